//! Functions shared by the readers of tables of particles and bonds.

use crate::diagnostic::{Diagnostic, Result};
use crate::lines::{missing, not_a_number};

/// The same message about a particle or a bond of a body from two tables, with the place in its
/// table.
pub(super) fn in_table(error: Diagnostic) -> Diagnostic {
    let place = error.place.as_str();
    if place.starts_with("particle ") {
        error.within("particles")
    } else if place.starts_with("bond ") {
        error.within("bonds")
    } else {
        error
    }
}

/// The index, from 0, of the particle given by `word`. `first` is the number of the first of them.
pub(super) fn particle(
    word: Option<&str>,
    what: &str,
    first: u32,
    particles: usize,
) -> Result<u32> {
    let word = word.ok_or_else(|| missing(what))?;
    let number: u64 = word
        .parse()
        .map_err(|_| not_a_number(word, what, "the number of a particle"))?;
    let index = number
        .checked_sub(u64::from(first))
        .filter(|index| *index < particles as u64);
    index
        .and_then(|index| u32::try_from(index).ok())
        .ok_or_else(|| {
            let problem = format!(
                "{what} is {number}, but there are {particles} particles, numbered from {first}"
            );
            Diagnostic::input("", problem, "correct or remove this line")
        })
}

/// The words in these columns of `line`.
pub(super) fn pick<const N: usize>(line: &str, columns: [Option<usize>; N]) -> [Option<&str>; N] {
    let mut picked = [None; N];
    for (column, word) in line.split(',').enumerate() {
        for (slot, wanted) in picked.iter_mut().zip(columns) {
            if wanted == Some(column) {
                *slot = Some(word.trim());
            }
        }
    }
    picked
}
