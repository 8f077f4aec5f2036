//! `dem-run lab` for tests under pressure: a measured material for each pressure, and the failure
//! line through the strengths of all.

use std::path::{Path, PathBuf};

use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::units::show_quantity;
use dem_io::write_target::refuse_to_replace;
use dem_io::{Diagnostic, Result};
use dem_laboratory::{
    Dimensions, FailureLine, ListedSpecimen, MeasuredSpecimen, Series, Specimen, TestType,
    evaluate, material, page_of_series, write_material,
};
use dem_terminal::standard_output::{write_standard_json, write_standard_output};
use serde_json::json;

use super::summary::{doubts_of, print_series, summary};

/// What is written and printed.
pub(super) struct Output<'a> {
    /// File of the material; of several the pressure is in its name.
    pub(super) file: &'a Path,
    pub(super) page_file: &'a Path,
    pub(super) json: bool,
    pub(super) quiet: bool,
}

/// Evaluates the specimens of each pressure, writes their materials and a page for all, and prints
/// a summary. No valid specimen is an error, once the page is written.
pub(super) fn lab_under_pressure(
    test: TestType,
    dimensions: &Dimensions,
    specimens: Vec<(&ListedSpecimen, MeasuredSpecimen)>,
    output: &Output<'_>,
) -> Result<()> {
    let page_file = output.page_file;
    let series = series(test, dimensions, specimens)?;
    let files: Vec<PathBuf> = series
        .iter()
        .map(|one| file_of(output.file, &series, one))
        .collect();
    let mut inputs: Vec<PathBuf> = Vec::new();
    let names = series.iter().flat_map(|one| &one.evaluated);
    inputs.extend(names.map(|one| PathBuf::from(&one.measured.name)));
    refuse_to_replace(&files, &inputs)?;
    let line = line(test, &series);
    write_file(page_file, |out| {
        out.write_all(page_of_series(&series, line.as_ref()).as_bytes())
    })?;
    let mut written = Vec::new();
    for (one, file) in series.iter().zip(files) {
        if let Some(found) = &one.material {
            write_material(&file, found)?;
            written.push(file);
        }
    }
    if written.is_empty() {
        let all = series.iter().flat_map(|one| &one.evaluated);
        let doubts: Vec<String> = all.map(doubts_of).collect();
        let problem = format!("no specimen is valid: {}", doubts.join("; "));
        let remedy = format!("see {}", visible(&page_file.display().to_string()));
        return Err(Diagnostic::input("", problem, remedy));
    }
    written.push(page_file.to_owned());
    if output.json {
        let of = |one: &Series| Some(summary(one.material.as_ref()?, &one.evaluated));
        let all: Vec<serde_json::Value> = series.iter().filter_map(of).collect();
        return write_standard_json(&json!({ "series": all, "failure_line": line }));
    }
    if output.quiet {
        return Ok(());
    }
    write_standard_output(|out| {
        for one in &series {
            writeln!(
                out,
                "{:27}  {}",
                one.name(),
                show_quantity(one.pressure_pa(), "Pa")
            )?;
            print_series(out, one.material.as_ref(), &one.evaluated)?;
        }
        if let Some(line) = &line {
            writeln!(out, "failure line {}", line.note())?;
        }
        let all: Vec<String> = written
            .iter()
            .map(|path| path.display().to_string())
            .collect();
        writeln!(out, "written      {}", visible(&all.join(", ")))
    })
}

/// The specimens of each pressure, from the lowest on, evaluated.
fn series(
    test: TestType,
    dimensions: &Dimensions,
    specimens: Vec<(&ListedSpecimen, MeasuredSpecimen)>,
) -> Result<Vec<Series>> {
    let mut groups: Vec<(Dimensions, Vec<MeasuredSpecimen>)> = Vec::new();
    for (listed, measured) in specimens {
        let own = listed.dimensions.or(dimensions);
        let same = groups
            .iter_mut()
            .find(|(other, _)| other.pressure_pa() == own.pressure_pa());
        match same {
            Some((_, group)) => group.push(measured),
            None => groups.push((own, vec![measured])),
        }
    }
    let pressure_pa = |dimensions: &Dimensions| dimensions.pressure_pa().unwrap_or(0.0);
    groups.sort_by(|(a, _), (b, _)| pressure_pa(a).total_cmp(&pressure_pa(b)));
    let of = |(scaled_to, group): (Dimensions, Vec<MeasuredSpecimen>)| {
        let reference = Specimen::new(test, &scaled_to)?;
        let evaluated = evaluate(group);
        Ok(Series {
            material: material(test, &scaled_to, &reference, &evaluated),
            test,
            dimensions: scaled_to,
            reference,
            evaluated,
        })
    };
    groups.into_iter().map(of).collect()
}

/// The file of the material of a pressure, which is in its name if there are several.
fn file_of(file: &Path, all: &[Series], one: &Series) -> PathBuf {
    if all.len() == 1 {
        return file.to_owned();
    }
    let stem = file.file_stem().unwrap_or_default();
    let pressure = show_quantity(one.pressure_pa(), "Pa").replace(' ', "");
    file.with_file_name(format!("{}-{pressure}.json", stem.to_string_lossy()))
}

/// The line through the strengths of all valid specimens.
fn line(test: TestType, series: &[Series]) -> Option<FailureLine> {
    let points = series.iter().flat_map(|one| {
        let valid = one.evaluated.iter().filter(|own| own.doubts.is_empty());
        valid.map(|own| [one.pressure_pa(), own.strength_pa])
    });
    FailureLine::of_strengths(test, &points.collect::<Vec<_>>())
}
