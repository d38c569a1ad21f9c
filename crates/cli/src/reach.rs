//! Steps to an instant that Ctrl-C can end, however much happens before it.

use carom_dynamics::{Refusal, StepReport, World};
use carom_math::SimTime;

use crate::interrupt;

/// How a world that was to reach an instant ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reached {
    /// It is there.
    There,
    /// Ctrl-C or termination was asked for on the way.
    Interrupted,
    /// A step was refused.
    Refused(Refusal),
}

/// Steps to `target`, as often as the bounded work of a step needs; `saw` is told of each step.
pub(crate) fn reach(
    world: &mut World,
    target: SimTime,
    saw: impl FnMut(&World, StepReport),
) -> Reached {
    reach_unless(world, target, saw, interrupt::asked)
}

fn reach_unless(
    world: &mut World,
    target: SimTime,
    mut saw: impl FnMut(&World, StepReport),
    asked: impl Fn() -> bool,
) -> Reached {
    let mut rest = target - world.time();
    loop {
        let report = world.step(rest);
        saw(world, report);
        if let Some(why) = report.refused {
            return Reached::Refused(why);
        }
        // A step that is done says so; its clock may be a rounding off.
        let done = report.advanced >= rest;
        rest = target - world.time();
        if done || rest <= 0.0 {
            return Reached::There;
        }
        if asked() {
            return Reached::Interrupted;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use carom_dynamics::{BodyDef, Material, Settings};
    use carom_geometry::Circle;
    use carom_math::{Vec2, vec2};

    use super::*;

    /// Discs between two others, with so much work in a tick.
    fn world(work: u64) -> World {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            work,
            ..Settings::default()
        })
        .unwrap();
        let lively = Material {
            restitution: 1.0,
            friction: 0.0,
            ..Material::default()
        };
        let disc = || Circle::new(0.5).unwrap();
        for x in [-2.0, 2.0] {
            let def = BodyDef::fixed().at(vec2(x, 0.0));
            world.insert(def, disc(), lively).unwrap();
        }
        let def = BodyDef::dynamic().moving(vec2(90.0, 0.0));
        world.insert(def, disc(), lively).unwrap();
        world
    }

    #[test]
    fn what_takes_many_steps_is_reached_with_the_bits_of_one() {
        let target = SimTime::from_secs(1.0);
        let (mut few, mut many) = (world(1), world(u64::MAX));
        let steps = Cell::new(0);
        let count = |_: &World, _: StepReport| steps.set(steps.get() + 1);
        assert_eq!(
            reach_unless(&mut few, target, count, || false),
            Reached::There
        );
        assert!(steps.replace(0) > 1, "the work of a step was not used up");
        assert_eq!(
            reach_unless(&mut many, target, count, || true),
            Reached::There
        );
        assert_eq!(steps.get(), 1);
        // What is left to the target is one number, so the instants differ by less than that has digits; nothing else does.
        assert!((few.time() - many.time()).abs() < 1e-16);
        let motions = [&few, &many].map(|world| {
            let bodies = world.bodies();
            bodies.map(|body| *body.motion()).collect::<Vec<_>>()
        });
        assert_eq!(motions[0], motions[1]);
    }

    #[test]
    fn ctrl_c_ends_a_step_of_much_work() {
        let target = SimTime::from_secs(1.0);
        let mut few = world(1);
        let steps = Cell::new(0);
        let count = |_: &World, _: StepReport| steps.set(steps.get() + 1);
        let ended = reach_unless(&mut few, target, count, || steps.get() == 2);
        assert_eq!((ended, steps.get()), (Reached::Interrupted, 2));
        assert!(few.time() < target);
    }
}
