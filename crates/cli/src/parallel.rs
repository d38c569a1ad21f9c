//! Work on several threads, with results in order: the number of threads never shows.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use crate::exit::{Failure, fail};

/// One job a core, or one.
pub fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Hands jobs from `produce` to `threads` workers and their results, in the order of the jobs, to `take`.
///
/// `produce` and `take` run on the calling thread. At most two jobs a thread are under way, so memory stays bounded.
/// The first failure ends it all. Where the system starts fewer threads, those work.
pub fn in_order<J: Send, T: Send>(
    threads: usize,
    produce: impl FnMut() -> Result<Option<J>, Failure>,
    work: impl Fn(J) -> Result<T, Failure> + Sync,
    take: impl FnMut(T) -> Result<(), Failure>,
) -> Result<(), Failure> {
    in_order_with(threads, || (), produce, |(), job| work(job), take)
}

/// The same; each worker has something of its own, made by `equip`, that it takes from job to job.
pub fn in_order_with<S, J: Send, T: Send>(
    threads: usize,
    equip: impl Fn() -> S + Sync,
    mut produce: impl FnMut() -> Result<Option<J>, Failure>,
    work: impl Fn(&mut S, J) -> Result<T, Failure> + Sync,
    mut take: impl FnMut(T) -> Result<(), Failure>,
) -> Result<(), Failure> {
    if threads <= 1 {
        let mut own = equip();
        while let Some(job) = produce()? {
            take(work(&mut own, job)?)?;
        }
        return Ok(());
    }
    let (jobs, queue) = channel::<(usize, J)>();
    let queue = Mutex::new(queue);
    let (results, finished) = channel();
    thread::scope(|scope| {
        // Dropped with this closure: then the workers find the queue closed and end.
        let jobs = jobs;
        let mut started = 0;
        for _ in 0..threads {
            let (results, queue, equip, work) = (results.clone(), &queue, &equip, &work);
            let worker = move || {
                let mut own = equip();
                while let Some((index, job)) = next(queue) {
                    // A panic must not leave the caller waiting for a result that never comes.
                    let result = catch_unwind(AssertUnwindSafe(|| work(&mut own, job)));
                    if results.send((index, result)).is_err() {
                        break;
                    }
                }
            };
            if let Err(error) = thread::Builder::new().spawn_scoped(scope, worker) {
                if started == 0 {
                    fail!("cannot start a thread: {error}");
                }
                break;
            }
            started += 1;
        }
        drop(results);
        let (mut sent, mut taken, mut more) = (0, 0, true);
        let mut early = BTreeMap::new();
        loop {
            while more && sent - taken < 2 * started {
                let job = produce()?;
                more = job.is_some_and(|job| jobs.send((sent, job)).is_ok());
                sent += usize::from(more);
            }
            if taken == sent {
                return Ok(());
            }
            let Ok((index, result)) = finished.recv() else {
                return Err(Failure::new("the drawing threads ended early"));
            };
            early.insert(index, result);
            while let Some(result) = early.remove(&taken) {
                taken += 1;
                match result {
                    Ok(result) => take(result?)?,
                    Err(panic) => resume_unwind(panic),
                }
            }
        }
    })
}

fn next<J>(queue: &Mutex<Receiver<(usize, J)>>) -> Option<(usize, J)> {
    queue.lock().ok()?.recv().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(threads: usize, fail_at: Option<u64>) -> (Vec<u64>, Result<(), Failure>) {
        let (mut jobs, mut seen) = (0..100_u64, Vec::new());
        let outcome = in_order(
            threads,
            || Ok(jobs.next()),
            |job| match fail_at {
                Some(bad) if bad == job => Err(Failure::new(format!("job {job}"))),
                _ => Ok(job * job),
            },
            |square| {
                seen.push(square);
                Ok(())
            },
        );
        (seen, outcome)
    }

    #[test]
    fn results_come_in_order_whatever_the_threads() {
        let expected: Vec<u64> = (0..100).map(|k| k * k).collect();
        for threads in [1, 2, 7] {
            let (seen, outcome) = squares(threads, None);
            assert!(outcome.is_ok());
            assert_eq!(seen, expected, "{threads} threads");
        }
    }

    #[test]
    fn what_came_before_a_failure_is_kept() {
        for threads in [1, 3] {
            let (seen, outcome) = squares(threads, Some(40));
            assert_eq!(outcome.unwrap_err().line(), "job 40");
            assert_eq!(seen.len(), 40, "{threads} threads");
        }
    }
}
