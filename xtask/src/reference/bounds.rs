//! How far off each output of a category may be: the bounds of the reference's own check.

use carom_math::{Sum, Vec2, vec2};
use serde_json::Value;

use super::book::{Case, flatten, number, number_at, point, point_at, points_at};
use super::decimal::Decimal;
use super::horizon;

/// Allowed absolute error of each number of one output.
///
/// # Errors
/// The input that cannot be read, or a category without bounds.
pub(super) fn bounds(
    category: &str,
    case: &Case,
    key: &str,
    want: &[Decimal],
) -> Result<Vec<f64>, String> {
    match category {
        "mass_properties" => Ok(mass_bounds(case, key, want)),
        "impacts" | "simultaneous" => Ok(impact_bounds(case, key, want)),
        "time_of_impact" => Ok(vec![first_contact_bound(case, key)?; want.len()]),
        _ => horizon::bounds(category, case, key, want)
            .ok_or_else(|| format!("{category} has no bounds")),
    }
}

/// 2e-13 relative, or 8 ulp times the cancellation of the cross products; the centroid of the bounding radius.
fn mass_bounds(case: &Case, key: &str, want: &[Decimal]) -> Vec<f64> {
    let mut slack = 2e-13;
    if let Some(list) = case.inputs["vertices"].as_array() {
        let vertices: Vec<(f64, f64)> = list.iter().filter_map(point).map(|p| (p.x, p.y)).collect();
        slack = f64::max(slack, 8.0 * f64::EPSILON * cancellation(&vertices));
    }
    let magnitude = |w: &Decimal| w.nearest().abs();
    if key == "centroid" {
        let size = first_number(case, "bounding_radius").unwrap_or(1.0);
        let bound = |w| slack * size + 2.0 * f64::EPSILON * magnitude(w);
        return want.iter().map(bound).collect();
    }
    want.iter().map(|w| slack * magnitude(w)).collect()
}

/// How much the cross products cancel in the area, about the worst of up to sixteen corners.
fn cancellation(vertices: &[(f64, f64)]) -> f64 {
    let Some(&first) = vertices.first() else {
        return f64::INFINITY;
    };
    let sum_about = |corner: (f64, f64), term: fn(f64) -> f64| {
        let mut sum = Sum::ZERO;
        for (k, &(x0, y0)) in vertices.iter().enumerate() {
            let (x1, y1) = vertices[(k + 1) % vertices.len()];
            let (x0, y0) = (x0 - corner.0, y0 - corner.1);
            let (x1, y1) = (x1 - corner.0, y1 - corner.1);
            sum.add(term(x0 * y1));
            sum.add(term(-x1 * y0));
        }
        sum.value()
    };
    let area = sum_about(first, |t| t).abs() / 2.0;
    let stride = (vertices.len() / 16).max(1);
    let corners = vertices.iter().step_by(stride);
    let total = corners.map(|&c| sum_about(c, f64::abs)).fold(0.0, f64::max);
    if area > 0.0 {
        total / 2.0 / area
    } else {
        f64::INFINITY
    }
}

/// 1e-12 of the largest speed, or of the normal impulse.
fn impact_bounds(case: &Case, key: &str, want: &[Decimal]) -> Vec<f64> {
    if let Some((law, "jn" | "jt")) = key.split_once('.') {
        let jn = first_number(case, &format!("{law}.jn")).unwrap_or(0.0);
        return vec![1e-12 * jn.abs().max(1e-300); want.len()];
    }
    let speeds = case
        .outputs
        .keys()
        .filter(|name| name.contains("velocit") || name.contains("omega"));
    let largest = speeds
        .flat_map(|name| numbers(case, name))
        .fold(1e-300, |largest, v| v.abs().max(largest));
    vec![1e-12 * largest; want.len()]
}

/// Rounding of relative positions, travel and shapes, over the gap rate; what that time does to point and normal at
/// the true speeds.
fn first_contact_bound(case: &Case, key: &str) -> Result<f64, String> {
    const ULP: f64 = f64::EPSILON;
    let time = first_number(case, "time_of_impact").unwrap_or(0.0);
    let slowness = first_number(case, "condition_time_per_metre").unwrap_or(0.0);
    let a = Mover::read(&case.inputs["body_a"])?;
    let b = Mover::read(&case.inputs["body_b"])?;
    let (turn_a, turn_b) = (a.turn(time), b.turn(time));
    let velocity = b.velocity - a.velocity;
    let acceleration = b.acceleration - a.acceleration;
    let reach = (b.position - a.position).length()
        + velocity.length() * time
        + acceleration.length() * time * time / 2.0
        + a.radius * (1.0 + turn_a)
        + b.radius * (1.0 + turn_b);
    let slip = 32.0 * ULP * time + slowness * 16.0 * ULP * reach;
    if key == "time_of_impact" {
        return Ok(slip);
    }
    let turning = a.spin.abs() * a.radius + b.spin.abs() * b.radius;
    let relative = (velocity + acceleration * time).length() + turning;
    if key == "normal_a_to_b" {
        let mut swing = a.spin.abs() + b.spin.abs();
        let mut slack = 1e-13 + 32.0 * ULP * (turn_a + turn_b);
        // The normal of a disc turns with its centre.
        let discs = [&a, &b].into_iter().filter(|mover| mover.is_disc);
        let radii: f64 = discs.map(|disc| disc.radius).sum();
        if radii > 0.0 {
            swing += relative / radii;
            slack += 16.0 * ULP * reach / radii;
        }
        return Ok(slack + swing * slip);
    }
    let speed = turning + relative + a.speed_at(time) + b.speed_at(time);
    let farthest = f64::max(a.farthest(time), b.farthest(time));
    Ok(2.0 * ULP * farthest + 32.0 * ULP * reach + speed * slip)
}

/// What a body's input says of its motion.
struct Mover {
    is_disc: bool,
    /// Largest distance of the shape from its origin, in m.
    radius: f64,
    position: Vec2,
    velocity: Vec2,
    acceleration: Vec2,
    angle: f64,
    spin: f64,
}

impl Mover {
    fn read(body: &Value) -> Result<Self, String> {
        let shape = &body["shape"];
        let is_disc = shape.get("circle").is_some();
        let radius = if is_disc {
            number_at(shape, "circle")?
        } else {
            let corners = points_at(shape, "polygon")?;
            corners.iter().map(|p| p.length()).fold(0.0, f64::max)
        };
        Ok(Self {
            is_disc,
            radius,
            position: point_at(body, "position")?,
            velocity: point_at(body, "velocity")?,
            acceleration: point_at(body, "acceleration")?,
            angle: number_at(body, "angle")?,
            spin: number_at(body, "angular_velocity")?,
        })
    }

    fn turn(&self, time: f64) -> f64 {
        self.angle.abs() + self.spin.abs() * time
    }

    fn speed_at(&self, time: f64) -> f64 {
        (self.velocity + self.acceleration * time).length()
    }

    fn farthest(&self, time: f64) -> f64 {
        let travel = self.velocity.length() * time;
        self.position.length() + travel + self.acceleration.length() * time * time / 2.0
    }
}

/// How far `got` lies from the stretch on which two edges land flat, in m; `ends` are its four coordinates.
///
/// With `s` the part of the way from end p to end q, the offset from the stretch is
/// `(1 − s) (got − p) + s (got − q)`, which keeps the digits of the ends.
pub(super) fn off_the_stretch(ends: &[Decimal], got: Vec2) -> Option<f64> {
    let [px, py, qx, qy] = ends else { return None };
    let from_p = vec2(px.offset_of(got.x), py.offset_of(got.y));
    let from_q = vec2(qx.offset_of(got.x), qy.offset_of(got.y));
    let along = from_p - from_q;
    let s = (from_p.dot(along) / along.length_squared()).clamp(0.0, 1.0);
    Some((from_p * (1.0 - s) + from_q * s).length())
}

/// The doubles of an output of the reference.
pub(super) fn numbers(case: &Case, key: &str) -> Vec<f64> {
    let mut found = Vec::new();
    if let Some(entry) = case.outputs.get(key) {
        flatten(&entry["value"], &mut |item| found.extend(number(item)));
    }
    found
}

/// The first of them.
pub(super) fn first_number(case: &Case, key: &str) -> Option<f64> {
    numbers(case, key).first().copied()
}
