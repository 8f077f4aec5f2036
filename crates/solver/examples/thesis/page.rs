//! The page: a text with places for tables. They are made from the results that are there; what has
//! not been computed anew stays as it stands on the page.

use std::path::Path;

use serde_json::Value;

use super::bench::{Failed, finished, read, root};
use super::bending::{self, READINGS};
use super::drops::{self, FALLS};
use super::plots;
use super::rebound;
use super::samples::{self, PACKINGS, Sample, Table as Spheres};
use super::steps;
use super::strengthening::{self, WAYS};
use super::text::{self, Table, cells, mean, number, range, rounded, thousands};

pub(crate) const TEXT: &str = include_str!("thesis.md");

/// Writes the page and its plots to `tests/verification`.
pub(crate) fn write(results: &Path) -> Result<(), Failed> {
    let folder = root().join("tests/verification");
    let before = std::fs::read_to_string(folder.join("thesis.md"))?;
    let mut page = TEXT.to_owned();
    let mut words: Vec<&str> = Vec::new();
    for (name, table) in tables(results) {
        let word = table.word;
        let at = words.iter().filter(|other| **other == word).count();
        words.push(word);
        let table = table.kept(&text::rows(&before, word, at));
        page = page.replace(&format!("{{{name}}}"), &table.markdown());
    }
    std::fs::write(folder.join("thesis.md"), page)?;
    for (name, svg) in plots::all(results) {
        std::fs::write(folder.join(name), svg)?;
    }
    Ok(())
}

/// The tables with their places.
pub(crate) fn tables(results: &Path) -> [(&'static str, Table); 9] {
    [
        ("sample", sample(results)),
        ("steps", steps::table(results)),
        ("bending", bending(results)),
        ("readings", readings(results)),
        ("speed", speed(results)),
        ("drops", drops(results)),
        ("utilisation", utilisation(results)),
        ("strengthening", strengthening(results)),
        ("rebound", rebound(results)),
    ]
}

fn sample(results: &Path) -> Table {
    let mut rows = vec![cells([
        "Platzer 2022, 3.2.3",
        "",
        "77,487",
        "377,052",
        "4.87",
        "132 s; 780 min by filling",
    ])];
    for (name, samples) in samples::counted() {
        let reports: Vec<Value> = samples
            .iter()
            .filter_map(|sample| read(&results.join(format!("{}.json", sample.name()))))
            .collect();
        let all = |value: &dyn Fn(&Value) -> f64| reports.iter().map(value).collect::<Vec<_>>();
        let quality = |name: &'static str| all(&|report| number(&report["quality"][name]));
        let (spheres, bonds) = (quality("particles"), quality("bonds"));
        let each: Vec<f64> = bonds.iter().zip(&spheres).map(|(b, s)| b / s).collect();
        let seconds = all(&|report| {
            let parts = report["seconds"].as_object();
            parts.map_or(f64::NAN, |parts| parts.values().map(number).sum())
        });
        rows.push(vec![
            name.to_owned(),
            reports.len().to_string(),
            between(&spheres),
            between(&bonds),
            range(&each, 2),
            match range(&seconds, 1) {
                none if none.is_empty() => none,
                seconds => seconds + " s",
            },
        ]);
    }
    Table {
        word: "sample",
        head: &[
            "sample, 180 mm x 30 mm x 35 mm",
            "packings",
            "spheres",
            "bonds",
            "bonds per sphere",
            "time",
        ],
        names: 1,
        rows,
    }
}

/// Least to most, with commas between thousands.
fn between(values: &[f64]) -> String {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted[..] {
        [] => String::new(),
        [only] => thousands(only),
        [least, .., most] => format!("{} to {}", thousands(least), thousands(most)),
    }
}

/// The bending tests of a row that have been run.
fn bent(results: &Path, row: &bending::Row) -> Vec<Value> {
    (1..=row.packings)
        .filter_map(|seed| finished(&results.join(row.name(seed))))
        .collect()
}

fn figures(runs: &[Value], name: &str) -> Vec<f64> {
    let figure = |run: &Value| {
        let results = run["test"]["results"].as_array()?;
        results.iter().find(|figure| figure["name"] == name)?["value"].as_f64()
    };
    runs.iter().filter_map(figure).collect()
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}

/// Cells of a row of bending tests after its name.
fn bent_cells(runs: &[Value]) -> Vec<String> {
    let within = |run: &Value| run["test"]["crack"]["fraction_within"].as_f64();
    let first = |run: &Value| run["test"]["first_broken"]["force_n"].as_f64();
    let all =
        |value: &dyn Fn(&Value) -> Option<f64>| runs.iter().filter_map(value).collect::<Vec<f64>>();
    vec![
        runs.len().to_string(),
        mean(&scaled(&figures(runs, "stiffness"), 1e-3), 2),
        mean(&scaled(&figures(runs, "modulus without shear"), 1e-6), 2),
        mean(&figures(runs, "failure force"), 1),
        mean(
            &scaled(&figures(runs, "crosshead travel at failure"), 1e3),
            2,
        ),
        mean(&scaled(&figures(runs, "strength"), 1e-6), 3),
        mean(&all(&first), 1),
        range(&scaled(&all(&within), 100.0), 0),
        range(&all(&|run| run["processor_s"].as_f64()), 1),
    ]
}

const BENDING_HEAD: [&str; 11] = [
    "sample",
    "reading of eq. 13",
    "packings",
    "stiffness, N/mm",
    "E by eq. 18, MPa",
    "F_max, N",
    "w_max, mm",
    "strength by eq. 19, MPa",
    "first bond breaks at, N",
    "broken bonds between the pins, %",
    "processor time, s",
];

fn wanted() -> Vec<String> {
    cells([
        "Platzer 2022",
        "",
        "",
        "18.23",
        "12.05",
        "51.45",
        "2.82",
        "0.21",
        "",
        "",
        "",
    ])
}

fn named(sample: &Sample) -> String {
    let texture = if sample.bare {
        "bare front"
    } else {
        "densified"
    };
    format!(
        "table {}, {texture}, bond range {}",
        sample.table.number(),
        sample.bond_range
    )
}

/// The tests with eq. 13 at its word.
fn bending(results: &Path) -> Table {
    bending_table(results, |row| row.reading == READINGS[0])
}

/// The tests with the other readings.
fn readings(results: &Path) -> Table {
    bending_table(results, |row| row.reading != READINGS[0])
}

fn bending_table(results: &Path, is_shown: fn(&bending::Row) -> bool) -> Table {
    let mut rows = vec![wanted()];
    for row in bending::rows().into_iter().filter(is_shown) {
        let first = vec![named(&row.sample), format!("`{}`", row.reading)];
        rows.push([first, bent_cells(&bent(results, &row))].concat());
    }
    Table {
        word: "bending",
        head: &BENDING_HEAD,
        names: 2,
        rows,
    }
}

/// Processor time and steps of the bending test with table 1 over those with table 2, of the bare
/// front.
fn speed(results: &Path) -> Table {
    let mut rows = vec![cells(["Platzer 2022, 4.5.3.3", "36", ""])];
    for reading in READINGS {
        let of = |table: Spheres, name: &str| {
            let mut all = bending::rows();
            all.retain(|row| {
                row.sample.table == table
                    && row.sample.bare
                    && row.sample.bond_range == "1.0"
                    && row.reading == reading
            });
            let runs = all.iter().flat_map(|row| bent(results, row));
            let values: Vec<f64> = runs.map(|run| number(&run[name])).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let ratio = |name: &str| of(Spheres::One, name) / of(Spheres::Two, name);
        rows.push(vec![
            format!("`{reading}`"),
            rounded(ratio("processor_s"), 0),
            rounded(ratio("steps"), 1),
        ]);
    }
    Table {
        word: "bending",
        head: &["table 1 over table 2", "processor time", "steps"],
        names: 1,
        rows,
    }
}

/// The drops of a row that have been run.
fn fallen(results: &Path, row: &drops::Row, fall: &str) -> Vec<Value> {
    (1..=row.packings)
        .filter_map(|seed| read(&results.join(format!("{}.json", row.name(fall, seed)))))
        .collect()
}

fn drop_name(row: &drops::Row) -> Vec<String> {
    vec![
        row.sample.table.number().to_string(),
        format!("`{}`", row.reading),
        row.damping.to_owned(),
        if row.dif { "yes" } else { "no" }.to_owned(),
    ]
}

/// Broken bonds, mean, and fraction of the largest piece, least to most; packings.
fn drops(results: &Path) -> Table {
    let thesis = |with: &str, outcome: fn(&str) -> &str| {
        let mut row = cells(["Platzer 2022", "", "0.6", with]);
        row.extend(FALLS.iter().map(|fall| outcome(fall.name).to_owned()));
        row
    };
    // Without the factor it has falls at 15 degrees only: figs. 51 and 52.
    let without = |fall: &str| match fall.starts_with("15") {
        true => "broken",
        false => "not shown",
    };
    let mut rows = vec![thesis("yes", |_| "intact"), thesis("no", without)];
    for row in drops::rows() {
        let mut cells = drop_name(&row);
        for fall in FALLS {
            let runs = fallen(results, &row, fall.name);
            let all = |name: &str| {
                runs.iter()
                    .map(|run| number(&run[name]))
                    .collect::<Vec<_>>()
            };
            cells.push(match runs.len() {
                0 => String::new(),
                count => format!(
                    "{} broken, largest piece {} ({count})",
                    thousands(all("broken").iter().sum::<f64>() / count as f64),
                    range(&all("largest"), 3),
                ),
            });
        }
        rows.push(cells);
    }
    Table {
        word: "drops",
        head: &DROPS_HEAD,
        names: 4,
        rows,
    }
}

const DROPS_HEAD: [&str; 8] = [
    "table",
    "reading of eq. 13",
    "damping ratio",
    "DIF",
    "15 degrees, flat",
    "15 degrees, upright",
    "25 degrees, flat",
    "25 degrees, upright",
];

/// Largest utilisation of each bond during the drop, of the first packing, with the factor.
fn utilisation(results: &Path) -> Table {
    let mut rows = vec![cells([
        "Platzer 2022, figs. 55 and 56",
        "",
        "0.6",
        "25-flat",
        "",
        "",
        "at most 71",
        "mostly below 50",
    ])];
    for row in drops::rows().iter().filter(|row| row.dif) {
        for fall in FALLS {
            let run = fallen(results, row, fall.name).first().cloned();
            let run = run.unwrap_or_default();
            let percent = |name: &str, digits: usize| {
                rounded(100.0 * number(&run["utilisation"][name]), digits)
            };
            rows.push(vec![
                row.sample.table.number().to_string(),
                format!("`{}`", row.reading),
                row.damping.to_owned(),
                fall.name.to_owned(),
                percent("median", 0),
                percent("exceeded_by_1_in_100", 0),
                percent("exceeded_by_1_in_1000", 0),
                percent("fraction_above_half", 1),
            ]);
        }
    }
    Table {
        word: "drops",
        head: &[
            "table",
            "reading of eq. 13",
            "damping ratio",
            "fall",
            "median, %",
            "exceeded by 1 % of bonds, %",
            "by 0.1 %, %",
            "bonds above 50 %, %",
        ],
        names: 4,
        rows,
    }
}

/// Of samples whose bonds do not break: the number of bonds whose utilisation exceeds 1, the
/// largest of any bond, and the fraction of bonds above a half.
fn strengthening(results: &Path) -> Table {
    let mut rows = Vec::new();
    for row in strengthening::rows() {
        for reading in &READINGS[..2] {
            for (name, way) in WAYS {
                let mut cells = vec![
                    row.sample.table.number().to_string(),
                    row.damping.to_owned(),
                    format!("`{reading}`"),
                    way.to_owned(),
                ];
                for fall in FALLS {
                    cells.push(endured(results, &row, fall.name, [*reading, name]));
                }
                rows.push(cells);
            }
        }
    }
    Table {
        word: "strengthening",
        head: &[
            "table",
            "damping ratio",
            "reading of eq. 13",
            "factor",
            "15 degrees, flat",
            "15 degrees, upright",
            "25 degrees, flat",
            "25 degrees, upright",
        ],
        names: 4,
        rows,
    }
}

/// A cell of that table, for a reading and a way to apply the factor.
fn endured(
    results: &Path,
    row: &strengthening::Row,
    fall: &str,
    [reading, way]: [&str; 2],
) -> String {
    let of = |seed| {
        let run = read(&results.join(format!("{}.json", row.name(fall, seed))))?;
        Some(run["readings"][reading][way].clone())
    };
    let runs: Vec<Value> = (1..=row.packings).filter_map(of).collect();
    let all = |name: &str| {
        runs.iter()
            .map(|run| number(&run[name]))
            .collect::<Vec<_>>()
    };
    match runs.len() {
        0 => String::new(),
        count => format!(
            "{} over, most {} %, above half {} % ({count})",
            thousands(all("above_1").iter().sum::<f64>() / count as f64),
            range(&scaled(&all("largest"), 100.0), 0),
            range(&scaled(&all("fraction_above_half"), 100.0), 1),
        ),
    }
}

fn rebound(results: &Path) -> Table {
    let row = |(damping, _): (&str, &str)| {
        let run = |seed| read(&results.join(format!("{}.json", rebound::name(damping, seed))));
        let runs: Vec<Value> = (1..=PACKINGS).filter_map(run).collect();
        let percent = |run: &Value| 100.0 * number(&run["fraction"]);
        let all: Vec<f64> = runs.iter().map(percent).collect();
        vec![damping.to_owned(), all.len().to_string(), mean(&all, 1)]
    };
    Table {
        word: "rebound",
        head: &[
            "damping of the bonds, sample of table 2",
            "packings",
            "rebound over height of the fall, %",
        ],
        names: 1,
        rows: rebound::DAMPING.map(row).into(),
    }
}
