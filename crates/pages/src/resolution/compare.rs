//! The answers to a question by size of the spheres: their scatter, their error, their run time,
//! and whether they converge.

use dem_io::Body;
use dem_laboratory::{Statistic, half_width};

use super::bonds::{Bonds, PAGE, label};
use super::spheres::{Lump, REFINEMENT, diameter_m, sieves};
use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};
use crate::cells::{mean, thousands};
use crate::table::{Table, write};

/// One of the numbers that answer a question.
pub(super) struct Quantity {
    pub(super) name: &'static str,
    /// From SI to its unit.
    pub(super) scale: f64,
    pub(super) digits: usize,
    /// Whether it is compared by its logarithm, with geometric means, or by differences in points:
    /// a part of the mass, from 0 to 1.
    pub(super) is_relative: bool,
    /// Whether it is compared with that of the finest spheres.
    pub(super) is_compared: bool,
}

/// A part, in percent.
pub(super) const fn share(name: &'static str, is_compared: bool) -> Quantity {
    Quantity {
        name,
        scale: 100.0,
        digits: 0,
        is_relative: false,
        is_compared,
    }
}

/// Questions with their tables: answers, errors over run time, convergence.
pub(super) struct Question {
    pub(super) words: &'static str,
    pub(super) heads: [&'static str; 3],
    pub(super) quantities: &'static [Quantity],
    /// Spheres across, the coarsest first.
    pub(super) sizes: &'static [f64],
    /// Spheres across that also take bonds which were not calibrated for them.
    pub(super) held: &'static [f64],
}

/// The answers of all specimens of one size of spheres.
pub(super) struct Answers {
    pub(super) spheres: usize,
    /// By quantity, then by specimen; in SI. NaN: these spheres give none.
    pub(super) values: Vec<Vec<f64>>,
    /// Mean processor time of a run, s.
    pub(super) processor_s: f64,
}

/// A mean and the ends of its 95 % confidence interval (Student's t).
#[derive(Debug, Clone, Copy)]
pub(super) struct Interval {
    pub(super) mean: f64,
    pub(super) least: f64,
    pub(super) most: f64,
}

impl Interval {
    pub(super) fn of(values: &[f64]) -> Self {
        let statistic = Statistic::of(values);
        let half = half_width(&statistic).unwrap_or(f64::NAN);
        Self {
            mean: statistic.mean,
            least: statistic.mean - half,
            most: statistic.mean + half,
        }
    }

    fn map(self, of: impl Fn(f64) -> f64) -> Self {
        Self {
            mean: of(self.mean),
            least: of(self.least),
            most: of(self.most),
        }
    }

    fn is_other_than_zero(self) -> bool {
        self.least > 0.0 || self.most < 0.0
    }
}

impl Question {
    /// The answers to all cases by a scene, whose lumps are each packed and turned in their own way.
    /// `keys`: what a lump sets in it. `values`: what a run gives for each quantity, in SI.
    pub(super) fn answered(
        &self,
        bench: &Bench,
        scene: &str,
        lumps: u32,
        keys: impl Fn(Lump, &Body) -> Vec<String>,
        values: impl Fn(&Run, f64) -> Result<Vec<f64>, Failed>,
    ) -> Result<Vec<Answers>, Failed> {
        let mut all = Vec::new();
        for (bonds, across) in self.cases() {
            let (mut found, mut times_s) = (vec![Vec::new(); self.quantities.len()], Vec::new());
            let mut spheres = 0;
            for number in 1..=lumps {
                let lump = Lump { across, number };
                let packed = lump.packed(Some(bench))?;
                spheres = packed.radii.len();
                let mut set = bonds.sets(across)?.to_vec();
                set.push(sieves(across));
                set.extend(keys(lump, &packed));
                let mut options = sets(&set);
                options.extend([ONE_THREAD.to_owned(), body("lump", &lump.file(bench))]);
                let name = format!("{scene}-{}-{}", bonds.file_name(), lump.name());
                let run = bench.run(&name, &format!("tests/resolution/{scene}.toml"), &options)?;
                for (found, value) in found.iter_mut().zip(values(&run, across)?) {
                    found.push(value);
                }
                times_s.push(run.processor_s());
            }
            all.push(Answers {
                spheres,
                values: found,
                processor_s: mean(&times_s),
            });
        }
        Ok(all)
    }
}

impl Quantity {
    fn compared(&self, value: f64) -> f64 {
        if self.is_relative { value.ln() } else { value }
    }

    /// The mean of specimens with its interval: `0.52 (0.45 to 0.60)`.
    pub(super) fn cell(&self, values: &[f64]) -> String {
        if values.iter().any(|value| value.is_nan()) {
            return "no sphere as small".to_owned();
        }
        let compared: Vec<f64> = values.iter().map(|value| self.compared(*value)).collect();
        let interval = Interval::of(&compared);
        let back = |value: f64| {
            let value = if self.is_relative {
                value.exp()
            } else {
                value.clamp(0.0, 1.0)
            };
            self.scale * value
        };
        let Interval { mean, least, most } = interval.map(back);
        let digits = self.digits;
        format!("{mean:.digits$} ({least:.digits$} to {most:.digits$})")
    }

    /// How much the specimens differ from the same ones of other spheres.
    fn difference(&self, values: &[f64], others: &[f64]) -> Interval {
        let pairs = values.iter().zip(others);
        let off = pairs.map(|(value, other)| self.compared(*value) - self.compared(*other));
        Interval::of(&off.collect::<Vec<_>>())
    }

    /// The cell of a difference: in percent, or in points of percent.
    fn difference_cell(&self, difference: Interval) -> String {
        if difference.mean.is_nan() {
            return String::new();
        }
        let percent = |value: f64| {
            let fraction = if self.is_relative {
                value.exp_m1()
            } else {
                value
            };
            100.0 * fraction
        };
        let Interval { mean, least, most } = difference.map(percent);
        let unit = if self.is_relative { " %" } else { "" };
        format!("{mean:+.0}{unit} ({least:+.0} to {most:+.0})")
    }
}

/// Order and limit of the last three of values whose spheres shrink by the same ratio
/// (Richardson), or why there are none: the last two changes have to be more than scatter, in the
/// same direction, and to shrink by more than scatter.
pub(super) fn convergence(last: f64, changes: &[Interval]) -> Result<[f64; 2], &'static str> {
    let [.., before, after] = changes else {
        return Err("too few sizes");
    };
    if !(before.is_other_than_zero() && after.is_other_than_zero()) {
        return Err("changes within the scatter");
    }
    if before.mean * after.mean < 0.0 {
        return Err("changes turn");
    }
    let size = |change: &Interval| {
        let [a, b] = [change.least.abs(), change.most.abs()];
        [a.min(b), a.max(b)]
    };
    let [before_ends, after_ends] = [before, after].map(size);
    if before_ends[0] <= after_ends[1] {
        return Err("changes do not shrink beyond the scatter");
    }
    let ratio = before.mean / after.mean;
    let order = ratio.ln() / REFINEMENT.ln();
    Ok([order, last + after.mean / (ratio - 1.0)])
}

impl Question {
    /// Its bonds and sizes of spheres, in the order of the rows.
    pub(super) fn cases(&self) -> Vec<(Bonds, f64)> {
        let of = |bonds, sizes: &[f64]| sizes.iter().map(|across| (bonds, *across)).collect();
        let all: [Vec<(Bonds, f64)>; 3] = [
            of(Bonds::Brittle, self.sizes),
            of(Bonds::Softening, self.sizes),
            of(Bonds::Held, self.held),
        ];
        all.concat()
    }

    fn compared(&self) -> impl Iterator<Item = (usize, &Quantity)> {
        let all = self.quantities.iter().enumerate();
        all.filter(|(_, quantity)| quantity.is_compared)
    }

    fn labels(&self) -> Vec<String> {
        let cases = self.cases().into_iter();
        cases.map(|(bonds, across)| label(bonds, across)).collect()
    }

    pub(super) fn tables(&self) -> [Table; 3] {
        let converge = [Bonds::Brittle, Bonds::Softening].map(|bonds| {
            let row = |(_, quantity): (usize, &Quantity)| {
                let (name, _) = quantity.name.split_once(',').unwrap_or((quantity.name, ""));
                format!("{}: {name}", bonds.name())
            };
            self.compared().map(row).collect::<Vec<_>>()
        });
        let [answers, errors, converges] = self.heads;
        [
            Table::new(PAGE, self.words, answers, self.labels()),
            Table::new(PAGE, self.words, errors, self.labels()),
            Table::new(PAGE, self.words, converges, converge.concat()),
        ]
    }

    /// Writes the tables of these answers, in the order of the cases.
    pub(super) fn write(&self, answers: &[Answers]) -> Result<(), Failed> {
        let [mut shown, mut errors, mut converges] = self.tables();
        let sizes = self.sizes.len();
        for (at, ((bonds, across), answer)) in self.cases().into_iter().zip(answers).enumerate() {
            let mut cells = vec![
                format!("{:.2}", 1e3 * diameter_m(across)),
                thousands(answer.spheres as f64),
            ];
            let values = self.quantities.iter().zip(&answer.values);
            cells.extend(values.map(|(quantity, values)| quantity.cell(values)));
            shown.row(cells);

            let first = if bonds == Bonds::Softening { sizes } else { 0 };
            let finest = first + sizes - 1;
            let mut cells = vec![
                format!("{:.2}", answer.processor_s),
                format!("{:.1}", answer.processor_s / answers[first].processor_s),
            ];
            let off = |(of, quantity): (usize, &Quantity)| {
                if at == finest {
                    return "0".to_owned();
                }
                let finest = &answers[finest].values[of];
                quantity.difference_cell(quantity.difference(&answer.values[of], finest))
            };
            cells.extend(self.compared().map(off));
            errors.row(cells);
        }
        for of_bonds in answers.chunks(sizes).take(2) {
            for (of, quantity) in self.compared() {
                converges.row(converged(quantity, of, of_bonds));
            }
        }
        write(&[shown, errors, converges])
    }
}

/// The cells of the convergence of a quantity over the sizes of spheres.
fn converged(quantity: &Quantity, of: usize, answers: &[Answers]) -> Vec<String> {
    let pairs = answers.windows(2);
    let changes: Vec<Interval> = pairs
        .map(|pair| quantity.difference(&pair[1].values[of], &pair[0].values[of]))
        .collect();
    let mut cells: Vec<String> = changes
        .iter()
        .map(|change| quantity.difference_cell(*change))
        .collect();
    let finest = &answers[answers.len() - 1].values[of];
    let compared: Vec<f64> = finest
        .iter()
        .map(|value| quantity.compared(*value))
        .collect();
    let last = Statistic::of(&compared).mean;
    let [order, limit] = match convergence(last, &changes) {
        Ok([order, limit]) => {
            let limit = if quantity.is_relative {
                limit.exp()
            } else {
                limit
            };
            let digits = quantity.digits;
            [
                format!("{order:.1}"),
                format!("{:.digits$}", quantity.scale * limit),
            ]
        }
        Err(why) => [why.to_owned(), String::new()],
    };
    cells.extend([order, limit]);
    cells
}
