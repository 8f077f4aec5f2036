//! Energy that bonds take to break, of one and of a bar of several.

use dem_run::stages::ledger::bookkeeping::balance;
use dem_run::step::{advance, interact};
use dem_run::{State, step};

use super::bond::{
    COHESION_PA, Criterion, LENGTH_M, POISSON, RADIUS_M, SHEAR_PA, STEPS, TENSION_PA, VON_MISES_PA,
    YOUNG_PA, area_m2, bond, bond_of, second_moment_m4, shear_modulus_pa, shear_stiffness_n_m,
};
use super::rate::dynamic_increase_factor;
use crate::verification::scene::started;
use crate::verification::table::{Case, compared};

/// Work of the supports until the first bond breaks, without what is stored, moves or was damped,
/// over the area of the section, J/m2.
fn energy_to_break_j_m2(mut state: State, end_s: f64) -> f64 {
    while state.time_s <= end_s {
        interact(&mut state);
        if state.broken_count > 0 {
            let now = balance(&mut state);
            let left_j = now.kinetic_j + now.elastic_j() + now.local_damping_j + now.bond_damping_j;
            return (now.support_work_j - left_j) / area_m2();
        }
        advance(&mut state);
    }
    f64::NAN
}

/// Energy to break a Timoshenko bond whose end is moved along this axis, J/m2.
fn of_one_bond(criterion: Criterion, axis: &str, energy_j_m2: f64, way_m: f64) -> f64 {
    let others = if axis == "x" {
        r#""y", "z", "rx", "ry", "rz""#
    } else {
        r#""x", "z", "rx", "ry", "rz""#
    };
    let more = format!(
        r#"
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = [{others}], displacement = {{ {axis} = {way_m:e} }}, ramp = 1 }}
        "#
    );
    let run = format!("end_time = 1, time_step = {:e}", 1.0 / STEPS);
    let failure = format!("{}, fracture_energy = {energy_j_m2:e}", criterion.key());
    energy_to_break_j_m2(bond(&failure, &run, &more), 1.0)
}

/// Energy to break a bond of this model whose ends are rotated against each other about this axis
/// by an angle, rad, J/m2.
fn of_one_rotated(
    model: &str,
    criterion: Criterion,
    axis: &str,
    energy_j_m2: f64,
    angle: f64,
) -> f64 {
    let others = if axis == "rx" {
        r#""x", "y", "z", "ry", "rz""#
    } else {
        r#""x", "y", "z", "rx", "ry""#
    };
    let end = |side: &str, angle: f64| {
        format!(
            "supports.{side} = {{ group = \"{side}\", fixed = [{others}], displacement = {{ {axis} = {angle:e} }}, ramp = 1 }}\n"
        )
    };
    let more = end("left", -0.5 * angle) + &end("right", 0.5 * angle);
    let run = format!("end_time = 1, time_step = {:e}", 1.0 / STEPS);
    let failure = format!("{}, fracture_energy = {energy_j_m2:e}", criterion.key());
    energy_to_break_j_m2(bond_of(model, &failure, &run, &more), 1.0)
}

/// Energy to break a bond that is pulled at a strain rate with strengthening, J/m2.
fn of_one_pulled_fast(rate_1_s: f64, energy_j_m2: f64) -> f64 {
    let speed = rate_1_s * LENGTH_M;
    let more = format!(
        r#"
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = {speed:e} }} }}
        "#
    );
    let end_s = 1.01 * dynamic_increase_factor(rate_1_s) * 2.0 * energy_j_m2 / TENSION_PA / speed;
    let run = format!("end_time = {end_s:e}, time_step = {:e}", end_s / STEPS);
    let failure = format!(
        "{}, rate_strengthening = 1e-9, fracture_energy = {energy_j_m2:e}",
        Criterion::Tension.key()
    );
    energy_to_break_j_m2(bond(&failure, &run, &more), end_s)
}

/// What bonds take that are only bent or twisted, sheared by the equivalent stress, or pulled fast,
/// over the fracture energy.
pub(crate) fn by_mode() -> String {
    const ENERGY_J_M2: f64 = 0.02;
    let shear = shear_stiffness_n_m();
    let normal = YOUNG_PA * area_m2() / LENGTH_M;
    let torsion = 2.0 * shear_modulus_pa() * second_moment_m4() / LENGTH_M;
    let mut cases = Vec::new();
    let parts = |found: f64| found / ENERGY_J_M2;
    for model in ["parallel", "timoshenko"] {
        let edge = 2.0 * ENERGY_J_M2 / RADIUS_M;
        let found = of_one_rotated(
            model,
            Criterion::Tension,
            "rz",
            ENERGY_J_M2,
            1.01 * edge / TENSION_PA,
        );
        cases.push(Case::new(
            format!("{model}, bent"),
            parts(found),
            0.25,
            2.0 / STEPS,
        ));
        let wanted = match model {
            "parallel" => 0.5,
            _ => 0.25 * RADIUS_M * RADIUS_M * shear / torsion,
        };
        // The moment over the angle is that of the wanted part: 2 G_f A over moment times it.
        let moment = SHEAR_PA * 2.0 * second_moment_m4() / RADIUS_M;
        let angle = 2.0 * wanted * ENERGY_J_M2 * area_m2() / moment;
        let found = of_one_rotated(model, Criterion::Shear, "rx", ENERGY_J_M2, 1.01 * angle);
        cases.push(Case::new(
            format!("{model}, twisted"),
            parts(found),
            wanted,
            2.0 / STEPS,
        ));
    }
    let wanted = normal / (3.0 * shear);
    let slid_m = 2.0 * wanted * ENERGY_J_M2 * 3.0_f64.sqrt() / VON_MISES_PA;
    let found = of_one_bond(Criterion::VonMises, "y", ENERGY_J_M2, 1.01 * slid_m);
    let strain = slid_m / LENGTH_M;
    let stretched = 0.5 * YOUNG_PA * strain * strain / VON_MISES_PA;
    let bound = 1.0 / STEPS + strain + stretched;
    let what = "timoshenko, sheared by the equivalent stress";
    cases.push(Case::new(what, parts(found), wanted, bound));
    for rate_1_s in [1e-2, 1.0, 10.0] {
        let found = of_one_pulled_fast(rate_1_s, ENERGY_J_M2);
        let factor = dynamic_increase_factor(rate_1_s);
        let what = format!("timoshenko, pulled at {rate_1_s}/s");
        cases.push(Case::new(what, parts(found), factor * factor, 1e-3));
    }
    compared("bond", "", &cases)
}

/// A bond that is opened, closed, pressed and opened again, as in fig. 7 c of Platzer 2022: its
/// stress over its strength at the end of each way.
pub(crate) fn by_cycle() -> String {
    const ENERGY_J_M2: f64 = 0.02;
    let strength_m = TENSION_PA * LENGTH_M / YOUNG_PA;
    let ratio = 2.0 * ENERGY_J_M2 / TENSION_PA / strength_m;
    // Openings, in multiples of that at the strength, one each second.
    let openings = [0.5, 1.0, 4.0, 2.0, 0.0, -2.0, 2.0, 4.0, 10.0, 5.0, 13.0];
    let mut table = "[0, 0]".to_owned();
    for (second, opening) in (1..).zip(openings) {
        table += &format!(", [{second}, {opening}]");
    }
    let more = format!(
        r#"
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], displacement = {{ x = {strength_m:e} }}, table = [{table}] }}
        "#
    );
    let run = format!("end_time = 12, time_step = {:e}", 1.0 / STEPS);
    let failure = format!(
        "{}, fracture_energy = {ENERGY_J_M2:e}",
        Criterion::Tension.key()
    );
    let mut state = bond(&failure, &run, &more);
    let (mut cases, mut largest) = (Vec::new(), 0.0_f64);
    for (second, opening) in (1..).zip(openings) {
        while state.time_s < f64::from(second) - 0.5 / STEPS {
            step(&mut state);
        }
        interact(&mut state);
        largest = largest.max(opening);
        let damage = if largest > 1.0 {
            ratio * (largest - 1.0) / (largest * (ratio - 1.0))
        } else {
            0.0
        };
        let kept = if opening < 0.0 { 1.0 } else { 1.0 - damage };
        let load_n = state.bonds.forces(0, &state.particles.poses).load.normal_n;
        let stress = load_n / area_m2() / TENSION_PA;
        let what = format!("{opening} times that at the strength");
        let bound = 1e-6 * ratio;
        cases.push(Case::of_scale(what, [stress, kept * opening], 1.0, bound).rounding(1e-8));
        advance(&mut state);
    }
    assert_eq!(state.broken_count, 0);
    compared("opening", "", &cases)
}

/// Energy to break a bar of so many bonds, J/m2.
fn of_a_bar(bonds: u32, energy_j_m2: f64) -> f64 {
    const LONG_M: f64 = 16e-3;
    let length_m = LONG_M / f64::from(bonds);
    let radius_m = 0.5 * length_m;
    let spheres = (0..=bonds).map(|i| {
        let x_m = f64::from(i) * length_m;
        format!("[{x_m:e}, 0, 0, {radius_m:e}]")
    });
    let pairs = (0..bonds).map(|i| format!("[{i}, {}]", i + 1));
    let [spheres, pairs] = [spheres.collect::<Vec<_>>(), pairs.collect()].map(|l| l.join(", "));
    let state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = 50e-3, safety_factor = 0.5, local_damping = 0.2, seed = 2 }}
        materials.stone = {{ density = 2500 }}
        bodies.rod = {{ particles = [{spheres}], bond_list = [{pairs}], material = "stone", bonds = "glue" }}
        groups.left = {{ particles = [0] }}
        groups.right = {{ particles = [{bonds}] }}
        bonds.glue = {{ young_modulus = 1e9, poisson_ratio = {POISSON:e}, radius_factor = {:e}, failure = {{ {}, weibull_modulus = 10, fracture_energy = {energy_j_m2:e} }} }}
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = 4e-3 }} }}
        "#,
        RADIUS_M / radius_m,
        Criterion::Tension.key(),
    ));
    energy_to_break_j_m2(state, 50e-3)
}

pub(crate) fn by_energy() -> String {
    const ENERGY_J_M2: f64 = 0.02;
    let mut cases = Vec::new();
    for (what, criterion, axis, strength_pa) in [
        (
            "tensile strength: tension",
            Criterion::Tension,
            "x",
            TENSION_PA,
        ),
        (
            "equivalent stress: tension",
            Criterion::VonMises,
            "x",
            VON_MISES_PA,
        ),
        ("shear strength: shear", Criterion::Shear, "y", SHEAR_PA),
        (
            "Mohr-Coulomb: shear",
            Criterion::MohrCoulomb,
            "y",
            COHESION_PA,
        ),
    ] {
        let broken_m = 2.0 * ENERGY_J_M2 / strength_pa;
        let found = of_one_bond(criterion, axis, ENERGY_J_M2, 1.01 * broken_m);
        let strain = broken_m / LENGTH_M;
        // Sliding by this strain stretches the bond by half its square.
        let stretched = 0.5 * YOUNG_PA * strain * strain / strength_pa;
        let bound = 1.0 / STEPS + strain + stretched;
        cases.push(Case::new(what, found, ENERGY_J_M2, bound));
    }
    for bonds in [2, 4, 8] {
        let what = format!("bar of {bonds} bonds");
        cases.push(Case::new(what, of_a_bar(bonds, 40.0), 40.0, 0.02));
    }
    compared("bonds", "J/m2", &cases)
}
