//! What rests, sleeps and wakes, and what a caller does.

use carom_dynamics::{BodyDef, BodyKind, EventKind, Force, Impulse, Material, Settings};
use carom_geometry::{ConvexPolygon, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use carom_tests::scenes::{block, boxed, column, disc, floor, put, stepped, surface};
use carom_tests::{overlaps, run};

use super::{G, restless, weightless};

/// erincatto/box2d#906: a ball that turns back on a slope falls asleep at its highest point.
#[test]
fn case_18_a_ball_on_a_slope_turns_back() {
    let mut world = stepped(Settings::default());
    let slope = Rot::from_degrees(20.0);
    let def = BodyDef::fixed()
        .at(slope * vec2(0.0, -1.0))
        .turned(20.0_f64.to_radians());
    put(&mut world, def, block(60.0, 2.0), Material::default());
    // Rolling up at 3 m/s: it turns back after 3/(2/3 g sin 20°) = 1.34 s.
    let def = BodyDef::dynamic()
        .at(slope * vec2(0.0, 0.5))
        .moving(slope * vec2(3.0, 0.0))
        .spinning(-6.0);
    let ball = put(&mut world, def, disc(0.5), Material::default());
    let mut highest = 0.0_f64;
    run(&mut world, 4.0, |world| {
        let body = world.body(ball).expect("it stays");
        assert!(!body.is_asleep(), "asleep after {}", world.time().as_secs());
        highest = highest.max((slope.inverse() * body.centre()).x);
    });
    let a = 2.0 / 3.0 * G * slope.sin();
    assert!(
        (highest - 4.5 / a).abs() < 1e-3,
        "turned at {highest}, expected {}",
        4.5 / a
    );
    let along = slope.inverse() * world.body(ball).expect("it stays").centre();
    let exact = 3.0 * 4.0 - 0.5 * a * 16.0;
    assert!(
        (along.x - exact).abs() < 5e-3,
        "at {} m, expected {exact}",
        along.x
    );
}

/// erincatto/box2d#227, liabru/matter-js#875: what is put into sleepers does not wake them.
#[test]
fn case_19_a_static_body_among_sleepers_wakes_them_in_the_same_step() {
    for moved in [false, true] {
        let mut world = stepped(Settings::default());
        floor(&mut world, Material::default());
        let low = boxed(&mut world, vec2(0.0, 0.5), Material::default());
        let high = boxed(&mut world, vec2(0.0, 1.5), Material::default());
        let far = BodyDef::fixed().at(vec2(15.0, 5.0));
        let wall = put(&mut world, far, block(1.0, 1.0), Material::default());
        run(&mut world, 3.0, |_| {});
        assert!(
            [low, high]
                .iter()
                .all(|id| world.body(*id).expect("it stays").is_asleep())
        );
        let at = vec2(0.7, 0.6);
        if moved {
            world.teleport(wall, Pose::at(at)).expect("valid");
        } else {
            put(
                &mut world,
                BodyDef::fixed().at(at),
                block(1.0, 1.0),
                Material::default(),
            );
        }
        world.step(1.0 / 60.0);
        for id in [low, high] {
            assert!(
                !world.body(id).expect("it stays").is_asleep(),
                "{id}, moved {moved}"
            );
        }
        run(&mut world, 4.0, |_| {});
        let (deepest, _) = overlaps(&world);
        assert!(deepest < 2e-3, "overlap {deepest:.1e} m, moved {moved}");
    }
}

/// dimforge/rapier#455: sharp hulls never rest.
#[test]
fn case_33_sharp_hulls_rest() {
    let mut world = stepped(restless(Settings::calm()));
    floor(&mut world, Material::default());
    let mut scale = 0.0;
    for i in 0..6 {
        let points = [(-1.0, 0.0), (1.0, 0.0), (0.2, 0.12 + 0.05 * f64::from(i))];
        let shard = ConvexPolygon::new(points.map(|(x, y)| vec2(x, y)).to_vec()).expect("a shard");
        let def = BodyDef::dynamic()
            .at(vec2(3.0 * f64::from(i) - 8.0, 0.5))
            .turned(0.3 * f64::from(i));
        let id = put(&mut world, def, shard, Material::default());
        scale += world.body(id).expect("it stays").mass() * G * 2.0;
    }
    run(&mut world, 10.0, |_| {});
    let kinetic = world.energy().kinetic;
    assert!(
        kinetic < 1e-6 * scale,
        "kinetic {kinetic:.1e} J of {scale:.1e}"
    );
}

/// godotengine/godot#72063, RandyGaul/qu3e#54: columns that creep.
#[test]
fn case_34_columns_stand_for_a_minute() {
    for (count, settings) in [
        (10, Settings::default()),
        (30, Settings::default()),
        (100, Settings::accurate()),
    ] {
        let mut world = stepped(restless(settings));
        floor(&mut world, Material::default());
        let boxes = column(&mut world, count, Material::default());
        let top = *boxes.last().expect("boxes");
        run(&mut world, 5.0, |_| {});
        let settled = world.body(top).expect("it stays").centre();
        let mut moved = 0.0_f64;
        run(&mut world, 60.0, |world| {
            let now = world.body(top).expect("it stays").centre();
            moved = moved.max((now - settled).length());
        });
        assert!(moved < 1e-4, "{count} boxes: the top moved {moved:.1e} m");
    }
}

/// avianphysics/avian#202, schteppe/p2.js#184, erincatto/box2d#508: bodies at one place.
#[test]
fn case_37_bodies_at_one_place_part() {
    for count in [2, 10, 100] {
        let mut world = stepped(weightless());
        for k in 0..count {
            let size = 0.2 + 0.1 * f64::from(k % 3);
            let shape = if k % 2 == 0 {
                Shape::from(block(size, size))
            } else {
                disc(size).into()
            };
            put(&mut world, BodyDef::dynamic(), shape, surface(0.0, 0.0));
        }
        world.step(0.0);
        let mut mass = 0.0;
        for body in world.bodies() {
            assert!(body.centre().is_finite());
            mass += body.mass();
        }
        let mut most = 0.0_f64;
        run(&mut world, 20.0, |world| {
            most = most.max(world.energy().kinetic);
            assert!(world.bodies().all(|body| body.centre().is_finite()));
        });
        // Push-out moves no body faster than 3 m/s against another, and leaves no more.
        assert!(most <= 0.5 * 9.0 * mass, "{count}: {most:.1e} J");
        let (deepest, _) = overlaps(&world);
        assert!(deepest < 5e-3, "{count}: overlap {deepest:.1e} m");
    }
}

/// `dimforge/bevy_rapier#115`, dimforge/rapier#326: NaN from the caller spreads.
#[test]
fn case_39_numbers_that_are_none_are_refused_and_change_nothing() {
    let mut world = stepped(Settings::default());
    floor(&mut world, Material::default());
    let id = boxed(&mut world, vec2(0.0, 0.6), Material::default());
    world.step(0.1);
    let hash = world.state_hash();
    let nan = f64::NAN;
    let said = [
        world.apply_force(id, Force::central(vec2(nan, 0.0))),
        world.apply(id, Impulse::at(vec2(0.0, nan), Vec2::X)),
        world.teleport(id, Pose::at(vec2(f64::INFINITY, 0.0))),
        world.set_velocity(id, vec2(0.0, nan), 0.0),
    ]
    .map(|answer| answer.expect_err("refused").to_string());
    assert!(
        said.iter().all(|text| text.contains("not a finite number")),
        "{said:?}"
    );
    assert_eq!(world.state_hash(), hash);
    assert!(world.step(nan).refused.is_some());
    assert_eq!(world.state_hash(), hash);
}

/// dimforge/rapier#868: other bits at a repeat.
#[test]
fn case_40_repeats_have_equal_bits_and_other_orders_the_same_laws() {
    let build = |order: &dyn Fn(usize) -> usize, spin: f64| {
        let mut world = stepped(Settings::default());
        floor(&mut world, Material::default());
        for k in 0..60 {
            let k = order(k);
            #[expect(clippy::cast_precision_loss, reason = "60 of them")]
            let at = vec2(0.9 * (k % 8) as f64 - 3.0, 0.6 + 1.1 * (k / 8) as f64);
            let side = if k.is_multiple_of(3) { 0.6 } else { 0.9 };
            put(
                &mut world,
                BodyDef::dynamic().at(at).spinning(spin),
                block(side, 0.8),
                Material::default(),
            );
        }
        run(&mut world, 10.0, |_| {});
        world
    };
    let repeat = build(&|k| k, 0.3).state_hash();
    // Which of eight columns topples is chance, and one that does takes a tenth of the height with it: so means are compared.
    let (mut heights, mut others) = (0.0, 0.0);
    for variant in 0..10 {
        let spin = 0.3 + 0.01 * f64::from(variant);
        let (first, other) = (build(&|k| k, spin), build(&|k| 59 - k, spin));
        assert!(variant > 0 || first.state_hash() == repeat);
        let (a, b) = (first.energy(), other.energy());
        heights += a.potential;
        others += b.potential;
        for world in [&first, &other] {
            assert!(overlaps(world).0 < 5e-3);
            // Columns jammed side by side do not hum.
            let kinetic = world.energy().kinetic;
            assert!(kinetic < 1e-3, "variant {variant}: {kinetic:.1e} J");
        }
    }
    assert!(
        (heights - others).abs() < 0.05 * heights,
        "{heights} J of ten piles, {others} J in other orders"
    );
}

/// slembcke/Chipmunk2D#161: normals of disc and polygon the wrong way.
#[test]
fn case_41_normals_point_from_a_to_b() {
    for disc_first in [true, false] {
        let mut world = stepped(Settings {
            gravity: vec2(-G, 0.0),
            ..Settings::default()
        });
        let at = [vec2(0.0, 0.0), vec2(0.99, 0.1)];
        let mut ids = Vec::new();
        for k in 0..2 {
            let kind = [BodyKind::Fixed, BodyKind::Dynamic][k];
            let def = BodyDef::new(kind).at(at[k]);
            ids.push(if (k == 0) == disc_first {
                put(&mut world, def, disc(0.5), Material::default())
            } else {
                put(&mut world, def, block(1.0, 1.0), Material::default())
            });
        }
        world.step(1.0 / 60.0);
        let contact = world.contacts().next().expect("they touch");
        assert_eq!([contact.a, contact.b], [ids[0], ids[1]]);
        assert!(contact.normal.x > 0.9, "{}", contact.normal);
        assert!(contact.points[0].separation < 1e-3);
    }
}

/// slembcke/Chipmunk2D#241: two rows, 30 boxes and 29 on their joints, fall asleep as one, and wake as one.
#[test]
fn case_41_chains_of_sleepers_end() {
    let mut world = stepped(Settings::default());
    floor(&mut world, Material::default());
    let row: Vec<_> = (0..30)
        .map(|i| {
            boxed(
                &mut world,
                vec2(f64::from(i) - 14.5, 0.5),
                Material::default(),
            )
        })
        .collect();
    for i in 0..29 {
        boxed(
            &mut world,
            vec2(f64::from(i) - 14.0, 1.5),
            Material::default(),
        );
    }
    run(&mut world, 5.0, |_| {});
    let asleep = world.bodies().filter(|body| body.is_asleep()).count();
    assert_eq!(asleep, 59);
    world
        .apply(row[0], Impulse::at(vec2(-14.5, 0.5), vec2(0.01, 0.0)))
        .expect("valid");
    world.step(1.0 / 60.0);
    let woken = world
        .events()
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Awake(_)));
    assert_eq!(
        woken.count() + world.bodies().filter(|b| b.is_asleep()).count(),
        59
    );
    run(&mut world, 3.0, |_| {});
    assert!(
        world
            .bodies()
            .filter(|body| body.kind() == BodyKind::Dynamic)
            .all(|body| body.is_asleep())
    );
}
