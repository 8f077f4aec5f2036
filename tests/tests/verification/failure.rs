//! Breakage of one bond, by every criterion, at every rate, and of many with scattered strengths.

use std::f64::consts::PI;

use dem_run::stages::ledger::balance;
use dem_run::step::{advance, interact};
use dem_run::{State, step};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::started;
use super::table::{Case, compared};

const RADIUS_M: f64 = 1e-3;
const LENGTH_M: f64 = 3e-3;
const YOUNG_PA: f64 = 1e12;
const POISSON: f64 = 0.2;
/// eta of Chen et al. 2022, eqs. 9 and 10.
const DAMPING: f64 = 0.3;

/// The strengths in tension and compression, in shear, by Mohr-Coulomb and by the equivalent
/// stress, Pa.
const TENSION_PA: f64 = 1.0e6;
const COMPRESSION_PA: f64 = 1.3e6;
const SHEAR_PA: f64 = 0.7e6;
const COHESION_PA: f64 = 0.5e6;
/// Its friction angle, degrees.
const FRICTION_DEG: f64 = 35.0;
const VON_MISES_PA: f64 = 1.1e6;
/// Tensile strength that cuts Mohr-Coulomb off before its tip at c/tan(phi), Pa.
const CUT_OFF_PA: f64 = 0.35e6;

/// Number of steps in which a load rises to its final value. A bond breaks at the first step at
/// which it carries more than its strength: at most one load step late.
const STEPS: f64 = 10_000.0;
/// Fraction of its final value that a load has reached when the bond breaks: in the middle of a
/// step.
const FRACTION: f64 = 0.700_05;
/// Relative nonlinearity of loads in displacements: bonds break at strains of about 1e-6.
const STRAIN: f64 = 1e-5;

/// Axial, bending, shear and torsional stress, in some proportion, Pa.
#[derive(Debug, Clone, Copy)]
struct Stresses {
    axial: f64,
    bending: f64,
    shear: f64,
    torsion: f64,
}

const NONE: Stresses = Stresses {
    axial: 0.0,
    bending: 0.0,
    shear: 0.0,
    torsion: 0.0,
};

/// A strength: its key, and its type of stress.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Criterion {
    Tension,
    Compression,
    Shear,
    MohrCoulomb,
    CutOff,
    VonMises,
}

impl Criterion {
    fn key(self) -> String {
        match self {
            Self::Tension => format!("tensile_strength = {TENSION_PA:e}"),
            Self::Compression => format!("compressive_strength = {COMPRESSION_PA:e}"),
            Self::Shear => format!("shear_strength = {SHEAR_PA:e}"),
            Self::MohrCoulomb => {
                format!("cohesion = {COHESION_PA:e}, friction_angle = \"{FRICTION_DEG} deg\"")
            }
            Self::CutOff => {
                format!(
                    "{}, tensile_strength = {CUT_OFF_PA:e}",
                    Self::MohrCoulomb.key()
                )
            }
            Self::VonMises => format!(
                "von_mises_strength = {VON_MISES_PA:e}, equivalent_stress = \"axial-in-tension\""
            ),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Tension => "tensile strength",
            Self::Compression => "compressive strength",
            Self::Shear => "shear strength",
            Self::MohrCoulomb => "Mohr-Coulomb",
            Self::CutOff => "Mohr-Coulomb, cut off",
            Self::VonMises => "equivalent stress",
        }
    }

    /// Utilisation of the strength by these stresses.
    fn used(self, s: Stresses) -> f64 {
        let sheared = s.shear + s.torsion;
        match self {
            Self::Tension => (s.bending + s.axial) / TENSION_PA,
            Self::Compression => (s.bending - s.axial) / COMPRESSION_PA,
            Self::Shear => sheared / SHEAR_PA,
            Self::MohrCoulomb => {
                (sheared + s.axial * FRICTION_DEG.to_radians().tan()) / COHESION_PA
            }
            Self::CutOff => {
                let pulled = (s.bending + s.axial) / CUT_OFF_PA;
                pulled.max(Self::MohrCoulomb.used(s))
            }
            Self::VonMises => {
                let pulled = s.axial.max(0.0) + s.bending;
                (pulled * pulled + 3.0 * sheared * sheared).sqrt() / VON_MISES_PA
            }
        }
    }
}

fn area_m2() -> f64 {
    PI * RADIUS_M * RADIUS_M
}

fn second_moment_m4() -> f64 {
    0.25 * PI * RADIUS_M.powi(4)
}

fn shear_modulus_pa() -> f64 {
    YOUNG_PA / (2.0 * (1.0 + POISSON))
}

/// Shear stiffness of a Timoshenko bond, N/m.
fn shear_stiffness_n_m() -> f64 {
    let phi = 20.0 * RADIUS_M * RADIUS_M * (1.0 + POISSON) / (3.0 * LENGTH_M * LENGTH_M);
    12.0 * YOUNG_PA * second_moment_m4() / (LENGTH_M.powi(3) * (1.0 + phi))
}

/// Two spheres and their Timoshenko bond along x; `failure` are its failure keys, `more` is added
/// for the spheres "left" and "right".
fn bond(failure: &str, run: &str, more: &str) -> State {
    bond_of("timoshenko", failure, run, more)
}

/// The same of another model.
fn bond_of(model: &str, failure: &str, run: &str, more: &str) -> State {
    started(&format!(
        r#"
        version = 1
        run = {{ {run} }}
        materials.stone = {{ density = 2500 }}
        bodies.rod = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{LENGTH_M:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue" }}
        groups.left = {{ particles = [0] }}
        groups.right = {{ particles = [1] }}
        bonds.glue = {{ model = "{model}", young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, failure = {{ {failure} }}, damping = {{ damping_ratio = {DAMPING} }} }}
        {more}
        "#
    ))
}

/// Runs until the first bond breaks. Returns the time of the forces that broke it, s.
fn breaks_s(state: &mut State, end_s: f64) -> f64 {
    while state.time_s <= end_s {
        let now_s = state.time_s;
        step(state);
        if state.broken_count > 0 {
            return now_s;
        }
    }
    f64::NAN
}

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

/// Proportions of stresses, by their type.
const LOADS: [(&str, Stresses); 11] = [
    ("tension", Stresses { axial: 1.0, ..NONE }),
    (
        "compression",
        Stresses {
            axial: -1.0,
            ..NONE
        },
    ),
    (
        "bending",
        Stresses {
            bending: 1.0,
            ..NONE
        },
    ),
    ("shear", Stresses { shear: 1.0, ..NONE }),
    (
        "torsion",
        Stresses {
            torsion: 1.0,
            ..NONE
        },
    ),
    (
        "tension and bending",
        Stresses {
            axial: 0.4,
            bending: 0.6,
            ..NONE
        },
    ),
    (
        "compression and bending",
        Stresses {
            axial: -0.7,
            bending: 0.3,
            ..NONE
        },
    ),
    (
        "shear and torsion",
        Stresses {
            shear: 0.5,
            torsion: 0.2,
            ..NONE
        },
    ),
    (
        "compression and shear",
        Stresses {
            axial: -0.5,
            shear: 0.5,
            ..NONE
        },
    ),
    (
        "tension and torsion",
        Stresses {
            axial: 0.4,
            torsion: 0.2,
            ..NONE
        },
    ),
    (
        "all",
        Stresses {
            axial: 0.3,
            bending: 0.4,
            shear: 0.1,
            torsion: 0.3,
        },
    ),
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
fn by_displacement() -> String {
    let tried = TRIED.iter().flat_map(|(criterion, names)| {
        let of = move |name: &&str| LOADS.iter().find(|load| load.0 == *name).unwrap();
        names.iter().map(move |name| (*criterion, of(name)))
    });
    let cases = tried.map(|(criterion, &(name, load))| {
        let whole = 1.0 / (FRACTION * criterion.used(load));
        let end = Stresses {
            axial: whole * load.axial,
            bending: whole * load.bending,
            shear: whole * load.shear,
            torsion: whole * load.torsion,
        };
        let stresses = [end.axial.abs(), end.bending, end.shear, end.torsion];
        let largest = 1e-6 * stresses.into_iter().fold(0.0, f64::max);
        let found = largest * breaks_at(criterion, end);
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
fn by_load() -> String {
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

/// The dynamic increase factor of Platzer 2022, eq. 20.
fn dynamic_increase_factor(rate_1_s: f64) -> f64 {
    let lg = rate_1_s.clamp(4.64e-6, 50.0).log10();
    if rate_1_s <= 0.1 {
        (1.0 + 0.0225 * (lg + 5.3333)).max(1.0)
    } else {
        1.6 + 1.235 * lg + 0.7325 * lg * lg
    }
}

/// Number of steps until the static strength is reached, such that at no rate a bond breaks just at
/// the end of a step, where rounding decides.
const STATIC_STEPS: f64 = 5066.7;

/// Strength over static strength of a bond under a constant strain rate.
fn strengthened(rate_1_s: f64, from_1_s: f64) -> f64 {
    let static_s = TENSION_PA / YOUNG_PA / rate_1_s;
    let half = 0.5 * rate_1_s * LENGTH_M;
    let more = format!(
        r#"
        supports.left = {{ group = "left", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = {:e} }} }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = {half:e} }} }}
        "#,
        -half
    );
    let failure = format!(
        "{}, rate_strengthening = {from_1_s:e}",
        Criterion::Tension.key()
    );
    let end_s = 8.0 * static_s;
    let run = format!(
        "end_time = {end_s:e}, time_step = {:e}",
        static_s / STATIC_STEPS
    );
    breaks_s(&mut bond(&failure, &run, &more), end_s) / static_s
}

fn by_rate() -> [String; 2] {
    let rates = [1e-6, 1e-5, 1e-3, 0.1, 0.2, 1.0, 1.2, 10.0, 50.0, 100.0];
    let [all, from] = [1e-9, 1.1].map(|from| {
        let cases = rates.map(|rate| {
            let wanted = if rate < from {
                1.0
            } else {
                dynamic_increase_factor(rate)
            };
            let bound = 1.0 / STATIC_STEPS + STRAIN;
            Case::new(format!("{rate}"), strengthened(rate, from), wanted, bound)
        });
        compared("rate, 1/s", "", &cases)
    });
    [all, from]
}

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
fn by_mode() -> String {
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
fn by_cycle() -> String {
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

/// Energy to part a bar of 4 mm x 4 mm x 16 mm that consists of `across` x `across` touching
/// spheres in each layer, over the section of the bonds of a layer, J/m2. In the middle layer of
/// bonds the strengths are 0.9 to 0.94 times those of the others; there it parts.
fn of_a_block(across: usize, energy_j_m2: f64) -> f64 {
    const SIDE_M: f64 = 4e-3;
    let (pitch_m, long) = (SIDE_M / across as f64, 4 * across);
    let sides = [long, across, across];
    let (spheres, pairs, number) = lattice(sides, pitch_m);
    let layer = |x: usize| -> Vec<usize> {
        let all = (0..across * across).map(|k| number([x, k % across, k / across]));
        all.collect()
    };
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = 50e-3, safety_factor = 0.5, local_damping = 0.2 }}
        materials.stone = {{ density = 2500 }}
        bodies.bar = {{ particles = [{}], bond_list = [{}], material = "stone", bonds = "glue" }}
        groups.left = {{ particles = {:?} }}
        groups.right = {{ particles = {:?} }}
        bonds.glue = {{ young_modulus = 1e9, poisson_ratio = {POISSON:e}, failure = {{ {}, fracture_energy = {energy_j_m2:e} }} }}
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = 2e-3 }} }}
        "#,
        spheres.join(", "),
        pairs.join(", "),
        layer(0),
        layer(long - 1),
        Criterion::Tension.key(),
    ));
    let middle = layer(long / 2 - 1);
    state.bonds.strength_factors = vec![1.0; state.bonds.len()];
    for at in 0..state.bonds.len() {
        let [a, b] = state.bonds.ends[at].map(|end| end as usize);
        if let (Some(k), true) = (middle.iter().position(|i| *i == a), b == a + 1) {
            let factor = 0.9 + 0.01 * (3 * k % 5) as f64;
            state.bonds.strength_factors[at] = factor;
            state.bonds.histories.damages[at].strength_factor = factor;
        }
    }
    while state.broken_count < (across * across) as u64 {
        assert!(
            state.time_s < 50e-3,
            "{across}: {} broken",
            state.broken_count
        );
        interact(&mut state);
        if state.broken_count == (across * across) as u64 {
            break;
        }
        advance(&mut state);
    }
    let now = balance(&mut state);
    let left_j = now.kinetic_j + now.elastic_j() + now.local_damping_j;
    let area_m2 = (across * across) as f64 * 0.25 * PI * pitch_m * pitch_m;
    (now.support_work_j - left_j) / area_m2
}

/// Three sizes of spheres.
fn by_block() -> String {
    let cases = [1, 2, 4].map(|across| {
        let what = format!("{across} x {across}");
        Case::new(what, of_a_block(across, 20.0), 20.0, 0.02)
    });
    compared("spheres across", "J/m2", &cases)
}

/// Touching spheres on a cubic grid, those along each of its edges bonded, and the number of the
/// one at a place.
fn lattice(
    sides: [usize; 3],
    pitch_m: f64,
) -> (Vec<String>, Vec<String>, impl Fn([usize; 3]) -> usize) {
    let [nx, ny, nz] = sides;
    let number = move |[x, y, z]: [usize; 3]| x + nx * (y + ny * z);
    let (mut spheres, mut pairs) = (Vec::new(), Vec::new());
    for i in 0..nx * ny * nz {
        let place = [i % nx, i / nx % ny, i / nx / ny];
        let [x, y, z] = place.map(|k| pitch_m * k as f64);
        spheres.push(format!("[{x:e}, {y:e}, {z:e}, {:e}]", 0.5 * pitch_m));
        for axis in (0..3).filter(|axis| place[*axis] + 1 < sides[*axis]) {
            let mut next = place;
            next[axis] += 1;
            pairs.push(format!("[{i}, {}]", number(next)));
        }
    }
    (spheres, pairs, number)
}

fn by_energy() -> String {
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

/// A bar of 13 x 2 x 3 touching spheres of 1 mm, of which the middle of the upper side is pressed
/// down by 0.4 mm while both ends of the lower side are held, in 0.1 s. Returns the largest load,
/// N, the most that bonds store, J, what breakage takes in all, J, and the largest fall of the load
/// between two of 200 rows over the largest load.
fn bent(fracture_energy: &str) -> [f64; 4] {
    const SIDES: [usize; 3] = [13, 2, 3];
    const ROWS: usize = 200;
    const DOWN_M: f64 = 0.4e-3;
    const END_S: f64 = 0.1;
    let [nx, _, nz] = SIDES;
    let (spheres, pairs, number) = lattice(SIDES, 2.0 * RADIUS_M);
    let ends = [0, nx - 1].map(|x| [0, 1].map(|y| number([x, y, 0])));
    let middle = [0, 1].map(|y| number([nx / 2, y, nz - 1]));
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = {END_S}, safety_factor = 0.5, local_damping = 0.2 }}
        materials.stone = {{ density = 2500 }}
        bodies.bar = {{ particles = [{}], bond_list = [{}], material = "stone", bonds = "glue" }}
        groups.ends = {{ particles = {:?} }}
        groups.middle = {{ particles = {middle:?} }}
        bonds.glue = {{ young_modulus = 1e9, poisson_ratio = {POISSON:e}, failure = {{ {}{fracture_energy} }} }}
        supports.ends = {{ group = "ends", fixed = ["z"] }}
        supports.middle = {{ group = "middle", fixed = ["x", "y"], displacement = {{ z = {:e} }}, ramp = {END_S} }}
        "#,
        spheres.join(", "),
        pairs.join(", "),
        ends.as_flattened(),
        Criterion::Tension.key(),
        -DOWN_M
    ));
    let (mut loads_n, mut stored_j) = (vec![0.0_f64], 0.0_f64);
    let (mut work_j, mut way_m, mut taken_j) = (0.0, 0.0, 0.0);
    for row in 1..=ROWS {
        while state.time_s < END_S * row as f64 / ROWS as f64 {
            step(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        let moved_m = DOWN_M * state.time_s / END_S;
        // The mean load since the last row.
        loads_n.push((now.support_work_j - work_j) / (moved_m - way_m));
        stored_j = stored_j.max(now.elastic_j());
        taken_j = now.bond_breakage_j + now.bond_damage_j;
        (work_j, way_m) = (now.support_work_j, moved_m);
        advance(&mut state);
    }
    let largest_n = loads_n.iter().copied().fold(0.0, f64::max);
    let falls = loads_n.windows(2).map(|two| two[0] - two[1]);
    let fall = falls.fold(0.0, f64::max) / largest_n;
    [largest_n, stored_j, taken_j, fall]
}

/// Bending without and with fracture energy. A crack that takes more than the bar stores follows
/// the displacement; one that takes less runs by itself.
fn by_bending() -> String {
    let mut table = "| fracture energy, J/m2 | largest load, N | most stored, mJ | breakage takes, mJ | largest fall between two rows |\n|---|---|---|---|---|\n".to_owned();
    for energy_j_m2 in [0.0, 10.0, 20.0, 40.0, 80.0] {
        let key = match energy_j_m2 {
            0.0 => String::new(),
            energy => format!(", fracture_energy = {energy}"),
        };
        let [largest_n, stored_j, taken_j, fall] = bent(&key);
        if energy_j_m2 == 0.0 {
            assert!(
                fall > 0.9 && taken_j < stored_j,
                "{fall} {taken_j} {stored_j}"
            );
        }
        if energy_j_m2 >= 40.0 {
            assert!(
                fall < 0.1 && taken_j > stored_j,
                "{fall} {taken_j} {stored_j}"
            );
        }
        let name = match energy_j_m2 {
            0.0 => "none: brittle".to_owned(),
            energy => energy.to_string(),
        };
        table += &format!(
            "| {name} | {largest_n:.2} | {:.3} | {:.3} | {:.0} % |\n",
            1e3 * stored_j,
            1e3 * taken_j,
            100.0 * fall
        );
    }
    table.trim_end().to_owned()
}

/// Way of a sphere that slides past another, m.
const WAY_M: f64 = 3e-6;

/// Two touching spheres that a load presses together while one slides past the other: the shear
/// force at which their Mohr-Coulomb bond breaks, and that afterwards, N.
fn sheared_under(pressure_pa: f64, friction: f64) -> [f64; 2] {
    const YOUNG_PA: f64 = 1e10;
    let press_n = pressure_pa * area_m2();
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = 0.07, safety_factor = 0.5 }}
        materials.stone = {{ density = 2500, young_modulus = 1e10, poisson_ratio = {POISSON:e} }}
        contacts.stone-stone = {{ restitution = 0.1, friction = {friction} }}
        bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue" }}
        groups.left = {{ particles = [0] }}
        groups.right = {{ particles = [1] }}
        bonds.glue = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, damping = {{ damping_ratio = {DAMPING} }}, failure = {{ {} }} }}
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["z", "rx", "ry", "rz"], displacement = {{ y = {WAY_M:e} }}, table = [[0.01, 0], [0.04, 1], [0.07, 2]] }}
        loads.press = {{ group = "right", force = [{:e}, 0, 0], ramp = 0.005 }}
        "#,
        2.0 * RADIUS_M,
        Criterion::MohrCoulomb.key(),
        -press_n
    ));
    let (mut broke_n, mut work_j, mut way_m, mut last_n) = (f64::NAN, 0.0, 0.0, 0.0);
    for row in 1..=2000 {
        let until_s = 0.01 + 0.03 * f64::from(row) / 2000.0;
        while state.time_s < until_s {
            step(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        let moved_m = WAY_M * ((state.time_s - 0.01) / 0.03).max(0.0);
        let shear_n = (now.support_work_j - work_j) / (moved_m - way_m);
        if state.broken_count > 0 && broke_n.is_nan() {
            broke_n = last_n;
        }
        (work_j, way_m, last_n) = (now.support_work_j, moved_m, shear_n);
        advance(&mut state);
    }
    [broke_n, last_n]
}

/// Friction after a break under pressure is that of the contact.
fn residual() -> String {
    let mut cases = Vec::new();
    for (pressure_pa, friction) in [(0.2e6, 0.3), (0.2e6, 0.6), (1.0e6, 0.3)] {
        let press_n = pressure_pa * area_m2();
        let strength_pa = COHESION_PA + pressure_pa * FRICTION_DEG.to_radians().tan();
        let [broke_n, left_n] = sheared_under(pressure_pa, friction);
        let what = format!("{:.1} MPa, friction {friction}", 1e-6 * pressure_pa);
        // The load is known from row to row.
        cases.push(Case::new(
            format!("{what}: breaks at, N"),
            broke_n,
            strength_pa * area_m2(),
            0.01,
        ));
        // The way across tilts the contact, by this at the end.
        let tilt = WAY_M / (2.0 * RADIUS_M);
        cases.push(Case::new(
            format!("{what}: slides at, N"),
            left_n,
            press_n * (friction - tilt) / (1.0 + friction * tilt),
            1e-3,
        ));
    }
    compared("pressure", "", &cases)
}

/// Gamma function, by Stirling's series.
fn gamma(x: f64) -> f64 {
    let y = x + 12.0;
    let series = 1.0 / (12.0 * y) - 1.0 / (360.0 * y.powi(3)) + 1.0 / (1260.0 * y.powi(5));
    let far = (y - 0.5) * y.ln() - y + 0.5 * (2.0 * PI).ln() + series;
    let between: f64 = (0..12).map(|i| (x + f64::from(i)).ln()).sum();
    (far - between).exp()
}

/// Ratios of the strengths of bonds under equal elongation to the given one, in the order of
/// breakage.
fn scattered(modulus: f64, count: usize, steps: f64) -> Vec<f64> {
    let spheres = (0..count).map(|i| {
        let y = 4.0 * RADIUS_M * i as f64;
        format!("[0, {y:e}, 0, {RADIUS_M:e}], [{LENGTH_M:e}, {y:e}, 0, {RADIUS_M:e}]")
    });
    let spheres: Vec<String> = spheres.collect();
    let pairs: Vec<String> = (0..count)
        .map(|i| format!("[{}, {}]", 2 * i, 2 * i + 1))
        .collect();
    let half_box = |low: f64, high: f64| {
        format!("{{ box = {{ min = [{low:e}, -1, -1], max = [{high:e}, 1000, 1] }} }}")
    };
    let middle = 0.5 * LENGTH_M;
    let (strain, text) = (
        TENSION_PA / YOUNG_PA,
        [spheres.join(", "), pairs.join(", ")],
    );
    let [spheres, pairs] = text;
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = 4, time_step = {:e}, seed = {modulus} }}
        materials.stone = {{ density = 2500 }}
        bodies.rods = {{ particles = [{spheres}], bond_list = [{pairs}], material = "stone", bonds = "glue" }}
        groups.left = {}
        groups.right = {}
        bonds.glue = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, failure = {{ {}, weibull_modulus = {modulus:e} }} }}
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = {:e} }} }}
        "#,
        1.0 / steps,
        half_box(-1.0, middle),
        half_box(middle, 1.0),
        Criterion::Tension.key(),
        strain * LENGTH_M
    ));
    let mut strengths = Vec::new();
    while strengths.len() < count && state.time_s < 4.0 {
        let now_s = state.time_s;
        step(&mut state);
        strengths.resize(state.broken_count as usize, now_s);
    }
    strengths
}

/// Mean and standard deviation of the strengths, and their distance from the distribution. Bounds
/// are three standard errors, and the step of the load.
fn scatter() -> String {
    const COUNT: usize = 2000;
    const STEPS: f64 = 500.0;
    let n = COUNT as f64;
    let mut cases = Vec::new();
    for modulus in [3.0, 6.0, 12.0] {
        let found = scattered(modulus, COUNT, STEPS);
        assert_eq!(found.len(), COUNT);
        let mean = found.iter().sum::<f64>() / n;
        let squares: f64 = found.iter().map(|s| (s - mean) * (s - mean)).sum();
        let deviation = (squares / (n - 1.0)).sqrt();
        let [m1, m2, m3, m4] = [1.0, 2.0, 3.0, 4.0].map(|k| gamma(1.0 + k / modulus));
        let wanted = (m2 - m1 * m1).sqrt();
        let fourth = m4 - 4.0 * m1 * m3 + 6.0 * m1 * m1 * m2 - 3.0 * m1.powi(4);
        let kurtosis = fourth / wanted.powi(4);
        let distance = found.iter().enumerate().map(|(i, strength)| {
            let fraction = 1.0 - (-strength.powf(modulus)).exp();
            (fraction - i as f64 / n)
                .abs()
                .max((fraction - (i as f64 + 1.0) / n).abs())
        });
        let of_mean = 3.0 * wanted / n.sqrt() / m1 + 1.0 / STEPS;
        let of_deviation = 3.0 * (0.25 * (kurtosis - 1.0) / n).sqrt() + 1.0 / STEPS;
        // The density is below 0.4 of the modulus.
        let of_distance = 1.63 / n.sqrt() + 0.4 * modulus / STEPS;
        let distance = distance.fold(0.0, f64::max);
        cases.push(Case::new(format!("{modulus}: mean"), mean, m1, of_mean));
        cases.push(Case::new(
            format!("{modulus}: standard deviation"),
            deviation,
            wanted,
            of_deviation,
        ));
        cases.push(Case::of_scale(
            format!("{modulus}: distance of Kolmogorov and Smirnov"),
            [distance, 0.0],
            1.0,
            of_distance,
        ));
    }
    compared("Weibull modulus", "", &cases)
}

/// The page of failure equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [rates, from] = by_rate();
        filled(
            include_str!("failure.md"),
            &[
                ("by displacement", by_displacement()),
                ("by load", by_load()),
                ("by energy", by_energy()),
                ("by mode", by_mode()),
                ("by cycle", by_cycle()),
                ("by block", by_block()),
                ("by bending", by_bending()),
                ("residual", residual()),
                ("rates", rates),
                ("rates from 1.1", from),
                ("scatter", scatter()),
            ],
        )
    });
    assert_shown(&[("failure.md".to_owned(), page)]);
}
