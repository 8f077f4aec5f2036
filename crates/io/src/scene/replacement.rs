//! `[replacement.NAME]`: NAME is a body.

use std::collections::BTreeMap;

use super::field::Field;
use super::table::Table;
use super::{BodyEntry, BodySource, ClumpMass, Region, StartAs};
use crate::Result;
use crate::units::{ENERGY, ENERGY_PER_MASS, FORCE, TIME, VELOCITY};

/// Whether all of `when` must hold, or any.
pub(super) const NEEDS: [(&str, bool); 2] = [("any", false), ("all", true)];

/// `min_particles` unless given.
const MIN_PARTICLES: u32 = 10;
/// `strain_energy` unless given, J/kg.
const STRAIN_ENERGY_J_KG: f64 = 0.01;
/// `inner_speed` unless given, m/s.
const INNER_SPEED_M_S: f64 = 5e-3;

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
    let table = field.table(&["when", "need", "back"])?;
    let when = table
        .need("when", "{ enters = \"NAME\" }, a name in [regions]")?
        .table(&["enters", "force", "impact_energy", "time"])?;
    if when.entries.is_empty() {
        let problem = format!("{} is an empty table", when.path);
        let remedy = "add enters = \"NAME\", force = \"100 N\", impact_energy = \"0.5 J\" or time = \"0.1 s\"";
        return Err(when.refuse(problem, remedy));
    }
    Ok(Replacement {
        enters: when.read("enters", |field| field.reference(regions.keys(), "regions"))?,
        force_n: when.read("force", |field| field.positive(&FORCE))?,
        impact_energy_j: when.read("impact_energy", |field| field.positive(&ENERGY))?,
        time_s: when.read("time", |field| field.not_negative(&TIME))?,
        needs_all: table
            .read("need", |field| field.choice(&NEEDS))?
            .unwrap_or(false),
        back: table.read("back", |field| back(&field, regions))?,
    })
}

fn back(field: &Field<'_>, regions: &BTreeMap<String, Region>) -> Result<Back> {
    let table = field.table(&["leaves", "min_particles", "strain_energy", "inner_speed"])?;
    Ok(Back {
        leaves: table
            .need("leaves", "\"NAME\", a name in [regions]")?
            .reference(regions.keys(), "regions")?,
        min_particles: table
            .read("min_particles", |field| {
                field.small_count("a usual value is 10")
            })?
            .unwrap_or(MIN_PARTICLES),
        strain_energy_j_kg: table
            .read("strain_energy", |field| field.positive(&ENERGY_PER_MASS))?
            .unwrap_or(STRAIN_ENERGY_J_KG),
        inner_speed_m_s: table
            .read("inner_speed", |field| field.positive(&VELOCITY))?
            .unwrap_or(INNER_SPEED_M_S),
    })
}
