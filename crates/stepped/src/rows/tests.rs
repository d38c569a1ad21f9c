//! Every width gives the bits of the scalar twin.

mod check;

use carom_math::vec2;

use super::kernel::{Pass, sweep};
use super::{Quad, correct, plain};
use crate::tests::{Random, floor, levels};
use crate::{Engine, LineIx, Mixed, Settings};

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
            for pass in [Pass::Solve, Pass::Relax] {
                let law = engine.law;
                sweep(level, pass, &law, &mut wide.bodies.lines, wide.graph.soft());
                plain::sweep(pass, &law, &mut slow.bodies.lines, slow.graph.soft());
                for (x, y) in wide.bodies.lines.iter().zip(&slow.bodies.lines) {
                    // Adding 0 makes −0 a 0: a block that is left early writes nothing back.
                    let bits = |line: &super::Line| line.0.map(|x| (x + 0.0).to_bits());
                    assert_eq!(bits(x), bits(y), "tick {tick}, {pass:?}, {level:?}");
                }
                for colour in wide.graph.soft() {
                    let pushing = colour.blocks.iter().map(super::Block::pushing);
                    assert!(colour.pushes.iter().copied().eq(pushing));
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

/// Counts of bodies that are no multiple of four, too: the last ones share a register with empty lines.
#[test]
fn all_widths_note_the_bodies_that_deviate_or_go_far_one_by_one() {
    let settings = Settings::default();
    let (h, rest) = (settings.substep(), 3.0 * settings.substep());
    let (mut deviate, mut far, mut all) = (0, 0, 0);
    for count in 1..40 {
        let mut engine = Engine::new(settings).unwrap();
        let mut random = Random::new(count);
        for _ in 0..count {
            let piece = random.piece();
            let body = random.body(&piece, 1.0);
            engine.insert(body, &[piece]).unwrap();
        }
        let bodies = &mut engine.bodies;
        for at in bodies.awake() {
            let speed = [0.1, 3.0, 60.0][random.below(3)];
            let v = vec2(random.signed(), random.signed()) * speed;
            let w = random.signed() * speed;
            bodies.lines[at].set_velocity(v, w);
            let pulled = bodies.pull[at].v() * h;
            bodies.start[at] = Quad::new(v + pulled, w + 0.01 * random.signed());
            bodies.foreseen[at] = Quad::new(v * random.next(), w * random.next());
            let d = vec2(random.signed(), random.signed());
            bodies.lines[at].set_displacement(d * 0.01, 0.1 * random.signed());
        }
        for level in levels() {
            let mut bodies = engine.bodies.clone();
            correct(level, &mut bodies, &settings, h, rest);
            let lines = bodies.awake();
            let deviates = |at: &LineIx| {
                let (line, then, limit) = (
                    &bodies.lines[*at],
                    &bodies.foreseen[*at],
                    &bodies.limits[*at],
                );
                let off = (line.v() - then.v()).abs();
                let off = off.x.max(off.y) + (line.w() - then.w()).abs() * limit.reach;
                limit.deviates(settings.margin, off * rest, line.turn())
            };
            let goes_far = |at: &LineIx| {
                let (line, limit) = (&bodies.lines[*at], &bodies.limits[*at]);
                limit.is_far((line.v() * h).length_squared(), line.w() * h)
            };
            let expected: Vec<LineIx> = lines.clone().filter(deviates).collect();
            assert_eq!(bodies.deviating, expected, "{count}, {level:?}");
            let expected: Vec<LineIx> = lines.clone().filter(goes_far).collect();
            let speedy = bodies.speedy.as_deref().unwrap_or_default();
            assert_eq!(speedy, expected, "{count}, {level:?}");
            all += lines.count();
            deviate += bodies.deviating.len();
            far += expected.len();
        }
    }
    assert!(all / 10 < deviate && deviate < all, "{deviate} of {all}");
    assert!(all / 10 < far && far < all, "{far} of {all}");
}

/// Bodies with velocities that are no longer numbers are stopped as the tick ends: until then their impacts are summed like others.
#[test]
fn heat_of_what_is_no_number_is_none_either() {
    for slip in [f64::NAN, f64::INFINITY] {
        assert!(!plain::friction_heat(1.0, slip, 2.0).is_finite());
    }
    // It stuck; it slid from −3 to −1 m/s.
    for (slip, heat) in [(0.0, 0.0), (-1.0, 4.0)] {
        assert!((plain::friction_heat(2.0, slip, 1.0) - heat).abs() < 1e-15);
    }
}
