//! Paths of groups that turn, against closed forms and laws.

use core::f64::consts::PI;

use arrayvec::ArrayVec;
use carom_math::{Rot, SimTime, Vec2, cross, perp, vec2};

use super::*;
use crate::law::pendulum::tests::integrate;

const G: f64 = 9.81;

fn body(mass: f64, inertia: f64, place: &Place) -> ImpactBody {
    ImpactBody {
        inverse_mass: mass.recip(),
        inverse_inertia: inertia.recip(),
        centre: place.centre,
        velocity: place.velocity,
        spin: place.spin,
    }
}

/// Accelerations of bodies: a floor has none.
fn pulls_on(bodies: &[ImpactBody]) -> Vec<(Vec2, f64)> {
    let gravity = |body: &ImpactBody| if body.inverse_mass > 0.0 { -G } else { 0.0 };
    let pulls = bodies.iter().map(|body| (vec2(0.0, gravity(body)), 0.0));
    pulls.collect()
}

fn floor() -> (ImpactBody, Place) {
    let place = Place {
        centre: Vec2::ZERO,
        rotation: Rot::IDENTITY,
        velocity: Vec2::ZERO,
        spin: 0.0,
    };
    (ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0), place)
}

/// A corner at `tip` of body 1 on the floor's line y = 0.
fn on_floor(tip: Vec2, friction: f64) -> Contact {
    Contact {
        bodies: (0, 1),
        joints: ArrayVec::from_iter([Joint::Line {
            owner: End::A,
            normal: Vec2::Y,
            height: 0.0,
            ends: [f64::NEG_INFINITY, f64::INFINITY],
            tip,
            radius: 0.0,
            beside: ArrayVec::new(),
        }]),
        friction,
    }
}

/// A rod of length 2 with its lower end at the origin, at an angle from the vertical.
fn rod(angle: f64, spin: f64, slip: f64) -> Place {
    let rotation = Rot::from_angle(angle);
    let centre = rotation * Vec2::Y;
    Place {
        centre,
        rotation,
        velocity: vec2(slip, 0.0) + perp(centre) * spin,
        spin,
    }
}

/// The path of a rod under a friction, stretch by stretch, up to `seconds`; all that ended a stretch.
fn run(start: Place, friction: f64, seconds: f64) -> (Place, Vec<(f64, Tip)>) {
    let (floor_body, floor_place) = floor();
    let mut place = start;
    let (mut now, mut found) = (0.0, Vec::new());
    while now < seconds {
        let bodies = vec![floor_body, body(1.0, 1.0 / 3.0, &place)];
        let pulls = pulls_on(&bodies);
        let contacts = vec![on_floor(vec2(0.0, -1.0), friction)];
        let places = vec![floor_place, place];
        let tip = tip(
            bodies,
            pulls,
            places,
            vec![0.0, 1.0],
            contacts,
            SimTime::from_secs(now),
            1.0,
        )
        .expect("it tips");
        let step = tip.after.min(seconds - now);
        place = tip.path.places_after(step)[1];
        now += step;
        found.push((now, tip));
    }
    (place, found)
}

fn energy(place: &Place) -> f64 {
    0.5 * place.velocity.length_squared() + place.spin * place.spin / 6.0 + G * place.centre.y
}

#[test]
fn a_rod_that_tips_is_a_pendulum() {
    // θ″ = (3 g/4) sin θ, with θ from the top.
    let (angle, spin) = integrate(0.75 * G, 0.2 + PI, 0.3, 0.4);
    let start = rod(0.2, 0.3, 0.0);
    let (place, _) = run(start, 100.0, 0.4);
    let wanted = rod(angle - PI, spin, 0.0);
    let off = (place.centre - wanted.centre).length();
    assert!(off < 1e-11, "{off:e} m");
    assert!((place.spin - spin).abs() < 1e-11);
    let lost = energy(&place) - energy(&start);
    assert!(lost.abs() < 1e-13 * energy(&start), "{lost:e} J");
}

#[test]
fn on_ice_the_centre_falls_straight() {
    // Energy alone: ½ (1/3 + sin² θ) ω² = g (cos θ₀ − cos θ).
    let start = rod(0.3, 0.0, 0.0);
    let (place, found) = run(start, 0.0, 0.5);
    assert!(place.centre.x - start.centre.x < 1e-14);
    let (sin, fallen) = (place.rotation.sin(), start.centre.y - place.centre.y);
    let spin = (2.0 * G * fallen / (1.0 / 3.0 + sin * sin)).sqrt();
    assert!(
        (place.spin - spin).abs() < 1e-12,
        "{} not {spin}",
        place.spin
    );
    assert!(found.iter().all(|(_, tip)| tip.heat(tip.after) == 0.0));
}

#[test]
fn what_friction_takes_is_heat() {
    let start = rod(0.3, 0.0, 0.8);
    let (place, found) = run(start, 0.25, 0.6);
    let mut last = 0.0;
    let mut heat = 0.0;
    for (now, tip) in &found {
        heat += tip.heat(now - last);
        last = *now;
    }
    let lost = energy(&start) - energy(&place);
    assert!(heat > 0.1, "{heat}");
    assert!((lost - heat).abs() < 1e-12, "{lost} not {heat}");
    let slides = |tip: &Tip| matches!(tip.equations.holds[0].rub, Tangent::Slides(_));
    assert!(found.iter().any(|(_, tip)| slides(tip)));
}

#[test]
fn friction_holds_until_its_cone_is_left() {
    // N = m g (1 − 3 c)²/4 and T = (3/4) m g s (3 c − 2) from rest at the top: with µ = 0.2 it slips at 0.4 rad or so.
    let start = rod(1e-2, 0.0, 0.0);
    let (_, found) = run(start, 0.2, 1.6);
    let first = found
        .iter()
        .find(|(_, tip)| matches!(tip.equations.holds[0].rub, Tangent::Slides(_)));
    let (_, tip) = first.expect("it slips");
    let (sin, cos) = {
        let rotation = tip.path.places_after(0.0)[1].rotation;
        (rotation.sin(), rotation.cos())
    };
    let top = carom_math::trig::sin_cos(1e-2).1;
    // ω² = (3/2) g (c₀ − c)
    let squared = 1.5 * G * (top - cos);
    let alpha = 0.75 * G * sin;
    // Centre at (−s, c): its acceleration is α (−c, −s) − ω² (−s, c).
    let pull = vec2(
        -alpha * cos + squared * sin,
        G - alpha * sin - squared * cos,
    );
    assert!((pull.x.abs() - 0.2 * pull.y).abs() < 1e-11, "{pull}");
}

#[test]
fn a_disc_leaves_a_disc_where_the_textbook_says() {
    // Without friction: cos θ = 2/3 from rest at the top.
    let (floor_body, floor_place) = floor();
    let mut place = Place {
        centre: Rot::from_angle(-1e-4) * vec2(0.0, 1.5),
        rotation: Rot::IDENTITY,
        velocity: Vec2::ZERO,
        spin: 0.0,
    };
    let start = place.centre.y;
    let mut now = 0.0;
    loop {
        let contact = Contact {
            bodies: (0, 1),
            joints: ArrayVec::from_iter([Joint::Points {
                a: Vec2::ZERO,
                b: Vec2::ZERO,
                radii: (1.0, 0.5),
                cone: None,
            }]),
            friction: 0.0,
        };
        let bodies = vec![floor_body, body(2.0, 0.25, &place)];
        let pulls = pulls_on(&bodies);
        let time = SimTime::from_secs(now);
        let tip = tip(
            bodies,
            pulls,
            vec![floor_place, place],
            vec![0.0, 0.5],
            vec![contact],
            time,
            1.0,
        )
        .expect("it slides");
        place = tip.path.places_after(tip.after)[1];
        now += tip.after;
        if !tip.equations.holds[0].closed[0] {
            break;
        }
        let off = (place.centre.length() - 1.5).abs();
        assert!(off < 1e-13, "{off:e} m off the disc");
        assert!(now < 5.0);
        let height = place.centre.y;
        let kinetic = 0.5 * place.velocity.length_squared();
        assert!((kinetic - G * (start - height)).abs() < 1e-12);
        if tip.after < tip.path.length() {
            let cos = height / 1.5;
            let wanted = 2.0 / 3.0 * start / 1.5;
            assert!((cos - wanted).abs() < 1e-12, "{cos} not {wanted}");
        }
    }
}

#[test]
fn a_path_turned_as_a_whole_is_the_same_path() {
    let start = rod(0.4, 0.1, 0.5);
    let (place, _) = run(start, 0.3, 0.3);
    let angular = cross(place.centre, place.velocity) + place.spin / 3.0;
    let mirrored = Place {
        centre: vec2(-start.centre.x, start.centre.y),
        rotation: start.rotation.inverse(),
        velocity: vec2(-start.velocity.x, start.velocity.y),
        spin: -start.spin,
    };
    let (other, _) = run(mirrored, 0.3, 0.3);
    let turned = cross(other.centre, other.velocity) + other.spin / 3.0;
    assert!((angular + turned).abs() < 1e-13);
    assert!((place.centre.x + other.centre.x).abs() < 1e-13);
}

mod swings {
    use super::*;
    use proptest::prelude::*;

    /// A box on one of its lower corners, on a slope: about its middle, and where its corner is.
    fn stood(
        half: Vec2,
        angle: f64,
        spin: f64,
        slope: f64,
        friction: f64,
    ) -> ([Place; 2], Contact) {
        let (_, mut ground) = floor();
        ground.rotation = Rot::from_angle(slope);
        let low = if angle > 0.0 { -1.0 } else { 1.0 };
        let tip = vec2(low * half.x, -half.y);
        let rotation = Rot::from_angle(slope + angle);
        let centre = -(rotation * tip);
        let place = Place {
            centre,
            rotation,
            velocity: perp(centre) * spin,
            spin,
        };
        let mut contact = on_floor(tip, friction);
        let Joint::Line { beside, .. } = &mut contact.joints[0] else {
            unreachable!("it is a line");
        };
        beside.push(vec2(-tip.x, tip.y));
        beside.push(vec2(tip.x, -tip.y));
        ([ground, place], contact)
    }

    proptest! {
        /// The closed form against the collocation, which shares nothing with it but the forces of its last instant.
        #[test]
        fn a_swing_is_the_collocated_path(
            half in (0.1..1.0_f64, 0.1..1.0_f64), angle in -0.7..0.7_f64, spin in -3.0..3.0_f64, slope in -0.2..0.2_f64,
            friction in 0.3..3.0_f64, mass in 0.1..10.0_f64, above in any::<bool>(),
        ) {
            let half = vec2(half.0, half.1);
            let (places, mut contact) = stood(half, angle, spin, slope, friction);
            let (floor_body, _) = floor();
            let inertia = mass * half.length_squared() / 3.0;
            let mut bodies = vec![floor_body, body(mass, inertia, &places[1])];
            let (mut places, mut reaches) = (places.to_vec(), vec![0.0, half.length()]);
            if !above {
                // The same seen from the other side: the box is A, and the edge B's.
                contact.bodies = (1, 0);
                let Joint::Line { owner, .. } = &mut contact.joints[0] else {
                    unreachable!("it is a line");
                };
                *owner = End::B;
            }
            if friction > 1.5 {
                bodies.reverse();
                places.reverse();
                reaches.reverse();
                contact.bodies = (1 - contact.bodies.0, 1 - contact.bodies.1);
            }
            let pulls = pulls_on(&bodies);
            let holds = modes(&bodies, &pulls, &places, std::slice::from_ref(&contact), 1.0);
            prop_assume!(holds.is_ok());
            let (holds, _) = holds.expect("it is");
            let equations = Equations { bodies, pulls, contacts: vec![contact], holds };
            let start = SimTime::from_secs(1.0);
            let size = half.length();
            let found = swing(&equations, &places, &reaches, start, size);
            // Of all that sticks and stays closed.
            prop_assume!(found.is_some());
            let (swing, end) = found.expect("it is");
            let (path, wanted) = follow(&equations, &places, &reaches, start, (size, 1.0)).expect("forces");
            let after = |end: &roots::End| match end {
                roots::End::After(after, _) => Some(*after),
                _ => None,
            };
            match (&end, &wanted) {
                (roots::End::After(found, limit), roots::End::After(wanted, other)) => {
                    prop_assert!((found - wanted).abs() < 1e-10, "{found} s, not {wanted}");
                    prop_assert_eq!(core::mem::discriminant(limit), core::mem::discriminant(other));
                    if let (Limit::Corner { normal, at, .. }, Limit::Corner { normal: n, at: there, .. }) = (limit, other) {
                        prop_assert!((*normal - *n).length() + (*at - *there).length() < 1e-9);
                    }
                }
                (roots::End::Never(limit), roots::End::Never(other)) => {
                    prop_assert_eq!(core::mem::discriminant(limit), core::mem::discriminant(other));
                }
                (found, roots::End::Open) => {
                    prop_assert!(after(found).is_none_or(|after| after > path.length() - 1e-10), "{found:?}");
                }
                (found, wanted) => prop_assert!(false, "{found:?} not {wanted:?}"),
            }
            let length = after(&wanted).unwrap_or_else(|| path.length());
            let moving = usize::from(reaches[0] == 0.0);
            for k in 0..=8 {
                let t = length * f64::from(k) / 8.0;
                let (found, wanted) = (swing.places_after(t)[moving], path.places_after(t)[moving]);
                prop_assert!((found.centre - wanted.centre).length() < 1e-11 * (1.0 + length));
                prop_assert!((found.velocity - wanted.velocity).length() < 1e-10);
                prop_assert!((found.rotation.x_axis() - wanted.rotation.x_axis()).length() < 1e-10);
                let (there, here) = (swing.acceleration_after(moving, t), path.acceleration_after(moving, t));
                prop_assert!((there.0 - here.0).length() + (there.1 - here.1).abs() < 1e-7);
            }
        }
    }
}
