//! The box around a shape for as long as a motion lasts: a little too large, never too small.

use carom_geometry::{Aabb, Shape};
use carom_math::{SimTime, Vec2};

use crate::Motion;

/// Largest turn between two looks at a shape, in rad: between them no point leaves its chord by more
/// than 1/32 of this squared and its distance from the centre, 0.8 %.
const TURN: f64 = 0.25;

/// More than the roundings of a pose can move a point, of all lengths that are in play.
const ROUNDING: f64 = 1.0 / (1_u64 << 46) as f64;

impl Motion {
    /// A box that contains `shape`, given about the centre of this motion, at every instant from
    /// `from` on for `duration` seconds (in m).
    ///
    /// Exact to rounding where nothing turns, the turning point of the parabola included; else no
    /// side is farther out than 1 % of the shape's reach, or than the circle around the shape where
    /// it makes a whole turn. [`Self::left_out`] is added. A half-plane that moves has no box: all of
    /// the plane is returned, as for a motion or a duration that is not finite.
    ///
    /// # Examples
    /// ```
    /// use carom_collision::Motion;
    /// use carom_geometry::{Circle, Shape};
    /// use carom_math::{SimTime, Vec2, vec2};
    /// // A ball of 0.5 m, thrown 5 m up: it is back after 2 s.
    /// let thrown = Motion {
    ///     velocity: vec2(1.0, 10.0),                               // m/s
    ///     acceleration: vec2(0.0, -10.0),                          // m/s²
    ///     ..Motion::resting(Vec2::ZERO)
    /// };
    /// let ball = Shape::from(Circle::new(0.5)?);
    /// let bounds = thrown.swept_box(&ball, SimTime::ZERO, 2.0);
    /// assert!((bounds.min - vec2(-0.5, -0.5)).length() < 1e-12);
    /// assert!((bounds.max - vec2(2.5, 5.5)).length() < 1e-12);
    /// # Ok::<(), carom_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn swept_box(&self, shape: &Shape, from: SimTime, duration: f64) -> Aabb {
        let everything = Aabb::new(Vec2::NEG_INFINITY, Vec2::INFINITY);
        let now = self.rebased(from);
        if !(now.is_finite() && duration.is_finite()) {
            return everything;
        }
        let duration = duration.max(0.0);
        if !shape.is_bounded() {
            let moves = [now.velocity, now.acceleration] != [Vec2::ZERO; 2] || now.turns();
            return if moves {
                everything
            } else {
                shape.aabb(now.pose_at(from))
            };
        }
        let reach = shape.reach_about(Vec2::ZERO);
        let path = now.centre_box(duration);
        let spin = now.spin.abs().max(now.spin_at(from + duration).abs());
        let turn = spin * duration;
        let around = if !now.turns() {
            let still = shape.aabb(carom_math::Pose::new(Vec2::ZERO, now.rotation));
            Aabb::new(path.min + still.min, path.max + still.max)
        } else if turn < core::f64::consts::TAU {
            now.box_by_looks(shape, reach, spin, duration)
        } else {
            path.grown(reach)
        };
        // What is turned since the start of the motion counts: its angle is rounded.
        let turned = self.turn(from - self.start).abs() + turn;
        let lengths = largest(path)
            + (from - self.start).abs() * self.velocity.length()
            + reach * (4.0 + turned);
        around.grown(self.left_out + ROUNDING * lengths)
    }

    fn turns(&self) -> bool {
        self.spin != 0.0 || self.angular_acceleration != 0.0
    }

    /// The box around the way of the centre in the first `duration` seconds: both ends, and where
    /// the parabola turns along an axis.
    fn centre_box(&self, duration: f64) -> Aabb {
        let turning = (-self.velocity / self.acceleration).to_array();
        let within = turning.into_iter().filter(|t| (0.0..duration).contains(t));
        let instants = [0.0, duration].into_iter().chain(within);
        Aabb::from_points(instants.map(|t| self.centre + self.travel(t)))
    }

    /// The boxes at instants so near to each other that little turns in between.
    ///
    /// The path p(t) of a point at r from the centre has |p″| ≤ |a| + r (ω² + |α|), and leaves the
    /// way between two instants h apart by at most h²/8 times that.
    fn box_by_looks(&self, shape: &Shape, reach: f64, spin: f64, duration: f64) -> Aabb {
        let mut looks = (spin * duration / TURN).ceil().max(1.0);
        // A fall is looked at as often as a turn: its arc is no more than 0.8 % of the reach.
        let fall = self.acceleration.length() + reach * self.angular_acceleration.abs();
        looks = looks.max(
            (duration * (4.0 * fall / (reach * TURN * TURN)).sqrt())
                .ceil()
                .min(32.0),
        );
        let step = duration / looks;
        let bend = fall + reach * spin * spin;
        let mut around = Aabb::EMPTY;
        let mut look = 0.0;
        while look <= looks {
            around = around.union(shape.aabb(self.pose_at(self.start + step * look)));
            look += 1.0;
        }
        around.grown(0.125 * step * step * bend)
    }
}

/// The largest coordinate of a box, in m.
fn largest(bounds: Aabb) -> f64 {
    bounds.min.abs().max(bounds.max.abs()).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_geometry::{Compound, ConvexPolygon, HalfPlane};
    use carom_math::{Pose, Rot, vec2};
    use proptest::prelude::*;

    fn shape() -> Shape {
        let plank = Shape::from(ConvexPolygon::rectangle(4.0, 0.5).expect("a plank"));
        let stone = Shape::from(ConvexPolygon::regular(5, 0.75).expect("a stone"));
        let parts = [(plank, Pose::IDENTITY), (stone, Pose::at(vec2(2.0, 1.0)))];
        Compound::new(parts).expect("bounded").into()
    }

    fn number(size: f64) -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), -1.0..1.0_f64, -1e-6..1e-6_f64].prop_map(move |x| size * x)
    }

    fn motion() -> impl Strategy<Value = Motion> {
        let vector = |size: f64| (number(size), number(size)).prop_map(|(x, y)| vec2(x, y));
        (
            vector(1e8),
            vector(100.0),
            vector(100.0),
            number(50.0),
            number(50.0),
            number(4.0),
        )
            .prop_map(
                |(centre, velocity, acceleration, spin, angular_acceleration, angle)| Motion {
                    velocity,
                    acceleration,
                    spin,
                    angular_acceleration,
                    rotation: Rot::from_angle(angle),
                    ..Motion::resting(centre)
                },
            )
    }

    proptest! {
        #[test]
        fn no_pose_on_the_way_leaves_the_box(
            motion in motion(), from in 0.0..50.0_f64, duration in prop_oneof![Just(0.0), 0.0..0.01_f64, 0.0..3.0_f64],
        ) {
            let (shape, from) = (shape(), SimTime::from_secs(from));
            let bounds = motion.swept_box(&shape, from, duration);
            for part in 0..=200 {
                let time = from + duration * f64::from(part) / 200.0;
                let there = shape.aabb(motion.pose_at(time));
                prop_assert!(bounds.contains(there), "{:?} is not in {:?} after {} of 200 parts", there, bounds, part);
            }
        }

        #[test]
        fn the_box_is_no_larger_than_it_says(motion in motion(), duration in 0.0..1.0_f64) {
            let shape = shape();
            let reach = shape.reach_about(Vec2::ZERO);
            let bounds = motion.swept_box(&shape, SimTime::ZERO, duration);
            let mut around = Aabb::EMPTY;
            for part in 0..=2000 {
                let time = SimTime::ZERO + duration * f64::from(part) / 2000.0;
                let pose = motion.pose_at(time);
                let end = motion.spin_at(SimTime::from_secs(duration)).abs();
                let whole_turn = motion.spin.abs().max(end) * duration >= std::f64::consts::TAU;
                let there = if whole_turn {
                    Aabb::new(pose.position, pose.position).grown(reach)
                } else {
                    shape.aabb(pose)
                };
                around = around.union(there);
            }
            // What happens between two of the 2000 looks, and rounding far out.
            let missed = 0.125 * (duration / 2000.0) * (duration / 2000.0) * (142.0 + reach * 1e4);
            let limit = around.grown(0.02 * reach + missed + 1e-5);
            prop_assert!(limit.contains(bounds), "{:?} around {:?}", bounds, around);
        }
    }

    #[test]
    fn a_turn_that_reverses_is_not_missed() {
        // Half a radian there and back: at both ends nothing has turned.
        let motion = Motion {
            spin: 2.0,
            angular_acceleration: -4.0,
            ..Motion::resting(Vec2::ZERO)
        };
        let shape = Shape::from(ConvexPolygon::rectangle(4.0, 0.5).expect("a plank"));
        let bounds = motion.swept_box(&shape, SimTime::ZERO, 1.0);
        let half_way = shape.aabb(motion.pose_at(SimTime::from_secs(0.5)));
        assert!(bounds.contains(half_way) && half_way.max.y > 1.1);
    }

    #[test]
    fn a_half_plane_has_a_box_while_it_rests() {
        let ground = Shape::from(HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("up"));
        let resting = Motion::resting(vec2(0.0, 3.0));
        let bounds = resting.swept_box(&ground, SimTime::ZERO, 1.0);
        assert_eq!((bounds.max.y, bounds.max.x), (3.0, f64::INFINITY));
        let rising = Motion {
            velocity: Vec2::Y,
            ..resting
        };
        let bounds = rising.swept_box(&ground, SimTime::ZERO, 1.0);
        assert_eq!(bounds.max.y, f64::INFINITY);
        let lost = Motion {
            velocity: vec2(f64::NAN, 0.0),
            ..resting
        };
        let ball = Shape::from(carom_geometry::Circle::new(1.0).expect("a ball"));
        assert_eq!(
            lost.swept_box(&ball, SimTime::ZERO, 1.0).min,
            Vec2::NEG_INFINITY
        );
    }
}
