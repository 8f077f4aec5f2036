//! Rounds of tests: every packing once with the same numbers.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use dem_io::Result;

use crate::case::{Case, End, Round, Trial};
use crate::search::{Step, next};
use crate::unknown::Unknown;

/// Bodies with fewer spheres across sink in at pins and plates more than they bend.
const FEWEST_ACROSS: f64 = 5.0;

/// Does the test of a packing, given by its number from 0, with a factor on the numbers of each
/// unknown.
pub type TestFunction<'a> = dyn Fn(&[f64], usize) -> Result<Trial> + Sync + 'a;

/// Saves what has been done so far.
pub type SaveFunction<'a> = dyn Fn(&Case) -> Result<()> + Sync + 'a;

/// Does rounds of tests, from the first factors of `case`, until the targets are met or cannot be
/// met. Rounds that `case` already has are not repeated. `workers` tests run at a time; `save` is
/// called after every test, and `case` keeps the finished tests on an error.
pub fn calibrate(
    unknowns: &[Unknown],
    packings: usize,
    case: &mut Case,
    workers: usize,
    test: &TestFunction<'_>,
    save: &SaveFunction<'_>,
) -> Result<()> {
    let start = case.start.clone();
    let first = start.as_ref().map(|start| start.factors.clone());
    let mut factors = first.unwrap_or_else(|| vec![1.0; unknowns.len()]);
    let mut at = 0;
    while case.end.is_none() {
        if at == case.rounds.len() {
            case.rounds.push(Round::new(factors.clone(), packings));
        }
        do_round(
            case,
            &|case: &mut Case| case.rounds.get_mut(at),
            workers,
            test,
            save,
        )?;
        match next(unknowns, start.as_ref(), &case.rounds[..=at]) {
            Step::Try(new) => factors = new,
            Step::Stop(best, end) => case.end = Some((best, coarse(end, case.spheres_across))),
        }
        at += 1;
    }
    save(case)
}

/// Names a body that is too coarse as a reason for a failure.
fn coarse(end: End, across: f64) -> End {
    match end {
        End::NotMet(problem, remedy) if across < FEWEST_ACROSS => End::NotMet(
            problem,
            format!("{remedy}; the body is only {across:.1} spheres across: take smaller ones"),
        ),
        end => end,
    }
}

/// Does the tests of all packings with the numbers of the result, by `test` at twice the rate.
pub fn check_rate(
    case: &mut Case,
    workers: usize,
    test: &TestFunction<'_>,
    save: &SaveFunction<'_>,
) -> Result<()> {
    if case.at_twice_the_rate.is_none() {
        let of = |round: &Round| Round::new(round.factors.clone(), round.trials.len());
        case.at_twice_the_rate = case.result().map(of);
    }
    do_round(
        case,
        &|case: &mut Case| case.at_twice_the_rate.as_mut(),
        workers,
        test,
        save,
    )
}

/// A round of what is calibrated.
pub(crate) type RoundOf<'a, C> = dyn Fn(&mut C) -> Option<&mut Round> + Sync + 'a;

/// Does the tests of a round of `case` that are not done, some at a time.
pub(crate) fn do_round<C: Send>(
    case: &mut C,
    round_of: &RoundOf<'_, C>,
    workers: usize,
    test: &TestFunction<'_>,
    save: &(dyn Fn(&C) -> Result<()> + Sync + '_),
) -> Result<()> {
    let Some(round) = round_of(case) else {
        return Ok(());
    };
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
                if let Some(round) = round_of(case) {
                    round.trials[packing] = Some(trial);
                }
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
