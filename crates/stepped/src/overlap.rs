//! Overlaps of what goes far in a sub-step.

use crate::Engine;
use crate::narrow::collide_any;
use crate::rows::OPEN;

impl Engine {
    /// Rows know gaps to first order in how their bodies turn, and as if faces had no ends. Of bodies that go or turn as far as fast
    /// ones do gaps are those of their pieces instead, where continuous collision left them.
    pub(crate) fn measure_far(&mut self) {
        let Self {
            bodies,
            pieces,
            graph,
            far,
            ..
        } = self;
        let is_far = |slot: u32| {
            let line = bodies.records[slot as usize].line;
            far.binary_search_by_key(&line, |(line, _)| *line).is_ok()
        };
        let in_touch = |(line, _): &_| {
            let slot = bodies.slot_of[*line as usize];
            graph.of_body(bodies, slot).next().is_some()
        };
        if self.least_gap >= 0.0 || !far.iter().any(in_touch) {
            return;
        }
        let gap = |id: u32| {
            let contact = &graph.contacts[id as usize];
            if !contact.bodies.into_iter().any(is_far) {
                let [first, second] = graph.gaps(bodies, id);
                return first.min(second);
            }
            let [a, b] = contact.pieces.map(|number| {
                let piece = &pieces.list[number as usize];
                (piece, bodies.pose_of(piece.body))
            });
            collide_any(a, b, 0.0).map_or(OPEN, |manifold| manifold.gap())
        };
        self.least_gap = graph.awake_ids().map(gap).fold(OPEN, f64::min);
    }
}
