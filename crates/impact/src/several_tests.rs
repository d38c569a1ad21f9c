//! Laws of several contacts at once, over random heaps.

use carom_math::{Vec2, cross, vec2};
use proptest::prelude::*;

use super::{
    ImpactBody, ImpactContact, ImpactLaw, SharedContact, blend, generalised_reflections,
    newton_lcp, resolve,
};
use crate::tests::heaps::{self, body, energy, least_opening};

/// Smooth bodies and contacts.
fn heap() -> impl Strategy<Value = (Vec<ImpactBody>, Vec<SharedContact>)> {
    heaps::heap(2.0, 8, (0.0..1.0_f64, Just(0.0)))
}

/// The same without immovable bodies.
fn free_heap() -> impl Strategy<Value = (Vec<ImpactBody>, Vec<SharedContact>)> {
    heap().prop_filter("no body is immovable", |(bodies, _)| {
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
            prop_assert!(after.impulses.iter().all(|j| j.0 >= 0.0));
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
        prop_assert!((after.impulses[0].0 - single.normal_impulse).abs() <= 1e-12 * SCALE);
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

#[test]
fn two_bodies_that_four_contacts_hold_and_a_third_one_stop() {
    let bodies = [
        body(
            0.50658677654104,
            0.21038780910532406,
            vec2(0.0026007348082136383, -0.6281402077753043),
            vec2(0.04176844812695691, 0.709694986212173),
            0.49917925778830174,
        ),
        body(
            42.96653462317391,
            14.876432571433511,
            vec2(-0.9817799402302846, -0.17661235279518522),
            vec2(-1.7793736861824525, 0.0),
            0.0,
        ),
        body(
            0.8999754991222896,
            1.423049121300508,
            vec2(1.2425800298912997, 1.035711336527252),
            vec2(0.4238860183056028, -1.0720572093453486),
            1.8345845645524865,
        ),
    ];
    let touch = |a, b, point, normal| SharedContact {
        a,
        b,
        contact: ImpactContact {
            point,
            normal,
            restitution: 0.0,
            friction: 0.0,
        },
    };
    let contacts = [
        touch(
            2,
            1,
            vec2(1.0862411227153892, 0.8133818144106565),
            vec2(0.47085946928584504, -0.8822082294922511),
        ),
        touch(
            0,
            2,
            vec2(1.9297969915466535, 0.0),
            vec2(0.013277145192553437, 0.9999118548229818),
        ),
        touch(
            0,
            1,
            vec2(0.40438956287997724, 0.8717024965241938),
            vec2(-0.8118459920000323, -0.5838716342429076),
        ),
        touch(
            1,
            2,
            vec2(1.9863683069995497, -0.4041072985105434),
            vec2(-0.18429337991235148, -0.9828712785103051),
        ),
        touch(
            1,
            2,
            vec2(0.1394869372863602, 1.7276485065671623),
            vec2(0.6444506133915899, -0.764645935645514),
        ),
        touch(
            1,
            2,
            vec2(0.0, 1.1562370578902157),
            vec2(-0.999996058599902, -0.002807629722971626),
        ),
    ];
    let after = newton_lcp(&bodies, &contacts);
    let least = least_opening(&after, &contacts);
    assert!(least > -1e-14, "closes by {least:e} m/s");
}
