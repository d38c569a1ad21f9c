//! Which outputs count, how far off they may be, and whether an answer passes.
//!
//! The bounds are those of the reference's own check; a category that is not listed here fails.

use core::f64::consts::TAU;

use carom_math::vec2;
use serde_json::Value;

use super::book::{Answer, Case, flatten, number_at};
use super::bounds::{bounds, first_number, off_the_stretch};
use super::decimal::Decimal;
use super::horizon;

/// What becomes of an answer.
#[derive(Debug)]
pub(super) struct Verdict {
    /// Largest error over its bound.
    pub(super) worst: f64,
    /// Why it fails; empty if it passes.
    pub(super) faults: Vec<String>,
}

/// Checks one answer.
pub(super) fn check(category: &str, case: &Case, answer: &Answer) -> Verdict {
    let mut verdict = Verdict {
        worst: 0.0,
        faults: Vec::new(),
    };
    let Some(required) = required(category) else {
        let why = answer.error.clone();
        verdict
            .faults
            .push(why.unwrap_or_else(|| format!("{category} has no check")));
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
            None | Some(Value::Null) if is_beyond_horizon(category, case, key, entry) => {}
            None | Some(Value::Null) => verdict.faults.push(format!("{key} is missing")),
            Some(got) => verdict.hear(category, case, key, entry, got),
        }
    }
    verdict
}

impl Verdict {
    fn hear(&mut self, category: &str, case: &Case, key: &str, entry: &Value, got: &Value) {
        if let Value::Bool(want) = entry["value"] {
            if got.as_bool() != Some(want) {
                self.faults.push(format!("{key} is {got}, not {want}"));
            }
            return;
        }
        if let Value::String(want) = &entry["value"]
            && entry.get("hp").is_none()
        {
            let fault = if category == "friction" && is_critical(case) {
                None
            } else if category == "scenes" {
                wrong_word(want, got, horizon::followed(case))
            } else {
                (got.as_str() != Some(want)).then(|| format!("{got}, not {want}"))
            };
            self.faults
                .extend(fault.map(|fault| format!("{key}: {fault}")));
            return;
        }
        if entry["value"].is_u64() {
            if got != &entry["value"] {
                let want = &entry["value"];
                self.faults.push(format!("{key} is {got}, not {want}"));
            }
            return;
        }
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
        let bounds = match bounds(category, case, key, &want) {
            Ok(bounds) => bounds,
            Err(why) => return self.faults.push(why),
        };
        if key == "contact_point"
            && let Some(stretch) = case.outputs.get("contact_segment")
        {
            return self.hear_landing(case, stretch, &have, &bounds);
        }
        for ((got, want), bound) in have.into_iter().zip(want).zip(bounds) {
            if bound.is_infinite() {
                continue;
            }
            let Some(got) = got.filter(|got| got.is_finite()) else {
                self.faults.push(format!("{key} is no finite number"));
                return;
            };
            let mut error = want.offset_of(got).abs();
            if key == "final_angles" {
                // Whole turns do not count.
                error = (error - (error / TAU).round() * TAU).abs();
            }
            if !self.allows(error, bound) {
                self.faults
                    .push(format!("{key} is off by {error:.2e}, allowed {bound:.2e}"));
                return;
            }
        }
    }

    /// A flat landing: any point of the stretch of contact is right.
    fn hear_landing(&mut self, case: &Case, stretch: &Value, have: &[Option<f64>], bounds: &[f64]) {
        let ends = exact(stretch).unwrap_or_default();
        let error = match have {
            [Some(x), Some(y)] => off_the_stretch(&ends, vec2(*x, *y)),
            _ => None,
        };
        let gap = first_number(case, "contact_segment_gap").unwrap_or(0.0);
        let bound = bounds.first().map_or(0.0, |bound| bound + gap);
        match error.filter(|error| error.is_finite()) {
            Some(error) if self.allows(error, bound) => {}
            Some(error) => self.faults.push(format!(
                "contact_point is {error:.2e} off the segment of contact, allowed {bound:.2e}"
            )),
            None => self.faults.push("contact_point is no point".to_owned()),
        }
    }

    /// Whether an error is within its bound; remembers the worst.
    fn allows(&mut self, error: f64, bound: f64) -> bool {
        let ratio = if error > 0.0 { error / bound } else { 0.0 };
        self.worst = self.worst.max(ratio);
        ratio <= 1.0
    }
}

/// Exactly at the critical friction rest and slide are both right.
fn is_critical(case: &Case) -> bool {
    let critical = first_number(case, "critical_mu");
    let friction = number_at(&case.inputs, "friction").ok();
    critical
        .zip(friction)
        .is_some_and(|(critical, friction)| (friction - critical).abs() <= 1e-9 * critical)
}

/// Nothing of this output lies within the horizon.
fn is_beyond_horizon(category: &str, case: &Case, key: &str, entry: &Value) -> bool {
    match &entry["value"] {
        Value::String(_) if category == "scenes" => horizon::followed(case) == 0,
        Value::Bool(_) | Value::String(_) | Value::Number(_) => false,
        _ => exact(entry)
            .and_then(|want| bounds(category, case, key, &want).ok())
            .is_some_and(|bounds| bounds.iter().all(|bound| bound.is_infinite())),
    }
}

/// The first word, one an impact, that differs from what is wanted, within the horizon.
fn wrong_word(want: &str, got: &Value, count: usize) -> Option<String> {
    let have: Vec<&str> = got.as_str().unwrap_or_default().split(' ').collect();
    let words = want.split(' ').take(count).enumerate();
    let mut wrong = words.filter(|(k, word)| have.get(*k) != Some(word));
    wrong.next().map(|(k, word)| {
        let found = have.get(k).copied().unwrap_or("missing");
        format!("impact {k} is {found}, not {word}")
    })
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
        "simultaneous" => Some(listed(&[
            "newton_lcp.velocities_vx_vy_omega",
            "generalised_reflections.velocities_vx_vy_omega",
            "blend.velocities_vx_vy_omega",
        ])),
        "time_of_impact" => {
            let keys = ["hit", "time_of_impact", "contact_point", "normal_a_to_b"];
            Some(keys.map(str::to_owned).to_vec())
        }
        "flight_bounce" => Some(listed(&[
            "position",
            "velocity",
            "angular_velocity",
            "cos_angle",
            "sin_angle",
            "bounce_times",
            "speed_after_bounce",
            "apex_centre_height_after_bounce",
            "centre_height_at_query_time",
            "zeno_time",
            "distance_down_slope",
        ])),
        "friction" => Some(listed(&[
            "distance_down_slope",
            "speed_down_slope",
            "state_at_end",
            "mode",
            "stop_distance",
            "stop_time",
            "angular_velocity",
            "roll_start_time",
            "distance_at_roll_start",
            "final_velocity",
            "final_angular_velocity",
            "position_at_query_time",
            "common_velocity",
            "time_to_stick",
            "relative_slide",
            "stays_at_minus_0.1_deg",
            "falls_at_plus_0.1_deg",
        ])),
        "chains" => Some(listed(&[
            "final_velocities",
            "collisions",
            "last_collision_time",
            "collapse_time",
        ])),
        "galperin" => Some(listed(&[
            "collisions",
            "final_velocity_big",
            "final_velocity_small",
            "last_collision_time",
        ])),
        "billiards" => Some(listed(&[
            "position",
            "velocity",
            "wall_hits",
            "centres",
            "velocities",
            "disc_collisions",
        ])),
        "disc_gas" => {
            let mut keys = listed(&[
                "first_event_times",
                "events_before_sample",
                "disc_collisions_before_sample",
                "energy",
            ]);
            keys.extend((0..8).flat_map(|k| [format!("positions_{k}"), format!("velocities_{k}")]));
            Some(keys)
        }
        "scenes" => Some(listed(&[
            "impact_times",
            "pairs",
            "contact_points",
            "normals",
            "normal_impulses",
            "tangential_impulses",
            "final_positions",
            "final_angles",
            "final_velocities",
            "final_angular_velocities",
            "energy",
        ])),
        _ => None,
    }
}

fn listed(keys: &[&str]) -> Vec<String> {
    keys.iter().map(|key| (*key).to_owned()).collect()
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
        assert_eq!(check("mass_properties", &case(), &right).faults, [""; 0]);

        let wrong = answer(json!({"area": 1.0 + 1e-12, "centroid": [0.5]}));
        let faults = check("mass_properties", &case(), &wrong).faults;
        assert_eq!(faults[0], "area is off by 1.00e-12, allowed 2.00e-13");
        assert_eq!(faults[1], "centroid has 1 numbers, not 2");
    }

    #[test]
    fn a_missing_or_unfinished_number_fails() {
        let empty = answer(json!({"area": null, "centroid": [0.5, null]}));
        let faults = check("mass_properties", &case(), &empty).faults;
        assert_eq!(faults, ["area is missing", "centroid is no finite number"]);
    }

    #[test]
    fn a_category_of_the_future_fails() {
        let right = answer(json!({"area": 1.0}));
        assert_eq!(
            check("tides", &case(), &right).faults,
            ["tides has no check"]
        );
    }

    /// A square of side 1 m lands flat after 1 s at 2 m/s: between x = 0 and x = 1.
    fn landing() -> Case {
        let body = |y: &str, v: &str| {
            json!({
                "position": ["0.5", y], "angle": "0", "velocity": ["0", v],
                "angular_velocity": "0", "acceleration": ["0", "0"],
                "shape": {"polygon": [["-0.5", "-0.5"], ["0.5", "-0.5"], ["0.5", "0.5"], ["-0.5", "0.5"]]},
            })
        };
        serde_json::from_value(json!({
            "id": "landing",
            "inputs": {"body_a": body("2.5", "-2"), "body_b": body("-0.5", "0"), "horizon": "2"},
            "outputs": {
                "hit": {"value": true},
                "time_of_impact": {"value": "1.0", "hp": "1.0"},
                "contact_point": {"value": ["0.0", "0.0"], "hp": ["0", "0"]},
                "normal_a_to_b": {"value": ["0.0", "-1.0"], "hp": ["0", "-1.0"]},
                "condition_time_per_metre": {"value": "0.5"},
                "contact_segment": {"value": [["0.0", "0.0"], ["1.0", "0.0"]], "hp": [["0", "0"], ["1.0", "0"]]},
                "contact_segment_gap": {"value": "0.0"},
            },
        }))
        .unwrap()
    }

    #[test]
    fn any_point_of_a_flat_landing_is_right() {
        for x in [0.0, 0.3, 1.0] {
            let right = answer(json!({
                "hit": true, "time_of_impact": 1.0, "contact_point": [x, 0.0], "normal_a_to_b": [0.0, -1.0],
            }));
            assert_eq!(check("time_of_impact", &landing(), &right).faults, [""; 0]);
        }
        let wrong = answer(json!({
            "hit": true, "time_of_impact": 1.0 + 1e-12, "contact_point": [1.25, 0.0], "normal_a_to_b": [0.0, 1.0],
        }));
        let faults = check("time_of_impact", &landing(), &wrong).faults;
        assert!(
            faults[0].starts_with("time_of_impact is off by 1.00e-12"),
            "{faults:?}"
        );
        assert!(
            faults[1].starts_with("contact_point is 2.50e-1 off the segment"),
            "{faults:?}"
        );
        assert!(
            faults[2].starts_with("normal_a_to_b is off by 2.00e0"),
            "{faults:?}"
        );
    }

    #[test]
    fn a_missed_contact_and_half_an_answer_fail() {
        let missed = answer(json!({"hit": false}));
        assert_eq!(
            check("time_of_impact", &landing(), &missed).faults[0],
            "hit is false, not true"
        );
        let no_point = answer(json!({
            "hit": true, "time_of_impact": 1.0, "contact_point": [0.5, null], "normal_a_to_b": [0.0, -1.0],
        }));
        assert_eq!(
            check("time_of_impact", &landing(), &no_point).faults,
            ["contact_point is no point"]
        );
    }
}
