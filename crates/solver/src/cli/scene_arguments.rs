//! Arguments of commands that take a scene, and the scene that they name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::{BodySource, Places, Scene, include_text, read_bodies, read_scene};

#[derive(Debug, Args)]
pub(super) struct SceneArguments {
    /// The scene (.toml); or a body (.vtp, .data, .csv, .txt) to describe
    #[arg(value_name = "SCENE", required_unless_present = "body")]
    pub(super) file: Option<PathBuf>,
    /// File of a body, instead of the scene's; - is a .vtp on standard input. NAME= may be left
    /// out if there is only one body
    #[arg(long, value_name = "[NAME=]FILE")]
    pub(super) body: Vec<String>,
    /// File of materials, contacts and bonds, as dem-run calibrate writes it: its keys stand above
    /// those of the scene
    #[arg(long, value_name = "FILE")]
    pub(super) material: Vec<PathBuf>,
    /// Set a value of the scene, such as run.end_time=0.5 or "bonds.bar.young_modulus=20 MPa"
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(super) overrides: Vec<String>,
    /// Accept a time step of the scene above the largest stable one
    #[arg(long)]
    pub(super) force_step: bool,
    /// Number of threads; all cores unless given. The results are the same for any number
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,
    /// Print the result as JSON
    #[arg(long)]
    pub(super) json: bool,
}

impl SceneArguments {
    /// Human-readable name of the input.
    pub(super) fn place(&self) -> String {
        let named = self.file.as_ref().map(|path| path.display().to_string());
        named.unwrap_or_else(|| "--body without a scene".to_owned())
    }

    pub(super) fn names_a_scene(&self) -> bool {
        let is_scene = |path: &PathBuf| path.extension().is_some_and(|e| e == "toml");
        self.file.as_ref().is_some_and(is_scene)
    }

    /// The `--set` values, and `--material` as one.
    pub(super) fn all_overrides(&self) -> Vec<String> {
        let mut overrides = self.overrides.clone();
        if !self.material.is_empty() {
            let names = self.material.iter().map(|path| path.display().to_string());
            overrides.push(include_text(&names.collect::<Vec<String>>()));
        }
        overrides
    }

    /// The error with the `--set` whose key it is about, if it names none.
    pub(super) fn naming_set(&self, error: Diagnostic) -> Diagnostic {
        let about = |text: &&String| {
            let key = text.split_once('=').map(|(key, _)| key.trim());
            key.is_some_and(|key| error.place.ends_with(key))
        };
        match self.overrides.iter().rfind(about) {
            Some(text) if !error.place.starts_with("--") => error.within(&format!("--set {text}")),
            _ => error,
        }
    }

    /// The places of the keys of the scene.
    pub(super) fn places(&self) -> Result<Places> {
        let file = self.file.as_deref().unwrap_or(Path::new(""));
        Places::read(file, &self.all_overrides())
    }

    /// The scene and all its bodies.
    pub(super) fn read(&self) -> Result<(Scene, BTreeMap<String, Body>)> {
        let file = self.file.as_deref().unwrap_or(Path::new(""));
        let mut scene = read_scene(file, &self.all_overrides())?;
        let mut named: BTreeMap<String, &str> = BTreeMap::new();
        for option in &self.body {
            let name = set_body(&mut scene, option)?;
            if let Some(other) = named.insert(name.clone(), option) {
                return Err(Diagnostic::input(
                    format!("--body {option}"),
                    format!("the body '{name}' has its file from --body {other} already"),
                    "name one file for each body",
                ));
            }
        }
        refuse_two_pipes(&scene)?;
        let bodies = read_bodies(&scene)?;
        Ok((scene, bodies))
    }
}

/// Sets a body's file from an option `[NAME=]FILE`. Returns the body's name.
fn set_body(scene: &mut Scene, option: &str) -> Result<String> {
    let declared = scene.declared_bodies();
    let only = (declared.len() == 1).then(|| declared.first().copied());
    let (name, file) = named_body(scene, option, only.flatten())?;
    scene.set_body_file(&name, &file);
    Ok(name)
}

/// Body and file of an option `[NAME=]FILE`; `usual`: the body that is meant without a name.
pub(super) fn named_body(
    scene: &Scene,
    option: &str,
    usual: Option<&str>,
) -> Result<(String, PathBuf)> {
    let (name, file) = match option.split_once('=') {
        Some((name, file)) => (Some(name), file),
        None => (usual, option),
    };
    let place = || format!("--body {option}");
    let names: Vec<&str> = scene.declared_bodies().into_iter().collect();
    let (problem, remedy) = match name {
        _ if file.is_empty() => (
            "no file is named".to_owned(),
            "write --body FILE, or --body NAME=FILE".to_owned(),
        ),
        Some(name) if names.contains(&name) => {
            return Ok((name.to_owned(), PathBuf::from(file)));
        }
        Some(name) => (
            format!("the scene has no body '{name}'"),
            format!("use one of {}", names.join(", ")),
        ),
        None => (
            format!("the scene has {} bodies", names.len()),
            format!(
                "say which: --body NAME={file} with one of {}",
                names.join(", ")
            ),
        ),
    };
    Err(Diagnostic::input(place(), problem, remedy))
}

fn refuse_two_pipes(scene: &Scene) -> Result<()> {
    let is_piped =
        |source: &BodySource| matches!(source, BodySource::File(path) if path == Path::new("-"));
    let mut piped = scene
        .bodies
        .iter()
        .filter(|(_, entry)| is_piped(&entry.source));
    if let (Some(_), Some((name, _))) = (piped.next(), piped.next()) {
        return Err(Diagnostic::input(
            format!("{}: [bodies.{name}]", scene.source),
            "standard input can be read for one body only",
            "write the others to files",
        ));
    }
    Ok(())
}
