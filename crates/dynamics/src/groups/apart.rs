//! Which contacts of a sub-step hang together.

use core::ops::Range;

use super::{Row, SolverBody, Source};
use crate::model::graph::Tree;

/// What is known of the group that one body stands for.
#[derive(Clone, Copy, Debug)]
struct Known {
    is_round: bool,
    /// Place among the groups, from 1 on.
    number: usize,
}

/// Puts the rows of each group one after the other, with where they came from; whether all of them are round, and where they lie.
pub(super) fn set_apart(
    bodies: &[SolverBody],
    rows: &mut Vec<Row>,
    sources: &mut Vec<Source>,
) -> Vec<(bool, Range<usize>)> {
    let moves = |place: u32| bodies[place as usize].inverse_mass > 0.0;
    let mut groups = Tree::new(bodies.len());
    for row in rows.iter() {
        if moves(row.bodies.0) && moves(row.bodies.1) {
            groups.join(row.bodies.0, row.bodies.1);
        }
    }
    let mut of = |row: &Row| {
        let (i, j) = row.bodies;
        groups.root(if moves(i) { i } else { j }) as usize
    };
    let roots: Vec<usize> = rows.iter().map(&mut of).collect();
    let unknown = Known {
        is_round: true,
        number: 0,
    };
    let mut known = vec![unknown; bodies.len()];
    let mut first = Vec::new();
    for (source, root) in sources.iter().zip(&roots) {
        let group = &mut known[*root];
        group.is_round &= source.is_round;
        if group.number == 0 {
            first.push(*root);
            group.number = first.len();
        }
    }
    // The sort is stable: rows of one number stay in their order.
    let mut all: Vec<(usize, Row, Source)> = (0..rows.len())
        .map(|k| (known[roots[k]].number, rows[k], sources[k]))
        .collect();
    all.sort_by_key(|(number, ..)| *number);
    *rows = all.iter().map(|(_, row, _)| *row).collect();
    *sources = all.iter().map(|(.., source)| *source).collect();
    let start = |number: usize| all.partition_point(|one| one.0 < number);
    let groups = first.into_iter().zip(1..);
    groups
        .map(|(root, number)| (known[root].is_round, start(number)..start(number + 1)))
        .collect()
}
