//! The largest stable step as observed: below it a small disturbance stays small, and above it, the
//! disturbance grows.
//!
//! Neither the program's limit nor its watchdog is used: the scene's state is stepped as it is, and
//! its energy is observed. Both must agree to a hundredth for all entries of the map: all bond
//! models with damping from none to ten times the critical value.

use std::sync::atomic::{AtomicBool, Ordering};

use dem_io::{Body, Diagnostic, Result};
use dem_scene::bond_models;

use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;
use dem_engine::stages::bonds::energy_kernel::elastic_energy;
use dem_engine::stages::ledger::totals::kinetic_energy;
use dem_engine::state::State;
use dem_engine::step::step;

/// Smallest distance between the largest stable and the smallest unstable step, relative to the
/// step.
const RESOLUTION: f64 = 0.002;
/// Ratio of energy to the initial energy at which a disturbance has grown: a thousandfold
/// amplitude. So small a disturbance is then still linear.
const GROWN: f64 = 1e6;
/// Initial strain of the bonds.
const DISTURBANCE: f64 = 1e-8;
/// Number of steps after which a disturbance that has not grown counts as stable. A strongly damped
/// mode grows slowest: by 4 `RESOLUTION` a step at least if the step exceeds the limit by
/// `RESOLUTION`. With a thousandth of the disturbance in it, the disturbance has grown a
/// thousandfold when the mode has grown a millionfold, after ln(1e6) / (4 `RESOLUTION`) = 1730
/// steps.
const STEPS: usize = 1800;
/// Interval between checks of the energy, in steps.
const EVERY: usize = 25;
/// Largest difference between predicted and observed limits.
const AGREEMENT: f64 = 0.01;

/// Largest stable step of a scene, s, within `RESOLUTION`, from half the program's limit to twice
/// that; NaN if all of those steps are stable, or none.
pub fn largest_step_s(trial: &Trial, interrupted: &AtomicBool) -> Result<f64> {
    let (_, plan, _) = trial.planned()?;
    let predicted_s = plan.step.limit.step_s;
    let mut bracket = [0.5 * predicted_s, 2.0 * predicted_s];
    let nearby = [0.995, 1.005].map(|fraction| fraction * predicted_s);
    let grows = |step_s: f64| grows(&plan.state, step_s, interrupted);
    // Most limits are near the prediction: two runs instead of a dozen.
    for near_s in nearby {
        bracket[usize::from(grows(near_s)?)] = near_s;
    }
    let ends = [0, 1].map(|end| bracket[end] != nearby[end]);
    for end in (0..2).filter(|end| ends[*end]) {
        if grows(bracket[end])? != (end == 1) {
            return Ok(f64::NAN);
        }
    }
    while bracket[1] - bracket[0] > RESOLUTION * bracket[0] {
        let middle = 0.5 * (bracket[0] + bracket[1]);
        bracket[usize::from(grows(middle)?)] = middle;
    }
    Ok(0.5 * (bracket[0] + bracket[1]))
}

/// Whether the disturbance of a state grows with this step, s.
fn grows(state: &State, step_s: f64, interrupted: &AtomicBool) -> Result<bool> {
    let mut state = state.clone();
    state.time_step_s = step_s;
    let energy_j = |state: &State| {
        let p = &state.particles;
        kinetic_energy(p, |i| p.motions[i]) + elastic_energy(state).total()
    };
    let start_j = energy_j(&state);
    for _ in 0..STEPS / EVERY {
        for _ in 0..EVERY {
            step(&mut state);
        }
        // NaN counts as grown.
        let is_small = energy_j(&state) <= GROWN * start_j;
        if !is_small {
            return Ok(true);
        }
        if interrupted.load(Ordering::Relaxed) {
            return Err(Diagnostic::interrupted("interrupted", ""));
        }
    }
    Ok(false)
}

/// The map: all models in both formulations, with no, light, critical and very high damping, and
/// the flat joint, which has only the total one; also other types of damping.
pub fn map() -> Result<Vec<Member>> {
    let etas = ["0", "0.1", "0.3", "1", "3", "10"];
    let mut members = Vec::new();
    for model in bond_models().filter(|model| *model != "flat-joint") {
        for eta in etas {
            for formulation in ["total", "incremental"] {
                members.push(of(
                    model,
                    formulation,
                    &format!("damping_ratio = {eta}"),
                    "0",
                )?);
            }
        }
    }
    for damping in [
        "damping_ratio = 0.3, per_mode = true",
        "damping_ratio = 10, per_mode = true",
        "damping_coefficient = \"30 N s/m\", torque_factor = 1",
        "normal_damping_ratio = 0.1, shear_damping_ratio = 0.3, torsion_damping_ratio = 1, bending_damping_ratio = 3",
        "structural_damping = 0.1",
        "structural_damping = 0.5",
        "structural_damping = 0.9",
    ] {
        members.push(of("timoshenko", "total", damping, "0")?);
    }
    members.push(of(
        "parallel",
        "incremental",
        "normal_damping_ratio = 3, shear_damping_ratio = 1, torsion_damping_ratio = 0.1, bending_damping_ratio = 0.3",
        "0",
    )?);
    for eta in ["0", "0.3"] {
        members.push(of(
            "flat-joint",
            "total",
            &format!("damping_ratio = {eta}"),
            "0",
        )?);
    }
    for local_damping in ["0.1", "0.5", "0.9"] {
        members.push(of(
            "timoshenko",
            "total",
            "damping_ratio = 0",
            local_damping,
        )?);
    }
    Ok(members)
}

/// A disturbed block with bonds of this model, formulation and damping.
pub fn of(model: &str, formulation: &str, damping: &str, local_damping: &str) -> Result<Member> {
    let scene = format!(
        "version = 1
run = {{ end_time = \"1 s\", local_damping = {local_damping} }}
materials.rock.density = 2500
bonds.rock = {{ model = \"{model}\", formulation = \"{formulation}\", young_modulus = \"1 GPa\", poisson_ratio = 0.25, damping = {{ {damping} }} }}
bodies.block = {{ file = \"block.vtp\", material = \"rock\", bonds = \"rock\" }}
"
    );
    let trial = Trial {
        bodies: vec![("block.vtp", block(3, 0.0, DISTURBANCE)?)],
        ..Trial::of(scene)
    };
    let of_particles = match local_damping {
        "0" => String::new(),
        gamma => format!(", local_damping = {gamma}"),
    };
    let name = match formulation {
        "total" => model.to_owned(),
        _ => format!("{model} ({formulation})"),
    };
    program_limit(format!("{name}, {damping}{of_particles}"), trial)
}

/// Predicts that the program's limit for a scene equals the observed one.
pub fn program_limit(what: String, trial: Trial) -> Result<Member> {
    let (_, plan, _) = trial.planned()?;
    let predicted_s = plan.step.limit.step_s;
    Ok(Member {
        what,
        trial,
        way: ObservationMethod::LargestStep,
        prediction: Prediction::Ends(vec![Shown {
            quantity: Quantity::LargestStep,
            unit: "s",
            value: predicted_s,
            tolerance: AGREEMENT * predicted_s,
        }]),
    })
}

/// A block of `side` spheres each way on a cubic grid, about 1 mm in radius with varying sizes,
/// bonded to their neighbours along the edges and the face diagonals of the grid; neighbours
/// overlap like spheres that touch at r/(1 + overlap). Bonds are stretched by `strain`, every
/// second one compressed.
pub fn block(side: usize, overlap: f64, strain: f64) -> Result<Body> {
    let pitch_m = 2.0e-3 / (1.0 + overlap);
    let mut spheres = Vec::new();
    let mut cells = Vec::new();
    for n in 0..side * side * side {
        let cell = [n % side, n / side % side, n / (side * side)];
        let [x, y, z] = cell.map(|k| k as f64 * pitch_m);
        // Seven sizes in turn: neighbours always differ.
        let radius_m = 1.0e-3 * (1.0 - 0.02 * (n * 3 % 7) as f64);
        spheres.push([x, y, z, radius_m]);
        cells.push(cell);
    }
    let is_near = |a: &[usize; 3], b: &[usize; 3]| {
        let apart = [0, 1, 2].map(|k| a[k].abs_diff(b[k]));
        apart.iter().max() == Some(&1) && apart.iter().sum::<usize>() <= 2
    };
    let mut bonds = Vec::new();
    let farthest = side * side + side + 1;
    for a in 0..cells.len() {
        let later = a + 1..cells.len().min(a + farthest + 1);
        let near = later.filter(|&b| is_near(&cells[a], &cells[b]));
        bonds.extend(near.map(|b| [a as u32, b as u32]));
    }
    let mut body = Body::from_spheres(&spheres, &bonds)?;
    for (n, length) in body.bond_lengths.iter_mut().enumerate() {
        *length *= if n % 2 == 0 {
            1.0 - strain
        } else {
            1.0 + strain
        };
    }
    Ok(body)
}

/// A step just below the limit, one just above it, and the latter with force.
pub(crate) fn beside_the_limit() -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for eta in ["0", "0.3", "3"] {
        let text = |time_step: &str, end_s: f64| {
            format!(
                "version = 1
run = {{ end_time = {end_s:e}, time_step = {time_step} }}
materials.rock.density = 2500
bonds.rock = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25, damping = {{ damping_ratio = {eta} }} }}
bodies.block = {{ file = \"block.vtp\", material = \"rock\", bonds = \"rock\" }}
measures.elastic_energy = {{ quantity = \"elastic_energy\", statistic = \"largest\" }}
"
            )
        };
        let trial = |time_step: &str, end_s: f64, force_step: bool| -> Result<Trial> {
            Ok(Trial {
                bodies: vec![("block.vtp", block(3, 0.0, 1e-6)?)],
                force_step,
                ..Trial::of(text(time_step, end_s))
            })
        };
        let (_, plan, _) = trial("\"auto\"", 1.0, false)?.planned()?;
        let limit_s = plan.step.limit.step_s;
        let start_j = elastic_energy(&plan.state).total();
        let fraction = 0.98;
        let end_s = STEPS as f64 * limit_s;
        // For a mode, leapfrog conserves its energy minus (w dt / 2)^2 of the elastic part.
        let most_j = start_j / (1.0 - fraction * fraction);
        members.push(Member::ends(
            format!("0.98, damping {eta}"),
            trial(&format!("{:e}", fraction * limit_s), end_s, false)?,
            vec![Shown::measure("elastic_energy", "J", 0.0, most_j)],
        ));
        let above = format!("{:e}", 1.02 * limit_s);
        members.push(Member {
            what: format!("1.02, damping {eta}"),
            trial: trial(&above, end_s, false)?,
            way: ObservationMethod::Run,
            prediction: Prediction::Refused(vec![format!(
                "is above the largest stable step of {limit_s:.4e} s"
            )]),
        });
        members.push(Member {
            what: format!("1.02 by force, damping {eta}"),
            trial: trial(&above, end_s, true)?,
            way: ObservationMethod::Run,
            prediction: Prediction::Stopped(vec![
                "of energy were created".to_owned(),
                "began at 1.020 of the largest stable one".to_owned(),
            ]),
        });
    }
    Ok(members)
}
