//! The engine and its tick.

use carom_geometry::Aabb;
use carom_math::Vec2;
use fearless_simd::Level;

use crate::bodies::{Bodies, BodyKind};
use crate::broad::{Broad, Pairs};
use crate::continuous::{FastBody, note_fast};
use crate::ghost;
use crate::hard::HardRows;
use crate::impact::Impacts;
use crate::narrow::Scene;
use crate::pieces::{Disc, Pieces};
use crate::rows::{
    Arrival, Before, Deep, ExtraSweeps, FreePairs, Graph, Law, Pass, Quad, RotatingRows, Ways,
    arrivals, bounce, correct, displace, sweep, warm_start,
};
use crate::sleep::Islands;
use crate::update::{create, met_asleep, update};
use crate::whole::PutPairs;
use crate::{BodyIx, ContactIx, EngineError, LineIx, Mixed, PairRules, Settings};

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
    parted: Vec<ContactIx>,
    pub(crate) islands: Islands,
    /// Points that bounce in this sub-step.
    arrived: Vec<Arrival>,
    /// Their bodies before they bounced.
    before: Vec<Before>,
    /// Rows with extra sweeps.
    extra: ExtraSweeps,
    pub(crate) hard: HardRows,
    free: FreePairs,
    pub(crate) ways: Ways,
    pub(crate) deep: Deep,
    pub(crate) rotating: RotatingRows,
    pub(crate) impacts: Impacts,
    /// Sub-steps of the present tick so far.
    done: u32,
    /// Contacts of the next sub-step were found.
    found: bool,
    /// Boxes were made for the search that comes next.
    posed: Option<Posed>,
    /// Tags of both pieces of each contact that ended while it touched.
    pub(crate) ended: Vec<[u64; 2]>,
    /// Bodies that went far in the last sub-step, or were carried by a caller since.
    pub(crate) fast_bodies: Vec<FastBody>,
    /// Bodies that continuous collision stopped where they stood in the last sub-step, and what stands in their way.
    pub(crate) hanging: Vec<[BodyIx; 2]>,
    /// Lines of bodies that went far in this sub-step, and their displacements before it.
    pub(crate) far: Vec<(LineIx, Quad)>,
    /// Pairs of pieces that were looked at by shape.
    pub(crate) looks: u64,
    /// Bodies that were stopped since a number was no longer finite.
    pub(crate) stopped: u64,
    /// What friction turned to heat, in J.
    pub(crate) heat: f64,
    /// What belts gave, in J.
    pub(crate) belts: f64,
    /// The least gap of a contact in the last sub-step, in m.
    pub(crate) least_gap: f64,
    /// The same of those that were computed as the sub-step began, at the poses there.
    pub(crate) least_found: f64,
}

/// What the boxes of the next search were made for.
#[derive(Clone, Copy, Debug)]
struct Posed {
    /// A tick begins, and all bodies are searched for.
    at_tick: bool,
    /// Some body came, or goes otherwise than was foreseen at the tick.
    deviates: bool,
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
            pieces: Pieces::new(settings.margin),
            broad: Broad::default(),
            known: Pairs::default(),
            graph: Graph::new(),
            parted: Vec::new(),
            islands: Islands::default(),
            arrived: Vec::new(),
            before: Vec::new(),
            extra: ExtraSweeps::default(),
            hard: HardRows::default(),
            free: FreePairs::default(),
            ways: Ways::default(),
            deep: Deep::default(),
            rotating: RotatingRows::default(),
            impacts: Impacts::default(),
            done: 0,
            found: false,
            posed: None,
            ended: Vec::new(),
            fast_bodies: Vec::new(),
            hanging: Vec::new(),
            far: Vec::new(),
            looks: 0,
            stopped: 0,
            heat: 0.0,
            belts: 0.0,
            least_gap: f64::INFINITY,
            least_found: f64::INFINITY,
        })
    }

    /// Uses registers of at most four lanes from now on, for measurements: the bits stay.
    pub fn hold_to_four_lanes(&mut self) {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = self.level.as_avx2() {
            self.level = Level::Avx2(avx2);
        }
    }

    /// Moves all bodies by one tick of [`Settings::tick`]; all pieces touch each other.
    pub fn tick(&mut self) {
        self.tick_by(&Mixed);
    }

    /// Moves all bodies to the end of the tick.
    pub fn tick_by(&mut self, rules: &dyn PairRules) {
        self.substep(rules);
        while self.done > 0 {
            self.substep(rules);
        }
    }

    /// Moves all bodies by one sub-step. Contacts are found where it begins a tick, and those of bodies that came or go
    /// otherwise than was foreseen there in each.
    pub fn substep(&mut self, rules: &dyn PairRules) {
        self.find_contacts(rules);
        self.advance();
        self.finish(rules);
    }

    /// Says which sub-step of its tick is the next, from 0: time went by without one. Whether it did.
    pub fn set_phase(&mut self, done: u32) -> bool {
        let done = done % self.settings.substeps;
        let passed = self.done != done;
        if passed {
            (self.done, self.found, self.posed) = (done, false, None);
            // More time is left for them than was when they were noted.
            self.bodies.may_deviate |= !self.bodies.deviating.is_empty();
        }
        passed
    }

    /// Time to the end of the tick, in s.
    #[must_use]
    pub fn left(&self) -> f64 {
        f64::from(self.settings.substeps - self.done) * self.law.h
    }

    /// Whether the next sub-step begins a tick.
    #[must_use]
    pub const fn is_at_tick(&self) -> bool {
        self.done == 0
    }

    /// Finds which pieces touch, or may within the tick, and where: what [`Self::substep`] begins with. Called before it, it
    /// wakes islands that are met, and boxes are those of the sub-step; only bodies that came or were moved since are searched for
    /// again. Whether some body came, or goes otherwise than was foreseen at the tick.
    pub fn find_contacts(&mut self, rules: &dyn PairRules) -> bool {
        if !self.found {
            self.least_found = f64::INFINITY;
        }
        self.pose_boxes();
        let Some(posed) = self.posed.take() else {
            return false;
        };
        self.found = true;
        if !(posed.at_tick || posed.deviates || self.broad.has_arrivals()) {
            return false;
        }
        let (tick, at_tick) = (self.settings.tick, posed.at_tick);
        self.broad.find(&self.bodies, &self.pieces, tick, at_tick);
        self.update_contacts(rules);
        !posed.at_tick
    }

    /// Makes the boxes in which [`Self::find_contacts`] searches next, which else makes them itself: fixed bodies and sleepers that
    /// come between the two are met as if they had been there before. See [`Self::new_boxes`].
    pub fn pose_boxes(&mut self) {
        let is_known = self.found && !self.broad.has_arrivals();
        if self.posed.is_some() || is_known && !self.bodies.moved[2..].contains(&true) {
            return;
        }
        let at_tick = self.done == 0 && !self.found;
        let mut deviates = false;
        if at_tick {
            self.rebase();
        } else {
            let rest = self.left();
            deviates = self.bodies.rebase_deviating(&self.settings, rest);
            if deviates || self.broad.has_arrivals() {
                self.pose_moved();
            }
        }
        self.posed = Some(Posed { at_tick, deviates });
    }

    /// Calls `found` with the tag and the box of each dynamic body, or of a piece of it, that the next search is about, after
    /// [`Self::pose_boxes`].
    pub fn new_boxes(&self, mut found: impl FnMut(u64, Aabb)) {
        let mut tell = |slot: BodyIx, bounds: Aabb| {
            let record = &self.bodies.records[slot];
            if record.kind == BodyKind::Dynamic {
                found(record.tag, bounds);
            }
        };
        let boxes = &self.pieces.boxes;
        for line in self.bodies.awake().filter(|line| self.bodies.moved[*line]) {
            let its = self.bodies.pieces_of_line(line).map(|piece| boxes[piece]);
            tell(
                self.bodies.slot_of[line],
                its.fold(Aabb::EMPTY, Aabb::union),
            );
        }
        for &piece in &self.broad.woken {
            tell(self.pieces.list[piece].body, boxes[piece]);
        }
    }

    /// What [`Self::substep`] does between [`Self::find_contacts`] and [`Self::finish`].
    pub fn advance(&mut self) {
        (self.done, self.found, self.posed) = (self.done + 1, false, None);
        self.hard
            .gather(&self.settings, &mut self.graph, &mut self.bodies);
        self.extra.gather(&mut self.graph, &self.bodies);
        self.deep.gather(&mut self.graph, &self.bodies);
        self.move_bodies();
    }

    /// What [`Self::substep`] ends with: continuous collision for what [`Self::advance`] moved far, which is searched for in
    /// [`Self::fast_boxes`]; and sleep, where a tick ends.
    pub fn finish(&mut self, rules: &dyn PairRules) {
        let stopped = self.stop_fast(self.law.h, rules);
        self.measure_far(&stopped);
        if self.done == self.settings.substeps {
            self.done = 0;
            self.stop_non_finite();
            self.settle();
        }
    }

    /// The rest of a tick, once its contacts are known.
    #[cfg(test)]
    pub(crate) fn substeps(&mut self) {
        self.advance();
        self.finish(&Mixed);
        while self.done > 0 {
            self.substep(&Mixed);
        }
    }

    /// Makes where bodies are their base poses, if that is far from these, and their boxes anew.
    pub(crate) fn rebase(&mut self) {
        self.bodies.rebase(self.settings.tick);
        self.pose_moved();
    }

    /// Poses the pieces of bodies that were rebased.
    fn pose_moved(&mut self) {
        for line in self.bodies.awake() {
            if self.bodies.moved[line] {
                self.pose_pieces(line);
            }
        }
    }

    /// Poses the pieces of the body of a line, and makes their boxes.
    pub(crate) fn pose_pieces(&mut self, line: LineIx) {
        let (bodies, pieces) = (&self.bodies, &mut self.pieces);
        let (body, limit) = (&bodies.lines[line], bodies.limits[line]);
        let (pose, tick) = (bodies.base[line], self.settings.tick);
        for number in bodies.pieces_of_line(line) {
            let tight = pieces.pose(number, pose);
            let outline = &pieces.outlines[number];
            let (reach, extent) = (outline.reach(), outline.extent());
            // Half of a pair's margin, and what the body may go unseen.
            let slack = 0.5 * self.settings.margin * extent + 2.0 * limit.tolerance;
            let turn = body.w().abs() * tick * reach;
            let around = Aabb::new(pose.position, pose.position).grown(reach);
            let box_ = intersection(tight.grown(turn), around.union(tight));
            let goes = body.v() * tick;
            let falls = bodies.pull[line].v() * (tick * tick);
            let swept = stretched(stretched(box_, goes), falls);
            pieces.boxes[number] = swept.grown(slack);
            pieces.discs[number] = Disc {
                centre: pose.position,
                velocity: body.v(),
                radius: reach + slack + falls.length(),
                beyond: turn + slack + falls.length(),
            };
        }
    }

    /// Contacts of moved bodies anew, then those that came, then without those that went.
    fn update_contacts(&mut self, rules: &dyn PairRules) {
        self.parted.clear();
        let mut put = PutPairs::of(&self.graph);
        let least = update(
            (self.level, &self.law),
            (&mut self.graph, &mut self.rotating, &mut put),
            &mut self.bodies,
            &self.pieces,
            &self.settings,
            &mut self.parted,
        );
        self.least_found = self.least_found.min(least);
        if self.islands.any_asleep() {
            let met = met_asleep(&self.scene(), &self.broad.found, rules);
            self.wake_all(&met);
        }
        self.looks += self.broad.found.len() as u64;
        let least = create(
            (self.level, &self.law),
            (&mut self.graph, &mut self.rotating),
            &mut self.bodies,
            (&self.pieces, &self.settings),
            (&mut self.known, &self.broad.found),
            (&self.deep, &mut put),
            rules,
        );
        self.least_found = self.least_found.min(least);
        let parted = core::mem::take(&mut self.parted);
        for &id in &parted {
            self.part(id);
        }
        self.parted = parted;
        ghost::filter(&mut self.graph, &mut self.bodies, &self.pieces);
        self.bodies.moved.fill(false);
        self.bodies.updates += 1;
    }

    /// What the narrow phase reads.
    pub(crate) const fn scene(&self) -> Scene<'_> {
        Scene {
            level: self.level,
            bodies: &self.bodies,
            pieces: &self.pieces,
            settings: &self.settings,
        }
    }

    /// Takes a contact out.
    pub(crate) fn part(&mut self, id: ContactIx) {
        let pieces = self.graph.contacts[id].pieces;
        if self.graph.is_touching(id) {
            self.ended.push(self.pieces.tags(pieces));
        }
        self.known.remove(pieces);
        self.graph.remove(&mut self.bodies, id);
    }

    /// One sub-step of the soft law.
    fn move_bodies(&mut self) {
        let Self {
            settings,
            level,
            law,
            bodies,
            pieces,
            graph,
            arrived,
            before,
            extra,
            hard,
            free,
            ways,
            impacts,
            fast_bodies,
            far,
            ..
        } = self;
        ways.start(bodies);
        free.meet(graph, bodies);
        warm_start(*level, bodies, law.h);
        hard.free(bodies, graph);
        arrivals((*level, law), bodies, graph, arrived, before);
        impacts.note_arrivals(arrived, graph);
        if hard.solve(law, bodies, graph) {
            // Islands without an answer are swept instead.
            extra.gather(graph, bodies);
            free.meet(graph, bodies);
        }
        sweep(*level, Pass::Solve, law, &mut bodies.lines, graph.soft());
        extra.sweep(Pass::Solve, law, bodies, graph);
        impacts.note_hits(law, bodies, graph, false);
        free.note_impulses(graph);
        displace(*level, bodies, law.h, far);
        ways.begin(bodies);
        note_fast(bodies, settings, law.h, far, fast_bodies);
        self.deep.part(law, bodies, graph, free);
        let seen = sweep(*level, Pass::Relax, law, &mut bodies.lines, graph.soft());
        extra.sweep(Pass::Relax, law, bodies, graph);
        free.turn_back(graph, bodies, law.h);
        self.heat += seen.heat + hard.heat;
        self.belts += graph.belt_work();
        let rest = f64::from(settings.substeps - self.done) * law.h;
        correct(*level, bodies, settings, law.h, rest);
        self.rotating.rotate(graph, bodies);
        let gap = hard.part(law, bodies, (graph, free), settings, true);
        free.turn_back_late(graph, bodies, law.h);
        impacts.note_hits(law, bodies, graph, true);
        impacts.add_rows(law, arrived, bodies, graph);
        let [heat, given] = bounce(bodies, graph, arrived, before);
        self.heat += heat;
        self.belts += given;
        impacts.end(law, arrived, bodies, graph, pieces);
        let borne = hard.part(law, bodies, (graph, free), settings, false);
        let least = seen.least_gap.min(self.deep.least_gap);
        self.least_gap = least.min(gap).min(borne);
        ways.end(bodies, law.h);
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
