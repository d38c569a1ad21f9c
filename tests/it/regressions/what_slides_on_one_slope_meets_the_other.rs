//! Bodies in analytic motion on concave ground that meet another piece of it.
//!
//! A search beside the contact that an island's mode holds goes from part to part, and its impacts named part 0 of both shapes: whether
//! that was a hidden side of a flush piece was asked of another piece than the one that was struck. A disc on one slope went through
//! the opposite one, by 2.4 cm in a step that was called exact.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::{Circle, Polygon, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::checks::overlapping;
use carom_tests::scenes::{put, surface};

fn ground(corners: &[(f64, f64)]) -> Polygon {
    let corners: Vec<Vec2> = corners.iter().map(|(x, y)| vec2(*x, *y)).collect();
    Polygon::new(corners).expect("an outline")
}

#[test]
fn what_slides_on_one_slope_meets_the_other() {
    let disc = Circle::new(0.205).expect("a disc");
    let thrown = BodyDef::dynamic().at(vec2(2.4, -2.0));
    let wide = [
        (4.0, -4.0),
        (4.0, -2.0),
        (2.8, -3.0),
        (1.4, -2.0),
        (-2.0, -2.0),
        (-3.0, -1.9),
        (-3.5, -2.0),
    ];
    let waves = [
        (4.0, -4.0),
        (4.0, -3.0),
        (3.0, -2.0),
        (2.0, -3.0),
        (0.7, -1.6),
        (0.0, -2.3),
        (-0.7, -2.4),
    ];
    let bank = [(-1.0, -2.0), (-2.0, -2.0), (-3.5, -1.9), (-4.2, -2.8)];
    let triangle = ground(&[(0.1, 0.0), (-0.2, 0.18), (-0.25, 0.0)]);
    let chip = [
        (0.0, -0.1),
        (-0.1, 0.3),
        (-0.1, 0.0),
        (-0.3, 0.1),
        (-0.3, 0.0),
    ];
    let rolls = BodyDef::dynamic().at(vec2(-0.3, -2.1)).turned(3.0);
    let falls = BodyDef::dynamic().at(vec2(-3.69, -1.3)).turned(3.0);
    let cases = [
        (
            ground(&wide),
            Shape::from(disc),
            thrown.moving(vec2(2.0, -10.0)).spinning(-2.0),
        ),
        (
            ground(&waves),
            triangle.into(),
            rolls.moving(vec2(2.0, 0.0)).spinning(-7.0),
        ),
        (
            ground(&bank),
            ground(&chip).into(),
            falls.moving(vec2(0.0, -6.0)).spinning(-1.0),
        ),
    ];
    for (case, (outline, shape, def)) in cases.into_iter().enumerate() {
        for mode in [Mode::Hybrid, Mode::Exact] {
            let settings = Settings {
                mode,
                gravity: vec2(0.0, -10.0),
                sleep: None,
                ..Settings::default()
            };
            let mut world = World::new(settings).expect("settings");
            put(
                &mut world,
                BodyDef::fixed(),
                outline.clone(),
                surface(0.0, 0.0),
            );
            put(&mut world, def, shape.clone(), surface(0.0, 0.0));
            for _ in 0..40 {
                let report = world.step(1.0 / 60.0);
                let found = overlapping(&world).into_iter();
                let deep = found.map(|found| found.2).fold(0.0, f64::max);
                let told = !report.is_exact() || deep < 1e-6;
                assert!(
                    told,
                    "{mode:?}, {case}: {deep} m at {:?}, {report:?}",
                    world.time()
                );
                assert!(deep < 0.01, "{mode:?}, {case}: {deep} m");
            }
        }
    }
}
