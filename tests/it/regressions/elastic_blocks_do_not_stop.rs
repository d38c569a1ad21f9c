//! Galperin's blocks, 1e12 : 1: they strike each other and the wall 3,141,592 times, half of them within a microsecond.

use carom_dynamics::BodyDef;
use carom_math::{Vec2, vec2};
use carom_tests::elastic;
use carom_tests::scenes::{block, put};

use crate::setters::{MODES, world};

/// In hybrid mode 262,144 impacts in a tick were taken for a series that comes to rest, and 5e11 J were gone.
#[test]
fn blocks_that_lose_nothing_are_not_brought_to_rest() {
    for mode in &MODES[..2] {
        let mut world = world(*mode, Vec2::ZERO);
        put(
            &mut world,
            BodyDef::fixed().at(vec2(-1.0, 0.0)),
            block(2.0, 4.0),
            elastic(),
        );
        let small = BodyDef::dynamic().at(vec2(1.5, 0.0));
        put(&mut world, small, block(1.0, 1.0), elastic());
        let heavy = carom_dynamics::Material {
            density: 1e12,
            ..elastic()
        };
        let large = BodyDef::dynamic()
            .at(vec2(3.5, 0.0))
            .moving(vec2(-1.0, 0.0));
        put(&mut world, large, block(1.0, 1.0), heavy);
        let energy = world.energy().kinetic;
        let mut impacts = 0;
        while impacts < 400_000 {
            let report = world.step(1.0 / 60.0);
            impacts += report.impacts;
            assert_eq!(report.collapsed, 0, "{mode:?} after {impacts} impacts");
        }
        let off = world.energy().kinetic / energy - 1.0;
        assert!(off.abs() < 1e-9, "{mode:?}: {off:e}");
    }
}
