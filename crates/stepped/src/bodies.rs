//! Bodies: a record each, and a line for each that is awake.

use carom_math::{Pose, Vec2};

pub(crate) use crate::input::{BodyId, BodyInput, BodyKind};
use crate::rows::{Line, Quad};
use crate::{EngineError, Settings};

/// What is kept of a body, awake or not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    pub(crate) generation: u32,
    pub(crate) kind: BodyKind,
    pub(crate) live: bool,
    /// Its line: [`Bodies::GROUND`] if fixed.
    pub(crate) line: u32,
    /// Pieces are numbered from here on.
    pub(crate) first_piece: u32,
    pub(crate) pieces: u32,
    /// Counts insertions: the order of bodies that recycled slots cannot change.
    pub(crate) birth: u64,
    /// Head of the list of its contacts.
    pub(crate) contacts: u32,
    /// A bit for each colour that has a contact of it.
    pub(crate) colours: u64,
    /// Where a fixed body is; others have theirs by line.
    pub(crate) pose: Pose,
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
    pub(crate) gravity_scale: f64,
    /// Distance of its farthest point from the centre of mass, in m.
    pub(crate) reach: f64,
    /// The island that it sleeps in, or [`Bodies::NONE`].
    pub(crate) island: u32,
}

/// A body without its line: what waking puts back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sleeper {
    pub(crate) slot: u32,
    line: Line,
    start: Quad,
    base: Pose,
    limit: Limit,
}

/// How far a body may go from its base pose before its contacts are computed anew.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    /// Distance of its farthest point from the centre of mass, in m.
    pub(crate) reach: f64,
    /// In m.
    pub(crate) tolerance: f64,
    /// Of its smallest piece, in m.
    pub(crate) extent: f64,
}

/// All bodies. The lists by line hold awake bodies only.
#[derive(Clone, Debug)]
pub(crate) struct Bodies {
    pub(crate) records: Vec<Record>,
    free: Vec<u32>,
    births: u64,
    pub(crate) lines: Vec<Line>,
    /// Velocities before contacts acted: v − start = Σ M⁻¹ Jᵀ j.
    pub(crate) start: Vec<Quad>,
    /// Accelerations.
    pub(crate) pull: Vec<Quad>,
    /// Where bodies were when they were last rebased.
    pub(crate) base: Vec<Pose>,
    pub(crate) limits: Vec<Limit>,
    /// Slots of the bodies.
    pub(crate) slot_of: Vec<u32>,
    /// Whether they were rebased in this tick.
    pub(crate) moved: Vec<bool>,
    /// For how long they have been at rest, in s.
    pub(crate) rest: Vec<f64>,
    /// Velocities that their boxes were made for.
    pub(crate) foreseen: Vec<Quad>,
}

impl Bodies {
    /// The line that empty lanes name.
    const EMPTY: u32 = 0;
    /// The line of all fixed bodies.
    pub(crate) const GROUND: u32 = 1;
    pub(crate) const NONE: u32 = u32::MAX;

    pub(crate) fn new() -> Self {
        let unlimited = Limit {
            reach: 0.0,
            tolerance: f64::INFINITY,
            extent: f64::INFINITY,
        };
        Self {
            records: Vec::new(),
            free: Vec::new(),
            births: 0,
            lines: vec![Line::EMPTY, Line::GROUND],
            start: vec![Quad([0.0, 0.0, 0.0, 1.0]), Quad::default()],
            pull: vec![Quad::default(); 2],
            base: vec![Pose::IDENTITY; 2],
            limits: vec![unlimited; 2],
            slot_of: vec![Self::NONE; 2],
            moved: vec![false; 2],
            rest: vec![0.0; 2],
            foreseen: vec![Quad::default(); 2],
        }
    }

    /// Makes a record, and a line unless it is fixed; it has no pieces yet.
    pub(crate) fn insert(&mut self, input: &BodyInput, settings: &Settings) -> BodyId {
        let dynamic = input.kind == BodyKind::Dynamic;
        let slot = self.free.pop().unwrap_or_else(|| {
            #[expect(clippy::cast_possible_truncation, reason = "hundreds of bytes each")]
            let slot = self.records.len() as u32;
            self.records.push(Record::NONE);
            slot
        });
        self.births += 1;
        let record = &mut self.records[slot as usize];
        *record = Record {
            generation: record.generation + 1,
            kind: input.kind,
            live: true,
            birth: self.births,
            pose: input.pose,
            mass: if dynamic { input.mass } else { f64::INFINITY },
            inertia: if dynamic {
                input.inertia
            } else {
                f64::INFINITY
            },
            gravity_scale: if dynamic { input.gravity_scale } else { 0.0 },
            ..Record::NONE
        };
        let generation = record.generation;
        if input.kind == BodyKind::Fixed {
            record.line = Self::GROUND;
        } else {
            self.give_line(slot, input.velocity, input.spin, settings);
        }
        BodyId { slot, generation }
    }

    /// Gives a body a line at the end.
    fn give_line(&mut self, slot: u32, v: Vec2, w: f64, settings: &Settings) {
        #[expect(clippy::cast_possible_truncation, reason = "hundreds of bytes each")]
        let line = self.lines.len() as u32;
        let record = &mut self.records[slot as usize];
        record.line = line;
        let (m, i) = (record.mass.recip(), record.inertia.recip());
        self.lines.push(Line::new(v, w, m, i));
        // The fourth number stays what stands in the line, so that whole lines are added and subtracted.
        self.start.push(Quad([v.x, v.y, w, m]));
        self.pull
            .push(Quad::new(settings.gravity * record.gravity_scale, 0.0));
        self.base.push(record.pose);
        self.limits.push(Limit {
            reach: record.reach,
            tolerance: 0.0,
            extent: 0.0,
        });
        self.slot_of.push(slot);
        self.moved.push(true);
        self.rest.push(0.0);
        self.foreseen.push(Quad::new(v, w));
    }

    /// Takes the line of a body out, to be put back as it is but for a velocity of 0; which body moved to its place.
    pub(crate) fn lay(&mut self, slot: u32) -> (Sleeper, Option<u32>) {
        let at = self.records[slot as usize].line as usize;
        self.records[slot as usize].pose = self.pose_of(slot);
        let (mut line, mut start) = (self.lines[at], self.start[at]);
        // What contacts do in a sub-step stays.
        start.add(&Quad::new(-line.v(), -line.w()));
        line.set_velocity(Vec2::ZERO, 0.0);
        let sleeper = Sleeper {
            slot,
            line,
            start,
            base: self.base[at],
            limit: self.limits[at],
        };
        (sleeper, self.take_line(slot))
    }

    /// Gives a body its line again.
    pub(crate) fn raise(&mut self, sleeper: &Sleeper, settings: &Settings) {
        self.give_line(sleeper.slot, Vec2::ZERO, 0.0, settings);
        let at = self.lines.len() - 1;
        self.lines[at] = sleeper.line;
        self.start[at] = sleeper.start;
        self.base[at] = sleeper.base;
        self.limits[at] = sleeper.limit;
        self.moved[at] = false;
    }

    /// The line of a body; that of fixed ones if it sleeps.
    pub(crate) fn line_of(&self, slot: u32) -> usize {
        match self.records[slot as usize].line {
            Self::NONE => Self::GROUND as usize,
            line => line as usize,
        }
    }

    /// Takes a line out; the last one moves there. Gives the slot of the body that moved.
    pub(crate) fn take_line(&mut self, slot: u32) -> Option<u32> {
        let line = self.records[slot as usize].line;
        let at = line as usize;
        self.lines.swap_remove(at);
        self.start.swap_remove(at);
        self.pull.swap_remove(at);
        self.base.swap_remove(at);
        self.limits.swap_remove(at);
        self.slot_of.swap_remove(at);
        self.moved.swap_remove(at);
        self.rest.swap_remove(at);
        self.foreseen.swap_remove(at);
        self.records[slot as usize].line = Self::NONE;
        let moved = *self.slot_of.get(at)?;
        self.records[moved as usize].line = line;
        Some(moved)
    }

    /// Forgets a body without a line.
    pub(crate) fn remove(&mut self, slot: u32) {
        let record = &mut self.records[slot as usize];
        record.live = false;
        self.free.push(slot);
    }

    pub(crate) fn get(&self, id: BodyId) -> Result<&Record, EngineError> {
        let found = self.records.get(id.slot as usize);
        found
            .filter(|record| record.live && record.generation == id.generation)
            .ok_or(EngineError::Stale(id))
    }

    pub(crate) fn id(&self, slot: u32) -> BodyId {
        let generation = self.records[slot as usize].generation;
        BodyId { slot, generation }
    }

    /// Where a body was when it was last rebased.
    pub(crate) fn base_of(&self, slot: u32) -> Pose {
        let record = &self.records[slot as usize];
        match record.line {
            Self::GROUND | Self::NONE => record.pose,
            line => self.base[line as usize],
        }
    }

    /// Where a body is.
    pub(crate) fn pose_of(&self, slot: u32) -> Pose {
        let record = &self.records[slot as usize];
        match record.line {
            Self::GROUND | Self::NONE => record.pose,
            line => {
                let (base, line) = (self.base[line as usize], &self.lines[line as usize]);
                Pose::new(base.position + line.d(), base.rotation.turned(line.turn()))
            }
        }
    }

    /// Velocity of the centre of mass and spin.
    pub(crate) fn velocity_of(&self, slot: u32) -> (Vec2, f64) {
        match self.records[slot as usize].line {
            Self::NONE => (Vec2::ZERO, 0.0),
            // Adding 0 makes −0 a 0: a skipped block and one that pushes nothing give the same bits.
            line => {
                let line = &self.lines[line as usize];
                (line.v() + Vec2::ZERO, line.w() + 0.0)
            }
        }
    }

    /// Whether contacts move it.
    pub(crate) fn is_dynamic(&self, slot: u32) -> bool {
        self.records[slot as usize].kind == BodyKind::Dynamic
    }

    /// Marks whatever left its base pose by its tolerance, or may until the next tick, and makes its base pose where it is.
    pub(crate) fn rebase(&mut self, tick: f64) {
        for at in 2..self.lines.len() {
            let (line, limit) = (self.lines[at], self.limits[at]);
            let far = |v: Vec2, w: f64| v.x.abs().max(v.y.abs()) + w.abs() * limit.reach;
            let went = far(line.d(), line.turn());
            let goes = far(line.v(), line.w()) * tick;
            self.moved[at] |= went > limit.tolerance || goes > limit.tolerance;
            self.foreseen[at] = Quad::new(line.v(), line.w());
            if self.moved[at] {
                self.rebase_one(at);
            }
        }
    }

    /// The base pose of the body of a line is where it is, from now on.
    fn rebase_one(&mut self, at: usize) {
        let (line, base) = (&mut self.lines[at], &mut self.base[at]);
        base.position += line.d();
        base.rotation = base.rotation.turned_slightly(line.turn());
        line.clear_displacement();
    }

    /// Rebases those whose velocity changed so much that they may be a margin off what was foreseen `rest` seconds later.
    pub(crate) fn rebase_strays(&mut self, settings: &Settings, rest: f64) -> bool {
        let mut strays = false;
        for at in 2..self.lines.len() {
            let (line, limit, then) = (&self.lines[at], &self.limits[at], &self.foreseen[at]);
            let v = line.v() - then.v();
            let change = v.x.abs().max(v.y.abs()) + (line.w() - then.w()).abs() * limit.reach;
            // What gravity adds within a tick is foreseen.
            let change = change - self.pull[at].v().length() * settings.tick;
            if change * rest > settings.margin * limit.extent {
                (self.moved[at], strays) = (true, true);
                self.foreseen[at] = Quad::new(line.v(), line.w());
                self.rebase_one(at);
            }
        }
        strays
    }
}

impl Record {
    const NONE: Self = Self {
        generation: 0,
        kind: BodyKind::Fixed,
        live: false,
        line: Bodies::NONE,
        first_piece: 0,
        pieces: 0,
        birth: 0,
        contacts: u32::MAX,
        colours: 0,
        pose: Pose::IDENTITY,
        mass: f64::INFINITY,
        inertia: f64::INFINITY,
        gravity_scale: 0.0,
        reach: 0.0,
        island: Bodies::NONE,
    };
}

/// Keeps the first line's name in use: empty lanes name line 0.
const _: () = assert!(Bodies::EMPTY == 0);
