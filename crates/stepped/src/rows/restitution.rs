//! Restitution: what arrives with a speed leaves with a part of it.
//!
//! Relaxing stops a body short of its surface in the sub-step before it is met. A point that it acts on, and that closes
//! faster than what counts as rest, then opens: with the speed that it had there on its way back from the surface, which
//! it left at e times its arrival speed. That impulse is no part of the warm start, and what stopped
//! the body is taken out of it: it is no guess for the next sub-step.
//!
//! How much of a blow the rows stop is a matter of where in the sub-step it falls. So the bounce goes on from what they did,
//! friction included ([`Bounce`]).

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use fearless_simd::{Level, Simd, SimdMask};

use super::block::{Block, Cold, LANES};
use super::bounce::Bounce;
use super::bounce_budget::{Before, Places, keep, note, places};
use super::colour::Colour;
use super::graph::Graph;
use super::law::Law;
use super::line::Line;
use super::transpose::{Wide, any};
use super::widest::widest;
use crate::bodies::Bodies;
use crate::{ContactIx, LineIx};

/// Pull over so many sub-steps is rest. Less: piles with restitution hum; more: low bounces end early.
pub(crate) const REST: f64 = 2.0;

/// Sweeps over all points that bounce in one sub-step: those of one face need about three.
const SWEEPS: usize = 8;

/// A contact of which a point is met, or both.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub(crate) contact: ContactIx,
    pub(super) lines: [LineIx; 2],
    /// Speed of the faster point, in m/s, and when the first one is met, in s from the beginning of the sub-step on.
    pub(crate) speed: f64,
    pub(crate) met: f64,
    /// Speed with which each point leaves the surface, in m/s; what is not met may leave with any.
    pub(super) leaves: [f64; 2],
    /// Acceleration that opens the points, in m/s².
    pull: f64,
    /// What the bounce adds at both points along the normal, and across, in N·s.
    pub(crate) impulses: [f64; 3],
    /// What friction turned to heat as it bounced, in J.
    pub(crate) heat: f64,
}

/// Finds what is met within this sub-step or the next, once the warm start acts.
pub(crate) fn arrivals(
    (level, law): (Level, &Law),
    bodies: &Bodies,
    graph: &mut Graph,
    found: &mut Vec<Arrival>,
    before: &mut Vec<Before>,
) {
    found.clear();
    let least = REST * law.h * law.gravity;
    let mut close = Vec::new();
    for colour in graph.awake().iter().filter(|colour| colour.bouncing > 0) {
        close.clear();
        widest!(level => closing(&bodies.lines, colour, least, &mut close));
        for &(k, lane) in &close {
            let row = (&colour.blocks[k], &colour.cold[k], lane);
            found.extend(arrival([least, law.h], bodies, row));
        }
    }
    for arrival in &*found {
        // It has no impulses yet: no warm start changes.
        let (block, lane) = graph.block_mut(arrival.contact);
        meet(block, lane, bodies);
    }
    if !found.is_empty() {
        let lines: Vec<_> = found.iter().map(|arrival| arrival.lines).collect();
        note(bodies, &lines, law.h, before);
    }
}

/// Blocks and lanes that have restitution, bear no load and close faster than `least`. What bears a load is at rest, however it shakes:
/// a bounce would take away what holds the pile above it.
#[inline(always)]
fn closing<S: Simd, V: Wide<S>>(
    simd: S,
    lines: &[Line],
    colour: &Colour,
    least: f64,
    found: &mut Vec<(usize, usize)>,
) {
    let (zero, least) = (V::splat(simd, 0.0), V::splat(simd, -least));
    for ((block, cold), k) in colour.blocks.iter().zip(&colour.cold).zip(0..) {
        let mut at = 0;
        while at < LANES {
            let end = at + V::LANES;
            let bounces = V::from_slice(simd, &cold.restitution[at..end]).simd_gt(zero);
            let j1 = V::from_slice(simd, &block.j1[at..end]);
            let is_loaded = (j1 + V::from_slice(simd, &block.j2[at..end])).simd_gt(zero);
            if any(bounces & !is_loaded) {
                let [avx, avy, aw, _] = V::columns(simd, lines, &block.a[at..end], 0);
                let [bvx, bvy, bw, _] = V::columns(simd, lines, &block.b[at..end], 0);
                let nx = V::from_slice(simd, &block.nx[at..end]);
                let ny = V::from_slice(simd, &block.ny[at..end]);
                let a1 = V::from_slice(simd, &block.a1[at..end]);
                let b1 = V::from_slice(simd, &block.b1[at..end]);
                let l = V::from_slice(simd, &block.l[at..end]);
                let v1 = nx * (bvx - avx) + ny * (bvy - avy) + b1 * bw - a1 * aw;
                let v2 = v1 + l * (bw - aw);
                let mut bits = (bounces & !is_loaded & v1.min(v2).simd_lt(least)).to_bitmask();
                while bits != 0 {
                    found.push((k, at + bits.trailing_zeros() as usize));
                    bits &= bits - 1;
                }
            }
            at = end;
        }
    }
}

/// The arrival of a contact that closes faster than `least`, if a point of it is met within two sub-steps of `h` seconds.
fn arrival(
    [least, h]: [f64; 2],
    bodies: &Bodies,
    (block, cold, lane): (&Block, &Cold, usize),
) -> Option<Arrival> {
    let lines = block.lines(lane);
    let v = block.opening(lane, &bodies.lines);
    let pull = block.pull(lane, bodies);
    let gaps = block.gaps(lane, &bodies.lines);
    let mut arrival = Arrival {
        contact: cold.contact[lane],
        lines,
        speed: 0.0,
        met: f64::INFINITY,
        leaves: [f64::NEG_INFINITY; 2],
        pull,
        impulses: [0.0; 3],
        heat: 0.0,
    };
    for point in 0..block.points(lane) {
        let (v, gap) = (v[point], gaps[point]);
        // Speed before this sub-step's pull, and what the pull adds to it on the way to the surface.
        let before = v - pull * h;
        let square = before * before - 2.0 * pull.min(0.0) * gap.max(0.0);
        let speed = if before < 0.0 { square.sqrt() } else { 0.0 };
        let met = gap > 0.0 && gap + 2.0 * v * h < 0.0;
        if met && speed > least {
            arrival.speed = arrival.speed.max(speed);
            arrival.met = arrival.met.min(gap / speed);
            arrival.leaves[point] = cold.restitution[lane] * speed;
        }
    }
    (arrival.speed > 0.0).then_some(arrival)
}

/// See [`Block::meet`].
fn meet(block: &mut Block, lane: usize, bodies: &Bodies) {
    let is_moved = |line: LineIx| bodies.lines[line].inverse_mass() > 0.0;
    if block.lines(lane).into_iter().all(is_moved) {
        block.meet(lane, bodies);
    }
}

/// Lets what arrived leave again; v and start change alike, and the rows start cold. The heat of friction, and what belts gave
/// for it, in J.
pub(crate) fn bounce(
    bodies: &mut Bodies,
    graph: &mut Graph,
    arrived: &mut [Arrival],
    before: &[Before],
) -> [f64; 2] {
    if arrived.is_empty() {
        return [0.0; 2];
    }
    for line in arrived.iter().flat_map(|arrival| arrival.lines) {
        bodies.note_change(line);
    }
    let mut bounces = Vec::with_capacity(arrived.len());
    for arrival in &mut *arrived {
        let (block, cold, lane) = graph.lane(arrival.contact);
        for (leaves, gap) in (arrival.leaves.iter_mut()).zip(block.gaps(lane, &bodies.lines)) {
            if *leaves >= 0.0 {
                let square = *leaves * *leaves + 2.0 * arrival.pull.min(0.0) * gap.max(0.0);
                *leaves = square.max(0.0).sqrt();
            }
        }
        let mut met = *block;
        meet(&mut met, lane, bodies);
        bounces.push(Bounce::new((&met, cold, lane), arrival.lines, bodies));
        graph.clear_warm_start(bodies, arrival.contact);
    }
    let places = places(bodies, arrived, before);
    solve(bodies, arrived, &bounces, (before.len(), &places));
    keep(bodies, arrived, &bounces, (before, &places));
    let mut work = [0.0; 2];
    for (arrival, bounce) in arrived.iter_mut().zip(&bounces) {
        let [heat, given] = bounce.work(&bodies.lines, arrival.impulses[2]);
        arrival.heat = heat;
        work = [work[0] + heat, work[1] + given];
    }
    work
}

/// Sweeps over all bounces; one is solved for again where others changed its bodies since.
fn solve(
    bodies: &mut Bodies,
    arrived: &mut [Arrival],
    bounces: &[Bounce],
    (count, places): (usize, &[Places]),
) {
    let mut changes = vec![0u32; count];
    let mut seen = vec![None; arrived.len()];
    for _ in 0..SWEEPS {
        let mut is_settled = true;
        for (k, (arrival, bounce)) in arrived.iter_mut().zip(bounces).enumerate() {
            let own = || places[k].into_iter().flatten();
            let now = Some(own().map(|at| changes[at]).sum::<u32>());
            if seen[k] == now {
                continue;
            }
            if bounce.solve(bodies, arrival) {
                own().for_each(|at| changes[at] += 1);
                is_settled = false;
            }
            seen[k] = Some(own().map(|at| changes[at]).sum());
        }
        if is_settled {
            return;
        }
    }
}
