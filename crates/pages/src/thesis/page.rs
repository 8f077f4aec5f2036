//! The tables of the page, from the results that are there; what has not been computed anew stays
//! as it stands on the page.

use std::path::Path;

use serde_json::Value;

use super::bending::{self, READINGS};
use super::drops::{self, Dif, FALLS};
use super::plots;
use super::rebound;
use super::samples::{self, PACKINGS, Table as Spheres};
use super::steps;
use super::strengthening::{self, WAYS};
use crate::bench::{Bench, Failed, Run, finished, number, read, root};
use crate::cells::{cells, least_to_most, mean, range, rounded, scattered, thousands};
use crate::table::{self, Table};

const PAGE: &str = "tests/verification/thesis.md";
const DROPS: &str = "thesis drops";
const BENDING: &str = "thesis bending";

/// Writes the tables of the page, and its plots.
pub(crate) fn write(bench: &Bench) -> Result<(), Failed> {
    let before = std::fs::read_to_string(root().join(PAGE))?;
    let mut tables = tables(&bench.folder);
    for at in 0..tables.len() {
        let place = table::place(&tables, at);
        let parts = table::parts(&before, tables[at].words, place);
        let [_, earlier, _] = parts.ok_or("the page has no such table")?;
        keep_earlier(&mut tables[at], &table::rows(earlier));
    }
    table::write(&tables)?;
    for (name, svg) in plots::all(&bench.folder) {
        std::fs::write(root().join("tests/verification").join(name), svg)?;
    }
    Ok(())
}

/// Keeps what earlier rows have more: cells that are empty now, and rows of more packings. Rows
/// without any result are left out.
fn keep_earlier(table: &mut Table, earlier: &[Vec<String>]) {
    let count = table.head.iter().position(|head| *head == "packings");
    let names = names(table);
    for row in &mut table.rows {
        let same = |other: &&Vec<String>| other[..names] == row[..names];
        let Some(other) = earlier.iter().find(same) else {
            continue;
        };
        let packings = |row: &[String]| count.map_or(0, |at| row[at].parse().unwrap_or(0));
        if packings(other) > packings(row) {
            row.clone_from(other);
        }
        for (cell, other) in row.iter_mut().zip(other) {
            if cell.is_empty() || packings_within(other) > packings_within(cell) {
                cell.clone_from(other);
            }
        }
    }
    table.rows.retain(|row| {
        let mut results = row[names..].iter().enumerate();
        results.any(|(at, cell)| Some(names + at) != count && !cell.is_empty())
    });
}

/// Number of cells at the beginning of a row that name it.
fn names(table: &Table) -> usize {
    match table.words {
        DROPS if table.head.contains(&"fall") => 5,
        DROPS | "thesis strengthening" => 4,
        BENDING if table.head[1] == "reading of eq. 13" => 2,
        _ => 1,
    }
}

/// Number of packings at the end of a cell: 4 in `broken (4)`; 0 if there is none.
fn packings_within(cell: &str) -> u32 {
    let inside = cell
        .rsplit_once('(')
        .and_then(|(_, end)| end.strip_suffix(')'));
    inside.and_then(|count| count.parse().ok()).unwrap_or(0)
}

/// The tables in their order.
pub(crate) fn tables(results: &Path) -> [Table; 9] {
    [
        sample(results),
        steps(results),
        bending(results, |row| row.reading == READINGS[0]),
        bending(results, |row| row.reading != READINGS[0]),
        speed(results),
        drops(results),
        utilisation(results),
        strengthening(results),
        rebound(results),
    ]
}

fn table(words: &'static str, head: &'static str, rows: Vec<Vec<String>>) -> Table {
    let mut table = Table::new(PAGE, words, head, [""; 0]);
    for row in rows {
        table.row(row);
    }
    table
}

/// The results of these names that have been computed.
fn results_of(results: &Path, names: impl Iterator<Item = String>) -> Vec<Value> {
    names
        .filter_map(|name| read(&results.join(format!("{name}.json"))))
        .collect()
}

fn all(results: &[Value], name: &str) -> Vec<f64> {
    results.iter().map(|result| number(&result[name])).collect()
}

fn sample(results: &Path) -> Table {
    let mut rows = vec![cells(
        "Platzer 2022, 3.2.3 |  | 77,487 | 377,052 | 4.87 | 132 s; 780 min by filling",
    )];
    for samples in samples::counted() {
        let reports = results_of(results, samples.iter().map(super::samples::Sample::name));
        let quality: Vec<Value> = reports
            .iter()
            .map(|report| report["quality"].clone())
            .collect();
        let (spheres, bonds) = (all(&quality, "particles"), all(&quality, "bonds"));
        let each: Vec<f64> = bonds.iter().zip(&spheres).map(|(b, s)| b / s).collect();
        let seconds = reports.iter().map(|report| {
            let parts = report["seconds"].as_object();
            parts.map_or(f64::NAN, |parts| parts.values().map(number).sum())
        });
        rows.push(vec![
            format!(
                "{}, bond range {}",
                samples[0].title(),
                samples[0].bond_range
            ),
            reports.len().to_string(),
            least_to_most(&spheres, thousands),
            least_to_most(&bonds, thousands),
            range(&each, 2),
            match range(&seconds.collect::<Vec<_>>(), 1) {
                none if none.is_empty() => none,
                seconds => seconds + " s",
            },
        ]);
    }
    let head = "sample, 180 mm x 30 mm x 35 mm | packings | spheres | bonds | bonds per sphere | \
        time";
    table("thesis sample", head, rows)
}

fn steps(results: &Path) -> Table {
    let mut rows = vec![cells("step of Platzer 2022 | 2 | 4")];
    for (damping, _) in steps::DAMPING {
        let [one, two] =
            [Spheres::One, Spheres::Two].map(|table| steps::limit_us(results, table, damping));
        rows.push(vec![damping.to_owned(), one, two]);
    }
    let head = "damping of the bonds | table 1, us | table 2, us";
    table("thesis steps", head, rows)
}

/// The bending tests of a row that have been run.
fn bent(results: &Path, row: &bending::Row) -> Vec<Run> {
    let names = (1..=row.packings).map(|seed| row.name(seed));
    names
        .filter_map(|name| finished(&results.join(name)))
        .collect()
}

/// Cells of a row of bending tests after its name.
fn bent_cells(runs: &[Run]) -> Vec<String> {
    let tests: Vec<_> = runs.iter().filter_map(|run| run.test().ok()).collect();
    let figure = |name: &str, factor: f64, digits: usize| {
        let values = tests.iter().filter_map(|test| test.figure(name));
        scattered(
            &values.map(|value| factor * value).collect::<Vec<_>>(),
            digits,
            "",
        )
    };
    let first = tests
        .iter()
        .filter_map(|test| Some(test.first_broken.as_ref()?.force_n));
    let within = tests
        .iter()
        .filter_map(|test| Some(test.crack.as_ref()?.fraction_within));
    let times: Vec<f64> = runs
        .iter()
        .map(super::super::bench::Run::processor_s)
        .collect();
    vec![
        runs.len().to_string(),
        figure("stiffness", 1e-3, 2),
        figure("modulus without shear", 1e-6, 2),
        figure("failure force", 1.0, 1),
        figure("crosshead travel at failure", 1e3, 2),
        figure("strength", 1e-6, 3),
        scattered(&first.collect::<Vec<_>>(), 1, ""),
        range(&within.map(|share| 100.0 * share).collect::<Vec<_>>(), 0),
        range(&times, 1),
    ]
}

/// The tests with some readings of eq. 13.
fn bending(results: &Path, is_shown: fn(&bending::Row) -> bool) -> Table {
    let mut rows = vec![cells(
        "Platzer 2022 |  |  | 18.23 | 12.05 | 51.45 | 2.82 | 0.21 |  |  | ",
    )];
    for row in bending::rows().iter().filter(|row| is_shown(row)) {
        let sample = format!(
            "{}, bond range {}",
            row.sample.title(),
            row.sample.bond_range
        );
        let first = vec![sample, format!("`{}`", row.reading)];
        rows.push([first, bent_cells(&bent(results, row))].concat());
    }
    table(BENDING, BENDING_HEAD, rows)
}

const BENDING_HEAD: &str = "sample | reading of eq. 13 | packings | stiffness, N/mm | E by eq. 18, MPa | \
    F_max, N | w_max, mm | strength by eq. 19, MPa | first bond breaks at, N | \
    broken bonds between the pins, % | processor time, s";

/// Processor time and steps of the bending test with table 1 over those with table 2, of the bare
/// front.
fn speed(results: &Path) -> Table {
    let mut rows = vec![cells("Platzer 2022, 4.5.3.3 | 36 | ")];
    for reading in READINGS {
        let of = |table: Spheres, read: fn(&Run) -> f64| {
            let mut all = bending::rows();
            all.retain(|row| {
                row.sample.table == table
                    && row.sample.bare
                    && row.sample.bond_range == "1.0"
                    && row.reading == reading
            });
            let runs = all.iter().flat_map(|row| bent(results, row));
            mean(&runs.map(|run| read(&run)).collect::<Vec<_>>())
        };
        let ratio = |read| of(Spheres::One, read) / of(Spheres::Two, read);
        rows.push(vec![
            format!("`{reading}`"),
            rounded(ratio(Run::processor_s), 0),
            rounded(ratio(|run| run.summary.steps as f64), 1),
        ]);
    }
    let head = "table 1 over table 2 | processor time | steps";
    table(BENDING, head, rows)
}

/// The drops of a row that have been run.
fn fallen(results: &Path, row: &drops::Row, fall: &str) -> Vec<Value> {
    results_of(results, (1..=row.packings).map(|seed| row.name(fall, seed)))
}

/// Broken bonds, mean, and fraction of the largest piece, least to most; packings.
fn drops(results: &Path) -> Table {
    let mut rows = vec![
        cells("Platzer 2022 |  | 0.6 | yes | intact | intact | intact | intact"),
        // Without the factor it has falls at 15 degrees only: figs. 51 and 52.
        cells("Platzer 2022 |  | 0.6 | no | broken | broken | not shown | not shown"),
    ];
    for row in drops::rows() {
        let mut cells = row.title();
        cells.push(row.dif.title().to_owned());
        for fall in FALLS {
            let runs = fallen(results, &row, fall.0);
            cells.push(match runs.len() {
                0 => String::new(),
                count => format!(
                    "{} broken, largest piece {} ({count})",
                    thousands(mean(&all(&runs, "broken"))),
                    range(&all(&runs, "largest"), 3),
                ),
            });
        }
        rows.push(cells);
    }
    table(DROPS, DROPS_HEAD, rows)
}

const DROPS_HEAD: &str = "table | reading of eq. 13 | damping ratio | DIF | 15 degrees, flat | \
    15 degrees, upright | 25 degrees, flat | 25 degrees, upright";

/// Largest utilisation of each bond during the drop, of the first packing, with the factor.
fn utilisation(results: &Path) -> Table {
    let mut rows = vec![cells(
        "Platzer 2022, figs. 55 and 56 |  | 0.6 | yes | 25-flat |  |  | at most 71 | mostly below 50",
    )];
    for row in drops::rows().iter().filter(|row| row.dif != Dif::No) {
        for fall in FALLS {
            let run = fallen(results, row, fall.0).first().cloned();
            let run = run.unwrap_or_default();
            let percent = |name: &str, digits: usize| {
                rounded(100.0 * number(&run["utilisation"][name]), digits)
            };
            let mut cells = row.title();
            cells.extend([
                row.dif.title().to_owned(),
                fall.0.to_owned(),
                percent("median", 0),
                percent("exceeded_by_1_in_100", 0),
                percent("exceeded_by_1_in_1000", 0),
                percent("fraction_above_half", 1),
            ]);
            rows.push(cells);
        }
    }
    let head = "table | reading of eq. 13 | damping ratio | DIF | fall | median, % | \
        exceeded by 1 % of bonds, % | by 0.1 %, % | bonds above 50 %, %";
    table(DROPS, head, rows)
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
                    cells.push(endured(results, &row, fall.0, [*reading, name]));
                }
                rows.push(cells);
            }
        }
    }
    let head = "table | damping ratio | reading of eq. 13 | factor | 15 degrees, flat | \
        15 degrees, upright | 25 degrees, flat | 25 degrees, upright";
    table("thesis strengthening", head, rows)
}

/// A cell of that table, for a reading and a way to apply the factor.
fn endured(results: &Path, row: &drops::Row, fall: &str, [reading, way]: [&str; 2]) -> String {
    let names = (1..=row.packings).map(|seed| strengthening::name(row, fall, seed));
    let runs = results_of(results, names);
    let runs = runs.iter().map(|run| run["readings"][reading][way].clone());
    let runs: Vec<Value> = runs.collect();
    let percent = |name: &str, digits: usize| {
        let values = all(&runs, name);
        range(
            &values.iter().map(|share| 100.0 * share).collect::<Vec<_>>(),
            digits,
        )
    };
    match runs.len() {
        0 => String::new(),
        count => format!(
            "{} over, most {} %, above half {} % ({count})",
            thousands(mean(&all(&runs, "above_1"))),
            percent("largest", 0),
            percent("fraction_above_half", 1),
        ),
    }
}

fn rebound(results: &Path) -> Table {
    let row = |(damping, _): (&str, &str)| {
        let runs = results_of(
            results,
            (1..=PACKINGS).map(|seed| rebound::name(damping, seed)),
        );
        let percent: Vec<f64> = all(&runs, "fraction")
            .iter()
            .map(|share| 100.0 * share)
            .collect();
        vec![
            damping.to_owned(),
            percent.len().to_string(),
            scattered(&percent, 1, ""),
        ]
    };
    let head = "damping of the bonds, sample of table 2 | packings | \
        rebound over height of the fall, %";
    table("thesis rebound", head, rebound::DAMPING.map(row).into())
}
