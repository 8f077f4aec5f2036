//! The incremental formulation: independent of numbering, objective, equal to an independent
//! implementation for a bent cantilever, and energy-conserving.

use super::{MODELS, vector};
use dem_physics::bond::incremental::{History, Step, advance, bond_forces};
use dem_physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use dem_physics::bond::total::{self, BondForces, End};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

fn model() -> impl Strategy<Value = Stiffness> {
    (0..MODELS.len(), 0.2..0.6).prop_map(|(model, radius_a)| {
        let shape = BondShape {
            length_m: 1.0,
            radius_m: 0.2,
            end_radii_m: [radius_a, 0.4],
        };
        stiffness(MODELS[model], &shape, 1e3, 0.3)
    })
}

/// A loaded bond along x and a step that moves and rotates its ends.
fn loaded() -> impl Strategy<Value = (Stiffness, History, Step)> {
    let step = (vector(0.2), vector(0.2), vector(0.3), vector(0.3));
    (model(), -9.0..9.0, -9.0..9.0, vector(9.0), step).prop_map(
        |(k, y, z, moment, (before, after, turn_a, turn_b))| {
            let apart_before = Vector3::x() * (1.0 + before.x);
            // A pin never has a moment.
            let moment = if k.bending == 0.0 {
                Vector3::zeros()
            } else {
                moment
            };
            let history = History {
                shear_force: Vector3::new(0.0, y, z),
                moment,
            };
            let step = Step {
                apart_before,
                apart_after: apart_before + after,
                turns: [turn_a, turn_b],
            };
            (k, history, step)
        },
    )
}

fn reversed(k: &Stiffness, history: &History, step: &Step) -> (Stiffness, History, Step) {
    let ([lever_a, lever_b], [turn_a, turn_b]) = (k.levers_m, step.turns);
    let k = Stiffness {
        levers_m: [lever_b, lever_a],
        ..*k
    };
    let history = History {
        shear_force: -history.shear_force,
        moment: -history.moment,
    };
    let step = Step {
        apart_before: -step.apart_before,
        apart_after: -step.apart_after,
        turns: [turn_b, turn_a],
    };
    (k, history, step)
}

/// Forces and moments are of the order 10 to 1000.
const ROUNDING: f64 = 1e-12;

proptest! {
    #[test]
    fn it_does_not_matter_which_end_is_named_first((k, history, step) in loaded()) {
        let (k_back, history_back, step_back) = reversed(&k, &history, &step);
        let forward = bond_forces(&k, &advance(&k, &history, &step), &step.apart_after);
        let back = bond_forces(&k_back, &advance(&k_back, &history_back, &step_back), &step_back.apart_after);
        prop_assert!((forward.force_on_b + back.force_on_b).norm() < ROUNDING);
        prop_assert!((forward.torques[0] - back.torques[1]).norm() < ROUNDING);
        prop_assert!((forward.torques[1] - back.torques[0]).norm() < ROUNDING);
    }

    #[test]
    fn a_step_back_undoes_a_step((k, history, step) in loaded()) {
        let there = advance(&k, &history, &step);
        let step = Step {
            apart_before: step.apart_after,
            apart_after: step.apart_before,
            turns: step.turns.map(|turn| -turn),
        };
        let back = advance(&k, &there, &step);
        prop_assert!((back.shear_force - history.shear_force).norm() < ROUNDING);
        prop_assert!((back.moment - history.moment).norm() < ROUNDING);
    }

    #[test]
    fn the_shear_force_stays_across_and_the_bond_turns_nothing_as_a_whole((k, history, step) in loaded()) {
        let after = advance(&k, &history, &step);
        let apart = step.apart_after;
        prop_assert!(after.shear_force.dot(&apart).abs() < ROUNDING);
        let forces = bond_forces(&k, &after, &apart);
        let moment = apart.cross(&forces.force_on_b) + forces.torques[0] + forces.torques[1];
        prop_assert!(moment.norm() < ROUNDING, "{moment}");
    }

    #[test]
    fn turned_as_a_whole_a_step_gives_turned_forces((k, history, step) in loaded(), turn in vector(3.0)) {
        let turn = UnitQuaternion::from_scaled_axis(turn);
        let after = advance(&k, &history, &step);
        let elsewhere = History {
            shear_force: turn * history.shear_force,
            moment: turn * history.moment,
        };
        let step = Step {
            apart_before: turn * step.apart_before,
            apart_after: turn * step.apart_after,
            turns: step.turns.map(|t| turn * t),
        };
        let found = advance(&k, &elsewhere, &step);
        prop_assert!((found.shear_force - turn * after.shear_force).norm() < ROUNDING);
        prop_assert!((found.moment - turn * after.moment).norm() < ROUNDING);
    }

    /// Half of force times deformation in each mode, and torques about the contact point.
    #[test]
    fn energy_and_load_are_those_of_the_history((k, history, step) in loaded()) {
        let after = advance(&k, &history, &step);
        let BondForces { energy, load, .. } = bond_forces(&k, &after, &step.apart_after);
        let modes = [
            (energy.normal, load.normal_n, k.normal),
            (energy.shear, load.shear_n, k.shear),
            (energy.torsion, load.torsion_n_m, k.torsion),
            (energy.bending, load.bending_n_m, k.bending),
        ];
        for (energy, load, k) in modes {
            if k == 0.0 {
                prop_assert_eq!((energy, load), (0.0, 0.0));
            } else {
                prop_assert!((0.5 * load * load / k - energy).abs() <= 1e-14 * energy);
            }
        }
    }
}

/// The history of a loaded bond, in co-rotating axes, after one rigid-body revolution in this many
/// steps.
fn error_after_turning(steps: u32) -> f64 {
    let k = stiffness(
        BondModel::Timoshenko,
        &BondShape {
            length_m: 1.0,
            radius_m: 0.2,
            end_radii_m: [0.3, 0.5],
        },
        1e3,
        0.3,
    );
    let loaded = History {
        shear_force: Vector3::new(0.0, 3.0, -2.0),
        moment: Vector3::new(1.0, 2.0, 4.0),
    };
    // Neither along the bond nor perpendicular to it.
    let turn = Vector3::new(1.0, 1.5, -0.5) / f64::from(steps);
    let once = UnitQuaternion::from_scaled_axis(turn);
    let mut history = loaded;
    let mut apart = 1.01 * Vector3::x();
    let mut turned = UnitQuaternion::identity();
    for _ in 0..steps {
        turned = once * turned;
        let next = turned * (1.01 * Vector3::x());
        let step = Step {
            apart_before: apart,
            apart_after: next,
            turns: [turn; 2],
        };
        history = advance(&k, &history, &step);
        apart = next;
    }
    let wrong = (turned.inverse() * history.shear_force - loaded.shear_force).norm();
    wrong + (turned.inverse() * history.moment - loaded.moment).norm()
}

#[test]
fn it_is_objective_to_second_order() {
    let errors = [100, 200, 400].map(error_after_turning);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order} of {errors:?}");
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Formulation {
    Incremental,
    Total,
}

/// Eleven spheres of steel in a row, each touching the next: the bar of Chen's case 1.
struct Bar {
    k: Stiffness,
    formulation: Formulation,
    places: Vec<Vector3<f64>>,
    velocities: Vec<Vector3<f64>>,
    spins: Vec<Vector3<f64>>,
    turned: Vec<UnitQuaternion<f64>>,
    history: Vec<History>,
}

const SPHERES: usize = 11;
const RADIUS_M: f64 = 0.2;
const MASS_KG: f64 = 7850.0 * 4.0 / 3.0 * PI * RADIUS_M * RADIUS_M * RADIUS_M;
const INERTIA_KG_M2: f64 = 0.4 * MASS_KG * RADIUS_M * RADIUS_M;
/// Largest stable step of the bar in the Timoshenko model, 2 over its largest frequency, to the
/// digits of an independent implementation.
const CRITICAL_STEP_S: f64 = 6.536982689455117e-5;

impl Bar {
    fn at_rest(model: BondModel, formulation: Formulation) -> Self {
        let shape = BondShape {
            length_m: 2.0 * RADIUS_M,
            radius_m: RADIUS_M,
            end_radii_m: [RADIUS_M; 2],
        };
        Self {
            k: stiffness(model, &shape, 200e9, 0.3),
            formulation,
            places: (0..SPHERES)
                .map(|i| Vector3::x() * (shape.length_m * i as f64))
                .collect(),
            velocities: vec![Vector3::zeros(); SPHERES],
            spins: vec![Vector3::zeros(); SPHERES],
            turned: vec![UnitQuaternion::identity(); SPHERES],
            history: vec![History::default(); SPHERES - 1],
        }
    }

    fn bond(&self, a: usize) -> BondForces {
        let ends = [a, a + 1].map(|i| End {
            position_m: self.places[i],
            turned: self.turned[i],
        });
        match self.formulation {
            Formulation::Incremental => {
                let apart = ends[1].position_m - ends[0].position_m;
                bond_forces(&self.k, &self.history[a], &apart)
            }
            Formulation::Total => total::bond_forces(&self.k, &Vector3::x(), &ends),
        }
    }

    fn kick(&mut self, seconds: f64, load: &Vector3<f64>) {
        let bonds: Vec<_> = (0..SPHERES - 1).map(|a| self.bond(a)).collect();
        let (per_mass, per_inertia) = (seconds / MASS_KG, seconds / INERTIA_KG_M2);
        for (a, bond) in bonds.iter().enumerate() {
            self.velocities[a] -= per_mass * bond.force_on_b;
            self.velocities[a + 1] += per_mass * bond.force_on_b;
            self.spins[a] += per_inertia * bond.torques[0];
            self.spins[a + 1] += per_inertia * bond.torques[1];
        }
        self.velocities[SPHERES - 1] += per_mass * load;
    }

    fn drift(&mut self, seconds: f64) {
        let before = self.places.clone();
        for (place, velocity) in self.places.iter_mut().zip(&self.velocities) {
            *place += seconds * velocity;
        }
        for (turned, spin) in self.turned.iter_mut().zip(&self.spins) {
            *turned = UnitQuaternion::from_scaled_axis(seconds * spin) * *turned;
        }
        for (a, history) in self.history.iter_mut().enumerate() {
            let step = Step {
                apart_before: before[a + 1] - before[a],
                apart_after: self.places[a + 1] - self.places[a],
                turns: [seconds * self.spins[a], seconds * self.spins[a + 1]],
            };
            *history = advance(&self.k, history, &step);
        }
    }

    fn elastic_j(&self) -> f64 {
        (0..SPHERES - 1).map(|a| self.bond(a).energy.total()).sum()
    }

    fn energy_j(&self) -> f64 {
        let squares = |vectors: &[Vector3<f64>]| -> f64 {
            vectors.iter().map(nalgebra::Matrix::norm_squared).sum()
        };
        0.5 * (MASS_KG * squares(&self.velocities) + INERTIA_KG_M2 * squares(&self.spins))
            + self.elastic_j()
    }
}

/// Tip deflection of the bar, held at one end and loaded transversely at the other, at rest after
/// uniform damping.
fn tip_of_cantilever(model: BondModel) -> f64 {
    let mut bar = Bar::at_rest(model, Formulation::Incremental);
    // Below every model's critical step; the damping is critical for the slowest mode, of about 123
    // rad/s.
    let (step, slowing) = (0.5 * 4.74e-5, 2.0 * 123.0);
    let load = 1e5 * Vector3::y();
    for _ in 0..40_000 {
        bar.kick(0.5 * step, &load);
        for vector in bar.velocities.iter_mut().chain(&mut bar.spins) {
            *vector *= 1.0 - step * slowing;
        }
        bar.velocities[0] = Vector3::zeros();
        bar.spins[0] = Vector3::zeros();
        bar.drift(step);
        bar.kick(0.5 * step, &load);
    }
    let fastest = bar.velocities[1..]
        .iter()
        .map(nalgebra::Matrix::norm)
        .fold(0.0, f64::max);
    assert!(fastest < 1e-9, "not at rest: {fastest} m/s");
    bar.places[SPHERES - 1].y
}

#[test]
fn cantilevers_bend_as_the_independent_implementation_says() {
    let tips = [
        (BondModel::Parallel { kappa: None }, 0.008508384010911304),
        (BondModel::EulerBernoulli, 0.008488224602199945),
        (BondModel::Timoshenko, 0.008534202199754698),
    ];
    for (model, tip) in tips {
        let found = tip_of_cantilever(model);
        assert!(
            (found / tip - 1.0).abs() < 1e-9,
            "{model:?}: {found} instead of {tip}"
        );
    }
}

/// The bar flies, tumbles about all three axes and vibrates in bending, stretching and torsion.
fn tumbling(formulation: Formulation) -> Bar {
    let mut bar = Bar::at_rest(BondModel::Timoshenko, formulation);
    let spin = Vector3::new(60.0, 30.0, 100.0);
    for i in 0..SPHERES {
        let from_middle = bar.places[i].x - 2.0;
        let phase = PI * i as f64 / (SPHERES - 1) as f64;
        let shake = Vector3::new(5.0 * phase.cos(), 0.0, 5.0 * ((2.0 * phase).cos() - 0.1));
        bar.velocities[i] =
            Vector3::new(10.0, -20.0, 5.0) + spin.cross(&(from_middle * Vector3::x())) + shake;
        bar.spins[i] = spin + 20.0 * phase.cos() * Vector3::x();
    }
    bar
}

/// Largest change of energy over the energy, in two parts of the run.
fn energy_errors(formulation: Formulation, share_of_critical: f64, steps: u32) -> [f64; 2] {
    let mut bar = tumbling(formulation);
    let step = share_of_critical * CRITICAL_STEP_S;
    let start = bar.energy_j();
    let mut errors = [0.0_f64; 2];
    for i in 0..steps {
        bar.kick(0.5 * step, &Vector3::zeros());
        bar.drift(step);
        bar.kick(0.5 * step, &Vector3::zeros());
        let part = &mut errors[usize::from(i >= steps / 2)];
        *part = part.max((bar.energy_j() / start - 1.0).abs());
    }
    errors
}

/// Both formulations have the error of leapfrog, and neither drifts.
#[test]
fn a_tumbling_bar_keeps_its_energy_as_well_as_in_the_total_formulation() {
    let [early, late] = energy_errors(Formulation::Incremental, 0.1, 50_000);
    let [total_early, total_late] = energy_errors(Formulation::Total, 0.1, 50_000);
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.1;
    assert!(near(early, late), "{early}, then {late}");
    assert!(near(early, total_early), "{early}, total {total_early}");
    assert!(near(late, total_late), "{late}, total {total_late}");
}

#[test]
fn energy_errors_fall_with_the_square_of_the_step() {
    let fractions = [0.1, 0.05, 0.025];
    let errors = fractions
        .map(|fraction| {
            energy_errors(
                Formulation::Incremental,
                fraction,
                (1000.0 / fraction) as u32,
            )
        })
        .map(|[a, b]| a.max(b));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order} of {errors:?}");
    }
}

/// Small motion from rest: both formulations are the same spring.
#[test]
fn small_loads_are_those_of_the_total_formulation() {
    let shape = BondShape {
        length_m: 1.0,
        radius_m: 0.2,
        end_radii_m: [0.3, 0.5],
    };
    let small = 1e-6;
    let moved = small * Vector3::new(0.3, -0.7, 0.2);
    let turns = [
        small * Vector3::new(0.5, 0.1, -0.4),
        small * Vector3::new(-0.2, 0.6, 0.3),
    ];
    for model in MODELS {
        let k = stiffness(model, &shape, 1e3, 0.3);
        let step = Step {
            apart_before: Vector3::x(),
            apart_after: Vector3::x() + moved,
            turns,
        };
        let history = advance(&k, &History::default(), &step);
        let found = bond_forces(&k, &history, &step.apart_after);
        let ends = [(Vector3::zeros(), turns[0]), (step.apart_after, turns[1])].map(
            |(position_m, turn)| End {
                position_m,
                turned: UnitQuaternion::from_scaled_axis(turn),
            },
        );
        let wanted = total::bond_forces(&k, &Vector3::x(), &ends);
        let near = |a: Vector3<f64>, b: Vector3<f64>| (a - b).norm() < 1e-5 * b.norm();
        assert!(near(found.force_on_b, wanted.force_on_b), "{model:?}");
        assert!(near(found.torques[0], wanted.torques[0]), "{model:?}");
        assert!(near(found.torques[1], wanted.torques[1]), "{model:?}");
    }
}
