//! Lasting contacts in closed form: rest, slide, roll, and the instants between them.

use carom_dynamics::{
    BodyDef, BodyId, ContactMode, EventKind, Impulse, PairMaterial, Settings, World,
};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Rot, SimTime, Vec2, vec2};
use carom_tests::run;
use carom_tests::scenes::surface;

const G: f64 = 9.81;

fn world() -> World {
    World::new(Settings {
        sleep: None,
        ..Settings::default()
    })
    .expect("valid")
}

fn on_floor(friction: f64) -> World {
    let mut world = world();
    let floor = ConvexPolygon::rectangle(2000.0, 2.0).expect("a floor");
    let def = BodyDef::fixed().at(vec2(0.0, -1.0));
    world
        .insert(def, floor, surface(0.0, friction))
        .expect("valid");
    world
}

fn block(width: f64, height: f64) -> ConvexPolygon {
    ConvexPolygon::rectangle(width, height).expect("a block")
}

/// Modes that began, with their instants.
fn modes(world: &mut World, seconds: f64) -> Vec<(SimTime, ContactMode)> {
    let end = world.time() + seconds;
    let mut found = Vec::new();
    while end - world.time() > 0.0 {
        world.step_to_next_event(end - world.time());
        for event in world.events() {
            if let EventKind::Mode { mode, .. } = event.kind {
                found.push((event.time, mode));
            }
        }
    }
    found
}

fn centre(world: &World, id: BodyId) -> Vec2 {
    world.body(id).expect("it is there").centre()
}

#[test]
fn a_column_of_ten_boxes_does_not_move_at_all() {
    let mut world = on_floor(0.5);
    let boxes: Vec<BodyId> = (0..10)
        .map(|k| {
            let def = BodyDef::dynamic().at(vec2(0.0, 0.5 + f64::from(k)));
            world
                .insert(def, block(1.0, 1.0), surface(0.0, 0.5))
                .expect("valid")
        })
        .collect();
    run(&mut world, 10.0, |_| {});
    for (k, id) in boxes.into_iter().enumerate() {
        let body = world.body(id).expect("it is there");
        assert_eq!(
            body.centre().y,
            0.5 + f64::from(u32::try_from(k).expect("few"))
        );
        assert_eq!(
            (body.velocity(), body.angular_velocity()),
            (Vec2::ZERO, 0.0)
        );
    }
    assert_eq!(world.energy().scheme, 0.0);
}

#[test]
fn a_block_on_a_slope_that_is_no_axis_slides_by_the_textbook() {
    let slope = Rot::from_degrees(30.0);
    let mut world = world();
    let half_plane = HalfPlane::new(Vec2::ZERO, slope * vec2(0.0, 1.0)).expect("a slope");
    world
        .insert(BodyDef::fixed(), Shape::from(half_plane), surface(0.0, 0.3))
        .expect("valid");
    let def = BodyDef::dynamic()
        .at(slope * vec2(0.0, 0.25))
        .turned(30.0_f64.to_radians());
    let id = world
        .insert(def, block(2.0, 0.5), surface(0.0, 0.3))
        .expect("valid");
    run(&mut world, 3.0, |_| {});
    let a = G * (slope.sin() - 0.3 * slope.cos());
    let way = slope.inverse_mul(centre(&world, id));
    assert!((way.x + 0.5 * a * 9.0).abs() < 1e-12 * 9.0, "{way}");
    assert!((way.y - 0.25).abs() < 1e-13, "{way}");
    let ledger = world.energy();
    assert!(ledger.scheme.abs() < 1e-11, "{ledger:?}");
    assert!(ledger.residual().abs() < 1e-11, "{ledger:?}");
    let mass = 1.0 * world.body(id).expect("it is there").mass();
    let heat = 0.3 * mass * G * slope.cos() * -way.x;
    assert!(
        (ledger.friction - heat).abs() < 1e-11 * heat,
        "{} not {heat}",
        ledger.friction
    );
}

#[test]
fn a_ball_that_rolls_up_a_slope_stops_and_rolls_back() {
    // Issue 906 of a peer: it must not fall asleep at its highest point.
    let mut world = World::new(Settings {
        gravity: Rot::from_degrees(10.0) * vec2(0.0, -G),
        ..Settings::default()
    })
    .expect("valid");
    let floor = block(2000.0, 2.0);
    world
        .insert(
            BodyDef::fixed().at(vec2(0.0, -1.0)),
            floor,
            surface(0.0, 0.8),
        )
        .expect("valid");
    let def = BodyDef::dynamic()
        .at(vec2(0.0, 0.5))
        .moving(vec2(-1.0, 0.0))
        .spinning(2.0);
    let id = world
        .insert(def, Circle::new(0.5).expect("a ball"), surface(0.0, 0.8))
        .expect("valid");
    let a = G * carom_math::trig::sin_cos(10.0_f64.to_radians()).0 / 1.5;
    run(&mut world, 2.0, |_| {});
    let t = world.time().as_secs();
    let off = centre(&world, id).x - (-t + 0.5 * a * t * t);
    assert!(off.abs() < 1e-13, "{off:e}");
    let body = world.body(id).expect("it is there");
    assert!((body.velocity().x + 0.5 * body.angular_velocity()).abs() < 1e-14);
}

#[test]
fn a_disc_rolls_off_the_end_of_a_table() {
    let mut world = world();
    world
        .insert(
            BodyDef::fixed().at(vec2(0.0, -1.0)),
            block(4.0, 2.0),
            surface(0.0, 0.5),
        )
        .expect("valid");
    let def = BodyDef::dynamic()
        .at(vec2(0.0, 0.25))
        .moving(vec2(2.0, 0.0))
        .spinning(-8.0);
    let id = world
        .insert(def, Circle::new(0.25).expect("a disc"), surface(0.0, 0.5))
        .expect("valid");
    world.step(1.0);
    assert_eq!(centre(&world, id), vec2(2.0, 0.25));
    run(&mut world, 1.0, |_| {});
    assert!(centre(&world, id).y < -1.0);
    assert!(world.energy().residual().abs() < 1e-9);
}

/// At the end of an edge rounding said to and fro whether a disc was still on it, and the solver of sub-steps let it
/// down: it rolls about the corner, and leaves it where the corner would have to pull.
#[test]
fn discs_that_roll_off_a_table_roll_about_its_corner() {
    for k in 0..40 {
        let (width, speed) = (4.0 + 0.37 * f64::from(k), 0.3 + 0.031 * f64::from(k));
        let mut world = world();
        let table = BodyDef::fixed().at(vec2(0.3, -1.0));
        world
            .insert(table, block(width, 2.0), surface(0.0, 1e3))
            .expect("valid");
        let (edge, r) = (0.3 + 0.5 * width, 0.25);
        let def = BodyDef::dynamic()
            .at(vec2(edge - 0.5, r))
            .moving(vec2(speed, 0.0))
            .spinning(-speed / r);
        let id = world
            .insert(def, Circle::new(r).expect("a disc"), surface(0.0, 1e3))
            .expect("valid");
        let (mut rows, mut rolled, mut open) = (0, 0, false);
        while !open && world.time().as_secs() < 5.0 {
            rows += world.step_to_next_event(0.01).rows;
            let began = |mode: ContactMode| {
                let mut events = world.events().iter();
                events
                    .any(|event| matches!(event.kind, EventKind::Mode { mode: m, .. } if m == mode))
            };
            open = began(ContactMode::Open);
            if open || began(ContactMode::Slide) {
                // No friction holds it where nothing presses any more.
                continue;
            }
            let body = world.body(id).expect("it is there");
            let from = body.centre() - vec2(edge, 0.0);
            if from.x > 0.0 {
                // 3/4 m v² = 3/4 m v₀² + m g r (1 − cos θ)
                let v2 = body.velocity().length_squared();
                let want = speed * speed + 4.0 / 3.0 * G * (r - from.y);
                assert!(
                    (v2 - want).abs() < 1e-11 * want,
                    "disc {k}: {v2}, not {want}"
                );
                assert!(
                    (from.length() - r).abs() < 1e-13,
                    "disc {k}: off the corner"
                );
                rolled += 1;
            }
        }
        assert!(
            open && rolled > 0,
            "disc {k} was on the corner {rolled} times"
        );
        assert_eq!(rows, 0, "disc {k}: no solver");
        // It leaves at v² = g r cos θ; the slip just before, at µ = 1000, does little.
        let cos = (0.75 * speed * speed + G * r) / (1.75 * G * r);
        let want = G * r * cos * cos * cos;
        let across = world.body(id).expect("it is there").velocity().x;
        assert!((across * across / want - 1.0).abs() < 1e-3, "disc {k}");
    }
}

#[test]
fn a_ball_that_lands_and_spins_slips_and_then_rolls() {
    let mut world = on_floor(0.3);
    let def = BodyDef::dynamic().at(vec2(0.0, 1.25)).spinning(-40.0);
    let id = world
        .insert(def, Circle::new(0.25).expect("a ball"), surface(0.0, 0.3))
        .expect("valid");
    let found = modes(&mut world, 3.0);
    assert_eq!(
        found.iter().map(|(_, mode)| *mode).collect::<Vec<_>>(),
        [ContactMode::Slide, ContactMode::Roll]
    );
    // Friction acts in the landing, too: the angular momentum about the floor stays, v = ω₀ r / 3.
    let body = world.body(id).expect("it is there");
    assert!(
        (body.velocity().x - 10.0 / 3.0).abs() < 1e-14,
        "{}",
        body.velocity()
    );
    let landing = (2.0 / G).sqrt();
    let impulse = 0.3 * (2.0 * G).sqrt();
    let wanted = landing + (10.0 / 3.0 - impulse) / (0.3 * G);
    assert!((found[1].0.as_secs() - wanted).abs() < 1e-13);
    assert!((centre(&world, id).y - 0.25).abs() < 1e-14);
}

#[test]
fn a_struck_block_slides_and_stops_where_it_should() {
    let mut world = on_floor(0.4);
    let def = BodyDef::dynamic().at(vec2(0.0, 0.25));
    let id = world
        .insert(def, block(2.0, 0.5), surface(0.0, 0.4))
        .expect("valid");
    run(&mut world, 0.5, |_| {});
    assert_eq!(centre(&world, id), vec2(0.0, 0.25));
    let mass = world.body(id).expect("it is there").mass();
    let at = centre(&world, id);
    world
        .apply(id, Impulse::at(at, vec2(3.0 * mass, 0.0)))
        .expect("valid");
    let hit = world.time();
    let found = modes(&mut world, 2.0);
    let (stopped, mode) = *found.last().expect("it stops");
    assert_eq!(mode, ContactMode::Rest);
    assert!((stopped - hit - 3.0 / (0.4 * G)).abs() < 1e-14);
    assert!((centre(&world, id).x - 9.0 / (0.8 * G)).abs() < 1e-14);
}

/// More groups change at one instant than one of them may have mode solves there: only the first 16 stopped where they should,
/// all others slid on, and back, to the next sub-step.
#[test]
fn a_hundred_blocks_that_come_to_rest_at_one_instant_all_stop_there() {
    let mut world = on_floor(0.5);
    let speed = 3.0;
    let from = |k: i32| -450.0 + 9.0 * f64::from(k);
    let put = |k| {
        let def = BodyDef::dynamic().at(vec2(from(k), 0.5));
        let def = def.moving(vec2(speed, 0.0));
        world
            .insert(def, block(1.0, 1.0), surface(0.0, 0.5))
            .expect("valid")
    };
    let blocks: Vec<BodyId> = (0..100).map(put).collect();
    world.step(2.0);
    let way = speed * speed / (2.0 * 0.5 * G);
    for (k, id) in (0..).zip(&blocks) {
        let off = centre(&world, *id).x - (from(k) + way);
        assert!(off.abs() < 1e-12, "block {k} is {off:e} m off");
    }
}

#[test]
fn a_free_body_that_hits_a_sliding_block_joins_the_account_at_its_instant() {
    let mut world = on_floor(0.2);
    let slider = BodyDef::dynamic()
        .at(vec2(0.0, 0.25))
        .moving(vec2(2.0, 0.0))
        .with_mass(1.0);
    let slider = world
        .insert(slider, block(2.0, 0.5), surface(0.0, 0.2))
        .expect("valid");
    let stone = BodyDef::dynamic().at(vec2(3.0, 0.25)).with_mass(1.0);
    let stone = world
        .insert(stone, block(2.0, 0.5), surface(0.0, 0.2))
        .expect("valid");
    let smooth = PairMaterial::default();
    world
        .set_pair_material(slider, stone, smooth)
        .expect("valid");
    // They meet when the slider has come 1 m, with e = 0 go on as one, and stop as one.
    let a = 0.2 * G;
    let speed = (4.0 - 2.0 * a).sqrt() / 2.0;
    run(&mut world, 4.0, |_| {});
    let wanted = 1.0 + speed * speed / (2.0 * a);
    for (id, from) in [(slider, 0.0), (stone, 2.0)] {
        let body = world.body(id).expect("it is there");
        assert_eq!(body.velocity(), Vec2::ZERO);
        assert!(
            (body.centre() - vec2(from + wanted, 0.25)).length() < 1e-12,
            "{}",
            body.centre()
        );
    }
    assert!(world.energy().residual().abs() < 1e-12);
}

#[test]
fn a_conveyor_takes_a_block_along() {
    let mut world = world();
    let belt = BodyDef::kinematic()
        .at(vec2(0.0, -1.0))
        .moving(vec2(1.5, 0.0));
    world
        .insert(belt, block(2000.0, 2.0), surface(0.0, 0.5))
        .expect("valid");
    let def = BodyDef::dynamic().at(vec2(0.0, 0.25));
    let id = world
        .insert(def, block(2.0, 0.5), surface(0.0, 0.5))
        .expect("valid");
    let brought = world.energy().external;
    let found = modes(&mut world, 2.0);
    assert_eq!(
        found.last().map(|(_, mode)| *mode),
        Some(ContactMode::Stick)
    );
    assert!((found[1].0.as_secs() - 1.5 / (0.5 * G)).abs() < 1e-14);
    let body = world.body(id).expect("it is there");
    assert!((body.velocity().x - 1.5).abs() < 1e-14);
    let ledger = world.energy();
    assert!(
        ledger.residual().abs() < 1e-12 && ledger.scheme.abs() < 1e-12,
        "{ledger:?}"
    );
    assert!(
        (ledger.external - brought - body.mass() * 1.5 * 1.5).abs() < 1e-12,
        "{ledger:?}"
    );
}

#[test]
fn what_rests_falls_asleep_and_wakes_when_it_is_struck() {
    let mut world = World::new(Settings::default()).expect("valid");
    world
        .insert(
            BodyDef::fixed().at(vec2(0.0, -1.0)),
            block(20.0, 2.0),
            surface(0.0, 0.5),
        )
        .expect("valid");
    let id = world
        .insert(
            BodyDef::dynamic().at(vec2(0.0, 0.5)),
            block(1.0, 1.0),
            surface(0.0, 0.5),
        )
        .expect("valid");
    run(&mut world, 1.0, |_| {});
    assert!(world.body(id).expect("it is there").is_asleep());
    let ball = BodyDef::dynamic()
        .at(vec2(-3.0, 0.5))
        .moving(vec2(5.0, 0.0));
    world
        .insert(ball, Circle::new(0.25).expect("a ball"), surface(0.0, 0.5))
        .expect("valid");
    run(&mut world, 1.0, |_| {});
    assert!(centre(&world, id).x > 0.01);
    assert!(world.energy().residual().abs() < 1e-9);
}

#[test]
fn a_slender_rod_that_slides_on_its_tip_stays_finite_and_loses_energy() {
    // Painlevé: above µ = 4/3 accelerations have no answer; impulses have.
    let mut world = on_floor(1.6);
    let lean = Rot::from_degrees(60.0);
    let rod = block(2.0, 0.01);
    let low = lean * vec2(-1.0, -0.005);
    let def = BodyDef::dynamic()
        .at(vec2(0.0, -low.y))
        .turned(60.0_f64.to_radians())
        .moving(vec2(-1.0, 0.0));
    let id = world.insert(def, rod, surface(0.0, 1.6)).expect("valid");
    let mut before = world.energy().mechanical();
    run(&mut world, 2.0, |world| {
        let now = world.energy().mechanical();
        assert!(now <= before + 1e-3, "{now} after {before} J");
        before = now;
    });
    assert!(centre(&world, id).is_finite());
}

#[test]
fn a_block_on_a_plank_comes_to_ride_it() {
    let mut world = world();
    let block_def = BodyDef::dynamic()
        .at(vec2(0.0, 0.625))
        .moving(vec2(2.0, 0.0))
        .with_mass(1.0);
    let top = world
        .insert(block_def, block(4.0, 0.25), surface(0.0, 0.2))
        .expect("valid");
    world
        .insert(
            BodyDef::fixed().at(vec2(0.0, -1.0)),
            block(2000.0, 2.0),
            surface(0.0, 0.0),
        )
        .expect("valid");
    let plank_def = BodyDef::dynamic().at(vec2(0.0, 0.25)).with_mass(1000.0);
    let plank = world
        .insert(plank_def, block(1000.0, 0.5), surface(0.0, 0.2))
        .expect("valid");
    run(&mut world, 2.0, |_| {});
    let common = 2.0 / 1001.0;
    for id in [top, plank] {
        let velocity = world.body(id).expect("it is there").velocity();
        assert!(
            (velocity - vec2(common, 0.0)).length() < 1e-14,
            "{velocity}"
        );
    }
}
