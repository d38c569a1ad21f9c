//! The search for the next impact against a search of all pairs. `cargo run --release -p carom-tests --example flights` asks for more.

use carom_dynamics::Mode;
use carom_tests::flights::play;

#[test]
fn flights_meet_when_a_search_of_all_pairs_says() {
    for mode in [Mode::Exact, Mode::Hybrid] {
        let (mut impacts, mut events) = (0, 0);
        for seed in 1..=150 {
            let seen = play(mode, seed).unwrap_or_else(|told| panic!("{mode:?} {seed}: {told}"));
            impacts += seen.impacts;
            events += seen.events;
        }
        assert!(impacts > 1000 && events > 3000, "{impacts} of {events}");
    }
}
