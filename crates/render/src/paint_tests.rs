//! What the painter promises: it always returns, nothing is lost or invented, and areas are right.

use carom_math::{Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::{BODY_COLOURS, Colour, Face, Frame, Ink, Label, Op, Paint, Picture, Size, Style};

fn canvas(width: u32, height: u32) -> Frame {
    Frame::new(Size::new(width, height).unwrap())
}

fn bare() -> Style {
    Style {
        outline: 0.0,
        ..Style::light()
    }
}

fn paint_one(op: Op) -> Picture {
    let mut frame = canvas(100, 80);
    frame.push(op);
    frame.paint(&bare())
}

/// Pixels of black ink on white, edges in proportion.
fn inked(picture: &Picture) -> f64 {
    let dark = |p: &[u8]| 1.0 - f64::from(p[0]) / 255.0;
    picture.rgba().chunks_exact(4).map(dark).sum()
}

const BLACK: Ink = Ink::Of(Colour::BLACK);

fn number() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        6 => -50.0..150.0_f64,
        1 => -1e5..1e5_f64,
        1 => prop::num::f64::ANY,
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e20, -1e20, 1e300, -1e300, 0.0, -0.0, 5e-324, 1e9, -1.0,
        ]),
    ]
}

fn point() -> impl Strategy<Value = Vec2> + Clone {
    (number(), number()).prop_map(|(x, y)| vec2(x, y))
}

fn any_op() -> impl Strategy<Value = Op> {
    let ring = prop::collection::vec(point(), 0..7);
    let paint = Paint::flat(BODY_COLOURS[0]);
    let dash = prop::option::of(number());
    prop_oneof![
        ring.clone()
            .prop_map(move |points| Op::Polygon { points, paint }),
        prop::collection::vec(ring.clone(), 0..4)
            .prop_map(move |rings| Op::Region { rings, paint }),
        ring.clone().prop_map(|points| Op::Area {
            points,
            ink: Ink::Text
        }),
        (point(), number(), any::<bool>()).prop_map(move |(centre, radius, shaded)| Op::Disc {
            centre,
            radius,
            paint: Paint { shaded, ..paint },
        }),
        (point(), number(), number()).prop_map(|(centre, radius, width)| Op::Ring {
            centre,
            radius,
            width,
            ink: Ink::Field,
        }),
        (ring, number(), dash.clone()).prop_map(|(points, width, dash)| Op::Line {
            points,
            width,
            dash,
            ink: Ink::Muted,
        }),
        (point(), point(), number()).prop_map(|(from, to, width)| Op::Arrow {
            from,
            to,
            width,
            ink: Ink::Velocity,
        }),
        (point(), point(), number(), dash).prop_map(|(min, max, width, dash)| Op::Box {
            min,
            max,
            fill: Some(Ink::Bar),
            border: Some(Ink::Text),
            width,
            dash,
        }),
        (point(), number(), number()).prop_map(|(centre, radius, angle)| Op::Face {
            centre,
            radius,
            turn: Rot::from_angle(angle),
            face: Face::smile(),
        }),
        (point(), number(), point(), number(), ".{0,8}").prop_map(
            |(at, height, anchor, angle, text)| {
                Op::Label(Label {
                    anchor,
                    turn: Rot::from_angle(angle),
                    ..Label::new(at, text, height, Ink::Text).with_halo()
                })
            }
        ),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn whatever_is_drawn_comes_back_opaque_and_twice_the_same(ops in prop::collection::vec(any_op(), 1..4)) {
        let mut frame = canvas(100, 80);
        for op in ops {
            frame.push(op);
        }
        let picture = frame.paint(&Style::dark());
        prop_assert!(picture.rgba().chunks_exact(4).all(|p| p[3] == 255));
        let mut again = Picture::new(Size::new(7, 3).unwrap(), Colour::WHITE);
        frame.paint_into(&Style::dark(), &mut again);
        prop_assert!(picture == again, "equal frames are equal bytes");
        prop_assert!(frame.to_svg(&Style::dark()).ends_with("</svg>\n"));
    }
}

proptest! {
    #[test]
    fn a_disc_covers_its_area(x in 30.0..70.0_f64, y in 30.0..50.0_f64, radius in 2.0..29.0_f64) {
        let picture = paint_one(Op::Dot { centre: vec2(x, y), radius, ink: BLACK });
        let area = core::f64::consts::PI * radius * radius;
        // The rasteriser's chords and its four rows a pixel: 0.1 px at the rim, less on average.
        prop_assert!((inked(&picture) - area).abs() < 0.05 * 2.0 * core::f64::consts::PI * radius + 0.2,
            "{} against {area}", inked(&picture));
    }

    #[test]
    fn holes_are_not_filled(x in 15.0..85.0_f64, y in 15.0..65.0_f64, half in 1.0..14.0_f64) {
        let square = |centre: Vec2, half: f64, turn: f64| -> Vec<Vec2> {
            let corner = vec2(half, half);
            let corners = (0..4).map(|i| Rot::from_degrees(turn * f64::from(i)) * corner);
            corners.map(|p| centre + p).collect()
        };
        // The canvas is 100 × 80 px: its rim is cut, the hole is not.
        let (outer, hole) = (square(vec2(50.0, 40.0), 60.0, 90.0), square(vec2(x, y), half, -90.0));
        let paint = Paint::flat(Colour::BLACK);
        let picture = paint_one(Op::Region { rings: vec![outer, hole], paint });
        let area = 8000.0 - 4.0 * half * half;
        prop_assert!((inked(&picture) - area).abs() < half + 0.5, "{} against {area}", inked(&picture));
    }

    #[test]
    fn a_polygon_covers_its_area(turn in 0.0..7.0_f64, radius in 4.0..38.0_f64, sides in 3..9_i32) {
        let points = (0..sides)
            .map(|i| {
                let angle = turn + core::f64::consts::TAU * f64::from(i) / f64::from(sides);
                vec2(50.0, 40.0) + radius * Rot::from_angle(angle).x_axis()
            })
            .collect();
        let picture = paint_one(Op::Area { points, ink: BLACK });
        let (sin, cos) = carom_math::trig::sin_cos(core::f64::consts::PI / f64::from(sides));
        let area = f64::from(sides) * radius * radius * sin * cos;
        let rim = 2.0 * f64::from(sides) * radius * sin;
        // The rasteriser rounds edges along the axes to quarters of a pixel: an eighth off at worst.
        prop_assert!((inked(&picture) - area).abs() < 0.125 * rim + 0.5, "{} against {area}", inked(&picture));
    }

    #[test]
    fn a_line_has_its_width_however_thin(width in 0.1..12.0_f64, slope in -20.0..20.0_f64) {
        let points = vec![vec2(-50.0, 40.0 - slope), vec2(150.0, 40.0 + slope)];
        let picture = paint_one(Op::Line { points, width, dash: None, ink: BLACK });
        // A level edge is found to a quarter of a row; below a pixel the ink is scaled instead.
        let area = 100.0 * width * (1.0 + slope * slope / 1e4).sqrt();
        prop_assert!((inked(&picture) - area).abs() < 26.0 * width.min(1.0) + 1.0, "{} against {area}", inked(&picture));
    }

    #[test]
    fn what_lies_outside_leaves_no_pixel(angle in 0.0..7.0_f64, far in 0.0..14.0_f64) {
        // Just off the canvas (65 px from its middle to a corner) up to where nothing is placed any more.
        let away = vec2(50.0, 40.0) + (90.0 + carom_math::trig::pow(10.0, far)) * Rot::from_angle(angle).x_axis();
        let mut frame = canvas(100, 80);
        frame.push(Op::Dot { centre: away, radius: 20.0, ink: BLACK });
        frame.push(Op::Ring { centre: away, radius: 20.0, width: 3.0, ink: BLACK });
        frame.push(Op::Area { points: [vec2(-9.0, 0.0), vec2(9.0, 0.0), vec2(0.0, 9.0)].map(|p| p + away).to_vec(), ink: BLACK });
        frame.push(Op::Face { centre: away, radius: 20.0, turn: Rot::IDENTITY, face: Face::smile() });
        frame.push(Op::Line { points: vec![away, away + vec2(5.0, 9.0)], width: 4.0, dash: None, ink: BLACK });
        prop_assert!(inked(&frame.paint(&bare())) == 0.0);
    }

    #[test]
    fn a_huge_disc_is_a_half_plane(angle in 0.0..7.0_f64, magnitude in 3.0..11.0_f64, depth in -30.0..30.0_f64) {
        // The rim passes the middle of the canvas at `depth`; sampled at two points 5 px to either side of it.
        let direction = Rot::from_angle(angle).x_axis();
        let radius = carom_math::trig::pow(10.0, magnitude);
        let middle = vec2(50.0, 40.0);
        let centre = middle - direction * (radius - depth);
        let picture = paint_one(Op::Dot { centre, radius, ink: BLACK });
        for (side, value) in [(-5.0, 0), (5.0, 255)] {
            let at = middle + direction * (depth + side);
            #[expect(clippy::cast_sign_loss, reason = "inside the picture")]
            let pixel = picture.pixel(at.x as u32, at.y as u32).unwrap();
            prop_assert_eq!(pixel.red, value, "radius {}, {} px from the rim", radius, side);
        }
    }
}

#[test]
fn an_empty_frame_is_its_ground() {
    let picture = canvas(9, 9).paint(&Style::dark());
    let ground = Some(Style::dark().background);
    assert!((0..9).all(|i| picture.pixel(i, i) == ground));
}

#[test]
fn nothing_without_extent_is_drawn() {
    let at = vec2(50.0, 40.0);
    for bad in [0.0, -0.0, -3.0, f64::NAN] {
        for op in [
            Op::Dot {
                centre: at,
                radius: bad,
                ink: BLACK,
            },
            Op::Ring {
                centre: at,
                radius: 10.0,
                width: bad,
                ink: BLACK,
            },
            Op::Ring {
                centre: at,
                radius: bad,
                width: 2.0,
                ink: BLACK,
            },
            Op::Line {
                points: vec![at, vec2(0.0, 0.0)],
                width: bad,
                dash: None,
                ink: BLACK,
            },
            Op::Arrow {
                from: at,
                to: vec2(0.0, 0.0),
                width: bad,
                ink: BLACK,
            },
            Op::Face {
                centre: at,
                radius: bad,
                turn: Rot::IDENTITY,
                face: Face::smile(),
            },
            Label::new(at, "text", bad, BLACK).into(),
        ] {
            assert_eq!(inked(&paint_one(op.clone())), 0.0, "{op:?}");
        }
    }
}

#[test]
fn a_line_of_any_width_is_cut_at_the_widest() {
    let line = |width: f64| {
        paint_one(Op::Line {
            points: vec![vec2(-1e7, 40.0), vec2(1e7, 41.0)],
            width,
            dash: None,
            ink: BLACK,
        })
    };
    assert_eq!(inked(&line(1e9)), 8000.0, "all of 100 x 80 px");
    assert_eq!(line(1e9), line(f64::INFINITY));
}

#[test]
fn a_label_stays_in_its_box() {
    let label = Label::new(vec2(50.0, 40.0), "12.5 s", 9.0, BLACK).anchored(0.5, 0.5);
    let half = vec2(0.5 * label.width() + 1.0, 6.0);
    let picture = paint_one(label.into());
    assert!(inked(&picture) > 40.0);
    for (i, pixel) in picture.rgba().chunks_exact(4).enumerate() {
        let at = vec2((i % 100) as f64 + 0.5, (i / 100) as f64 + 0.5) - vec2(50.0, 40.0);
        let inside = at.x.abs() <= half.x && at.y.abs() <= half.y;
        assert!(inside || pixel[0] == 255, "ink at {at}");
    }
}

#[test]
fn a_shaded_ball_is_bright_at_its_upper_left() {
    let fill = Colour::rgb(90, 150, 240);
    let picture = paint_one(Op::Disc {
        centre: vec2(50.0, 40.0),
        radius: 30.0,
        paint: Paint::flat(fill).shaded(),
    });
    // The focus is 0.2 r up and left of the centre.
    assert_eq!(picture.pixel(44, 34), Some(fill));
    let red = |x, y| picture.pixel(x, y).unwrap().red;
    assert!(
        red(44, 34) > red(60, 50) && red(60, 50) > red(70, 60),
        "darker to the lower right"
    );
    assert!(red(70, 60) >= 30, "never below a third");
}

#[test]
fn a_face_turns_with_its_disc() {
    let face = |turn: Rot| {
        paint_one(Op::Face {
            centre: vec2(50.0, 40.0),
            radius: 32.0,
            turn,
            face: Face::smile(),
        })
    };
    let upright = face(Rot::IDENTITY);
    let quarter = face(Rot::from_degrees(90.0));
    // Turned by a quarter in the picture (y down), what was 16 px right of the centre is 16 px below it.
    for (dx, dy) in [(16_i32, -8_i32), (-10, 12), (3, 20), (-9, -6)] {
        let at = |picture: &Picture, x: i32, y: i32| {
            let pixel = picture
                .pixel((50 + x).cast_unsigned(), (40 + y).cast_unsigned())
                .unwrap();
            f64::from(pixel.red) + f64::from(pixel.green) + f64::from(pixel.blue)
        };
        let (before, after) = (at(&upright, dx, dy), at(&quarter, -dy - 1, dx));
        assert!(
            (before - after).abs() < 30.0,
            "({dx}, {dy}): {before} and {after}"
        );
    }
    // Clipped to the disc.
    assert_eq!(upright.pixel(50 - 26, 40 - 26), Some(Colour::WHITE));
}

#[test]
fn half_of_a_dashed_line_is_drawn() {
    let line = |dash| {
        inked(&paint_one(Op::Line {
            points: vec![vec2(10.0, 40.5), vec2(90.0, 40.5)],
            width: 1.0,
            dash,
            ink: BLACK,
        }))
    };
    assert!((line(Some(4.0)) - 40.0).abs() < 0.5, "{}", line(Some(4.0)));
    assert!(
        (line(None) - 81.0).abs() < 0.8,
        "round ends add a dot: {}",
        line(None)
    );
}

#[test]
fn a_canvas_of_the_largest_side_is_painted_to_its_end() {
    let mut frame = canvas(16_384, 8);
    frame.push(Op::Dot {
        centre: vec2(16_380.0, 4.0),
        radius: 3.0,
        ink: BLACK,
    });
    let points = vec![vec2(0.0, 1.0), vec2(16_384.0, 1.0)];
    frame.push(Op::Line {
        points,
        width: 1.0,
        dash: None,
        ink: BLACK,
    });
    let picture = frame.paint(&bare());
    assert_eq!(picture.pixel(16_380, 4), Some(Colour::BLACK));
    let lines = (0..16_384)
        .filter(|&x| picture.pixel(x, 1) != Some(Colour::WHITE))
        .count();
    assert_eq!(lines, 16_384);
}
