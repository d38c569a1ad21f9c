//! What a sub-step takes from the energy of an island: ways take no less than nothing, and parting gives back no more.
//!
//! ```text
//! gain = j·(θ J v' + (1 − θ) J v) − (θ − ½) (v' − v)ᵀ M (v' − v)        d = h (θ v' + (1 − θ) v), less the work of pull on the way
//! ```
//! At θ = 1 nothing is gained: jₙ v'ₙ = −jₙ gap/h, and friction opposes the slip. At θ = ½ displacements are of second order.

use carom_impact::ImpactBody;
use carom_math::Vec2;

use super::solve::Island;
use crate::LineIx;
use crate::bodies::Bodies;
use crate::rows::{Graph, Law, Quad, quotient};

impl Island {
    /// Kinetic energy as the sub-step begins, in J. `None` where drivers or belts may add to it, or what lies too deep for sweeps is to be
    /// pushed out.
    pub(super) fn energy_before(&self, graph: &Graph) -> Option<f64> {
        let drives = |body: &ImpactBody| {
            body.inverse_mass <= 0.0 && (body.velocity != Vec2::ZERO || body.spin.abs() > 0.0)
        };
        let adds = self.contacts.iter().any(|contact| {
            let (_, cold, lane) = graph.lane(contact.id);
            contact.belt.abs() > 0.0 || cold.is_deep(lane)
        });
        if adds || self.bodies.iter().any(drives) {
            return None;
        }
        let came = self.bodies.iter().zip(&self.came);
        let kinetic =
            |(body, (v, w)): (&ImpactBody, &(Vec2, f64))| body.moving(*v, *w).kinetic_energy();
        Some(came.map(kinetic).sum())
    }

    /// What it has lost since, in J.
    pub(super) fn lost(&self, bodies: &Bodies) -> Option<f64> {
        let before = self.energy?;
        let now = |(line, body): (LineIx, &ImpactBody)| {
            let now = &bodies.lines[line];
            body.moving(now.v(), now.w()).kinetic_energy()
        };
        let kinetic: f64 = self.moved().map(now).sum();
        let went = |(line, from): (&LineIx, &Quad)| {
            let now = &bodies.lines[*line];
            work(bodies, *line, now.d() - from.v(), now.turn() - from.w())
        };
        let fell: f64 = self.lines.iter().zip(&self.ways).map(went).sum();
        Some(before + fell - kinetic)
    }

    /// Ways of second order may gain energy: they become ways by the velocities at the end, which do not, as far as that takes.
    pub(super) fn dissipate(&self, law: &Law, bodies: &mut Bodies) {
        let Some(lost) = self.lost(bodies).filter(|lost| *lost < 0.0) else {
            return;
        };
        let longer = |(line, from): (&LineIx, &Quad)| {
            let now = &bodies.lines[*line];
            let way = from.v() + now.v() * law.h - now.d();
            (way, from.w() + now.w() * law.h - now.turn())
        };
        let longer: Vec<(Vec2, f64)> = self.lines.iter().zip(&self.ways).map(longer).collect();
        let all = self.lines.iter().zip(&longer);
        let falls: f64 = all
            .map(|(line, (way, turn))| work(bodies, *line, *way, *turn))
            .sum();
        let part = if falls > -lost { -lost / falls } else { 1.0 };
        if falls > 0.0 {
            for (line, (way, turn)) in self.lines.iter().zip(longer) {
                let line = &mut bodies.lines[*line];
                line.set_displacement(line.d() + way * part, line.turn() + turn * part);
            }
        }
    }
}

/// What pull does on a way of a body, in J.
pub(super) fn work(bodies: &Bodies, line: LineIx, way: Vec2, turn: f64) -> f64 {
    let (body, pull) = (&bodies.lines[line], &bodies.pull[line]);
    let straight = quotient(pull.v().dot(way), body.inverse_mass());
    straight + quotient(pull.w() * turn, body.inverse_inertia())
}
