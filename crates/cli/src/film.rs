//! From a built scene to frames: steps on this thread, drawing on others.

use std::cell::RefCell;
use std::fmt;
use std::ops::Range;

use carom_dynamics::EnergyLedger;
use carom_math::SimTime;
use carom_render::{Frame, FrameRate, Packer, Packing, Painter, Picture, Size, Style, Trace};
use carom_scenes::Built;

use crate::clock::Clock;
use crate::exit::{Failure, fail};
use crate::interrupt;
use crate::parallel;
use crate::progress::Progress;
use crate::reach::{Reached, reach};
use crate::summary::Watch;

/// Which frames to draw, and how.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frame k shows the instant k / rate.
    pub rate: FrameRate,
    /// Frames of the whole film.
    pub frames: u64,
    /// Frames of this slice of it.
    pub slice: Range<u64>,
    /// Threads that draw and encode.
    pub threads: usize,
}

/// What a run gave besides its pictures.
#[derive(Debug)]
pub struct Footage {
    /// From the first step to the last.
    pub watch: Watch,
    /// The ledger at each frame, with its time in s.
    pub energy: Vec<(f64, EnergyLedger)>,
    /// Of the steps, frame by frame.
    pub physics: Times,
    /// Of painting and packing, frame by frame.
    pub drawing: Times,
    /// Frames that were drawn.
    pub drawn: u64,
    /// Whether Ctrl-C ended it early.
    pub interrupted: bool,
}

/// What a drawing thread works with: it leaves alone what did not change since the frame that it drew before.
#[derive(Debug)]
pub struct Easel {
    painter: Painter,
    picture: Picture,
    /// The encoder of all pictures so far, if there is one.
    packer: Option<Packer>,
}

impl Easel {
    fn new(size: Size, style: Style) -> Self {
        Self {
            picture: Picture::new(size, style.background),
            painter: Painter::new(style),
            packer: None,
        }
    }

    /// The picture of a frame; its bytes do not depend on what was drawn before.
    pub fn paint(&mut self, frame: &Frame) -> &Picture {
        self.painter.paint(frame, &mut self.picture);
        self.packer = None;
        &self.picture
    }

    /// The picture of a frame as a PNG file; one easel packs all its frames alike.
    pub fn png(&mut self, frame: &Frame, packing: Packing) -> &[u8] {
        let changes = self.painter.paint(frame, &mut self.picture);
        let packer = self.packer.get_or_insert_with(|| Packer::new(packing));
        packer.pack(&self.picture, changes)
    }

    /// What was painted last.
    pub const fn picture(&self) -> &Picture {
        &self.picture
    }
}

/// Runs the scene, captures the frames that are `wanted`, and hands what `draw` makes of them to `take`, in order.
///
/// Steps and captures run on this thread, `draw` on others.
pub fn shoot<T: Send>(
    built: &mut Built,
    plan: &Plan,
    label: &str,
    wanted: impl Fn(u64) -> bool,
    draw: impl Fn(&mut Easel, u64, Frame) -> Result<T, Failure> + Sync,
    mut take: impl FnMut(u64, T) -> Result<(), Failure>,
) -> Result<Footage, Failure> {
    let mut progress = Progress::new(label, plan.slice.end, "frames");
    let mut footage = Footage {
        watch: Watch::start(&built.world),
        energy: Vec::new(),
        physics: Times::default(),
        drawing: Times::default(),
        drawn: 0,
        interrupted: false,
    };
    let (size, style) = (built.camera.size(), built.look.style.clone());
    let drawing = RefCell::new((Times::default(), 0));
    let mut indices = 0..plan.slice.end;
    let mut trace = Trace::new(&built.look.overlay);
    let produce = || {
        for index in indices.by_ref() {
            footage.interrupted = interrupt::asked();
            if footage.interrupted {
                break;
            }
            if index > 0 {
                footage.interrupted = !advance(built, plan.rate, index, &mut footage)?;
                if footage.interrupted {
                    break;
                }
            }
            trace.watch(&built.world);
            let energy = built.world.energy();
            footage.energy.push((built.world.time().as_secs(), energy));
            progress.advance();
            if plan.slice.contains(&index) && wanted(index) {
                let Built {
                    world,
                    look,
                    camera,
                    ..
                } = &*built;
                let frame = Frame::capture_traced(world, look, camera, &trace);
                return Ok(Some((index, frame)));
            }
        }
        Ok(None)
    };
    let equip = || Easel::new(size, style.clone());
    let work = |easel: &mut Easel, (index, frame): (u64, Frame)| {
        let clock = Clock::start();
        let made = draw(easel, index, frame)?;
        Ok((index, made, clock.seconds()))
    };
    let collect = |(index, made, seconds): (u64, T, f64)| {
        let mut drawing = drawing.borrow_mut();
        drawing.0.add(seconds);
        drawing.1 += 1;
        take(index, made)
    };
    parallel::in_order_with(plan.threads, equip, produce, work, collect)?;
    progress.finish();
    (footage.drawing, footage.drawn) = drawing.into_inner();
    Ok(footage)
}

/// Steps to the instant of a frame; `false` if Ctrl-C ended that on the way.
fn advance(
    built: &mut Built,
    rate: FrameRate,
    index: u64,
    footage: &mut Footage,
) -> Result<bool, Failure> {
    let target = SimTime::multiple(index, rate.interval());
    let clock = Clock::start();
    let watch = &mut footage.watch;
    let reached = reach(&mut built.world, target, |world, report| {
        watch.saw(world, report);
    });
    footage.physics.add(clock.seconds());
    match reached {
        Reached::There => Ok(true),
        Reached::Interrupted => Ok(false),
        Reached::Refused(why) => fail!("the step to frame {index} was refused: {why}"),
    }
}

/// Many measured times, in s.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    total: f64,
    largest: f64,
    count: u32,
}

impl Times {
    fn add(&mut self, seconds: f64) {
        self.total += seconds;
        self.largest = self.largest.max(seconds);
        self.count += 1;
    }
}

/// `1.23 s in all, 0.12 ms a frame, at most 0.54 ms`.
impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = 1e3 * self.total / f64::from(self.count.max(1));
        let largest = 1e3 * self.largest;
        write!(
            f,
            "{:.3} s in all, {mean:.3} ms a frame, at most {largest:.3} ms",
            self.total
        )
    }
}
