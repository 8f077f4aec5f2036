//! The time series, `series.csv`.

use dem_io::Result;
use dem_results::SeriesFile;

use super::{Moment, Opening, Output, Saved, TableEnd};
use crate::output::series::{columns, row};

struct Series(SeriesFile);

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let path = opening.folder.series();
    let columns = columns(opening.scene.walls.keys(), opening.probes);
    let file = match opening.position::<TableEnd>()? {
        None => SeriesFile::create(&path, &columns)?,
        Some(end) => SeriesFile::continue_at(&path, &columns, end.bytes)?,
    };
    Ok(Some(Box::new(Series(file))))
}

impl Output for Series {
    fn write(&mut self, now: &Moment<'_>) -> Result<()> {
        let Some((balance, values)) = now.row else {
            return Ok(());
        };
        let row = row(now.state, balance, values);
        self.0.append(now.state.time_s, &row)
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.0.table, &())
    }
}
