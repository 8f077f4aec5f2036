//! `daughters` of `[replacement.NAME]`: the pieces that replace a particle, by the energy that it
//! takes in.

use std::collections::BTreeMap;

use super::body::BodyEntry;
use super::field::Field;
use super::listing::Listing;
use super::numbers::quantity;
use super::plain_table::keyed_struct;
use super::schema::{Kind, Word};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ENERGY_PER_MASS, LENGTH};

/// Largest number of replacements of a body unless given.
const LIMIT: f64 = 1e6;

keyed_struct! {
    SIZE_CLASS = "Size class";
    /// The daughters of particles that have taken in at least this energy.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SizeClass {
        /// Least energy over the mass of the particle.
        from_j_kg: f64 = quantity("from", &ENERGY_PER_MASS).positive().required("\"20 J/kg\"");
        /// The daughters: a packing of loose spheres, or a body with bonds. It is not in the scene
        /// at the start.
        body: String = text("body", "a name in [bodies]").required("\"NAME\", a name in [bodies]");
    }
}

keyed_struct! {
    DAUGHTERS = "Daughters";
    /// Pieces that replace a particle once it has taken in enough energy.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Daughters {
        /// Size classes, by ascending energy: `[{ from = "20 J/kg", body = "NAME" }, ...]`. The
        /// first energy is the strength of the particle.
        classes: Vec<SizeClass> = new("classes", Kind::List(&Kind::Table(&SIZE_CLASS)))
            .required("[{ from = \"20 J/kg\", body = \"NAME\" }]");
        /// The energy that counts: that of `one-impact`, or the sum of `all-impacts` so far.
        energy: CountedEnergy = word::<CountedEnergy>("energy", "one-impact");
        /// The energies of the classes follow a Weibull distribution with this modulus, with one
        /// factor for each particle; the given energies are its scale.
        weibull_modulus: Option<f64> = number("weibull_modulus")
            .positive()
            .otherwise("all particles are equal");
        /// Daughters of this diameter and larger ones are replaced in turn, smaller ones never.
        smallest_size_m: Option<f64> = quantity("smallest_size", &LENGTH)
            .positive()
            .otherwise("daughters are not replaced");
        /// Largest number of particles of this body that are replaced; then the others stay whole.
        limit: u32 = new("limit", Kind::COUNT).remedy("a usual value is 100000").or(LIMIT);
    }
}

/// The energy that decides on the replacement of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CountedEnergy {
    /// "one-impact": from the first touch until the particle touches nothing.
    OneImpact,
    /// "all-impacts": the sum over all impacts so far.
    AllImpacts,
}

impl Word for CountedEnergy {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("one-impact", Self::OneImpact),
        ("all-impacts", Self::AllImpacts),
    ];
}

/// From the table in `field`, of the body `parent`.
pub(super) fn read(
    field: &Field<'_>,
    parent: &str,
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
) -> Result<Daughters> {
    let table = Table::of(field, &DAUGHTERS)?;
    let mut classes: Vec<SizeClass> = Vec::new();
    for item in table.need("classes")?.items()? {
        let class = Table::of(&item, &SIZE_CLASS)?;
        let named = class.need("body")?;
        let body = named.reference(bodies.keys(), "bodies")?;
        check_body(&named, &body, parent, root, bodies)?;
        let from_j_kg = class.read("from")?;
        if let Some(before) = classes.last().filter(|class| class.from_j_kg >= from_j_kg) {
            let limit = format!(
                "more than {} J/kg, that of the class before",
                before.from_j_kg
            );
            let remedy = "list the classes by ascending energy";
            return Err(class.need("from")?.wrong(&limit, remedy));
        }
        classes.push(SizeClass { from_j_kg, body });
    }
    Ok(Daughters {
        classes,
        energy: table.read("energy")?,
        weibull_modulus: table.read("weibull_modulus")?,
        smallest_size_m: table.read("smallest_size")?,
        limit: table.read("limit")?,
    })
}

/// Refuses daughters that are the particle itself, of another material, or have a place, a motion
/// or a mass of their own: these are the parent's.
fn check_body(
    named: &Field<'_>,
    body: &str,
    parent: &str,
    root: &Table<'_>,
    bodies: &BTreeMap<String, BodyEntry>,
) -> Result<()> {
    if body == parent {
        let remedy = "name a body of several spheres, its daughters";
        return Err(named.fault("is the body that is replaced", remedy));
    }
    let materials = [body, parent].map(|name| bodies.get(name).map(|entry| &entry.material));
    if let ([Some(own), Some(of_parent)], true) = (materials, materials[0] != materials[1]) {
        let problem = format!(
            "is \"{body}\" of material '{own}', but the particle '{parent}' is of '{of_parent}'"
        );
        let remedy = format!("write material = \"{of_parent}\" in [bodies.{body}]");
        return Err(named.fault(problem, remedy));
    }
    for key in [
        "position",
        "rotation",
        "velocity",
        "drop",
        "angular_velocity",
        "mass",
        "body_density",
    ] {
        if let Some(field) = root.find(&["bodies", body, key]) {
            let problem = format!(
                "has no effect: daughters of '{parent}' take over its place, motion and mass"
            );
            return Err(field.fault(problem, "remove it"));
        }
    }
    for key in ["start_as", "clump"] {
        if let Some(field) = root.find(&["bodies", body, key]) {
            let problem = format!(
                "has no effect: daughters of '{parent}' are loose spheres, or bonded if their file has bonds"
            );
            return Err(field.fault(problem, "remove it"));
        }
    }
    if let Some(field) = root.find(&["replacement", body, "daughters"]) {
        let problem = format!("belongs to a body that is daughters of '{parent}' itself");
        let remedy = format!(
            "write smallest_size in [replacement.{parent}.daughters], whose loose daughters are then replaced in turn"
        );
        return Err(field.fault(problem, remedy));
    }
    Ok(())
}

pub(super) fn list(daughters: &Daughters, listing: &mut Listing) {
    let class =
        |class: &SizeClass| format!("from {}: {}", quantity(class.from_j_kg, "J/kg"), class.body);
    let classes: Vec<String> = daughters.classes.iter().map(class).collect();
    listing.text("classes", classes.join(", "));
    listing.value("energy", &daughters.energy);
    listing.value("weibull_modulus", &daughters.weibull_modulus);
    listing.value("smallest_size", &daughters.smallest_size_m);
    listing.value("limit", &daughters.limit);
}
