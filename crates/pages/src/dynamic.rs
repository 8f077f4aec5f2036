//! doc/dynamic-tests.md: t10 and sizes of a disc under a drop weight.

use dem_io::units::significant;
use dem_plots::{Axis, Line, Marks, Plot, Point};

use crate::bench::{Bench, Failed, Run};
use crate::cells::ends;
use crate::plots::draw;
use crate::table::{Table, write};

const ENERGIES: [&str; 2] = ["impact energy", "absorbed energy"];

pub(crate) fn tables() -> [Table; 2] {
    const PAGE: &str = "doc/dynamic-tests.md";
    const WORDS: &str = "dynamic heights";
    let heights = "impact | impact energy | absorbed energy | largest fragment | d50 | t10";
    let law = "E | A | b | A b | t10 off by at most";
    [
        Table::new(PAGE, WORDS, heights, [""; 0]),
        Table::new(PAGE, WORDS, law, ENERGIES),
    ]
}

fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 3))
}

/// t10 and sizes over the specific energy, that of the impact and what the disc absorbed of it.
pub(crate) fn heights(bench: &Bench) -> Result<(), Failed> {
    let [mut table, mut laws] = tables();
    let mut points = [Vec::new(), Vec::new()];
    for run in bench.study("drop-weight-heights")? {
        for (points, point) in points.iter_mut().zip(row(&run, &mut table)?) {
            points.push(point);
        }
    }
    let (mut lines, mut marks) = (Vec::new(), Vec::new());
    for (name, points) in ENERGIES.into_iter().zip(points) {
        let law = Breakage::fitted(&points);
        let off = points.iter().map(|[e, t10]| (law.t10(*e) - t10).abs());
        laws.row([
            percent(law.largest),
            format!("{} t/kWh", significant(law.rate_t_kwh, 3)),
            format!("{} t/kWh", percent(law.largest * law.rate_t_kwh)),
            format!("{} points", significant(100.0 * off.fold(0.0, f64::max), 3)),
        ]);
        let energies: Vec<f64> = points.iter().map(|[e, _]| *e).collect();
        let [first, last] = ends(&energies);
        let along = (0..=100).map(|i| first * (last / first).powf(0.01 * f64::from(i)));
        let along = along.map(|e| [e, 100.0 * law.t10(e)]);
        lines.push(Line::dashed(
            format!("A (1 - exp(-b E)), {name}"),
            along.collect(),
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
    let title = "fines of a disc under a drop weight";
    let plot = Plot {
        x: Axis::log("energy over the mass of the disc (kWh/t)"),
        marks,
        ..Plot::of(title, "", "t10 (%)", lines)
    };
    draw("doc/t10.svg", &plot)?;
    write(&[table, laws])
}

/// Adds the row of a run. Returns the energy of the impact and t10, and that absorbed and t10.
fn row(run: &Run, table: &mut Table) -> Result<[[f64; 2]; 2], Failed> {
    let test = run.test()?;
    let figure = |name: &str| test.figure(name).unwrap_or(f64::NAN);
    let impact_kwh_t = figure("specific energy per tonne");
    let absorbed_kwh_t = figure("specific absorbed energy") / 3600.0;
    let t10 = figure("t10");
    table.row([
        format!("{} m/s", significant(test.rate_m_s, 3)),
        format!("{} kWh/t", significant(impact_kwh_t, 3)),
        format!("{} kWh/t", significant(absorbed_kwh_t, 3)),
        percent(figure("largest fragment")),
        format!("{} mm", significant(1e3 * figure("d50"), 3)),
        percent(t10),
    ]);
    Ok([[impact_kwh_t, t10], [absorbed_kwh_t, t10]])
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
