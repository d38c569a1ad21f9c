//! Heaps that land at once: bodies that rest on each other join the engine together, without being sub-stepped first.
//!
//! Body by body each would be made ready for sub-steps, paired, looked at and solved for, layer upon layer, only to be
//! handed to the engine, which pairs it and looks at it once more.

use carom_collision::{PartManifold, contacts};
use carom_math::{Pose, SimTime};

use super::MANY;
use super::rules::Rules;
use crate::broad::tree::Overlapping;
use crate::model::approach::RigidState;
use crate::model::graph::ROWS;
use crate::model::narrow::{TOUCH, rest_speed_between};
use crate::store::state::BodyState;

/// What the search for heaps knows of the bodies of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen {
    of: Vec<Step>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Unseen,
    /// It belongs to a heap.
    Found,
    /// And all that it touches is known.
    Asked,
}

/// What hangs together by touch, and does not move against each other.
struct Heap {
    bodies: Vec<u32>,
    /// Points of contact: at least as many rows.
    points: usize,
    /// No body in it is in closed form.
    fits: bool,
}

impl Heap {
    /// Whether the engine takes it before closed forms are tried, or after these were tried in vain.
    fn is_for_engine(&self, few: usize) -> bool {
        let count = self.bodies.len();
        self.fits && (count > MANY || count > few && self.points > ROWS)
    }
}

/// What a search for heaps reads, at the start of a sub-step.
pub(crate) struct Heaps<'a> {
    pub(crate) rules: Rules<'a>,
    /// Finds free bodies.
    pub(crate) free: &'a Overlapping<'a>,
    /// So many bodies may be in closed form.
    pub(crate) few: usize,
    pub(crate) time: SimTime,
    pub(crate) h: f64,
}

impl Heaps<'_> {
    /// Bodies of `lands`, which begin to rest, with all of their heaps that are for the engine, in order.
    pub(crate) fn joining(&self, lands: &[u32], seen: &mut Seen) -> Vec<u32> {
        seen.of.resize(self.rules.bodies.places(), Step::Unseen);
        let mut joining = Vec::new();
        for &index in lands {
            if seen.of[index as usize] == Step::Unseen {
                let heap = self.heap_around(index, seen);
                if heap.is_for_engine(self.few) {
                    joining.extend(heap.bodies);
                }
            }
        }
        joining.sort_unstable();
        joining
    }

    /// All that hangs together by touch with a body that begins to rest.
    fn heap_around(&self, first: u32, seen: &mut Seen) -> Heap {
        let Rules {
            bodies, colliders, ..
        } = self.rules;
        let mut heap = Heap {
            bodies: vec![first],
            points: 0,
            fits: true,
        };
        seen.of[first as usize] = Step::Found;
        let mut scratch = Scratch::default();
        let mut next = 0;
        while let Some(&index) = heap.bodies.get(next) {
            next += 1;
            seen.of[index as usize] = Step::Asked;
            let state = bodies.get(index);
            heap.fits &= !state.membership.is_closed();
            let here = Here::of(state, self.time);
            for &mine in &state.colliders {
                self.near_at(mine, &here, &mut scratch);
                for &other in &scratch.near {
                    let owner = colliders[other as usize].body;
                    if seen.of[owner as usize] == Step::Asked {
                        continue;
                    }
                    let shapes = (mine, other);
                    let points = self.rest_between(shapes, &here, &mut scratch.found);
                    if points == 0 {
                        continue;
                    }
                    heap.points += points;
                    let state = bodies.get(owner);
                    let belongs = state.is_dynamic() && !state.is_asleep() && !state.in_engine();
                    if belongs && seen.of[owner as usize] == Step::Unseen {
                        seen.of[owner as usize] = Step::Found;
                        heap.bodies.push(owner);
                    }
                }
            }
        }
        heap
    }

    /// Shapes that may touch one where it is, those of free bodies too.
    fn near_at(&self, mine: u32, here: &Here, scratch: &mut Scratch) {
        let Rules {
            bodies,
            colliders,
            broad,
        } = self.rules;
        let collider = &colliders[mine as usize];
        let bounds = collider.solid.aabb(here.pose).grown(here.touch);
        broad.search_tree(colliders, bounds, &mut scratch.near);
        (self.free)(bodies, bounds, &mut scratch.free);
        let shapes = |body: &u32| &bodies.get(*body).colliders;
        scratch.near.extend(scratch.free.iter().flat_map(shapes));
    }

    /// At how many points a shape of a body that is here rests on another one: they touch, and do not approach faster than what rests.
    fn rest_between(
        &self,
        (mine, other): (u32, u32),
        here: &Here,
        found: &mut Vec<PartManifold>,
    ) -> usize {
        let Rules {
            bodies,
            colliders,
            broad,
        } = self.rules;
        let [mine, other] = [mine, other].map(|at| &colliders[at as usize]);
        let (a, b) = (bodies.get(mine.body), bodies.get(other.body));
        let apart = b.centre_at(self.time) - here.pose.position;
        let touch = TOUCH * a.reach.min(b.reach);
        let near = a.reach + b.reach + touch;
        if mine.body == other.body
            || apart.length_squared() > near * near
            || !broad.may_touch(bodies, mine, other)
        {
            return 0;
        }
        let there = Here::of(b, self.time);
        let b_in_a = there.pose.seen_from(here.pose);
        found.clear();
        contacts(&mine.solid, &other.solid, b_in_a, touch, found);
        let slowest = -rest_speed_between(bodies, (mine.body, other.body), self.h);
        let mut points = 0;
        for contact in &*found {
            let normal = here.pose.vector(contact.manifold.normal);
            for point in &contact.manifold.points {
                let at = here.pose.point(point.point);
                let rate = (there.moves.velocity_of(at) - here.moves.velocity_of(at)).dot(normal);
                points += usize::from(point.separation <= touch && rate >= slowest);
            }
        }
        points
    }
}

/// A body at an instant.
struct Here {
    pose: Pose,
    moves: RigidState,
    /// What touches it is nearer than this, in m.
    touch: f64,
}

impl Here {
    fn of(state: &BodyState, time: SimTime) -> Self {
        Self {
            pose: state.centre_pose(time),
            moves: RigidState::of(state, time),
            touch: TOUCH * state.reach,
        }
    }
}

/// What a search for the next one in a heap leaves behind.
#[derive(Default)]
struct Scratch {
    near: Vec<u32>,
    free: Vec<u32>,
    found: Vec<PartManifold>,
}

#[cfg(test)]
mod tests {
    use crate::{BodyDef, BodyId, Material, PairSearch, Settings, World};
    use carom_geometry::ConvexPolygon;
    use carom_math::vec2;

    /// Pyramids on a floor, too small for the engine, for it after closed forms and for it at once; of each one is at rest, in
    /// one a body is damped, in one it was put deep into the floor, on one the top moves, and onto one it falls.
    fn stacks(pair_search: PairSearch) -> World {
        let settings = Settings {
            pair_search,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let stone = Material::default();
        let block = |x, y| ConvexPolygon::rectangle(x, y).expect("a rectangle");
        let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
        world
            .insert(floor, block(4e3, 2.0), stone)
            .expect("a floor");
        let mut left = -1e3;
        for (k, rows) in [3, 5, 6, 11].into_iter().enumerate() {
            for variant in 0..5 {
                for row in 0..rows {
                    for column in 0..rows - row {
                        let (x, y) = (f64::from(column) + 0.5 * f64::from(row), f64::from(row));
                        let mut def = BodyDef::dynamic().at(vec2(left + x, y + 0.5));
                        let (first, top) = ((row, column) == (1, 0), row + 1 == rows);
                        match variant {
                            1 if first => def = def.damped(0.1, 0.0),
                            2 if first => def = def.at(vec2(left + x, y + 0.4)),
                            3 if top => def = def.moving(vec2(0.1, 0.0)),
                            4 if top => def = def.moving(vec2(0.0, -3.0)),
                            _ => {}
                        }
                        let height = if k % 2 == 0 || !top { 1.0 } else { 2.0 };
                        def.position.y += 0.5 * (height - 1.0);
                        world.insert(def, block(1.0, height), stone).expect("valid");
                    }
                }
                left += f64::from(rows) + 3.0;
            }
        }
        world
    }

    /// Members of the engine.
    fn members(world: &World) -> Vec<BodyId> {
        let members = world.bodies.iter().filter(|state| state.in_engine());
        members.map(|state| state.id).collect()
    }

    #[test]
    fn a_heap_joins_at_once_as_it_does_layer_by_layer() {
        let mut worlds = [PairSearch::Indexed, PairSearch::AllPairs].map(stacks);
        let [at_once, by_layers] = &mut worlds;
        for world in [&mut *at_once, by_layers] {
            world.step(world.settings.substep);
        }
        let (at_once, by_layers) = (members(at_once), members(by_layers));
        assert_eq!(at_once, by_layers);
        assert!(at_once.len() > 200, "{}", at_once.len());
    }
}
