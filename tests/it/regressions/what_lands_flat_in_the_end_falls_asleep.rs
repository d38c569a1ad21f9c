//! A box that rocks to rest turns by the roundings of its last landings: by more than what counts as still, by less than what
//! opens a corner. It was given a path on which nothing moves nor ends, kept 1e-16 m/s, and never fell asleep: 1 to 3 of 200 boxes.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, put, surface};

/// Restitution and friction; height in m, angle, speed along the floor in m/s, spin in rad/s.
type Drop = (f64, f64, f64, f64, f64, f64);

#[rustfmt::skip]
const DROPS: [Drop; 6] = [
    (0.8, 0.2, 2.943_462_206_277_743_6, -1.228_512_648_052_476_6, 1.869_263_036_847_116_6, -3.830_977_107_083_577_4),
    (0.8, 0.2, 1.097_396_136_450_493_4, 1.899_637_490_617_732_5, -0.493_982_006_679_761_1, -4.751_013_867_106_39),
    (0.8, 0.2, 1.639_215_848_950_677_4, 0.375_272_151_859_209_9, -1.815_197_449_532_424_8, 0.408_697_603_125_026_45),
    (0.3, 0.5, 2.328_468_473_078_620_7, 2.347_419_254_030_936, -2.740_876_074_524_648, -1.087_891_832_962_051_3),
    (0.5, 0.5, 2.513_642_964_278_617, 2.961_725_203_931_814, -0.399_784_469_088_985_8, 1.391_639_646_301_964_5),
    (0.8, 0.5, 1.548_312_849_373_153_3, -0.830_071_112_891_978_2, -1.532_041_735_816_195_7, 0.723_153_381_400_148_7),
];

#[test]
fn what_lands_flat_in_the_end_falls_asleep() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for (restitution, friction, height, angle, speed, spin) in DROPS {
            let settings = Settings {
                mode,
                ..Settings::default()
            };
            let mut world = World::new(settings).expect("settings");
            let material = surface(restitution, friction);
            let ground = BodyDef::fixed().at(vec2(0.0, -1.0));
            put(&mut world, ground, block(200.0, 2.0), material);
            let def = BodyDef::dynamic().at(vec2(0.0, height)).turned(angle);
            let def = def.moving(vec2(speed, 0.0)).spinning(spin);
            let id = put(&mut world, def, block(0.8, 0.8), material);
            for _ in 0..30 {
                world.step(1.0);
            }
            let body = world.body(id).expect("it is there");
            assert!(
                body.is_asleep(),
                "{mode:?}, e = {restitution}, µ = {friction}, from {height} m: awake at {:e} m/s",
                body.velocity().length()
            );
        }
    }
}
