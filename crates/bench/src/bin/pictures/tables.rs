//! What is measured, and how it is printed.

use std::hint::black_box;
use std::path::Path;

use carom_bench::CpuClock;
use carom_math::Rot;
use carom_render::{
    Changes, Colour, Face, Frame, Op, Packer, Packing, Painter, Picture, Size, Style, write_file,
};

use crate::faces::{Balls, Turned};
use crate::peers::{Bytes, Cairo, Skia, Vello, Way};
use crate::scene::{Arrows, Scene};

/// Canvases and numbers of bodies, and the rounds that each is drawn for.
pub(crate) const ROWS: [(u32, u32, usize, usize); 8] = [
    (800, 800, 20, 61),
    (800, 800, 200, 61),
    (800, 800, 2000, 31),
    (800, 800, 20_000, 11),
    (1920, 1080, 20, 41),
    (1920, 1080, 200, 41),
    (1920, 1080, 2000, 21),
    (1920, 1080, 20_000, 11),
];

pub(crate) fn style() -> Style {
    Style {
        background: Colour::BLACK,
        outline: 0.0,
        ..Style::dark()
    }
}

/// The median; the times are sorted.
pub(crate) fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// CPU time of this thread in `work`, in ms.
pub(crate) fn timed(work: impl FnOnce()) -> f64 {
    let clock = CpuClock::thread();
    let start = clock.seconds();
    work();
    1e3 * (clock.seconds() - start)
}

const PAINTERS: usize = 6;

/// Drawing alone.
pub(crate) fn raster(arrows: Arrows, rows: &[(u32, u32, usize, usize)], folder: Option<&Path>) {
    println!(
        "| canvas, N | Cairo | as original | FAST | tiny-skia | vello_cpu | carom | /Cairo | /original | /tiny-skia | /vello |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for &(width, height, count, rounds) in rows {
        let size = Size::new(width, height).expect("a canvas of the table");
        let mut scene = Scene::new(size, count, count);
        let mut cairo = [Way::Direct, Way::Cached, Way::Fast]
            .map(|way| Cairo::new(size, way).expect("libcairo makes a surface"));
        let mut skia = Skia::new(size).expect("a size that is not zero");
        let mut vello = Vello::new(size);
        let mut carom = Painter::new(style()).redrawing();
        let mut picture = Picture::new(size, Colour::BLACK);
        let mut frame = Frame::new(size);
        let mut times: [Vec<f64>; PAINTERS] = Default::default();
        for round in 0..rounds {
            scene.step();
            let things = scene.things(arrows);
            scene.frame_into(arrows, &mut frame);
            for turn in 0..PAINTERS {
                let which = (turn + round) % PAINTERS;
                let time = timed(|| match which {
                    0..=2 => cairo[which].draw(&things).expect("Cairo draws"),
                    3 => skia.draw(&things),
                    4 => vello.draw(&things),
                    _ => {
                        carom.paint(&frame, &mut picture);
                    }
                });
                times[which].push(time);
            }
        }
        let [direct, original, fast, plain, strips, own] = times.map(|mut t| median(&mut t));
        println!(
            "| {width} × {height}, {count} | {direct:.2} | {original:.2} | {fast:.2} | {plain:.2} | {strips:.2} | {own:.2} | {:.2} | {:.2} | {:.2} | {:.2} |",
            own / direct,
            own / original,
            own / plain,
            own / strips,
        );
        if let Some(folder) = folder {
            let [direct, cached, _] = cairo;
            let all = [
                direct.bytes(),
                cached.bytes(),
                skia.bytes(),
                vello.bytes(),
                (picture.rgba().to_vec(), 0),
            ];
            let names = ["cairo", "original", "skia", "vello", "carom"];
            for (name, bytes) in names.iter().zip(all) {
                save(folder, &format!("{width}-{count}-{name}.png"), size, bytes);
            }
        }
    }
}

fn save(folder: &Path, name: &str, size: Size, (mut bytes, red): Bytes) {
    if red == 2 {
        for pixel in bytes.chunks_exact_mut(4) {
            pixel.swap(0, 2);
        }
    }
    let picture = Picture::from_rgba(size, bytes).expect("as many bytes as pixels");
    write_file(&folder.join(name), &picture.to_png()).expect("the folder is there");
}

/// Canvases of the tables of files.
const FILES: [(u32, u32, usize, usize); 5] = [
    (800, 800, 20, 21),
    (800, 800, 200, 21),
    (800, 800, 2000, 11),
    (800, 800, 20_000, 7),
    (1920, 1080, 200, 11),
];

/// Packing alone: the same scene by the painter of each.
pub(crate) fn packing() {
    println!(
        "| canvas, N | Cairo ms | bytes | carom fast ms | bytes | small ms | bytes | fast: Cairo/carom | bytes | small: bytes |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for (width, height, count, rounds) in FILES {
        let size = Size::new(width, height).expect("a canvas of the table");
        let mut scene = Scene::new(size, count, count);
        let mut cairo = Cairo::new(size, Way::Direct).expect("libcairo makes a surface");
        let mut frame = Frame::new(size);
        let mut times: [Vec<f64>; 3] = Default::default();
        let mut bytes = [0; 3];
        for round in 0..rounds {
            scene.step();
            cairo
                .draw(&scene.things(Arrows::Strokes))
                .expect("Cairo draws");
            scene.frame_into(Arrows::Strokes, &mut frame);
            let picture = frame.paint(&style());
            for turn in 0..3 {
                let which = (turn + round) % 3;
                times[which].push(timed(|| {
                    bytes[which] = match which {
                        0 => cairo.png(),
                        1 => picture.to_png(),
                        _ => picture.to_png_packed(Packing::Small),
                    }
                    .len();
                }));
            }
        }
        let [theirs, fast, small] = times.map(|mut t| median(&mut t));
        println!(
            "| {width} × {height}, {count} | {theirs:.1} | {} K | {fast:.2} | {} K | {small:.1} | {} K | {:.1} | {:.2} | {:.2} |",
            bytes[0] / 1000,
            bytes[1] / 1000,
            bytes[2] / 1000,
            theirs / fast,
            ratio(bytes[1], bytes[0]),
            ratio(bytes[2], bytes[0]),
        );
    }
}

#[expect(clippy::cast_precision_loss, reason = "bytes of a picture")]
fn ratio(a: usize, b: usize) -> f64 {
    a as f64 / b as f64
}

/// From the state to the bytes of a file, everything moving.
pub(crate) fn frames() {
    println!(
        "| canvas, N | Cairo + write_to_png | tiny-skia + png Fast | carom | of it list | drawing | Cairo/carom | tiny-skia/carom |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|");
    for (width, height, count, rounds) in FILES {
        let size = Size::new(width, height).expect("a canvas of the table");
        let mut scene = Scene::new(size, count, count);
        let mut cairo = Cairo::new(size, Way::Direct).expect("libcairo makes a surface");
        let mut skia = Skia::new(size).expect("a size that is not zero");
        let mut carom = Painter::new(style());
        let mut packer = Packer::new(Packing::Fast);
        let mut picture = Picture::new(size, Colour::BLACK);
        let mut frame = Frame::new(size);
        let mut times: [Vec<f64>; 5] = Default::default();
        for round in 0..rounds {
            scene.step();
            for turn in 0..3 {
                let which = (turn + round) % 3;
                let (mut list, mut drawing) = (0.0, 0.0);
                let time = timed(|| match which {
                    0 => {
                        cairo
                            .draw(&scene.things(Arrows::Strokes))
                            .expect("Cairo draws");
                        cairo.png();
                    }
                    1 => {
                        skia.draw(&scene.things(Arrows::Strokes));
                        skia.png();
                    }
                    _ => {
                        list = timed(|| {
                            scene.frame_into(Arrows::Strokes, &mut frame);
                        });
                        let mut changes = Changes::default();
                        drawing = timed(|| {
                            changes.clone_from(carom.paint(&frame, &mut picture));
                        });
                        black_box(packer.pack(&picture, &changes));
                    }
                });
                times[which].push(time);
                if which == 2 {
                    times[3].push(list);
                    times[4].push(drawing);
                }
            }
        }
        let [theirs, plain, own, list, drawing] = times.map(|mut t| median(&mut t));
        println!(
            "| {width} × {height}, {count} | {theirs:.1} | {plain:.2} | {own:.2} | {list:.2} | {drawing:.2} | {:.1} | {:.2} |",
            theirs / own,
            plain / own,
        );
    }
}

/// What is saved when few bodies move.
pub(crate) fn skipping() {
    println!(
        "| N, awake | list | gone on with | drawn in full | skipping | part | packed in full | what changed | part | all that is left of a full frame | dirty bands |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    let size = Size::new(800, 800).expect("a canvas of the table");
    for (count, awake, rounds) in [
        (20, 20, 61),
        (20, 4, 61),
        (20, 0, 61),
        (200, 200, 61),
        (200, 20, 61),
        (200, 2, 61),
        (200, 0, 61),
        (2000, 200, 31),
        (2000, 0, 31),
    ] {
        let mut scene = Scene::new(size, count, awake);
        let mut painters = [Painter::new(style()).redrawing(), Painter::new(style())];
        let mut pictures = [0, 1].map(|_| Picture::new(size, Colour::BLACK));
        // One list is made anew each time, one goes on from the marks that do not move.
        let mut frames = [0, 1].map(|_| Frame::new(size));
        let still = scene.frame_into(Arrows::Strokes, &mut frames[1]);
        let mut packer = Packer::new(Packing::Fast);
        let mut times: [Vec<f64>; 6] = Default::default();
        let mut dirty = 0.0;
        for round in 0..rounds {
            scene.step();
            times[2].push(timed(|| {
                scene.frame_into(Arrows::Strokes, &mut frames[0]);
            }));
            times[5].push(timed(|| {
                scene.frame_again(Arrows::Strokes, still, &mut frames[1]);
            }));
            assert!(frames[0] == frames[1], "both lists are the same");
            for turn in 0..2 {
                let which = (turn + round) % 2;
                let mut changes = Changes::default();
                times[which].push(timed(|| {
                    changes.clone_from(painters[which].paint(&frames[which], &mut pictures[which]));
                }));
                if which == 1 {
                    dirty += ratio(changes.count(), changes.bands().len());
                    times[4].push(timed(|| {
                        black_box(packer.pack(&pictures[1], &changes));
                    }));
                }
            }
            let mut file = Vec::new();
            times[3].push(timed(|| file = pictures[0].to_png()));
            assert!(pictures[0] == pictures[1], "skipping changes no pixel");
            assert!(
                packer.pack(&pictures[1], &Changes::default()) == file,
                "nor a byte"
            );
        }
        let [full, skipped, list, packed, again, on] = times.map(|mut t| median(&mut t));
        println!(
            "| {count}, {awake} | {list:.3} | {on:.3} | {full:.2} | {skipped:.3} | {:.3} | {packed:.2} | {again:.3} | {:.3} | {:.2} % | {:.0} % |",
            skipped / full,
            again / packed,
            100.0 * (on + skipped + again) / (list + full + packed),
            100.0 * dirty / ratio(rounds, 1),
        );
    }
}

/// Balls with faces: Cairo paints a picture of each turn, made before; carom turns the face.
pub(crate) fn faces() {
    println!("| 200 balls of radius | Cairo, cached turns | carom | ratio |");
    println!("|---|---:|---:|---:|");
    let size = Size::new(800, 800).expect("a canvas of the table");
    let face = Face::smile();
    for radius in [18.0, 40.0] {
        let mut balls = Balls::new(size, 200);
        let cairo = Turned::new(size, radius).expect("libcairo makes a surface");
        let mut carom = Painter::new(style()).redrawing();
        let mut picture = Picture::new(size, Colour::BLACK);
        let mut times: [Vec<f64>; 2] = Default::default();
        for round in 0..41 {
            balls.step();
            let mut frame = Frame::new(size);
            for (centre, turn) in balls.each() {
                frame.push(Op::Face {
                    centre,
                    radius,
                    turn: Rot::from_angle(turn),
                    face: face.clone(),
                });
            }
            for turn in 0..2 {
                let which = (turn + round) % 2;
                times[which].push(timed(|| {
                    if which == 0 {
                        cairo.draw(balls.each()).expect("Cairo draws");
                    } else {
                        carom.paint(&frame, &mut picture);
                    }
                }));
            }
        }
        let [theirs, own] = times.map(|mut t| median(&mut t));
        println!(
            "| {radius} px | {theirs:.2} | {own:.2} | {:.2} |",
            own / theirs
        );
    }
}
