//! `merge`: the slices that `render --shard` wrote, joined into one folder.

use std::ops::Range;
use std::path::{Path, PathBuf};

use carom_render::{Checksum, Existing, Manifest, OutputFolder, Sequence, read_file};

use crate::exit::{End, Failure, Outcome, fail};
use crate::files;
use crate::flags::MergeArgs;
use crate::interrupt;
use crate::out::say;
use crate::progress::Progress;
use crate::render::Job;
use crate::sweep::join;
use crate::values::Shard;

/// A folder with one slice.
#[derive(Debug)]
struct Slice {
    folder: PathBuf,
    manifest: Manifest,
    job: Job,
}

pub(crate) fn run(args: &MergeArgs) -> Outcome {
    if args.out.as_deref().is_some_and(files::is_stdout) {
        fail!("--out - is no stdout here, and ./- a place of that name");
    }
    let is_table = |path: &PathBuf| path.extension().is_some_and(|end| end == "csv");
    if args.dirs.iter().all(is_table) {
        let out = args.out.as_deref().unwrap_or(Path::new("out/merged.csv"));
        for table in &args.dirs {
            if files::is_same(table, out) {
                fail!("--out {} is one of the slices", out.display());
            }
        }
        return join::run(&args.dirs, &files::prepare(out)?);
    }
    let place = args.out.as_deref().unwrap_or(Path::new("out/merged"));
    let slices = ordered(
        args.dirs
            .iter()
            .map(|dir| open(dir))
            .collect::<Result<_, _>>()?,
    )?;
    let job = Job {
        shard: Shard::WHOLE,
        ..slices[0].job.clone()
    };
    for slice in &slices {
        check(slice)?;
        if files::is_same(&slice.folder, place) {
            fail!("--out {} is one of the slices", place.display());
        }
    }
    let existing = if args.force {
        Existing::Replace
    } else {
        Existing::Refuse
    };
    let out = OutputFolder::open(place, existing, &job.to_string())?;
    say!(
        "{} frames of {} slices into {}",
        job.frames,
        slices.len(),
        out.path().display()
    );
    interrupt::watch("finishing the frame")?;
    let mut progress = Progress::new("merge", job.frames, "frames");
    for slice in &slices {
        for index in frames(slice) {
            if interrupt::asked() {
                progress.finish();
                say!("INTERRUPTED  merge again with --force");
                return Ok(End::Interrupted);
            }
            let name = name(slice, index);
            out.save(&name, &read(slice, &name)?)?;
            progress.advance();
        }
    }
    progress.finish();
    out.close()?;
    Ok(End::Done)
}

/// A folder's manifest, if `render` wrote it.
fn open(folder: &Path) -> Result<Slice, Failure> {
    let shown = folder.display();
    let Some(manifest) = Manifest::read(folder)? else {
        fail!("{shown} holds no frames of carom: it has no manifest.txt");
    };
    let Some(job) = Job::parse(&manifest.about) else {
        fail!(
            "{shown} was not written by render: its manifest says '{}'",
            manifest.about
        );
    };
    Ok(Slice {
        folder: folder.to_path_buf(),
        manifest,
        job,
    })
}

/// The slices in the order of their frames, if they are all there, once each, and of one run.
fn ordered(mut slices: Vec<Slice>) -> Result<Vec<Slice>, Failure> {
    slices.sort_by_key(|slice| slice.job.shard.index);
    for pair in slices.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let folders = format!("{} and {}", a.folder.display(), b.folder.display());
        if (&a.job.what, a.job.frames) != (&b.job.what, b.job.frames) {
            fail!(
                "{folders} hold different runs: '{}' and '{}'",
                a.manifest.about,
                b.manifest.about
            );
        }
        if a.job.shard.count != b.job.shard.count {
            fail!(
                "{folders} are cut differently: slice {} and slice {}",
                a.job.shard,
                b.job.shard
            );
        }
        if a.job.shard == b.job.shard {
            fail!("{folders} are both slice {}", a.job.shard);
        }
    }
    let count = slices[0].job.shard.count;
    let missing = (0..count).find(|&k| slices.get(index(k)).is_none_or(|s| s.job.shard.index != k));
    if let Some(index) = missing {
        fail!("slice {} is missing", Shard { index, count });
    }
    Ok(slices)
}

/// A number of slices fits: there are as many folders.
fn index(k: u64) -> usize {
    usize::try_from(k).unwrap_or(usize::MAX)
}

fn frames(slice: &Slice) -> Range<u64> {
    slice.job.shard.range(slice.job.frames)
}

/// A frame's file name: that of a picture, or of a drawing.
fn name(slice: &Slice, index: u64) -> String {
    let png = Sequence::name(index);
    if slice.manifest.files.contains_key(&png) {
        return png;
    }
    Sequence::svg_name(index)
}

/// Every frame is there, and as the manifest says.
fn check(slice: &Slice) -> Result<(), Failure> {
    for index in frames(slice) {
        let name = name(slice, index);
        let Some(Some(sum)) = slice.manifest.files.get(&name) else {
            fail!(
                "frame {index} is missing in {}: finish the slice with render --resume",
                slice.folder.display()
            );
        };
        let path = slice.folder.join(&name);
        if !sum.is_of(&path)? {
            return Err(changed(&path));
        }
    }
    Ok(())
}

/// The bytes of a frame, if they are still what was checked.
fn read(slice: &Slice, name: &str) -> Result<Vec<u8>, Failure> {
    let path = slice.folder.join(name);
    let Some(Some(sum)) = slice.manifest.files.get(name) else {
        return Err(changed(&path));
    };
    let bytes = read_file(&path, sum.length)
        .map_err(|error| Failure::new(format!("cannot read {}: {error}", path.display())))?;
    if Checksum::of(&bytes) == *sum {
        Ok(bytes)
    } else {
        Err(changed(&path))
    }
}

fn changed(path: &Path) -> Failure {
    Failure::new(format!(
        "{} is not what its manifest says: draw it again with render --resume",
        path.display()
    ))
}
