//! What spins fast was searched for a turn at a time past a wall that leans, 1e8 times in a day; what fell for a day was
//! seen from where it began, in boxes rounded to kilometres, and looked round every 35 cm; what is larger than the cells
//! of the grid did so, too.

use carom_dynamics::{BodyDef, BodyId, Mode, Settings, World};
use carom_geometry::{HalfPlane, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

const DAY: f64 = 86_400.0;

fn empty(gravity: f64) -> World {
    World::new(Settings {
        gravity: vec2(0.0, gravity),
        mode: Mode::Exact,
        ..Settings::default()
    })
    .expect("valid settings")
}

#[test]
fn a_long_flight_costs_no_more_than_what_it_meets() {
    let shapes: [fn() -> Shape; 3] = [
        || disc(0.5).into(),
        || block(1.0, 1.0).into(),
        || block(100.0, 1.0).into(),
    ];
    for (k, shape) in shapes.into_iter().enumerate() {
        for gravity in [0.0, -9.81] {
            let mut world = empty(gravity);
            let leans = HalfPlane::new(Vec2::ZERO, vec2(-1.0, 0.1)).expect("a wall");
            let wall = BodyDef::fixed().at(vec2(100.0, 0.0));
            put(&mut world, wall, leans, surface(0.5, 0.3));
            // Up, and back where it began.
            let velocity = vec2(-4.0, -0.5 * gravity * DAY);
            let flies = BodyDef::dynamic().moving(velocity).spinning(1e4);
            let body = put(&mut world, flies, shape(), surface(0.5, 0.3));
            let report = world.step(DAY);
            assert!(report.is_exact() && report.impacts == 0, "{report:?}");
            assert!(report.pairs < 10_000, "{} looks, shape {k}", report.pairs);
            let off = world.body(body).expect("there").centre() - vec2(-4.0 * DAY, 0.0);
            assert!(off.length() < 1e-4, "{off} m off, shape {k}");
        }
    }
}

fn velocities(world: &World, id: BodyId) -> (Vec2, f64) {
    let body = world.body(id).expect("there");
    (body.velocity(), body.angular_velocity())
}

#[test]
fn a_spinning_box_strikes_a_leaning_wall_as_one_that_was_looked_at_often_does() {
    // Cut into steps of 0.1 rad, where the search begins anew each time the caller changes something.
    let strike = |looks: u32| {
        let mut world = empty(0.0);
        let leans = HalfPlane::new(Vec2::ZERO, vec2(-1.0, 0.1)).expect("a wall");
        let wall = BodyDef::fixed().at(vec2(3.0, 0.0));
        put(&mut world, wall, leans, surface(1.0, 0.0));
        let flies = BodyDef::dynamic().moving(vec2(1.0, 0.0)).spinning(200.0);
        let body = put(&mut world, flies, block(1.0, 1.0), surface(1.0, 0.0));
        for _ in 0..looks {
            world.step(4.0 / f64::from(looks));
            let (velocity, spin) = velocities(&world, body);
            world.set_velocity(body, velocity, spin).expect("there");
        }
        world.step(1e-3);
        velocities(&world, body)
    };
    let ((once, spin), (often, spin_often)) = (strike(1), strike(8_000));
    let off = (once - often).length() + (spin - spin_often).abs();
    // An angle of up to 800 rad is rounded by 1e-13 rad in each of 8,000 steps, and the impact turns by it.
    assert!(
        once.x < 0.0 && off < 1e-9 * spin.abs(),
        "{once} and {often}"
    );
}
