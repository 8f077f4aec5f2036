//! From which height does a lump break?

use super::bonds::Bonds;
use super::compare::{Answers, Quantity, Question};
use super::spheres::{ACROSS, Lump, resolved_m, sieves};
use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};
use crate::cells::mean;

pub(super) const QUESTION: Question = Question {
    words: "resolution drop",
    heads: [
        "bonds, spheres across | diameter, mm | spheres | break height, m | \
            finer than three diameters at this height, %",
        "bonds, spheres across | processor time of a fall, s | over the coarsest | \
            break height off the finest",
        "bonds: result | 4 to 6 | 6 to 9 | 9 to 13.5 | order | without end",
    ],
    quantities: &[
        Quantity {
            name: "break height, m",
            scale: 1.0,
            digits: 2,
            is_relative: true,
            is_compared: true,
        },
        Quantity {
            name: "unresolved, %",
            scale: 100.0,
            digits: 0,
            is_relative: false,
            is_compared: false,
        },
    ],
    sizes: &ACROSS,
    held: &[4.0, 6.0],
};

/// Specimens of each size: packings, each turned in its own way.
const SPECIMENS: u32 = 6;
/// Of what breaks, the largest piece has less than this of the mass.
const BROKEN_BELOW: f64 = 0.9;
/// The height tried first, m, and heights to a factor of two.
const FIRST_M: f64 = 0.5;
const STEPS: f64 = 4.0;

/// What a fall leaves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fall {
    /// Mass fractions of the largest piece and of what is finer than three diameters.
    largest: f64,
    unresolved: f64,
    processor_s: f64,
}

impl Fall {
    pub(super) fn of(run: &Run, across: f64) -> Result<Self, Failed> {
        Ok(Self {
            largest: run.fragments().mass_fraction_of_largest,
            unresolved: passing(run, resolved_m(across))?,
            processor_s: run.processor_s(),
        })
    }
}

/// Mass fraction of all fragments that passes a sieve.
pub(super) fn passing(run: &Run, sieve_m: f64) -> Result<f64, Failed> {
    let columns = ["body", "location", "sieve_m", "passing_fraction"];
    for [body, location, opening, fraction] in run.words("distribution.csv", columns)? {
        let is_sieve = (opening.parse::<f64>()? / sieve_m - 1.0).abs() < 1e-6;
        if body == "all" && location == "both" && is_sieve {
            return Ok(fraction.parse()?);
        }
    }
    Err("a run without its sieve".into())
}

/// A height of the ladder, m.
pub(super) fn height_m(rung: i32) -> f64 {
    FIRST_M * (f64::from(rung) / STEPS).exp2()
}

/// What a specimen gives: the height between the highest fall that it survives and the next one,
/// m, what is unresolved after that one, and the processor times of all falls, s.
struct Broken {
    height_m: f64,
    unresolved: f64,
    times_s: Vec<f64>,
}

/// Looks for the height in steps of a factor of two, then by halves.
fn broken(fall: impl Fn(i32) -> Result<Fall, Failed>) -> Result<Broken, Failed> {
    let mut times_s = Vec::new();
    let mut falls = |rung| {
        let fall = fall(rung)?;
        times_s.push(fall.processor_s);
        Ok::<_, Failed>((fall.largest < BROKEN_BELOW, fall.unresolved))
    };
    let (mut low, mut high, mut last) = (None, None, f64::NAN);
    let mut rung = 0_i32;
    let [_, high] = loop {
        let (breaks, unresolved) = falls(rung)?;
        if breaks {
            (high, last) = (Some(rung), unresolved);
        } else {
            low = Some(rung);
        }
        rung = match (low, high) {
            (None, _) => rung - STEPS as i32,
            (_, None) => rung + STEPS as i32,
            (Some(low), Some(high)) if high - low > 1 => (low + high) / 2,
            (Some(low), Some(high)) => break [low, high],
        };
        if rung.abs() > 40 {
            return Err("a lump breaks at no height".into());
        }
    };
    Ok(Broken {
        height_m: (height_m(high) * height_m(high - 1)).sqrt(),
        unresolved: last,
        times_s,
    })
}

/// The keys of `tests/resolution/drop.toml` of a fall.
pub(super) fn keys(bonds: Bonds, across: f64, rung: i32) -> Result<Vec<String>, Failed> {
    let mut keys = bonds.sets(across)?.to_vec();
    keys.push(format!("bodies.lump.drop.height={}", height_m(rung)));
    keys.push(sieves(across));
    Ok(keys)
}

/// The break heights of all specimens, by how one falls from a rung.
pub(super) fn answers(
    across: f64,
    bench: Option<&Bench>,
    fall: &dyn Fn(Lump, i32) -> Result<Fall, Failed>,
) -> Result<Answers, Failed> {
    let (mut values, mut times_s) = (vec![Vec::new(), Vec::new()], Vec::new());
    let mut spheres = 0;
    for number in 1..=SPECIMENS {
        let lump = Lump { across, number };
        spheres = lump.packed(bench)?.radii.len();
        let broken = broken(|rung| fall(lump, rung))?;
        values[0].push(broken.height_m);
        values[1].push(broken.unresolved);
        times_s.extend(broken.times_s);
    }
    Ok(Answers {
        spheres,
        values,
        processor_s: mean(&times_s),
    })
}

/// Lumps that fall onto a plate.
pub(crate) fn drop(bench: &Bench) -> Result<(), Failed> {
    let mut all = Vec::new();
    for (bonds, across) in QUESTION.cases() {
        let fall = |lump: Lump, rung: i32| {
            let mut options = sets(&keys(bonds, across, rung)?);
            options.extend([ONE_THREAD.to_owned(), body("lump", &lump.file(bench))]);
            let name = format!("drop-{}-{}-{rung}", bonds.file_name(), lump.name());
            let run = bench.run(&name, "tests/resolution/drop.toml", &options)?;
            Fall::of(&run, across)
        };
        all.push(answers(across, Some(bench), &fall)?);
    }
    QUESTION.write(&all)
}
