//! How the gap at a point of contact bends: the second derivative that tells press from pull.

use carom_collision::{Hull, Motion, Side};
use carom_math::{Rot, SimTime, Vec2, cross_scalar, perp};

/// What of a body touches: a corner, or the centre of a disc; and how it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touching {
    /// Where the corner or the centre is, in m, and its velocity and acceleration.
    at: Vec2,
    velocity: Vec2,
    acceleration: Vec2,
    /// The body about it: spin, angular acceleration, its centre of mass with velocity and acceleration.
    spin: f64,
    turning: f64,
    centre: Vec2,
    centre_velocity: Vec2,
    centre_acceleration: Vec2,
}

impl Touching {
    /// What of a convex part touches at `point`.
    pub(crate) fn of(motion: &Motion, part: &Hull<'_>, point: Vec2, time: SimTime) -> Self {
        let centre = motion.centre_at(time);
        // A disc, and one that is a part of something too, rolls about its centre: its own spin does not move its rim.
        let at = match (part.normals, part.vertices) {
            ([], [hub]) if *hub == Vec2::ZERO => centre,
            ([], [hub]) => motion.pose_at(time).point(*hub),
            _ => point,
        };
        let (arm, spin, turning) = (
            at - centre,
            motion.spin_at(time),
            motion.angular_acceleration,
        );
        let centre_velocity = motion.velocity_at(time);
        Self {
            at,
            velocity: centre_velocity + cross_scalar(spin, arm),
            acceleration: motion.acceleration + cross_scalar(turning, arm) - arm * (spin * spin),
            spin,
            turning,
            centre,
            centre_velocity,
            centre_acceleration: motion.acceleration,
        }
    }

    /// By how much it is displaced in the next `t` seconds, in m.
    fn way(&self, t: f64) -> Vec2 {
        (self.velocity + self.acceleration * (0.5 * t)) * t
    }
}

/// g″ of the gap g between features of A and B along the normal from A to B, in m/s².
///
/// On a straight `face` of body E, with n its outward normal, t = n turned by +90°, and q the other one's feature:
/// ```text
/// g  = n·(q − c) − h          c: E's centre of mass, h: distance of the face from it
/// g″ = n·(q″ − c″) + 2 ω t·(q′ − c′) + α t·(q − c) − ω² n·(q − c)
/// ```
/// Between corners and centres `d` apart `g″ = n·d″ + (t·d′)²/|d|`.
pub(crate) fn gap_acceleration(
    a: &Touching,
    b: &Touching,
    normal: Vec2,
    face: Option<Side>,
) -> f64 {
    let (own, other, n) = match face {
        Some(Side::A) => (a, b, normal),
        Some(Side::B) => (b, a, -normal),
        None => {
            let (d, slip) = (b.at - a.at, slip_of(a, b, normal));
            let distance = d.length();
            let bend = if distance > 0.0 {
                slip * slip / distance
            } else {
                0.0
            };
            return (b.acceleration - a.acceleration).dot(normal) + bend;
        }
    };
    let (t, d) = (perp(n), other.at - own.centre);
    n.dot(other.acceleration - own.centre_acceleration)
        + 2.0 * own.spin * t.dot(other.velocity - own.centre_velocity)
        + own.turning * t.dot(d)
        - own.spin * own.spin * n.dot(d)
}

/// How fast the feature of B goes along that of A, along the normal turned by +90°, in m/s.
pub(crate) fn slip_of(a: &Touching, b: &Touching, normal: Vec2) -> f64 {
    (b.velocity - a.velocity).dot(perp(normal))
}

/// Point of contact, in m, and normal from A to B of features that touch now, and again `t` seconds later.
///
/// On a straight face of body E the point goes with the other one's corner or disc, and the normal with E's rotation.
/// Between corners and centres the point divides their distance as it does now, and the normal is along it.
pub(crate) fn contact_after(
    a: &Touching,
    b: &Touching,
    (point, normal): (Vec2, Vec2),
    face: Option<Side>,
    t: f64,
) -> (Vec2, Vec2) {
    let (own, other) = match face {
        Some(Side::A) => (a, b),
        Some(Side::B) => (b, a),
        None => {
            let (d, way, other_way) = (b.at - a.at, a.way(t), b.way(t));
            if d == Vec2::ZERO {
                // Two corners that meet have no distance to tell the normal by.
                return (point + 0.5 * (way + other_way), normal);
            }
            let part = (point - a.at).dot(d) / d.length_squared();
            let opened = other_way - way;
            return (
                point + way + opened * part,
                (d + opened).normalize_or(normal),
            );
        }
    };
    let turned = (own.spin + 0.5 * own.turning * t) * t;
    (point + other.way(t), Rot::from_angle(turned) * normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_collision::part;
    use carom_geometry::{Circle, Compound, ConvexPolygon, Shape};
    use carom_math::{Pose, vec2};

    fn motion(at: Vec2, velocity: Vec2, acceleration: Vec2, spin: f64, turning: f64) -> Motion {
        Motion {
            velocity,
            acceleration,
            spin,
            angular_acceleration: turning,
            ..Motion::resting(at)
        }
    }

    /// The formula against differences of the gap itself.
    #[test]
    fn the_gap_bends_as_its_second_difference_says() {
        let plate = Shape::from(ConvexPolygon::rectangle(4.0, 2.0).expect("a plate"));
        let disc = Shape::from(Circle::new(0.5).expect("a disc"));
        let below = motion(Vec2::ZERO, vec2(0.3, -0.2), vec2(0.1, 0.4), 0.7, -0.3);
        let above = motion(vec2(0.6, 1.5), vec2(-0.4, 0.5), vec2(0.2, -3.0), 5.0, 2.0);
        let gap = |t: f64| {
            let time = SimTime::from_secs(t);
            let local = below.pose_at(time).inverse_point(above.centre_at(time));
            local.y - 1.5
        };
        let h = 1e-3;
        let difference = (gap(3.0 * h) - 2.0 * gap(2.0 * h) + gap(h)) / (h * h);
        let at = SimTime::from_secs(2.0 * h);
        let normal = below.rotation_at(at) * Vec2::Y;
        let point = above.centre_at(at) - normal * 0.5;
        let a = Touching::of(&below, &part(&plate, 0), point, at);
        let b = Touching::of(&above, &part(&disc, 0), point, at);
        let bends = gap_acceleration(&a, &b, normal, Some(Side::A));
        assert!(
            (bends - difference).abs() < 1e-5,
            "{bends} and {difference}"
        );
        let turned = gap_acceleration(&b, &a, -normal, Some(Side::B));
        assert!((bends - turned).abs() < 1e-13);
    }

    #[test]
    fn a_disc_that_is_a_part_turns_about_its_own_centre() {
        let plate = Shape::from(ConvexPolygon::rectangle(9.0, 2.0).expect("a plate"));
        let hub = vec2(-0.3, 0.2);
        let disc = Circle::new(0.5).expect("a disc").into();
        let weight = Circle::new(0.1).expect("a weight").into();
        let parts = [(weight, Pose::IDENTITY), (disc, Pose::at(hub))];
        let both = Shape::from(Compound::new(parts).expect("a compound"));
        let below = Motion::resting(Vec2::ZERO);
        let above = motion(vec2(0.6, 1.3), vec2(-0.4, 0.5), vec2(0.2, -3.0), 5.0, 2.0);
        let at = |t: f64| above.pose_at(SimTime::from_secs(t)).point(hub);
        let h = 1e-3;
        let difference = (at(3.0 * h).y - 2.0 * at(2.0 * h).y + at(h).y) / (h * h);
        let now = SimTime::from_secs(2.0 * h);
        let point = at(2.0 * h) - 0.5 * Vec2::Y;
        let a = Touching::of(&below, &part(&plate, 0), point, now);
        let b = Touching::of(&above, &part(&both, 1), point, now);
        let bends = gap_acceleration(&a, &b, Vec2::Y, Some(Side::A));
        assert!(
            (bends - difference).abs() < 1e-3,
            "{bends} and {difference}"
        );
    }

    #[test]
    fn discs_that_pass_each_other_part_faster() {
        let disc = Shape::from(Circle::new(0.5).expect("a disc"));
        let a = motion(Vec2::ZERO, Vec2::ZERO, Vec2::ZERO, 3.0, 0.0);
        let b = motion(Vec2::X, vec2(0.0, 2.0), Vec2::ZERO, -4.0, 1.0);
        let of = |motion| Touching::of(motion, &part(&disc, 0), vec2(0.5, 0.0), SimTime::ZERO);
        // |d| = √(1 + 4 t²), so |d|″ = 4 at the start.
        assert_eq!(gap_acceleration(&of(&a), &of(&b), Vec2::X, None), 4.0);
    }
}
