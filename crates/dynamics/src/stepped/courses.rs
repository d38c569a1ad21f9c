//! Who may meet whom while both keep their courses: boxes along two ways overlap far more often than bodies that go them meet.
//!
//! A pile in a drum moves by a quarter of a box in a tick, all together. Boxes stretched along such ways overlap
//! those of every second neighbour, and those of the drum's turned walls everything; but as one body sees the other,
//! hardly any moves. A body that is within its padding of its course meets nothing that its course, so widened,
//! does not meet; and whoever leaves its course, or ends it, looks for partners anew.

use carom_collision::{part, part_count};
use carom_geometry::Shape;
use carom_math::{SimTime, Vec2, perp};

use super::seats::{NONE, Seat};
use crate::broad::PADDING;
use crate::solver::{Line, Pull};
use crate::{BodyKind, World};

/// Beyond this turn of the larger body, in rad, boxes decide: the bound on what it does to a way is a series.
const TURN: f64 = 0.2;

/// The motion that the boxes of a body were stretched along.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) from: SimTime,
    pub(super) centre: Vec2,
    pub(super) velocity: Vec2,
    pub(super) acceleration: Vec2,
    pub(super) angle: f64,
    pub(super) spin: f64,
    /// Up to so many seconds after `from`.
    pub(super) lasts: f64,
}

impl Course {
    /// Nobody goes along it.
    const NONE: Self = Self {
        from: SimTime::ZERO,
        centre: Vec2::ZERO,
        velocity: Vec2::ZERO,
        acceleration: Vec2::ZERO,
        angle: 0.0,
        spin: 0.0,
        lasts: 0.0,
    };

    /// Whether a body at `time` keeps to its course for `seconds`: it is no farther off, now and then, than its
    /// boxes are padded.
    pub(super) fn holds(
        &self,
        seat: &Seat,
        line: &Line,
        pull: &Pull,
        time: SimTime,
        seconds: f64,
    ) -> bool {
        let passed = time - self.from;
        if passed + seconds > self.lasts {
            return false;
        }
        let (off, turned) = self.off_by(seat, (line.d(), line.turn()), passed);
        let drift = line.v() - self.velocity_after(passed);
        let then =
            off + (drift + (pull.acceleration - self.acceleration) * (0.5 * seconds)) * seconds;
        let turned_then = turned + (line.w() - self.spin) * seconds;
        is_near(seat, off, turned) && is_near(seat, then, turned_then)
    }

    /// How far a displacement and a turn are off the course.
    fn off_by(&self, seat: &Seat, (d, turn): (Vec2, f64), passed: f64) -> (Vec2, f64) {
        (
            seat.base.position + d - self.centre_after(passed),
            seat.base_angle + turn - (self.angle + self.spin * passed),
        )
    }

    fn centre_after(&self, passed: f64) -> Vec2 {
        self.centre + (self.velocity + self.acceleration * (0.5 * passed)) * passed
    }

    fn velocity_after(&self, passed: f64) -> Vec2 {
        self.velocity + self.acceleration * passed
    }
}

/// Whether a body that is so far off its course is within its padding.
fn is_near(seat: &Seat, off: Vec2, turned: f64) -> bool {
    off.length() + seat.rim * turned.abs() <= PADDING * seat.reach
}

/// Courses by slot, side by side. While nobody is quick there is no list.
#[derive(Clone, Debug, Default)]
pub(super) struct Courses {
    list: Vec<Course>,
    /// How many go along one.
    count: usize,
}

impl Courses {
    /// What the boxes of the body at `slot` were stretched along; `None`: they were not.
    #[inline]
    pub(super) fn of(&self, slot: u32) -> Option<&Course> {
        let course = self.list.get(slot as usize);
        course.filter(|course| course.lasts > 0.0)
    }

    pub(super) fn begin(&mut self, slot: u32, course: Course) {
        let at = slot as usize;
        if self.list.len() <= at {
            self.list.resize(at + 1, Course::NONE);
        }
        self.count += usize::from(self.of(slot).is_none());
        self.list[at] = course;
    }

    pub(super) fn end(&mut self, slot: u32) {
        if self.of(slot).is_some() {
            self.list[slot as usize] = Course::NONE;
            self.count -= 1;
            if self.count == 0 {
                self.list = Vec::new();
            }
        }
    }

    /// Bodies moved to new slots; `u32::MAX`: there was nobody.
    pub(super) fn renumber(&mut self, new: &[u32]) {
        for (course, slot) in core::mem::take(self).list.into_iter().zip(new) {
            if *slot != NONE && course.lasts > 0.0 {
                self.begin(*slot, course);
            }
        }
    }
}

/// Where a body is on its course, and how long that lasts; one that stands is on its course for ever.
#[derive(Clone, Copy, Debug)]
struct On {
    centre: Vec2,
    v: Vec2,
    w: f64,
    a: Vec2,
    left: f64,
    /// How far off it may be, in m.
    off: f64,
}

impl On {
    fn new(seat: &Seat, course: Option<&Course>, time: SimTime) -> Option<Self> {
        if seat.kind == BodyKind::Fixed {
            return Some(Self {
                centre: seat.base.position,
                v: Vec2::ZERO,
                w: 0.0,
                a: Vec2::ZERO,
                left: f64::INFINITY,
                off: 0.0,
            });
        }
        let course = course?;
        let passed = time - course.from;
        let left = course.lasts - passed;
        (left > 0.0).then(|| Self {
            centre: course.centre_after(passed),
            v: course.velocity_after(passed),
            w: if seat.rim > 0.0 { course.spin } else { 0.0 },
            a: course.acceleration,
            left,
            off: PADDING * seat.reach,
        })
    }
}

/// A shape of a body on its course.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goer {
    /// The shape.
    pub(super) at: u32,
    pub(super) body: u32,
    pub(super) slot: u32,
    reach: f64,
    rim: f64,
    /// Its course begins now: it looks for partners, too.
    pub(super) sets_out: bool,
    on: On,
}

/// What most who do not meet are told apart by: all of it lies side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mover {
    centre: Vec2,
    v: Vec2,
    left: f64,
    /// Its reach, how far off it may be, and what its pull adds, in m.
    room: f64,
    pub(super) sets_out: bool,
}

impl Mover {
    /// Whether two cannot meet however they turn: what [`World::may_meet`] asks first, of sums of magnitudes.
    #[inline]
    pub(super) fn plainly_misses(&self, other: &Self) -> bool {
        let (r, v) = (other.centre - self.centre, other.v - self.v);
        let way = (v.x.abs() + v.y.abs()) * self.left.min(other.left);
        let near = self.room + other.room + way;
        r.length_squared() > near * near
    }
}

impl Goer {
    pub(super) fn mover(&self) -> Mover {
        let On {
            centre,
            v,
            a,
            left,
            off,
            ..
        } = self.on;
        Mover {
            centre,
            v,
            left,
            room: self.reach + off + 0.5 * a.length() * left * left,
            sets_out: self.sets_out,
        }
    }

    /// Of two of whom one at least sets out: whether it is this one that looks for the other. Of two who set out
    /// together it is the first.
    #[inline]
    pub(super) const fn looks_for(&self, other: &Self) -> bool {
        self.sets_out && (!other.sets_out || self.body < other.body)
    }
}

#[cfg(test)]
impl Goer {
    /// A shape of a body that stands and sets out.
    pub(super) const fn setting_out(at: u32) -> Self {
        Self {
            at,
            body: at,
            slot: 0,
            reach: 1.0,
            rim: 1.0,
            sets_out: true,
            on: On {
                centre: Vec2::ZERO,
                v: Vec2::ZERO,
                w: 0.0,
                a: Vec2::ZERO,
                left: f64::INFINITY,
                off: 0.0,
            },
        }
    }
}

impl World {
    /// A shape of the body at `slot`, if that is on a course.
    #[inline]
    pub(super) fn goer(&self, slot: u32, at: u32, time: SimTime) -> Option<Goer> {
        let seat = self.pool.seats.get(slot);
        let course = self.pool.seats.courses.of(slot);
        Some(Goer {
            at,
            body: seat.body,
            slot,
            reach: seat.reach,
            rim: seat.rim,
            sets_out: course.is_some_and(|course| course.from == time),
            on: On::new(seat, course, time)?,
        })
    }

    /// The same for a shape whose body has a slot.
    pub(super) fn goer_of(&self, at: u32, time: SimTime) -> Option<Goer> {
        let slot = self.pool.seats.slot(self.colliders[at as usize].body)?;
        self.goer(slot, at, time)
    }

    /// Whether two shapes may meet while both bodies keep their courses.
    ///
    /// As the larger body F sees it, the centre of the other one S moves by at most
    ///
    /// ```text
    /// (u + ½ A T) T (1 + 4 ω T),   u = |v_S − v_F − ω × r|,   A = |a_S − a_F| + ω² |r|
    /// ```
    /// within T, since its speed there grows by A + 2 ω (speed) + ω² (way). Where F does not turn the way is
    /// nearly straight, and what counts is the nearest point of it.
    #[inline]
    pub(super) fn may_meet(&self, mine: &Goer, other: &Goer) -> bool {
        let (large, small) = if mine.rim < other.rim {
            (other, mine)
        } else {
            (mine, other)
        };
        let (f, s) = (&large.on, &small.on);
        let seconds = f.left.min(s.left);
        let off = f.off + s.off;
        let (r, v) = (s.centre - f.centre, s.v - f.v);
        // A floor may hold back what a course has fall.
        let fall = 0.5 * (f.a.length() + s.a.length()) * seconds * seconds;
        let near = large.reach + small.reach + off + fall;
        let nearest = {
            let square = v.length_squared();
            let at = if square > 0.0 {
                (-r.dot(v) / square).clamp(0.0, seconds)
            } else {
                0.0
            };
            (r + v * at).length_squared()
        };
        if nearest > near * near {
            return false;
        }
        let turn = f.w.abs() * seconds;
        // A row of neighbours is told apart by circles; a long wall and what lies along it is not.
        if turn > TURN || large.reach < 2.0 * small.reach {
            return true;
        }
        let u = (v - perp(r) * f.w).length();
        let grows = (s.a - f.a).length() + f.w * f.w * r.length();
        let way = (u + 0.5 * grows * seconds) * seconds * (1.0 + 4.0 * turn);
        let seats = &self.pool.seats;
        let apart = distance_to(&self.colliders[large.at as usize].solid, || {
            seats
                .pose(large.slot)
                .inverse_point(seats.centre(small.slot))
        });
        // Both are off their courses now, and then.
        apart.is_none_or(|apart| apart <= way + small.reach + 2.0 * off + fall)
    }
}

/// How far a point is from a convex polygon at least, in m; of other shapes it is not known.
fn distance_to(shape: &Shape, point: impl Fn() -> Vec2) -> Option<f64> {
    if part_count(shape) != 1 {
        return None;
    }
    let hull = part(shape, 0);
    if hull.normals.len() < 2 {
        return None;
    }
    let point = point();
    let edges = hull.normals.iter().zip(hull.vertices);
    let heights = edges.map(|(normal, vertex)| normal.dot(point - *vertex));
    Some(heights.fold(f64::NEG_INFINITY, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;
    use proptest::prelude::*;

    fn goer() -> impl Strategy<Value = Goer> {
        let vector = |most: f64| (-most..most, -most..most).prop_map(|(x, y)| vec2(x, y));
        let motion = (vector(3.0), vector(20.0), vector(10.0));
        (motion, 0.001..0.1_f64, 0.0..0.1_f64).prop_map(|((centre, v, a), left, off)| {
            let on = On {
                centre,
                v,
                w: 0.0,
                a,
                left,
                off,
            };
            Goer {
                on,
                ..Goer::setting_out(0)
            }
        })
    }

    proptest! {
        /// Whoever comes near on the way, however far off it is, does not plainly miss.
        #[test]
        fn who_plainly_misses_stays_away(one in goer(), two in goer(), part in 0.0..1.0_f64) {
            let after = part * one.on.left.min(two.on.left);
            let at = |on: &On| on.centre + (on.v + on.a * (0.5 * after)) * after;
            let apart = (at(&two.on) - at(&one.on)).length();
            let misses = one.mover().plainly_misses(&two.mover());
            prop_assert!(!misses || apart > one.reach + two.reach + one.on.off + two.on.off);
        }
    }
}
