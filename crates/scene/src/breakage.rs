//! `[replacement.NAME.breakage]`: particles that break by the law of their material.

use super::body::BodyEntry;
use super::field::Field;
use super::material::Material;
use super::plain_table::plain_table;
use super::schema::Kind;
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::LENGTH;
use dem_physics::breakage::SMALLEST_T10;
use std::collections::BTreeMap;
use std::ops::Bound::{Excluded, Unbounded};

/// Largest number of replacements of a body unless given.
const LIMIT: f64 = 1e6;

plain_table! {
    BREAKAGE = "Breakage";
    /// The particle breaks by the breakage law of its material: into loose spheres within it, whose
    /// sizes follow from the energy that it took in. These break in turn. Below a t10 of 1 % it
    /// does not break.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Breakage {
        /// Fragments smaller than this are not made: their mass is recorded as fines.
        smallest_size_m: f64 = quantity("smallest_size", &LENGTH).positive().required("\"4 mm\"");
        /// gamma of Tavares 2009: impacts below the fracture energy damage the particle, the small
        /// ones less, the larger the exponent; about 5 for ores.
        damage_exponent: Option<f64> = number("damage_exponent")
            .within(Excluded(2.5), Unbounded)
            .remedy("a usual value is 5")
            .otherwise("they leave no trace");
        /// t10 at which the particle breaks while its contacts still press harder; the pieces take
        /// the rest. Small for jaws and rolls, which press on.
        at_once_from_t10: Option<f64> = number("at_once_from_t10")
            .within(Excluded(0.0), Excluded(1.0))
            .remedy("a usual value is 0.05")
            .otherwise("90 % of the largest");
        /// Largest number of particles of this body that break; then the others stay whole.
        limit: u32 = new("limit", Kind::COUNT).remedy("a usual value is 100000").or(LIMIT);
    }
}

/// From the table in `field`, of the body `name`, whose material has a law.
pub(super) fn read(
    field: &Field<'_>,
    name: &str,
    bodies: &BTreeMap<String, BodyEntry>,
    materials: &BTreeMap<String, Material>,
) -> Result<Breakage> {
    let table = Table::of(field, &BREAKAGE)?;
    let material = bodies.get(name).map(|body| body.material.as_str());
    let known = material.and_then(|material| materials.get(material));
    if let (Some(name), Some(Material { breakage: None, .. })) = (material, known) {
        let problem = format!("needs a breakage law, which the material '{name}' does not have");
        let remedy = format!(
            "add [materials.{name}.breakage], or include the file that dem-run lab --type drop-weight writes"
        );
        return Err(field.fault(problem, remedy));
    }
    let breakage = Breakage::read(&table)?;
    let law = known.and_then(|material| material.breakage);
    if let (Some(field), Some(at_once), Some(law)) = (
        table.get("at_once_from_t10"),
        breakage.at_once_from_t10,
        law,
    ) && !(SMALLEST_T10..law.largest_t10).contains(&at_once)
    {
        let limit = format!(
            "at least {SMALLEST_T10}, below which nothing breaks, and less than the largest_t10 of its law, {}",
            law.largest_t10
        );
        return Err(field.wrong(&limit, "a usual value is 0.05"));
    }
    Ok(breakage)
}
