//! `[initial.NAME]`

use super::field::Field;
use super::targets::Targets;
use crate::Result;
use crate::units::{ANGULAR_VELOCITY, LENGTH, VELOCITY};

/// How the particles of a set start, on top of how their bodies do. What several of these say of a
/// particle adds up.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// `of`: a set, a body or `all`.
    pub of: String,
    /// `velocity` of each particle, m/s; 0 unless given. Length 3.
    pub velocity_m_s: [f64; 3],
    /// `angular_velocity` of the set as one rigid body about its centre of mass, rad/s; 0 unless
    /// given. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// `displacement` of each particle from where its bonds are at rest, m; 0 unless given.
    /// Length 3.
    pub displacement_m: [f64; 3],
}

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Initial> {
    let table = field.table(&["of", "velocity", "angular_velocity", "displacement"])?;
    let of = targets.name(&table.need("of", "\"NAME\", a set, a body or \"all\"")?)?;
    if table.entries.len() == 1 {
        let problem = format!("{} does not say how its particles start", table.path);
        let remedy = "add velocity, angular_velocity or displacement, such as \
                      displacement = [0, 0, \"1 mm\"]";
        return Err(table.refuse(problem, remedy));
    }
    Ok(Initial {
        of,
        velocity_m_s: table
            .read("velocity", |field| field.vector(&VELOCITY))?
            .unwrap_or_default(),
        angular_velocity_rad_s: table
            .read("angular_velocity", |field| field.vector(&ANGULAR_VELOCITY))?
            .unwrap_or_default(),
        displacement_m: table
            .read("displacement", |field| field.vector(&LENGTH))?
            .unwrap_or_default(),
    })
}
