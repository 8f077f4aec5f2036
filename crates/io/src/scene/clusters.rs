//! `[clusters]`

use super::field::Field;
use crate::Result;

/// When damaged bodies are searched for their pieces (Platzer 2022, 4.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clusters {
    /// `interval`: steps between two looks at what has broken, 50 unless given. At least 1.
    pub interval: u64,
    /// `min_broken`: bonds that must have broken since the last search for another, 1 unless given.
    /// At least 1.
    pub min_broken: u64,
    /// `force_every`: so many intervals after the last search there is another in any case. 0,
    /// unless given: never.
    pub force_every: u64,
}

impl Default for Clusters {
    fn default() -> Self {
        Self {
            interval: 50,
            min_broken: 1,
            force_every: 0,
        }
    }
}

pub(super) fn read(field: &Field<'_>) -> Result<Clusters> {
    let table = field.table(&["interval", "min_broken", "force_every"])?;
    let usual = Clusters::default();
    Ok(Clusters {
        interval: table
            .read("interval", |field| field.count("a usual value is 50"))?
            .unwrap_or(usual.interval),
        min_broken: table
            .read("min_broken", |field| field.count("1 stands for any bond"))?
            .unwrap_or(usual.min_broken),
        force_every: table
            .read("force_every", |field| {
                field.whole(u64::MAX, "write 0 for never")
            })?
            .unwrap_or(usual.force_every),
    })
}
