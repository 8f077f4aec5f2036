//! What arrives below a plate against which lumps fly?

use dem_io::Body;

use super::compare::{Quantity, Question, share};
use super::spheres::Lump;
use super::weight::sizes;
use crate::bench::{Bench, Failed, Run};

pub(super) const QUESTION: Question = Question {
    words: "resolution chute",
    heads: [
        "bonds, spheres across | diameter, mm | spheres of a lump | d50, mm | \
            finer than 9 mm, % | finer than three diameters, %",
        "bonds, spheres across | processor time of six lumps, s | over the coarsest | \
            d50 off the finest | finer than 9 mm off, points",
        "bonds: result | 4 to 6 | 6 to 9 | order | without end",
    ],
    quantities: &[
        Quantity {
            name: "d50, mm",
            scale: 1e3,
            digits: 1,
            is_relative: true,
            is_compared: true,
        },
        share("finer than 9 mm, %", true),
        share("unresolved, %", false),
    ],
    sizes: &[4.0, 6.0, 9.0],
    held: &[4.0, 6.0],
};

/// Runs of each size, each with its own packing and its own seed.
const RUNS: u32 = 4;

/// Lumps that fly against a plate.
pub(crate) fn chute(bench: &Bench) -> Result<(), Failed> {
    let keys = |lump: Lump, _: &Body| vec![format!("run.seed={}", lump.number)];
    let values = |run: &Run, across: f64| {
        let [d50_m, quarter, _, unresolved] = sizes(run, across)?;
        Ok(vec![d50_m, quarter, unresolved])
    };
    QUESTION.write(&QUESTION.answered(bench, "chute", RUNS, keys, values)?)
}
