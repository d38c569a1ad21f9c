//! The contact update, once a tick: contacts of bodies that moved are computed anew, straight into their rows; new pairs
//! get a contact, pairs that parted lose theirs.

use carom_math::Vec2;

use crate::Settings;
use crate::bodies::Bodies;
use crate::broad::Pairs;
use crate::narrow::{Manifold, collide, collide_any};
use crate::pieces::Pieces;
use crate::rows::{Block, Cold, Graph, LANES, Quad};

/// A kept contact may be so many margins wide, so that pairs do not come and go each tick.
const KEPT: f64 = 1.5;

/// Part of a margin by which B's face must separate better than A's: flush faces keep one owner.
const HYSTERESIS: f64 = 0.1;

/// Cosine of 25°: beyond it what pushed along the old normal is no guess for what will along the new one.
const SAME_NORMAL: f64 = 0.9;

/// What two pieces are to each other within a tick.
struct Meeting {
    /// Gaps below it make a contact, in m.
    margin: f64,
    /// How far B goes against A until the next tick, in m, and what they may close by besides.
    way: Vec2,
    closing: f64,
    /// The most that they moved by against each other since their base poses, in m.
    moved: f64,
}

/// What the narrow phase reads.
#[derive(Clone, Copy)]
struct Scene<'a> {
    bodies: &'a Bodies,
    pieces: &'a Pieces,
    settings: &'a Settings,
}

/// Computes the contacts of moved bodies anew; those that parted are added to `parted`.
pub(crate) fn update(
    graph: &mut Graph,
    bodies: &mut Bodies,
    pieces: &Pieces,
    settings: &Settings,
    parted: &mut Vec<u32>,
) {
    for colour in graph.awake() {
        for (block, cold) in colour.blocks.iter_mut().zip(&mut colour.cold) {
            let moved = |line: &u32| bodies.moved[*line as usize];
            if !block.a.iter().chain(&block.b).any(moved) {
                continue;
            }
            for lane in 0..LANES {
                let (a, b) = (block.a[lane] as usize, block.b[lane] as usize);
                if bodies.moved[a] || bodies.moved[b] {
                    let scene = Scene {
                        bodies,
                        pieces,
                        settings,
                    };
                    match scene.contact(cold.pieces[lane], KEPT) {
                        Some(manifold) => rewrite(bodies, block, cold, lane, &manifold),
                        None => parted.push(cold.contact[lane]),
                    }
                }
            }
        }
    }
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
    let mut fresh = Vec::new();
    for &pair in candidates {
        let asleep = pair.map(|piece| {
            let slot = pieces.list[piece as usize].body;
            bodies.records[slot as usize].line == Bodies::NONE
        });
        if asleep[0] || asleep[1] || known.get(pair).is_some() {
            continue;
        }
        let order = pair.map(|piece| {
            let piece = &pieces.list[piece as usize];
            (bodies.records[piece.body as usize].birth, piece.ordinal)
        });
        let (pair, order) = if order[0] < order[1] {
            (pair, order)
        } else {
            ([pair[1], pair[0]], [order[1], order[0]])
        };
        if let Some(manifold) = scene.contact(pair, 1.0) {
            fresh.push((order, pair, manifold));
        }
    }
    fresh.sort_unstable_by_key(|new| new.0);
    for (_, pair, manifold) in fresh {
        let [a, b] = pair.map(|piece| &pieces.list[piece as usize]);
        let ends = [a.body, b.body];
        let surface = a.material.with(b.material);
        let id = graph.insert(bodies, ends, pair, &manifold, surface);
        known.insert(pair, id);
        narrow_tolerances(bodies, settings, ends, a.extent.min(b.extent));
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

impl Scene<'_> {
    /// The contact of two pieces whose gap is below `factor` margins, or may be until the next tick.
    fn contact(&self, pair: [u32; 2], factor: f64) -> Option<Manifold> {
        let meeting = self.meeting(pair);
        let margin = factor * meeting.margin;
        let [a, b] = pair.map(|piece| &self.pieces.list[piece as usize]);
        let [turned_a, turned_b] = pair.map(|piece| &self.pieces.turned[piece as usize]);
        let [pose_a, pose_b] = [a.body, b.body].map(|slot| self.bodies.base_of(slot));
        let limit = margin + meeting.closing + meeting.moved;
        let found = if turned_a.corners > 0 && turned_b.corners > 0 {
            let d = pose_b.position - pose_a.position;
            let hysteresis = HYSTERESIS * meeting.margin;
            collide(turned_a, turned_b, d, meeting.way, limit, hysteresis)
        } else {
            collide_any((a, pose_a), (b, pose_b), limit + meeting.way.length())
        }?;
        (found.gap() < margin + self.closes(pair, &found)).then_some(found)
    }

    fn meeting(&self, pair: [u32; 2]) -> Meeting {
        let [a, b] = pair.map(|piece| &self.pieces.list[piece as usize]);
        let [line_a, line_b] = [a, b].map(|piece| self.bodies.line_of(piece.body));
        let (body_a, body_b) = (&self.bodies.lines[line_a], &self.bodies.lines[line_b]);
        // Half-planes reach without end, and do not turn.
        let times = |angle: f64, reach: f64| {
            if angle == 0.0 {
                0.0
            } else {
                angle.abs() * reach
            }
        };
        let turning = times(body_a.w(), a.reach) + times(body_b.w(), b.reach);
        let turned = times(body_a.turn(), a.reach) + times(body_b.turn(), b.reach);
        let tolerance = |line: usize| {
            let tolerance = self.bodies.limits[line].tolerance;
            if tolerance < f64::INFINITY {
                tolerance
            } else {
                0.0
            }
        };
        let margin = self.settings.margin * a.extent.min(b.extent);
        let tick = self.settings.tick;
        let pull = self.settings.gravity.length() * tick;
        Meeting {
            // A body at rest may be a tolerance off its base pose, and go as far again.
            margin: margin.max(2.0 * (tolerance(line_a) + tolerance(line_b))),
            way: (body_b.v() - body_a.v()) * tick,
            closing: (turning + pull) * tick,
            moved: (body_b.d() - body_a.d()).length() + turned,
        }
    }

    /// How far the nearer point closes from the base poses until the next tick, in m, if velocities stay but for gravity.
    fn closes(&self, pair: [u32; 2], found: &Manifold) -> f64 {
        let lines = pair.map(|piece| {
            let slot = self.pieces.list[piece as usize].body;
            self.bodies.line_of(slot)
        });
        let [a, b] = lines.map(|line| &self.bodies.lines[line]);
        let pull: Vec2 = self.bodies.pull[lines[1]].v() - self.bodies.pull[lines[0]].v();
        let n = found.normal;
        let first = n.dot(b.v() - a.v()) + found.arm_b * b.w() - found.arm_a * a.w();
        let second = first + found.length * (b.w() - a.w());
        let least = if second < first { second } else { first };
        let least = least + n.dot(pull).min(0.0) * self.settings.tick;
        let went = n.dot(b.d() - a.d()) + found.arm_b * b.turn() - found.arm_a * a.turn();
        let second = went + found.length * (b.turn() - a.turn());
        let went = if second < went { second } else { went };
        (-least).max(0.0) * self.settings.tick - went
    }
}

/// Puts a contact anew into its row, carries its impulses over, and corrects the warm start of both bodies.
fn rewrite(bodies: &mut Bodies, block: &mut Block, cold: &mut Cold, lane: usize, new: &Manifold) {
    let (a, b) = (block.a[lane] as usize, block.b[lane] as usize);
    let old = block.impulses(lane);
    let acts = old.iter().any(|j| j.abs() > 0.0);
    let before = acts.then(|| block.push(lane, &bodies.lines[a], &bodies.lines[b]));
    if acts {
        let j = carried(block, lane, new, old);
        block.set_impulses(lane, j);
    }
    block.put(lane, new);
    cold.features[lane] = new.features;
    if let Some(before) = before {
        let after = block.push(lane, &bodies.lines[a], &bodies.lines[b]);
        correct_start(&mut bodies.start[a], &before[0], &after[0]);
        correct_start(&mut bodies.start[b], &before[1], &after[1]);
    }
}

/// v stays, and what contacts did to it changes.
fn correct_start(start: &mut Quad, before: &Quad, after: &Quad) {
    for k in 0..3 {
        start.0[k] += before.0[k] - after.0[k];
    }
}

/// Impulses for the new points: point by point, or summed, or to the nearer one.
fn carried(block: &Block, lane: usize, new: &Manifold, [j1, j2, jt]: [f64; 3]) -> [f64; 3] {
    let normal = Vec2::new(block.nx[lane], block.ny[lane]);
    if normal.dot(new.normal) <= SAME_NORMAL {
        return [0.0; 3];
    }
    let two = block.s2[lane] < crate::rows::OPEN;
    match (two, new.points == 2) {
        (_, false) => [j1 + j2, 0.0, jt],
        (true, true) => [j1, j2, jt],
        (false, true) => {
            let off = block.a1[lane] - new.arm_a;
            if off.abs() <= (off - new.length).abs() {
                [j1, 0.0, jt]
            } else {
                [0.0, j1, jt]
            }
        }
    }
}
