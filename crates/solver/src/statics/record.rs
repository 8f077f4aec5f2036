//! What a static run leaves: its summary, its text, its files.

use std::collections::BTreeMap;
use std::fmt;

use dem_io::Result;
use dem_io::body::mass::BodyMass;
use dem_io::results::{EventFile, FrameFiles, ResultsFolder, SeriesFile, write_json};
use dem_io::scene::Scene;
use dem_io::text::visible;
use dem_io::units::significant;
use serde::Serialize;

use super::newton::Equilibrium;
use crate::machine::machine;
use crate::measure::Probe;
use crate::output::fragments::FragmentSummary;
use crate::output::frames::FrameOrder;
use crate::output::series;
use crate::output::summary::{Summary, Verdict, measure_lines};
use crate::physics::bond::failure::CauseCounts;
use crate::plan::inputs::Inputs;
use crate::run::RunSettings;
use crate::stages::bonds::most_strained_edge;
use crate::stages::ledger::Balance;
use crate::state::State;
use crate::state::clusters::fragments as fragments_of;

/// Residual over the largest bond force that is worth a word.
const LARGE_RESIDUAL: f64 = 1e-6;

/// How an equilibrium was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EquilibriumSummary {
    /// Unknown freedoms.
    pub unknowns: usize,
    /// Freedoms that supports hold.
    pub held: usize,
    /// Newton steps, of all load steps together.
    pub newton_steps: usize,
    /// Load steps; 1: the whole load at once.
    pub load_steps: usize,
    /// The residual over the largest bond force.
    pub residual: f64,
    /// The residual, N; torques over the radii of their particles.
    pub residual_n: f64,
    /// The largest that a bond carries, N; moments over its radius.
    pub largest_bond_force_n: f64,
    /// Bonds beyond their strength.
    pub bonds_beyond_strength: usize,
    /// Whether every small move from the equilibrium needs work.
    pub stable: bool,
}

impl EquilibriumSummary {
    /// Of an equilibrium in which so many bonds are beyond their strength.
    pub fn new(found: &Equilibrium, bonds_beyond_strength: usize) -> Self {
        Self {
            unknowns: found.unknowns,
            held: found.held,
            newton_steps: found.newton_steps,
            load_steps: found.load_steps,
            residual: found.residual(),
            residual_n: found.residual_n,
            largest_bond_force_n: found.bond_force_n,
            bonds_beyond_strength,
            stable: found.stable,
        }
    }

    /// What speaks against trusting the result. Empty: nothing.
    pub fn doubts(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        if self.bonds_beyond_strength > 0 {
            doubts.push(format!(
                "{} beyond their strength: the body would break; run it with run.integrator = \"leapfrog\"",
                match self.bonds_beyond_strength {
                    1 => "1 bond is".to_owned(),
                    many => format!("{many} bonds are"),
                }
            ));
        }
        if !self.stable {
            doubts.push(
                "the equilibrium may not be stable: some small moves from it give work".to_owned(),
            );
        }
        if self.residual > LARGE_RESIDUAL {
            doubts.push(format!(
                "the residual is {} of the largest bond force: the loads are hardly more than rounding",
                significant(self.residual, 2)
            ));
        }
        doubts
    }

    /// The text of a summary that is of an equilibrium.
    ///
    /// # Errors
    /// Those of the formatter.
    pub fn write(&self, summary: &Summary, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let results = summary.results.as_ref();
        writeln!(
            f,
            "{}: equilibrium at {} s in {} s{}",
            visible(&summary.scene),
            significant(summary.simulated_s, 6),
            significant(summary.wall_s, 3),
            results.map_or(String::new(), |folder| format!(" -> {}", visible(folder))),
        )?;
        measure_lines(&summary.measures, f)?;
        let steps = |count: usize, what: &str| {
            format!("{count} {what}{}", if count == 1 { "" } else { "s" })
        };
        writeln!(
            f,
            "equilibrium  in {}{}, residual {} of the largest bond force",
            steps(self.newton_steps, "Newton iteration"),
            match self.load_steps {
                1 => String::new(),
                many => format!(" and {many} load steps"),
            },
            significant(self.residual, 2),
        )?;
        writeln!(
            f,
            "solved       {} unknowns; {} freedoms held",
            self.unknowns, self.held
        )?;
        summary.write_masses(f)?;
        summary.write_verdict(f)
    }
}

/// A scene at rest, and what has been read of it.
pub(super) struct AtRest<'a> {
    pub(super) state: &'a State,
    pub(super) scene: &'a Scene,
    pub(super) probes: &'a [Probe],
    pub(super) balance: &'a Balance,
    pub(super) masses: &'a BTreeMap<String, BodyMass>,
}

impl AtRest<'_> {
    /// The summary. Times: wall and, where the system says it, processor time, s.
    pub(super) fn summary(
        &self,
        settings: &RunSettings<'_>,
        found: EquilibriumSummary,
        (wall_s, processor_s): (f64, Option<f64>),
        (notes, inputs): (Vec<String>, Inputs),
    ) -> Summary {
        let state = self.state;
        let fragments = state.clusters.as_ref().map(|clusters| {
            let all = fragments_of(clusters, &state.particles, &state.clumps, None);
            FragmentSummary::new(clusters, &all)
        });
        let steps_per_s = found.newton_steps as f64 / wall_s;
        Summary {
            scene: self.scene.source.clone(),
            program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
            ended_by: "equilibrium".to_owned(),
            problem: None,
            inputs,
            simulated_s: state.time_s,
            wall_s,
            processor_s,
            threads: settings.threads,
            machine: machine(),
            particles: state.particles.len(),
            bonds: state.bonds.len(),
            bodies: self.masses.clone(),
            broken_bonds: 0,
            largest_bond_strain: most_strained_edge(&state.bonds, &state.particles.poses)
                .map_or(0.0, |(strain, _)| strain),
            largest_overlap: 0.0,
            broken_by_cause: CauseCounts::default(),
            fragments,
            population: None,
            sleep: None,
            steps: state.steps,
            time_step_s: state.time_step_s,
            limit_s: f64::INFINITY,
            share_of_limit: 0.0,
            adaptive: None,
            steps_per_s,
            bond_steps_per_s: steps_per_s * state.bonds.len() as f64,
            energy_error: f64::NAN,
            momentum_error: f64::NAN,
            angular_momentum_error: f64::NAN,
            ledger: *self.balance,
            measures: self.probes.iter().map(Probe::result).collect(),
            time_by_stage: Vec::new(),
            left_out: Vec::new(),
            notes,
            verdict: Verdict::default(),
            results: settings
                .folder
                .map(|folder| folder.path().display().to_string()),
            resumed_with: None,
            test: None,
            equilibrium: Some(found),
        }
    }

    /// Writes one frame, one row of the time series with what was `measured`, no events, and the summary.
    ///
    /// # Errors
    /// Those of the files.
    pub(super) fn write(
        &self,
        folder: &ResultsFolder,
        order: &FrameOrder,
        measured: &[f64],
        summary: &Summary,
    ) -> Result<()> {
        let columns = series::columns(self.scene.walls.keys(), self.probes);
        let mut rows = SeriesFile::create(&folder.series(), &columns)?;
        rows.append(
            self.state.time_s,
            &series::row(self.state, self.balance, measured),
        )?;
        EventFile::create(&folder.events())?;
        order.write(self.state, &mut FrameFiles::create(folder))?;
        write_json(&folder.summary(), summary)
    }
}
