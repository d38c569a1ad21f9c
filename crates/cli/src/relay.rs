//! What a job made, handed to the job after it, on whatever threads they run.

use std::collections::BTreeMap;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// Results of consecutive jobs, each kept until the job after it has taken it.
#[derive(Debug)]
pub struct Relay<T> {
    /// `None` for a job that ended without a result.
    made: Mutex<BTreeMap<u64, Option<Arc<T>>>>,
    more: Condvar,
}

/// A job's place in the row. Dropped without a result, it lets the next one go on without.
#[derive(Debug)]
pub struct Turn<'a, T> {
    relay: &'a Relay<T>,
    index: u64,
    passed: bool,
}

impl<T> Relay<T> {
    /// A relay with no job before the first one, number `first`.
    pub fn from(first: u64) -> Self {
        let before = first.checked_sub(1).map(|index| (index, None));
        Self {
            made: Mutex::new(before.into_iter().collect()),
            more: Condvar::new(),
        }
    }

    /// The turn of job `index`. Jobs must begin in order, or the row may wait forever.
    pub const fn turn(&self, index: u64) -> Turn<'_, T> {
        Turn {
            relay: self,
            index,
            passed: false,
        }
    }

    fn put(&self, index: u64, result: Option<Arc<T>>) {
        self.lock().insert(index, result);
        self.more.notify_all();
    }

    /// Nothing is half done when a lock is let go.
    fn lock(&self) -> MutexGuard<'_, BTreeMap<u64, Option<Arc<T>>>> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> Turn<'_, T> {
    /// Hands on what this job made, waits for what the job before it made and gives both.
    pub fn pass(mut self, made: T) -> (Option<Arc<T>>, Arc<T>) {
        let made = Arc::new(made);
        self.passed = true;
        self.relay.put(self.index, Some(Arc::clone(&made)));
        let Some(before) = self.index.checked_sub(1) else {
            return (None, made);
        };
        let mut list = self.relay.lock();
        loop {
            match list.remove(&before) {
                Some(result) => return (result, made),
                None => {
                    list = self
                        .relay
                        .more
                        .wait(list)
                        .unwrap_or_else(PoisonError::into_inner);
                }
            }
        }
    }
}

impl<T> Drop for Turn<'_, T> {
    fn drop(&mut self) {
        if !self.passed {
            self.relay.put(self.index, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exit::Failure;
    use crate::parallel::in_order;

    /// Sums of each number and the one before it, from 3 on; job 7 fails if asked to.
    fn sums(threads: usize, fails: bool) -> (Vec<u64>, bool) {
        let (relay, mut jobs, mut seen) = (Relay::from(3), 3..50_u64, Vec::new());
        let outcome = in_order(
            threads,
            || Ok(jobs.next()),
            |job| {
                let turn = relay.turn(job);
                if fails && job == 7 {
                    return Err(Failure::new("seven"));
                }
                let (before, made) = turn.pass(job);
                Ok(before.map_or(0, |before| *before) + *made)
            },
            |sum| {
                seen.push(sum);
                Ok(())
            },
        );
        assert!(relay.lock().len() <= 1 || fails, "only the last is kept");
        (seen, outcome.is_ok())
    }

    #[test]
    fn every_job_meets_the_one_before_it() {
        let expected: Vec<u64> = (3..50)
            .map(|k| if k == 3 { 3 } else { 2 * k - 1 })
            .collect();
        for threads in [1, 2, 5] {
            assert_eq!(
                sums(threads, false),
                (expected.clone(), true),
                "{threads} threads"
            );
        }
    }

    #[test]
    fn a_failed_job_blocks_no_other() {
        for threads in [1, 2, 5] {
            assert_eq!(sums(threads, true).0.len(), 4, "{threads} threads");
        }
    }
}
