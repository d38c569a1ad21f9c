//! A step that is refused leaves the world as it was; but it delivered what the caller's last changes had brought about, and the
//! step after it told nothing of that.

use carom_dynamics::{EventKind, Mode, Settings};
use carom_math::vec2;
use carom_tests::scenes::{boxed, floor, surface};

#[test]
fn a_refused_step_takes_no_events() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let mut world = carom_dynamics::World::new(settings).expect("valid settings");
        floor(&mut world, surface(0.0, 0.5));
        let block = boxed(&mut world, vec2(0.0, 0.5), surface(0.0, 0.5));
        world.step(0.1);
        world.remove(block).expect("it is there");
        assert!(world.step(-1.0).refused.is_some());
        assert!(world.step_to_next_event(f64::NAN).refused.is_some());
        world.step(0.0);
        let ends = |kind: &EventKind| matches!(kind, EventKind::End { b, .. } if *b == block);
        let told = world.events().iter().filter(|event| ends(&event.kind));
        assert_eq!(told.count(), 1, "{mode:?}");
    }
}
