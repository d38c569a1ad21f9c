//! Balls that wear a face and turn.

use cairo::{Context, Format, ImageSurface};
use carom_math::{Rot, Vec2, vec2};
use carom_render::{Colour, Face, Frame, Op, Size, Style};

use crate::scene::Random;

/// Balls in flight.
pub(crate) struct Balls {
    size: Size,
    balls: Vec<(Vec2, f64, Vec2, f64)>,
}

impl Balls {
    pub(crate) fn new(size: Size, count: usize) -> Self {
        let mut random = Random(0x2545_F491_4F6C_DD1D);
        let corner = size.corner();
        let balls = (0..count).map(|_| {
            let at = vec2(random.between(0.0, corner.x), random.between(0.0, corner.y));
            let velocity = vec2(random.between(-1.0, 1.0), random.between(-1.0, 1.0));
            (
                at,
                random.between(0.0, core::f64::consts::TAU),
                velocity,
                random.between(-0.1, 0.1),
            )
        });
        Self {
            size,
            balls: balls.collect(),
        }
    }

    pub(crate) fn step(&mut self) {
        let corner = self.size.corner();
        for (at, angle, velocity, spin) in &mut self.balls {
            *at += *velocity;
            *angle += *spin;
            *at -= corner * (*at / corner).floor();
        }
    }

    /// Centres and angles.
    pub(crate) fn each(&self) -> impl Iterator<Item = (Vec2, f64)> {
        self.balls.iter().map(|&(at, angle, ..)| (at, angle))
    }
}

/// Cairo with a picture of the face for every 2 px that its rim turns by.
pub(crate) struct Turned {
    context: Context,
    side: f64,
    turns: Vec<ImageSurface>,
}

impl Turned {
    pub(crate) fn new(size: Size, radius: f64) -> Result<Self, cairo::Error> {
        let [width, height] = [size.width(), size.height()].map(u32::cast_signed);
        let surface = ImageSurface::create(Format::Rgb24, width, height)?;
        let count = (core::f64::consts::TAU * radius / 2.0).ceil();
        let side = (2.0 * radius).ceil() + 2.0;
        let mut turns = Vec::new();
        let mut turn = 0.0;
        while turn < count {
            turns.push(picture(
                side,
                radius,
                core::f64::consts::TAU * turn / count,
            )?);
            turn += 1.0;
        }
        Ok(Self {
            context: Context::new(&surface)?,
            side,
            turns,
        })
    }

    pub(crate) fn draw(
        &self,
        balls: impl Iterator<Item = (Vec2, f64)>,
    ) -> Result<(), cairo::Error> {
        self.context.set_source_rgb(0.0, 0.0, 0.0);
        self.context.paint()?;
        for (at, angle) in balls {
            let part = (angle / core::f64::consts::TAU).rem_euclid(1.0);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "an index below the number of turns"
            )]
            let index = (part * self.turns.len() as f64) as usize % self.turns.len();
            let corner = at - Vec2::splat(0.5 * self.side);
            self.context
                .set_source_surface(&self.turns[index], corner.x, corner.y)?;
            self.context.paint()?;
        }
        Ok(())
    }
}

/// The face as carom draws it, on a transparent square; a ground of two colours tells opacity.
fn picture(side: f64, radius: f64, angle: f64) -> Result<ImageSurface, cairo::Error> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 82 px"
    )]
    let whole = side as u32;
    let size = Size::new(whole, whole).expect("a small square");
    let mut frame = Frame::new(size);
    frame.push(Op::Face {
        centre: Vec2::splat(0.5 * side),
        radius,
        turn: Rot::from_angle(angle),
        face: Face::smile(),
    });
    let [black, white] = [Colour::BLACK, Colour::WHITE].map(|background| {
        frame.paint(&Style {
            background,
            ..Style::dark()
        })
    });
    let pixels = black
        .rgba()
        .chunks_exact(4)
        .zip(white.rgba().chunks_exact(4));
    let bytes: Vec<u8> = pixels
        .flat_map(|(b, w)| [b[2], b[1], b[0], 255 - (w[1] - b[1])])
        .collect();
    let side = whole.cast_signed();
    ImageSurface::create_for_data(bytes, Format::ARgb32, side, side, 4 * side)
}
