//! Mass, momentum, angular momentum and energy are the same before and after a bonded cluster
//! replaces a clump, and the path continues.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::state::State;
use dem_engine::state::events::PopulationEvent;
use dem_engine::step::{drift, exchange, interact};
use dem_physics::rotation::numbers;
use dem_physics::rotation::rotation;
use dem_physics::shape::fit::best_rotation;
use dem_plan::Plan;
use nalgebra::Vector3;
use proptest::prelude::*;

use super::{HEAD, MEETS, Whole, go, lump, planned};
use dem_testing::Random;

/// A lump that becomes a cluster at this time.
fn one(time_s: f64) -> Plan {
    let body = lump("lump", "start_as = \"clump\"");
    planned(&format!(
        "{HEAD}{body}[replacement.lump]\nwhen = {{ time = {time_s} }}"
    ))
}

fn swapped(far_m: f64, seed: u64) {
    let mut state = one(0.0).state;
    let mut random = Random(seed);
    let template = state.clumps.templates[0].clone();
    let clump = &mut state.clumps.all[0];
    clump.place_m = random.point(far_m);
    clump.turned = numbers(&random.rotation());
    let (fast, spin) = (
        10.0_f64.powf(random.within(-3.0, 2.0)),
        random.within(-1.0, 4.0),
    );
    clump.velocity_m_s = random.point(fast);
    clump.angular_momentum = random.point(10.0_f64.powf(spin) * template.moments_kg_m2[0]);
    let before = *clump;
    interact(&mut state);
    exchange(&mut state);
    let (renumbered, happened) = (
        &state.scratch.events.renumberings,
        &state.scratch.events.population,
    );
    let count = template.spheres.len();
    assert_eq!((renumbered.len(), happened.len()), (1, 1));
    assert_eq!(
        (state.particles.free, state.particles.len()),
        (count, count)
    );
    assert_eq!(state.bonds.len(), template.bonds.len());
    assert!(state.clumps.all.is_empty());

    let about = Vector3::from(before.place_m);
    let whole = Whole::of(&state.particles, 0..count, &about);
    // Positions far from the origin are rounded: they are accurate to `eps * far`, a fraction of
    // arms no longer than the reach.
    let fraction = 1e-12 + 2.0 * f64::EPSILON * about.norm() / template.reach_m;
    let spin = before.spin_rad_s(&template);
    let speed = Vector3::from(before.velocity_m_s).norm() + spin.norm() * template.reach_m;
    let mass = template.mass_kg;
    let momentum = Vector3::from(before.velocity_m_s) * mass;
    let kinetic = before.kinetic_j(&template);
    assert!((whole.mass_kg / mass - 1.0).abs() < 1e-13);
    assert!((whole.centre - about).norm() < fraction * template.reach_m);
    assert!((whole.momentum - momentum).norm() < fraction * mass * speed);
    let angular = whole.angular_momentum - Vector3::from(before.angular_momentum);
    assert!(angular.norm() < fraction * mass * speed * template.reach_m);
    assert!((whole.kinetic_j - kinetic).abs() < fraction * mass * speed * speed);
    if far_m <= 1.0 {
        assert!((whole.kinetic_j / kinetic - 1.0).abs() < 1e-12);
        // Also about the origin.
        let origin = Whole::of(&state.particles, 0..count, &Vector3::zeros()).angular_momentum;
        let wanted = about.cross(&momentum) + Vector3::from(before.angular_momentum);
        // The momenta of the spheres cancel, except for rounding.
        let size = (about.norm() + template.reach_m) * mass * speed;
        assert!((origin - wanted).norm() < 1e-12 * size);
    }
    let PopulationEvent::Replaced {
        mass_kg,
        momentum_n_s,
        kinetic_j,
        cause,
        place_m,
        ..
    } = &happened[0]
    else {
        panic!("{happened:?}");
    };
    assert_eq!((*cause, *place_m), ("time", before.place_m));
    assert!((mass_kg[0] / mass_kg[1] - 1.0).abs() < 1e-13);
    assert!((momentum_n_s[0] - momentum_n_s[1]).abs() < fraction * mass * speed);
    assert!((kinetic_j[0] - kinetic_j[1]).abs() < fraction * mass * speed * speed);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn nothing_is_lost_within_a_metre(seed in any::<u64>()) {
        swapped(1.0, seed);
    }

    #[test]
    fn a_kilometre_away_only_digits_of_the_place_are_lost(seed in any::<u64>()) {
        swapped(1e3, seed);
    }
}

#[test]
fn several_bodies_of_several_shapes_are_replaced_in_one_step_and_keep_their_numbers() {
    let at = |x: f64, more: &str| format!("position = [{x}, 0, 0]\nvelocity = [0, {x}, 1]\n{more}");
    let clump = |x: f64| at(x, "start_as = \"clump\"\nangular_velocity = [10, 20, 30]");
    let pair = |name: &str, more: &str| {
        super::block(
            name,
            [2, 1, 1],
            2e-3,
            |[x, ..]| Some(1e-3 * (1.0 - 0.1 * f64::from(x))),
            more,
        )
    };
    let text = [
        HEAD.to_owned(),
        MEETS.to_owned(),
        lump("a", &clump(0.1)),
        pair("b", &clump(0.2)),
        lump("c", &at(0.3, "")),
        pair("d", &clump(0.4)),
        lump("e", &clump(0.5)),
        pair("f", &at(0.6, "")),
        lump("g", &clump(0.7)),
        "[replacement]\n".to_owned(),
        "a.when = { time = 0 }\nb.when = { time = 0 }\n".to_owned(),
        "d.when = { time = 1e-5 }\ng.when = { time = 0 }\n".to_owned(),
    ];
    let Plan {
        mut state,
        mut bodies,
        ..
    } = planned(&text.concat());
    state.time_step_s = 1e-6;
    let start = state.clone();
    let clump_of = |state: &State, name: &str| {
        let is_it = |c: &&dem_engine::state::clumps::Clump| state.clumps.template(c).body == name;
        *state.clumps.all.iter().find(is_it).unwrap()
    };
    let happened = &go(&mut state, &mut bodies).population;
    let replaced: Vec<(&str, u32)> = happened
        .iter()
        .map(|one| match one {
            PopulationEvent::Replaced { body, cluster, .. } => (body.as_str(), *cluster),
            _ => panic!("{one:?}"),
        })
        .collect();
    let wanted = ["a", "b", "g"].map(|name| (name, clump_of(&start, name).cluster));
    assert_eq!(replaced, wanted);
    assert_eq!((state.population.replaced, state.clumps.all.len()), (3, 2));
    assert_eq!(state.particles.free, 11 + 2 + 11 + 2 + 11);
    let clusters = state.clusters.as_ref().unwrap();
    assert_eq!(clusters.history.len(), 7);
    assert!(
        clusters
            .history
            .iter()
            .all(|c| c.parent.is_none() && c.ended_s.is_none())
    );
    for name in ["a", "b", "g"] {
        let was = clump_of(&start, name);
        let template = start.clumps.template(&was);
        let body = bodies.iter().find(|body| body.name == name).unwrap();
        assert_eq!(clusters.members(was.cluster).len(), template.spheres.len());
        for (sphere, &number) in template.file_number.iter().enumerate() {
            let i = body.particles[number as usize];
            assert_eq!(clusters.of_particle[i as usize], was.cluster);
            // It starts at the position of the clump's sphere, and has moved for one step.
            let pose = template.pose(sphere, &was);
            let motion = was.motion(template)(&pose.place());
            let wanted = pose.place() + Vector3::from(motion.velocity_m_s) * 1e-6;
            let found = &state.particles.poses[i as usize];
            assert!((found.place() - wanted).norm() < 1e-15);
            assert_eq!(found.radius_m(), template.spheres[sphere].radius_m);
        }
        let ends = &state.bonds.ends[body.first_bond..][..body.bonds.len()];
        assert!(
            ends.iter()
                .flatten()
                .all(|i| clusters.of_particle[*i as usize] == was.cluster)
        );
    }
    // The others are unchanged.
    place_all(&state.clumps, &mut state.particles);
    for name in ["d", "e"] {
        let (was, is) = (clump_of(&start, name), clump_of(&state, name));
        assert_eq!(
            (was.cluster, was.velocity_m_s),
            (is.cluster, is.velocity_m_s)
        );
        let own = is.first as usize..is.first as usize + clusters.members(is.cluster).len();
        assert!(own.clone().all(|i| clusters.of_particle[i] == is.cluster));
        let moved = Vector3::from(is.place_m) - Vector3::from(was.place_m);
        assert!((moved - Vector3::from(was.velocity_m_s) * 1e-6).norm() < 1e-15);
        let template = state.clumps.template(&is);
        for (i, &sphere) in own.zip(template.outer.iter()) {
            let wanted = template.pose(sphere as usize, &is).place();
            assert!((state.particles.poses[i].place() - wanted).norm() < 1e-15);
        }
    }
    while state.time_s < 2e-5 {
        go(&mut state, &mut bodies);
    }
    assert_eq!((state.population.replaced, state.clumps.all.len()), (4, 1));
}

/// Difference between the path of a body that is replaced on the way and one that never is.
#[test]
fn a_body_that_is_replaced_in_flight_goes_on_as_the_clump_would() {
    let spin = [40.0, -25.0, 60.0];
    let body = |more: &str| {
        let flies = "start_as = \"clump\"\nvelocity = [3, 1, 2]\nangular_velocity = [40, -25, 60]";
        let text = lump("lump", flies);
        let mut plan = planned(&format!("{HEAD}run.gravity = [0, 0, -9.81]\n{text}{more}"));
        plan.state.time_step_s = 4e-7;
        plan.state
    };
    let mut rigid = body("");
    let mut elastic = body("[replacement.lump]\nwhen = { time = 0.01 }");
    let template = rigid.clumps.templates[0].clone();
    let weights: Vec<f64> = template.spheres.iter().map(|s| s.mass_kg).collect();
    let shape: Vec<[f64; 3]> = template.spheres.iter().map(|s| s.place_m).collect();
    let count = shape.len();

    // Upper bound of the sudden load by centrifugal forces on one bond of the body, with a factor
    // of two for its suddenness.
    let omega = Vector3::from(spin).norm();
    let pulled: f64 = template
        .spheres
        .iter()
        .map(|s| 0.5 * s.mass_kg * omega * omega * Vector3::from(s.place_m).norm())
        .sum();
    let thinnest = (0..template.bonds.len()).map(|at| template.bonds.radius_m(at));
    let thinnest = thinnest.fold(f64::INFINITY, f64::min);
    let strain = 2.0 * pulled / (1e9 * std::f64::consts::PI * thinnest * thinnest);

    let (mut centre, mut angle, mut angle_bound) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..100_000 {
        for state in [&mut rigid, &mut elastic] {
            interact(state);
            exchange(state);
        }
        let clump = rigid.clumps.all[0];
        if !elastic.clumps.all.is_empty() {
            assert_eq!(clump, elastic.clumps.all[0]);
        } else if rigid.steps.is_multiple_of(100) {
            let about = Vector3::from(clump.place_m);
            let whole = Whole::of(&elastic.particles, 0..count, &about);
            // Each step rounds positions and velocities of all spheres once.
            let rounds = rigid.steps as f64 * f64::EPSILON;
            let momentum = Vector3::from(clump.velocity_m_s) * template.mass_kg;
            let turning = Vector3::from(clump.angular_momentum).norm();
            centre = centre.max((whole.centre - about).norm() / about.norm());
            assert!((whole.centre - about).norm() < rounds * about.norm());
            assert!((whole.momentum - momentum).norm() < rounds * momentum.norm());
            // Positions are rounded relative to the position of the body, which gives errors in the
            // momentum of each sphere.
            let moved = about.norm() * momentum.norm();
            let angular = whole.angular_momentum - Vector3::from(clump.angular_momentum);
            assert!(angular.norm() < rounds * (moved + turning), "{angular:e}");
            let places: Vec<[f64; 3]> = (0..count)
                .map(|i| (elastic.particles.poses[i].place() - whole.centre).into())
                .collect();
            let found = best_rotation(&shape, &places, &weights);
            let apart = rotation(found).angle_to(&rotation(clump.turned));
            let since = elastic.time_s - 0.01;
            // The error of the inertia is twice the strain, and that of the spin too; in all three
            // directions.
            let bound = 2.0 * 3.0_f64.sqrt() * strain * (1.0 + omega * since);
            assert!(apart < bound, "{apart:e} {bound:e} at {since}");
            (angle, angle_bound) = (angle.max(apart), bound);
        }
        drift(&mut rigid);
        drift(&mut elastic);
    }
    eprintln!(
        "strain {strain:.1e}, centre {centre:.1e}, angle {angle:.1e} of {angle_bound:.1e} after {:.2} turns",
        omega * (elastic.time_s - 0.01) / std::f64::consts::TAU
    );
    assert!(elastic.clumps.all.is_empty());
}
