//! The time step at each row of the time series, `steps.csv`.

use dem_io::Result;
use dem_io::text::exact;
use dem_results::Table;

use super::{Moment, Opening, Output, Saved};

struct Steps(Table);

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let path = opening.folder.path().join("steps.csv");
    let table = opening.table(&path, "time_s,time_step_s")?;
    Ok(Some(Box::new(Steps(table))))
}

impl Output for Steps {
    fn write(&mut self, now: &Moment<'_>) -> Result<()> {
        if now.row.is_none() {
            return Ok(());
        }
        let [time, step] = [now.state.time_s, now.state.time_step_s].map(exact);
        self.0.append(&format!("{time},{step}\n"))
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.0, &())
    }
}
