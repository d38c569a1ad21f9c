//! A press that jams bodies on the floor: no impulses stop them, or only such as hurl them out of a wedge of a hundredth of a
//! radian. Struck again at the same instant they were faster each time, up to 9.6e9 J in a box that was stirred for long.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::vec2;
use carom_tests::gas::numbers;
use carom_tests::scenes::{block, disc, floor, put, surface};

#[test]
fn driven_bodies_do_not_hurl_what_they_squeeze() {
    // The fastest of old was 73 km/s, with seed 19. Where a body lies half a metre deep in the floor the engine throws it: of
    // 800 such worlds 3 in a hundred have one above 100 m/s, and the fastest of all goes at 306.
    let mut fast = 0;
    let worlds = [Mode::Exact, Mode::Hybrid].map(|mode| (1..=40).map(move |seed| (mode, seed)));
    for (mode, seed) in worlds.into_iter().flatten() {
        let settings = Settings {
            gravity: vec2(0.0, -10.0),
            mode,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let material = surface(0.5, 0.3);
        floor(&mut world, material);
        let mut next = numbers(seed);
        let mut between = |least: f64, most: f64| least + (most - least) * next();
        let press = BodyDef::kinematic()
            .at(vec2(0.0, 3.5))
            .turned(between(-0.1, 0.1))
            .moving(vec2(0.0, -2.0));
        put(&mut world, press, block(4.0, 0.3), material);
        let squeezed: Vec<_> = (0..6_u32)
            .map(|k| {
                let x = 0.8 * f64::from(k % 2) - 0.4 + between(-0.1, 0.1);
                let def = BodyDef::dynamic()
                    .at(vec2(x, 0.5 + f64::from(k / 2)))
                    .turned(between(0.0, 6.0));
                let size = between(0.25, 0.4);
                if k % 3 == 0 {
                    return put(&mut world, def, disc(size), material);
                }
                let polygon = ConvexPolygon::regular(3 + k as usize, size).expect("a polygon");
                put(&mut world, def, polygon, material)
            })
            .collect();
        let mut fastest = 0.0_f64;
        for _ in 0..100 {
            world.step(1.0 / 60.0);
            for id in &squeezed {
                let body = world.body(*id).expect("it stays");
                fastest = fastest.max(body.velocity().length());
            }
        }
        assert!(fastest < 500.0, "{mode:?}, seed {seed}: {fastest} m/s");
        fast += u32::from(fastest > 100.0);
    }
    assert!(fast <= 8, "above 100 m/s in {fast} of 80 worlds");
}
