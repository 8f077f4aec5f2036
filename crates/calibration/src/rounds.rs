//! Rounds of tests: every packing once with the same numbers.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use dem_io::Result;

use crate::case::{Case, Round, Trial};
use crate::search::{Step, next};
use crate::unknown::Unknown;

/// Does the test of a packing, given by its number from 0, with a factor on the numbers of each
/// unknown.
pub type TestFunction<'a> = dyn Fn(&[f64], usize) -> Result<Trial> + Sync + 'a;

/// Does rounds of tests, from the first factors of `case`, until the targets are met or cannot be
/// met. Rounds that `case` already has are not repeated. `workers` tests run at a time; `save` is
/// called after every test, and `case` keeps the finished tests on an error.
pub fn calibrate(
    unknowns: &[Unknown],
    packings: usize,
    case: &mut Case,
    workers: usize,
    test: &TestFunction<'_>,
    save: &(dyn Fn(&Case) -> Result<()> + Sync),
) -> Result<()> {
    let start = case.start.as_ref().map(|start| start.factors.clone());
    let mut factors = start.unwrap_or_else(|| vec![1.0; unknowns.len()]);
    let mut at = 0;
    while case.end.is_none() {
        if at == case.rounds.len() {
            case.rounds.push(Round {
                factors: factors.clone(),
                trials: vec![None; packings],
            });
        }
        do_round(case, at, workers, test, save)?;
        match next(unknowns, &case.rounds[..=at]) {
            Step::Try(new) => factors = new,
            Step::Stop(best, end) => case.end = Some((best, end)),
        }
        at += 1;
    }
    save(case)
}

/// Does the tests of a round that are not done, some at a time.
fn do_round(
    case: &mut Case,
    at: usize,
    workers: usize,
    test: &TestFunction<'_>,
    save: &(dyn Fn(&Case) -> Result<()> + Sync),
) -> Result<()> {
    let round = &case.rounds[at];
    let factors = round.factors.clone();
    let trials = round.trials.iter().enumerate();
    let left: Vec<usize> = trials
        .filter(|(_, trial)| trial.is_none())
        .map(|(packing, _)| packing)
        .collect();
    let taken = AtomicUsize::new(0);
    let shared = Mutex::new((case, Ok(())));
    let work = || {
        while let Some(&packing) = left.get(taken.fetch_add(1, Ordering::Relaxed)) {
            let done = test(&factors, packing);
            let Ok(mut guard) = shared.lock() else { return };
            let (case, problem) = &mut *guard;
            let saved = done.and_then(|trial| {
                case.rounds[at].trials[packing] = Some(trial);
                save(case)
            });
            if saved.is_err() {
                if problem.is_ok() {
                    *problem = saved;
                }
                taken.store(left.len(), Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..workers.min(left.len()) {
            scope.spawn(work);
        }
        work();
    });
    // The scope has passed on the panic of a worker.
    shared.into_inner().map_or(Ok(()), |(_, problem)| problem)
}
