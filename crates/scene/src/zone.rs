//! `bonded_within` of `[bodies.NAME]`: a body of which only a part is bonded.

use std::collections::BTreeMap;

use super::field::Field;
use super::listing::Listing;
use super::plain_table::{keyed_struct, plain_table};
use super::region::Region;
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ENERGY_PER_MASS, VELOCITY};

keyed_struct! {
    ZONE = "Bonded zone";
    /// The part of a body that is bonded. Spheres outside it that are bonded to each other move as
    /// rigid parts.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Zone {
        /// Spheres whose centres are in this region are bonded.
        region: String = text("region", "a name in [regions]")
            .required("\"NAME\", a name in [regions]");
        /// The region moves and turns with this wall. It lies where `[regions]` puts it at the
        /// start.
        moves_with: Option<String> = text("moves_with", "a name in [walls]")
            .otherwise("the region does not move");
        /// Conditions under which a sphere that the region has left joins a rigid part again,
        /// bonded to one, all its bonds intact; all must hold.
        rejoin: Option<Rejoin> = table("rejoin", &REJOIN).otherwise("never");
    }
}

plain_table! {
    REJOIN = "Rejoin";
    /// Conditions under which a sphere joins a rigid part again.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Rejoin {
        /// Elastic energy of its bonds over its mass is at most this.
        strain_energy_j_kg: f64 = quantity("strain_energy", &ENERGY_PER_MASS).positive().or(0.01);
        /// Its velocity relative to the rigid part, and that of its surface as it turns relative to
        /// it, are at most this.
        fluctuation_velocity_m_s: f64 = quantity("fluctuation_velocity", &VELOCITY)
            .positive()
            .or(5e-3);
    }
}

pub(super) fn read(field: &Field<'_>, regions: &BTreeMap<String, Region>) -> Result<Zone> {
    let table = Table::of(field, &ZONE)?;
    Ok(Zone {
        region: table.need("region")?.reference(regions.keys(), "regions")?,
        moves_with: table.read("moves_with")?,
        rejoin: table.read_by("rejoin", |field| Rejoin::read(&Table::of(&field, &REJOIN)?))?,
    })
}

pub(super) fn list(zone: &Zone, listing: &mut Listing) {
    listing.text("region", &zone.region);
    listing.value("moves_with", &zone.moves_with);
    let Some(rejoin) = &zone.rejoin else {
        return listing.text("rejoin", "never");
    };
    listing.table("rejoin", &REJOIN, |listing| rejoin.list(listing));
}
