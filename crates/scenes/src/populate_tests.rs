//! Random populations: inside their region, apart, and the same every time; random files: no panic.

use std::fmt::Write as _;

use carom_dynamics::World;
use carom_math::{Vec2, vec2};
use proptest::prelude::*;

use crate::build_tests::built;
use crate::{Scene, list};

/// The bodies of a population as circles: place, and reach of the shape.
fn circles(world: &World) -> Vec<(Vec2, f64)> {
    world
        .bodies()
        .map(|body| {
            let reach = body
                .shapes()
                .map(|(shape, _)| shape.reach_about(Vec2::ZERO));
            (body.pose().position, reach.fold(0.0, f64::max))
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn populations_lie_inside_and_apart(
        seed in 0..=i64::MAX,
        count in 1_u32..60,
        least in 0.05..0.5_f64,
        more in 0.0..0.5_f64,
        shapes in prop::sample::subsequence(vec!["disc", "regular", "random", "rectangle", "star"], 1..=5),
    ) {
        let most = least + more;
        // A third of the area is taken at most.
        let side = (f64::from(count) * 3.0 * 3.2 * most * most).sqrt() + 2.0 * most;
        let mut text = String::new();
        let _ = write!(
            text,
            "version = 1\nseed = {seed}\ngravity = [0, 0]\n[[population]]\nname = 'p'\ncount = {count}\n\
             region = [-1, -2, {}, {}]\nradius = [{least}, {most}]\nspeed = [1, 2]\nshapes = {shapes:?}\n",
            side - 1.0, side - 2.0,
        );
        let scene = Scene::from_toml(&text, "p").map_err(|error| TestCaseError::fail(error.to_string()))?;
        let built = scene.build().map_err(|error| TestCaseError::fail(error.to_string()))?;
        let circles = circles(&built.world);
        prop_assert_eq!(circles.len(), count as usize);
        for (i, &(a, reach_a)) in circles.iter().enumerate() {
            prop_assert!(reach_a <= most * (1.0 + 1e-12));
            // Rounding of the corners' places on their circle.
            let inside = a - vec2(-1.0, -2.0);
            prop_assert!(inside.min_element() >= reach_a - 1e-9 && inside.max_element() <= side - reach_a + 1e-9);
            for &(b, reach_b) in &circles[..i] {
                prop_assert!(a.distance(b) >= reach_a + reach_b - 1e-12, "{a} {reach_a} {b} {reach_b}");
            }
        }
        for body in built.world.bodies() {
            prop_assert!((1.0 - 1e-12..=2.0 + 1e-12).contains(&body.velocity().length()));
        }
        let again = scene.build().map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(again.world.state_hash(), built.world.state_hash());
    }

    #[test]
    fn any_text_is_read_or_refused_on_one_line(text in "\\PC{0,80}") {
        let text = format!("version = 1\n{text}");
        if let Err(error) = Scene::from_toml(&text, "any") {
            prop_assert!(!error.to_string().contains('\n'));
            prop_assert!(error.to_string().starts_with("any"));
        }
    }

    #[test]
    fn a_cut_or_flipped_scene_never_panics(cut in 0..3000_usize, byte: u8, at in 0..3000_usize) {
        let mut bytes = list()[0].text.as_bytes().to_vec();
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(cut);
        if let Ok(text) = String::from_utf8(bytes)
            && let Err(error) = Scene::from_toml(&text, "flipped").and_then(|scene| scene.build())
        {
            prop_assert!(!error.to_string().contains('\n'), "{error}");
        }
    }
}

#[test]
fn populations_keep_clear_of_what_stands_there() {
    let text = "version = 1\n[[body]]\nname = 'bar'\nkind = 'fixed'\nangle_deg = 45\nshape = { rectangle = [20, 2] }\n\
                [[population]]\nname = 'p'\ncount = 60\nregion = [-8, -8, 8, 8]\nradius = 0.4\n";
    let built = built(text);
    let diagonal = vec2(-1.0, 1.0) / core::f64::consts::SQRT_2;
    for (place, reach) in circles(&built.world).into_iter().skip(1) {
        assert!(
            place.dot(diagonal).abs() >= 1.0 + reach - 1e-12,
            "{place} is in the bar"
        );
    }
}
