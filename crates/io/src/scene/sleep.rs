//! `[sleep]`

use super::field::Field;
use crate::Result;
use crate::units::{TIME, VELOCITY};

/// When bodies at rest are no more stepped, until something comes near them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sleep {
    /// `speed`: no point of a body that falls asleep is faster, 1 mm/s unless given; more than 0.
    pub speed_m_s: f64,
    /// `after`: it has been as slow for so long, 50 ms unless given; more than 0 s.
    pub after_s: f64,
}

impl Default for Sleep {
    fn default() -> Self {
        Self {
            speed_m_s: 1e-3,
            after_s: 0.05,
        }
    }
}

pub(super) fn read(field: &Field<'_>) -> Result<Sleep> {
    let table = field.table(&["speed", "after"])?;
    let usual = Sleep::default();
    Ok(Sleep {
        speed_m_s: table
            .read("speed", |field| field.positive(&VELOCITY))?
            .unwrap_or(usual.speed_m_s),
        after_s: table
            .read("after", |field| field.positive(&TIME))?
            .unwrap_or(usual.after_s),
    })
}
