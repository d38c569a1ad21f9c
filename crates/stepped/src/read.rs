//! What a caller reads between ticks.

use carom_math::{Pose, Vec2};

use crate::{BodyId, BodyKind, Engine, EngineError, Settings};

/// A contact of two pieces, as the last sub-step left it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// A and B: A was inserted first.
    pub bodies: [BodyId; 2],
    /// Index of each one's convex piece.
    pub pieces: [u32; 2],
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
    /// What it was made with.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
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

    /// Names of all bodies, by slot.
    pub fn bodies(&self) -> impl Iterator<Item = BodyId> + '_ {
        let live = self.bodies.records.iter().zip(0u32..);
        live.filter(|(record, _)| record.live)
            .map(|(_, slot)| self.bodies.id(slot))
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

    /// Kinetic energy of all dynamic bodies and their potential energy in uniform gravity, in J.
    #[must_use]
    pub fn energy(&self) -> (f64, f64) {
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for (record, slot) in self.bodies.records.iter().zip(0u32..) {
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

    fn contact(&self, id: u32) -> Contact {
        let contact = &self.graph.contacts[id as usize];
        let (block, _, lane) = self.graph.lane(id);
        let [a, b] = [block.a[lane], block.b[lane]].map(|line| &self.bodies.lines[line as usize]);
        let [j1, j2, friction] = block.impulses(lane);
        Contact {
            bodies: contact.bodies.map(|slot| self.bodies.id(slot)),
            pieces: contact
                .pieces
                .map(|piece| self.pieces.list[piece as usize].ordinal),
            normal: Vec2::new(block.nx[lane], block.ny[lane]),
            points: if block.s2[lane] < crate::rows::OPEN {
                2
            } else {
                1
            },
            gaps: block.gaps(lane, a, b),
            impulses: [j1, j2],
            friction,
        }
    }
}
