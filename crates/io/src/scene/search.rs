//! `[search]`

use super::field::Field;
use crate::Result;
use crate::units::NUMBER;

/// How particles that may touch are found.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Search {
    /// `skin`: how far beyond touching pairs are listed, as a share of the largest radius; in (0,
    /// 2]. None: chosen by the program.
    pub skin: Option<f64>,
}

pub(super) fn read(field: &Field<'_>) -> Result<Search> {
    let table = field.table(&["skin"])?;
    let skin = table.read("skin", |field| {
        field.limited(
            &NUMBER,
            |skin| skin > 0.0 && skin <= 2.0,
            "more than 0 and at most 2",
            "it is a share of the largest radius: leave it out, and the program chooses",
        )
    })?;
    Ok(Search { skin })
}
