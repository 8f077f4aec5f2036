//! What arrives below a plate against which lumps fly?

use super::compare::{Answers, Quantity, Question, share};
use super::spheres::{Lump, sieves};
use super::weight::sizes;
use crate::bench::{Bench, Failed, ONE_THREAD, body, sets};
use crate::cells::mean;

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
    let mut all = Vec::new();
    for (bonds, across) in QUESTION.cases() {
        let (mut values, mut times_s) = (vec![Vec::new(); 3], Vec::new());
        let mut spheres = 0;
        for number in 1..=RUNS {
            let lump = Lump { across, number };
            spheres = lump.packed(Some(bench))?.radii.len();
            let mut keys = bonds.sets(across)?.to_vec();
            keys.extend([sieves(across), format!("run.seed={number}")]);
            let mut options = sets(&keys);
            options.extend([ONE_THREAD.to_owned(), body("lump", &lump.file(bench))]);
            let name = format!("chute-{}-{}", bonds.file_name(), lump.name());
            let run = bench.run(&name, "tests/resolution/chute.toml", &options)?;
            let [d50_m, quarter, _, unresolved] = sizes(&run, across)?;
            for (values, value) in values.iter_mut().zip([d50_m, quarter, unresolved]) {
                values.push(value);
            }
            times_s.push(run.processor_s());
        }
        all.push(Answers {
            spheres,
            values,
            processor_s: mean(&times_s),
        });
    }
    QUESTION.write(&all)
}
