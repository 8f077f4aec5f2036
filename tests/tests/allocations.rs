//! A step that renews no list takes no memory: what it needs has been there since the first steps.

use std::fmt::Write;

use allocation_counter::measure;
use dem_run::step;

use super::verification::page::on_one_thread;
use super::verification::scene::started;

const HEAD: &str = "version = 1
run = { end_time = 1, gravity = [0, 0, -9.81] }
materials.stone = { density = 2500, young_modulus = 1e8, poisson_ratio = 0.3 }
contacts.stone-stone = { restitution = 0.5, friction = 0.4 }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"stone\" }
";

/// A block of 64 bonded spheres with its lowest layer at this height, in diameters.
fn block(height: f64, bonds: &str, more: &str) -> String {
    cube(4, height, bonds, more)
}

/// A cube of so many spheres along each edge.
fn cube(side: usize, height: f64, bonds: &str, more: &str) -> String {
    let (mut spheres, mut pairs) = (String::new(), String::new());
    for n in 0..side * side * side {
        let at = [n % side, n / side % side, n / (side * side)];
        let [x, y, z] = at.map(|k| 2e-3 * k as f64);
        write!(spheres, "[{x:e}, {y:e}, {:e}, 1e-3], ", z + 2e-3 * height).unwrap();
        for (axis, to) in [1, side, side * side].into_iter().enumerate() {
            if at[axis] + 1 < side {
                write!(pairs, "[{n}, {}], ", n + to).unwrap();
            }
        }
    }
    format!(
        "{HEAD}bonds.glue = {{ young_modulus = 1e8, poisson_ratio = 0.3{bonds} }}
bodies.block = {{ particles = [{spheres}], bond_list = [{pairs}], material = \"stone\", bonds = \"glue\"{more} }}
"
    )
}

/// Steps of a scene, after as many that are not counted: the allocations in each.
fn allocations(text: &str) -> Vec<u64> {
    const STEPS: usize = 200;
    on_one_thread(|| {
        let mut state = started(text);
        for _ in 0..STEPS {
            step(&mut state);
        }
        let count = |_| measure(|| _ = step(&mut state)).count_total;
        (0..STEPS).map(count).collect()
    })
}

#[test]
fn a_step_takes_no_memory() {
    let strengths = ", failure = { tensile_strength = 1e9 }";
    let on_floor = 0.5 + 1e-9;
    for (name, text) in [
        ("bonds", block(1.0, "", "")),
        ("failure", block(1.0, strengths, "")),
        ("many spheres", cube(11, 1.0, strengths, "")),
        (
            "weak damping",
            block(1.0, ", damping = { damping_ratio = 0.01 }", ""),
        ),
        (
            "strong damping",
            block(1.0, ", damping = { damping_ratio = 3 }", ""),
        ),
        (
            "structural damping",
            block(1.0, ", damping = { structural_damping = 0.3 }", ""),
        ),
        (
            "both dampings",
            block(
                1.0,
                ", damping = { damping_ratio = 0.1, structural_damping = 0.3 }",
                "",
            ),
        ),
        ("history", block(1.0, ", formulation = \"incremental\"", "")),
        (
            "yield",
            block(1.0, ", plasticity = { normal_yield_strength = 1e9 }", ""),
        ),
        ("at a wall", block(on_floor, strengths, "")),
        (
            "clump at a wall",
            block(on_floor, "", ", start_as = \"clump\""),
        ),
        (
            "part bonded",
            block(1.0, "", ", bonded_within = { region = \"zone\" }")
                + "regions.zone.box = { min = [-1, -1, -1], max = [1, 1, 4e-3] }\n",
        ),
    ] {
        let found = allocations(&text);
        // Where the bonded zone of a body is now, is found once in fifty steps.
        let looks = if name == "part bonded" {
            found.len() / 50
        } else {
            0
        };
        let taking = found.iter().filter(|&&count| count > 0).count();
        assert!(taking <= looks, "{name}: {found:?}");
    }
}
