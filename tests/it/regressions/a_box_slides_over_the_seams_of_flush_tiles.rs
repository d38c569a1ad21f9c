//! A body that has landed lies in its floor by a rounding, and one that a soft contact bears by some micrometres: the side
//! of the next flush tile stood in its way by as much. A box of 8 m/s stopped at a seam, or was turned over there. What
//! stands out of the floor by more than counts as touch is met as ever, and so are its ends.

use carom_dynamics::{BodyDef, BodyId, Material, Mode, Settings, World};
use carom_geometry::{Compound, ConvexPolygon, Polygon, Segment, Shape};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::scenes::{block, put};

const MODES: [Mode; 2] = [Mode::Hybrid, Mode::Exact];

fn smooth(restitution: f64) -> Material {
    Material {
        restitution,
        friction: 0.0,
        ..Material::default()
    }
}

fn empty(mode: Mode) -> World {
    let settings = Settings {
        mode,
        sleep: None,
        ..Settings::default()
    };
    World::new(settings).expect("valid settings")
}

/// Tiles of 1 m from x = 0 on, with tops at `level`.
fn tiles(world: &mut World, count: u32, level: f64, restitution: f64) {
    for k in 0..count {
        let def = BodyDef::fixed().at(vec2(0.5 + f64::from(k), level - 0.5));
        put(world, def, block(1.0, 1.0), smooth(restitution));
    }
}

/// A box of 1 m, `drop` above a floor at `level`.
fn slider(world: &mut World, drop: f64, speed: f64, level: f64, locked: bool, e: f64) -> BodyId {
    let def = BodyDef::dynamic()
        .at(vec2(1.8, level + 0.5 + drop))
        .moving(vec2(speed, 0.0));
    let def = if locked {
        def.with_locked_rotation()
    } else {
        def
    };
    put(world, def, block(1.0, 1.0), smooth(e))
}

fn place(world: &World, id: BodyId) -> Vec2 {
    world.body(id).expect("there").centre()
}

fn velocity(world: &World, id: BodyId) -> Vec2 {
    world.body(id).expect("there").velocity()
}

#[test]
fn a_box_that_landed_passes_every_seam() {
    for mode in MODES {
        for (locked, e) in [(false, 0.0), (true, 0.0), (true, 0.25)] {
            for level in [0.0, 0.3] {
                for drop in [0.0, 1e-6, 1e-4, 1e-2, 0.1] {
                    for speed in [0.5, 2.0, 8.0] {
                        let mut world = empty(mode);
                        tiles(&mut world, 40, level, e);
                        let id = slider(&mut world, drop, speed, level, locked, e);
                        let whole = 36.0 / speed;
                        while world.time() < carom_math::SimTime::ZERO + whole {
                            world.step(1.0 / 60.0);
                        }
                        let story =
                            format!("{mode:?}, drop {drop} m, {speed} m/s, locked {locked}");
                        let v = velocity(&world, id);
                        assert!((v.x - speed).abs() < 1e-9 * speed, "{story}: {v} m/s");
                        let y = place(&world, id).y - level - 0.5;
                        assert!(y.abs() < 1e-5, "{story}: {y} m above the floor");
                    }
                }
            }
        }
    }
}

/// With friction, in both directions: whichever tile bears the box, it goes as it does on one slab, and stops there.
#[test]
fn tiles_bear_a_box_as_one_slab_does() {
    let rough = Material {
        friction: 0.2,
        ..smooth(0.0)
    };
    for mode in MODES {
        for speed in [3.0, -3.0] {
            let [tiled, slab] = [(60, 1.0), (1, 60.0)].map(|(count, width)| {
                let mut world = empty(mode);
                for k in 0..count {
                    let at = vec2((f64::from(k) + 0.5) * width - 30.0, -0.5);
                    put(
                        &mut world,
                        BodyDef::fixed().at(at),
                        block(width, 1.0),
                        rough,
                    );
                }
                let def = BodyDef::dynamic()
                    .at(vec2(0.1, 0.25))
                    .moving(vec2(speed, 0.0));
                let id = put(&mut world, def, block(0.7, 0.5), rough);
                let mut way = Vec::new();
                for _ in 0..120 {
                    world.step(1.0 / 60.0);
                    way.push((place(&world, id), velocity(&world, id)));
                }
                way
            });
            for (step, (one, other)) in tiled.iter().zip(&slab).enumerate() {
                let off = (one.0 - other.0).length() + (one.1 - other.1).length();
                assert!(off < 1e-11, "{mode:?}, {speed} m/s, step {step}: {off}");
            }
        }
    }
}

/// However little a tile stands out: what is not flush is a step.
#[test]
fn a_step_of_a_micrometre_stops_a_box() {
    for mode in MODES {
        for step in [1e-6, 1e-4, 1e-2] {
            for drop in [0.0, 1e-6, 1e-2] {
                let mut world = empty(mode);
                tiles(&mut world, 8, 0.0, 0.0);
                let def = BodyDef::fixed().at(vec2(8.5, step - 0.5));
                put(&mut world, def, block(1.0, 1.0), smooth(0.0));
                let id = slider(&mut world, drop, 2.0, 0.0, true, 0.0);
                for _ in 0..300 {
                    world.step(1.0 / 60.0);
                }
                let x = place(&world, id).x;
                assert!(
                    (x - 7.5).abs() < 1e-4,
                    "{mode:?}, {step} m, drop {drop}: {x} m"
                );
            }
        }
    }
}

#[test]
fn a_box_stops_in_the_corner_of_floor_and_wall() {
    for mode in MODES {
        for drop in [0.0, 1e-6, 1e-2] {
            for locked in [false, true] {
                let mut world = empty(mode);
                tiles(&mut world, 8, 0.0, 0.0);
                let def = BodyDef::fixed().at(vec2(8.5, 0.5));
                put(&mut world, def, block(1.0, 3.0), smooth(0.0));
                let id = slider(&mut world, drop, 2.0, 0.0, locked, 0.0);
                for _ in 0..300 {
                    world.step(1.0 / 60.0);
                }
                let x = place(&world, id).x;
                assert!((x - 7.5).abs() < 1e-4, "{mode:?}, drop {drop}: {x} m");
            }
        }
    }
}

/// A ramp begins at a seam, with its side flush with that of the last tile: the box is thrown up, and does not sink in.
#[test]
fn a_ramp_at_a_seam_is_met() {
    for mode in MODES {
        for drop in [0.0, 1e-6, 1e-2] {
            let mut world = empty(mode);
            tiles(&mut world, 8, 0.0, 0.0);
            let ramp = [
                vec2(8.0, -1.0),
                vec2(12.0, -1.0),
                vec2(12.0, 1.0),
                vec2(8.0, 0.0),
            ];
            let ramp = ConvexPolygon::new(ramp).expect("a ramp");
            put(&mut world, BodyDef::fixed(), ramp, smooth(0.0));
            let id = slider(&mut world, drop, 4.0, 0.0, true, 0.0);
            let mut deepest = 0.0_f64;
            for _ in 0..240 {
                deepest = deepest.max(world.step(1.0 / 60.0).deepest_overlap);
                let at = place(&world, id);
                let over = (at.y - 0.5) - 0.25 * (at.x + 0.5 - 8.0).max(0.0);
                assert!(over > -1e-3, "{mode:?}, drop {drop}: {over} m at {at}");
            }
            assert!(deepest < 1e-3, "{mode:?}, drop {drop}: {deepest} m deep");
        }
    }
}

/// Over a gap of its own width a box tips, and strikes the side of the tile beyond, which is flush with the floor.
#[test]
fn a_box_that_tips_into_a_gap_strikes_the_tile_beyond() {
    for mode in MODES {
        let mut world = empty(mode);
        tiles(&mut world, 8, 0.0, 0.0);
        let def = BodyDef::fixed().at(vec2(9.7, -0.5));
        put(&mut world, def, block(1.0, 1.0), smooth(0.0));
        let id = slider(&mut world, 1e-6, 1.0, 0.0, false, 0.0);
        for _ in 0..1200 {
            world.step(1.0 / 60.0);
        }
        let (at, v) = (place(&world, id), velocity(&world, id));
        assert!(at.x < 9.2, "{mode:?}: through the tile, at {at}");
        assert!(v.length() < 100.0, "{mode:?}: {v} m/s");
    }
}

/// The side of a square chain of segments hangs from the end of its upper one: a box that is driven over the corner goes on.
#[test]
fn a_driven_box_passes_the_corner_of_a_chain() {
    let corners = [
        vec2(-2.0, 0.0),
        vec2(2.0, 0.0),
        vec2(2.0, -4.0),
        vec2(-2.0, -4.0),
    ];
    let side = |k: usize| Segment::new(corners[k], corners[(k + 1) % 4]).expect("a side");
    for mode in MODES {
        for start in [0.5, 0.6, 0.51] {
            for whole in [false, true] {
                let mut world = empty(mode);
                if whole {
                    let parts = (0..4).map(|k| (Shape::from(side(k)), Pose::IDENTITY));
                    let chain = Compound::new(parts).expect("a chain");
                    put(&mut world, BodyDef::fixed(), chain, smooth(0.0));
                } else {
                    for k in 0..4 {
                        put(&mut world, BodyDef::fixed(), side(k), smooth(0.0));
                    }
                }
                let def = BodyDef::dynamic()
                    .at(vec2(start, 0.5))
                    .with_locked_rotation();
                let id = put(&mut world, def, block(1.0, 1.0), smooth(0.0));
                for _ in 0..120 {
                    let v = velocity(&world, id);
                    world.set_velocity(id, vec2(1.0, v.y), 0.0).expect("there");
                    let report = world.step(1.0 / 60.0);
                    assert!(report.deepest_overlap < 1e-6, "{report:?}");
                }
                let x = place(&world, id).x;
                assert!(
                    (x - start - 2.0).abs() < 1e-9,
                    "{mode:?}, from {start}: {x} m"
                );
            }
        }
    }
}

#[test]
fn a_step_on_the_tile_behind_a_seam_is_met() {
    for mode in MODES {
        for drop in [0.0, 1e-4, 1e-2] {
            for speed in [0.5, 2.0, 20.0] {
                let mut world = empty(mode);
                tiles(&mut world, 4, 0.0, 0.0);
                // One shape: flush to x = 7, and half a metre higher from there on.
                let step = Polygon::new([
                    vec2(4.0, -1.0),
                    vec2(12.0, -1.0),
                    vec2(12.0, 0.5),
                    vec2(7.0, 0.5),
                    vec2(7.0, 0.0),
                    vec2(4.0, 0.0),
                ])
                .expect("simple");
                put(&mut world, BodyDef::fixed(), step, smooth(0.0));
                let id = slider(&mut world, drop, speed, 0.0, true, 0.0);
                let whole = 8.0 / speed;
                while world.time() < carom_math::SimTime::ZERO + whole {
                    world.step(1.0 / 60.0);
                }
                let x = place(&world, id).x;
                let story = format!("{mode:?}, drop {drop} m, {speed} m/s");
                assert!((x - 6.5).abs() < 1e-4, "{story}: it is at {x} m");
            }
        }
    }
}
