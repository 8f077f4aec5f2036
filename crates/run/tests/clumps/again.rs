//! The same bits for any number of threads, and after any interruption.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clumps::Clump;
use dem_engine::state::partitions::divide;
use dem_plan::Plan;
use dem_runner::Progress;
use dem_runner::snapshot::{Snapshot, fingerprint};

use super::books::feed;
use super::{go, planned};

/// Lumps that are fed rapidly, wait for each other, break, and are removed.
pub(crate) fn busy(threads: usize) -> Plan {
    let text = feed(0.5, "box = { min = [-1, -1, -1], max = [1, 1, -0.01] }")
        .replace("rate = 60", "rate = 400")
        .replace("min = [-1, -1, -1], max = [1, 1, 0.014]", "min = [-1, -1, 2e-3], max = [1, 1, 0.014]")
        .replace("when = { enters = \"low\" }", "when = { enters = \"low\" }\nrestore = { leaves = \"low\", min_particles = 2, strain_energy = 10, fluctuation_velocity = 0.05 }")
        .replace(
            "1e7, damping",
            "1e7, failure = { tensile_strength = 1e4, shear_strength = 1e4, weibull_modulus = 5 }, damping",
        );
    let mut plan = planned(&text);
    let state = &mut plan.state;
    // A scene may not make rigid what moves as fast as here.
    for rule in state.model.rules.restores.iter_mut().flatten() {
        rule.inner_speed_m_s = 1.0;
    }
    // Outside this test, this few particles do not justify a second thread.
    state.scratch.threads = threads;
    state.scratch.worth_a_thread = 0;
    state.scratch.partitions = divide(&state.bonds, state.particles.free, threads);
    let count = state.particles.len();
    if let Some(contacts) = &mut state.contacts {
        contacts.divide(count, threads);
    }
    state.time_step_s = 4e-6;
    plan
}

/// All data that a run continues from or reports.
pub(crate) fn same(a: &State, b: &State) -> bool {
    let rules = |s: &State| {
        (
            s.population.inlets.clone(),
            s.population.outlets.clone(),
            s.population.instances,
            s.population.replaced,
            s.population.bond_steps,
        )
    };
    let contacts = |s: &State| {
        let c = s.contacts.as_ref().unwrap();
        (c.lost_j.clone(), c.lost_by_removed_j, c.materials.clone())
    };
    let walls = |s: &State| {
        let all = s.walls.iter();
        all.map(|w| (w.touching.clone(), w.push, w.friction_j, w.damping_j))
            .collect::<Vec<_>>()
    };
    // Spheres of clumps without near objects are only placed on demand; which clumps have near
    // objects depends on the last search.
    let poses = |s: &State| {
        let mut particles = s.particles.clone();
        place_all(&s.clumps, &mut particles);
        particles.poses
    };
    let clumps = |s: &State| -> Vec<Clump> {
        let all = s.clumps.all.iter();
        all.map(|clump| Clump {
            near: [0; 2],
            ..*clump
        })
        .collect()
    };
    let motions = |s: &State| s.particles.motions[..s.particles.free].to_vec();
    poses(a) == poses(b)
        && motions(a) == motions(b)
        && a.particles.free == b.particles.free
        && clumps(a) == clumps(b)
        && a.bonds.ends == b.bonds.ends
        && a.bonds.blocks == b.bonds.blocks
        && a.bonds.strength_factors == b.bonds.strength_factors
        && a.broken_count == b.broken_count
        && a.broken_removed == b.broken_removed
        && rules(a) == rules(b)
        && contacts(a) == contacts(b)
        && walls(a) == walls(b)
        && a.clusters.as_ref().unwrap().history == b.clusters.as_ref().unwrap().history
        && a.clusters.as_ref().unwrap().of_particle == b.clusters.as_ref().unwrap().of_particle
}

#[test]
fn one_thread_and_more_give_the_same_bits() {
    let all = [1, 2, 3].map(|threads| {
        let Plan {
            mut state,
            mut bodies,
            ..
        } = busy(threads);
        while state.time_s < 0.1 {
            go(&mut state, &mut bodies);
        }
        (state, bodies)
    });
    let (one, bodies) = &all[0];
    let waited = one.population.inlets[0].delayed;
    eprintln!(
        "{} came, {waited} waited, {} replaced, {} bonds broken, {:?} gone",
        one.population.inlets[0].bodies,
        one.population.replaced,
        one.broken_count,
        one.population.outlets[0]
    );
    assert!(waited > 0 && one.population.replaced > 5 && one.broken_count > 10);
    assert!(one.population.outlets[0].bodies > 5);
    for (other, other_bodies) in &all[1..] {
        assert!(same(one, other) && bodies == other_bodies);
        assert_eq!(one.ledger, other.ledger);
    }
}

fn taken(state: &State, bodies: &[PlacedBody], fingerprint: u64) -> Vec<u8> {
    let progress = Progress::default();
    Snapshot::taken(
        state,
        bodies,
        String::new(),
        fingerprint,
        Vec::new(),
        progress,
    )
    .to_bytes()
    .unwrap()
}

#[test]
fn a_run_taken_up_again_at_any_moment_goes_on_to_the_same_bits() {
    let plan = busy(2);
    let number = fingerprint(&plan.state).unwrap();
    let Plan {
        mut state,
        mut bodies,
        ..
    } = plan.clone();
    let to_end = ["an inlet waits", "after something has gone"];
    let mut moments: Vec<(u64, Vec<u8>, &str)> = Vec::new();
    let mut kept: Vec<State> = Vec::new();
    let (mut waiting, mut swaps, mut gone) = (false, 0, 0);
    while state.time_s < 0.08 {
        let before = (
            state.population.replaced,
            state.population.outlets[0].bodies,
        );
        let early = taken_before_swap(&state, &bodies, number, swaps);
        go(&mut state, &mut bodies);
        if state.steps.is_multiple_of(500) {
            kept.push(state.clone());
        }
        let come = &state.population.inlets[0];
        let mut take = |why| moments.push((state.steps, taken(&state, &bodies, number), why));
        if come.tries > 0 && !waiting {
            waiting = true;
            take("an inlet waits");
        }
        if state.population.replaced > before.0 {
            swaps += 1;
            if [1, 4, 8].contains(&swaps) {
                take("after a swap");
                moments.extend(early.map(|bytes| (state.steps - 1, bytes, "before a swap")));
            }
        } else if state.population.outlets[0].bodies > before.1 {
            gone += 1;
            if gone == 2 {
                take("after something has gone");
            }
        } else if state.steps % 4000 == 1000 {
            take("between");
        }
    }
    eprintln!(
        "{:?}",
        moments
            .iter()
            .map(|(at, _, why)| (*at, *why))
            .collect::<Vec<_>>()
    );
    assert!(waiting && swaps > 5 && gone > 2);
    for (at, bytes, why) in &moments {
        let Plan {
            state: mut again,
            bodies: mut again_bodies,
            ..
        } = plan.clone();
        let snapshot = Snapshot::from_bytes(bytes).unwrap();
        snapshot
            .restore(number, &mut again, &mut again_bodies)
            .unwrap();
        assert_eq!(again.steps, *at);
        // Some to the end, and the others past the next event.
        let last = if to_end.contains(why) {
            u64::MAX
        } else {
            at + 1500
        };
        let wanted = kept
            .iter()
            .find(|state| state.steps >= last)
            .unwrap_or(&state);
        while again.steps < wanted.steps {
            go(&mut again, &mut again_bodies);
        }
        assert!(same(wanted, &again), "{why}, step {at}");
        assert_eq!(wanted.ledger, again.ledger, "{why}, step {at}");
        if wanted.steps == state.steps {
            assert_eq!(bodies, again_bodies, "{why}, step {at}");
        }
    }
}

/// At every step near those in which something is replaced, including steps before it.
fn taken_before_swap(
    state: &State,
    bodies: &[PlacedBody],
    number: u64,
    swaps: u32,
) -> Option<Vec<u8>> {
    let low = 0.0145;
    let soon = |place: [f64; 3]| place[2] < low;
    let is_near = [0, 3, 7].contains(&swaps) && state.clumps.all.iter().any(|c| soon(c.place_m));
    is_near.then(|| taken(state, bodies, number))
}
