//! The largest utilisation is that of the bond nearest to its strength, whatever the bonds are.

use std::fmt::Write;

use dem_plan::measure::bond_utilisation;

use super::Measured;

/// Spheres along an edge of the large cube: more bonds than one task looks at.
const SIDE: usize = 8;

/// A cube of spheres, and a small one, fall onto a floor. `bonds` is what their bonds have beside
/// their moduli.
fn cubes(bonds: &str) -> String {
    let mut text = format!(
        "version = 1
run = {{ end_time = 1, gravity = [0, 0, -9.81], seed = 3 }}
materials.stone = {{ density = 2500, young_modulus = 1e8, poisson_ratio = 0.3 }}
contacts.stone-stone = {{ restitution = 0.5, friction = 0.4 }}
walls.floor = {{ plane = {{ point = [0, 0, -1.0001e-3], normal = [0.02, 0, 1] }}, material = \"stone\" }}
bonds.glue = {{ young_modulus = 1e8, poisson_ratio = 0.3, {bonds} }}
measures.all = {{ quantity = \"largest_utilisation\" }}
measures.large = {{ of = \"large\", quantity = \"largest_utilisation\" }}
measures.small = {{ of = \"small\", quantity = \"largest_utilisation\" }}
"
    );
    for (name, side, x_m) in [("large", SIDE, 0.0), ("small", 2, 0.1)] {
        let (mut spheres, mut pairs) = (String::new(), String::new());
        for n in 0..side.pow(3) {
            let at = [n % side, n / side % side, n / (side * side)];
            let [x, y, z] = at.map(|k| 2e-3 * k as f64);
            write!(spheres, "[{x:e}, {y:e}, {z:e}, 1e-3], ").unwrap();
            for (axis, to) in [1, side, side * side].into_iter().enumerate() {
                if at[axis] + 1 < side {
                    write!(pairs, "[{n}, {}], ", n + to).unwrap();
                }
            }
        }
        writeln!(text, "bodies.{name} = {{ particles = [{spheres}], bond_list = [{pairs}], material = \"stone\", bonds = \"glue\", position = [{x_m}, 0, 5e-4], velocity = [0.1, 0, -2] }}").unwrap();
    }
    text
}

#[test]
fn it_is_that_of_the_most_loaded_bond() {
    let threads = |count| rayon::ThreadPoolBuilder::new().num_threads(count).build();
    for (bonds, broken, damaged) in [
        ("model = \"timoshenko\"", false, false),
        (
            "failure = { tensile_strength = 1e9, shear_strength = 1e9 }",
            false,
            false,
        ),
        (
            "failure = { tensile_strength = 2e5, weibull_modulus = 3 }",
            true,
            false,
        ),
        (
            "failure = { von_mises_strength = 2e5, equivalent_stress = \"tensile-edge\" }",
            true,
            false,
        ),
        (
            "failure = { cohesion = 1e9, friction_angle = \"30 deg\", compressive_strength = 1e9 }",
            false,
            false,
        ),
        (
            "failure = { tensile_strength = 2e5, fracture_energy = 1e3 }",
            false,
            true,
        ),
        (
            "formulation = \"incremental\", failure = { tensile_strength = 2e5 }",
            true,
            false,
        ),
        (
            "model = \"flat-joint\", failure = { tensile_strength = 1e5 }",
            true,
            false,
        ),
        (
            "plasticity = { normal_yield_strength = 1e6 }, failure = { shear_strength = 1e9 }",
            false,
            false,
        ),
    ] {
        let mut scene = Measured::new(&cubes(bonds));
        let mut largest = 0.0_f64;
        for step in 0..1500 {
            scene.interact();
            if step % 100 == 0 || step == 1499 {
                let values = threads(1).unwrap().install(|| scene.read());
                assert_eq!(
                    values,
                    threads(3).unwrap().install(|| scene.read()),
                    "{bonds}"
                );
                let state = &scene.state;
                let first = SIDE.pow(3) as u32;
                let most = |is_in: &dyn Fn(u32) -> bool| {
                    let own = (0..state.bonds.len()).filter(|&at| is_in(state.bonds.ends[at][0]));
                    own.map(|at| bond_utilisation(state, at))
                        .fold(0.0, f64::max)
                };
                assert_eq!(values["all"], most(&|_| true), "{bonds}");
                assert_eq!(values["large"], most(&|i| i < first), "{bonds}");
                assert_eq!(values["small"], most(&|i| i >= first), "{bonds}");
                largest = largest.max(values["all"]);
            }
            scene.replace();
            scene.advance();
        }
        let bonds_now = &scene.state.bonds;
        let any = |is_so: &dyn Fn(usize) -> bool| (0..bonds_now.len()).any(is_so);
        assert_eq!(largest > 0.0, bonds.contains("failure"), "{bonds}");
        assert_eq!(
            any(&|at| bonds_now.is_broken(at)),
            broken,
            "{bonds}: {largest}"
        );
        let is_damaged = |at: usize| !bonds_now.is_broken(at) && bonds_now.damage(at) > 0.0;
        assert_eq!(any(&is_damaged), damaged, "{bonds}: {largest}");
    }
}
