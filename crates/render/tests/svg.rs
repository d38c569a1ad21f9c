//! A drawing shows what the picture shows, mark by mark: SVG read by resvg against our own pixels.

use carom_render::math::{Rot, Vec2, vec2};
use carom_render::{
    BODY_COLOURS, Colour, Face, Frame, Ink, Label, Op, Paint, Picture, Size, Style,
};
use resvg::{tiny_skia, usvg};

const SIDE: u32 = 120;

/// The drawing as pixels.
fn read(svg: &str) -> tiny_skia::Pixmap {
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).expect("an SVG");
    let mut pixels = tiny_skia::Pixmap::new(SIDE, SIDE).expect("a size");
    resvg::render(
        &tree,
        tiny_skia::Transform::identity(),
        &mut pixels.as_mut(),
    );
    pixels
}

/// How far apart two pictures are: the mean over all bytes, and the share of those that are more than 64 apart.
fn apart(a: &[u8], b: &[u8]) -> (f64, f64) {
    assert_eq!(a.len(), b.len());
    let (mut sum, mut far) = (0_u32, 0_u32);
    for (a, b) in a.iter().zip(b) {
        let apart = a.abs_diff(*b);
        sum += u32::from(apart);
        far += u32::from(apart > 64);
    }
    let count = f64::from(u32::try_from(a.len()).expect("a small picture"));
    (f64::from(sum) / count, f64::from(far) / count)
}

fn star(centre: Vec2, count: u32, radii: [f64; 2]) -> Vec<Vec2> {
    let step = core::f64::consts::TAU / f64::from(count);
    (0..count)
        .map(|i| {
            centre + radii[i as usize % 2] * Rot::from_angle(0.3 + step * f64::from(i)).x_axis()
        })
        .collect()
}

/// Every kind of mark, what each of them is asked for, and numbers that are none.
fn marks() -> Vec<(&'static str, Op)> {
    let paint = Paint::flat(BODY_COLOURS[0]);
    let (centre, nan) = (vec2(60.3, 58.6), f64::NAN);
    let ink = Ink::Of(Colour::rgb(200, 30, 30));
    let line = |points: Vec<Vec2>, dash| Op::Line {
        points,
        width: 4.0,
        dash,
        ink,
    };
    let rectangle = |min, max| Op::Box {
        min,
        max,
        fill: Some(ink),
        border: Some(Ink::Text),
        width: 3.0,
        dash: None,
    };
    let disc = |radius| Op::Disc {
        centre,
        radius,
        paint,
    };
    let hole = star(centre, 5, [15.0; 2]).into_iter().rev().collect();
    vec![
        (
            "polygon",
            Op::Polygon {
                points: star(centre, 10, [45.0, 20.0]),
                paint,
            },
        ),
        (
            "region",
            Op::Region {
                rings: vec![star(centre, 8, [45.0; 2]), hole],
                paint,
            },
        ),
        ("disc", disc(33.0)),
        (
            "shaded disc",
            Op::Disc {
                centre,
                radius: 33.0,
                paint: paint.shaded(),
            },
        ),
        (
            "area",
            Op::Area {
                points: star(centre, 10, [45.0, 20.0]),
                ink,
            },
        ),
        (
            "dot",
            Op::Dot {
                centre,
                radius: 7.5,
                ink,
            },
        ),
        (
            "ring",
            Op::Ring {
                centre,
                radius: 33.0,
                width: 5.0,
                ink,
            },
        ),
        (
            "line",
            line(vec![vec2(10.0, 20.0), vec2(100.0, 70.0)], None),
        ),
        (
            "bent line",
            line(
                vec![vec2(10.0, 20.0), vec2(100.0, 70.0), vec2(30.0, 100.0)],
                None,
            ),
        ),
        (
            "dashed line",
            line(vec![vec2(10.0, 20.0), vec2(100.0, 70.0)], Some(9.0)),
        ),
        (
            "arrow",
            Op::Arrow {
                from: vec2(10.0, 20.0),
                to: vec2(100.0, 70.0),
                width: 5.0,
                ink,
            },
        ),
        (
            "face",
            Op::Face {
                centre,
                radius: 40.0,
                turn: Rot::from_angle(0.4),
                face: Face::smile(),
            },
        ),
        ("box", rectangle(vec2(20.0, 30.0), vec2(90.0, 80.0))),
        (
            "label",
            Op::Label(Label::new(vec2(10.0, 60.0), "12.5 m", 24.0, Ink::Text).with_halo()),
        ),
        (
            "box, inside out",
            rectangle(vec2(90.0, 80.0), vec2(20.0, 30.0)),
        ),
        (
            "box without an end",
            rectangle(vec2(20.0, 30.0), vec2(f64::INFINITY, 80.0)),
        ),
        (
            "line with a gap",
            line(
                vec![vec2(10.0, 20.0), vec2(nan, 3.0), vec2(100.0, 70.0)],
                None,
            ),
        ),
        (
            "polygon with a gap",
            Op::Polygon {
                points: [star(centre, 6, [45.0; 2]), vec![vec2(nan, nan)]].concat(),
                paint,
            },
        ),
        ("disc of no radius", disc(0.0)),
        ("disc of a negative radius", disc(-20.0)),
        ("disc of nan", disc(nan)),
        ("line of one point", line(vec![vec2(10.0, 20.0)], None)),
        (
            "dashes of no length",
            line(vec![vec2(10.0, 20.0), vec2(100.0, 70.0)], Some(0.0)),
        ),
        (
            "dashes without an end",
            line(
                vec![vec2(10.0, 20.0), vec2(100.0, 70.0)],
                Some(f64::INFINITY),
            ),
        ),
        (
            "ring of no width",
            Op::Ring {
                centre,
                radius: 33.0,
                width: 0.0,
                ink,
            },
        ),
        (
            "far out",
            line(vec![vec2(-1e9, 60.0), vec2(1e9, 60.0)], None),
        ),
    ]
}

#[test]
fn every_mark_is_drawn_as_it_is_painted() {
    let mut wrong = Vec::new();
    for style in [Style::light(), Style::dark(), Style::print()] {
        for (name, op) in marks() {
            let mut frame = Frame::new(Size::new(SIDE, SIDE).unwrap());
            frame.push(op);
            let painted: Picture = frame.paint(&style);
            let drawn = read(&frame.to_svg(&style));
            let (mean, share) = apart(painted.rgba(), drawn.data());
            println!(
                "{name}: {mean:.3} of 255 apart, {:.2} % by more than 64",
                100.0 * share
            );
            if mean > 0.5 || share > 0.004 {
                wrong.push(format!(
                    "{name}: {mean:.2} of 255 apart, {:.2} % by more than 64",
                    100.0 * share
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
