//! A checkpoint: the changing part of a state as it is, and the progress of the output. Scene and
//! bodies are read again when a run is resumed.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use dem_io::body::files::body_files;
use dem_io::hash::Fnv1a;
use dem_io::{Diagnostic, Result};
use serde::{Deserialize, Serialize};

use super::progress::Progress;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_physics::lanes::instructions;
use dem_plan::measure;

/// A run between two steps.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Snapshot<'a> {
    /// The scene, as written by [`dem_scene::Scene::describe`].
    scene: String,
    /// See [`fingerprint`].
    fingerprint: u64,
    /// Vector instructions of the processor that it ran on.
    instructions: String,
    /// The state, without its model and without what can be rebuilt.
    state: Cow<'a, State>,
    /// Particles and bonds of each body.
    bodies: Cow<'a, [PlacedBody]>,
    /// Histories of the probes.
    pub measures: Vec<measure::History>,
    /// Progress of the output.
    pub progress: Progress,
}

impl<'a> Snapshot<'a> {
    /// From a run between two steps.
    pub fn taken(
        state: &'a State,
        bodies: &'a [PlacedBody],
        scene: String,
        fingerprint: u64,
        measures: Vec<measure::History>,
        progress: Progress,
    ) -> Self {
        Self {
            scene,
            fingerprint,
            instructions: instructions().to_owned(),
            state: Cow::Borrowed(state),
            bodies: Cow::Borrowed(bodies),
            measures,
            progress,
        }
    }
    /// The files of bodies, walls and regions named in its scene.
    pub fn files_of_scene(&self) -> Vec<PathBuf> {
        let of_line = |line: &str| {
            let (key, file) = line.split_once(' ')?;
            let is_file = ["bodies.", "walls.", "regions."]
                .iter()
                .any(|kind| key.starts_with(kind))
                && [".file", ".stl"].iter().any(|name| key.ends_with(name));
            is_file.then(|| PathBuf::from(file.trim_start()))
        };
        let files = self.scene.lines().filter_map(of_line);
        files
            .flat_map(|file| body_files(&file).unwrap_or(vec![file]))
            .collect()
    }

    /// As bytes.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        postcard::to_stdvec(self).map_err(|error| fault(&error))
    }

    /// From the bytes of a checkpoint.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        postcard::from_bytes(bytes).map_err(|error| {
            Diagnostic::input(
                "",
                format!("this checkpoint does not hold a run of this program: {error}"),
                "start the run again, without --resume",
            )
        })
    }

    /// Checks that a scene is the one of the run, except for settings that may change: end time,
    /// values of measures that end it, time step, output, and paths of the files of its bodies.
    pub(crate) fn check_scene(&self, scene: &str) -> Result<()> {
        let may_change = |key: &str| {
            const RUN: [&str; 5] = [
                "run.end_time",
                "run.rest_energy_ratio",
                "run.time_step",
                "run.safety_factor",
                "run.impact_accuracy",
            ];
            RUN.contains(&key)
                || key.starts_with("output")
                || key.ends_with(".file")
                || key.ends_with(".end_run_above")
        };
        let values = |text: &str| -> BTreeMap<String, String> {
            text.lines()
                .filter_map(|line| line.split_once(' '))
                .map(|(key, value)| (key.to_owned(), value.trim().to_owned()))
                .filter(|(key, _)| !may_change(key))
                .collect()
        };
        let (before, now) = (values(&self.scene), values(scene));
        let keys: BTreeSet<&String> = before.keys().chain(now.keys()).collect();
        let said = |value: Option<&String>| value.map_or("not there".to_owned(), String::clone);
        let changed: Vec<String> = keys
            .into_iter()
            .filter(|&key| before.get(key) != now.get(key))
            .map(|key| {
                let (before, now) = (said(before.get(key)), said(now.get(key)));
                format!("{key} was {before} and is {now}")
            })
            .collect();
        if changed.is_empty() {
            return Ok(());
        }
        let more = match changed.len() {
            0..=3 => String::new(),
            count => format!("; and {} more", count - 3),
        };
        Err(Diagnostic::input(
            "",
            format!(
                "the scene is not that of the run: {}{more}",
                changed[..changed.len().min(3)].join("; ")
            ),
            "put it back, or start again without --resume; end_time, rest_energy_ratio, time_step, safety_factor, impact_accuracy and [output] may change",
        ))
    }

    /// Restores the progress of the run in a state that has been planned from the same scene and
    /// has this [`fingerprint`]. Refuses other bodies or bonds than those of the run.
    pub fn restore(
        &self,
        fingerprint: u64,
        state: &mut State,
        bodies: &mut Vec<PlacedBody>,
    ) -> Result<()> {
        let is_same = self.fingerprint == fingerprint;
        let planned = std::mem::take(&mut state.model);
        let restored = self.state.clone().into_owned();
        let restored = restored.rebuilt(planned, &state.scratch);
        let of_run = &self.instructions;
        *state =
            (restored.filter(|_| is_same)).ok_or_else(|| other_bodies(of_run, instructions()))?;
        *bodies = self.bodies.to_vec();
        Ok(())
    }
}

/// `of_run`, `here`: the vector instructions of both processors.
fn other_bodies(of_run: &str, here: &str) -> Diagnostic {
    if of_run != here {
        return Diagnostic::input(
            "",
            format!(
                "this checkpoint was written on a processor with {of_run}, and this one has {here}: static equilibria and rate = \"auto\" differ in their last digits, or the run had other bodies, bonds or walls"
            ),
            "go on on such a processor, or start again without --resume",
        );
    }
    Diagnostic::input(
        "",
        "this checkpoint belongs to a run with other bodies, bonds or walls than the scene has now",
        "give the scene and the bodies that the run began with, or start again without --resume",
    )
}

/// A hash of the data fixed by the plan, and of the particles and bonds before the first step.
pub fn fingerprint(planned: &State) -> Result<u64> {
    let parts = (&planned.model, &planned.particles, &planned.bonds);
    let hash = postcard::to_io(&parts, Fnv1a::default()).map_err(|error| fault(&error))?;
    Ok(hash.0)
}

fn fault(error: &postcard::Error) -> Diagnostic {
    Diagnostic::failed(
        "checkpoint",
        error.to_string(),
        "this is a fault of the program",
    )
}

#[cfg(test)]
mod tests {
    use super::other_bodies;

    #[test]
    fn another_processor_is_named() {
        let said = other_bodies("AVX-512", "AVX2").to_string();
        assert!(
            said.contains("written on a processor with AVX-512, and this one has AVX2"),
            "{said}"
        );
        let said = other_bodies("AVX2", "AVX2").to_string();
        assert!(
            said.starts_with("this checkpoint belongs to a run with other bodies"),
            "{said}"
        );
    }
}
