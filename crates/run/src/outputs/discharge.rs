//! What leaves through outlets, `discharge.csv`.

use dem_io::Result;
use dem_results::columns::{header, lines};
use dem_results::folder::names;
use dem_results::{DischargeRow, Table};

use super::{Changes, Opening, Output, Saved};
use dem_engine::state::clusters::sizes::Discharged;

struct Discharge {
    table: Table,
    /// Number of its rows.
    written: usize,
}

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let state = opening.state;
    if state.model.rules.outlets.is_empty() {
        return Ok(None);
    }
    let table = opening.table(
        &opening.folder.file(names::DISCHARGE),
        &header(&DischargeRow::COLUMNS),
    )?;
    let written = state.population.discharged.len();
    Ok(Some(Box::new(Discharge { table, written })))
}

impl Output for Discharge {
    fn note_changes(&mut self, changes: &Changes<'_>) -> Result<()> {
        if changes.is_after_end {
            self.table.hold();
        }
        let state = changes.state;
        let all = &state.population.discharged;
        let (model, outlets) = (&state.model, &state.model.rules.outlets);
        let row = |one: &Discharged| DischargeRow {
            time_s: one.time_s,
            fragment_id: one.fragment_id,
            body: model.body_name(one.size.body),
            material: model.material_name(one.size.body),
            outlet: &outlets[one.outlet as usize].name,
            mass_kg: one.size.mass_kg,
            equivalent_diameter_m: one.size.equivalent_diameter_m,
            box_lengths_m: one.size.box_lengths_m,
            sieve_m: one.size.sieve_m,
        };
        let rows = all[self.written..].iter().map(row);
        self.table.append(&lines(&DischargeRow::COLUMNS, rows))?;
        self.written = all.len();
        Ok(())
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.table, &())
    }
}
