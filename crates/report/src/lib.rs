//! The page of a run, `report.html`: verdict, results, a view in three dimensions, curves, what was
//! run, and where the time went. One file that needs no other and no network.
//!
//! [`picture`] draws its frames again from any side.
//!
//! The page is made from the folder of the results alone, so that it can be written again at any
//! time.

mod folder;
mod home;
mod load_cells;
pub mod picture;
mod sections;
mod view;
pub mod wall_loads;

use std::path::Path;

use dem_io::{Diagnostic, Result};
use dem_plots::Page;
use dem_results::{Summary, from_json};
use serde_json::Value;

use folder::Folder;
use sections::{
    add_curves, add_inputs, add_results, add_test, add_time, add_verdict, add_wall_loads,
};

/// The page of a finished run from its folder and its summary (the text of `summary.json`). Refuses
/// another summary, and missing or damaged frames.
pub fn report(folder: &Path, summary: &str) -> Result<String> {
    let (summary, scene) = read_summary(summary).map_err(|error| {
        Diagnostic::input(
            folder.join("summary.json").display().to_string(),
            format!("this is not the summary of a run: {error}"),
            "name the folder of a run that has ended",
        )
    })?;
    let mut page = Page::new(&title(&scene, folder, &summary));
    let folder = Folder::read(folder)?;
    add_verdict(&mut page, &summary);
    if let Some(view) = view::view(&folder.subject(&summary))? {
        page.heading("View");
        page.part(view);
    }
    if summary.has_results() {
        add_test(&mut page, &summary);
        add_results(&mut page, &summary, &folder);
        add_wall_loads(&mut page, &summary, &folder)?;
        add_curves(&mut page, &folder)?;
    }
    add_inputs(&mut page, &summary, &folder);
    // Another program does not say where its time went.
    if summary.has_results() && summary.engine.is_none() {
        add_time(&mut page, &summary);
    }
    Ok(page.html())
}

/// The summary with the names of files in place of their paths: a page that is shared does not name
/// the folders of a machine. With the path of the scene.
fn read_summary(text: &str) -> serde_json::Result<(Summary, String)> {
    let mut json: Value = serde_json::from_str(text)?;
    let summary: Summary = from_json(json.clone())?;
    let scene = summary.scene.clone();
    let bodies = summary.inputs.bodies.into_values();
    let walls = summary.inputs.walls.into_values();
    let mut paths: Vec<String> = (bodies.filter_map(|body| body.file))
        .chain(walls.map(|wall| wall.file))
        .collect();
    paths.push(summary.scene);
    paths.retain(|path| !path.is_empty());
    paths.sort_by_key(|path| std::cmp::Reverse(path.len()));
    shorten(&mut json, &paths);
    Ok((from_json(json)?, scene))
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

/// The name of the scene without folder and ending; of a `scene.toml` that of its folder.
fn title(scene: &str, results: &Path, summary: &Summary) -> String {
    let path = Path::new(scene);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let stem = match stem.as_ref() {
        "scene" => folder_of_scene(path, results).unwrap_or(stem.into_owned()),
        _ => stem.into_owned(),
    };
    match &summary.test {
        Some(test) => format!("{stem}: {}", test.kind.name().replace('-', " ")),
        None => stem,
    }
}

/// The name of the folder of a `scene.toml`. Named without a folder, the scene is beside its results
/// `scene-out`; results elsewhere have names of their own.
fn folder_of_scene(scene: &Path, results: &Path) -> Option<String> {
    let name = |path: &Path| Some(path.file_name()?.to_string_lossy().into_owned());
    scene.parent().and_then(name).or_else(|| {
        let results = results.canonicalize().ok()?;
        match results.ends_with("scene-out") {
            true => name(results.parent()?),
            false => name(&results),
        }
    })
}
