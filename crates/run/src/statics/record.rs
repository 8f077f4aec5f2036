//! Output of a static run: its summary, its text, its files.

use std::collections::BTreeMap;

use dem_io::Result;
use dem_io::body::mass::BodyMass;
use dem_results::columns::header;
use dem_results::folder::names;
use dem_results::summary::{EquilibriumSummary, Inputs, Summary, Verdict};
use dem_results::{Event, FrameFiles, ResultsFolder, SeriesFile, Table};
use dem_scene::Scene;

use crate::last_files::End;
use crate::last_files::fragments::fragment_summary;
use crate::machine::machine;
use crate::outputs::frames::order::FrameOrder;
use crate::outputs::frames::walls::WallOutput;
use crate::outputs::series;
use crate::settings::RunSettings;
use dem_engine::Balance;
use dem_engine::stages::bonds::forces::most_strained_edge;
use dem_engine::state::State;
use dem_engine::state::clusters::fragments as fragments_of;
use dem_engine::statics::newton::Equilibrium;
use dem_physics::bond::failure::CauseCounts;
use dem_plan::measure::Probe;

/// Summary of an equilibrium with this number of bonds beyond their strength.
pub(super) fn equilibrium_summary(
    found: &Equilibrium,
    bonds_beyond_strength: usize,
) -> EquilibriumSummary {
    EquilibriumSummary {
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

/// A scene at rest, and its measured values.
pub(super) struct AtRest<'a> {
    pub(super) state: &'a State,
    pub(super) scene: &'a Scene,
    pub(super) probes: &'a [Probe],
    pub(super) balance: &'a Balance,
    pub(super) masses: &'a BTreeMap<String, BodyMass>,
}

impl AtRest<'_> {
    /// The summary. Times: wall and, if the system provides it, processor time, s.
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
            fragment_summary(clusters, &all, &state.population)
        });
        let steps_per_s = found.newton_steps as f64 / wall_s;
        Summary {
            scene: self.scene.source.clone(),
            program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
            engine: None,
            ended_by: "equilibrium".to_owned(),
            problem: None,
            inputs,
            simulated_s: state.time_s,
            resumed_at_s: None,
            wall_s,
            processor_s,
            threads: settings.threads,
            machine: machine(),
            particles: state.particles.len(),
            bonds: state.bonds.len(),
            bodies: self.masses.clone(),
            broken_bonds: 0,
            damaged_bonds: state.bonds.count_damaged(),
            yielded_bonds: state.bonds.count_yielded(),
            largest_bond_strain: most_strained_edge(&state.bonds, &state.particles.poses)
                .map_or(0.0, |(strain, _)| strain),
            largest_overlap: 0.0,
            broken_by_cause: CauseCounts::default(),
            fragments,
            sizes: None,
            flows: None,
            population: None,
            taken_in: BTreeMap::new(),
            wall_loads: BTreeMap::new(),
            walls: BTreeMap::new(),
            sleep: None,
            steps: state.steps,
            time_step_s: state.time_step_s,
            limit_s: f64::INFINITY,
            fraction_of_limit: 0.0,
            adaptive: None,
            steps_per_s,
            bond_steps_per_s: steps_per_s * state.bonds.len() as f64,
            energy_error: f64::NAN,
            part_error: None,
            momentum_error: f64::NAN,
            angular_momentum_error: f64::NAN,
            balance: *self.balance,
            measures: self.probes.iter().map(Probe::result).collect(),
            time_by_stage: Vec::new(),
            inactive_stages: Vec::new(),
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

    /// Writes one frame, one row of the time series with the `measured` values, no events, the page
    /// and the summary.
    pub(super) fn write(
        &self,
        folder: &ResultsFolder,
        order: &FrameOrder,
        measured: &[f64],
        summary: &Summary,
    ) -> Result<()> {
        let columns = series::columns(self.scene.walls.keys(), self.probes);
        let mut rows = SeriesFile::create(&folder.file(names::SERIES), &columns)?;
        rows.append(
            self.state.time_s,
            &series::row(self.state, self.balance, measured),
        )?;
        Table::create(&folder.file(names::EVENTS), &header(&Event::COLUMNS))?;
        let walls = WallOutput::of(self.state);
        let mut frames = FrameFiles::create(folder, walls.files());
        order.write(self.state, &walls, &mut frames)?;
        let end = End::of(summary)?;
        end.write_page(folder)?;
        end.write_summary(folder)
    }
}
