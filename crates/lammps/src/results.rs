//! The files of results of an imported run: frames, events, fragments, counts and a summary.

use std::path::Path;

use dem_engine::state::clusters::fragments::fragment_masses_kg;
use dem_engine::state::clusters::{Clusters, Split, fragments};
use dem_io::Result;
use dem_io::body::stored_frame::{
    BODY, BOND_LENGTH, BOND_RADIUS, BROKEN, DENSITY, FRAGMENT_ID, PARTICLE_ID, RADIUS, VELOCITY,
};
use dem_plan::measure::sizes::Fragments;
use dem_report::report;
use dem_results::columns::{header, write_table};
use dem_results::folder::names;
use dem_results::summary::Verdict;
use dem_results::{
    DistributionRow, Event, Existing, FragmentRow, Frame, FrameFiles, NamedArray, ResultsFolder,
    SeriesFile, Table, Values, WallFiles, WallFrame, WallTriangles, append_fragments, event_lines,
    read_series, write_json,
};
use dem_runner::last_files::fragments::{fragment_summary, write_fragment_plots, write_tree};
use dem_runner::last_files::plots::write_broken_plot;
use dem_runner::outputs::event_table::split_text;
use dem_runner::outputs::fragments::fragment_rows;
use serde_json::json;

use super::breaks::Break;
use super::came::Came;
use super::exported::Exported;
use super::files::Manifest;
use super::pieces::Pieces;

/// Columns of `series.csv`: what LAMMPS leaves, at the times of the frames.
const COUNTS: [&str; 4] = ["broken_bonds", "intact_bonds", "particles", "clumps"];

/// The files that grow while the dumps are read.
pub(super) struct Results {
    folder: ResultsFolder,
    frames: FrameFiles,
    events: Table,
    fragments: Table,
    series: SeriesFile,
}

/// What is read at the time of a frame.
pub(super) struct Moment<'a> {
    pub manifest: &'a Manifest,
    pub exported: &'a Exported,
    /// Particles where the frame has them.
    pub pieces: &'a Pieces,
    pub time_s: f64,
}

impl Results {
    /// New files in a folder.
    pub(super) fn create(path: &Path, existing: Existing) -> Result<Self> {
        let folder = ResultsFolder::create(path, existing)?;
        let table = |name: &str, header: &str| Table::create(&folder.file(name), header);
        let counts = COUNTS.map(str::to_owned);
        Ok(Self {
            frames: FrameFiles::create(&folder, WallFiles::default()),
            events: table(names::EVENTS, &header(&Event::COLUMNS))?,
            fragments: table(names::FRAGMENTS, &header(&FragmentRow::COLUMNS))?,
            series: SeriesFile::create(&folder.file(names::SERIES), &counts)?,
            folder,
        })
    }

    /// Records bonds that broke in one step, and what they left in pieces.
    pub(super) fn add_breaks(
        &mut self,
        moment: &Moment<'_>,
        breaks: &[Break],
        splits: &[Split],
    ) -> Result<()> {
        let of_all = |step: u64| Event {
            step,
            time_s: step as f64 * moment.pieces.state.time_step_s,
            kind: "split",
            bond: None,
            particle_a: None,
            particle_b: None,
            position_m: None,
            cause: "",
            energy_j: None,
            detail: "",
            strengthened: None,
        };
        let broken = breaks.iter().map(|one| {
            let place = moment.exported.in_file(one.bond);
            let body = moment.manifest.body_of_molecule[place.molecule as usize - 1];
            Event {
                kind: "bond_broken",
                bond: Some(place.bond),
                particle_a: Some(place.particles[0]),
                particle_b: Some(place.particles[1]),
                position_m: Some(one.place_m),
                detail: &moment.manifest.bodies[body as usize].name,
                ..of_all(one.step)
            }
        });
        self.events.append(&event_lines(broken))?;
        let (Some(clusters), Some(one)) = (&moment.pieces.state.clusters, breaks.first()) else {
            return Ok(());
        };
        let details: Vec<String> = (splits.iter())
            .map(|split| split_text(split, &clusters.history))
            .collect();
        let split = |detail| Event {
            detail,
            ..of_all(one.step)
        };
        let details = details.iter().map(String::as_str);
        self.events.append(&event_lines(details.map(split)))
    }

    /// Writes a frame, its fragments and its counts.
    pub(super) fn add_frame(&mut self, moment: &Moment<'_>) -> Result<()> {
        let Moment { pieces, time_s, .. } = *moment;
        let state = &pieces.state;
        let Some(clusters) = &state.clusters else {
            return Ok(());
        };
        write_frame(moment, clusters, &mut self.frames)?;
        let all = fragments(clusters, &state.particles, &state.clumps, None);
        let rows = fragment_rows(&all, state).into_iter();
        let rows = rows.map(|row| FragmentRow {
            time_s,
            // Those that LAMMPS would write have weight and supports in them.
            force_n: None,
            ..row
        });
        append_fragments(&mut self.fragments, &rows.collect::<Vec<_>>())?;
        let broken = state.broken_count as f64;
        let clumps = moment.manifest.clumps(&moment.exported.molecules) as f64;
        let intact = pieces.is_broken.len() as f64 - broken;
        let counts = [broken, intact, state.particles.len() as f64, clumps];
        self.series.append(time_s, &counts)
    }

    /// Writes the last files: tables of the fragments at the end, plots, summary and page.
    pub(super) fn finish(&self, moment: &Moment<'_>, came: &Came) -> Result<()> {
        let state = &moment.pieces.state;
        let folder = &self.folder;
        let (Some(clusters), Some(sizes)) = (&state.clusters, Fragments::of(state)) else {
            return Ok(());
        };
        write_tree(folder, clusters)?;
        write_fragment_plots(folder, state, &sizes, came.last_s, &[])?;
        write_broken_plot(folder, &read_series(&folder.file(names::SERIES))?)?;
        let rows = sizes.rows(&state.model, &moment.manifest.sieves_m);
        let path = folder.file(names::DISTRIBUTION);
        write_table(&path, &DistributionRow::COLUMNS, rows)?;
        let unchecked = "computed by LAMMPS: energies, momentum and overlaps were not checked";
        let warnings: Vec<String> = std::iter::once(unchecked.to_owned())
            .chain(came.warning())
            .collect();
        let all = fragments(clusters, &state.particles, &state.clumps, None);
        let summary = json!({
            "program": moment.manifest.program,
            "engine": "LAMMPS",
            "scene": moment.manifest.scene,
            "ended_by": if came.is_whole { "end time" } else { "interruption" },
            "simulated_s": came.last_s,
            "steps": state.steps,
            "time_step_s": state.time_step_s,
            "particles": state.particles.len(),
            "bonds": moment.exported.bonds.len(),
            "broken_bonds": state.broken_count,
            "fragments": fragment_summary(clusters, &all, &state.population),
            "sizes": sizes.sizes(&state.model),
            "verdict": Verdict::new(warnings, Vec::new()),
        });
        write_json(&folder.file(names::SUMMARY), &summary)?;
        let page = report(folder.path(), &summary.to_string())?;
        folder.write(names::REPORT, &page)
    }
}

fn write_frame(moment: &Moment<'_>, clusters: &Clusters, files: &mut FrameFiles) -> Result<()> {
    let Moment {
        manifest,
        exported,
        pieces,
        time_s,
    } = *moment;
    let particles = &pieces.state.particles;
    let masses_kg = fragment_masses_kg(clusters, particles, &pieces.state.clumps);
    let body_names: Vec<&str> = manifest.bodies.iter().map(|b| b.name.as_str()).collect();
    let radius = |i: usize| exported.radii_m[i];
    let body = |i: usize| manifest.body_of_molecule[exported.molecules[i] as usize - 1];
    let particle_id = |i: usize| (exported.ids[i] - 1) as u32;
    let velocity = |i: usize| particles.motions[i].velocity_m_s;
    let spin = |i: usize| particles.motions[i].spin_rad_s;
    let fragment = |i: usize| clusters.of_particle[i];
    let density = |i: usize| exported.densities_kg_m3[i];
    let fragment_mass = |i: usize| masses_kg[i];
    let bond_radius = |i: usize| manifest.bond_radii_m[exported.bond_types[i] - 1];
    let length = |i: usize| exported.length_m(i);
    let is_broken = |i: usize| u32::from(pieces.is_broken[i]);
    let array = |name, values| NamedArray { name, values };
    let frame = Frame {
        time_s,
        body_names: &body_names,
        particles: particles.len(),
        position_m: &|i| particles.poses[i].place().into(),
        particle_arrays: &[
            array(RADIUS, Values::Scalars(&radius)),
            array(BODY, Values::Counts(&body)),
            array(PARTICLE_ID, Values::Counts(&particle_id)),
            array(VELOCITY, Values::Vectors(&velocity)),
            array("angular_velocity_rad_s", Values::Vectors(&spin)),
            array(FRAGMENT_ID, Values::Counts(&fragment)),
            array(DENSITY, Values::Scalars(&density)),
            array("fragment_mass_kg", Values::Scalars(&fragment_mass)),
        ],
        bonds: exported.bonds.len(),
        ends: &|i| exported.bonds[i],
        bond_arrays: &[
            array(BOND_RADIUS, Values::Scalars(&bond_radius)),
            array(BROKEN, Values::Counts(&is_broken)),
            array(BOND_LENGTH, Values::Scalars(&length)),
        ],
    };
    files.append(&frame, &WallFrame::default(), &WallTriangles::default())
}
