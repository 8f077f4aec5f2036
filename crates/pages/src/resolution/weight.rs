//! How fine does a weight break a lump?

use dem_io::Body;

use super::compare::{Answers, Quantity, Question, share};
use super::spheres::{ACROSS, Lump, QUARTER_M, passing, resolved_m, sieves};
use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};
use crate::cells::mean;

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

/// The lowest and the highest place of a body, m.
fn ends_m(body: &Body) -> [f64; 2] {
    let places = body.positions.iter().zip(&body.radii);
    let ends = places.map(|(place, radius)| [place[2] - radius, place[2] + radius]);
    ends.fold([f64::INFINITY, f64::NEG_INFINITY], |so_far, ends| {
        [so_far[0].min(ends[0]), so_far[1].max(ends[1])]
    })
}

/// Lumps between an anvil and a weight that falls.
pub(crate) fn weight(bench: &Bench) -> Result<(), Failed> {
    let mut all = Vec::new();
    for (bonds, across) in QUESTION.cases() {
        let (mut values, mut times_s) = (vec![Vec::new(); 4], Vec::new());
        let mut spheres = 0;
        for number in 1..=SPECIMENS {
            let lump = Lump { across, number };
            let packed = lump.packed(Some(bench))?;
            spheres = packed.radii.len();
            let [low_m, high_m] = ends_m(&packed);
            let mut keys = bonds.sets(across)?.to_vec();
            keys.push(sieves(across));
            keys.push(format!("walls.anvil.plane.point=[0,0,{}]", low_m - GAP_M));
            keys.push(format!("walls.weight.plane.point=[0,0,{}]", high_m + GAP_M));
            let mut options = sets(&keys);
            options.extend([ONE_THREAD.to_owned(), body("lump", &lump.file(bench))]);
            let name = format!("weight-{}-{}", bonds.file_name(), lump.name());
            let run = bench.run(&name, "tests/resolution/weight.toml", &options)?;
            for (values, value) in values.iter_mut().zip(sizes(&run, across)?) {
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
