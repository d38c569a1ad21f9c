//! Which outputs count, how far off they may be, and whether an answer passes.
//!
//! The bounds are those of the reference's own judge; a category that is not listed here fails.

use carom_math::Sum;
use serde_json::Value;

use super::book::{Answer, Case, number, point};
use super::decimal::Decimal;

/// What becomes of an answer.
#[derive(Debug)]
pub(super) struct Verdict {
    /// Largest error over its bound.
    pub(super) worst: f64,
    /// Why it fails; empty if it passes.
    pub(super) faults: Vec<String>,
}

/// Judges one answer.
pub(super) fn judge(category: &str, case: &Case, answer: &Answer) -> Verdict {
    let mut verdict = Verdict {
        worst: 0.0,
        faults: Vec::new(),
    };
    let Some(required) = required(category) else {
        let why = answer.error.clone();
        verdict
            .faults
            .push(why.unwrap_or_else(|| format!("{category} has no judge")));
        return verdict;
    };
    let Some(outputs) = &answer.outputs else {
        let why = answer
            .error
            .clone()
            .unwrap_or_else(|| "no answer".to_owned());
        verdict.faults.push(why);
        return verdict;
    };
    for key in &required {
        let Some(entry) = case.outputs.get(key) else {
            continue;
        };
        match outputs.get(key) {
            None | Some(Value::Null) => verdict.faults.push(format!("{key} is missing")),
            Some(got) => verdict.hear(category, case, key, entry, got),
        }
    }
    verdict
}

impl Verdict {
    fn hear(&mut self, category: &str, case: &Case, key: &str, entry: &Value, got: &Value) {
        let Some(want) = exact(entry) else {
            self.faults
                .push(format!("{key} of the reference cannot be read"));
            return;
        };
        let mut have = Vec::new();
        flatten(got, &mut |item| have.push(item.as_f64()));
        if have.len() != want.len() {
            let (found, expected) = (have.len(), want.len());
            self.faults
                .push(format!("{key} has {found} numbers, not {expected}"));
            return;
        }
        let bounds = match category {
            "mass_properties" => mass_bounds(case, key, &want),
            _ => impact_bounds(case, key, &want),
        };
        for ((got, want), bound) in have.into_iter().zip(want).zip(bounds) {
            let Some(got) = got.filter(|got| got.is_finite()) else {
                self.faults.push(format!("{key} is no finite number"));
                return;
            };
            let error = want.error_of(got);
            let ratio = if error > 0.0 { error / bound } else { 0.0 };
            self.worst = self.worst.max(ratio);
            if ratio > 1.0 {
                self.faults
                    .push(format!("{key} is off by {error:.2e}, allowed {bound:.2e}"));
                return;
            }
        }
    }
}

/// The outputs that count, where the reference has them.
fn required(category: &str) -> Option<Vec<String>> {
    match category {
        "mass_properties" => {
            let keys = [
                "area",
                "centroid",
                "second_moment_polar",
                "mass_from_density",
                "inertia_from_density",
                "inertia_from_mass",
            ];
            Some(keys.map(str::to_owned).to_vec())
        }
        "impacts" => {
            let keys = ["jn", "jt", "velocity_a", "omega_a", "velocity_b", "omega_b"];
            let laws = ["newton", "poisson", "stronge"];
            let all = laws
                .iter()
                .flat_map(|law| keys.map(|key| format!("{law}.{key}")));
            Some(all.collect())
        }
        _ => None,
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
        let size = numbers(case, "bounding_radius")
            .first()
            .copied()
            .unwrap_or(1.0);
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
        let jn = numbers(case, &format!("{law}.jn"))
            .first()
            .copied()
            .unwrap_or(0.0);
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

/// The doubles of an output of the reference.
fn numbers(case: &Case, key: &str) -> Vec<f64> {
    let mut found = Vec::new();
    if let Some(entry) = case.outputs.get(key) {
        flatten(&entry["value"], &mut |item| found.extend(number(item)));
    }
    found
}

/// The numbers of an output with all their digits.
fn exact(entry: &Value) -> Option<Vec<Decimal>> {
    let source = entry.get("hp").or_else(|| entry.get("value"))?;
    let mut all = Some(Vec::new());
    flatten(source, &mut |item| {
        let text = match item {
            Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        match (Decimal::parse(&text), &mut all) {
            (Some(number), Some(list)) => list.push(number),
            _ => all = None,
        }
    });
    all
}

fn flatten(value: &Value, each: &mut dyn FnMut(&Value)) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| flatten(item, each)),
        Value::Object(items) => items.values().for_each(|item| flatten(item, each)),
        other => each(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn case() -> Case {
        serde_json::from_value(json!({
            "id": "square",
            "inputs": {"vertices": [["0", "0"], ["1", "0"], ["1", "1"], ["0", "1"]]},
            "outputs": {
                "area": {"value": "1.0", "hp": "1.0"},
                "centroid": {"value": ["0.5", "0.5"], "hp": ["0.5", "0.5"]},
                "bounding_radius": {"value": "0.7071067811865476"},
            },
        }))
        .unwrap()
    }

    fn answer(outputs: Value) -> Answer {
        Answer {
            id: "square".to_owned(),
            seconds: None,
            outputs: outputs.as_object().cloned(),
            error: None,
        }
    }

    #[test]
    fn a_right_answer_passes_and_a_wrong_one_says_why() {
        let right = answer(json!({"area": 1.0, "centroid": [0.5, 0.5]}));
        assert_eq!(judge("mass_properties", &case(), &right).faults, [""; 0]);

        let wrong = answer(json!({"area": 1.0 + 1e-12, "centroid": [0.5]}));
        let faults = judge("mass_properties", &case(), &wrong).faults;
        assert_eq!(faults[0], "area is off by 1.00e-12, allowed 2.00e-13");
        assert_eq!(faults[1], "centroid has 1 numbers, not 2");
    }

    #[test]
    fn a_missing_or_unfinished_number_fails() {
        let empty = answer(json!({"area": null, "centroid": [0.5, null]}));
        let faults = judge("mass_properties", &case(), &empty).faults;
        assert_eq!(faults, ["area is missing", "centroid is no finite number"]);
    }

    #[test]
    fn a_category_of_the_future_fails() {
        let right = answer(json!({"area": 1.0}));
        assert_eq!(
            judge("tides", &case(), &right).faults,
            ["tides has no judge"]
        );
    }
}
