//! Every width gives the bits of the scalar twin.

use super::kernel::{Pass, sweep};
use super::plain;
use crate::tests::{Random, floor, levels};
use crate::{Engine, Mixed, Settings};

#[test]
fn all_widths_have_the_bits_of_the_plain_sweep() {
    let mut engine = Engine::new(Settings::default()).unwrap();
    floor(&mut engine);
    let mut random = Random::new(4);
    for k in 0..120 {
        let piece = random.piece();
        let mut body = random.body(&piece, 1.0);
        body.pose.position.x += 1.1 * f64::from(k % 10);
        body.pose.position.y += 1.5 + f64::from(k / 10);
        engine.insert(body, &[piece]).unwrap();
    }
    for tick in 0..60 {
        engine.find_contacts(&Mixed);
        for level in levels() {
            let mut wide = engine.clone();
            let mut slow = engine.clone();
            for pass in [
                Pass::Solve,
                Pass::Relax,
                Pass::SolveWithFriction,
                Pass::Relax,
            ] {
                let law = engine.law;
                sweep(level, pass, &law, &mut wide.bodies.lines, wide.graph.soft());
                plain::sweep(pass, &law, &mut slow.bodies.lines, slow.graph.soft());
                for (x, y) in wide.bodies.lines.iter().zip(&slow.bodies.lines) {
                    // Adding 0 makes −0 a 0: a block that is left early writes nothing back.
                    let bits = |line: &super::Line| line.0.map(|x| (x + 0.0).to_bits());
                    assert_eq!(bits(x), bits(y), "tick {tick}, {pass:?}, {level:?}");
                }
                for id in wide.graph.ids() {
                    let ((x, _, lane), (y, ..)) = (wide.graph.lane(id), slow.graph.lane(id));
                    let bits = |j: [f64; 3]| j.map(|j| (j + 0.0).to_bits());
                    assert_eq!(bits(x.impulses(lane)), bits(y.impulses(lane)));
                }
            }
        }
        engine.substeps();
    }
    assert!(engine.contact_count() > 100);
}
