//! What a checkpoint holds: all that changes while a run steps. What the scene and the bodies say
//! is read again when it goes on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use dem_io::body::files::body_files;
use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::progress::Progress;
use crate::measure;
use crate::physics::bond::failure::CauseCounts;
use crate::physics::bond::incremental::History;
use crate::state::State;
use crate::state::bodies::PlacedBody;
use crate::state::ledger::EnergyLedger;
use crate::state::particles::Motion;
use crate::state::partitions::divide_anew;
use crate::state::watches::Seen;

mod meetings;
mod population;

use self::meetings::Meetings;
use self::population::Population;

/// Position x, y, z, orientation x, y, z, w, velocity x, y, z, spin x, y, z of a particle.
type PlaceAndMotion = ([f64; 3], [f64; 4], [f64; 3], [f64; 3]);

/// A run between two steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The scene, as [`dem_io::Scene::describe`] tells it.
    scene: String,
    fingerprint: u64,
    steps: u64,
    time_s: f64,
    time_step_s: f64,
    previous_time_step_s: f64,
    broken_count: u64,
    broken_by_cause: CauseCounts,
    particles: Vec<PlaceAndMotion>,
    broken: Vec<u32>,
    histories: Vec<[f64; 6]>,
    ledger: EnergyLedger,
    meetings: Meetings,
    /// None: bodies neither come nor go, and what stands above is enough.
    population: Option<Population>,
    /// What has been seen of forces and contacts in every step.
    watches: Vec<Seen>,
    /// What the probes have shown.
    pub measures: Vec<measure::History>,
    /// Where the output stands.
    pub progress: Progress,
}

impl Snapshot {
    /// Of a run between two steps.
    pub fn taken(
        state: &State,
        bodies: &[PlacedBody],
        scene: String,
        fingerprint: u64,
        measures: Vec<measure::History>,
        progress: Progress,
    ) -> Self {
        let p = &state.particles;
        let population = Population::taken(state, bodies);
        let is_planned = population.is_none();
        Self {
            scene,
            fingerprint,
            steps: state.steps,
            time_s: state.time_s,
            time_step_s: state.time_step_s,
            previous_time_step_s: state.previous_time_step_s,
            broken_count: state.broken_count,
            broken_by_cause: state.broken_by_cause,
            particles: p
                .poses
                .iter()
                .zip(&p.motions)
                .filter(|_| is_planned)
                .map(|(pose, motion)| {
                    let [x, y, z, _] = pose.position_m;
                    (
                        [x, y, z],
                        pose.turned,
                        motion.velocity_m_s,
                        motion.spin_rad_s,
                    )
                })
                .collect(),
            broken: (0..state.bonds.len())
                .filter(|&at| is_planned && state.bonds.is_broken(at))
                .map(|at| at as u32)
                .collect(),
            histories: state
                .bonds
                .histories
                .iter()
                .filter(|_| is_planned)
                .map(|h| {
                    let [fx, fy, fz]: [f64; 3] = h.shear_force.into();
                    let [mx, my, mz]: [f64; 3] = h.moment.into();
                    [fx, fy, fz, mx, my, mz]
                })
                .collect(),
            ledger: state.ledger,
            meetings: Meetings::taken(state),
            population,
            watches: state.watches.iter().map(|watch| watch.seen).collect(),
            measures,
            progress,
        }
    }

    /// The files of bodies, walls and regions that its scene names.
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
    ///
    /// # Errors
    /// None in practice (exit code 1).
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        postcard::to_stdvec(self).map_err(|error| {
            Diagnostic::failed(
                "checkpoint",
                error.to_string(),
                "this is a fault of the program",
            )
        })
    }

    /// From the bytes of a checkpoint.
    ///
    /// # Errors
    /// It holds something else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        postcard::from_bytes(bytes).map_err(|error| {
            Diagnostic::input(
                "",
                format!("this checkpoint does not hold a run of this program: {error}"),
                "start the run again, without --resume",
            )
        })
    }

    /// Whether a scene is the one of the run, but for what may change on the way: when it ends, how
    /// it steps, what it writes, and where the files of its bodies are.
    ///
    /// # Errors
    /// Says what has changed.
    pub fn check_scene(&self, scene: &str) -> Result<()> {
        let may_change = |key: &str| {
            const RUN: [&str; 4] = [
                "run.end_time",
                "run.rest_energy_ratio",
                "run.time_step",
                "run.safety_factor",
            ];
            RUN.contains(&key) || key.starts_with("output") || key.ends_with(".file")
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
            "put it back, or start again without --resume; end_time, rest, time_step, safety and [output] may change",
        ))
    }

    /// Puts a state that has been planned from the same scene where the run stood.
    ///
    /// # Errors
    /// The scene's bodies or bonds are others than those of the run.
    pub fn restore(&self, state: &mut State, bodies: &mut Vec<PlacedBody>) -> Result<()> {
        if let Some(population) = &self.population {
            if self.fingerprint != fingerprint(state) {
                return Err(other_bodies());
            }
            population.restore(state, bodies)?;
        } else {
            self.restore_planned(state)?;
        }
        state.ledger = self.ledger;
        self.meetings.restore(state)?;
        for (watch, seen) in state.watches.iter_mut().zip(&self.watches) {
            watch.seen = *seen;
        }
        state.steps = self.steps;
        state.time_s = self.time_s;
        state.time_step_s = self.time_step_s;
        state.previous_time_step_s = self.previous_time_step_s;
        state.broken_count = self.broken_count;
        state.broken_by_cause = self.broken_by_cause;
        let there = (0..state.bonds.len()).filter(|&at| state.bonds.is_broken(at));
        state.broken_gone = self.broken_count.saturating_sub(there.count() as u64);
        Ok(())
    }

    /// Puts the particles and bonds where they stood.
    fn restore_planned(&self, state: &mut State) -> Result<()> {
        let bonds = state.bonds.len();
        if self.fingerprint != fingerprint(state)
            || self.particles.len() != state.particles.len()
            || self.histories.len() != state.bonds.histories.len()
            || self.broken.iter().any(|&at| at as usize >= bonds)
        {
            return Err(other_bodies());
        }
        let p = &mut state.particles;
        for (i, &([x, y, z], turned, velocity_m_s, spin_rad_s)) in self.particles.iter().enumerate()
        {
            p.poses[i].put_at([x, y, z]);
            p.poses[i].turned = turned;
            p.motions[i] = Motion {
                velocity_m_s,
                spin_rad_s,
                ..p.motions[i]
            };
        }
        for &at in &self.broken {
            state.bonds.set_broken(at as usize);
        }
        divide_anew(&state.bonds, &mut state.partitions, &[]);
        let history = |&[fx, fy, fz, mx, my, mz]: &[f64; 6]| History {
            shear_force: Vector3::new(fx, fy, fz),
            moment: Vector3::new(mx, my, mz),
        };
        state.bonds.histories = self.histories.iter().map(history).collect();
        Ok(())
    }
}

fn other_bodies() -> Diagnostic {
    Diagnostic::input(
        "",
        "this checkpoint belongs to a run with other bodies or bonds than the scene has now",
        "give the scene and the bodies that the run began with, or start again without --resume",
    )
}

/// A hash (FNV-1a) of what a state is made of: particles and bonds as planned, before the first
/// step.
pub fn fingerprint(state: &State) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |word: u64| {
        for byte in word.to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    let (p, b) = (&state.particles, &state.bonds);
    let inverse_masses = p.motions.iter().map(|motion| motion.inverse_mass).collect();
    for numbers in [&inverse_masses, &b.torsion_per_bending, &b.strength_factors] {
        add(numbers.len() as u64);
        numbers.iter().for_each(|n| add(n.to_bits()));
    }
    for block in &b.blocks {
        let [x, y, z] = &block.direction;
        let [lever_a, lever_b] = &block.levers_m;
        let (normal, shear, radii) = (&block.normal, &block.shear, &block.radii_m);
        for column in [x, y, z, lever_a, lever_b, normal, shear, radii] {
            column.iter().for_each(|n| add(n.to_bits()));
        }
    }
    for pose in &p.poses {
        pose.position_m.iter().for_each(|x| add(x.to_bits()));
    }
    for &(end, rule) in &b.rule_runs {
        add(end as u64);
        add(u64::from(b.rules[rule].incremental));
    }
    for &[a, c] in &b.ends {
        add(u64::from(a) << 32 | u64::from(c));
    }
    for template in &state.clumps.templates {
        for sphere in &template.spheres {
            let numbers = sphere.place_m.into_iter();
            let numbers = numbers.chain([sphere.radius_m, sphere.mass_kg]);
            numbers.for_each(|x| add(x.to_bits()));
        }
        for &[a, c] in &template.bonds.ends {
            add(u64::from(a) << 32 | u64::from(c));
        }
    }
    hash
}
