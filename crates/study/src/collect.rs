//! The outcomes of the processes of a sweep, from the files that they left.

use std::fs;
use std::path::Path;

use dem_results::folder::names::DISCHARGE;
use dem_results::{SievedPieces, Summary, discharged};
use dem_scene::study::{DischargeFigure, MeasureOf, RUN_RESULTS, Reference, RunTime, Study};

use super::curves::{curve, largest_n};
use super::jobs::Job;
use super::masses::masses_kg;
use super::outcome::{Done, Outcome, Reading};

/// Reads the results of a job.
pub fn outcome(study: &Study, job: Job, runs: &Path) -> Outcome {
    let summary = Summary::read(&job.folder(runs).join("summary.json"));
    let Some(summary) = summary.filter(|summary| summary.problem.is_none()) else {
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

fn done(study: &Study, summary: &Summary, results: &Path) -> Result<Done, String> {
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
        time_s: time_s(study.time, summary)?,
        steps: summary.steps,
        time_step_s: summary.time_step_s,
        machine: summary.machine.clone(),
        verdict: summary.verdict.clone(),
        report: None,
        readings,
    })
}

/// Time of the steps of a run, s.
fn time_s(time: RunTime, summary: &Summary) -> Result<f64, String> {
    match time {
        RunTime::Wall => Ok(summary.wall_s),
        RunTime::Processor => {
            (summary.processor_s).ok_or_else(|| "its summary has no processor_s".to_owned())
        }
    }
}

fn reading(summary: &Summary, results: &Path, of: &MeasureOf) -> Result<Reading, String> {
    let plain = |value: f64| Reading {
        value,
        unit: String::new(),
        closed_form: None,
        masses_kg: Vec::new(),
        curve: Vec::new(),
    };
    let found = match of {
        MeasureOf::Balance(key) => {
            return Ok(plain(match *key {
                "energy_error" => summary.energy_error,
                "momentum_error" => summary.momentum_error,
                _ => summary.angular_momentum_error,
            }));
        }
        MeasureOf::RunTime(time) => {
            return Ok(Reading {
                unit: "s".to_owned(),
                ..plain(time_s(*time, summary)?)
            });
        }
        MeasureOf::RunResult(name) => {
            let found = summary.run_result(name);
            let units = RUN_RESULTS.iter().find(|(known, _)| known == name);
            let (Some(value), Some((_, unit))) = (found, units) else {
                return Err(format!("its fragments have no {name}"));
            };
            return Ok(Reading {
                unit: (*unit).to_owned(),
                ..plain(value)
            });
        }
        MeasureOf::Discharge(figure, outlet) => {
            let value = discharge(summary, results, *figure, outlet.as_deref())?;
            return Ok(Reading {
                unit: figure.unit().to_owned(),
                ..plain(value)
            });
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
        MeasureOf::Measure(name) => {
            let found = summary.measures.iter().find(|one| one.name == *name);
            let found = found.map(|one| (one.value, &one.unit, one.reference));
            found.ok_or(name)
        }
        MeasureOf::Figure(name) => {
            let mut figures = summary.test.iter().flat_map(|test| &test.figures);
            let found = figures.find(|one| one.name == *name);
            let found = found.map(|one| (one.value, &one.unit, one.theory));
            found.ok_or(name)
        }
    };
    let (value, unit, closed_form) =
        found.map_err(|name| format!("nothing in its summary is called '{name}'"))?;
    Ok(Reading {
        unit: unit.clone(),
        closed_form,
        ..plain(value)
    })
}

/// A figure of what left through the outlet of this name, or through all of them.
fn discharge(
    summary: &Summary,
    results: &Path,
    figure: DischargeFigure,
    outlet: Option<&str>,
) -> Result<f64, String> {
    let csv = fs::read_to_string(results.join(DISCHARGE)).unwrap_or_default();
    let mut outlets = discharged(&csv).ok_or("it has no table of what left")?;
    let pieces = match outlet {
        Some(name) => outlets.remove(name).unwrap_or_default(),
        None => {
            let fines_kg = summary.population.as_ref().map_or(0.0, |p| p.fines_kg);
            let fines = (fines_kg > 0.0).then_some([0.0, fines_kg]);
            let all = outlets.into_values().flat_map(SievedPieces::into_pieces);
            SievedPieces::new(all.chain(fines).collect())
        }
    };
    let found = match figure {
        DischargeFigure::Mass => Some(pieces.mass_kg()),
        DischargeFigure::MassFlow => Some(pieces.mass_kg() / summary.simulated_s),
        DischargeFigure::MassOfLargest => pieces.largest_kg(),
        DischargeFigure::Size(fraction) => pieces.size_m(fraction),
        DischargeFigure::Passing(opening_m) => pieces.passing(opening_m),
    };
    let name = outlet.map_or_else(String::new, |name| format!(" '{name}'"));
    found.ok_or_else(|| format!("nothing left through an outlet{name}"))
}
