//! Output of a test: its curve, as a table and as a plot, and the picture of the crack.

use std::fmt::Write;

use dem_io::Result;
use dem_plots::{Axis, Line, Plot};
use dem_results::ResultsFolder;
use dem_scene::Test;

use super::crack::{CrackPicture, crack_map};
use super::evaluate::{
    FAILURE_FORCE, Figure, TestResult, measured_curve, peak, play_m, rows_of, slope,
};
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

/// Writes `plots/force-displacement.svg`, `plots/crack.svg` and `force-displacement.csv`.
///
/// # Errors
/// Those of the files.
pub(crate) fn write_test(folder: &ResultsFolder, files: &TestFiles<'_>) -> Result<()> {
    let rows = rows_of(files.record, files.result.lowest_frequency_hz);
    let measured = measured_curve(files.test, &files.picture.setup.specimen);
    let curve = curve(&rows, files.result, &measured).svg();
    let crack = crack_map(&files.picture).svg();
    folder.write_plot("force-displacement", &curve.file())?;
    folder.write_plot("crack", &crack.file())?;
    folder.write_test_curve(&curve_csv(files.record, play_m(&rows)))
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

/// Load over displacement of the rows used in the evaluation ([`rows_of`]), with the theory's line
/// if the scene gives a modulus, and the measured curve ([`measured_curve`]) unless it is empty.
pub fn curve(rows: &[Row], result: &TestResult, measured: &[[f64; 2]]) -> Plot {
    let play_m = play_m(rows);
    let points = |way: &dyn Fn(&Row) -> f64| -> Vec<[f64; 2]> {
        rows.iter().map(|row| [way(row), row.load_n()]).collect()
    };
    let mut lines = vec![Line {
        name: "crosshead travel".to_owned(),
        points: points(&|row| row.travel_m - play_m),
        dashed: false,
    }];
    let of_body = slope(rows, |row| row.deflection_m);
    if let (Some(of_body), true) = (of_body, named(result, "specimen stiffness").is_some()) {
        let sign = of_body.stiffness_n_m.signum();
        let way = |row: &Row| sign * (row.deflection_m - of_body.start_m);
        // After it has broken the body has no deflection.
        let until = peak(rows).map_or(f64::INFINITY, |row| row.time_s);
        let whole = rows.iter().filter(|row| row.time_s <= until);
        lines.push(Line {
            name: "deflection of the specimen".to_owned(),
            points: whole.map(|row| [way(row), row.load_n()]).collect(),
            dashed: false,
        });
    }
    let theory = ["specimen stiffness", "stiffness"]
        .iter()
        .find_map(|name| named(result, name)?.theory);
    if let (Some(stiffness), Some(peak)) = (theory, peak(rows)) {
        lines.push(Line {
            name: "theory".to_owned(),
            points: vec![[0.0, 0.0], [peak.load_n() / stiffness, peak.load_n()]],
            dashed: true,
        });
    }
    if !measured.is_empty() {
        lines.push(Line {
            name: "measured".to_owned(),
            points: measured.to_vec(),
            dashed: true,
        });
    }
    let failure = named(result, FAILURE_FORCE).and_then(|figure| figure.theory);
    Plot {
        title: result.kind.replace('-', " "),
        x: Axis::of("displacement (m)"),
        y: Axis::of("load (N)"),
        lines,
        reference: failure.map(|force| (force, "failure force wanted".to_owned())),
        ..Plot::default()
    }
}

fn named<'a>(result: &'a TestResult, name: &str) -> Option<&'a Figure> {
    result.figures.iter().find(|figure| figure.name == name)
}

/// A fraction as a percentage with its sign.
pub fn percent(fraction: f64) -> String {
    format!("{:+.1} %", 100.0 * fraction)
}
