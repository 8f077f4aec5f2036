//! The outcomes of the processes of a sweep, from the files that they left.

use std::fs;
use std::path::Path;

use dem_scene::study::{MeasureOf, Reference, RunTime, Study};
use serde_json::Value;

use super::curves::{curve, largest_n};
use super::jobs::Job;
use super::masses::masses_kg;
use super::outcome::{Done, Outcome, Reading};

/// Reads the results of a job.
pub fn outcome(study: &Study, job: Job, runs: &Path) -> Outcome {
    let summary = fs::read(job.folder(runs).join("summary.json"));
    let summary = summary
        .ok()
        .and_then(|bytes| serde_json::from_slice(&bytes).ok())
        .filter(|summary: &Value| summary["problem"].is_null());
    let Some(summary) = summary else {
        let said = fs::read_to_string(job.complaint(runs)).unwrap_or_default();
        let last = said.lines().rev().find(|line| !line.trim().is_empty());
        return last.map_or(Outcome::Missing, |line| {
            Outcome::Failed(line.strip_prefix("error: ").unwrap_or(line).to_owned())
        });
    };
    let done = done(study, &summary, &job.folder(runs)).map(|done| Done {
        report: report(job, runs),
        ..done
    });
    done.map_or_else(Outcome::Failed, Outcome::Done)
}

/// The page of a job, relative to the folder of the sweep, in which `runs` is.
fn report(job: Job, runs: &Path) -> Option<String> {
    let page = job.folder(runs).join("report.html");
    let within = page.strip_prefix(runs.parent()?).ok()?;
    let parts = within.iter().map(|part| part.to_str());
    let parts: Vec<&str> = parts.collect::<Option<_>>()?;
    page.is_file().then(|| parts.join("/"))
}

fn done(study: &Study, summary: &Value, results: &Path) -> Result<Done, String> {
    let number = |key: &str| {
        let value = summary[key].as_f64();
        value.ok_or_else(|| format!("its summary has no {key}"))
    };
    let mut readings = Vec::new();
    for measure in &study.measures {
        let mut read = reading(summary, results, &measure.of)?;
        if !read.value.is_finite() {
            return Err(format!("the measure '{}' is not a number", measure.name));
        }
        if let (MeasureOf::Figure(name), Reference::ClosedForm, None) =
            (&measure.of, &measure.reference, read.closed_form)
        {
            return Err(format!(
                "the scene has no values for the theory of '{name}'"
            ));
        }
        if let MeasureOf::Balance(_) = measure.of {
            read.closed_form = Some(0.0);
        }
        readings.push(read);
    }
    Ok(Done {
        time_s: number(match study.time {
            RunTime::Wall => "wall_s",
            RunTime::Processor => "processor_s",
        })?,
        steps: number("steps")? as u64,
        time_step_s: number("time_step_s")?,
        machine: summary["machine"].as_str().unwrap_or_default().to_owned(),
        doubts: doubts(summary),
        report: None,
        readings,
    })
}

/// The warnings of a doubtful run.
fn doubts(summary: &Value) -> Vec<String> {
    let warnings = summary["verdict"]["warnings"].as_array();
    let warnings = warnings.into_iter().flatten().filter_map(Value::as_str);
    warnings.map(str::to_owned).collect()
}

/// A value that is not a number is null in JSON.
fn reading(summary: &Value, results: &Path, of: &MeasureOf) -> Result<Reading, String> {
    let plain = |value: f64| Reading {
        value,
        unit: String::new(),
        closed_form: None,
        masses_kg: Vec::new(),
        curve: Vec::new(),
    };
    let (entry, name, reference) = match of {
        MeasureOf::Balance(key) => {
            let value = summary[*key].as_f64().unwrap_or(f64::NAN);
            return Ok(plain(value));
        }
        MeasureOf::Masses(pieces) => {
            let masses_kg = masses_kg(*pieces, results)?;
            let count = masses_kg.len() as f64;
            return Ok(Reading {
                masses_kg,
                ..plain(count)
            });
        }
        MeasureOf::Curve => {
            let curve = curve(results)?;
            let largest_n = largest_n(&curve);
            return Ok(Reading {
                unit: "N".to_owned(),
                curve,
                ..plain(largest_n)
            });
        }
        MeasureOf::Measure(name) => (summary["measures"].get(name), name, "reference"),
        MeasureOf::Figure(name) => {
            let figures = summary["test"]["results"].as_array();
            let mut figures = figures.into_iter().flatten();
            let found = figures.find(|entry| entry["name"].as_str() == Some(name));
            (found, name, "theory")
        }
    };
    let entry = entry.ok_or_else(|| format!("nothing in its summary is called '{name}'"))?;
    Ok(Reading {
        unit: entry["unit"].as_str().unwrap_or_default().to_owned(),
        closed_form: entry[reference].as_f64(),
        ..plain(entry["value"].as_f64().unwrap_or(f64::NAN))
    })
}
