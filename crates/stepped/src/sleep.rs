//! Islands, and their sleep.
//!
//! An island is what hangs together by contacts that push or overlap, through dynamic bodies. Islands are found when some
//! body has rested long enough, from its contacts alone. One that sleeps has no lines, and its contacts lie apart with
//! all their fields; waking puts both back as they were.

use carom_math::Vec2;

use crate::bodies::{Bodies, Sleeper};
use crate::groups::reached;
use crate::update::nearness;
use crate::{BodyId, BodyIx, BodyKind, ContactIx, Engine, EngineError, IslandIx};

/// Ticks between two searches for islands at rest. Fewer: an island that rests but for one body is walked for nothing;
/// more: islands fall asleep later by as much.
const SEARCH: u64 = 8;

/// What was inserted asleep touches what is nearer than this part of a margin.
const TOUCHES: f64 = 0.1;

/// A fixed body that is put deeper into sleepers than this part of a margin wakes them.
const DISTURBS: f64 = 0.02;

/// Islands asleep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Islands {
    asleep: Vec<Option<Vec<Sleeper>>>,
    free: Vec<IslandIx>,
    ticks: u64,
    /// How many of them were inserted asleep: they have met nothing yet.
    unmet: usize,
    /// Slots of bodies that fell asleep or woke since a caller asked.
    changed: Vec<BodyIx>,
    /// Scratch of [`Engine::sleep`], by slot: false.
    seen: Vec<bool>,
}

impl Islands {
    pub(crate) const fn any_asleep(&self) -> bool {
        self.asleep.len() > self.free.len()
    }

    /// What a sleeper goes on with once it wakes; `None` if it is awake.
    pub(crate) fn sleeper_mut(&mut self, island: IslandIx, slot: BodyIx) -> Option<&mut Sleeper> {
        let sleepers = self.asleep.get_mut(island.at());
        let mut sleepers = sleepers.into_iter().flatten().flatten();
        sleepers.find(|sleeper| sleeper.slot == slot)
    }
}

impl Engine {
    /// Counts how long bodies rest, and puts islands to sleep.
    pub(crate) fn settle(&mut self) {
        let Some(sleep) = self.settings.sleep else {
            return;
        };
        self.islands.ticks += 1;
        let Bodies {
            lines,
            limits,
            rest,
            ..
        } = &mut self.bodies;
        let mut longest = 0.0f64;
        for ((line, limit), rest) in lines.iter().zip(limits).zip(rest).skip(2) {
            let v = line.v();
            let speed = v.x.abs().max(v.y.abs()) + line.w().abs() * limit.reach;
            let rests = speed <= sleep.least(limit.extent) && line.inverse_mass() > 0.0;
            *rest = if rests {
                *rest + self.settings.tick
            } else {
                // −∞ stays.
                rest.min(0.0)
            };
            longest = longest.max(*rest);
        }
        // For this tick at least: what moves has rested for 0 s.
        let after = sleep.after.max(self.settings.tick);
        if longest >= after && self.islands.ticks.is_multiple_of(SEARCH) {
            for island in self.islands_at_rest(after) {
                self.lay(&island);
            }
        }
    }

    /// Islands of which all bodies have rested for so long, in s.
    fn islands_at_rest(&self, after: f64) -> Vec<Vec<BodyIx>> {
        let mut seen = vec![false; self.bodies.records.len()];
        let mut found = Vec::new();
        for line in 2..self.bodies.lines.len() {
            let slot = self.bodies.slot_of[line];
            if self.bodies.rest[line] >= after && !seen[slot.at()] {
                let (mut island, rests) = self.island(slot, after, &mut seen);
                if rests {
                    // Lines depend on other islands, and contacts of the overflow colour wake in this order.
                    island.sort_unstable_by_key(|slot| self.bodies.records[*slot].birth);
                    found.push(island);
                }
            }
        }
        found
    }

    /// The island of a body that is awake, and whether all of it has rested for so long and nothing that moves touches it. What drifts
    /// in space is not at rest, however slow: it would lose its momentum.
    fn island(&self, slot: BodyIx, after: f64, seen: &mut [bool]) -> (Vec<BodyIx>, bool) {
        let (mut rests, mut supported) = (true, false);
        let island = reached(&[slot], seen, |slot, meet| {
            rests &= self.bodies.rest[self.bodies.line_of(slot)] >= after;
            supported |= self.rests_unsupported(slot);
            for (id, side) in self.graph.of_body(&self.bodies, slot) {
                let other = self.graph.contacts[id].bodies[1 - side];
                if !self.hold_together(id) {
                    continue;
                }
                if self.bodies.is_dynamic(other) {
                    meet(other);
                } else {
                    let (v, w) = self.bodies.velocity_of(other);
                    rests &= v == Vec2::ZERO && w.abs() <= 0.0;
                    supported = true;
                }
            }
        });
        (island, rests && supported)
    }

    /// Whether a body may rest in space: it does not move at all, or damping stops it.
    fn rests_unsupported(&self, slot: BodyIx) -> bool {
        let (v, w) = self.bodies.velocity_of(slot);
        let record = &self.bodies.records[slot];
        v == Vec2::ZERO && w.abs() <= 0.0 || record.damping.into_iter().any(|rate| rate > 0.0)
    }

    /// Whether the bodies of a contact hang together: it pushes or overlaps.
    fn hold_together(&self, id: ContactIx) -> bool {
        let (block, _, lane) = self.graph.lane(id);
        let gaps = block.gaps(lane, &self.bodies.lines);
        block.j1[lane] + block.j2[lane] > 0.0 || gaps[0].min(gaps[1]) <= 0.0
    }

    /// Puts an island to sleep.
    fn lay(&mut self, island: &[BodyIx]) {
        let number = self.islands.free.pop().unwrap_or_else(|| {
            self.islands.asleep.push(None);
            IslandIx::new(self.islands.asleep.len() - 1)
        });
        for &slot in island {
            self.bodies.records[slot].island = number;
        }
        self.islands.changed.extend(island);
        // A caller may not ask for a long time.
        if self.islands.changed.len() > 2 * self.bodies.records.len() + 64 {
            self.islands.changed.sort_unstable();
            self.islands.changed.dedup();
        }
        for &slot in island {
            let ids: Vec<_> = self.graph.of_body(&self.bodies, slot).collect();
            for (id, side) in ids {
                let contact = self.graph.contacts[id];
                let other = &self.bodies.records[contact.bodies[1 - side]];
                if other.kind == BodyKind::Dynamic && other.island != number {
                    // Near, and no part of the island: found again when one of both moves, or wakes.
                    self.part(id);
                } else if !contact.sleeps() {
                    self.graph.shift(&mut self.bodies, id, true);
                }
            }
        }
        let mut sleepers = Vec::with_capacity(island.len());
        for &slot in island {
            let (sleeper, moved) = self.bodies.lay(slot);
            sleepers.push(sleeper);
            if let Some(moved) = moved {
                self.graph.renumber(&self.bodies, moved);
            }
            // Others meet it where it lies: it has no line to tell how far that is from its base pose.
            let record = &self.bodies.records[slot];
            for piece in record.pieces() {
                self.pieces.pose(piece, record.pose);
                self.broad.stand(piece, self.pieces.boxes[piece]);
            }
        }
        self.islands.unmet += usize::from(sleepers.iter().any(Sleeper::is_unmet));
        self.islands.asleep[number] = Some(sleepers);
    }

    /// Wakes these islands, and what was inserted asleep in touch with such bodies.
    pub(crate) fn wake_all(&mut self, islands: &[IslandIx]) {
        let mut waking = islands.to_vec();
        while let Some(number) = waking.pop() {
            let Some(sleepers) = self.islands.asleep[number].take() else {
                continue;
            };
            self.islands.free.push(number);
            if sleepers.iter().any(Sleeper::is_unmet) {
                self.islands.unmet -= 1;
                for sleeper in &sleepers {
                    waking.extend(self.unmet_at(sleeper.slot));
                }
            }
            self.raise(&sleepers);
        }
    }

    /// Gives the bodies of an island their lines and contacts again.
    fn raise(&mut self, sleepers: &[Sleeper]) {
        for sleeper in sleepers {
            self.bodies.raise(sleeper, &self.settings);
            self.islands.changed.push(sleeper.slot);
            let record = &mut self.bodies.records[sleeper.slot];
            record.island = IslandIx::NONE;
            for piece in record.pieces() {
                self.pieces.pose(piece, sleeper.base);
                self.broad.wake(piece);
            }
        }
        for sleeper in sleepers {
            let ids: Vec<_> = self.graph.of_body(&self.bodies, sleeper.slot).collect();
            for (id, _) in ids {
                if self.graph.contacts[id].sleeps() {
                    self.graph.shift(&mut self.bodies, id, false);
                }
            }
        }
    }

    /// Islands asleep that a body that stands is nearer to than `margins`.
    fn sleepers_at(&self, slot: BodyIx, margins: f64) -> Vec<IslandIx> {
        let record = &self.bodies.records[slot];
        let mut found = Vec::new();
        for piece in record.pieces() {
            let bounds = self.pieces.boxes[piece];
            self.broad.standing_in(bounds, |other| {
                let theirs = self.pieces.list[other].body;
                let island = self.bodies.records[theirs].island;
                if island != IslandIx::NONE
                    && theirs != slot
                    && nearness(&self.scene(), [piece, other]).is_some_and(|gap| gap <= margins)
                {
                    found.push(island);
                }
            });
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Those of them within `TOUCHES` that were inserted asleep.
    fn unmet_at(&self, slot: BodyIx) -> Vec<IslandIx> {
        if self.islands.unmet == 0 {
            return Vec::new();
        }
        let mut found = self.sleepers_at(slot, TOUCHES);
        found.retain(|island| {
            let sleepers = self.islands.asleep[*island].as_ref();
            sleepers.is_some_and(|sleepers| sleepers.iter().any(Sleeper::is_unmet))
        });
        found
    }

    /// Wakes what a fixed body was put into; what sleeps beside it sleeps on.
    pub(crate) fn wake_overlapped(&mut self, slot: BodyIx) {
        if self.islands.any_asleep() {
            let islands = self.sleepers_at(slot, -DISTURBS);
            self.wake_all(&islands);
        }
    }

    pub(crate) fn wake_every(&mut self) {
        let all = (0..self.islands.asleep.len()).map(IslandIx::new);
        self.wake_all(&all.collect::<Vec<_>>());
    }

    /// Wakes the island of a body, and all islands that touch it.
    pub(crate) fn wake_around(&mut self, slot: BodyIx) {
        let mut islands = vec![self.bodies.records[slot].island];
        for (id, side) in self.graph.of_body(&self.bodies, slot) {
            let contact = &self.graph.contacts[id];
            if contact.sleeps() {
                islands.push(self.bodies.records[contact.bodies[1 - side]].island);
            }
        }
        islands.extend(self.unmet_at(slot));
        islands.retain(|island| *island != IslandIx::NONE);
        islands.dedup();
        self.wake_all(&islands);
    }

    /// Wakes a body with its island.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn wake(&mut self, id: BodyId) -> Result<(), EngineError> {
        self.bodies.get(id)?;
        self.wake_around(id.slot);
        Ok(())
    }

    /// Puts the island of a body to sleep, whatever its speed and even if it may not fall asleep by itself: it is at rest from then
    /// on. A fixed or kinematic body does not sleep.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn sleep(&mut self, id: BodyId) -> Result<(), EngineError> {
        let record = *self.bodies.get(id)?;
        if record.kind == BodyKind::Dynamic && record.island == IslandIx::NONE {
            let mut seen = core::mem::take(&mut self.islands.seen);
            seen.resize(self.bodies.records.len(), false);
            let (island, _) = self.island(id.slot, 0.0, &mut seen);
            for &slot in &island {
                seen[slot.at()] = false;
                let line = self.bodies.line_of(slot);
                if self.bodies.moved[line] {
                    self.pose_pieces(line);
                }
            }
            self.islands.seen = seen;
            self.lay(&island);
        }
        Ok(())
    }

    /// Calls `tell` for each body that fell asleep (`true`) or woke since this was last called, by slot.
    pub fn sleep_changes(&mut self, mut tell: impl FnMut(BodyId, bool)) {
        let mut changed = core::mem::take(&mut self.islands.changed);
        changed.sort_unstable();
        changed.dedup();
        for &slot in &changed {
            let record = &self.bodies.records[slot];
            if record.live {
                tell(self.bodies.id(slot), record.island != IslandIx::NONE);
            }
        }
        changed.clear();
        self.islands.changed = changed;
    }

    /// Whether a body sleeps: nothing is computed for it until something meets its island.
    ///
    /// # Errors
    /// [`EngineError::Stale`] if it is not in this engine.
    pub fn is_asleep(&self, id: BodyId) -> Result<bool, EngineError> {
        Ok(self.bodies.get(id)?.island != IslandIx::NONE)
    }
}
