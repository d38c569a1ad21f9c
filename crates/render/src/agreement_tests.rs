//! Both engines draw the same picture, as far as tiny-skia's four rows a pixel let them.

use carom_math::{Rot, Vec2, vec2};

use crate::{
    BODY_COLOURS, Colour, Engine, Face, Frame, Ink, Label, Op, Paint, Painter, Picture, Size, Style,
};

const SIZE: (u32, u32) = (600, 400);

/// Every kind of mark, in several sizes.
pub(crate) fn frame() -> Frame {
    let mut frame = Frame::new(Size::new(SIZE.0, SIZE.1).unwrap());
    let star = |centre: Vec2, count: u32, radii: [f64; 2], turn: f64| -> Vec<Vec2> {
        let step = core::f64::consts::TAU / f64::from(count);
        let corner = |i: u32| {
            let angle = turn + step * f64::from(i);
            centre + radii[i as usize % 2] * Rot::from_angle(angle).x_axis()
        };
        (0..count).map(corner).collect()
    };
    for i in 0..8_u32 {
        let part = f64::from(i);
        let x = 50.0 + 70.0 * part;
        let radius = 2.0 + 4.0 * part;
        let paint = Paint::flat(BODY_COLOURS[i as usize]);
        let at = |y: f64| vec2(x, y);
        let turn = Rot::from_angle(0.3 * part);
        let ops = [
            Op::Polygon {
                points: star(at(50.0), 3 + i, [30.0, 30.0], 0.3),
                paint,
            },
            Op::Disc {
                centre: at(120.0),
                radius,
                paint: paint.shaded(),
            },
            Op::Line {
                points: vec![at(120.0), at(120.0) + vec2(radius, 0.0)],
                width: 1.25,
                dash: None,
                ink: Ink::Text,
            },
            Op::Face {
                centre: at(190.0),
                radius,
                turn,
                face: Face::smile(),
            },
            Op::Arrow {
                from: at(240.0) - vec2(20.0, 0.0),
                to: at(230.0) + vec2(20.0, 5.0 * part),
                width: 2.0,
                ink: Ink::Velocity,
            },
            Op::Ring {
                centre: at(290.0),
                radius,
                width: 3.0,
                ink: Ink::Field,
            },
            Op::Polygon {
                points: star(at(350.0), 10, [25.0, 11.0], 0.2 * part),
                paint,
            },
            Op::Box {
                min: at(350.0) - Vec2::splat(30.0),
                max: at(350.0) + Vec2::splat(30.0),
                fill: (i == 5).then_some(Ink::Of(Colour::BLACK.with_alpha(90))),
                border: Some(Ink::Muted),
                width: 1.0,
                dash: (i % 2 == 0).then_some(4.0),
            },
        ];
        for op in ops {
            frame.push(op);
        }
    }
    // A ring that crosses itself: its middle is covered twice.
    let pentagram = (0..5).map(|i| {
        vec2(560.0, 240.0)
            + 30.0 * Rot::from_angle(0.8 * core::f64::consts::PI * f64::from(i)).x_axis()
    });
    frame.push(Op::Area {
        points: pentagram.collect(),
        ink: Ink::Contact,
    });
    let hole = star(vec2(20.0, 200.0), 6, [8.0, 8.0], 0.1)
        .into_iter()
        .rev()
        .collect();
    frame.push(Op::Region {
        rings: vec![star(vec2(20.0, 200.0), 6, [16.0, 16.0], 0.3), hole],
        paint: Paint::flat(BODY_COLOURS[0]),
    });
    frame.push(
        Label::new(
            vec2(20.0, 395.0),
            "own scan converter 0123 t = 1.25 s",
            10.0,
            Ink::Text,
        )
        .with_halo(),
    );
    frame
}

fn painted(frame: &Frame, engine: Engine, style: Style) -> Picture {
    let mut picture = Picture::new(frame.size(), Colour::WHITE);
    Painter::new(style)
        .with_engine(engine)
        .paint(frame, &mut picture);
    picture
}

#[test]
fn both_engines_draw_the_same_picture() {
    let frame = frame();
    for style in [Style::light(), Style::dark()] {
        let [own, skia] =
            [Engine::Own, Engine::TinySkia].map(|engine| painted(&frame, engine, style.clone()));
        let (mut sum, mut far, mut worst) = (0_u64, 0, 0);
        for (a, b) in own.rgba().iter().zip(skia.rgba()) {
            let apart = a.abs_diff(*b);
            sum += u64::from(apart);
            far += usize::from(apart > 32);
            worst = worst.max(apart);
        }
        let mean = sum as f64 / own.rgba().len() as f64;
        let share = far as f64 / own.rgba().len() as f64;
        println!(
            "mean {mean:.3}, {:.3} % by more than 32, at most {worst}",
            100.0 * share
        );
        // tiny-skia is a quarter of a row off at worst, 64 steps between black and white.
        assert!(mean <= 0.3, "{mean} of 255 apart on average");
        assert!(share <= 0.002, "{share} of all bytes more than 32 apart");
        assert!(worst <= 96, "{worst} apart");
    }
}
