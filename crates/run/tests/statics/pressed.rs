//! Laboratory tests without steps: walls that press a body, and linear systems without factors.

use dem_engine::statics::conjugate::ConjugateGradients;
use dem_engine::statics::degrees_of_freedom::DegreesOfFreedom;
use dem_engine::statics::direct::DirectFactor;
use dem_engine::statics::matrix::Matrix;
use dem_laboratory::Line;
use dem_rig::elastic_test::{ElasticTest, elastic_test};
use dem_rig::plan_with_test;
use dem_scene::{read_bodies, scene_from_text};

use super::{assert_near, fix, load};
use crate::bars::{ELASTIC, MODELS, random_body};

/// Eleven spheres of 2 mm in a row along z, bonded to a rod of 40 mm, in a test.
fn row_in(test: &str) -> String {
    let particles: Vec<String> = (0..11)
        .map(|i| format!("[0, 0, {}, 0.002]", 0.004 * f64::from(i)))
        .collect();
    let bonds: Vec<String> = (0..10).map(|i| format!("[{i}, {}]", i + 1)).collect();
    format!(
        r#"version = 1
[run]
integrator = "static"
end_time = "1 s"
[materials.clay]
density = 2000
young_modulus = "20 MPa"
poisson_ratio = 0.3
[materials.steel]
young_modulus = "200 GPa"
poisson_ratio = 0.3
[bonds.clay]
young_modulus = "15 MPa"
poisson_ratio = 0.3
[bodies.bar]
particles = [{}]
bond_list = [{}]
material = "clay"
bonds = "clay"
{test}
"#,
        particles.join(", "),
        bonds.join(", "),
    )
}

/// Area of the rod, m2.
const AREA_M2: f64 = std::f64::consts::PI * 4e-6;

fn tested(text: &str, threads: usize) -> ElasticTest {
    let scene = scene_from_text(text, "row.toml", &[]).unwrap();
    let bodies = read_bodies(&scene).unwrap();
    let (mut plan, setup) = plan_with_test(&scene, bodies, threads, false).unwrap();
    elastic_test(&mut plan.state, &scene, &setup.unwrap(), &|_| true).unwrap()
}

fn pressed_row() -> String {
    row_in(
        r#"[contacts]
clay-steel = { restitution = 0.5, friction = 0.3 }
[walls.floor]
plane = { point = [0, 0, -0.002], normal = [0, 0, 1] }
material = "steel"
[walls.lid]
plane = { point = [0, 0, 0.0421], normal = [0, 0, -1] }
material = "steel"
[test]
type = "compression"
crosshead = ["lid"]
direction = [0, 0, -1]
stroke = "1 mm"
length = "44 mm"
area = "12.5663706 mm2"
strength = "0.05 MPa"
"#,
    )
}

/// Travel of the lid beyond touching: the rod and two contacts of Hertz in series.
#[test]
fn a_row_between_plates_is_a_rod_and_two_contacts() {
    let found = tested(&pressed_row(), 1);
    // 1/E* = (1 - nu^2)/E of both materials.
    let elastic_pa = 1.0 / (0.91 / 20e6 + 0.91 / 200e9);
    let travel_m = |force_n: f64| {
        let rod = force_n * 0.04 / (15e6 * AREA_M2);
        let overlap = (0.75 * force_n / (elastic_pa * 0.002_f64.sqrt())).powf(2.0 / 3.0);
        rod + 2.0 * overlap
    };
    // Below the load of 1 N at which the rod buckles.
    let largest_n = 0.05e6 * AREA_M2;
    assert_eq!(found.rows.len(), 3);
    for (row, fraction) in found.rows.iter().zip([0.2, 0.4, 0.6]) {
        let load_n = row.load_n();
        assert_near(load_n, fraction * largest_n, 0.11, "load");
        // The lid touches after 0.1 mm.
        assert_near(row.travel_m - 1e-4, travel_m(load_n), 2e-3, "travel");
        assert_near(row.force_n, row.reaction_n, 1e-3, "balance");
    }
    let travels: Vec<f64> = found
        .rows
        .iter()
        .map(|row| travel_m(row.load_n()))
        .collect();
    let loads: Vec<f64> = found
        .rows
        .iter()
        .map(dem_rig::record::Row::load_n)
        .collect();
    let stiffness = Line::fitted(&travels, &loads).slope;
    assert_near(
        found.figure("stiffness").unwrap(),
        stiffness,
        3e-3,
        "stiffness",
    );
}

/// A lid that begins 50 mm above the row.
#[test]
fn walls_may_be_far_away() {
    let near = tested(&pressed_row(), 1);
    let far = pressed_row()
        .replace("0.0421]", "0.092]")
        .replace("stroke = \"1 mm\"", "stroke = \"60 mm\"");
    let far = tested(&far, 1);
    let stiffness = |found: &ElasticTest| found.figure("stiffness").unwrap();
    assert_near(stiffness(&far), stiffness(&near), 0.02, "stiffness");
}

#[test]
fn the_number_of_threads_does_not_change_a_test() {
    let [one, two] = [1, 2].map(|threads| tested(&pressed_row(), threads));
    assert_eq!(one, two);
}

/// Bodies of 500 particles with some of them held: 3,000 unknowns in some groups.
#[test]
fn without_factors_the_solution_is_the_same() {
    for (model, name) in MODELS {
        let mut state = random_body(model, ELASTIC, 1e-6);
        fix(&mut state, &[0, 1, 2, 3]);
        load(&mut state, &[400], [1.0, 2.0, 3.0], [0.0; 3]);
        let freedoms = DegreesOfFreedom::new(&state, 1.0);
        let mut matrix = Matrix::pattern(&state, &freedoms, true);
        matrix.assemble(&state.bonds, &freedoms, &state.particles.poses);
        let side: Vec<f64> = (0..freedoms.count)
            .map(|at| f64::from(u32::try_from(at * 7919 % 1000).unwrap()) - 500.0)
            .collect();
        let mut direct = DirectFactor::new(&matrix).unwrap();
        direct.compute(&matrix).unwrap();
        let mut wanted = side.clone();
        direct.solve(&mut wanted);
        let nodes = freedoms.nodes(&state.particles.poses);
        let gradients = ConjugateGradients::new(&matrix, &nodes).unwrap();
        let mut found = side.clone();
        let iterations = gradients.solve(&mut found, 1e-12).unwrap();
        let largest = wanted.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-8 * largest, "{name}");
        }
        assert!(iterations < freedoms.count / 4, "{name}: {iterations}");
        // A matrix that is not positive definite is refused.
        let minus = Matrix {
            values: matrix.values.iter().map(|value| -value).collect(),
            ..matrix.clone()
        };
        assert!(ConjugateGradients::new(&minus, &nodes).is_err());
    }
}
