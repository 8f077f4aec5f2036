//! From which height does a lump break?

use dem_io::Body;

use super::bonds::Bonds;
use super::compare::{Answers, Quantity, Question, share};
use super::spheres::{ACROSS, Lump, passing, resolved_m, sieves};
use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};
use crate::cells::mean;

pub(super) const QUESTION: Question = Question {
    words: "resolution drop",
    heads: [
        "bonds, spheres across | diameter, mm | spheres | break height, m | \
            finer than three diameters, % | bonds damaged, %",
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
        share("unresolved, %", false),
        share("bonds damaged, %", false),
    ],
    sizes: &ACROSS,
    held: &[4.0, 6.0],
};

/// Specimens of each size: packings, each turned in its own way.
pub(super) const SPECIMENS: usize = 6;
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
    /// Part of the bonds that have softened and are not broken.
    damaged: f64,
    processor_s: f64,
}

impl Fall {
    pub(super) fn of(run: &Run, across: f64) -> Result<Self, Failed> {
        Ok(Self {
            largest: run.fragments().mass_fraction_of_largest,
            unresolved: passing(run, resolved_m(across))?,
            damaged: run.summary.damaged_bonds.unwrap_or(0) as f64 / run.summary.bonds as f64,
            processor_s: run.processor_s(),
        })
    }
}

/// A height of the ladder, m.
pub(super) fn height_m(rung: i32) -> f64 {
    FIRST_M * (f64::from(rung) / STEPS).exp2()
}

/// Where the search for a height begins: a rung, and the first step from it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    pub(super) rung: i32,
    pub(super) step: i32,
}

/// That of the coarsest spheres. Others begin where the same specimen of larger spheres broke.
pub(super) const START: Start = Start { rung: 0, step: 4 };

/// What a specimen gives: the lowest rung from which it breaks, what that fall leaves, and the
/// processor times of all falls, s.
struct Broken {
    rung: i32,
    fall: Fall,
    times_s: Vec<f64>,
}

/// Looks for the rung by steps that double, then by halves.
fn broken(start: Start, fall: impl Fn(i32) -> Result<Fall, Failed>) -> Result<Broken, Failed> {
    let (mut low, mut high): (Option<i32>, Option<(i32, Fall)>) = (None, None);
    let (mut times_s, mut rung, mut step) = (Vec::new(), start.rung, start.step);
    let (rung, fall) = loop {
        let found = fall(rung)?;
        times_s.push(found.processor_s);
        if found.largest < BROKEN_BELOW {
            high = Some((rung, found));
        } else {
            low = Some(rung);
        }
        rung = match (low, high) {
            (None, _) => rung - step,
            (_, None) => rung + step,
            (Some(low), Some((high, _))) if high - low > 1 => i32::midpoint(low, high),
            (_, Some(high)) => break high,
        };
        step *= 2;
        if rung.abs() > 40 {
            return Err("a lump breaks at no height".into());
        }
    };
    Ok(Broken {
        rung,
        fall,
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

/// The break heights of all specimens, by how one falls from a rung; each is half a rung below the
/// lowest fall that breaks it. `starts` are those of the specimens, and become those of the next
/// smaller spheres.
pub(super) fn answers(
    across: f64,
    bench: Option<&Bench>,
    starts: &mut [Start],
    fall: &dyn Fn(Lump, &Body, i32) -> Result<Fall, Failed>,
) -> Result<Answers, Failed> {
    let (mut values, mut times_s) = (vec![Vec::new(); 3], Vec::new());
    let mut spheres = 0;
    for (number, start) in (1..).zip(starts) {
        let lump = Lump { across, number };
        let packed = lump.packed(bench)?;
        spheres = packed.radii.len();
        let broken = broken(*start, |rung| fall(lump, &packed, rung))?;
        values[0].push((height_m(broken.rung) * height_m(broken.rung - 1)).sqrt());
        values[1].push(broken.fall.unresolved);
        values[2].push(broken.fall.damaged);
        times_s.extend(broken.times_s);
        let rung = broken.rung;
        *start = Start { rung, step: 1 };
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
    let mut starts = [START; SPECIMENS];
    for (bonds, across) in QUESTION.cases() {
        if across == QUESTION.sizes[0] {
            starts = [START; SPECIMENS];
        }
        let fall = |lump: Lump, _: &Body, rung: i32| {
            let mut options = sets(&keys(bonds, across, rung)?);
            options.extend([ONE_THREAD.to_owned(), body("lump", &lump.file(bench))]);
            let name = format!("drop-{}-{}-{rung}", bonds.file_name(), lump.name());
            let run = bench.run(&name, "tests/resolution/drop.toml", &options)?;
            Fall::of(&run, across)
        };
        all.push(answers(across, Some(bench), &mut starts, &fall)?);
    }
    QUESTION.write(&all)
}
