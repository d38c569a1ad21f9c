//! Laws of exact motion that hold for whatever strikes: momentum and energy, nothing missed, symmetry, order.

use carom_dynamics::{Body, BodyDef, EventKind, ImpactLaw, Material, PairSearch, Settings, World};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Rot, Vec2, trig, vec2};
use carom_tests::elastic;
use carom_tests::gas::{Molecule, Watch, deepest, gas, kinetic, numbers};
use carom_tests::scenes::put;
use proptest::prelude::*;

/// Discs, polygons to slivers of 1 : 1000, and stars, of 1 cm to 1 m.
fn shape() -> impl Strategy<Value = Shape> {
    let size = (-2.0..0.0_f64).prop_map(|x| trig::pow(10.0, x));
    (0..3_u8, size, 3..9_usize, -3.0..0.0_f64, any::<u64>()).prop_map(
        |(kind, size, corners, squeeze, seed)| {
            let mut next = numbers(seed);
            match kind {
                0 => Circle::new(size).expect("a disc").into(),
                1 => {
                    let round = ConvexPolygon::random(corners, size, &mut next);
                    let thin = trig::pow(10.0, squeeze);
                    let corners = round.expect("a polygon");
                    let corners = corners.vertices().iter().map(|v| vec2(v.x, v.y * thin));
                    ConvexPolygon::new(corners.collect::<Vec<Vec2>>())
                        .expect("squeezed it is convex")
                        .into()
                }
                _ => Polygon::random_star(corners + 1, 0.3 * size, size, &mut next)
                    .expect("a star")
                    .into(),
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn impacts_keep_momentum_and_gain_no_energy_in_any_law(
        (a, b) in (shape(), shape()),
        law in prop_oneof![Just(ImpactLaw::Stronge), Just(ImpactLaw::Poisson), Just(ImpactLaw::Newton)],
        (e, mu) in (prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64], prop_oneof![Just(0.0), 0.0..3.0_f64]),
        ratio in -12.0..12.0_f64,
        (aim, turn) in (-1.0..1.0_f64, (0.0..6.3_f64, 0.0..6.3_f64)),
        (speed, spins) in (0.1..30.0_f64, (-30.0..30.0_f64, -30.0..30.0_f64)),
    ) {
        let settings = Settings { gravity: Vec2::ZERO, sleep: None, impact_law: law, ..Settings::default() };
        let mut world = World::new(settings).expect("valid settings");
        let surface = Material { friction: mu, restitution: e, ..Material::default() };
        let [reach_a, reach_b] = [&a, &b].map(|s| s.reach_about(s.area_properties().expect("areas").centroid));
        let aside = 0.7 * aim * (reach_a + reach_b);
        let [from_a, from_b] = [&a, &b].map(|s| s.area_properties().expect("areas").centroid);
        // The centres of mass where they are meant to be, whatever the turn.
        let place = |centre: Vec2, turn: f64, own: Vec2| centre - Rot::from_angle(turn) * own;
        let start = vec2(-1.5 * (reach_a + reach_b), aside);
        let def = BodyDef::dynamic().at(place(start, turn.0, from_a)).turned(turn.0);
        world.insert(def.moving(vec2(speed, 0.1)).spinning(spins.0), a, surface).expect("valid");
        let heavy = Material { density: trig::pow(10.0, ratio), ..surface };
        let def = BodyDef::dynamic().at(place(Vec2::ZERO, turn.1, from_b)).turned(turn.1);
        world.insert(def.moving(vec2(0.2, 0.0)).spinning(spins.1), b, heavy).expect("valid");
        let mut watch = Watch::default();
        let mut before = kinetic(&world);
        for _ in 0..3 {
            watch.next(&mut world, 3.0);
            let mut events = world.events().iter();
            if watch.report.handed_over > 0 || events.any(|event| matches!(event.kind, EventKind::Begin { .. })) {
                break; // They stay in touch, and are not free any more.
            }
            let now = kinetic(&world);
            // Newton's law gains where friction turns the slip: there the ledger says how much.
            if law != ImpactLaw::Newton || mu == 0.0 {
                prop_assert!(now <= before * (1.0 + 1e-14), "gained {:e}", now / before - 1.0);
            }
            if e == 1.0 && mu == 0.0 {
                prop_assert!((now / before - 1.0).abs() < 1e-14, "lost {:e}", 1.0 - now / before);
            }
            before = now;
        }
        // A case of two that miss each other is no case.
        prop_assume!(watch.collisions > 0);
        let ledger = world.energy();
        prop_assert!(ledger.residual().abs() <= 1e-13 * ledger.external, "{ledger:?}");
        prop_assert!(watch.linear < 1e-15, "momentum {:e}", watch.linear);
        prop_assert!(watch.angular < 4e-15, "turning {:e}", watch.angular);
    }
}

#[test]
fn no_impact_is_missed_that_dense_samples_find() {
    // No body is faster than its size in 20 samples: one that passed through another would be seen inside.
    for (molecule, friction) in [
        (Molecule::Disc, 0.0),
        (Molecule::Box, 0.4),
        (Molecule::Polygon, 0.0),
        (Molecule::Polygon, 0.4),
    ] {
        let mut world = rough_gas(molecule, friction);
        let mut impacts = 0;
        for sample in 0..10_000 {
            impacts += world.step(1e-3).impacts;
            let deep = deepest(&world);
            assert!(
                deep < 1e-12,
                "{molecule:?}: {deep:e} of a size at sample {sample}"
            );
        }
        assert!(impacts > 100, "{molecule:?}: {impacts}");
    }
}

/// Sixteen bodies that give everything back, with friction.
fn rough_gas(molecule: Molecule, friction: f64) -> World {
    let smooth = gas(molecule, 4, 3);
    let mut world = World::new(*smooth.settings()).expect("valid settings");
    for body in smooth.bodies() {
        let (shape, material) = body.shapes().next().expect("it has a shape");
        let material = Material {
            friction,
            ..*material
        };
        put(&mut world, again(&body), shape.clone(), material);
    }
    world
}

/// What a gas's body was made from, without its tag.
fn again(body: &Body<'_>) -> BodyDef {
    let def = if body.mass().is_finite() {
        BodyDef::dynamic()
            .moving(body.velocity())
            .spinning(body.angular_velocity())
    } else {
        BodyDef::fixed()
    };
    def.at(body.pose().position).turned(body.angle())
}

/// A gas with its bodies in another order, found in another way.
fn reordered(molecule: Molecule, search: PairSearch, order: impl Fn(usize) -> usize) -> World {
    let model = gas(molecule, 5, 11);
    let settings = Settings {
        pair_search: search,
        ..*model.settings()
    };
    let mut world = World::new(settings).expect("valid settings");
    let bodies: Vec<_> = model.bodies().collect();
    for k in 0..bodies.len() {
        let body = &bodies[order(k)];
        let (shape, material) = body.shapes().next().expect("it has a shape");
        // Tag 0 is a wall.
        let tag = if body.mass().is_finite() {
            1 + body.tag()
        } else {
            0
        };
        put(
            &mut world,
            again(body).tagged(tag),
            shape.clone(),
            *material,
        );
    }
    world
}

/// Centres, angles and velocities by tag.
fn states(world: &World) -> Vec<(u64, [f64; 7])> {
    let mut all: Vec<(u64, [f64; 7])> = world
        .bodies()
        .filter(|body| body.tag() > 0)
        .map(|body| {
            let (c, v, r) = (body.centre(), body.velocity(), body.pose().rotation);
            let state = [
                c.x,
                c.y,
                v.x,
                v.y,
                body.angular_velocity(),
                r.cos(),
                r.sin(),
            ];
            (body.tag(), state)
        })
        .collect();
    all.sort_by_key(|(tag, _)| *tag);
    all
}

#[test]
fn the_order_of_insertion_changes_no_bit_of_a_gas() {
    for molecule in [Molecule::Disc, Molecule::Box, Molecule::Polygon] {
        let mut forth = reordered(molecule, PairSearch::Indexed, |k| k);
        let mut back = reordered(molecule, PairSearch::Indexed, |k| 28 - k);
        let mut mixed = reordered(molecule, PairSearch::Indexed, |k| k * 12 % 29);
        let mut slow = reordered(molecule, PairSearch::AllPairs, |k| k * 7 % 29);
        for second in 1..=10 {
            let reports =
                [&mut forth, &mut back, &mut mixed, &mut slow].map(|world| world.step(1.0));
            assert!(reports[0].impacts > 10);
            for world in [&back, &mixed, &slow] {
                assert_eq!(
                    states(world),
                    states(&forth),
                    "{molecule:?} after {second} s"
                );
            }
        }
    }
}

/// Bodies and their mirror images about x = 0, and some that are their own.
fn mirrored(molecule: Molecule, seed: u64) -> World {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        sleep: None,
        ..Settings::default()
    })
    .expect("valid settings");
    let mut next = numbers(seed);
    let mut tag = 0;
    for row in 0..4_u32 {
        for column in 0..3_u32 {
            let at = vec2(0.7 + f64::from(column), f64::from(row) - 1.5);
            let (w, h, radius) = (0.3 + 0.3 * next(), 0.2 + 0.3 * next(), 0.2 + 0.2 * next());
            let velocity = (vec2(next(), next()) - 0.5) * 4.0;
            let (angle, spin) = (3.0 * next(), 4.0 * (next() - 0.5));
            for side in [1.0, -1.0] {
                tag += 1;
                let def = BodyDef::dynamic()
                    .at(at * vec2(side, 1.0))
                    .moving(velocity * vec2(side, 1.0))
                    .turned(angle * side)
                    .spinning(spin * side)
                    .tagged(tag);
                let shape: Shape = match molecule {
                    Molecule::Disc => Circle::new(radius).expect("a disc").into(),
                    _ => ConvexPolygon::rectangle(w, h).expect("a box").into(),
                };
                world.insert(def, shape, elastic()).expect("valid");
            }
        }
    }
    // On the axis: struck from both sides at once. Boxes fill it, so that no corner meets its own image:
    // two corners that meet have no normal, and take one of an edge.
    for row in 0..4_u32 {
        tag += 1;
        let def = BodyDef::dynamic()
            .at(vec2(0.0, f64::from(row) - 1.5))
            .tagged(1000 + tag);
        let heavy = Material {
            density: 3.0,
            ..elastic()
        };
        let shape: Shape = match molecule {
            Molecule::Disc => Circle::new(0.25).expect("a disc").into(),
            _ => ConvexPolygon::rectangle(0.4, 0.98).expect("a box").into(),
        };
        world.insert(def, shape, heavy).expect("valid");
    }
    for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let wall = ConvexPolygon::rectangle(
            if y == 0.0 { 1.0 } else { 10.0 },
            if x == 0.0 { 1.0 } else { 10.0 },
        );
        let at = vec2(x * 4.0, y * 2.5);
        let wall = wall.expect("a wall");
        world
            .insert(BodyDef::fixed().at(at), wall, elastic())
            .expect("valid");
    }
    world
}

#[test]
fn a_mirrored_scene_stays_its_own_mirror_image() {
    for molecule in [Molecule::Disc, Molecule::Box] {
        for seed in 0..10 {
            let mut world = mirrored(molecule, seed);
            let mut impacts = 0;
            for sample in 0..60 {
                if impacts > 40 {
                    break; // From here on roundings have grown.
                }
                impacts += world.step(1.0 / 60.0).impacts;
                let all = states(&world);
                let mut worst = 0.0_f64;
                for pair in all
                    .iter()
                    .filter(|(tag, _)| *tag < 1000)
                    .collect::<Vec<_>>()
                    .chunks(2)
                {
                    let (one, two) = (pair[0].1, pair[1].1);
                    let off = [
                        one[0] + two[0],
                        one[1] - two[1],
                        one[2] + two[2],
                        one[3] - two[3],
                        one[4] + two[4],
                    ];
                    worst = off.iter().fold(worst, |worst, x| worst.max(x.abs()));
                }
                for (_, own) in all.iter().filter(|(tag, _)| *tag > 1000) {
                    worst = worst.max(own[0].abs()).max(own[2].abs()).max(own[4].abs());
                }
                assert!(
                    worst < 1e-9,
                    "{molecule:?} {seed}: off by {worst:e} after {sample}/60 s and {impacts} impacts"
                );
            }
        }
    }
}
