//! What a caller changes of bodies that are there.

use carom_math::{Pose, Vec2};

use crate::error::{finite, finite_pose};
use crate::rows::{Law, Quad};
use crate::{
    BodyId, BodyKind, Engine, EngineError, Entry, LineIx, PairRules, Settings, Sleep, Softness,
};

/// Numbers of a pose, as errors name them.
const POSE: [&str; 4] = [
    "pose.position.x",
    "pose.position.y",
    "pose.rotation.cos",
    "pose.rotation.sin",
];

impl Engine {
    /// Sets the velocity of the centre of mass, in m/s, and the spin, in rad/s; a fixed body stays at rest.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine, [`EngineError::Value`] if a number is not finite.
    pub fn set_velocity(
        &mut self,
        id: BodyId,
        velocity: Vec2,
        spin: f64,
    ) -> Result<(), EngineError> {
        self.bodies.get(id)?;
        finite("velocity.x", velocity.x)?;
        finite("velocity.y", velocity.y)?;
        finite("spin", spin)?;
        self.wake_around(id.slot);
        let record = *self.bodies.get(id)?;
        if record.kind != BodyKind::Fixed {
            let at = record.line;
            let (line, start) = (&mut self.bodies.lines[at], &mut self.bodies.start[at]);
            // What contacts do in a sub-step does not change by it: both change by the same amount.
            let (v, w) = (line.v(), line.w());
            let change = Quad::new(velocity - v, spin - w);
            start.add(&change);
            line.set_velocity(velocity, spin);
            if record.contacts == Entry::NONE {
                // Free flight has no leftovers of rounding.
                start.0[..3].copy_from_slice(&[velocity.x, velocity.y, spin]);
            }
            self.bodies.note_change(record.line);
        }
        Ok(())
    }

    /// Puts a body elsewhere, without its contacts.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine, [`EngineError::Value`] if a number is not finite.
    pub fn set_pose(&mut self, id: BodyId, pose: Pose) -> Result<(), EngineError> {
        self.bodies.get(id)?;
        finite_pose(POSE, pose)?;
        self.wake_around(id.slot);
        let record = *self.bodies.get(id)?;
        self.drop_contacts(id.slot);
        self.bodies.records[id.slot].placed = self.bodies.updates;
        if record.kind == BodyKind::Fixed {
            self.bodies.records[id.slot].pose = pose;
            for number in record.pieces() {
                self.broad.leave(number);
                self.stand(number, pose);
            }
            self.wake_overlapped(id.slot);
        } else {
            let at = record.line;
            self.bodies.base[at] = pose;
            self.bodies.lines[at].clear_displacement();
            (self.bodies.moved[at], self.bodies.may_deviate) = (true, true);
        }
        Ok(())
    }

    /// Puts a body a little way off, with its contacts: they are computed anew with the next tick.
    ///
    /// # Errors
    /// As [`Self::set_pose`].
    pub fn shift(&mut self, id: BodyId, pose: Pose) -> Result<(), EngineError> {
        let record = *self.bodies.get(id)?;
        if record.line == LineIx::NONE || record.kind == BodyKind::Fixed {
            return self.set_pose(id, pose);
        }
        finite_pose(POSE, pose)?;
        let at = record.line;
        let base = self.bodies.base[at];
        let turn = (pose.rotation * base.rotation.inverse()).angle();
        self.bodies.lines[at].set_displacement(pose.position - base.position, turn);
        self.bodies.may_deviate = true;
        Ok(())
    }

    /// Sets the angle by which a body has turned so far, in rad, whole turns included: it only counts.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine, [`EngineError::Value`] if the angle is not finite.
    pub fn set_turned(&mut self, id: BodyId, turned: f64) -> Result<(), EngineError> {
        let record = *self.bodies.get(id)?;
        finite("turned", turned)?;
        if record.line == LineIx::NONE || record.kind == BodyKind::Fixed {
            self.bodies.records[id.slot].turned = turned;
            if let Some(sleeper) = self.islands.sleeper_mut(record.island, id.slot) {
                sleeper.turned = turned - sleeper.line.turn();
            }
        } else {
            let at = record.line;
            self.bodies.turned[at] = turned - self.bodies.lines[at].turn();
        }
        Ok(())
    }

    /// Sets what accelerates a dynamic body besides contacts, in m/s² and rad/s²: gravity, fields and forces together.
    ///
    /// A body that sleeps sleeps on, and is pulled so once it wakes.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine, [`EngineError::Value`] if a number is not finite.
    pub fn set_pull(&mut self, id: BodyId, pull: Vec2, twist: f64) -> Result<(), EngineError> {
        let record = *self.bodies.get(id)?;
        finite("pull.x", pull.x)?;
        finite("pull.y", pull.y)?;
        finite("twist", twist)?;
        if record.kind == BodyKind::Dynamic {
            let pull = Quad::new(pull, twist);
            if record.line != LineIx::NONE {
                self.bodies.set_pull(record.line, pull);
            } else if let Some(sleeper) = self.islands.sleeper_mut(record.island, id.slot) {
                sleeper.pull = pull;
            }
        }
        Ok(())
    }

    /// Changes gravity, in m/s²: of all dynamic bodies by their scale, whatever their pull was. All that sleeps wakes.
    ///
    /// # Errors
    /// [`EngineError::Value`] if a number is not finite.
    pub fn set_gravity(&mut self, gravity: Vec2) -> Result<(), EngineError> {
        finite("gravity.x", gravity.x)?;
        finite("gravity.y", gravity.y)?;
        self.change_settings(Settings {
            gravity,
            ..self.settings
        })?;
        for at in self.bodies.awake() {
            let record = &self.bodies.records[self.bodies.slot_of[at]];
            let pull = Quad::new(gravity * record.gravity_scale, 0.0);
            self.bodies.set_pull(at, pull);
        }
        Ok(())
    }

    /// Changes the soft law of contacts, from the next sub-step on. All that sleeps wakes.
    ///
    /// # Errors
    /// [`EngineError::Value`] if a number is out of its range.
    pub fn set_softness(&mut self, softness: Softness) -> Result<(), EngineError> {
        self.change_settings(Settings {
            softness,
            ..self.settings
        })
    }

    /// Changes when islands fall asleep; never if `None`. All that sleeps wakes.
    ///
    /// # Errors
    /// [`EngineError::Value`] if a number is out of its range.
    pub fn set_sleep(&mut self, sleep: Option<Sleep>) -> Result<(), EngineError> {
        self.change_settings(Settings {
            sleep,
            ..self.settings
        })
    }

    /// What sleeps came to rest by the old ones.
    fn change_settings(&mut self, settings: Settings) -> Result<(), EngineError> {
        settings.check()?;
        (self.settings, self.law) = (settings, Law::new(&settings));
        self.wake_every();
        Ok(())
    }

    /// Asks anew how the contacts of a body meet, and drops those that no longer do.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine.
    pub fn resurface(&mut self, id: BodyId, rules: &dyn PairRules) -> Result<(), EngineError> {
        self.bodies.get(id)?;
        let contacts: Vec<_> = self.graph.of_body(&self.bodies, id.slot).collect();
        for (contact, _) in contacts {
            let pieces = self.graph.contacts[contact].pieces;
            match self.pieces.surface(pieces, rules) {
                Some(surface) => self.graph.resurface(contact, surface),
                None => self.part(contact),
            }
        }
        Ok(())
    }
}
