//! Large islands in hybrid mode: the stepped engine moves them, free bodies and callers meet them.

use carom_dynamics::{
    BodyDef, BodyId, BodyKind, EventKind, Force, Impulse, Material, Mode, PairMaterial, Settings,
    Sleep, World,
};
use carom_math::{Pose, Rot, Vec2, vec2};
use carom_tests::scenes::{block, disc, put};
use carom_tests::{overlaps, run};

fn stone() -> Material {
    Material {
        density: 1.0,
        friction: 0.5,
        restitution: 0.0,
        ..Material::default()
    }
}

fn world(settings: Settings) -> World {
    World::new(settings).expect("valid settings")
}

fn awake() -> Settings {
    Settings {
        sleep: None,
        ..Settings::default()
    }
}

fn floor(world: &mut World) -> BodyId {
    let def = BodyDef::fixed().at(vec2(0.0, -1.0));
    put(world, def, block(60.0, 2.0), stone())
}

fn boxed(world: &mut World, def: BodyDef) -> BodyId {
    put(world, def, block(1.0, 1.0), stone())
}

/// Rows of boxes that touch, the lowest on y = 0.
fn wall(world: &mut World, columns: u32, rows: u32) -> Vec<BodyId> {
    let mut boxes = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let at = vec2(
                f64::from(column) - 0.5 * f64::from(columns),
                f64::from(row) + 0.5,
            );
            boxes.push(boxed(world, BodyDef::dynamic().at(at)));
        }
    }
    boxes
}

/// The balance of the energy, as a part of what there is.
fn balance(world: &World) -> f64 {
    let energy = world.energy();
    let all = energy.kinetic + energy.potential.abs() + energy.external.abs();
    energy.residual().abs() / all
}

#[test]
fn a_pile_that_falls_together_rests_and_its_books_balance() {
    let mut world = world(Settings::default());
    floor(&mut world);
    for k in 0..90 {
        let (row, column) = (k / 9, k % 9);
        let shift = if row % 2 == 0 { 0.0 } else { 0.45 };
        let at = vec2(
            1.1 * f64::from(column) - 4.0 + shift,
            1.0 + 1.3 * f64::from(row),
        );
        boxed(
            &mut world,
            BodyDef::dynamic().at(at).turned(0.1 * f64::from(k % 7)),
        );
    }
    let (mut worst, mut most) = (0.0_f64, 0);
    let start = world.energy().mechanical();
    run(&mut world, 20.0, |world| {
        worst = worst.max(balance(world));
        most = most.max(world.contacts().count());
    });
    assert!(most > 100, "{most} contacts: no large island");
    assert!(worst < 1e-12, "the ledger is open by {worst:.1e}");
    assert!(world.energy().mechanical() < start);
    let restless = world
        .bodies()
        .filter(|body| body.kind() == BodyKind::Dynamic && !body.is_asleep());
    assert_eq!(restless.count(), 0, "bodies that do not sleep");
    let (deepest, _) = overlaps(&world);
    assert!(deepest < 0.01, "overlap {deepest:.1e} m");
}

#[test]
fn how_time_is_cut_does_not_matter_to_a_large_island() {
    let hash = |cuts: u32| {
        let mut world = world(awake());
        floor(&mut world);
        wall(&mut world, 8, 5);
        let thrown = BodyDef::dynamic()
            .at(vec2(-12.0, 6.0))
            .moving(vec2(9.0, 0.0));
        put(&mut world, thrown, disc(0.4), stone());
        for _ in 0..128 * cuts {
            world.step(1.0 / (64.0 * f64::from(cuts)));
        }
        world.state_hash()
    };
    // None of these steps is a whole number of sub-steps.
    let whole = hash(1);
    assert_eq!(hash(2), whole, "halves");
    assert_eq!(hash(8), whole, "eighths");
}

#[test]
fn a_blow_on_a_sleeping_island_keeps_momentum_and_adds_no_energy() {
    let mut world = world(Settings {
        gravity: Vec2::ZERO,
        // A body that falls asleep loses what little momentum it had.
        sleep: Some(Sleep {
            time: 10.0,
            ..Sleep::default()
        }),
        ..Settings::default()
    });
    for row in 0..10 {
        for column in 0..10 {
            let at = vec2(f64::from(column), f64::from(row) - 4.3);
            boxed(&mut world, BodyDef::dynamic().at(at).asleep());
        }
    }
    let def = BodyDef::dynamic()
        .at(vec2(-20.0, 0.1))
        .moving(vec2(60.0, 0.0));
    put(&mut world, def, block(3.0, 2.0), stone());
    let before = (world.momentum(), world.energy().kinetic);
    run(&mut world, 3.0, |world| {
        let now = world.energy().kinetic;
        assert!(now <= before.1, "{} J became {now} J", before.1);
        assert!(
            balance(world) < 1e-12,
            "the ledger is open by {:.1e}",
            balance(world)
        );
    });
    let after = world.momentum();
    let linear = (after.linear - before.0.linear).length() / before.0.linear.length();
    assert!(linear < 1e-12, "momentum changed by {linear:.1e}");
    assert!(
        world.energy().kinetic < 0.5 * before.1,
        "nothing was struck"
    );
}

#[test]
fn a_ball_bounces_off_a_large_island_by_its_restitution() {
    let mut world = world(awake());
    floor(&mut world);
    let boxes = wall(&mut world, 24, 1);
    let top: Vec<BodyId> = (0..23)
        .map(|k| {
            boxed(
                &mut world,
                BodyDef::dynamic().at(vec2(f64::from(k) - 11.5, 1.5)),
            )
        })
        .collect();
    run(&mut world, 1.0, |_| {});
    let def = BodyDef::dynamic().at(vec2(-0.5, 4.1));
    let ball = put(&mut world, def, disc(0.1), stone());
    let bouncy = PairMaterial {
        restitution: 0.8,
        ..PairMaterial::default()
    };
    for other in boxes.iter().chain(&top) {
        world
            .set_pair_material(ball, *other, bouncy)
            .expect("valid");
    }
    // It falls by 2 m, strikes, and rises by e² of that; the box gives way by its own mass at most.
    let mut apex = 0.0_f64;
    run(&mut world, 1.5, |world| {
        let body = world.body(ball).expect("it is there");
        if world.time().as_secs() > 1.7 {
            apex = apex.max(body.centre().y);
        }
    });
    let rise = (apex - 2.1) / 2.0;
    assert!(
        (0.5..0.65).contains(&rise),
        "{rise} of the fall, e² is 0.64"
    );
}

#[test]
fn a_drum_puts_in_what_its_boxes_get() {
    let mut world = world(Settings::default());
    let bar = |half: Vec2, at: Vec2| block(2.0 * half.x, 2.0 * half.y).translated(at);
    let walls = [
        bar(vec2(0.5, 7.0), vec2(7.0, 0.0)),
        bar(vec2(0.5, 7.0), vec2(-7.0, 0.0)),
        bar(vec2(7.0, 0.5), vec2(0.0, 7.0)),
        bar(vec2(7.0, 0.5), vec2(0.0, -7.0)),
    ];
    let drum = BodyDef::kinematic().spinning(0.6);
    let shapes = walls.map(|wall| (wall.into(), stone())).to_vec();
    world.insert_compound(drum, shapes).expect("valid");
    for k in 0..81 {
        let at = vec2(f64::from(k % 9) * 1.02 - 4.1, f64::from(k / 9) * 1.02 - 5.0);
        boxed(&mut world, BodyDef::dynamic().at(at));
    }
    let mut worst = 0.0_f64;
    let inserted = world.energy().external;
    run(&mut world, 12.0, |world| worst = worst.max(balance(world)));
    assert!(worst < 1e-12, "the ledger is open by {worst:.1e}");
    let energy = world.energy();
    // Boxes are lifted again and again; what they lose is what the drum put in.
    assert!(
        energy.external - inserted > 100.0,
        "the drum put in {} J",
        energy.external - inserted
    );
    assert!(energy.friction > 10.0, "{energy:?}");
    let out = world.bodies().filter(|body| body.centre().length() > 10.0);
    assert_eq!(out.count(), 0, "bodies that left the drum");
}

#[test]
fn a_caller_may_change_members_of_a_large_island() {
    let mut world = world(Settings::default());
    floor(&mut world);
    let boxes = wall(&mut world, 10, 4);
    run(&mut world, 0.3, |_| {});
    let check = |world: &World, what: &str| {
        assert!(
            balance(world) < 1e-12,
            "{what}: open by {:.1e}",
            balance(world)
        );
        let lost = world.bodies().filter(|body| !body.centre().is_finite());
        assert_eq!(lost.count(), 0, "{what}");
    };
    world.remove(boxes[15]).expect("it is there");
    check(&world, "removed");
    run(&mut world, 0.1, |world| check(world, "after a removal"));
    world
        .teleport(boxes[35], Pose::new(vec2(0.0, 9.0), Rot::from_angle(0.3)))
        .expect("it is there");
    check(&world, "put elsewhere");
    run(&mut world, 0.1, |world| {
        check(world, "after it was put elsewhere");
    });
    world
        .set_velocity(boxes[30], vec2(-6.0, 2.0), 3.0)
        .expect("it is there");
    world
        .apply(boxes[31], Impulse::at(vec2(-2.0, 3.5), vec2(2.0, 5.0)))
        .expect("it is there");
    check(&world, "struck");
    for _ in 0..30 {
        world
            .apply_force(boxes[32], Force::at(vec2(-1.0, 3.5), vec2(40.0, 0.0)))
            .expect("it is there");
        world.step(1.0 / 60.0);
        check(&world, "pushed");
    }
    assert!(world.energy().forces.abs() > 1.0, "{:?}", world.energy());
    for kind in [BodyKind::Fixed, BodyKind::Kinematic, BodyKind::Dynamic] {
        world.set_kind(boxes[2], kind).expect("it is there");
        check(&world, "of another kind");
        run(&mut world, 0.2, |world| {
            check(world, "after it changed its kind");
        });
    }
    let centre = world.body(boxes[1]).expect("it is there").centre();
    boxed(&mut world, BodyDef::dynamic().at(centre + vec2(0.0, 3.0)));
    run(&mut world, 10.0, |world| check(world, "to the end"));
    // Columns that are jammed hum.
    let fastest = world.bodies().map(|body| body.velocity().length());
    let fastest = fastest.fold(0.0, f64::max);
    assert!(fastest < 0.1, "{fastest} m/s after ten seconds");
    let (deepest, _) = overlaps(&world);
    assert!(deepest < 0.01, "overlap {deepest:.1e} m");
}

#[test]
fn a_few_bodies_are_no_large_island() {
    let mut world = world(awake());
    floor(&mut world);
    wall(&mut world, 1, 9);
    let mut handed = 0;
    for _ in 0..60 {
        handed += world.step(1.0 / 60.0).handed_over;
    }
    assert_eq!(handed, 0, "nine boxes at rest are held in closed form");
    for body in world
        .bodies()
        .filter(|body| body.kind() == BodyKind::Dynamic)
    {
        assert_eq!(body.velocity(), Vec2::ZERO);
    }
}

/// Impacts of a step: when, which bodies, speed and impulse.
fn impacts(world: &World) -> Vec<(f64, [BodyId; 2], f64, f64)> {
    let told = world
        .events()
        .into_iter()
        .filter_map(|event| match event.kind {
            EventKind::Impact {
                a,
                b,
                speed,
                normal_impulse,
                ..
            } => Some((event.time.as_secs(), [a, b], speed, normal_impulse)),
            _ => None,
        });
    told.collect()
}

/// A ball that falls onto a pile of many: one impact with what it meets, when it meets it, and the others' as the blow goes on.
#[test]
fn a_blow_on_a_large_island_is_an_impact() {
    for mode in [Mode::Hybrid, Mode::Stepped] {
        let mut world = world(Settings { mode, ..awake() });
        floor(&mut world);
        let boxes = wall(&mut world, 8, 5);
        run(&mut world, 1.0, |_| {});
        let start = world.time().as_secs();
        let top = world.body(boxes[36]).expect("a box").centre();
        let def = BodyDef::dynamic().at(top + vec2(0.0, 0.5 + 0.3 + 2.0));
        let ball = put(&mut world, def, disc(0.3), stone());
        let mut told = Vec::new();
        for _ in 0..60 {
            world.step(1.0 / 60.0);
            told.extend(impacts(&world));
        }
        let (speed, time) = ((2.0f64 * 9.81 * 2.0).sqrt(), (2.0f64 * 2.0 / 9.81).sqrt());
        let first = told.iter().find(|(_, ends, ..)| ends.contains(&ball));
        let (when, _, met, impulse) = first.expect("the blow is told");
        assert!(
            (met - speed).abs() < 0.01 * speed,
            "{mode:?}: {met} m/s, not {speed}"
        );
        assert!(
            (when - start - time).abs() < 1.0 / 360.0,
            "{mode:?}: {when} s"
        );
        let mass = world.body(ball).expect("the ball").mass();
        assert!(
            *impulse > 0.4 * mass * speed && *impulse < 2.5 * mass * speed,
            "{mode:?}: {impulse} N s"
        );
        // What rests tells of nothing.
        run(&mut world, 2.0, |_| {});
        for _ in 0..20 {
            world.step(1.0 / 60.0);
            assert_eq!(impacts(&world), [], "{mode:?}");
        }
    }
}

/// Impacts are told in order of time, whatever pieces time is cut into, and the same ones.
#[test]
fn impacts_of_a_large_island_do_not_depend_on_the_steps() {
    for mode in [Mode::Hybrid, Mode::Stepped] {
        let run = |cuts: &[f64]| {
            let mut world = world(Settings { mode, ..awake() });
            floor(&mut world);
            for k in 0..40 {
                let at = vec2(
                    1.1 * f64::from(k % 5) + 0.1 * f64::from(k / 5),
                    1.0 + 1.3 * f64::from(k / 5),
                );
                boxed(&mut world, BodyDef::dynamic().at(at));
            }
            let (mut told, mut last, mut k) = (Vec::new(), 0.0, 0);
            while world.time().as_secs() < 2.9 {
                world.step(cuts[k % cuts.len()]);
                k += 1;
                for event in &world.events().into_iter().collect::<Vec<_>>() {
                    let time = event.time.as_secs();
                    assert!(
                        last <= time && event.time <= world.time(),
                        "{mode:?}: {event:?} after {last} s"
                    );
                    last = time;
                }
                told.extend(impacts(&world));
            }
            world.step((3.0 - world.time().as_secs()).max(0.0));
            told.extend(impacts(&world));
            let key = |(_, ends, speed, impulse): (f64, [BodyId; 2], f64, f64)| {
                (
                    ends.map(|id| format!("{id:?}")),
                    speed.to_bits(),
                    impulse.to_bits(),
                )
            };
            let mut told: Vec<_> = told.into_iter().map(key).collect();
            told.sort();
            told
        };
        let whole = run(&[1.0 / 60.0]);
        assert!(whole.len() > 40, "{mode:?}: {}", whole.len());
        assert_eq!(whole, run(&[0.0071, 0.0013, 0.04]), "{mode:?}");
    }
}
