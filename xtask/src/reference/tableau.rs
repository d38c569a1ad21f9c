//! Category `scenes`: turning bodies, followed impact by impact.

use carom_dynamics::{ImpactLaw, Material};
use carom_math::Vec2;
use serde_json::Value;

use super::book::{Outputs, number_at, pair, point_at};
use super::outline::Outline;
use super::stage::{Cast, Play, Player, Stage};

/// How long the next impact is waited for, in s.
const PATIENCE: f64 = 1e6;

/// What a case gives.
#[derive(Clone, Debug)]
pub(super) struct SceneCase {
    cast: Cast,
    impacts: usize,
}

impl SceneCase {
    pub(super) fn read(inputs: &Value) -> Result<Self, String> {
        let bodies = inputs["bodies"].as_array();
        let bodies = bodies.ok_or("input bodies is no list")?;
        let mut gravity = Vec2::ZERO;
        let mut players = Vec::with_capacity(bodies.len());
        for body in bodies {
            let pull = point_at(body, "gravity")?;
            if pull != Vec2::ZERO {
                gravity = pull;
            }
            players.push(player(body)?);
        }
        let law = inputs["impact_law"].as_str().unwrap_or_default();
        if !law.starts_with("newton") {
            return Err(format!("input impact_law is {law:?}, not newton"));
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count"
        )]
        let impacts = number_at(inputs, "impacts")?.max(0.0) as usize;
        Ok(Self {
            cast: Cast {
                gravity,
                material: Material {
                    restitution: number_at(inputs, "restitution")?,
                    friction: number_at(inputs, "friction")?,
                    ..Material::default()
                },
                law: ImpactLaw::Newton,
                players,
            },
            impacts,
        })
    }
}

impl Play for SceneCase {
    fn cast(&self) -> &Cast {
        &self.cast
    }

    /// The state is the one just after the last impact.
    fn play(&self, stage: &mut Stage) -> Result<Outputs, String> {
        while stage.impacts.len() < self.impacts {
            if !stage.next_impact(PATIENCE)? {
                return Err(format!("no impact after the {}th", stage.impacts.len()));
            }
        }
        let players = self.cast.players.iter().enumerate();
        let moving: Vec<usize> = players
            .filter(|(_, player)| !player.fixed)
            .map(|(index, _)| index)
            .collect();
        let struck = &stage.impacts[..self.impacts];
        let mut outputs = Outputs::new();
        let mut put = |key: &str, value: Value| outputs.insert(key.to_owned(), value);
        put("impact_times", struck.iter().map(|s| s.time).collect());
        let pairs: Vec<String> = struck
            .iter()
            .map(|s| format!("{}-{}", s.pair.0, s.pair.1))
            .collect();
        put("pairs", pairs.join(" ").into());
        put(
            "contact_points",
            struck.iter().map(|s| pair(s.point)).collect(),
        );
        put("normals", struck.iter().map(|s| pair(s.normal)).collect());
        put(
            "normal_impulses",
            struck.iter().map(|s| s.normal_impulse).collect(),
        );
        put(
            "tangential_impulses",
            struck.iter().map(|s| s.tangential_impulse).collect(),
        );
        let each = || moving.iter().copied();
        put(
            "final_positions",
            each().map(|i| pair(stage.position(i))).collect(),
        );
        put("final_angles", each().map(|i| stage.angle(i)).collect());
        put(
            "final_velocities",
            each().map(|i| pair(stage.velocity(i))).collect(),
        );
        put(
            "final_angular_velocities",
            each().map(|i| stage.spin(i)).collect(),
        );
        put("energy", stage.energy().into());
        Ok(outputs)
    }
}

/// The origin of the frame is the centre of mass, by definition: vertices are rounded to 12 digits, and the centroid of
/// these lies 1e-13 m beside it.
fn player(body: &Value) -> Result<Player, String> {
    Ok(Player {
        outline: Outline::read(&body["shape"])?,
        fixed: body["static"].as_bool().unwrap_or(false),
        mass: None,
        inertia: None,
        centre: Some(Vec2::ZERO),
        friction: None,
        density: number_at(body, "density")?,
        position: point_at(body, "position")?,
        angle: number_at(body, "angle")?,
        velocity: point_at(body, "velocity")?,
        spin: number_at(body, "angular_velocity")?,
    })
}
