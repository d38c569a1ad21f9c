//! Every case with carom; and with engines of known error.

use std::f64::consts::PI;

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainKind, PlainScene};

use super::{CASES, Case, Trial, Values, trial::Opener};
use crate::engine::{Body, Counters, Engine, EngineError, Mode, Setup, State};
use crate::engines::EngineName;
use crate::job::Point;

fn case(number: &str) -> &'static Case {
    let found = CASES.iter().find(|case| case.name.starts_with(number));
    found.expect("a case of that number")
}

fn point(case: &Case, hz: u32) -> Point {
    Point {
        engine: EngineName::Carom,
        mode: Mode::Hybrid,
        case: case.name.to_owned(),
        hz,
        substeps: None,
    }
}

fn value(values: &Values, name: &str) -> f64 {
    let found = values.iter().find(|(known, _)| known == name);
    found.unwrap_or_else(|| panic!("{name} in {values:?}")).1
}

#[test]
fn names_are_numbers_and_each_metric_has_its_own() {
    for (i, case) in CASES.iter().enumerate() {
        assert!(
            case.name.starts_with(&format!("{:02}_", i + 1)),
            "{}",
            case.name
        );
        for (k, metric) in case.metrics.iter().enumerate() {
            let again = case.metrics[..k]
                .iter()
                .any(|other| other.name == metric.name);
            assert!(!again, "{} twice in {}", metric.name, case.name);
        }
    }
}

#[test]
fn carom_gives_every_metric_of_every_case() {
    for case in CASES {
        let mut trial = Trial::new(&point(case, 30));
        let values = (case.measure)(&mut trial).expect("carom takes every case");
        for (name, value) in &values {
            let known = case.metrics.iter().any(|metric| metric.name == name);
            assert!(known, "{}: {name} is no metric", case.name);
            assert!(value.is_finite(), "{}: {name} = {value}", case.name);
        }
        for metric in case.metrics {
            let given = values.iter().any(|(name, _)| name == metric.name);
            assert!(
                given || metric.missing != "none",
                "{}: no {}",
                case.name,
                metric.name
            );
        }
        assert!(trial.cpu_per_second() > 0.0, "{}", case.name);
    }
}

/// Bodies with a formula of time as their motion.
struct Formula {
    states: Vec<State>,
    gravity: Vec2,
    dt: f64,
    time: f64,
    motion: fn(&State, Vec2, f64) -> State,
}

impl Engine for Formula {
    fn step(&mut self) {
        self.time += self.dt;
    }

    fn state(&self, body: usize) -> State {
        (self.motion)(&self.states[body], self.gravity, self.time)
    }

    fn body(&self, _: usize) -> Body {
        Body {
            mass: 1.0,
            inertia: 1.0,
        }
    }

    fn read_poses(&mut self) -> f64 {
        0.0
    }

    fn counters(&self) -> Counters {
        Counters::default()
    }

    fn settings(&self) -> String {
        String::new()
    }
}

fn formula(
    scene: &PlainScene,
    setup: &Setup,
    motion: fn(&State, Vec2, f64) -> State,
) -> Box<dyn Engine> {
    let states = scene.bodies.iter().map(|body| State {
        position: body.position,
        angle: body.angle,
        velocity: body.velocity,
        spin: body.spin,
    });
    let fixed = |i: usize| scene.bodies[i].kind == PlainKind::Fixed;
    assert!(scene.bodies.len() <= 2 && !fixed(scene.bodies.len() - 1));
    Box::new(Formula {
        states: states.collect(),
        gravity: scene.gravity,
        dt: setup.hz.recip(),
        time: 0.0,
        motion,
    })
}

fn flight(start: &State, gravity: Vec2, t: f64) -> State {
    State {
        position: start.position + start.velocity * t + gravity * (t * t / 2.0),
        angle: start.angle + start.spin * t,
        velocity: start.velocity + gravity * t,
        spin: start.spin,
    }
}

fn exact(_: EngineName, scene: &PlainScene, setup: &Setup) -> Result<Box<dyn Engine>, EngineError> {
    Ok(formula(scene, setup, flight))
}

/// Drifts by 0.25 m/s, turns too fast by 1e-4 rad/s, says that it spins 1 % too fast.
fn wrong(_: EngineName, scene: &PlainScene, setup: &Setup) -> Result<Box<dyn Engine>, EngineError> {
    Ok(formula(scene, setup, |start, gravity, t| {
        let right = flight(start, gravity, t);
        State {
            position: right.position + vec2(0.0, 0.25 * t),
            angle: right.angle + 1e-4 * t,
            spin: 1.01 * right.spin,
            ..right
        }
    }))
}

fn with(opener: Opener, number: &str, hz: u32) -> Values {
    let case = case(number);
    (case.measure)(&mut Trial::opened_by(opener, &point(case, hz))).expect("a formula takes all")
}

#[test]
fn an_exact_flight_has_no_error() {
    for hz in [30, 60, 3840] {
        let error = value(&with(exact, "01", hz), "pos_error_m");
        assert!(error < 1e-14, "{hz} Hz: {error:e} m");
    }
    let spin = with(exact, "11", 60);
    // 2000 rad have an ulp of 2e-13; the sum of dt is the same on both sides.
    assert!(value(&spin, "angle_err_rad_1000s") < 1e-12, "{spin:?}");
    assert!(value(&spin, "ang_momentum_rel") < 1e-15);
    assert!(value(&spin, "centre_drift_m") < 1e-15);
}

#[test]
fn a_known_error_is_found() {
    let error = value(&with(wrong, "01", 60), "pos_error_m");
    assert!((error - 0.25).abs() < 1e-14, "{error}");
    let spin = with(wrong, "11", 60);
    let angle = value(&spin, "angle_err_rad_1000s");
    assert!((angle - 0.1).abs() < 1e-9 && angle < PI, "{angle}");
    assert!((value(&spin, "ang_momentum_rel") - 0.01).abs() < 1e-14);
    assert!((value(&spin, "centre_drift_m") - 250.0).abs() < 1e-9);
}

/// A disc that bounces off y = 0.25 with restitution `e`, by closed form.
fn bouncing(start: &State, t: f64, e: f64) -> State {
    if start.position.y < 0.0 {
        return *start;
    }
    let (g, radius) = (10.0, 0.25);
    let height = start.position.y - radius;
    let mut speed = (2.0 * g * height).sqrt();
    let mut since = t - speed / g;
    if since < 0.0 {
        return flight(start, vec2(0.0, -g), t);
    }
    speed *= e;
    while speed > 1e-3 && since > 2.0 * speed / g {
        since -= 2.0 * speed / g;
        speed *= e;
    }
    if speed <= 1e-3 {
        (speed, since) = (0.0, 0.0);
    }
    State {
        position: vec2(0.0, radius + since * (speed - g * since / 2.0)),
        velocity: vec2(0.0, speed - g * since),
        ..State::default()
    }
}

fn elastic(
    _: EngineName,
    scene: &PlainScene,
    setup: &Setup,
) -> Result<Box<dyn Engine>, EngineError> {
    Ok(formula(scene, setup, |start, _, t| bouncing(start, t, 1.0)))
}

fn damped(
    _: EngineName,
    scene: &PlainScene,
    setup: &Setup,
) -> Result<Box<dyn Engine>, EngineError> {
    Ok(formula(scene, setup, |start, _, t| bouncing(start, t, 0.8)))
}

/// An apex between two steps is missed by at most g dt²/8 of height, and by nothing in time.
#[test]
fn exact_bounces_are_seen_to_the_step() {
    let missed = 10.0 / 8.0 / (240.0 * 240.0) + 1e-9;
    let perfect = with(elastic, "02", 240);
    assert!(value(&perfect, "worst_apex_m") < missed, "{perfect:?}");
    assert!((value(&perfect, "bounces") - 111.0).abs() < 0.5);
    assert!(value(&perfect, "deepest_m") < 1e-12);
    assert!(!perfect.iter().any(|(name, _)| name == "half_height_at_s"));

    let damped = with(damped, "03", 240);
    assert!(value(&damped, "apex_err_rel_h0") < missed, "{damped:?}");
    assert!(value(&damped, "apex_time_err_s") < 1e-9, "{damped:?}");

    // The last landing above 0.02 m/s is the 24th, at 0.0211 m/s: 0.0169 s before rest. If the steps jump over it, the 23rd
    // is taken, 0.0042 s earlier.
    let fine = with(self::damped, "03", 3840);
    let rest = value(&fine, "rest_time_s");
    assert!((0.0165..0.0215).contains(&rest), "{rest}");
}
