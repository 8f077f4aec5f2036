//! `[materials.NAME]`

use std::ops::Bound::{Excluded, Included};

use super::breakage_law;
use super::field::Field;
use super::listing::Listing;
use super::schema::{Key, table_schema};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{DENSITY, STRESS};
use dem_physics::breakage::BreakageLaw;

/// Properties of the material of particles and walls.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// `density`, kg/m3. None: the density in the body's file; bodies whose particles are in the
    /// scene have none.
    pub density_kg_m3: Option<f64>,
    /// `young_modulus`, Pa; or from `shear_modulus` and `poisson_ratio`. None: not given; only
    /// contacts and Rayleigh's estimate need it.
    pub young_modulus_pa: Option<f64>,
    /// `poisson_ratio`, in (-1, 0.5]. 0.3 unless given.
    pub poisson_ratio: f64,
    /// `rigid`: does not deform; only for walls, and without the values above. False unless given.
    pub rigid: bool,
    /// `breakage`: how its particles break by energy. None: no law.
    pub breakage: Option<BreakageLaw>,
}

/// Keys of a deformable material.
const OF_ELASTIC: [&str; 5] = [
    "density",
    "young_modulus",
    "shear_modulus",
    "poisson_ratio",
    "breakage",
];

table_schema! {
    /// Material of particles and walls.
    pub(super) static MATERIAL = "[materials.NAME]";

    /// Density of the spheres.
    quantity("density", &DENSITY).positive().otherwise("from the body, where one needs it");
    /// Young's modulus; required for the law `hertz-mindlin` and for Rayleigh's estimate of the
    /// step.
    quantity("young_modulus", &STRESS).positive();
    /// Shear modulus, instead of `young_modulus`.
    quantity("shear_modulus", &STRESS).positive();
    /// Poisson's ratio.
    poisson_ratio().or(0.3);
    /// The material does not deform; for walls only, and instead of all other keys.
    flag("rigid", false);
    /// How particles break by the energy that they take in, for `[replacement.NAME.breakage]`.
    table("breakage", &breakage_law::LAW).otherwise("no law");
}

impl Key {
    /// The key `poisson_ratio`.
    pub(super) const fn poisson_ratio(doc: &'static str) -> Self {
        Self::number("poisson_ratio", doc)
            .within(Excluded(-1.0), Included(0.5))
            .remedy("a usual value is 0.3")
    }
}

pub(super) fn read(field: &Field<'_>) -> Result<Material> {
    let table = Table::of(field, &MATERIAL)?;
    let rigid = table.read("rigid")?;
    if let (true, Some((_, field))) = (rigid, table.given(&OF_ELASTIC).next()) {
        let remedy = "remove one of them: a rigid wall does not deform and has no mass";
        return Err(field.fault("cannot be combined with rigid = true", remedy));
    }
    let density_kg_m3 = table.read("density")?;
    let young: Option<f64> = table.read("young_modulus")?;
    let shear: Option<f64> = table.read("shear_modulus")?;
    let poisson_ratio = table.read("poisson_ratio")?;
    if let (Some(_), Some(_), Some(field)) = (young, shear, table.get("shear_modulus")) {
        let problem = "cannot be combined with young_modulus";
        return Err(field.fault(problem, "one follows from the other: remove one"));
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
        breakage: table.read_by("breakage", |field| breakage_law::read(&field))?,
    })
}

pub(super) fn list(material: &Material, listing: &mut Listing) {
    if material.rigid {
        return listing.value("rigid", &material.rigid);
    }
    listing.value("density", &material.density_kg_m3);
    listing.value("young_modulus", &material.young_modulus_pa);
    listing.value("poisson_ratio", &material.poisson_ratio);
    if let Some(law) = &material.breakage {
        listing.table("breakage", &breakage_law::LAW, |listing| {
            breakage_law::list(law, listing);
        });
    }
}
