//! Groups at rest: they fall asleep together and wake together.

use carom_math::{SimTime, Vec2};

use crate::groups::Groups;
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
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

/// Wakes a body and all sleepers that it touches, and so on; those that the engine has are for the engine to wake.
pub(crate) fn wake(
    bodies: &mut Bodies,
    pairs: &Pairs,
    index: u32,
    time: SimTime,
    events: &mut Events,
    woken: &mut Vec<u32>,
) {
    let mut waking = vec![index];
    while let Some(index) = waking.pop() {
        let state = bodies.get_mut(index);
        if !state.is_asleep() {
            continue;
        }
        woken.push(index);
        if state.in_engine() {
            continue;
        }
        state.slow_for = 0.0;
        let id = state.id;
        if bodies.wake(index) {
            events.push(time, EventKind::Awake(id));
        }
        waking.extend(neighbours(bodies, pairs, index));
    }
}

/// Wakes all sleepers that touch a body: what held them has changed.
pub(crate) fn wake_around(
    bodies: &mut Bodies,
    pairs: &Pairs,
    index: u32,
    time: SimTime,
    events: &mut Events,
    woken: &mut Vec<u32>,
) {
    wake(bodies, pairs, index, time, events, woken);
    let around: Vec<u32> = neighbours(bodies, pairs, index).collect();
    for other in around {
        wake(bodies, pairs, other, time, events, woken);
    }
}

/// Bodies that touch a body.
pub(crate) fn neighbours<'a>(
    bodies: &'a Bodies,
    pairs: &'a Pairs,
    index: u32,
) -> impl Iterator<Item = u32> + use<'a> {
    bodies.get(index).pairs.iter().filter_map(move |&place| {
        let pair = pairs.get(place);
        pair.touching.then(|| pair.other(index))
    })
}

fn moves(bodies: &Bodies, index: u32) -> bool {
    let motion = &bodies.get(index).motion;
    motion.velocity != Vec2::ZERO || motion.spin != 0.0
}

/// Union by index: the smaller root wins, so that groups do not depend on the order of links.
pub(crate) struct Tree {
    parents: Vec<u32>,
}

impl Tree {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            parents: (0u32..).take(count).collect(),
        }
    }

    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let up = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = up;
            i = up;
        }
        i
    }

    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        self.parents[high as usize] = low;
    }
}
