//! Strengths under increasing displacements and loads, by every criterion.

use std::f64::consts::PI;

use super::bond::{
    Criterion, DAMPING, LENGTH_M, RADIUS_M, SHEAR_PA, STEPS, STRAIN, Stresses, TENSION_PA,
    YOUNG_PA, area_m2, bond, breaks_s, second_moment_m4, shear_modulus_pa, shear_stiffness_n_m,
};
use crate::verification::table::{Case, compared};

/// Fraction of its final value that a load has reached when the bond breaks: in the middle of a
/// step.
const FRACTION: f64 = 0.700_05;

/// Fraction of these stresses at which a bond breaks whose ends are displaced and rotated such that
/// it carries them at the end.
fn breaks_at(criterion: Criterion, end: Stresses) -> f64 {
    let strain = end.axial / YOUNG_PA;
    let slid_m = end.shear * area_m2() / shear_stiffness_n_m();
    let bent = end.bending * LENGTH_M / (YOUNG_PA * RADIUS_M);
    let twisted = end.torsion * LENGTH_M / (shear_modulus_pa() * RADIUS_M);
    let more = format!(
        r#"
        supports.left = {{ group = "left", fixed = ["x", "y", "z", "rx", "ry"], displacement = {{ rz = {:e} }}, ramp = 1 }}
        supports.right = {{ group = "right", fixed = ["z", "ry"], displacement = {{ x = {:e}, y = {slid_m:e}, rx = {twisted:e}, rz = {:e} }}, ramp = 1 }}
        "#,
        -0.5 * bent,
        strain * LENGTH_M,
        0.5 * bent,
    );
    let run = format!("end_time = 1, time_step = {:e}", 1.0 / STEPS);
    breaks_s(&mut bond(&criterion.key(), &run, &more), 1.0)
}

/// Axial, bending, shear and torsional stress, in these proportions.
const LOADS: [(&str, [f64; 4]); 11] = [
    ("tension", [1.0, 0.0, 0.0, 0.0]),
    ("compression", [-1.0, 0.0, 0.0, 0.0]),
    ("bending", [0.0, 1.0, 0.0, 0.0]),
    ("shear", [0.0, 0.0, 1.0, 0.0]),
    ("torsion", [0.0, 0.0, 0.0, 1.0]),
    ("tension and bending", [0.4, 0.6, 0.0, 0.0]),
    ("compression and bending", [-0.7, 0.3, 0.0, 0.0]),
    ("shear and torsion", [0.0, 0.0, 0.5, 0.2]),
    ("compression and shear", [-0.5, 0.0, 0.5, 0.0]),
    ("tension and torsion", [0.4, 0.0, 0.0, 0.2]),
    ("all", [0.3, 0.4, 0.1, 0.3]),
];

/// The loads with which each criterion is tested.
const TRIED: [(Criterion, &[&str]); 6] = [
    (
        Criterion::Tension,
        &["tension", "bending", "tension and bending", "all"],
    ),
    (
        Criterion::Compression,
        &["compression", "bending", "compression and bending"],
    ),
    (
        Criterion::Shear,
        &["shear", "torsion", "shear and torsion", "all"],
    ),
    (
        Criterion::MohrCoulomb,
        &[
            "shear",
            "torsion",
            "tension",
            "compression and shear",
            "tension and torsion",
            "all",
        ],
    ),
    (
        Criterion::CutOff,
        &[
            "tension",
            "bending",
            "shear",
            "compression and shear",
            "tension and torsion",
            "all",
        ],
    ),
    (
        Criterion::VonMises,
        &[
            "tension",
            "bending",
            "shear",
            "torsion",
            "compression and bending",
            "all",
        ],
    ),
];

/// All criteria under single and mixed loads: the largest stress at the break.
pub(crate) fn by_displacement() -> String {
    let tried = TRIED.iter().flat_map(|(criterion, names)| {
        let of = move |name: &&str| LOADS.iter().find(|load| load.0 == *name).unwrap();
        names.iter().map(move |name| (*criterion, of(name)))
    });
    let cases = tried.map(|(criterion, &(name, load))| {
        let whole = 1.0 / (FRACTION * criterion.used(Stresses::of(load)));
        let end = load.map(|part| whole * part);
        let largest = 1e-6 * end.map(f64::abs).into_iter().fold(0.0, f64::max);
        let found = largest * breaks_at(criterion, Stresses::of(end));
        let what = format!("{}: {name}", criterion.name());
        Case::new(
            what,
            found,
            largest * FRACTION,
            1.0 / (FRACTION * STEPS) + STRAIN,
        )
    });
    compared("criterion: load", "MPa", &cases.collect::<Vec<_>>())
}

/// Slowly increasing loads on the free end. Damping with the coefficient c reduces the load of a
/// bond of stiffness k by c/k times the rate of the load.
pub(crate) fn by_load() -> String {
    let mass_kg = 2500.0 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    let inertia_kg_m2 = 0.4 * mass_kg * RADIUS_M * RADIUS_M;
    let normal = YOUNG_PA * area_m2() / LENGTH_M;
    let bending = YOUNG_PA * second_moment_m4() / LENGTH_M;
    let torsion = 2.0 * shear_modulus_pa() * second_moment_m4() / LENGTH_M;
    let step_s = 0.1 * (mass_kg / normal).sqrt();
    let force_damping = 2.0 * DAMPING * (normal * mass_kg).sqrt();
    let moment_damping = 2.0 * DAMPING * (2.0 * torsion * inertia_kg_m2).sqrt();
    let force = TENSION_PA * area_m2();
    let moment = TENSION_PA * second_moment_m4() / RADIUS_M;
    let twist = 2.0 * SHEAR_PA * second_moment_m4() / RADIUS_M;
    let of_bending_s = moment_damping / bending;
    let mut cases = Vec::new();
    for (criterion, what, push, strength, lag_s) in [
        (
            Criterion::Tension,
            "tension, N",
            "force = [1, 0, 0]",
            force,
            force_damping / normal,
        ),
        (
            Criterion::Tension,
            "bending, N m",
            "torque = [0, 0, 1]",
            moment,
            of_bending_s,
        ),
        (
            // The moment is evaluated halfway along the bond.
            Criterion::Tension,
            "across the end, N",
            "force = [0, 1, 0]",
            moment / (0.5 * LENGTH_M),
            of_bending_s,
        ),
        (
            Criterion::Shear,
            "torsion, N m",
            "torque = [1, 0, 0]",
            twist,
            moment_damping / torsion,
        ),
    ] {
        let (end, end_s) = (strength / FRACTION, STEPS * step_s);
        let push = push.replace('1', &format!("{end:e}"));
        let more = format!(
            "supports.left = {{ group = \"left\", fixed = true }}\nloads.right = {{ group = \"right\", {push}, ramp = {end_s:e} }}"
        );
        let run = format!("end_time = {end_s:e}, time_step = {step_s:e}");
        let found = breaks_s(&mut bond(&criterion.key(), &run, &more), end_s) / end_s;
        let bound = (1.0 + lag_s / step_s) / (FRACTION * STEPS) + STRAIN;
        cases.push(Case::new(what, found * end, strength, bound));
    }
    compared("load", "", &cases)
}
