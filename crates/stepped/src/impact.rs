//! Impacts, as callers see them.
//!
//! ```text
//! a point that was apart pushes, and closed faster than rest ─► its pair's run begins ─► nothing of it closes any more
//! ```
//! The impact of two pieces' shapes is that run of sub-steps: its speed is that of arrival, its impulse the sum over sub-steps,
//! points and pieces, its time when the gap was closed. For sub-steps of no length it is the event of exact motion.

use carom_math::{Vec2, perp};

use crate::bodies::{Bodies, number};
use crate::pieces::Pieces;
use crate::rows::{Arrival, Block, Cold, Colour, Graph, Law, REST, lanes};
use crate::{BodyId, BodyIx, ContactIx, Engine, LineIx, PieceIx};

/// A run goes on for so many sub-steps at most: what is pressed on for longer lies there.
const LONGEST: u32 = 16;

/// An impact of two bodies' shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// A and B: A was inserted first.
    pub bodies: [BodyId; 2],
    /// Tags of the pieces that met: what has the same tag is one shape.
    pub tags: [u64; 2],
    /// Point at which its impulses act together, in m.
    pub place: Vec2,
    /// Unit normal from A to B.
    pub normal: Vec2,
    /// Impulse on B along the normal, in N·s.
    pub normal_impulse: f64,
    /// Impulse on B along the normal turned by +90°, in N·s.
    pub tangential_impulse: f64,
    /// Normal speed of approach with which the surface was met, in m/s.
    pub speed: f64,
    /// For how long it has been met, in s.
    pub since: f64,
}

/// An impact of two pieces that goes on.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// Number of the contact, and its bodies and pieces: numbers are given anew.
    contact: ContactIx,
    slots: [BodyIx; 2],
    pieces: [PieceIx; 2],
    speed: f64,
    /// From the beginning of its first sub-step on, in s.
    met: f64,
    age: u32,
    impulse: Vec2,
    /// Sums of the normal impulses of all points: alone, times normals, times places.
    weight: f64,
    normal: Vec2,
    moment: Vec2,
    /// Speeds with which its points opened before this sub-step, and the slip, in m/s, once they are known; and in it the impulses
    /// so far, and the heat of friction, which is told elsewhere, in J.
    came: Option<[f64; 3]>,
    did: [f64; 3],
    heat: f64,
    /// What it took beside that heat, in J.
    lost: f64,
}

/// The rows of a contact: its block, and its lane there.
type Row<'r> = (&'r Block, &'r Cold, usize);

/// Impacts that go on, and those that ended.
#[derive(Clone, Debug, Default)]
pub(crate) struct Impacts {
    /// The caller asks for them.
    asked: bool,
    runs: Vec<Run>,
    /// Where the run of each contact is, if it has one: by number.
    of_contact: Vec<u32>,
    ended: Vec<Impact>,
    /// What impacts that ended took beside the heat of friction, in J.
    pub(crate) lost: f64,
    /// Scratch.
    new: Vec<ContactIx>,
}

impl Impacts {
    /// Points that bounce in this sub-step or the next begin runs.
    pub(crate) fn note_arrivals(&mut self, arrived: &[Arrival], graph: &Graph) {
        if self.asked {
            for arrival in arrived {
                self.meet(arrival.contact, [arrival.speed, arrival.met], graph);
            }
        }
    }

    /// Contacts that push, and did not when this was last called, begin runs if a point of theirs that was apart closed faster
    /// than what counts as rest. To be called before the bodies move, and once more when they `moved`: relaxing stops them
    /// short of what they would meet in the next sub-step.
    pub(crate) fn note_hits(&mut self, law: &Law, bodies: &Bodies, graph: &mut Graph, moved: bool) {
        if !self.asked {
            return;
        }
        let mut new = core::mem::take(&mut self.new);
        new.clear();
        graph.note_hard_pushing();
        for colour in graph.awake() {
            begins(colour, &mut new);
        }
        for &id in &new {
            let (block, _, lane) = graph.lane(id);
            if let Some(arrives) = arrival(law, bodies, block, lane, moved) {
                self.meet(id, arrives, graph);
            }
        }
        self.new = new;
    }

    fn meet(&mut self, id: ContactIx, [speed, met]: [f64; 2], graph: &Graph) {
        if let Some(run) = self.run_of(id, graph) {
            // Its other point, or both ways found it.
            run.speed = run.speed.max(speed);
            if run.age == 0 {
                run.met = run.met.min(met);
            }
        } else {
            let (at, contact) = (id.at(), graph.contacts[id]);
            if self.of_contact.len() <= at {
                self.of_contact.resize(at + 1, 0);
            }
            self.of_contact[at] = number(self.runs.len());
            self.runs.push(Run {
                contact: id,
                slots: contact.bodies,
                pieces: contact.pieces,
                speed,
                met,
                age: 0,
                impulse: Vec2::ZERO,
                weight: 0.0,
                normal: Vec2::ZERO,
                moment: Vec2::ZERO,
                came: None,
                did: [0.0; 3],
                heat: 0.0,
                lost: 0.0,
            });
        }
    }

    /// The run of a contact. Numbers are given anew, and may be those of contacts of other pieces.
    fn run_of(&mut self, id: ContactIx, graph: &Graph) -> Option<&mut Run> {
        let at = *self.of_contact.get(id.at())?;
        let run = self.runs.get_mut(at as usize);
        let pieces = graph.contacts[id].pieces;
        run.filter(|run| run.contact == id && run.pieces == pieces)
    }

    /// Adds what the rows did in this sub-step of what will bounce, which clears them.
    pub(crate) fn add_rows(
        &mut self,
        law: &Law,
        arrived: &[Arrival],
        bodies: &Bodies,
        graph: &Graph,
    ) {
        for arrival in arrived {
            if let Some(run) = self.run_of(arrival.contact, graph) {
                run.add_rows(law, bodies, graph.lane(arrival.contact));
            }
        }
    }

    /// Adds what bounces did, and what the rows of all others did, and ends the runs of what closes no more.
    pub(crate) fn end(
        &mut self,
        law: &Law,
        arrived: &[Arrival],
        bodies: &Bodies,
        graph: &Graph,
        pieces: &Pieces,
    ) {
        if self.runs.is_empty() {
            return;
        }
        for arrival in arrived {
            if let Some(run) = self.run_of(arrival.contact, graph) {
                run.add(bodies, graph.lane(arrival.contact), arrival.impulses);
                run.heat += arrival.heat;
            }
        }
        let least = REST * law.h * law.gravity;
        let mut over = Vec::new();
        let (of_contact, mut stay) = (&mut self.of_contact, 0);
        self.runs.retain_mut(|run| {
            let there = graph.has(run.contact, run.pieces);
            let row = there.then(|| graph.lane(run.contact));
            let closes = row.is_some_and(|row| {
                run.add_rows(law, bodies, row);
                let (block, _, lane) = row;
                let gaps = block.gaps(lane, &bodies.lines);
                let v = run.lose(least, bodies, row, gaps);
                (0..block.points(lane)).any(|k| v[k] < -least && gaps[k] + 2.0 * v[k] * law.h < 0.0)
            });
            run.age += 1;
            let goes_on = closes && run.age < LONGEST;
            if goes_on {
                of_contact[run.contact.at()] = stay;
                stay += 1;
            } else {
                over.push(*run);
            }
            goes_on
        });
        self.tell(law, bodies, pieces, over);
    }

    /// Pieces of two shapes that end in one sub-step are one impact.
    fn tell(&mut self, law: &Law, bodies: &Bodies, pieces: &Pieces, mut over: Vec<Run>) {
        let pair = |run: &Run| (run.slots, pieces.tags(run.pieces));
        over.retain(|run| run.weight > 0.0);
        over.sort_unstable_by_key(|run| (pair(run), run.pieces));
        for runs in over.chunk_by(|one, other| pair(one) == pair(other)) {
            let sum = |of: fn(&Run) -> Vec2| runs.iter().map(of).sum::<Vec2>();
            let weight: f64 = runs.iter().map(|run| run.weight).sum();
            let normal = sum(|run| run.normal);
            let (normal, impulse) = (normal / normal.length(), sum(|run| run.impulse));
            // None gives energy: what it seems to is an error.
            self.lost += runs.iter().map(|run| run.lost).sum::<f64>().max(0.0);
            let since = |run: &Run| f64::from(run.age) * law.h - run.met;
            self.ended.push(Impact {
                bodies: runs[0].slots.map(|slot| bodies.id(slot)),
                tags: pieces.tags(runs[0].pieces),
                place: sum(|run| run.moment) / weight,
                normal,
                normal_impulse: impulse.dot(normal),
                tangential_impulse: impulse.dot(perp(normal)),
                speed: runs.iter().map(|run| run.speed).fold(0.0, f64::max),
                since: runs.iter().map(since).fold(0.0, f64::max),
            });
        }
    }

    /// Forgets the impacts of a body that is taken out.
    pub(crate) fn forget(&mut self, slot: BodyIx) {
        self.runs.retain(|run| !run.slots.contains(&slot));
        for (run, k) in self.runs.iter().zip(0..) {
            self.of_contact[run.contact.at()] = k;
        }
        self.ended
            .retain(|impact| impact.bodies.iter().all(|body| body.slot != slot));
    }
}

impl Run {
    /// Adds what its rows did in this sub-step, and the heat that was told of them.
    fn add_rows(&mut self, law: &Law, bodies: &Bodies, row: Row<'_>) {
        if self.came.is_none() {
            self.come(law, bodies, row);
        }
        let (block, cold, lane) = row;
        self.heat += block.heat(lane, &bodies.lines, cold.belt[lane]);
        self.add(bodies, row, block.impulses(lane));
    }

    /// Notes with what speeds it came to its first sub-step.
    fn come(&mut self, law: &Law, bodies: &Bodies, (block, cold, lane): Row<'_>) {
        let [a, b] = block
            .lines(lane)
            .map(|line| bodies.velocity_before(line, law.h));
        let (gap, pull) = (self.speed * self.met, block.pull(lane, bodies));
        let [first, second] = block.along(lane, a, b).map(|v| at_surface(v, gap, pull));
        let slip = block.across(lane, a, b) - cold.belt[lane];
        self.came = Some([first, second, slip]);
    }

    /// Adds what this sub-step's impulses took, but for heat of friction that is told elsewhere: impulse × mean of the speeds before
    /// and after is the work of a row, whatever the others do. The speeds with which its points open now.
    fn lose(
        &mut self,
        rest: f64,
        bodies: &Bodies,
        (block, cold, lane): Row<'_>,
        gaps: [f64; 2],
    ) -> [f64; 3] {
        let [first, second] = block.opening(lane, &bodies.lines);
        let slip = block.slip(lane, &bodies.lines) - cold.belt[lane];
        let left = [first, second, slip];
        let came = self.came.replace(left).unwrap_or(left);
        let mut gone = left;
        for (v, gap) in gone.iter_mut().zip(gaps) {
            if *v > rest {
                *v = at_surface(*v, gap, block.pull(lane, bodies));
            }
        }
        for ((j, came), gone) in self.did.iter().zip(came).zip(gone) {
            self.lost -= 0.5 * j * (came + gone);
        }
        self.lost -= self.heat;
        (self.did, self.heat) = ([0.0; 3], 0.0);
        left
    }

    /// Adds normal impulses of both points, and that of friction.
    fn add(&mut self, bodies: &Bodies, (block, _, lane): Row<'_>, j: [f64; 3]) {
        let normal = block.normal(lane);
        let sum = j[0] + j[1];
        // Midway between the surfaces: from the centre of a body that has a line of its own.
        let [a, b] = block.lines(lane);
        let [gap, second] = block.gaps(lane, &bodies.lines);
        let half = 0.5 * gap.min(second).max(0.0);
        let (line, height, arm) = if block.a[lane] == LineIx::GROUND {
            (b, block.bt[lane] - half, block.b1[lane])
        } else {
            (a, block.at[lane] + half, block.a1[lane])
        };
        let centre = bodies.centre_at(line);
        let first = centre + normal * height - perp(normal) * arm;
        self.weight += sum;
        self.normal += normal * sum;
        self.impulse += normal * sum + perp(normal) * j[2];
        self.moment += first * sum - perp(normal) * (block.l[lane] * j[1]);
        for (sum, j) in self.did.iter_mut().zip(j) {
            *sum += j;
        }
    }
}

/// The speed at the surface of a point that comes or goes at `v` where the gap is `gap`, if `pull` closes it.
fn at_surface(v: f64, gap: f64, pull: f64) -> f64 {
    if gap > 0.0 {
        (v * v - 2.0 * pull.min(0.0) * gap).sqrt().copysign(v)
    } else {
        v
    }
}

/// Adds numbers of contacts that push and did not when this was last asked.
fn begins(colour: &mut Colour, new: &mut Vec<ContactIx>) {
    let pushed = colour.pushes.iter().zip(&mut colour.pushed);
    for ((now, pushed), cold) in pushed.zip(&colour.cold) {
        let begins = now & !*pushed;
        *pushed = *now;
        new.extend(lanes(begins).map(|lane| cold.contact[lane]));
    }
}

/// The speed with which the fastest point that pushes and was apart arrives, in m/s, and when, in s from the beginning of the
/// sub-step on; `None` if none does so faster than what counts as rest.
fn arrival(
    law: &Law,
    bodies: &Bodies,
    block: &Block,
    lane: usize,
    moved: bool,
) -> Option<[f64; 2]> {
    let ends = block.lines(lane);
    let mut gaps = block.gaps(lane, &bodies.lines);
    let (points, j) = (block.points(lane), block.impulses(lane));
    let is_apart = |gaps: [f64; 2], point: &usize| j[*point] > 0.0 && gaps[*point] > 0.0;
    if !moved && !(0..points).any(|point| is_apart(gaps, &point)) {
        return None;
    }
    // Before contacts acted.
    let [a, b] = ends.map(|line| (bodies.start[line].v(), bodies.start[line].w()));
    let opening = block.along(lane, a, b);
    if moved {
        // No row held it: it went as it came.
        gaps = [0, 1].map(|point| gaps[point] - opening[point] * law.h);
    }
    let pull = block.pull(lane, bodies).min(0.0);
    let rest = REST * law.h * law.gravity;
    let mut first: Option<[f64; 2]> = None;
    for point in (0..points).filter(|point| is_apart(gaps, point)) {
        let before = opening[point] - pull * law.h;
        let square = before * before - 2.0 * pull * gaps[point];
        if before < 0.0 && square > rest * rest {
            let speed = square.sqrt();
            if first.is_none_or(|[known, _]| speed > known) {
                first = Some([speed, gaps[point] / speed]);
            }
        }
    }
    first
}

impl Engine {
    /// Notes impacts from now on, for [`Self::impacts`]; or ceases to.
    pub fn note_impacts(&mut self, asked: bool) {
        self.impacts = Impacts {
            asked,
            lost: self.impacts.lost,
            ..Impacts::default()
        };
    }

    /// Adds the impacts that ended since this was last asked, in order of time up to a sub-step, then of their bodies' slots.
    pub fn impacts(&mut self, found: &mut Vec<Impact>) {
        found.append(&mut self.impacts.ended);
    }
}
