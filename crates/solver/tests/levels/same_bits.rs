//! The same bits without steps by body where none can be longer, for any number of threads, and
//! after an interruption.

use std::fs;

use dem_results::checkpoint::read_checkpoint;
use dem_results::{Existing, ResultsFolder};
use dem_run::plan::{Plan, plan};
use dem_run::run::snapshot::Snapshot;
use dem_run::state::State;
use dem_run::step::step;
use dem_scene::{Scene, read_bodies, scene_from_text};

use super::{CONTACTS, PLATE, exchange, head, pair, planned};
use crate::fragments::run_into;

/// A particle of the second cake.
const IN_B: usize = 700;

/// Three cakes that fly and fall onto a plate on its way up, one of them hard, and two as rigid
/// clumps, of which one falls onto the other.
fn cakes(end_s: f64) -> String {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/bodies/cake.vtp");
    let cake = |name: &str, kind: &str, x_m: f64, speed_m_s: f64| {
        format!(
            "[bodies.{name}]\nfile = \"{file}\"\nmaterial = \"{kind}\"\nbonds = \"{kind}\"\n\
             position = [{x_m}, 0, 1e-3]\nvelocity = [{speed_m_s}, 0, -1]\n"
        )
    };
    let clump = |name: &str, z_m: f64, speed_m_s: f64| {
        format!(
            "[bodies.{name}]\nfile = \"{file}\"\nmaterial = \"soft\"\nstart_as = \"clump\"\n\
             position = [0.4, 0, {z_m}]\nvelocity = [0, 0, {speed_m_s}]\n"
        )
    };
    head(&format!(
        "run.end_time = {end_s}\nrun.gravity = [0, 0, -9.81]"
    )) + CONTACTS
        + PLATE
        + "velocity = [0, 0, 0.05]\n"
        + &cake("a", "soft", 0.0, 0.0)
        + &cake("b", "soft", 0.13, 0.0)
        + &cake("c", "hard", 0.26, -4.0)
        + &clump("d", 1e-3, -1.0)
        + &clump("e", 34e-3, -1.4)
}

#[test]
fn two_threads_give_the_bits_of_one() {
    let text = cakes(5e-3);
    let ends = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let scene = crate::helpers::scene(&text);
            let mut state = plan(&scene, read_bodies(&scene).unwrap(), threads, false)
                .unwrap()
                .state;
            let mut levels = Vec::new();
            while state.time_s < 5e-3 {
                step(&mut state);
                levels.push(super::levels(&state)[IN_B]);
            }
            (state, levels)
        })
    });
    let [(one, levels), (two, _)] = &ends;
    assert_eq!(one.particles.poses, two.particles.poses);
    assert_eq!(one.particles.motions, two.particles.motions);
    assert_eq!(one.clumps.all, two.clumps.all);
    assert_eq!(one.ledger, two.ledger);
    let impact_j = one.clumps.all.iter().map(|clump| clump.impact_energy_j);
    assert!(impact_j.fold(f64::INFINITY, f64::min) > 0.0);
    // They were apart and came together.
    assert!(levels.contains(&0) && levels.iter().any(|level| *level > 1));
}

/// Bodies of equal limits: nothing differs, and nothing is stored.
#[test]
fn where_no_step_can_be_longer_nothing_changes() {
    let text = head("run.end_time = 1e-3")
        + CONTACTS
        + &pair("a", "hard", [0.0; 3], [1.0, 0.0, 0.0])
        + &pair("b", "hard", [8e-3, 0.0, 0.0], [0.0; 3]);
    let off = text.replace("run.steps_by_body = true", "");
    let [on, off] = [text, off].map(|text| {
        let mut state: State = planned(&text).state;
        assert!(state.levels.is_none());
        while state.time_s < 1e-3 {
            step(&mut state);
        }
        state
    });
    assert_eq!(on.particles.poses, off.particles.poses);
    assert_eq!(on.steps, off.steps);
}

fn planned_of(scene: &Scene) -> Plan {
    plan(scene, read_bodies(scene).unwrap(), 1, false).unwrap()
}

#[test]
fn after_an_interruption_the_results_are_the_same_bytes() {
    let cakes = cakes(4e-3) + "[output]\nseries = 1e-4\nframes = 1e-3\n";
    are_the_same_bytes(&cakes);
    let coming_and_going = exchange::text(0.03) + "[output]\nseries = 1e-4\nframes = 7.5e-3\n";
    are_the_same_bytes(&coming_and_going);
}

/// Runs a scene of four frames at once, and with two interruptions.
fn are_the_same_bytes(text: &str) {
    let scene = scene_from_text(text, "test.toml", &[]).unwrap();
    let parent = tempfile::tempdir().unwrap();
    let [whole, parted] = ["whole", "parted"].map(|name| parent.path().join(name));
    let of_whole = ResultsFolder::create(&whole, Existing::Refuse).unwrap();
    run_into(&of_whole, planned_of(&scene), &scene, None, 2.0).unwrap();
    // In flight, and where the bodies are about to meet.
    let folder = ResultsFolder::create(&parted, Existing::Refuse).unwrap();
    run_into(&folder, planned_of(&scene), &scene, None, 0.2).unwrap_err();
    drop(folder);
    for stop_at in [0.6, 2.0] {
        let folder = ResultsFolder::create(&parted, Existing::Continue).unwrap();
        let snapshot = read_checkpoint(&folder.checkpoint()).unwrap();
        let snapshot = Snapshot::from_bytes(&snapshot).unwrap();
        let ended = run_into(&folder, planned_of(&scene), &scene, Some(snapshot), stop_at);
        assert_eq!(ended.is_ok(), stop_at > 1.0);
    }
    for name in ["series.csv", "events.csv", "frames/frame_000004.vtp"] {
        let [one, other] = [&whole, &parted].map(|at| fs::read(at.join(name)).unwrap());
        assert!(one == other, "{name}");
    }
}
