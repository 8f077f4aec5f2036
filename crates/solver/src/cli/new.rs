//! `dem-run new`: a scene to start from, with a shape and its body.

mod answers;
mod arguments;
mod fill;
mod questions;
mod shape;
mod spheres;
mod surfaces;
mod templates;

use std::fs;
use std::path::Path;

use dem_io::body::files::write_body;
use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::whole_folder::WholeFolder;
use dem_io::{Body, Diagnostic, Result};
use dem_pack::{Basis, Sizes};
use dem_scene::reference;
use dem_study::jobs::shell_word;
use dem_terminal::standard_output::write_standard_output;

use self::answers::{Answers, answers};
pub(super) use self::arguments::NewArguments;
use self::fill::filled;
use self::shape::stl;

/// Name of the file of keys for editors, as in the first line of each scene.
const SCHEMA: &str = "scene.schema.json";

/// Makes the folder with `scene.toml`, `shape.stl`, `body.vtp` and the schema for editors, and
/// prints the next commands. Refuses a folder that exists.
pub(super) fn new(arguments: &NewArguments) -> Result<()> {
    let folder = &arguments.folder;
    if fs::symlink_metadata(folder).is_ok() {
        return Err(exists_already(folder));
    }
    let diameter = arguments.diameter.as_deref();
    let diameter = diameter.map(|text| Sizes::parse(text, Basis::Number));
    let diameter = diameter
        .transpose()
        .map_err(|error| error.within("--diameter"))?;
    let answers = answers(arguments)?;
    let (body, remark) = match arguments.template.is_ball() {
        true => (None, None),
        false => {
            let (body, remark) = packed(arguments, &answers, diameter.as_ref())?;
            (Some(body), remark)
        }
    };
    let surfaces = write_folder(arguments, &answers, body.as_ref())?;
    let of_body = body.map_or(String::new(), |body| {
        let (spheres, bonds) = (body.radii.len(), body.bonds.len());
        format!("shape.stl, body.vtp with {spheres} particles and {bonds} bonds, ")
    });
    write_standard_output(|out| {
        let shown = folder.display().to_string();
        let shown = visible(&shown);
        writeln!(out, "made {shown}: scene.toml, {of_body}{surfaces}{SCHEMA}")?;
        if let Some(remark) = remark {
            writeln!(out, "note: {remark}")?;
        }
        let scene = shell_word(&format!("{shown}/scene.toml"));
        let results = shell_word(&format!("{shown}/results"));
        writeln!(
            out,
            "next:\n  dem-run check {scene}\n  dem-run {scene} --output {results}"
        )
    })
}

/// The shape packed with spheres, and a remark where it is coarser than it should be.
fn packed(
    arguments: &NewArguments,
    answers: &Answers,
    diameter: Option<&Sizes>,
) -> Result<(Body, Option<String>)> {
    let fineness = arguments.template.fineness();
    let (mut body, remark) = spheres::packed(&answers.surface, fineness, diameter)?;
    let source = Path::new(".").join(&arguments.folder).join("shape.stl");
    body.about.source = Some(source.display().to_string());
    if fineness.is_rigid {
        // Neither bonds nor few spheres across matter to a clump.
        body.bonds.clear();
        body.bond_radii.clear();
        body.bond_lengths.clear();
        body.about.warnings.clear();
    }
    Ok((body, remark))
}

/// Writes the files. Returns the names of the surfaces of walls, each with a comma.
fn write_folder(
    arguments: &NewArguments,
    answers: &Answers,
    body: Option<&Body>,
) -> Result<String> {
    let folder = &arguments.folder;
    let template = arguments.template;
    let made = WholeFolder::beside(folder, "FOLDER")?;
    let write = |name: &str, text: &str| {
        write_file(&made.path().join(name), |out| {
            out.write_all(text.as_bytes())
        })
    };
    if let Some(body) = body {
        write("shape.stl", &stl(&answers.facets))?;
        write_body(body, &made.path().join("body.vtp"))?;
    }
    let surfaces = template.surfaces(&answers.body, answers.situation_si);
    for (name, facets) in &surfaces {
        write(name, &stl(facets))?;
    }
    for (name, text) in reference::files() {
        if name == SCHEMA {
            write(name, &text)?;
        }
    }
    let values = template.values(&answers.body, answers.situation_si);
    let scene = filled(template.text(), &answers.weight, &values);
    write("scene.toml", &scene)?;
    made.publish()?;
    let names = surfaces.iter().map(|(name, _)| format!("{name}, "));
    Ok(names.collect())
}

fn exists_already(folder: &Path) -> Diagnostic {
    Diagnostic::input(
        folder.display().to_string(),
        "there is such a file or folder already, and nothing is overwritten",
        "name another folder",
    )
}
