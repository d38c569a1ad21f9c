//! What enters and leaves between ticks.

use carom_math::Pose;

use crate::bodies::number;
use crate::groups::reached;
use crate::pieces::{Disc, Piece};
use crate::{
    BodyId, BodyInput, BodyIx, BodyKind, Engine, EngineError, LineIx, PieceInput, PieceIx,
};

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
            list.extend(Piece::of(piece, id.slot, number(list.len())));
        }
        let reach = list.iter().map(|piece| piece.reach).fold(0.0, f64::max);
        let extent = list.iter().map(|piece| piece.extent);
        let extent = extent.fold(f64::INFINITY, f64::min);
        let count = number(list.len());
        let first = self.pieces.insert(list);
        let record = &mut self.bodies.records[id.slot];
        (record.first_piece, record.count, record.reach) = (first, count, reach);
        if body.kind == BodyKind::Fixed {
            for number in first.run(count) {
                self.stand(number, body.pose);
            }
            self.wake_overlapped(id.slot);
        } else {
            let limit = &mut self.bodies.limits[record.line];
            limit.reach = reach;
            limit.tolerance = self.settings.tolerance * extent;
            limit.extent = extent;
            for number in first.run(count) {
                self.broad.enter(number);
            }
        }
        Ok(id)
    }

    /// A piece stands where the pose puts it.
    pub(crate) fn stand(&mut self, number: PieceIx, pose: Pose) {
        let tight = self.pieces.pose(number, pose);
        let piece = &self.pieces.list[number];
        let slack = 0.5 * self.settings.margin * piece.extent;
        let bounds = if tight.is_finite() {
            tight.grown(slack)
        } else {
            tight
        };
        self.pieces.boxes[number] = bounds;
        self.pieces.discs[number] = Disc::endless(slack);
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
        self.impacts.forget(id.slot);
        for number in record.pieces() {
            self.broad.leave(number);
        }
        self.pieces.remove(record.first_piece, record.count);
        if record.kind != BodyKind::Fixed
            && let Some(moved) = self.bodies.take_line(id.slot)
        {
            self.graph.renumber(&self.bodies, moved);
        }
        self.bodies.remove(id.slot);
        Ok(())
    }

    /// Says that a caller moves bodies, or takes them out, once this part of a sub-step has passed. They go on as they are seen there, and
    /// all that contacts connect with them goes on as it is seen, too: what contacts did in the sub-step has not happened yet, and no
    /// momentum or energy comes of half of it. Free bodies lose what their velocities lack ([`State::lack`](crate::State::lack)). Gives
    /// those of the connected ones that something pulls: how they are seen is the caller's to know.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if one is not in this engine.
    pub fn leave_ways(&mut self, ids: &[BodyId], passed: f64) -> Result<Vec<BodyId>, EngineError> {
        for id in ids {
            self.bodies.get(*id)?;
        }
        let slots: Vec<BodyIx> = ids.iter().map(|id| id.slot).collect();
        let others = self.connected(&slots);
        self.ways.leave(&mut self.bodies, (&slots, &others), passed);
        let pulled = others.into_iter().filter(|other| !self.ways.knows(*other));
        Ok(pulled.map(|slot| self.bodies.id(slot)).collect())
    }

    /// The bodies that contacts connect with some, and move, also by what continuous collision did.
    fn connected(&self, slots: &[BodyIx]) -> Vec<BodyIx> {
        let moves = |other: &BodyIx| {
            let is_awake = self.bodies.records[*other].line != LineIx::NONE;
            is_awake && self.bodies.is_dynamic(*other)
        };
        let mut seen = vec![false; self.bodies.records.len()];
        let mut found = reached(slots, &mut seen, |slot, meet| {
            let others = self.graph.neighbours(&self.bodies, slot);
            others
                .chain(self.ways.met(slot))
                .filter(moves)
                .for_each(meet);
        });
        found.split_off(slots.len())
    }

    pub(crate) fn drop_contacts(&mut self, slot: BodyIx) {
        let contacts: Vec<_> = self.graph.of_body(&self.bodies, slot).collect();
        for (id, _) in contacts {
            self.part(id);
        }
    }
}
