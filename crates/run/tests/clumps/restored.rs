//! Clusters and fragments that become rigid clumps again: conserved quantities, recorded losses,
//! and retained data.

use dem_engine::stages::bonds::energy_kernel::elastic_energy;
use dem_engine::stages::clumps::restoring::restore_clumps;
use dem_engine::stages::population::change::apply_topology_change;
use dem_engine::state::State;
use dem_engine::state::events::PopulationEvent;
use dem_engine::state::events::TopologyChange;
use dem_engine::step::{exchange, interact, step};
use dem_physics::rotation::{numbers, rotation};
use nalgebra::{UnitQuaternion, Vector3};

use super::books::{booked, feed};
use super::{HEAD, Whole, lump, planned};

/// A lump that flies and spins, is replaced at once, and may become rigid again anywhere.
fn flying() -> State {
    flying_with(HEAD)
}

/// The same with another head of the scene.
fn flying_with(head: &str) -> State {
    let body = lump(
        "lump",
        "start_as = \"clump\"\nposition = [0.1, 0.2, 0.3]\nvelocity = [1, -2, 3]\nangular_velocity = [20, -30, 10]",
    );
    let mut state = planned(&format!(
        "{head}{body}[replacement.lump]\nwhen = {{ time = 0 }}\n\
         restore = {{ leaves = \"far\", min_particles = 2, strain_energy = 1e3, fluctuation_velocity = 10 }}\n\
         [regions.far]\nbox = {{ min = [10, 10, 10], max = [11, 11, 11] }}\n"
    ))
    .state;
    interact(&mut state);
    exchange(&mut state);
    assert!(!state.scratch.events.population.is_empty());
    state.steps = 200;
    state
}

fn whole(state: &State) -> Whole {
    Whole::of(&state.particles, 0..state.particles.free, &Vector3::zeros())
}

#[test]
fn a_cluster_swapped_in_and_out_ten_times_does_not_drift() {
    let mut state = flying();
    let start = whole(&state);
    let mut first = None;
    for _ in 0..10 {
        state.scratch.events.population.clear();
        assert_eq!(restore_clumps(&mut state), 1);
        assert!(
            matches!(&state.scratch.events.population[..], [PopulationEvent::Restored { particles: 11, lost_j, .. }] if *lost_j < 1e-12 * start.kinetic_j)
        );
        let clump = state.clumps.all[0];
        // The template of the scene is used again.
        assert_eq!((clump.template, state.clumps.templates.len()), (0, 1));
        let first = first.get_or_insert(clump);
        let close = |a: &[f64], b: &[f64], size: f64| {
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12 * size)
        };
        assert!(close(&clump.place_m, &first.place_m, 1.0));
        assert!(close(&clump.turned, &first.turned, 1.0));
        assert!(close(&clump.velocity_m_s, &first.velocity_m_s, 4.0));
        let size = Vector3::from(first.angular_momentum).norm();
        assert!(close(
            &clump.angular_momentum,
            &first.angular_momentum,
            size
        ));
        let to_clusters = vec![0];
        apply_topology_change(
            &mut state,
            TopologyChange {
                to_clusters,
                ..TopologyChange::default()
            },
        );
    }
    let end = whole(&state);
    assert!((end.centre - start.centre).norm() < 1e-12);
    assert!((end.momentum - start.momentum).norm() < 1e-12 * start.momentum.norm());
    let size = start.mass_kg * 4.0 * 0.4;
    assert!((end.angular_momentum - start.angular_momentum).norm() < 1e-12 * size);
    assert!((end.kinetic_j / start.kinetic_j - 1.0).abs() < 1e-12);
}

#[test]
fn a_fragment_keeps_its_strain_and_its_broken_bonds() {
    let mut state = flying();
    // One bond missing, and a sphere displaced: the rest is still connected.
    state.bonds.set_broken(0);
    let broken = state.bonds.ends[0];
    let aside = Vector3::new(0.0, 2e-6, 0.0);
    let place = state.particles.poses[3].place() + aside;
    state.particles.poses[3].put_at(place.into());
    // It moves with the rigid body at that position.
    let motion = &mut state.particles.motions[3];
    let spin = Vector3::from(motion.spin_rad_s);
    motion.velocity_m_s = (Vector3::from(motion.velocity_m_s) + spin.cross(&aside)).into();
    let (start, strain_j) = (whole(&state), elastic_energy(&state).total());
    let places: Vec<Vector3<f64>> = state
        .particles
        .poses
        .iter()
        .map(dem_engine::state::particles::Pose::place)
        .collect();
    let bonds = state.bonds.len();
    assert!(strain_j > 0.0);
    state.scratch.events.population.clear();
    restore_clumps(&mut state);
    let happened = state.scratch.events.population.clone();
    let [PopulationEvent::Restored { lost_j, .. }] = &happened[..] else {
        panic!("{happened:?}");
    };
    assert!(
        (lost_j / strain_j - 1.0).abs() < 1e-6,
        "{lost_j:e} {strain_j:e}"
    );
    assert_eq!((state.bonds.len(), state.particles.free), (0, 0));
    assert_eq!(
        (state.clumps.all.len(), state.clumps.templates.len()),
        (1, 2)
    );
    let to_clusters = vec![0];
    apply_topology_change(
        &mut state,
        TopologyChange {
            to_clusters,
            ..TopologyChange::default()
        },
    );
    assert_eq!(state.bonds.len(), bonds - 1);
    assert!(!state.bonds.ends.contains(&broken));
    for (pose, place) in state.particles.poses.iter().zip(places) {
        assert!((pose.place() - place).norm() < 1e-15);
    }
    let end = whole(&state);
    assert!((end.momentum - start.momentum).norm() < 1e-12 * start.momentum.norm());
    assert!((end.kinetic_j / start.kinetic_j - 1.0).abs() < 1e-12);
    // Strain is a difference of positions rounded to 1e-16 m, of 2e-6 m.
    assert!((elastic_energy(&state).total() / strain_j - 1.0).abs() < 1e-8);
}

#[test]
fn a_time_does_not_ask_twice() {
    let mut state = flying();
    state.time_step_s = 1e-9;
    for _ in 0..300 {
        step(&mut state);
    }
    assert_eq!(
        (state.population.replaced, state.population.restored),
        (1, 1)
    );
    assert_eq!(state.clumps.all.len(), 1);
}

#[test]
fn books_hold_over_what_becomes_rigid_again() {
    let text = feed(0.5, "box = { min = [-1, -1, -1], max = [1, 1, -0.03] }")
        .replace(
            "min = [-1, -1, -1], max = [1, 1, 0.014]",
            "min = [-1, -1, 0], max = [1, 1, 0.014]",
        )
        .replace(
            "when = { enters = \"low\" }",
            "when = { enters = \"low\" }\nrestore = { leaves = \"low\", min_particles = 2 }",
        );
    let books = [4e-6, 2e-6].map(|step_s| booked(&text, step_s, 0.2));
    for books in &books {
        let restored =
            |happened: &&PopulationEvent| matches!(happened, PopulationEvent::Restored { .. });
        let restored = books.happened.iter().filter(restored).count();
        assert!(restored >= 2, "{restored}");
        assert!(
            books.worst[1] < 1e-11 && books.worst[2] < 1e-11,
            "{:?}",
            books.worst
        );
    }
    let errors = books.each_ref().map(|books| books.worst[0]);
    eprintln!("energy errors {errors:?}");
    assert!(
        errors[1] < 1e-4 && errors[0] > 3.0 * errors[1],
        "{errors:?}"
    );
}

/// Loads that are summed step by step turn with the clump while it is one.
#[test]
fn a_fragment_of_incremental_bonds_turns_their_loads() {
    let head = HEAD.replace(
        "bonds.stiff = { ",
        "bonds.stiff = { formulation = \"incremental\", ",
    );
    let mut state = flying_with(&head);
    state.bonds.set_broken(0);
    for (n, history) in (1..).zip(state.bonds.histories.sums.iter_mut().skip(1)) {
        let n = f64::from(n);
        history.shear_force = 1e-4 * Vector3::new(n, -2.0, 0.5 * n);
        history.moment = 1e-7 * Vector3::new(0.3, n, -n);
    }
    let before = state.bonds.histories.sums.clone();
    restore_clumps(&mut state);
    assert_eq!((state.bonds.len(), state.clumps.all.len()), (0, 1));
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -1.1, 0.7));
    let clump = &mut state.clumps.all[0];
    clump.turned = numbers(&(turn * rotation(clump.turned)));
    let to_clusters = vec![0];
    apply_topology_change(
        &mut state,
        TopologyChange {
            to_clusters,
            ..TopologyChange::default()
        },
    );
    assert_eq!(state.bonds.histories.sums.len(), before.len() - 1);
    for (after, before) in state.bonds.histories.sums.iter().zip(&before[1..]) {
        let pairs = [
            (after.shear_force, before.shear_force),
            (after.moment, before.moment),
        ];
        for (after, before) in pairs {
            assert!(
                (after - turn * before).norm() < 1e-12 * before.norm(),
                "{after} {before}"
            );
        }
    }
}
