//! Films read back frame by frame, by three readers.

use super::*;
use crate::disk::fault;
use crate::{Colour, second_reader};
use ::png::{BlendOp, DecodeOptions, Decoder};
use proptest::prelude::*;
use std::fmt::Write as _;
use std::fs;

fn size() -> Size {
    Size::new(20, 10).unwrap()
}

fn shade(i: u8) -> Picture {
    Picture::new(size(), Colour::rgb(i, 2 * i, 255 - i))
}

fn rate() -> FrameRate {
    FrameRate::per_second(30).unwrap()
}

/// The bytes of a film of these pictures.
fn film(pictures: &[Picture], packing: Packing) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let mut film = Animation::create(&path, pictures[0].size(), rate())
        .unwrap()
        .packed(packing);
    for picture in pictures {
        film.push(picture).unwrap();
    }
    assert_eq!(film.finish().unwrap(), pictures.len() as u64);
    fs::read(&path).unwrap()
}

/// Every picture of a film as a viewer puts it together, once for each 1/30 s that it is shown.
fn played(bytes: &[u8]) -> Vec<Picture> {
    let mut options = DecodeOptions::default();
    options.set_ignore_checksums(false);
    let decoder = Decoder::new_with_options(std::io::Cursor::new(bytes), options);
    let mut reader = decoder.read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!(control.num_plays, 0);
    let canvas = Size::new(reader.info().width, reader.info().height).unwrap();
    let mut shown = vec![0_u8; 4 * canvas.pixels()];
    let mut pictures = Vec::new();
    let mut raw = vec![0; reader.output_buffer_size().unwrap()];
    for _ in 0..control.num_frames {
        reader.next_frame(&mut raw).unwrap();
        let frame = *reader.info().frame_control().unwrap();
        assert_eq!(frame.delay_den, 30);
        let width = frame.width as usize;
        for (k, pixel) in raw
            .chunks_exact(4)
            .take(width * frame.height as usize)
            .enumerate()
        {
            let (x, y) = (
                frame.x_offset as usize + k % width,
                frame.y_offset as usize + k / width,
            );
            let at = 4 * (y * canvas.width() as usize + x);
            if frame.blend_op == BlendOp::Source || pixel[3] == 255 {
                shown[at..at + 4].copy_from_slice(pixel);
            } else {
                assert_eq!(pixel, [0; 4], "half transparent");
            }
        }
        for _ in 0..frame.delay_num {
            pictures.push(Picture::from_rgba(canvas, shown.clone()).unwrap());
        }
    }
    assert!(
        reader.next_frame(&mut raw).is_err(),
        "no frame more than was said"
    );
    pictures
}

/// Pictures of which each differs from the one before in some pixels, many, or none.
fn changing(steps: &[(u8, u8, u8, u8)]) -> Vec<Picture> {
    let mut picture = shade(40);
    let mut pictures = vec![picture.clone()];
    for &(x, y, side, grey) in steps {
        let side = u32::from(side % 8);
        if side > 0 {
            let patch = Picture::new(Size::new(side, side).unwrap(), Colour::rgb(grey, grey, 7));
            picture.place(&patch, u32::from(x % 20), u32::from(y % 10));
        }
        pictures.push(picture.clone());
    }
    pictures
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn a_film_plays_as_it_was_made(steps in prop::collection::vec(any::<(u8, u8, u8, u8)>(), 0..12)) {
        let pictures = changing(&steps);
        for packing in [Packing::Fast, Packing::Small] {
            let bytes = film(&pictures, packing);
            prop_assert_eq!(played(&bytes), pictures.clone());
            second_reader::agrees(&bytes);
            // The first frame alone is what a plain PNG reader sees.
            prop_assert_eq!(&Picture::from_png(&bytes).unwrap(), &pictures[0]);
        }
    }

    #[test]
    fn patches_found_apart_make_the_same_film(steps in prop::collection::vec(any::<(u8, u8, u8, u8)>(), 0..12)) {
        let pictures = changing(&steps);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.png");
        let mut apart = Animation::create(&path, size(), rate()).unwrap();
        let before = [None].into_iter().chain(pictures.iter().map(Some));
        for (before, now) in before.zip(&pictures) {
            apart.push_patch(Patch::between(before, now, Packing::Fast)).unwrap();
        }
        apart.finish().unwrap();
        prop_assert_eq!(fs::read(&path).unwrap(), film(&pictures, Packing::Fast));
    }
}

/// Noise under a few pixels that move apart: the rectangle around them is dear, they are not.
#[test]
fn the_cheaper_of_both_ways_is_taken() {
    let size = Size::new(64, 64).unwrap();
    let noise = |seed: usize| {
        let bytes = (0..4 * size.pixels()).map(|i| ((i + seed) * (i + seed) / 7) as u8);
        Picture::from_rgba(size, bytes.collect()).unwrap()
    };
    let before = noise(0);
    let mut corners = before.clone();
    let dot = Picture::new(Size::new(1, 1).unwrap(), Colour::WHITE);
    corners.place(&dot, 0, 0);
    corners.place(&dot, 63, 63);
    let few = Patch::between(Some(&before), &corners, Packing::Fast);
    assert_eq!(few.blend(), Blend::Over);
    assert!(few.len() * 5 < Patch::between(None, &corners, Packing::Fast).len());
    let all = Patch::between(Some(&before), &noise(1), Packing::Fast);
    assert_eq!(all.blend(), Blend::Source);
}

#[test]
fn a_picture_that_stays_only_lasts_longer() {
    let bytes = film(&vec![shade(9); 1000], Packing::Fast);
    assert_eq!(played(&bytes).len(), 1000);
    assert!(bytes.len() < film(&[shade(9)], Packing::Fast).len() + 1);
    // Longer than one delay can say: more than 65,535 frames.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let one = Picture::new(Size::new(1, 1).unwrap(), Colour::BLACK);
    let mut film = Animation::create(&path, one.size(), rate()).unwrap();
    for _ in 0..70_000 {
        film.push(&one).unwrap();
    }
    film.finish().unwrap();
    assert_eq!(played(&fs::read(&path).unwrap()).len(), 70_000);
}

#[test]
fn the_file_has_its_name_only_when_it_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let mut film = Animation::create(&path, size(), rate()).unwrap();
    film.push(&shade(1)).unwrap();
    assert!(!path.exists());
    film.finish().unwrap();
    assert!(path.exists());
}

#[test]
fn a_disk_that_fills_up_at_any_moment_leaves_no_film() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    // Noise, so that the film outgrows the buffer in front of the disk.
    let size = Size::new(100, 200).unwrap();
    let noise = |seed: usize| {
        let mixed = (0..4 * size.pixels()).map(|i| (i * i * (seed + 3) / 11) as u8);
        Picture::from_rgba(size, mixed.collect()).unwrap()
    };
    let pictures: Vec<Picture> = (0..6).map(noise).collect();
    let whole = film(&pictures, Packing::Fast);
    for changes in 0.. {
        let (outcome, refused) = fault::after(changes, || {
            let mut film = Animation::create(&path, size, rate())?;
            for picture in &pictures {
                film.push(picture)?;
            }
            film.finish()
        });
        assert_eq!(outcome.is_err(), refused, "{changes} changes");
        if !refused {
            assert!(changes > 5, "{changes} changes");
            break;
        }
        let said = outcome.unwrap_err().to_string();
        assert!(
            said.contains("film.png") && said.contains("no storage space"),
            "{said}"
        );
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            0,
            "{changes} changes"
        );
    }
    assert_eq!(fs::read(&path).unwrap(), whole);
}

#[test]
fn nothing_is_left_of_a_film_without_frames() {
    let folder = tempfile::tempdir().unwrap();
    let film = Animation::create(folder.path().join("film.png"), size(), rate());
    assert!(matches!(film.unwrap().finish(), Err(RenderError::NoFrames)));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn other_sizes_and_films_without_a_beginning_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let mut film = Animation::create(&path, size(), rate()).unwrap();
    let error = film
        .push_patch(Patch::between(Some(&shade(1)), &shade(1), Packing::Fast))
        .unwrap_err();
    assert!(matches!(error, RenderError::NoWhole), "{error}");
    film.push(&shade(1)).unwrap();
    let other = Picture::new(Size::new(10, 20).unwrap(), Colour::WHITE);
    let error = film.push(&other).unwrap_err();
    assert_eq!(
        error.to_string(),
        "frame 1 is 10 x 20 px, the frames before it are 20 x 10 px"
    );
    drop(film);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A page that decodes a film by the browser's own decoder and sends back every frame's delay and pixels.
fn page(film: &[u8]) -> String {
    let bytes: Vec<String> = film.iter().map(u8::to_string).collect();
    format!(
        r#"<!doctype html><canvas id="canvas" width="20" height="10"></canvas><script>
(async () => {{
  let text = "";
  try {{
    const data = new Uint8Array([{}]);
    const decoder = new ImageDecoder({{ data, type: "image/png" }});
    await decoder.tracks.ready;
    await decoder.completed;
    const context = document.getElementById("canvas").getContext("2d");
    for (let k = 0; k < decoder.tracks.selectedTrack.frameCount; k++) {{
      const {{ image }} = await decoder.decode({{ frameIndex: k }});
      context.clearRect(0, 0, 20, 10);
      context.drawImage(image, 0, 0);
      const pixels = context.getImageData(0, 0, 20, 10).data;
      text += "frame " + image.duration + ":" + Array.from(pixels).join(",") + ";";
    }}
    text += "end";
  }} catch (error) {{
    text = "failed: " + error;
  }}
  await fetch("/", {{ method: "POST", body: text }});
}})();
</script>"#,
        bytes.join(",")
    )
}

#[test]
fn chromium_shows_what_was_made() {
    let steps = [
        (3, 2, 5, 200),
        (0, 0, 0, 0),
        (9, 1, 3, 90),
        (18, 9, 1, 255),
        (0, 0, 7, 10),
    ];
    let pictures = changing(&steps);
    let Some(shown) = second_reader::browse(&page(&film(&pictures, Packing::Fast))) else {
        return;
    };
    // The second picture is shown for two thirtieths of a second, the others for one; Chromium counts in whole milliseconds.
    let mut expected = String::new();
    for (k, duration) in [
        (0, 33_000),
        (1, 66_000),
        (3, 33_000),
        (4, 33_000),
        (5, 33_000),
    ] {
        let pixels: Vec<String> = pictures[k].rgba().iter().map(u8::to_string).collect();
        write!(expected, "frame {duration}:{};", pixels.join(",")).unwrap();
    }
    assert_eq!(shown, expected + "end");
}
