//! `check`: whether a scene is valid, and what it costs, before anything is run.

use carom_dynamics::BodyKind;
use carom_geometry::{Outline, Shape};

use crate::exit::{End, Outcome};
use crate::flags::CheckArgs;
use crate::out::say;
use crate::render::frames;
use crate::scene;
use crate::summary::short;

/// Bytes of a pixel before it is packed.
const BYTES: u64 = 3;

pub(crate) fn run(args: &CheckArgs) -> Outcome {
    let scene = scene::open(&args.scene, &args.set, None)?;
    let built = scene.build()?;
    let size = built.camera.size();
    let frames = frames(built.duration, built.rate, size)?;
    scene::check_step(&scene, &built.world, built.rate.interval())?;

    let (mut bodies, mut moving, mut shapes, mut vertices) = (0, 0, 0, 0);
    for body in built.world.bodies() {
        bodies += 1;
        moving += usize::from(body.kind() != BodyKind::Fixed);
        for (shape, _) in body.shapes() {
            shapes += 1;
            vertices += count(shape);
        }
    }
    let pixels = frames * size.pixels() as u64;
    say!("valid        {}", scene.name());
    say!("bodies       {bodies} ({moving} moving)");
    say!("vertices     {vertices} in {shapes} shapes (a circle and a half-plane count as one)");
    say!(
        "film         {} s at {} per second: {frames} frames of {size} px",
        short(built.duration),
        built.rate.get()
    );
    say!("pixels       {pixels}");
    say!("bytes        {} unpacked", BYTES * pixels);
    Ok(End::Done)
}

/// Vertices of a shape, all parts together.
fn count(shape: &Shape) -> usize {
    match shape.outline() {
        Outline::Open(ring) | Outline::Closed(ring) => ring.len(),
        Outline::Rings(rings) => rings.iter().map(Vec::len).sum(),
        Outline::Parts(parts) => parts.iter().map(count).sum(),
        // A circle, a half-plane.
        _ => 1,
    }
}
