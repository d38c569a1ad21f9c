//! Where a mode ends: the first instant at which one of its margins falls to 0.

use carom_math::{Vec2, falling_root};

use super::equations::{Equations, Workspace};
use super::{AT_ONCE, Tangent};
use crate::law::path::Path;
use crate::law::path::Place;

/// Instants of a stretch at which margins are looked at.
const LOOKS: u32 = 12;

/// A margin below this part of what it is the difference of is 0.
pub(super) const NOTHING: f64 = 1e-12;

/// A force below this part of the largest weight is rounding, where no path is found for it: a disc that leaves a corner has 9e-17,
/// all others without a path in the tests 2e-3 or more, or a pull.
const FAINT: f64 = 1e-12;

/// What a margin belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Limit {
    /// A normal force: the point opens.
    Press { contact: usize, point: usize },
    /// What friction could hold beyond what it does: it begins to slip, with this sign.
    Grip { contact: usize, sign: f64 },
    /// Slip against the sign that it has: it comes to rest.
    Slip { contact: usize },
    /// A disc or a corner comes to the end of an edge.
    Way { contact: usize, point: usize },
    /// A corner lands on the edge of a contact, or a point that had opened closes.
    Corner {
        contact: usize,
        normal: Vec2,
        at: Vec2,
    },
}

/// A margin at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    pub(super) limit: Limit,
    pub(super) value: f64,
    /// What counts as 0.
    pub(super) nothing: f64,
}

/// What ends a mode.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// Nothing does as long as the path is known.
    Open,
    /// The mode is none: this margin falls below 0 from the start.
    Never(Limit),
    /// After so many seconds.
    After(f64, Limit),
    /// Forces were not found.
    Lost,
}

/// A closed point with a normal force of no more than rounding of the weights.
pub(super) fn faint(equations: &Equations, places: &[Place]) -> Option<Limit> {
    let mut workspace = Workspace::default();
    let forces = equations.forces(places, &mut workspace)?;
    let pulled = equations.bodies.iter().zip(&equations.pulls);
    let pulled = pulled.filter(|(body, _)| body.inverse_mass > 0.0);
    let weights = pulled.map(|(body, (pull, _))| pull.length() / body.inverse_mass);
    let least = FAINT * weights.fold(0.0, f64::max);
    let all = equations.holds.iter().zip(&forces.normal).enumerate();
    let mut points = all.flat_map(|(contact, (hold, normal))| {
        (0..2).map(move |point| (contact, point, hold.closed[point], normal[point]))
    });
    let found = points.find(|(.., closed, force)| *closed && force.abs() <= least);
    found.map(|(contact, point, ..)| Limit::Press { contact, point })
}

/// The margins of a path.
struct Margins<'a> {
    equations: &'a Equations,
    path: &'a dyn Path,
    /// A length in m and a speed in m/s that roundings are measured by.
    sizes: (f64, f64),
    workspace: Workspace,
    places: Vec<Place>,
    /// Those of the last instant that was asked for.
    list: Vec<Left>,
}

impl Margins<'_> {
    /// All of them `t` seconds after the start; `None` where forces were not found.
    fn at(&mut self, t: f64) -> Option<&[Left]> {
        let (size, speed) = self.sizes;
        let Self {
            equations,
            path,
            workspace,
            places,
            list,
            ..
        } = self;
        path.write_places(t, places);
        list.clear();
        let forces = equations.forces(places, workspace)?;
        let most = forces.normal.iter().flatten();
        let most = most.fold(0.0_f64, |most, force| most.max(force.abs()));
        let mut add = |limit: Limit, value: f64, scale: f64| {
            list.push(Left {
                limit,
                value,
                nothing: NOTHING * scale,
            });
        };
        for (contact, (of, hold)) in equations.contacts.iter().zip(&equations.holds).enumerate() {
            let (a, b) = (&places[of.bodies.0], &places[of.bodies.1]);
            let mut slips = None;
            let mut pressed = 0.0;
            for (point, joint) in of.joints.iter().enumerate() {
                let seen = joint.seen(a, b);
                let ends = |lands: Option<Vec2>| {
                    let corner = |at| Limit::Corner {
                        contact,
                        normal: seen.normal,
                        at,
                    };
                    lands.map_or(Limit::Way { contact, point }, corner)
                };
                if hold.over[point] {
                    if hold.shares.is_some() {
                        for (left, lands) in joint.margins(a, b) {
                            add(ends(lands), left, size);
                        }
                    }
                    continue;
                }
                if !hold.closed[point] {
                    let limit = Limit::Corner {
                        contact,
                        normal: seen.normal,
                        at: seen.point,
                    };
                    add(limit, seen.gap, size);
                    continue;
                }
                slips.get_or_insert(seen.slip);
                let force = forces.normal[contact][point];
                pressed += force;
                add(Limit::Press { contact, point }, force, most);
                for (left, lands) in joint.margins(a, b) {
                    add(ends(lands), left, size);
                }
            }
            match (hold.rub, slips) {
                (Tangent::Holds, Some(_)) => {
                    let pull = forces.tangential[contact];
                    let limit = Limit::Grip {
                        contact,
                        sign: -pull.signum(),
                    };
                    add(limit, of.friction * pressed - pull.abs(), most);
                }
                (Tangent::Slides(sign), Some(slip)) => {
                    add(Limit::Slip { contact }, slip * sign, speed);
                }
                _ => {}
            }
        }
        Some(&self.list)
    }

    fn one(&mut self, i: usize, t: f64) -> Option<Left> {
        self.at(t)?.get(i).copied()
    }
}

/// The first margin to fall to 0.
pub(super) fn first(equations: &Equations, path: &dyn Path, sizes: (f64, f64)) -> End {
    let mut margins = Margins {
        equations,
        path,
        sizes,
        workspace: Workspace::default(),
        places: Vec::new(),
        list: Vec::new(),
    };
    let Some(mut before) = margins.at(0.0).map(<[Left]>::to_vec) else {
        return End::Lost;
    };
    // What begins at 0 counts once it has been above.
    let mut armed: Vec<bool> = before.iter().map(|m| m.value > m.nothing).collect();
    let (mut now, mut from) = (Vec::new(), 0.0);
    for k in 1..=LOOKS {
        let to = path.length() * f64::from(k) / f64::from(LOOKS);
        now.clear();
        match margins.at(to) {
            Some(list) => now.extend_from_slice(list),
            None => return End::Lost,
        }
        if now.len() != before.len() {
            return End::Lost;
        }
        let mut found: Option<(f64, Limit)> = None;
        for (i, margin) in now.iter().enumerate() {
            if margin.value > margin.nothing {
                armed[i] = true;
                continue;
            }
            let mut above = (from, before[i].value);
            if !armed[i] {
                if margin.value >= -margin.nothing {
                    continue;
                }
                match rise(&mut margins, i, to) {
                    Some(risen) => above = risen,
                    None => return End::Never(margin.limit),
                }
            }
            if margin.value > 0.0 {
                continue;
            }
            let Some((after, limit)) = fall(&mut margins, i, above, (to, margin.value)) else {
                return End::Lost;
            };
            if found.is_none_or(|(known, _)| after < known) {
                found = Some((after, limit));
            }
        }
        if let Some((after, limit)) = found {
            return End::After(after, limit);
        }
        core::mem::swap(&mut before, &mut now);
        from = to;
    }
    End::Open
}

/// An instant before `to` at which margin `i`, which is 0 at the start and has fallen at `to`, is above 0: a corner that opens
/// may be back before the first look.
fn rise(margins: &mut Margins<'_>, i: usize, to: f64) -> Option<(f64, f64)> {
    let mut after = 0.5 * to;
    while after > AT_ONCE {
        let margin = margins.one(i, after)?;
        if margin.value > margin.nothing {
            return Some((after, margin.value));
        }
        if margin.value >= -margin.nothing {
            // So near the start that rounding hides which way it goes.
            return None;
        }
        after *= 0.5;
    }
    None
}

/// Where margin `i` falls through 0 between two looks.
fn fall(
    margins: &mut Margins<'_>,
    i: usize,
    above: (f64, f64),
    below: (f64, f64),
) -> Option<(f64, Limit)> {
    let root = falling_root(above, below, |t| Some(margins.one(i, t)?.value))?;
    Some((root, margins.one(i, root)?.limit))
}

/// Heat by friction in the first `elapsed` seconds, in J: Gauss–Legendre in two halves.
pub(super) fn heat(equations: &Equations, path: &dyn Path, elapsed: f64) -> f64 {
    /// Points and weights of (−1, 1), mirrored.
    const POINTS: [(f64, f64); 3] = [
        (0.238_619_186_083_196_9, 0.467_913_934_572_691_05),
        (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
        (0.932_469_514_203_152, 0.171_324_492_379_170_35),
    ];
    let slides = |hold: &super::Hold| matches!(hold.rub, Tangent::Slides(_));
    if !equations.holds.iter().any(slides) {
        return 0.0;
    }
    let mut workspace = Workspace::default();
    let mut power = |t: f64| {
        let places = path.places_after(t);
        let Some(forces) = equations.forces(&places, &mut workspace) else {
            return 0.0;
        };
        let seen = equations.seen(&places);
        let both = seen.iter().zip(&equations.holds).zip(&forces.tangential);
        both.map(|((seen, hold), pull)| {
            let points = seen.iter().zip(hold.closed);
            let mut closed = points.filter_map(|(seen, closed)| seen.filter(|_| closed));
            closed.next().map_or(0.0, |seen| -pull * seen.slip)
        })
        .sum::<f64>()
    };
    let half = 0.25 * elapsed;
    let mut sum = 0.0;
    for middle in [half, 3.0 * half] {
        for (at, weight) in POINTS {
            sum += weight * (power(middle - half * at) + power(middle + half * at));
        }
    }
    half * sum
}
