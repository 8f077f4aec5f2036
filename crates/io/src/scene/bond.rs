//! `[bonds.NAME]`

use super::field::Field;
use super::table::Table;
use super::tree::Value;
use super::{BondDamping, BondFailure, BondKind, BondModel, Formulation, RateOf};
use crate::Result;
use crate::units::{NUMBER, RATE, STRESS, VISCOUS_DAMPING};

const KEYS: [&str; 9] = [
    "model",
    "kappa",
    "shear_coefficient",
    "formulation",
    "young_modulus",
    "poisson_ratio",
    "radius_factor",
    "damping",
    "failure",
];

/// `shear_coefficient` unless given.
const SHEAR_COEFFICIENT: f64 = 0.9;

/// What `rate_strengthening = true` stands for, 1/s: where the strength of [Platzer 2022, eqs. 20,
/// 21] begins to rise.
const RATE_STRENGTHENING_FROM: f64 = 4.64e-6;

/// What a rate can be of.
pub(super) const RATES: [(&str, RateOf); 2] = [
    ("elongation", RateOf::Elongation),
    ("relative-velocity", RateOf::RelativeVelocity),
];

pub(super) fn read(field: &Field<'_>) -> Result<BondKind> {
    let table = field.table(&KEYS)?;
    Ok(BondKind {
        model: model(&table)?,
        formulation: table
            .read("formulation", |field| {
                field.choice(&[
                    ("total", Formulation::Total),
                    ("incremental", Formulation::Incremental),
                ])
            })?
            .unwrap_or(Formulation::Total),
        young_modulus_pa: table
            .need("young_modulus", "\"15 MPa\"")?
            .positive(&STRESS)?,
        poisson_ratio: table.need("poisson_ratio", "0.3")?.poisson_ratio()?,
        radius_factor: table.read("radius_factor", |field| field.positive(&NUMBER))?,
        damping: table
            .read("damping", |field| damping(&field))?
            .unwrap_or_default(),
        failure: table
            .read("failure", |field| failure(&field))?
            .unwrap_or_default(),
    })
}

fn model(table: &Table<'_>) -> Result<BondModel> {
    let kappa = table.read("kappa", |field| field.positive(&NUMBER))?;
    let alpha = table.read("shear_coefficient", |field| field.positive(&NUMBER))?;
    let known = [
        ("parallel", BondModel::Parallel { kappa }),
        ("euler-bernoulli", BondModel::EulerBernoulli),
        ("timoshenko", BondModel::Timoshenko),
        ("elastic-solid", BondModel::ElasticSolid),
        (
            "shear-coefficient",
            BondModel::ShearCoefficient {
                alpha: alpha.unwrap_or(SHEAR_COEFFICIENT),
            },
        ),
    ];
    let model = table
        .read("model", |field| field.choice(&known))?
        .unwrap_or(BondModel::Timoshenko);
    for (key, of, belongs) in [
        (
            "kappa",
            "parallel",
            matches!(model, BondModel::Parallel { .. }),
        ),
        (
            "shear_coefficient",
            "shear-coefficient",
            matches!(model, BondModel::ShearCoefficient { .. }),
        ),
    ] {
        if let (Some(field), false) = (table.get(key), belongs) {
            let name = known.iter().find(|(_, other)| *other == model);
            let problem = format!(
                "{} means nothing to the model \"{}\"",
                field.path,
                name.map_or("", |(name, _)| *name)
            );
            return Err(field.refuse(problem, format!("remove it, or write model = \"{of}\"")));
        }
    }
    Ok(model)
}

fn damping(field: &Field<'_>) -> Result<BondDamping> {
    let table = field.table(&["viscous", "each_mode", "force", "torque"])?;
    let viscous = table.read("viscous", |field| field.not_negative(&NUMBER))?;
    let each_mode = table.read("each_mode", |field| field.boolean())?;
    if let (Some(field), None) = (table.get("each_mode"), viscous) {
        let problem = format!("{} stands without viscous, on which it acts", field.path);
        return Err(field.refuse(problem, "add viscous = 0.1, or remove each_mode"));
    }
    Ok(BondDamping {
        viscous: viscous.unwrap_or_default(),
        each_mode: each_mode.unwrap_or_default(),
        force_n_s_m: table
            .read("force", |field| field.not_negative(&VISCOUS_DAMPING))?
            .unwrap_or_default(),
        torque: table
            .read("torque", |field| field.not_negative(&NUMBER))?
            .unwrap_or_default(),
    })
}

impl Default for BondFailure {
    /// Nothing breaks.
    fn default() -> Self {
        Self {
            tension_pa: None,
            compression_pa: None,
            shear_pa: None,
            von_mises_pa: None,
            rate_strengthening_from_1_s: None,
            rate_of: RateOf::default(),
            weibull_modulus: None,
        }
    }
}

fn failure(field: &Field<'_>) -> Result<BondFailure> {
    if let Some(old) = field.any_table()?.get("compressive") {
        let problem = format!("{} is no more: tension breaks pulled edges only", old.path);
        let remedy = "write compression = \"15 MPa\" for a strength of its own under pressure, or leave it out";
        return Err(old.refuse(problem, remedy));
    }
    let table = field.table(&[
        "tension",
        "compression",
        "shear",
        "von_mises",
        "rate_strengthening",
        "rate_of",
        "weibull_modulus",
    ])?;
    let strength = |key| table.read(key, |field: Field<'_>| field.not_negative(&STRESS));
    let failure = BondFailure {
        tension_pa: strength("tension")?,
        compression_pa: strength("compression")?,
        shear_pa: strength("shear")?,
        von_mises_pa: strength("von_mises")?,
        rate_strengthening_from_1_s: match table.get("rate_strengthening") {
            Some(field) => rate_strengthening(&field)?,
            None => None,
        },
        rate_of: table
            .read("rate_of", |field| field.choice(&RATES))?
            .unwrap_or_default(),
        weibull_modulus: table.read("weibull_modulus", |field| field.positive(&NUMBER))?,
    };
    let by_rate = [failure.tension_pa, failure.shear_pa, failure.von_mises_pa];
    let has_none = by_rate.iter().all(Option::is_none);
    if has_none && failure.compression_pa.is_none() {
        let remedy =
            "add tension, compression, shear or von_mises, such as von_mises = \"0.185 MPa\"";
        let field = table.get("rate_strengthening").unwrap_or(field.clone());
        let problem = format!("{} stands without a strength to exceed", field.path);
        return Err(field.refuse(problem, remedy));
    }
    if let (Some(field), None) = (table.get("rate_of"), table.get("rate_strengthening")) {
        let problem = format!(
            "{} stands without rate_strengthening, on which it acts",
            field.path
        );
        return Err(field.refuse(problem, "add rate_strengthening = true, or remove rate_of"));
    }
    let strengthens = table.get("rate_strengthening");
    let strengthens = strengthens.filter(|_| failure.rate_strengthening_from_1_s.is_some());
    if let (Some(field), true) = (strengthens, has_none) {
        let problem = format!(
            "{} stands without tension, shear or von_mises, which it raises; compression it does not",
            field.path
        );
        return Err(field.refuse(
            problem,
            "add tension = \"1 MPa\", or remove rate_strengthening",
        ));
    }
    Ok(failure)
}

/// The strain rate from which strengths rise, 1/s. None for `false`.
fn rate_strengthening(field: &Field<'_>) -> Result<Option<f64>> {
    if let Value::Boolean(on) = field.node.value {
        return Ok(on.then_some(RATE_STRENGTHENING_FROM));
    }
    let remedy = "write true, or a strain rate such as \"4.64e-6 1/s\"";
    if field.is_word() {
        return Err(field.wrong("true, false or a rate", remedy));
    }
    field
        .limited(&RATE, |rate| rate > 0.0, "more than 0 1/s", remedy)
        .map(Some)
}
