//! The engine and its tick.

use carom_geometry::Aabb;
use carom_math::Vec2;
use fearless_simd::Level;

use crate::bodies::Bodies;
use crate::broad::{Broad, Pairs};
use crate::ghost::hide;
use crate::pieces::{Disc, Pieces};
use crate::rows::{
    Arrival, Graph, Law, Pass, arrivals, bounce, correct, displace, sweep, warm_start,
};
use crate::sleep::Islands;
use crate::update::{create, met_asleep, update};
use crate::{EngineError, Relaxation, Settings};

/// Bodies in contact, moved one sub-step after the other.
///
/// Its state is a pure function of the sequence of calls: equal calls, equal bits.
#[derive(Clone, Debug)]
pub struct Engine {
    pub(crate) settings: Settings,
    pub(crate) law: Law,
    /// Instructions that the processor has: they change no bit.
    pub(crate) level: Level,
    pub(crate) bodies: Bodies,
    pub(crate) pieces: Pieces,
    pub(crate) broad: Broad,
    pub(crate) known: Pairs,
    pub(crate) graph: Graph,
    /// Contacts that parted in this tick.
    parted: Vec<u32>,
    pub(crate) islands: Islands,
    /// Points that bounce in this sub-step.
    arrived: Vec<Arrival>,
}

impl Engine {
    /// An engine without bodies.
    ///
    /// # Errors
    /// [`EngineError::Value`] if a number of the settings is out of its range.
    pub fn new(settings: Settings) -> Result<Self, EngineError> {
        settings.check()?;
        Ok(Self {
            settings,
            law: Law::new(&settings),
            level: Level::new(),
            bodies: Bodies::new(),
            pieces: Pieces::default(),
            broad: Broad::new(),
            known: Pairs::new(),
            graph: Graph::new(),
            parted: Vec::new(),
            islands: Islands::default(),
            arrived: Vec::new(),
        })
    }

    /// Uses registers of at most four lanes from now on, for measurements: the bits stay.
    pub fn hold_to_four_lanes(&mut self) {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = self.level.as_avx2() {
            self.level = Level::Avx2(avx2);
        }
    }

    /// Moves all bodies by one tick of [`Settings::tick`].
    pub fn tick(&mut self) {
        self.find_contacts();
        self.substeps();
        self.settle();
    }

    /// Which pieces touch, or may within the tick, and where.
    pub(crate) fn find_contacts(&mut self) {
        self.rebase();
        self.broad
            .find(self.level, &self.bodies, &self.pieces, self.settings.tick);
        self.update_contacts();
    }

    pub(crate) fn substeps(&mut self) {
        for k in 1..=self.settings.substeps {
            self.substep(k == self.settings.substeps);
            if k < self.settings.substeps {
                self.follow_strays(f64::from(self.settings.substeps - k) * self.law.h);
            }
        }
    }

    /// Finds the contacts of bodies that go otherwise than was foreseen at the tick, for the `rest` of it in s.
    fn follow_strays(&mut self, rest: f64) {
        if self.bodies.rebase_strays(&self.settings, rest) {
            self.pose_moved();
            self.broad
                .find_few(self.level, &self.bodies, &self.pieces, self.settings.tick);
            self.update_contacts();
        }
    }

    /// Makes where bodies are their base poses, if that is far from these, and their boxes anew.
    fn rebase(&mut self) {
        self.bodies.rebase(self.settings.tick);
        self.pose_moved();
    }

    /// Poses the pieces of bodies that were rebased.
    fn pose_moved(&mut self) {
        for line in 2..self.bodies.lines.len() {
            if self.bodies.moved[line] {
                self.pose_pieces(line);
            }
        }
    }

    /// Poses the pieces of the body of a line, and makes their boxes.
    fn pose_pieces(&mut self, line: usize) {
        let Self {
            bodies,
            pieces,
            settings,
            ..
        } = self;
        let record = &bodies.records[bodies.slot_of[line] as usize];
        let (body, limit) = (&bodies.lines[line], bodies.limits[line]);
        let pose = bodies.base[line];
        for number in record.first_piece..record.first_piece + record.pieces {
            let tight = pieces.pose(number, pose);
            let outline = &pieces.outlines[number as usize];
            let (reach, extent) = (outline.reach(), outline.extent());
            // Half of a pair's margin, and what the body may go unseen.
            let slack = 0.5 * settings.margin * extent + 2.0 * limit.tolerance;
            let turn = body.w().abs() * settings.tick * reach;
            let around = Aabb::new(pose.position, pose.position).grown(reach);
            let box_ = intersection(tight.grown(turn), around.union(tight));
            let goes = body.v() * settings.tick;
            let falls = bodies.pull[line].v() * (settings.tick * settings.tick);
            let swept = stretched(stretched(box_, goes), falls);
            pieces.boxes[number as usize] = swept.grown(slack);
            pieces.discs[number as usize] = Disc {
                centre: pose.position,
                velocity: body.v(),
                radius: reach + slack + falls.length(),
            };
        }
    }

    /// Contacts of moved bodies anew, then those that came, then without those that went.
    fn update_contacts(&mut self) {
        let Self {
            settings,
            level,
            bodies,
            pieces,
            broad,
            graph,
            parted,
            ..
        } = self;
        parted.clear();
        update(*level, graph, bodies, pieces, settings, parted);
        if self.islands.any_asleep() {
            let met = met_asleep(bodies, pieces, settings, &broad.found);
            self.wake_all(&met);
        }
        let Self {
            settings,
            level,
            bodies,
            pieces,
            broad,
            known,
            graph,
            parted,
            ..
        } = self;
        create(*level, graph, bodies, pieces, settings, known, &broad.found);
        for &id in &*parted {
            known.remove(graph.contacts[id as usize].pieces);
            graph.remove(bodies, id);
        }
        hide(*level, graph, bodies, pieces, known);
        bodies.moved.fill(false);
    }

    /// One sub-step of the soft law.
    fn substep(&mut self, last: bool) {
        let Self {
            level,
            law,
            bodies,
            graph,
            arrived,
            ..
        } = self;
        let Bodies {
            lines, start, pull, ..
        } = bodies;
        let every = self.settings.relaxation == Relaxation::EverySubstep;
        warm_start(lines, start, pull, law.h);
        arrivals(*level, law, bodies, graph, arrived);
        let lines = &mut bodies.lines;
        let solve = if every {
            Pass::Solve
        } else {
            Pass::SolveWithFriction
        };
        sweep(*level, solve, law, lines, graph.awake());
        displace(lines, law.h);
        if every || last {
            sweep(*level, Pass::Relax, law, lines, graph.awake());
        }
        bounce(bodies, graph, arrived);
        let Bodies {
            lines, start, pull, ..
        } = bodies;
        correct(lines, start, pull, law.h);
    }
}

/// What both boxes hold.
fn intersection(a: Aabb, b: Aabb) -> Aabb {
    Aabb::new(a.min.max(b.min), a.max.min(b.max))
}

/// A box, and where it comes to by going `way`.
fn stretched(bounds: Aabb, way: Vec2) -> Aabb {
    Aabb::new(
        bounds.min + way.min(Vec2::ZERO),
        bounds.max + way.max(Vec2::ZERO),
    )
}
