//! What enters and leaves between ticks.

use carom_math::{Pose, Vec2};

use crate::error::finite;
use crate::pieces::{Disc, Piece};
use crate::{BodyId, BodyInput, BodyKind, Engine, EngineError, PieceInput};

impl Engine {
    /// Adds a body made of these pieces.
    ///
    /// # Errors
    /// [`EngineError::Value`] if a number is out of its range, [`EngineError::Unbounded`] if a body that moves has a half-plane.
    pub fn insert(
        &mut self,
        body: BodyInput,
        pieces: &[PieceInput],
    ) -> Result<BodyId, EngineError> {
        body.check()?;
        for (k, piece) in pieces.iter().enumerate() {
            piece.check()?;
            if body.kind != BodyKind::Fixed && !piece.shape.is_bounded() {
                return Err(EngineError::Unbounded { piece: k });
            }
        }
        let id = self.bodies.insert(&body, &self.settings);
        let mut list = Vec::new();
        for piece in pieces {
            #[expect(clippy::cast_possible_truncation, reason = "hundreds of bytes each")]
            let first = list.len() as u32;
            list.extend(Piece::of(piece, id.slot, first));
        }
        let reach = list.iter().map(|piece| piece.reach).fold(0.0, f64::max);
        let extent = list.iter().map(|piece| piece.extent);
        let extent = extent.fold(f64::INFINITY, f64::min);
        #[expect(clippy::cast_possible_truncation, reason = "hundreds of bytes each")]
        let count = list.len() as u32;
        let first = self.pieces.insert(list);
        let record = &mut self.bodies.records[id.slot as usize];
        (record.first_piece, record.pieces, record.reach) = (first, count, reach);
        if body.kind == BodyKind::Fixed {
            for number in first..first + count {
                self.stand(number, body.pose);
            }
        } else {
            let limit = &mut self.bodies.limits[record.line as usize];
            limit.reach = reach;
            limit.tolerance = self.settings.tolerance * extent;
            limit.extent = extent;
        }
        Ok(id)
    }

    /// A piece stands where the pose puts it.
    fn stand(&mut self, number: u32, pose: Pose) {
        let tight = self.pieces.pose(number, pose);
        let piece = &self.pieces.list[number as usize];
        let slack = 0.5 * self.settings.margin * piece.extent;
        let bounds = if tight.is_finite() {
            tight.grown(slack)
        } else {
            tight
        };
        self.pieces.boxes[number as usize] = bounds;
        self.pieces.discs[number as usize] = Disc::ENDLESS;
        self.broad.stand(number, bounds);
    }

    /// Takes a body out, with its contacts; what lay on it falls from the next tick on.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn remove(&mut self, id: BodyId) -> Result<(), EngineError> {
        self.wake(id)?;
        let record = *self.bodies.get(id)?;
        self.drop_contacts(id.slot);
        for number in record.first_piece..record.first_piece + record.pieces {
            self.broad.leave(number);
        }
        self.pieces.remove(record.first_piece, record.pieces);
        if record.kind != BodyKind::Fixed
            && let Some(moved) = self.bodies.take_line(id.slot)
        {
            self.graph.renumber(&self.bodies, moved);
        }
        self.bodies.remove(id.slot);
        Ok(())
    }

    fn drop_contacts(&mut self, slot: u32) {
        let ids: Vec<u32> = self
            .graph
            .of_body(&self.bodies, slot)
            .map(|(id, _)| id)
            .collect();
        for id in ids {
            self.known.remove(self.graph.contacts[id as usize].pieces);
            self.graph.remove(&mut self.bodies, id);
        }
    }

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
            let at = record.line as usize;
            let (line, start) = (&mut self.bodies.lines[at], &mut self.bodies.start[at]);
            // What contacts do in a sub-step does not change by it: both change by the same amount.
            let (v, w) = (line.v(), line.w());
            let change = crate::rows::Quad::new(velocity - v, spin - w);
            start.add(&change);
            line.set_velocity(velocity, spin);
        }
        Ok(())
    }

    /// Puts a body elsewhere, without its contacts.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine, [`EngineError::Value`] if a number is not finite.
    pub fn set_pose(&mut self, id: BodyId, pose: Pose) -> Result<(), EngineError> {
        self.bodies.get(id)?;
        finite("pose.position.x", pose.position.x)?;
        finite("pose.position.y", pose.position.y)?;
        self.wake_around(id.slot);
        let record = *self.bodies.get(id)?;
        self.drop_contacts(id.slot);
        if record.kind == BodyKind::Fixed {
            self.bodies.records[id.slot as usize].pose = pose;
            for number in record.first_piece..record.first_piece + record.pieces {
                self.broad.leave(number);
                self.stand(number, pose);
            }
        } else {
            let at = record.line as usize;
            self.bodies.base[at] = pose;
            self.bodies.lines[at].clear_displacement();
            self.bodies.moved[at] = true;
        }
        Ok(())
    }
}
