//! Category `flight_bounce`: free flight, bounces, and the end of infinitely many of them.

use carom_math::{Rot, Vec2, vec2};
use serde_json::Value;

use super::book::{Outputs, number_at, pair, point_at};
use super::stage::{Cast, Play, Player, Stage};

/// How long a bounce is waited for, in s.
const PATIENCE: f64 = 1e6;

/// What a case gives.
#[derive(Clone, Debug)]
pub(super) struct FlightCase {
    cast: Cast,
    question: Question,
}

#[derive(Clone, Copy, Debug)]
enum Question {
    /// Where a body flies in this time, in s.
    Flight(f64),
    /// So many bounces on the floor, and the height at an instant, in s.
    Bounces { count: usize, query: f64 },
    /// One bounce with spin.
    Spin,
    /// So many bounces down an incline.
    Incline(usize),
}

impl FlightCase {
    pub(super) fn read(inputs: &Value) -> Result<Self, String> {
        let has = |key: &str| inputs.get(key).is_some();
        if has("incline_deg") {
            incline(inputs)
        } else if has("bounces") {
            bounces(inputs)
        } else if has("friction") {
            spin(inputs)
        } else {
            flight(inputs)
        }
    }
}

impl Play for FlightCase {
    fn cast(&self) -> &Cast {
        &self.cast
    }

    fn play(&self, stage: &mut Stage) -> Result<Outputs, String> {
        match self.question {
            Question::Flight(time) => {
                stage.until(time)?;
                Ok(flown(stage))
            }
            Question::Bounces { count, query } => bounced(stage, count, query),
            Question::Spin => {
                stage.next_impact(PATIENCE)?;
                let mut outputs = Outputs::new();
                outputs.insert("velocity".to_owned(), pair(stage.velocity(0)));
                outputs.insert("angular_velocity".to_owned(), stage.spin(0).into());
                Ok(outputs)
            }
            Question::Incline(count) => slope(stage, count),
        }
    }
}

fn flight(inputs: &Value) -> Result<FlightCase, String> {
    let body = Player {
        velocity: point_at(inputs, "velocity")?,
        angle: number_at(inputs, "angle")?,
        spin: number_at(inputs, "angular_velocity")?,
        ..Player::disc(0.1, point_at(inputs, "position")?)
    };
    Ok(FlightCase {
        cast: Cast::of(point_at(inputs, "gravity")?, 0.0, 0.0, vec![body]),
        question: Question::Flight(number_at(inputs, "time")?),
    })
}

fn bounces(inputs: &Value) -> Result<FlightCase, String> {
    let height = number_at(inputs, "centre_height")?;
    let ball = Player::disc(number_at(inputs, "radius")?, vec2(0.0, height));
    let gravity = vec2(0.0, -number_at(inputs, "gravity")?);
    let restitution = number_at(inputs, "restitution")?;
    Ok(FlightCase {
        cast: Cast::of(gravity, restitution, 0.0, vec![ball, Player::floor()]),
        question: Question::Bounces {
            count: count_at(inputs)?,
            query: number_at(inputs, "query_time")?,
        },
    })
}

fn spin(inputs: &Value) -> Result<FlightCase, String> {
    let radius = number_at(inputs, "radius")?;
    let ball = Player {
        mass: Some(number_at(inputs, "mass")?),
        velocity: point_at(inputs, "velocity")?,
        spin: number_at(inputs, "angular_velocity")?,
        ..Player::disc(radius, vec2(0.0, radius + 1.0))
    };
    let (restitution, friction) = (
        number_at(inputs, "restitution")?,
        number_at(inputs, "friction")?,
    );
    Ok(FlightCase {
        cast: Cast::of(
            Vec2::ZERO,
            restitution,
            friction,
            vec![ball, Player::floor()],
        ),
        question: Question::Spin,
    })
}

/// In the frame of the incline: the floor is level and gravity is turned, downhill is +x.
fn incline(inputs: &Value) -> Result<FlightCase, String> {
    const RADIUS: f64 = 0.125;
    let height = number_at(inputs, "normal_distance")? + RADIUS;
    let ball = Player::disc(RADIUS, vec2(0.0, height));
    let down = vec2(0.0, -number_at(inputs, "gravity")?);
    let gravity = Rot::from_degrees(number_at(inputs, "incline_deg")?) * down;
    let restitution = number_at(inputs, "restitution")?;
    Ok(FlightCase {
        cast: Cast::of(gravity, restitution, 0.0, vec![ball, Player::floor()]),
        question: Question::Incline(count_at(inputs)?),
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small count"
)]
fn count_at(inputs: &Value) -> Result<usize, String> {
    Ok(number_at(inputs, "bounces")?.max(0.0) as usize)
}

fn flown(stage: &Stage) -> Outputs {
    let rotation = stage.rotation(0);
    let mut outputs = Outputs::new();
    let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
    put("position", pair(stage.position(0)));
    put("velocity", pair(stage.velocity(0)));
    put("angular_velocity", stage.spin(0).into());
    put("cos_angle", rotation.cos().into());
    put("sin_angle", rotation.sin().into());
    outputs
}

fn bounced(stage: &mut Stage, count: usize, query: f64) -> Result<Outputs, String> {
    let (mut speeds, mut apexes) = (Vec::new(), Vec::new());
    let mut height = None;
    while speeds.len() < count {
        let struck = if height.is_none() {
            stage.next_impact(query)?
        } else {
            stage.next_impact(PATIENCE)?
        };
        if struck {
            speeds.push(stage.velocity(0).length());
            apexes.extend(stage.apex(0).map(|apex| apex.y));
        } else if height.is_none() {
            height = Some(stage.centre(0).y);
        } else {
            break;
        }
    }
    if height.is_none() {
        stage.until(query)?;
        height = Some(stage.centre(0).y);
    }
    // What follows are ever smaller bounces, up to their end.
    while stage.accumulated.is_none() && stage.impacts.len() < 100_000 {
        if !stage.next_impact(PATIENCE)? {
            break;
        }
    }
    let mut outputs = Outputs::new();
    let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
    let times = stage.impacts.iter().take(count).map(|struck| struck.time);
    put("bounce_times", times.collect());
    put("speed_after_bounce", speeds.into());
    put("apex_centre_height_after_bounce", apexes.into());
    put("centre_height_at_query_time", height.into());
    if let Some(end) = stage.accumulated {
        put("zeno_time", end.into());
    }
    Ok(outputs)
}

fn slope(stage: &mut Stage, count: usize) -> Result<Outputs, String> {
    let start = stage.centre(0).x;
    let mut distances = Vec::new();
    while distances.len() < count && stage.next_impact(PATIENCE)? {
        distances.push(stage.centre(0).x - start);
    }
    let mut outputs = Outputs::new();
    let times = stage.impacts.iter().take(count).map(|struck| struck.time);
    outputs.insert("bounce_times".to_owned(), times.collect());
    outputs.insert("distance_down_slope".to_owned(), distances.into());
    Ok(outputs)
}
