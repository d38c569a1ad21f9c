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

use fearless_simd::{Level, Simd, SimdBase, SimdMask, dispatch, f64x4};

use super::block::{Block, LANES};
use super::bounce::Bounce;
use super::bounce_budget::{Before, Places, keep, note, places};
use super::colour::Colour;
use super::graph::Graph;
use super::law::Law;
use super::line::Line;
use super::transpose::Wide;
use crate::bodies::Bodies;

/// Pull over so many sub-steps is rest. Less: piles with restitution hum; more: low bounces end early.
pub(crate) const REST: f64 = 2.0;

/// Sweeps over all points that bounce in one sub-step: those of one face need about three.
const SWEEPS: usize = 8;

/// What may be met is looked for over so many sub-steps: those two that are asked for, and some rounding.
const SOON: f64 = 2.001;

/// A contact of which a point is met, or both.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub(crate) contact: u32,
    pub(super) lines: [u32; 2],
    /// Speed of the faster point, in m/s, and when the first one is met, in s from the beginning of the sub-step on.
    pub(crate) speed: f64,
    pub(crate) met: f64,
    /// Speed with which each point leaves the surface, in m/s; what is not met may leave with any.
    pub(super) leaves: [f64; 2],
    /// Acceleration that opens the points, in m/s².
    pull: f64,
    /// What the bounce adds at both points along the normal, and across, in N·s.
    pub(crate) impulses: [f64; 3],
}

/// Finds what is met within this sub-step or the next, once the warm start acts.
pub(crate) fn arrivals(
    level: Level,
    law: &Law,
    bodies: &Bodies,
    graph: &mut Graph,
    found: &mut Vec<Arrival>,
    before: &mut Vec<Before>,
) {
    found.clear();
    let least = REST * law.h * law.gravity;
    let mut blocks = Vec::new();
    for (colour, c) in graph.awake().iter().zip(0..) {
        if colour.bouncing > 0 {
            dispatch!(level, simd => closing(simd, [least, law.h], &bodies.lines, colour, c, &mut blocks));
        }
    }
    for (c, k, lanes) in blocks {
        let colour = &graph.awake()[c];
        let (block, cold) = (&colour.blocks[k], &colour.cold[k]);
        let closes = |lane: &usize| lanes >> lane & 1 == 1 && cold.restitution[*lane] > 0.0;
        for lane in (0..LANES).filter(closes) {
            // What bears a load is at rest, however it shakes: a bounce would take away what holds the pile above it.
            if block.j1[lane] + block.j2[lane] > 0.0 {
                continue;
            }
            let [v, gaps, pull] = motion(bodies, block, lane);
            let mut arrival = Arrival {
                contact: cold.contact[lane],
                lines: [block.a[lane], block.b[lane]],
                speed: 0.0,
                met: f64::INFINITY,
                leaves: [f64::NEG_INFINITY; 2],
                pull: pull[0],
                impulses: [0.0; 3],
            };
            for point in 0..block.points(lane) {
                let (v, gap, a) = (v[point], gaps[point], pull[0]);
                // Speed before this sub-step's pull, and what the pull adds to it on the way to the surface.
                let before = v - a * law.h;
                let square = before * before - 2.0 * a.min(0.0) * gap.max(0.0);
                let speed = if before < 0.0 { square.sqrt() } else { 0.0 };
                let met = gap > 0.0 && gap + 2.0 * v * law.h < 0.0;
                if met && speed > least {
                    arrival.speed = arrival.speed.max(speed);
                    arrival.met = arrival.met.min(gap / speed);
                    arrival.leaves[point] = cold.restitution[lane] * speed;
                }
            }
            if arrival.speed > 0.0 {
                found.push(arrival);
            }
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

/// Blocks with restitution in which a contact closes faster than `least` and an open point of it may be met within two sub-steps of
/// `h`, with a bit for each lane in which one may.
#[inline(always)]
fn closing<S: Simd>(
    simd: S,
    [least, h]: [f64; 2],
    lines: &[Line],
    colour: &Colour,
    c: usize,
    found: &mut Vec<(usize, usize, u8)>,
) {
    for (k, (block, bounces)) in colour.blocks.iter().zip(&colour.bounces).enumerate() {
        if *bounces == 0 {
            continue;
        }
        let mut closes = 0u8;
        for at in [0, 4] {
            let end = at + 4;
            let [avx, avy, aw, _] = f64x4::columns(simd, lines, &block.a[at..end], 0);
            let [bvx, bvy, bw, _] = f64x4::columns(simd, lines, &block.b[at..end], 0);
            let nx = f64x4::from_slice(simd, &block.nx[at..end]);
            let ny = f64x4::from_slice(simd, &block.ny[at..end]);
            let a1 = f64x4::from_slice(simd, &block.a1[at..end]);
            let b1 = f64x4::from_slice(simd, &block.b1[at..end]);
            let l = f64x4::from_slice(simd, &block.l[at..end]);
            let v1 = nx * (bvx - avx) + ny * (bvy - avy) + b1 * bw - a1 * aw;
            let v2 = v1 + l * (bw - aw);
            let closes_fast = v1.min(v2).simd_lt(-least);
            if !closes_fast.any_true() {
                continue;
            }
            let [adx, ady, aturn, _] = f64x4::columns(simd, lines, &block.a[at..end], 4);
            let [bdx, bdy, bturn, _] = f64x4::columns(simd, lines, &block.b[at..end], 4);
            let moved1 = nx * (bdx - adx) + ny * (bdy - ady) + b1 * bturn - a1 * aturn;
            let moved2 = moved1 + l * (bturn - aturn);
            let met =
                |v: f64x4<S>, gap: f64x4<S>| gap.simd_gt(0.0) & (gap + v * (SOON * h)).simd_lt(0.0);
            let gap1 = f64x4::from_slice(simd, &block.s1[at..end]) + moved1;
            let gap2 = f64x4::from_slice(simd, &block.s2[at..end]) + moved2;
            #[expect(clippy::cast_possible_truncation, reason = "four lanes")]
            let bits = (closes_fast & (met(v1, gap1) | met(v2, gap2))).to_bitmask() as u8;
            closes |= bits << at;
        }
        if closes != 0 {
            found.push((c, k, closes));
        }
    }
}

/// Normal velocity and gap of both points, and the acceleration along the normal.
fn motion(bodies: &Bodies, block: &Block, lane: usize) -> [[f64; 2]; 3] {
    let (a, b) = (block.a[lane] as usize, block.b[lane] as usize);
    let n = block.normal(lane);
    let pull = n.dot(bodies.pull[b].v() - bodies.pull[a].v());
    let (a, b) = (&bodies.lines[a], &bodies.lines[b]);
    [block.opening(lane, a, b), block.gaps(lane, a, b), [pull; 2]]
}

/// See [`Block::meet`].
fn meet(block: &mut Block, lane: usize, bodies: &Bodies) {
    let ends = [block.a[lane], block.b[lane]].map(|line| {
        let at = line as usize;
        (&bodies.lines[at], bodies.base[at].position)
    });
    if ends.iter().all(|(line, _)| line.inverse_mass() > 0.0) {
        block.meet(lane, ends);
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
        let [a, b] = arrival.lines.map(|line| &bodies.lines[line as usize]);
        for (leaves, gap) in arrival.leaves.iter_mut().zip(block.gaps(lane, a, b)) {
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
    for (arrival, bounce) in arrived.iter().zip(&bounces) {
        let [heat, given] = bounce.work(&bodies.lines, arrival.impulses[2]);
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
