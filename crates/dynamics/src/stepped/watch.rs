//! When a pair is looked at again: not before its motion since the last look (`relative`) can matter.

use core::hint::black_box;

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use super::relative::{Against, QUICK, Since, fall};
use super::stand::Stand;
use crate::World;
use crate::pairs::{Glance, Rows};

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

/// Contacts of two that move against each other are sought farther by what they go in another tick, and by no more than this,
/// as a fraction of the smaller reach: who keeps its contacts knows all that may come then.
const FARTHER: f64 = 0.046;

/// How much farther contacts are sought of a pair that goes `travel` in a tick, in m.
pub(super) fn farther(travel: f64, size: f64) -> f64 {
    travel.min(FARTHER * size)
}

/// Rows of a pair that are so much farther apart than they can come until the next tick are let go. Less only means
/// that rows come and go more often.
const LET_GO: f64 = 0.028;

/// A pair of which a body turns by so much in a tick, in rad, 3.8 rad/s, is asked at length: gaps are linear in the turn, and
/// off by ½ r θ², 1.4 mm for boxes of 1 m.
const WHIRL: f64 = 0.063;

/// So many pairs are asked one after the other, before those of them that want it are looked at: what they answer takes 4 KB.
const AT_ONCE: usize = 32;

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

/// How the bodies of a pair move against each other, and where they sit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub(super) slots: [u32; 2],
    pub(super) against: Against,
}

/// Whether a pair plainly needs nothing before the next tick: most of those that rest do not, and are told by sums of
/// magnitudes, which are never less than what [`Since`] and [`Against`] make of the same motion.
#[inline]
fn hardly_moves(glance: &Glance, both: [&Stand; 2], ahead: f64, tick: f64) -> bool {
    let size = both[0].reach.min(both[1].reach);
    let rims = [both[0].rim, both[1].rim];
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
    let spins = [both[0].spin.abs(), both[1].spin.abs()];
    if spins[0].max(spins[1]) * tick > WHIRL {
        return false;
    }
    let apart = both[1].centre - both[0].centre;
    let speed = sum(both[1].v - both[0].v) + about(spins, sum(apart));
    if speed * tick > QUICK * size {
        return false;
    }
    let turns = [
        (both[0].angle - glance.angles.0).abs(),
        (both[1].angle - glance.angles.1).abs(),
    ];
    let moved = sum(apart - glance.apart) + about(turns, sum(glance.apart));
    let free = if glance.has_rows() {
        if moved > KEPT_APART * size {
            return false;
        }
        glance.sought
    } else {
        glance.sought.max(glance.gap)
    };
    let fall = fall(sum(both[1].pull - both[0].pull), ahead + tick);
    free - moved > speed * ahead + fall + RESERVE * size
}

/// A bound on the length of a vector, √2 of it at most.
#[inline]
fn sum(v: Vec2) -> f64 {
    v.x.abs() + v.y.abs()
}

impl World {
    /// Attends to pairs, some of which may be gone; `parts`: those whose boxes parted are let go.
    pub(super) fn attend(
        &mut self,
        pairs: &mut impl Iterator<Item = u32>,
        time: SimTime,
        parts: bool,
    ) {
        loop {
            let places: ArrayVec<u32, AT_ONCE> = pairs.take(AT_ONCE).collect();
            if places.is_empty() {
                return;
            }
            // What one is asked does not wait for what another answers, so that memory is read side by side.
            let known: ArrayVec<_, AT_ONCE> =
                places.iter().map(|place| self.slots_of(*place)).collect();
            for slots in known.iter().flatten() {
                self.pool.seats.take_stand(*slots);
            }
            let wishes: ArrayVec<_, AT_ONCE> = (places.iter().zip(known))
                .map(|(place, slots)| self.wish(*place, slots))
                .collect();
            let looks = places.iter().zip(&wishes);
            let looks = looks.filter(|(_, (wish, moving))| *wish == Wish::Look && moving.is_some());
            self.read_ahead(looks.map(|(place, _)| *place));
            for (place, (wish, moving)) in places.into_iter().zip(wishes) {
                // Whoever wakes joins a crowd, and leaves pairs behind.
                let glance = self.pairs.glance(place);
                if !glance.is_there() {
                    continue;
                }
                debug_assert!(
                    glance.holds || wish == Wish::Look && moving.is_none(),
                    "who was asked kept its line while others were looked at"
                );
                if parts && !self.keeps(place) {
                    self.part(place, time);
                } else {
                    self.heed(place, (wish, moving), time);
                }
            }
        }
    }

    /// Reads the rows of pairs that are looked at next, all at once: each look would wait for its own.
    fn read_ahead(&self, places: impl Iterator<Item = u32>) {
        let rig = &self.pool.seats.rig;
        let known = places.filter_map(|place| {
            let id = self.pairs.rows_of(place).next()?;
            let contact = self.pairs.get(place).contacts.first()?;
            // Where they lie first: what leads there is waited for side by side, too.
            Some((contact, rig.lanes.at(id)))
        });
        let known: ArrayVec<_, AT_ONCE> = known.collect();
        let sums = known
            .into_iter()
            .map(|(contact, (wide, lane))| contact.tangent_impulse + wide.sum_of(lane));
        black_box(sums.sum::<f64>());
    }

    /// Looks at a pair if it must be, and notes when to ask it again before the next tick.
    fn heed(&mut self, place: u32, (mut wish, moving): (Wish, Option<Moving>), time: SimTime) {
        let left = self.pool.until_look;
        if wish == Wish::Look {
            let Some(quick) = self.look_at(place, time, moving) else {
                return;
            };
            wish = self.wish_after(place, &quick);
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

    /// What becomes of a pair until the next tick, as its bodies move now, and how they do if it was asked at length.
    #[inline]
    fn wish(&self, place: u32, slots: Option<[u32; 2]>) -> (Wish, Option<Moving>) {
        let Some(slots) = slots else {
            return (Wish::Look, None);
        };
        let both = slots.map(|slot| self.pool.seats.stand(slot));
        let glance = self.pairs.glance(place);
        let (ahead, tick) = (self.ahead(), self.settings.tick);
        if hardly_moves(glance, both, ahead, tick) {
            return (Wish::Rest, None);
        }
        let against = Against::new(both);
        let wish = self.wish_at_length(place, &Since::new(glance, both), &against);
        (wish, Some(Moving { slots, against }))
    }

    /// The same of a pair that was looked at just now, and is too quick for [`hardly_moves`].
    fn wish_after(&self, place: u32, quick: &Moving) -> Wish {
        let both = quick.slots.map(|slot| self.pool.seats.stand(slot));
        let since = Since::a_look(self.pairs.glance(place), both);
        self.wish_at_length(place, &since, &quick.against)
    }

    /// Where the bodies of a pair sit; `None`: nothing is known of it.
    #[inline]
    fn slots_of(&self, place: u32) -> Option<[u32; 2]> {
        let glance = self.pairs.glance(place);
        let seats = &self.pool.seats;
        let slots = [glance.bodies.0, glance.bodies.1].map(|index| seats.slot(index));
        let (true, [Some(a), Some(b)]) = (glance.holds, slots) else {
            return None;
        };
        Some([a, b])
    }

    /// Seconds to the next tick.
    fn ahead(&self) -> f64 {
        f64::from(self.pool.until_look) * self.clock.h
    }

    /// [`Self::wish`] of a pair that moves.
    #[inline]
    fn wish_at_length(&self, place: u32, since: &Since, against: &Against) -> Wish {
        let glance = self.pairs.glance(place);
        let rig = &self.pool.seats.rig;
        let (h, tick) = (self.clock.h, self.settings.tick);
        let (left, ahead) = (self.pool.until_look, self.ahead());
        if since.lost {
            return Wish::Look;
        }
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
            return if glance.has_rows() && room > LET_GO * size {
                Wish::LetGo
            } else {
                Wish::Rest
            };
        }
        let (went, speed) = (since.went(), against.speed());
        let quick = against.is_quick(tick);
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
        let free = lasts(strip - SPARE * size, closing);
        if quick && free > 0 {
            return if free < left {
                Wish::Wait(free)
            } else {
                Wish::Rest
            };
        }
        // Whether its rows are what a look would make of them. Who has none has none that grow stale.
        let fresh = || {
            let strain = went + since.bent;
            !glance.has_rows()
                || !since.stale
                    && (strain <= KEPT_APART * size
                        // Asked of the rows: what callers were told last depends on when they looked.
                        || strain <= KEPT * size
                            && self.pairs.rows_of(place).any(|id| rig.pushes(id)))
        };
        // Nothing without a row is nearer than this.
        let bare = glance.sought - went;
        let bare = if glance.has_rows() {
            bare
        } else {
            bare.max(strip)
        };
        if quick {
            return if lasts(bare - SPARE * size, speed) > 0 && fresh() {
                Wish::Wait(1)
            } else {
                Wish::Look
            };
        }
        // Who cannot meet unless somebody is struck has rows for that case alone.
        let spared =
            || !since.stale && strip > closing * ahead + fall && since.twisted() <= KEPT * size;
        if bare > speed * ahead + fall + RESERVE * size && (spared() || fresh()) {
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
        pair.contacts = Vec::new();
        pair.fresh = false;
        let touched = pair.told;
        let glance = self.pairs.glance_mut(place);
        (glance.rows, glance.sought) = (Rows::None, f64::NEG_INFINITY);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BodyDef, Material, Mode, Settings};
    use carom_geometry::ConvexPolygon;
    use carom_math::vec2;

    /// Whoever hardly moves wants nothing at length either.
    #[test]
    fn the_short_answer_is_that_at_length() {
        let settings = Settings {
            mode: Mode::Hybrid,
            sleep: None,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let block = |x, y| ConvexPolygon::rectangle(x, y).expect("a rectangle");
        let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
        let stone = Material::default();
        world.insert(floor, block(60.0, 2.0), stone).expect("valid");
        for k in 0..80 {
            let (column, row) = (f64::from(k % 10), f64::from(k / 10));
            let at = vec2(1.02 * column + 0.3 * (row % 2.0), 0.5 + 1.1 * row);
            let def = BodyDef::dynamic().at(at).spinning(0.3 * (column - 5.0));
            world.insert(def, block(1.0, 0.8), stone).expect("valid");
        }
        let (mut short, mut long) = (0, 0);
        for _ in 0..600 {
            world.step(world.settings.substep);
            let bodies = (0..81).map(|index| world.bodies.get(index));
            let places: Vec<u32> = bodies.flat_map(|state| &state.pairs).copied().collect();
            world.pool.seats.stands.renew();
            for place in places {
                let Some(slots) = world.slots_of(place) else {
                    continue;
                };
                world.pool.seats.take_stand(slots);
                let both = slots.map(|slot| world.pool.seats.stand(slot));
                let glance = world.pairs.glance(place);
                if hardly_moves(glance, both, world.ahead(), world.settings.tick) {
                    let (since, against) = (Since::new(glance, both), Against::new(both));
                    let wish = world.wish_at_length(place, &since, &against);
                    assert!(matches!(wish, Wish::Rest | Wish::LetGo), "{wish:?}");
                    short += 1;
                } else {
                    long += 1;
                }
            }
        }
        assert!(short > 1000 && long > 1000, "{short} and {long}");
    }
}
