//! A force that ends leaves the acceleration of free flight as it was. (g + F/m) − F/m left a rounding on it for good, which made the
//! body one that no closed form of an impact took.

use carom_dynamics::{BodyDef, Force, Material, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::vec2;

#[test]
fn a_force_that_ends_leaves_the_acceleration_as_it_was() {
    let gravity = vec2(0.3, -9.81);
    let mut world = World::new(Settings {
        gravity,
        ..Settings::default()
    })
    .expect("valid settings");
    let shape = ConvexPolygon::rectangle(0.7, 0.3).expect("a rectangle");
    let body = world
        .insert(BodyDef::dynamic(), shape, Material::default())
        .expect("valid");
    for k in 1..=1000_u32 {
        let strength = f64::from(k).sqrt();
        let at = world.body(body).expect("it is there").centre() + vec2(0.1, 0.02);
        let force = Force::at(at, vec2(strength, 0.37 * strength));
        world.apply_force(body, force).expect("valid");
        world.step(1.0 / 60.0);
        let motion = *world.body(body).expect("it is there").motion();
        assert_eq!(motion.acceleration, gravity, "after {k} forces");
        assert_eq!(motion.angular_acceleration, 0.0, "after {k} forces");
    }
}
