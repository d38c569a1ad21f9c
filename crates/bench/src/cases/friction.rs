//! Case 8: a block slides, holds and stops.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{G, GRAVITY, Incline, dynamic, floor};
use super::{Case, Metric, RATES, Run, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "08_friction",
    about: "a block slides down 20 degrees for 2 s, holds there for 20 s, and stops on the level",
    metrics: &[
        Metric::error("slide_dist_2s", "1"),
        Metric::error("slide_speed_2s", "1"),
        Metric::error("hold_mu0.37_creep_20s_m", "m"),
        Metric::error("hold_mu0.5_creep_20s_m", "m"),
        Metric::error("stop_dist_m", "1"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

/// Half of the block's side, in m.
const HALF: f64 = 0.5;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let incline = Incline::new();
    let mu = 0.2;
    let mut slide = on_incline(trial, mu)?;
    slide.run.until(2.0);
    let t = slide.run.time();
    let a = G * (incline.sin - mu * incline.cos);
    let speed = slide
        .run
        .state(slide.block)
        .velocity
        .dot(incline.downhill());
    let mut values: Values = vec![
        (
            "slide_dist_2s".into(),
            (slide.moved() / (a * t * t / 2.0) - 1.0).abs(),
        ),
        ("slide_speed_2s".into(), (speed / (a * t) - 1.0).abs()),
    ];
    drop(slide);
    for mu in [0.37, 0.5] {
        let mut hold = on_incline(trial, mu)?;
        hold.run.until(20.0);
        values.push((format!("hold_mu{mu}_creep_20s_m"), hold.moved().abs()));
    }
    values.push(("stop_dist_m".into(), stop(trial)?));
    Ok(values)
}

struct OnIncline<'a> {
    run: Run<'a>,
    block: usize,
    start: Vec2,
}

impl OnIncline<'_> {
    /// Downhill, in m.
    fn moved(&self) -> f64 {
        let way = self.run.state(self.block).position - self.start;
        way.dot(Incline::new().downhill())
    }
}

fn on_incline(trial: &mut Trial, friction: f64) -> Result<OnIncline<'_>, EngineError> {
    let incline = Incline::new();
    let mut scene = PlainScene::empty(CASE.name, GRAVITY);
    let material = scene.material(1.0, friction, 0.0);
    incline.add(&mut scene, material);
    let start = incline.above(HALF);
    let body = dynamic(start, material).turned(incline.angle);
    let block = scene.add(body, PlainShape::rectangle(HALF, HALF));
    let run = trial.open(&scene)?;
    Ok(OnIncline { run, block, start })
}

/// 5 m/s on the level with mu 0.3, against v²/(2 mu g), relative.
fn stop(trial: &mut Trial) -> Result<f64, EngineError> {
    let (mu, speed) = (0.3, 5.0);
    let mut scene = PlainScene::empty(CASE.name, GRAVITY);
    let material = scene.material(1.0, mu, 0.0);
    floor(&mut scene, material);
    let body = dynamic(vec2(0.0, HALF), material).moving(vec2(speed, 0.0));
    let block = scene.add(body, PlainShape::rectangle(HALF, HALF));
    let mut run = trial.open(&scene)?;
    run.until(4.0);
    let exact = speed * speed / (2.0 * mu * G);
    Ok((run.state(block).position.x / exact - 1.0).abs())
}
