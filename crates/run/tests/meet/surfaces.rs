//! Irregular walls from STL files: their effect on a sphere, their warnings, and their refusal.

use std::fmt::Write;
use std::path::Path;

use dem_engine::step::step;
use dem_io::{Body, Diagnostic};
use dem_plan::{Plan, plan};
use dem_scene::{BodySource, scene_from_text};

use super::apart::planned;
use crate::closed_box::closed_box;

type Corners = [[f64; 3]; 3];

fn write_stl(folder: &Path, name: &str, triangles: &[Corners]) -> String {
    let mut text = "solid wall\n".to_owned();
    for triangle in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in triangle {
            let _ = writeln!(text, "vertex {x:e} {y:e} {z:e}");
        }
        text += "endloop\nendfacet\n";
    }
    text += "endsolid wall\n";
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn turned([a, b, c]: Corners) -> Corners {
    [b, a, c]
}

/// Squares of 5 mm of two triangles each, on z = 0 around the origin.
fn plate() -> Vec<Corners> {
    let at = |i: i32, j: i32| [0.005 * f64::from(i), 0.005 * f64::from(j), 0.0];
    let squares = (-4..4).flat_map(|i| (-4..4).map(move |j| (i, j)));
    let of_one = |(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    squares.flat_map(of_one).collect()
}

fn box_corners(low: [f64; 3], high: [f64; 3]) -> Vec<Corners> {
    let (vertices, triangles) = closed_box(low, high);
    let corners = triangles.iter().map(|t| t.map(|v| vertices[v as usize]));
    corners.collect()
}

/// A sphere of 5 mm radius above a wall.
fn scene(wall: &str, ball: &str, run: &str) -> String {
    format!(
        "version = 1\nrun.end_time = 1\nrun.gravity = [0, 0, -9.81]\n{run}\n\
         materials.glass = {{ density = 2500, young_modulus = \"50 MPa\", poisson_ratio = 0.25 }}\n\
         contacts.glass-glass = {{ restitution = 0.5, friction = 0.5 }}\n\
         bodies.ball = {{ particles = [{ball}], velocity = [0.3, 0.17, -0.1], material = \"glass\" }}\n\
         [walls.ground]\nmaterial = \"glass\"\n{wall}\n"
    )
}

/// As [`planned`], for a scene that may be refused.
fn tried(text: &str) -> Result<Plan, Diagnostic> {
    let scene = scene_from_text(text, "test.toml", &[])?;
    let bodies = (scene.bodies.iter())
        .filter_map(|(name, entry)| match &entry.source {
            BodySource::Inline { particles, bonds } => {
                Some((name.clone(), Body::from_spheres(particles, bonds).ok()?))
            }
            BodySource::File(_) => None,
        })
        .collect();
    plan(&scene, bodies, 2, false)
}

/// A sphere bounces and slides over a plate in the same way for any winding of its triangles and
/// any number of duplicates.
#[test]
fn turned_and_doubled_triangles_push_as_a_clean_plate_does() {
    let folder = tempfile::tempdir().unwrap();
    let clean = plate();
    let mut some_turned = clean.clone();
    for t in [72, 73, 75, 91] {
        some_turned[t] = turned(some_turned[t]);
    }
    let mut doubled = clean.clone();
    doubled.extend([clean[72], clean[73], clean[90]]);
    let mut both_ways = clean.clone();
    both_ways.extend([turned(clean[72]), turned(clean[73]), turned(clean[90])]);
    let mut flat = clean.clone();
    let [a, b, _] = clean[72];
    flat.extend([[a, b, a], [a, b, [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))]]);
    let run = |name: &str, triangles: &[Corners]| {
        let stl = write_stl(folder.path(), name, triangles);
        let wall = format!("stl = {stl:?}\nunit = \"m\"");
        let text = scene(&wall, "[1e-3, 5e-4, 5.2e-3, 5e-3]", "run.time_step = 1e-5");
        let Plan {
            mut state, notes, ..
        } = planned(&text);
        let mut seen = Vec::new();
        while state.time_s < 0.03 {
            step(&mut state);
            let [x, y, z]: [f64; 3] = state.particles.poses[0].place().into();
            seen.push([x, y, z, state.walls[0].push.force_n[2]]);
        }
        (seen, notes)
    };
    let (wanted, notes) = run("clean.stl", &clean);
    assert!(wanted.iter().filter(|row| row[3] > 0.0).count() > 200);
    assert!(wanted[wanted.len() - 1][0] > 5e-3, "over several triangles");
    assert_eq!(notes.len(), 1, "only that it is open: {notes:?}");
    for (name, triangles, said) in [
        (
            "turned.stl",
            some_turned,
            "4 facets are turned against their neighbours",
        ),
        (
            "doubled.stl",
            doubled,
            "3 facets that stood there already were dropped: each counts once",
        ),
        (
            "both.stl",
            both_ways,
            "3 facets that stood there already were dropped: each counts once",
        ),
        ("flat.stl", flat, "2 facets without area were dropped"),
    ] {
        let (found, notes) = run(name, &triangles);
        for (found, wanted) in found.iter().zip(&wanted) {
            let off = (0..4).map(|k| (found[k] - wanted[k]).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12, "{name}: {found:?}");
        }
        assert_eq!(notes.len(), 2, "{name}: {notes:?}");
        assert!(notes.iter().any(|note| note.contains(said)), "{notes:?}");
    }
}

#[test]
fn a_body_that_starts_inside_a_solid_surface_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let outwards = box_corners([-0.1, -0.1, -0.2], [0.1, 0.1, 0.0]);
    let inwards: Vec<Corners> = outwards.iter().copied().map(turned).collect();
    let mut mixed = outwards.clone();
    mixed[0] = turned(mixed[0]);
    let open = outwards[1..].to_vec();
    let wall = |name: &str, triangles: &[Corners]| {
        let stl = write_stl(folder.path(), name, triangles);
        format!("stl = {stl:?}\nunit = \"m\"\npivot = [0, 0, -0.05]")
    };
    let solid = wall("solid.stl", &outwards);
    let inside = "[0.01, 0.02, -0.05, 5e-3]";
    for (ball, depth, more) in [
        (inside, "55 mm", ""),
        (
            "[0, 0, 0.02, 5e-3], [0.01, 0.02, -0.05, 5e-3], [0.05, 0.02, -0.03, 5e-3]",
            "55 mm",
            ", the deepest of 2 places",
        ),
        // Its centre is inside, and it protrudes.
        ("[0.01, 0.02, -0.002, 5e-3]", "7 mm", ""),
    ] {
        for overlap in ["refuse", "relax"] {
            let run = format!("run.initial_overlap = \"{overlap}\"");
            let error = tried(&scene(&solid, ball, &run)).err().unwrap();
            assert_eq!(error.exit_code(), 2);
            let said = error.to_string();
            let wanted = format!(
                " of the body 'ball' is {depth} deep in the wall 'ground' at the start{more}; \
                 move the body or the wall: its centre is inside a closed surface whose normals look outwards, so a solid; \
                 if that is to be a container, export it with its normals inwards"
            );
            assert!(said.starts_with("test.toml: [walls.ground]: particle "));
            assert!(said.ends_with(&wanted), "{said}");
        }
    }
    // Its own corner is turned away from the sphere, which is therefore free.
    let aside = format!("{solid}\nrotation = {{ axis = [1, 0, 0], angle = \"180 deg\" }}");
    let free = "[0.01, 0.02, -0.16, 5e-3]";
    assert!(tried(&scene(&solid, free, "")).is_err());
    assert!(tried(&scene(&aside, free, "")).is_ok());

    for (name, triangles, said) in [
        ("container.stl", inwards, "the surface is inside out"),
        ("mixed.stl", mixed, "1 facet is turned against its"),
        ("open.stl", open, "the surface is open"),
    ] {
        let text = scene(&wall(name, &triangles), inside, "");
        let notes = tried(&text).unwrap().notes;
        assert!(notes[0].contains(said), "{notes:?}");
        let of_surface = notes.iter().filter(|note| !note.contains("pivot"));
        assert_eq!(of_surface.count(), 1, "{notes:?}");
    }
}

#[test]
fn a_surface_out_of_proportion_asks_for_its_unit() {
    let folder = tempfile::tempdir().unwrap();
    let cube = |edge_m: f64| box_corners([-0.5 * edge_m; 3], [0.5 * edge_m; 3]);
    // Two spheres of 10 mm, and the same number far away.
    let near = "[0, 0, 20, 5e-3], [0.02, 0, 20, 5e-3]";
    let wide = "[0, 0, 20, 5e-3], [8, 0, 20, 5e-3]";
    for (edge_m, balls, said) in [
        (1.0, near, None),
        (0.03, near, None),
        // A pin or a tooth among bodies that are far apart.
        (0.02, wide, None),
        (0.01, near, None),
        (20.0, near, Some("times larger than all bodies together")),
        (1e-3, near, Some("smaller than a single sphere (10 mm)")),
        (1e-3, wide, Some("smaller than a single sphere (10 mm)")),
        (1e-6, near, Some("smaller than a single sphere (10 mm)")),
        (0.01, wide, Some("times smaller than all bodies together")),
    ] {
        let stl = write_stl(folder.path(), "cube.stl", &cube(edge_m));
        let text = scene(&format!("stl = {stl:?}\nunit = \"m\""), balls, "");
        let notes = tried(&text).unwrap().notes;
        match said {
            None => assert!(notes.is_empty(), "{edge_m}: {notes:?}"),
            Some(said) => assert!(
                notes.len() == 1 && notes[0].contains(said) && notes[0].contains("its file 1 m?"),
                "{edge_m}: {notes:?}"
            ),
        }
    }
}

#[test]
fn a_belt_moves_along_its_plane() {
    let belt = |wall: &str| tried(&scene(wall, "[0, 0, 0.5, 5e-3]", ""));
    let level = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }";
    for (wall, part) in [
        (
            format!("{level}\nsurface_velocity = [3, 0, 0.5]"),
            "has 0.5 m/s of 3.041 m/s along the plane's normal",
        ),
        (
            format!("{level}\nsurface_velocity = [3, 0, -1e-4]"),
            "write surface_velocity = [3, 0, 0], which is its part along the plane",
        ),
        (
            format!(
                "{level}\nrotation = {{ axis = [0, 1, 0], angle = \"30 deg\" }}\nsurface_velocity = [1, 0, 0]"
            ),
            "write surface_velocity = [0.75, 0, -0.433012702]",
        ),
    ] {
        let error = belt(&wall).err().unwrap();
        assert_eq!(
            (error.exit_code(), &error.place[..]),
            (2, "test.toml: [walls.ground]")
        );
        let said = error.to_string();
        assert!(said.contains(part), "'{part}' is not in: {said}");
    }
    for wall in [
        format!("{level}\nsurface_velocity = [3, -2, 0]"),
        format!("{level}\nsurface_velocity = [3, 0, 1e-7]"),
        format!("{level}\nrotation = {{ axis = [0, 1, 0], angle = \"30 deg\" }}\nsurface_velocity = [0.75, 0, -0.433012702]"),
        // For these, each side contributes.
        "box = { min = [-1, -1, -1], max = [1, 1, 0] }\nsurface_velocity = [1, 0, 1]".to_owned(),
        "cylinder = { from = [0, -1, -1], to = [0, 1, -1], radius = 0.5 }\nsurface_velocity = [1, 0, 1]"
            .to_owned(),
    ] {
        assert!(belt(&wall).is_ok(), "{wall}");
    }
}
