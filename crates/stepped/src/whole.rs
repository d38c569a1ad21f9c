//! Rows of whole shapes: of bodies so deep in a concave one that pieces know no way out.
//!
//! A piece is left through its outline, never across a cut to the next piece; what overlaps it less across a cut than behind its
//! outline is that piece's. Deep in a concave body that may be so of all its pieces, or two of them push against each other. The two
//! bodies then have one row, along the shortest way out of the whole shapes, until these are apart.

use std::collections::BTreeSet;

use carom_math::Vec2;

use crate::PairRules;
use crate::narrow::{Found, Scene};
use crate::rows::{Block, Cold, Graph};
use crate::update::{Fresh, Pair, lanes, place};

/// Cosine of the angle between the row of a piece and the way out of the whole shapes that it leads.
const LEADS: f64 = 0.5;

/// Slots of two bodies each that have a row of whole shapes.
pub(crate) struct WholePairs {
    slots: BTreeSet<[u32; 2]>,
    /// Contacts that got one, and their pieces.
    new: Vec<(u32, [u32; 2])>,
}

impl WholePairs {
    pub(crate) fn of(graph: &mut Graph) -> Self {
        Self {
            slots: graph.retain_whole().collect(),
            new: Vec::new(),
        }
    }

    /// Rows of whole shapes go on as such, and no piece of their bodies has another one; rows of pieces of concave shapes that were put
    /// deeper than a margin become such. A bit for each lane among those that `moved` that has one.
    pub(crate) fn renew(
        &mut self,
        scene: &Scene<'_>,
        (block, cold): (&Block, &mut Cold),
        moved: u8,
        found: &mut Found,
    ) -> u8 {
        let mut whole = moved & cold.whole;
        let asked = if self.slots.is_empty() {
            cold.put()
        } else {
            !0
        };
        for lane in lanes(moved & found.near & asked & !whole) {
            let (pair, bit) = (cold.pieces[lane], 1 << lane);
            let slots = scene.pieces.bodies(pair);
            let [a, b] =
                [block.a[lane], block.b[lane]].map(|line| scene.bodies.lines[line as usize].d());
            if self.slots.contains(&slots) {
                found.near &= !bit;
            } else if cold.was_put(lane)
                && scene.is_entangled(pair, found.gap(lane, b - a))
                && let Some(way) = scene.way_out(pair)
                && !leads(found.rows.normal(lane), way.normal)
            {
                whole |= bit;
                self.slots.insert(slots);
                self.new.push((cold.contact[lane], pair));
            }
        }
        for lane in lanes(whole) {
            let bit = 1 << lane;
            let goes_on = cold.was_put(lane) || cold.whole & bit == 0;
            if goes_on && let Some(manifold) = scene.way_out(cold.pieces[lane]) {
                found.set(lane, &manifold);
                cold.whole |= bit;
            } else {
                found.near &= !bit;
                cold.whole &= !bit;
            }
        }
        // No ghosts: these are rows of no sides.
        found.short &= !whole;
        found.slants &= !whole;
        found.seam &= !whole;
        whole
    }

    /// Notes the contacts that got one.
    pub(crate) fn note(self, graph: &mut Graph) {
        graph.add_whole(&self.new);
    }

    /// Gives bodies that were put into each other one row of their whole shapes instead of all others, if some pieces of theirs, `cut`,
    /// have none though they overlap, or one of a concave shape is deeper than a margin.
    pub(crate) fn add(
        mut self,
        scene: &Scene<'_>,
        rules: &dyn PairRules,
        mut cut: Vec<Pair>,
        fresh: &mut Vec<Fresh>,
    ) {
        let (bodies, pieces) = (scene.bodies, scene.pieces);
        let was_put = |pair: &Pair| {
            let records = pair
                .slots(pieces)
                .map(|slot| &bodies.records[slot as usize]);
            records.iter().any(|record| record.placed == bodies.updates)
        };
        cut.retain(was_put);
        let entangled = fresh.iter().filter(|fresh| {
            was_put(&fresh.pair) && scene.is_entangled(fresh.pair.pieces, fresh.manifold.gap())
        });
        cut.extend(entangled.map(|fresh| fresh.pair));
        cut.retain(|pair| {
            !self.slots.contains(&pair.slots(pieces))
                && pieces.surface(pair.pieces, rules).is_some()
        });
        cut.sort_by_cached_key(|pair| pair.pieces.map(|piece| place(scene.bodies, pieces, piece)));
        cut.dedup_by_key(|pair| pair.slots(pieces));
        let normal = |fresh: &Fresh| (fresh.pair.slots(pieces), fresh.manifold.normal);
        let mut normals: Vec<([u32; 2], Vec2)> = Vec::new();
        if !cut.is_empty() {
            let overlaps = fresh.iter().filter(|fresh| fresh.manifold.gap() < 0.0);
            normals.extend(overlaps.map(normal));
            normals.sort_by_key(|(slots, _)| *slots);
        }
        let way_out = |pair: Pair| {
            let (slots, manifold) = (pair.slots(pieces), scene.way_out(pair.pieces)?);
            let first = normals.partition_point(|(other, _)| *other < slots);
            let of_bodies = normals[first..]
                .iter()
                .take_while(|(other, _)| *other == slots);
            let mut known = of_bodies.map(|(_, normal)| *normal).peekable();
            let is_known =
                known.peek().is_some() && known.all(|normal| leads(normal, manifold.normal));
            (!is_known).then_some(Fresh {
                pair,
                manifold,
                face: None,
                is_whole: true,
            })
        };
        let new: Vec<Fresh> = cut.into_iter().filter_map(way_out).collect();
        self.slots
            .extend(new.iter().map(|fresh| fresh.pair.slots(pieces)));
        fresh.retain(|fresh| !self.slots.contains(&fresh.pair.slots(pieces)));
        fresh.extend(new);
    }
}

/// Whether the row of a piece pushes along the way out of the whole shapes.
fn leads(normal: Vec2, way: Vec2) -> bool {
    normal.dot(way) > LEADS
}
