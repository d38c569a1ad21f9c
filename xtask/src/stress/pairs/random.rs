//! Random shapes, poses and motions from a case's number.

use carom_collision::{Convex, Motion, separating_axis};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Rot, Vec2, trig, vec2};

use crate::random::SplitMix;

/// Chance that is started by the number of a case.
#[derive(Clone, Debug)]
pub(super) struct Random(SplitMix);

impl Random {
    pub(super) fn new(number: u64) -> Self {
        Self(SplitMix::new(
            number.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(1),
        ))
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.unit()
    }

    fn one_in(&mut self, count: u64) -> bool {
        self.0.next().is_multiple_of(count)
    }

    /// A number of corners from `low` to less than `high`.
    #[expect(clippy::cast_possible_truncation, reason = "dozens")]
    pub(super) fn corners(&mut self, low: u64, high: u64) -> usize {
        self.count(low, high) as usize
    }

    pub(super) fn count(&mut self, low: u64, high: u64) -> u64 {
        low + self.0.next() % (high - low)
    }

    /// A convex polygon of about a metre: round, lean, thin as 1e-8, or a box.
    pub(super) fn convex(&mut self) -> ConvexPolygon {
        loop {
            if self.one_in(4) {
                let (w, h) = (self.between(0.1, 1.0), self.between(0.1, 1.0));
                let centred = Vec2::new(w, h);
                let corners = [
                    vec2(-1.0, -1.0),
                    vec2(1.0, -1.0),
                    vec2(1.0, 1.0),
                    vec2(-1.0, 1.0),
                ];
                if let Ok(found) = ConvexPolygon::new(corners.map(|c| c * centred)) {
                    return found;
                }
            }
            let thin = match self.0.next() % 10 {
                0 => trig::exp(-self.between(2.0, 18.4)),
                1..4 => self.between(0.01, 1.0),
                _ => 1.0,
            };
            let turn = self.turn();
            let corners = self.count(3, 9);
            let points: Vec<Vec2> = (0..corners)
                .map(|_| self.turn().x_axis() * self.between(0.3, 1.0))
                .map(|p| turn * vec2(p.x, p.y * thin))
                .collect();
            if let Ok(found) = ConvexPolygon::hull(points) {
                return found;
            }
        }
    }

    fn turn(&mut self) -> Rot {
        Rot::from_angle(self.between(-4.0, 4.0))
    }

    /// A rotation that leaves edges parallel as often as not, or off by 1e-12 rad.
    fn tidy_turn(&mut self) -> Rot {
        let quarter = Rot::from_degrees([0.0, 90.0, 180.0, 270.0][(self.0.next() % 4) as usize]);
        match self.0.next() % 7 {
            0..4 => self.turn(),
            4..6 => quarter,
            _ => quarter.turned(self.between(-1e-12, 1e-12)),
        }
    }

    pub(super) fn pose(&mut self, reach: f64) -> Pose {
        let place = vec2(self.between(-reach, reach), self.between(-reach, reach));
        Pose::new(place, self.tidy_turn())
    }

    /// A disc, a convex polygon, or a star-shaped ring of up to 40 corners.
    pub(super) fn shape(&mut self) -> Shape {
        match self.0.next() % 8 {
            0..2 => {
                let radius = self.between(0.05, 1.0);
                Circle::new(radius).map_or_else(|_| self.shape(), Shape::from)
            }
            2..5 => self.fat_convex().into(),
            kind => {
                let corners = if kind == 7 {
                    self.count(33, 41)
                } else {
                    self.count(4, 14)
                };
                let step = 360.0 / corners as f64;
                let ray = |k: u64, r: f64| Rot::from_degrees(step * k as f64).x_axis() * r;
                let points: Vec<Vec2> = (0..corners)
                    .map(|k| ray(k, self.between(0.3, 1.2)))
                    .collect();
                Polygon::new(points).map_or_else(|_| self.shape(), Shape::from)
            }
        }
    }

    /// A convex polygon with an area that a sampler can see.
    fn fat_convex(&mut self) -> ConvexPolygon {
        loop {
            let found = self.convex();
            if found.area_properties().area > 1e-3 {
                return found;
            }
        }
    }

    /// From about `x` metres towards 0, turning.
    pub(super) fn motion(&mut self, x: f64) -> Motion {
        Motion {
            velocity: vec2(
                -x.signum() * self.between(0.2, 4.0),
                self.between(-1.5, 1.5),
            ),
            acceleration: vec2(0.0, if x > 0.0 { -9.81 } else { 0.0 }),
            spin: self.between(-12.0, 12.0),
            angular_acceleration: self.between(-3.0, 3.0),
            rotation: self.turn(),
            ..Motion::resting(vec2(x + self.between(-0.5, 0.5), self.between(-1.5, 1.5)))
        }
    }
}

/// Two convex polygons of about `size` metres, and B in A's frame.
#[derive(Clone, Debug)]
pub(super) struct ConvexPair {
    pub(super) a: ConvexPolygon,
    pub(super) b: ConvexPolygon,
    pub(super) pose: Pose,
    pub(super) size: f64,
}

impl ConvexPair {
    pub(super) fn new(number: u64) -> Self {
        let mut random = Random::new(number);
        let size = trig::pow(10.0, random.between(-6.0, 6.0));
        let (a, b) = loop {
            let scaled = |shape: ConvexPolygon| {
                let points: Vec<Vec2> = shape.vertices().iter().map(|v| *v * size).collect();
                ConvexPolygon::hull(points)
            };
            if let (Ok(a), Ok(b)) = (scaled(random.convex()), scaled(random.convex())) {
                break (a, b);
            }
        };
        let rotation = random.tidy_turn();
        let way = random.turn().x_axis();
        let touching = random.one_in(4);
        let reach = if touching {
            2.5
        } else {
            random.between(0.0, 2.5)
        };
        let mut pose = Pose::new(way * (reach * size), rotation);
        if touching {
            let axis = separating_axis(&a.hull(), &b.hull(), pose);
            pose.position -= axis.normal * axis.separation;
        }
        Self { a, b, pose, size }
    }
}
