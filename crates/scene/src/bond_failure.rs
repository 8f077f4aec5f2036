//! `failure` of `[bonds.NAME]`

use super::conflicts;
use super::field::Field;
use super::listing::Listing;
use super::schema::{Key, Kind, Schema, Word};
use super::table::Table;
use super::tree::Value;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGLE, ENERGY_PER_AREA, RATE, STRESS};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;
use std::ops::Bound::{Excluded, Included};

/// The quantity whose rate strengthens bonds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub enum StrainRateMeasure {
    /// "elongation": relative velocity along the bond over its initial length.
    #[default]
    Elongation,
    /// "relative-velocity": the full relative velocity over the initial length, as printed in
    /// Platzer 2022, eq. 21. It also gives a rate for a bond that only rotates.
    RelativeVelocity,
}

/// The stresses that count in the equivalent stress of Platzer 2022, eq. 13.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub enum EquivalentStress {
    /// "forces-only": the axial stress if it is tensile, and the shear force; no moments.
    #[default]
    ForcesOnly,
    /// "axial-in-tension": the axial stress if it is tensile, and the bending stress always; shear
    /// and torsion.
    AxialInTension,
    /// "tensile-edge": axial and bending stress at the edge with the largest tension, if their sum
    /// is tensile.
    TensileEdge,
    /// "bond-in-tension": axial and bending stress while the axial force is tensile.
    BondInTension,
}

/// Failure criteria of a bond; the first one met breaks it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BondFailure {
    /// `tensile_strength`: largest stress at the tensile edge, F_n/A + M_ben r/I, Pa (MUSEN's
    /// sigma_max with the sign of the force).
    pub tensile_strength_pa: Option<f64>,
    /// `compressive_strength`: largest compressive stress at the edge, -F_n/A + M_ben r/I, Pa.
    /// None: no failure in compression.
    pub compressive_strength_pa: Option<f64>,
    /// `shear_strength`: largest shear stress, Pa (MUSEN's tau_max).
    pub shear_strength_pa: Option<f64>,
    /// `cohesion`: largest tau + sigma tan(phi), Pa, with sigma = F_n/A, tension positive (Mohr and
    /// Coulomb). Given with the friction angle only.
    pub cohesion_pa: Option<f64>,
    /// `friction_angle`: phi there, rad, from 0 to below a right angle.
    pub friction_angle_rad: Option<f64>,
    /// `von_mises_strength`: largest equivalent stress, Pa (Platzer 2022, eqs. 11-13).
    pub von_mises_strength_pa: Option<f64>,
    /// `equivalent_stress`: the stresses that count in it, those of axial tension and shear forces
    /// unless given.
    pub equivalent_stress: EquivalentStress,
    /// `rate_strengthening`: strain rate above which all strengths except the compressive one rise
    /// with the rate (Platzer 2022, eqs. 20, 21), 1/s; `true` stands for 4.64e-6. None: never.
    pub rate_strengthening_from_1_s: Option<f64>,
    /// `strain_rate_measure`: the measure of that rate, the elongation unless given.
    pub strain_rate_measure: StrainRateMeasure,
    /// `fracture_energy`: energy per area that it takes to pull the bond apart, J/m2: beyond its
    /// strength it softens. None: it breaks at its strength.
    pub fracture_energy_j_m2: Option<f64>,
    /// `weibull_modulus`: strengths scatter by a Weibull distribution of this modulus whose scale
    /// is the given strength. None: all bonds are equal.
    pub weibull_modulus: Option<f64>,
}

/// Value of `rate_strengthening = true`, 1/s: where the strength of [Platzer 2022, eqs. 20, 21]
/// begins to rise.
const RATE_STRENGTHENING_FROM: f64 = 4.64e-6;

pub(super) static FAILURE: Schema = Schema {
    title: "Failure",
    doc: "Failure criteria of a bond; the first that is met breaks it. At least one strength is required.",
    keys: &[
        Key::quantity("tensile_strength", &STRESS, "Largest tensile stress that the edge of the bond can bear.").not_negative(),
        Key::quantity(
            "compressive_strength",
            &STRESS,
            "Largest compressive stress that the edge of the bond can bear; without it no bond breaks in compression.",
        )
        .not_negative(),
        Key::quantity("shear_strength", &STRESS, "Largest shear stress that the bond can bear.").not_negative(),
        Key::quantity(
            "cohesion",
            &STRESS,
            "Largest shear stress that the bond can bear without axial force, by Mohr-Coulomb; needs `friction_angle`.",
        )
        .not_negative(),
        Key::quantity(
            "friction_angle",
            &ANGLE,
            "Its tangent times the axial pressure adds to `cohesion`, times the axial tension is subtracted (Mohr-Coulomb).",
        )
        .within(Included(0.0), Excluded(FRAC_PI_2))
        .remedy("write an angle such as \"35 deg\""),
        Key::quantity(
            "von_mises_strength",
            &STRESS,
            "Largest equivalent stress that the bond can bear (Platzer 2022, eqs. 11 to 13).",
        )
        .not_negative(),
        Key::word::<EquivalentStress>(
            "equivalent_stress",
            "forces-only",
            "Stresses that count in the equivalent stress: `forces-only`, the axial stress if it is tensile, and the shear \
             force, but no moments. The others count shear and torsion, and `axial-in-tension` the axial stress if it is tensile \
             and bending always, `tensile-edge` axial and bending stress at the edge with the largest tension, `bond-in-tension` \
             both, but only while the axial force is tensile.",
        ),
        Key::new(
            "rate_strengthening",
            Kind::Either(&[Kind::Boolean, Kind::Quantity(&RATE)]),
            "Strain rate above which all strengths except the compressive one rise with the rate (Platzer 2022, eqs. 20 \
             and 21); `true` means 4.64e-6 1/s.",
        )
        .positive()
        .remedy("write true, or a strain rate such as \"4.64e-6 1/s\""),
        Key::quantity(
            "fracture_energy",
            &ENERGY_PER_AREA,
            "Energy per area that it takes to pull or shear a bond apart: beyond its strength the bond softens, by a damage \
             that stays, until this is spent (cohesive zone). Without it a bond breaks at its strength.",
        )
        .positive(),
        Key::number(
            "weibull_modulus",
            "Strengths follow a Weibull distribution with this modulus; the given strength is its scale.",
        )
        .positive(),
        Key::word::<StrainRateMeasure>(
            "strain_rate_measure",
            "elongation",
            "Strain rate that `rate_strengthening` uses: the relative velocity along the bond over its length, or, as \
             printed in Platzer 2022, eq. 21, the full relative velocity over its length.",
        ),
    ],
};

impl Word for EquivalentStress {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("forces-only", Self::ForcesOnly),
        ("axial-in-tension", Self::AxialInTension),
        ("tensile-edge", Self::TensileEdge),
        ("bond-in-tension", Self::BondInTension),
    ];
}

impl Word for StrainRateMeasure {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("elongation", Self::Elongation),
        ("relative-velocity", Self::RelativeVelocity),
    ];
}

pub(super) fn read(field: &Field<'_>) -> Result<BondFailure> {
    let table = Table::of(field, &FAILURE)?;
    let failure = BondFailure {
        tensile_strength_pa: table.read("tensile_strength")?,
        compressive_strength_pa: table.read("compressive_strength")?,
        shear_strength_pa: table.read("shear_strength")?,
        cohesion_pa: table.read("cohesion")?,
        friction_angle_rad: table.read("friction_angle")?,
        von_mises_strength_pa: table.read("von_mises_strength")?,
        equivalent_stress: table.read("equivalent_stress")?,
        rate_strengthening_from_1_s: rate_strengthening(&table)?,
        strain_rate_measure: table.read("strain_rate_measure")?,
        fracture_energy_j_m2: table.read("fracture_energy")?,
        weibull_modulus: table.read("weibull_modulus")?,
    };
    check_strengths(field, &table, &failure)?;
    conflicts::FAILURE.refuse(&table, &table)?;
    check_fracture_energy(&table, &failure)?;
    Ok(failure)
}

/// Whether there is a strength, and one that the rate raises where that is asked for.
fn check_strengths(field: &Field<'_>, table: &Table<'_>, failure: &BondFailure) -> Result<()> {
    let by_rate = [
        failure.tensile_strength_pa,
        failure.shear_strength_pa,
        failure.cohesion_pa,
        failure.von_mises_strength_pa,
    ];
    let has_none = by_rate.iter().all(Option::is_none);
    if has_none && failure.compressive_strength_pa.is_none() {
        let remedy = "add tensile_strength, compressive_strength, shear_strength, cohesion or von_mises_strength, such as von_mises_strength = \"0.185 MPa\"";
        let field = table.get("rate_strengthening").unwrap_or(field.clone());
        return Err(field.fault("has no strength to exceed", remedy));
    }
    let strengthens = table.get("rate_strengthening");
    let strengthens = strengthens.filter(|_| failure.rate_strengthening_from_1_s.is_some());
    if let (Some(field), true) = (strengthens, has_none) {
        let problem = "has no effect without tensile_strength, shear_strength, cohesion or von_mises_strength, which it raises; it does not raise compressive_strength";
        let remedy = "add tensile_strength = \"1 MPa\", or remove rate_strengthening";
        return Err(field.fault(problem, remedy));
    }
    Ok(())
}

/// Whether no strength beyond which a bond softens is 0.
fn check_fracture_energy(table: &Table<'_>, failure: &BondFailure) -> Result<()> {
    let Some(field) = table.get("fracture_energy") else {
        return Ok(());
    };
    let strengths = [
        ("tensile_strength", failure.tensile_strength_pa),
        ("shear_strength", failure.shear_strength_pa),
        ("cohesion", failure.cohesion_pa),
        ("von_mises_strength", failure.von_mises_strength_pa),
    ];
    if let Some((name, _)) = strengths
        .iter()
        .find(|(_, strength)| *strength == Some(0.0))
    {
        let problem = format!("has no strength to soften from: {name} is 0");
        return Err(field.fault(problem, "give the strength, or remove fracture_energy"));
    }
    Ok(())
}

/// The strain rate above which strengths rise, 1/s. None for `false`.
fn rate_strengthening(table: &Table<'_>) -> Result<Option<f64>> {
    let Some(field) = table.get("rate_strengthening") else {
        return Ok(None);
    };
    if let Value::Boolean(on) = field.node.value {
        return Ok(on.then_some(RATE_STRENGTHENING_FROM));
    }
    if field.is_word() {
        let remedy = "write true, or a strain rate such as \"4.64e-6 1/s\"";
        return Err(field.wrong("true, false or a rate", remedy));
    }
    table.read("rate_strengthening")
}

pub(super) fn list(failure: &BondFailure, listing: &mut Listing) {
    listing.value("tensile_strength", &failure.tensile_strength_pa);
    listing.value("compressive_strength", &failure.compressive_strength_pa);
    listing.value("shear_strength", &failure.shear_strength_pa);
    listing.value("cohesion", &failure.cohesion_pa);
    listing.value("friction_angle", &failure.friction_angle_rad);
    listing.value("von_mises_strength", &failure.von_mises_strength_pa);
    listing.value("equivalent_stress", &failure.equivalent_stress);
    listing.value("rate_strengthening", &failure.rate_strengthening_from_1_s);
    listing.value("fracture_energy", &failure.fracture_energy_j_m2);
    listing.value("weibull_modulus", &failure.weibull_modulus);
    listing.value("strain_rate_measure", &failure.strain_rate_measure);
}
