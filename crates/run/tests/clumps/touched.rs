//! Clumps that are replaced when they touch what their trigger names, and rigid again by
//! themselves.

use std::collections::BTreeMap;

use dem_engine::state::State;
use dem_engine::state::events::PopulationEvent;
use dem_engine::step::{advance, interact};

use super::again::busy;
use super::{HEAD, block, happens, planned};

const STEP_S: f64 = 1e-6;

/// The state of a scene, with steps of this length.
fn stepping(text: &str) -> State {
    let mut plan = planned(text);
    plan.state.time_step_s = STEP_S;
    plan.state
}

/// Two spheres side by side that move down at 1 m/s, from 1 mm above the ground, and rebound from it
/// and from a ceiling.
fn bouncing(rule: &str) -> State {
    let start = "start_as = \"clump\"\nposition = [0, 0, 2e-3]\nvelocity = [0, 0, -1]";
    let pair = block("pair", [2, 1, 1], 2e-3, |_| Some(1e-3), start);
    let text = format!(
        "{HEAD}contacts.stuff-stuff = {{ restitution = 1, friction = 0 }}\n{pair}\
         [walls.ground]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n\
         [walls.ceiling]\nplane = {{ point = [0, 0, 3.5e-3], normal = [0, 0, -1] }}\nmaterial = \"stuff\"\n\
         [replacement.pair]\n{rule}\n"
    );
    stepping(&text)
}

/// Times and causes of the replacements until this time, and the times at which it became rigid.
fn replacements(state: &mut State, until_s: f64) -> (Vec<(f64, &'static str)>, Vec<f64>) {
    let (mut replaced, mut restored) = (Vec::new(), Vec::new());
    while state.time_s < until_s {
        let now_s = state.time_s;
        for event in happens(state) {
            match event {
                PopulationEvent::Replaced { cause, .. } => replaced.push((now_s, cause)),
                PopulationEvent::Restored { .. } => restored.push(now_s),
                _ => {}
            }
        }
    }
    (replaced, restored)
}

#[test]
fn a_clump_is_replaced_in_the_step_in_which_it_touches_what_is_named() {
    // It needs 1 ms to the ground, and 1.5 ms from there to the ceiling.
    let touches = |names: &str| {
        let mut state = bouncing(&format!("when = {{ touches = {names} }}"));
        replacements(&mut state, 5e-3).0
    };
    for names in ["\"ground\"", "[\"ground\", \"ceiling\"]"] {
        let [(at_s, cause)] = touches(names)[..] else {
            panic!("{:?}", touches(names));
        };
        assert_eq!(cause, "touches");
        assert!(
            (1e-3 - STEP_S..1e-3 + 2.0 * STEP_S).contains(&at_s),
            "{at_s}"
        );
    }
    let [(at_s, _)] = touches("\"ceiling\"")[..] else {
        panic!("the ceiling is touched");
    };
    assert!(at_s > 2.5e-3 && at_s < 2.8e-3, "{at_s}");
}

#[test]
fn a_body_that_is_named_replaces_and_another_does_not() {
    let touched_by = |named: &str| {
        let ball = |name: &str, z_m: f64| {
            format!(
                "[bodies.{name}]\nmaterial = \"stuff\"\nparticles = [[0, 0, {z_m}, 1e-3]]\nvelocity = [0, 0, {}]\n",
                -z_m.signum()
            )
        };
        let pair = block(
            "pair",
            [1, 1, 2],
            2e-3,
            |_| Some(1e-3),
            "start_as = \"clump\"",
        );
        let text = format!(
            "{HEAD}contacts.stuff-stuff = {{ restitution = 1, friction = 0 }}\n{pair}{}{}\
             [replacement.pair]\nwhen = {{ touches = \"{named}\" }}\n",
            ball("above", 4.5e-3),
            ball("below", -3e-3)
        );
        replacements(&mut stepping(&text), 0.7e-3).0
    };
    // The gap to the upper ball is 0.5 mm, to the lower one 1 mm.
    let [(at_s, "touches")] = touched_by("above")[..] else {
        panic!("{:?}", touched_by("above"));
    };
    assert!((at_s - 0.5e-3).abs() < 2.0 * STEP_S, "{at_s}");
    assert_eq!(touched_by("below"), []);
}

#[test]
fn who_became_rigid_again_is_replaced_by_the_next_touch() {
    let mut state = bouncing(
        "when = { touches = \"ground\" }\n\
         restore = { unbroken_for = 3e-4, min_particles = 2, strain_energy = 1e3, fluctuation_velocity = 10 }",
    );
    let (replaced, restored) = replacements(&mut state, 8e-3);
    // From ground to ground it takes 3 ms and two impacts.
    assert!(
        replaced.len() == 3 && restored.len() == 3,
        "{replaced:?} {restored:?}"
    );
    for ((touched_s, _), rigid_s) in replaced.iter().zip(&restored) {
        // Conditions are looked at every 200 steps.
        let after_s = rigid_s - touched_s;
        assert!((3e-4 - STEP_S..5.1e-4).contains(&after_s), "{after_s}");
    }
    let between_s = replaced[1].0 - replaced[0].0;
    assert!((3e-3..3.3e-3).contains(&between_s), "{between_s}");
}

/// A pair that comes to rest on the ground, with more in its scene.
fn resting(more: &str) -> State {
    let pair = block(
        "pair",
        [2, 1, 1],
        2e-3,
        |_| Some(1e-3),
        "start_as = \"clump\"\nposition = [0, 0, 1e-3]\nvelocity = [0, 0, -0.01]",
    );
    let text = format!(
        "{HEAD}run.gravity = [0, 0, -9.81]\ncontacts.stuff-stuff = {{ restitution = 0.1, friction = 0 }}\n{more}{pair}\
         [walls.ground]\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\n\
         [replacement.pair]\nwhen = {{ touches = \"ground\" }}\n\
         restore = {{ unbroken_for = 3e-4, min_particles = 2, strain_energy = 1e3, fluctuation_velocity = 10 }}\n"
    );
    stepping(&text)
}

#[test]
fn who_became_rigid_while_it_touched_stays_so_until_it_parts() {
    let state = &mut resting("");
    let (replaced, _) = replacements(state, 0.02);
    let (later, _) = replacements(state, 0.04);
    assert!(!replaced.is_empty());
    assert_eq!(later, []);
    assert!(state.clumps.all[0].rigid_while_touching);
    // Lifted and dropped, it is replaced again.
    state.clumps.all[0].velocity_m_s[2] = 0.05;
    let (lifted, _) = replacements(state, 0.06);
    assert!(!lifted.is_empty());
}

#[test]
fn who_sleeps_has_not_parted() {
    let state = &mut resting("sleep = { speed = 0.02, after = 2e-3 }\n");
    while state.clumps.all.is_empty() || !state.clumps.all[0].asleep {
        happens(state);
        assert!(state.time_s < 0.1, "it falls asleep");
    }
    let (replaced, _) = replacements(state, state.time_s + 1e-3);
    assert_eq!(replaced, []);
    let clump = &state.clumps.all[0];
    assert!(clump.asleep && clump.rigid_while_touching);
}

#[test]
fn no_cluster_is_rigid_before_its_bonds_have_held_for_the_time() {
    const UNBROKEN_S: f64 = 1e-3;
    let mut state = busy(1).state;
    for rule in state.model.rules.restores.iter_mut().flatten() {
        rule.leaves = None;
        rule.unbroken_for_s = UNBROKEN_S;
    }
    let mut last_break_s: BTreeMap<u32, f64> = BTreeMap::new();
    let (mut restored, mut broke_before) = (0, 0);
    while state.time_s < 0.06 {
        interact(&mut state);
        let clusters = state.clusters.as_ref().unwrap();
        for broken in &state.scratch.events.broken {
            for (particle, _) in broken.ends {
                let id = clusters.of_particle[particle as usize];
                last_break_s.insert(id, state.time_s);
            }
        }
        let now_s = state.time_s;
        advance(&mut state);
        let clusters = state.clusters.as_ref().unwrap();
        for event in &state.scratch.events.population {
            if let PopulationEvent::Restored { cluster, .. } = event {
                let found_s = clusters.history[*cluster as usize].created_s;
                let broke_s = last_break_s.get(cluster);
                let since_s = broke_s.map_or(found_s, |broke_s| broke_s.max(found_s));
                assert!(
                    now_s - since_s >= UNBROKEN_S,
                    "{cluster}: {since_s} {now_s}"
                );
                restored += 1;
                broke_before += usize::from(broke_s.is_some());
            }
        }
    }
    assert!(
        restored >= 3 && broke_before >= 1,
        "{restored} {broke_before}"
    );
}
