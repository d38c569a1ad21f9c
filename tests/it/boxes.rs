//! Random closed boxes lose no body. `cargo run --release -p carom-tests --example boxes` plays more of them, and kinds that still lose
//! some.

use carom_dynamics::Mode;
use carom_tests::boxes::Extra::{self, Changes, Elastic, Paddles, Plates, Weightless};
use carom_tests::boxes::Walls::{self, Blocks, HalfPlanes, Segments, Zigzag};
use carom_tests::boxes::{Kind, play};

/// Kinds that lose no body in the first 500 runs of each mode.
const CLOSED: [(Walls, &[Extra]); 8] = [
    (Segments, &[]),
    (Segments, &[Changes]),
    (Blocks, &[]),
    (Blocks, &[Plates, Changes]),
    (HalfPlanes, &[]),
    (HalfPlanes, &[Plates, Changes]),
    (Zigzag, &[Weightless]),
    (Zigzag, &[Elastic, Changes]),
];

/// Runs of each kind.
const COUNT: u64 = 15;

/// Plays the first runs of a kind; how many their reports called exact.
fn keeps(mode: Mode, (walls, extras): (Walls, &[Extra])) -> usize {
    let kind = Kind { walls, extras };
    let play = |seed: &u64| match play(mode, kind, *seed) {
        Ok(report) => report.is_exact(),
        Err(escape) => panic!("{mode:?} {kind:?} {seed}: {escape}"),
    };
    (1..=COUNT).filter(play).count()
}

#[test]
fn closed_boxes_lose_no_body_in_hybrid_mode() {
    let exact: usize = CLOSED.map(|kind| keeps(Mode::Hybrid, kind)).iter().sum();
    assert!(exact > 0, "no run is exact");
}

#[test]
fn closed_boxes_lose_no_body_in_exact_mode() {
    let exact: usize = CLOSED.map(|kind| keeps(Mode::Exact, kind)).iter().sum();
    assert!(exact > 0, "no run is exact");
}

#[test]
fn closed_boxes_lose_no_body_in_stepped_mode() {
    // The other modes lose a plate at times.
    for kind in CLOSED.into_iter().chain([(Segments, [Plates].as_slice())]) {
        keeps(Mode::Stepped, kind);
    }
}

#[test]
fn no_run_that_loses_a_body_is_called_exact() {
    for (walls, extras) in [
        (Zigzag, [Paddles].as_slice()),
        (Segments, &[Plates, Changes]),
    ] {
        let kind = Kind { walls, extras };
        for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
            for seed in 1..=COUNT {
                if let Err(escape) = play(mode, kind, seed) {
                    assert!(!escape.exact, "{mode:?} {kind:?} {seed}: {escape}");
                }
            }
        }
    }
}
