//! Laws that hold whatever is simulated.

mod bouncing;
mod broad;
mod calls;
mod composition;
mod concave;
mod fast;
mod free;
mod geometry;
mod ghosts;
mod hard;
mod impacts;
mod laws;
mod scales;
mod sleeping;
mod springless;
mod squeezed;
mod twin;
mod wide;

use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use fearless_simd::Level;

use crate::{BodyId, BodyInput, Engine, Material, PieceInput, Settings};

/// Registers of all widths that the processor has.
pub(super) fn levels() -> Vec<Level> {
    let mut levels = vec![Level::new(), Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        let best = Level::new();
        levels.extend(best.as_avx2().map(Level::Avx2));
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
    }
    levels
}

/// Numbers from 0 to 1, the same for the same seed.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(super) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from((self.0 >> 33) as u32) / f64::from(1u32 << 31)
    }

    /// From −1 to 1.
    pub(super) fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "below the count"
    )]
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// A box, triangle, hexagon, octagon or disc of about a metre, with a rounding or without.
    pub(super) fn piece(&mut self) -> PieceInput {
        let size = 0.3 + 0.4 * self.next();
        let shape: Shape = match self.below(6) {
            0 => Circle::new(size).unwrap().into(),
            1 => ConvexPolygon::rectangle(2.0 * size, 0.6 * size)
                .unwrap()
                .into(),
            2 => ConvexPolygon::regular(3, size).unwrap().into(),
            3 => ConvexPolygon::regular(6, size).unwrap().into(),
            4 => ConvexPolygon::regular(8, size).unwrap().into(),
            _ => ConvexPolygon::square(1.4 * size).unwrap().into(),
        };
        let round = if self.below(3) == 0 { 0.1 } else { 0.0 };
        PieceInput::new(shape).rounded(round)
    }

    pub(super) fn pose(&mut self, spread: f64) -> Pose {
        let at = vec2(self.signed(), self.signed()) * spread;
        Pose::new(at, Rot::from_angle(4.0 * self.signed()))
    }

    /// A body of `piece` with the mass that it has at 1 kg/m².
    pub(super) fn body(&mut self, piece: &PieceInput, spread: f64) -> BodyInput {
        let area = piece.shape.area_properties().unwrap().with_density(1.0);
        let mut body = BodyInput::dynamic(area.mass, area.inertia);
        body.pose = self.pose(spread);
        body.velocity = vec2(self.signed(), self.signed()) * 2.0;
        body.spin = 2.0 * self.signed();
        body
    }
}

pub(super) fn without_sleep() -> Settings {
    Settings {
        sleep: None,
        ..Settings::default()
    }
}

/// No gravity, and no sleep.
pub(super) fn weightless() -> Settings {
    Settings {
        gravity: Vec2::ZERO,
        ..without_sleep()
    }
}

pub(crate) fn floor(engine: &mut Engine) -> BodyId {
    let plane = HalfPlane::new(Vec2::ZERO, Vec2::Y).unwrap();
    engine
        .insert(BodyInput::fixed(), &[PieceInput::new(plane)])
        .unwrap()
}

pub(crate) fn unit_box() -> PieceInput {
    PieceInput::new(ConvexPolygon::square(1.0).unwrap())
}

pub(super) fn with_friction(piece: PieceInput, friction: f64) -> PieceInput {
    piece.with_material(Material {
        friction,
        ..Material::default()
    })
}

/// Boxes of 1 m in rows, each a box shorter than the one below.
pub(super) fn pyramid(engine: &mut Engine, rows: u32, corner: Vec2) -> Vec<BodyId> {
    let mut ids = Vec::new();
    for row in 0..rows {
        for k in 0..rows - row {
            let x = f64::from(k) + 0.5 * f64::from(row);
            let at = corner + vec2(x, 0.5 + f64::from(row));
            let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(at);
            ids.push(engine.insert(body, &[unit_box()]).unwrap());
        }
    }
    ids
}
