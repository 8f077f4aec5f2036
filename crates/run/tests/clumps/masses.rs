//! Bodies have the mass given in the scene, in whatever form they start, and clumps the mass of the
//! clusters that replace them.

use std::collections::BTreeMap;

use dem_engine::state::events::PopulationEvent;
use dem_io::Body;
use dem_plan::{Plan, plan};

use super::{HEAD, MEETS, Whole, happens};
use crate::helpers::scene;

/// Volume of the shape of the body, m3.
const VOLUME_M3: f64 = 3e-8;

/// Four overlapping spheres without symmetry, in a row with a corner.
fn cake() -> Body {
    let spheres = [
        [0.0, 0.0, 0.0, 1e-3],
        [1.6e-3, 0.0, 0.0, 1.1e-3],
        [3.1e-3, 0.2e-3, 0.0, 0.9e-3],
        [3.1e-3, 1.7e-3, 0.3e-3, 1e-3],
    ];
    let mut body = Body::from_spheres(&spheres, &[[0, 1], [1, 2], [2, 3]]).unwrap();
    body.about.shape_volume_m3 = Some(VOLUME_M3);
    body
}

fn planned(more: &str) -> Plan {
    let text = format!(
        "{HEAD}{MEETS}bodies.cake = {{ file = \"cake.vtp\", material = \"stuff\", bonds = \"stiff\", {more} }}\n"
    );
    of_text(&text)
}

fn of_text(text: &str) -> Plan {
    let bodies = BTreeMap::from([("cake".to_owned(), cake())]);
    plan(&scene(text), bodies, 1, false).unwrap()
}

/// Mass of all bodies of the state, with clumps by their templates.
fn mass_kg(plan: &Plan) -> f64 {
    let p = &plan.state.particles;
    let of_clumps = plan.state.clumps.mass_kg();
    match plan.state.clumps.all.len() {
        0 => Whole::of(p, 0..p.len(), &nalgebra::Vector3::zeros()).mass_kg,
        _ => of_clumps,
    }
}

#[test]
fn a_body_weighs_what_the_scene_says() {
    let starts = [
        "start_as = \"bonded\"",
        "start_as = \"clump\"",
        "start_as = \"clump\", clump = { mass = \"union\" }",
    ];
    for start in starts {
        let usual = planned(start);
        let spheres = &usual.masses["cake"];
        assert!(spheres.difference_percent.unwrap().abs() > 5.0);
        for (says, wanted_kg) in [
            ("body_density = 1800", 1800.0 * VOLUME_M3),
            ("body_density = \"1.8 g/cm3\"", 1800.0 * VOLUME_M3),
            ("mass = \"372 g\"", 0.372),
        ] {
            let plan = planned(&format!("{start}, {says}"));
            let cake = &plan.masses["cake"];
            for found in [mass_kg(&plan), cake.mass_kg] {
                assert!(
                    (found / wanted_kg - 1.0).abs() < 1e-12,
                    "{start} {says}: {found}"
                );
            }
            // The same shape, heavier: inertia grows with the mass, the centre stays.
            let heavier = wanted_kg / spheres.mass_kg;
            for k in 0..3 {
                let grown = cake.principal_moments_kg_m2[k] / spheres.principal_moments_kg_m2[k];
                assert!((grown / heavier - 1.0).abs() < 1e-9, "{grown} {heavier}");
                assert!((cake.centre_m[k] - spheres.centre_m[k]).abs() < 1e-15);
            }
            assert!(plan.notes.is_empty(), "{:?}", plan.notes);
        }
    }
    // A shape filled with the density of the body has the same mass.
    let as_much = planned("body_density = 1800").masses["cake"];
    assert_eq!(as_much.fill_density_kg_m3, Some(1800.0));
    assert!(as_much.difference_percent.unwrap().abs() < 1e-9);
}

#[test]
fn the_density_of_the_material_is_not_needed() {
    let without = HEAD.replace("density = 2500, ", "");
    let text = format!(
        "{without}{MEETS}bodies.cake = {{ file = \"cake.vtp\", material = \"stuff\", bonds = \"stiff\", mass = 0.5 }}\n"
    );
    let plan = of_text(&text);
    assert!((mass_kg(&plan) / 0.5 - 1.0).abs() < 1e-12);
    assert_eq!(plan.masses["cake"].shape_mass_kg, None);
}

#[test]
fn a_body_that_is_turned_and_moved_is_told_of_where_it_stands() {
    let moved = "position = [1, 2, 3], rotation = { axis = [0, 0, 1], angle = \"90 deg\" }";
    let [here, there] = ["", &format!("{moved}, ")].map(|more| {
        ["bonded", "clump"]
            .map(|start| planned(&format!("{more}start_as = \"{start}\"")).masses["cake"])
    });
    for (here, there) in here.iter().zip(&there) {
        let [x, y, z] = here.centre_m;
        for (found, wanted) in there.centre_m.iter().zip([1.0 - y, 2.0 + x, 3.0 + z]) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
        let (a, b) = (here.inertia_kg_m2, there.inertia_kg_m2);
        let scale = here.principal_moments_kg_m2[2];
        for (found, wanted) in [(b[0][0], a[1][1]), (b[1][1], a[0][0]), (b[0][1], -a[0][1])] {
            assert!((found - wanted).abs() < 1e-9 * scale, "{found} {wanted}");
        }
    }
}

#[test]
fn a_cluster_weighs_what_its_clump_did() {
    let text = format!(
        "{HEAD}{MEETS}bodies.cake = {{ file = \"cake.vtp\", material = \"stuff\", bonds = \"stiff\", start_as = \"clump\", body_density = 1800, velocity = [1, 0, 0] }}\nreplacement.cake.when.time = 1e-5\n"
    );
    let mut plan = of_text(&text);
    let wanted_kg = 1800.0 * VOLUME_M3;
    assert!((mass_kg(&plan) / wanted_kg - 1.0).abs() < 1e-12);
    let mut replaced = false;
    while !replaced {
        assert!(plan.state.time_s < 1e-3);
        let happened = happens(&mut plan.state);
        replaced = happened
            .iter()
            .any(|one| matches!(one, PopulationEvent::Replaced { .. }));
    }
    assert!(plan.state.clumps.all.is_empty());
    assert!((mass_kg(&plan) / wanted_kg - 1.0).abs() < 1e-12);
}

#[test]
fn an_inlet_feeds_by_that_mass() {
    let text = format!(
        "{HEAD}{MEETS}bodies.cake = {{ file = \"cake.vtp\", material = \"stuff\", bonds = \"stiff\", mass = 0.25 }}\n\
         [regions.gate]\nbox = {{ min = [-50, -50, -50], max = [50, 50, 50] }}\n\
         [inlets.feed]\nregion = \"gate\"\nbodies = [\"cake\"]\nmass_rate = \"10 kg/s\"\n"
    );
    let mut plan = of_text(&text);
    assert!((plan.masses["cake"].mass_kg / 0.25 - 1.0).abs() < 1e-12);
    plan.state.time_step_s = 1e-4;
    while plan.state.time_s < 0.21 {
        happens(&mut plan.state);
    }
    // One at once, and one every 25 ms.
    let come = &plan.state.population.inlets[0];
    assert_eq!(come.bodies, 9);
    assert!((come.mass_kg / (9.0 * 0.25) - 1.0).abs() < 1e-12);
}

#[test]
fn what_weighs_other_than_its_shape_is_noted_with_the_remedy() {
    let plan = planned("start_as = \"bonded\"");
    let cake = &plan.masses["cake"];
    let spheres_m3 = 4.0 / 3.0 * std::f64::consts::PI * (2.0 + 1.331 + 0.729) * 1e-9;
    assert!((cake.mass_kg / (2500.0 * spheres_m3) - 1.0).abs() < 1e-12);
    assert!((cake.shape_mass_kg.unwrap() / (2500.0 * VOLUME_M3) - 1.0).abs() < 1e-12);
    assert_eq!(
        plan.notes,
        [
            "body 'cake' weighs 4.252e-5 kg, -43 % against its shape filled with 2500 kg/m3: bodies.cake.body_density = \"2500 kg/m3\" gives it that mass"
        ]
    );
    assert!(plan.warnings.is_empty());
}

#[test]
fn large_spheres_of_a_file_without_a_unit_are_noted() {
    let notes = |file: &str, radii: [f64; 2], more: &str| {
        let text = format!(
            "{HEAD}{MEETS}bodies.cake = {{ file = \"{file}\", material = \"stuff\", {more} }}\n"
        );
        let spheres = [[0.0, 0.0, 0.0, radii[0]], [0.0, 0.0, 9.0, radii[1]]];
        let body = Body::from_spheres(&spheres, &[]).unwrap();
        let bodies = BTreeMap::from([("cake".to_owned(), body)]);
        plan(&scene(&text), bodies, 1, true).unwrap().notes
    };
    let is_said = |notes: Vec<String>| notes.iter().any(|note| note.contains("metres"));
    assert!(notes("cake.csv", [2.0, 3.0], "").contains(
        &"bodies.cake: the spheres of 'cake.csv' have radii of 2 to 3 m, as its numbers are metres: if they are millimetres, multiply them by 0.001, or set bodies.cake.sieve_size, which scales the body".to_owned()
    ));
    assert!(is_said(notes("cake.txt", [0.6, 0.6], "")));
    assert!(!is_said(notes("cake.csv", [0.5, 0.4], "")));
    assert!(!is_said(notes("cake.vtp", [2.0, 3.0], "")));
    assert!(!is_said(notes(
        "cake.csv",
        [2.0, 3.0],
        "sieve_size = \"20 mm\""
    )));
}
