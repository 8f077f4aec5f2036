//! Bodies are fed at the rates, in the proportions and with the orientations of the scene, and
//! where there is space.

use dem_engine::stages::population::change::apply_topology_change;
use dem_engine::state::State;
use dem_engine::state::bodies::called;
use dem_engine::state::clumps::Clump;
use dem_engine::state::events::{PopulationEvent, TopologyChange};
use dem_engine::step::{drift, exchange, interact, step};
use dem_physics::rotation::rotation;
use nalgebra::Vector3;

use super::again::same;
use super::{HEAD, MEETS, block, go, happens, lump, planned};

const BALL: &str = "[bodies.ball]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0, 1e-3]]\n";
/// Wide enough that no body waits.
const WIDE: &str = "[regions.gate]\nbox = { min = [-50, -50, -50], max = [50, 50, 50] }\n";

/// A scene without contacts, with a large time step.
fn fed(bodies: &str, inlet: &str) -> State {
    let text = format!("{HEAD}{bodies}[inlets.feed]\nregion = \"gate\"\n{inlet}");
    let mut plan = planned(&text);
    plan.state.time_step_s = 1e-4;
    plan.state
}

fn run_to(state: &mut State, end_s: f64) -> Vec<PopulationEvent> {
    let mut all = Vec::new();
    while state.time_s < end_s - 0.5 * state.time_step_s {
        all.extend(happens(state));
    }
    all
}

/// Bodies in the scene: single spheres are particles, all others clumps.
fn bodies_in(state: &State) -> usize {
    state.particles.free + state.clumps.all.len()
}

#[test]
fn a_rate_by_number_is_kept_between_start_and_end() {
    let inlet = "bodies = [\"ball\"]\nrate = 500\nstart = 0.01\nend = 0.05\n";
    let mut state = fed(&format!("{BALL}{WIDE}"), inlet);
    for n in 0..800 {
        let now_s = state.time_s;
        happens(&mut state);
        let since_s = now_s.min(0.05) - 0.01;
        // The first at once, and one every 2 ms; none at the end itself.
        let due = if n < 100 {
            0.0
        } else {
            (since_s / 2e-3 - 1e-9).floor() + 1.0
        };
        let exact = (since_s / 2e-3).round();
        let is_edge = (since_s / 2e-3 - exact).abs() < 1e-6;
        let come = f64::from(state.population.inlets[0].bodies);
        assert!(
            come == due || (is_edge && (come - due).abs() < 1.5),
            "{now_s}: {come} {due}"
        );
    }
    assert_eq!(state.population.inlets[0].bodies, 20);
    assert_eq!(bodies_in(&state), 20);
    assert_eq!(state.population.inlets[0].delayed, 0);
    // No more than `count`.
    let mut state = fed(&format!("{BALL}{WIDE}"), &format!("{inlet}count = 7\n"));
    run_to(&mut state, 0.08);
    assert_eq!(state.population.inlets[0].bodies, 7);
}

/// Shares by mass become shares by number: each over the mass of a body.
#[test]
fn shares_by_mass_are_those_of_the_mass_that_is_fed() {
    let bodies = format!("{BALL}{}{WIDE}", lump("lump", "start_as = \"clump\""));
    let fed_kg = |shares: &str| {
        let inlet = format!("bodies = {{ ball = 1, lump = 3 }}\n{shares}rate = 5000\n");
        let mut state = fed(&bodies, &inlet);
        run_to(&mut state, 0.1);
        let of_lump = state
            .clumps
            .templates
            .iter()
            .find(|t| t.body == "lump")
            .unwrap();
        let lumps = state.clumps.all.len() as f64;
        let balls = state.particles.free as f64;
        let ball = state
            .clumps
            .templates
            .iter()
            .find(|t| t.body == "ball")
            .unwrap();
        (balls * ball.mass_kg, lumps * of_lump.mass_kg, lumps / balls)
    };
    let (balls_kg, lumps_kg, _) = fed_kg("shares_by = \"mass\"\n");
    assert!(
        (lumps_kg / balls_kg / 3.0 - 1.0).abs() < 0.3,
        "{lumps_kg} {balls_kg}"
    );
    let (_, _, by_number) = fed_kg("");
    assert!((by_number / 3.0 - 1.0).abs() < 0.3, "{by_number}");
}

#[test]
fn a_rate_by_mass_is_kept_to_a_body() {
    let bodies = format!("{BALL}{}{WIDE}", lump("lump", "start_as = \"clump\""));
    let inlet = "bodies = [\"ball\", \"lump\"]\nmass_rate = \"0.05 kg/s\"\n";
    let mut state = fed(&bodies, inlet);
    let heaviest = state
        .clumps
        .templates
        .iter()
        .map(|t| t.mass_kg)
        .fold(0.0, f64::max);
    for _ in 0..2000 {
        let now_s = state.time_s;
        happens(&mut state);
        let come_kg = state.population.inlets[0].mass_kg;
        assert!(come_kg > 0.05 * now_s && come_kg <= 0.05 * now_s + heaviest * (1.0 + 1e-12));
        let balls = &state.particles.motions[..state.particles.free];
        let balls_kg: f64 = balls.iter().map(|motion| 1.0 / motion.inverse_mass).sum();
        let there_kg = state.clumps.mass_kg() + balls_kg;
        assert!((there_kg / come_kg - 1.0).abs() < 1e-12);
    }
    assert!(bodies_in(&state) > 100, "{}", bodies_in(&state));
}

#[test]
fn a_mix_has_its_shares() {
    let pair = block(
        "pair",
        [2, 1, 1],
        2e-3,
        |_| Some(1e-3),
        "start_as = \"clump\"",
    );
    let bodies = format!("{BALL}{pair}{WIDE}");
    let mut state = fed(&bodies, "bodies = { ball = 6, pair = 2 }\nrate = 10000\n");
    run_to(&mut state, 0.2);
    let count = bodies_in(&state) as f64;
    assert!((count - 2000.0).abs() < 1.5);
    let is_pair = |clump: &&Clump| state.clumps.template(clump).body == "pair";
    let pairs = state.clumps.all.iter().filter(is_pair).count() as f64;
    let sigma = (count * 0.25 * 0.75).sqrt();
    eprintln!(
        "{pairs} of {count}, expected {} +- {sigma:.0}",
        0.25 * count
    );
    assert!((pairs - 0.25 * count).abs() < 4.0 * sigma);
}

/// Bodies, positions and orientations.
fn told(state: &State) -> Vec<(u32, [f64; 3], [f64; 4])> {
    let all = state.clumps.all.iter();
    all.map(|clump| (clump.template, clump.place_m, clump.turned))
        .collect()
}

#[test]
fn the_seed_says_what_is_random_and_orientations_are_uniform() {
    let bodies = |seed: u32| {
        format!(
            "run.seed = {seed}\n{}{WIDE}",
            lump("lump", "start_as = \"clump\"")
        )
    };
    let inlet = "bodies = [\"lump\"]\nrate = 10000\norientation = \"random\"\nvelocity = [1, 2, 3]\nangular_velocity = [4, 5, 6]\n";
    let run = |seed: u32| {
        let mut state = fed(&bodies(seed), inlet);
        run_to(&mut state, 0.02);
        state
    };
    let (one, same, other) = (run(1), run(1), run(2));
    assert!(told(&one) == told(&same));
    for (a, b) in told(&one).iter().zip(&told(&other)) {
        assert!(a.1 != b.1 && a.2 != b.2);
    }

    // When fed, before they have rotated: each component of each axis has mean 0 and mean square
    // 1/3.
    let mut fresh = fed(&bodies(1), inlet);
    let template = fresh.clumps.templates[0].clone();
    let mut axes: Vec<[Vector3<f64>; 3]> = Vec::new();
    let mut places: Vec<Vector3<f64>> = Vec::new();
    while axes.len() < 2000 {
        dem_engine::step::interact(&mut fresh);
        let before = fresh.clumps.all.len();
        dem_engine::step::exchange(&mut fresh);
        for clump in &fresh.clumps.all[before..] {
            let as_file = rotation(clump.turned) * rotation(template.axes).inverse();
            axes.push([Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| as_file * axis));
            places.push(clump.place_m.into());
            assert_eq!(clump.velocity_m_s, [1.0, 2.0, 3.0]);
            let spin = clump.spin_rad_s(&template) - Vector3::new(4.0, 5.0, 6.0);
            assert!(spin.norm() < 1e-13);
        }
        dem_engine::step::drift(&mut fresh);
    }
    let n = axes.len() as f64;
    for axis in 0..3 {
        let mean: Vector3<f64> = axes.iter().map(|a| a[axis]).sum::<Vector3<f64>>() / n;
        let squares = axes
            .iter()
            .map(|a| a[axis].component_mul(&a[axis]))
            .sum::<Vector3<f64>>()
            / n;
        // Variances 1/3 and 1/5 - 1/9.
        assert!(mean.amax() < 4.0 / (3.0 * n).sqrt(), "{mean}");
        assert!(
            squares.add_scalar(-1.0 / 3.0).amax() < 4.0 * (4.0 / 45.0 / n).sqrt(),
            "{squares}"
        );
    }
    let mean: Vector3<f64> = places.iter().sum::<Vector3<f64>>() / n;
    assert!(mean.amax() < 4.0 * 100.0 / (12.0 * n).sqrt(), "{mean}");

    // Oriented like the scene's body, and its copies.
    let turned = "start_as = \"clump\"\nrotation = { axis = [1, 2, 2], angle = 0.9 }";
    let mut state = fed(
        &format!("{}{WIDE}", lump("lump", turned)),
        "bodies = [\"lump\"]\nrate = 1000\n",
    );
    dem_engine::step::interact(&mut state);
    dem_engine::step::exchange(&mut state);
    let found = rotation(state.clumps.all[0].turned) * rotation(template.axes).inverse();
    let wanted = Vector3::new(1.0, 2.0, 2.0) / 3.0 * 0.9;
    assert!((found.scaled_axis() - wanted).norm() < 1e-14);
}

/// True if no spheres of different bodies overlap.
fn none_overlap(state: &State) -> bool {
    let clusters = &state.clusters.as_ref().unwrap().of_particle;
    let poses = &state.particles.poses;
    (0..poses.len()).all(|i| {
        (0..i).all(|j| {
            clusters[i] == clusters[j]
                || dem_engine::stages::contacts::forces::overlap_m(poses, [j as u32, i as u32])
                    <= 0.0
        })
    })
}

#[test]
fn who_finds_no_place_waits_and_is_counted_once() {
    // Room for one ball at a time, which leaves it after 2.1 mm at 1 m/s.
    let gate = "[regions.gate]\nsphere = { centre = [0, 0, 0], radius = 1e-5 }\n";
    let inlet = "bodies = [\"ball\"]\nrate = 10000\nvelocity = [1, 0, 0]\ncount = 10\n";
    let mut state = fed(&format!("{MEETS}{BALL}{gate}"), inlet);
    state.time_step_s = 1e-5;
    while state.time_s < 0.03 {
        happens(&mut state);
        assert!(none_overlap(&state));
    }
    let come = &state.population.inlets[0];
    assert_eq!((come.bodies, come.delayed, bodies_in(&state)), (10, 9, 10));
}

#[test]
fn bodies_with_larger_contact_spheres_do_not_come_into_each_other() {
    let gate = "[regions.gate]\nbox = { min = [-0.01, -0.01, -0.01], max = [0.01, 0.01, 0.01] }\n";
    let scaled = "start_as = \"clump\"\nclump = { scale = 1.5 }";
    let ball = format!("{BALL}{scaled}\n").replace("ball", "body");
    for body in [lump("body", scaled), ball] {
        // All at once, so that each must avoid those fed with it.
        let inlet = "bodies = [\"body\"]\nrate = 1e9\ncount = 60\norientation = \"random\"\n";
        let mut state = fed(&format!("{MEETS}{body}{gate}"), inlet);
        for _ in 0..100 {
            dem_engine::step::interact(&mut state);
            dem_engine::step::exchange(&mut state);
            assert!(none_overlap(&state));
            state.steps += 1;
            state.time_s += 1e-6;
        }
        assert!(state.clumps.all.len() > 3);
    }
}

#[test]
fn nothing_comes_into_the_middle_of_a_clump() {
    // Its inner spheres are not in the scene, but their space is occupied.
    let full = block(
        "full",
        [8, 8, 8],
        1e-3,
        |_| Some(1e-3),
        "start_as = \"clump\"",
    );
    let pea = "[bodies.pea]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0, 0.2e-3]]\n";
    let gate = "[regions.gate]\nsphere = { centre = [3.5e-3, 3.5e-3, 3.5e-3], radius = 1e-4 }\n";
    let mut state = fed(
        &format!("{MEETS}{full}{pea}{gate}"),
        "bodies = [\"pea\"]\nrate = 100\n",
    );
    state.time_step_s = 1e-5;
    assert!(state.particles.len() < 512);
    run_to(&mut state, 1e-3);
    assert_eq!(state.population.inlets[0].bodies, 0);
    assert_eq!(state.population.inlets[0].delayed, 1);
}

/// Half of the region is inside a floor, and a lump needs room above it.
#[test]
fn nothing_comes_into_a_wall() {
    let text = format!(
        "{HEAD}{MEETS}{}\
         [walls.floor]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n\
         [walls.post]\nbox = {{ min = [0.02, -1, -1], max = [0.03, 1, 1] }}\nmaterial = \"stuff\"\n\
         [regions.gate]\nbox = {{ min = [0, 0, -0.02], max = [0.05, 0.05, 0.02] }}\n\
         [inlets.feed]\nbodies = [\"lump\"]\nregion = \"gate\"\nrate = 1e9\ncount = 40\norientation = \"random\"\n",
        lump("lump", "start_as = \"clump\"")
    );
    let mut plan = planned(&text);
    for _ in 0..200 {
        go(&mut plan.state, &mut plan.bodies);
        let state = &plan.state;
        assert!(state.walls.iter().all(|wall| wall.touching.is_empty()));
    }
    let state = &plan.state;
    let [left, right] = [0, 1].map(|side| {
        let of_side = |clump: &&Clump| (clump.place_m[0] > 0.025) == (side == 1);
        state.clumps.all.iter().filter(of_side).count()
    });
    eprintln!(
        "{left} and {right}, {} wait",
        state.model.rules.inlets[0].owed(&state.population.inlets[0], state.time_s)
    );
    assert!(left > 3 && right > 3);
    assert!(state.clumps.all.iter().all(|clump| clump.place_m[2] > 1e-3));
}

#[test]
fn who_is_due_and_has_not_come_is_counted() {
    let text = |rest: &str| {
        format!(
            "{HEAD}{MEETS}{}[regions.gate]\nbox = {{ min = [0, 0, 0], max = [1e-6, 1e-6, 1e-6] }}\n\
             [inlets.feed]\nbodies = [\"lump\"]\nregion = \"gate\"\n{rest}\n",
            lump("lump", "start_as = \"clump\"")
        )
    };
    // One enters and takes the place. Due are those at 0, 10, 20 ... ms.
    for (rest, time_s, waiting) in [
        ("rate = 100", 0.0, 0),
        ("rate = 100", 0.035, 3),
        ("rate = 100\nend = 0.035", 0.05, 3),
        ("rate = 100\nend = 0.04", 0.05, 3),
        ("rate = 100\nend = 0.041", 0.05, 4),
        ("rate = 100\ncount = 2", 0.05, 1),
        ("rate = 100\nstart = 0.02", 0.035, 1),
    ] {
        let mut plan = planned(&text(rest));
        plan.state.time_step_s = 1e-4;
        while plan.state.time_s < time_s + 1e-5 {
            go(&mut plan.state, &mut plan.bodies);
        }
        let inlet = &plan.state.model.rules.inlets[0];
        let come = &plan.state.population.inlets[0];
        assert_eq!(come.bodies, 1, "{rest}");
        assert_eq!(inlet.owed(come, time_s), waiting, "{rest} at {time_s} s");
    }
}

/// A single sphere moves as a clump of one sphere does, which it is only where something replaces
/// it.
#[test]
fn a_fed_sphere_is_a_particle_unless_something_replaces_it() {
    let run = |more: &str| {
        let gate =
            "[regions.gate]\nbox = { min = [-2e-3, -2e-3, 2e-3], max = [2e-3, 2e-3, 5e-3] }\n";
        let floor = "run.gravity = [1, 0, -9.81]\nrun.time_step = 2e-6\nwalls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"stuff\" }\n";
        let inlet = "bodies = [\"ball\"]\nrate = 1e6\ncount = 1\nvelocity = [0.1, 0.2, -0.3]\nangular_velocity = [50, 0, 20]\n";
        let text = format!(
            "{HEAD}{floor}{MEETS}{BALL}{more}{gate}[inlets.feed]\nregion = \"gate\"\n{inlet}"
        );
        let mut state = planned(&text).state;
        let mut events = Vec::new();
        let mut places = Vec::new();
        while state.time_s < 0.05 {
            events.extend(happens(&mut state));
            // Spheres of clumps are in place only where something is near.
            let clump = state.clumps.all.first();
            places.push(match clump {
                Some(clump) => Vector3::from(clump.place_m),
                None => state.particles.poses[0].place(),
            });
        }
        (state, events, places)
    };
    let (particle, events, as_particle) = run("");
    let (clump, _, as_clump) = run(
        "start_as = \"clump\"\n[bodies.half]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0, 1e-4], [2e-4, 0, 0, 1e-4]]\n[replacement.ball.daughters]\nclasses = [{ from = 1e9, body = \"half\" }]\n",
    );
    assert!(particle.clumps.all.is_empty());
    assert_eq!(clump.clumps.all.len(), 1);
    assert_eq!(events.len(), 1, "{events:?}");
    // It has bounced and slides or rolls.
    assert!(as_particle.iter().any(|place| place.z < 1e-3));
    assert_eq!(as_particle.len(), as_clump.len());
    for (one, other) in as_particle.iter().zip(&as_clump) {
        assert!((one - other).norm() < 1e-9, "{one} {other}");
    }
}

/// A damped block falls on a moving floor while lumps are fed.
fn fed_while_all_moves() -> State {
    let gate = "[regions.gate]\nbox = { min = [-0.02, -0.02, 0.02], max = [0.02, 0.02, 0.06] }\n";
    let more = "position = [0, 0, 0.002]\nvelocity = [0, 0, -1]";
    let text = format!(
        "{HEAD}run.gravity = [0, 0, -9.81]\n{MEETS}{gate}{}{}\
         [walls.floor]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\nvelocity = [0, 0, 0.1]\n\
         [inlets.feed]\nregion = \"gate\"\nbodies = [\"fed\"]\nrate = 2000\ncount = 12\norientation = \"random\"\nvelocity = [0, 0, -3]\n",
        lump("fed", "start_as = \"clump\""),
        block("falls", [4, 4, 3], 2e-3, |_| Some(1e-3), more),
    );
    let damped = "bonds.stiff = { damping = { damping_ratio = 0.05 }, ";
    planned(&text.replace("bonds.stiff = { ", damped)).state
}

#[test]
fn a_fed_body_makes_the_state_that_any_change_of_the_bodies_makes() {
    let mut state = fed_while_all_moves();
    let mut compared = 0;
    while compared < 3 {
        interact(&mut state);
        let mut changed = state.clone();
        exchange(&mut state);
        let came = |event: &PopulationEvent| matches!(event, PopulationEvent::Came { .. });
        if state.scratch.events.population.iter().any(came) {
            let coming = vec![*state.clumps.all.last().unwrap()];
            let change = TopologyChange {
                coming,
                ..TopologyChange::default()
            };
            changed.population.inlets = state.population.inlets.clone();
            changed.population.instances = state.population.instances;
            exchange(&mut changed);
            apply_topology_change(&mut changed, change);
            let mut fed = state.clone();
            for both in [&mut fed, &mut changed] {
                drift(both);
                for _ in 0..100 {
                    step(both);
                }
            }
            assert!(same(&fed, &changed), "{} s", state.time_s);
            compared += 1;
        }
        drift(&mut state);
    }
    assert!(!state.walls[0].touching.is_empty());
}

#[test]
fn what_is_known_of_fed_bodies_is_what_would_be_found_anew() {
    let mut state = fed_while_all_moves();
    run_to(&mut state, 8e-3);
    assert_eq!(state.population.inlets[0].bodies, 12);
    assert_eq!(state.clumps.all.len(), 12);
    let clusters = state.clusters.as_ref().unwrap();
    let mut again = clusters.clone();
    again.rebuild(&state.bonds).expect("they belong together");
    assert_eq!(&again, clusters);
    let contacts = state.contacts.as_ref().unwrap();
    let count = state.particles.len();
    assert_eq!(
        [
            contacts.materials.len(),
            contacts.lost_j.len(),
            clusters.of_particle.len()
        ],
        [count; 3]
    );
    let mut ids = state.particles.ids.clone();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
}

/// A gate that a slow sphere leaves while others fly past it, one after another from afar, and hold
/// it closed.
fn closed_gate() -> String {
    let mut text = format!(
        "{HEAD}{MEETS}[regions.gate]\nbox = {{ min = [0, 0, 0], max = [1e-5, 1e-5, 1e-5] }}\n{}\
         [inlets.feed]\nregion = \"gate\"\nbodies = [\"fed\"]\nrate = 5000\ncount = 1\n\
         [bodies.slow]\nmaterial = \"stuff\"\nparticles = [[0, 0, 0, 1e-3]]\nvelocity = [0, -0.3, 0]\n",
        lump("fed", "start_as = \"clump\""),
    );
    for n in 0..40 {
        let far_m = 0.06 + 0.003 * f64::from(n);
        text += &format!(
            "[bodies.s{n}]\nmaterial = \"stuff\"\nparticles = [[{far_m:?}, 2.5e-3, 0, 1e-3]]\nvelocity = [-6, 0, 0]\n",
        );
    }
    text
}

#[test]
fn what_an_inlet_remembers_of_its_surroundings_changes_nothing() {
    let mut keeps = planned(&closed_gate()).state;
    let mut looks = keeps.clone();
    let (mut tries, mut kept) = (0, 0);
    while keeps.population.inlets[0].bodies == 0 {
        assert!(keeps.time_s < 0.1, "the gate never opens");
        looks.scratch.surroundings.clear();
        let left_m = |state: &State| state.scratch.surroundings.first().map(|near| near.left_m);
        let (before, knew) = (keeps.population.inlets[0], left_m(&keeps));
        for state in [&mut keeps, &mut looks] {
            step(state);
        }
        let after = keeps.population.inlets[0];
        assert_eq!(looks.population.inlets[0], after);
        if after.next_try != before.next_try {
            tries += 1;
            kept +=
                u32::from(left_m(&keeps).is_some_and(|left| knew.is_some_and(|knew| left < knew)));
        }
    }
    // The last of the fast spheres is gone, and the slow one long before.
    assert!(keeps.time_s > (0.06 + 0.003 * 39.0) / 6.0);
    assert!(same(&keeps, &looks));
    assert!(2 * kept > tries && kept < tries, "{kept} of {tries}");
}

/// A single body of a name needs no more than that.
#[test]
fn bodies_of_one_name_are_told_apart_in_messages() {
    let text = format!("{BALL}{}{WIDE}", lump("lump", "start_as = \"clump\""));
    for count in [1, 2] {
        let called_all = |name: &str| -> Vec<String> {
            let inlet = format!("bodies = [\"{name}\"]\nrate = 500\ncount = {count}\n");
            let mut state = fed(&text, &inlet);
            let mut bodies = Vec::new();
            for _ in 0..100 {
                go(&mut state, &mut bodies);
            }
            let firsts = state.clumps.all.iter().map(|clump| clump.first);
            let firsts = firsts.chain(bodies.iter().map(|body| body.particles[0]));
            let called = firsts.map(|first| called(&bodies, &state.clumps, first));
            called.collect()
        };
        for name in ["ball", "lump"] {
            // The other body of the scene is there from the start.
            let own = format!("particle 0 of the body '{name}'");
            let mut found = called_all(name);
            found.retain(|one| one.starts_with(&own));
            assert_eq!(found.len(), count, "{found:?}");
            if count == 1 {
                assert_eq!(found, [own]);
                continue;
            }
            let came = format!("{own} that came as fragment ");
            assert!(found.iter().all(|one| one.starts_with(&came)), "{found:?}");
            assert_ne!(found[0], found[1]);
        }
    }
}
