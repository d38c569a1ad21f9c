//! Free bodies that continuous collision shifted keep their angular momentum.
//!
//! ```text
//! Σ m s × v                           is what shifts s of both bodies of a pair add
//! v_B − v_A                           turns by what gives that back, as far as a turn does
//! u, ω → f (u, ω) + (Ω × r, Ω)        all that touched, seen from its centre of mass, turns as one by the rest
//! ```
//! `f ≤ 1`, so that there is no more energy than before. What it is not enough for is lost: no motion of these bodies there has that
//! momentum.

use carom_math::{Vec2, perp};

use super::free::{Turn, turn_pair};
use super::line::{Line, Quad};
use crate::bodies::Bodies;
use crate::groups::Groups;

/// Two free bodies that touched, by line, and how far each is off where it was going, in m.
pub(crate) type Shifted = ([u32; 2], [Vec2; 2]);

/// Gives back what shifts added; what that added to velocities, by line.
pub(crate) fn turn_shifted(bodies: &mut Bodies, shifted: &[Shifted]) -> Vec<(u32, Quad)> {
    let turn = |&(lines, shifts): &([u32; 2], [Vec2; 2])| {
        let added = lines.iter().zip(shifts).map(|(line, shift)| {
            let line = &bodies.lines[*line as usize];
            shift.perp_dot(line.v()) / line.inverse_mass()
        });
        Turn {
            lines,
            moment: -added.sum::<f64>(),
            limit: 0.0,
        }
    };
    let turns: Vec<Turn> = shifted.iter().map(turn).collect();
    let mut lines: Vec<u32> = turns.iter().flat_map(|turn| turn.lines).collect();
    lines.sort_unstable();
    lines.dedup();
    let before: Vec<(u32, Line)> = lines
        .iter()
        .map(|line| (*line, bodies.lines[*line as usize]))
        .collect();
    let rests: Vec<f64> = turns.iter().map(|turn| turn_pair(bodies, turn)).collect();
    if rests.iter().any(|rest| *rest != 0.0) {
        let place = |line: u32| lines.partition_point(|known| *known < line);
        let mut groups = Groups::new(lines.len());
        for turn in &turns {
            let [a, b] = turn.lines.map(place);
            groups.join(a, b);
        }
        let mut moved = vec![(Vec::new(), 0.0); lines.len()];
        for (k, line) in lines.iter().enumerate() {
            moved[groups.find(k)].0.push(*line);
        }
        for (turn, rest) in turns.iter().zip(rests) {
            moved[groups.find(place(turn.lines[0]))].1 += rest;
        }
        for (lines, moment) in moved.iter().filter(|(_, moment)| *moment != 0.0) {
            turn_as_one(bodies, lines, *moment);
        }
    }
    lines.iter().for_each(|line| bodies.note_change(*line));
    let added = |(at, before): (u32, Line)| {
        let line = &bodies.lines[at as usize];
        (at, Quad::new(line.v() - before.v(), line.w() - before.w()))
    };
    before.into_iter().map(added).collect()
}

/// Bodies turn as one by what gives them a moment more, in N·m·s, and move as much slower against each other as their energy asks for.
fn turn_as_one(bodies: &mut Bodies, lines: &[u32], moment: f64) {
    let lines = || lines.iter().map(|line| *line as usize);
    let centre = |bodies: &Bodies, at: usize| bodies.base[at].position + bodies.lines[at].d();
    let (mut mass, mut middle, mut pushes) = (0.0, Vec2::ZERO, Vec2::ZERO);
    for at in lines() {
        let m = 1.0 / bodies.lines[at].inverse_mass();
        mass += m;
        middle += centre(bodies, at) * m;
        pushes += bodies.lines[at].v() * m;
    }
    let (middle, mean) = (middle / mass, pushes / mass);
    // Angular momentum and moment of inertia about it, and twice the kinetic energy.
    let (mut turns, mut whole, mut energy) = (0.0, 0.0, 0.0);
    for at in lines() {
        let line = &bodies.lines[at];
        let (arm, v) = (centre(bodies, at) - middle, line.v() - mean);
        let mut add = |inertia: f64, spin: f64, square: f64| {
            turns += inertia * spin;
            whole += inertia * square;
        };
        let m = 1.0 / line.inverse_mass();
        add(m, arm.perp_dot(v), arm.length_squared());
        energy += m * v.length_squared();
        if line.inverse_inertia() > 0.0 {
            let inertia = 1.0 / line.inverse_inertia();
            add(inertia, line.w(), 1.0);
            energy += inertia * line.w() * line.w();
        }
    }
    if whole <= 0.0 {
        return;
    }
    let fastest = (energy / whole).sqrt();
    let spin = ((turns + moment) / whole).max(-fastest).min(fastest);
    let own = turns / whole;
    let (left, against) = (energy - whole * spin * spin, energy - whole * own * own);
    let part = (left / against).max(0.0).sqrt().min(1.0);
    for at in lines() {
        let arm = centre(bodies, at) - middle;
        let line = &bodies.lines[at];
        let v = (line.v() - mean - perp(arm) * own) * part + perp(arm) * spin;
        let turns = line.inverse_inertia() > 0.0;
        let w = if turns {
            (line.w() - own) * part + spin
        } else {
            line.w()
        };
        let push = Quad::new(v + mean - line.v(), w - line.w());
        bodies.lines[at].add(&push);
        bodies.start[at].add(&push);
    }
}
