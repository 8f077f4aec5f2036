//! Bars of many spheres on a grid, pulled apart and bent.

use std::f64::consts::PI;

use dem_run::stages::ledger::bookkeeping::balance;
use dem_run::step;
use dem_run::step::{advance, interact};

use super::bond::{Criterion, POISSON, RADIUS_M};
use crate::verification::scene::started;
use crate::verification::table::{Case, compared};

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
pub(crate) fn by_block() -> String {
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
pub(crate) fn by_bending() -> String {
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
