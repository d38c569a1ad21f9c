//! A disc and a corner 30 nm apart: a last bit before the contact the gap, a multiple of 1.1e-16 m, lay 1.7e-23 m above the
//! tolerance and stayed there, while the search went on by steps of 6e-24 s until its budget was spent.

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_geometry::{ConvexPolygon, Shape};
use carom_math::{Rot, trig, vec2};
use carom_tests::scenes::disc;

#[test]
fn a_gap_that_rounds_to_the_tolerance_closes() {
    let pentagon = Shape::from(ConvexPolygon::regular(5, 0.5).expect("a pentagon"));
    let disc = Shape::from(disc(0.5));
    let place = vec2(25.436_337_539_180_208, 11.571_613_285_824_723);
    let a = Motion {
        velocity: vec2(-2.986_715_780_556_607_6, -1.154_387_342_622_191_3),
        acceleration: vec2(0.149_335_789_027_830_37, 0.057_719_367_131_109_57),
        rotation: Rot::from_angle(trig::atan2(
            0.521_965_050_225_342_3,
            0.852_966_872_945_987_2,
        )),
        spin: -3.919_192_445_026_207_2,
        angular_acceleration: 0.195_959_622_251_310_36,
        ..Motion::resting(place)
    };
    let b = Motion {
        velocity: vec2(1.330_127_354_915_705_3, 0.030_586_135_214_005_97),
        acceleration: vec2(-0.066_506_367_745_785_26, -0.001_529_306_760_700_298_6),
        rotation: Rot::from_angle(trig::atan2(
            0.421_376_155_387_271_6,
            0.906_885_955_162_523_2,
        )),
        spin: 0.054_131_720_407_999_03,
        angular_acceleration: -0.002_706_586_020_399_951_7,
        ..Motion::resting(vec2(25.052_638_687_005_89, 10.648_155_097_280_547))
    };
    for nearer in 0..100 {
        let away = vec2(1e-10, 0.7e-10) * f64::from(nearer);
        let a = Motion {
            centre: place + away,
            ..a
        };
        let found = time_of_impact(&pentagon, &a, &disc, &b, 1e-6);
        let TimeOfImpact::Hit(hit) = found else {
            panic!("they meet within 12 ns: {found:?}");
        };
        let gap = 2.980_195_468e-8 + 1.0304e-10 * f64::from(nearer);
        assert!((hit.time * 2.754_171_1 - gap).abs() < 1e-9, "{hit:?}");
    }
}
