//! Runs a list of jobs, a few at a time.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::thread;

use anyhow::Context as _;

/// Jobs that run at a time.
const WORKERS: usize = 2;

/// Runs the jobs up to the first that fails, and announces each in the words of `describe`.
pub(crate) fn run_all<J: Ord + Send + std::fmt::Debug, R: Send>(
    jobs: Vec<J>,
    run: impl Fn(&J) -> anyhow::Result<R> + Sync,
    describe: impl Fn(&J, &R) -> String + Sync,
) -> anyhow::Result<BTreeMap<J, R>> {
    let count = jobs.len();
    let queue = Mutex::new(jobs.into_iter().enumerate());
    let next = || queue.lock().ok().and_then(|mut queue| queue.next());
    let work = || -> anyhow::Result<Vec<(J, R)>> {
        let mut done = Vec::new();
        while let Some((index, job)) = next() {
            let result = run(&job).with_context(|| {
                // A failure drops the other jobs.
                while next().is_some() {}
                format!("{job:?}")
            })?;
            println!("{}/{count} {}", index + 1, describe(&job, &result));
            done.push((job, result));
        }
        Ok(done)
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..WORKERS).map(|_| scope.spawn(work)).collect();
        let mut results = BTreeMap::new();
        for worker in workers {
            results.extend(worker.join().map_err(|_| anyhow::anyhow!("a worker panicked"))??);
        }
        Ok(results)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_job_runs_once_and_a_failure_ends_the_rest() {
        let results = run_all((0..50).collect(), |job| Ok(job * 2), |_, _| String::new()).unwrap();
        assert_eq!(results, (0..50).map(|job| (job, job * 2)).collect());
        let failing = run_all(
            (0..50).collect::<Vec<i32>>(),
            |job| if *job == 3 { Err(anyhow::anyhow!("no")) } else { Ok(()) },
            |_, ()| String::new(),
        );
        assert_eq!(format!("{:#}", failing.unwrap_err()), "3: no");
    }
}
