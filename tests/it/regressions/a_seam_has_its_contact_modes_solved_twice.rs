//! At the end of a tile's edge the stretch that a sliding box has in common with it is as long as a rounding. The box was
//! found to slide on until that ended too, 16 times at one instant, before the next sub-step took it.

use carom_dynamics::{BodyDef, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

#[test]
fn a_seam_has_its_contact_modes_solved_twice() {
    for speed in [3.0, -0.7, 11.0] {
        let mut world = World::new(Settings {
            gravity: vec2(0.0, -9.81),
            sleep: None,
            ..Settings::default()
        })
        .expect("valid settings");
        let smooth = surface(0.0, 0.0);
        for tile in -20..=20 {
            let at = BodyDef::fixed().at(vec2(f64::from(tile), -0.5));
            put(&mut world, at, block(1.0, 1.0), smooth);
        }
        let slides = BodyDef::dynamic()
            .at(vec2(0.03, 0.4))
            .moving(vec2(speed, 0.0));
        let slides = put(&mut world, slides, block(0.8, 0.8), smooth);
        let mut solved = 0;
        let mut time = 0.0;
        while time < 12.0 / f64::abs(speed) {
            solved += world.step(1.0 / 60.0).modes_solved;
            time += 1.0 / 60.0;
        }
        let body = world.body(slides).expect("it stays");
        assert_eq!(body.velocity(), vec2(speed, 0.0));
        assert_eq!(body.centre().y, 0.4, "{}", body.centre());
        let seams = (body.centre() - vec2(0.03, 0.4)).length();
        assert!(
            solved as f64 <= 2.0 * seams + 3.0,
            "{solved} for {seams} tiles at {speed} m/s"
        );
        assert!((seams - 12.0).abs() < 0.2 && body.velocity() != Vec2::ZERO);
    }
}
