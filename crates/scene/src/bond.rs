//! `[bonds.NAME]`

use super::bond_failure::{self, BondFailure, FAILURE};
use super::conflicts;
use super::field::Field;
use super::listing::{Listing, one_field_a_key};
use super::material::poisson_ratio;
use super::schema::{Key, Kind, Schema, Word, words_of};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{STRESS, VISCOUS_DAMPING};
use std::ops::Bound::{Excluded, Included};

/// Beam model of the bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondModel {
    /// "parallel": `stiffness_ratio` is normal over shear stiffness, 2 (1 + nu) unless given.
    Parallel {
        /// Normal over shear stiffness.
        stiffness_ratio: Option<f64>,
    },
    /// "pin": as "parallel", without moments.
    Pin {
        /// Normal over shear stiffness.
        stiffness_ratio: Option<f64>,
    },
    /// "rojek": as "parallel", of two segments, each as thick as its sphere.
    Rojek {
        /// Normal over shear stiffness.
        stiffness_ratio: Option<f64>,
    },
    /// "euler-bernoulli"
    EulerBernoulli,
    /// "timoshenko"
    Timoshenko,
    /// "elastic-solid"
    ElasticSolid,
    /// "shear-coefficient": `shear_coefficient`, 0.9 unless given.
    ShearCoefficient {
        /// Shear coefficient of the section.
        alpha: f64,
    },
    /// "flat-joint": as "parallel", with a section of elements that fail one by one.
    FlatJoint {
        /// Normal over shear stiffness.
        stiffness_ratio: Option<f64>,
        /// Its elements.
        elements: JointElements,
    },
}

/// Elements of the section of a flat joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointElements {
    /// `radial_elements`: rings of equal width, 3 unless given.
    pub radial: u32,
    /// `circumferential_elements`: sectors of each ring, 12 unless given.
    pub circumferential: u32,
    /// `joint_friction`: friction coefficient of failed elements, 0 unless given.
    pub friction: f64,
}

impl Default for JointElements {
    fn default() -> Self {
        Self {
            radial: 3,
            circumferential: 12,
            friction: 0.0,
        }
    }
}

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
}

/// Viscous and structural damping at the bond. All may act together.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BondDamping {
    /// `damping_ratio`: eta of Chen et al. 2022, eqs. 9 and 10. 0: none.
    pub damping_ratio: f64,
    /// `per_mode`: eta acts with each mode's own stiffness instead of the normal and the torsional
    /// one.
    pub per_mode: bool,
    /// `damping_coefficient`: d of Platzer 2022, eq. 7, N s/m. 0: none.
    pub damping_coefficient_n_s_m: f64,
    /// `torque_factor`: factor of the damping torque of Platzer 2022, eq. 9 (1 there). 0: none.
    pub torque_factor: f64,
    /// `normal_damping_ratio`: of critical damping, along the bond, with the stiffness of this
    /// mode. 0: none. The next three likewise.
    pub normal_damping_ratio: f64,
    /// `shear_damping_ratio`: across the bond.
    pub shear_damping_ratio: f64,
    /// `torsion_damping_ratio`: about the axis of the bond.
    pub torsion_damping_ratio: f64,
    /// `bending_damping_ratio`: about the axes across the bond.
    pub bending_damping_ratio: f64,
    /// `structural_damping`: gamma, the fraction of the load of each mode that resists its motion,
    /// in [0, 1). 0: none.
    pub structural_damping: f64,
}

/// Yield strengths of a bond, mode by mode. None: the mode stays elastic.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BondPlasticity {
    /// `normal_yield_strength`: of |F_n|/A, Pa.
    pub normal_yield_strength_pa: Option<f64>,
    /// `shear_yield_strength`: of F_s/A, Pa.
    pub shear_yield_strength_pa: Option<f64>,
    /// `torsion_yield_strength`: of M_tor r/J, Pa.
    pub torsion_yield_strength_pa: Option<f64>,
    /// `bending_yield_strength`: of M_ben r/I, Pa.
    pub bending_yield_strength_pa: Option<f64>,
    /// `hardening_ratio`: stiffness beyond yield over elastic stiffness, in [0, 1).
    pub hardening_ratio: f64,
}

pub(super) static BOND: Schema = Schema {
    title: "[bonds.NAME]",
    doc: "Properties of bonds.",
    keys: &[
        Key::new(
            "model",
            Kind::Word(|| words_of(&models(None, 0.0, JointElements::default()))),
            "Model of the bond: a beam; `pin`, which resists neither torsion nor bending; `rojek`, two segments in series, each \
             as thick in proportion as its sphere; or `flat-joint`, whose section consists of elements that fail one by one.",
        )
        .or_word("timoshenko"),
        Key::number(
            "stiffness_ratio",
            "Normal over shear stiffness of the models `parallel`, `pin`, `rojek` and `flat-joint`.",
        )
        .positive()
        .otherwise("2 (1 + nu)"),
        Key::number(
            "shear_coefficient",
            "Shear coefficient of the section, for the model `shear-coefficient`.",
        )
        .positive()
        .or(0.9),
        Key::new(
            "radial_elements",
            Kind::Whole { least: 1, most: Some(100), of: "" },
            "Rings of elements in the section, for the model `flat-joint`.",
        )
        .remedy("leave it out for 3")
        .or(3.0),
        Key::new(
            "circumferential_elements",
            Kind::Whole { least: 3, most: Some(100), of: "" },
            "Elements of each ring, for the model `flat-joint`.",
        )
        .remedy("leave it out for 12")
        .or(12.0),
        Key::number(
            "joint_friction",
            "Friction coefficient of failed elements under pressure, for the model `flat-joint` with `failure`.",
        )
        .not_negative()
        .or(0.0),
        Key::word::<Formulation>(
            "formulation",
            "total",
            "`total`: forces are the gradient of an energy of positions and orientations; `incremental`, for comparison: \
             forces are summed step by step.",
        ),
        Key::quantity("young_modulus", &STRESS, "Young's modulus of the beam.")
            .positive()
            .required("\"15 MPa\""),
        poisson_ratio("Poisson's ratio of the beam.").required("0.3"),
        Key::number(
            "radius_factor",
            "Radius of the bond over that of the smaller particle.",
        )
        .positive()
        .otherwise("radii of the body"),
        Key::table("damping", &DAMPING, "Damping at the bond."),
        Key::table(
            "failure",
            &FAILURE,
            "Failure criteria; without them no bond breaks.",
        ),
        Key::table(
            "plasticity",
            &PLASTICITY,
            "Yield strengths; without them bonds are elastic until they break.",
        ),
        Key::flag(
            "contact_beside_bond",
            false,
            "The contact law of the two materials acts beside the bond, from the overlap at which the ends were bonded.",
        ),
    ],
};

pub(super) static PLASTICITY: Schema = Schema {
    title: "Plasticity",
    doc: "Yield strengths of a bond, each for one mode, which is elastic up to it and then flows. At least one is required; modes \
          without one stay elastic.",
    keys: &[
        Key::quantity(
            "normal_yield_strength",
            &STRESS,
            "Axial stress, of tension and of compression, at which the bond yields.",
        )
        .positive(),
        Key::quantity("shear_yield_strength", &STRESS, "Stress of the shear force at which it yields.").positive(),
        Key::quantity(
            "torsion_yield_strength",
            &STRESS,
            "Stress of torsion, at the edge, at which it yields.",
        )
        .positive(),
        Key::quantity(
            "bending_yield_strength",
            &STRESS,
            "Stress of bending, at the edge, at which it yields; for the fully plastic moment of a solid section write 1.698 \
             times the yield strength of the material.",
        )
        .positive(),
        Key::number(
            "hardening_ratio",
            "Stiffness beyond yield over elastic stiffness (linear kinematic hardening); 0: perfectly plastic.",
        )
        .within(Included(0.0), Excluded(1.0))
        .remedy("write 0 for none")
        .or(0.0),
    ],
};

pub(super) static DAMPING: Schema = Schema {
    title: "Damping",
    doc: "Viscous and structural damping at the bond. What is given adds up.",
    keys: &[
        Key::number(
            "damping_ratio",
            "Fraction of critical damping: eta of Chen et al. 2022, eqs. 9 and 10; 0: none.",
        )
        .not_negative()
        .or(0.0),
        Key::flag(
            "per_mode",
            false,
            "`damping_ratio` refers to the stiffness of each mode instead of the normal and torsional stiffness.",
        ),
        Key::quantity(
            "damping_coefficient",
            &VISCOUS_DAMPING,
            "d of Platzer 2022, eq. 7; 0: none.",
        )
        .not_negative()
        .or(0.0),
        Key::number(
            "torque_factor",
            "Factor of the damping torque of Platzer 2022, eq. 9, which is 1 there; 0: none.",
        )
        .not_negative()
        .or(0.0),
        Key::number(
            "normal_damping_ratio",
            "Fraction of critical damping along the bond, by the stiffness of this mode; 0: none.",
        )
        .not_negative()
        .or(0.0),
        Key::number("shear_damping_ratio", "The same across the bond.").not_negative().or(0.0),
        Key::number("torsion_damping_ratio", "The same about the axis of the bond.").not_negative().or(0.0),
        Key::number("bending_damping_ratio", "The same about the axes across the bond.").not_negative().or(0.0),
        Key::number(
            "structural_damping",
            "Fraction of the force or moment of each mode that acts against its relative motion: gamma; 0: none.",
        )
        .within(Included(0.0), Excluded(1.0))
        .remedy("write 0 for none")
        .or(0.0),
    ],
};

impl Word for Formulation {
    const WORDS: &'static [(&'static str, Self)] =
        &[("total", Self::Total), ("incremental", Self::Incremental)];
}

pub(super) fn read(field: &Field<'_>) -> Result<BondKind> {
    let table = Table::of(field, &BOND)?;
    let kind = BondKind {
        model: model(&table)?,
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
    };
    conflicts::BOND.refuse_key("plasticity", &table)?;
    match kind.model {
        BondModel::FlatJoint { .. } => check_flat_joint(&table, &kind.failure)?,
        BondModel::Pin { .. } => check_pin(&table, &kind.damping)?,
        _ => {}
    }
    conflicts::BOND.refuse_key("formulation = incremental", &table)?;
    Ok(kind)
}

/// The models and their names.
fn models(
    stiffness_ratio: Option<f64>,
    alpha: f64,
    elements: JointElements,
) -> [(&'static str, BondModel); 8] {
    [
        ("parallel", BondModel::Parallel { stiffness_ratio }),
        ("pin", BondModel::Pin { stiffness_ratio }),
        ("rojek", BondModel::Rojek { stiffness_ratio }),
        ("euler-bernoulli", BondModel::EulerBernoulli),
        ("timoshenko", BondModel::Timoshenko),
        ("elastic-solid", BondModel::ElasticSolid),
        ("shear-coefficient", BondModel::ShearCoefficient { alpha }),
        (
            "flat-joint",
            BondModel::FlatJoint {
                stiffness_ratio,
                elements,
            },
        ),
    ]
}

fn model(table: &Table<'_>) -> Result<BondModel> {
    let known = models(
        table.read("stiffness_ratio")?,
        table.read("shear_coefficient")?,
        JointElements {
            radial: table.read("radial_elements")?,
            circumferential: table.read("circumferential_elements")?,
            friction: table.read("joint_friction")?,
        },
    );
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
    Ok(model)
}

one_field_a_key! {
    BondDamping {
        damping_ratio: "damping_ratio",
        per_mode: "per_mode",
        damping_coefficient_n_s_m: "damping_coefficient",
        torque_factor: "torque_factor",
        normal_damping_ratio: "normal_damping_ratio",
        shear_damping_ratio: "shear_damping_ratio",
        torsion_damping_ratio: "torsion_damping_ratio",
        bending_damping_ratio: "bending_damping_ratio",
        structural_damping: "structural_damping",
    }
}

fn damping(bond: &Table<'_>) -> Result<BondDamping> {
    let damping = fields(&bond.table("damping", &DAMPING)?)?;
    conflicts::BOND.refuse_key("per_mode", bond)?;
    Ok(damping)
}

fn plasticity(field: &Field<'_>) -> Result<BondPlasticity> {
    let table = Table::of(field, &PLASTICITY)?;
    let plasticity = BondPlasticity {
        normal_yield_strength_pa: table.read("normal_yield_strength")?,
        shear_yield_strength_pa: table.read("shear_yield_strength")?,
        torsion_yield_strength_pa: table.read("torsion_yield_strength")?,
        bending_yield_strength_pa: table.read("bending_yield_strength")?,
        hardening_ratio: table.read("hardening_ratio")?,
    };
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
        (
            "rate_strengthening",
            failure.rate_strengthening_from_1_s.is_some(),
        ),
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
    let known = models(None, 0.0, JointElements::default());
    let same =
        |other: &BondModel| std::mem::discriminant(other) == std::mem::discriminant(&kind.model);
    let name = known.iter().find(|(_, other)| same(other));
    listing.text("model", name.map_or("", |(name, _)| *name));
    match kind.model {
        BondModel::Parallel { stiffness_ratio }
        | BondModel::Pin { stiffness_ratio }
        | BondModel::Rojek { stiffness_ratio }
        | BondModel::FlatJoint {
            stiffness_ratio, ..
        } => {
            let stiffness_ratio = stiffness_ratio.unwrap_or(2.0 * (1.0 + kind.poisson_ratio));
            listing.value("stiffness_ratio", &stiffness_ratio);
        }
        BondModel::ShearCoefficient { alpha } => listing.value("shear_coefficient", &alpha),
        BondModel::EulerBernoulli | BondModel::Timoshenko | BondModel::ElasticSolid => {}
    }
    if let BondModel::FlatJoint { elements, .. } = &kind.model {
        listing.value("radial_elements", &elements.radial);
        listing.value("circumferential_elements", &elements.circumferential);
        listing.value("joint_friction", &elements.friction);
    }
    listing.value("formulation", &kind.formulation);
    listing.value("young_modulus", &kind.young_modulus_pa);
    listing.value("poisson_ratio", &kind.poisson_ratio);
    listing.value("radius_factor", &kind.radius_factor);
    listing.table("damping", &DAMPING, |listing| list(&kind.damping, listing));
    listing.table("failure", &FAILURE, |listing| {
        bond_failure::list(&kind.failure, listing);
    });
    if let Some(plasticity) = &kind.plasticity {
        listing.table("plasticity", &PLASTICITY, |listing| {
            listing.value(
                "normal_yield_strength",
                &plasticity.normal_yield_strength_pa,
            );
            listing.value("shear_yield_strength", &plasticity.shear_yield_strength_pa);
            listing.value(
                "torsion_yield_strength",
                &plasticity.torsion_yield_strength_pa,
            );
            listing.value(
                "bending_yield_strength",
                &plasticity.bending_yield_strength_pa,
            );
            listing.value("hardening_ratio", &plasticity.hardening_ratio);
        });
    }
    listing.value("contact_beside_bond", &kind.contact_beside_bond);
}
