//! Stepped mode: every moving body in one solver, contacts kept from step to step.

use carom_dynamics::{BodyDef, BodyKind, EventKind, Material, Settings};
use carom_geometry::HalfPlane;
use carom_math::{Pose, Rot, Vec2, vec2};
use carom_tests::scenes::{block, boxed, column, disc, floor, put, stepped};
use carom_tests::{elastic, run};

#[test]
fn the_apex_of_an_elastic_ball_stays_within_a_thousandth() {
    let mut world = stepped(Settings::default());
    floor(&mut world, elastic());
    let def = BodyDef::dynamic().at(vec2(0.0, 1.25));
    let ball = put(&mut world, def, disc(0.25), elastic());
    let mut apexes = Vec::new();
    let mut before = (1.25, 0.0);
    run(&mut world, 12.0, |world| {
        let body = world.body(ball).expect("it stays");
        let now = (body.centre().y, body.velocity().y);
        if before.1 > 0.0 && now.1 <= 0.0 {
            // From any point of a parabola to its top: v²/2g.
            apexes.push(now.0 + now.1 * now.1 / (2.0 * 9.81) - 0.25);
        }
        before = now;
    });
    for (i, apex) in apexes.iter().take(10).enumerate() {
        assert!(
            (apex - 1.0).abs() < 1e-3,
            "apex {i} at {apex} m, expected 1 within 1e-3"
        );
    }
    assert!(apexes.len() >= 10, "{} apexes", apexes.len());
}

#[test]
fn a_pile_at_rest_looks_at_no_pair() {
    let mut world = stepped(Settings {
        sleep: None,
        ..Settings::default()
    });
    floor(&mut world, Material::default());
    for i in 0..30 {
        boxed(
            &mut world,
            vec2(f64::from(i % 6) * 1.1, 0.5 + f64::from(i / 6)),
            Material::default(),
        );
    }
    run(&mut world, 5.0, |_| {});
    let mut looks = 0;
    for _ in 0..60 {
        let report = world.step(1.0 / 60.0);
        looks += report.pairs;
        assert!(report.rows > 0);
    }
    assert_eq!(looks, 0, "pairs that were looked at in a second at rest");
}

#[test]
fn a_stack_falls_asleep_and_wakes_when_it_is_hit() {
    let mut world = stepped(Settings::default());
    floor(&mut world, Material::default());
    let stack = column(&mut world, 3, Material::default());
    run(&mut world, 3.0, |_| {});
    for id in &stack {
        assert!(world.body(*id).expect("it stays").is_asleep());
    }
    let report = world.step(1.0 / 60.0);
    assert_eq!((report.rows, report.handed_over), (0, 0));
    let def = BodyDef::dynamic()
        .at(vec2(-6.0, 1.5))
        .moving(vec2(12.0, 0.0));
    put(&mut world, def, disc(0.25), Material::default());
    let mut woken = 0;
    run(&mut world, 1.0, |world| {
        let events = world.events().iter();
        woken += events
            .filter(|event| matches!(event.kind, EventKind::Awake(_)))
            .count();
    });
    assert_eq!(woken, 3);
    let pushed = world.body(stack[1]).expect("it stays").centre().x;
    assert!(pushed > 0.01, "the middle box moved {pushed} m");
}

#[test]
fn a_box_slides_to_rest_where_coulomb_says() {
    let ice = Material {
        friction: 0.3,
        ..Material::default()
    };
    let mut world = stepped(Settings::default());
    floor(&mut world, ice);
    let id = boxed(&mut world, vec2(-10.0, 0.5), ice);
    run(&mut world, 0.5, |_| {});
    let from = world.body(id).expect("it stays").centre().x;
    world.set_velocity(id, vec2(4.0, 0.0), 0.0).expect("valid");
    let before = world.energy();
    run(&mut world, 3.0, |_| {});
    let went = world.body(id).expect("it stays").centre().x - from;
    let exact = 16.0 / (2.0 * 0.3 * 9.81);
    assert!(
        (went - exact).abs() < 1e-3,
        "slid {went} m, expected {exact}"
    );
    // Slip is taken as the row sees it: to first order in the sub-step.
    let heat = world.energy().friction - before.friction;
    assert!((heat - 8.0).abs() < 0.05, "friction took {heat} J of 8");
}

#[test]
fn steps_of_any_length_give_the_same_motions() {
    let build = || {
        let mut world = stepped(Settings::default());
        floor(&mut world, Material::default());
        for i in 0..12 {
            let at = vec2(0.3 * f64::from(i % 3), 1.0 + 1.2 * f64::from(i));
            boxed(&mut world, at, Material::default());
        }
        world
    };
    let (mut one, mut many) = (build(), build());
    one.step(2.0);
    for _ in 0..2000 {
        many.step(1e-3);
    }
    for (a, b) in one.bodies().zip(many.bodies()) {
        assert!(
            (a.centre() - b.centre()).length() < 1e-12,
            "{} {}",
            a.centre(),
            b.centre()
        );
    }
    let mut again = build();
    again.step(2.0);
    assert_eq!(again.state_hash(), one.state_hash());
}

#[test]
fn what_a_caller_changes_is_taken_over() {
    let mut world = stepped(Settings::default());
    floor(&mut world, Material::default());
    let low = boxed(&mut world, vec2(0.0, 0.5), Material::default());
    let high = boxed(&mut world, vec2(0.0, 1.5), Material::default());
    run(&mut world, 2.0, |_| {});
    // The support goes: what stood on it falls.
    world.remove(low).expect("it is there");
    run(&mut world, 1.0, |_| {});
    let y = world.body(high).expect("it stays").centre().y;
    assert!((y - 0.5).abs() < 1e-3, "fell to {y}");
    // Teleported into the air: falls again, freely.
    world
        .teleport(high, Pose::new(vec2(3.0, 5.0), Rot::from_degrees(90.0)))
        .expect("valid");
    world.step(0.5);
    let body = world.body(high).expect("it stays");
    let exact = 5.0 - 0.5 * 9.81 * 0.25;
    assert!(
        (body.centre() - vec2(3.0, exact)).length() < 1e-9,
        "{}",
        body.centre()
    );
    run(&mut world, 2.0, |_| {});
    world.set_kind(high, BodyKind::Fixed).expect("valid");
    let rest = boxed(&mut world, vec2(3.0, 1.6), Material::default());
    run(&mut world, 1.0, |_| {});
    let y = world.body(rest).expect("it stays").centre().y;
    assert!((y - 1.5).abs() < 1e-3, "rests at {y}");
    // A box of the same place in the store.
    world.remove(rest).expect("it is there");
    let new = boxed(&mut world, vec2(-3.0, 2.0), Material::default());
    run(&mut world, 2.0, |_| {});
    let y = world.body(new).expect("it stays").centre().y;
    assert!((y - 0.5).abs() < 1e-3, "fell to {y}");
}

#[test]
fn a_pile_is_the_same_a_million_metres_away() {
    let build = |far: Vec2| {
        let mut world = stepped(Settings::default());
        world
            .insert(
                BodyDef::fixed().at(far),
                HalfPlane::new(Vec2::ZERO, vec2(0.0, 1.0)).expect("a floor"),
                Material::default(),
            )
            .expect("valid");
        for i in 0..10 {
            boxed(
                &mut world,
                far + vec2(0.0, 0.5 + f64::from(i)),
                Material::default(),
            );
        }
        world.step(5.0);
        world
    };
    let (near, far) = (build(Vec2::ZERO), build(vec2(1048576.0, 0.0)));
    for (a, b) in near.bodies().zip(far.bodies()) {
        let difference = (b.centre() - vec2(1048576.0, 0.0) - a.centre()).length();
        assert!(difference < 1e-8, "{difference:.2e} m apart");
    }
}

#[test]
fn forces_act_for_their_step() {
    let mut world = stepped(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    });
    let id = boxed(&mut world, Vec2::ZERO, Material::default());
    for dt in [0.5, 1.0 / 60.0, 1e-3, 0.0123] {
        let before = world.body(id).expect("it stays").velocity().x;
        world
            .apply_force(id, carom_dynamics::Force::central(vec2(2.0, 0.0)))
            .expect("valid");
        world.step(dt);
        let gained = world.body(id).expect("it stays").velocity().x - before;
        assert!((gained - 2.0 * dt).abs() < 1e-12, "{gained} in {dt} s");
    }
    let work = world.energy().forces;
    let kinetic = world.energy().kinetic;
    assert!(
        (work - kinetic).abs() < 1e-9 * kinetic,
        "work {work} J of {kinetic}"
    );
}

/// What falls through something viscous in a field, and comes to rest on a floor.
#[test]
fn damping_and_fields_act_in_stepped_mode() {
    let mut world = stepped(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    });
    let down = carom_dynamics::RadialField::new(vec2(0.0, -1e4), 9.81e8, 1.0).expect("a field");
    world.add_field(down);
    floor(&mut world, Material::default());
    let def = BodyDef::dynamic().at(vec2(0.0, 20.5)).damped(0.5, 0.1);
    let id = put(&mut world, def, block(1.0, 1.0), Material::default());
    run(&mut world, 1.5, |_| {});
    // v = g/c (1 − e^(−ct)), where g is that of the field at 10 km from its centre.
    let speed = 9.81 / 0.5 * (1.0 - carom_math::trig::exp(-0.75));
    let v = world.body(id).expect("it stays").velocity();
    assert!((v.y + speed).abs() < 0.05, "{v} of {speed} m/s");
    run(&mut world, 5.0, |_| {});
    let body = world.body(id).expect("it stays");
    assert!((body.centre().y - 0.5).abs() < 1e-3, "{}", body.centre());
    assert!(body.is_asleep());
    // Damping that is taken away is gone.
    world.set_damping(id, 0.0, 0.0).expect("valid");
    let up = vec2(0.0, 30.0);
    world.set_velocity(id, up, 0.0).expect("valid");
    world.step(1.0);
    let v = world.body(id).expect("it stays").velocity();
    assert!((v.y - 30.0 + 9.81).abs() < 0.05, "{v}");
}

/// A half-plane reaches without end, and a move of it by little was taken for rounding.
#[test]
fn a_floor_that_is_put_a_little_lower_is_lower() {
    let mut world = stepped(Settings::default());
    let plane = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
    let floor = put(&mut world, BodyDef::fixed(), plane, Material::default());
    let id = boxed(&mut world, vec2(0.0, 0.5), Material::default());
    run(&mut world, 2.0, |_| {});
    let before = world.body(id).expect("it stays").centre().y;
    let pose = world.body(floor).expect("it stays").pose();
    let lower = Pose::new(pose.position - vec2(0.0, 5e-4), pose.rotation);
    world.teleport(floor, lower).expect("valid");
    run(&mut world, 2.0, |_| {});
    let fell = before - world.body(id).expect("it stays").centre().y;
    assert!((fell - 5e-4).abs() < 5e-5, "{fell} m");
}

/// A field without a number somewhere: bodies there feel nothing of it, in builds with assertions, too.
#[test]
fn a_field_that_is_no_number_accelerates_nothing() {
    #[derive(Debug)]
    struct Hole;
    impl carom_dynamics::Field for Hole {
        fn acceleration(&self, _: Vec2) -> Vec2 {
            Vec2::NAN
        }
        fn potential(&self, _: Vec2) -> f64 {
            0.0
        }
        fn gradient_bound(&self, _: Vec2, _: f64) -> f64 {
            0.0
        }
    }
    let mut world = stepped(Settings::default());
    world.add_field(Hole);
    let def = BodyDef::dynamic().moving(vec2(1.0, 0.0));
    let id = put(&mut world, def, disc(0.5), Material::default());
    world.step(1.0);
    let centre = world.body(id).expect("it stays").centre();
    assert!((centre - vec2(1.0, 0.0)).length() < 1e-9, "{centre}");
}
