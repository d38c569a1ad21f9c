//! Bounds of worlds that are followed impact by impact: checked as far as doubles can follow the motion.

use super::book::Case;
use super::bounds::{first_number, numbers};
use super::decimal::Decimal;

/// Allowed absolute error of each number of one output; infinite where it is not checked.
///
/// `None`: the category has no such bounds.
pub(super) fn bounds(category: &str, case: &Case, key: &str, want: &[Decimal]) -> Option<Vec<f64>> {
    let scale = largest(want);
    let all = |bound: f64| Some(vec![bound; want.len()]);
    match category {
        "flight_bounce" if key == "zeno_time" => all(1e-12 * scale),
        "flight_bounce" => {
            let angle = first_number(case, "angle_unwrapped").unwrap_or(0.0).abs();
            all(1e-13 * scale.max(1e-300) + 8.0 * f64::EPSILON * angle)
        }
        "friction" => all((1e-12 * scale).max(1e-14)),
        "chains" if key == "collapse_time" => {
            let lost = losses(case, key).first().copied().unwrap_or(0.0);
            all((1e-9 * scale.max(1.0)).max(10.0 * lost))
        }
        "chains" => all(1e-12 * scale.max(1.0)),
        "galperin" => {
            let peak = first_number(case, "speed_bound_small").unwrap_or(0.0);
            all(match key {
                "final_velocity_big" => 1e-15 * (peak + 2.0),
                "final_velocity_small" => 1e-15 * (peak * peak.sqrt() + 1.0),
                _ => 4e-16 * scale * scale * peak * peak.sqrt(),
            })
        }
        "billiards" if key == "position" => {
            // Each of the many hits may round the time.
            let [x, y] = numbers_of_input(case, "velocity")[..] else {
                return None;
            };
            let time = numbers_of_input(case, "time").first().copied()?;
            let path = (x * x + y * y).sqrt() * time;
            let hits = first_number(case, "wall_hits").unwrap_or(0.0);
            all((f64::EPSILON / 4.0 * path * hits).max(1e-9))
        }
        "billiards" if key == "centres" => all(1e-9),
        "billiards" => all(1e-12 * scale.max(1.0)),
        "disc_gas" => Some(gas(case, key, want)),
        "scenes" => Some(scene(case, key, want)),
        _ => None,
    }
}

/// How many impacts of a scene doubles can follow, in this order.
pub(super) fn followed(case: &Case) -> usize {
    let times = numbers(case, "impact_times");
    let last = times.iter().fold(0.0, |last: f64, t| last.max(t.abs()));
    let allowed = from_losses(case, "impact_times", times.len(), last, 1e-3 * last);
    for (k, bound) in allowed.iter().enumerate() {
        let neighbours = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
        let gaps = neighbours.filter_map(|j| times.get(j).map(|t| (times[k] - t).abs()));
        let near = gaps.fold(f64::INFINITY, f64::min);
        if bound.is_infinite() || *bound > near / 2.0 {
            return k;
        }
    }
    times.len()
}

fn gas(case: &Case, key: &str, want: &[Decimal]) -> Vec<f64> {
    if key.ends_with("before_sample") {
        let exact_there = |k: usize| {
            let places = format!("positions_{k}");
            let scale = numbers(case, &places)
                .iter()
                .fold(0.0, |s: f64, x| s.max(x.abs()));
            let bounds = from_losses(case, &places, 1, scale, 1e-3);
            bounds.first().is_some_and(|bound| bound.is_finite())
        };
        let bound = |k| if exact_there(k) { 0.0 } else { f64::INFINITY };
        return (0..want.len()).map(bound).collect();
    }
    let scale = largest(want);
    if key == "energy" && is_input(case, "restitution", 1.0) {
        return vec![1e-12 * scale; want.len()];
    }
    from_losses(case, key, want.len(), scale, 1e-3)
}

fn scene(case: &Case, key: &str, want: &[Decimal]) -> Vec<f64> {
    let of = |key: &str| {
        numbers(case, key)
            .iter()
            .fold(0.0, |s: f64, x| s.max(x.abs()))
    };
    let mut scale = largest(want);
    if key == "energy" && is_input(case, "restitution", 1.0) && is_input(case, "friction", 0.0) {
        return vec![1e-11 * scale.max(1e-300)];
    }
    if key == "tangential_impulses" {
        scale = of("normal_impulses");
    }
    if key.starts_with("final_velocities") || key.starts_with("final_angular") {
        scale = of("final_velocities").max(of("final_angular_velocities"));
    }
    if key == "final_angles" {
        scale = scale.max(1.0);
    }
    let allowed = from_losses(case, key, want.len(), scale, 1e-3 * scale);
    let (seen, count) = (followed(case), numbers(case, "impact_times").len());
    if key.starts_with("final") || key == "energy" {
        return if seen == count {
            allowed
        } else {
            vec![f64::INFINITY; want.len()]
        };
    }
    let each = (want.len() / count.max(1)).max(1);
    let within = |(k, bound): (usize, f64)| {
        if k / each < seen {
            bound
        } else {
            f64::INFINITY
        }
    };
    allowed.into_iter().enumerate().map(within).collect()
}

/// 100 times what plain double runs lost, at least 1e-13 of the scale; infinite above `limit`.
fn from_losses(case: &Case, key: &str, count: usize, scale: f64, limit: f64) -> Vec<f64> {
    let lost = losses(case, key);
    if lost.is_empty() {
        return vec![f64::INFINITY; count];
    }
    // One loss may stand for several numbers.
    let each = (count / lost.len()).max(1);
    let bound = |k: usize| {
        let bound = (100.0 * lost[(k / each).min(lost.len() - 1)]).max(1e-13 * scale);
        if bound <= limit { bound } else { f64::INFINITY }
    };
    (0..count).map(bound).collect()
}

/// What plain double-precision event loops lost.
fn losses(case: &Case, key: &str) -> Vec<f64> {
    let mut found = Vec::new();
    if let Some(entry) = case.outputs.get(key) {
        super::book::flatten(&entry["double_error"], &mut |item| {
            found.extend(super::book::number(item));
        });
    }
    found
}

fn numbers_of_input(case: &Case, key: &str) -> Vec<f64> {
    let mut found = Vec::new();
    super::book::flatten(&case.inputs[key], &mut |item| {
        found.extend(super::book::number(item));
    });
    found
}

fn is_input(case: &Case, key: &str, value: f64) -> bool {
    numbers_of_input(case, key) == [value]
}

fn largest(want: &[Decimal]) -> f64 {
    want.iter().fold(0.0, |s: f64, w| s.max(w.nearest().abs()))
}
