//! `bonded_within` of `[bodies.NAME]`: a body of which only a part is bonded.

use std::collections::BTreeMap;

use super::field::Field;
use super::listing::Listing;
use super::region::Region;
use super::schema::{Key, Schema};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ENERGY_PER_MASS, VELOCITY};

pub(super) static ZONE: Schema = Schema {
    title: "Bonded zone",
    doc: "The part of a body that is bonded. Spheres outside it that are bonded to each other move as rigid parts.",
    keys: &[
        Key::text(
            "region",
            "a name in [regions]",
            "Spheres whose centres are in this region are bonded.",
        )
        .required("\"NAME\", a name in [regions]"),
        Key::text(
            "moves_with",
            "a name in [walls]",
            "The region moves and turns with this wall. It lies where `[regions]` puts it at the start.",
        )
        .otherwise("the region does not move"),
        Key::table(
            "rejoin",
            &REJOIN,
            "Conditions under which a sphere that the region has left joins a rigid part again, bonded to one, all its bonds intact; all must hold.",
        )
        .otherwise("never"),
    ],
};

pub(super) static REJOIN: Schema = Schema {
    title: "Rejoin",
    doc: "Conditions under which a sphere joins a rigid part again.",
    keys: &[
        Key::quantity(
            "strain_energy",
            &ENERGY_PER_MASS,
            "Elastic energy of its bonds over its mass is at most this.",
        )
        .positive()
        .or(0.01),
        Key::quantity(
            "fluctuation_velocity",
            &VELOCITY,
            "Its velocity relative to the rigid part, and that of its surface as it turns relative to it, are at most this.",
        )
        .positive()
        .or(5e-3),
    ],
};

/// `bonded_within = { ... }`: the part of a body that is bonded.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// `region`: a name of `[regions]`.
    pub region: String,
    /// `moves_with`: a name of `[walls]`. None: the region does not move.
    pub moves_with: Option<String>,
    /// `rejoin`. None: spheres that were bonded once stay bonded.
    pub rejoin: Option<Rejoin>,
}

/// `rejoin = { ... }`: conditions under which a sphere joins a rigid part again. All must hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rejoin {
    /// `strain_energy`: largest elastic energy of its bonds over its mass, 0.01 J/kg unless given;
    /// more than 0.
    pub strain_energy_j_kg: f64,
    /// `fluctuation_velocity`: largest velocity relative to the rigid part, 5 mm/s unless given;
    /// more than 0.
    pub fluctuation_velocity_m_s: f64,
}

pub(super) fn read(field: &Field<'_>, regions: &BTreeMap<String, Region>) -> Result<Zone> {
    let table = Table::of(field, &ZONE)?;
    Ok(Zone {
        region: table.need("region")?.reference(regions.keys(), "regions")?,
        moves_with: table.read_by("moves_with", |field| Ok(field.text()?.to_owned()))?,
        rejoin: table.read_by("rejoin", |field| {
            let table = Table::of(&field, &REJOIN)?;
            Ok(Rejoin {
                strain_energy_j_kg: table.read("strain_energy")?,
                fluctuation_velocity_m_s: table.read("fluctuation_velocity")?,
            })
        })?,
    })
}

pub(super) fn list(zone: &Zone, listing: &mut Listing) {
    listing.text("region", &zone.region);
    listing.text(
        "moves_with",
        zone.moves_with
            .as_deref()
            .unwrap_or("the region does not move"),
    );
    let Some(rejoin) = &zone.rejoin else {
        return listing.text("rejoin", "never");
    };
    listing.table("rejoin", &REJOIN, |listing| {
        listing.value("strain_energy", &rejoin.strain_energy_j_kg);
        listing.value("fluctuation_velocity", &rejoin.fluctuation_velocity_m_s);
    });
}
