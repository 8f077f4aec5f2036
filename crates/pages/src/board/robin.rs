//! The round robin of Dosta et al. 2024 at full size: `tests/round-robin`.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::rows::Row;
use super::times::processor;
use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, keep, number, read, root};
use crate::cells::change;

const SCENE: &str = "tests/round-robin/penetration.toml";
const PUBLISHED: &str = "tests/round-robin/published.json";
/// The beds: in names of files, and in words.
const BEDS: [(&str, &str); 2] = [("25k", "25,000"), ("50k", "50,000")];
/// Height of the centre of the ball at the start, m.
const START_M: f64 = 0.06;

/// The way of the ball into a bed, as a run has left it.
fn results(bed: &str) -> PathBuf {
    root().join(format!("tests/round-robin/penetration-{bed}.json"))
}

/// Runs the ball into 25,000 spheres, or takes what a run has left, and stores its way.
pub(crate) fn penetration_25k(bench: &Bench) -> Result<(), Failed> {
    penetration(bench, "25k")
}

/// The same into 50,000 spheres.
pub(crate) fn penetration_50k(bench: &Bench) -> Result<(), Failed> {
    penetration(bench, "50k")
}

fn penetration(bench: &Bench, bed: &str) -> Result<(), Failed> {
    let name = format!("penetration-{bed}");
    let folder = bench.folder.join(&name);
    let run = if bench.has(&folder.join("series.csv")) {
        Run {
            folder: folder.clone(),
            settings: Vec::new(),
            summary: dem_results::Summary::read(&folder.join("summary.json"))
                .ok_or("the run has no summary")?,
        }
    } else {
        let file = root().join(format!("tests/round-robin/{name}-bed.vtp"));
        bench.run(&name, SCENE, &[ONE_THREAD.to_owned(), body("bed", &file)])?
    };
    let rows = run.columns("series.csv", ["time_s", "ball_m"])?;
    let way = rows
        .iter()
        .map(|[t, z]| json!([1e3 * t, 1e3 * (z - START_M)]));
    let stored = json!({
        "processor": processor(),
        "processor_s": run.processor_s(),
        "way_ms_mm": way.collect::<Vec<_>>(),
    });
    keep(&results(bed), &stored)
}

/// The displacement on the line between two rows (time, displacement).
fn at(way: &[[f64; 2]], time_ms: f64) -> Option<f64> {
    let next = way.iter().position(|[t, _]| *t >= time_ms)?;
    let [[t, z], [next_t, next_z]] = [way[next.saturating_sub(1)], way[next]];
    let part = if next_t > t {
        (time_ms - t) / (next_t - t)
    } else {
        0.0
    };
    Some(z + (next_z - z) * part)
}

/// The displacements of the ball beside those of others, for each bed that it has been run into.
pub(super) fn rows() -> Result<Vec<Row>, Failed> {
    let published = read(&root().join(PUBLISHED)).ok_or("no published numbers")?;
    let mut rows = Vec::new();
    for (bed, spheres) in BEDS {
        if let Some(stored) = read(&results(bed)) {
            let programs = published["cases"][bed].as_array().ok_or("no programs")?;
            rows.extend(rows_of(spheres, &stored, programs));
        }
    }
    Ok(rows)
}

/// The rows of a bed of so many spheres, in words.
fn rows_of(spheres: &str, stored: &Value, programs: &[Value]) -> Vec<Row> {
    let pairs = stored["way_ms_mm"].as_array().into_iter().flatten();
    let way: Vec<[f64; 2]> = pairs
        .map(|pair| [number(&pair[0]), number(&pair[1])])
        .collect();
    let until_ms = way.last().map_or(0.0, |[t, _]| *t);
    let lowest = way.iter().map(|[_, z]| *z).fold(0.0, f64::min);
    let time = |program: &Value| {
        let seconds = number(&program["wall_s"]);
        format!(
            "{} {seconds:.0} s on {}",
            words(&program["name"]),
            words(&program["device"])
        )
    };
    let times: Vec<String> = programs.iter().map(time).collect();
    let mut rows = Vec::new();
    for (what, here, of) in [
        ("after 10 ms", at(&way, 10.0), "10"),
        ("after 20 ms", at(&way, 20.0), "20"),
        ("after 30 ms", at(&way, 30.0), "30"),
        ("lowest", Some(lowest), "lowest"),
        ("after 40 ms", at(&way, 40.0), "40"),
        ("after 60 ms", at(&way, 60.0), "60"),
    ] {
        let Some(here) = here else { continue };
        let theirs = programs.iter().map(|program| {
            let value = match of {
                "lowest" => number(&program["lowest_mm"]),
                _ => number(&program["displacement_mm"][of]),
            };
            (words(&program["name"]), value)
        });
        let theirs: Vec<(&str, f64)> = theirs.collect();
        let off = theirs
            .iter()
            .map(|(_, value)| change(here / value - 1.0, 2));
        let off: Vec<String> = off.collect();
        let numbers = theirs.iter().map(|(name, value)| format!("{name} {value}"));
        rows.push(Row {
            case: format!("[ball into {spheres} spheres of 2 mm](../round-robin/README.md): displacement {what}, mm"),
            source: "Dosta et al. 2024, from the published bed".to_owned(),
            ours: format!("{here:.2}"),
            theirs: numbers.collect::<Vec<_>>().join("; "),
            error: off.join("; "),
            hardware: format!("one core, {}", words(&stored["processor"])),
            time: format!(
                "{:.0} s to {until_ms:.0} ms; to 100 ms {}",
                number(&stored["processor_s"]),
                times.join(", ")
            ),
        });
    }
    rows
}

fn words(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}
