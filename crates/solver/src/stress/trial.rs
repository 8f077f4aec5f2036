//! A scene of the suite, run as a user would run it: from files in a folder.

use std::sync::atomic::AtomicBool;

use dem_io::body::write_body;
use dem_io::diagnostic::Kind;
use dem_io::safe_write::write_file;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::scene_from_text;
use dem_scene::{Scene, read_bodies};
use tempfile::TempDir;

use crate::output::summary::Summary;
use crate::plan::{Plan, plan};
use crate::run::{RunSettings, run};

/// A scene and the files that it names.
#[derive(Debug, Clone, Default)]
pub struct Trial {
    /// Its text.
    pub scene: String,
    /// Bodies, by the names of their files (`.vtp`).
    pub bodies: Vec<(&'static str, Body)>,
    /// Surfaces, by the names of their files (`.stl`): their text.
    pub surfaces: Vec<(&'static str, String)>,
    /// As `--force-step`: the scene's time step is taken even if it is above the largest stable
    /// one.
    pub force_step: bool,
}

/// How a run came to its end.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It did.
    Ended(Box<Summary>),
    /// It was refused before it started (exit code 2): what was said.
    Refused(String),
    /// It was stopped (exit code 3): what was said.
    Stopped(String),
}

impl Trial {
    /// Of a scene that names no files.
    pub fn of(scene: String) -> Self {
        Self {
            scene,
            ..Self::default()
        }
    }

    /// The scene, its plan, and the folder of its files, which goes with the last value.
    ///
    /// # Errors
    /// What reading and planning refuse; a folder that cannot be written.
    pub fn planned(&self) -> Result<(Scene, Plan, TempDir)> {
        let folder = tempfile::tempdir().map_err(|error| {
            let problem = format!("no folder for the files of the suite: {error}");
            Diagnostic::failed(std::env::temp_dir().display().to_string(), problem, "")
        })?;
        let file = |name: &str| folder.path().join(name);
        for (name, body) in &self.bodies {
            write_body(body, &file(name))?;
        }
        for (name, text) in &self.surfaces {
            write_file(&file(name), |out| out.write_all(text.as_bytes()))?;
        }
        let scene = scene_from_text(&self.scene, &file("scene.toml").display().to_string(), &[])?;
        let bodies = read_bodies(&scene)?;
        let threads = rayon::current_num_threads();
        let plan = plan(&scene, bodies, threads, self.force_step)?;
        Ok((scene, plan, folder))
    }

    /// Runs it to its end, if it has one.
    ///
    /// # Errors
    /// Interrupted, or a folder that cannot be written.
    pub fn run(&self, interrupted: &AtomicBool) -> Result<Outcome> {
        let ran = self.planned().and_then(|(scene, plan, folder)| {
            let settings = RunSettings {
                folder: None,
                resume: None,
                threads: rayon::current_num_threads(),
                interrupted,
                test: None,
            };
            let summary = run(plan, &scene, settings, &|_| {});
            drop(folder);
            summary
        });
        match ran {
            Ok(summary) => Ok(Outcome::Ended(Box::new(summary))),
            Err(error) => match error.kind {
                Kind::Input => Ok(Outcome::Refused(error.to_string())),
                Kind::Unstable => Ok(Outcome::Stopped(error.to_string())),
                Kind::Failed | Kind::Interrupted => Err(error),
            },
        }
    }
}
