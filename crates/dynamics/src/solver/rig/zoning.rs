//! Which bodies belong to which zone: groups that hang together stay together while they are small, and
//! large ones are cut where few rows cross.

use super::Rig;
use crate::solver::coast::Quad;
use crate::solver::wide::Line;
use crate::solver::zone::Zone;

/// Fewer rows than this are swept as a whole: they fit into the cache. In unit tests few are many.
const LARGE: usize = if cfg!(test) { 16 } else { 8192 };

/// Rows of a zone, about: with their lines half of a second-level cache of 1 MiB.
const ROWS: usize = if cfg!(test) { 4 } else { 3072 };

/// Zones come in multiples of this: as much for each of two or four threads.
const EVEN: usize = 4;

/// Nobody.
const NONE: u32 = u32::MAX;

/// Where everybody goes.
struct Plan {
    /// New line of each old one; holes get none.
    new: Vec<u32>,
    /// Old line of each new one; `None`: an empty line.
    old: Vec<Option<u32>>,
    zones: Vec<Zone>,
}

impl Rig {
    /// Whether zones would leave fewer rows to be swept one after the other.
    pub(crate) fn wants_zones(&self) -> bool {
        let (rows, loose) = (self.lanes.len(), self.lanes.loose());
        rows >= LARGE && loose > rows / 8 && loose > 2 * self.crossing
    }

    /// Moves the bodies together; gives the new slot of each old one, `u32::MAX` for holes.
    pub(crate) fn compact(&mut self) -> Vec<u32> {
        let plan = self.plan();
        let lines = |old: &Option<u32>| old.map_or(Line::EMPTY, |i| self.lines[i as usize]);
        let lines: Vec<Line> = plan.old.iter().map(lines).collect();
        let start = |old: &Option<u32>| old.map_or(Quad::EMPTY, |i| self.start[i as usize]);
        let pull = |old: &Option<u32>| old.map_or(Quad::default(), |i| self.pull[i as usize]);
        self.start = plan.old.iter().map(start).collect();
        self.pull = plan.old.iter().map(pull).collect();
        self.free.clear();
        if plan.zones.len() == 1 && self.lanes.zones.len() == 1 {
            self.lanes.renumber(&plan.new);
        } else {
            self.lanes
                .settle(&self.lines, &plan.new, plan.zones, &lines);
        }
        self.lines = lines;
        self.crossing = self.lanes.loose();
        plan.new
    }

    fn plan(&self) -> Plan {
        let mut taken = vec![true; self.lines.len()];
        for slot in &self.free {
            taken[*slot as usize] = false;
        }
        // Doubles are nobody's.
        for zone in &self.lanes.zones[1..] {
            taken[zone.first as usize] = false;
            for (_, double) in &zone.doubles {
                taken[*double as usize] = false;
            }
        }
        let mut plan = Plan {
            new: vec![NONE; self.lines.len()],
            old: Vec::with_capacity(self.lines.len()),
            zones: vec![Zone::new(0, 0, Vec::new())],
        };
        let zones = if self.lanes.len() < LARGE {
            Vec::new()
        } else {
            self.divide()
        };
        let mut zone_of = vec![0u32; self.lines.len()];
        for (number, members) in (1u32..).zip(&zones) {
            for &slot in members {
                zone_of[slot as usize] = number;
            }
        }
        for slot in (0u32..).take(self.lines.len()) {
            if taken[slot as usize] && zone_of[slot as usize] == 0 {
                plan.add(slot);
            }
        }
        let mut met: Vec<Vec<u32>> = vec![Vec::new(); zones.len() + 1];
        for id in self.lanes.ids() {
            let (a, b) = self.bodies(id);
            for (one, other) in [(a, b), (b, a)] {
                if self.lines[one as usize].inverse_mass() == 0.0 {
                    met[zone_of[other as usize] as usize].push(one);
                }
            }
        }
        for (members, mut met) in zones.iter().zip(met.into_iter().skip(1)) {
            met.sort_unstable_by_key(|slot| plan.new[*slot as usize]);
            met.dedup();
            let first = plan.next();
            plan.old.push(None);
            let mut doubles = Vec::new();
            for slot in met {
                doubles.push((plan.new[slot as usize], plan.next()));
                plan.old.push(Some(slot));
            }
            for &slot in members {
                plan.add(slot);
            }
            plan.zones
                .push(Zone::new(first, plan.next() - first, doubles));
        }
        plan
    }

    /// Members of each zone, as their lines lie; none, where groups are to stay whole and one has most of the rows.
    fn divide(&self) -> Vec<Vec<u32>> {
        let near = self.neighbours();
        let rows = self.lanes.len();
        let count = rows.div_ceil(EVEN * ROWS) * EVEN;
        let most = rows.div_ceil(count);
        let mut marks = vec![0; self.lines.len()];
        let mut zones: Vec<Vec<u32>> = Vec::new();
        let (mut zone, mut size) = (Vec::new(), 0);
        for slot in (0u32..).take(self.lines.len()) {
            let moves = self.lines[slot as usize].inverse_mass() > 0.0;
            if marks[slot as usize] == NONE || !moves || self.lanes.degree(slot) == 0 {
                continue;
            }
            // From one end of the group to the other: a front that goes through it is short.
            let end = near.walk(slot, slot + 1, &mut marks);
            let end = end.last().copied().unwrap_or(slot);
            let before = size;
            for slot in near.walk(end, NONE, &mut marks) {
                // A row belongs to two.
                size += 2 * self.lanes.degree(slot) as usize - near.of(slot).len();
                zone.push(slot);
                if self.cuts && size >= 2 * most {
                    zones.push(core::mem::take(&mut zone));
                    size = 0;
                }
            }
            if self.cuts {
                continue;
            }
            if size - before > rows {
                return Vec::new();
            }
            if size >= 2 * most {
                zones.push(core::mem::take(&mut zone));
                size = 0;
            }
        }
        if !zone.is_empty() {
            zones.push(zone);
        }
        for zone in &mut zones {
            zone.sort_unstable();
        }
        zones
    }

    fn neighbours(&self) -> Neighbours {
        let moves = |i: u32| self.lines[i as usize].inverse_mass() > 0.0;
        let pairs = self.lanes.ids().map(|id| self.bodies(id));
        let pairs: Vec<(u32, u32)> = pairs.filter(|(a, b)| moves(*a) && moves(*b)).collect();
        let mut first = vec![0usize; self.lines.len() + 1];
        for (a, b) in &pairs {
            first[*a as usize + 1] += 1;
            first[*b as usize + 1] += 1;
        }
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let mut list = vec![0; 2 * pairs.len()];
        for (a, b) in pairs {
            for (one, other) in [(a, b), (b, a)] {
                list[next[one as usize]] = other;
                next[one as usize] += 1;
            }
        }
        Neighbours { first, list }
    }
}

/// Who shares rows with whom, among those who move.
struct Neighbours {
    /// Where the neighbours of each line begin in the list.
    first: Vec<usize>,
    list: Vec<u32>,
}

impl Neighbours {
    fn of(&self, slot: u32) -> &[u32] {
        &self.list[self.first[slot as usize]..self.first[slot as usize + 1]]
    }

    /// All who hang together with `from`, the nearer ones first; they get the mark.
    fn walk(&self, from: u32, mark: u32, marks: &mut [u32]) -> Vec<u32> {
        let mut walked = vec![from];
        marks[from as usize] = mark;
        let mut i = 0;
        while i < walked.len() {
            for &other in self.of(walked[i]) {
                if marks[other as usize] != mark {
                    marks[other as usize] = mark;
                    walked.push(other);
                }
            }
            i += 1;
        }
        walked
    }
}

impl Plan {
    fn next(&self) -> u32 {
        #[expect(clippy::cast_possible_truncation, reason = "slots are u32")]
        let next = self.old.len() as u32;
        next
    }

    fn add(&mut self, slot: u32) {
        self.new[slot as usize] = self.next();
        self.old.push(Some(slot));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::rig::{Member, NOBODY, Pull};
    use crate::solver::{Law, Row};
    use crate::{Settings, Softness};
    use carom_math::{Vec2, vec2};

    /// Columns of unit boxes on one ground, so many high.
    fn columns(heights: &[u32]) -> Rig {
        let mut rig = Rig {
            cuts: Settings::default().zones,
            ..Rig::default()
        };
        let mut member = Member {
            velocity: Vec2::ZERO,
            spin: 0.0,
            inverse_mass: 0.0,
            inverse_inertia: 0.0,
            pull: Pull::default(),
        };
        let ground = rig.admit(&member);
        (member.inverse_mass, member.inverse_inertia) = (1.0, 6.0);
        member.pull.acceleration = vec2(0.0, -10.0);
        for height in heights {
            let mut below = (ground, 0.0);
            for _ in 0..*height {
                let slot = rig.admit(&member);
                let arms = [-0.5, 0.5].map(|x| (vec2(x, below.1), vec2(x, -0.5)));
                let mut row = Row::new((below.0, slot), vec2(0.0, 1.0), &arms, 0.6);
                row.gap = [0.0; 2];
                rig.insert(&row);
                below = (slot, 0.5);
            }
        }
        rig
    }

    #[test]
    fn groups_lie_whole_in_zones_unless_one_has_most_of_the_rows() {
        let mut many = columns(&[3, 7, 2, 9, 1, 4, 6, 5, 8, 3]);
        assert!(many.wants_zones());
        many.compact();
        many.lanes.check(&many.lines);
        assert!(many.lanes.zones.len() > 4 && many.lanes.loose() == 0);
        let mut one = columns(&[3, 30, 5]);
        one.compact();
        assert_eq!(one.lanes.zones.len(), 1);
        assert!(!one.wants_zones(), "it is not tried at every tick");
    }

    /// The slow twin: second order in a pass of its own, and zones in the other order.
    #[test]
    fn a_sub_step_in_one_piece_has_the_bits_of_one_in_two() {
        let law = Law::new(&Softness::default(), 1.0 / 360.0);
        let mut whole = columns(&[3, 7, 2, 9, 1, 4, 6, 5, 8, 3]);
        whole.compact();
        assert_eq!(whole.lanes.loose(), 0);
        let mut parted = whole.clone();
        parted.back = !whole.back;
        for _ in 0..100 {
            whole.step(&law, NOBODY);
            parted.step(&law, Some(|_: &mut Rig| ()));
        }
        assert!(whole.lines.iter().any(|line| line.d().y < -1e-6));
        assert_eq!(whole.lines, parted.lines);
        assert_eq!(whole.heat.to_bits(), parted.heat.to_bits());
    }

    #[test]
    fn sub_steps_made_at_once_have_the_bits_of_one_after_the_other() {
        let law = Law::new(&Softness::default(), 1.0 / 360.0);
        let mut ahead = columns(&[3, 7, 2, 9, 1, 4, 6, 5, 8, 3]);
        ahead.compact();
        assert!(ahead.may_go_ahead());
        let mut slow = ahead.clone();
        for _ in 0..20 {
            assert!(ahead.step_ahead(&law, 6), "nothing comes up");
            (0..6).for_each(|_| slow.step(&law, NOBODY));
        }
        assert!(ahead.lines.iter().any(|line| line.d().y < -1e-6));
        assert_eq!(ahead.lines, slow.lines);
        assert_eq!(ahead.heat.to_bits(), slow.heat.to_bits());

        // Who falls is met with a speed: that is for one sub-step after the other, and all zones are as they were.
        let last = ahead.lines.len() - 1;
        #[expect(clippy::cast_possible_truncation, reason = "few")]
        for rig in [&mut ahead, &mut slow] {
            rig.set_velocity(last as u32, vec2(0.0, -1.0), 0.0);
        }
        assert!(ahead.may_go_ahead() && !ahead.step_ahead(&law, 6));
        for _ in 0..6 {
            ahead.step(&law, NOBODY);
            slow.step(&law, NOBODY);
        }
        assert_eq!(ahead.lines, slow.lines);
        assert_eq!(ahead.heat.to_bits(), slow.heat.to_bits());
    }

    #[test]
    fn in_a_zone_a_group_comes_to_rest_as_it_does_alone() {
        let law = Law::new(&Softness::default(), 1.0 / 360.0);
        let sunk = |heights: &[u32]| {
            let mut rig = columns(heights);
            rig.compact();
            for _ in 0..3600 {
                rig.step(&law, NOBODY);
            }
            let moving = rig.lines.iter().filter(|line| line.inverse_mass() > 0.0);
            let mut sunk: Vec<f64> = moving.map(|line| line.d().y).collect();
            sunk.sort_by(f64::total_cmp);
            sunk
        };
        let heights = [9, 4, 7, 8];
        let mut alone: Vec<f64> = heights.iter().flat_map(|n| sunk(&[*n])).collect();
        alone.sort_by(f64::total_cmp);
        for (y, alone) in sunk(&heights).into_iter().zip(alone) {
            assert!((y - alone).abs() < 1e-9, "sunk by {y} m, alone by {alone}");
        }
    }
}
