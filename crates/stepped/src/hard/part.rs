//! What overlaps once bodies moved is parted.
//!
//! ```text
//! d += h p        p: as little as leaves no gap below 0
//! v += p          where all pairs are free: SHAKE, with the normals and arms of the beginning
//! v += q          q: as little as stops what closes at the end, with the normals and arms there: RATTLE
//! ```
//! Two that turn about each other go straight within a sub-step, and so overlap at its end. Parted by displacement alone they are nearer
//! and as fast, and angular momentum is missing; impulses keep it. What was put into each other would gain energy by p: such bodies are
//! displaced, and so are those that something bears.

use carom_impact::{Friction, HeldFace, HeldFaces, ImpactBody};
use carom_math::{Vec2, perp};

use super::energy::work;
use super::solve::{HardContact, Island};
use crate::bodies::Bodies;
use crate::rows::{FreePairs, Graph, Law, Quad};
use crate::{LineIx, Settings};

/// A body's contacts are computed anew once it turned so far, in rad: rows are straight. A ring at 14.7 rad/s lets a hexagon out by
/// 22 mm where as much may turn as in soft rows.
const STALE: f64 = 0.02;

/// Overlap that is left as it is where sweeps hold an island, as a part of the smallest extent: what is parted opens other contacts, and
/// sweeps begin anew. A damped column of twenty boxes hums for ever at 3 cm/s with 0, and rests within 3 s with 1e-5 to 1e-3.
const SLOP: f64 = 1e-4;

/// Secants with which a push is sought that adds no energy: two to four are enough.
const SECANTS: usize = 8;

/// What such a push is to lose, and what it may lose, as parts of what all of it gains: as much is missed of it in each sub-step that
/// two turn about each other, and what they overlap by grows.
const LOSSES: [f64; 2] = [1e-6, 1e-3];

/// How fast both points of each contact are to open at least, in m/s.
type Opens = Vec<[f64; 2]>;

/// What parts contacts.
struct Parting {
    opens: Opens,
    /// How fast they may close afterwards: what was apart may come together.
    stops: Opens,
    /// What no body is faster than.
    fastest: f64,
}

impl Island {
    /// Displaces the bodies by as little as leaves no gap below 0 at the end of the sub-step, or as little as the fastest push-out
    /// does; the least gap then, in m. Where some cannot be parted the others are, as far as sweeps do.
    pub(super) fn part(
        &mut self,
        law: &Law,
        bodies: &mut Bodies,
        (graph, free): (&Graph, &mut FreePairs),
        settings: &Settings,
    ) -> f64 {
        let begun: Vec<[f64; 2]> = self.contacts.iter().map(|at| at.gaps).collect();
        self.dissipate(law, bodies);
        let mut least = self.least_gap(bodies, graph);
        let slop = self.slop(bodies);
        if least < -slop - self.touches(law) {
            let parts = self.parting_speeds(law, &begun, slop);
            if !self.push_apart(law, &parts, bodies, graph) {
                let mut faces = self.smooth_faces(graph);
                ask(&mut faces, &parts.opens);
                if let Some((_, centres)) = &self.begun {
                    meet(&mut faces, |k| centres[k]);
                }
                let (held, part) = self.parted(law, bodies, &parts, &faces);
                let part = part.min(self.covered(law, bodies, &held.bodies));
                self.displace(law.h * part, bodies, &held.bodies);
                self.note_parted(bodies, settings, &held.bodies, part);
                if self.gives_back {
                    self.give_back(graph, free, (&held.impulses, part), parts.fastest);
                }
            }
            least = self.least_gap(bodies, graph);
        }
        self.note_turned(bodies, settings);
        least
    }

    /// Parts free pairs as SHAKE and RATTLE do: by impulses that last, as the sub-step began, then by such as stop what closes where
    /// they are. Where more energy would be left than was there they are parted by less. Whether that is most of it.
    fn push_apart(&self, law: &Law, parts: &Parting, bodies: &mut Bodies, graph: &Graph) -> bool {
        let Some((begun, _)) = &self.begun else {
            return false;
        };
        let mut faces = begun.clone();
        ask(&mut faces, &parts.opens);
        let (held, part) = self.parted(law, bodies, parts, &faces);
        let before: f64 = self.bodies.iter().map(ImpactBody::kinetic_energy).sum();
        let pushed = |part: f64| {
            let pushed = self.pushed(part, &held.bodies, bodies);
            let mut faces = self.smooth_faces(graph);
            ask(&mut faces, &parts.stops);
            meet(&mut faces, |k| {
                bodies.centre_at(self.lines[k]) + held.bodies[k].velocity * (part * law.h)
            });
            let stopped = self.held(&pushed, &faces);
            let gained = stopped
                .bodies
                .iter()
                .map(ImpactBody::kinetic_energy)
                .sum::<f64>()
                - before;
            stopped.sure.then_some((stopped.bodies, gained))
        };
        if !held.sure {
            return false;
        }
        let Some((part, pushed)) = most(part, pushed) else {
            return false;
        };
        self.displace(law.h * part, bodies, &held.bodies);
        for (&at, to) in self.lines.iter().zip(&pushed) {
            let line = &mut bodies.lines[at];
            let push = Quad::new(to.velocity - line.v(), to.spin - line.w());
            line.set_velocity(to.velocity, to.spin);
            bodies.start[at].add(&push);
        }
        true
    }

    /// The bodies after a part of a push.
    fn pushed(&self, part: f64, by: &[ImpactBody], bodies: &Bodies) -> Vec<ImpactBody> {
        let push = |(line, by): (&LineIx, &ImpactBody)| {
            let line = &bodies.lines[*line];
            by.moving(line.v() + by.velocity * part, line.w() + by.spin * part)
        };
        self.lines.iter().zip(by).map(push).collect()
    }

    pub(super) fn smooth_faces(&self, graph: &Graph) -> Vec<HeldFace> {
        let mut faces = self.faces(graph, |_| 0.0, |_, _| Friction::Coulomb(0.0));
        if self.is_swept {
            // Sweeps begin with these impulses, while pivots but guess by them which points push.
            faces.iter_mut().for_each(|face| face.before = [0.0; 3]);
        }
        faces
    }

    /// How deep contacts may stay, in m.
    fn slop(&self, bodies: &Bodies) -> f64 {
        if !self.is_swept {
            return 0.0;
        }
        let extents = self.moved().map(|(line, _)| bodies.limits[line].extent);
        SLOP * extents.fold(f64::INFINITY, f64::min)
    }

    /// What overlapped as the sub-step began, at those gaps, parts at the fastest push-out; what did not parts at once: as a face turns
    /// that a plate runs along at 400 m/s it comes to lie 19 mm deep.
    fn parting_speeds(&self, law: &Law, begun: &[[f64; 2]], slop: f64) -> Parting {
        let mut parts = Parting {
            opens: Vec::with_capacity(begun.len()),
            stops: Vec::with_capacity(begun.len()),
            fastest: law.push_out,
        };
        for (contact, begun) in self.contacts.iter().zip(begun) {
            let points = [0, 1].map(|point| {
                let (gap, was) = (contact.gaps[point], begun[point]);
                let made = (was.min(0.0) - gap).max(0.0);
                let limit = law.push_out + made * law.inverse_h;
                if point < contact.points {
                    parts.fastest = parts.fastest.max(limit);
                }
                let stops = -was.max(gap).max(0.0) * law.inverse_h;
                ((-(gap + slop) * law.inverse_h).min(limit), stops)
            });
            parts.opens.push(points.map(|point| point.0));
            parts.stops.push(points.map(|point| point.1));
        }
        parts
    }

    /// The velocities, of bodies at rest, that part faces within a sub-step, and the part of them by which none goes or turns faster than
    /// the fastest push-out, or than one that is not fast but for what it went in by: what is wedged in goes a long way for a little room,
    /// past the ends of faces that it slides along.
    fn parted(
        &self,
        law: &Law,
        bodies: &Bodies,
        parts: &Parting,
        faces: &[HeldFace],
    ) -> (HeldFaces, f64) {
        let at_rest = self.bodies.iter().map(ImpactBody::at_rest);
        let held = self.held(&at_rest.collect::<Vec<_>>(), faces);
        let made = parts.fastest - law.push_out;
        let share = |(line, by): (&LineIx, &ImpactBody)| {
            let limit = &bodies.limits[*line];
            let slow = limit.near() * law.inverse_h;
            let fastest = by.velocity.length().max(by.spin.abs() * limit.reach);
            (made + law.push_out.min(slow)) / fastest
        };
        let shares = self.lines.iter().zip(&held.bodies).map(share);
        let part = shares.fold(1.0, f64::min);
        (held, part)
    }

    /// The part of a displacement that raises bodies by no more energy than the sub-step took.
    fn covered(&self, law: &Law, bodies: &Bodies, by: &[ImpactBody]) -> f64 {
        let Some(lost) = self.lost(bodies) else {
            return 1.0;
        };
        let falls = |(line, by): (&LineIx, &ImpactBody)| {
            work(bodies, *line, by.velocity * law.h, by.spin * law.h)
        };
        let raised: f64 = -self.lines.iter().zip(by).map(falls).sum::<f64>();
        if raised > lost {
            lost.max(0.0) / raised
        } else {
            1.0
        }
    }

    fn displace(&self, h: f64, bodies: &mut Bodies, by: &[ImpactBody]) {
        for (&line, by) in self.lines.iter().zip(by) {
            let line = &mut bodies.lines[line];
            let (d, turn) = (line.d() + by.velocity * h, line.turn() + by.spin * h);
            line.set_displacement(d, turn);
        }
    }

    /// Tells of a part of these impulses, pair by pair. Those that hold a squeezed body from several sides are up to 1e12 N·s: what would
    /// displace the heavier of a pair faster than the fastest push-out did not, and is not told.
    fn give_back(
        &self,
        graph: &Graph,
        free: &mut FreePairs,
        (impulses, part): (&[[f64; 3]], f64),
        fastest: f64,
    ) {
        for (k, contact) in self.contacts.iter().enumerate() {
            let of_pair = |other: &HardContact| other.ends == contact.ends;
            if self.contacts[..k].iter().any(of_pair) {
                continue;
            }
            let all = self.contacts.iter().zip(impulses);
            let pushes = all.filter(|(other, _)| of_pair(other)).map(|(other, j)| {
                let (block, _, lane) = graph.lane(other.id);
                block.normal(lane) * ((j[0] + j[1]) * part)
            });
            let push: Vec2 = pushes.sum();
            let [a, b] = contact.ends.map(|k| self.bodies[k].inverse_mass);
            let push = push * (fastest / (push.length() * a.min(b))).min(1.0);
            let (block, _, lane) = graph.lane(contact.id);
            let n = block.normal(lane);
            free.add_late(graph, contact.id, (n.dot(push), perp(n).dot(push)));
        }
    }

    /// What is parted faster than at a speed that counts as slow is not at rest, though displacements are no velocities.
    fn note_parted(
        &self,
        bodies: &mut Bodies,
        settings: &Settings,
        parted: &[ImpactBody],
        share: f64,
    ) {
        let Some(sleep) = settings.sleep else {
            return;
        };
        for (&line, to) in self.lines.iter().zip(parted) {
            if share * to.velocity.length() > sleep.least(bodies.limits[line].extent) {
                bodies.rest[line] = bodies.rest[line].min(0.0);
            }
        }
    }

    /// Notes the bodies that turned so far that their contacts are computed anew.
    fn note_turned(&self, bodies: &mut Bodies, settings: &Settings) {
        for &line in self.lines.iter().filter(|line| **line > LineIx::GROUND) {
            let turn = bodies.lines[line].turn();
            let is_stale = turn.abs() > STALE;
            if is_stale || bodies.limits[line].deviates(settings.margin, 0.0, turn) {
                bodies.deviating.push(line);
            }
            bodies.moved[line] |= is_stale;
        }
    }
}

/// The greatest part of a push with which no energy is gained, and what it leads to, by secants: the energy is nearly a parabola of the
/// part. `None` if it is less than half of `whole`.
fn most<T>(whole: f64, pushed: impl Fn(f64) -> Option<(T, f64)>) -> Option<(f64, T)> {
    let (found, gained) = pushed(whole)?;
    if gained <= 0.0 {
        return Some((whole, found));
    }
    let [aim, enough] = LOSSES.map(|part| -part * gained);
    let (mut gains, mut loses) = ((whole, gained), (0.0, pushed(0.0)?.1));
    for _ in 0..SECANTS {
        let part = loses.0 + (gains.0 - loses.0) * (aim - loses.1) / (gains.1 - loses.1);
        let (found, gained) = pushed(part)?;
        if gained <= 0.0 && gained >= enough {
            return (2.0 * part > whole).then_some((part, found));
        }
        if gained > aim {
            gains = (part, gained);
        } else {
            loses = (part, gained);
        }
    }
    None
}

fn ask(faces: &mut [HeldFace], speeds: &Opens) {
    for (face, opens) in faces.iter_mut().zip(speeds) {
        for (point, opens) in face.points.iter_mut().zip(opens) {
            point.opens = *opens;
        }
    }
}

/// Has faces push at one point of both bodies, with their centres there: no angular momentum changes.
fn meet(faces: &mut [HeldFace], centre: impl Fn(usize) -> Vec2) {
    for face in faces {
        let between = centre(face.bodies.1) - centre(face.bodies.0);
        for point in &mut face.points {
            let off = 0.5 * (between - (point.on.0 - point.on.1));
            point.on = (point.on.0 + off, point.on.1 - off);
        }
    }
}
