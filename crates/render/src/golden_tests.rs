//! Small pictures of every mark and every overlay, looked at once and equal ever since.
//!
//! `UPDATE=1 cargo test -p carom-render golden` writes them anew; the difference is to be looked at.

use std::fs;
use std::path::{Path, PathBuf};

use carom_math::{Rot, Vec2, vec2};

use crate::{
    Chroma, Colour, Face, Film, Frame, FrameRate, Ink, Label, Op, Packing, Paint, Picture, Size,
    Style, agreement_tests, second_reader,
};

/// Asserts that a picture is the one in the folder of goldens.
#[track_caller]
pub(crate) fn golden(name: &str, picture: &Picture) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens");
    let place = folder.join(format!("{name}.png"));
    if std::env::var_os("UPDATE").is_some() {
        fs::create_dir_all(&folder).unwrap();
        picture.save_small_png(&place).unwrap();
    }
    let bytes = fs::read(&place).unwrap_or_else(|error| panic!("{}: {error}", place.display()));
    second_reader::agrees(&bytes);
    second_reader::agrees(&picture.to_png_packed(Packing::Fast));
    let expected = Picture::from_png(&bytes).unwrap();
    if expected == *picture {
        return;
    }
    let found: PathBuf = std::env::temp_dir().join(format!("carom-{name}.png"));
    picture.save_png(&found).unwrap();
    assert_eq!(picture.size(), expected.size(), "{name}");
    let pairs = picture.rgba().chunks(4).zip(expected.rgba().chunks(4));
    let apart = pairs.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max());
    let apart: Vec<u8> = apart.flatten().filter(|&apart| apart > 0).collect();
    panic!(
        "{name}: {} pixels differ, by {} at most: see {}; UPDATE=1 if it is right",
        apart.len(),
        apart.iter().max().unwrap_or(&0),
        found.display()
    );
}

pub(crate) const BLUE: Colour = Colour::hex(0x4C8ED9);
pub(crate) const RED: Colour = Colour::hex(0xE4685D);

fn op(name: &str, ops: impl IntoIterator<Item = Op>) {
    let mut frame = Frame::new(Size::new(64, 48).unwrap());
    for op in ops {
        frame.push(op);
    }
    golden(&format!("op-{name}"), &frame.paint(&Style::light()));
}

/// Points of a star around a place: every other corner lies nearer.
fn star(centre: Vec2, corners: u32, outer: f64, inner: f64) -> Vec<Vec2> {
    let turn = 180.0 / f64::from(corners);
    let corner = |k: u32| {
        let radius = if k.is_multiple_of(2) { outer } else { inner };
        centre + radius * Rot::from_degrees(turn * f64::from(k) + 7.0).x_axis()
    };
    (0..2 * corners).map(corner).collect()
}

/// Pictures are compared pixel by pixel elsewhere; here it is the bytes of files.
#[test]
fn golden_files() {
    let picture = agreement_tests::frame().paint(&Style::light());
    let png = crc32fast::hash(&picture.to_png());
    let mut film = Film::new(
        Vec::new(),
        picture.size(),
        FrameRate::per_second(25).unwrap(),
        Chroma::Quarter,
    )
    .unwrap();
    film.push(&picture).unwrap();
    let film = crc32fast::hash(&film.finish().unwrap());
    assert_eq!(
        [png, film],
        [0xC50F_39EF, 0x07AD_5637],
        "CRC-32 of a PNG and of a Y4M film"
    );
}

#[test]
fn golden_marks() {
    let middle = vec2(32.3, 24.2);
    let line = vec![
        vec2(6.5, 40.2),
        vec2(30.1, 8.4),
        vec2(38.0, 36.0),
        vec2(57.3, 10.9),
    ];
    op(
        "polygon",
        [Op::Polygon {
            points: star(middle, 5, 21.0, 9.0),
            paint: Paint::flat(BLUE),
        }],
    );
    let mut hole = star(middle, 4, 10.0, 7.0);
    hole.reverse();
    op(
        "region",
        [Op::Region {
            rings: vec![star(middle, 6, 22.0, 17.0), hole],
            paint: Paint::flat(RED),
        }],
    );
    op(
        "disc",
        [Op::Disc {
            centre: middle,
            radius: 18.4,
            paint: Paint::flat(BLUE).outlined(RED),
        }],
    );
    op(
        "ball",
        [Op::Disc {
            centre: middle,
            radius: 18.4,
            paint: Paint::flat(RED).shaded(),
        }],
    );
    op(
        "area",
        [Op::Area {
            points: star(middle, 3, 22.0, 12.0),
            ink: Ink::Contact,
        }],
    );
    op(
        "dot",
        (1..7).map(|k| {
            let x = f64::from(k);
            Op::Dot {
                centre: vec2(8.7 * x, 20.0 + 0.3 * x),
                radius: 0.7 * x,
                ink: Ink::Field,
            }
        }),
    );
    op(
        "ring",
        [
            Op::Ring {
                centre: middle,
                radius: 17.3,
                width: 4.2,
                ink: Ink::Series(2),
            },
            Op::Ring {
                centre: middle,
                radius: 8.3,
                width: 0.6,
                ink: Ink::Text,
            },
        ],
    );
    op(
        "line",
        [Op::Line {
            points: line.clone(),
            width: 5.0,
            dash: None,
            ink: Ink::Series(1),
        }],
    );
    op(
        "hairline",
        [Op::Line {
            points: line.clone(),
            width: 0.4,
            dash: None,
            ink: Ink::Text,
        }],
    );
    op(
        "dashes",
        [Op::Line {
            points: line,
            width: 2.0,
            dash: Some(4.0),
            ink: Ink::Muted,
        }],
    );
    op(
        "arrow",
        [
            Op::Arrow {
                from: vec2(6.0, 40.0),
                to: vec2(56.0, 9.0),
                width: 3.0,
                ink: Ink::Velocity,
            },
            Op::Arrow {
                from: vec2(8.0, 8.0),
                to: vec2(15.0, 8.5),
                width: 3.0,
                ink: Ink::Contact,
            },
        ],
    );
    op(
        "face",
        [Op::Face {
            centre: middle,
            radius: 19.0,
            turn: Rot::from_degrees(25.0),
            face: Face::smile(),
        }],
    );
    let frame = |inset: f64, fill, border, dash| Op::Box {
        min: vec2(inset, inset),
        max: vec2(64.0 - inset, 48.0 - inset),
        fill,
        border,
        width: 1.5,
        dash,
    };
    op(
        "box",
        [
            frame(3.5, Some(Ink::Grid), None, None),
            frame(8.3, None, Some(Ink::Text), None),
            frame(14.0, Some(Ink::Bar), Some(Ink::Muted), Some(3.0)),
        ],
    );
    let text = |y: f64, text: &str| Label::new(vec2(4.0, y), text, 9.0, Ink::Text);
    op(
        "label",
        [
            Op::Area {
                points: star(middle, 3, 22.0, 12.0),
                ink: Ink::Bar,
            },
            text(14.0, "Ag = 9.81").into(),
            text(30.0, "m/s² µ×").with_halo().into(),
            Label::new(vec2(60.0, 44.0), "up", 8.0, Ink::Contact)
                .upwards()
                .into(),
        ],
    );
    op(
        "clear",
        [
            Op::Disc {
                centre: middle,
                radius: 15.0,
                paint: Paint::flat(BLUE.with_alpha(90)),
            },
            Op::Dot {
                centre: vec2(22.0, 20.0),
                radius: 9.0,
                ink: Ink::Of(RED.with_alpha(128)),
            },
        ],
    );
}
