//! Bodies come, go and are replaced while others take longer steps.

use std::path::Path;

use dem_run::plan::plan;
use dem_run::state::State;
use dem_run::state::events::PopulationEvent;
use dem_run::step::{advance, interact, step};
use dem_scene::read_bodies;

use super::{CONTACTS, PLATE, errors, head, levels, pair, planned};

/// Soft pairs come as clumps through an inlet, become bonded below 8 mm, bounce on a belt, become
/// clumps again above 8 mm, and leave the room. A hard pair that falls beside them sets the step.
pub(super) fn text(end_s: f64) -> String {
    let soft = pair("grain", "soft", [0.0; 3], [0.0; 3])
        .replace("velocity = [0.0, 0.0, 0.0]\n", "")
        + "start_as = \"clump\"\n";
    head(&format!(
        "run.end_time = {end_s}\nrun.gravity = [0, 0, -9.81]\nrun.safety_factor = 0.3"
    )) + CONTACTS
        + PLATE
        + "surface_velocity = [0.1, 0, 0]\n"
        + &pair("a", "hard", [-20e-3, 0.0, 18e-3], [0.0; 3])
        + &soft
        + "[regions]
gate.box = { min = [-2e-3, -2e-3, 10e-3], max = [2e-3, 2e-3, 14e-3] }
low.box = { min = [-1, -1, -1], max = [1, 1, 8e-3] }
room.box = { min = [-0.03, -0.03, -0.01], max = [0.03, 0.03, 0.02] }
[inlets.feed]
bodies = [\"grain\"]
region = \"gate\"
rate = 400
velocity = [1, 0, -1]
angular_velocity = [0, 20, 0]
orientation = \"random\"
[outlets.out]
outside = \"room\"
[replacement.grain]
when = { enters = \"low\" }
restore = { leaves = \"low\", min_particles = 2, strain_energy = 0.1, fluctuation_velocity = 0.1 }
"
}

/// What happened to bodies.
#[derive(Debug, Default, PartialEq)]
struct Happened {
    came: usize,
    left: usize,
    replaced: usize,
    restored: usize,
}

impl Happened {
    fn note(&mut self, state: &State) {
        for event in &state.scratch.events.population {
            match event {
                PopulationEvent::Came { .. } => self.came += 1,
                PopulationEvent::Left { .. } => self.left += 1,
                PopulationEvent::Replaced { .. } => self.replaced += 1,
                PopulationEvent::Restored { .. } => self.restored += 1,
                _ => {}
            }
        }
    }
}

/// Levels of the particles of a cluster.
fn levels_of(state: &State, cluster: u32) -> Vec<u8> {
    let ids = &state.clusters.as_ref().unwrap().of_particle;
    let both = ids.iter().zip(levels(state));
    both.filter(|(id, _)| **id == cluster)
        .map(|(_, level)| *level)
        .collect()
}

#[test]
fn what_comes_goes_and_is_replaced_is_booked() {
    let mut state = planned(&text(0.05)).state;
    let mut happened = Happened::default();
    let mut largest = [0.0_f64; 3];
    let mut long_before = 0;
    let mut longest_bonded = 0;
    while state.time_s < 0.05 {
        interact(&mut state);
        let errors = errors(&mut state);
        largest = [0, 1, 2].map(|k| largest[k].max(errors[k]));
        let own = levels(&state).to_vec();
        long_before += usize::from(
            state
                .clumps
                .all
                .iter()
                .any(|clump| own[clump.first as usize] > 0),
        );
        longest_bonded = longest_bonded.max(
            own[2..state.particles.free]
                .iter()
                .copied()
                .max()
                .unwrap_or(0),
        );
        advance(&mut state);
        happened.note(&state);
        for event in &state.scratch.events.population {
            if let PopulationEvent::Replaced { cluster, .. } = event {
                assert_eq!(levels_of(&state, *cluster), [0; 2]);
            }
        }
    }
    assert!(happened.came >= 15 && happened.left >= 3, "{happened:?}");
    assert!(
        happened.replaced >= 10 && happened.restored >= 3,
        "{happened:?}"
    );
    // They took longer steps as clumps, and as clusters.
    assert!(
        long_before > 100 && longest_bonded > 1,
        "{long_before} {longest_bonded}"
    );
    assert!(largest[0] < 2e-3, "{largest:?}");
    assert!(largest[1] < 1e-11 && largest[2] < 1e-11, "{largest:?}");
}

#[test]
fn two_threads_give_the_bits_of_one() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/scenes/mixed-feed.toml"
    );
    let scene = dem_scene::read_scene(Path::new(path), &[]).unwrap();
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let bodies = read_bodies(&scene).unwrap();
            let mut state = plan(&scene, bodies, threads, false).unwrap().state;
            assert_eq!(state.scratch.threads, threads);
            while state.time_s < 0.04 {
                step(&mut state);
            }
            state
        })
    });
    assert!(one.population.replaced > 5);
    assert_eq!(one.particles.poses, two.particles.poses);
    assert_eq!(one.particles.motions, two.particles.motions);
    assert_eq!(one.clumps.all, two.clumps.all);
    assert_eq!(one.ledger, two.ledger);
}

/// What comes is of one kind, and no step can be longer: single spheres, or bonded pairs.
#[test]
fn where_nothing_that_comes_can_take_longer_steps_nothing_changes() {
    let single = "[bodies.grain]\nmaterial = \"soft\"\nparticles = [[0, 0, 0, 1e-3]]\n";
    let bonded =
        pair("grain", "soft", [0.0; 3], [0.0; 3]).replace("velocity = [0.0, 0.0, 0.0]\n", "");
    for body in [single, &bonded] {
        let fed = format!(
            "{body}[regions.gate]\nbox = {{ min = [0, 0, 0.01], max = [0.01, 0.01, 0.02] }}
[inlets.feed]\nbodies = [\"grain\"]\nregion = \"gate\"\nrate = 400\nvelocity = [0, 0, -1]\n"
        );
        let gravity = "run.end_time = 0.02\nrun.gravity = [0, 0, -9.81]";
        let alone = head(gravity) + CONTACTS + PLATE + &fed;
        assert!(planned(&alone).state.levels.is_none(), "{body}");
        // Beside a hard pair they can take longer ones.
        let hard = pair("a", "hard", [0.1, 0.0, 0.01], [0.0; 3]);
        let mut state = planned(&(head(gravity) + CONTACTS + PLATE + &hard + &fed)).state;
        let mut largest = 0.0_f64;
        let mut longest = 0;
        while state.time_s < 0.02 {
            interact(&mut state);
            largest = largest.max(errors(&mut state)[0]);
            longest = longest.max(levels(&state)[2..].iter().copied().max().unwrap_or(0));
            advance(&mut state);
        }
        assert!(
            longest > 0 && largest < 4e-3,
            "{longest} {largest:e} {body}"
        );
    }
}
