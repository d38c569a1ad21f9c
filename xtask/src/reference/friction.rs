//! Category `friction`: lasting contacts that slide, roll, stop, stick and tip.

use carom_dynamics::ContactMode;
use carom_math::{Rot, Vec2, vec2};
use serde_json::Value;

use super::book::{Outputs, number_at};
use super::stage::{Cast, Play, Player, Stage};

/// How long a change is waited for, in s.
const PATIENCE: f64 = 1e6;

/// How long a block that may tip is watched, in s, and how far from its tipping angle, in degrees.
const WATCH: f64 = 10.0;
const ASIDE: f64 = 0.1;

/// The body in question, what it touches, and what that lies on.
const BODY: usize = 0;
const FLOOR: usize = 1;
const PLANK: usize = 2;

/// What a case asks of one world.
#[derive(Clone, Debug)]
pub(super) struct FrictionCase {
    cast: Cast,
    question: Question,
}

#[derive(Clone, Copy, Debug)]
enum Question {
    /// Where a block or a disc on an incline is at this instant, in s.
    Incline(f64),
    /// When and where a block stops.
    Stop,
    /// When and where a disc begins to roll, and where it is at this instant, in s.
    Roll(f64),
    /// When a block and the plank under it are as fast.
    Plank,
    /// Whether a block stays below its tipping angle.
    Stays,
    /// Whether it falls above it.
    Falls,
}

impl FrictionCase {
    pub(super) fn read(inputs: &Value) -> Result<Vec<Self>, String> {
        let has = |key: &str| inputs.get(key).is_some();
        if has("mass_plank") {
            Ok(vec![plank(inputs)?])
        } else if has("query_time") {
            Ok(vec![spin(inputs)?])
        } else if has("incline_deg") {
            Ok(vec![incline(inputs)?])
        } else if has("speed") {
            Ok(vec![stop(inputs)?])
        } else if has("width") {
            Ok(vec![
                tip(inputs, Question::Stays)?,
                tip(inputs, Question::Falls)?,
            ])
        } else {
            Err("inputs of no kind that is known".to_owned())
        }
    }

    fn of(
        gravity: Vec2,
        inputs: &Value,
        mut players: Vec<Player>,
        question: Question,
    ) -> Result<Self, String> {
        let friction = number_at(inputs, "friction")?;
        players.insert(FLOOR, Player::floor());
        Ok(Self {
            cast: Cast::of(gravity, 0.0, friction, players),
            question,
        })
    }
}

impl Play for FrictionCase {
    fn cast(&self) -> &Cast {
        &self.cast
    }

    fn play(&self, stage: &mut Stage) -> Result<Outputs, String> {
        let start = stage.position(BODY).x;
        let mut outputs = Outputs::new();
        let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
        match self.question {
            Question::Incline(time) => {
                stage.until(time)?;
                put(
                    "distance_down_slope",
                    (stage.position(BODY).x - start).into(),
                );
                put("speed_down_slope", stage.velocity(BODY).x.into());
                put("angular_velocity", stage.spin(BODY).into());
                let mode = stage.mode((BODY, FLOOR));
                put("state_at_end", word(mode, "slide").into());
                put("mode", word(mode, "slip").into());
            }
            Question::Stop => {
                let time = stage.until_mode((BODY, FLOOR), &[ContactMode::Rest], PATIENCE)?;
                put("stop_time", time.into());
                put("stop_distance", (stage.position(BODY).x - start).into());
            }
            Question::Roll(query) => {
                let held = [ContactMode::Roll, ContactMode::Rest];
                let time = stage.until_mode((BODY, FLOOR), &held, PATIENCE)?;
                put("roll_start_time", time.into());
                put(
                    "distance_at_roll_start",
                    (stage.position(BODY).x - start).into(),
                );
                put("final_velocity", stage.velocity(BODY).x.into());
                put("final_angular_velocity", stage.spin(BODY).into());
                stage.until(query)?;
                put(
                    "position_at_query_time",
                    (stage.position(BODY).x - start).into(),
                );
            }
            Question::Plank => {
                let together = [ContactMode::Stick, ContactMode::Rest];
                let time = stage.until_mode((BODY, PLANK), &together, PATIENCE)?;
                put("time_to_stick", time.into());
                put("common_velocity", stage.velocity(PLANK).x.into());
                let way = (stage.position(BODY) - stage.position(PLANK)).x;
                put("relative_slide", (way - start).into());
                put("energy_lost", stage.friction_heat().into());
            }
            Question::Stays => {
                stage.until(WATCH)?;
                let stays = stage.mode((BODY, FLOOR)) == Some(ContactMode::Rest);
                put("stays_at_minus_0.1_deg", (stays && lies(stage)).into());
            }
            Question::Falls => {
                stage.until(WATCH)?;
                put("falls_at_plus_0.1_deg", (!lies(stage)).into());
            }
        }
        Ok(outputs)
    }
}

/// Whether a block has kept its side on the floor: whole turns count.
fn lies(stage: &Stage) -> bool {
    stage.angle(BODY).abs() < 0.1
}

/// The reference's word for a mode.
fn word(mode: Option<ContactMode>, sliding: &'static str) -> Option<&'static str> {
    Some(match mode? {
        ContactMode::Rest => "rest",
        ContactMode::Stick => "stick",
        ContactMode::Roll => "roll",
        ContactMode::Slide => sliding,
        ContactMode::Open => "open",
        _ => return None,
    })
}

fn level(inputs: &Value) -> Result<Vec2, String> {
    Ok(vec2(0.0, -number_at(inputs, "gravity")?))
}

/// So flat that friction never tips it: µ times its height is at most its half-width.
fn flat_block(inputs: &Value) -> Result<Player, String> {
    let height = number_at(inputs, "friction")?.recip().min(0.25);
    Ok(Player::block(vec2(-2.0, 0.0), vec2(2.0, height)))
}

fn disc(inputs: &Value) -> Result<Player, String> {
    let radius = number_at(inputs, "radius")?;
    let share = number_at(inputs, "inertia_over_mr2")?;
    Ok(Player {
        inertia: Some(share * radius * radius),
        ..Player::disc(radius, vec2(0.0, radius))
    })
}

/// In the frame of the incline: the floor is level and gravity is turned, downhill is +x.
fn incline(inputs: &Value) -> Result<FrictionCase, String> {
    let slope = Rot::from_degrees(number_at(inputs, "incline_deg")?);
    let body = if inputs.get("radius").is_some() {
        disc(inputs)?
    } else {
        Player {
            velocity: vec2(number_at(inputs, "initial_speed_down_slope")?, 0.0),
            ..flat_block(inputs)?
        }
    };
    let question = Question::Incline(number_at(inputs, "time")?);
    FrictionCase::of(slope * level(inputs)?, inputs, vec![body], question)
}

fn stop(inputs: &Value) -> Result<FrictionCase, String> {
    let block = Player {
        velocity: vec2(number_at(inputs, "speed")?, 0.0),
        ..flat_block(inputs)?
    };
    FrictionCase::of(level(inputs)?, inputs, vec![block], Question::Stop)
}

fn spin(inputs: &Value) -> Result<FrictionCase, String> {
    let body = Player {
        velocity: vec2(number_at(inputs, "velocity")?, 0.0),
        spin: number_at(inputs, "angular_velocity")?,
        ..disc(inputs)?
    };
    let question = Question::Roll(number_at(inputs, "query_time")?);
    FrictionCase::of(level(inputs)?, inputs, vec![body], question)
}

/// The floor is frictionless, the plank long enough.
fn plank(inputs: &Value) -> Result<FrictionCase, String> {
    let block = flat_block(inputs)?;
    let block = Player {
        mass: Some(number_at(inputs, "mass_block")?),
        velocity: vec2(number_at(inputs, "speed_block")?, 0.0),
        position: vec2(0.0, 0.5) + block.position,
        ..block
    };
    let plank = Player {
        mass: Some(number_at(inputs, "mass_plank")?),
        ..Player::block(vec2(-500.0, 0.0), vec2(500.0, 0.5))
    };
    let mut case = FrictionCase::of(level(inputs)?, inputs, vec![block, plank], Question::Plank)?;
    case.cast.players[FLOOR].friction = Some(0.0);
    Ok(case)
}

/// On an incline a little less, or a little more steep than the angle at which the diagonal stands upright.
fn tip(inputs: &Value, question: Question) -> Result<FrictionCase, String> {
    let (width, height) = (number_at(inputs, "width")?, number_at(inputs, "height")?);
    let block = Player::block(vec2(-0.5 * width, 0.0), vec2(0.5 * width, height));
    let tipping = Rot::from_direction(vec2(height, width)).ok_or("a block without size")?;
    let aside = match question {
        Question::Stays => -ASIDE,
        _ => ASIDE,
    };
    let slope = tipping * Rot::from_degrees(aside);
    FrictionCase::of(slope * vec2(0.0, -9.81), inputs, vec![block], question)
}
