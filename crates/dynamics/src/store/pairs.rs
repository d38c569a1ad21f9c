//! Pairs of shapes that are near each other, and what they remember.

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use super::clock::whole;
use super::slots::Slots;
use crate::{BodyIx, ColliderIx, ContactMode, PairIx, PairMaterial, Two};

/// Two colliders of different bodies with overlapping boxes; the lower body comes first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pair {
    pub(crate) colliders: Two<ColliderIx>,
    pub(crate) bodies: Two<BodyIx>,
    pub(crate) material: PairMaterial,
    /// Not looked at yet: what lies beside a body that starts asleep must be known before either is struck.
    pub(crate) fresh: bool,
    /// Contacts of the last look, part by part.
    pub(crate) contacts: Vec<PairContact>,
    /// Touched at the last look, or struck since.
    pub(crate) touching: bool,
    /// The caller was told that it touches: looks of all kinds say what touches, begins and ends come in turns.
    pub(crate) told: bool,
    /// What the turning of its bodies adds to its rest speed, in m/s, by the last look or forecast.
    pub(crate) turning_rest: f64,
    /// Some contact pushes: the pair is solved for, not struck.
    pub(crate) lasting: bool,
    /// How its bodies last moved against each other in a contact in closed form.
    pub(crate) mode: Option<ContactMode>,
    /// So deep in each other that no strike makes sense: the solver pushes them apart.
    pub(crate) buried: bool,
    /// The sub-step, on their grid, of its last impact.
    pub(crate) struck_in: u64,
    /// Impacts in that sub-step.
    pub(crate) impacts: u32,
    /// What they spent of the pair's budget in it.
    pub(crate) spent: f64,
}

/// Two shapes of two bodies: (body, collider) of both.
pub(crate) type Shapes = [(BodyIx, ColliderIx); 2];

impl Pair {
    /// Its bodies, each with its shape.
    pub(crate) const fn shapes(&self) -> Shapes {
        let ((a, b), (first, second)) = (self.bodies, self.colliders);
        [(a, first), (b, second)]
    }

    /// An impact in another sub-step of `h` seconds than the last one has a new budget.
    pub(crate) fn begin_budget(&mut self, time: SimTime, h: f64) {
        let substep = whole(time, h);
        if self.struck_in != substep {
            (self.struck_in, self.impacts, self.spent) = (substep, 0, 0.0);
        }
    }

    /// Whether its shapes were more than `touch` m deep in each other at the last look.
    pub(crate) fn overlaps(&self, touch: f64) -> bool {
        let mut points = self.contacts.iter().flat_map(|contact| &contact.points);
        points.any(|point| point.separation < -touch)
    }

    /// Its deepest overlap, in m, ≥ 0.
    pub(crate) fn depth(&self) -> f64 {
        let points = self.contacts.iter().flat_map(|contact| &contact.points);
        points.map(|point| -point.separation).fold(0.0, f64::max)
    }

    /// The one of its bodies that is not this one.
    pub(crate) fn other(&self, body: BodyIx) -> BodyIx {
        let (a, b) = self.bodies;
        if a == body { b } else { a }
    }

    /// The shape that this body has in it, and that of the other.
    pub(crate) fn shapes_from(&self, body: BodyIx) -> Two<ColliderIx> {
        let (first, second) = self.colliders;
        if self.bodies.0 == body {
            (first, second)
        } else {
            (second, first)
        }
    }
}

/// A contact of two convex parts at the last look.
#[derive(Clone, Debug)]
pub(crate) struct PairContact {
    pub(crate) parts: (u32, u32),
    /// Unit normal from A to B, in the world.
    pub(crate) normal: Vec2,
    pub(crate) points: ArrayVec<PairPoint, 2>,
    pub(crate) tangent_impulse: f64,
}

/// A point of a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairPoint {
    /// In the world, in m.
    pub(crate) position: Vec2,
    pub(crate) separation: f64,
    pub(crate) impulse: f64,
}

/// The pairs of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    list: Slots<PairIx, Pair>,
    /// Places of pairs that have not been looked at yet.
    pub(crate) fresh: Vec<PairIx>,
}

impl Pairs {
    pub(crate) fn insert(&mut self, pair: Pair) -> PairIx {
        let place = self.list.insert(pair);
        self.fresh.push(place);
        place
    }

    pub(crate) fn remove(&mut self, place: PairIx) -> Option<Pair> {
        self.list.remove(place)
    }

    /// The pair of a place, if there is one.
    pub(crate) fn find(&self, place: PairIx) -> Option<&Pair> {
        self.list.get(place)
    }

    /// # Panics
    /// If the place is empty: lists of places and the store have parted.
    pub(crate) fn get(&self, place: PairIx) -> &Pair {
        self.list.get(place).expect("a listed pair is there")
    }

    /// # Panics
    /// If the place is empty: lists of places and the store have parted.
    pub(crate) fn get_mut(&mut self, place: PairIx) -> &mut Pair {
        self.list.get_mut(place).expect("a listed pair is there")
    }

    /// The other shape of a pair that this shape is in.
    pub(crate) fn partner(&self, place: PairIx, shape: ColliderIx) -> Option<ColliderIx> {
        match self.get(place).colliders {
            (one, other) | (other, one) if one == shape => Some(other),
            _ => None,
        }
    }

    /// These places in order of colliders, each once.
    pub(crate) fn by_colliders(&self, places: impl IntoIterator<Item = PairIx>) -> Vec<PairIx> {
        let keyed = places
            .into_iter()
            .map(|place| (self.get(place).colliders, place));
        let mut keyed: Vec<_> = keyed.collect();
        keyed.sort_unstable();
        keyed.dedup();
        keyed.into_iter().map(|(_, place)| place).collect()
    }

    /// Places of all pairs in order of colliders.
    pub(crate) fn in_order(&self) -> Vec<PairIx> {
        self.by_colliders(self.list.iter().map(|(place, _)| place))
    }
}
