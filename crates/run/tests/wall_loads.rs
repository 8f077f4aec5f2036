//! Books of what contacts do to the patches of walls: they close with the forces and the losses of
//! the walls, and agree with what is known of sliding and impact.

use std::f64::consts::PI;
use std::fmt::Write;

use dem_engine::state::State;
use dem_engine::state::walls::Wall;
use dem_engine::step::{advance, interact};
use dem_physics::contact::patch_book::PatchBook;
use dem_physics::geometry::patches::Patch;
use dem_plan::plan;
use dem_scene::read_bodies;

use crate::closed_box::closed_box;
use crate::helpers::{scene, started, try_planned};
use crate::sleep::{CLUMP, GRAVITY_M_S2, SLEEP, ball, head, slab, slab_kg};

/// The books of the first wall, with the patches in its own frame.
fn patches(state: &State) -> Vec<(Patch, PatchBook)> {
    let wall = &state.walls[0];
    let (model, book) = (
        wall.model.book.as_ref().unwrap(),
        wall.book.as_ref().unwrap(),
    );
    let patch = |at| model.patches.patch(&wall.model.shape, at);
    let all = book.patches().into_iter();
    all.map(|(at, book)| (patch(at), *book)).collect()
}

/// Those that have been touched.
fn touched(state: &State) -> Vec<(Patch, PatchBook)> {
    let mut all = patches(state);
    all.retain(|(_, book)| *book != PatchBook::default());
    all
}

/// What the patches of a wall together must have.
#[derive(Default)]
struct Sums {
    /// In the frame of the wall, N s; and the sum of the magnitudes.
    impulse_n_s: [f64; 3],
    scale_n_s: f64,
}

impl Sums {
    fn add(&mut self, wall: &Wall, kick_s: f64) {
        let on_wall_n = wall.total_load()[0].map(|force_n| -force_n);
        for (sum, force_n) in
            (self.impulse_n_s.iter_mut()).zip(wall.frame.direction_to_wall(on_wall_n))
        {
            *sum += kick_s * force_n;
            self.scale_n_s += kick_s * force_n.abs();
        }
    }
}

/// Follows a scene with one wall; the books must close. Returns its end.
fn follow(text: &str, until_s: f64) -> State {
    let mut state = started(text);
    let mut sums = Sums::default();
    while state.time_s < until_s {
        interact(&mut state);
        let [before_s, after_s] = state.steps_s();
        sums.add(&state.walls[0], 0.5 * (before_s + after_s));
        advance(&mut state);
    }
    let wall = &state.walls[0];
    let total = wall.book.as_ref().unwrap().total();
    assert!(sums.scale_n_s > 0.0);
    // Contributions are summed step by step, with rounding in each.
    let rounding = 1e-13 + f64::EPSILON * state.steps as f64;
    for (booked, wanted) in total.impulse_n_s.iter().zip(sums.impulse_n_s) {
        let error = (booked - wanted).abs() / sums.scale_n_s;
        assert!(error < rounding, "{booked} instead of {wanted}: {error:e}");
    }
    let scale_j = wall.friction_j.abs() + wall.damping_j.abs();
    for (booked, wanted) in [
        (total.friction_j, wall.friction_j),
        (total.damping_j, wall.damping_j),
    ] {
        let error = (booked - wanted).abs() / scale_j;
        assert!(error < rounding, "{booked} instead of {wanted}: {error:e}");
    }
    assert!(scale_j > 0.0 && total.sliding_load_n_m > 0.0 && total.impact_j > 0.0);
    state
}

/// A rigid clump, a bonded body and a ball that fall onto a wall with this shape and motion.
fn falling(wall: &str, more: &str) -> String {
    let clump = slab(
        "clump",
        [-3e-3, -1e-3, 2e-4],
        &format!("velocity = [0.1, 0, -0.2]\n{CLUMP}"),
    );
    let cluster = slab(
        "cluster",
        [1.5e-3, 1e-3, 1e-4],
        "velocity = [0, 0.15, -0.1]",
    );
    let ball = ball("ball", [-1e-3, -3e-3, 5e-4], "velocity = [0.1, 0.1, -0.1]");
    format!(
        "{}{clump}{cluster}{ball}[walls.w]\nmaterial = \"stuff\"\n{wall}\n{more}",
        head(0.2)
    )
}

const BOX: &str = "box = { min = [-0.02, -0.02, -0.01], max = [0.02, 0.02, 0] }\n";
const PATCH: &str = "loads = { patch = \"2 mm\", wear_constant = \"1e-12 1/Pa\" }\n";

#[test]
fn the_books_of_a_box_close() {
    follow(&falling(&format!("{BOX}{PATCH}"), ""), 0.01);
}

#[test]
fn the_books_of_a_plane_that_moves_close() {
    let plane = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }\nvelocity = [0.05, 0, 0.1]\n";
    let state = follow(&falling(&format!("{plane}{PATCH}"), ""), 0.01);
    assert_eq!(touched(&state).len(), patches(&state).len());
}

#[test]
fn the_books_of_a_cylinder_that_turns_close() {
    let pin = "cylinder = { from = [0, -0.02, -0.02], to = [0, 0.02, -0.02], radius = 0.02 }\n\
        pivot = [0, 0, -0.02]\nangular_velocity = [0, 5, 0]\n";
    follow(&falling(&format!("{pin}{PATCH}"), ""), 0.01);
}

#[test]
fn the_books_of_a_box_that_turns_close() {
    let turns = "pivot = [0, 0, -5e-3]\nangular_velocity = [3, 8, 20]\n";
    let state = follow(&falling(&format!("{BOX}{turns}{PATCH}"), ""), 0.01);
    assert!(touched(&state).len() > 4);
}

#[test]
fn the_books_of_a_belt_close() {
    let belt = "surface_velocity = [0.3, 0, 0]\n";
    follow(&falling(&format!("{BOX}{belt}{PATCH}"), ""), 0.01);
}

#[test]
fn the_books_of_triangles_that_turn_close() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.stl");
    let (vertices, triangles) = closed_box([-20.0, -20.0, -10.0], [20.0, 20.0, 0.0]);
    let mut text = "solid box\n".to_owned();
    for corners in &triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for corner in corners {
            let [x, y, z]: [f64; 3] = vertices[*corner as usize];
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    std::fs::write(&path, text + "endsolid box\n").unwrap();
    let wall = format!(
        "stl = '{}'\nunit = \"mm\"\npivot = [0, 0, -5e-3]\nangular_velocity = [3, 8, 20]\nloads = {{ wear_constant = 1e-12 }}\n",
        path.display()
    );
    let state = follow(&falling(&wall, ""), 0.01);
    // Of twelve triangles the two on which bodies fell.
    assert_eq!((patches(&state).len(), touched(&state).len()), (12, 2));
}

#[test]
fn the_books_of_a_wet_wall_close() {
    let dry = "friction = 0.8 }";
    let liquid = "{ surface_tension = 0.073, contact_angle = 0.3, volume = 1e-12 }";
    let wet = format!("friction = 0.8, liquid_bridge = {liquid} }}");
    let text = falling(&format!("{BOX}{PATCH}"), "");
    assert!(text.contains(dry), "{text}");
    let text = text.replace(dry, &wet);
    let state = follow(&text, 0.01);
    assert!(
        state
            .bridges
            .is_some_and(|bridges| !bridges.walls.is_empty())
    );
}

/// Bodies that sleep go on pressing, and the patches of a belt under a body that rides on it change.
#[test]
fn the_books_close_while_bodies_sleep() {
    let level = falling(&format!("{BOX}{PATCH}"), SLEEP);
    let state = follow(&level, 0.12);
    assert!(state.sleep.as_ref().unwrap().bodies > 0);
    let belt = "surface_velocity = [0.05, 0, 0]\n";
    let body = slab(
        "clump",
        [-9e-3, -1e-3, 0.0],
        &format!("velocity = [0.05, 0, 0]\n{CLUMP}"),
    );
    let text = format!(
        "{}{body}[walls.w]\nmaterial = \"stuff\"\n{BOX}{belt}{PATCH}{SLEEP}",
        head(0.0)
    );
    let state = follow(&text, 0.2);
    assert!(state.sleep.as_ref().unwrap().bodies > 0);
    let weight_n = slab_kg() * GRAVITY_M_S2;
    // A patch of 2 mm over which all four spheres have gone, two by two; y = 0 is an edge.
    let passed = patches(&state)
        .into_iter()
        .filter(|(patch, _)| patch.normal[2] > 0.0 && (patch.centre_m[0] + 3e-3).abs() < 1e-9);
    let impulse_n_s: f64 = passed.map(|(_, book)| book.normal_impulse_n_s).sum();
    let wanted_n_s = weight_n * 2e-3 / 0.05;
    assert!(
        (impulse_n_s / wanted_n_s - 1.0).abs() < 0.02,
        "{impulse_n_s} {wanted_n_s}"
    );
}

/// What slides over patches at its weight wears each by Archard's volume.
#[test]
fn a_sliding_body_wears_each_patch_by_its_weight_and_the_way() {
    let body = slab(
        "clump",
        [1e-3, 1e-3, 0.0],
        &format!("velocity = [1, 0, 0]\n{CLUMP}"),
    );
    let wall = "[walls.w]\nmaterial = \"stuff\"\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n\
        loads = { patch = \"5 mm\", wear_constant = \"2e-12 m2/N\" }\n";
    let state = follow(&format!("{}{body}{wall}", head(0.0)), 0.14);
    let (weight_n, friction) = (slab_kg() * GRAVITY_M_S2, 0.8);
    let way_m = 1.0 / (2.0 * friction * GRAVITY_M_S2);
    let total = state.walls[0].book.as_ref().unwrap().total();
    let is = |is: f64, wanted: f64, what: &str| {
        eprintln!("{what}: {is:e}, {wanted:e}");
        assert!(
            (is / wanted - 1.0).abs() < 0.01,
            "{what}: {is:e}, {wanted:e}"
        );
    };
    is(total.sliding_load_n_m, weight_n * way_m, "sliding load");
    is(total.friction_j, friction * weight_n * way_m, "friction");
    is(total.wear_m3(2e-12), 2e-12 * weight_n * way_m, "wear");
    let mut passed = 0;
    for (patch, book) in patches(&state) {
        let x_m = patch.centre_m[0];
        // All four spheres have passed it.
        if x_m > 6e-3 && x_m < way_m - 4e-3 {
            is(book.sliding_load_n_m, weight_n * 5e-3, "of a patch");
            passed += 1;
        }
    }
    assert!(passed >= 8, "{passed}");
}

/// A ball that meets the wall `w` at 1 m/s without friction, damping and gravity.
fn impact(ball_m_s: [f64; 3], position_m: [f64; 3], wall: &str) -> String {
    let [[x, y, z], v] = [position_m, ball_m_s];
    format!(
        "version = 1\nrun.end_time = 1\nrun.impact_accuracy = 1e-4\n\
         materials.stuff = {{ density = 2500, young_modulus = 1e8, poisson_ratio = 0.25 }}\n\
         contacts.stuff-stuff = {{ restitution = 1, friction = 0 }}\n\
         bodies.ball = {{ material = \"stuff\", particles = [[{x:e}, {y:e}, {z:e}, 1e-3]], velocity = {v:?} }}\n\
         [walls.w]\nmaterial = \"stuff\"\n{wall}\n"
    )
}

/// The only patch that this impact has touched, and what happened to it, over what a mass of the
/// ball at 1 m/s gives.
fn hit(text: &str) -> (Patch, PatchBook) {
    let mut state = started(text);
    while state.time_s < 0.012 {
        interact(&mut state);
        advance(&mut state);
    }
    assert_eq!(state.walls[0].touching.len(), 0);
    let [one] = <[_; 1]>::try_from(touched(&state)).unwrap();
    let mass_kg = 2500.0 * 4.0 / 3.0 * PI * 1e-9;
    let (impulse, energy) = (
        one.1.normal_impulse_n_s / (2.0 * mass_kg),
        one.1.impact_j / (0.5 * mass_kg),
    );
    eprintln!("impulse {impulse}, energy {energy}");
    assert!(
        (impulse - 1.0).abs() < 1e-3 && (energy - 1.0).abs() < 1e-3,
        "{impulse} {energy}"
    );
    assert!(one.1.friction_j.abs() < 1e-12 * one.1.impact_j);
    one
}

#[test]
fn an_elastic_impact_gives_its_patch_twice_its_momentum_and_its_energy() {
    let (patch, book) = hit(&impact(
        [0.0, 0.0, -1.0],
        [3e-3, 1e-3, 5e-3],
        &format!("{BOX}{PATCH}"),
    ));
    assert_eq!(patch.normal, [0.0, 0.0, 1.0]);
    assert!((patch.centre_m[0] - 3e-3).abs() < 1.1e-3 && (patch.centre_m[1] - 1e-3).abs() < 1.1e-3);
    assert!(book.impulse_n_s[2] == -book.normal_impulse_n_s);
    let towards = format!("{BOX}velocity = [0, 0, 1]\n{PATCH}");
    let (moving, _) = hit(&impact([0.0; 3], [3e-3, 1e-3, 5e-3], &towards));
    assert_eq!(moving, patch);
}

/// A wall that has turned by a quarter is hit on the side that was at -y.
#[test]
fn a_turned_wall_books_at_its_own_place() {
    let cube = "box = { min = [-0.01, -0.01, -0.01], max = [0.01, 0.01, 0.01] }\n\
        angular_displacement = { axis = [0, 0, 1], angle = \"90 deg\" }\nramp = \"1 ms\"\n";
    let text = impact(
        [-1.0, 0.0, 0.0],
        [18e-3, 3e-3, 1e-3],
        &format!("{cube}{PATCH}"),
    );
    let (patch, book) = hit(&text);
    assert_eq!(patch.normal, [0.0, -1.0, 0.0]);
    assert!((patch.centre_m[0] - 3e-3).abs() < 1.1e-3, "{patch:?}");
    let [x, y, _] = book.impulse_n_s;
    assert!((y / book.normal_impulse_n_s - 1.0).abs() < 1e-9 && x.abs() < 1e-9 * y);
}

/// A wall with books moves everything as one without does, and books the same with two threads.
#[test]
fn books_change_nothing_and_do_not_depend_on_threads() {
    let mut particles = String::new();
    for i in 0..36 {
        for j in 0..36 {
            write!(
                particles,
                "[{:e}, {:e}, 1.001e-3, 1e-3],",
                2.1e-3 * f64::from(i),
                2.1e-3 * f64::from(j)
            )
            .unwrap();
        }
    }
    let text = |loads: &str| {
        format!(
            "{}[bodies.many]\nmaterial = \"stuff\"\nbonds = \"stiff\"\nparticles = [{particles}]\nbond_list = [[0, 1]]\nvelocity = [0.3, 0.2, -0.1]\n\
             [walls.w]\nmaterial = \"stuff\"\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\n{loads}\n",
            head(0.0)
        )
    };
    let run = |loads: &str, threads: usize| {
        let scene = scene(&text(loads));
        let mut state = plan(&scene, read_bodies(&scene).unwrap(), threads, false)
            .unwrap()
            .state;
        state.scratch.worth_a_thread = 0;
        while state.time_s < 1e-3 {
            interact(&mut state);
            advance(&mut state);
        }
        state
    };
    let [without, one, two] =
        [("", 1), (PATCH, 1), (PATCH, 2)].map(|(loads, threads)| run(loads, threads));
    assert_eq!(without.particles.poses, one.particles.poses);
    assert_eq!(without.particles.motions, one.particles.motions);
    assert_eq!(one.walls[0].book, two.walls[0].book);
    assert!(touched(&one).len() > 100);
}

#[test]
fn too_many_patches_are_refused() {
    let plane = "plane = { point = [0, 0, 0], normal = [0, 0, 1] }\n";
    let pin = "cylinder = { from = [0, -0.02, -0.02], to = [0, 0.02, -0.02], radius = 0.02 }\n";
    let messages = [plane, BOX, pin].map(|shape| {
        let refused = |patch: &str| {
            try_planned(&falling(&format!("{shape}loads.patch = \"{patch}\"\n"), "")).err()
        };
        let message = refused("1 um").unwrap().to_string();
        // What the message advises is enough.
        let advised = message.rsplit("such as ").next().unwrap().trim().to_owned();
        assert_eq!(refused(&advised).map(|error| error.to_string()), None);
        assert_eq!(refused("10 m").map(|error| error.to_string()), None);
        message
    });
    assert_eq!(
        messages[1],
        "test.toml: [walls.w]: patches of 1 um divide it into 4.800e9 of them; there can be at most 1e6; give a larger patch, such as 71 um"
    );
}
