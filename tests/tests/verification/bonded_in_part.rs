//! Bodies bonded in part: momenta at releases and joinings, regions around all and around nothing,
//! a beam clamped at a rigid block.

use std::fmt::Write;

use dem_run::step::{drift, exchange, interact};
use dem_run::{State, step};
use nalgebra::Vector3;

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::{place, started};
use super::table::{Case, compared};

const APART_M: f64 = 2e-3;

/// A scene with a body of spheres on a grid of this size, and these lines for the run, the body
/// and the rest.
fn scene(run: &str, [nx, ny, nz]: [i32; 3], body: &str, rest: &str) -> State {
    let (mut spheres, mut bonds) = (String::new(), String::new());
    let number = |[x, y, z]: [i32; 3]| (x * ny + y) * nz + z;
    for x in 0..nx {
        for y in 0..ny {
            for z in 0..nz {
                let [px, py, pz] = [x, y, z].map(|k| f64::from(k) * APART_M);
                write!(spheres, "[{px:e}, {py:e}, {pz:e}, 1e-3],").unwrap();
                for next in [[x + 1, y, z], [x, y + 1, z], [x, y, z + 1]] {
                    if next[0] < nx && next[1] < ny && next[2] < nz {
                        write!(bonds, "[{}, {}],", number([x, y, z]), number(next)).unwrap();
                    }
                }
            }
        }
    }
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = 1{run} }}
        materials.stuff = {{ density = 2500, young_modulus = 1e9, poisson_ratio = 0.25 }}
        bonds.stiff = {{ young_modulus = 1e9, poisson_ratio = 0.25 }}
        [bodies.block]
        material = "stuff"
        bonds = "stiff"
        particles = [{spheres}]
        bond_list = [{bonds}]
        {body}
        {rest}
        "#
    ))
}

/// A region in the form of a box.
fn region(min: [f64; 3], max: [f64; 3]) -> String {
    format!("[regions.zone]\nbox = {{ min = {min:?}, max = {max:?} }}\n")
}

const FLIES: &str =
    "velocity = [1, -2, 3]\nangular_velocity = [20, -30, 10]\nposition = [0.1, 0.2, 0.3]\n";

/// Momentum, angular momentum about the origin, and kinetic energy.
fn totals(state: &State) -> (Vector3<f64>, Vector3<f64>, f64) {
    let p = &state.particles;
    let mut sums = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for i in 0..p.free {
        let motion = &p.motions[i];
        let momentum = Vector3::from(motion.velocity_m_s) / motion.inverse_mass;
        sums.0 += momentum;
        sums.1 += p.poses[i].place().cross(&momentum)
            + Vector3::from(motion.spin_rad_s) / motion.inverse_inertia;
        sums.2 += p.kinetic_j(i, motion);
    }
    sums
}

/// Largest relative changes of momentum, angular momentum and, at releases, of kinetic energy, and
/// the numbers of spheres released and joined.
fn largest_changes([bonded_from_m, up_m_s]: [f64; 2], more: &str) -> ([f64; 3], [u64; 2]) {
    let body =
        format!("{FLIES}bonded_within = {{ region = \"zone\", moves_with = \"blade\"{more} }}");
    let rest = region([-9.0, -9.0, bonded_from_m], [9.0; 3])
        + &format!(
            "[contacts.stuff-stuff]\nrestitution = 0.5\n[walls.blade]\nmaterial = \"stuff\"\n\
             box = {{ min = [9, 9, 9], max = [9.1, 9.1, 9.1] }}\n\
             velocity = [1, -2, {up_m_s}]\nangular_velocity = [0, 0, 3]\n"
        );
    let mut state = scene(", safety_factor = 0.3", [6, 3, 3], &body, &rest);
    let mut largest = [0.0_f64; 3];
    for _ in 0..20_000 {
        interact(&mut state);
        let before = totals(&state);
        let [released, rejoined] = [state.rigid_parts.released, state.rigid_parts.rejoined];
        exchange(&mut state);
        let parts = &state.rigid_parts;
        if [parts.released, parts.rejoined] != [released, rejoined] {
            let after = totals(&state);
            let errors = [
                (after.0 - before.0).norm() / before.0.norm(),
                (after.1 - before.1).norm() / before.1.norm(),
                // Joining takes energy.
                if parts.rejoined == rejoined {
                    (after.2 / before.2 - 1.0).abs()
                } else {
                    0.0
                },
            ];
            largest = [0, 1, 2].map(|n| largest[n].max(errors[n]));
        }
        drift(&mut state);
    }
    let parts = &state.rigid_parts;
    (largest, [parts.released, parts.rejoined])
}

fn changes() -> String {
    let mut cases = Vec::new();
    // The block rises at 3 m/s: into the region, or behind it.
    let (largest, [released, _]) = largest_changes([0.3031, 2.0], "");
    assert!(released > 10, "{released}");
    let of = ["momentum", "angular momentum", "kinetic energy"];
    for (of, error) in of.into_iter().zip(largest) {
        cases.push(Case::of_scale(
            format!("release: {of}"),
            [error, 0.0],
            1.0,
            1e-12,
        ));
    }
    let rejoin = ", rejoin = { strain_energy = 10, fluctuation_velocity = 0.5 }";
    let (largest, [_, rejoined]) = largest_changes([0.3011, 8.0], rejoin);
    assert!(rejoined > 10, "{rejoined}");
    for (of, error) in of.into_iter().zip(largest).take(2) {
        cases.push(Case::of_scale(
            format!("joining: {of}"),
            [error, 0.0],
            1.0,
            1e-12,
        ));
    }
    compared("change", "", &cases)
}

/// Largest difference of the positions of two states, over the distance of neighbours.
fn apart(one: &State, other: &State) -> f64 {
    let pairs = one.particles.poses.iter().zip(&other.particles.poses);
    let apart_m = pairs.map(|(a, b)| (a.place() - b.place()).norm());
    apart_m.fold(0.0, f64::max) / APART_M
}

fn limits() -> String {
    let all = region([-9.0; 3], [9.0; 3]);
    let within = "bonded_within = { region = \"zone\" }";
    let [mut bonded, mut zone] =
        ["", within].map(|more| scene("", [6, 3, 3], &format!("{FLIES}{more}"), &all));
    for _ in 0..3000 {
        step(&mut bonded);
        step(&mut zone);
    }
    let same = bonded.particles.poses == zone.particles.poses;
    assert!(same && bonded.particles.motions == zone.particles.motions);

    let nothing = region([-9.0; 3], [-8.0; 3]);
    let [mut clump, mut part] = ["start_as = \"clump\"", within].map(|more| {
        scene(
            ", time_step = 2e-7",
            [6, 3, 3],
            &format!("{FLIES}{more}"),
            &nothing,
        )
    });
    for _ in 0..10_000 {
        step(&mut clump);
        step(&mut part);
    }
    let [clump, part] =
        [clump.clumps.all[0].place_m, part.rigid_parts.all[0].place_m].map(Vector3::from);
    compared(
        "region",
        "",
        &[
            Case::of_scale("around all", [apart(&bonded, &zone), 0.0], 1.0, 0.0),
            Case::of_scale(
                "around nothing",
                [(clump - part).norm() / APART_M, 0.0],
                1.0,
                1e-9,
            ),
        ],
    )
}

const SPHERES: usize = 12;

/// Brings everything to rest at each largest kinetic energy. A step after rest is a full one, not a
/// half: it must be well below the limit.
fn settle(state: &mut State) {
    state.time_step_s *= 0.3;
    let mut before_j = 0.0;
    for _ in 0..400_000 {
        step(state);
        let now_j = totals(state).2;
        let turns = now_j < before_j;
        before_j = if turns { 0.0 } else { now_j };
        if turns {
            for motion in &mut state.particles.motions {
                motion.velocity_m_s = [0.0; 3];
                motion.spin_rad_s = [0.0; 3];
            }
            for part in &mut state.rigid_parts.all {
                part.velocity_m_s = [0.0; 3];
                part.angular_momentum = [0.0; 3];
            }
        }
    }
}

/// Deflection of the last sphere, m, if only this many bonds deform.
fn tip_m(state: &State, deform: usize) -> f64 {
    let weight_n = 9.81 / state.particles.motions[1].inverse_mass;
    let (mut tip_m, mut rotation) = (0.0, 0.0);
    for at in 0..SPHERES - 1 {
        let k = state.bonds.stiffness(at);
        let beyond = (at + 1..SPHERES).map(|i| ((i - at) as f64 - 0.5) * APART_M);
        tip_m += 0.5 * APART_M * rotation;
        if at < deform {
            tip_m += weight_n * (SPHERES - 1 - at) as f64 / k.shear;
            rotation += weight_n * beyond.sum::<f64>() / k.bending;
        }
        tip_m += 0.5 * APART_M * rotation;
    }
    tip_m
}

fn beam() -> String {
    let cases = [(3, 0.0041), (5, 0.0081), (8, 0.0141), (11, 1.0)].map(|(deform, to_m)| {
        let rest = region([-1.0; 3], [to_m, 1.0, 1.0])
            + "[groups.foot]\nparticles = [0]\n[supports.foot]\ngroup = \"foot\"\nfixed = true\n";
        let run = ", gravity = [0, -9.81, 0]";
        let body = "bonded_within = { region = \"zone\" }";
        let mut state = scene(run, [SPHERES as i32, 1, 1], body, &rest);
        let wanted_m = tip_m(&state, deform);
        let start_m = place(&state, SPHERES - 1).y;
        settle(&mut state);
        let found_m = start_m - place(&state, SPHERES - 1).y;
        let what = format!("{deform} of 11 bonds deform: deflection of the tip, um");
        Case::new(what, 1e6 * found_m, 1e6 * wanted_m, 1e-6).rounding(1e-7)
    });
    compared("beam", "", &cases)
}

#[test]
fn bodies_bonded_in_part() {
    let page = on_one_thread(|| {
        filled(
            include_str!("bonded-in-part.md"),
            &[
                ("changes", changes()),
                ("limits", limits()),
                ("beam", beam()),
            ],
        )
    });
    assert_shown(&[("bonded-in-part.md".to_owned(), page)]);
}
