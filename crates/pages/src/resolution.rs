//! tests/verification/resolution.md: the same questions asked with several sizes of spheres, whose
//! bonds are calibrated for each, and what the answers take.

mod bonds;
mod chute;
mod compare;
mod drop;
mod spheres;
#[cfg(test)]
mod tests;
mod weight;

pub(crate) use self::bonds::calibrate;
pub(crate) use self::chute::chute;
pub(crate) use self::drop::drop;
pub(crate) use self::weight::weight;
#[cfg(test)]
use crate::table::Table;

#[cfg(test)]
pub(crate) fn tables() -> Vec<Table> {
    let mut all = vec![bonds::table()];
    all.extend(drop::QUESTION.tables());
    all.extend(weight::QUESTION.tables());
    all.extend(chute::QUESTION.tables());
    all
}
