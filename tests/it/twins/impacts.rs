//! Times of impact against sampled time.

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_math::{Rot, SimTime, vec2};
use proptest::prelude::*;

use super::{naive, shape, solid};

fn motion(x: f64) -> impl Strategy<Value = Motion> {
    (
        (-0.3..0.3_f64, -1.0..1.0_f64),
        (0.2..4.0_f64, -1.5..1.5_f64),
        (-6.0..6.0_f64, -3.0..3.0_f64),
    )
        .prop_map(move |(place, velocity, (spin, turn))| Motion {
            velocity: vec2(-x.signum() * velocity.0, velocity.1),
            acceleration: vec2(0.0, if x > 0.0 { -9.81 } else { 0.0 }),
            spin,
            rotation: Rot::from_angle(turn),
            ..Motion::resting(vec2(x + place.0, place.1))
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_time_of_impact_is_neither_late_nor_invented(
        a in shape(), b in shape(), motion_a in motion(-2.0), motion_b in motion(2.0),
    ) {
        let horizon = 1.5;
        let answer = time_of_impact(&a, &motion_a, &b, &motion_b, horizon);
        let gap = |t: f64| {
            let time = SimTime::from_secs(t);
            naive::distance(&solid(&a, motion_a.pose_at(time)), &solid(&b, motion_b.pose_at(time)))
        };
        let until = match &answer {
            TimeOfImpact::Hit(hit) => {
                // The certificate: they touch at that instant, to rounding.
                prop_assert!(gap(hit.time) < 1e-13, "{:e} m apart at {answer:?}", gap(hit.time));
                prop_assert!(hit.gap_rate < 0.0);
                prop_assert!((hit.normal.length() - 1.0).abs() < 1e-12);
                hit.time
            }
            TimeOfImpact::Clear => horizon,
            TimeOfImpact::Touching(_) => {
                prop_assert!(gap(0.0) < 1e-13);
                return Ok(());
            }
            TimeOfImpact::Unresolved { .. } => panic!("unresolved: {a:?} {motion_a:?} {b:?} {motion_b:?}"),
        };
        // An overlap at the start that opens is left out until it has opened.
        let mut open = gap(0.0) > 0.0;
        for i in 0..400 {
            let t = until * f64::from(i) / 400.0;
            let apart = gap(t);
            prop_assert!(!open || apart > 0.0 || t > until - 1e-13, "overlap at {t} s, before {until} s: {answer:?}");
            open |= apart > 0.0;
        }
    }
}
