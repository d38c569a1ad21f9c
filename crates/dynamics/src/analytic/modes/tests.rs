//! Closed forms and laws of contact groups.

use super::balance::balance;
use super::faces::Faces;
use super::naive::all_balances;
use super::*;
use carom_math::{cross, vec2};
use proptest::prelude::*;

const G: f64 = 9.81;

/// A body, and its acceleration by all that is no contact.
type Pulled = (ImpactBody, (Vec2, f64));

fn fixed() -> Pulled {
    let body = ImpactBody::immovable(vec2(0.0, -1.0), Vec2::ZERO, 0.0);
    (body, (Vec2::ZERO, 0.0))
}

fn block(mass: f64, width: f64, height: f64, centre: Vec2, pull: Vec2) -> Pulled {
    let body = ImpactBody {
        inverse_mass: mass.recip(),
        inverse_inertia: 12.0 / (mass * (width * width + height * height)),
        centre,
        ..fixed().0
    };
    (body, (pull, 0.0))
}

fn disc(radius: f64, share: f64, pull: Vec2) -> Pulled {
    let body = ImpactBody {
        inverse_mass: 1.0,
        inverse_inertia: (share * radius * radius).recip(),
        centre: vec2(0.0, radius),
        ..fixed().0
    };
    (body, (pull, 0.0))
}

/// B lies flat on A from x₁ to x₂ at height y; A reaches over `under`, B over `over`.
pub(super) fn flat(
    bodies: (usize, usize),
    y: f64,
    under: [f64; 2],
    over: [f64; 2],
    friction: f64,
) -> Touch {
    let (low, high) = (under[0].max(over[0]), under[1].min(over[1]));
    // The tangent is perp(up): to the left.
    let edge = |x: [f64; 2]| Feature::Edge {
        low: high - x[1],
        high: high - x[0],
    };
    Touch {
        bodies,
        normal: vec2(0.0, 1.0),
        points: [vec2(high, y), vec2(low, y)].into(),
        features: (edge(under), edge(over)),
        friction,
    }
}

/// B is round and touches A at x.
fn round(bodies: (usize, usize), point: Vec2, under: [f64; 2], friction: f64) -> Touch {
    Touch {
        bodies,
        normal: vec2(0.0, 1.0),
        points: [point].into_iter().collect(),
        features: (
            Feature::Edge {
                low: point.x - under[1],
                high: point.x - under[0],
            },
            Feature::Round,
        ),
        friction,
    }
}

const FLOOR: [f64; 2] = [-1000.0, 1000.0];

fn pull(slope: f64) -> Vec2 {
    carom_math::Rot::from_degrees(slope) * vec2(0.0, -G)
}

/// A flat block on an incline, in the incline's frame: downhill is +x.
fn on_incline(slope: f64, friction: f64, speed: f64) -> (Vec<Pulled>, Vec<Touch>) {
    let mut body = block(1.0, 1.0, 0.25, vec2(0.0, 0.125), pull(slope));
    body.0.velocity.x = speed;
    (
        vec![fixed(), body],
        vec![flat((0, 1), 0.0, FLOOR, [-0.5, 0.5], friction)],
    )
}

fn solve(bodies: &[Pulled], touches: &[Touch]) -> Result<GroupMove, NotMine> {
    let (bodies, pulls): (Vec<_>, Vec<_>) = bodies.iter().copied().unzip();
    solve_modes(&bodies, &pulls, touches, 0.0)
}

fn modes_of((bodies, touches): &(Vec<Pulled>, Vec<Touch>)) -> GroupMove {
    solve(bodies, touches).expect("a group of ours")
}

fn near(found: f64, wanted: f64) {
    let off = (found - wanted).abs();
    assert!(
        off <= 1e-14 * wanted.abs().max(1.0),
        "{found}, not {wanted}"
    );
}

#[test]
fn a_block_below_its_critical_friction_slides() {
    let found = modes_of(&on_incline(30.0, 0.5, 0.0));
    let (sin, cos) = carom_math::trig::sin_cos(core::f64::consts::PI / 6.0);
    near(found.bodies[1].acceleration.x, G * (sin - 0.5 * cos));
    assert_eq!(found.bodies[1].acceleration.y, 0.0);
    assert_eq!(found.bodies[1].angular_acceleration, 0.0);
    assert_eq!(found.touches[0].mode, ContactMode::Slide);
}

#[test]
fn a_block_above_its_critical_friction_rests() {
    let found = modes_of(&on_incline(30.0, 0.6, 0.0));
    assert_eq!(found.bodies[1], BodyMove::default());
    assert_eq!(
        (found.touches[0].mode, found.change),
        (ContactMode::Rest, None)
    );
}

#[test]
fn a_block_that_slides_on_the_level_stops_at_v_over_mu_g() {
    let found = modes_of(&on_incline(0.0, 0.3, 3.0));
    let change = found.change.expect("it stops");
    near(change, 3.0 / (0.3 * G));
}

#[test]
fn a_disc_rolls_or_slips_by_its_friction() {
    for (slope, friction, share, mode) in [
        (10.0, 0.5, 0.5, ContactMode::Roll),
        (30.0, 0.1, 0.5, ContactMode::Slide),
        (60.0, 0.9, 0.25, ContactMode::Roll),
    ] {
        let group = (
            vec![fixed(), disc(0.25, share, pull(slope))],
            vec![round((0, 1), Vec2::ZERO, FLOOR, friction)],
        );
        let found = modes_of(&group);
        let (sin, cos) = carom_math::trig::sin_cos(slope.to_radians());
        let (a, alpha) = if mode == ContactMode::Roll {
            (G * sin / (1.0 + share), -G * sin / (1.0 + share) / 0.25)
        } else {
            (
                G * (sin - friction * cos),
                -friction * G * cos / (share * 0.25),
            )
        };
        near(found.bodies[1].acceleration.x, a);
        near(found.bodies[1].angular_acceleration, alpha);
        assert_eq!(found.touches[0].mode, mode);
    }
}

#[test]
fn a_disc_that_touches_a_rounding_beside_its_centre_rolls() {
    // The normal force turned it at 1.7e-15 rad/s², and its roll was called a slide.
    let mut body = disc(0.05, 0.5, pull(0.0));
    (body.0.velocity, body.0.spin) = (vec2(0.2, 0.0), -4.0);
    let found = modes_of(&(
        vec![fixed(), body],
        vec![round((0, 1), vec2(2.2e-19, 0.0), FLOOR, 5.0)],
    ));
    assert_eq!(found.touches[0].mode, ContactMode::Roll);
    let turn = found.bodies[1].angular_acceleration;
    assert!(turn.abs() < 1e-15, "it turns at {turn} rad/s²");
}

#[test]
fn a_spinning_disc_comes_to_roll() {
    let mut body = disc(0.25, 0.5, pull(0.0));
    body.0.spin = -40.0;
    let found = modes_of(&(
        vec![fixed(), body],
        vec![round((0, 1), Vec2::ZERO, FLOOR, 0.3)],
    ));
    // Slip v + ω r grows by µg (1 + 1/share).
    near(found.change.expect("it rolls"), 10.0 / (0.3 * G * 3.0));
}

#[test]
fn a_block_on_a_plank_sticks_when_both_are_as_fast() {
    let (mut top, plank) = (
        block(1.0, 0.5, 0.25, vec2(0.0, 0.625), pull(0.0)),
        block(1000.0, 40.0, 0.5, vec2(0.0, 0.25), pull(0.0)),
    );
    top.0.velocity.x = 2.0;
    let group = (
        vec![fixed(), plank, top],
        vec![
            flat((0, 1), 0.0, FLOOR, [-20.0, 20.0], 0.0),
            flat((1, 2), 0.5, [-20.0, 20.0], [-0.25, 0.25], 0.2),
        ],
    );
    let found = modes_of(&group);
    near(
        found.change.expect("it sticks"),
        2.0 / (0.2 * G * (1.0 + 1e-3)),
    );
    near(found.bodies[1].acceleration.x, 0.2 * G * 1e-3);
}

#[test]
fn a_column_of_ten_is_exactly_still() {
    let mut bodies = vec![fixed()];
    let mut touches = Vec::new();
    for k in 0..10_usize {
        let y = f64::from(u32::try_from(k).expect("few")) * 0.7;
        let shift = 0.01 * y;
        bodies.push(block(1.0, 1.0, 0.7, vec2(shift, y + 0.35), pull(0.0)));
        let under = if k == 0 {
            FLOOR
        } else {
            [shift - 0.507, shift + 0.493]
        };
        touches.push(flat((k, k + 1), y, under, [shift - 0.5, shift + 0.5], 0.3));
    }
    let found = solve(&bodies, &touches).expect("a group of ours");
    assert!(found.bodies.iter().all(|body| *body == BodyMove::default()));
    near(found.touches[0].normal.iter().sum(), 10.0 * G);
    near(found.touches[9].normal.iter().sum(), G);
}

#[test]
fn a_column_that_is_carried_along_stays_one() {
    // Five blocks on a frictionless floor, all as fast: nothing accelerates.
    let mut bodies = vec![fixed()];
    let mut touches = Vec::new();
    for k in 0..5_usize {
        let y = f64::from(u32::try_from(k).expect("few"));
        let mut body = block(1.0 + y, 1.0, 1.0, vec2(0.0, y + 0.5), pull(0.0));
        body.0.velocity.x = 0.3;
        bodies.push(body);
        let under = if k == 0 { FLOOR } else { [-0.5, 0.5] };
        let friction = if k == 0 { 0.0 } else { 0.4 };
        touches.push(flat((k, k + 1), y, under, [-0.5, 0.5], friction));
    }
    let found = solve(&bodies, &touches).expect("a group of ours");
    for (k, body) in found.bodies.iter().enumerate().skip(1) {
        assert_eq!(body.velocity, vec2(0.3, 0.0), "block {k}");
        assert_eq!(
            (body.acceleration, body.angular_acceleration),
            (Vec2::ZERO, 0.0),
            "block {k}"
        );
    }
    assert_eq!(found.touches[0].mode, ContactMode::Slide);
    assert_eq!(found.touches[1].mode, ContactMode::Stick);
}

#[test]
fn a_disc_leaves_the_end_of_an_edge() {
    let mut body = disc(0.25, 0.5, pull(0.0));
    body.0.velocity.x = 2.0;
    body.0.spin = -8.0;
    let found = modes_of(&(
        vec![fixed(), body],
        vec![round((0, 1), Vec2::ZERO, [-1.0, 3.0], 0.5)],
    ));
    assert_eq!(found.change, Some(1.5), "the edge ends");
    assert_eq!(found.touches[0].mode, ContactMode::Roll);
}

#[test]
fn a_block_that_slides_off_a_table_tips_when_its_load_passes_the_edge() {
    // With friction the load lies µ h/2 ahead of the centre.
    for friction in [0.0, 0.1] {
        let mut body = block(1.0, 1.0, 0.5, vec2(0.0, 0.25), pull(0.0));
        body.0.velocity.x = 2.0;
        let found = modes_of(&(
            vec![fixed(), body],
            vec![flat((0, 1), 0.0, [-10.0, 1.0], [-0.5, 0.5], friction)],
        ));
        let change = found.change.expect("it tips");
        let way = 1.0 - 0.25 * friction;
        let a = friction * G;
        let wanted = 2.0 * way / (2.0 + (4.0 - 2.0 * a * way).sqrt());
        let off = (change - wanted).abs();
        assert!(off < 1e-12 * wanted, "{change} not {wanted}");
    }
}

#[test]
fn a_slender_rod_that_slides_on_its_tip_has_no_accelerations() {
    // Painlevé: µ > 4/3 at the worst angle of a rod that slides forward.
    let (sin, cos) = carom_math::trig::sin_cos(core::f64::consts::FRAC_PI_3);
    let mut rod = block(1.0, 2.0, 1e-6, vec2(cos, sin), pull(0.0));
    rod.0.velocity.x = -1.0;
    let touch = Touch {
        bodies: (0, 1),
        normal: vec2(0.0, 1.0),
        points: [Vec2::ZERO].into_iter().collect(),
        features: (
            Feature::Edge {
                low: -9.0,
                high: 9.0,
            },
            Feature::Corner,
        ),
        friction: 1.6,
    };
    let group = (vec![fixed(), rod], vec![touch]);
    assert_eq!(solve(&group.0, &group.1), Err(NotMine::Painleve));
}

#[test]
fn a_block_beyond_its_tipping_angle_turns() {
    for (slope, stays) in [(44.9, true), (45.1, false)] {
        let body = block(1.0, 1.0, 1.0, vec2(0.0, 0.5), pull(slope));
        let found = solve(
            &[fixed(), body],
            &[flat((0, 1), 0.0, FLOOR, [-0.5, 0.5], 2.0)],
        );
        if stays {
            assert_eq!(found.expect("rests").bodies[1], BodyMove::default());
        } else {
            assert_eq!(found, Err(NotMine::Turns));
        }
    }
}

/// A tower on a floor: blocks, and a disc on top if asked for.
fn tower() -> impl Strategy<Value = (Vec<Pulled>, Vec<Touch>)> {
    let level = (
        0.1..10.0_f64,
        0.5..2.0_f64,
        0.3..1.0_f64,
        -0.2..0.2_f64,
        prop_oneof![Just(0.0), -1.0..1.0_f64],
        prop_oneof![Just(0.0), 0.05..0.9_f64],
    );
    let top = proptest::option::of((0.2..0.5_f64, -4.0..4.0_f64, 0.05..0.9_f64));
    (prop::collection::vec(level, 1..3), top, -40.0..40.0_f64).prop_map(|(levels, top, slope)| {
        let (mut bodies, mut touches) = (vec![fixed()], Vec::new());
        let (mut y, mut under) = (0.0, FLOOR);
        for (mass, width, height, shift, speed, friction) in levels {
            let mut body = block(
                mass,
                width,
                height,
                vec2(shift, y + 0.5 * height),
                pull(slope),
            );
            body.0.velocity.x = speed;
            let over = [shift - 0.5 * width, shift + 0.5 * width];
            let ends = (bodies.len() - 1, bodies.len());
            touches.push(flat(ends, y, under, over, friction));
            bodies.push(body);
            y += height;
            under = over;
        }
        if let Some((radius, spin, friction)) = top {
            let mut body = disc(radius, 0.5, pull(slope));
            let x = 0.4 * under[0] + 0.6 * under[1];
            body.0.centre = vec2(x, y + radius);
            body.0.spin = spin;
            let ends = (bodies.len() - 1, bodies.len());
            touches.push(round(ends, vec2(x, y), under, friction));
            bodies.push(body);
        }
        (bodies, touches)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn accelerations_are_those_of_the_slow_twin((bodies, touches) in tower()) {
        let (bodies, pulls): (Vec<_>, Vec<_>) = bodies.into_iter().unzip();
        let slips = faces::slips(&bodies, &touches, 0.0).expect("all touch");
        let faces = Faces::new(&bodies, &pulls, &touches);
        let twins = all_balances((&bodies, &pulls), &touches, &slips.iter().map(|s| if *s == 0.0 { 0.0 } else { s.signum() }).collect::<Vec<_>>());
        match balance(&faces, &tangents(&touches, &slips)) {
            Ok(found) => {
                let physical: Vec<f64> = found.state.iter().enumerate().map(|(k, x)| {
                    let body = &bodies[k / 3];
                    x * if k % 3 == 2 { body.inverse_inertia.sqrt() } else { body.inverse_mass.sqrt() }
                }).collect();
                let off = |twin: &Vec<f64>| twin.iter().zip(&physical).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let best = twins.iter().map(off).fold(f64::INFINITY, f64::min);
                // Near a configuration of Painlevé's accelerations are thousands of g, and known as a part of that.
                let size = physical.iter().fold(9.81, |most: f64, a| most.max(a.abs()));
                prop_assert!(best < 1e-9 * size, "off by {best:e}, {} twins: {physical:?} {twins:?}", twins.len());
            }
            Err(why) => prop_assert!(why == NotMine::Painleve, "{why:?} {} {twins:?}", twins.len()),
        }
    }

    #[test]
    fn the_conditions_of_signorini_and_coulomb_hold((bodies, touches) in tower()) {
        let Ok(found) = solve(&bodies, &touches) else { return Ok(()) };
        let mut momentum = vec![(Vec2::ZERO, 0.0); bodies.len()];
        for (touch, moved) in touches.iter().zip(&found.touches) {
            let t = perp(touch.normal);
            let load = moved.normal[0] + moved.normal[1];
            prop_assert!(moved.normal.iter().all(|n| *n >= 0.0));
            prop_assert!(moved.tangential.abs() <= touch.friction * load * (1.0 + 1e-12) + 1e-12);
            if moved.slip != 0.0 {
                prop_assert!(moved.tangential * moved.slip <= 0.0, "friction drives");
                prop_assert!((moved.tangential.abs() - touch.friction * load).abs() <= 1e-12 * (1.0 + load));
            }
            for (k, &point) in touch.points.iter().enumerate() {
                let mut force = touch.normal * moved.normal[k];
                if k == 0 {
                    force += t * moved.tangential;
                }
                for (place, sign) in [(touch.bodies.0, -1.0), (touch.bodies.1, 1.0)] {
                    momentum[place].0 += sign * force;
                    momentum[place].1 += sign * cross(point - bodies[place].0.centre, force);
                }
            }
        }
        // Newton and Euler, body by body: with ± forces that is momentum, too.
        for (((body, (pull, _)), moved), (force, torque)) in bodies.iter().zip(&found.bodies).zip(momentum) {
            if body.inverse_mass == 0.0 {
                continue;
            }
            let size = 1e-12 * (G + force.length() * body.inverse_mass);
            let off = *pull + force * body.inverse_mass - moved.acceleration;
            prop_assert!(off.length() < size, "{off}");
            let off = torque * body.inverse_inertia - moved.angular_acceleration;
            prop_assert!(off.abs() < 10.0 * size * body.inverse_inertia / body.inverse_mass, "{off:e}");
        }
    }

    #[test]
    fn a_mirrored_group_moves_mirrored((bodies, touches) in tower()) {
        let flip = |v: Vec2| vec2(-v.x, v.y);
        let mirrored: Vec<Pulled> = bodies.iter().map(|(body, (pull, twist))| {
            let body = ImpactBody {
                centre: flip(body.centre), velocity: flip(body.velocity), spin: -body.spin, ..*body
            };
            (body, (flip(*pull), *twist))
        }).collect();
        let turned = |feature| match feature {
            Feature::Edge { low, high } => Feature::Edge { low: -high, high: -low },
            other => other,
        };
        let flipped: Vec<Touch> = touches.iter().map(|touch| Touch {
            points: touch.points.iter().map(|p| flip(*p)).collect(),
            features: (turned(touch.features.0), turned(touch.features.1)),
            ..touch.clone()
        }).collect();
        let (one, other) = (solve(&bodies, &touches), solve(&mirrored, &flipped));
        prop_assert_eq!(one.is_ok(), other.is_ok());
        if let (Ok(one), Ok(other)) = (one, other) {
            for (a, b) in one.bodies.iter().zip(&other.bodies) {
                prop_assert!((a.acceleration - flip(b.acceleration)).length() < 1e-12 * G);
            }
            let times = (one.change, other.change);
            if let (Some(x), Some(y)) = times {
                // The rounding of a place, 1e-15 m, over a slip that ends at 0.1 mm/s.
                prop_assert!((x - y).abs() <= 1e-9 * x + 1e-11, "{x} {y}");
            }
        }
    }
}
