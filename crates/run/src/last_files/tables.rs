//! Tables and plots of the last state of a run in which bodies can break.

use std::path::PathBuf;

use dem_io::Result;
use dem_results::columns::{Column, write_table};
use dem_results::folder::names;
use dem_results::{DistributionRow, FlowRow, MixingRow};

use super::last_state::LastState;
use crate::last_files::flows::flow_rows;
use crate::last_files::fragments::{FRAGMENT_PLOTS, write_fragment_plots, write_tree};
use dem_plan::measure::Probe;

/// Origin, plots and size distribution of the fragments.
pub(super) fn fragments(last: &LastState<'_>) -> Result<Vec<PathBuf>> {
    let (folder, state) = (last.folder, last.state);
    let Some((clusters, fragments)) = state.clusters.as_ref().zip(last.fragments.as_ref()) else {
        return Ok(Vec::new());
    };
    write_tree(folder, clusters)?;
    write_fragment_plots(folder, state, fragments, last.end_s, last.probes)?;
    let output = last.scene.output.as_ref();
    let sieves_m = output.map_or(&[][..], |output| &output.sieves_m);
    let rows = fragments.rows(&state.model, sieves_m);
    write_table(
        &folder.file(names::DISTRIBUTION),
        &DistributionRow::COLUMNS,
        rows,
    )?;
    let plots = FRAGMENT_PLOTS.iter().map(|name| folder.plot(name));
    let tables = [
        folder.file(names::FRAGMENT_TREE),
        folder.file(names::DISTRIBUTION),
    ];
    Ok(plots.filter(|path| path.is_file()).chain(tables).collect())
}

/// Mass flows over time.
pub(super) fn flow(last: &LastState<'_>) -> Result<Vec<PathBuf>> {
    if last.fragments.is_none() || !last.state.model.rules.have_flows() {
        return Ok(Vec::new());
    }
    let interval_s = (last.scene.output.as_ref()).and_then(|output| output.flow_s);
    let interval_s = interval_s.unwrap_or(last.end_s / 20.0);
    let path = last.folder.file(names::FLOW);
    let rows = flow_rows(last.state, interval_s, last.end_s);
    write_table(&path, &FlowRow::COLUMNS, rows)?;
    Ok(vec![path])
}

/// The cells of all mixing indices.
pub(super) fn mixing(last: &LastState<'_>) -> Result<Vec<PathBuf>> {
    if last.fragments.is_none() || !last.probes.iter().any(Probe::mixes) {
        return Ok(Vec::new());
    }
    let of_probe = |probe| {
        let probe: &Probe = probe;
        let cells = probe.mixed_cells(last.state).into_iter();
        cells.map(|cell| MixingRow {
            measure: &probe.name,
            centre_m: cell.centre_m,
            mass_kg: cell.mass_kg,
            fraction: cell.fraction,
        })
    };
    let rows = last.probes.iter().flat_map(of_probe);
    let path = last.folder.file(names::MIXING);
    write_table(&path, &MixingRow::COLUMNS, rows)?;
    Ok(vec![path])
}

/// A body, and its centre of mass, m. Length 3.
type Centre = (String, [f64; 3]);

const CENTRE: [Column<Centre>; 4] = [
    ("body", |(name, _)| {
        format!("\"{}\"", name.replace('"', "\"\""))
    }),
    ("x_m", |(_, [x, _, _])| x.to_string()),
    ("y_m", |(_, [_, y, _])| y.to_string()),
    ("z_m", |(_, [_, _, z])| z.to_string()),
];

/// Centres of mass of the bodies with all their pieces.
pub(super) fn centres(last: &LastState<'_>) -> Result<Vec<PathBuf>> {
    let state = last.state;
    let Some(clusters) = &state.clusters else {
        return Ok(Vec::new());
    };
    let p = &state.particles;
    let mut sums = vec![(0.0, [0.0; 3]); state.model.bodies.len()];
    let mut add = |cluster: u32, mass_kg: f64, place_m: [f64; 3]| {
        let (total_kg, moment) = &mut sums[clusters.history[cluster as usize].body as usize];
        *total_kg += mass_kg;
        for (sum, x) in moment.iter_mut().zip(place_m) {
            *sum += mass_kg * x;
        }
    };
    for i in 0..p.free {
        let mass_kg = 1.0 / p.motions[i].inverse_mass;
        add(clusters.of_particle[i], mass_kg, p.poses[i].place().into());
    }
    for clump in &state.clumps.all {
        let mass_kg = state.clumps.template(clump).mass_kg;
        add(clump.cluster, mass_kg, clump.place_m);
    }
    let named = state.model.bodies.iter().zip(sums);
    let rows = named
        .filter(|(_, (mass_kg, _))| *mass_kg > 0.0)
        .map(|(body, (mass_kg, moment))| (body.name.clone(), moment.map(|m| m / mass_kg)));
    let path = last.folder.file(names::CENTRES);
    write_table(&path, &CENTRE, rows)?;
    Ok(vec![path])
}
