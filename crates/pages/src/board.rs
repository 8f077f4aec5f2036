//! tests/verification/board.md: every claim beside a number of others. `board times` measures what
//! the tests of the verification pages take, `board page` writes the table from the pages and from
//! stored results; it runs nothing.
//! `board penetration-25k` and `board penetration-50k` run cases of a round robin.

mod page;
mod quasi_static;
mod robin;
mod rows;
mod times;

#[cfg(test)]
pub(crate) use page::tables;
pub(crate) use page::write;
pub(crate) use robin::{penetration_25k, penetration_50k};
pub(crate) use times::measure;
