//! Impacts inside a world: the thesis's response, at the right instant.

use carom_dynamics::{BodyDef, EventKind, ImpactLaw, Material, PairMaterial, Settings, World};
use carom_geometry::{Circle, ConvexPolygon, Polygon};
use carom_math::{Vec2, vec2};
use carom_tests::elastic;

fn space() -> World {
    World::new(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    })
    .expect("valid")
}

#[test]
fn separating_bodies_get_no_impulse() {
    // The engine of the thesis pulls a separating pair together: it has no test for approach.
    let mut world = space();
    let square = || ConvexPolygon::square(1.0).expect("a square");
    world
        .insert(
            BodyDef::dynamic()
                .at(vec2(-0.49, 0.0))
                .moving(vec2(-1.0, 0.0)),
            square(),
            elastic(),
        )
        .expect("valid");
    world
        .insert(
            BodyDef::dynamic()
                .at(vec2(0.49, 0.0))
                .moving(vec2(1.0, 0.0)),
            square(),
            elastic(),
        )
        .expect("valid");
    world.step(1.0);
    assert_eq!(world.step(0.0).impacts, 0);
    let speeds: Vec<f64> = world.bodies().map(|b| b.velocity().x).collect();
    assert!(speeds[0] <= -1.0 && speeds[1] >= 1.0, "{speeds:?}");
}

#[test]
fn infinite_masses_push_and_are_not_pushed() {
    let mut world = space();
    let wall = ConvexPolygon::rectangle(1.0, 4.0).expect("a wall");
    let ram = world
        .insert(
            BodyDef::kinematic()
                .at(vec2(-3.0, 0.0))
                .moving(vec2(2.0, 0.0)),
            wall,
            elastic(),
        )
        .expect("valid");
    let ball = world
        .insert(
            BodyDef::dynamic(),
            Circle::new(0.5).expect("a ball"),
            elastic(),
        )
        .expect("valid");
    world.step(2.0);
    assert_eq!(
        world.body(ram).expect("it stays").velocity(),
        vec2(2.0, 0.0)
    );
    assert!(
        (world.body(ball).expect("it stays").velocity() - vec2(4.0, 0.0)).length() < 1e-12,
        "twice the ram's speed"
    );
    // The ram did the work: it came from outside.
    let energy = world.energy();
    assert!(energy.residual().abs() < 1e-12 && energy.external > 0.0);
}

#[test]
fn one_impact_of_a_spinning_square_is_the_law_s_answer_in_every_law() {
    for law in [ImpactLaw::Stronge, ImpactLaw::Poisson, ImpactLaw::Newton] {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            impact_law: law,
            ..Settings::default()
        })
        .expect("valid");
        let rough = Material {
            friction: 0.3,
            restitution: 0.5,
            ..Material::default()
        };
        world
            .insert(
                BodyDef::fixed().at(vec2(0.0, -1.0)),
                ConvexPolygon::rectangle(20.0, 2.0).expect("a floor"),
                rough,
            )
            .expect("valid");
        let square = world
            .insert(
                BodyDef::dynamic()
                    .at(vec2(0.0, 2.0))
                    .turned(0.4)
                    .moving(vec2(1.0, -2.0))
                    .spinning(0.2),
                ConvexPolygon::square(1.0).expect("a square"),
                rough,
            )
            .expect("valid");
        let report = world.step_to_next_event(2.0);
        assert_eq!(report.impacts, 1);
        let energy = world.energy();
        assert!(energy.impacts > 0.0);
        assert!(energy.residual().abs() < 1e-13);
        let rebound = world.body(square).expect("it stays");
        let struck = world.events().iter().find_map(|e| match e.kind {
            EventKind::Impact { point, speed, .. } => Some((point, speed)),
            _ => None,
        });
        let (point, speed) = struck.expect("an impact");
        let arm = point - rebound.centre();
        let after = rebound.velocity().y + rebound.angular_velocity() * arm.x;
        if law == ImpactLaw::Newton {
            assert!(
                (after - 0.5 * speed).abs() < 1e-13,
                "{after} against e · {speed}"
            );
        }
        assert!(after > 0.0);
    }
}

#[test]
fn a_pair_s_own_material_wins_over_mixing() {
    let mut world = space();
    let a = world
        .insert(
            BodyDef::fixed(),
            Circle::new(1.0).expect("a disc"),
            elastic(),
        )
        .expect("valid");
    let b = world
        .insert(
            BodyDef::dynamic()
                .at(vec2(4.0, 0.0))
                .moving(vec2(-2.0, 0.0)),
            Circle::new(1.0).expect("a disc"),
            elastic(),
        )
        .expect("valid");
    world
        .set_pair_material(
            a,
            b,
            PairMaterial {
                friction: 0.0,
                restitution: 0.25,
                ..PairMaterial::default()
            },
        )
        .expect("valid");
    world.step(3.0);
    assert!((world.body(b).expect("it stays").velocity() - vec2(0.5, 0.0)).length() < 1e-13);
}

#[test]
fn a_concave_body_is_struck_on_its_true_outline() {
    // A ball dropped into the notch of a U falls past both arms and lands on the base.
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -10.0),
        ..Settings::default()
    })
    .expect("valid");
    let u = Polygon::new([
        vec2(-2.0, 0.0),
        vec2(2.0, 0.0),
        vec2(2.0, 3.0),
        vec2(1.0, 3.0),
        vec2(1.0, 1.0),
        vec2(-1.0, 1.0),
        vec2(-1.0, 3.0),
        vec2(-2.0, 3.0),
    ])
    .expect("a U");
    world
        .insert(BodyDef::fixed(), u, Material::default())
        .expect("valid");
    let ball = world
        .insert(
            BodyDef::dynamic().at(vec2(0.2, 6.4)),
            Circle::new(0.4).expect("a ball"),
            Material::default(),
        )
        .expect("valid");
    let report = world.step_to_next_event(3.0);
    assert_eq!(report.impacts, 1);
    assert!(
        (world.time().as_secs() - 1.0).abs() < 1e-13,
        "5 m down to the base at y = 1"
    );
    assert!((world.body(ball).expect("it stays").centre() - vec2(0.2, 1.4)).length() < 1e-12);
}

#[test]
fn a_bullet_does_not_pass_a_thin_wall_and_no_speed_is_capped() {
    let mut world = space();
    world
        .insert(
            BodyDef::fixed(),
            ConvexPolygon::rectangle(0.001, 10.0).expect("a wall"),
            elastic(),
        )
        .expect("valid");
    let bullet = world
        .insert(
            BodyDef::dynamic()
                .at(vec2(-5.0, 0.0))
                .moving(vec2(1e6, 0.0)),
            Circle::new(0.01).expect("a bullet"),
            elastic(),
        )
        .expect("valid");
    world.step(1e-3);
    let body = world.body(bullet).expect("it stays");
    assert!((body.velocity() - vec2(-1e6, 0.0)).length() < 1e-9);
    assert!(
        (body.centre().x + 1000.0 - 5.0 + 2.0 * 0.0105).abs() < 1e-6,
        "reflected at −0.0105 m: {}",
        body.centre().x
    );
}

#[test]
fn two_bodies_at_one_place_part_by_a_fixed_rule() {
    // Coincident centres gave the original program a division by zero.
    let run = || {
        let mut world = space();
        for _ in 0..2 {
            world
                .insert(
                    BodyDef::dynamic(),
                    Circle::new(0.5).expect("a disc"),
                    Material::default(),
                )
                .expect("valid");
        }
        for _ in 0..120 {
            world.step(1.0 / 60.0);
        }
        assert!(
            world
                .bodies()
                .all(|b| b.centre().is_finite() && b.velocity().is_finite())
        );
        let centres: Vec<Vec2> = world.bodies().map(|b| b.centre()).collect();
        assert!((centres[1] - centres[0]).length() > 0.9, "{centres:?}");
        world.state_hash()
    };
    assert_eq!(run(), run());
}

/// A free body that found nothing around it does not search again with every impact, but where something came.
#[test]
fn a_wall_that_came_where_nothing_was_is_struck() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("settings");
    let material = Material {
        restitution: 1.0,
        friction: 0.0,
        ..Material::default()
    };
    let slab = |width, height| ConvexPolygon::rectangle(width, height).expect("a slab");
    let fixed = |x, y| BodyDef::fixed().at(vec2(x, y));
    world
        .insert(fixed(0.0, -30.0), slab(80.0, 1.0), material)
        .expect("a floor");
    let discs = [
        (-12.0, 3.0),
        (-4.0, 3.0),
        (-2.0, 0.0),
        (0.0, 0.0),
        (2.0, 0.0),
    ];
    let ids = discs.map(|(x, speed)| {
        let def = BodyDef::dynamic().at(vec2(x, 0.0)).moving(vec2(speed, 0.0));
        let disc = Circle::new(0.5).expect("a disc");
        world.insert(def, disc, material).expect("a disc")
    });
    // The first blow has gone through the row: each gave it on and stands where it met the next.
    let report = world.step(1.5);
    assert_eq!(report.impacts, 3);
    world
        .insert(fixed(2.5, 0.0), slab(0.4, 4.0), material)
        .expect("a wall");
    // The second blow brings the last of them against the wall, and comes back.
    world.step(4.0);
    let at = |k: usize| world.body(ids[k]).expect("it is there").centre().x;
    assert!(at(3) < 1.8 + 1e-12, "through the wall: {} m", at(3));
    let velocity = world.body(ids[0]).expect("it is there").velocity();
    assert!((velocity - vec2(-3.0, 0.0)).length() < 1e-12, "{velocity}");
}

/// A ball that comes down between two others strikes both at one instant: neither comes first, with losses too.
#[test]
fn a_ball_between_two_parts_them_alike_whatever_is_lost() {
    for (restitution, friction) in [(0.0, 0.0), (0.5, 0.0), (0.5, 0.4), (0.9, 0.1), (1.0, 0.0)] {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            ..Settings::default()
        })
        .expect("valid");
        let material = Material {
            restitution,
            friction,
            ..Material::default()
        };
        let mut ball = |at: Vec2, velocity: Vec2| {
            let shape = Circle::new(0.5).expect("a ball");
            let def = BodyDef::dynamic().at(at).moving(velocity);
            world.insert(def, shape, material).expect("valid")
        };
        let middle = ball(vec2(0.0, 3.0), vec2(0.0, -2.0));
        let (left, right) = (
            ball(vec2(-0.6, 0.0), Vec2::ZERO),
            ball(vec2(0.6, 0.0), Vec2::ZERO),
        );
        let report = world.step(2.0);
        assert_eq!(report.impacts, 2, "e = {restitution}");
        let [middle, left, right] = [middle, left, right]
            .map(|id| world.body(id).expect("it is there"))
            .map(|body| (body.velocity(), body.angular_velocity()));
        assert!(
            middle.0.x.abs() < 1e-14,
            "{} at e = {restitution}",
            middle.0
        );
        assert!(middle.1.abs() < 1e-13);
        assert!((left.0.x + right.0.x).abs() < 1e-14 && (left.0.y - right.0.y).abs() < 1e-14);
        assert!((left.1 + right.1).abs() < 1e-13);
        assert!(right.0.x > 0.1);
    }
}
