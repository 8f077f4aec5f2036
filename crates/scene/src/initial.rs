//! `[initial.NAME]`

use super::field::Field;
use super::plain_table::plain_table;
use super::table::Table;
use super::targets::Targets;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGULAR_VELOCITY, LENGTH, VELOCITY};

plain_table! {
    INITIAL = "[initial.NAME]";
    /// Initial motion and displacement of a group, added to those of its bodies.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Initial {
        /// The particles that it acts on.
        group: String = group("group");
        /// Velocity of each particle.
        velocity_m_s: [f64; 3] = vector("velocity", &VELOCITY);
        /// Angular velocity of the group as one rigid body about its centre of mass.
        angular_velocity_rad_s: [f64; 3] = vector("angular_velocity", &ANGULAR_VELOCITY);
        /// Displacement of each particle from where its bonds are stress-free.
        displacement_m: [f64; 3] = vector("displacement", &LENGTH);
    }
}

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Initial> {
    let table = Table::of(field, &INITIAL)?;
    targets.name(&table.need("group")?)?;
    if table.entries.len() == 1 {
        let remedy = "add velocity, angular_velocity or displacement, such as \
                      displacement = [0, 0, \"1 mm\"]";
        return Err(table.fault("does not say how its particles start", remedy));
    }
    Initial::read(&table)
}
