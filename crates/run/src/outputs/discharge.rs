//! What leaves through outlets, `discharge.csv`.

use dem_io::Result;
use dem_results::{DischargeFile, DischargeRow};

use super::{Changes, Opening, Output, Saved, TableEnd};
use dem_engine::state::clusters::sizes::Discharged;

const NAME: &str = "discharge";

struct Discharge {
    file: DischargeFile,
    /// Number of its rows.
    written: usize,
}

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let state = opening.state;
    if state.model.rules.outlets.is_empty() {
        return Ok(None);
    }
    let path = opening.folder.discharge();
    let file = match opening.position::<(TableEnd, ())>(NAME)? {
        None => DischargeFile::create(&path)?,
        Some((end, ())) => {
            let mut file = DischargeFile::continue_at(&path, end.bytes)?;
            file.table.append(&end.held)?;
            file
        }
    };
    let written = state.population.discharged.len();
    Ok(Some(Box::new(Discharge { file, written })))
}

impl Output for Discharge {
    fn name(&self) -> &'static str {
        NAME
    }

    fn note_changes(&mut self, changes: &Changes<'_>) -> Result<()> {
        if changes.is_after_end {
            self.file.table.hold();
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
        self.file.append(all[self.written..].iter().map(row))?;
        self.written = all.len();
        Ok(())
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.file.table, &())
    }
}
