//! The neighbour lists hold all that touches, however unevenly bodies move: only what has moved
//! too far is searched for again.

use std::fmt::Write as _;

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::state::State;
use dem_engine::state::events::PopulationEvent;
use dem_engine::state::particles::Pose;
use dem_engine::step::{advance, interact, stages, step};
use dem_physics::geometry::Touch;
use dem_plan::Plan;

use super::again::busy;
use super::{HEAD, MEETS, block, lump, planned};

/// Clumps and a breakable block fall at different speeds into a box with a moving plate, after a
/// sphere ten times as large as theirs. `lump`: the body of a clump with this name and these lines.
fn fall(search: &str, lump: fn(&str, &str) -> String) -> Plan {
    planned(&fall_text(search, lump))
}

fn fall_text(search: &str, lump: fn(&str, &str) -> String) -> String {
    let mut text = format!(
        "{HEAD}run.gravity = [0, 0, -9.81]\n{MEETS}{search}\n\
         bonds.weak = {{ young_modulus = 1e7, poisson_ratio = 0.25, failure = {{ tensile_strength = 1e3, shear_strength = 1e3 }} }}\n\
         [walls.floor]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n\
         [walls.side]\nplane = {{ point = [-0.004, 0, 0], normal = [1, 0, 0] }}\nmaterial = \"stuff\"\n\
         [walls.plate]\nbox = {{ min = [0.03, -0.02, -0.01], max = [0.04, 0.03, 0.05] }}\nmaterial = \"stuff\"\nvelocity = [-0.5, 0, 0]\n\
         [bodies.ball]\nmaterial = \"stuff\"\nparticles = [[0.01, 0.005, 0.0101, 0.01]]\n"
    );
    for n in 0..8_i32 {
        let (x, y, z) = (n % 3, n / 3 % 2, n / 2);
        let more = format!(
            "start_as = \"clump\"\nposition = [{}, {}, {}]\nvelocity = [{}, 0, {}]\nangular_velocity = [0, {}, 0]",
            8e-3 * f64::from(x),
            9e-3 * f64::from(y),
            0.024 + 6e-3 * f64::from(z),
            0.2 * f64::from(x - 1),
            -0.3 * f64::from(n),
            10.0 * f64::from(n),
        );
        write!(text, "{}", lump(&format!("lump{n}"), &more)).unwrap();
    }
    let more = "position = [0.002, 0.002, 0.055]\nvelocity = [0, 0, -1]";
    let brittle = block("brittle", [4, 4, 3], 2e-3, |_| Some(1e-3), more);
    text += &brittle.replace("bonds = \"stiff\"", "bonds = \"weak\"");
    text
}

/// Everything that touches is in the lists. `clusters`: that of each particle before the step.
fn assert_all_listed(state: &State, clusters: &[u32]) {
    let mut particles = state.particles.clone();
    place_all(&state.clumps, &mut particles);
    let (poses, contacts) = (&particles.poses, state.contacts.as_ref().unwrap());
    for (i, a) in poses.iter().enumerate() {
        for (j, b) in poses.iter().enumerate().skip(i + 1) {
            let gap_m = (b.place() - a.place()).norm() - a.radius_m() - b.radius_m();
            if gap_m < 0.0 && clusters[i] != clusters[j] {
                let pair = [i as u32, j as u32];
                let listed = contacts.pairs.binary_search(&pair).is_ok();
                assert!(listed, "{pair:?} at {} s", state.time_s);
                let current = [i, j].map(|i| state.particles.poses[i].place() == poses[i].place());
                assert_eq!(current, [true; 2], "{pair:?} at {} s", state.time_s);
            }
        }
    }
    for wall in &state.walls {
        let touches = |pose: &Pose| {
            let mut found: Vec<Touch> = Vec::new();
            let centre = wall.frame.to_wall(pose.place().into());
            wall.model
                .shape
                .touches(centre, pose.radius_m(), &mut found);
            !found.is_empty()
        };
        for (i, pose) in poses.iter().enumerate().filter(|(_, pose)| touches(pose)) {
            let listed = wall.near.binary_search(&(i as u32)).is_ok();
            assert!(listed, "{i} at {} at {} s", wall.model.name, state.time_s);
            assert_eq!(state.particles.poses[i].place(), pose.place());
        }
    }
}

fn places(state: &State) -> Vec<[f64; 4]> {
    let mut particles = state.particles.clone();
    place_all(&state.clumps, &mut particles);
    particles.poses.iter().map(|pose| pose.position_m).collect()
}

/// A body of 17 spheres of 2 mm: as a clump, its balls follow from its template.
fn large_lump(name: &str, more: &str) -> String {
    let radius = |[x, y, z]: [i32; 3]| {
        let is_there = [x, y, z] != [2, 1, 1];
        is_there.then(|| 1e-3 * (1.0 - 0.02 * f64::from(x) - 0.04 * f64::from(y * z)))
    };
    block(name, [3, 3, 2], 2e-3, radius, more)
}

#[test]
fn what_touches_is_listed_however_unevenly_bodies_move() {
    assert_all_listed_in_a_fall(lump);
}

#[test]
fn what_touches_is_listed_however_unevenly_large_clumps_move() {
    assert_all_listed_in_a_fall(large_lump);
}

/// A wall that moves is listed again before bodies are searched for that stay where others go.
#[test]
fn what_touches_is_listed_when_bodies_only_go() {
    let mut text = fall_text("", large_lump);
    text += "[outlets.exit]\ninside = \"exit\"\n\
             [regions.exit]\nbox = { min = [0.08, -0.1, 0], max = [0.2, 0.1, 0.01] }\n";
    for n in 0..12 {
        let z = 0.012 + 2.2e-3 * f64::from(n);
        writeln!(
            text,
            "[bodies.drop{n}]\nmaterial = \"stuff\"\nvelocity = [0, 0, -1]\nparticles = [[0.1, 0, {z}, 1e-3]]"
        )
        .unwrap();
    }
    let text = text.replace("velocity = [-0.5, 0, 0]", "velocity = [-1, 0, 0]");
    let Plan { mut state, .. } = planned(&text);
    while state.time_s < 0.02 {
        let clusters = state.clusters.as_ref().unwrap().of_particle.clone();
        interact(&mut state);
        assert_all_listed(&state, &clusters);
        advance(&mut state);
    }
    let plate = state.walls.iter().find(|wall| wall.model.name == "plate");
    assert!(plate.is_some_and(|plate| plate.near.len() > 3));
    assert!(state.population.outlets[0].bodies > 5);
}

fn assert_all_listed_in_a_fall(lump: fn(&str, &str) -> String) {
    let Plan { mut state, .. } = fall("", lump);
    let mut most_pairs = 0;
    while state.time_s < 0.05 {
        let clusters = state.clusters.as_ref().unwrap().of_particle.clone();
        interact(&mut state);
        assert_all_listed(&state, &clusters);
        let is_of_clump = |i: u32| i as usize >= state.particles.free;
        let pairs = &state.contacts.as_ref().unwrap().pairs;
        let of_clumps = pairs
            .iter()
            .filter(|[i, j]| is_of_clump(*i) && is_of_clump(*j));
        most_pairs = most_pairs.max(of_clumps.count());
        advance(&mut state);
    }
    assert!(most_pairs > 5, "clumps meet: {most_pairs}");
    let pieces = state.clusters.as_ref().unwrap().living().count();
    assert!(pieces > 12, "the block breaks: {pieces}");
    let mut all = stages().iter();
    let search = all.position(|stage| stage.name == "neighbour search");
    let searched = state.scratch.clock.done(search.unwrap()) as f64 / state.steps as f64;
    let particles = state.particles.len();
    eprintln!("{searched} of {particles} particles searched for in a step");
    // A free particle is searched for again when it has used at least half of the distance that it
    // goes in thirty steps; a clump would use up the rest of its distance in thirty steps.
    assert!(searched > 0.0 && searched < particles as f64 / 9.0);
}

/// What was there keeps its lists when a lump comes, becomes a cluster or a clump, or goes.
#[test]
fn what_touches_is_listed_while_bodies_come_are_replaced_and_go() {
    let Plan { mut state, .. } = busy(1);
    let [mut came, mut replaced, mut restored] = [0; 3];
    let mut searched = 0;
    while state.time_s < 0.25 {
        let clusters = state.clusters.as_ref().unwrap().of_particle.clone();
        interact(&mut state);
        assert_all_listed(&state, &clusters);
        advance(&mut state);
        for event in &state.scratch.events.population {
            match event {
                PopulationEvent::Came { .. } => came += 1,
                PopulationEvent::Replaced { .. } => replaced += 1,
                PopulationEvent::Restored { .. } => restored += 1,
                _ => {}
            }
        }
        let asked = &state.contacts.as_ref().unwrap().scratch.references.balls;
        searched += usize::from(asked.is_empty());
    }
    let left = state.population.outlets[0].bodies;
    assert!(
        came > 20 && replaced > 10 && restored > 3 && left > 3,
        "{came} {replaced} {restored} {left}"
    );
    assert_eq!(searched, 0, "nothing asks for a search of all");
}

/// The same if all neighbours are to be searched for anyway when bodies come and go.
#[test]
fn lists_of_walls_follow_where_all_is_searched_for() {
    let Plan { mut state, .. } = busy(1);
    while state.time_s < 0.1 {
        let clusters = state.clusters.as_ref().unwrap().of_particle.clone();
        interact(&mut state);
        assert_all_listed(&state, &clusters);
        let contacts = state.contacts.as_mut().unwrap();
        contacts.scratch.references.balls.clear();
        advance(&mut state);
    }
    assert!(state.population.outlets[0].bodies > 0);
}

#[test]
fn the_size_of_the_skin_changes_no_bit() {
    let end = |search: &str| {
        let Plan { mut state, .. } = fall(search, lump);
        while state.time_s < 0.04 {
            step(&mut state);
        }
        let pieces = state.clusters.as_ref().unwrap().living().count();
        (places(&state), pieces)
    };
    let one = end("");
    assert!(one.1 > 10, "the block breaks: {}", one.1);
    for skin in [0.01, 0.1, 1.0] {
        assert!(one == end(&format!("search.skin = {skin}")), "{skin}");
    }
}
