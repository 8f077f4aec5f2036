//! `dem-run new`: a scene to start from, with a shape and its body.

mod shape;

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use dem_io::body::files::write_body;
use dem_io::safe_write::{explain, write_file};
use dem_io::text::visible;
use dem_io::{Diagnostic, Result};
use dem_pack::cli::Recipe;
use dem_scene::reference;
use dem_terminal::standard_output::write_standard_output;

use self::shape::{cuboid, cylinder, stl};
use super::new_folder::WholeFolder;

/// Name of the file of keys for editors, as in the first line of each scene.
const SCHEMA: &str = "scene.schema.json";

/// Name of the shape.
const SHAPE: &str = "shape.stl";

#[derive(Debug, Args)]
pub(super) struct NewArguments {
    /// What happens in the scene
    #[arg(value_name = "TYPE")]
    template: Template,
    /// The folder to make
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

/// The scenes to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Template {
    /// A tablet falls onto a plate
    Drop,
    /// Blocks ride a belt and hit a plate; they break where they hit
    Chute,
    /// A lump between two jaws, one of which moves
    Crusher,
    /// Four-point bending of a bar
    Bending,
    /// Compression of a cylinder between plates
    Compression,
}

impl Template {
    fn scene(self) -> &'static str {
        match self {
            Self::Drop => include_str!("new/drop.toml"),
            Self::Chute => include_str!("new/chute.toml"),
            Self::Crusher => include_str!("new/crusher.toml"),
            Self::Bending => include_str!("new/bending.toml"),
            Self::Compression => include_str!("new/compression.toml"),
        }
    }

    /// The facets of its shape, mm, and the diameters with which it is packed.
    fn shape(self) -> (Vec<[[f64; 3]; 3]>, &'static str) {
        match self {
            Self::Drop => (cylinder(15.0, 12.0), "2.4mm..3mm"),
            Self::Chute => (cuboid(60.0, 40.0, 25.0), "8mm..10mm"),
            Self::Crusher => (cylinder(30.0, 40.0), "7mm..9mm"),
            Self::Bending => (cuboid(180.0, 30.0, 35.0), "7mm..9mm"),
            Self::Compression => (cylinder(15.0, 60.0), "5mm..6mm"),
        }
    }
}

/// Makes the folder with `scene.toml`, `shape.stl`, `body.vtp` and the schema for editors, and
/// prints the next commands. Refuses a folder that exists.
pub(super) fn new(arguments: &NewArguments) -> Result<()> {
    let folder = &arguments.folder;
    if fs::symlink_metadata(folder).is_ok() {
        return Err(cannot(folder, &ErrorKind::AlreadyExists.into()));
    }
    let made = WholeFolder::beside(folder).map_err(|error| cannot(folder, &error))?;
    let file = |name: &str| made.path().join(name);
    let (facets, diameter) = arguments.template.shape();
    let shape = file(SHAPE);
    write_file(&shape, |out| out.write_all(stl(&facets).as_bytes()))?;
    let options = ["--diameter", diameter, "--overlap", "0.25"];
    // A name that begins with - is no option.
    let here = if shape.is_relative() {
        Path::new(".")
    } else {
        Path::new("")
    };
    let shape = here.join(shape).display().to_string();
    let recipe = std::iter::once(shape).chain(options.map(str::to_owned));
    let recipe = Recipe::parse(&recipe.collect::<Vec<String>>())?;
    let (mut body, _) = recipe.make(recipe.seed(), &|_, _| Ok(()))?;
    body.about.source = Some(here.join(folder).join(SHAPE).display().to_string());
    write_body(&body, &file("body.vtp"))?;
    for (name, text) in reference::files() {
        if name == SCHEMA {
            write_file(&file(name), |out| out.write_all(text.as_bytes()))?;
        }
    }
    let scene = file("scene.toml");
    let text = arguments.template.scene();
    write_file(&scene, |out| out.write_all(text.as_bytes()))?;
    made.publish()?;
    write_standard_output(|out| {
        let shown = folder.display().to_string();
        let shown = visible(&shown);
        writeln!(
            out,
            "made {shown}: scene.toml, shape.stl, body.vtp with {} particles and {} bonds, {SCHEMA}\n\
             next:\n  dem-run check {shown}/scene.toml\n  dem-run {shown}/scene.toml --output {shown}/results",
            body.radii.len(),
            body.bonds.len()
        )
    })
}

fn cannot(folder: &Path, error: &std::io::Error) -> Diagnostic {
    match error.kind() {
        ErrorKind::AlreadyExists => Diagnostic::input(
            folder.display().to_string(),
            "there is such a file or folder already, and nothing is overwritten",
            "name another folder",
        ),
        ErrorKind::NotFound => Diagnostic::input(
            folder.display().to_string(),
            "the folder that it would be in does not exist",
            "make it first, or name another folder",
        ),
        _ => explain(folder, error),
    }
}
