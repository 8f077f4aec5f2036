//! Studies and scenes that examples run, and tables of them.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::programs::{Failed, Programs, output, root};

/// A run of a study.
pub(crate) struct Run {
    /// Its folder.
    pub(crate) folder: PathBuf,
    /// The words for its value on each axis.
    pub(crate) settings: Vec<String>,
    /// Processor time, s, if the study measures it, or time by the clock.
    pub(crate) time_s: f64,
    /// Its `summary.json`.
    pub(crate) summary: Value,
}

/// Runs a study of `data/studies`, or keeps its complete runs, and returns all in its order.
pub(crate) fn runs(study: &str, folder: &Path, resume: bool) -> Result<Vec<Run>, Failed> {
    let mut command = Command::new(Programs::build()?.dem_run);
    command.args(["sweep", &format!("data/studies/{study}.toml")]);
    command.args(["--json", "--quiet", "--output"]).arg(folder);
    command.arg(if resume { "--resume" } else { "--force" });
    let table: Value = serde_json::from_slice(&output(&mut command)?)?;
    let rows = table["runs"].as_array().ok_or("the study has no runs")?;
    rows.iter().map(|row| run_of(row, folder)).collect()
}

fn run_of(row: &Value, folder: &Path) -> Result<Run, Failed> {
    if let Some(why) = row["failed"].as_str() {
        return Err(why.into());
    }
    let number = row["number"].as_u64().unwrap_or_default();
    let folder = folder.join(format!("runs/{number:04}-1"));
    let summary = summary_in(&folder)?;
    let words = row["settings"].as_array().into_iter().flatten();
    Ok(Run {
        folder,
        settings: words
            .map(|word| word.as_str().unwrap_or_default().to_owned())
            .collect(),
        time_s: row["time_s"].as_f64().unwrap_or(f64::NAN),
        summary,
    })
}

/// The `summary.json` of a run.
fn summary_in(folder: &Path) -> Result<Value, Failed> {
    let bytes = std::fs::read(folder.join("summary.json"))?;
    Ok(serde_json::from_slice(&bytes)?)
}

/// Runs a scene of `data/scenes` with these options and hardly any pictures. Returns its summary.
pub(crate) fn run_scene(
    dem_run: &Path,
    scene: &str,
    options: &[String],
    folder: &Path,
) -> Result<Value, Failed> {
    let scene = PathBuf::from(format!("data/scenes/{scene}.toml"));
    let few_pictures = ["--set", "output.pictures=\"10 s\""].map(str::to_owned);
    run_file(dem_run, &scene, &[&few_pictures, options].concat(), folder)
}

/// Runs a scene with these options. Returns its summary.
pub(crate) fn run_file(
    dem_run: &Path,
    scene: &Path,
    options: &[String],
    folder: &Path,
) -> Result<Value, Failed> {
    let mut command = Command::new(dem_run);
    command.arg(scene).args(["--quiet", "--force"]);
    command.args(options).arg("--output").arg(folder);
    output(&mut command)?;
    summary_in(folder)
}

/// As [`run_scene`]; if it `keeps`, a run that has come to its end in this folder is not run again.
pub(crate) fn run_scene_or_keep(
    dem_run: &Path,
    scene: &str,
    options: &[String],
    folder: &Path,
    keeps: bool,
) -> Result<Value, Failed> {
    let before = if keeps { summary_in(folder).ok() } else { None };
    let ends = ["end time", "rest", "measure"];
    match before.filter(|summary| ends.iter().any(|end| summary["ended_by"] == *end)) {
        Some(summary) => Ok(summary),
        None => run_scene(dem_run, scene, options, folder),
    }
}

/// The value of a measure in a summary.
pub(crate) fn measured(summary: &Value, measure: &str) -> Result<f64, Failed> {
    let value = summary["measures"][measure]["value"].as_f64();
    Ok(value.ok_or("no value of a measure in summary.json")?)
}

/// Mean of some values with their unit, and the smallest and the largest if there are several.
pub(crate) fn mean_and_range(values: &[f64], unit: &str, decimals: usize) -> String {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let text = format!("{mean:.decimals$} {unit}");
    let text = text.trim_end();
    if values.len() < 2 {
        return text.to_owned();
    }
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!("{text} ({smallest:.decimals$} to {largest:.decimals$})")
}

impl Run {
    /// A figure of its test; not a number if it has none.
    pub(crate) fn figure(&self, name: &str) -> f64 {
        let figures = self.summary["test"]["results"].as_array();
        let mut figures = figures.into_iter().flatten();
        let found = figures.find(|figure| figure["name"] == name);
        let value = found.and_then(|figure| figure["value"].as_f64());
        value.unwrap_or(f64::NAN)
    }

    /// An entry of its energy balance, J.
    pub(crate) fn balance_j(&self, name: &str) -> f64 {
        self.summary["balance"][name].as_f64().unwrap_or(f64::NAN)
    }

    /// Columns of one of its tables, row by row.
    pub(crate) fn columns(&self, file: &str, names: [&str; 2]) -> Result<Vec<[f64; 2]>, Failed> {
        columns(&self.folder.join(file), names)
    }
}

/// Columns of a table of results, row by row.
pub(crate) fn columns<const N: usize>(
    file: &Path,
    names: [&str; N],
) -> Result<Vec<[f64; N]>, Failed> {
    let text = std::fs::read_to_string(file)?;
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let mut places = [0; N];
    for (place, name) in places.iter_mut().zip(names) {
        let at = head.iter().position(|other| *other == name);
        *place = at.ok_or_else(|| format!("{} has no {name}", file.display()))?;
    }
    let mut rows = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let mut row = [0.0; N];
        for (number, place) in row.iter_mut().zip(places) {
            *number = cells[place].parse()?;
        }
        rows.push(row);
    }
    Ok(rows)
}

/// A table, row by row.
#[derive(Default)]
pub(crate) struct Table(String);

impl Table {
    /// An empty one with this head.
    pub(crate) fn new(cells: &[&str]) -> Self {
        let mut table = Self::default();
        table.row(
            &cells
                .iter()
                .map(|&cell| cell.to_owned())
                .collect::<Vec<_>>(),
        );
        table.0 += &format!("|{}\n", "---|".repeat(cells.len()));
        table
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, cells: &[String]) {
        self.0 += &format!("| {} |\n", cells.join(" | "));
    }

    /// Prints it, and writes it into a page, between the line `<!-- table: NAME -->` and the end of
    /// that table.
    pub(crate) fn write(&self, page: &str, name: &str) -> Result<(), Failed> {
        print!("{}", self.0);
        let page = root().join(page);
        let text = std::fs::read_to_string(&page)?;
        let begin = format!("<!-- table: {name} -->\n");
        let (before, after) = text
            .split_once(&begin)
            .ok_or("the page has no such table")?;
        let end = "<!-- end of table -->";
        let (_, after) = after.split_once(end).ok_or("the table does not end")?;
        let rows = &self.0;
        std::fs::write(&page, format!("{before}{begin}{rows}{end}{after}"))?;
        Ok(())
    }
}
