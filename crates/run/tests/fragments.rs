//! Output of a run about fragments.

pub(crate) mod burst;
mod files;
mod pictures;
mod resume;
mod sizes;

use std::fs;
use std::path::Path;

/// The header of a table, and its rows as texts, checked to have the same length.
pub(crate) fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(path).unwrap();
    let words = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<String>>();
    let mut lines = text.lines();
    let header = words(lines.next().unwrap());
    let rows: Vec<Vec<String>> = lines.map(words).collect();
    assert!(rows.iter().all(|row| row.len() == header.len()));
    (header, rows)
}
