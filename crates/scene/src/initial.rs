//! `[initial.NAME]`

use super::field::Field;
use super::listing::Listing;
use super::schema::{Key, Schema};
use super::table::Table;
use super::targets::{GROUP_KEY, Targets};
use dem_io::diagnostic::Result;
use dem_io::units::{ANGULAR_VELOCITY, LENGTH, VELOCITY};

/// Initial motion of the particles of a group, in addition to that of their bodies. If several of
/// these apply to a particle, they are added.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// `group`: a group, a body or `all`.
    pub group: String,
    /// `velocity` of each particle, m/s; 0 unless given. Length 3.
    pub velocity_m_s: [f64; 3],
    /// `angular_velocity` of the group as one rigid body about its centre of mass, rad/s; 0 unless
    /// given. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// `displacement` of each particle from the rest position of its bonds, m; 0 unless given.
    /// Length 3.
    pub displacement_m: [f64; 3],
}

pub(super) static INITIAL: Schema = Schema {
    title: "[initial.NAME]",
    doc: "Initial motion and displacement of a group, added to those of its bodies.",
    keys: &[
        GROUP_KEY,
        Key::vector("velocity", &VELOCITY, "Velocity of each particle."),
        Key::vector(
            "angular_velocity",
            &ANGULAR_VELOCITY,
            "Angular velocity of the group as one rigid body about its centre of mass.",
        ),
        Key::vector(
            "displacement",
            &LENGTH,
            "Displacement of each particle from where its bonds are stress-free.",
        ),
    ],
};

pub(super) fn read(field: &Field<'_>, targets: &Targets<'_>) -> Result<Initial> {
    let table = Table::of(field, &INITIAL)?;
    let group = targets.name(&table.need("group")?)?;
    if table.entries.len() == 1 {
        let remedy = "add velocity, angular_velocity or displacement, such as \
                      displacement = [0, 0, \"1 mm\"]";
        return Err(table.fault("does not say how its particles start", remedy));
    }
    Ok(Initial {
        group,
        velocity_m_s: table.read("velocity")?,
        angular_velocity_rad_s: table.read("angular_velocity")?,
        displacement_m: table.read("displacement")?,
    })
}

pub(super) fn list(initial: &Initial, listing: &mut Listing) {
    listing.text("group", &initial.group);
    listing.value("velocity", &initial.velocity_m_s);
    listing.value("angular_velocity", &initial.angular_velocity_rad_s);
    listing.value("displacement", &initial.displacement_m);
}
