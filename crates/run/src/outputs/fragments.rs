//! The fragments at chosen moments, `fragments.csv`.

use dem_io::Result;
use dem_results::columns::header;
use dem_results::folder::names;
use dem_results::{FragmentRow, Table, append_fragments};

use super::{Moment, Opening, Output, Saved, TableEnd};
use dem_engine::stages::clumps::motion::synchronous;
use dem_engine::stages::ledger::totals::synchronous_motions;
use dem_engine::state::State;
use dem_engine::state::clusters::{Fragment, fragments};

/// Besides at the frames, fragments are written when their number has grown by one in this many.
/// While there are few, every new one is written, and the number of rows written for all splits
/// together is at most one more than this times the number of fragments at the end.
const GROWTH: u64 = 20;

struct Fragments {
    table: Table,
    /// Number of fragments when they were written last.
    written: u64,
}

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    if opening.state.clusters.is_none() {
        return Ok(None);
    }
    let position = opening.position::<(TableEnd, u64)>()?;
    Ok(Some(Box::new(Fragments {
        table: opening.table(
            &opening.folder.file(names::FRAGMENTS),
            &header(&FragmentRow::COLUMNS),
        )?,
        written: position.map_or(0, |(_, written)| written),
    })))
}

impl Output for Fragments {
    fn write(&mut self, now: &Moment<'_>) -> Result<()> {
        let state = now.state;
        let Some(clusters) = &state.clusters else {
            return Ok(());
        };
        let has_new = || clusters.living().count() as u64 > self.written + self.written / GROWTH;
        if !(now.is_frame || now.row.is_some() && has_new()) {
            return Ok(());
        }
        let motions = synchronous_motions(state);
        let moving = synchronous(state);
        let moving = Some((&motions[..], &moving[..]));
        let fragments = fragments(clusters, &state.particles, &state.clumps, moving);
        self.written = fragments.len() as u64;
        let rows = fragment_rows(&fragments, state);
        append_fragments(&mut self.table, &rows)
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.table, &self.written)
    }
}

/// Fragments as rows of the table of fragments.
pub fn fragment_rows<'a>(fragments: &[Fragment], state: &'a State) -> Vec<FragmentRow<'a>> {
    let model = &state.model;
    let row = |fragment: &Fragment| FragmentRow {
        time_s: state.time_s,
        fragment_id: fragment.fragment_id,
        parent_id: fragment.parent_id,
        particles: fragment.particles,
        mass_kg: fragment.mass_kg,
        centre_m: fragment.centre_m,
        velocity_m_s: fragment.velocity_m_s,
        angular_velocity_rad_s: fragment.angular_velocity_rad_s,
        force_n: Some(fragment.force_n),
        equivalent_diameter_m: fragment.equivalent_diameter_m,
        box_diagonal_m: fragment.box_diagonal_m,
        body: model.body_name(fragment.body),
        material: model.material_name(fragment.body),
    };
    fragments.iter().map(row).collect()
}
