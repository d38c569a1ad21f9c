//! Where drawn frames go.

use carom_render::{Animation, Chroma, Draft, Film, OutputFolder, Sequence};
use carom_scenes::Built;

use crate::exit::Failure;
use crate::film::{Footage, Plan, shoot};

/// What a run gave, and where its pictures are.
type Shot = Result<(Footage, String), Failure>;

/// Numbered PNG files; those that are there already are kept.
pub(super) fn frames(built: &mut Built, plan: &Plan, folder: &OutputFolder) -> Shot {
    let there = |index: u64| folder.has(&Sequence::name(index));
    let kept = plan.slice.clone().filter(|&index| there(index)).count();
    let footage = shoot(
        built,
        plan,
        "render",
        |index| {
            // Listed in order, whatever the order in which threads finish.
            let missing = !there(index);
            if missing {
                folder.claim(&Sequence::name(index))?;
            }
            Ok(missing)
        },
        |index, picture| Ok(folder.save(&Sequence::name(index), &picture.to_png())?),
        |_, ()| Ok(()),
    )?;
    let place = folder.path().display();
    let files = match kept {
        0 => format!("in {place}"),
        _ => format!("{kept} kept, in {place}"),
    };
    Ok((footage, files))
}

/// One animated PNG.
pub(super) fn apng(built: &mut Built, plan: &Plan, folder: &OutputFolder, name: &str) -> Shot {
    let path = folder.claim(name)?;
    let mut film = Animation::create(&path, built.camera.size(), plan.rate)?;
    let footage = shoot(
        built,
        plan,
        "render",
        |_| Ok(true),
        |_, picture| Ok(picture.to_png()),
        |_, png| Ok(film.push_png(&png)?),
    )?;
    // Interrupted before the first frame: no film, and no file.
    if footage.drawn > 0 {
        film.finish()?;
    }
    Ok((footage, format!("in {}", path.display())))
}

/// One uncompressed film.
pub(super) fn y4m(built: &mut Built, plan: &Plan, folder: &OutputFolder, name: &str) -> Shot {
    let path = folder.claim(name)?;
    let draft = Draft::create(&path)?;
    let mut film = Film::new(draft, built.camera.size(), plan.rate, Chroma::Quarter)?;
    let footage = shoot(
        built,
        plan,
        "render",
        |_| Ok(true),
        |_, picture| Ok(picture),
        |_, picture| Ok(film.push(&picture)?),
    )?;
    if footage.drawn > 0 {
        film.finish()?.finish()?;
    }
    Ok((footage, format!("in {}", path.display())))
}
