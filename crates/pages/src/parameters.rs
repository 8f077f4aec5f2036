//! doc/parameters.md: which parameters of a breaking cake matter.

use dem_io::units::significant;
use dem_scene::study::read_study;
use serde_json::Value;

use crate::bench::{Bench, Failed, number, read, root};
use crate::table::{Table, write};

/// A study, and its measures with their columns on the page.
struct Ranked {
    study: &'static str,
    measures: &'static [&'static str],
    head: &'static str,
}

const STUDIES: [Ranked; 2] = [
    Ranked {
        study: "parameters-drop",
        measures: &["d50", "broken", "rebound", "push", "time"],
        head: "parameter and its range | d50 | broken bonds | rebound velocity | impact force | processor time",
    },
    Ranked {
        study: "parameters-compression",
        measures: &["strength", "stiffness", "time"],
        head: "parameter and its range | strength | stiffness | processor time",
    },
];
/// Plots of the page: file in the folder of the studies, and that on the page.
const PLOTS: [[&str; 2]; 4] = [
    ["parameters-drop/rebound.svg", "doc/parameters-rebound.svg"],
    [
        "parameters-drop/rebound.sigma.svg",
        "doc/parameters-sigma.svg",
    ],
    ["parameters-drop/time.svg", "doc/parameters-time.svg"],
    [
        "parameters-compression/strength.svg",
        "doc/parameters-strength.svg",
    ],
];

pub(crate) fn tables() -> Result<Vec<Table>, Failed> {
    STUDIES.iter().map(table).collect()
}

/// The table of a study, with its parameters.
fn table(of: &Ranked) -> Result<Table, Failed> {
    let study = read_study(&root().join(format!("data/studies/{}.toml", of.study)))?;
    let ranges = study.design.iter().flat_map(|design| &design.ranges);
    let names = study.axes.iter().zip(ranges).map(|(axis, range)| {
        let [low, high] = range.ends.map(|end| significant(end, 4));
        let text = format!("`{}`, {low} to {high} {}", axis.name, range.unit);
        text.trim_end().to_owned()
    });
    let names: Vec<String> = names.collect();
    Ok(Table::new(
        "doc/parameters.md",
        "parameters",
        of.head,
        names,
    ))
}

/// mu* of each parameter over the mean of each measure, and its interval.
pub(crate) fn parameters(bench: &Bench) -> Result<(), Failed> {
    let mut tables = tables()?;
    for (of, table) in STUDIES.iter().zip(&mut tables) {
        bench.study(of.study)?;
        let results = read(&bench.folder.join(of.study).join("sweep.json"));
        let results = results.ok_or("the study left no results")?;
        for parameter in 0..table.rows.len() {
            let cell = |measure: &&str| cell(&results, measure, parameter);
            table.row(of.measures.iter().map(cell));
        }
    }
    for [from, to] in PLOTS {
        std::fs::copy(bench.folder.join(from), root().join(to))?;
    }
    write(&tables)
}

/// `27 % (22 to 31)`; in brackets as a whole if chance may give as much.
fn cell(results: &Value, measure: &str, parameter: usize) -> String {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let is_of = |one: &Value, key: &str, at: usize| one[key].as_u64() == Some(at as u64);
    let at = list(&results["measures"])
        .iter()
        .position(|one| one["name"] == measure);
    let rankings = list(&results["design"]["morris"]);
    let ranking = rankings
        .iter()
        .find(|one| at.is_some_and(|at| is_of(one, "measure", at)));
    let parameters = ranking.map_or(Vec::new(), |one| list(&one["parameters"]));
    let of = parameters
        .iter()
        .find(|one| is_of(one, "parameter", parameter));
    let (Some(ranking), Some(of)) = (ranking, of.filter(|of| !of["statistics"].is_null())) else {
        return String::new();
    };
    let percent = |value: &Value| significant(100.0 * number(value) / number(&ranking["mean"]), 2);
    let statistics = &of["statistics"];
    let mu_star = percent(&statistics["mu_star"]);
    if of["is_above_chance"].as_bool() == Some(false) {
        return format!("({mu_star} %)");
    }
    let [low, high] = [0, 1].map(|end| percent(&statistics["interval"][end]));
    format!("{mu_star} % ({low} to {high})")
}
