//! Packings of the body under test: made from a shape, or read from files.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use dem_io::body::files::body_files;
use dem_io::body::read_body;
use dem_io::hash::file_hash;
use dem_io::{Body, Diagnostic, Result};
use dem_pack::cli::Recipe;
use dem_scene::{BodySource, Scene, read_bodies};

use super::scene_arguments::named_body;

/// Packings of one body of a scene.
pub(super) struct Packings {
    /// Name of the body.
    pub(super) body: String,
    /// Number of packings of each recipe.
    pub(super) count: usize,
    /// The shape with each size of spheres; none: the packings are files.
    recipes: Vec<Recipe>,
    /// Files of the packings.
    files: Vec<PathBuf>,
    /// The body whose particles are in the scene: the only packing.
    inline: Option<Body>,
    /// Files of other bodies, by name.
    other_files: BTreeMap<String, PathBuf>,
}

impl Packings {
    /// The packings of the tested or only body of a scene; `named`: texts `[NAME=]FILE` of
    /// `--body`, several for that body.
    ///
    /// # Errors
    /// No such body; files as well as a shape; several files for another body; standard input.
    pub(super) fn of(recipes: Vec<Recipe>, named: &[String], scene: &Scene) -> Result<Self> {
        let body = match (&scene.test, scene.bodies.keys().next()) {
            (Some(test), _) => test.body.clone(),
            (None, Some(only)) if scene.bodies.len() == 1 => only.clone(),
            _ => {
                let problem = "the scene has several bodies and no [test] that names one";
                let remedy = "calibrate with a scene of one body, or add [test]";
                return Err(Diagnostic::input(&scene.source, problem, remedy));
            }
        };
        let mut packings = Self {
            body,
            count: 0,
            recipes,
            files: Vec::new(),
            inline: None,
            other_files: BTreeMap::new(),
        };
        for text in named {
            packings.add(text, scene)?;
        }
        if !packings.recipes.is_empty() && !packings.files.is_empty() {
            let remedy = "name either files, or a shape after --";
            return Err(Diagnostic::input(
                "--body",
                "the body is packed anew",
                remedy,
            ));
        }
        if let Some((file, other)) = same_files(&packings.files) {
            return Err(Diagnostic::input(
                format!("--body {}", file.display()),
                format!("it is the same packing as {}", other.display()),
                "name each packing once: twice the same one would count as scatter",
            ));
        }
        if packings.recipes.is_empty() && packings.files.is_empty() {
            packings.take_own(scene)?;
        }
        if packings.files.iter().any(|file| file.as_os_str() == "-") {
            let remedy = "write the body to a file";
            return Err(Diagnostic::input(
                "--body",
                "standard input is read once",
                remedy,
            ));
        }
        Ok(packings)
    }

    /// The only packing is the body of the scene.
    fn take_own(&mut self, scene: &Scene) -> Result<()> {
        match scene.bodies.get(&self.body).map(|body| &body.source) {
            Some(BodySource::File(path)) => self.files.push(path.clone()),
            Some(BodySource::Inline { particles, bonds }) => {
                let within = |error: Diagnostic| {
                    error.within(&format!("{}: [bodies.{}]", scene.source, self.body))
                };
                self.inline = Some(Body::from_spheres(particles, bonds).map_err(within)?);
            }
            None => {}
        }
        Ok(())
    }

    fn add(&mut self, text: &str, scene: &Scene) -> Result<()> {
        let (name, file) = named_body(scene, text, Some(&self.body))?;
        if name == self.body {
            self.files.push(file);
        } else if self.other_files.insert(name.clone(), file).is_some() {
            let problem = format!(
                "the body '{name}' has a file already, and only '{}' has packings",
                self.body
            );
            return Err(Diagnostic::input(
                format!("--body {text}"),
                problem,
                "name one file for it",
            ));
        }
        Ok(())
    }

    /// All bodies of the scene but that with the packings.
    pub(super) fn other_bodies(&self, scene: &Scene) -> Result<BTreeMap<String, Body>> {
        let mut scene = scene.clone();
        scene.bodies.remove(&self.body);
        for (name, file) in &self.other_files {
            if let Some(entry) = scene.bodies.get_mut(name) {
                entry.source = BodySource::File(file.clone());
            }
        }
        read_bodies(&scene)
    }

    /// Packing `at` of the size `case`. `interrupted` ends it (exit code 130).
    pub(super) fn make(&self, case: usize, at: usize, interrupted: &AtomicBool) -> Result<Body> {
        let go_on = |_: &str, _: f64| match interrupted.load(Ordering::Relaxed) {
            true => Err(Diagnostic::interrupted("interrupted", "start it again")),
            false => Ok(()),
        };
        match (self.recipes.get(case), self.files.get(at)) {
            (Some(recipe), _) => {
                let seed = recipe.seed().wrapping_add(at as u64);
                recipe.make(seed, &go_on).map(|(body, _)| body)
            }
            (None, Some(file)) => read_body(file),
            // Neither a shape nor files: the scene has the particles.
            (None, None) => Ok(self.inline.clone().unwrap_or_default()),
        }
    }

    /// Names of the packings of a size.
    pub(super) fn names(&self) -> Vec<String> {
        match self.recipes.first() {
            Some(recipe) => (0..self.count as u64)
                .map(|at| format!("seed {}", recipe.seed().wrapping_add(at)))
                .collect(),
            None if self.inline.is_some() => vec!["of the scene".to_owned()],
            None => self
                .files
                .iter()
                .map(|file| file.display().to_string())
                .collect(),
        }
    }

    /// Names of the sizes; one empty name without sizes.
    pub(super) fn case_names(&self) -> Vec<String> {
        if self.recipes.len() < 2 {
            return vec![String::new()];
        }
        let names = self
            .recipes
            .iter()
            .map(|recipe| recipe.diameter().to_owned());
        names.collect()
    }

    /// Files that are read.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let bodies = self.files.iter().chain(self.other_files.values());
        let mut files: Vec<PathBuf> = bodies
            .flat_map(|file| body_files(file).unwrap_or_default())
            .collect();
        files.extend(self.recipes.iter().flat_map(Recipe::files));
        files
    }
}

/// The first file whose content another one before it has, and that one.
fn same_files(files: &[PathBuf]) -> Option<(&PathBuf, &PathBuf)> {
    let hashes: Vec<Option<u64>> = files.iter().map(|file| file_hash(file)).collect();
    let twice = |at: &usize| {
        let before = (0..*at).find(|other| hashes[*at].is_some() && hashes[*other] == hashes[*at]);
        before.map(|other| (&files[*at], &files[other]))
    };
    (0..files.len()).find_map(|at| twice(&at))
}

/// Spheres across the thinnest part of a body, as its file says, or across its box.
pub(super) fn spheres_across(body: &Body) -> f64 {
    let of_box = || smallest_extent_m(body) / body.mean_diameter_m();
    body.about.particles_across.unwrap_or_else(of_box)
}

/// Smallest extent of a body, m.
fn smallest_extent_m(body: &Body) -> f64 {
    let extent = |k: usize| {
        let ends = body.positions.iter().zip(&body.radii);
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (p, r)| {
            (low.min(p[k] - r), high.max(p[k] + r))
        });
        high - low
    };
    (0..3).map(extent).fold(f64::INFINITY, f64::min)
}
