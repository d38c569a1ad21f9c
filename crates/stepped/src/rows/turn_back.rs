//! Displacements of free bodies that velocities do not tell of add angular momentum: velocities turn by what gives it back.
//!
//! ```text
//! v_B − v_A                           turns by what gives that back, as far as a turn does
//! u, ω → f (u, ω) + (Ω × r, Ω)        all that touched, seen from its centre of mass, turns as one by the rest
//! ```
//! `f ≤ 1`, so that there is no more energy than before. What it is not enough for is lost: no motion of these bodies there has that
//! momentum.

use carom_math::{Vec2, perp};

use super::line::Quad;
use crate::LineIx;
use crate::bodies::Bodies;
use crate::groups::Groups;

/// How a pair turns back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) lines: [LineIx; 2],
    /// What it is to have more of angular momentum, in N·m·s.
    pub(super) moment: f64,
    /// The square of the greatest speed that B may have against A, in m²/s².
    pub(super) limit: f64,
}

/// Turns pairs, one after the other: all moments are those of the velocities that the displacements came with.
pub(super) fn turn_all(bodies: &mut Bodies, turns: &[Turn]) {
    let mut rests: Vec<([LineIx; 2], f64)> = Vec::new();
    for turn in turns {
        let rest = turn_pair(bodies, turn);
        if rest != 0.0 && !spin_pair(bodies, turn, rest) {
            rests.push((turn.lines, rest));
        }
    }
    if rests.is_empty() {
        return;
    }
    // Sums are in the order of births, since lines and lanes depend on other islands.
    let birth = |line: LineIx| bodies.birth_of_line(line);
    rests.sort_by_key(|(lines, _)| lines.map(birth));
    let mut lines: Vec<LineIx> = turns.iter().flat_map(|turn| turn.lines).collect();
    lines.sort_unstable_by_key(|line| birth(*line));
    lines.dedup();
    let place = |line: LineIx| lines.partition_point(|known| birth(*known) < birth(line));
    let mut groups = Groups::new(lines.len());
    for turn in turns {
        let [a, b] = turn.lines.map(place);
        groups.join(a, b);
    }
    let mut moved = vec![(Vec::new(), 0.0); lines.len()];
    for (k, line) in lines.iter().enumerate() {
        moved[groups.find(k)].0.push(*line);
    }
    for ([line, _], rest) in rests {
        moved[groups.find(place(line))].1 += rest;
    }
    for (lines, moment) in moved.iter().filter(|(_, moment)| *moment != 0.0) {
        turn_as_one(bodies, lines, *moment);
    }
}

/// Turns the velocity of B against A so that both have the moment more. It is as long as before, or as what displaced them if that was
/// faster and no turn is enough, and on which side of the line between both it points stays. What no turn gives, in N·m·s.
fn turn_pair(bodies: &mut Bodies, turn: &Turn) -> f64 {
    let [a, b] = turn.lines;
    let (first, second) = (&bodies.lines[a], &bodies.lines[b]);
    let (ma, mb) = (first.inverse_mass(), second.inverse_mass());
    let arm = bodies.centre_at(b) - bodies.centre_at(a);
    let v = second.v() - first.v();
    // By which arm × v is to change.
    let more = turn.moment * (ma + mb);
    let square = arm.length_squared();
    if square <= 0.0 {
        return turn.moment;
    }
    let (turns, parts) = (arm.perp_dot(v), arm.dot(v));
    // (arm · v)² + (arm × v)² stays.
    let left = parts * parts - more * (turns + turns + more);
    // What displaced them may have been faster: that energy is there.
    let most = (square * turn.limit)
        .max(parts * parts + turns * turns)
        .sqrt();
    let wanted = turns + more;
    let change = if wanted * wanted <= most * most {
        more
    } else {
        most.copysign(wanted) - turns
    };
    let parting = left.max(0.0).sqrt().copysign(parts) - parts;
    let scale = 1.0 / (square * (ma + mb));
    let push = (arm * parting + perp(arm) * change) * scale;
    for (line, push) in turn.lines.into_iter().zip([push * -ma, push * mb]) {
        bodies.push(line, &Quad::new(push, 0.0));
    }
    (more - change) / (ma + mb)
}

/// Gives the spins of a pair a moment, in N·m·s, unless they had more energy by it than such a speed of B against A has; whether it does.
fn spin_pair(bodies: &mut Bodies, turn: &Turn, moment: f64) -> bool {
    let (mut inertia, mut turns, mut inverse_mass) = (0.0, 0.0, 0.0);
    for line in turn.lines.map(|line| &bodies.lines[line]) {
        let own = line.inertia();
        inertia += own;
        turns += own * line.w();
        inverse_mass += line.inverse_mass();
    }
    if inertia <= 0.0 {
        return false;
    }
    let spin = moment / inertia;
    let energy = (turns + 0.5 * moment) * spin;
    let gives = energy <= 0.5 * turn.limit / inverse_mass;
    for line in turn.lines.into_iter().filter(|_| gives) {
        if bodies.lines[line].inverse_inertia() > 0.0 {
            bodies.push(line, &Quad::new(Vec2::ZERO, spin));
        }
    }
    gives
}

/// Bodies turn as one by what gives them a moment more, in N·m·s, and move as much slower against each other as their energy asks for.
fn turn_as_one(bodies: &mut Bodies, group: &[LineIx], moment: f64) {
    let (mut mass, mut middle, mut pushes) = (0.0, Vec2::ZERO, Vec2::ZERO);
    for &at in group {
        let m = 1.0 / bodies.lines[at].inverse_mass();
        mass += m;
        middle += bodies.centre_at(at) * m;
        pushes += bodies.lines[at].v() * m;
    }
    let (middle, mean) = (middle / mass, pushes / mass);
    // Angular momentum and moment of inertia about it, and twice the kinetic energy.
    let (mut turns, mut whole, mut energy) = (0.0, 0.0, 0.0);
    for &at in group {
        let line = &bodies.lines[at];
        let (arm, v) = (bodies.centre_at(at) - middle, line.v() - mean);
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
    for &at in group {
        let arm = bodies.centre_at(at) - middle;
        let line = &bodies.lines[at];
        let v = (line.v() - mean - perp(arm) * own) * part + perp(arm) * spin;
        let turns = line.inverse_inertia() > 0.0;
        let w = if turns {
            (line.w() - own) * part + spin
        } else {
            line.w()
        };
        let push = Quad::new(v + mean - line.v(), w - line.w());
        bodies.push(at, &push);
    }
}
