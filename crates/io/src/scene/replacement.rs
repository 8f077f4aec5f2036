//! `[replacement.NAME]`: NAME is a body.

use std::collections::BTreeMap;

use super::body::{BodyEntry, BodySource};
use super::clump::{ClumpMass, StartAs};
use super::field::Field;
use super::listing::Listing;
use super::region::Region;
use super::schema::{Key, Kind, Schema, words_of};
use super::table::Table;
use crate::diagnostic::Result;
use crate::units::{ENERGY, ENERGY_PER_MASS, FORCE, TIME, VELOCITY};

/// Whether all of `when` must hold, or any.
const NEEDS: [(&str, bool); 2] = [("any", false), ("all", true)];

pub(super) static REPLACEMENT: Schema = Schema {
    title: "[replacement.NAME]",
    doc: "When the clump NAME, a body with bonds, becomes its bonded cluster, and when that becomes rigid again.",
    keys: &[
        Key::table("when", &WHEN, "What must hold; at least one of its keys.")
            .required("{ enters = \"NAME\" }, a name in [regions]"),
        Key::new(
            "need",
            Kind::Word(|| words_of(&NEEDS)),
            "Any of what `when` names, or all.",
        )
        .or_word("any"),
        Key::table(
            "back",
            &BACK,
            "When a fragment becomes rigid again; all of it must hold.",
        )
        .otherwise("never"),
    ],
};

pub(super) static WHEN: Schema = Schema {
    title: "When",
    doc: "What makes a clump its bonded cluster.",
    keys: &[
        Key::text("enters", "a name in [regions]", "Its centre of mass is in this region.")
            .otherwise("not asked"),
        Key::quantity("force", &FORCE, "Contacts push it with this together.")
            .positive()
            .otherwise("not asked"),
        Key::quantity(
            "impact_energy",
            &ENERGY,
            "Contacts have taken this from its motion, over all times at which they slowed it down.",
        )
        .positive()
        .otherwise("not asked"),
        Key::quantity("time", &TIME, "So late it is.")
            .not_negative()
            .otherwise("not asked"),
    ],
};

pub(super) static BACK: Schema = Schema {
    title: "Back",
    doc: "What makes a fragment rigid again.",
    keys: &[
        Key::text("leaves", "a name in [regions]", "Its centre is outside this region.")
            .required("\"NAME\", a name in [regions]"),
        Key::new(
            "min_particles",
            Kind::Whole {
                least: 1,
                most: Some(u32::MAX as u64),
                of: "",
            },
            "It has at least so many particles.",
        )
        .remedy("a usual value is 10")
        .or(10.0),
        Key::quantity(
            "strain_energy",
            &ENERGY_PER_MASS,
            "Elastic energy of its bonds over its mass is at most this.",
        )
        .positive()
        .or(0.01),
        Key::quantity(
            "inner_speed",
            &VELOCITY,
            "Root mean square speed of its particles beside its motion as a rigid body is at most this.",
        )
        .positive()
        .or(5e-3),
    ],
};

/// When a rigid clump becomes the bonded cluster that it stands for, and when that becomes rigid
/// again.
#[derive(Debug, Clone, PartialEq)]
pub struct Replacement {
    /// `when.enters`: its centre is in this region, a name of `[regions]`. None, here and below:
    /// not asked; at least one is.
    pub enters: Option<String>,
    /// `when.force` on it reaches this, N; more than 0.
    pub force_n: Option<f64>,
    /// `when.impact_energy`, that of a contact, reaches this, J; more than 0.
    pub impact_energy_j: Option<f64>,
    /// `when.time`: so late it is, s; at least 0.
    pub time_s: Option<f64>,
    /// `need`: all that `when` has must hold ("all"), not just any ("any"). False unless given.
    pub needs_all: bool,
    /// `back`. None: what was replaced stays bonded.
    pub back: Option<Back>,
}

/// `back = { ... }`: when a fragment becomes rigid again. All of it must hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Back {
    /// `leaves`: its centre is outside this region, a name of `[regions]`.
    pub leaves: String,
    /// `min_particles`: it has at least so many, 10 unless given. At least 1.
    pub min_particles: u32,
    /// `strain_energy`: elastic energy of its bonds over its mass is at most this, 0.01 J/kg unless
    /// given; more than 0.
    pub strain_energy_j_kg: f64,
    /// `inner_speed`: root mean square speed of its particles beside its motion as a rigid body is
    /// at most this, 5 mm/s unless given; more than 0.
    pub inner_speed_m_s: f64,
}

pub(super) fn read_all(
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
    regions: &BTreeMap<String, Region>,
) -> Result<BTreeMap<String, Replacement>> {
    let mut replacements = BTreeMap::new();
    for (name, field) in root.named("replacement")? {
        check_body(root, &name, &field, bodies)?;
        replacements.insert(name, read(&field, regions)?);
    }
    Ok(replacements)
}

/// Refuses what is no clump, cannot break, or would change its mass.
fn check_body(
    root: &Table<'_>,
    name: &str,
    field: &Field<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
) -> Result<()> {
    let Some(body) = bodies.get(name) else {
        return field.key_reference(name, bodies.keys(), "bodies");
    };
    let StartAs::Clump(clump) = body.start_as else {
        let problem = format!(
            "{} replaces a clump, but the body '{name}' starts bonded",
            field.path
        );
        let remedy =
            format!("add start_as = \"clump\" to [bodies.{name}], or remove [replacement.{name}]");
        return Err(field.refuse(problem, remedy));
    };
    let has_bonds = match &body.source {
        BodySource::Inline { bonds, .. } if bonds.is_empty() => false,
        // Whoever reads the file finds whether it has some.
        _ => body.bond_kind.is_some(),
    };
    if !has_bonds {
        let problem = format!(
            "{}: body '{name}' has no bonds: it cannot break",
            field.path
        );
        let missing = match body.source {
            BodySource::Inline { ref bonds, .. } if bonds.is_empty() => "bond_list = [[0, 1]]",
            _ => "bonds = \"NAME\"",
        };
        let remedy = format!("add {missing} to [bodies.{name}], or remove [replacement.{name}]");
        return Err(field.refuse(problem, remedy));
    }
    if clump.mass == ClumpMass::Union {
        let mass = root.find(&["bodies", name, "clump", "mass"]);
        let place = mass.unwrap_or_else(|| field.clone());
        let problem = format!(
            "{} is \"union\", but [replacement.{name}] replaces it: the clump would weigh other than the cluster it becomes",
            place.path
        );
        return Err(place.refuse(problem, "write mass = \"spheres\""));
    }
    Ok(())
}

fn read(field: &Field<'_>, regions: &BTreeMap<String, Region>) -> Result<Replacement> {
    let table = Table::of(field, &REPLACEMENT)?;
    let when = Table::of(&table.need("when")?, &WHEN)?;
    if when.entries.is_empty() {
        let problem = format!("{} is an empty table", when.path);
        let remedy = "add enters = \"NAME\", force = \"100 N\", impact_energy = \"0.5 J\" or time = \"0.1 s\"";
        return Err(when.refuse(problem, remedy));
    }
    Ok(Replacement {
        enters: when.read_by("enters", |field| field.reference(regions.keys(), "regions"))?,
        force_n: when.read("force")?,
        impact_energy_j: when.read("impact_energy")?,
        time_s: when.read("time")?,
        needs_all: table
            .read_by("need", |field| field.choice(&NEEDS))?
            .unwrap_or(false),
        back: table.read_by("back", |field| back(&field, regions))?,
    })
}

fn back(field: &Field<'_>, regions: &BTreeMap<String, Region>) -> Result<Back> {
    let table = Table::of(field, &BACK)?;
    Ok(Back {
        leaves: table.need("leaves")?.reference(regions.keys(), "regions")?,
        min_particles: table.read("min_particles")?,
        strain_energy_j_kg: table.read("strain_energy")?,
        inner_speed_m_s: table.read("inner_speed")?,
    })
}

pub(super) fn list(replacement: &Replacement, listing: &mut Listing) {
    listing.table("when", &WHEN, |listing| {
        listing.text(
            "enters",
            replacement.enters.as_deref().unwrap_or("not asked"),
        );
        listing.value("force", &replacement.force_n);
        listing.value("impact_energy", &replacement.impact_energy_j);
        listing.value("time", &replacement.time_s);
    });
    listing.text("need", if replacement.needs_all { "all" } else { "any" });
    let Some(back) = &replacement.back else {
        return listing.text("back", "never");
    };
    listing.table("back", &BACK, |listing| {
        listing.text("leaves", &back.leaves);
        listing.value("min_particles", &back.min_particles);
        listing.value("strain_energy", &back.strain_energy_j_kg);
        listing.value("inner_speed", &back.inner_speed_m_s);
    });
}
