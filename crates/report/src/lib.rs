//! The page of a run, `report.html`: verdict, results, a view in three dimensions, curves, what was
//! run, and where the time went. One file that needs no other and no network.
//!
//! [`picture`] draws its frames again from any side.
//!
//! The page is made from the folder of the results alone, so that it can be written again at any
//! time.

mod folder;
mod home;
pub mod picture;
mod sections;
mod view;

use std::path::Path;

use dem_io::{Diagnostic, Result};
use dem_plots::Page;
use serde_json::Value;

use folder::Folder;
use sections::{add_curves, add_inputs, add_results, add_test, add_time, add_verdict};

/// The page of a finished run from its folder and its summary (the text of `summary.json`).
///
/// # Errors
/// The summary is not that of a run; a frame is missing or damaged (both exit code 2).
pub fn report(folder: &Path, summary: &str) -> Result<String> {
    let summary: Value = serde_json::from_str(summary).map_err(|error| {
        Diagnostic::input(
            folder.join("summary.json").display().to_string(),
            format!("this is not the summary of a run: {error}"),
            "name the folder of a run that has ended",
        )
    })?;
    let summary = without_folders(summary);
    let folder = Folder::read(folder)?;
    let mut page = Page::new(&title(&summary));
    add_verdict(&mut page, &summary);
    if let Some(view) = view::view(&folder.subject(&summary))? {
        page.heading("View");
        page.part(view);
    }
    // A run that failed at its start has no results.
    let has_results = summary["steps"].is_number();
    if has_results {
        add_test(&mut page, &summary);
        add_results(&mut page, &summary, &folder);
        add_curves(&mut page, &folder)?;
    }
    add_inputs(&mut page, &summary, &folder);
    if has_results {
        add_time(&mut page, &summary);
    }
    Ok(page.html())
}

/// The summary with the names of files in place of their paths: a page that is shared does not name
/// the folders of a machine.
fn without_folders(mut summary: Value) -> Value {
    let mut paths: Vec<String> = [&summary["inputs"]["bodies"], &summary["inputs"]["walls"]]
        .into_iter()
        .filter_map(Value::as_object)
        .flat_map(|all| all.values())
        .filter_map(|input| input["file"].as_str().map(str::to_owned))
        .collect();
    paths.extend(summary["scene"].as_str().map(str::to_owned));
    paths.sort_by_key(|path| std::cmp::Reverse(path.len()));
    shorten(&mut summary, &paths);
    summary
}

/// Replaces these paths by their last parts in all texts.
fn shorten(value: &mut Value, paths: &[String]) {
    match value {
        Value::String(text) => {
            for path in paths {
                if text.contains(path.as_str()) {
                    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
                    *text = text.replace(path.as_str(), name);
                }
            }
        }
        Value::Array(all) => all.iter_mut().for_each(|value| shorten(value, paths)),
        Value::Object(all) => all.values_mut().for_each(|value| shorten(value, paths)),
        _ => {}
    }
}

/// The name of the scene without folder and ending.
fn title(summary: &Value) -> String {
    let scene = summary["scene"].as_str().unwrap_or_default();
    let stem = Path::new(scene).file_stem().unwrap_or_default();
    match &summary["test"]["type"] {
        Value::String(test) => format!("{}: {}", stem.to_string_lossy(), test.replace('-', " ")),
        _ => stem.to_string_lossy().into_owned(),
    }
}
