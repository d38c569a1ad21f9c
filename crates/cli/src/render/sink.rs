//! Where drawn frames go.

use std::borrow::Cow;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use carom_render::{
    Animation, Chroma, Draft, Film, Frame, OutputFolder, Packing, Patch, RenderError, Sequence,
    Sheet,
};
use carom_scenes::Built;

use crate::exit::{Failure, fail};
use crate::film::{Easel, Footage, Plan, shoot};
use crate::out::is_closed_pipe;
use crate::relay::Relay;

/// Tiles of a contact sheet, and how many stand in a row.
const TILES: u64 = 12;
const COLUMNS: u32 = 4;

/// What a run gave, and where its pictures are.
type Shot = Result<(Footage, String), Failure>;

/// Numbered PNG files; those that are there already are kept.
pub(super) fn frames(
    built: &mut Built,
    plan: &Plan,
    folder: &OutputFolder,
    packing: Packing,
) -> Shot {
    numbered(built, plan, folder, Sequence::name, |easel, frame| {
        Cow::Borrowed(easel.png(frame, packing))
    })
}

/// Numbered SVG files; those that are there already are kept.
pub(super) fn drawings(built: &mut Built, plan: &Plan, folder: &OutputFolder) -> Shot {
    let style = built.look.style.clone();
    numbered(built, plan, folder, Sequence::svg_name, |_, frame| {
        Cow::Owned(frame.to_svg(&style).into_bytes())
    })
}

fn numbered(
    built: &mut Built,
    plan: &Plan,
    folder: &OutputFolder,
    name: impl Fn(u64) -> String + Sync,
    draw: impl for<'a> Fn(&'a mut Easel, &Frame) -> Cow<'a, [u8]> + Sync,
) -> Shot {
    let kept = plan
        .slice
        .clone()
        .filter(|&index| folder.has(&name(index)))
        .count();
    let footage = shoot(
        built,
        plan,
        "render",
        |index| !folder.has(&name(index)),
        |easel, index, frame| Ok(folder.save(&name(index), &draw(easel, &frame))?),
        |_, ()| Ok(()),
    )?;
    // A run of hours does not end as done while frames that it listed are missing.
    let gone = plan.slice.clone().find(|&index| !folder.has(&name(index)));
    if let Some(index) = gone.filter(|_| !footage.interrupted) {
        fail!(
            "{} was removed by something else: --resume draws it again",
            folder.path().join(name(index)).display()
        );
    }
    let place = folder.path().display();
    let files = match kept {
        0 => format!("in {place}"),
        _ => format!("{kept} kept, in {place}"),
    };
    Ok((footage, files))
}

/// One animated PNG.
pub(super) fn apng(
    built: &mut Built,
    plan: &Plan,
    folder: &OutputFolder,
    name: &str,
    packing: Packing,
) -> Shot {
    let path = folder.claim(name)?;
    let mut film = Animation::create(&path, built.camera.size(), plan.rate)?;
    let relay = Relay::from(plan.slice.start);
    let footage = shoot(
        built,
        plan,
        "render",
        |_| true,
        |easel, index, frame| {
            let turn = relay.turn(index);
            let (before, now) = turn.pass(easel.paint(&frame).clone());
            Ok(Patch::between(before.as_deref(), &now, packing))
        },
        |_, patch| Ok(film.push_patch(patch)?),
    )?;
    // Interrupted before the first frame: no film, and no file.
    if footage.drawn > 0 {
        film.finish()?;
        folder.seal(name)?;
    }
    Ok((footage, format!("in {}", path.display())))
}

/// One uncompressed film.
pub(super) fn y4m(built: &mut Built, plan: &Plan, folder: &OutputFolder, name: &str) -> Shot {
    let path = folder.claim(name)?;
    let (footage, draft) = film(built, plan, Draft::create(&path)?, &path)?;
    if footage.drawn > 0 {
        draft.finish()?;
        folder.seal(name)?;
    }
    Ok((footage, format!("in {}", path.display())))
}

/// The same to stdout; `None` if the reader went away.
pub(super) fn y4m_to_stdout(built: &mut Built, plan: &Plan) -> Result<Option<Footage>, Failure> {
    let mut gone = false;
    let out = Watched {
        out: BufWriter::new(io::stdout().lock()),
        gone: &mut gone,
    };
    match film(built, plan, out, Path::new("stdout")).map(|(footage, _)| footage) {
        Ok(footage) => Ok(Some(footage)),
        Err(_) if gone => Ok(None),
        Err(failure) => Err(failure),
    }
}

fn film<W: Write>(
    built: &mut Built,
    plan: &Plan,
    out: W,
    place: &Path,
) -> Result<(Footage, W), Failure> {
    let named = |error| named(error, place);
    let film = Film::new(out, built.camera.size(), plan.rate, Chroma::Quarter);
    let mut film = film.map_err(named)?;
    let footage = shoot(
        built,
        plan,
        "render",
        |_| true,
        |easel, _, frame| Ok(easel.paint(&frame).clone()),
        |_, picture| Ok(film.push(&picture).map_err(named)?),
    )?;
    Ok((footage, film.finish().map_err(named)?))
}

/// An error of a film, which knows its stream alone, with the place that the stream leads to.
fn named(error: RenderError, place: &Path) -> RenderError {
    match error {
        RenderError::Io { action, source, .. } => RenderError::Io {
            action,
            path: place.to_path_buf(),
            source,
        },
        other => other,
    }
}

/// A stream that remembers whether its reader went away.
struct Watched<'a, W> {
    out: W,
    gone: &'a mut bool,
}

impl<W> Watched<'_, W> {
    fn look<T>(&mut self, done: io::Result<T>) -> io::Result<T> {
        *self.gone |= done.as_ref().is_err_and(is_closed_pipe);
        done
    }
}

impl<W: Write> Write for Watched<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let done = self.out.write(bytes);
        self.look(done)
    }

    fn flush(&mut self) -> io::Result<()> {
        let done = self.out.flush();
        self.look(done)
    }
}

/// Twelve frames on one picture.
pub(super) fn sheet(
    built: &mut Built,
    plan: &Plan,
    folder: &OutputFolder,
    name: &str,
    packing: Packing,
) -> Shot {
    let style = built.look.style.clone();
    let mut sheet = blank(built).titled(name);
    let tiles = tiles(plan.frames);
    let footage = shoot(
        built,
        plan,
        "render",
        |index| tiles.contains(&index),
        |easel, _, frame| Ok(easel.paint(&frame).clone()),
        |index, picture| Ok(sheet.push(&picture, caption(index, plan))?),
    )?;
    let name = format!("{name}.png");
    match sheet.paint(&style) {
        Ok(picture) => folder.save(&name, &picture.to_png_packed(packing))?,
        Err(RenderError::NoFrames) => {}
        Err(error) => return Err(error.into()),
    }
    Ok((
        footage,
        format!("in {}", folder.path().join(name).display()),
    ))
}

fn blank(built: &Built) -> Sheet {
    Sheet::new(COLUMNS, (built.camera.size().width() / 3).max(1))
}

/// Refuses a sheet that would be too large, before anything is drawn.
pub(super) fn check_sheet(built: &Built, plan: &Plan) -> Result<(), Failure> {
    let count = u32::try_from(tiles(plan.frames).len()).unwrap_or(u32::MAX);
    let sheet = blank(built).titled("title");
    if let Err(error) = sheet.size(built.camera.size(), count) {
        fail!(
            "--format sheet of {count} frames of {} px: {error}",
            built.camera.size()
        );
    }
    Ok(())
}

/// The time of a frame, for its tile.
pub fn caption(index: u64, plan: &Plan) -> String {
    #[expect(clippy::cast_precision_loss, reason = "a frame number below 1e6")]
    let time = index as f64 * plan.rate.interval();
    format!("{time:.2} s")
}

/// The frames on a contact sheet of `frames`: the first, the last, and evenly between them.
pub fn tiles(frames: u64) -> Vec<u64> {
    let tiles = frames.min(TILES);
    let last = frames.saturating_sub(1);
    let mut list: Vec<u64> = (0..tiles).map(|k| k * last / (tiles - 1).max(1)).collect();
    list.dedup();
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_shows_the_first_and_the_last_frame() {
        for frames in [1, 2, 11, 12, 13, 600] {
            let list = tiles(frames);
            assert_eq!(list.len() as u64, frames.min(12), "{frames} frames");
            assert_eq!((list[0], *list.last().unwrap()), (0, frames - 1));
        }
    }
}
