//! What a caller reads between ticks.

use carom_geometry::Aabb;
use carom_math::{Pose, Vec2};

use crate::{
    BodyId, BodyIx, BodyKind, ContactIx, Engine, EngineError, Entry, LineIx, PieceIx, Settings,
};

/// A body as the last sub-step left it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Its name.
    pub id: BodyId,
    /// The caller's own, as in [`BodyInput::tag`](crate::BodyInput::tag).
    pub tag: u64,
    /// What moves it.
    pub kind: BodyKind,
    /// Where the centre of mass is, in m, and how the body is turned.
    pub pose: Pose,
    /// Angle by which it has turned, in rad, whole turns included, from [`BodyInput::turned`](crate::BodyInput::turned) on.
    pub turned: f64,
    /// Velocity of the centre of mass, in m/s, and spin, in rad/s.
    pub velocity: (Vec2, f64),
    /// The same before the last sub-step.
    pub before: (Vec2, f64),
    /// What the velocity and spin on the way through the last sub-step lacked of these, as it began and as it ended, if contacts alone
    /// act on the body, which goes evenly then, and [`Engine::note_ways`] asked for it.
    pub lack: Option<[(Vec2, f64); 2]>,
}

/// A contact of two pieces, as the last sub-step left it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// A and B: A was inserted first.
    pub bodies: [BodyId; 2],
    /// Index of each one's convex piece.
    pub pieces: [u32; 2],
    /// Tags of both pieces.
    pub tags: [u64; 2],
    /// Whether it pushed when begins and ends of touch were last asked for.
    pub touching: bool,
    /// Points, midway between the surfaces, in m: of the first [`Self::points`] of them.
    pub places: [Vec2; 2],
    /// Unit normal from A to B.
    pub normal: Vec2,
    /// How many points it has: 1 or 2.
    pub points: usize,
    /// Gap of each point, in m; below zero they overlap.
    pub gaps: [f64; 2],
    /// Normal impulse of each point in the last sub-step, in N·s.
    pub impulses: [f64; 2],
    /// Impulse of friction on B in the last sub-step along the normal turned by +90°, in N·s.
    pub friction: f64,
}

impl Engine {
    /// Notes from now on how free bodies go through each sub-step, or forgets it: see [`State::lack`].
    pub fn note_ways(&mut self, noted: bool) {
        self.ways.note(noted);
    }

    /// What it was made with.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Solves of hard rows that found no answer, since the engine was made: each left an island to soft rows until it has other
    /// contacts.
    #[must_use]
    pub const fn failed_hard_solves(&self) -> u64 {
        self.hard.failed
    }

    /// Where the centre of mass of a body is, in m, and how it is turned.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn pose(&self, id: BodyId) -> Result<Pose, EngineError> {
        self.bodies.get(id)?;
        Ok(self.bodies.pose_of(id.slot))
    }

    /// Velocity of the centre of mass, in m/s, and spin, in rad/s.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn velocity(&self, id: BodyId) -> Result<(Vec2, f64), EngineError> {
        self.bodies.get(id)?;
        Ok(self.bodies.velocity_of(id.slot))
    }

    /// A body, asleep or awake.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn state(&self, id: BodyId) -> Result<State, EngineError> {
        let record = self.bodies.get(id)?;
        Ok(
            if record.line == LineIx::NONE || record.kind == BodyKind::Fixed {
                State {
                    id,
                    tag: record.tag,
                    kind: record.kind,
                    pose: record.pose,
                    turned: record.turned,
                    velocity: (Vec2::ZERO, 0.0),
                    before: (Vec2::ZERO, 0.0),
                    lack: None,
                }
            } else {
                self.state_at(record.line)
            },
        )
    }

    /// All bodies that are awake and not fixed, in no order that means anything.
    pub fn awake(&self) -> impl Iterator<Item = State> + '_ {
        self.bodies.awake().map(|line| self.state_at(line))
    }

    /// Those of [`Self::awake`] that have no contact, pushing or not.
    pub fn without_contact(&self) -> impl Iterator<Item = State> + '_ {
        let bodies = &self.bodies;
        let contacts = |at: LineIx| bodies.records[bodies.slot_of[at]].contacts;
        bodies
            .awake()
            .filter(move |at| contacts(*at) == Entry::NONE)
            .map(|at| self.state_at(at))
    }

    fn state_at(&self, at: LineIx) -> State {
        let bodies = &self.bodies;
        let slot = bodies.slot_of[at];
        let record = &bodies.records[slot];
        let line = &bodies.lines[at];
        let velocity = (line.v() + Vec2::ZERO, line.w() + 0.0);
        let before = self.ways.came(slot);
        let before = before.unwrap_or_else(|| bodies.velocity_before(at, self.law.h));
        State {
            id: bodies.id(slot),
            tag: record.tag,
            kind: record.kind,
            pose: bodies.pose_at(at),
            turned: bodies.turned_at(at),
            velocity,
            before,
            lack: self.ways.lack(slot),
        }
    }

    /// How many contacts of bodies that are awake there are, wide ones too.
    #[must_use]
    pub fn awake_contact_count(&self) -> usize {
        self.graph.awake_len()
    }

    /// How many bodies contacts move that are awake.
    #[must_use]
    pub fn awake_count(&self) -> usize {
        let lines = self.bodies.lines[2..].iter();
        lines.filter(|line| line.inverse_mass() > 0.0).count()
    }

    /// How often a body was stopped because a number of its was no longer finite, at the end of a tick: where it last was, without contacts.
    #[must_use]
    pub const fn stopped_count(&self) -> u64 {
        self.stopped
    }

    /// What friction has turned to heat so far, in J, to first order in the sub-step.
    #[must_use]
    pub const fn friction_heat(&self) -> f64 {
        self.heat
    }

    /// What impacts that ended have taken so far beside [`Self::friction_heat`], in J, to first order in the sub-step: of those that
    /// are noted ([`Self::note_impacts`]), impulse × mean of the speeds before and after each sub-step.
    #[must_use]
    pub const fn impact_losses(&self) -> f64 {
        self.impacts.lost
    }

    /// What belts have given so far, to bodies and as heat, in J.
    #[must_use]
    pub const fn belt_work(&self) -> f64 {
        self.belts
    }

    /// How deep the deepest contact overlapped in the last sub-step, as it began or ended, in m; 0 if none did.
    #[must_use]
    pub fn deepest_overlap(&self) -> f64 {
        (-self.least_gap.min(self.least_found)).max(0.0)
    }

    /// Pairs of pieces that were looked at by shape so far.
    #[must_use]
    pub const fn looks(&self) -> u64 {
        self.looks
    }

    /// Calls `found` with the tag of each piece that may be in `bounds` until the next sub-step, perhaps more than once.
    pub fn query(&self, bounds: Aabb, mut found: impl FnMut(u64)) {
        let tag = |piece: PieceIx| self.pieces.list[piece].tag;
        // Boxes are those of the last tick's begin: a blow in the last sub-step may lead out of them, and push-outs since then.
        let since = if self.is_at_tick() {
            self.settings.tick
        } else {
            self.settings.tick - self.left()
        };
        let pushed = self.law.push_out * since;
        let bounds = bounds.grown(self.bodies.beyond_boxes + pushed);
        self.broad.pieces_in(&self.pieces, bounds, |piece| {
            found(tag(piece));
        });
    }

    /// Many queries follow: after many changes, and sub-steps in which many bodies woke, each would look at all of these.
    pub fn prepare_queries(&mut self) {
        self.broad
            .prepare_queries(&self.bodies, &self.pieces, self.settings.tick);
    }

    /// [`Self::query`] of those alone that are awake and not fixed.
    pub fn query_awake(&self, bounds: Aabb, mut found: impl FnMut(u64)) {
        let tag = |piece: PieceIx| self.pieces.list[piece].tag;
        self.broad
            .movers_in(&self.pieces, bounds, |piece| found(tag(piece)));
    }

    /// Calls `found` with the tag and the box of each awake piece of a body that is not fixed: where it is until the tick ends, unless
    /// it goes otherwise than was foreseen. Only after [`Self::prepare_queries`].
    pub fn movers(&self, mut found: impl FnMut(u64, Aabb)) {
        let movers = self.broad.movers(&self.bodies, &self.pieces);
        movers.for_each(|(piece, bounds)| found(self.pieces.list[piece].tag, bounds));
    }

    /// Calls `found` with the tag and the box of each awake piece that came, or goes otherwise than was foreseen, since contacts were
    /// last found at the begin of a tick, or since [`Self::forget_news`]. Only after [`Self::prepare_queries`].
    pub fn news(&self, mut found: impl FnMut(u64, Aabb)) {
        for (piece, bounds) in self.broad.news(&self.pieces) {
            found(self.pieces.list[piece].tag, bounds);
        }
    }

    /// See [`Self::news`].
    pub fn forget_news(&mut self) {
        self.broad.news.clear();
    }

    /// Names of all bodies, by slot.
    pub fn bodies(&self) -> impl Iterator<Item = BodyId> + '_ {
        let live = (0..).map(BodyIx).zip(&self.bodies.records);
        live.filter(|(_, record)| record.live)
            .map(|(slot, _)| self.bodies.id(slot))
    }

    /// All contacts, wide ones too, in no order that means anything.
    pub fn contacts(&self) -> impl Iterator<Item = Contact> + '_ {
        self.graph.ids().map(|id| self.contact(id))
    }

    /// How many contacts there are, wide ones too.
    #[must_use]
    pub fn contact_count(&self) -> usize {
        self.graph.len()
    }

    /// The contacts of a body, the newest first.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn contacts_of(
        &self,
        id: BodyId,
    ) -> Result<impl Iterator<Item = Contact> + '_, EngineError> {
        self.bodies.get(id)?;
        let ids = self.graph.of_body(&self.bodies, id.slot);
        Ok(ids.map(|(id, _)| self.contact(id)))
    }

    /// Work of a body on all that it touches in the last sub-step, in J: by the velocity that it has, as kinematic bodies keep theirs.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn work_of(&self, id: BodyId) -> Result<f64, EngineError> {
        self.bodies.get(id)?;
        let (still, own) = ((Vec2::ZERO, 0.0), self.bodies.velocity_of(id.slot));
        if own == still {
            return Ok(0.0);
        }
        let of_contact = |(id, side): (ContactIx, usize)| {
            let (block, _, lane) = self.graph.lane(id);
            let [a, b] = if side == 0 {
                [own, still]
            } else {
                [still, own]
            };
            let [first, second] = block.along(lane, a, b);
            let [j1, j2, jt] = block.impulses(lane);
            j1 * first + j2 * second + jt * block.across(lane, a, b)
        };
        let contacts = self.graph.of_body(&self.bodies, id.slot);
        Ok(-contacts.map(of_contact).sum::<f64>())
    }

    /// Kinetic energy of all dynamic bodies and their potential energy in uniform gravity, in J.
    #[must_use]
    pub fn energy(&self) -> (f64, f64) {
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for (slot, record) in (0..).map(BodyIx).zip(&self.bodies.records) {
            if record.live && record.kind == BodyKind::Dynamic {
                let (v, w) = self.bodies.velocity_of(slot);
                let turns = if w == 0.0 {
                    0.0
                } else {
                    record.inertia * w * w
                };
                kinetic += 0.5 * (record.mass * v.length_squared() + turns);
                let at = self.bodies.pose_of(slot).position;
                potential -= record.mass * record.gravity_scale * self.settings.gravity.dot(at);
            }
        }
        (kinetic, potential)
    }

    fn contact(&self, id: ContactIx) -> Contact {
        let contact = &self.graph.contacts[id];
        let (block, _, lane) = self.graph.lane(id);
        let [j1, j2, friction] = block.impulses(lane);
        Contact {
            bodies: contact.bodies.map(|slot| self.bodies.id(slot)),
            pieces: contact.pieces.map(|piece| self.pieces.list[piece].ordinal),
            tags: self.pieces.tags(contact.pieces),
            touching: self.graph.is_touching(id),
            places: self.graph.places(&self.bodies, id),
            normal: block.normal(lane),
            points: block.points(lane),
            gaps: self.graph.gaps(&self.bodies, id),
            impulses: [j1, j2],
            friction,
        }
    }
}
