//! The same bits for any number of threads, and after any interruption.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::state::State;
use dem_engine::state::partitions::divide;
use dem_plan::Plan;
use dem_runner::Progress;
use dem_runner::snapshot::{Snapshot, fingerprint};
use rayon::prelude::*;

use super::riding::belts;
use super::{CLUMP, GROUND, SLEEP, ball, go, go_until, head, planned, slab, sleep};

/// A sleeping pile, a ball that slowly rolls up to it, and one that falls from above.
fn pile(threads: usize) -> Plan {
    let low = slab("low", [0.0, 0.0, 0.0], CLUMP);
    let middle = slab("middle", [0.0, 0.0, 2e-3], "");
    let beside = slab("beside", [6e-3, 0.0, 0.0], "");
    let roller = ball("roller", [-4e-3, 1e-3, 0.0], "velocity = [0.04, 0, 0]");
    let faller = ball("faller", [7e-3, 1e-3, 4e-3], "velocity = [0, 0, 0.2]");
    let text = format!(
        "{}search.skin = 0.4\n{low}{middle}{beside}{roller}{faller}{GROUND}{SLEEP}",
        head(0.0)
    );
    divided(planned(&text), threads)
}

fn divided(mut plan: Plan, threads: usize) -> Plan {
    let state = &mut plan.state;
    // Outside this test, this few particles do not justify a second thread.
    state.scratch.threads = threads;
    state.scratch.worth_a_thread = 0;
    state.scratch.partitions = divide(&state.bonds, state.particles.free, threads);
    let count = state.particles.len();
    if let Some(contacts) = &mut state.contacts {
        contacts.divide(count, threads);
    }
    plan
}

/// Riders on a belt, one of them on another one and one bonded, that meet a plate, a resting ball or
/// the end of the belt one after another.
fn belt(threads: usize) -> Plan {
    let mut text = belts("0.3", 30e-3);
    for (n, x_m) in [0.0, 5e-3, 13e-3].into_iter().enumerate() {
        let start = if n == 1 { "" } else { CLUMP };
        let rides = format!("{start}\nvelocity = [0.3, 0, 0]");
        text += &slab(&format!("s{n}"), [x_m, 0.0, 0.0], &rides);
    }
    text += &slab(
        "top",
        [5e-3, 0.0, 2e-3],
        &format!("{CLUMP}\nvelocity = [0.3, 0, 0]"),
    );
    text += &ball("resting", [24e-3, 3.25e-3, 1e-3], "");
    divided(planned(&format!("{text}{SLEEP}")), threads)
}

/// All data that a run continues from or reports.
fn same(a: &State, b: &State) -> bool {
    let mut states = [a.clone(), b.clone()];
    for state in &mut states {
        place_all(&state.clumps, &mut state.particles);
    }
    let [a, b] = &states;
    let walls = |s: &State| {
        let all = s.walls.iter();
        all.map(|w| {
            (
                w.touching.clone(),
                w.push,
                w.load_by_sleepers,
                w.friction_j,
                w.damping_j,
                w.work_j,
                w.ridden,
            )
        })
        .collect::<Vec<_>>()
    };
    let kept = |s: &State| {
        let sleep = sleep(s);
        (
            sleep.of_cluster.clone(),
            sleep.riders.clone(),
            sleep.pairs.clone(),
            sleep.touches.clone(),
            sleep.particle_steps,
        )
    };
    let clumps = |s: &State| {
        let all = s.clumps.all.iter();
        all.map(|c| {
            (
                c.place_m,
                c.turned,
                c.velocity_m_s,
                c.angular_momentum,
                c.asleep,
            )
        })
        .collect::<Vec<_>>()
    };
    let free = a.particles.free;
    a.steps == b.steps
        && a.particles.poses == b.particles.poses
        && a.particles.motions[..free] == b.particles.motions[..free]
        && clumps(a) == clumps(b)
        && a.ledger == b.ledger
        && walls(a) == walls(b)
        && kept(a) == kept(b)
}

const END_S: f64 = 0.12;

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for scene in [pile, belt] {
        let mut one = scene(1).state;
        let mut three = scene(3).state;
        let mut asleep = 0;
        while one.time_s < END_S {
            go(&mut one);
            go(&mut three);
            asleep += sleep(&one).bodies;
        }
        assert!(asleep > 0);
        assert!(same(&one, &three));
    }
}

#[test]
fn an_interruption_changes_nothing() {
    goes_on_after_interruptions(pile);
}

#[test]
fn an_interruption_of_a_ride_changes_nothing() {
    let riders = goes_on_after_interruptions(belt);
    assert!(riders >= 10, "{riders}");
}

/// Returns the number of interruptions at which somebody rode.
fn goes_on_after_interruptions(scene: fn(usize) -> Plan) -> usize {
    let mut state = scene(1).state;
    let mut shots = Vec::new();
    let bodies = scene(1).bodies;
    let print = fingerprint(&scene(1).state).unwrap();
    let mut riding = 0;
    let (mut awake, mut next) = (0, 0);
    while state.time_s < END_S {
        go(&mut state);
        let woke = state
            .scratch
            .events
            .sleep
            .iter()
            .any(|news| news.kind == "awake");
        awake += usize::from(woke);
        let fell = state
            .scratch
            .events
            .sleep
            .iter()
            .any(|news| news.kind == "asleep");
        if state.steps >= next || woke || fell {
            next = state.steps + 1 + state.steps % 37 + (END_S / state.time_step_s / 20.0) as u64;
            let shot = Snapshot::taken(
                &state,
                &bodies,
                String::new(),
                print,
                Vec::new(),
                Progress::default(),
            );
            shots.push(shot.to_bytes().unwrap());
            riding += usize::from(!sleep(&state).riders.is_empty());
        }
    }
    assert!(awake >= 2, "{awake}");
    eprintln!(
        "{} snapshots, {awake} wakings, {} steps",
        shots.len(),
        state.steps
    );
    shots.par_iter().for_each(|bytes| {
        let Plan {
            state: mut again,
            mut bodies,
            ..
        } = scene(2);
        let snapshot = Snapshot::from_bytes(bytes).unwrap();
        snapshot.restore(print, &mut again, &mut bodies).unwrap();
        let from = again.steps;
        go_until(&mut again, END_S);
        assert!(same(&state, &again), "from step {from}");
    });
    riding
}
