//! A thread pool that returns results in the order of the jobs.

use std::num::NonZero;
use std::sync::{Mutex, mpsc};
use std::thread;

/// Returns the number of threads that this machine can run at once, or 1 if that is not known.
#[must_use]
pub fn workers() -> NonZero<usize> {
    thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN)
}

/// Does `work` for each job on up to `workers` threads, and returns the results. Jobs are begun in their order.
/// `watch` is called on this thread after each job, with its index.
///
/// Results are handed over one at a time, so a thread starts at most one more job before `watch` has been
/// called for its last. Work that can end early must return that as its result.
///
/// # Panics
///
/// If `work` panics.
pub fn side_by_side<J: Sync, R: Send>(
    jobs: &[J],
    workers: NonZero<usize>,
    work: impl Fn(&J) -> R + Sync,
    mut watch: impl FnMut(usize),
) -> Vec<R> {
    let waiting = Mutex::new(jobs.iter().enumerate());
    let (done, results) = mpsc::sync_channel(0);
    thread::scope(|scope| {
        for _ in 0..workers.get().min(jobs.len()) {
            let (waiting, done, work) = (&waiting, done.clone(), &work);
            scope.spawn(move || {
                while let Some((i, job)) = waiting.lock().ok().and_then(|mut jobs| jobs.next()) {
                    if done.send((i, work(job))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(done);
        let mut found: Vec<(usize, R)> = results.into_iter().inspect(|(i, _)| watch(*i)).collect();
        found.sort_by_key(|(i, _)| *i);
        // A worker's panic ends the scope, so that all jobs have been done.
        found.into_iter().map(|(_, result)| result).collect()
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    use super::*;

    #[test]
    fn workers_wait_until_they_were_heard_of() {
        let (begun, mut heard) = (AtomicUsize::new(0), 0);
        let workers = NonZero::<usize>::MIN.saturating_add(2);
        let jobs: Vec<usize> = (0..40).collect();
        let work = |&job: &usize| {
            begun.fetch_add(1, Ordering::SeqCst);
            2 * job
        };
        let doubled = side_by_side(&jobs, workers, work, |_| {
            heard += 1;
            thread::sleep(Duration::from_millis(2));
            let ahead = begun.load(Ordering::SeqCst) - heard;
            assert!(ahead <= workers.get(), "{ahead}");
        });
        let expected: Vec<usize> = jobs.iter().map(|job| 2 * job).collect();
        assert_eq!((doubled, heard), (expected, jobs.len()));
    }
}
