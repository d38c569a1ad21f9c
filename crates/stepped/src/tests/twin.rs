//! A tick against the slow twin.

use carom_math::{Pose, Rot, Vec2, vec2};

use super::{Random, floor, pyramid, unit_box, without_sleep};
use crate::naive;
use crate::{BodyInput, Engine, Mixed};

/// A heap in touch: velocities and impulses after a tick are those of rows in a list, swept in the same order.
#[test]
fn a_tick_agrees_with_its_slow_twin() {
    let mut engine = Engine::new(without_sleep()).unwrap();
    floor(&mut engine);
    let mut ids = pyramid(&mut engine, 6, Vec2::ZERO);
    // Gaps of exactly 0 would be open or closed by rounding.
    let mut random = Random::new(8);
    for id in &ids {
        let at = engine.pose(*id).unwrap().position;
        let at = at * vec2(1.002, 1.003) + vec2(random.next(), random.next()) * 1e-3;
        engine.set_pose(*id, Pose::at(at)).unwrap();
    }
    let mut leaning = BodyInput::dynamic(0.5, 0.1).at(vec2(-1.2, 0.71));
    leaning.pose.rotation = Rot::from_angle(0.7);
    ids.push(engine.insert(leaning, &[unit_box()]).unwrap());
    for tick in 0..100 {
        engine.find_contacts(&Mixed);
        let expected = naive::State::of(&engine).substeps(&engine);
        engine.substeps();
        for (k, (v, w)) in expected.velocities.iter().enumerate().skip(2) {
            let line = &engine.bodies.lines[k];
            let off = (line.v() - *v).length() + (line.w() - w).abs();
            assert!(off < 1e-9, "tick {tick}: body {k} is off by {off} m/s");
        }
        for (id, j) in expected.impulses {
            let (block, _, lane) = engine.graph.lane(id);
            for (ours, theirs) in block.impulses(lane).into_iter().zip(j) {
                assert!(
                    (ours - theirs).abs() < 1e-9,
                    "tick {tick}: {ours} and {theirs} N·s"
                );
            }
        }
    }
}
