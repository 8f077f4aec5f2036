//! The tables of doc/calibration.md. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example calibration_tables -- sizes         # 6 minutes
//! cargo run --release -p dem-run --example calibration_tables -- scatter       # 20 minutes
//! cargo run --release -p dem-run --example calibration_tables -- stiffness     # 2 minutes
//! cargo run --release -p dem-run --example calibration_tables -- breaks        # 2 minutes
//! ```
//!
//! Each prints its table, and the command as a comment above it. Tests run one after another on one
//! thread. Their results are kept in `target/calibration-tables`; what is there is not computed
//! again.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod bench;
mod breaks;
#[path = "../programs/mod.rs"]
mod programs;
mod scatter;
mod sizes;
mod stiffness;
mod table;
#[cfg(test)]
mod tests;

use programs::Failed;

const USAGE: &str = "write sizes, scatter, stiffness or breaks";

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let table = match words.first().map_or("", String::as_str) {
        "sizes" => sizes::table(),
        "scatter" => scatter::table(),
        "stiffness" => stiffness::table(),
        "breaks" => breaks::table(),
        _ => Err(USAGE.into()),
    };
    println!("{}", table?.markdown());
    Ok(())
}
