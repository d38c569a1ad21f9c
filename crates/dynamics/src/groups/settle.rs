//! Groups at rest fall asleep together.

use carom_math::{SimTime, Vec2};

use super::Groups;
use crate::model::graph::Tree;
use crate::store::bodies::Bodies;
use crate::values::event::EventKind;
use crate::{BodyKind, Events, Sleep};

/// Puts every island to sleep once all its bodies have been slow for long enough; returns these bodies.
pub(crate) fn settle(
    sleep: Sleep,
    bodies: &mut Bodies,
    stepped: &[u32],
    groups: &Groups,
    time: SimTime,
    h: f64,
    events: &mut Events,
) -> Vec<u32> {
    // Groups by places in the list, which is in order.
    let mut tree = Tree::new(stepped.len());
    let (mut restless, mut on_ground) = (Vec::new(), Vec::new());
    #[expect(clippy::cast_possible_truncation, reason = "fewer than bodies")]
    let place = |index: u32| stepped.binary_search(&index).ok().map(|at| at as u32);
    for (a, b) in groups.links() {
        match (bodies.get(a).kind, bodies.get(b).kind) {
            (BodyKind::Dynamic, BodyKind::Dynamic) => {
                if let Some((a, b)) = place(a).zip(place(b)) {
                    tree.join(a, b);
                }
            }
            (BodyKind::Kinematic, _) if moves(bodies, a) => restless.extend(place(b)),
            (_, BodyKind::Kinematic) if moves(bodies, b) => restless.extend(place(a)),
            (BodyKind::Dynamic, _) => on_ground.extend(place(a)),
            _ => on_ground.extend(place(b)),
        }
    }
    // What drifts in space is not at rest, however slow: it would lose its momentum.
    let mut supported = vec![false; stepped.len()];
    for at in on_ground {
        supported[tree.root(at) as usize] = true;
    }
    // Least time of rest in each group, kept at its root.
    let mut least = vec![f64::INFINITY; stepped.len()];
    let mut asleep = Vec::new();
    for (&index, at) in stepped.iter().zip(0..) {
        let pushed = groups.pushed(index);
        let state = bodies.get_mut(index);
        let end = time + h;
        let speed = state.velocity_at(end).length() + state.spin_at(end).abs() * state.reach;
        // Only what something holds can be at rest: the top of a throw is not.
        state.slow_for = if pushed && speed <= sleep.speed && state.sleep_allowed() {
            state.slow_for + h
        } else {
            0.0
        };
        let slow = state.slow_for;
        let root = tree.root(at) as usize;
        least[root] = least[root].min(slow);
    }
    for at in restless {
        least[tree.root(at) as usize] = 0.0;
    }
    // Slow for this sub-step at least. What is in an analytic island is not pushed, and falls asleep with it.
    let enough = sleep.time.max(h);
    for (&index, at) in stepped.iter().zip(0..) {
        let root = tree.root(at) as usize;
        if least[root] < enough || !supported[root] {
            continue;
        }
        let (kinetic, _) = bodies.energy_of(index, time);
        bodies.book.scheme.add(-kinetic);
        bodies.change(index, time, |motion| {
            motion.velocity = Vec2::ZERO;
            motion.acceleration = Vec2::ZERO;
            motion.spin = 0.0;
            motion.angular_acceleration = 0.0;
        });
        bodies.fall_asleep(index);
        events.push(time, EventKind::Asleep(bodies.get(index).id));
        asleep.push(index);
    }
    asleep
}

fn moves(bodies: &Bodies, index: u32) -> bool {
    let motion = &bodies.get(index).motion;
    motion.velocity != Vec2::ZERO || motion.spin != 0.0
}
