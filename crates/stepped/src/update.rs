//! The contact update, once a tick: contacts of bodies that moved are computed anew, straight into their rows; new pairs
//! get a contact, pairs that parted lose theirs.

use carom_math::Vec2;
use fearless_simd::Level;

use crate::bodies::{Bodies, BodyKind};
use crate::broad::Pairs;
use crate::enough::{DeepCounts, take_many};
use crate::narrow::{Eight, Found, Manifold, Scene, collide_eight};
use crate::pieces::Pieces;
use crate::rows::{
    Block, Cold, Colour, Deep, Graph, HARD, LANES, Law, OPEN, Pressed, RotatingRows, Side, Touched,
    lanes, renew,
};
use crate::whole::PutPairs;
use crate::{BodyIx, ContactIx, IslandIx, LineIx, PairRules, PieceIx, Settings};

/// A kept contact may be so many margins wide, so that pairs do not come and go each tick.
const KEPT: f64 = 1.5;

/// Cosine of the angle by which a normal turned that is of the other side: 120°, as two sides of a regular triangle are apart. Those of
/// more corners are nearer, opposite ones 180° apart.
const TURNED_OVER: f64 = -0.5;

/// Computes the contacts of moved bodies anew; those that parted are added to `parted`. The least gap of them, in m.
pub(crate) fn update(
    (level, law): (Level, &Law),
    (graph, rotating, put): (&mut Graph, &mut RotatingRows, &mut PutPairs),
    bodies: &mut Bodies,
    pieces: &Pieces,
    settings: &Settings,
    parted: &mut Vec<ContactIx>,
) -> f64 {
    rotating.retain(graph, bodies);
    let touched = graph.touched(bodies);
    graph.suspects.clear();
    graph.suspects.cover(bodies.lines.len());
    let displaced = graph.displaced(bodies);
    let (colours, suspects) = graph.awake_and_suspects();
    // Rows are renewed, and all else of the bodies stays.
    let mut start = core::mem::take(&mut bodies.start);
    let scene = Scene {
        level,
        bodies,
        pieces,
        settings,
    };
    // To pack all blocks takes 1.04 of the instructions of a drum; to pack none 1.06 of those of a bin that is stirred.
    let count: u32 = touched.iter().map(|block| block.lanes.count_ones()).sum();
    let mut packed = (0 < count && 2 * count as usize <= LANES * touched.len())
        .then(|| packed(&scene, colours, &touched));
    let mut own = Found::NONE;
    let mut deep = Vec::new();
    let mut least = OPEN;
    for (at, touched) in touched.iter().enumerate() {
        let is_hard = touched.colour >= HARD;
        let colour = &mut colours[touched.colour];
        let (block, cold) = (
            &mut colour.blocks[touched.block],
            &mut colour.cold[touched.block],
        );
        let moved = touched.lanes;
        let found = if let Some(packed) = &mut packed {
            &mut packed[at]
        } else {
            let pairs = lanes(moved).map(|lane| (lane, Pair::of_lane(block, cold, lane)));
            manifolds(&scene, KEPT, pairs, &mut own);
            &mut own
        };
        let whole = put.renew(&scene, (block, cold), moved, found);
        let near = moved & found.near;
        for lane in lanes(near & !whole) {
            keep_side(&scene, block, cold.pieces[lane], lane, found);
        }
        renew(
            level,
            &scene.bodies.lines,
            &mut start,
            block,
            &found.rows,
            near,
        );
        for lane in lanes(near) {
            let ends = block.lines(lane);
            let lines = &scene.bodies.lines;
            let [first, second] = block.gaps(lane, lines);
            let gap = first.min(second);
            let beside = !displaced.is_empty() && ends.iter().any(|line| displaced[*line]);
            if gap < 0.0 || cold.is_deep(lane) || beside {
                least = least.min(gap);
                let deepest = deepest(law, pieces, cold.pieces[lane]);
                let by = if whole >> lane & 1 == 1 {
                    Pressed::ByCaller
                } else if beside {
                    Pressed::ByDisplacement
                } else {
                    Pressed::ByRows
                };
                let are_free = ends.iter().all(|line| scene.bodies.is_free(*line));
                if cold.note_depth((block, lane), lines, deepest, (by, are_free)) {
                    deep.push(cold.contact[lane]);
                }
            }
        }
        for lane in lanes(near & (found.short | found.slants)) {
            let lines = block.lines(lane);
            suspects.add_short(
                (scene.bodies, pieces),
                lines,
                cold.pieces[lane],
                cold.contact[lane],
            );
        }
        for lane in lanes(near & (found.of_a | found.of_b)) {
            let pair = cold.pieces[lane];
            if let Some(side) = face(found, lane, pieces, pair, is_hard)
                && !cold.is_deep(lane)
            {
                let [a, b] = pair.map(|piece| pieces.outlines[piece].extent());
                rotating.add(
                    (block, lane),
                    (cold.contact[lane], pair),
                    (scene.bodies, side),
                    (settings.tick, a.min(b)),
                );
            }
        }
        for lane in lanes(near & found.seam) {
            suspects.add_seam(block.lines(lane));
        }
        parted.extend(lanes(moved & !near).map(|lane| cold.contact[lane]));
    }
    bodies.start = start;
    graph.deep.append(&mut deep);
    least
}

/// What overlaps, or was pushed in the last sub-step, stays on the side on which it came: a thin body that is pressed into a wall
/// without thickness by more than half of its own would go through. A corner beside a corner is on no side: beyond the end of a wall
/// it may be below the one that its body then lies on.
fn keep_side(scene: &Scene<'_>, block: &Block, pair: [PieceIx; 2], lane: usize, found: &mut Found) {
    let [a, b] = block.lines(lane).map(|line| &scene.bodies.lines[line]);
    let normal = found.rows.normal(lane);
    let overlaps = found.gap(lane, b.d() - a.d()) < 0.0;
    let pushes = block.j1[lane] + block.j2[lane] > 0.0;
    let came = block.normal(lane);
    let is_sharp = |piece: PieceIx| scene.pieces.outlines[piece].radius() == 0.0;
    let of_corners = || block.s2[lane] == OPEN && pair.into_iter().all(is_sharp);
    if (overlaps || pushes)
        && came.dot(normal) < TURNED_OVER
        && !of_corners()
        && let Some(manifold) = scene.contact_on(came, pair, KEPT)
    {
        found.set(lane, &manifold);
    }
}

/// Manifolds of blocks in which few lanes moved: the pairs of several fill a register.
fn packed(scene: &Scene<'_>, colours: &[Colour], touched: &[Touched]) -> Vec<Found> {
    let mut all = vec![Found::NONE; touched.len()];
    let mut found = Found::NONE;
    let each = |(at, block): (usize, &Touched)| lanes(block.lanes).map(move |lane| (at, lane));
    let places: Vec<(usize, usize)> = touched.iter().enumerate().flat_map(each).collect();
    for places in places.chunks(LANES) {
        let pairs = places.iter().map(|&(at, lane)| {
            let (colour, k) = (&colours[touched[at].colour], touched[at].block);
            Pair::of_lane(&colour.blocks[k], &colour.cold[k], lane)
        });
        manifolds(scene, KEPT, (0..).zip(pairs), &mut found);
        for (from, &(at, lane)) in places.iter().enumerate() {
            all[at].copy_lane(lane, &found, from);
        }
    }
    all
}

/// Which body of a lane has the face, if its row may be rotated.
fn face(
    found: &Found,
    lane: usize,
    pieces: &Pieces,
    pair: [PieceIx; 2],
    is_hard: bool,
) -> Option<Side> {
    let has = |bits: u8| bits >> lane & 1 == 1;
    let of_b = has(found.of_b);
    let corner = pair[usize::from(!of_b)];
    let radius = pieces.outlines[corner].radius();
    // Corners in short soft rows may be ghosts, and go; a disc on a face has no other rows.
    let stays = is_hard || !has(found.short) || radius > 0.0;
    ((of_b || has(found.of_a)) && stays).then_some(Side { of_b, radius })
}

/// The least gap of two pieces that the sweeps see, in m.
fn deepest(law: &Law, pieces: &Pieces, pair: [PieceIx; 2]) -> f64 {
    let [a, b] = pair.map(|piece| pieces.outlines[piece].extent());
    law.deepest(a.min(b))
}

/// Manifolds of pairs, each in its lane: pieces without outlines one by one.
fn manifolds(
    scene: &Scene<'_>,
    factor: f64,
    pairs: impl Iterator<Item = (usize, Pair)> + Clone,
    found: &mut Found,
) {
    let mut eight = Eight::new(scene.pieces, [[LineIx::EMPTY; LANES]; 2]);
    for (lane, pair) in pairs.clone() {
        if eight.set(scene.pieces, lane, pair.pieces) {
            (eight.lines[0][lane], eight.lines[1][lane]) = (pair.lines[0], pair.lines[1]);
            eight.least[lane] = scene.seen(pair.lines);
        }
    }
    collide_eight(scene, factor, &eight, found);
    for (lane, pair) in pairs.filter(|(lane, _)| eight.used >> lane & 1 == 0) {
        if let Some(manifold) = scene.contact(pair.pieces, factor) {
            found.set(lane, &manifold);
        }
    }
}

/// Islands asleep that some candidate reaches before the next tick: its gap may come below 0 until then.
pub(crate) fn met_asleep(
    scene: &Scene<'_>,
    candidates: &[[PieceIx; 2]],
    rules: &dyn PairRules,
) -> Vec<IslandIx> {
    let (bodies, pieces) = (scene.bodies, scene.pieces);
    let mut islands = Vec::new();
    for &pair in candidates {
        let slots = pair.map(|piece| pieces.list[piece].body);
        let [a, b] = slots.map(|slot| bodies.records[slot].island);
        let island = a.min(b);
        if island == IslandIx::NONE || islands.contains(&island) {
            continue;
        }
        // A body that moves is seen once a tolerance; one that rests wakes no island by lying near.
        let slot = slots[usize::from(a != IslandIx::NONE)];
        let line = bodies.line_of(slot);
        // Nor does a kinematic body at rest: sleepers may lean on it.
        let stands = !bodies.is_dynamic(slot) && bodies.velocity_of(slot) == (Vec2::ZERO, 0.0);
        if stands && !bodies.moved[line] {
            continue;
        }
        let rests = bodies.rest[line] > 0.0;
        let seen = if rests {
            0.0
        } else {
            bodies.limits[line].tolerance
        };
        // What carries a body at rest goes on to.
        let pair = in_order(bodies, pieces, pair);
        let near = |found: &Manifold| scene.gap_ahead(pair, found, !rests) < seen;
        let met = |pair| match scene.contact(pair, 1.0) {
            Some(found) => near(&found),
            None => bodies.were_placed(slots) && scene.overlaps_across_cuts(pair),
        };
        if pieces.surface(pair, rules).is_some() && met(pair) {
            islands.push(island);
        }
    }
    islands
}

/// How near two pieces are where their bodies are based, in margins of theirs, at most one; `None` if they are farther apart.
pub(crate) fn nearness(scene: &Scene<'_>, pair: [PieceIx; 2]) -> Option<f64> {
    let pair = in_order(scene.bodies, scene.pieces, pair);
    let gap = scene.contact(pair, 1.0)?.gap();
    Some(gap / scene.margin(pair))
}

/// Two pieces in the order in which their bodies were inserted: a manifold depends on which one is A, and neither the numbers
/// of pieces nor the search that found the pair may decide that.
fn in_order(bodies: &Bodies, pieces: &Pieces, [a, b]: [PieceIx; 2]) -> [PieceIx; 2] {
    let birth = |piece: PieceIx| place(bodies, pieces, piece).0;
    if birth(a) < birth(b) { [a, b] } else { [b, a] }
}

/// Makes contacts of those candidates that are near enough, in the order in which their bodies were inserted. The least gap of
/// them, in m.
pub(crate) fn create(
    (level, law): (Level, &Law),
    (graph, rotating): (&mut Graph, &mut RotatingRows),
    bodies: &mut Bodies,
    (pieces, settings): (&Pieces, &Settings),
    (known, candidates): (&mut Pairs, &[[PieceIx; 2]]),
    (deep, put): (&Deep, &mut PutPairs),
    rules: &dyn PairRules,
) -> f64 {
    let mut deep = DeepCounts::of(deep, graph, bodies);
    let scene = Scene {
        level,
        bodies,
        pieces,
        settings,
    };
    graph.suspects.cover(bodies.lines.len());
    let unknown = candidates.iter().filter(|pair| !known.contains(**pair));
    let news = unknown.filter_map(|pair| Pair::new(bodies, pieces, *pair));
    let mut waits = Vec::new();
    let mut news: Vec<Pair> = news
        .filter(|pair| deep.asks(pair.slots(pieces), &mut waits))
        .collect();
    let many = take_many(bodies, pieces, &mut news);
    let (mut fresh, mut cut) = (Vec::new(), Vec::new());
    for eight in news.chunks(LANES) {
        add_near(&scene, put, eight, (&mut fresh, &mut cut));
    }
    for eight in many.chunks(LANES) {
        let asks = |pair: &&Pair| deep.asks(pair.slots(pieces), &mut waits);
        let eight: Vec<Pair> = eight.iter().filter(asks).copied().collect();
        let before = fresh.len();
        add_near(&scene, put, &eight, (&mut fresh, &mut cut));
        for Fresh { pair, manifold, .. } in &fresh[before..] {
            if manifold.gap() < deepest(law, pieces, pair.pieces)
                && pieces.surface(pair.pieces, rules).is_some()
            {
                deep.add(bodies, pair.slots(pieces));
            }
        }
    }
    put.add(&scene, rules, cut, &mut fresh);
    for (record, waits) in bodies.records.iter_mut().zip(waits) {
        if waits {
            // It was put there until then.
            record.placed = bodies.updates + 1;
        }
    }
    fresh.sort_by_cached_key(|fresh| fresh.pair.pieces.map(|piece| place(bodies, pieces, piece)));
    let mut least = OPEN;
    for Fresh {
        pair: Pair { pieces: pair, .. },
        manifold,
        face,
        is_whole,
    } in fresh
    {
        // Few of the candidates are near: so the rules are asked about these alone.
        let Some(surface) = pieces.surface(pair, rules) else {
            continue;
        };
        let [a, b] = pair.map(|piece| &pieces.list[piece]);
        let ends = [a.body, b.body];
        let deepest = deepest(law, pieces, pair);
        let by = if is_whole || put.contains(bodies, ends) {
            Pressed::ByCaller
        } else {
            Pressed::New
        };
        let how = (&manifold, deepest, (by, is_whole));
        let id = graph.insert(bodies, ends, pair, how, surface);
        let [first, second] = graph.gaps(bodies, id);
        least = least.min(first).min(second);
        known.insert(pair);
        if let Some(side) = face {
            let (block, cold, lane) = graph.lane(id);
            if !cold.is_deep(lane) {
                let (tick, extent) = (settings.tick, a.extent.min(b.extent));
                rotating.add((block, lane), (id, pair), (bodies, side), (tick, extent));
            }
        }
        if !is_whole {
            let lines = ends.map(|slot| bodies.records[slot].line);
            let parts = (&*bodies, pieces);
            graph.suspects.add_short(parts, lines, pair, id);
            graph.suspects.add_seam(lines);
        }
        narrow_tolerances(bodies, settings, ends, a.extent.min(b.extent));
    }
    least
}

/// Adds those of at most eight pairs that are near enough, with their manifolds, and those that were put into each other and overlap
/// across cuts alone.
fn add_near(
    scene: &Scene<'_>,
    put: &PutPairs,
    news: &[Pair],
    (fresh, cut): (&mut Vec<Fresh>, &mut Vec<Pair>),
) {
    let mut found = Found::NONE;
    manifolds(scene, 1.0, (0..).zip(news.iter().copied()), &mut found);
    let apart = news
        .iter()
        .zip(0..)
        .filter(|(_, lane)| found.near >> lane & 1 == 0);
    cut.extend(apart.map(|(pair, _)| *pair).filter(|pair| {
        put.contains(scene.bodies, pair.slots(scene.pieces))
            && scene.overlaps_across_cuts(pair.pieces)
    }));
    fresh.extend(lanes(found.near).map(|lane| {
        let pair = news[lane];
        // A corner may leave its face before it comes near; a disc keeps to it.
        let side = face(&found, lane, scene.pieces, pair.pieces, false);
        Fresh {
            pair,
            manifold: found.manifold(lane),
            face: side.filter(|side| side.radius > 0.0),
            is_whole: false,
        }
    }));
}

/// A pair that is near enough.
pub(crate) struct Fresh {
    pub(crate) pair: Pair,
    pub(crate) manifold: Manifold,
    /// Which body has the face, if its row may be rotated.
    pub(crate) face: Option<Side>,
    /// The row is one of whole shapes.
    pub(crate) is_whole: bool,
}

/// Two pieces, beginning with what was inserted first, and the lines of their bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub(crate) pieces: [PieceIx; 2],
    lines: [LineIx; 2],
}

impl Pair {
    /// Slots of both bodies.
    pub(crate) fn slots(self, pieces: &Pieces) -> [BodyIx; 2] {
        pieces.bodies(self.pieces)
    }

    const fn of_lane(block: &Block, cold: &Cold, lane: usize) -> Self {
        Self {
            pieces: cold.pieces[lane],
            lines: block.lines(lane),
        }
    }

    /// Two pieces of bodies that are awake or fixed, and that contacts move at least one of.
    fn new(bodies: &Bodies, pieces: &Pieces, pair: [PieceIx; 2]) -> Option<Self> {
        let pair = in_order(bodies, pieces, pair);
        let records = pieces.bodies(pair).map(|slot| &bodies.records[slot]);
        let lines = records.map(|record| record.line);
        let is_moved = records
            .iter()
            .any(|record| record.kind == BodyKind::Dynamic);
        let are_here = !lines.contains(&LineIx::NONE);
        (is_moved && are_here).then_some(Self {
            pieces: pair,
            lines,
        })
    }
}

/// Place of a piece in an order that memory does not change: birth of its body, and index of the piece.
pub(crate) fn place(bodies: &Bodies, pieces: &Pieces, piece: PieceIx) -> (u64, u32) {
    let owner = pieces.owners[piece];
    (bodies.records[owner.body].birth, owner.ordinal)
}

/// What is little to a body must be little to the smallest piece that it has a contact with.
fn narrow_tolerances(bodies: &mut Bodies, settings: &Settings, ends: [BodyIx; 2], extent: f64) {
    for slot in ends {
        let line = bodies.line_of(slot);
        // All fixed bodies have one line, and none: they never move.
        if line == LineIx::GROUND {
            continue;
        }
        let limit = &mut bodies.limits[line];
        limit.tolerance = limit.tolerance.min(settings.tolerance * extent);
    }
}
