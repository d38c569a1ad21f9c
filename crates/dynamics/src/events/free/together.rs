//! Impacts of free bodies at one instant: a body struck from two sides, three that meet in a point, a ball on a joint.
//!
//! With e < 1 a series that comes ever faster is followed to its limit one after the other: there all instants are one.

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2, perp};

use super::Foreseen;
use super::queue::Entry;
use super::strike::{approach_speed, contacts_of, pace};
use crate::events::free::Cause;
use crate::events::shock::Shock;
use crate::impact::ImpactBody;
use crate::store::state::BodyState;
use crate::{BodyIx, Ix, PairIx, World};

/// Instants that differ by less are one, as a fraction of the way to them over the speed: impacts make
/// differences of roundings larger, by a decade each.
const INSTANT: f64 = 1e-12;

/// Instants of impacts with a loss that are longer, in s, are the end of many.
const SHORT: f64 = 1e-9;

/// Longest instant of impacts without loss, in s: they may be as slow as roundings are.
const LONGEST: f64 = 1e-4;

/// Approaches with a loss that are slower, as a part of the speeds that they are the difference of, are the end of many.
const FADING: f64 = 1e-6;

/// Points and normals that differ by less, as a fraction of the size, are those of a seam.
const SEAM: f64 = 1e-6;

/// Searches for each body within one instant. 3,000 scripts of `tests/it` ask for 0.2 at most; one asked for so many that it did not end.
const SEARCHES: usize = 16;

/// An impact that waits for its turn, with its entry.
type Due = (Entry, Foreseen);

impl World {
    /// Resolves an impact with all others of the same instant that it hangs together with.
    pub(super) fn strike_with_others(&mut self, first: Due) {
        let time = first.0.time;
        let instant = self.instant(&first.1, time);
        let loses = self.material_of(&first.1).restitution < 1.0;
        if loses && instant > SHORT {
            return self.strike_free_body(&first.1, time);
        }
        let limit = time + instant.min(LONGEST);
        self.lay_aside(limit);
        if self.free.aside.first().is_none() {
            return self.strike_free_body(&first.1, time);
        }
        let mut struck = vec![first];
        // A moving body in one of them brings in all its others.
        let mut k = 0;
        while k < struck.len() {
            let (a, b) = struck[k].1.bodies;
            k += 1;
            let mut joined = Vec::new();
            for index in [a, b] {
                if self.bodies.get(index).inverse_mass > 0.0 {
                    joined.extend(self.free.take_aside(index, limit));
                }
            }
            joined.sort_unstable();
            for entry in joined {
                let Some(other) = self.free.release(&entry) else {
                    continue;
                };
                // A pair may have been found twice.
                let known = |(_, known): &Due| known.colliders == other.colliders;
                if self.stamp(entry.a, entry.other()) == entry.stamp && !struck.iter().any(known) {
                    struck.push((entry, other));
                }
            }
        }
        if struck.len() > 1 && self.are_real(&struck, time) {
            self.drop_corners_of_seams(&mut struck);
            self.unite_sides(&mut struck);
        }
        if struck.len() > 1 && self.are_real(&struck, time) && self.are_one(&struck, time) {
            let impacts: Vec<Foreseen> = struck.into_iter().map(|(_, impact)| impact).collect();
            self.strike_all(&impacts, time);
        } else {
            let rest = struck.split_off(1);
            for (entry, impact) in rest {
                self.free.push_impact(entry.time, entry.stamp, impact);
            }
            self.strike_free_body(&struck[0].1, time);
        }
    }

    /// How much later an impact may be that happens at the same instant but for rounding, in s.
    fn instant(&self, impact: &Foreseen, time: SimTime) -> f64 {
        let (a, b) = self.bodies.both(impact.bodies);
        let way = impact.points[0].abs().max_element() + a.reach.min(b.reach);
        let speed = pace(&a.in_impact(time), a.reach) + pace(&b.in_impact(time), b.reach);
        if speed > 0.0 {
            INSTANT * way / speed
        } else {
            0.0
        }
    }

    /// Both bodies just before.
    pub(super) fn ends_of(&self, impact: &Foreseen, time: SimTime) -> [ImpactBody; 2] {
        [
            self.bodies.get(impact.bodies.0).in_impact(time),
            self.bodies.get(impact.bodies.1).in_impact(time),
        ]
    }

    /// Lays all impacts aside that are due by `limit`, once all searches due by then are done: all but what would use up the work of a
    /// call between two events.
    fn lay_aside(&mut self, limit: SimTime) {
        let mut searches = SEARCHES * (1 + self.bodies.places());
        while searches > 0
            && let Some(entry) = self.free.pop_queued(&self.bodies, limit)
        {
            if entry.what.slot().is_some() {
                self.free.aside.lay(entry);
            } else {
                self.run_search(&entry);
                searches -= 1;
            }
        }
    }

    /// Whether all are approaches, of free bodies and bodies at rest.
    fn are_real(&self, struck: &[Due], time: SimTime) -> bool {
        struck.iter().all(|(_, impact)| {
            let ends = [impact.bodies.0, impact.bodies.1].map(|index| self.bodies.get(index));
            let is_free = |state: &&BodyState| {
                !(state.is_asleep() || state.moves_analytically() || state.is_stepped())
            };
            ends.iter().all(is_free) && self.approaches(impact, time)
        })
    }

    /// Whether impacts of one instant are resolved together: where nothing is lost always, else unless a series that
    /// comes ever faster makes many instants look like one.
    fn are_one(&self, struck: &[Due], time: SimTime) -> bool {
        struck.iter().all(|(_, impact)| {
            let (a, b) = impact.bodies;
            let in_series = [a, b].map(|index| self.bodies.get(index).course.series.is_one());
            let ends = self.ends_of(impact, time);
            let fades = approach_speed(impact, &ends) <= FADING * self.scale(impact, &ends);
            self.material_of(impact).restitution >= 1.0
                || (in_series == [false, false] && !fades && self.instant(impact, time) <= SHORT)
        })
    }

    /// A ball that comes down on the joint of two tiles meets a face and, at the same instant, the other
    /// tile's corner: the corner lies in the face, and has no normal of its own.
    fn drop_corners_of_seams(&self, struck: &mut Vec<Due>) {
        let faces: Vec<Foreseen> = struck
            .iter()
            .filter(|(_, impact)| impact.face().is_some())
            .map(|(_, impact)| impact.clone())
            .collect();
        struck.retain(|(_, impact)| {
            let on_seam = |face: &Foreseen| {
                let common = |index: BodyIx| {
                    self.bodies.get(index).inverse_mass > 0.0
                        && (index == face.bodies.0 || index == face.bodies.1)
                };
                let Some(body) = [impact.bodies.0, impact.bodies.1]
                    .into_iter()
                    .find(|index| common(*index))
                else {
                    return false;
                };
                let size = self.bodies.get(body).reach;
                let away = |impact: &Foreseen| {
                    if impact.bodies.0 == body {
                        impact.normal
                    } else {
                        -impact.normal
                    }
                };
                (impact.points[0] - face.points[0]).length() <= SEAM * size
                    && (away(impact) - away(face)).length() <= SEAM
            };
            impact.face().is_some() || !faces.iter().any(on_seam)
        });
    }

    /// Shapes of one body that come down with one side, or with a corner that they share, strike once, as a shape in one piece does: at
    /// the ends of all that touches.
    fn unite_sides(&self, struck: &mut Vec<Due>) {
        let mut k = 1;
        while k < struck.len() {
            let known = struck[..k].iter();
            let mut known = known.map(|(_, one)| self.is_one_side(one, &struck[k].1));
            let Some(one) = known.position(|is| is) else {
                k += 1;
                continue;
            };
            let (_, other) = struck.remove(k);
            let impact = &mut struck[one].1;
            let near = SEAM * self.smaller_reach(impact);
            let along = perp(impact.normal);
            let all = || impact.points.iter().chain(&other.points).copied();
            let place = |x: &Vec2, y: &Vec2| x.dot(along).total_cmp(&y.dot(along));
            let ends = [all().min_by(place), all().max_by(place)];
            let ends: ArrayVec<Vec2, 2> = ends.into_iter().flatten().collect();
            impact.points = ends;
            if impact.points.len() == 2 && (impact.points[1] - impact.points[0]).length() <= near {
                impact.points.truncate(1);
            }
        }
    }

    /// Whether two impacts are of the same bodies, along one line, and with one material.
    fn is_one_side(&self, one: &Foreseen, other: &Foreseen) -> bool {
        let off = (other.points[0] - one.points[0]).dot(one.normal);
        one.bodies == other.bodies
            && (other.normal - one.normal).length() <= SEAM
            && off.abs() <= SEAM * self.smaller_reach(one)
            && self.material_of(one) == self.material_of(other)
    }

    fn smaller_reach(&self, impact: &Foreseen) -> f64 {
        let (a, b) = self.bodies.both(impact.bodies);
        a.reach.min(b.reach)
    }

    /// Several impacts at one instant, by [`crate::Settings::several`].
    fn strike_all(&mut self, impacts: &[Foreseen], time: SimTime) {
        let mut outrun = false;
        for impact in impacts {
            let material = self.material_of(impact);
            outrun |= self.outruns(impact, time, &material);
        }
        if outrun {
            return;
        }
        let mut shock = Shock::new(time);
        for (pair, impact) in (0..u32::MAX).rev().map(PairIx::new).zip(impacts) {
            let before = self.ends_of(impact, time);
            self.count_in_series(impact, time, approach_speed(impact, &before), 0.0);
            let material = self.material_of(impact);
            for contact in contacts_of(impact, &before, material) {
                let at = (contact.point, contact.normal);
                shock.add(&self.bodies, pair, impact.bodies, at, material, 0.0);
            }
        }
        for index in self.strike_together(shock, time) {
            if self.bodies.get(index).is_free() {
                self.foresee(index, time, Cause::Deflected, None);
            } else {
                // What was left squeezed has landed, and others were struck with it.
                self.deflected(index, time);
            }
        }
    }
}
