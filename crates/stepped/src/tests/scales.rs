//! Small, far, many-cornered and driven: piles behave as those of metres at the origin do.

use carom_geometry::{ConvexPolygon, Polygon, Segment};
use carom_math::{Rot, Vec2, vec2};

use super::{Random, floor, unit_box};
use crate::{BodyId, BodyInput, Engine, Mixed, PieceInput, Settings};

/// A pyramid of ten rows of boxes of `size` metres at `corner`: the most that a box moved by in 2 s, in sizes.
fn pyramid_moves(size: f64, corner: Vec2) -> f64 {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let ground = PieceInput::new(ConvexPolygon::rectangle(100.0 * size, size).unwrap());
    let at = corner - vec2(0.0, 0.5 * size);
    engine.insert(BodyInput::fixed().at(at), &[ground]).unwrap();
    let square = PieceInput::new(ConvexPolygon::square(size).unwrap());
    let mut ids: Vec<(BodyId, Vec2)> = Vec::new();
    for row in 0..10 {
        for k in 0..10 - row {
            let at = vec2(f64::from(k) + 0.5 * f64::from(row), 0.5 + f64::from(row));
            let mass = size * size;
            let body = BodyInput::dynamic(mass, mass * size * size / 6.0).at(corner + at * size);
            ids.push((
                engine.insert(body, core::slice::from_ref(&square)).unwrap(),
                corner + at * size,
            ));
        }
    }
    for _ in 0..120 {
        engine.tick();
    }
    let moves = ids
        .iter()
        .map(|(id, at)| (engine.pose(*id).unwrap().position - *at).length());
    moves.fold(0.0, f64::max) / size
}

#[test]
fn millimetres_and_a_thousand_kilometres_are_as_metres() {
    let metres = pyramid_moves(1.0, Vec2::ZERO);
    assert!(metres < 0.01, "{metres}");
    let far = pyramid_moves(1.0, vec2(1e6, -1e6));
    assert!((far - metres).abs() < 1e-3, "{far} and {metres}");
    // Softness is told by frequency: a small box sinks in by as many metres as a large one, so by more of its size.
    let small = pyramid_moves(0.1, Vec2::ZERO);
    assert!(small < 0.1, "{small}");
}

/// A concave body is its pieces; it lies on its feet, and its cuts are not touched.
#[test]
fn an_arch_stands_on_its_feet() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let corners = [
        (-2.0, -1.0),
        (-1.0, -1.0),
        (-1.0, 0.5),
        (1.0, 0.5),
        (1.0, -1.0),
        (2.0, -1.0),
        (2.0, 1.0),
        (-2.0, 1.0),
    ];
    let shape = Polygon::new(corners.map(|(x, y)| vec2(x, y))).unwrap();
    let area = shape.area_properties().with_density(1.0);
    let centred = PieceInput::new(shape.translated(-area.centroid));
    let body =
        BodyInput::dynamic(area.mass, area.inertia).at(vec2(0.0, 1.0 + area.centroid.y + 0.2));
    let id = engine.insert(body, &[centred]).unwrap();
    for _ in 0..120 {
        engine.tick();
    }
    let at = engine.pose(id).unwrap().position;
    assert!(
        (at - vec2(0.0, 1.0 + area.centroid.y)).length() < 5e-3,
        "{at}"
    );
    let feet: f64 = engine
        .contacts_of(id)
        .unwrap()
        .map(|c| c.impulses[0] + c.impulses[1])
        .sum();
    let load = area.mass * 9.81 * engine.settings().tick / f64::from(engine.settings().substeps);
    assert!((feet - load).abs() < 1e-3 * load, "{feet} and {load} N·s");
}

/// A drum that turns carries its bodies along, and loses none.
#[test]
fn a_drum_keeps_what_is_in_it() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let drum = BodyInput::kinematic().moving(Vec2::ZERO, 1.0);
    let walls = [
        (3.2, 0.0, 0.4, 6.8),
        (-3.2, 0.0, 0.4, 6.8),
        (0.0, 3.2, 6.8, 0.4),
        (0.0, -3.2, 6.8, 0.4),
    ];
    let walls = walls.map(|(x, y, w, h)| {
        PieceInput::new(
            ConvexPolygon::rectangle(w, h)
                .unwrap()
                .translated(vec2(x, y)),
        )
    });
    engine.insert(drum, &walls).unwrap();
    let mut random = Random::new(77);
    let mut ids = Vec::new();
    for k in 0..16 {
        let piece = random.piece();
        let mut body = random.body(&piece, 0.1);
        body.pose.position += vec2(1.4 * f64::from(k % 4) - 2.1, 1.4 * f64::from(k / 4) - 2.1);
        ids.push(engine.insert(body, &[piece]).unwrap());
    }
    for _ in 0..600 {
        engine.tick();
        engine.graph.check(&engine.bodies);
    }
    for id in ids {
        let at = engine.pose(id).unwrap().position;
        assert!(at.length() < 4.5, "a body left for {at}");
    }
}

/// Capsules and rounded boxes lie on segments.
#[test]
fn rounded_shapes_lie_on_a_wall_without_thickness() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    let line = PieceInput::new(Segment::new(vec2(-9.0, 0.0), vec2(9.0, 0.0)).unwrap());
    engine.insert(BodyInput::fixed(), &[line]).unwrap();
    let capsule =
        PieceInput::new(Segment::new(vec2(-0.5, 0.0), vec2(0.5, 0.0)).unwrap()).rounded(0.25);
    let rounded = unit_box().rounded(0.25);
    let put = |engine: &mut Engine, piece: PieceInput, at: Vec2, turned: f64| {
        let mut body = BodyInput::dynamic(1.0, 0.3).at(at);
        body.pose.rotation = Rot::from_angle(turned);
        engine.insert(body, &[piece]).unwrap()
    };
    let first = put(&mut engine, capsule, vec2(-3.0, 0.6), 0.3);
    let second = put(&mut engine, rounded, vec2(3.0, 1.2), 0.3);
    for _ in 0..240 {
        engine.tick();
    }
    let height = |id: BodyId| engine.pose(id).unwrap().position.y;
    assert!((height(first) - 0.25).abs() < 2e-3, "{}", height(first));
    assert!((height(second) - 0.75).abs() < 2e-3, "{}", height(second));
}

/// A hundred boxes put at one place part within ten seconds, with little energy: at 0.3 m/s each.
#[test]
fn boxes_at_one_place_part() {
    for seed in 1..9 {
        let mut engine = Engine::new(super::weightless()).unwrap();
        let mut random = Random::new(seed);
        for _ in 0..100 {
            let at = vec2(random.signed(), random.signed()) * 1e-3;
            let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(at);
            engine.insert(body, &[unit_box()]).unwrap();
        }
        engine.substep(&Mixed);
        // Of 4950 pairs those are enough that leave each body 64 others.
        let contacts = engine.contact_count();
        assert!((3200..4500).contains(&contacts), "{contacts}");
        let mut most = 0.0f64;
        for _ in 0..600 {
            engine.tick();
            most = most.max(engine.energy().0);
        }
        assert!(most < 5.0, "{seed}: {most} J");
        assert!(engine.deepest_overlap() < 1e-3, "{seed}");
    }
}
