//! The tables of doc/dynamic-tests.md, made by running its studies. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example dynamic_tables -- rates
//! cargo run --release -p dem-run --example dynamic_tables -- heights
//! ```
//!
//! Builds the program and runs `hopkinson-rates.toml` or `drop-weight-heights.toml` as they are,
//! some minutes each. Results are written to `target/dynamic-tables`, with the plots
//! `strain-rate.svg`, strength over strain rate beside eq. 20, and `t10.svg`, fines over specific
//! energy; `--resume` at the end keeps the complete runs.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod programs;

use dem_io::units::significant;
use dem_plots::{Axis, Line, Marks, Plot, Point};
use dem_run::physics::bond::strain_rate::{HIGHEST_1_S, dynamic_increase_factor};
use programs::study::{Run, Table, runs};
use programs::{Failed, results, root};

const PAGE: &str = "doc/dynamic-tests.md";

const USAGE: &str = "write rates or heights, then --resume or nothing";

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let resume = words.get(1).is_some_and(|word| word == "--resume");
    let found = |study: &str| runs(study, &results("dynamic-tests")?.join(study), resume);
    match words.first().map(String::as_str) {
        Some("rates") => rates(&found("hopkinson-rates")?),
        Some("heights") => heights(&found("drop-weight-heights")?),
        _ => Err(USAGE.into()),
    }
}

fn line(name: &str, points: Vec<[f64; 2]>, dashed: bool) -> Line {
    Line {
        name: name.to_owned(),
        points,
        dashed,
    }
}

/// Largest difference of the forces on both ends over the largest load, between half of it and all
/// of it, of a test in equilibrium: that of the verdict of a run.
const APART: f64 = 0.1;

/// Strength of the disc over the strain rate, without rate strengthening and with it: the runs of
/// the study take turns. A run out of equilibrium measures no strength of the disc, and says so.
fn rates(runs: &[Run]) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "striker",
        "eq. 20 for bonds",
        "strain rate",
        "strength",
        "over the static one",
        "eq. 20 at this rate",
        "(F_1 - F_2)/F, largest",
        "in equilibrium",
    ]);
    let mut marks = ["without rate strengthening", "eq. 20 for the bonds"].map(|name| Marks {
        name: name.to_owned(),
        ..Marks::default()
    });
    for (at, run) in runs.iter().enumerate() {
        let strengthens = at % 2;
        let rate_1_s = run.figure("strain rate");
        let factor = run.figure("dynamic increase factor");
        if !factor.is_finite() {
            return Err("a disc of the study did not break".into());
        }
        let apart = run.figure("force equilibrium");
        let is_valid = apart.abs() <= APART;
        marks[strengthens].points.push(Point {
            at: [rate_1_s, factor],
            filled: is_valid,
            ..Point::default()
        });
        let theory = dynamic_increase_factor(rate_1_s, 0.0);
        let striker_m_s = run.summary["test"]["rate_m_s"].as_f64();
        table.row(&[
            format!("{} m/s", significant(striker_m_s.unwrap_or(f64::NAN), 3)),
            ["off", "on"][strengthens].to_owned(),
            format!("{} /s", significant(rate_1_s, 3)),
            format!("{} MPa", significant(1e-6 * run.figure("strength"), 3)),
            significant(factor, 3),
            significant(theory, 3),
            format!("{:+.0} %", 100.0 * apart),
            if is_valid { "yes" } else { "no: not valid" }.to_owned(),
        ]);
    }
    let all = marks.iter().flat_map(|marks| &marks.points);
    let rates = all.map(|point| point.at[0]).filter(|rate| rate.is_finite());
    let [lowest, highest] = rates.fold([HIGHEST_1_S, 0.0], |[low, high], rate| {
        [rate.min(low), rate.max(high)]
    });
    let theory = (0..=50)
        .map(|i| lowest * (highest / lowest).powf(f64::from(i) / 50.0))
        .map(|rate| [rate, dynamic_increase_factor(rate, 0.0)]);
    let plot = Plot {
        title: "strength of a disc over its strain rate".to_owned(),
        x: Axis {
            log: true,
            ..Axis::of("strain rate (1/s)")
        },
        y: Axis::of("strength over static strength"),
        lines: vec![line("eq. 20", theory.collect(), true)],
        marks: marks.into(),
        filled: Some(["in equilibrium", "not in equilibrium: not valid"].map(str::to_owned)),
        ..Plot::default()
    };
    std::fs::write(root().join("doc/strain-rate.svg"), plot.svg().file())?;
    table.write(PAGE, "dynamic_tables rates")
}

/// t10 and sizes over the specific energy, that of the impact and what the disc absorbed of it.
fn heights(runs: &[Run]) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "impact",
        "impact energy",
        "absorbed energy",
        "largest fragment",
        "d50",
        "t10",
    ]);
    let (mut impact, mut absorbed) = (Vec::new(), Vec::new());
    let percent = |share: f64| format!("{} %", significant(100.0 * share, 3));
    for run in runs {
        let impact_kwh_t = run.figure("specific energy per tonne");
        let absorbed_kwh_t = run.figure("specific absorbed energy") / 3600.0;
        let t10 = run.figure("t10");
        impact.push([impact_kwh_t, t10]);
        absorbed.push([absorbed_kwh_t, t10]);
        let speed_m_s = run.summary["test"]["rate_m_s"].as_f64();
        table.row(&[
            format!("{} m/s", significant(speed_m_s.unwrap_or(f64::NAN), 3)),
            format!("{} kWh/t", significant(impact_kwh_t, 3)),
            format!("{} kWh/t", significant(absorbed_kwh_t, 3)),
            percent(run.figure("largest fragment")),
            format!("{} mm", significant(1e3 * run.figure("d50"), 3)),
            percent(t10),
        ]);
    }
    table.write(PAGE, "dynamic_tables heights")?;

    let mut table = Table::new(&["E", "A", "b", "A b", "t10 off by at most"]);
    let (mut lines, mut marks) = (Vec::new(), Vec::new());
    for (name, points) in [("impact energy", impact), ("absorbed energy", absorbed)] {
        let law = Breakage::fitted(&points);
        let off = |[e, t10]: &[f64; 2]| (law.t10(*e) - t10).abs();
        table.row(&[
            name.to_owned(),
            percent(law.largest),
            format!("{} t/kWh", significant(law.rate_t_kwh, 3)),
            format!(
                "{} % t/kWh",
                significant(100.0 * law.largest * law.rate_t_kwh, 3)
            ),
            format!(
                "{} points",
                significant(100.0 * points.iter().map(off).fold(0.0, f64::max), 3)
            ),
        ]);
        let of = |f: fn(f64, f64) -> f64| points.iter().map(|[e, _]| *e).reduce(f);
        let [first, last] = [of(f64::min), of(f64::max)].map(|e| e.unwrap_or(f64::NAN));
        let along = (0..=100).map(|i| first * (last / first).powf(0.01 * f64::from(i)));
        lines.push(line(
            &format!("A (1 - exp(-b E)), {name}"),
            along.map(|e| [e, 100.0 * law.t10(e)]).collect(),
            true,
        ));
        let at = |[e, t10]: &[f64; 2]| Point {
            at: [*e, 100.0 * t10],
            filled: true,
            ..Point::default()
        };
        marks.push(Marks {
            name: name.to_owned(),
            points: points.iter().map(at).collect(),
            ..Marks::default()
        });
    }
    let plot = Plot {
        title: "fines of a disc under a drop weight".to_owned(),
        x: Axis {
            log: true,
            ..Axis::of("energy over the mass of the disc (kWh/t)")
        },
        y: Axis::of("t10 (%)"),
        lines,
        marks,
        ..Plot::default()
    };
    std::fs::write(root().join("doc/t10.svg"), plot.svg().file())?;
    table.write(PAGE, "dynamic_tables heights law")
}

/// The law t10 = A (1 - exp(-b E)) of Narayanan and Whiten 1988.
struct Breakage {
    /// A.
    largest: f64,
    /// b, t/kWh.
    rate_t_kwh: f64,
}

impl Breakage {
    fn t10(&self, energy_kwh_t: f64) -> f64 {
        self.largest * (1.0 - (-self.rate_t_kwh * energy_kwh_t).exp())
    }

    /// The law nearest to these energies, kWh/t, and t10, by least squares: for each of a thousand
    /// values of b over four decades the best A, which is at most 1.
    fn fitted(points: &[[f64; 2]]) -> Self {
        let of_rate = |rate_t_kwh: f64| {
            let shape = |e: f64| 1.0 - (-rate_t_kwh * e).exp();
            let sum = |of: fn(f64, f64) -> f64| -> f64 {
                points.iter().map(|[e, t10]| of(shape(*e), *t10)).sum()
            };
            let largest = (sum(|s, t10| s * t10) / sum(|s, _| s * s)).min(1.0);
            Self {
                largest,
                rate_t_kwh,
            }
        };
        let misfit = |law: &Self| -> f64 {
            let off = points.iter().map(|[e, t10]| law.t10(*e) - t10);
            off.map(|off| off * off).sum()
        };
        let rates = (1..1000).map(|i| 10_f64.powf(4.0 * f64::from(i) / 1000.0));
        let laws = rates.map(of_rate);
        laws.fold(of_rate(1.0), |best, law| {
            if misfit(&law) < misfit(&best) {
                law
            } else {
                best
            }
        })
    }
}
