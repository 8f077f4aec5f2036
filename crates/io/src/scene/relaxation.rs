//! `[relaxation]`

use super::field::Field;
use crate::Result;
use crate::units::NUMBER;

/// What becomes of overlaps between particles that cease to be of one piece (Platzer 2022, 4.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// `enabled`: such an overlap becomes the origin of the pair's contact law. True unless given.
    pub enabled: bool,
    /// `min_overlap`: smaller ones, as a share of the reduced radius, are not kept. 1e-5 unless
    /// given; in [0, 1). The force that a pair then has at once gives it energy, which grows with
    /// this to the power of 2.5: at 1e-3 a whole body can gain 1e-4 of its own.
    pub min_overlap: f64,
}

impl Default for Relaxation {
    fn default() -> Self {
        Self {
            enabled: true,
            min_overlap: 1e-5,
        }
    }
}

pub(super) fn read(field: &Field<'_>) -> Result<Relaxation> {
    let table = field.table(&["enabled", "min_overlap"])?;
    let usual = Relaxation::default();
    Ok(Relaxation {
        enabled: table
            .read("enabled", |field| field.boolean())?
            .unwrap_or(usual.enabled),
        min_overlap: table
            .read("min_overlap", |field| {
                field.limited(
                    &NUMBER,
                    |share| (0.0..1.0).contains(&share),
                    "at least 0 and less than 1",
                    "it is a share of the reduced radius: a usual value is 1e-5",
                )
            })?
            .unwrap_or(usual.min_overlap),
    })
}
