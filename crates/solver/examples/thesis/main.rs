//! The tests of Platzer 2022 on its two samples, and the page that sets its results beside ours.
//! From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example thesis -- sample
//! cargo run --release -p dem-run --example thesis -- steps
//! cargo run --release -p dem-run --example thesis -- bending           # an hour and a half
//! cargo run --release -p dem-run --example thesis -- drops             # two hours
//! cargo run --release -p dem-run --example thesis -- strengthening     # two hours
//! cargo run --release -p dem-run --example thesis -- rebound
//! cargo run --release -p dem-run --example thesis -- page
//! ```
//!
//! Each command but the last computes its cases one after another on one thread and writes a file
//! for each into `target/thesis`. Cases whose file is there are not computed again. A word after
//! the command selects the cases whose names contain it: `bending bending-2` are those of table
//! two. `page` writes `tests/verification/thesis.md` and its plots from the files that are there;
//! what has not been computed anew stays as it stands.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it says what it computes"
)]

mod bench;
mod bending;
mod drops;
mod map;
mod oscillation;
mod page;
mod plots;
#[path = "../programs/mod.rs"]
mod programs;
mod rebound;
mod samples;
mod steps;
mod strengthening;
#[cfg(test)]
mod tests;
mod text;
mod watch;

use bench::{Bench, Failed};

const USAGE: &str = "write sample, steps, bending, drops, strengthening, rebound or page, then a part of the names of the cases or nothing";

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let part = words.get(1).map_or("", String::as_str);
    match words.first().map(String::as_str) {
        Some("sample") => samples::compute(&Bench::new()?, part),
        Some("bending") => bending::compute(&Bench::new()?, part),
        Some("drops") => drops::compute(&Bench::new()?, part),
        Some("strengthening") => strengthening::compute(&Bench::new()?, part),
        Some("rebound") => {
            oscillation::compute(&Bench::new()?)?;
            rebound::compute(&Bench::new()?, part)
        }
        Some("steps") => steps::compute(&Bench::new()?),
        Some("page") => page::write(&bench::results()?),
        _ => Err(USAGE.into()),
    }
}
