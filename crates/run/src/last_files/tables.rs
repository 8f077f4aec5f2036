//! Tables and plots of the last state of a run in which bodies can break.

use std::path::PathBuf;

use dem_io::Result;
use dem_results::columns::write_table;
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
