//! The stress suite: every case behaves as predicted, and deviations are reported.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    clippy::print_stdout,
    reason = "a test stops where it fails, and says what it measured"
)]

mod mended;
mod sabotage;
mod suite;

use std::sync::atomic::AtomicBool;

use dem_stress::cases::CASES;
use dem_stress::prediction::Member;

/// Members of a case.
fn members(case: &str) -> Vec<Member> {
    let found = CASES.iter().find(|one| one.name == case).unwrap();
    found.members(&AtomicBool::new(false)).unwrap()
}

/// The member of a case with this name.
fn member(case: &str, what: &str) -> Member {
    let all = members(case).into_iter();
    let mut found = all.filter(|member| member.what == what);
    let one = found.next();
    assert!(found.next().is_none(), "{case}: {what} twice");
    one.unwrap_or_else(|| panic!("{case} has no {what}"))
}
