//! `[bonds.NAME]`

use super::bond_failure::{self, BondFailure, FAILURE};
use super::conflicts;
use super::field::Field;
use super::listing::Listing;
use super::plain_table::plain_table;
use super::schema::{Kind, Word, table_schema, words_of};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{LENGTH, STRESS, VISCOUS_DAMPING};
use dem_physics::bond::flat_joint::{FlatJointLaw, moment_ratio};
use dem_physics::bond::stiffness::BondModel;
use std::ops::Bound::{Excluded, Included};

/// How forces are computed from motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Formulation {
    /// "total": the gradient of an energy of positions and orientations.
    Total,
    /// "incremental": summed step by step.
    Incremental,
}

/// Properties of bonds.
#[derive(Debug, Clone, PartialEq)]
pub struct BondKind {
    /// `model`, "timoshenko" unless given.
    pub model: BondModel,
    /// `radial_elements`, `circumferential_elements` and `joint_friction`: of a flat joint only.
    pub joint: Option<FlatJointLaw>,
    /// `formulation`, "total" unless given.
    pub formulation: Formulation,
    /// `young_modulus`, Pa.
    pub young_modulus_pa: f64,
    /// `poisson_ratio`, in (-1, 0.5].
    pub poisson_ratio: f64,
    /// `radius_factor`: bond radius over the smaller of the two particle radii. None: the radii of
    /// the body's file.
    pub radius_factor: Option<f64>,
    /// `damping = { ... }`
    pub damping: BondDamping,
    /// `failure = { ... }`
    pub failure: BondFailure,
    /// `plasticity = { ... }`. None: elastic until it breaks.
    pub plasticity: Option<BondPlasticity>,
    /// `contact_beside_bond`: the contact law of the two ends acts beside the bond.
    pub contact_beside_bond: bool,
    /// `calibrated_diameter`: mean diameter of the spheres with which they were calibrated, m.
    pub calibrated_diameter_m: Option<f64>,
    /// `calibrated_across`: spheres across the thinnest part of the body with which they were
    /// calibrated.
    pub calibrated_across: Option<f64>,
    /// `size_correction`: modulus and strengths are corrected for bodies of other spheres across.
    pub size_correction: bool,
}

table_schema! {
    /// Properties of bonds.
    pub(super) static BOND = "[bonds.NAME]";

    /// Model of the bond: a beam; `pin`, which resists neither torsion nor bending; `rojek`, two
    /// segments in series, each as thick in proportion as its sphere; or `flat-joint`, whose
    /// section consists of elements that fail one by one.
    new("model", Kind::Word(|| words_of(&models(None, 0.0, 0.0)))).or_word("timoshenko");
    /// Normal over shear stiffness of the models `parallel`, `pin`, `rojek` and `flat-joint`.
    number("stiffness_ratio").positive().otherwise("2 (1 + nu)");
    /// Shear coefficient of the section, for the model `shear-coefficient`.
    number("shear_coefficient").positive().or(0.9);
    /// Rings of elements in the section, for the model `flat-joint`.
    new("radial_elements", Kind::Whole { least: 1, most: Some(100), of: "" })
        .remedy("leave it out for 3")
        .or(3.0);
    /// Elements of each ring, for the model `flat-joint`.
    new("circumferential_elements", Kind::Whole { least: 3, most: Some(100), of: "" })
        .remedy("leave it out for 12")
        .or(12.0);
    /// Friction coefficient of failed elements under pressure, for the model `flat-joint` with
    /// `failure`.
    number("joint_friction").not_negative().or(0.0);
    /// `total`: forces are the gradient of an energy of positions and orientations; `incremental`,
    /// for comparison: forces are summed step by step.
    word::<Formulation>("formulation", "total");
    /// Young's modulus of the beam.
    quantity("young_modulus", &STRESS).positive().required("\"15 MPa\"");
    /// Poisson's ratio of the beam.
    poisson_ratio().required("0.3");
    /// Radius of the bond over that of the smaller particle.
    number("radius_factor").positive().otherwise("radii of the body");
    /// Damping at the bond.
    table("damping", &DAMPING);
    /// Failure criteria; without them no bond breaks.
    table("failure", &FAILURE);
    /// Yield strengths; without them bonds are elastic until they break.
    table("plasticity", &PLASTICITY);
    /// The contact law of the two materials acts beside the bond, from the overlap at which the
    /// ends were bonded.
    flag("contact_beside_bond", false);
    /// Mean diameter of the spheres with which these bonds were calibrated; `dem-run calibrate`
    /// writes it. The verdict does not call bodies of such spheres coarse.
    quantity("calibrated_diameter", &LENGTH).positive().otherwise("not calibrated");
    /// Spheres across the thinnest part of the body with which these bonds were calibrated;
    /// `dem-run calibrate` writes it. A body with others across is coarse: bonds near its faces
    /// are a larger or smaller part of it.
    number("calibrated_across").positive().otherwise("any");
    /// In a body of more or fewer spheres across than `calibrated_across`, modulus and strengths are
    /// those with which it is as stiff and strong: bonds join centres, so that a layer of 0.35
    /// diameters at each face bears nothing (doc/sphere-size.md).
    flag("size_correction", false);
}

plain_table! {
    PLASTICITY = "Plasticity";
    /// Yield strengths of a bond, each for one mode, which is elastic up to it and then flows. At
    /// least one is required; modes without one stay elastic.
    #[derive(Debug, Clone, Copy, Default, PartialEq)]
    pub struct BondPlasticity {
        /// Axial stress, of tension and of compression, at which the bond yields.
        normal_yield_strength_pa: Option<f64> = quantity("normal_yield_strength", &STRESS)
            .positive();
        /// Stress of the shear force at which it yields.
        shear_yield_strength_pa: Option<f64> = quantity("shear_yield_strength", &STRESS).positive();
        /// Stress of torsion, at the edge, at which it yields.
        torsion_yield_strength_pa: Option<f64> = quantity("torsion_yield_strength", &STRESS)
            .positive();
        /// Stress of bending, at the edge, at which it yields; for the fully plastic moment of a
        /// solid section write 1.698 times the yield strength of the material.
        bending_yield_strength_pa: Option<f64> = quantity("bending_yield_strength", &STRESS)
            .positive();
        /// Stiffness beyond yield over elastic stiffness (linear kinematic hardening); 0: perfectly
        /// plastic.
        hardening_ratio: f64 = number("hardening_ratio")
            .within(Included(0.0), Excluded(1.0))
            .remedy("write 0 for none")
            .or(0.0);
    }
}

plain_table! {
    DAMPING = "Damping";
    /// Viscous and structural damping at the bond. What is given adds up.
    #[derive(Debug, Clone, Copy, Default, PartialEq)]
    pub struct BondDamping {
        /// Fraction of critical damping: eta of Chen et al. 2022, eqs. 9 and 10; 0: none.
        damping_ratio: f64 = number("damping_ratio").not_negative().or(0.0);
        /// `damping_ratio` refers to the stiffness of each mode instead of the normal and torsional
        /// stiffness.
        per_mode: bool = flag("per_mode", false);
        /// d of Platzer 2022, eq. 7; 0: none.
        damping_coefficient_n_s_m: f64 = quantity("damping_coefficient", &VISCOUS_DAMPING)
            .not_negative()
            .or(0.0);
        /// Factor of the damping torque of Platzer 2022, eq. 9, which is 1 there; 0: none.
        torque_factor: f64 = number("torque_factor").not_negative().or(0.0);
        /// Fraction of critical damping along the bond, by the stiffness of this mode; 0: none.
        normal_damping_ratio: f64 = number("normal_damping_ratio").not_negative().or(0.0);
        /// The same across the bond.
        shear_damping_ratio: f64 = number("shear_damping_ratio").not_negative().or(0.0);
        /// The same about the axis of the bond.
        torsion_damping_ratio: f64 = number("torsion_damping_ratio").not_negative().or(0.0);
        /// The same about the axes across the bond.
        bending_damping_ratio: f64 = number("bending_damping_ratio").not_negative().or(0.0);
        /// Fraction of the force or moment of each mode that acts against its relative motion:
        /// gamma; 0: none.
        structural_damping: f64 = number("structural_damping")
            .within(Included(0.0), Excluded(1.0))
            .remedy("write 0 for none")
            .or(0.0);
    }
}

impl Word for Formulation {
    const WORDS: &'static [(&'static str, Self)] =
        &[("total", Self::Total), ("incremental", Self::Incremental)];
}

pub(super) fn read(field: &Field<'_>) -> Result<BondKind> {
    let table = Table::of(field, &BOND)?;
    let (model, joint) = model(&table)?;
    let kind = BondKind {
        model,
        joint,
        formulation: table.read("formulation")?,
        young_modulus_pa: table.read("young_modulus")?,
        poisson_ratio: table.read("poisson_ratio")?,
        radius_factor: table.read("radius_factor")?,
        damping: damping(&table)?,
        failure: table
            .read_by("failure", |field| bond_failure::read(&field))?
            .unwrap_or_default(),
        plasticity: table.read_by("plasticity", |field| plasticity(&field))?,
        contact_beside_bond: table.read("contact_beside_bond")?,
        calibrated_diameter_m: table.read("calibrated_diameter")?,
        calibrated_across: table.read("calibrated_across")?,
        size_correction: table.read("size_correction")?,
    };
    conflicts::BOND.refuse_key("plasticity", &table)?;
    match kind.model {
        BondModel::FlatJoint { .. } => check_flat_joint(&table, &kind.failure)?,
        BondModel::Pin { .. } => check_pin(&table, &kind.damping)?,
        _ => {}
    }
    conflicts::BOND.refuse_key("formulation = incremental", &table)?;
    conflicts::BOND.refuse_key("size_correction = true", &table)?;
    Ok(kind)
}

/// The models and their names.
fn models(kappa: Option<f64>, alpha: f64, moment_ratio: f64) -> [(&'static str, BondModel); 8] {
    let flat_joint = BondModel::FlatJoint {
        kappa,
        moment_ratio,
    };
    [
        ("parallel", BondModel::Parallel { kappa }),
        ("pin", BondModel::Pin { kappa }),
        ("rojek", BondModel::Rojek { kappa }),
        ("euler-bernoulli", BondModel::EulerBernoulli),
        ("timoshenko", BondModel::Timoshenko),
        ("elastic-solid", BondModel::ElasticSolid),
        ("shear-coefficient", BondModel::ShearCoefficient { alpha }),
        ("flat-joint", flat_joint),
    ]
}

/// Names of the models.
pub fn bond_models() -> impl Iterator<Item = &'static str> {
    models(None, 0.0, 0.0).into_iter().map(|(name, _)| name)
}

/// The model, and the elements of a flat joint.
fn model(table: &Table<'_>) -> Result<(BondModel, Option<FlatJointLaw>)> {
    let (kappa, alpha) = (
        table.read("stiffness_ratio")?,
        table.read("shear_coefficient")?,
    );
    let joint = FlatJointLaw {
        radial_elements: table.read("radial_elements")?,
        circumferential_elements: table.read("circumferential_elements")?,
        friction: table.read("joint_friction")?,
    };
    let known = models(kappa, alpha, moment_ratio(&joint));
    if let Some(field) = table.get("model").filter(|field| field.is("shen")) {
        let problem = "is \"shen\", the bond with concave ends of Shen et al. 2016, which is not available: the sources at hand do not give its formulas";
        return Err(field.fault(problem, "write another model, such as \"parallel\""));
    }
    let model = table
        .read_by("model", |field| field.choice(&known))?
        .unwrap_or(BondModel::Timoshenko);
    let is_flat_joint = matches!(model, BondModel::FlatJoint { .. });
    for (key, of, belongs) in [
        (
            "stiffness_ratio",
            "parallel",
            matches!(
                model,
                BondModel::Parallel { .. }
                    | BondModel::Pin { .. }
                    | BondModel::Rojek { .. }
                    | BondModel::FlatJoint { .. }
            ),
        ),
        ("radial_elements", "flat-joint", is_flat_joint),
        ("circumferential_elements", "flat-joint", is_flat_joint),
        ("joint_friction", "flat-joint", is_flat_joint),
        (
            "shear_coefficient",
            "shear-coefficient",
            matches!(model, BondModel::ShearCoefficient { .. }),
        ),
    ] {
        if let (Some(field), false) = (table.get(key), belongs) {
            let name = known.iter().find(|(_, other)| *other == model);
            let problem = format!(
                "does not apply to the model \"{}\"",
                name.map_or("", |(name, _)| *name)
            );
            return Err(field.fault(problem, format!("remove it, or write model = \"{of}\"")));
        }
    }
    Ok((model, is_flat_joint.then_some(joint)))
}

fn damping(bond: &Table<'_>) -> Result<BondDamping> {
    let damping = BondDamping::read(&bond.table("damping", &DAMPING)?)?;
    conflicts::BOND.refuse_key("per_mode", bond)?;
    Ok(damping)
}

fn plasticity(field: &Field<'_>) -> Result<BondPlasticity> {
    let table = Table::of(field, &PLASTICITY)?;
    let plasticity = BondPlasticity::read(&table)?;
    let none = BondPlasticity {
        hardening_ratio: plasticity.hardening_ratio,
        ..BondPlasticity::default()
    };
    if plasticity == none {
        let remedy = "add normal_yield_strength, shear_yield_strength, torsion_yield_strength or bending_yield_strength, such as normal_yield_strength = \"1 MPa\"";
        return Err(field.fault("has no strength at which a bond yields", remedy));
    }
    Ok(plasticity)
}

/// Whether a pin, which has no moments, has no damping of them.
fn check_pin(table: &Table<'_>, damping: &BondDamping) -> Result<()> {
    let of_moments = [
        ("torsion_damping_ratio", damping.torsion_damping_ratio),
        ("bending_damping_ratio", damping.bending_damping_ratio),
        ("torque_factor", damping.torque_factor),
    ];
    let given = of_moments.into_iter().find(|(_, value)| *value > 0.0);
    if let (Some(field), Some((name, _))) = (table.get("damping"), given) {
        let problem = format!(
            "{}.{name} has no effect on the model \"pin\", which has no moments",
            field.path
        );
        return Err(field.refuse(problem, "remove it, or take another model"));
    }
    Ok(())
}

/// Whether a flat joint has none of the keys that act on a section as a whole, and friction only
/// with elements that can fail.
fn check_flat_joint(table: &Table<'_>, failure: &BondFailure) -> Result<()> {
    let unknown = [
        ("shear_strength", failure.shear_strength_pa.is_some()),
        (
            "compressive_strength",
            failure.compressive_strength_pa.is_some(),
        ),
        (
            "von_mises_strength",
            failure.von_mises_strength_pa.is_some(),
        ),
        ("rate_strengthening", failure.rate_strengthening.is_some()),
        ("fracture_energy", failure.fracture_energy_j_m2.is_some()),
    ];
    let unknown = unknown.into_iter().find(|(_, is_given)| *is_given);
    if let (Some(field), Some((name, _))) = (table.get("failure"), unknown) {
        let problem = format!(
            "{}.{name} does not apply to the elements of a flat joint",
            field.path
        );
        let remedy =
            "write tensile_strength, or cohesion with friction_angle (0 for a shear strength)";
        return Err(field.refuse(problem, remedy));
    }
    conflicts::FLAT_JOINT.refuse(table, table)
}

pub(super) fn list_kind(kind: &BondKind, listing: &mut Listing) {
    let known = models(None, 0.0, 0.0);
    let same =
        |other: &BondModel| std::mem::discriminant(other) == std::mem::discriminant(&kind.model);
    let name = known.iter().find(|(_, other)| same(other));
    listing.text("model", name.map_or("", |(name, _)| *name));
    match kind.model {
        BondModel::Parallel { kappa }
        | BondModel::Pin { kappa }
        | BondModel::Rojek { kappa }
        | BondModel::FlatJoint { kappa, .. } => {
            let stiffness_ratio = kappa.unwrap_or(2.0 * (1.0 + kind.poisson_ratio));
            listing.value("stiffness_ratio", &stiffness_ratio);
        }
        BondModel::ShearCoefficient { alpha } => listing.value("shear_coefficient", &alpha),
        BondModel::EulerBernoulli | BondModel::Timoshenko | BondModel::ElasticSolid => {}
    }
    if let Some(joint) = &kind.joint {
        listing.value("radial_elements", &joint.radial_elements);
        listing.value("circumferential_elements", &joint.circumferential_elements);
        listing.value("joint_friction", &joint.friction);
    }
    listing.value("formulation", &kind.formulation);
    listing.value("young_modulus", &kind.young_modulus_pa);
    listing.value("poisson_ratio", &kind.poisson_ratio);
    listing.value("radius_factor", &kind.radius_factor);
    listing.table("damping", &DAMPING, |listing| kind.damping.list(listing));
    listing.table("failure", &FAILURE, |listing| kind.failure.list(listing));
    if let Some(plasticity) = &kind.plasticity {
        listing.table("plasticity", &PLASTICITY, |listing| {
            plasticity.list(listing);
        });
    }
    listing.value("contact_beside_bond", &kind.contact_beside_bond);
    listing.value("calibrated_diameter", &kind.calibrated_diameter_m);
    listing.value("calibrated_across", &kind.calibrated_across);
    listing.value("size_correction", &kind.size_correction);
}
