//! The contact update, once a tick: contacts of bodies that moved are computed anew, straight into their rows; new pairs
//! get a contact, pairs that parted lose theirs.

use fearless_simd::Level;

use crate::Settings;
use crate::bodies::Bodies;
use crate::broad::Pairs;
use crate::narrow::{Eight, Found, Manifold, Patch, Scene, collide_eight};
use crate::pieces::Pieces;
use crate::rows::{Block, Cold, Graph, LANES, renew};

/// A kept contact may be so many margins wide, so that pairs do not come and go each tick.
const KEPT: f64 = 1.5;

/// Computes the contacts of moved bodies anew; those that parted are added to `parted`.
pub(crate) fn update(
    level: Level,
    graph: &mut Graph,
    bodies: &mut Bodies,
    pieces: &Pieces,
    settings: &Settings,
    parted: &mut Vec<u32>,
) {
    let (colours, patches) = graph.awake_and_patches();
    for colour in colours {
        for (block, cold) in colour.blocks.iter_mut().zip(&mut colour.cold) {
            let mut moved = 0u8;
            for lane in 0..LANES {
                let (a, b) = (block.a[lane] as usize, block.b[lane] as usize);
                moved |= u8::from(bodies.moved[a] | bodies.moved[b]) << lane;
            }
            if moved == 0 {
                continue;
            }
            let scene = Scene {
                bodies,
                pieces,
                settings,
            };
            let found = manifolds(level, &scene, block, cold, moved);
            let near = moved & found.near;
            renew(level, &bodies.lines, &mut bodies.start, block, &found, near);
            for lane in lanes(near) {
                let (manifold, pair) = (found.manifold(lane), cold.pieces[lane]);
                cold.features[lane] = manifold.features;
                let centre = pieces.turned[pair[0] as usize].centre();
                patches[cold.contact[lane] as usize] = Patch::new(&manifold, centre, pair);
            }
            parted.extend(lanes(moved & !near).map(|lane| cold.contact[lane]));
        }
    }
}

/// Those lanes that have a bit.
fn lanes(bits: u8) -> impl Iterator<Item = usize> {
    (0..LANES).filter(move |lane| bits >> lane & 1 == 1)
}

/// Manifolds of the lanes of a block that have a bit in `moved`: pieces without outlines one by one.
fn manifolds(level: Level, scene: &Scene<'_>, block: &Block, cold: &Cold, moved: u8) -> Found {
    let mut eight = Eight::NONE;
    eight.lines = [block.a, block.b];
    for lane in lanes(moved) {
        eight.set_pieces(scene, lane, cold.pieces[lane]);
    }
    let mut found = collide_eight(level, scene, KEPT, &eight);
    for lane in lanes(moved & !eight.used) {
        if let Some(manifold) = scene.contact(cold.pieces[lane], KEPT) {
            found.set(lane, &manifold);
        }
    }
    found
}

/// Islands asleep that some candidate reaches before the next tick: its gap may come below 0 until then.
pub(crate) fn met_asleep(
    bodies: &Bodies,
    pieces: &Pieces,
    settings: &Settings,
    candidates: &[[u32; 2]],
) -> Vec<u32> {
    let scene = Scene {
        bodies,
        pieces,
        settings,
    };
    let mut islands = Vec::new();
    for &pair in candidates {
        let slots = pair.map(|piece| pieces.list[piece as usize].body);
        let [a, b] = slots.map(|slot| bodies.records[slot as usize].island);
        let island = a.min(b);
        if island == Bodies::NONE || islands.contains(&island) {
            continue;
        }
        // A body that creeps is seen once a tolerance.
        let line = bodies.line_of(slots[usize::from(a != Bodies::NONE)]);
        let seen = bodies.limits[line].tolerance;
        let near = |found: &Manifold| found.gap() < scene.closes(pair, found) + seen;
        if scene.contact(pair, 1.0).is_some_and(|found| near(&found)) {
            islands.push(island);
        }
    }
    islands
}

/// Makes contacts of those candidates that are near enough, in the order in which their bodies were inserted.
pub(crate) fn create(
    level: Level,
    graph: &mut Graph,
    bodies: &mut Bodies,
    pieces: &Pieces,
    settings: &Settings,
    known: &mut Pairs,
    candidates: &[[u32; 2]],
) {
    let scene = Scene {
        bodies,
        pieces,
        settings,
    };
    let line = |piece: u32| bodies.records[pieces.body_of[piece as usize] as usize].line;
    let dynamic = |piece: u32| bodies.is_dynamic(pieces.body_of[piece as usize]);
    let unknown = candidates.iter().filter(|pair| {
        !known.contains(**pair)
            && !pair.map(line).contains(&Bodies::NONE)
            && (dynamic(pair[0]) || dynamic(pair[1]))
    });
    let news: Vec<_> = unknown.map(|pair| New::of(&scene, *pair)).collect();
    let mut fresh = Vec::new();
    for news in news.chunks(LANES) {
        let mut eight = Eight::NONE;
        for (lane, new) in news.iter().enumerate() {
            let lines = new.pieces.map(line);
            if eight.set_pieces(&scene, lane, new.pieces) {
                (eight.lines[0][lane], eight.lines[1][lane]) = (lines[0], lines[1]);
                eight.least[lane] = scene.seen(lines.map(|line| line as usize));
            } else if let Some(manifold) = scene.contact(new.pieces, 1.0) {
                fresh.push((*new, manifold));
            }
        }
        let found = collide_eight(level, &scene, 1.0, &eight);
        let near = lanes(found.near);
        fresh.extend(near.map(|lane| (news[lane], found.manifold(lane))));
    }
    fresh.sort_unstable_by_key(|new| new.0);
    for (New { pieces: pair, .. }, manifold) in fresh {
        let [a, b] = pair.map(|piece| &pieces.list[piece as usize]);
        let ends = [a.body, b.body];
        let surface = a.material.with(b.material);
        let patch = Patch::new(&manifold, pieces.turned[pair[0] as usize].centre(), pair);
        let id = graph.insert(bodies, ends, patch, &manifold, surface);
        known.insert(pair, id);
        narrow_tolerances(bodies, settings, ends, a.extent.min(b.extent));
    }
}

/// A pair that may become a contact: it begins with what was inserted first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct New {
    /// Birth of the body, and index of the piece.
    order: [(u64, u32); 2],
    pieces: [u32; 2],
}

impl New {
    fn of(scene: &Scene<'_>, pieces: [u32; 2]) -> Self {
        let order = pieces.map(|piece| {
            let piece = &scene.pieces.list[piece as usize];
            (
                scene.bodies.records[piece.body as usize].birth,
                piece.ordinal,
            )
        });
        if order[0] < order[1] {
            Self { order, pieces }
        } else {
            Self {
                order: [order[1], order[0]],
                pieces: [pieces[1], pieces[0]],
            }
        }
    }
}

/// What is little to a body must be little to the smallest piece that it has a contact with.
fn narrow_tolerances(bodies: &mut Bodies, settings: &Settings, ends: [u32; 2], extent: f64) {
    for slot in ends {
        let line = bodies.line_of(slot);
        let limit = &mut bodies.limits[line];
        limit.tolerance = limit.tolerance.min(settings.tolerance * extent);
    }
}
