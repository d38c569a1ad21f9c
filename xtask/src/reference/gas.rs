//! Categories `billiards` and `disc_gas`: discs between walls.

use carom_math::{Vec2, vec2};
use serde_json::Value;

use super::book::{Case, Outputs, number_at, numbers_at, pair, point_at, points_at};
use super::stage::{Cast, Play, Player, Stage};

/// What a case gives.
#[derive(Clone, Debug)]
pub(super) struct GasCase {
    cast: Cast,
    question: Question,
}

#[derive(Clone, Debug)]
enum Question {
    /// One disc in a box, after this time, in s.
    Single(f64),
    /// Discs in a row between two walls, after this time, in s.
    Corridor(f64),
    /// Discs in a box, at these times, in s; so many of the first impacts are named.
    Gas { samples: Vec<f64>, firsts: usize },
}

impl GasCase {
    pub(super) fn read_billiard(inputs: &Value) -> Result<Self, String> {
        let radius = number_at(inputs, "radius")?;
        let time = number_at(inputs, "time")?;
        if inputs.get("box").is_some() {
            let disc = Player {
                velocity: point_at(inputs, "velocity")?,
                ..Player::disc(radius, point_at(inputs, "position")?)
            };
            let (low, high) = box_at(inputs)?;
            let mut players = vec![disc];
            players.extend(Player::walls(low, high));
            return Ok(Self {
                cast: Cast::of(Vec2::ZERO, 1.0, 0.0, players),
                question: Question::Single(time),
            });
        }
        let ends = numbers_at(inputs, "corridor")?;
        let [left, right] = ends[..] else {
            return Err("input corridor is no pair".to_owned());
        };
        let mass = number_at(inputs, "mass")?;
        let centres = numbers_at(inputs, "centres")?;
        let discs = centres.iter().zip(numbers_at(inputs, "velocities")?);
        let mut players: Vec<Player> = discs
            .map(|(x, speed)| Player {
                velocity: vec2(speed, 0.0),
                mass: Some(mass),
                ..Player::disc(radius, vec2(*x, 0.0))
            })
            .collect();
        players.push(Player::wall(vec2(left - 1.0, -1.0), vec2(left, 1.0)));
        players.push(Player::wall(vec2(right, -1.0), vec2(right + 1.0, 1.0)));
        Ok(Self {
            cast: Cast::of(Vec2::ZERO, 1.0, 0.0, players),
            question: Question::Corridor(time),
        })
    }

    /// The instants of the samples stand among the answers.
    pub(super) fn read_gas(case: &Case) -> Result<Self, String> {
        let inputs = &case.inputs;
        let [radii, masses] = ["radii", "masses"].map(|key| numbers_at(inputs, key));
        let [places, velocities] = ["positions", "velocities"].map(|key| points_at(inputs, key));
        let (radii, masses, places, velocities) = (radii?, masses?, places?, velocities?);
        let discs = radii.iter().zip(masses).zip(places.iter().zip(velocities));
        let mut players: Vec<Player> = discs
            .map(|((radius, mass), (place, velocity))| Player {
                velocity,
                mass: Some(mass),
                ..Player::disc(*radius, *place)
            })
            .collect();
        let (low, high) = box_at(inputs)?;
        players.extend(Player::walls(low, high));
        let asked = Value::Object(case.outputs.clone());
        Ok(Self {
            cast: Cast::of(
                point_at(inputs, "gravity")?,
                number_at(inputs, "restitution")?,
                number_at(inputs, "friction")?,
                players,
            ),
            question: Question::Gas {
                samples: numbers_at(&asked["sample_times"], "value")?,
                firsts: numbers_at(&asked["first_event_times"], "value")?.len(),
            },
        })
    }
}

impl Play for GasCase {
    fn cast(&self) -> &Cast {
        &self.cast
    }

    fn play(&self, stage: &mut Stage) -> Result<Outputs, String> {
        let mut outputs = Outputs::new();
        let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
        let moving = self.cast.players.iter().filter(|player| !player.fixed);
        let discs = moving.count();
        match &self.question {
            Question::Single(time) => {
                stage.until(*time)?;
                put("position", pair(stage.centre(0)));
                put("velocity", pair(stage.velocity(0)));
                put("wall_hits", stage.impacts.len().into());
            }
            Question::Corridor(time) => {
                stage.until(*time)?;
                put("centres", (0..discs).map(|i| stage.centre(i).x).collect());
                put(
                    "velocities",
                    (0..discs).map(|i| stage.velocity(i).x).collect(),
                );
                let among = among_discs(stage, discs);
                put("disc_collisions", among.into());
                put("wall_hits", (stage.impacts.len() - among).into());
            }
            Question::Gas { samples, firsts } => {
                let (mut all, mut among, mut energies) = (Vec::new(), Vec::new(), Vec::new());
                for (k, time) in samples.iter().enumerate() {
                    stage.until(*time)?;
                    all.push(stage.impacts.len());
                    among.push(among_discs(stage, discs));
                    energies.push(stage.energy());
                    let centres = (0..discs).map(|i| pair(stage.centre(i)));
                    put(&format!("positions_{k}"), centres.collect());
                    let velocities = (0..discs).map(|i| pair(stage.velocity(i)));
                    put(&format!("velocities_{k}"), velocities.collect());
                }
                put("events_before_sample", all.into());
                put("disc_collisions_before_sample", among.into());
                put("energy", energies.into());
                let times = stage.impacts.iter().take(*firsts);
                put(
                    "first_event_times",
                    times.map(|struck| struck.time).collect(),
                );
            }
        }
        Ok(outputs)
    }
}

/// Impacts in which no wall took part: walls come after the discs.
fn among_discs(stage: &Stage, discs: usize) -> usize {
    let among = stage.impacts.iter().filter(|struck| struck.pair.1 < discs);
    among.count()
}

fn box_at(inputs: &Value) -> Result<(Vec2, Vec2), String> {
    match numbers_at(inputs, "box")?[..] {
        [x0, y0, x1, y1] => Ok((vec2(x0, y0), vec2(x1, y1))),
        _ => Err("input box is not four numbers".to_owned()),
    }
}
