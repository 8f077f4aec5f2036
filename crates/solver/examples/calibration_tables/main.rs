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
#[cfg(test)]
mod tests;

use programs::Failed;

const USAGE: &str = "write sizes, scatter, stiffness or breaks";

/// A table of the page.
struct Table {
    /// The word that selects it.
    word: &'static str,
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

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

/// The head of a table of fixed columns.
fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

impl Table {
    /// The command that prints it, as a comment, and the table.
    fn markdown(&self) -> String {
        let command = "cargo run --release -p dem-run --example calibration_tables --";
        let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
        let mut lines = vec![
            format!("<!-- {command} {} -->", self.word),
            line(&self.head),
            format!("|{}", "---|".repeat(self.head.len())),
        ];
        lines.extend(self.rows.iter().map(|row| line(row)));
        lines.join("\n")
    }
}
