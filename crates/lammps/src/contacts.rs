//! Contacts as `pair_style granular`: a `pair_coeff` for each pair of materials.
//!
//! Normal law, tangential law and damping are the same formulas. `damping coeff_restitution` takes
//! the restitution that the damping ratio would give with attraction; `limit_damping` cuts
//! attraction off. The tangential spring that keeps the lesser force is `mindlin_rescale/force`.
//!
//! <https://docs.lammps.org/pair_granular.html>

use std::f64::consts::PI;

use dem_scene::Scene;

use super::refusals::Refusals;
use dem_engine::state::contacts::NO_KIND;
use dem_physics::contact::law::{ContactKind, Law, Rolling};
use dem_physics::contact::pair_parameters::PairParameters;
use dem_plan::Plan;

/// The contacts of an export.
#[derive(Debug, Clone, Default)]
pub(super) struct Contacts {
    /// Names of the materials: the atom types.
    pub materials: Vec<String>,
    /// For each particle of the state its material.
    pub material_of: Vec<u8>,
    /// For each pair of materials, the first not after the second, its law in the words of LAMMPS.
    /// Empty: particles never touch each other.
    pub laws: Vec<([usize; 2], String)>,
}

/// The contacts of a planned scene; refuses rolling friction, a liquid bridge, and a restitution
/// that is too small.
pub(super) fn contacts(scene: &Scene, plan: &Plan, refusals: &mut Refusals) -> Contacts {
    let state = &plan.state;
    let materials: Vec<String> = scene.materials.keys().cloned().collect();
    let Some(contacts) = &state.contacts else {
        let mut material_of = vec![0; state.particles.len()];
        for body in &plan.bodies {
            let name = &scene.bodies[&body.name].material;
            let number = materials
                .iter()
                .position(|known| known == name)
                .unwrap_or(0);
            for &i in &body.particles {
                material_of[i as usize] = number as u8;
            }
        }
        return Contacts {
            materials,
            material_of,
            laws: Vec::new(),
        };
    };
    let mut laws = Vec::new();
    let count = materials.len();
    for a in 0..count {
        for b in a..count {
            let kind = contacts.model.kind_of[a * count + b];
            if kind != NO_KIND && !contacts.model.alone {
                let names = format!("{}-{}", materials[a], materials[b]);
                let kind = &contacts.model.kinds[kind as usize];
                let law = law_in_words(&names, kind, refusals);
                laws.extend(law.map(|law| ([a, b], law)));
            }
        }
    }
    Contacts {
        materials,
        material_of: contacts.materials.clone(),
        laws,
    }
}

/// The contact law of a pair of materials, `grain-plate`, in the words of `pair_coeff`, `fix
/// wall/gran` and `fix surface/global`, which mean something only if it is not refused.
pub(super) fn law_in_words(
    names: &str,
    kind: &ContactKind,
    refusals: &mut Refusals,
) -> Option<String> {
    if kind.rolling != Rolling::Free {
        refusals.add(
            format!("contacts.{names}.rolling_friction"),
            "the spring of its rolling friction does not follow the load of the contact, and it has no constant moment",
            "leave rolling_friction out",
        );
    }
    if kind.bridge.is_some() {
        refusals.add(
            format!("contacts.{names}.liquid_bridge"),
            "liquid between its ends, which pulls them together beyond their touch",
            "leave it out, or run the scene with dem-run",
        );
    }
    let (normal, tangential, parameters) = match &kind.law {
        Law::HertzMindlin(law) => {
            let (e, g) = (law.young_modulus_pa, law.shear_modulus_pa);
            let style = tangential_style(&law.parameters);
            // Both dampings are ratios of their own stiffness: k_t / k_n = 8 G* / (2 E*).
            let ratio = (4.0 * g / e).sqrt() * tangential_ratio(&law.parameters);
            (
                format!("hertz {:e}", 4.0 / 3.0 * e),
                format!("{style} {:e} {ratio:e}", 8.0 * g),
                &law.parameters,
            )
        }
        Law::DerjaguinMullerToporov(_) => {
            refusals.add(
                format!("contacts.{names}.law"),
                "the friction of its dmt has another limit than the force that presses",
                "write law = \"hertz-mindlin\" without work_of_adhesion",
            );
            return None;
        }
        Law::Linear(law) => {
            let (n, t) = (law.normal_n_m, law.tangential_n_m);
            let ratio = (t / n).sqrt() * tangential_ratio(&law.parameters);
            (
                format!("hooke {n:e}"),
                format!("linear_history {t:e} {ratio:e}"),
                &law.parameters,
            )
        }
    };
    let zeta = parameters.damping_ratio;
    if zeta >= 1.0 {
        refusals.add(
            format!("contacts.{names}.restitution"),
            format!(
                "it needs a damping ratio of {zeta:.3}, and that of coeff_restitution is below 1"
            ),
            "use a restitution above 0.136",
        );
    }
    let restitution = (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
    let cut = if parameters.least_n == 0.0 {
        " limit_damping"
    } else {
        ""
    };
    Some(format!(
        "{normal} {restitution:e} tangential {tangential} {:e} damping coeff_restitution{cut}",
        parameters.friction
    ))
}

/// Tangential damping relative to that of Tsuji et al. 1992.
fn tangential_ratio(parameters: &PairParameters) -> f64 {
    if parameters.damping_ratio > 0.0 {
        parameters.tangential_damping_ratio / parameters.damping_ratio
    } else {
        1.0
    }
}

fn tangential_style(parameters: &PairParameters) -> &'static str {
    match parameters.kept {
        [0.0, 1.0] => "mindlin_rescale/force",
        [1.0, 1.0] => "mindlin",
        _ => "mindlin/force",
    }
}
