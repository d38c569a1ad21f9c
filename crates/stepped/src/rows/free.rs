//! Free pairs, of two bodies that contacts alone move, keep their angular momentum `Σ m c × v + I ω` to rounding.
//!
//! ```text
//! impulses act at one point of both bodies, at the poses that the sub-step begins with
//! d += h v₁,  v₁ = start + M⁻¹ Jᵀ j₁           as the pass with bias leaves them
//! v' = start + M⁻¹ Jᵀ j'                        as the sub-step ends
//! Σ m h v₁ × v' = h Σ (j₁ − j') × (v'_B − v'_A)  is what the displacement adds, contact by contact
//! v'_B − v'_A turns by what gives that back      as it turns with the line between both centres on a curved way
//! ```
//! Displacements that part an overlap count as impulses `j₁` that do not last.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_math::{Vec2, perp};
use fearless_simd::{Level, Select, Simd, SimdMask};

use super::block::{Block, LANES, flags};
use super::colour::Colour;
use super::graph::Graph;
use super::line::Quad;
use super::transpose::{Wide, any};
use super::widest::widest;
use crate::bodies::Bodies;

/// The contacts of free pairs in a sub-step.
#[derive(Clone, Debug, Default)]
pub(crate) struct FreePairs {
    /// In the order of colours.
    blocks: Vec<FreeBlock>,
    /// Of each line: where its body's centre is, in m, the angle that it turned by since its base pose, and 1 if it is free.
    centres: Vec<Quad>,
    /// Blocks with displacements that came after velocities had been found.
    late: Vec<usize>,
    /// Scratch.
    turns: Vec<Turn>,
}

/// Those in one block.
#[derive(Clone, Copy, Debug)]
struct FreeBlock {
    /// Colour and number of the block.
    at: (usize, usize),
    /// A bit for each lane of a free pair.
    lanes: u8,
    /// Impulses that displaced the bodies, along the normal and across, in N·s.
    along: [f64; LANES],
    across: [f64; LANES],
}

/// How the pairs of a block turn back.
#[derive(Clone, Copy, Debug)]
struct Turn {
    /// Colour and number of the block.
    at: (usize, usize),
    /// What each pair is to have more of angular momentum, in N·m·s.
    moment: [f64; LANES],
    /// The square of the greatest speed that B may have against A, in m²/s².
    limit: [f64; LANES],
}

impl FreePairs {
    /// Gathers them, and has their impulses act at one point of both bodies.
    pub(crate) fn meet(&mut self, level: Level, graph: &mut Graph, bodies: &mut Bodies) {
        self.blocks.clear();
        if !bodies.any_is_free() {
            return;
        }
        self.note_centres(bodies);
        let (colours, centres, blocks) = (graph.awake(), &self.centres[..], &mut self.blocks);
        widest!(level => meet_all(colours, centres, bodies, blocks));
    }

    fn note_centres(&mut self, bodies: &Bodies) {
        self.centres.clear();
        let lines = bodies.lines.iter().zip(&bodies.base).zip(0..);
        self.centres.extend(lines.map(|((line, base), at)| {
            let centre = base.position + line.d();
            let free = if bodies.is_free(at) { 1.0 } else { 0.0 };
            Quad([centre.x, centre.y, line.turn(), free])
        }));
    }

    /// Notes the impulses that bodies are displaced by.
    pub(crate) fn note_impulses(&mut self, graph: &Graph) {
        for free in &mut self.blocks {
            free.note_impulses(&graph.colours[free.at.0].blocks[free.at.1]);
        }
    }

    /// A contact displaced its bodies, besides, as by an impulse along the normal, in N·s.
    pub(crate) fn add(&mut self, graph: &Graph, id: u32, impulse: f64) {
        if let Some((known, lane)) = self.find(graph, id) {
            self.blocks[known].along[lane] += impulse;
        }
    }

    /// The same along the normal and across once velocities have been found: see [`Self::turn_back_late`].
    pub(crate) fn add_late(&mut self, graph: &Graph, id: u32, (along, across): (f64, f64)) {
        if let Some((known, lane)) = self.find(graph, id) {
            self.blocks[known].along[lane] += along;
            self.blocks[known].across[lane] += across;
            self.late.push(known);
        }
    }

    /// Block and lane of a contact, if its bodies are free.
    fn find(&self, graph: &Graph, id: u32) -> Option<(usize, usize)> {
        let contact = &graph.contacts[id as usize];
        let (k, lane) = contact.place();
        let at = (contact.colour as usize, k);
        let known = self.blocks.binary_search_by_key(&at, |block| block.at);
        Some((known.ok()?, lane))
    }

    /// Gives back the angular momentum that displacements added within `h` seconds, before rows are rotated.
    pub(crate) fn turn_back(&mut self, level: Level, graph: &Graph, bodies: &mut Bodies, h: f64) {
        self.turn_all(level, &graph.colours, bodies, None, h);
    }

    /// The same of displacements that came afterwards.
    pub(crate) fn turn_back_late(
        &mut self,
        level: Level,
        graph: &Graph,
        bodies: &mut Bodies,
        h: f64,
    ) {
        let mut late = core::mem::take(&mut self.late);
        if late.is_empty() {
            return;
        }
        late.sort_unstable();
        late.dedup();
        self.turn_all(level, &graph.colours, bodies, Some(&late), h);
        for known in late {
            let block = self.blocks[known].of(graph);
            for line in block.a.into_iter().chain(block.b) {
                bodies.note_change(line);
            }
        }
    }

    /// All blocks, or those of these numbers. All moments are those of the velocities that the displacements came with.
    fn turn_all(
        &mut self,
        level: Level,
        colours: &[Colour],
        bodies: &mut Bodies,
        which: Option<&[usize]>,
        h: f64,
    ) {
        if self.blocks.is_empty() {
            return;
        }
        self.turns.clear();
        let (blocks, turns) = (&mut self.blocks[..], &mut self.turns);
        widest!(level => all_moments(colours, bodies, blocks, which, h, turns));
        if self.turns.is_empty() {
            return;
        }
        self.note_centres(bodies);
        let (centres, turns) = (&self.centres[..], &self.turns[..]);
        widest!(level => turn_back_all(colours, centres, bodies, turns));
    }
}

#[inline(always)]
fn meet_all<S: Simd, V: Wide<S>>(
    simd: S,
    colours: &mut [Colour],
    centres: &[Quad],
    bodies: &mut Bodies,
    blocks: &mut Vec<FreeBlock>,
) {
    for (colour, c) in colours.iter_mut().zip(0..) {
        for (block, k) in colour.blocks.iter_mut().zip(0..) {
            let lanes = meet::<S, V>(simd, block, centres, bodies);
            if lanes != 0 {
                blocks.push(FreeBlock {
                    at: (c, k),
                    lanes,
                    along: [0.0; LANES],
                    across: [0.0; LANES],
                });
            }
        }
    }
}

#[inline(always)]
fn all_moments<S: Simd, V: Wide<S>>(
    simd: S,
    colours: &[Colour],
    bodies: &Bodies,
    blocks: &mut [FreeBlock],
    which: Option<&[usize]>,
    h: f64,
    turns: &mut Vec<Turn>,
) {
    // No closure: what it calls would not be compiled for wide registers.
    for n in 0..which.map_or(blocks.len(), <[usize]>::len) {
        let free = &mut blocks[which.map_or(n, |which| which[n])];
        let block = &colours[free.at.0].blocks[free.at.1];
        if let Some(turn) = moments::<S, V>(simd, block, free, bodies, h) {
            turns.push(turn);
        }
    }
}

#[inline(always)]
fn turn_back_all<S: Simd, V: Wide<S>>(
    simd: S,
    colours: &[Colour],
    centres: &[Quad],
    bodies: &mut Bodies,
    turns: &[Turn],
) {
    for turn in turns {
        let block = &colours[turn.at.0].blocks[turn.at.1];
        turn_back::<S, V>(simd, block, turn, centres, bodies);
    }
}

impl FreeBlock {
    fn note_impulses(&mut self, block: &Block) {
        for lane in 0..LANES {
            self.along[lane] = block.j1[lane] + block.j2[lane];
        }
        self.across = block.jt;
    }

    fn of<'g>(&self, graph: &'g Graph) -> &'g Block {
        &graph.colours[self.at.0].blocks[self.at.1]
    }
}

/// [`Block::meet`] of the lanes of free pairs, which have a bit in what is returned: v stays, and what contacts did to it changes.
#[inline(always)]
fn meet<S: Simd, V: Wide<S>>(
    simd: S,
    block: &mut Block,
    centres: &[Quad],
    bodies: &mut Bodies,
) -> u8 {
    let (zero, half) = (V::splat(simd, 0.0), V::splat(simd, 0.5));
    let mut lanes = 0;
    for at in (0..LANES).step_by(V::LANES) {
        let end = at + V::LANES;
        let (a, b) = (&block.a[at..end], &block.b[at..end]);
        let [ax, ay, aturn, a_free] = V::columns(simd, centres, a, 0);
        let [bx, by, bturn, b_free] = V::columns(simd, centres, b, 0);
        let chosen = a_free.min(b_free).simd_gt(zero);
        #[expect(clippy::cast_possible_truncation, reason = "eight lanes")]
        let bits = chosen.to_bitmask() as u8;
        if bits == 0 {
            continue;
        }
        lanes |= bits << at;
        // From B to A.
        let (x, y) = (ax - bx, ay - by);
        let nx = V::from_slice(simd, &block.nx[at..end]);
        let ny = V::from_slice(simd, &block.ny[at..end]);
        let a1 = V::from_slice(simd, &block.a1[at..end]);
        let b1 = V::from_slice(simd, &block.b1[at..end]);
        let at_ = V::from_slice(simd, &block.at[at..end]);
        let bt = V::from_slice(simd, &block.bt[at..end]);
        let lever = chosen.select(half * (x * ny - y * nx - (b1 - a1)), zero);
        let height = chosen.select(half * (x * nx + y * ny - (bt - at_)), zero);
        let turned = lever * (aturn + bturn);
        let s1 = V::from_slice(simd, &block.s1[at..end]) - turned;
        let s2 = V::from_slice(simd, &block.s2[at..end]) - turned;
        let sum = V::from_slice(simd, &block.j1[at..end]) + V::from_slice(simd, &block.j2[at..end]);
        let moment = lever * sum + height * V::from_slice(simd, &block.jt[at..end]);
        (a1 - lever).store_slice(&mut block.a1[at..end]);
        (b1 + lever).store_slice(&mut block.b1[at..end]);
        (at_ - height).store_slice(&mut block.at[at..end]);
        (bt + height).store_slice(&mut block.bt[at..end]);
        s1.store_slice(&mut block.s1[at..end]);
        s2.store_slice(&mut block.s2[at..end]);
        if any(moment.abs().simd_gt(zero)) {
            let [_, _, _, ia] = V::columns(simd, &bodies.lines, &block.a[at..end], 4);
            let [_, _, _, ib] = V::columns(simd, &bodies.lines, &block.b[at..end], 4);
            // One body after the other: an empty lane names one line twice.
            for (ends, inertia) in [
                (&block.a[at..end], moment * ia),
                (&block.b[at..end], moment * ib),
            ] {
                let [x, y, w, m] = V::columns(simd, &bodies.start, ends, 0);
                V::write(&mut bodies.start, ends, [x, y, w - inertia, m]);
            }
        }
    }
    lanes
}

/// How the free pairs of a block turn back, if one does. Displacements that come later count from here.
#[inline(always)]
fn moments<S: Simd, V: Wide<S>>(
    simd: S,
    block: &Block,
    free: &mut FreeBlock,
    bodies: &Bodies,
    h: f64,
) -> Option<Turn> {
    let chosen = flags(free.lanes);
    let zero = V::splat(simd, 0.0);
    let mut acts = false;
    let mut turn = Turn {
        at: free.at,
        moment: [0.0; LANES],
        limit: [0.0; LANES],
    };
    for at in (0..LANES).step_by(V::LANES) {
        let end = at + V::LANES;
        let chosen = V::from_slice(simd, &chosen[at..end]).simd_gt(zero);
        let lasting =
            V::from_slice(simd, &block.j1[at..end]) + V::from_slice(simd, &block.j2[at..end]);
        let rubs = V::from_slice(simd, &block.jt[at..end]);
        let along = V::from_slice(simd, &free.along[at..end]) - lasting;
        let across = V::from_slice(simd, &free.across[at..end]) - rubs;
        let chosen = chosen & (along.abs() + across.abs()).simd_gt(zero);
        if !any(chosen) {
            continue;
        }
        acts = true;
        let [avx, avy, _, ma] = V::columns(simd, &bodies.lines, &block.a[at..end], 0);
        let [bvx, bvy, _, mb] = V::columns(simd, &bodies.lines, &block.b[at..end], 0);
        let nx = V::from_slice(simd, &block.nx[at..end]);
        let ny = V::from_slice(simd, &block.ny[at..end]);
        let (px, py) = (nx * along - ny * across, ny * along + nx * across);
        let (vx, vy, m) = (bvx - avx, bvy - avy, ma + mb);
        let added = (px * vy - py * vx) * V::splat(simd, h);
        let moment = chosen.select(-added, zero);
        let (ux, uy) = (vx + px * m, vy + py * m);
        let limit = (vx * vx + vy * vy).max(ux * ux + uy * uy);
        limit.store_slice(&mut turn.limit[at..end]);
        moment.store_slice(&mut turn.moment[at..end]);
        lasting.store_slice(&mut free.along[at..end]);
        rubs.store_slice(&mut free.across[at..end]);
    }
    acts.then_some(turn)
}

/// Turns the velocity of B against A so that both have the moments more. It is as long as before, or as what displaced them if that was
/// faster and no turn is enough, and on which side of the line between both it points stays. What no turn gives their spins get.
#[inline(always)]
fn turn_back<S: Simd, V: Wide<S>>(
    simd: S,
    block: &Block,
    turn: &Turn,
    centres: &[Quad],
    bodies: &mut Bodies,
) {
    let (zero, one) = (V::splat(simd, 0.0), V::splat(simd, 1.0));
    for at in (0..LANES).step_by(V::LANES) {
        let end = at + V::LANES;
        let moment = V::from_slice(simd, &turn.moment[at..end]);
        let chosen = moment.abs().simd_gt(zero);
        if !any(chosen) {
            continue;
        }
        let (a, b) = (&block.a[at..end], &block.b[at..end]);
        let [avx, avy, aw, ma] = V::columns(simd, &bodies.lines, a, 0);
        let [bvx, bvy, bw, mb] = V::columns(simd, &bodies.lines, b, 0);
        let [ax, ay, ..] = V::columns(simd, centres, a, 0);
        let [bx, by, ..] = V::columns(simd, centres, b, 0);
        let (vx, vy) = (bvx - avx, bvy - avy);
        let m = ma + mb;
        // By which arm × v is to change.
        let more = moment * m;
        let (x, y) = (bx - ax, by - ay);
        let square = x * x + y * y;
        let (turns, parts) = (x * vy - y * vx, x * vx + y * vy);
        // (arm · v)² + (arm × v)² stays.
        let left = parts * parts - more * (turns + turns + more);
        // What displaced them may have been faster: that energy is there.
        let limit = V::from_slice(simd, &turn.limit[at..end]);
        let most = (square * limit).max(parts * parts + turns * turns).sqrt();
        let wanted = turns + more;
        let most = wanted.simd_lt(zero).select(-most, most);
        let is_within = (wanted * wanted).simd_le(most * most);
        let change = is_within.select(more, most - turns);
        let length = left.max(zero).sqrt();
        let parting = parts.simd_lt(zero).select(-length, length) - parts;
        let acts = chosen & square.simd_gt(zero);
        let scale = acts.select(one / (square * m), zero);
        let (cx, cy) = (
            (x * parting - y * change) * scale,
            (y * parting + x * change) * scale,
        );
        let rest = chosen.select((more - acts.select(change, zero)) / m, zero);
        let (mut spin_a, mut spin_b) = (zero, zero);
        if any(rest.abs().simd_gt(zero)) {
            let [_, _, _, ia] = V::columns(simd, &bodies.lines, a, 4);
            let [_, _, _, ib] = V::columns(simd, &bodies.lines, b, 4);
            let [own_a, own_b] = [ia, ib].map(|i| i.simd_gt(zero).select(one / i, zero));
            let own = own_a + own_b;
            let spin = own.simd_gt(zero).select(rest / own, zero);
            spin_a = ia.simd_gt(zero).select(spin, zero);
            spin_b = ib.simd_gt(zero).select(spin, zero);
        }
        let lines = &mut bodies.lines;
        V::write(lines, a, [avx - cx * ma, avy - cy * ma, aw + spin_a, ma]);
        V::write(lines, b, [bvx + cx * mb, bvy + cy * mb, bw + spin_b, mb]);
        for (ends, [cx, cy, spin]) in [
            (a, [-cx * ma, -cy * ma, spin_a]),
            (b, [cx * mb, cy * mb, spin_b]),
        ] {
            let [x, y, w, last] = V::columns(simd, &bodies.start, ends, 0);
            V::write(&mut bodies.start, ends, [x + cx, y + cy, w + spin, last]);
        }
    }
}

/// Gives back the angular momentum that shifts of the first of two free bodies each added.
pub(crate) fn turn_shifted(bodies: &mut Bodies, shifted: &[([u32; 2], Vec2)]) {
    let added = |([at, _], shift): &([u32; 2], Vec2)| {
        let line = &bodies.lines[*at as usize];
        shift.perp_dot(line.v()) / line.inverse_mass()
    };
    let added: Vec<f64> = shifted.iter().map(added).collect();
    for ((pair, _), added) in shifted.iter().zip(added) {
        turn_pair(bodies, pair.map(|line| line as usize), -added);
        for line in pair {
            bodies.note_change(*line);
        }
    }
}

/// [`turn_back`] of two bodies, which get `moment` N·m·s. What no turn gives is lost: it may be that of a way at 1e5 m/s, and spins that
/// gave it had 4e8 rad/s.
fn turn_pair(bodies: &mut Bodies, [a, b]: [usize; 2], moment: f64) {
    let (first, second) = (&bodies.lines[a], &bodies.lines[b]);
    let (ma, mb) = (first.inverse_mass(), second.inverse_mass());
    let place = |at: usize| bodies.base[at].position + bodies.lines[at].d();
    let (arm, v) = (place(b) - place(a), second.v() - first.v());
    let (turns, parts) = (arm.perp_dot(v), arm.dot(v));
    let more = moment * (ma + mb);
    let left = parts * parts - more * (turns + turns + more);
    let most = arm.length() * v.length();
    let change = if left >= 0.0 {
        more
    } else {
        most.copysign(turns + more) - turns
    };
    let (square, mut push) = (arm.length_squared(), Vec2::ZERO);
    if square > 0.0 {
        let parting = left.max(0.0).sqrt().copysign(parts) - parts;
        push = (arm * parting + perp(arm) * change) / (square * (ma + mb));
    }
    for (at, push) in [(a, push * -ma), (b, push * mb)] {
        let turn = Quad::new(push, 0.0);
        bodies.lines[at].add(&turn);
        bodies.start[at].add(&turn);
    }
}
