//! Rows of the board, from tables of the pages and stored results.

use dem_io::units::significant;
use serde_json::Value;

use super::times;
use crate::bench::{Failed, number, read, root};
use crate::cells::change;
use crate::rocks::{Beside, beside};
use crate::table::rows as table_rows;

/// A claim.
#[derive(Debug, Default, Clone)]
pub(super) struct Row {
    pub(super) case: String,
    pub(super) source: String,
    pub(super) ours: String,
    pub(super) theirs: String,
    pub(super) error: String,
    pub(super) hardware: String,
    pub(super) time: String,
}

/// The tables of a section of a page, each as its rows, the head first.
fn tables_of(page: &str, section: &str) -> Result<Vec<Vec<Vec<String>>>, Failed> {
    let text = std::fs::read_to_string(root().join(page))?;
    let parts = sections(&text);
    let found = parts.into_iter().find(|(title, _)| title == section);
    let (_, text) = found.ok_or_else(|| format!("{page} has no section '{section}'"))?;
    Ok(tables_in(&text))
}

/// Titles of the sections of a page and their texts; what is before the first has none.
fn sections(text: &str) -> Vec<(String, String)> {
    let mut all = vec![(String::new(), String::new())];
    for line in text.lines() {
        if let Some(title) = line.strip_prefix("## ") {
            all.push((title.to_owned(), String::new()));
        } else if let Some((_, text)) = all.last_mut() {
            text.push_str(line);
            text.push('\n');
        }
    }
    all
}

fn tables_in(text: &str) -> Vec<Vec<Vec<String>>> {
    let blocks = text.split("\n\n").filter(|block| block.contains("|--"));
    let lines = |block: &str| -> String {
        let rows = block.lines().filter(|line| line.starts_with('|'));
        rows.flat_map(|line| [line, "\n"]).collect()
    };
    blocks.map(|block| table_rows(&lines(block))).collect()
}

/// The number that a cell begins with; none in words.
fn leading(cell: &str) -> Option<f64> {
    let cell = cell.replace('\u{2212}', "-").replace(',', "");
    let cell = cell.trim_start_matches("< ");
    let end = cell.find(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c)));
    cell[..end.unwrap_or(cell.len())].parse().ok()
}

/// The claims of the pages that tests write: of each section the row with the largest relative
/// error.
pub(super) fn of_sections() -> Result<Vec<Row>, Failed> {
    let index = std::fs::read_to_string(root().join("tests/verification/README.md"))?;
    let mut rows = Vec::new();
    for page in times::pages()? {
        let text = std::fs::read_to_string(root().join(format!("tests/verification/{page}.md")))?;
        let listed = index
            .lines()
            .find(|line| line.contains(&format!("({page}.md)")));
        let source = listed.and_then(|line| line.trim_end_matches(" |").rsplit(" | ").next());
        let [hardware, time] = times::of(&page);
        for (title, text) in sections(&text) {
            let tables = tables_in(&text);
            let compared = tables.iter().filter(|table| table[0].len() == 5);
            let compared = compared.filter(|table| table[0][3] == "relative error");
            let all = compared.flat_map(|table| table[1..].iter().map(move |row| (&table[0], row)));
            let error = |row: &[String]| leading(&row[3]).unwrap_or(0.0).abs();
            let worst = all.max_by(|(_, a), (_, b)| error(a).total_cmp(&error(b)));
            let Some((head, row)) = worst else { continue };
            let unit = head[1]
                .strip_prefix("computed, ")
                .filter(|unit| *unit != "SI");
            let unit = unit.map_or(String::new(), |unit| format!(", {unit}"));
            rows.push(Row {
                case: format!("[{title}]({page}.md): {}{unit}", row[0]),
                source: source.unwrap_or_default().to_owned(),
                ours: row[1].clone(),
                theirs: row[2].clone(),
                error: row[3].clone(),
                hardware: hardware.clone(),
                time: time.clone(),
            });
        }
    }
    Ok(rows)
}

/// A row of a table on a page: our number and that of others, by their columns.
pub(super) struct Pick {
    pub(super) case: &'static str,
    pub(super) source: &'static str,
    pub(super) page: &'static str,
    pub(super) section: &'static str,
    /// The beginnings of the first cells of the row, between `|`.
    pub(super) row: &'static str,
    pub(super) ours: &'static str,
    /// Row, by the same rule, and column of the number of others.
    pub(super) theirs: [&'static str; 2],
    /// Column of the time, s, if the table has one.
    pub(super) time: &'static str,
}

/// Where the times of the thesis are from.
const SHARED: &str = "one core of a shared machine";

const THESIS: &str = "tests/verification/thesis.md";
const ROBIN: &str = "doc/inside/round-robin.md";

const fn of_thesis(case: &'static str, row: &'static str, column: &'static str) -> Pick {
    Pick {
        case,
        source: "Platzer 2022, eqs. 18 and 19",
        page: THESIS,
        section: "Four-point bending",
        row,
        ours: column,
        theirs: ["Platzer 2022", column],
        time: "processor time, s",
    }
}

/// Measurements and results of others on the pages.
const MEASURED: [Pick; 9] = [
    of_thesis(
        "four-point bending, sample of table 1: stiffness, N/mm",
        "table 1, bare front, bond range 1.0",
        "stiffness, N/mm",
    ),
    of_thesis(
        "four-point bending, sample of table 1: largest force, N",
        "table 1, bare front, bond range 1.0",
        "F_max, N",
    ),
    of_thesis(
        "four-point bending, sample of table 2: stiffness, N/mm",
        "table 2, bare front, bond range 1.0",
        "stiffness, N/mm",
    ),
    of_thesis(
        "four-point bending, sample of table 2: largest force, N",
        "table 2, bare front, bond range 1.0",
        "F_max, N",
    ),
    Pick {
        case: "spheres in the sample of table 1",
        source: "Platzer 2022, 3.2.3",
        page: THESIS,
        section: "Spheres and bonds",
        row: "table 1, bare front, bond range 1.0",
        ours: "spheres",
        theirs: ["Platzer 2022", "spheres"],
        time: "time",
    },
    Pick {
        case: "ball in a bed of 100,000 spheres of 2 mm, a twentieth as stiff: displacement, mm",
        source: "Uehara et al. 2003: depth, mm",
        page: ROBIN,
        section: "Penetration",
        row: "2 mm",
        ours: "depth",
        theirs: ["2 mm", "Uehara et al. 2003"],
        time: "",
    },
    Pick {
        case: "silo with a cone, hole of 60 mm, spheres of 6 mm: spheres per second",
        source: "Beverloo et al. 1961",
        page: ROBIN,
        section: "Silo",
        row: "cone|M1 of 6 mm",
        ours: "spheres per second",
        theirs: ["cone|M1 of 6 mm", "Beverloo"],
        time: "",
    },
    Pick {
        case: "drum: torque times speed against booked work, mW",
        source: "conservation of energy",
        page: ROBIN,
        section: "Drum",
        row: "torque on the drum",
        ours: "",
        theirs: ["work of the drum", ""],
        time: "",
    },
    Pick {
        case: "cantilever of parallel bonds, case 1: deflection, mm",
        source: "Chen et al. 2022, table 4",
        page: "tests/verification/cantilevers.md",
        section: "Case 1: the reference bar (table 4 of the paper)",
        row: "parallel (PBM)",
        ours: "here, mm",
        theirs: ["parallel (PBM)", "paper, mm"],
        time: "",
    },
];

const RESOLUTION: &str = "tests/verification/resolution.md";

/// A result with larger spheres beside that with the finest ones.
const fn of_resolution(
    case: &'static str,
    section: &'static str,
    [row, finest]: [&'static str; 2],
    column: &'static str,
    time: &'static str,
) -> Pick {
    Pick {
        case,
        source: "the same with the finest spheres of the page",
        page: RESOLUTION,
        section,
        row,
        ours: column,
        theirs: [finest, column],
        time,
    }
}

const FALLS: &str = "From which height does a lump break?";
const WEIGHTS: &str = "How fine does a weight break it?";
const CHUTES: &str = "What arrives below a plate?";
const BRITTLE: [&str; 2] = ["brittle, 6", "brittle, 13.5"];
const SOFTENING: [&str; 2] = ["5 J/m2, 6", "5 J/m2, 13.5"];

/// Results with six spheres across.
const COARSE: [Pick; 6] = [
    of_resolution(
        "break height with 6 spheres across, brittle bonds, m",
        FALLS,
        BRITTLE,
        "break height, m",
        "processor time of a fall, s",
    ),
    of_resolution(
        "the same, bonds with a fracture energy",
        FALLS,
        SOFTENING,
        "break height, m",
        "processor time of a fall, s",
    ),
    of_resolution(
        "d50 under a weight with 6 spheres across, brittle bonds, mm",
        WEIGHTS,
        BRITTLE,
        "d50, mm",
        "processor time of a test, s",
    ),
    of_resolution(
        "the same, bonds with a fracture energy",
        WEIGHTS,
        SOFTENING,
        "d50, mm",
        "processor time of a test, s",
    ),
    of_resolution(
        "d50 below a plate with 6 spheres across, brittle bonds, mm",
        CHUTES,
        ["brittle, 6", "brittle, 9"],
        "d50, mm",
        "processor time of six lumps, s",
    ),
    of_resolution(
        "the same, bonds with a fracture energy",
        CHUTES,
        ["5 J/m2, 6", "5 J/m2, 9"],
        "d50, mm",
        "processor time of six lumps, s",
    ),
];

pub(super) fn of_sizes() -> Result<Vec<Row>, Failed> {
    COARSE.iter().map(picked).collect()
}

/// The row of some tables whose first cells begin with these words, in a table with this column,
/// and the place of the column.
fn find(tables: &[Vec<Vec<String>>], row: &str, column: &str) -> Option<(Vec<String>, usize)> {
    let words: Vec<&str> = row.split('|').collect();
    for table in tables {
        let Some(at) = table[0].iter().position(|head| head == column) else {
            continue;
        };
        let named = |cells: &&Vec<String>| {
            let mut pairs = cells.iter().zip(&words);
            pairs.all(|(cell, word)| cell.trim_matches('`').starts_with(word))
        };
        if let Some(cells) = table[1..].iter().find(named) {
            return Some((cells.clone(), at));
        }
    }
    None
}

/// The error of a number beside that of a cell, or beside the nearer end of a band: `1 to 2`.
fn compared(own: f64, theirs: &str) -> Option<String> {
    let ends = theirs.split_once(" to ").filter(|_| !theirs.contains('('));
    let Some((low, high)) = ends else {
        return Some(change(own / leading(theirs)? - 1.0, 2));
    };
    let (low, high) = (leading(low)?, leading(high)?);
    Some(if own < low {
        format!("{} of the lower end", change(own / low - 1.0, 1))
    } else if own > high {
        format!("{} of the upper end", change(own / high - 1.0, 1))
    } else {
        "inside".to_owned()
    })
}

pub(super) fn picked(pick: &Pick) -> Result<Row, Failed> {
    let tables = tables_of(pick.page, pick.section)?;
    let cell = |row: &str, column: &str| -> Result<String, Failed> {
        let found = find(&tables, row, column).map(|(cells, at)| cells[at].clone());
        Ok(found.ok_or_else(|| format!("{}: no '{row}', '{column}'", pick.page))?)
    };
    let ours = cell(pick.row, pick.ours)?;
    let theirs = cell(pick.theirs[0], pick.theirs[1])?;
    let off = leading(&ours).and_then(|own| compared(own, &theirs));
    let time = if pick.time.is_empty() {
        String::new()
    } else {
        let time = cell(pick.row, pick.time)?;
        format!("{} s", time.trim_end_matches(" s"))
    };
    let hardware = if time.is_empty() { "" } else { SHARED };
    Ok(Row {
        case: format!("[{}](../../{})", pick.case, pick.page),
        source: pick.source.to_owned(),
        hardware: hardware.to_owned(),
        error: off.unwrap_or_default(),
        ours,
        theirs,
        time,
    })
}

pub(super) fn measured() -> Result<Vec<Row>, Failed> {
    MEASURED.iter().map(picked).collect()
}

/// Mean strengths of rocks between bars, predicted from slow tests.
pub(super) fn of_rocks() -> Result<Vec<Row>, Failed> {
    let row = |one: Beside| {
        let Beside { rock, count, .. } = one;
        let [ours, theirs] = one.strengths_mpa;
        Row {
            case: format!(
                "[{rock} between bars, bonds calibrated on slow tests: mean strength of {count} tests, MPa](rocks.md)"
            ),
            source: "Rae et al. 2020".to_owned(),
            ours: format!("{ours:.1}"),
            theirs: format!("{theirs:.1}"),
            error: change(ours / theirs - 1.0, 1),
            ..Row::default()
        }
    };
    Ok(beside()?.into_iter().map(row).collect())
}

/// A deviation that a table has in one of its rows.
struct Deviation {
    case: &'static str,
    source: &'static str,
    page: &'static str,
    section: &'static str,
    /// Which of the tables of the section, and which column, from 0.
    at: [usize; 2],
    unit: &'static str,
}

const CHUNG: &str = "tests/verification/chung-ooi.md";
const OF_LARGEST: &str = "% of the largest, root mean square";

const fn of_chung(
    case: &'static str,
    source: &'static str,
    section: &'static str,
    at: usize,
) -> Deviation {
    Deviation {
        case,
        source,
        page: CHUNG,
        section,
        at: [at, 3],
        unit: OF_LARGEST,
    }
}

const TEST_4: &str = "Test 4: oblique impacts at one speed";
const TEST_5: &str = "Test 5: oblique impacts at one normal velocity";
const DEVIATIONS: [Deviation; 8] = [
    of_chung(
        "spin after oblique impacts",
        "Kharaz et al. 2001, measured",
        TEST_4,
        2,
    ),
    of_chung(
        "angle of rebound of the surface",
        "Kharaz et al. 2001, measured",
        TEST_4,
        3,
    ),
    of_chung(
        "velocity along the plane",
        "Chung and Ooi 2011, their program",
        TEST_4,
        4,
    ),
    of_chung(
        "slip after oblique impacts",
        "finite elements, in Chung and Ooi 2011",
        TEST_5,
        2,
    ),
    of_chung(
        "restitution of a spinning surface",
        "Chung and Ooi 2011, their program",
        "Test 6: a spinning sphere",
        1,
    ),
    of_quartzite("fragments of quartzite below 1/4 of its size", 2),
    of_quartzite("fragments of quartzite below 1/10 of its size", 4),
    of_quartzite("fragments of quartzite below 1/25 of its size", 6),
];

const fn of_quartzite(case: &'static str, column: usize) -> Deviation {
    Deviation {
        case,
        source: "Rae et al. 2020, 13 tests, measured",
        page: "doc/breakage.md",
        section: "Beside measured quartzite",
        at: [0, column],
        unit: "points of per cent, root mean square",
    }
}

/// Deviations of whole series: the last row of each table has them.
pub(super) fn of_tables() -> Result<Vec<Row>, Failed> {
    let row = |of: &Deviation| {
        let [table, column] = of.at;
        let tables = tables_of(of.page, of.section)?;
        let last = tables.get(table).and_then(|table| table.last());
        let cell = last.filter(|row| row[0].starts_with("root mean square"));
        let cell = cell.ok_or_else(|| format!("{}: no deviation", of.case))?;
        Ok(Row {
            case: format!("[{}](../../{})", of.case, of.page),
            source: of.source.to_owned(),
            error: format!("{} {}", cell[column], of.unit),
            ..Row::default()
        })
    };
    DEVIATIONS.iter().map(row).collect()
}

/// Rows of the comparisons with LAMMPS on one rank: agreement, the neck, speed.
pub(super) fn of_programs() -> Result<Vec<Row>, Failed> {
    let mut rows = Vec::new();
    let on_one = |table: &[Vec<String>], column: &str| -> Vec<Vec<String>> {
        let at = table[0].iter().position(|head| head == column);
        let one = table[1..]
            .iter()
            .filter(|row| at.is_some_and(|at| row[at] == "1"));
        one.cloned().collect()
    };
    let agreement = tables_of("doc/lammps.md", "Agreement")?;
    for cells in on_one(&agreement[0], "ranks") {
        rows.push(Row {
            case: format!("[{}](../../doc/lammps.md#agreement)", cells[0]),
            source: "LAMMPS".to_owned(),
            ours: cells[2].clone(),
            theirs: cells[3].clone(),
            error: cells[4].clone(),
            ..Row::default()
        });
    }
    let neck = tables_of("tests/verification/size-ratios.md", "The neck")?;
    for (ours, theirs) in neck[0][1..]
        .iter()
        .filter(|row| row[0].contains("leaves"))
        .zip(&neck[1][1..])
    {
        let off = leading(&theirs[3]).zip(leading(&theirs[1]));
        rows.push(Row {
            case: format!("[neck, ratio {}](size-ratios.md#the-neck)", ours[0]),
            source: "LAMMPS; the closed form is below".to_owned(),
            ours: ours[1].clone(),
            theirs: format!("{}, synchronized {}", theirs[2], theirs[3]),
            error: off.map_or(String::new(), |(a, b)| {
                format!("theirs, synchronized: {}", change(a / b - 1.0, 0))
            }),
            ..Row::default()
        });
    }
    let speed = tables_of("doc/inside/performance.md", "Beside LAMMPS")?;
    for cells in on_one(&speed[0], "threads, ranks") {
        rows.push(Row {
            case: format!(
                "[speed, {}: {}](../../doc/inside/performance.md#beside-lammps)",
                cells[0], cells[4]
            ),
            source: "LAMMPS".to_owned(),
            ours: cells[5].clone(),
            theirs: cells[6].clone(),
            error: format!("{} times as fast", cells[7]),
            hardware: "one core of the machine of the page".to_owned(),
            ..Row::default()
        });
    }
    Ok(rows)
}

/// The round robin of bonded models, as tests/bonded-round-robin/run.py stored it.
pub(super) fn bonded() -> Result<Vec<Row>, Failed> {
    let stored = read(&root().join("tests/bonded-round-robin/results.json"));
    let stored = stored.ok_or("tests/bonded-round-robin has no results")?;
    let mut rows = Vec::new();
    let cases = stored["cases"].as_object().ok_or("no cases")?;
    for (name, case) in cases {
        for of in case["quantities"].as_array().into_iter().flatten() {
            let ours = number(&of["values"]["dem-run"]);
            let closed = of["closed_form"].as_f64();
            let of_program = |program: &str| {
                let value = of["values"][program].as_f64()?;
                Some((format!("{program} {}", significant(value, 6)), value))
            };
            let others: Vec<_> = ["dem-run, incremental", "LAMMPS", "YADE"]
                .into_iter()
                .filter_map(of_program)
                .collect();
            let values = closed
                .into_iter()
                .chain(others.iter().map(|(_, value)| *value));
            let off = values
                .map(|value| (ours / value - 1.0).abs())
                .fold(0.0, f64::max);
            let closed = closed.map(|value| format!("closed form {}", significant(value, 6)));
            let theirs = closed
                .into_iter()
                .chain(others.into_iter().map(|(text, _)| text));
            let quantity = of["quantity"].as_str().unwrap_or_default();
            rows.push(Row {
                case: format!("[{name}](../bonded-round-robin/README.md): {quantity}"),
                source: "the same bonds, by each program".to_owned(),
                ours: significant(ours, 6),
                theirs: theirs.collect::<Vec<_>>().join("; "),
                error: format!("{off:.1e}"),
                hardware: format!(
                    "one core, {}",
                    stored["processor"].as_str().unwrap_or_default()
                ),
                time: times_of(&case["seconds"]),
            });
        }
    }
    Ok(rows)
}

/// The times of a case in each program.
fn times_of(seconds: &Value) -> String {
    let of = |program: &&str| seconds[*program].is_number();
    let programs = ["dem-run", "LAMMPS", "YADE"].into_iter().filter(of);
    let text = programs.map(|program| match program {
        "dem-run" => format!("{} s", seconds[program]),
        _ => format!("{program} {} s", seconds[program]),
    });
    text.collect::<Vec<_>>().join("; ")
}
