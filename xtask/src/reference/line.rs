//! Categories `chains` and `galperin`: bodies on a line, counted impact by impact.

use carom_math::{Vec2, vec2};
use serde_json::Value;

use super::book::{Outputs, number_at, numbers_at};
use super::stage::{Cast, Play, Player, Stage};

/// How long another impact is waited for, in s.
const PATIENCE: f64 = 1e6;

/// How long another impact is waited for after infinitely many, in s.
const SETTLED: f64 = 1.0;

/// What a case gives.
#[derive(Clone, Debug)]
pub(super) struct LineCase {
    cast: Cast,
    /// How its answer names the velocities.
    galperin: bool,
}

impl LineCase {
    /// Discs side by side.
    pub(super) fn read_chain(inputs: &Value) -> Result<Self, String> {
        let [radii, centres] = ["radii", "centres"].map(|key| numbers_at(inputs, key));
        let [speeds, masses] = ["velocities", "masses"].map(|key| numbers_at(inputs, key));
        let (radii, centres, speeds, masses) = (radii?, centres?, speeds?, masses?);
        let players = radii.iter().zip(centres).zip(speeds.iter().zip(masses));
        let players = players.map(|((radius, centre), (speed, mass))| Player {
            velocity: vec2(*speed, 0.0),
            mass: Some(mass),
            ..Player::disc(*radius, vec2(centre, 0.0))
        });
        Ok(Self {
            cast: Cast::of(
                Vec2::ZERO,
                number_at(inputs, "restitution")?,
                0.0,
                players.collect(),
            ),
            galperin: false,
        })
    }

    /// A wall and two blocks.
    pub(super) fn read_galperin(inputs: &Value) -> Result<Self, String> {
        let block = |name: &str| {
            let centre = number_at(inputs, &format!("centre_{name}"))?;
            let width = number_at(inputs, &format!("width_{name}"))?;
            let half = vec2(width / 2.0, 0.5);
            let at = vec2(centre, 0.0);
            Ok::<_, String>(Player {
                mass: Some(number_at(inputs, &format!("mass_{name}"))?),
                velocity: vec2(number_at(inputs, &format!("velocity_{name}"))?, 0.0),
                ..Player::block(at - half, at + half)
            })
        };
        let face = number_at(inputs, "wall_x")?;
        let wall = Player::wall(vec2(face - 1.0, -2.0), vec2(face, 2.0));
        Ok(Self {
            cast: Cast::of(
                Vec2::ZERO,
                number_at(inputs, "restitution")?,
                0.0,
                vec![block("small")?, block("big")?, wall],
            ),
            galperin: true,
        })
    }
}

impl Play for LineCase {
    fn cast(&self) -> &Cast {
        &self.cast
    }

    fn play(&self, stage: &mut Stage) -> Result<Outputs, String> {
        let mut last = 0.0;
        // Some may come to rest against each other before they meet the others.
        while stage.next_impact(stage.accumulated.map_or(PATIENCE, |end| end + SETTLED))? {
            if let Some(struck) = stage.impacts.last() {
                last = struck.time;
            }
            // There may be millions, and only their number is asked for.
            stage.impacts.clear();
        }
        let mut outputs = Outputs::new();
        let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
        if let Some(end) = stage.accumulated {
            stage.until(end + SETTLED)?;
            put("collisions", "infinite".into());
            put("collapse_time", end.into());
        } else {
            put("collisions", stage.struck.into());
            put("last_collision_time", last.into());
        }
        if self.galperin {
            put("final_velocity_small", stage.velocity(0).x.into());
            put("final_velocity_big", stage.velocity(1).x.into());
        } else {
            let all = 0..self.cast.players.len();
            put(
                "final_velocities",
                all.map(|index| stage.velocity(index).x).collect(),
            );
        }
        Ok(outputs)
    }
}
