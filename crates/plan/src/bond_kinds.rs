//! Kinds of bonds of a scene: their models, laws and strengths.

use dem_scene::{BondDamping, BondFailure, BondKind, Formulation};

use dem_engine::state::bonds::{BondLaw, BondRule};
use dem_physics::bond::failure::{Criteria, has_strength};
use dem_physics::bond::plasticity::Plasticity;
use dem_physics::bond::rate_strengthening::RateStrengthening;

/// The law of a kind of bonds, of which the scene allows one.
fn law(kind: &BondKind) -> BondLaw {
    let strength_pa = |strength: Option<f64>| strength.unwrap_or(f64::INFINITY);
    if let Some(joint) = kind.joint {
        BondLaw::FlatJoint(joint)
    } else if kind.formulation == Formulation::Incremental {
        BondLaw::Incremental
    } else if let Some(plasticity) = kind.plasticity {
        BondLaw::ElastoPlastic(Plasticity {
            yield_strengths_pa: [
                plasticity.normal_yield_strength_pa,
                plasticity.shear_yield_strength_pa,
                plasticity.torsion_yield_strength_pa,
                plasticity.bending_yield_strength_pa,
            ]
            .map(strength_pa),
            hardening_ratio: plasticity.hardening_ratio,
        })
    } else if let Some(fracture_energy_j_m2) = kind.failure.fracture_energy_j_m2 {
        BondLaw::Softening {
            fracture_energy_j_m2,
        }
    } else {
        BondLaw::Elastic
    }
}

/// How the strengths of a kind of bonds rise with the strain rate. None: they do not.
pub fn strengthening(failure: &BondFailure) -> Option<RateStrengthening> {
    let curve = failure.rate_strengthening.clone()?;
    let keeps_largest = failure.keeps_largest_factor;
    Some(RateStrengthening {
        curve,
        keeps_largest,
    })
}

/// What the bonds of a kind share.
pub(super) fn rule(kind: &BondKind) -> BondRule {
    let failure = &kind.failure;
    let strength_pa = |strength: Option<f64>| strength.unwrap_or(f64::INFINITY);
    let criteria = Criteria {
        tensile_strength_pa: strength_pa(failure.tensile_strength_pa),
        compressive_strength_pa: strength_pa(failure.compressive_strength_pa),
        shear_strength_pa: strength_pa(failure.shear_strength_pa),
        cohesion_pa: strength_pa(failure.cohesion_pa),
        friction_tangent: failure.friction_angle_rad.map_or(0.0, f64::tan),
        von_mises_strength_pa: strength_pa(failure.von_mises_strength_pa),
        equivalent_stress: failure.equivalent_stress,
    };
    let undamped = BondDamping {
        per_mode: kind.damping.per_mode,
        structural_damping: kind.damping.structural_damping,
        ..BondDamping::default()
    };
    BondRule {
        law: law(kind),
        damped: kind.damping != undamped,
        structural_damping: kind.damping.structural_damping,
        criteria: has_strength(&criteria).then_some(criteria),
        strengthening: strengthening(failure),
        strain_rate_measure: failure.strain_rate_measure,
        contact_beside: kind.contact_beside_bond,
    }
}
