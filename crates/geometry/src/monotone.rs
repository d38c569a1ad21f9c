//! A simple ring cut into triangles in O(n log n) whatever it looks like, with exact signs.
//!
//! A line sweeps over the ring from left to right and cuts it where it bends back on itself (D. T.
//! Lee, F. P. Preparata, 1977); what is left is monotone along x and falls apart from left to right
//! (M. R. Garey, D. S. Johnson, F. P. Preparata, R. E. Tarjan, 1978). Its triangles are thinner than
//! those of `ears`, which come first.
//!
//! Points come in the order of x, then y, as if the plane were sheared a little: so vertical edges
//! are no special case.

use carom_math::{Vec2, orient2d};

use crate::ears::{OUTLINE, Triangles};

/// Triangles of a simple counter-clockwise ring without straight corners, or `None` if a predicate
/// underflowed and the sweep lost its way.
pub(crate) fn triangulate(ring: &[Vec2]) -> Option<Triangles> {
    let cuts = Sweep::new(ring).cuts()?;
    let mut origins = Vec::with_capacity(3 * (ring.len() - 2));
    for part in parts(ring, &cuts) {
        fan_out(ring, &part, &mut origins);
    }
    if origins.len() != 3 * (ring.len() - 2) {
        return None;
    }
    let twins = twins(&origins, ring.len())?;
    Some(Triangles { origins, twins })
}

/// Whether point `p` comes before point `q`.
fn before(p: Vec2, q: Vec2) -> bool {
    (p.x, p.y) < (q.x, q.y)
}

/// The line that sweeps, and the floors that it crosses: edges with the inside above them.
struct Sweep<'a> {
    ring: &'a [Vec2],
    /// From low to high; floor i runs from point i to the next.
    floors: Vec<usize>,
    /// The last point that the line met between each floor and the ceiling above it: what a cut to
    /// the next point there can start from.
    helper: Vec<usize>,
    /// Points where the outline bends back from the right: each waits for a cut to the right.
    merges: Vec<bool>,
    cuts: Vec<(usize, usize)>,
}

impl<'a> Sweep<'a> {
    fn new(ring: &'a [Vec2]) -> Self {
        Self {
            ring,
            floors: Vec::new(),
            helper: vec![usize::MAX; ring.len()],
            merges: vec![false; ring.len()],
            cuts: Vec::new(),
        }
    }

    /// Cuts between points of the ring that leave nothing but monotone parts.
    fn cuts(mut self) -> Option<Vec<(usize, usize)>> {
        let n = self.ring.len();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&i, &j| {
            let (p, q) = (self.ring[i], self.ring[j]);
            p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
        });
        for here in order {
            let into = if here == 0 { n - 1 } else { here - 1 };
            let to = if here + 1 == n { 0 } else { here + 1 };
            let [a, p, b] = [into, here, to].map(|i| self.ring[i]);
            let convex = orient2d(a, p, b) > 0.0;
            match (before(a, p), before(p, b)) {
                // Two edges begin.
                (false, true) => {
                    if !convex {
                        let floor = self.below(p)?;
                        self.cut(here, floor);
                        self.helper[floor] = here;
                    }
                    self.open(here, p);
                }
                // Two edges end.
                (true, false) => {
                    self.close(into, here)?;
                    if !convex {
                        self.merges[here] = true;
                        self.meet(here)?;
                    }
                }
                // A floor goes on.
                (true, true) => {
                    let at = self.close(into, here)?;
                    self.floors.insert(at, here);
                    self.helper[here] = here;
                }
                // A ceiling goes on.
                (false, false) => self.meet(here)?,
            }
        }
        Some(self.cuts)
    }

    /// How many floors lie below a point.
    fn place(&self, p: Vec2) -> usize {
        let above = |&floor: &usize| {
            let end = if floor + 1 == self.ring.len() {
                0
            } else {
                floor + 1
            };
            orient2d(self.ring[floor], self.ring[end], p) > 0.0
        };
        self.floors.partition_point(above)
    }

    fn below(&self, p: Vec2) -> Option<usize> {
        let at = self.place(p).checked_sub(1)?;
        Some(self.floors[at])
    }

    fn open(&mut self, floor: usize, p: Vec2) {
        let at = self.place(p);
        self.floors.insert(at, floor);
        self.helper[floor] = floor;
    }

    /// Takes out a floor that ends here; where it was.
    fn close(&mut self, floor: usize, here: usize) -> Option<usize> {
        let at = self.place(self.ring[here]);
        if self.floors.get(at) != Some(&floor) {
            return None;
        }
        self.floors.remove(at);
        self.cut_to_merge(here, floor);
        Some(at)
    }

    /// A point above a floor that is not its own.
    fn meet(&mut self, here: usize) -> Option<()> {
        let floor = self.below(self.ring[here])?;
        self.cut_to_merge(here, floor);
        self.helper[floor] = here;
        Some(())
    }

    fn cut_to_merge(&mut self, here: usize, floor: usize) {
        if self.merges[self.helper[floor]] {
            self.cut(here, floor);
        }
    }

    fn cut(&mut self, here: usize, floor: usize) {
        self.cuts.push((here, self.helper[floor]));
    }
}

/// The parts of a ring between cuts, each counter-clockwise.
fn parts(ring: &[Vec2], cuts: &[(usize, usize)]) -> Vec<Vec<usize>> {
    let n = ring.len();
    // Edge i < n is the ring's; cut k is edge n + 2 k there and n + 2 k + 1 back.
    let mut leaving: Vec<(usize, usize)> = Vec::with_capacity(2 * cuts.len());
    let mut origins: Vec<usize> = (0..n).collect();
    for (k, &(from, to)) in cuts.iter().enumerate() {
        leaving.extend([(from, n + 2 * k), (to, n + 2 * k + 1)]);
        origins.extend([from, to]);
    }
    let twin = |edge: usize| n + ((edge - n) ^ 1);
    let end = |edge: usize| origins[twin(edge)];
    // Around each point, from its own edge on counter-clockwise.
    leaving.sort_by(|&(p, e), &(q, f)| {
        p.cmp(&q).then_with(|| {
            let (here, own) = (ring[p], ring[if p + 1 == n { 0 } else { p + 1 }]);
            let (to_e, to_f) = (ring[end(e)], ring[end(f)]);
            let beyond = |to: Vec2| orient2d(here, own, to) <= 0.0;
            let turn = orient2d(here, to_e, to_f);
            beyond(to_e)
                .cmp(&beyond(to_f))
                .then(0.0_f64.total_cmp(&turn))
        })
    });
    // A part that arrives along an edge leaves along the next one clockwise.
    let mut next: Vec<usize> = (0..n).map(|i| if i + 1 == n { 0 } else { i + 1 }).collect();
    next.resize(origins.len(), usize::MAX);
    for (i, &(point, edge)) in leaving.iter().enumerate() {
        let first = i == 0 || leaving[i - 1].0 != point;
        next[twin(edge)] = if first { point } else { leaving[i - 1].1 };
        // The last of them is what the ring's own edge into the point turns to.
        next[if point == 0 { n - 1 } else { point - 1 }] = edge;
    }
    let mut done = vec![false; origins.len()];
    let mut parts = Vec::with_capacity(cuts.len() + 1);
    for start in 0..origins.len() {
        let mut part = Vec::new();
        let mut edge = start;
        while !done[edge] {
            done[edge] = true;
            part.push(origins[edge]);
            edge = next[edge];
        }
        if !part.is_empty() {
            parts.push(part);
        }
    }
    parts
}

/// Triangles of a part that is monotone: three points each.
fn fan_out(ring: &[Vec2], part: &[usize], origins: &mut Vec<usize>) {
    let count = part.len();
    let least = (0..count).fold(0, |best, i| {
        if before(ring[part[i]], ring[part[best]]) {
            i
        } else {
            best
        }
    });
    let at = |step: usize| part[(least + step) % count];
    // Floors from the left, ceilings from the left: merged by their place.
    let (mut low, mut high) = (1, count - 1);
    // Points that see what comes next only past each other: an arc that bends inwards.
    let mut waiting: Vec<usize> = vec![at(0)];
    let mut on_floor = true;
    for _ in 1..count {
        let floor_first = low <= high && before(ring[at(low)], ring[at(high)]) || low == high;
        let here = if floor_first { at(low) } else { at(high) };
        let last = low == high;
        if floor_first {
            low += 1;
        } else {
            high -= 1;
        }
        let mut add = |[p, q, r]: [usize; 3], floor: bool| {
            origins.extend(if floor { [p, q, r] } else { [q, p, r] });
        };
        if waiting.len() > 1 && (last || floor_first != on_floor) {
            // From the other side it sees them all.
            for pair in waiting.windows(2) {
                add([pair[0], pair[1], here], on_floor);
            }
            waiting.drain(..waiting.len() - 1);
        } else {
            while let [.., p, q] = waiting[..] {
                let turn = orient2d(ring[p], ring[q], ring[here]);
                if if floor_first {
                    turn <= 0.0
                } else {
                    turn >= 0.0
                } {
                    break;
                }
                add([p, q, here], floor_first);
                waiting.pop();
            }
        }
        waiting.push(here);
        on_floor = floor_first;
    }
}

/// The same edge of the neighbouring triangle for every edge; `None` if one has no neighbour.
fn twins(origins: &[usize], n: usize) -> Option<Vec<usize>> {
    let mut twins = vec![OUTLINE; origins.len()];
    let mut cuts: Vec<(usize, usize, usize)> = Vec::new();
    for edge in 0..origins.len() {
        let from = origins[edge];
        let to = origins[edge - edge % 3 + (edge + 1) % 3];
        if to != (if from + 1 == n { 0 } else { from + 1 }) {
            cuts.push((from.min(to), from.max(to), edge));
        }
    }
    cuts.sort_unstable();
    let mut pairs = cuts.chunks_exact(2);
    for pair in &mut pairs {
        let [(a, b, edge), (c, d, other)] = [pair[0], pair[1]];
        if (a, b) != (c, d) {
            return None;
        }
        (twins[edge], twins[other]) = (other, edge);
    }
    pairs.remainder().is_empty().then_some(twins)
}
