//! doc/parameters.md: which parameters of a breaking disc matter.

use dem_io::units::significant;
use dem_scene::study::read_study;
use serde_json::Value;

use crate::bench::{Bench, Failed, number, read, root};
use crate::table::{Table, write};

const STUDY: &str = "parameters";
/// Measures of the study, in the order of the columns.
const MEASURES: [&str; 4] = ["strength", "d50", "rebound", "time"];
/// Measures whose plots stand on the page: file in the folder of the study, and on the page.
const PLOTS: [[&str; 2]; 4] = [
    ["strength.svg", "doc/parameters-strength.svg"],
    ["d50.svg", "doc/parameters-d50.svg"],
    ["time.svg", "doc/parameters-time.svg"],
    ["rebound.sigma.svg", "doc/parameters-rebound-sigma.svg"],
];

pub(crate) fn table() -> Result<Table, Failed> {
    let study = read_study(&root().join(format!("data/studies/{STUDY}.toml")))?;
    let ranges = study.design.iter().flat_map(|design| &design.ranges);
    let names = study.axes.iter().zip(ranges).map(|(axis, range)| {
        let [low, high] = range.ends.map(|end| significant(end, 4));
        let text = format!("`{}`, {low} to {high} {}", axis.name, range.unit);
        text.trim_end().to_owned()
    });
    let head = "parameter and its range | largest force | d50 | rebound velocity | processor time";
    Ok(Table::new(
        "doc/parameters.md",
        "parameters",
        head,
        names.collect::<Vec<_>>(),
    ))
}

/// mu* of each parameter over the mean of each measure, and its interval.
pub(crate) fn parameters(bench: &Bench) -> Result<(), Failed> {
    bench.study(STUDY)?;
    let folder = bench.folder.join(STUDY);
    let results = read(&folder.join("sweep.json")).ok_or("the study left no results")?;
    let mut table = table()?;
    for parameter in 0..table.rows.len() {
        table.row(MEASURES.map(|measure| cell(&results, measure, parameter)));
    }
    for [from, to] in PLOTS {
        std::fs::copy(folder.join(from), root().join(to))?;
    }
    write(&[table])
}

/// `27 % (22 to 31)`; in brackets with the word if chance may give as much.
fn cell(results: &Value, measure: &str, parameter: usize) -> String {
    let measures = results["measures"].as_array().into_iter().flatten();
    let at = measures.into_iter().position(|one| one["name"] == measure);
    let mut rankings = results["design"]["morris"].as_array().into_iter().flatten();
    let Some(ranking) = rankings.find(|one| one["measure"].as_u64() == at.map(|at| at as u64))
    else {
        return String::new();
    };
    let mut parameters = ranking["parameters"].as_array().into_iter().flatten();
    let of = parameters.find(|one| one["parameter"].as_u64() == Some(parameter as u64));
    let Some(of) = of.filter(|of| !of["statistics"].is_null()) else {
        return String::new();
    };
    let percent = |value: &Value| significant(100.0 * number(value) / number(&ranking["mean"]), 2);
    let statistics = &of["statistics"];
    let [low, high] = [0, 1].map(|end| percent(&statistics["interval"][end]));
    let text = format!("{} % ({low} to {high})", percent(&statistics["mu_star"]));
    match of["is_above_chance"].as_bool() {
        Some(false) => format!("within chance: {text}"),
        _ => text,
    }
}
