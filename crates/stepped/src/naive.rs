//! The slow twin of the sub-steps: rows in a list, points in space, impulses applied one by one.
//!
//! It shares no code with the sweeps: velocities of points are `v + ω × r`, the warm start applies the impulses of all rows
//! anew in every sub-step, and the 2 × 2 complementarity problem is solved by trying its cases.

use carom_math::{Vec2, cross, cross_scalar, perp};

use crate::{ContactIx, Engine};

/// A body as the twin sees it.
#[derive(Clone, Copy)]
struct Body {
    v: Vec2,
    w: f64,
    /// Displacement and turn since the base pose.
    d: Vec2,
    turn: f64,
    inverse_mass: f64,
    inverse_inertia: f64,
    pull: Vec2,
}

/// A contact: normal, and for each point its arms, gap at the base poses and impulse.
struct Row {
    id: ContactIx,
    ends: [usize; 2],
    normal: Vec2,
    points: Vec<([Vec2; 2], f64, f64)>,
    /// Where friction acts.
    middle: [Vec2; 2],
    friction: f64,
    jt: f64,
}

/// Bodies and rows before the sub-steps of a tick.
pub(crate) struct State {
    bodies: Vec<Body>,
    rows: Vec<Row>,
}

/// What a tick came to.
pub(crate) struct After {
    pub(crate) velocities: Vec<(Vec2, f64)>,
    pub(crate) impulses: Vec<(ContactIx, [f64; 3])>,
}

impl State {
    pub(crate) fn of(engine: &Engine) -> Self {
        let lines = engine.bodies.lines.iter().zip(&engine.bodies.pull);
        let bodies = lines.map(|(line, pull)| Body {
            v: line.v(),
            w: line.w(),
            d: line.d(),
            turn: line.turn(),
            inverse_mass: line.inverse_mass(),
            inverse_inertia: line.inverse_inertia(),
            pull: pull.v(),
        });
        Self {
            bodies: bodies.collect(),
            rows: engine.graph.ids().map(|id| Row::of(engine, id)).collect(),
        }
    }

    /// Runs the sub-steps of a tick.
    pub(crate) fn substeps(self, engine: &Engine) -> After {
        let Self {
            mut bodies,
            mut rows,
        } = self;
        let law = Law::new(engine);
        for _ in 0..engine.settings.substeps {
            let before = bodies.clone();
            for body in &mut bodies {
                body.v += body.pull * law.h;
            }
            for row in &rows {
                row.act(&mut bodies);
            }
            for row in &mut rows {
                row.solve(&mut bodies, &law, true);
            }
            for body in &mut bodies {
                body.d += body.v * law.h;
                body.turn += body.w * law.h;
            }
            for row in &mut rows {
                row.solve(&mut bodies, &law, false);
            }
            for (body, before) in bodies.iter_mut().zip(before) {
                let change = (body.v - before.v, body.w - before.w);
                if change.0.length() <= 4.0 * body.pull.length() * law.h {
                    body.d -= change.0 * (0.5 * law.h);
                    body.turn -= change.1 * (0.5 * law.h);
                }
            }
        }
        let impulses = rows.iter().map(|row| {
            let j = |k: usize| row.points.get(k).map_or(0.0, |point| point.2);
            (row.id, [j(0), j(1), row.jt])
        });
        After {
            velocities: bodies.iter().map(|body| (body.v, body.w)).collect(),
            impulses: impulses.collect(),
        }
    }
}

/// Constants of the soft law, from its definition.
struct Law {
    h: f64,
    push_out: f64,
    over_relaxation: f64,
    soft: [(f64, f64); 2],
}

impl Law {
    fn new(engine: &Engine) -> Self {
        let settings = &engine.settings;
        let h = settings.tick / f64::from(settings.substeps);
        let softness = &settings.softness;
        let spring = |f: f64| {
            let omega = core::f64::consts::TAU * f;
            let c = 2.0 * softness.damping_ratio + h * omega;
            (omega / c, softness.compliance / (h * omega * c))
        };
        let f = softness.frequency.min(0.125 / h);
        Self {
            h,
            push_out: softness.push_out,
            over_relaxation: softness.over_relaxation,
            soft: [spring(f), spring(2.0 * f)],
        }
    }
}

impl Row {
    /// Points in space from arms and gaps of the engine's block.
    fn of(engine: &Engine, id: ContactIx) -> Self {
        let (block, _, lane) = engine.graph.lane(id);
        let n = Vec2::new(block.nx[lane], block.ny[lane]);
        // r · n = a_t, r × n = a: so r = n a_t − t a.
        let arm = |tangent: f64, arm: f64| n * tangent - perp(n) * arm;
        let (at, bt) = (block.at[lane], block.bt[lane]);
        let (a, b, l) = (block.a1[lane], block.b1[lane], block.l[lane]);
        let [j1, j2, jt] = block.impulses(lane);
        let mut points = vec![([arm(at, a), arm(bt, b)], block.s1[lane], j1)];
        if block.s2[lane] < crate::rows::OPEN {
            points.push(([arm(at, a + l), arm(bt, b + l)], block.s2[lane], j2));
        }
        Self {
            id,
            ends: [block.a[lane].at(), block.b[lane].at()],
            normal: n,
            middle: [n * at, n * bt],
            friction: block.mu[lane],
            jt,
            points,
        }
    }

    /// Applies all its impulses.
    fn act(&self, bodies: &mut [Body]) {
        for (arms, _, j) in &self.points {
            push(bodies, self.ends, *arms, self.normal * *j);
        }
        push(bodies, self.ends, self.middle, perp(self.normal) * self.jt);
    }

    fn solve(&mut self, bodies: &mut [Body], law: &Law, bias: bool) {
        let [a, b] = self.ends.map(|end| bodies[end]);
        let n = self.normal;
        let ground = a.inverse_mass == 0.0 || b.inverse_mass == 0.0;
        let (rate, gamma) = if bias {
            law.soft[usize::from(ground)]
        } else {
            (0.0, 0.0)
        };
        let mut j: Vec<f64> = self.points.iter().map(|point| point.2).collect();
        let mut wanted = Vec::new();
        let mut matrix = vec![vec![0.0; j.len()]; j.len()];
        for (i, (arms, gap, _)) in self.points.iter().enumerate() {
            for (k, (other, ..)) in self.points.iter().enumerate() {
                matrix[i][k] = a.inverse_mass
                    + b.inverse_mass
                    + a.inverse_inertia * cross(arms[0], n) * cross(other[0], n)
                    + b.inverse_inertia * cross(arms[1], n) * cross(other[1], n);
            }
            let gap =
                gap + n.dot(b.d - a.d) + cross(arms[1], n) * b.turn - cross(arms[0], n) * a.turn;
            let v = n.dot(velocity(&b, arms[1]) - velocity(&a, arms[0]));
            let stiff = if gap > 0.0 { j[i] } else { 0.0 };
            let bias = if gap > 0.0 {
                gap / law.h
            } else {
                (rate * gap).max(-law.push_out)
            };
            wanted.push(v + bias - gamma * matrix[i][i] * stiff);
        }
        let right: Vec<f64> = (0..j.len())
            .map(|i| (0..j.len()).map(|k| matrix[i][k] * j[k]).sum::<f64>() - wanted[i])
            .collect();
        let soft = |i: usize| matrix[i][i] * (1.0 + gamma);
        let alone = |i: usize| (right[i] / soft(i)).max(0.0);
        let x = if j.len() == 1 {
            vec![alone(0)]
        } else {
            let off = matrix[0][1];
            let det = soft(0) * soft(1) - off * off;
            let both = [
                (soft(1) * right[0] - off * right[1]) / det,
                (soft(0) * right[1] - off * right[0]) / det,
            ];
            if both[0] >= 0.0 && both[1] >= 0.0 {
                both.to_vec()
            } else if off * alone(0) >= right[1] {
                vec![alone(0), 0.0]
            } else {
                vec![0.0, alone(1)]
            }
        };
        let carried: f64 = j.iter().sum();
        let wanted: f64 = x.iter().sum();
        let rests = carried > 0.0 && wanted <= 2.0 * carried && carried <= 2.0 * wanted;
        for (i, x) in x.iter().enumerate() {
            let old = j[i];
            let (arms, gap, _) = &self.points[i];
            let gap =
                gap + n.dot(b.d - a.d) + cross(arms[1], n) * b.turn - cross(arms[0], n) * a.turn;
            let omega = match (bias, rests && gap <= 0.0) {
                (false, _) => 1.0,
                (true, true) => law.over_relaxation,
                (true, false) => 1.0 + gamma,
            };
            j[i] = (old + omega * (x - old)).max(0.0);
            self.points[i].2 = j[i];
            push(bodies, self.ends, self.points[i].0, n * (j[i] - old));
        }
        if !bias {
            let [a, b] = self.ends.map(|end| bodies[end]);
            let t = perp(n);
            let k = a.inverse_mass
                + b.inverse_mass
                + a.inverse_inertia * cross(self.middle[0], t) * cross(self.middle[0], t)
                + b.inverse_inertia * cross(self.middle[1], t) * cross(self.middle[1], t);
            let slip = t.dot(velocity(&b, self.middle[1]) - velocity(&a, self.middle[0]));
            let limit = self.friction * j.iter().sum::<f64>();
            let new = (self.jt - slip / k).clamp(-limit, limit);
            push(bodies, self.ends, self.middle, t * (new - self.jt));
            self.jt = new;
        }
    }
}

/// Velocity of a point of a body.
fn velocity(body: &Body, arm: Vec2) -> Vec2 {
    body.v + cross_scalar(body.w, arm)
}

/// Applies an impulse to B, and its opposite to A.
fn push(bodies: &mut [Body], ends: [usize; 2], arms: [Vec2; 2], impulse: Vec2) {
    for ((end, arm), sign) in ends.into_iter().zip(arms).zip([-1.0, 1.0]) {
        let body = &mut bodies[end];
        body.v += impulse * (sign * body.inverse_mass);
        body.w += cross(arm, impulse) * (sign * body.inverse_inertia);
    }
}
