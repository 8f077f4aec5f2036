//! `bonded_within` of `[bodies.NAME]`: a body of which only a part is bonded.

use std::collections::BTreeMap;

use super::body::{BodyEntry, BodySource};
use super::bond::{BondKind, BondModel, Formulation};
use super::clump::StartAs;
use super::field::Field;
use super::inlet::Inlet;
use super::listing::Listing;
use super::region::Region;
use super::schema::{Key, Schema};
use super::table::Table;
use super::wall::Wall;
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

/// What the zones of a scene refer to.
pub(super) struct Known<'a> {
    pub(super) bodies: &'a BTreeMap<String, BodyEntry>,
    pub(super) bonds: &'a BTreeMap<String, BondKind>,
    pub(super) inlets: &'a BTreeMap<String, Inlet>,
    pub(super) walls: &'a BTreeMap<String, Wall>,
}

/// Refuses zones of bodies that cannot have one, walls that are not there, and what has no meaning
/// beside a zone.
pub(super) fn check(root: &Table<'_>, known: &Known<'_>) -> Result<()> {
    for (name, body) in known.bodies {
        let Some(zone) = &body.bonded_within else {
            continue;
        };
        let Some(field) = root.find(&["bodies", name, "bonded_within"]) else {
            continue;
        };
        let table = Table::of(&field, &ZONE)?;
        if let (Some(_), Some(field)) = (&zone.moves_with, table.get("moves_with")) {
            field.reference(known.walls.keys(), "walls")?;
        }
        check_body(&field, name, body, known)?;
        for (key, why) in [
            ("sleep", "bodies with rigid parts do not sleep"),
            ("test", "a laboratory test bonds the whole body"),
        ] {
            if root.get(key).is_some() {
                let problem = format!("{} cannot be combined with [{key}]: {why}", field.path);
                return Err(field.refuse(problem, format!("remove it, or [{key}]")));
            }
        }
        for (replaced, _) in root.named("replacement")? {
            if root
                .find(&["replacement", &replaced, "daughters"])
                .is_some()
            {
                let problem = format!(
                    "{} cannot be combined with [replacement.{replaced}.daughters]: what a particle takes in from a rigid part is not counted",
                    field.path
                );
                return Err(field.refuse(problem, "remove one of the two"));
            }
        }
    }
    Ok(())
}

fn check_body(field: &Field<'_>, name: &str, body: &BodyEntry, known: &Known<'_>) -> Result<()> {
    let path = &field.path;
    if body.start_as != StartAs::Bonded {
        let problem = format!("{path} has no effect on a clump, which is rigid as a whole");
        return Err(field.refuse(problem, "remove start_as = \"clump\", or remove it"));
    }
    let has_bonds = match &body.source {
        BodySource::Inline { bonds, .. } => !bonds.is_empty(),
        // The reader of the file finds whether it has bonds.
        BodySource::File(_) => true,
    };
    let kind = body
        .bond_kind
        .as_ref()
        .and_then(|kind| known.bonds.get(kind));
    let Some(kind) = kind.filter(|_| has_bonds) else {
        let problem = format!("{path}: body '{name}' has no bonds");
        return Err(field.refuse(problem, "give it bonds, or remove it"));
    };
    if kind.formulation == Formulation::Incremental {
        let problem = format!(
            "{path}: the bonds of body '{name}' are incremental, and forget how a rigid part turns"
        );
        return Err(field.refuse(problem, "write formulation = \"total\" in its [bonds]"));
    }
    let is_joint = matches!(kind.model, BondModel::FlatJoint { .. });
    if kind.plasticity.is_some() || is_joint {
        let problem = format!(
            "{path}: the bonds of body '{name}' keep a history, which a rigid part does not follow"
        );
        let remedy = "take a model other than flat-joint, without plasticity, in its [bonds]";
        return Err(field.refuse(problem, remedy));
    }
    let fed = known
        .inlets
        .iter()
        .find(|(_, inlet)| inlet.bodies.iter().any(|(of, _)| of == name));
    if let Some((inlet, _)) = fed {
        let problem = format!("{path}: [inlets.{inlet}] feeds body '{name}'");
        return Err(field.refuse(problem, "place it in the scene, or remove it"));
    }
    Ok(())
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
