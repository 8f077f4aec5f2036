//! What was run.

use dem_io::text::counted;
use dem_io::units::show_quantity;
use dem_plots::{Column, Page, Table};
use serde_json::Value;

use super::values::{number, text, texts};
use crate::folder::Folder;

/// Scene, bodies, settings and files.
pub(crate) fn add_inputs(page: &mut Page, summary: &Value, folder: &Folder) {
    let inputs = &summary["inputs"];
    page.heading("Input");
    let mut said = text(&summary["scene"]).to_owned();
    // What another program computed has none.
    if !inputs["seed"].is_null() {
        said += &format!(", seed {}", inputs["seed"]);
    }
    said += &match text(&summary["machine"]) {
        "" => ".".to_owned(),
        machine => format!(", on {machine}."),
    };
    let set = texts(&inputs["set"]);
    if !set.is_empty() {
        said += &format!(" Set: {}.", set.join(", "));
    }
    page.paragraph(&said);
    add_bodies(page, summary);
    if let Some(scene) = folder.text("scene.toml") {
        page.details("The scene as it was run (scene.toml)", &scene);
    }
    let values = inputs["scene"].as_object().into_iter().flatten();
    let values = values.map(|(key, value)| format!("{key} = {}\n", text(value)));
    page.details("All values, defaults included", &values.collect::<String>());
}

fn add_bodies(page: &mut Page, summary: &Value) {
    let bodies = summary["inputs"]["bodies"].as_object();
    let Some(bodies) = bodies.filter(|bodies| !bodies.is_empty()) else {
        return;
    };
    let row = |(name, body): (&String, &Value)| {
        let mass = number(&summary["bodies"][name]["mass_kg"]);
        vec![
            name.clone(),
            text(&body["file"]).to_owned(),
            body["particles"].to_string(),
            body["bonds"].to_string(),
            if mass.is_finite() {
                show_quantity(mass, "kg")
            } else {
                String::new()
            },
            text(&body["hash"]).to_owned(),
        ]
        .into()
    };
    let columns = [
        Column::text("body"),
        Column::text("file"),
        Column::number("particles"),
        Column::number("bonds"),
        Column::number("mass"),
        Column::text("hash"),
    ];
    page.table(&Table {
        columns: columns.to_vec(),
        rows: bodies.iter().map(row).collect(),
    });
    let walls = summary["inputs"]["walls"]
        .as_object()
        .map_or(0, |walls| walls.len());
    if walls > 0 {
        page.small(&format!("{} from STL files.", counted(walls, "wall")));
    }
}
