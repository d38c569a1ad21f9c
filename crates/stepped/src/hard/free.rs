//! Free islands, without supports or external forces, keep their angular momentum `Σ m c × v + I ω` to rounding.
//!
//! ```text
//! impulses act at one point of both bodies, at the poses that the sub-step begins with
//! d += h v'                                       along v', so c × v' stays
//! d += δ, δ = ± way jₙ n / m                      changes it by Σ m δ × v' = way jₙ n × (v_B − v_A)
//! v_B − v_A turns by what gives that back         as it turns with the line between both centres on a curved way
//! ```

use carom_math::{Vec2, perp};

use super::solve::Island;
use crate::bodies::Bodies;
use crate::rows::{Graph, Law, Quad, quotient};

/// Whether a body can be moved, and no force acts on it but those of contacts.
pub(super) fn is_free(bodies: &Bodies, line: usize) -> bool {
    bodies.lines[line].inverse_mass() > 0.0 && bodies.pull[line] == Quad::default()
}

impl Island {
    /// Notes that its bodies are free, and where they are.
    pub(super) fn begin_free(&mut self, bodies: &Bodies, graph: &mut Graph) {
        let at = |line: &u32| bodies.lines[*line as usize].displacement();
        self.from = self.lines.iter().map(at).collect();
        for contact in &self.contacts {
            graph.meet(bodies, contact.id);
        }
    }

    /// Displaces free bodies by what their velocities say: impulses act as the sub-step begins. Damping acts evenly.
    pub(super) fn go_straight(&self, law: &Law, bodies: &mut Bodies) {
        for (&line, from) in self.lines.iter().zip(&self.from) {
            let at = line as usize;
            let before = bodies.velocity_before(at, law.h);
            let (body, start) = (&bodies.lines[at], &bodies.start[at]);
            let velocity = [body.v().x, body.v().y, body.w()];
            let [x, y, turn] = [0, 1, 2].map(|k| {
                let damped = start.0[k] - before[k];
                from.0[k] + law.h * (velocity[k] - 0.5 * damped)
            });
            bodies.lines[at].set_displacement(Vec2::new(x, y), turn);
        }
    }

    /// Takes back the angular momentum of free bodies that normal impulses parted by a displacement, which acted for `way` seconds.
    pub(super) fn turn_back(
        &self,
        bodies: &mut Bodies,
        graph: &Graph,
        (impulses, way): (&[[f64; 3]], f64),
    ) {
        if self.from.is_empty() {
            return;
        }
        let lost = self.contacts.iter().zip(impulses);
        let lost: Vec<f64> = lost
            .map(|(contact, [first, second, _])| {
                let (block, _, lane) = graph.lane(contact.id);
                let [a, b] = self.ends(bodies, contact);
                way * (first + second) * block.normal(lane).perp_dot(b.v() - a.v())
            })
            .collect();
        for (contact, lost) in self.contacts.iter().zip(lost) {
            let [a, b] = contact.ends.map(|end| self.lines[end] as usize);
            turn_pair(bodies, [a, b], -lost);
            for end in contact.ends {
                bodies.note_change(self.lines[end]);
            }
        }
    }
}

/// Turns the velocity of one body against the other one so that both have `moment` N·m·s more. What no turn gives their spins get.
fn turn_pair(bodies: &mut Bodies, [a, b]: [usize; 2], moment: f64) {
    let (first, second) = (&bodies.lines[a], &bodies.lines[b]);
    let (ma, mb) = (first.inverse_mass(), second.inverse_mass());
    let place = |at: usize| bodies.base[at].position + bodies.lines[at].d();
    let (arm, against) = (place(b) - place(a), second.v() - first.v());
    let most = arm.length() * against.length();
    let (across, along) = (arm.perp_dot(against), arm.dot(against));
    let wanted = across + moment * (ma + mb);
    let reached = wanted.clamp(-most, most);
    // As long as before: only its direction turns, and on which side of the arm it points stays.
    let rest = (most * most - reached * reached)
        .max(0.0)
        .sqrt()
        .copysign(along);
    let turned = if most > 0.0 {
        (arm * rest + perp(arm) * reached) / arm.length_squared()
    } else {
        against
    };
    let change = (turned - against) / (ma + mb);
    let inertia = [first, second].map(|line| quotient(1.0, line.inverse_inertia()));
    let spin = (wanted - reached) / (ma + mb) * quotient(1.0, inertia[0] + inertia[1]);
    for (at, inertia, change) in [(a, inertia[0], change * -ma), (b, inertia[1], change * mb)] {
        let turn = Quad::new(change, if inertia > 0.0 { spin } else { 0.0 });
        bodies.lines[at].add(&turn);
        bodies.start[at].add(&turn);
    }
}
