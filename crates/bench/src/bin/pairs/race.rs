//! Two ways to answer the same questions, in turn.

use core::hint::black_box;

use carom_bench::CpuClock;

/// Rounds of each; the median counts.
const ROUNDS: usize = 11;

/// Rows of a Markdown table, printed as they come.
#[derive(Debug)]
pub(crate) struct Table;

impl Table {
    pub(crate) fn new() -> Self {
        println!("| what | carom ns | parry ns | ratio | carom wrong | parry wrong | of |");
        println!("|---|---:|---:|---:|---:|---:|---:|");
        Self
    }

    /// One row: both answer every question, [`ROUNDS`] times; then `wrong` checks the answers to each.
    pub(crate) fn row<T, A, B>(
        &self,
        what: &str,
        questions: &[T],
        mut ours: impl FnMut(&T) -> A,
        mut theirs: impl FnMut(&T) -> B,
        wrong: impl Fn(&T, &A, &B) -> [bool; 2],
    ) {
        let clock = CpuClock::thread();
        let mut times = [const { Vec::new() }; 2];
        for round in 0..ROUNDS {
            for turn in [round % 2, 1 - round % 2] {
                let start = clock.seconds();
                for question in questions {
                    if turn == 0 {
                        black_box(ours(question));
                    } else {
                        black_box(theirs(question));
                    }
                }
                let spent = clock.seconds() - start;
                times[turn].push(spent * 1e9 / questions.len() as f64);
            }
        }
        let [us, them] = times.map(|mut list| {
            list.sort_unstable_by(f64::total_cmp);
            list[list.len() / 2]
        });
        let mut count = [0; 2];
        for question in questions {
            let found = wrong(question, &ours(question), &theirs(question));
            for (sum, bad) in count.iter_mut().zip(found) {
                *sum += usize::from(bad);
            }
        }
        println!(
            "| {what} | {us:.0} | {them:.0} | {:.2} | {} | {} | {} |",
            us / them,
            count[0],
            count[1],
            questions.len()
        );
    }
}
