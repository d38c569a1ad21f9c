//! When a pair is looked at again: not before its motion since the last look can matter.
//!
//! A look leaves a strip between the two bodies (or says by how much they overlap), and rows for all that is
//! nearer than the look's margin. Both are followed in the frame of the larger body, F: with r from its centre to
//! that of the smaller one, S, at the look, and φ, ψ what either turned since,
//!
//! ```text
//! moved    r' − R(φ) r                         what S moved by, as F sees it
//! swung    rim_S |ψ − φ|                       what its points moved by beside that, at most
//! strip    gap + n·moved − swung               n turns with F
//! others   margin − |moved| − swung            nearest that anything can be that has no row
//! ```
//! As long as the strip is wider than what both go in a sub-step nothing can happen; and rows stay those of the
//! pair as long as `|moved| + swung` is small against its size and its normals keep their directions.

use carom_math::{SimTime, Vec2, perp};

use super::depths::BEARS;
use super::faces::GIVES;
use super::seats::Seat;
use crate::World;
use crate::pairs::Glance;
use crate::solver::{Line, Pull};

/// How far a body may move before it is asked about, as a fraction of the smallest reach about it: 5 mm for boxes
/// of 1 m.
pub(super) const LEASH: f64 = 0.007;

/// Who is off its way by more within a tick, as the same fraction, is asked about again: 57 mm for boxes of 1 m.
pub(super) const STRAY: f64 = 0.08;

/// Two bodies that moved less than this against each other since their contacts were found, as a fraction of the
/// smaller reach, keep them: normals of a box of 1 m that turned by as much are off by 0.014 rad.
pub(super) const KEPT_APART: f64 = 0.014;

/// The same for two that push each other: 20 mm for boxes of 1 m.
const KEPT: f64 = 0.028;

/// What two bodies may do against each other that nobody asked about: each its leash, and off its way.
pub(super) const RESERVE: f64 = 2.0 * (LEASH + STRAY);

/// The same within a tick at whose start both were asked about.
const SPARE: f64 = 2.0 * STRAY;

/// Contacts are sought so far beyond a tick's travel: they must do until the pair moved by what keeps it.
pub(super) const MARGIN: f64 = KEPT_APART + RESERVE;

/// Rows of a pair that are so much farther apart than they can come until the next tick are let go. Less only means
/// that rows come and go more often.
const LET_GO: f64 = 0.028;

/// Normals are kept in the world: a pair that turned by more, in rad, is looked at again.
const TURNED: f64 = 0.1;

/// A pair that moves against each other by so much of its smaller reach in a tick is asked in every sub-step
/// while it has rows that act: 11 m/s for boxes of 1 m.
const QUICK: f64 = 0.25;

/// So is one of which a body turns by so much in a tick, in rad, 3.8 rad/s: gaps are linear in the turn, and off by
/// ½ r θ², 1.4 mm for boxes of 1 m.
const WHIRL: f64 = 0.063;

/// Where the larger body turned by more since a look, in rad, nobody knows what is left of the strip.
const LOST: f64 = 0.25;

/// What a pair wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wish {
    /// Nothing can come of it before the next tick, as its bodies move now.
    Rest,
    /// The same, and none of its rows is needed.
    LetGo,
    /// To be asked again after so many sub-steps.
    Wait(u32),
    Look,
}

/// How two bodies move against each other: the smaller one as the larger one sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Against {
    /// Of the centre of the smaller one, in m/s.
    v: Vec2,
    /// Of its points about the centre, in m/s.
    swing: f64,
    /// In rad/s, the faster of both.
    whirl: f64,
    /// Difference of what pulls on both, in m/s².
    pull: f64,
    size: f64,
}

impl Against {
    #[inline]
    pub(super) fn new(seats: [&Seat; 2], lines: [&Line; 2], pulls: [Pull; 2]) -> Self {
        let (f, s) = larger_first(seats);
        let apart = seats[s].base.position + lines[s].d() - seats[f].base.position - lines[f].d();
        let (w_f, w_s) = (spin(seats[f], lines[f]), spin(seats[s], lines[s]));
        let carried = if w_f == 0.0 {
            Vec2::ZERO
        } else {
            perp(apart) * w_f
        };
        let pull = pulls[1].acceleration - pulls[0].acceleration;
        Self {
            v: lines[s].v() - lines[f].v() - carried,
            swing: swing(seats[s].rim, w_s - w_f),
            whirl: w_f.abs().max(w_s.abs()),
            pull: if pull == Vec2::ZERO {
                0.0
            } else {
                pull.length()
            },
            size: seats[0].reach.min(seats[1].reach),
        }
    }

    /// Fastest that two points of them can approach, in m/s.
    pub(super) fn speed(&self) -> f64 {
        self.v.length() + self.swing
    }

    pub(super) const fn pull(&self) -> f64 {
        self.pull
    }

    /// Whether rows found at a tick would not serve until the next. By the turn in [`crate::Mode::Stepped`] alone:
    /// jammed columns in a crowd of hybrid mode hummed at 0.6 m/s with it.
    pub(super) fn is_quick(&self, tick: f64, stepped: bool) -> bool {
        stepped && self.whirl * tick > WHIRL || self.speed() * tick > QUICK * self.size
    }
}

/// How far a pull moves apart or together within some seconds, in m.
pub(super) const fn fall(pull: f64, seconds: f64) -> f64 {
    0.5 * pull * seconds * seconds
}

/// What a turn moves the rim by; a disc and what does not turn stay where they are.
#[inline]
fn swing(rim: f64, by: f64) -> f64 {
    if by == 0.0 { 0.0 } else { rim * by.abs() }
}

/// A disc turns into itself.
#[inline]
fn spin(seat: &Seat, line: &Line) -> f64 {
    if seat.rim > 0.0 { line.w() } else { 0.0 }
}

/// Which of two bodies is the frame, and which is followed in it.
#[inline]
fn larger_first([a, b]: [&Seat; 2]) -> (usize, usize) {
    let second = usize::from(a.rim < b.rim);
    (second, 1 - second)
}

/// What became of a pair since its last look.
struct Since {
    /// Of the smaller one's centre, in m.
    moved: Vec2,
    /// Of its points beside that, at most, in m.
    swung: f64,
    /// From the larger to the smaller; zero if the look left none.
    normal: Vec2,
    /// What the gaps of rows are off by for a larger one that turned, in m.
    bent: f64,
    /// Some normal is stale.
    stale: bool,
    /// The larger one turned too far for what is known of it to be followed.
    lost: bool,
}

impl Since {
    #[inline]
    fn new(glance: &Glance, seats: [&Seat; 2], lines: [&Line; 2]) -> Self {
        let (f, s) = larger_first(seats);
        let (apart, angles) = lie_of(seats, lines);
        let sign = if f == 0 { 1.0 } else { -1.0 };
        let turns = [angles.0 - glance.angles.0, angles.1 - glance.angles.1];
        let turn = |k: usize| if seats[k].rim > 0.0 { turns[k] } else { 0.0 };
        let (by, own) = (turn(f), turn(s));
        let (then, now) = (glance.apart * sign, apart * sign);
        let n = glance.normal * sign;
        let mut since = Self {
            moved: now - then,
            swung: swing(seats[s].rim, own - by),
            normal: n,
            bent: 0.0,
            stale: by.abs() > TURNED || own.abs() > TURNED,
            lost: by.abs() > LOST,
        };
        if by != 0.0 {
            // R(φ) = 1 + φ ⟂ − φ²/2 up to |φ|³/6, of the way as of the normal.
            let half = 0.5 * by * by;
            since.moved += then * half - perp(then) * by;
            since.normal = n * (1.0 - half) + perp(n) * by;
            since.bent = half * then.length();
            let third = by.abs() * (1.0 / 3.0);
            since.swung += (since.bent + half * since.moved.length()) * third;
        }
        since
    }

    /// What the smaller one's points moved by, at most, in m.
    #[inline]
    fn went(&self) -> f64 {
        self.moved.length() + self.swung
    }

    /// Strip between the bodies, in m.
    #[inline]
    fn strip(&self, gap: f64) -> f64 {
        if self.normal == Vec2::ZERO {
            gap - self.went()
        } else {
            gap + self.normal.dot(self.moved) - self.swung
        }
    }
}

/// From the centre of A to that of B, in m, and the angles of both.
pub(super) fn lie_of([a, b]: [&Seat; 2], lines: [&Line; 2]) -> (Vec2, (f64, f64)) {
    let centres = [
        a.base.position + lines[0].d(),
        b.base.position + lines[1].d(),
    ];
    let angles = (
        a.base_angle + lines[0].turn(),
        b.base_angle + lines[1].turn(),
    );
    (centres[1] - centres[0], angles)
}

/// Whether a pair plainly needs nothing before the next tick: most of those that rest do not, and are told by sums of
/// magnitudes, which are never less than what [`Since`] and [`Against`] make of the same motion.
#[inline]
fn hardly_moves(
    glance: &Glance,
    seats: [&Seat; 2],
    lines: [&Line; 2],
    pulls: [Pull; 2],
    [ahead, tick]: [f64; 2],
) -> bool {
    let sum = |v: Vec2| v.x.abs() + v.y.abs();
    let size = seats[0].reach.min(seats[1].reach);
    let rims = [seats[0].rim, seats[1].rim];
    let (apart, angles) = lie_of(seats, lines);
    let turns = [
        (angles.0 - glance.angles.0).abs(),
        (angles.1 - glance.angles.1).abs(),
    ];
    let spins = [lines[0].w().abs(), lines[1].w().abs()];
    // Either may be the frame, and the other's points lie around its centre.
    let about = |by: [f64; 2], r: f64| {
        let all = |k: usize| {
            if by[k] * rims[k] > 0.0 {
                by[k] * (r + rims[k])
            } else {
                0.0
            }
        };
        all(0) + all(1)
    };
    let moved = sum(apart - glance.apart) + about(turns, sum(glance.apart));
    let speed = sum(lines[1].v() - lines[0].v()) + about(spins, sum(apart));
    let fall = fall(
        sum(pulls[1].acceleration - pulls[0].acceleration),
        ahead + tick,
    );
    let (free, kept) = if glance.rows {
        (glance.sought, moved <= KEPT_APART * size)
    } else {
        (glance.sought.max(glance.gap), true)
    };
    let slow = speed * tick <= QUICK * size && spins[0].max(spins[1]) * tick <= WHIRL;
    kept && slow && free - moved > speed * ahead + fall + RESERVE * size
}

impl World {
    /// Looks at a pair if it must be, and notes when to ask it again before the next tick.
    pub(super) fn attend(&mut self, place: u32, time: SimTime, moved: &mut Vec<u32>) {
        let left = self.pool.until_look;
        let mut wish = self.wish(place);
        if wish == Wish::Rest && self.may_give(place) {
            wish = Wish::Look;
        }
        if wish == Wish::Look {
            if !self.look_at(place, time, moved) {
                return;
            }
            wish = self.wish(place);
        } else {
            let glance = self.pairs.glance(place);
            if glance.load > BEARS || glance.buried {
                let load = glance.load;
                self.pool.depths.note(self.pairs.get(place), load);
            }
        }
        let after = match wish {
            Wish::Rest => return,
            Wish::LetGo => return self.let_go(place, time),
            Wish::Wait(after) => after,
            Wish::Look => 1,
        };
        let glance = self.pairs.glance_mut(place);
        // 0 is the next tick, which asks everybody.
        let due = left.saturating_sub(after);
        if due > glance.due {
            glance.due = due;
            self.pool.watched.push((due, place));
        }
    }

    /// Whether the light body of a pair may give way to the heavy one in this tick, or the pair is deep in each other:
    /// rows are swept often while that is so, and only a look tells. Asked at ticks.
    fn may_give(&self, place: u32) -> bool {
        let glance = self.pairs.glance(place);
        if !(glance.rows && (glance.heavy || glance.buried))
            || self.pool.until_look < self.settings.substeps_per_tick()
        {
            return false;
        }
        if glance.buried {
            return true;
        }
        let seats = &self.pool.seats;
        let (Some(a), Some(b)) = (seats.slot(glance.bodies.0), seats.slot(glance.bodies.1)) else {
            return false;
        };
        let slots = [a, b];
        let against = Against::new(
            slots.map(|slot| seats.get(slot)),
            slots.map(|slot| &seats.rig.lines[slot as usize]),
            [Pull::default(); 2],
        );
        glance.load > BEARS || against.speed() * self.settings.tick > GIVES * against.size
    }

    /// What becomes of a pair until the next tick, as its bodies move now.
    #[inline]
    fn wish(&self, place: u32) -> Wish {
        let glance = self.pairs.glance(place);
        let seats = &self.pool.seats;
        let slots = [glance.bodies.0, glance.bodies.1].map(|index| seats.slot(index));
        let (true, [Some(a), Some(b)]) = (glance.holds, slots) else {
            return Wish::Look;
        };
        let slots = [a, b];
        let both = slots.map(|slot| seats.get(slot));
        let lines = slots.map(|slot| &seats.rig.lines[slot as usize]);
        let pulls = slots.map(|slot| seats.rig.pull(slot));
        let (h, tick) = (self.clock.h, self.settings.tick);
        let left = self.pool.until_look;
        let ahead = f64::from(left) * h;
        if hardly_moves(glance, both, lines, pulls, [ahead, tick]) {
            return Wish::Rest;
        }
        let since = Since::new(glance, both, lines);
        if since.lost {
            return Wish::Look;
        }
        let against = Against::new(both, lines, pulls);
        let size = against.size;
        let closing = if since.normal == Vec2::ZERO {
            against.speed()
        } else {
            (-since.normal.dot(against.v)).max(0.0) + against.swing
        };
        let fall = fall(against.pull, ahead + tick);
        let strip = since.strip(glance.gap);
        let room = strip - closing * ahead - fall - RESERVE * size;
        if room > 0.0 {
            return if glance.rows && room > LET_GO * size {
                Wish::LetGo
            } else {
                Wish::Rest
            };
        }
        let (went, speed) = (since.went(), against.speed());
        let quick = against.is_quick(tick, self.moves_all());
        // Sub-steps, of those that are left, for which so much room lasts.
        let lasts = |room: f64, rate: f64| {
            let rate = rate + 0.5 * against.pull * ahead;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "what is negative or no number becomes 0"
            )]
            let steps = (room / (rate * h)).min(f64::from(left)) as u32;
            steps
        };
        let near = KEPT_APART * size;
        let free = lasts(strip - SPARE * size, closing);
        if quick && free > 0 {
            return if free < left {
                Wish::Wait(free)
            } else {
                Wish::Rest
            };
        }
        let strain = went + since.bent;
        let kept = !since.stale
            && (strain <= near
                || strain <= KEPT * size && {
                    // Asked of the rows: what callers were told last depends on when they looked.
                    let contacts = &self.pairs.get(place).contacts;
                    let mut rows = contacts.iter().filter_map(|contact| contact.row);
                    rows.any(|id| seats.rig.pushes(id))
                });
        // Nothing without a row is nearer than this.
        let bare = glance.sought - went;
        let bare = if glance.rows { bare } else { bare.max(strip) };
        if quick {
            return if kept && lasts(bare - SPARE * size, speed) > 0 {
                Wish::Wait(1)
            } else {
                Wish::Look
            };
        }
        if kept && bare > speed * ahead + fall + RESERVE * size {
            Wish::Rest
        } else if free > 0 && free < left {
            Wish::Wait(free)
        } else {
            Wish::Look
        }
    }

    /// Takes the rows of a pair whose bodies are far apart.
    fn let_go(&mut self, place: u32, time: SimTime) {
        let pair = self.pairs.get_mut(place);
        self.pool.release(pair);
        pair.contacts.clear();
        pair.fresh = false;
        let touched = pair.touching;
        let glance = self.pairs.glance_mut(place);
        (glance.rows, glance.sought) = (false, f64::NEG_INFINITY);
        (glance.load, glance.buried) = (1.0, false);
        if touched {
            self.judge(place, time);
        }
    }

    /// Pairs that are to be asked now.
    pub(super) fn pairs_due(&mut self) -> Vec<u32> {
        let now = self.pool.until_look;
        let mut due = Vec::new();
        let pairs = &mut self.pairs;
        self.pool.watched.retain(|&(at, place)| {
            let later = at < now;
            let glance = pairs.glance_mut(place);
            if !later && glance.due == at {
                glance.due = 0;
                due.push(place);
            }
            later
        });
        due
    }

    /// A tick begins: everybody is asked.
    pub(super) fn forget_watched(&mut self) {
        for (_, place) in self.pool.watched.drain(..) {
            self.pairs.glance_mut(place).due = 0;
        }
    }
}
