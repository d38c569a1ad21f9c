//! A ball that a corner sends back opens against floor and ramp at once. What touched something and had no contact mode was left to the
//! engine, as if it were pressed: of these 40 balls 22 were in it for up to five seconds of six, in exact mode.

use carom_dynamics::BodyDef;
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::vec2;
use carom_tests::scenes::{exact, floor, put, surface};

#[test]
fn a_ball_bounces_out_of_a_corner() {
    for k in 0..40_u8 {
        let mut world = exact();
        let (e, friction) = ([0.3, 0.5, 0.7, 0.9], [0.0, 0.3, 0.7]);
        let material = surface(e[usize::from(k % 4)], friction[usize::from(k % 3)]);
        floor(&mut world, material);
        let height = 0.5 + 0.2 * f64::from(k % 9);
        let ramp = [vec2(2.0, -1.0), vec2(6.0, -1.0), vec2(6.0, height)];
        let ramp = ConvexPolygon::new(ramp.to_vec()).expect("a ramp");
        put(&mut world, BodyDef::fixed(), ramp, material);
        let def = BodyDef::dynamic().at(vec2(-2.0, 1.5)).spinning(-4.0);
        let def = def.moving(vec2(2.0 + 0.1 * f64::from(k), 0.0));
        let ball = Circle::new(0.5).expect("a disc");
        put(&mut world, def, ball, material);
        let report = world.step(6.0);
        assert!(report.is_exact(), "ball {k}: {report:?}");
        assert!(world.energy().scheme.abs() < 1e-12, "ball {k}");
    }
}
