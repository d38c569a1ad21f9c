//! Two that touch may be struck together because of a third, or by a rounding: the speed of approach of such an impact was told as
//! below 0, by up to 2.4e-5 m/s.

use carom_dynamics::{EventKind, Mode, Settings, World};
use carom_tests::run;
use carom_tests::scenes::{any_disc, heap};

#[test]
fn an_impact_approaches() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let mut impacts = 0;
        for seed in 1..=4 {
            let settings = Settings {
                mode,
                ..Settings::default()
            };
            let mut world = World::new(settings).expect("valid settings");
            heap(&mut world, seed, any_disc);
            run(&mut world, 3.0, |world| {
                for event in world.events() {
                    if let EventKind::Impact { speed, .. } = event.kind {
                        assert!(speed >= 0.0, "{speed:e} m/s, {mode:?}, seed {seed}");
                        impacts += 1;
                    }
                }
            });
        }
        assert!(impacts > 1000, "{impacts}, {mode:?}");
    }
}
