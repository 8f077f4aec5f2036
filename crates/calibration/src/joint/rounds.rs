//! Rounds of a calibration by several tests: every packing of every test once with the same
//! numbers.

use dem_io::Result;

use super::search::next_of_joint;
use super::state::Joint;
use crate::case::{Round, Trial};
use crate::rounds::{TestFunction, do_round};
use crate::search::Step;

/// Saves what has been done so far.
type SaveJoint<'a> = dyn Fn(&Joint) -> Result<()> + Sync + 'a;

/// Does rounds of tests, from the first factors, until the targets are met or cannot be met. Rounds
/// that there are already are not repeated. `test` does a test by its index in a round
/// ([`Joint::job`]); `workers` tests run at a time; `save` is called after every test, and `joint`
/// keeps the finished tests on an error.
pub fn calibrate_joint(
    joint: &mut Joint,
    workers: usize,
    test: &TestFunction<'_>,
    save: &SaveJoint<'_>,
) -> Result<()> {
    let first = joint.start.as_ref().map(|start| start.factors.clone());
    let mut factors = first.unwrap_or_else(|| vec![1.0; joint.unknowns.len()]);
    let mut done = joint.clone();
    done.rounds.clear();
    while joint.end.is_none() {
        let at = done.rounds.len();
        if at == joint.rounds.len() {
            let round = Round::new(factors.clone(), joint.jobs());
            joint.rounds.push(round);
        }
        do_round(
            joint,
            &|joint: &mut Joint| joint.rounds.get_mut(at),
            workers,
            test,
            save,
        )?;
        done.rounds.push(joint.rounds[at].clone());
        match next_of_joint(&done) {
            Step::Try(new) => factors = new,
            Step::Stop(best, end) => joint.end = Some((best, end)),
        }
    }
    save(joint)
}

/// Does the tests whose scenes ask for it with the numbers of the result, by `test` at twice the
/// rate; `asked`: one for each test.
pub fn check_joint_rate(
    joint: &mut Joint,
    asked: &[bool],
    workers: usize,
    test: &TestFunction<'_>,
    save: &SaveJoint<'_>,
) -> Result<()> {
    let jobs = joint.jobs();
    if joint.at_twice_the_rate.is_none() {
        let of = |round: &Round| Round::new(round.factors.clone(), jobs);
        joint.at_twice_the_rate = joint.result().map(of);
    }
    let tests: Vec<usize> = (0..jobs).map(|at| joint.job(at).0).collect();
    let aims = joint.aims.len();
    let asked_only = |factors: &[f64], at: usize| match asked[tests[at]] {
        true => test(factors, at),
        false => Ok(Trial {
            results: vec![None; aims],
            at_least: vec![None; aims],
            curve: Vec::new(),
            doubts: Vec::new(),
            broken_at_peak: 0,
            wall_s: 0.0,
        }),
    };
    do_round(
        joint,
        &|joint: &mut Joint| joint.at_twice_the_rate.as_mut(),
        workers,
        &asked_only,
        save,
    )
}
