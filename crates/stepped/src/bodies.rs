//! Bodies: a record each, and a line for each that is awake.

use carom_math::{Pose, Vec2};

pub(crate) use crate::input::{BodyId, BodyInput, BodyKind};
pub(crate) use crate::record::{BEND, FAST, Limit, Record, Sleeper};
use crate::record::{UNDAMPED, drag};
use crate::rows::{Line, Quad, velocity_before};
use crate::{BodyIx, EngineError, LineIx, PieceIx, Settings};

/// A place in a list, or the length of one, as it is stored: what is counted so takes dozens of bytes each.
#[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32")]
pub(crate) const fn number(at: usize) -> u32 {
    at as u32
}

/// All bodies. The lists by line hold awake bodies only.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    pub(crate) records: Vec<Record>,
    free: Vec<BodyIx>,
    births: u64,
    /// Counts updates of contacts.
    pub(crate) updates: u64,
    pub(crate) lines: Vec<Line>,
    /// Velocities before contacts acted: v − start = Σ M⁻¹ Jᵀ j.
    pub(crate) start: Vec<Quad>,
    /// Accelerations.
    pub(crate) pull: Vec<Quad>,
    /// Where bodies were when they were last rebased.
    pub(crate) base: Vec<Pose>,
    /// Angles by which they had turned then, in rad, whole turns included.
    pub(crate) turned: Vec<f64>,
    pub(crate) limits: Vec<Limit>,
    /// Slots of the bodies.
    pub(crate) slot_of: Vec<BodyIx>,
    /// Whether they were rebased in this tick.
    pub(crate) moved: Vec<bool>,
    /// For how long they have been at rest, in s; −∞ of those that may not sleep.
    pub(crate) rest: Vec<f64>,
    /// Velocities that their boxes were made for.
    pub(crate) foreseen: Vec<Quad>,
    /// What a sub-step leaves of their velocities, and part of their accelerations that it adds: 1 without damping.
    pub(crate) drag: Vec<[Quad; 2]>,
    /// How many of them are damped.
    pub(crate) damped: usize,
    /// Whether they can be moved, and nothing accelerates them but contacts; and of how many that is so. Each row is asked for it in each
    /// sub-step: told from pull and mass it took 5 % of a weightless smash.
    free_lines: Vec<bool>,
    free_count: usize,
    /// Lines of bodies that may deviate from their predicted motions, perhaps more than once: see [`Self::rebase_deviating`].
    pub(crate) deviating: Vec<LineIx>,
    /// Others may as well: lines came or went, or some body was changed.
    pub(crate) may_deviate: bool,
    /// Lines of bodies that may go far in the next sub-step, perhaps more than once, if not all may: see [`Self::fast`].
    pub(crate) speedy: Option<Vec<LineIx>>,
    /// How far beyond their boxes bodies may have come in the last sub-step, in m.
    pub(crate) beyond_boxes: f64,
}

impl Bodies {
    pub(crate) fn new() -> Self {
        let unlimited = Limit {
            reach: 0.0,
            tolerance: f64::INFINITY,
            extent: f64::INFINITY,
        };
        Self {
            lines: vec![Line::EMPTY, Line::GROUND],
            start: vec![Quad([0.0, 0.0, 0.0, 1.0]), Quad::default()],
            pull: vec![Quad::default(); 2],
            base: vec![Pose::IDENTITY; 2],
            turned: vec![0.0; 2],
            limits: vec![unlimited; 2],
            slot_of: vec![BodyIx::NONE; 2],
            moved: vec![false; 2],
            rest: vec![0.0; 2],
            foreseen: vec![Quad::default(); 2],
            drag: vec![UNDAMPED; 2],
            free_lines: vec![false; 2],
            ..Self::default()
        }
    }

    /// The lines of all bodies that are awake and not fixed.
    pub(crate) fn awake(&self) -> impl Iterator<Item = LineIx> + Clone + use<> {
        (2..self.lines.len()).map(LineIx::new)
    }

    /// Where the centre of mass of the body of a line is.
    pub(crate) fn centre_at(&self, at: LineIx) -> Vec2 {
        self.base[at].position + self.lines[at].d()
    }

    /// The pieces of the body of a line.
    pub(crate) fn pieces_of_line(
        &self,
        line: LineIx,
    ) -> impl Iterator<Item = PieceIx> + Clone + use<> {
        self.records[self.slot_of[line]].pieces()
    }

    /// Number of the insertion of the body of a line; 0 for the lines of empty lanes and of fixed bodies.
    pub(crate) fn birth_of_line(&self, line: LineIx) -> u64 {
        let slot = self.slot_of[line];
        let record = self.records.get(slot.at());
        record.map_or(0, |record| record.birth)
    }

    /// Makes a record, and a line unless it is fixed; it has no pieces yet.
    pub(crate) fn insert(&mut self, input: &BodyInput, settings: &Settings) -> BodyId {
        let slot = self.free.pop().unwrap_or_else(|| {
            self.records.push(Record::NONE);
            BodyIx::new(self.records.len() - 1)
        });
        self.births += 1;
        let record = &mut self.records[slot];
        *record = Record {
            generation: record.generation + 1,
            kind: input.kind,
            live: true,
            sleep_allowed: input.sleep_allowed,
            birth: input.order.unwrap_or(self.births),
            placed: self.updates,
            pose: input.pose,
            turned: input.turned,
            tag: input.tag,
            ..Record::NONE
        };
        if input.kind == BodyKind::Dynamic {
            (record.mass, record.inertia) = (input.mass, input.inertia);
            (record.gravity_scale, record.damping) = (input.gravity_scale, input.damping);
        }
        let generation = record.generation;
        if input.kind == BodyKind::Fixed {
            record.line = LineIx::GROUND;
        } else {
            self.give_line(slot, input.velocity, input.spin, settings);
            if let Some(turned) = self.turned.last_mut() {
                *turned = input.turned;
            }
        }
        BodyId { slot, generation }
    }

    /// Gives a body a line at the end.
    fn give_line(&mut self, slot: BodyIx, v: Vec2, w: f64, settings: &Settings) {
        let line = LineIx::new(self.lines.len());
        let record = &mut self.records[slot];
        record.line = line;
        let (m, i) = (record.mass.recip(), record.inertia.recip());
        self.lines.push(Line::new(v, w, m, i));
        // The fourth number stays what stands in the line, so that whole lines are added and subtracted.
        self.start.push(Quad([v.x, v.y, w, m]));
        self.pull
            .push(Quad::new(settings.gravity * record.gravity_scale, 0.0));
        self.base.push(record.pose);
        self.turned.push(0.0);
        self.limits.push(Limit {
            reach: record.reach,
            tolerance: 0.0,
            extent: 0.0,
        });
        self.slot_of.push(slot);
        self.moved.push(true);
        self.rest.push(if record.sleep_allowed {
            0.0
        } else {
            f64::NEG_INFINITY
        });
        self.foreseen.push(Quad::new(v, w));
        let drag = drag(record.damping, settings.substep());
        self.damped += usize::from(drag != UNDAMPED);
        self.drag.push(drag);
        self.free_lines.push(false);
        self.note_free(line);
        (self.may_deviate, self.speedy) = (true, None);
    }

    /// Whether a body can be moved, and nothing accelerates it but contacts.
    #[inline]
    pub(crate) fn is_free(&self, line: LineIx) -> bool {
        self.free_lines[line]
    }

    fn note_free(&mut self, line: LineIx) {
        let is = self.pull[line] == Quad::default() && self.lines[line].inverse_mass() > 0.0;
        let was = core::mem::replace(&mut self.free_lines[line], is);
        self.free_count += usize::from(is);
        self.free_count -= usize::from(was);
    }

    /// Whether there is such a body.
    pub(crate) const fn any_is_free(&self) -> bool {
        self.free_count > 0
    }

    /// Sets what accelerates the body of a line besides contacts.
    pub(crate) fn set_pull(&mut self, line: LineIx, pull: Quad) {
        self.pull[line] = pull;
        self.note_free(line);
    }

    /// Takes the line of a body out, to be put back as it is but for a velocity of 0; which body moved to its place.
    pub(crate) fn lay(&mut self, slot: BodyIx) -> (Sleeper, Option<BodyIx>) {
        let at = self.records[slot].line;
        let (pose, turned) = (self.pose_of(slot), self.turned_at(at));
        let record = &mut self.records[slot];
        (record.pose, record.turned) = (pose, turned);
        let (mut line, mut start) = (self.lines[at], self.start[at]);
        // What contacts do in a sub-step stays.
        start.add(&Quad::new(-line.v(), -line.w()));
        line.set_velocity(Vec2::ZERO, 0.0);
        let sleeper = Sleeper {
            slot,
            line,
            start,
            pull: self.pull[at],
            base: self.base[at],
            turned: self.turned[at],
            limit: self.limits[at],
            moved: self.moved[at],
        };
        (sleeper, self.take_line(slot))
    }

    /// Angle by which the body of a line has turned, in rad, whole turns included.
    pub(crate) fn turned_at(&self, at: LineIx) -> f64 {
        self.turned[at] + self.lines[at].turn()
    }

    /// Gives a body its line again.
    pub(crate) fn raise(&mut self, sleeper: &Sleeper, settings: &Settings) {
        self.give_line(sleeper.slot, Vec2::ZERO, 0.0, settings);
        let at = self.records[sleeper.slot].line;
        self.lines[at] = sleeper.line;
        self.start[at] = sleeper.start;
        self.set_pull(at, sleeper.pull);
        self.base[at] = sleeper.base;
        self.turned[at] = sleeper.turned;
        self.limits[at] = sleeper.limit;
        self.moved[at] = sleeper.moved;
    }

    /// The line of a body; that of fixed ones if it sleeps.
    pub(crate) fn line_of(&self, slot: BodyIx) -> LineIx {
        match self.records[slot].line {
            LineIx::NONE => LineIx::GROUND,
            line => line,
        }
    }

    /// Takes a line out; the last one moves there. Gives the slot of the body that moved.
    pub(crate) fn take_line(&mut self, slot: BodyIx) -> Option<BodyIx> {
        let line = self.records[slot].line;
        let at = line.at();
        self.free_count -= usize::from(self.free_lines.swap_remove(at));
        self.lines.swap_remove(at);
        self.start.swap_remove(at);
        self.pull.swap_remove(at);
        self.base.swap_remove(at);
        self.turned.swap_remove(at);
        self.limits.swap_remove(at);
        self.slot_of.swap_remove(at);
        self.moved.swap_remove(at);
        self.rest.swap_remove(at);
        self.foreseen.swap_remove(at);
        let drag = self.drag.swap_remove(at);
        self.damped -= usize::from(drag != UNDAMPED);
        self.records[slot].line = LineIx::NONE;
        // What is noted of lines is so by their numbers.
        (self.may_deviate, self.speedy) = (true, None);
        let moved = *self.slot_of.get(at)?;
        self.records[moved].line = line;
        Some(moved)
    }

    /// Forgets a body without a line.
    pub(crate) fn remove(&mut self, slot: BodyIx) {
        let record = &mut self.records[slot];
        record.live = false;
        self.free.push(slot);
    }

    pub(crate) fn get(&self, id: BodyId) -> Result<&Record, EngineError> {
        let found = self.records.get(id.slot.at());
        found
            .filter(|record| record.live && record.generation == id.generation)
            .ok_or(EngineError::Stale(id))
    }

    pub(crate) fn id(&self, slot: BodyIx) -> BodyId {
        let generation = self.records[slot].generation;
        BodyId { slot, generation }
    }

    /// Where a body was when it was last rebased.
    pub(crate) fn base_of(&self, slot: BodyIx) -> Pose {
        let record = &self.records[slot];
        match record.line {
            LineIx::GROUND | LineIx::NONE => record.pose,
            line => self.base[line],
        }
    }

    /// Where a body is.
    pub(crate) fn pose_of(&self, slot: BodyIx) -> Pose {
        let record = &self.records[slot];
        match record.line {
            LineIx::GROUND | LineIx::NONE => record.pose,
            line => self.pose_at(line),
        }
    }

    /// Where the body of a line is, which is not fixed.
    #[inline]
    pub(crate) fn pose_at(&self, at: LineIx) -> Pose {
        let (base, line) = (self.base[at], &self.lines[at]);
        Pose::new(
            base.position + line.d(),
            base.rotation.turned_slightly(line.turn()),
        )
    }

    /// The velocity of the body of a line before the last sub-step, of `h` seconds.
    #[inline]
    pub(crate) fn velocity_before(&self, at: LineIx, h: f64) -> (Vec2, f64) {
        let drag = if self.damped > 0 {
            &self.drag[at]
        } else {
            &UNDAMPED
        };
        velocity_before(&self.start[at], &self.pull[at], drag, h)
    }

    /// Velocity of the centre of mass and spin.
    pub(crate) fn velocity_of(&self, slot: BodyIx) -> (Vec2, f64) {
        match self.records[slot].line {
            LineIx::NONE => (Vec2::ZERO, 0.0),
            // Adding 0 makes −0 a 0: a skipped block and one that pushes nothing give the same bits.
            line => {
                let line = &self.lines[line];
                (line.v() + Vec2::ZERO, line.w() + 0.0)
            }
        }
    }

    /// Whether a body that is awake is a disc about its centre of mass.
    pub(crate) fn is_disc(&self, slot: BodyIx) -> bool {
        let limit = &self.limits[self.line_of(slot)];
        limit.reach <= 0.5 * limit.extent * (1.0 + 1e-12)
    }

    /// Whether contacts move it.
    pub(crate) fn is_dynamic(&self, slot: BodyIx) -> bool {
        self.records[slot].kind == BodyKind::Dynamic
    }

    /// Marks whatever left its base pose by its tolerance, or may until the next tick, and makes its base pose where it is.
    pub(crate) fn rebase(&mut self, tick: f64) {
        for at in self.awake() {
            let (line, limit) = (self.lines[at], self.limits[at]);
            let far = |v: Vec2, w: f64| v.x.abs().max(v.y.abs()) + w.abs() * limit.reach;
            let went = far(line.d(), line.turn());
            let goes = far(line.v(), line.w()) * tick;
            // What waits for contacts is looked for again.
            let waits = self.records[self.slot_of[at]].placed == self.updates;
            self.moved[at] |= waits || went > limit.tolerance || goes > limit.tolerance;
            self.foreseen[at] = Quad::new(line.v(), line.w());
            if self.moved[at] {
                self.rebase_one(at);
            }
        }
    }

    /// The base pose of the body of a line is where it is, from now on, if that is a place.
    fn rebase_one(&mut self, at: LineIx) {
        let (line, base) = (&mut self.lines[at], &mut self.base[at]);
        if !line.is_finite() {
            return;
        }
        self.turned[at] += line.turn();
        base.position += line.d();
        base.rotation = base.rotation.turned_slightly(line.turn());
        line.clear_displacement();
    }

    /// By how much a point of a body goes otherwise than was foreseen, in m/s; what gravity adds within a tick is foreseen.
    pub(crate) fn change(&self, at: LineIx, tick: f64) -> f64 {
        let (line, then) = (&self.lines[at], &self.foreseen[at]);
        let v = line.v() - then.v();
        let turns = (line.w() - then.w()).abs() * self.limits[at].reach;
        v.x.abs().max(v.y.abs()) + turns - self.pull[at].v().length() * tick
    }

    /// Whether one of two bodies was put where it is since contacts were last found.
    pub(crate) fn were_placed(&self, slots: [BodyIx; 2]) -> bool {
        let placed = |slot: BodyIx| self.records[slot].placed == self.updates;
        slots.into_iter().any(placed)
    }

    /// Slots of the bodies that go far within `h` seconds.
    pub(crate) fn fast(&self, h: f64) -> impl Iterator<Item = BodyIx> + '_ {
        let noted = self.speedy.as_deref();
        let all = self.awake().filter(move |_| noted.is_none());
        let noted = noted.unwrap_or_default().iter().copied();
        let fast = noted.chain(all).filter(move |at| self.is_fast(*at, h));
        fast.map(|at| self.slot_of[at])
    }

    /// Whether the body of a line goes far within `h` seconds.
    fn is_fast(&self, at: LineIx, h: f64) -> bool {
        let (line, limit) = (&self.lines[at], &self.limits[at]);
        limit.is_far((line.v() * h).length_squared(), line.w() * h)
    }

    /// Changes the velocity of the body of a line by what lasts: its next sub-step begins with it.
    pub(crate) fn push(&mut self, line: LineIx, push: &Quad) {
        self.lines[line].add(push);
        self.start[line].add(push);
    }

    /// The body of a line has another velocity than the last sub-step left it with.
    pub(crate) fn note_change(&mut self, line: LineIx) {
        self.deviating.push(line);
        if let Some(speedy) = &mut self.speedy {
            speedy.push(line);
        }
    }

    /// Rebases bodies that may be a margin off their predicted motion `rest` seconds later, since their velocities changed.
    pub(crate) fn rebase_deviating(&mut self, settings: &Settings, rest: f64) -> bool {
        if self.may_deviate {
            let mut deviates = false;
            for at in self.awake() {
                deviates |= self.rebase_if_deviating(at, settings, rest);
            }
            return deviates;
        }
        let mut deviating = core::mem::take(&mut self.deviating);
        deviating.sort_unstable();
        deviating.dedup();
        let mut deviates = false;
        for &at in deviating.iter().filter(|at| **at > LineIx::GROUND) {
            deviates |= self.rebase_if_deviating(at, settings, rest);
        }
        self.deviating = deviating;
        deviates
    }

    fn rebase_if_deviating(&mut self, at: LineIx, settings: &Settings, rest: f64) -> bool {
        let (line, limit) = (&self.lines[at], &self.limits[at]);
        let off = self.change(at, settings.tick) * rest;
        // What came, or was put elsewhere, since the tick is off as well.
        let deviates = self.moved[at] || limit.deviates(settings.margin, off, line.turn());
        if deviates {
            self.moved[at] = true;
            self.foreseen[at] = Quad::new(line.v(), line.w());
            self.rebase_one(at);
        }
        deviates
    }
}
