//! Free bodies that continuous collision shifted keep their angular momentum: shifts s of both bodies of a pair add `Σ m s × v`.

use carom_math::Vec2;

use super::line::{Line, Quad};
use super::turn_back::{Turn, turn_all};
use crate::LineIx;
use crate::bodies::Bodies;

/// Two free bodies that touched, by line, and how far each is off where it was going, in m.
pub(crate) type Shifted = ([LineIx; 2], [Vec2; 2]);

/// Gives back what shifts added; what that added to velocities, by line.
pub(crate) fn turn_shifted(bodies: &mut Bodies, shifted: &[Shifted]) -> Vec<(LineIx, Quad)> {
    let turn = |&(lines, shifts): &Shifted| {
        let added = lines.iter().zip(shifts).map(|(line, shift)| {
            let line = &bodies.lines[*line];
            shift.perp_dot(line.v()) / line.inverse_mass()
        });
        Turn {
            lines,
            moment: -added.sum::<f64>(),
            limit: 0.0,
        }
    };
    let turns: Vec<Turn> = shifted.iter().map(turn).collect();
    let mut lines: Vec<LineIx> = turns.iter().flat_map(|turn| turn.lines).collect();
    lines.sort_unstable();
    lines.dedup();
    let before: Vec<(LineIx, Line)> = lines
        .iter()
        .map(|line| (*line, bodies.lines[*line]))
        .collect();
    turn_all(bodies, &turns);
    lines.iter().for_each(|line| bodies.note_change(*line));
    let added = |(at, before): (LineIx, Line)| {
        let line = &bodies.lines[at];
        (at, Quad::new(line.v() - before.v(), line.w() - before.w()))
    };
    before.into_iter().map(added).collect()
}
