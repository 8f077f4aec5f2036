//! Static equilibrium without steps: the equilibrium of bonded bodies on supports under the loads
//! at the end of a run, found by Newton's method.
//!
//! Bonds, loads, gravity and supports are the same as in a run with steps, so both give the same
//! state at rest. Quantities that depend on motion (masses except for weight, damping, time steps)
//! have no effect, and contacts, breakage, inlets and outlets are refused: run.integrator =
//! "leapfrog" is for these.
//!
//! A support that holds one or two of the three rotations of a particle holds the sum of its small
//! rotations about those axes. If the particle also rotates far about the others, the result
//! depends on its path, which here is that of the Newton steps.

mod record;

pub use dem_engine::statics::{Cause, Equilibrium, StaticsEstimate, Unsolved, equilibrium};

use std::sync::atomic::Ordering;
use std::time::Instant;

use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_scene::Scene;

use crate::machine::processor_time_s;
use crate::outputs::frames::order::FrameOrder;
use crate::settings::{RunSettings, SoFar};
use dem_engine::stages::bonds::energy_kernel::elastic_energy;
use dem_engine::state::State;
use dem_engine::state::particles::Motion;
use dem_plan::Plan;
use dem_plan::measure::{bond_utilisation, probes, read_probes};
use dem_results::Balance;
use dem_results::Summary;

use dem_engine::check::validity::strain_warning;

use self::record::{AtRest, equilibrium_summary};
use dem_engine::statics::newton::{loads, six};
use dem_rig::elastic_test::elastic_test;

/// Brings a plan into equilibrium, measures it and writes the results. `tell` is called from time
/// to time with the progress, in 0..1.
///
/// # Errors
/// No stable equilibrium is found (exit code 3); memory or disk are full (1); interrupted (130).
pub fn run(
    plan: Plan,
    scene: &Scene,
    settings: &RunSettings<'_>,
    tell: &dyn Fn(&SoFar),
) -> Result<Summary> {
    if scene.test.is_some() && settings.setup.is_none() {
        let problem = "the test of the scene has not been set up";
        let remedy = "plan the scene with its test, and give both to the run";
        return Err(Diagnostic::failed(scene.source.clone(), problem, remedy));
    }
    let mut probes = probes(scene, &plan);
    let Plan {
        mut state,
        bodies,
        masses,
        notes,
        mut warnings,
        coarse,
        inputs,
        ..
    } = plan;
    let order = settings.folder.map(|_| FrameOrder::new(&bodies, &state));
    let start_moments = moments(&state);
    let end_s = scene.run.end_time_s;
    let clock = Instant::now();
    let processor_before_s = processor_time_s();
    let goes_on = |fraction: f64| {
        tell(&SoFar {
            fraction,
            time_s: fraction * end_s,
            broken_bonds: 0,
        });
        !settings.interrupted.load(Ordering::Relaxed)
    };
    let mut test = None;
    let found = match &settings.setup {
        Some(setup) => {
            let elastic = elastic_test(&mut state, scene, setup, &goes_on)?;
            test = elastic.result(scene);
            elastic.equilibrium
        }
        None => {
            let found = equilibrium(&mut state, end_s, &goes_on);
            found.map_err(|unsolved| problem(&unsolved, scene))?
        }
    };
    set_at_rest(&mut state, end_s, found.newton_steps as u64);
    let wall_s = clock.elapsed().as_secs_f64();
    let processor_s = processor_time_s().zip(processor_before_s);

    let balance = balance(&state, start_moments);
    let values = read_probes(&mut probes, &state, &balance);
    let beyond = (0..state.bonds.len()).filter(|at| bond_utilisation(&state, *at) >= 1.0);
    let found = equilibrium_summary(&found, beyond.count());
    let at_rest = AtRest {
        state: &state,
        scene,
        probes: &probes,
        balance: &balance,
        masses: &masses,
    };
    let processor_s = processor_s.map(|(after, before)| after - before);
    let mut summary = at_rest.summary(settings, found, (wall_s, processor_s), (notes, inputs));
    summary.test = test;
    warnings.extend(strain_warning(summary.largest_bond_strain, ""));
    summary.judge(warnings, coarse, false, None);
    if let (Some(folder), Some(order)) = (settings.folder, order) {
        at_rest.write(folder, &order, &values, &summary)?;
    }
    Ok(summary)
}

/// Turns a state whose poses are in equilibrium into one that has rested there for one long step:
/// at `end_s`, without velocities, with the reactions of its supports.
pub fn set_at_rest(state: &mut State, end_s: f64, steps: u64) {
    let load = loads(state, end_s);
    for motion in &mut state.particles.motions {
        *motion = Motion {
            velocity_m_s: [0.0; 3],
            spin_rad_s: [0.0; 3],
            ..*motion
        };
    }
    for support in &mut state.supports {
        for held in &mut support.held {
            let i = held.particle as usize;
            let bonds = six(&state.particles.wrenches[i]);
            let mut reaction = [0.0; 6];
            for k in (0..6).filter(|k| support.holds[*k].is_some()) {
                reaction[k] = -(bonds[k] + load[i][k]);
            }
            held.before = [0.0; 6];
            held.reactions = [reaction; 2];
        }
    }
    state.time_s = end_s;
    state.previous_time_step_s = end_s;
    state.time_step_s = 0.0;
    state.steps = steps;
}

/// Human-readable description of the failure.
fn problem(unsolved: &Unsolved, scene: &Scene) -> Diagnostic {
    let place = scene.source.clone();
    let fraction = significant(100.0 * unsolved.fraction, 4);
    let reached =
        format!("an equilibrium was found for {fraction} % of the loads and displacements");
    match unsolved.cause {
        Cause::Pivot => Diagnostic::unstable(
            place,
            format!(
                "{reached} and no stable one for more: a pivot of the stiffness is not positive there, so the body buckles or snaps through"
            ),
            "load it less; or see what it does then with run.integrator = \"leapfrog\"",
        ),
        Cause::NoConvergence => Diagnostic::unstable(
            place,
            format!(
                "{reached}; beyond it Newton's method does not converge, the last residual is {} of the largest bond force",
                significant(unsolved.residual, 2)
            ),
            "load it less; or see what it does then with run.integrator = \"leapfrog\"",
        ),
        Cause::Memory => Diagnostic::failed(
            place,
            "the factors of the stiffness do not fit into memory",
            "use fewer particles, or run.integrator = \"leapfrog\"",
        ),
        Cause::Processor => Diagnostic::failed(
            place,
            "the library of linear systems does not work on this processor, which has FMA without all of AVX2, or AVX-512F without all of AVX-512",
            "run it on another, or with run.integrator = \"leapfrog\"",
        ),
        Cause::Interrupted => Diagnostic::interrupted(
            format!("interrupted: {reached}"),
            "a static run leaves no checkpoint: start it again",
        )
        .within(&place),
    }
}

/// Sum of mass times position of all particles, kg m. Length 3.
fn moments(state: &State) -> [f64; 3] {
    let p = &state.particles;
    dem_engine::stages::chunks::ordered_sums(p.len(), |i| {
        let mass_kg = 1.0 / p.motions[i].inverse_mass;
        let [x, y, z, _] = p.poses[i].position_m;
        [x, y, z].map(|x| mass_kg * x)
    })
}

/// Energies at rest. Works and errors depend on a path that was not followed: they are NaN.
fn balance(state: &State, start_moments: [f64; 3]) -> Balance {
    let elastic = elastic_energy(state);
    let now = moments(state);
    let fallen = |k: usize| state.model.gravity_m_s2[k] * (now[k] - start_moments[k]);
    Balance {
        elastic_normal_j: elastic.normal,
        elastic_shear_j: elastic.shear,
        elastic_torsion_j: elastic.torsion,
        elastic_bending_j: elastic.bending,
        gravity_j: 0.0 - (0..3).map(fallen).sum::<f64>(),
        load_work_j: f64::NAN,
        support_work_j: f64::NAN,
        energy_error_j: f64::NAN,
        energy_error: f64::NAN,
        momentum_error: f64::NAN,
        angular_momentum_error: f64::NAN,
        ..Balance::default()
    }
}
