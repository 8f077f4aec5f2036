//! How fine does a weight break a lump?

use dem_io::Body;
use dem_io::body::body_summary;

use super::compare::{Quantity, Question, share};
use super::spheres::{ACROSS, Lump, QUARTER_M, passing, resolved_m};
use crate::bench::{Bench, Failed, Run};

pub(super) const QUESTION: Question = Question {
    words: "resolution weight",
    heads: [
        "bonds, spheres across | diameter, mm | spheres | d50, mm | t4, % | t10, % | \
            finer than three diameters, %",
        "bonds, spheres across | processor time of a test, s | over the coarsest | \
            d50 off the finest | t4 off, points",
        "bonds: result | 4 to 6 | 6 to 9 | 9 to 13.5 | order | without end",
    ],
    quantities: &[
        Quantity {
            name: "d50, mm",
            scale: 1e3,
            digits: 1,
            is_relative: true,
            is_compared: true,
        },
        share("t4, %", true),
        share("t10, %", false),
        share("unresolved, %", false),
    ],
    sizes: &ACROSS,
    held: &[4.0, 6.0],
};

/// Specimens of each size: packings, each turned in its own way.
const SPECIMENS: u32 = 6;
/// Gaps at anvil and weight, m.
const GAP_M: f64 = 1e-5;

/// d50, m, and the mass fractions t4, t10 (NaN: no sphere is as small) and finer than three
/// diameters of what a run leaves.
pub(super) fn sizes(run: &Run, across: f64) -> Result<[f64; 4], Failed> {
    let all = run
        .summary
        .sizes
        .as_ref()
        .and_then(|all| all.all.get("both"));
    let all = all.ok_or("a run without sizes")?;
    Ok([
        all.d50_m,
        passing(run, QUARTER_M)?,
        all.t10.unwrap_or(f64::NAN),
        passing(run, resolved_m(across))?,
    ])
}

/// Lumps between an anvil and a weight that falls.
pub(crate) fn weight(bench: &Bench) -> Result<(), Failed> {
    let keys = |_: Lump, packed: &Body| {
        let lump = body_summary(packed);
        let [low_m, high_m] = [lump.box_min_m[2] - GAP_M, lump.box_max_m[2] + GAP_M];
        vec![
            format!("walls.anvil.plane.point=[0,0,{low_m}]"),
            format!("walls.weight.plane.point=[0,0,{high_m}]"),
        ]
    };
    let values = |run: &Run, across: f64| Ok(sizes(run, across)?.to_vec());
    QUESTION.write(&QUESTION.answered(bench, "weight", SPECIMENS, keys, values)?)
}
