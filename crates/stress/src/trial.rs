//! A scene of the suite, run like a user's scene: from files in a folder.

use std::sync::atomic::AtomicBool;

use dem_io::body::write_body;
use dem_io::diagnostic::Kind;
use dem_io::safe_write::write_file;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::scene_from_text;
use dem_scene::{Scene, read_bodies};
use tempfile::TempDir;

use dem_plan::Plan;
use dem_results::Summary;
use dem_rig::arrange::{TestedBody, arrange};
use dem_rig::plan_with_test;
use dem_runner::{RunSettings, run};

/// A scene and its files.
#[derive(Debug, Clone, Default)]
pub struct Trial {
    /// Its text.
    pub scene: String,
    /// Bodies, by the names of their files (`.vtp`).
    pub bodies: Vec<(&'static str, Body)>,
    /// Surfaces, by the names of their files (`.stl`): their text.
    pub surfaces: Vec<(&'static str, String)>,
    /// Like `--force-step`: accepts a time step of the scene above the largest stable one.
    pub force_step: bool,
}

/// Outcome of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It ended.
    Ended(Box<Summary>),
    /// It was refused before it started (exit code 2): the message.
    Refused(String),
    /// It was stopped (exit code 3): the message.
    Stopped(String),
}

impl Trial {
    /// For a scene without files.
    pub fn of(scene: String) -> Self {
        Self {
            scene,
            ..Self::default()
        }
    }

    /// The scene, its plan, and the folder of its files, which is removed with the last value.
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
        // Bars and weights need nothing of the body, and no case has another test.
        let body = TestedBody {
            lowest_frequency_hz: 1.0,
            extent_m: [[0.0; 2]; 3],
        };
        let scene = arrange(&scene, &body, 1.0)?;
        let bodies = read_bodies(&scene)?;
        let threads = rayon::current_num_threads();
        let (plan, _) = plan_with_test(&scene, bodies, threads, self.force_step)?;
        Ok((scene, plan, folder))
    }

    /// Runs it to its end, if it has one.
    pub fn run(&self, interrupted: &AtomicBool) -> Result<Outcome> {
        let ran = self.planned().and_then(|(scene, plan, folder)| {
            let settings = RunSettings {
                folder: None,
                resume: None,
                threads: rayon::current_num_threads(),
                interrupted,
                test: None,
                setup: None,
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
