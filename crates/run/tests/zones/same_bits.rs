//! The same bits as a bonded body or the motion of a clump, with any number of threads, and after
//! an interruption.

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{interact, step};
use dem_plan::Plan;
use dem_runner::Progress;
use dem_runner::snapshot::{Snapshot, fingerprint};
use nalgebra::Vector3;

use super::{EVERYWHERE, FLIES, NOWHERE, TOP, disturb, flying, lump, rigid};
use crate::clumps::{HEAD, MEETS};
use crate::helpers::planned;

const FLOOR: &str =
    "[walls.floor]\nplane = { point = [0, 0, 0.299], normal = [0, 0, 1] }\nmaterial = \"stuff\"\n";

fn same(one: &State, other: &State) -> bool {
    one.particles.poses == other.particles.poses
        && one.particles.motions == other.particles.motions
        && one.rigid_parts == other.rigid_parts
        && one.population.bond_steps == other.population.bond_steps
        && one.ledger == other.ledger
}

#[test]
fn a_zone_around_all_of_a_body_gives_the_bits_of_a_bonded_body() {
    let text = |zone: &str| {
        format!(
            "{HEAD}{MEETS}{}{FLOOR}[regions.zone]\nbox = {{ min = [-9, -9, -9], max = [9, 9, 9] }}\n",
            lump(&format!("{}{zone}", FLIES.replace(", 3]", ", -3]")))
        )
    };
    let mut bonded = planned(&text("")).state;
    let mut zone = planned(&text("bonded_within = { region = \"zone\" }\n")).state;
    assert_eq!(rigid(&zone), 0);
    for _ in 0..3000 {
        step(&mut bonded);
        step(&mut zone);
    }
    assert!(
        bonded.walls[0].work_j != 0.0
            || !bonded.walls[0].touching.is_empty()
            || bonded.particles.motions[0].velocity_m_s[2] > 0.0
    );
    assert!(bonded.particles.poses == zone.particles.poses);
    assert!(bonded.particles.motions == zone.particles.motions);
    assert_eq!(bonded.ledger, zone.ledger);
}

#[test]
fn a_zone_that_contains_nothing_gives_the_motion_of_a_clump() {
    let text = |more: &str, contact: &str| {
        let down = FLIES.replace(", 3]", ", -3]");
        format!("{HEAD}{contact}{}{FLOOR}[regions.zone]\nbox = {{ min = [8, 8, 8], max = [9, 9, 9] }}\n", lump(&format!("{down}{more}")))
            .replace("run.end_time = 1", "run = { end_time = 1, time_step = 2e-7 }")
    };
    // Without damping, which takes the mass of a clump in place of that of a sphere.
    let contact = "contacts.stuff-stuff = { restitution = 1, friction = 0 }\n";
    let mut clump = planned(&text("start_as = \"clump\"\n", contact)).state;
    let mut part = planned(&text("bonded_within = { region = \"zone\" }\n", contact)).state;
    assert_eq!((rigid(&part), part.rigid_parts.all.len()), (54, 1));
    let mut rises = false;
    for _ in 0..10_000 {
        step(&mut clump);
        step(&mut part);
        rises |= clump.clumps.all[0].velocity_m_s[2] > 1.0;
    }
    let (clump, part) = (&clump.clumps.all[0], &part.rigid_parts.all[0]);
    assert!(rises);
    let off = |a: [f64; 3], b: [f64; 3]| (Vector3::from(a) - Vector3::from(b)).norm();
    let found = [
        off(clump.place_m, part.place_m) / 2e-3,
        off(clump.velocity_m_s, part.velocity_m_s) / 3.0,
        off(clump.angular_momentum, part.angular_momentum)
            / Vector3::from(part.angular_momentum).norm(),
    ];
    eprintln!("{found:?}");
    assert!(found.iter().all(|off| *off < 1e-8), "{found:?}");
}

const MOVES: &str =
    ", moves_with = \"blade\", rejoin = { strain_energy = 10, fluctuation_velocity = 0.5 }";

#[test]
fn threads_and_interruptions_do_not_change_a_bit() {
    let with = |threads: usize| {
        let mut plan = flying(TOP, MOVES);
        let state = &mut plan.state;
        disturb(state, 0.05);
        state.scratch.threads = threads;
        state.scratch.worth_a_thread = 0;
        state.divide();
        let count = state.particles.len();
        if let Some(contacts) = &mut state.contacts {
            contacts.divide(count, threads);
        }
        plan
    };
    let plan = with(1);
    let number = fingerprint(&plan.state).unwrap();
    let Plan {
        mut state, bodies, ..
    } = plan.clone();
    let mut three = with(3).state;
    let mut kept = Vec::new();
    for n in 0..4000 {
        if [1, 777, 2000, 2051].contains(&n) {
            let progress = Progress::default();
            let snapshot =
                Snapshot::taken(&state, &bodies, String::new(), number, Vec::new(), progress);
            kept.push(snapshot.to_bytes().unwrap());
        }
        step(&mut state);
        step(&mut three);
    }
    assert!(state.rigid_parts.rejoined > 0);
    assert!(same(&state, &three));
    for bytes in kept {
        let Plan {
            state: mut again,
            bodies: mut again_bodies,
            ..
        } = with(2);
        Snapshot::from_bytes(&bytes)
            .unwrap()
            .restore(number, &mut again, &mut again_bodies)
            .unwrap();
        while again.steps < state.steps {
            step(&mut again);
        }
        assert!(same(&state, &again));
    }
}

#[test]
fn bonds_within_rigid_parts_are_not_computed() {
    let run = |corners| {
        let mut state = flying(corners, "").state;
        for _ in 0..100 {
            step(&mut state);
        }
        interact(&mut state);
        (
            state.population.bond_steps,
            balance(&mut state).energy_error,
        )
    };
    let ([all, none], _) = run(EVERYWHERE);
    let ([done, skipped], error) = run(TOP);
    let ([nothing, every], _) = run(NOWHERE);
    eprintln!("bonded {all}, layer {done} and {skipped}, error {error:e}");
    assert_eq!((none, done + skipped), (0, all));
    assert_eq!((nothing, every), (0, all));
    assert!(3 * skipped > all && error.abs() < 1e-9);
}
