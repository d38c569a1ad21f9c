//! Worlds on threads: each of its own, or cloned from one.

use carom::{BodyDef, Circle, Material, Settings, World, vec2};

const fn may_go_to_another_thread<T: Clone + Send + 'static>() {}

const _: () = may_go_to_another_thread::<World>();

#[test]
fn a_clone_on_another_thread_has_the_bits_of_the_original() {
    let mut world = World::new(Settings::default()).unwrap();
    for k in 0..5 {
        let def = BodyDef::dynamic().at(vec2(0.1 * f64::from(k), 1.5 * f64::from(k)));
        world
            .insert(def, Circle::new(0.5).unwrap(), Material::default())
            .unwrap();
    }
    let mut clone = world.clone();
    let there = std::thread::spawn(move || {
        clone.step(1.0);
        clone.state_hash()
    });
    world.step(1.0);
    assert_eq!(there.join().unwrap(), world.state_hash());
}
