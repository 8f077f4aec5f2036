//! `[materials.NAME]`

use super::Material;
use super::field::Field;
use crate::Result;
use crate::units::{DENSITY, STRESS};

/// What a material that deforms can have.
const OF_ELASTIC: [&str; 4] = ["density", "young_modulus", "shear_modulus", "poisson_ratio"];

const KEYS: [&str; 5] = [
    "density",
    "young_modulus",
    "shear_modulus",
    "poisson_ratio",
    "rigid",
];

/// `poisson_ratio` unless given.
const POISSON_RATIO: f64 = 0.3;

pub(super) fn read(field: &Field<'_>) -> Result<Material> {
    let table = field.table(&KEYS)?;
    let rigid = table
        .read("rigid", |field| field.boolean())?
        .unwrap_or_default();
    if let (true, Some((_, field))) = (rigid, table.given(&OF_ELASTIC).next()) {
        let problem = format!("{} stands beside rigid = true", field.path);
        let remedy = "remove one of them: a rigid wall does not deform and has no mass";
        return Err(field.refuse(problem, remedy));
    }
    let density_kg_m3 = table.read("density", |field| field.positive(&DENSITY))?;
    let young = table.read("young_modulus", |field| field.positive(&STRESS))?;
    let shear = table.read("shear_modulus", |field| field.positive(&STRESS))?;
    let poisson_ratio = table
        .read("poisson_ratio", |field| field.poisson_ratio())?
        .unwrap_or(POISSON_RATIO);
    if let (Some(_), Some(_), Some(field)) = (young, shear, table.get("shear_modulus")) {
        let problem = format!("{} stands beside young_modulus", field.path);
        return Err(field.refuse(problem, "one follows from the other: remove one"));
    }
    let young_modulus_pa = young.or(shear.map(|shear| 2.0 * shear * (1.0 + poisson_ratio)));
    if let (Some(field), true) = (
        table.get("shear_modulus"),
        young_modulus_pa.is_some_and(f64::is_infinite),
    ) {
        return Err(field.wrong("less than 1e307 Pa", "write a smaller number"));
    }
    Ok(Material {
        density_kg_m3,
        young_modulus_pa,
        poisson_ratio,
        rigid,
    })
}
