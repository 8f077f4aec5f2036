//! `failure` of `[bonds.NAME]`

use super::conflicts;
use super::field::Field;
use super::numbers::{number, quantity};
use super::plain_table::plain_table;
use super::schema::{Key, Kind, Unless, Word};
use super::table::{Read, Table};
use super::tree::Value;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGLE, ENERGY_PER_AREA, NUMBER, RATE, STRESS};
use dem_physics::bond::failure::EquivalentStress;
use dem_physics::bond::rate_strengthening::IncreaseCurve;
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

/// Value of `rate_strengthening = true`, 1/s: where the strength of [Platzer 2022, eqs. 20, 21]
/// begins to rise.
const RATE_STRENGTHENING_FROM: f64 = 4.64e-6;
const SWITCH_RATE_OR_TABLE: Kind = Kind::Either(&[
    Kind::Boolean,
    Kind::Quantity(&RATE),
    Kind::List(&Kind::Row(&[
        Kind::Quantity(&RATE),
        Kind::Quantity(&NUMBER),
    ])),
]);
const WRITE_A_RATE: &str = "write true, or a strain rate such as \"4.64e-6 1/s\"";

plain_table! {
    FAILURE = "Failure";
    /// Failure criteria of a bond; the first that is met breaks it. At least one strength is
    /// required.
    #[derive(Debug, Clone, Default, PartialEq)]
    pub struct BondFailure {
        /// Largest tensile stress that the edge of the bond can bear.
        tensile_strength_pa: Option<f64> = quantity("tensile_strength", &STRESS).not_negative();
        /// Largest compressive stress that the edge of the bond can bear; without it no bond breaks
        /// in compression.
        compressive_strength_pa: Option<f64> = quantity("compressive_strength", &STRESS)
            .not_negative();
        /// Largest shear stress that the bond can bear.
        shear_strength_pa: Option<f64> = quantity("shear_strength", &STRESS).not_negative();
        /// Largest shear stress that the bond can bear without axial force, by Mohr-Coulomb; needs
        /// `friction_angle`.
        cohesion_pa: Option<f64> = quantity("cohesion", &STRESS).not_negative();
        /// Its tangent times the axial pressure adds to `cohesion`, times the axial tension is
        /// subtracted (Mohr-Coulomb).
        friction_angle_rad: Option<f64> = quantity("friction_angle", &ANGLE)
            .within(Included(0.0), Excluded(FRAC_PI_2))
            .remedy("write an angle such as \"35 deg\"");
        /// Largest equivalent stress that the bond can bear (Platzer 2022, eqs. 11 to 13).
        von_mises_strength_pa: Option<f64> = quantity("von_mises_strength", &STRESS).not_negative();
        /// Stresses that count in the equivalent stress: `forces-only`, the axial stress if it is
        /// tensile, and the shear force, but no moments. The others count shear and torsion, and
        /// `axial-in-tension` the axial stress if it is tensile and bending always, `tensile-edge`
        /// axial and bending stress at the edge with the largest tension, `bond-in-tension` both,
        /// but only while the axial force is tensile.
        equivalent_stress: EquivalentStress =
            word::<EquivalentStress>("equivalent_stress", "forces-only");
        /// Strain rate above which all strengths except the compressive one rise with the rate
        /// (Platzer 2022, eqs. 20 and 21); `true` means 4.64e-6 1/s. Or the factor on them over the
        /// rate, `[[rate, factor], ...]`, linear in the logarithm of the rate between the rows, 1
        /// below the first and constant above the last; rates rise, factors are 1 or more and do
        /// not fall.
        rate_strengthening: Option<IncreaseCurve> =
            new("rate_strengthening", SWITCH_RATE_OR_TABLE)
                .positive()
                .remedy(WRITE_A_RATE), by rate_strengthening;
        /// A bond keeps the largest factor of `rate_strengthening` that it has had, however slowly
        /// it is strained later.
        keeps_largest_factor: bool = flag("keeps_largest_factor", false);
        /// Energy per area that it takes to pull or shear a bond apart: beyond its strength the
        /// bond softens, by a damage that stays, until this is spent (cohesive zone). Without it a
        /// bond breaks at its strength.
        fracture_energy_j_m2: Option<f64> = quantity("fracture_energy", &ENERGY_PER_AREA)
            .positive();
        /// Strengths follow a Weibull distribution with this modulus; the given strength is its
        /// scale.
        weibull_modulus: Option<f64> = number("weibull_modulus").positive();
        /// Strain rate that `rate_strengthening` uses: the relative velocity along the bond over
        /// its length, or, as printed in Platzer 2022, eq. 21, the full relative velocity over its
        /// length.
        strain_rate_measure: StrainRateMeasure =
            word::<StrainRateMeasure>("strain_rate_measure", "elongation");
    }
}

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
    let failure = BondFailure::read(&table)?;
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
    let strengthens = strengthens.filter(|_| failure.rate_strengthening.is_some());
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

/// The factor on strengths over the strain rate. None for `false`.
fn rate_strengthening(table: &Table<'_>) -> Result<Option<IncreaseCurve>> {
    let Some(field) = table.get("rate_strengthening") else {
        return Ok(None);
    };
    if let Value::Boolean(on) = field.node.value {
        let from_1_s = RATE_STRENGTHENING_FROM;
        return Ok(on.then_some(IncreaseCurve::Platzer { from_1_s }));
    }
    if field.is_word() || matches!(field.node.value, Value::Table(_)) {
        let remedy = "write true, a strain rate such as \"4.64e-6 1/s\", or a table such as [[\"1 1/s\", 1.6], [\"10 1/s\", 3.57]]";
        return Err(field.wrong("true, false, a rate or a list of [rate, factor]", remedy));
    }
    table.read("rate_strengthening")
}

/// The rows `[rate, factor]` of a table.
fn increase_table(field: &Field<'_>) -> Result<IncreaseCurve> {
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for item in field.items()? {
        let [rate, factor] = item.row("[rate, factor], such as [\"1 1/s\", 1.6]")?;
        let row = [rate.positive(&RATE)?, factor.quantity(&NUMBER)?];
        let [rate_before, factor_before] = rows.last().copied().unwrap_or([0.0, 1.0]);
        if row[0] <= rate_before {
            let limit = format!("more than the rate before it, {rate_before} 1/s");
            return Err(rate.wrong(&limit, "put the rows in the order of their rates"));
        }
        if row[1] < 1.0 {
            let remedy = "it is the strength at this rate over that of the scene, the static one";
            return Err(factor.wrong("at least 1", remedy));
        }
        if row[1] < factor_before {
            let limit = format!("at least the factor before it, {factor_before}");
            let remedy = "a strength does not fall with the rate: write one factor in both rows";
            return Err(factor.wrong(&limit, remedy));
        }
        rows.push(row);
    }
    Ok(IncreaseCurve::Table(rows))
}

impl Read for IncreaseCurve {
    fn given(field: &Field<'_>, key: &Key) -> Result<Self> {
        match field.node.value {
            Value::List(_) => increase_table(field),
            _ => Ok(Self::Platzer {
                from_1_s: field.within_limits(key)?,
            }),
        }
    }

    fn unless_given(_: Unless) -> Option<Self> {
        None
    }

    fn told(&self, key: &Key) -> String {
        match self {
            Self::Platzer { from_1_s } => quantity(*from_1_s, key.unit()),
            Self::Table(rows) => {
                let row = |[rate, factor]: &[f64; 2]| {
                    format!("{}: {}", quantity(*rate, key.unit()), number(*factor))
                };
                rows.iter().map(row).collect::<Vec<_>>().join(", ")
            }
        }
    }
}
