//! Overlaps and energies by hand, and the grid against all pairs.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use super::overlap::Overlaps;
use super::solid::place;
use super::{Quality, Snapshot, Unrest};
use crate::engine::{Body, Counters, Engine, State};

/// A scene of one material, and a state for each body.
struct Table {
    scene: PlainScene,
    states: Vec<State>,
    masses: Vec<Body>,
}

impl Table {
    fn new() -> Self {
        let mut scene = PlainScene::empty("table", vec2(0.0, -10.0));
        scene.material(1.0, 0.5, 0.0);
        Self {
            scene,
            states: Vec::new(),
            masses: Vec::new(),
        }
    }

    fn put(mut self, kind: PlainKind, shape: PlainShape, position: Vec2, angle: f64) -> Self {
        self.scene.add(PlainBody::new(kind, position, 0), shape);
        self.states.push(State {
            position,
            angle,
            ..State::default()
        });
        self.masses.push(Body {
            mass: 1.0,
            inertia: 1.0,
        });
        self
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot {
            states: self.states.clone(),
            masses: self.masses.clone(),
        }
    }

    fn assess(&self) -> Quality {
        self.snapshot().assess(&self.scene)
    }
}

const DYNAMIC: PlainKind = PlainKind::Dynamic;
const SQUARE: PlainShape = PlainShape::rectangle(0.5, 0.5);
const DISC: PlainShape = PlainShape::Circle { radius: 0.5 };

/// The overlap of two dynamic bodies of which the first lies at the origin, unturned.
fn depth(a: PlainShape, b: PlainShape, position: Vec2, angle: f64) -> f64 {
    let table = Table::new()
        .put(DYNAMIC, a, Vec2::ZERO, 0.0)
        .put(DYNAMIC, b, position, angle);
    table.assess().overlap_max
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-14,
        "{found:e}, expected {expected:e}"
    );
}

#[test]
fn boxes_overlap_along_their_best_axis() {
    assert_near(depth(SQUARE, SQUARE, vec2(0.9, 0.4), 0.0), 0.1);
    assert_near(depth(SQUARE, SQUARE, vec2(0.4, -0.75), 0.0), 0.25);
    // A square on its tip reaches 1/√2 down: its corner is that much, less 0.6, below an edge half a metre up.
    let turned = std::f64::consts::FRAC_PI_4;
    let tip = depth(SQUARE, SQUARE, vec2(0.1, 1.1), turned);
    assert_near(tip, std::f64::consts::FRAC_1_SQRT_2 - 0.6);
    assert_near(depth(SQUARE, SQUARE, vec2(1.0, 0.0), 0.0), 0.0);
    assert_near(depth(SQUARE, SQUARE, vec2(1.2, 0.0), 0.0), 0.0);
}

#[test]
fn discs_overlap_by_what_their_distance_falls_short_of_the_radii() {
    assert_near(depth(DISC, DISC, vec2(0.3, 0.4), 1.0), 0.5);
    assert_near(depth(DISC, DISC, vec2(0.6, 0.8), 1.0), 0.0);
}

#[test]
fn a_disc_overlaps_a_polygon_at_a_face_at_a_corner_and_from_inside() {
    assert_near(depth(SQUARE, DISC, vec2(0.9, 0.1), 0.0), 0.1);
    // The corner (0.5, 0.5) is 3-4-5: 0.3 left of and 0.4 below the centre, outside both faces.
    let small = PlainShape::Circle { radius: 0.6 };
    assert_near(depth(SQUARE, small, vec2(0.8, 0.9), 0.0), 0.1);
    assert_near(depth(SQUARE, DISC, vec2(0.8, 0.9), 0.0), 0.0);
    // Inside: 0.2 below the upper face, and the whole radius besides.
    assert_near(depth(SQUARE, DISC, vec2(0.1, 0.3), 0.0), 0.7);
    assert_near(depth(DISC, SQUARE, vec2(0.1, 0.3), 0.0), 0.7);
}

#[test]
fn a_box_off_its_bodys_origin_turns_about_the_origin() {
    let arm = PlainShape::Box {
        half: vec2(0.5, 0.1),
        offset: vec2(1.0, 0.0),
    };
    // Turned by a right angle it stands at (0, 1), from 0.5 to 1.5: 0.05 into the square under it.
    let found = depth(SQUARE, arm, vec2(0.0, -0.05), std::f64::consts::FRAC_PI_2);
    assert_near(found, 0.05);
}

#[test]
fn pieces_count_one_by_one_and_never_against_their_own_body() {
    let mut table = Table::new().put(DYNAMIC, SQUARE, Vec2::ZERO, 0.0);
    let twin = table.scene.shape(SQUARE);
    table.scene.bodies[0].shapes.push(twin);
    let table = table.put(DYNAMIC, SQUARE, vec2(0.75, 0.0), 0.0);
    let verdict = table.assess();
    assert_eq!(verdict.overlap_pairs, 2);
    assert_near(verdict.overlap_mean, 0.25);
}

#[test]
fn overlaps_of_two_immovable_bodies_do_not_count() {
    let table = Table::new()
        .put(PlainKind::Fixed, SQUARE, Vec2::ZERO, 0.0)
        .put(PlainKind::Kinematic, SQUARE, vec2(0.5, 0.0), 0.0);
    assert_eq!(table.assess().overlap_pairs, 0);
    let table = table.put(DYNAMIC, SQUARE, vec2(0.25, 0.9), 0.0);
    assert_eq!(table.assess().overlap_pairs, 2);
}

#[test]
fn segments_are_left_out() {
    let wall = PlainShape::Segment([vec2(-1.0, 0.0), vec2(1.0, 0.0)]);
    assert_near(depth(SQUARE, wall, Vec2::ZERO, 0.0), 0.0);
}

#[test]
fn the_grid_finds_the_pairs_that_a_look_at_all_of_them_finds() {
    let mut random = Random(7);
    for round in 0..40 {
        let spread = 3.0 + f64::from(round);
        let mut table = Table::new();
        for i in 0..120 {
            let position = vec2(random.within(spread), random.within(spread));
            let size = 0.1 + random.within(1.0).abs();
            let shape = match i % 4 {
                0 => PlainShape::Circle { radius: size },
                1 => PlainShape::rectangle(size, 0.3),
                // Far larger than the rest: some of them leave the grid.
                2 if i % 24 == 2 => PlainShape::rectangle(40.0 * size, 0.2),
                _ => PlainShape::Polygon(vec![
                    vec2(-size, -size),
                    vec2(size, -0.5 * size),
                    vec2(0.0, size),
                ]),
            };
            table = table.put(DYNAMIC, shape, position, random.within(4.0));
        }
        let solids = place(&table.scene, &table.states);
        let mut all = Overlaps::default();
        for (i, a) in solids.iter().enumerate() {
            for b in &solids[i + 1..] {
                all.add(a, b);
            }
        }
        let found = Overlaps::of(&table.scene, &table.states);
        assert!(all.pairs() > 0, "round {round} tests nothing");
        assert_eq!(found.pairs(), all.pairs(), "round {round}");
        assert_near(found.deepest(), all.deepest());
        assert!((found.mean() - all.mean()).abs() < 1e-12, "round {round}");
    }
}

#[test]
fn energy_and_momenta_are_those_of_the_textbook() {
    let mut table = Table::new().put(DYNAMIC, SQUARE, vec2(2.0, 3.0), 0.0).put(
        PlainKind::Fixed,
        SQUARE,
        vec2(9.0, 9.0),
        0.0,
    );
    table.states[0].velocity = vec2(4.0, 1.0);
    table.states[0].spin = 5.0;
    table.masses[0] = Body {
        mass: 2.0,
        inertia: 0.5,
    };
    let verdict = table.assess();
    // 2 (16 + 1)/2 + 0.5·25/2 + 2·10·3
    assert_near(verdict.energy, 17.0 + 6.25 + 60.0);
    assert_near(verdict.momentum[0], 8.0);
    assert_near(verdict.momentum[1], 2.0);
    // 2 (2·1 − 3·4) + 0.5·5
    assert_near(verdict.angular_momentum, -20.0 + 2.5);
    assert_near(verdict.highest, 3.0);
}

#[test]
fn escaped_and_non_finite_bodies_are_counted() {
    let mut table = Table::new()
        .put(DYNAMIC, SQUARE, vec2(0.0, 0.0), 0.0)
        .put(DYNAMIC, SQUARE, vec2(5.0, 0.0), 0.0)
        .put(DYNAMIC, SQUARE, vec2(f64::NAN, 0.0), 0.0);
    table.scene.region = Some([vec2(-5.0, -5.0), vec2(5.0, 5.0)]);
    let verdict = table.assess();
    assert_eq!((verdict.escaped, verdict.non_finite), (1, 1));
    assert!(verdict.energy.is_finite());
    table.states[0].velocity.x = 1e200;
    assert_eq!(table.assess().non_finite, 2);
}

#[test]
fn drift_is_the_farthest_move_of_a_centre() {
    let table = Table::new()
        .put(DYNAMIC, SQUARE, Vec2::ZERO, 0.0)
        .put(DYNAMIC, SQUARE, vec2(5.0, 0.0), 0.0)
        .put(PlainKind::Kinematic, SQUARE, vec2(9.0, 0.0), 0.0);
    let mut later = table.snapshot();
    later.states[0].position = vec2(0.3, 0.4);
    later.states[1].position = vec2(5.0, 0.1);
    later.states[2].position = vec2(0.0, 0.0);
    assert_near(table.snapshot().drift(&later, &table.scene), 0.5);
}

/// One body, with the number of its steps as velocity and spin.
struct Accelerating(f64);

impl Engine for Accelerating {
    fn step(&mut self) {
        self.0 += 1.0;
    }

    fn state(&self, _: usize) -> State {
        State {
            velocity: vec2(3.0 * self.0, 0.0),
            spin: 2.0 * self.0,
            ..State::default()
        }
    }

    fn body(&self, _: usize) -> Body {
        Body {
            mass: 1.0,
            inertia: 4.0,
        }
    }

    fn read_poses(&mut self) -> f64 {
        self.0
    }

    fn counters(&self) -> Counters {
        Counters::default()
    }

    fn settings(&self) -> String {
        String::new()
    }
}

#[test]
fn unrest_weighs_spin_with_the_radius_of_gyration() {
    let table = Table::new().put(DYNAMIC, SQUARE, Vec2::ZERO, 0.0);
    let mut engine = Accelerating(0.0);
    let mut unrest = Unrest::new(&table.scene, &engine);
    for _ in 0..3 {
        engine.step();
        unrest.add(&engine, 0.5);
    }
    // Each step: Δv = 3, Δω = 2, k = 2: √(3² + 4²) / 0.5.
    assert_near(unrest.rms(), 10.0);
}

struct Random(u64);

impl Random {
    /// Between −`half` and `half`.
    fn within(&mut self, half: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let unit = f64::from(u32::try_from((z ^ (z >> 31)) >> 32).expect("32 bits"));
        half * (2.0 * unit / f64::from(u32::MAX) - 1.0)
    }
}
