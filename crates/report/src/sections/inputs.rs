//! What was run.

use dem_io::text::counted;
use dem_io::units::show_quantity;
use dem_plots::{Column, Page, Table};
use dem_results::Summary;
use dem_results::summary::InputBody;

use crate::folder::Folder;

/// Scene, bodies, settings and files.
pub(crate) fn add_inputs(page: &mut Page, summary: &Summary, folder: &Folder) {
    let inputs = &summary.inputs;
    page.heading("Input");
    let mut said = summary.scene.clone();
    // What another program computed has none.
    if summary.engine.is_none() {
        said += &format!(", seed {}", inputs.seed);
    }
    said += &match summary.machine.as_str() {
        "" => ".".to_owned(),
        machine => format!(", on {machine}."),
    };
    if !inputs.set.is_empty() {
        said += &format!(" Set: {}.", inputs.set.join(", "));
    }
    page.paragraph(&said);
    add_bodies(page, summary);
    if let Some(scene) = folder.text("scene.toml") {
        page.details("The scene as it was run (scene.toml)", &scene);
    }
    let values = inputs.scene.iter();
    let values = values.map(|(key, value)| format!("{key} = {value}\n"));
    let hashes = inputs.bodies.iter();
    let hashes = hashes.map(|(name, body)| format!("hash of the body {name}: {}\n", body.hash));
    let all: String = values.chain(hashes).collect();
    page.details("All values, defaults included", &all);
}

fn add_bodies(page: &mut Page, summary: &Summary) {
    let bodies = &summary.inputs.bodies;
    if bodies.is_empty() {
        return;
    }
    let row = |(name, body): (&String, &InputBody)| {
        let mass_kg = summary.bodies.get(name).map(|mass| mass.mass_kg);
        let mass_kg = mass_kg.filter(|mass_kg| mass_kg.is_finite());
        vec![
            name.clone(),
            body.file.clone().unwrap_or_default(),
            body.particles.to_string(),
            body.bonds.to_string(),
            mass_kg.map_or(String::new(), |mass_kg| show_quantity(mass_kg, "kg")),
        ]
        .into()
    };
    let columns = [
        Column::text("body"),
        Column::text("file"),
        Column::number("particles"),
        Column::number("bonds"),
        Column::number("mass"),
    ];
    page.table(&Table {
        columns: columns.to_vec(),
        rows: bodies.iter().map(row).collect(),
    });
    let walls = summary.inputs.walls.len();
    if walls > 0 {
        page.small(&format!(
            "{} from files of triangles.",
            counted(walls, "wall")
        ));
    }
}
