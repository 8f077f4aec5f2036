//! Rods under a slowly increasing load break at the load given by the closed form of the criterion,
//! to within one step of the load.

use std::f64::consts::PI;

use dem_engine::state::State;
use dem_engine::state::loads::factor_at;
use dem_engine::step::{advance, interact};
use dem_physics::bond::failure::{Cause, Criteria, Factors, stresses, utilisation};

use super::bodies::{
    ALL, LENGTH_M, LOAD_STEP, MOHR_COULOMB, NONE, NORMAL, PRESSED, RADIUS_M, SHEAR, STRENGTH_PA,
    VON_MISES, area_m2, hold, on_one_thread, push, rod,
};

/// A load at the free end of a rod whose other end is fixed: force and torque, N and N m, in some
/// proportion.
#[derive(Debug, Clone, Copy)]
struct End {
    name: &'static str,
    force: [f64; 3],
    torque: [f64; 3],
}

/// Largest stresses of a bond: axial, bending, shear, torsion.
fn closed_form(end: &End, to_contact_m: f64) -> [f64; 4] {
    let ([fx, fy, fz], [mx, my, mz]) = (end.force, end.torque);
    let (by, bz) = (my - to_contact_m * fz, mz + to_contact_m * fy);
    let second_moment = 0.25 * PI * RADIUS_M.powi(4);
    [
        fx / area_m2(),
        by.hypot(bz) * RADIUS_M / second_moment,
        fy.hypot(fz) / area_m2(),
        mx.abs() * RADIUS_M / (2.0 * second_moment),
    ]
}

/// Utilisation of each strength of such a bond (tension, compression, shear, equivalent,
/// Mohr-Coulomb).
fn used(criteria: &Criteria, [axial, bending, shear, torsion]: [f64; 4]) -> [f64; 5] {
    let pulled = axial.max(0.0) + bending;
    let sheared = shear + torsion;
    [
        (bending + axial).max(0.0) / criteria.tensile_strength_pa,
        (bending - axial).max(0.0) / criteria.compressive_strength_pa,
        sheared / criteria.shear_strength_pa,
        pulled.hypot(3.0_f64.sqrt() * sheared) / criteria.von_mises_strength_pa,
        (sheared + axial * criteria.friction_tangent).max(0.0) / criteria.cohesion_pa,
    ]
}

/// A rod fixed at one end, with a load on the other that slowly grows to `end` and beyond.
fn loaded(bonds: usize, criteria: Criteria, incremental: bool, end: &End) -> State {
    let mut state = rod(bonds, criteria, incremental);
    hold(&mut state, std::iter::once(0), 0.0);
    push(&mut state, bonds as u32, end.force, end.torque);
    state
}

/// The present load minus the full load, in steps of the load.
fn beyond(state: &State) -> f64 {
    (factor_at(&state.loads[0].factor, state.time_s) - 1.0) / LOAD_STEP
}

/// Runs until the first break. Returns the load beyond the full load, in steps of the load, the
/// bond, and the cause. The bond has not reached its criterion in the step before, and has at the
/// break.
fn first_break(state: &mut State) -> Option<(f64, usize, Cause)> {
    let fraction = |state: &State, at: usize| {
        let forces = state.bonds.forces(at, &state.particles.poses);
        let criteria = state.bonds.rules[0].criteria.unwrap();
        let stresses = stresses(&forces.load, state.bonds.radius_m(at));
        let factors = Factors::scattered(state.bonds.strength_factor(at));
        utilisation(&criteria, &stresses, factors)
    };
    let mut before = vec![0.0; state.bonds.len()];
    while beyond(state) < 100.0 {
        let whole = state.bonds.clone();
        interact(state);
        if let Some(&first) = state.scratch.events.broken.first() {
            let at = first.bond as usize;
            let bonds = std::mem::replace(&mut state.bonds, whole);
            // The increments are those of this step, before the bonds broke.
            if bonds.histories.sums.is_empty() {
                assert!(fraction(state, at) >= 1.0, "{at} broke before its strength");
            }
            assert!(before[at] < 1.0, "{at} broke after its strength");
            state.bonds = bonds;
            return Some((beyond(state), at, first.cause));
        }
        for (at, before) in before.iter_mut().enumerate() {
            *before = fraction(state, at);
            assert!(*before < 1.0, "{at} is beyond its strength");
        }
        advance(state);
    }
    None
}

/// Load proportions at the end of a rod of this length; the last number of each is a stress.
fn ends(length_m: f64) -> [End; 9] {
    let force = STRENGTH_PA * area_m2();
    let moment = STRENGTH_PA * PI * RADIUS_M.powi(3) / 4.0;
    // In the middle of the last bond, the moment of the force is subtracted.
    let back = 0.5 * LENGTH_M;
    let end = |name, force, torque| End {
        name,
        force,
        torque,
    };
    [
        end("tension", [force, 0.0, 0.0], [0.0; 3]),
        end("compression", [-force, 0.0, 0.0], [0.0; 3]),
        end("torsion", [0.0; 3], [2.0 * moment, 0.0, 0.0]),
        end("bending", [0.0; 3], [0.0, 0.8 * moment, 0.6 * moment]),
        end(
            "shear without bending in one bond",
            [0.0, force, 0.0],
            [0.0, 0.0, -force * back],
        ),
        end("cantilever", [0.0, 0.0, moment / length_m], [0.0; 3]),
        end(
            "tension and torsion",
            [0.5 * force, 0.0, 0.0],
            [moment, 0.0, 0.0],
        ),
        end(
            "pressure and torsion",
            [-0.5 * force, 0.0, 0.0],
            [2.0 * moment, 0.0, 0.0],
        ),
        end(
            "all",
            [
                0.3 * force,
                0.2 * moment / length_m,
                -0.1 * moment / length_m,
            ],
            [0.4 * moment, 0.1 * moment, -0.2 * moment],
        ),
    ]
}

/// Breaks rods of this many bonds in every way, with both formulations, one bond being the weakest.
fn breaks_at_the_closed_form(bonds: usize, weakest: usize) {
    let length = LENGTH_M * bonds as f64;
    let mut rods = 0;
    for criteria in [NORMAL, PRESSED, SHEAR, VON_MISES, MOHR_COULOMB, ALL] {
        for end in ends(length) {
            let factors: Vec<f64> = (0..bonds)
                .map(|at| if at == weakest { 0.9 } else { 1.2 })
                .collect();
            let fractions: Vec<f64> = (0..bonds)
                .map(|at| {
                    let stresses = closed_form(&end, length - LENGTH_M * (at as f64 + 0.5));
                    used(&criteria, stresses).into_iter().fold(0.0, f64::max) / factors[at]
                })
                .collect();
            let largest = fractions.iter().copied().fold(0.0, f64::max);
            if largest < 1e-6 {
                continue;
            }
            let wanted_bond = fractions
                .iter()
                .position(|&fraction| fraction == largest)
                .unwrap();
            let critical = End {
                force: end.force.map(|f| f / largest),
                torque: end.torque.map(|t| t / largest),
                ..end
            };
            for incremental in [false, true] {
                let mut state = loaded(bonds, criteria, incremental, &critical);
                state.bonds.strength_factors = factors.clone();
                let what = format!("{} {criteria:?}, incremental: {incremental}", end.name);
                let (late, bond, cause) =
                    first_break(&mut state).unwrap_or_else(|| panic!("{what}: does not break"));
                assert!((-0.1..1.1).contains(&late), "{what}: {late} steps late");
                assert_eq!(bond, wanted_bond, "{what}");
                let stresses = closed_form(&end, length - LENGTH_M * (bond as f64 + 0.5));
                let fractions = used(&criteria, stresses);
                let largest = fractions.iter().copied().fold(0.0, f64::max);
                let causes = [
                    Cause::Tension,
                    Cause::Compression,
                    Cause::Shear,
                    Cause::VonMises,
                    Cause::MohrCoulomb,
                ];
                let worst = fractions.iter().position(|&fraction| fraction == largest);
                assert_eq!(Some(cause), worst.map(|worst| causes[worst]), "{what}");
                rods += 1;
            }
        }
    }
    assert!(rods > 40, "{rods} rods");
}

#[test]
fn one_bond_breaks_at_the_closed_form() {
    on_one_thread(|| breaks_at_the_closed_form(1, 0));
}

#[test]
fn a_chain_breaks_at_the_closed_form() {
    on_one_thread(|| breaks_at_the_closed_form(5, 2));
}

/// Failure in tension at the tensile edge, also under a small compression of the bond; in
/// compression at the compressed edge, if there is a strength for it. The equivalent stress always
/// includes bending, and never compression.
#[test]
fn each_edge_breaks_at_its_own_strength() {
    let force = STRENGTH_PA * area_m2();
    let moment = STRENGTH_PA * PI * RADIUS_M.powi(3) / 4.0;
    let end = |name, axial, bending| End {
        name,
        force: [axial * force, 0.0, 0.0],
        torque: [0.0, bending * moment, 0.0],
    };
    let of = |tension, compression| Criteria {
        tensile_strength_pa: tension * STRENGTH_PA,
        compressive_strength_pa: compression * STRENGTH_PA,
        ..NONE
    };
    let never = f64::INFINITY;
    let equivalent = Criteria {
        von_mises_strength_pa: STRENGTH_PA,
        ..NONE
    };
    let pulled = end("pulled", 1.0, 0.0);
    let pressed = end("pressed", -10.0, 0.0);
    let bent = end("bent", 0.0, 1.0);
    let bent_and_pushed = end("bent and pushed a little", -0.1, 1.1);
    let bent_and_pulled = end("bent and pulled a little", 0.1, 0.9);
    let pushed_and_bent = end("pushed and bent a little", -0.9, 0.6);
    let (tension, compression) = (Some(Cause::Tension), Some(Cause::Compression));
    let cases = [
        (pulled, of(1.0, never), tension),
        (pulled, of(never, 0.1), None),
        (pressed, of(1.0, never), None),
        (pressed, of(1.0, 10.0), compression),
        (pressed, equivalent, None),
        (bent, of(1.0, never), tension),
        (bent, of(1.0, 1.2), tension),
        (bent, of(1.2, 1.0), compression),
        (bent_and_pushed, of(1.0, never), tension),
        (bent_and_pushed, of(1.0, 1.3), tension),
        (bent_and_pushed, of(never, 1.2), compression),
        (bent_and_pulled, of(1.0, never), tension),
        (bent_and_pulled, of(never, 0.8), compression),
        (pushed_and_bent, of(0.1, never), None),
        (pushed_and_bent, of(0.1, 1.5), compression),
        (end("bent", -0.1, 1.0), equivalent, Some(Cause::VonMises)),
    ];
    on_one_thread(|| {
        for (end, criteria, wanted) in cases {
            for incremental in [false, true] {
                let mut state = loaded(1, criteria, incremental, &end);
                let found = first_break(&mut state);
                let what = format!("{} {criteria:?}, incremental: {incremental}", end.name);
                assert_eq!(found.map(|(_, _, cause)| cause), wanted, "{what}");
                if let Some((late, ..)) = found {
                    assert!((-0.1..1.1).contains(&late), "{what}: {late} steps late");
                }
            }
        }
    });
}
