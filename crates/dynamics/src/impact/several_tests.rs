//! Laws of several contacts at once, over random heaps.

use carom_math::{Vec2, cross, vec2};
use proptest::prelude::*;

use super::heaps::{self, energy, least_opening};
use super::{
    ImpactBody, ImpactContact, ImpactLaw, SharedContact, blend, generalised_reflections,
    newton_lcp, resolve,
};

/// Smooth bodies and contacts.
fn heap() -> impl Strategy<Value = (Vec<ImpactBody>, Vec<SharedContact>)> {
    heaps::heap(2.0, 8, (0.0..1.0_f64, Just(0.0)))
}

/// The same with nobody immovable.
fn free_heap() -> impl Strategy<Value = (Vec<ImpactBody>, Vec<SharedContact>)> {
    heap().prop_filter("nobody is immovable", |(bodies, _)| {
        bodies[0].inverse_mass > 0.0
    })
}

fn momentum(bodies: &[ImpactBody]) -> (Vec2, f64) {
    let free = bodies.iter().filter(|body| body.inverse_mass > 0.0);
    free.fold((Vec2::ZERO, 0.0), |(p, l), body| {
        let linear = body.velocity / body.inverse_mass;
        let angular = cross(body.centre, linear) + body.spin / body.inverse_inertia;
        (p + linear, l + angular)
    })
}

/// Random contacts may be parallel to 1e-4, and be struck a thousand times: what doubles lose there.
const ROUNDING: f64 = 1e-11;

/// Sums of masses, speeds and arms of a heap stay below this, in SI units.
const SCALE: f64 = 1e4;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn nothing_closes_and_no_energy_is_gained((bodies, contacts) in heap()) {
        let before = energy(&bodies);
        for after in [blend(&bodies, &contacts), generalised_reflections(&bodies, &contacts)] {
            let least = least_opening(&after, &contacts);
            prop_assert!(least > -100.0 * ROUNDING, "closes by {least:e}");
            prop_assert!(energy(&after.bodies) <= before * (1.0 + ROUNDING));
            prop_assert!(after.normal_impulses.iter().all(|j| *j >= 0.0));
        }
        let reflected = generalised_reflections(&bodies, &contacts);
        let change = energy(&reflected.bodies) - before;
        prop_assert!(reflected.exhausted || change.abs() <= ROUNDING * before, "{change:e} of {before:e}");
    }

    #[test]
    fn free_heaps_keep_their_momentum((bodies, contacts) in free_heap()) {
        let (p, l) = momentum(&bodies);
        for law in [newton_lcp, blend, generalised_reflections] {
            let after = law(&bodies, &contacts).bodies;
            let (q, m) = momentum(&after);
            // Arms are below 3 m, radii of gyration below 2 m.
            let largest = after.iter().map(|body| {
                (body.velocity.length() + 6.0 * body.spin.abs()) / body.inverse_mass
            });
            let scale = largest.fold(1.0, f64::max);
            prop_assert!((q - p).length() < ROUNDING * scale, "{:e}", (q - p).length() / scale);
            prop_assert!((m - l).abs() < ROUNDING * scale, "{:e}", (m - l).abs() / scale);
        }
    }

    #[test]
    fn the_order_of_contacts_does_not_matter((bodies, contacts) in heap()) {
        let backwards: Vec<SharedContact> = contacts.iter().rev().copied().collect();
        for law in [newton_lcp, blend, generalised_reflections] {
            let (one, other) = (law(&bodies, &contacts), law(&bodies, &backwards));
            for (x, y) in one.bodies.iter().zip(&other.bodies) {
                prop_assert!((x.velocity - y.velocity).length() < 1e-9);
                prop_assert!((x.spin - y.spin).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn one_contact_follows_the_single_law((bodies, contacts) in heap()) {
        let only = [contacts[0]];
        let shared = only[0];
        let single = resolve(ImpactLaw::Newton, &bodies[shared.a], &bodies[shared.b], &shared.contact);
        let after = blend(&bodies, &only);
        prop_assert!((after.normal_impulses[0] - single.normal_impulse).abs() <= 1e-12 * SCALE);
        prop_assert!((after.bodies[shared.a].velocity - single.a.velocity).length() < 1e-12);
        prop_assert!((after.bodies[shared.b].velocity - single.b.velocity).length() < 1e-12);
    }
}

#[test]
fn an_impact_runs_through_a_hundred_touching_discs() {
    let disc = |k: u8, speed: f64| ImpactBody {
        inverse_mass: 1.0,
        inverse_inertia: 8.0,
        centre: vec2(f64::from(k), 0.0),
        velocity: vec2(speed, 0.0),
        spin: 0.0,
    };
    let bodies: Vec<ImpactBody> = (0..100)
        .map(|k| disc(k, if k == 0 { 2.0 } else { 0.0 }))
        .collect();
    let touch = |k: u8| SharedContact {
        a: usize::from(k),
        b: usize::from(k) + 1,
        contact: ImpactContact {
            point: vec2(f64::from(k) + 0.5, 0.0),
            normal: Vec2::X,
            restitution: 1.0,
            friction: 0.0,
        },
    };
    let contacts: Vec<SharedContact> = (0..99).map(touch).collect();
    let after = blend(&bodies, &contacts).bodies;
    assert_eq!(after[99].velocity, vec2(2.0, 0.0));
    assert!(after[..99].iter().all(|body| body.velocity == Vec2::ZERO));
}

#[test]
fn a_box_that_lands_flat_without_restitution_lies_still() {
    let floor = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
    let landing = ImpactBody {
        inverse_mass: 1.0,
        inverse_inertia: 48.0 / 17.0,
        centre: vec2(0.1, 0.25),
        velocity: vec2(0.3, -3.0),
        spin: 1.5,
    };
    let corner = |x: f64| SharedContact {
        a: 0,
        b: 1,
        contact: ImpactContact {
            point: vec2(x, 0.0),
            normal: Vec2::Y,
            restitution: 0.0,
            friction: 0.0,
        },
    };
    let after = blend(&[floor, landing], &[corner(-0.9), corner(1.1)]).bodies[1];
    assert_eq!((after.velocity, after.spin), (vec2(0.3, 0.0), 0.0));
}
