//! The time step of a run: the exact limit, what is chosen, and the estimates that others use beside it.

use dem_io::scene::Scene;
use dem_io::{Diagnostic, Result};

use crate::check::limit::{Limit, limit};
use crate::state::State;

/// The chosen step and what it was chosen from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepChoice {
    /// Taken, s.
    pub step_s: f64,
    /// Whether it was given, not found.
    pub given: bool,
    /// The exact limit.
    pub limit: Limit,
    /// Rayleigh's estimate [Platzer 14], s; infinite where no modulus is known.
    pub rayleigh_s: f64,
    /// 0.17 sqrt(m/K) [Platzer 15], s; infinite without bonds.
    pub thesis_s: f64,
}

impl StepChoice {
    /// Step over limit.
    pub fn share_of_limit(&self) -> f64 {
        self.step_s / self.limit.step_s
    }
}

/// Chooses the step of a scene: the one given, or `safety` times the limit, made a little smaller so that the end time is met.
///
/// # Errors
/// A given step above the limit, unless any step is allowed.
pub fn choose_step(scene: &Scene, state: &mut State, allow_any_step: bool) -> Result<StepChoice> {
    let run = &scene.run;
    let limit = limit(state);
    if limit.step_s.is_nan() || limit.step_s <= 0.0 {
        return Err(Diagnostic::input(
            scene.source.clone(),
            format!("the largest stable time step is {} s", limit.step_s),
            "check the units of places, radii, density, modulus and damping",
        ));
    }
    let step_s = match run.time_step_s {
        Some(given) => {
            if given > limit.step_s && !allow_any_step {
                return Err(Diagnostic::input(
                    format!("{}: run.time_step", scene.source),
                    format!(
                        "{given:.4e} s is above the largest stable step of {:.4e} s",
                        limit.step_s
                    ),
                    "write time_step = \"auto\", or --force-step to see what happens",
                ));
            }
            given
        }
        None => {
            let largest = (run.safety * limit.step_s).min(run.end_time_s / 100.0);
            run.end_time_s / (run.end_time_s / largest).ceil()
        }
    };
    Ok(StepChoice {
        step_s,
        given: run.time_step_s.is_some(),
        limit,
        rayleigh_s: rayleigh_s(scene, state),
        thesis_s: thesis_s(state),
    })
}

/// pi R sqrt(rho/G) / (0.1631 nu + 0.8766), the smallest of all particles [Platzer 14].
fn rayleigh_s(scene: &Scene, state: &State) -> f64 {
    let softness = |material: &dem_io::scene::Material| {
        let nu = material.poisson_ratio;
        let shear = material.young_modulus_pa? / (2.0 * (1.0 + nu));
        Some(1.0 / (shear.sqrt() * (0.1631 * nu + 0.8766)))
    };
    let smallest = scene
        .materials
        .values()
        .filter_map(softness)
        .fold(f64::INFINITY, f64::min);
    let p = &state.particles;
    (0..p.len())
        .map(|i| {
            let radius = p.poses[i].radius_m();
            let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
            let density = 1.0 / (p.motions[i].inverse_mass * volume);
            std::f64::consts::PI * radius * density.sqrt() * smallest
        })
        .fold(f64::INFINITY, f64::min)
}

/// 0.17 sqrt(m/K) with the lighter end and the normal stiffness of each bond, the smallest of all bonds [Platzer 15].
fn thesis_s(state: &State) -> f64 {
    let motions = &state.particles.motions;
    let bonds = &state.bonds;
    (0..bonds.len())
        .map(|at| {
            let [a, b] = bonds.ends[at].map(|end| motions[end as usize].inverse_mass);
            0.17 / (bonds.normal(at) * a.max(b)).sqrt()
        })
        .fold(f64::INFINITY, f64::min)
}
