//! `drop` and `position_of` of bodies: places and speeds at the start.

use dem_engine::state::State;
use nalgebra::{UnitQuaternion, Vector3};

use super::{MASS_KG, place, planned, run_of, try_planned};

/// Two spheres of 1 mm and 2 mm above a plate.
const BALLS: &str = "version = 1\nmaterials.m = { density = 1000, young_modulus = \"1 MPa\", poisson_ratio = 0.3 }\n\
     contacts.m-m = { restitution = 0.5, friction = 0.3 }\n\
     run = { end_time = \"2 ms\", gravity = [0, 0, -9.81] }\n\
     walls.plate = { plane = { point = [0, 0, \"5 cm\"], normal = [0, 0, 1] }, material = \"m\" }\n";

fn balls(body: &str) -> String {
    format!(
        "{BALLS}bodies.balls = {{ material = \"m\", particles = [[0, 0, 0, 1e-3], [4e-3, 0, \"1 mm\", 2e-3]], {body} }}\n"
    )
}

/// Lowest point of the particles above the plate, m.
fn gap_m(state: &State) -> f64 {
    let lowest = state.particles.poses.iter();
    let lowest = lowest.map(|pose| pose.place().z - pose.radius_m());
    lowest.fold(f64::INFINITY, f64::min) - 0.05
}

fn velocity(state: &State, particle: usize) -> Vector3<f64> {
    state.particles.motions[particle].velocity_m_s.into()
}

/// Both spheres reach 1 mm below the origin. v^2/2 + g gap is g times the height.
#[test]
fn a_body_starts_with_the_energy_of_its_fall() {
    for height_m in [1e-6, 1e-3, 1.0, 50.0] {
        let state = planned(&balls(&format!(
            "position = [\"1 m\", 0, 0], drop = {{ height = {height_m}, onto = \"plate\" }}"
        )))
        .state;
        let gap = gap_m(&state);
        assert!(gap > 0.0 && gap <= 1.0001e-5, "{gap:e}");
        let speed = -velocity(&state, 0).z;
        let energy = 0.5 * speed * speed + 9.81 * gap;
        assert!(
            (energy / (9.81 * height_m) - 1.0).abs() < 1e-9,
            "{height_m}: {energy:e}"
        );
        assert_eq!(velocity(&state, 0), velocity(&state, 1));
        // It moves along gravity only.
        let xs = [0, 1].map(|i| place(&state, i).x);
        assert!(xs.iter().any(|x| (x - 1.0).abs() < 1e-15), "{xs:?}");
    }
}

/// The largest force of a bounce is that of the speed sqrt(2 g h), whatever the gap: the same run
/// from a position and velocity given by hand.
#[test]
fn the_plate_feels_the_fall() {
    let measure =
        "measures.push = { of = \"plate\", quantity = \"force\", statistic = \"largest\" }\n";
    let push = |body: &str| {
        // Small steps: the largest force of a step is that of the bounce.
        let text = format!(
            "{}{measure}",
            balls(body).replace("run = { ", "run = { safety_factor = 0.02, ")
        );
        let summary = run_of(&text, None, None, 2.0).unwrap();
        summary.measures[0].value
    };
    let fallen = push("drop = { height = \"0.2 m\", onto = \"plate\" }");
    let speed = (2.0_f64 * 9.81 * 0.2).sqrt();
    let thrown = push(&format!(
        "position = [0, 0, 0.051000001], velocity = [0, 0, -{speed}]"
    ));
    assert!((fallen / thrown - 1.0).abs() < 1e-3, "{fallen} {thrown}");
    assert!(fallen > 100.0 * MASS_KG * 9.81);
}

/// Onto a plane that is inclined by its rotation, along a gravity in no axis.
#[test]
fn a_fall_onto_an_inclined_plane_is_along_gravity() {
    let text = balls("rotation = { axis = [1, 2, 3], angle = 1 }, drop = { height = \"0.3 m\", onto = \"plate\" }")
        .replace("gravity = [0, 0, -9.81]", "gravity = [1, 2, -9]")
        .replace("material = \"m\" }\nbodies", "material = \"m\", rotation = { axis = [1, 0, 0], angle = 0.4 }, pivot = [0, 0, 1] }\nbodies");
    let state = planned(&text).state;
    let gravity = Vector3::new(1.0, 2.0, -9.0);
    assert!(velocity(&state, 0).cross(&gravity).norm() < 1e-12);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, 0.0, 0.0));
    let pivot = Vector3::new(0.0, 0.0, 1.0);
    let point = pivot + turn * (Vector3::new(0.0, 0.0, 0.05) - pivot);
    let normal = turn * Vector3::z();
    let gaps = state.particles.poses.iter();
    let gaps = gaps.map(|pose| (pose.place() - point).dot(&normal) - pose.radius_m());
    let gap = gaps.fold(f64::INFINITY, f64::min);
    assert!(gap > 0.0 && gap < 2e-5, "{gap:e}");
    // The way left along gravity.
    let left = gap / -gravity.normalize().dot(&normal);
    let energy = 0.5 * velocity(&state, 0).norm_squared() + gravity.norm() * left;
    assert!((energy / (gravity.norm() * 0.3) - 1.0).abs() < 1e-9);
}

#[test]
fn a_fall_away_from_the_wall_is_refused() {
    let text = balls("drop = { height = 1, onto = \"plate\" }")
        .replace("normal = [0, 0, 1]", "normal = [0, 0, -1]");
    let said = try_planned(&text).unwrap_err().to_string();
    assert!(said.contains("bodies.balls.drop: gravity does not point towards the free side of 'plate'; name a plane below"), "{said}");
}

/// The plate as another wall whose top is at the same height.
fn onto(wall: &str, body: &str) -> String {
    balls(body).replace(
        "plane = { point = [0, 0, \"5 cm\"], normal = [0, 0, 1] }",
        wall,
    )
}

const BLOCK: &str = "box = { min = [-2, -2, 0], max = [2, 2, \"5 cm\"] }";

/// Both spheres reach 1 mm below the origin: the place is that above a plane.
#[test]
fn a_body_falls_onto_boxes_cylinders_and_surfaces() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("roof.stl");
    let corners =
        [[-2, -2], [2, -2], [2, 2], [-2, 2]].map(|[x, y]| format!("vertex {x} {y} 0.05\n"));
    let facet = |three: [usize; 3]| {
        let loops = three.map(|k| corners[k].as_str()).concat();
        format!("facet normal 0 0 1\nouter loop\n{loops}endloop\nendfacet\n")
    };
    let roof = format!(
        "solid roof\n{}{}endsolid roof\n",
        facet([0, 1, 2]),
        facet([0, 2, 3])
    );
    std::fs::write(&path, roof).unwrap();
    let roof = format!("stl = \"{}\", unit = \"m\"", path.display());
    let pillar = "cylinder = { from = [0, 0, 0], to = [0, 0, \"5 cm\"], radius = 2 }";
    for wall in [BLOCK, pillar, &roof] {
        for height_m in [1e-3, 1.0] {
            let drop = format!(
                "position = [\"1 m\", \"0.5 m\", 0], drop = {{ height = {height_m}, onto = \"plate\" }}"
            );
            let plane = planned(&balls(&drop)).state;
            let state = planned(&onto(wall, &drop)).state;
            let gap = gap_m(&state);
            assert!(gap > 0.0 && (gap - 1e-5).abs() < 2e-9, "{wall}: {gap:e}");
            for i in [0, 1] {
                assert!(
                    (place(&state, i) - place(&plane, i)).norm() < 2e-9,
                    "{wall}"
                );
                assert!(
                    (velocity(&state, i) - velocity(&plane, i)).norm() < 1e-9,
                    "{wall}"
                );
            }
        }
    }
}

/// A sphere of 1 mm whose centre is 0.6 mm beyond the edge of a box touches it 0.8 mm below its
/// centre, at a normal with the cosine 0.8; the other sphere of the body passes.
#[test]
fn a_body_may_hit_an_edge_or_fall_past() {
    let drop = |x_m: f64| {
        onto(
            BLOCK,
            &format!("position = [{x_m}, 0, 0], drop = {{ height = 1, onto = \"plate\" }}"),
        )
    };
    let state = planned(&drop(2.0006)).state;
    let small = |i: &usize| state.particles.poses[*i].radius_m() < 1.5e-3;
    let height_m = place(&state, (0..2).find(small).unwrap()).z - 0.05;
    assert!((height_m - (0.8e-3 + 1.25e-5)).abs() < 1e-8, "{height_m:e}");
    let said = try_planned(&drop(3.0)).unwrap_err().to_string();
    assert!(
        said.contains("bodies.balls.drop: the body falls past 'plate'; move it across gravity"),
        "{said}"
    );
}

/// Masses 1 and 8 at 0 and 4 mm: the centre is 8/9 of the way.
#[test]
fn a_position_of_the_centre_is_that_of_the_centre_of_mass() {
    let centre = |state: &State| (place(state, 0) + place(state, 1)) / 9.0;
    let of = |body: &str| {
        let state =
            planned(&balls(body).replace("[4e-3, 0, \"1 mm\", 2e-3]", "[4e-3, 0, 0, 2e-3]")).state;
        let radius = |i: usize| state.particles.poses[i].radius_m();
        let small = usize::from(radius(0) > radius(1));
        let places = [place(&state, small), place(&state, 1 - small)];
        (places, centre(&state))
    };
    let rotation = "rotation = { axis = [0, 1, 0], angle = 0.5 }";
    for turned in ["", rotation] {
        let body = format!("position = [1, 2, 3], position_of = \"centre\", {turned}");
        let ([small, large], _) = of(body.trim_end_matches(", "));
        let found = (small + 8.0 * large) / 9.0;
        assert!(
            (found - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-14,
            "{found}"
        );
        assert!(((large - small).norm() - 4e-3).abs() < 1e-15);
    }
    let ([small, _], _) = of("position = [1, 2, 3]");
    assert_eq!(small, Vector3::new(1.0, 2.0, 3.0), "the origin of the file");
    // A clump, whose spheres do not overlap, is put the same way; a drop keeps the sides.
    let clump = "start_as = \"clump\", position = [1, 2, 0], position_of = \"centre\", drop = { height = 1, onto = \"plate\" }";
    let state =
        planned(&balls(clump).replace("[4e-3, 0, \"1 mm\", 2e-3]", "[4e-3, 0, 0, 2e-3]")).state;
    let clump = &state.clumps.all[0];
    assert!((clump.place_m[0] - 1.0).abs() < 1e-14 && (clump.place_m[1] - 2.0).abs() < 1e-14);
    assert!((clump.velocity_m_s[2] + (2.0_f64 * 9.81).sqrt()).abs() < 1e-3);
}
