//! Output of a test: its curve, as a table and as a plot, and the picture of the crack.

use std::fmt::Write;

use dem_io::Result;
use dem_laboratory::Specimen;
use dem_laboratory::figure::Figure;
use dem_laboratory::test_result::TestResult;
use dem_plots::{Line, Plot};
use dem_results::ResultsFolder;
use dem_results::folder::names;
use dem_scene::{Bars, Test};

use super::crack::{CrackPicture, crack_map};
use super::curve::{peak, play_m, rows_of, slope};
use super::disc_stress::{self, slabs};
use super::dynamic::{BarSignal, GaugeSignal, bar_signals, gauge_signals, stress_strain};
use super::evaluate::{FAILURE_FORCE, measured_curve};
use super::record::{Record, Row};

/// Content of the files of a test.
#[derive(Debug, Clone, Copy)]
pub struct TestFiles<'a> {
    /// The scene's file.
    pub scene: &'a str,
    /// The test.
    pub test: &'a Test,
    /// Record of the test.
    pub record: &'a Record,
    /// Result of the test.
    pub result: &'a TestResult,
    /// The crack.
    pub picture: CrackPicture<'a>,
}

/// Writes `plots/force-displacement.svg`, `plots/crack.svg` and `force-displacement.csv`; of a test
/// with bars also `bar-signals.csv` and plots of the pulses, forces and stress; of a weight the
/// force over time, of a disc between plates the stress over its loaded diameter.
pub(crate) fn write_test(folder: &ResultsFolder, files: &TestFiles<'_>) -> Result<()> {
    let rows = rows_of(files.record, files.result.lowest_frequency_hz);
    let measured = measured_curve(files.test, &files.picture.setup.specimen);
    let curve = curve(&rows, files.result, &measured).svg();
    let crack = crack_map(&files.picture).svg();
    folder.write_plot("force-displacement", &curve.file())?;
    folder.write_plot("crack", &crack.file())?;
    let mut play_m = play_m(&rows);
    if files.test.kind.is_dynamic() {
        play_m = 0.0;
        folder.write_plot(
            "force-time",
            &force_over_time(&rows, files.result).svg().file(),
        )?;
    }
    if let Some(bars) = &files.test.bars {
        let plots = [
            ("bar-signals", bar_plot(files.record, bars)),
            (
                "stress-strain",
                stress_plot(&rows, &files.picture.setup.specimen),
            ),
        ];
        for (name, plot) in plots {
            folder.write_plot(name, &plot.svg().file())?;
        }
        folder.write(names::BAR_SIGNALS, &signals_csv(files.record, bars))?;
        if let Some(gauges) = bars.gauges {
            let signals = gauge_signals(files.record, bars, gauges);
            folder.write_plot("gauge-signals", &gauge_plot(&signals).svg().file())?;
            folder.write(names::GAUGE_SIGNALS, &gauges_csv(&signals))?;
        }
    }
    let slabs = slabs(files.picture.setup, &files.record.disc);
    if !slabs.is_empty() {
        let plot = disc_stress::plot(&slabs, files.record.disc.load_n);
        folder.write_plot("disc-stress", &plot.svg().file())?;
        folder.write(names::DISC_STRESS, &disc_stress::table(&slabs))?;
    }
    folder.write(names::TEST_CURVE, &curve_csv(files.record, play_m))
}

/// The first line of `bar-signals.csv`.
const SIGNALS: &str = "time_s,incident_strain,reflected_strain,transmitted_strain,incident_force_n,transmission_force_n,incident_bar_velocity_m_s,transmission_bar_velocity_m_s";

fn signals_csv(record: &Record, bars: &Bars) -> String {
    let signals = bar_signals(record, bars);
    let rows = signals.iter().zip(&record.rows).map(|(signal, row)| {
        let [moving_m_s, resting_m_s, _] = row.speeds_m_s;
        [
            signal.time_s,
            signal.incident,
            signal.reflected,
            signal.transmitted,
            row.force_n,
            row.reaction_n,
            moving_m_s,
            resting_m_s,
        ]
    });
    csv(SIGNALS, rows)
}

/// The first line of `gauge-signals.csv`.
const GAUGES: &str = "time_s,incident_bar_strain,transmission_bar_strain";

fn gauges_csv(signals: &[GaugeSignal]) -> String {
    let row = |signal: &GaugeSignal| [signal.time_s, signal.incident_bar, signal.transmission_bar];
    csv(GAUGES, signals.iter().map(row))
}

/// A table of numbers with this first line.
fn csv<const N: usize>(head: &str, rows: impl Iterator<Item = [f64; N]>) -> String {
    let mut out = format!("{head}\n");
    for row in rows {
        out += &row.map(|number| format!("{number:e}")).join(",");
        out.push('\n');
    }
    out
}

/// What the strain gauges on both bars record.
fn gauge_plot(signals: &[GaugeSignal]) -> Plot {
    let points = |of: &dyn Fn(&GaugeSignal) -> f64| -> Vec<[f64; 2]> {
        signals.iter().map(|one| [one.time_s, of(one)]).collect()
    };
    Plot::of(
        "strain at the gauges",
        "time (s)",
        "strain",
        vec![
            Line::new("incident bar", points(&|one| one.incident_bar)),
            Line::new("transmission bar", points(&|one| one.transmission_bar)),
        ],
    )
}

/// The three pulses over time, and the sum of two of them, which is the third in equilibrium.
fn bar_plot(record: &Record, bars: &Bars) -> Plot {
    let signals = bar_signals(record, bars);
    let points = |of: &dyn Fn(&BarSignal) -> f64| -> Vec<[f64; 2]> {
        signals.iter().map(|one| [one.time_s, of(one)]).collect()
    };
    Plot::of(
        "pulses at the ends of the bars",
        "time (s)",
        "strain",
        vec![
            Line::new("incident", points(&|one| one.incident)),
            Line::new("reflected", points(&|one| one.reflected)),
            Line::new("transmitted", points(&|one| one.transmitted)),
            Line::dashed(
                "incident + reflected",
                points(&|one| one.incident + one.reflected),
            ),
        ],
    )
}

/// Stress over strain of a specimen between two bars.
fn stress_plot(rows: &[Row], specimen: &Specimen) -> Plot {
    let (length_m, strain) = match specimen {
        Specimen::Disc { diameter_m, .. } => {
            (*diameter_m, "approach of the bars over the diameter")
        }
        Specimen::Bar { length_m, .. } => (*length_m, "strain"),
        Specimen::Beam(_) => (1.0, "strain"),
    };
    let curve = stress_strain(rows, specimen, length_m);
    Plot::of(
        "stress over strain",
        strain,
        "stress (Pa)",
        vec![Line::new("mean of both ends", curve)],
    )
}

/// The force on both sides of the body over time.
fn force_over_time(rows: &[Row], result: &TestResult) -> Plot {
    let points = |of: &dyn Fn(&Row) -> f64| -> Vec<[f64; 2]> {
        rows.iter().map(|row| [row.time_s, of(row)]).collect()
    };
    Plot::of(
        result.kind.name().replace('-', " "),
        "time (s)",
        "force (N)",
        vec![
            Line::new("on the loaded side", points(&|row| row.force_n)),
            Line::new("on the other side", points(&|row| row.reaction_n)),
        ],
    )
}

/// The first line of `force-displacement.csv`.
const COLUMNS: &str =
    "time_s,travel_m,displacement_m,load_n,force_n,reaction_n,deflection_m,broken_bonds";

/// The record, a row for each interval; the displacement is the travel minus `play_m`. Every number
/// is written so that it reads back as the same bits.
fn curve_csv(record: &Record, play_m: f64) -> String {
    let mut out = format!("{COLUMNS}\n");
    for row in &record.rows {
        let broken = record
            .broken
            .partition_point(|broken| broken.time_s <= row.time_s);
        let numbers = [
            row.time_s,
            row.travel_m,
            row.travel_m - play_m,
            row.load_n(),
            row.force_n,
            row.reaction_n,
            row.deflection_m,
        ];
        out += &numbers.map(|number| format!("{number:e},")).concat();
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{broken}");
    }
    out
}

/// Load over displacement of the rows used in the evaluation ([`rows_of`]), with the line of
/// the target stiffness if there is one, and the measured curve ([`measured_curve`]) unless it is
/// empty.
pub fn curve(rows: &[Row], result: &TestResult, measured: &[[f64; 2]]) -> Plot {
    let play_m = if result.is_dynamic() {
        0.0
    } else {
        play_m(rows)
    };
    let points = |way: &dyn Fn(&Row) -> f64| -> Vec<[f64; 2]> {
        rows.iter().map(|row| [way(row), row.load_n()]).collect()
    };
    let mut lines = vec![Line::new(
        "crosshead travel",
        points(&|row| row.travel_m - play_m),
    )];
    let of_body = slope(rows, None, |row| row.deflection_m);
    if let (Some(of_body), true) = (of_body, named(result, "specimen stiffness").is_some()) {
        let sign = of_body.stiffness_n_m.signum();
        let way = |row: &Row| sign * (row.deflection_m - of_body.start_m);
        // After it has broken the body has no deflection.
        let until = peak(rows).map_or(f64::INFINITY, |row| row.time_s);
        let whole = rows.iter().filter(|row| row.time_s <= until);
        lines.push(Line::new(
            "deflection of the specimen",
            whole.map(|row| [way(row), row.load_n()]).collect(),
        ));
    }
    let target = ["specimen stiffness", "stiffness"].iter().find_map(|name| {
        let figure = named(result, name)?;
        Some((figure.theory?, figure.theory_is?))
    });
    if let (Some((stiffness, source)), Some(peak)) = (target, peak(rows)) {
        lines.push(Line::dashed(
            format!("{}: stiffness", source.name()),
            vec![[0.0, 0.0], [peak.load_n() / stiffness, peak.load_n()]],
        ));
    }
    if !measured.is_empty() {
        lines.push(Line::dashed("measured", measured.to_vec()));
    }
    let failure = named(result, FAILURE_FORCE).and_then(|figure| figure.theory);
    Plot {
        reference: failure.map(|force| (force, "target: failure force".to_owned())),
        ..Plot::of(
            result.kind.name().replace('-', " "),
            "displacement (m)",
            "load (N)",
            lines,
        )
    }
}

fn named<'a>(result: &'a TestResult, name: &str) -> Option<&'a Figure> {
    result.figures.iter().find(|figure| figure.name == name)
}
