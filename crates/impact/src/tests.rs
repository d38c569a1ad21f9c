//! Laws that every impact obeys, whatever the bodies, the arm and the material.

pub(super) mod heaps;

use carom_math::{Vec2, cross, perp, vec2};
use proptest::prelude::*;

use super::{ImpactBody, ImpactContact, ImpactLaw, newton, poisson, resolve, stronge};

/// A body near the origin, of up to 1e12 times the mass of another.
fn body() -> impl Strategy<Value = ImpactBody> {
    (
        (-6.0..6.0_f64, 0.01..100.0_f64),
        (-2.0..2.0_f64, -2.0..2.0_f64),
        (-10.0..10.0_f64, -10.0..10.0_f64, -20.0..20.0_f64),
    )
        .prop_map(|((exponent, gyration), centre, motion)| {
            let mass = carom_math::trig::pow(10.0, exponent);
            ImpactBody {
                inverse_mass: mass.recip(),
                inverse_inertia: (mass * gyration).recip(),
                centre: vec2(centre.0, centre.1),
                velocity: vec2(motion.0, motion.1),
                spin: motion.2,
            }
        })
}

/// A contact at the origin, turned any way, with round numbers among the materials.
fn contact() -> impl Strategy<Value = ImpactContact> {
    let restitution = prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64];
    let friction = prop_oneof![Just(0.0), 0.0..2.0_f64, Just(1e6)];
    (-3.2..3.2_f64, restitution, friction).prop_map(|(angle, restitution, friction)| {
        ImpactContact {
            point: Vec2::ZERO,
            normal: carom_math::Rot::from_angle(angle).x_axis(),
            restitution,
            friction,
        }
    })
}

const LAWS: [ImpactLaw; 3] = [ImpactLaw::Stronge, ImpactLaw::Poisson, ImpactLaw::Newton];

fn momentum(b: &ImpactBody) -> (Vec2, f64) {
    let linear = b.velocity / b.inverse_mass;
    (linear, cross(b.centre, linear) + b.spin / b.inverse_inertia)
}

fn opening(a: &ImpactBody, b: &ImpactBody, contact: &ImpactContact) -> f64 {
    (b.velocity_of(contact.point) - a.velocity_of(contact.point)).dot(contact.normal)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn momentum_is_kept_at_any_mass_ratio(a in body(), b in body(), contact in contact()) {
        for law in LAWS {
            let after = resolve(law, &a, &b, &contact);
            let ((p_a, l_a), (p_b, l_b)) = (momentum(&a), momentum(&b));
            let ((q_a, m_a), (q_b, m_b)) = (momentum(&after.a), momentum(&after.b));
            let scale = p_a.length() + p_b.length();
            prop_assert!(((q_a + q_b) - (p_a + p_b)).length() <= 1e-14 * scale);
            let spin_scale = scale * 3.0 + a.spin.abs() / a.inverse_inertia + b.spin.abs() / b.inverse_inertia;
            prop_assert!(((m_a + m_b) - (l_a + l_b)).abs() <= 1e-14 * spin_scale);
        }
    }

    #[test]
    fn energetic_and_kinetic_restitution_never_gain_energy(a in body(), b in body(), contact in contact()) {
        for after in [stronge(&a, &b, &contact), poisson(&a, &b, &contact)] {
            let before = a.kinetic_energy() + b.kinetic_energy();
            prop_assert!(after.loss >= -1e-13 * before, "gained {} of {before}", -after.loss);
        }
    }

    #[test]
    fn the_loss_is_what_the_kinetic_energy_lacks(a in body(), b in body(), contact in contact()) {
        for law in LAWS {
            let after = resolve(law, &a, &b, &contact);
            let before = a.kinetic_energy() + b.kinetic_energy();
            let left = after.a.kinetic_energy() + after.b.kinetic_energy();
            let scale = before + left + after.loss.abs();
            prop_assert!((before - left - after.loss).abs() <= 1e-13 * scale);
        }
    }

    #[test]
    fn without_friction_newton_is_the_final_speed(a in body(), b in body(), contact in contact()) {
        let contact = ImpactContact { friction: 0.0, ..contact };
        let before = opening(&a, &b, &contact);
        for law in LAWS {
            let after = resolve(law, &a, &b, &contact);
            let speed = opening(&after.a, &after.b, &contact);
            let scale = a.velocity.length() + b.velocity.length() + 3.0 * (a.spin.abs() + b.spin.abs());
            if before < 0.0 {
                prop_assert!((speed + contact.restitution * before).abs() <= 1e-9 * scale);
            } else {
                prop_assert_eq!(after.normal_impulse, 0.0, "separating points get no impulse");
                prop_assert_eq!(after.a, a);
            }
        }
    }

    #[test]
    fn friction_stays_in_its_cone(a in body(), b in body(), contact in contact()) {
        for law in LAWS {
            let after = resolve(law, &a, &b, &contact);
            prop_assert!(after.normal_impulse >= 0.0);
            let limit = contact.friction * after.normal_impulse;
            prop_assert!(after.tangential_impulse.abs() <= limit * (1.0 + 1e-12));
        }
    }

    #[test]
    fn swapping_the_bodies_swaps_the_answer(a in body(), b in body(), contact in contact()) {
        let mirrored = ImpactContact { normal: -contact.normal, ..contact };
        for law in LAWS {
            let (one, two) = (resolve(law, &a, &b, &contact), resolve(law, &b, &a, &mirrored));
            prop_assert_eq!(one.normal_impulse, two.normal_impulse);
            prop_assert_eq!(one.tangential_impulse, two.tangential_impulse);
            prop_assert_eq!(one.a, two.b);
        }
    }
}

#[test]
fn newton_gains_energy_where_friction_turns_the_slip_and_the_others_do_not() {
    // Kane's rod: slender, 1 m and 1 kg, its end hits at 50 degrees while it slips.
    let rod = ImpactBody {
        inverse_mass: 1.0,
        inverse_inertia: 12.0,
        centre: carom_math::Rot::from_degrees(50.0) * vec2(0.5, 0.0),
        velocity: vec2(0.7, -1.0),
        spin: 0.0,
    };
    let floor = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
    let contact = ImpactContact {
        point: Vec2::ZERO,
        normal: Vec2::Y,
        restitution: 0.9,
        friction: 0.3,
    };
    let gained = |after: super::Outcome| -after.loss;
    assert!(
        gained(newton(&floor, &rod, &contact)) > 0.0,
        "the known fault of Newton's law"
    );
    assert!(gained(stronge(&floor, &rod, &contact)) <= 0.0);
    assert!(gained(poisson(&floor, &rod, &contact)) <= 0.0);
}

#[test]
fn two_immovable_bodies_exchange_nothing() {
    let left = ImpactBody::immovable(Vec2::ZERO, vec2(1.0, 0.0), 0.0);
    let right = ImpactBody::immovable(Vec2::X, vec2(-1.0, 0.0), 0.0);
    let contact = ImpactContact {
        point: vec2(0.5, 0.0),
        normal: Vec2::X,
        restitution: 1.0,
        friction: 1.0,
    };
    for law in LAWS {
        let after = resolve(law, &left, &right, &contact);
        assert_eq!(after.normal_impulse, 0.0);
        assert_eq!((after.a, after.b), (left, right));
    }
}

#[test]
fn thesis_3_3_ends_before_its_formula_and_this_is_it() {
    // j = −(1 + e) v_rel·n / (1/m_a + 1/m_b + (r_a×n)²/I_a + (r_b×n)²/I_b)
    let a = ImpactBody {
        inverse_mass: 0.5,
        inverse_inertia: 0.25,
        centre: vec2(-1.0, 0.5),
        velocity: vec2(2.0, 0.3),
        spin: 0.4,
    };
    let b = ImpactBody {
        inverse_mass: 2.0,
        inverse_inertia: 3.0,
        centre: vec2(0.7, -0.2),
        velocity: vec2(-1.0, 0.1),
        spin: -0.8,
    };
    let n = vec2(0.8, 0.6);
    let contact = ImpactContact {
        point: Vec2::ZERO,
        normal: n,
        restitution: 0.5,
        friction: 0.0,
    };
    let (r_a, r_b) = (-a.centre, -b.centre);
    let v = (b.velocity + perp(r_b) * b.spin) - (a.velocity + perp(r_a) * a.spin);
    let k = 0.5 + 2.0 + 0.25 * cross(r_a, n) * cross(r_a, n) + 3.0 * cross(r_b, n) * cross(r_b, n);
    let j = -1.5 * v.dot(n) / k;
    assert!((stronge(&a, &b, &contact).normal_impulse - j).abs() < 1e-14);
}

#[test]
fn flying_balls_scaled_by_twice_e_where_one_plus_e_is_right() {
    // Balls of 1 and 3 kg meet head on: with e = 0 they move on together, not through each other.
    let ball = |mass: f64, x: f64, v: f64| ImpactBody {
        inverse_mass: 1.0 / mass,
        inverse_inertia: 1.0,
        centre: vec2(x, 0.0),
        velocity: vec2(v, 0.0),
        spin: 0.0,
    };
    let (p, q) = (ball(1.0, -1.0, 4.0), ball(3.0, 1.0, 0.0));
    let contact = |restitution| ImpactContact {
        point: Vec2::ZERO,
        normal: Vec2::X,
        restitution,
        friction: 0.0,
    };
    let stuck = newton(&p, &q, &contact(0.0));
    assert_eq!((stuck.a.velocity.x, stuck.b.velocity.x), (1.0, 1.0));
    // With m_total = m_p + m_q, not m_p + m_p: speeds of unequal balls after e = 1/2.
    let half = newton(&p, &q, &contact(0.5));
    assert!((half.b.velocity.x - half.a.velocity.x - 2.0).abs() < 1e-15);
    assert!((half.a.velocity.x + 3.0 * half.b.velocity.x - 4.0).abs() < 1e-15);
}
