//! Skipping on equals skipping off, and changes say enough.

use carom_math::{Rot, Vec2, vec2};

use super::*;
use crate::{BODY_COLOURS, Face, Ink, Label, Op, Paint, Source};

/// `xorshift64*` (Vigna 2016).
struct Random(u64);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32;
        u32::try_from(bits).unwrap() % end
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.below(1 << 20)) / f64::from(1 << 20)
    }

    fn place(&mut self) -> Vec2 {
        vec2(self.between(-20.0, 220.0), self.between(-20.0, 170.0))
    }

    /// Any mark, from a fraction of a pixel to larger than the canvas.
    fn op(&mut self) -> Op {
        let centre = self.place();
        let radius =
            [0.3, 3.0, 3.0, 8.0, 8.0, 20.0, 200.0][self.below(7) as usize] * self.between(0.5, 1.5);
        let colour = BODY_COLOURS[self.below(9) as usize];
        let colour = colour.with_alpha([255, 255, 120][self.below(3) as usize]);
        let ink = Ink::Of(colour);
        let width = self.between(0.2, 5.0);
        let paint = Paint {
            shaded: self.below(2) == 0,
            ..Paint::flat(colour)
        };
        let count = 3 + self.below(7);
        let angle = self.between(0.0, 7.0);
        let points: Vec<Vec2> = (0..count)
            .map(|i| {
                let turn = angle + core::f64::consts::TAU * f64::from(i) / f64::from(count);
                centre + self.between(0.3, 1.0) * radius * Rot::from_angle(turn).x_axis()
            })
            .collect();
        let dash = (self.below(2) == 0).then_some(4.0);
        let other = self.place();
        match self.below(13) {
            0 | 1 => Op::Polygon { points, paint },
            2 => Op::Region {
                rings: vec![
                    points.clone(),
                    points.iter().rev().map(|&p| centre.lerp(p, 0.5)).collect(),
                ],
                paint,
            },
            3 | 4 => Op::Disc {
                centre,
                radius,
                paint,
            },
            5 => Op::Area { points, ink },
            6 => Op::Dot {
                centre,
                radius,
                ink,
            },
            7 => Op::Ring {
                centre,
                radius,
                width,
                ink,
            },
            8 => Op::Line {
                points: vec![centre, other],
                width,
                dash,
                ink,
            },
            9 => Op::Line {
                points,
                width,
                dash,
                ink,
            },
            10 => Op::Arrow {
                from: centre,
                to: other,
                width,
                ink,
            },
            11 => Op::Face {
                centre,
                radius,
                turn: Rot::from_angle(angle),
                face: Face::smile(),
            },
            _ if self.below(2) == 0 => Op::Box {
                min: centre,
                max: centre + Vec2::splat(radius),
                fill: Some(ink),
                border: Some(Ink::Text),
                width,
                dash,
            },
            _ => Label::new(centre, "t = 1.25 s", self.between(4.0, 20.0), ink)
                .with_halo()
                .into(),
        }
    }
}

#[test]
fn skipping_equals_painting_in_full_for_a_thousand_random_frames() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let size = Size::new(200, 150).unwrap();
    let mut painter = Painter::new(Style::dark()).checking();
    let mut picture = Picture::new(size, Colour::WHITE);
    let mut before = picture.clone();
    // Marks, and whether they are awake.
    let mut marks: Vec<(Op, bool)> = Vec::new();
    let mut frame = Frame::new(size);
    let (mut quiet, mut parts) = (0, 0);
    for number in 0..1000 {
        // A quiet stretch now and then; else some marks come, go, move, fall asleep or wake.
        let busy = if number % 10 < 3 { 0 } else { random.below(4) };
        for _ in 0..busy {
            let at = random.below(marks.len() as u32 + 1) as usize;
            match random.below(6) {
                0 | 1 if marks.len() < 24 => marks.insert(at, (random.op(), random.below(3) > 0)),
                0..=2 if at < marks.len() => {
                    marks.remove(at);
                }
                3 if at < marks.len() => marks[at].1 = !marks[at].1,
                _ if at < marks.len() => marks[at].0 = random.op(),
                _ => {}
            }
        }
        frame.clear(size);
        for layer in [false, true] {
            for (op, awake) in marks.iter().filter(|mark| mark.1 == layer) {
                frame.push_from(
                    Source {
                        body: None,
                        awake: *awake,
                    },
                    op.clone(),
                );
            }
        }
        let changes = painter.paint(&frame, &mut picture).clone();
        assert_eq!(painter.differing(), 0, "frame {number}: {frame:?}");
        quiet += usize::from(changes.is_empty());
        parts += usize::from(
            changes
                .bounds()
                .is_some_and(|bounds| bounds != PixelBox::of(size)),
        );
        // What is said not to have changed has not.
        let bounds = changes.bounds().unwrap_or(PixelBox::EMPTY);
        let pixels = picture
            .rgba()
            .chunks_exact(4)
            .zip(before.rgba().chunks_exact(4));
        for (i, (new, old)) in (0..).zip(pixels) {
            let (x, y) = (i % 200, i / 200);
            let inside = changes.bands()[(y / BAND) as usize]
                && (bounds.left..bounds.right).contains(&x)
                && (bounds.top..bounds.bottom).contains(&y);
            assert!(new == old || inside, "frame {number}, pixel {x}, {y}");
        }
        before.clone_from(&picture);
    }
    assert!(
        quiet > 200 && parts > 200,
        "{quiet} frames were quiet, {parts} changed in part"
    );
}

#[test]
fn bodies_that_come_and_go_do_not_shift_the_rest() {
    let size = Size::new(320, 160).unwrap();
    let mut world = carom_dynamics::World::new(carom_dynamics::Settings::default()).unwrap();
    let ids: Vec<_> = (0..8)
        .map(|_| {
            let shape = carom_geometry::Circle::new(0.5).unwrap();
            world
                .insert(
                    carom_dynamics::BodyDef::dynamic(),
                    shape,
                    carom_dynamics::Material::default(),
                )
                .unwrap()
        })
        .collect();
    let mut painter = Painter::new(Style::light()).checking();
    let mut picture = Picture::new(size, Colour::WHITE);
    let frame_without = |gone: Option<usize>| {
        let mut frame = Frame::new(size);
        for (i, &body) in ids.iter().enumerate().filter(|&(i, _)| Some(i) != gone) {
            let source = Source {
                body: Some(body),
                awake: true,
            };
            let centre = vec2(20.0 + 40.0 * i as f64, 80.0);
            frame.push_from(
                source,
                Op::Dot {
                    centre,
                    radius: 6.0,
                    ink: Ink::Text,
                },
            );
            frame.push_from(
                source,
                Op::Dot {
                    centre,
                    radius: 2.0,
                    ink: Ink::Contact,
                },
            );
        }
        frame
    };
    painter.paint(&frame_without(None), &mut picture);
    for gone in [Some(3), None, Some(0), Some(7), None] {
        let changes = painter.paint(&frame_without(gone), &mut picture);
        let bounds = changes.bounds().unwrap();
        assert!(bounds.right - bounds.left <= 320, "{gone:?}");
        assert_eq!(changes.count(), 2, "{gone:?}: two bands of ten");
    }
    let bounds = painter
        .paint(&frame_without(Some(3)), &mut picture)
        .bounds()
        .unwrap();
    assert!(
        bounds.right - bounds.left <= 64,
        "only the one that went: {bounds:?}"
    );
    assert_eq!(painter.differing(), 0);
}

#[test]
fn a_new_size_is_a_new_picture() {
    let mut painter = Painter::new(Style::light()).checking();
    let mut picture = Picture::new(Size::new(7, 3).unwrap(), Colour::BLACK);
    for (width, height) in [(60, 40), (40, 60), (41, 60), (41, 60)] {
        let size = Size::new(width, height).unwrap();
        let mut frame = Frame::new(size);
        frame.push(Op::Dot {
            centre: vec2(20.0, 20.0),
            radius: 9.0,
            ink: Ink::Text,
        });
        painter.paint(&frame, &mut picture);
        assert_eq!(picture.size(), size);
    }
    assert_eq!(painter.differing(), 0);
}

#[test]
fn ring_that_is_left_out_is_left_out_with_its_outline() {
    let size = Size::new(64, 64).unwrap();
    let paint = Paint::flat(BODY_COLOURS[0]);
    let square = |at: f64| -> Vec<Vec2> {
        let corners = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];
        corners.map(|(x, y)| vec2(at + x, at + y)).to_vec()
    };
    for far in [f64::NAN, f64::INFINITY, 1e13] {
        // Its other four points are seen.
        let mut bad = square(40.0);
        bad.push(vec2(far, 44.0));
        for engine in [Engine::Own, Engine::TinySkia] {
            let shown = |rings: &[Vec<Vec2>]| {
                let mut painter = Painter::new(Style::light()).with_engine(engine);
                let mut frame = Frame::new(size);
                let rings = rings.to_vec();
                frame.push(Op::Region { rings, paint });
                let mut picture = Picture::new(size, Colour::WHITE);
                painter.paint(&frame, &mut picture);
                picture
            };
            let one = shown(&[square(4.0)]);
            assert!(
                shown(&[square(4.0), bad.clone()]) == one,
                "{engine:?}, {far}"
            );
        }
        // What was painted is painted over, too.
        let mut painter = Painter::new(Style::light()).checking();
        let mut picture = Picture::new(size, Colour::WHITE);
        for rings in [vec![square(4.0), bad], vec![square(5.0)]] {
            let mut frame = Frame::new(size);
            frame.push(Op::Region { rings, paint });
            painter.paint(&frame, &mut picture);
        }
        assert_eq!(painter.differing(), 0, "{far}");
    }
}

/// Marks that do not move have a layer, but those of which nothing is seen made none, or left that of other marks.
#[test]
fn unseen_marks_that_rest_do_not_stand_for_a_layer() {
    let size = Size::new(64, 64).unwrap();
    let dot = |x: f64, radius: f64, awake: bool| {
        let op = Op::Dot {
            centre: vec2(x, 20.0),
            radius,
            ink: Ink::Text,
        };
        (Source { body: None, awake }, op)
    };
    let (unseen, seen) = (dot(f64::NAN, 9.0, false), dot(20.0, 9.0, false));
    let (moving, moved) = (dot(24.0, 2.0, true), dot(25.0, 2.0, true));
    for frames in [
        vec![
            vec![],
            vec![unseen.clone()],
            vec![unseen.clone(), seen.clone()],
        ],
        vec![
            vec![seen.clone(), moving.clone()],
            vec![moving.clone()],
            vec![unseen.clone(), moving.clone()],
            vec![unseen, moved],
        ],
    ] {
        let mut painter = Painter::new(Style::light()).checking();
        let mut picture = Picture::new(size, Colour::WHITE);
        for marks in frames {
            let mut frame = Frame::new(size);
            for (source, op) in marks {
                frame.push_from(source, op);
            }
            painter.paint(&frame, &mut picture);
        }
        assert_eq!(painter.differing(), 0);
    }
}
