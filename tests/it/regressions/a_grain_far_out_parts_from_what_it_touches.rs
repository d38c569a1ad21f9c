//! A grain of 1 mm of three parts grazed an angle 640 m out. The search for other parts found the touch itself again at the same
//! instant, without end: no step went on any more, and all of them were called exact.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{put, surface};

#[test]
fn a_grain_far_out_parts_from_what_it_touches() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            mode,
            ..Settings::default()
        })
        .expect("settings");
        let rough = Material {
            density: 0.007_250_909_003_292_933_5,
            ..surface(0.0, 5.0)
        };
        let length = 0.000_844_839_406_691_906_7;
        let rod = ConvexPolygon::rectangle(length, 5.166_461_081_958_621_4e-5).expect("a rod");
        let disc = |x: f64, radius: f64| -> (Shape, Material) {
            let disc = Circle::at(vec2(x, 0.0), radius).expect("a disc");
            (disc.into(), rough)
        };
        let grain = vec![
            (rod.into(), rough),
            disc(0.5 * length, 0.000_112_645_254_225_587_57),
            disc(-0.5 * length, 5.632_262_711_279_378e-5),
        ];
        let def = BodyDef::dynamic()
            .at(vec2(-481.719_920_822_220_33, -421.921_621_541_543_23))
            .turned(0.952_071_322_760_809_7)
            .moving(vec2(-0.725_753_580_393_765_1, 0.365_663_336_682_681_34))
            .spinning(19.649_787_163_345_394);
        let grain = world.insert_compound(def, grain).expect("valid");
        let (low, high, thick) = (
            -0.020_052_861_319_946_585,
            0.040_105_722_639_893_16,
            -0.016_895_552_641_704_014,
        );
        let angle = Polygon::new([
            vec2(low, low),
            vec2(high, low),
            vec2(high, thick),
            vec2(thick, thick),
            vec2(thick, high),
            vec2(low, high),
        ])
        .expect("an angle");
        let def = BodyDef::dynamic()
            .at(vec2(-481.746_554_296_621_24, -421.937_431_549_574_17))
            .turned(1.733_782_975_847_710_4)
            .moving(vec2(-0.047_609_916_702_031_19, -0.002_447_073_429_008_619))
            .spinning(0.914_528_077_965_552_9)
            .with_mass(10.323_617_408_763_887);
        put(&mut world, def, angle, surface(0.0, 0.6));
        for _ in 0..60 {
            let report = world.step(1.0 / 60.0);
            assert!(report.advanced > 0.0, "{mode:?}: {report:?}");
        }
        let grain = world.body(grain).expect("there");
        assert!(grain.velocity().length() < 2.0, "{mode:?}");
    }
}
