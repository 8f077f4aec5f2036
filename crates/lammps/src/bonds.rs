//! Bonds as types of `bond_style bpm/rotational`.
//!
//! Its four stiffnesses Kr, Ks, Kt, Kb are ours: normal, shear, torsion and bending, and shear acts
//! in the middle. Its damping of rolling is 1/2 groll L times the spin across the bond, that of
//! twisting 1/2 gtwist times the spin along it. It breaks a bond at
//!
//! F_r/fcr + F_s/fcs + M_t/tct + M_b/tcb >= 1
//!
//! with F_r negative in compression, so that the stress at the tensile edge, F_n/A + M_b r/I, and
//! the shear stress, F_s/A + M_t r/J, are each a sum of two of these terms.
//!
//! <https://docs.lammps.org/bond_bpm_rotational.html>

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::io::{self, Write};

use dem_scene::Scene;

use super::refusals::Refusals;
use dem_engine::state::State;
use dem_engine::state::bonds::{BondLaw, BondRule};
use dem_physics::bond::failure::Criteria;

/// Relative width of a class: the largest ratio of two values in it is 1 + this.
pub const CLASS_WIDTH: f64 = 1e-3;

/// Stands for a limit that is never reached.
const NEVER: f64 = 1e300;

/// The numbers of a `bond_coeff`: Kr, Ks, Kt, Kb, fcr, fcs, tct, tcb, gnorm, gslide, groll, gtwist.
pub type Coefficients = [f64; 12];

/// A type of bonds.
#[derive(Debug, Clone, PartialEq)]
pub struct BondType {
    /// Means of its bonds.
    pub coefficients: Coefficients,
    /// Mean radius of its bonds, m.
    pub radius_m: f64,
    /// Number of its bonds.
    pub count: usize,
}

/// All types, and the type of each bond of the state, from 0.
#[derive(Debug, Clone)]
pub struct BondTypes {
    /// The types.
    pub types: Vec<BondType>,
    /// For each bond its type.
    pub type_of: Vec<u32>,
    /// Largest relative difference between a coefficient of a bond and that of its type.
    pub largest_error: f64,
}

impl BondTypes {
    /// Whether any bond can break.
    pub(crate) fn break_at_all(&self) -> bool {
        let limits = |one: &BondType| one.coefficients[4..8].iter().any(|limit| *limit < NEVER);
        self.types.iter().any(limits)
    }
}

/// Writes a `bond_coeff` for each type.
pub(crate) fn write(types: &BondTypes, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "# type, Kr Ks (N/m), Kt Kb (N m/rad), fcr fcs (N), tct tcb (N m), gnorm gslide (N s/m), groll (N s/rad), gtwist (N m s/rad)"
    )?;
    for (number, one) in (1..).zip(&types.types) {
        write!(out, "bond_coeff {number}")?;
        for x in &one.coefficients {
            write!(out, " {x:e}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Sorts the bonds of a state into types; refuses a rule that the bond style cannot represent.
pub(crate) fn bond_types(scene: &Scene, state: &State, refusals: &mut Refusals) -> BondTypes {
    for (number, (name, rule)) in (0..).zip(scene.bonds.keys().zip(state.bonds.rules.iter())) {
        refuse_rule(name, rule, refusals);
        // One of its bonds stands for all of them.
        let mut own = (0..state.bonds.len()).filter(|at| state.bonds.rule_of(*at) == number);
        if let Some((part, why, remedy)) = own.find_map(|at| misfit_of_bond(name, state, at)) {
            refusals.add(part, why, remedy);
        }
    }
    let bonds = 0..state.bonds.len();
    let all: Vec<Coefficients> = bonds.clone().map(|at| coefficients(state, at)).collect();
    let radii: Vec<f64> = bonds.map(|at| state.bonds.radius_m(at)).collect();
    classes(&all, &radii)
}

/// Sorts bonds with these coefficients and radii, m, into classes no wider than [`CLASS_WIDTH`].
pub fn classes(all: &[Coefficients], radii_m: &[f64]) -> BondTypes {
    // Half of the width on each side of a class's middle, on a logarithmic scale.
    let step = CLASS_WIDTH.ln_1p();
    let class = |x: f64| {
        if x > 0.0 {
            (x.ln() / step).floor() as i64
        } else {
            i64::MIN
        }
    };
    let mut number_of: BTreeMap<[i64; 12], u32> = BTreeMap::new();
    let mut types: Vec<BondType> = Vec::new();
    let mut type_of = Vec::with_capacity(all.len());
    for (one, radius_m) in all.iter().zip(radii_m) {
        let next = types.len() as u32;
        let number = *number_of.entry(one.map(class)).or_insert(next);
        if number == next {
            types.push(BondType {
                coefficients: [0.0; 12],
                radius_m: 0.0,
                count: 0,
            });
        }
        let of = &mut types[number as usize];
        of.count += 1;
        // Running means: of equal numbers they are these numbers.
        let share = 1.0 / of.count as f64;
        for (mean, x) in of.coefficients.iter_mut().zip(one) {
            *mean += (x - *mean) * share;
        }
        of.radius_m += (radius_m - of.radius_m) * share;
        type_of.push(number);
    }
    let mut largest_error = 0.0_f64;
    for (one, number) in all.iter().zip(&type_of) {
        let mean = &types[*number as usize].coefficients;
        for (x, mean) in one.iter().zip(mean).filter(|(x, _)| **x > 0.0) {
            largest_error = largest_error.max((mean / x - 1.0).abs());
        }
    }
    BondTypes {
        types,
        type_of,
        largest_error,
    }
}

/// The coefficients of one bond.
fn coefficients(state: &State, at: usize) -> Coefficients {
    let bonds = &state.bonds;
    let stiffness = bonds.stiffness(at);
    let [normal, shear, torsion, bending] = bonds.damping.get(at).copied().unwrap_or([0.0; 4]);
    let criteria = bonds.rules[bonds.rule_of(at)].criteria;
    let [fcr, fcs, tct, tcb] = criteria.map_or([NEVER; 4], |criteria| {
        limits(&criteria, bonds.radius_m(at), bonds.strength_factor(at))
    });
    [
        stiffness.normal,
        stiffness.shear,
        stiffness.torsion,
        stiffness.bending,
        fcr,
        fcs,
        tct,
        tcb,
        normal,
        shear,
        2.0 * bending / bonds.initial_length_m(at),
        2.0 * torsion,
    ]
}

/// Largest normal and shear force, N, and largest torsion and bending moment, N m, each alone.
fn limits(criteria: &Criteria, radius_m: f64, factor: f64) -> [f64; 4] {
    let area = PI * radius_m * radius_m;
    let limit = |strength: f64, section: f64| {
        if strength.is_finite() {
            factor * strength * section
        } else {
            NEVER
        }
    };
    let (tension, shear) = (criteria.tensile_strength_pa, criteria.shear_strength_pa);
    [
        limit(tension, area),
        limit(shear, area),
        limit(shear, 0.5 * area * radius_m),
        limit(tension, 0.25 * area * radius_m),
    ]
}

/// What the bond style cannot represent: whether it is there, its key, the reason and the remedy.
type Misfit = (bool, &'static str, &'static str, &'static str);

const LEAVE_OUT: &str = "leave it out, or run the scene with dem-run";

fn misfits_of_law(rule: &BondRule) -> [Misfit; 3] {
    let (why, remedy) = match rule.law {
        BondLaw::Incremental => (
            "bpm/rotational computes forces from the present positions, not step by step",
            "use formulation = \"total\"",
        ),
        BondLaw::FlatJoint(_) => (
            "bonds of bpm/rotational break as a whole",
            "use another model, such as \"timoshenko\"",
        ),
        BondLaw::Softening { .. } => (
            "bonds of bpm/rotational break at their strength and do not soften",
            LEAVE_OUT,
        ),
        _ => (
            "bonds of bpm/rotational are elastic until they break",
            LEAVE_OUT,
        ),
    };
    let key = rule.law.key();
    [
        (key.is_some(), key.unwrap_or_default(), why, remedy),
        (
            rule.structural_damping > 0.0,
            "damping.structural_damping",
            "damping of bpm/rotational is viscous",
            "use damping_ratio, or run the scene with dem-run",
        ),
        (
            rule.strengthening.is_some(),
            "failure.rate_strengthening",
            "strengths of bpm/rotational do not depend on the strain rate",
            LEAVE_OUT,
        ),
    ]
}

fn misfits_of_criteria(criteria: &Criteria) -> [Misfit; 5] {
    let (tension, shear) = (criteria.tensile_strength_pa, criteria.shear_strength_pa);
    [
        (
            criteria.von_mises_strength_pa.is_finite(),
            "failure.von_mises_strength",
            "bpm/rotational adds loads relative to their limits, which is no equivalent stress",
            "use tensile_strength or shear_strength",
        ),
        (
            criteria.compressive_strength_pa.is_finite(),
            "failure.compressive_strength",
            "bpm/rotational breaks no bond by compression",
            LEAVE_OUT,
        ),
        (
            criteria.is_frictional(),
            "failure.cohesion",
            "strengths of bpm/rotational do not rise with pressure",
            "use shear_strength, or run the scene with dem-run",
        ),
        (
            tension.is_finite() && shear.is_finite(),
            "failure.shear_strength",
            "bpm/rotational adds tension and shear to one limit, and here each has its own",
            "keep tensile_strength or shear_strength, not both",
        ),
        (
            tension == 0.0 || shear == 0.0,
            "failure.tensile_strength",
            "a limit of bpm/rotational is above 0",
            "use a small strength, such as \"1 Pa\"",
        ),
    ]
}

fn refuse_rule(name: &str, rule: &BondRule, refusals: &mut Refusals) {
    let of_criteria = rule.criteria.iter().flat_map(misfits_of_criteria);
    let misfits = misfits_of_law(rule).into_iter().chain(of_criteria);
    for (_, key, why, remedy) in misfits.filter(|(is_there, ..)| *is_there) {
        refusals.add(format!("bonds.{name}.{key}"), why, remedy);
    }
}

/// Largest distance of the contact point from the middle of a bond, relative to its length.
const MIDDLE: f64 = 1e-3;
/// Largest relative difference between the initial distance of two particles and the length of
/// their bond.
const UNSTRESSED: f64 = 1e-9;

/// Part, reason and remedy, if the bond style cannot represent this bond of a rule.
fn misfit_of_bond(name: &str, state: &State, at: usize) -> Option<(String, String, &'static str)> {
    let bonds = &state.bonds;
    let [a, b] = bonds.levers_m(at);
    let length_m = a + b;
    if (a - b).abs() > 2.0 * MIDDLE * length_m {
        let why = format!(
            "in this model shear does not act in the middle of a bond between spheres of different size, where bpm/rotational has it, but {:.1} % of its length away",
            50.0 * (a - b).abs() / length_m
        );
        let remedy = "use another model, such as \"timoshenko\", or spheres of one size";
        return Some((format!("bonds.{name}.model"), why, remedy));
    }
    let part = format!("[bonds.{name}]");
    let remedy = "start from a body whose bonds are at rest";
    let [i, j] = bonds.ends[at].map(|end| state.particles.poses[end as usize].place());
    let apart_m = (j - i).norm();
    if (apart_m / length_m - 1.0).abs() > UNSTRESSED {
        let why = format!(
            "a bond is {:.3e} of its length longer than at rest, and bpm/rotational takes the lengths at rest from the positions at the start",
            apart_m / length_m - 1.0
        );
        return Some((part, why, remedy));
    }
    // A deformation in place of the load of each mode: m and rad.
    let strain = bonds.deformation(at, &state.particles.poses);
    let sheared = strain.shear_n / length_m;
    let largest = sheared.max(strain.torsion_n_m).max(strain.bending_n_m);
    let why = format!(
        "a bond is sheared, twisted or bent by {largest:.3e}, and bpm/rotational takes bonds at rest from the positions at the start"
    );
    (largest > UNSTRESSED).then_some((part, why, remedy))
}
