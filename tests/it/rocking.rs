//! A box that rocks from corner to corner: in analytic islands from landing to landing, and then at rest.

use carom_dynamics::{BodyDef, BodyId, Mode, Settings, World};
use carom_geometry::{ConvexPolygon, HalfPlane};
use carom_math::{Vec2, perp, vec2};
use carom_tests::scenes::surface;

/// A block 2 m high that stands on a rough floor and turns about its right corner, with e = 0.
fn rocking(mode: Mode, width: f64, spin: f64) -> (World, BodyId) {
    let settings = Settings {
        sleep: None,
        mode,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("settings");
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
    let rough = surface(0.0, 1e3);
    world.insert(BodyDef::fixed(), floor, rough).expect("valid");
    let block = ConvexPolygon::rectangle(width, 2.0).expect("a block");
    let def = BodyDef::dynamic()
        .at(vec2(0.0, 1.0))
        .moving(perp(vec2(-0.5 * width, 1.0)) * -spin)
        .spinning(-spin);
    let id = world.insert(def, block, rough).expect("valid");
    (world, id)
}

/// A landing leaves a part of the spin (Housner, 1963), in a series without end: sub-steps looked at such a box six times a tick
/// for as long as it was awake, and soft rows let it sink.
#[test]
fn a_box_that_rocks_needs_no_sub_steps_and_comes_to_rest() {
    for k in 0..20 {
        let (width, spin) = (0.6 + 0.05 * f64::from(k), 0.3 + 0.02 * f64::from(k));
        let (mut world, id) = rocking(Mode::Hybrid, width, spin);
        let (mut twin, twin_id) = rocking(Mode::Exact, width, spin);
        let (mut substeps, mut rows, mut alike) = (0, 0, 0);
        let mut before = world.energy().mechanical();
        for _ in 0..300 {
            let report = world.step(1.0 / 60.0);
            (substeps, rows) = (substeps + report.substeps, rows + report.rows);
            twin.step(1.0 / 60.0);
            let now = world.energy().mechanical();
            assert!(now <= before + 1e-11, "block {k}: {:e} J", now - before);
            before = now;
            let body = world.body(id).expect("it is there");
            if body.angular_velocity() != 0.0 {
                // In exact mode the series goes on.
                let there = twin.body(twin_id).expect("it is there").centre();
                let off = (body.centre() - there).length();
                assert!(off < 1e-9, "block {k}: {off:e} m beside its twin");
                alike += 1;
            }
        }
        let body = world.body(id).expect("it is there");
        assert_eq!(
            (body.velocity(), body.angular_velocity()),
            (Vec2::ZERO, 0.0)
        );
        let sunk = 1.0 - body.centre().y;
        assert!(sunk.abs() < 1e-12, "block {k}: {sunk:e} m deep");
        assert_eq!(rows, 0, "block {k}: rows without closed form");
        assert!(substeps < 100, "block {k}: {substeps} sub-steps of 1800");
        assert!(alike > 10, "block {k} rocked for {alike} ticks");
    }
}
