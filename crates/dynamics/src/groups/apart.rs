//! Which contacts of a sub-step hang together, and how each such group is solved for.

use core::ops::Range;

use super::{Row, SolverBody};
use crate::model::graph::Tree;
use crate::model::mass_ratio::{BEARS, mass_ratio};

/// Points of a group that are solved for at once; what has more is swept. A common stop takes the cube of its rows, of
/// which a point with friction has two.
const POINTS: usize = 48;

/// How a group of contacts is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// By one sweep of soft rows.
    Swept,
    /// Without springs: see [`crate::groups::round`].
    Round,
    /// By equations: see [`crate::groups::heavy`].
    AtOnce,
}

/// What is known of the group that one body stands for.
#[derive(Clone, Copy, Debug)]
struct Known {
    points: usize,
    heavy: bool,
    round: bool,
    /// Place among the groups that are set apart.
    number: usize,
}

impl Known {
    fn method(&self) -> Method {
        match (self.heavy, self.round) {
            (true, _) if self.points <= POINTS => Method::AtOnce,
            (false, true) => Method::Round,
            _ => Method::Swept,
        }
    }
}

/// Puts the rows of each group that is not swept, with where they came from, behind all others; the methods, and the rows of
/// each. What is swept comes first, all in one.
pub(crate) fn set_apart<S: Copy>(
    bodies: &[SolverBody],
    rows: &mut Vec<Row>,
    sources: &mut Vec<S>,
    is_round: impl Fn(&S) -> bool,
) -> Vec<(Method, Range<usize>)> {
    let moves = |place: u32| bodies[place as usize].inverse_mass > 0.0;
    let is_heavy = |row: &Row| {
        let (i, j) = row.bodies;
        mass_ratio([i, j].map(|place| bodies[place as usize].inverse_mass)) > BEARS
    };
    if !rows.iter().any(is_heavy) && !sources.iter().any(&is_round) {
        return vec![(Method::Swept, 0..rows.len())];
    }
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
        points: 0,
        heavy: false,
        round: true,
        number: 0,
    };
    let mut known = vec![unknown; bodies.len()];
    for ((row, source), root) in rows.iter().zip(&*sources).zip(&roots) {
        let group = &mut known[*root];
        group.points += row.points();
        group.heavy |= is_heavy(row);
        group.round &= is_round(source);
    }
    let mut methods = vec![Method::Swept];
    for root in &roots {
        let group = &mut known[*root];
        if group.number == 0 && group.method() != Method::Swept {
            group.number = methods.len();
            methods.push(group.method());
        }
    }
    // The sort is stable: rows of one number stay in their order.
    let mut all: Vec<(usize, Row, S)> = (0..rows.len())
        .map(|k| (known[roots[k]].number, rows[k], sources[k]))
        .collect();
    all.sort_by_key(|(number, ..)| *number);
    *rows = all.iter().map(|(_, row, _)| *row).collect();
    *sources = all.iter().map(|(.., source)| *source).collect();
    let start = |number: usize| all.partition_point(|one| one.0 < number);
    let groups = methods.iter().enumerate();
    groups
        .map(|(number, method)| (*method, start(number)..start(number + 1)))
        .collect()
}
