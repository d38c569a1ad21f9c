//! Random scripts of public calls, checked by code that shares nothing with the library. New ones in each run: the first seed is
//! printed, `CAROM_SEED` sets it, and where property tests are told to repeat themselves (`PROPTEST_RNG_SEED`, as in CI), so do these.
//!
//! Asserted: nothing panics, every call ends, equal calls leave equal bits, in stepped mode in any units, and scripts that broke a law
//! once keep it. Which laws break else is printed, not asserted, since some still do. Of the scripts 1 to 20,000, 20 s each:
//!
//! | broken law | hybrid | exact | stepped |
//! |---|---|---|---|
//! | a centre ends behind a surface, deeper than the report says | 0 | 0 | 0 |
//! | an overlap is missed and called exact | 1 | 1 | 0 |
//! | energy rises by more than the ledger says that sub-steps put in, or these put in more than 3 % | 1 | 0 | 4 |
//! | momentum of a free system is lost | 0 | 0 | 10 |
//! | over 20 s, a standstill or a panic | 0 | 0 | 0 |
//!
//! `cargo run --release -p carom-tests --example calls -- --count 20000 --limit 20` asks for all of them, fails if any breaks, and names the seeds.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, UNIX_EPOCH};

use carom_dynamics::Mode;
use carom_tests::scripts::{End, Units, ends_in_units, play};

/// Scripts in each mode.
const COUNT: u64 = 134;

/// All scripts of a mode together take some seconds; a call without end takes more than this.
const LIMIT: Duration = Duration::from_secs(600);

#[expect(
    clippy::disallowed_methods,
    reason = "a new seed for each run, which is printed"
)]
fn first() -> u64 {
    let told = ["CAROM_SEED", "PROPTEST_RNG_SEED"]
        .into_iter()
        .find_map(|name| std::env::var(name).ok());
    told.map_or_else(
        || {
            let now = std::time::SystemTime::now().duration_since(UNIX_EPOCH);
            now.map_or(1, |now| u64::from(now.subsec_nanos()) * 1_000)
        },
        |seed| {
            seed.parse()
                .expect("CAROM_SEED and PROPTEST_RNG_SEED are whole numbers")
        },
    )
}

fn ask(mode: Mode) {
    let first = first();
    println!("{mode:?}: scripts {first} and {COUNT} on; CAROM_SEED={first} asks them again");
    let (tell, hear) = channel();
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    let player = std::thread::spawn(move || {
        for seed in first..first + COUNT {
            if tell.send((seed, None)).is_err() {
                return;
            }
            let end = play(mode, seed, &asked);
            let same = end == play(mode, seed, &asked) || asked.load(Ordering::Relaxed);
            let _ = tell.send((seed, Some((end, same))));
        }
    });
    let (mut last, mut differ) = (first, Vec::new());
    loop {
        match hear.recv_timeout(LIMIT) {
            Ok((seed, None)) => last = seed,
            Ok((seed, Some((end, same)))) => {
                if let End::Broke(call, fault) = end {
                    println!("{mode:?}, seed {seed}, call {call}: {fault:?}");
                }
                if !same {
                    differ.push(seed);
                }
            }
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                stop.store(true, Ordering::Relaxed);
                panic!("{mode:?}: CAROM_SEED={last} takes more than {LIMIT:?}");
            }
        }
    }
    assert!(player.join().is_ok(), "{mode:?}: CAROM_SEED={last} panics");
    assert!(
        differ.is_empty(),
        "{mode:?}: other bits in a second run of {differ:?}"
    );
}

#[test]
fn random_scripts_end_and_leave_equal_bits_in_hybrid_mode() {
    ask(Mode::Hybrid);
}

#[test]
fn random_scripts_end_and_leave_equal_bits_in_exact_mode() {
    ask(Mode::Exact);
}

#[test]
fn random_scripts_end_and_leave_equal_bits_in_stepped_mode() {
    ask(Mode::Stepped);
}

/// Scripts in small units, in which no impulse is beyond the limit of the world, and in such that are a power of two larger: all is the
/// same then but for the exponents of numbers.
fn ask_in_units(mode: Mode, change: impl Fn(Units) -> Units) {
    let first = first();
    println!("{mode:?}: scripts {first} on; CAROM_SEED={first} asks them again");
    let small = Units {
        length: 1.0 / 4096.0,
        ..Units::ONE
    };
    for seed in first..first + COUNT {
        let [one, other] = [small, change(small)].map(|units| ends_in_units(mode, seed, units));
        assert_eq!(one, other, "{mode:?}, script {seed}");
    }
}

#[test]
fn no_length_is_absolute_in_stepped_mode() {
    ask_in_units(Mode::Stepped, |small| Units {
        length: 4.0 * small.length,
        ..small
    });
}

#[test]
fn no_time_is_absolute_in_stepped_mode() {
    ask_in_units(Mode::Stepped, |small| Units {
        time: 4.0 * small.time,
        ..small
    });
}

#[test]
fn no_mass_is_absolute() {
    for mode in [Mode::Stepped, Mode::Hybrid, Mode::Exact] {
        ask_in_units(mode, |small| Units {
            density: 4.0 * small.density,
            ..small
        });
    }
}

#[test]
fn scripts_that_broke_a_law_once_keep_it() {
    // From 1501 on: what a caller had kicked up rose without weight until the next sub-step, or an overlap in the midst of a
    // sub-step was called exact; 301: the rim of a part was taken for a corner; 391: what waited for the engine was called exact;
    // 7703: a body that joined the engine while its group was taken apart was sub-stepped as well; 2939: what an impact had taken out
    // of an island went on by accelerations of contacts that were no more.
    let exact = [
        1, 156, 235, 280, 301, 332, 379, 391, 1501, 2939, 3051, 4657, 10177, 11539, 14010, 14255,
        16210, 18465, 19091, 20373,
    ];
    // 20373: a corner that slid over the end of a face was on no edge any more, and what it slid on cut into the other face.
    let exact = exact.map(|seed| (Mode::Exact, seed));
    // 18465: from when on two may meet was sought for without end, where the bound came early by less than time rounds.
    // 19091: a touch that approached by rounding alone hid all others of its pair.
    // 4161: a plate passed through a disc that it rolled on; 4850, 4973, 19697: depths within a sub-step were not told.
    // 622, 884, 10608: bodies that had left a path were given another motion before a report told of them.
    // 471 to 2935: angular momentum that displacements take was given back by spins of any energy, up to 1e4 times what was there.
    let hybrid = [
        1, 193, 202, 379, 471, 622, 650, 884, 1783, 2038, 2381, 2775, 2856, 2935, 4161, 4657, 4850,
        4973, 7703, 10177, 10608, 14255, 19091, 19697,
    ];
    let hybrid = hybrid.map(|seed| (Mode::Hybrid, seed));
    // Free bodies lost their angular momentum in the engine. 1511: an island left hard rows after its free pairs had been gathered.
    // 128 to 1925 and 13797: bodies kept blows of one that was changed before them; 2839: as 471 above. 226 to 618: what was stopped within a
    // sub-step lacked angular momentum there.
    let stepped = [
        2, 5, 10, 13, 18, 23, 31, 33, 128, 205, 226, 256, 283, 372, 618, 1243, 1511, 1925, 2839,
        13797,
    ];
    let stepped = stepped.map(|seed| (Mode::Stepped, seed));
    // What held two that six contacts squeeze was given back contact by contact, each of 1e11 N·s: velocities were no numbers. An
    // island with modes of 1e-18 s was solved for without end within a sub-step. 1525: several that are wedged push each other by 1e12 N·s;
    // 16943: left out whole, such impulses let one out of its box.
    let squeezed = [
        (Mode::Exact, 261_940_947_125),
        (Mode::Exact, 324_721_302_128),
        (Mode::Hybrid, 1525),
        (Mode::Stepped, 16943),
    ];
    let stop = AtomicBool::new(false);
    for (mode, seed) in exact
        .into_iter()
        .chain(hybrid)
        .chain(stepped)
        .chain(squeezed)
    {
        let end = play(mode, seed, &stop);
        assert!(matches!(end, End::Passed(_)), "{mode:?} {seed}: {end:?}");
    }
}
