//! Rigid clumps take steps of their own.

use dem_run::state::State;
use dem_run::step::{advance, interact, step};

use super::{CONTACTS, PLATE, RADIUS_M, errors, head, pair, planned, touching_at_one_level};

/// A rigid clump of three soft spheres in an angle, with its first sphere at this place, m.
fn angle(name: &str, place_m: [f64; 3], velocity_m_s: [f64; 3]) -> String {
    let d = 2.0 * RADIUS_M;
    format!(
        "[bodies.{name}]\nmaterial = \"soft\"\nstart_as = \"clump\"\n\
         particles = [[0, 0, 0, {RADIUS_M:e}], [{d:e}, 0, 0, {RADIUS_M:e}], [{d:e}, {d:e}, 0, {RADIUS_M:e}]]\n\
         bond_list = [[0, 1], [1, 2]]\nposition = {place_m:?}\nvelocity = {velocity_m_s:?}\n\
         angular_velocity = [3, 2, 40]\n"
    )
}

/// Level of the clump with this number.
fn level(state: &State, clump: usize) -> u8 {
    super::levels(state)[state.clumps.all[clump].first as usize]
}

/// Far from everything, a clump moves as one does alone with eight times the step: the same bits.
#[test]
fn a_clump_far_away_takes_the_longest_steps() {
    let run = |step_s: f64, by_body: bool, text: &str| {
        let run =
            format!("run.end_time = 8e-3\nrun.time_step = {step_s:e}\nrun.gravity = [0, 0, -9.81]");
        let key = format!("run.steps_by_body = {by_body}");
        let head = head(&run).replace("run.steps_by_body = true", &key);
        let head = head.replace("1e8", "1e10");
        let text = head + CONTACTS + text + &angle("c", [1.0, 0.0, 0.0], [0.1, 0.2, 1.0]);
        let mut state = planned(&text).state;
        while state.time_s < 8e-3 * (1.0 - 1e-9) {
            step(&mut state);
        }
        state
    };
    let step_s = 2.0_f64.powi(-22);
    let beside = run(step_s, true, &pair("a", "hard", [0.0; 3], [0.0; 3]));
    let alone = run(8.0 * step_s, false, "");
    assert!(super::levels(&beside)[0] < 3);
    assert_eq!(level(&beside, 0), 3);
    assert_eq!(beside.time_s, alone.time_s);
    let [one, other] = [&beside, &alone].map(|state| state.clumps.all[0]);
    assert_eq!(one.place_m, other.place_m);
    assert_eq!(one.turned, other.turned);
    assert_eq!(one.velocity_m_s, other.velocity_m_s);
    assert_eq!(one.angular_momentum, other.angular_momentum);
}

/// Two clumps bounce on a plate, one on the other, while a hard pair bounces elsewhere: all that
/// they exchange with the plate is booked.
#[test]
fn what_clumps_exchange_is_booked() {
    let text = head("run.end_time = 0.02\nrun.gravity = [0, 0, -9.81]\nrun.safety_factor = 0.2")
        + CONTACTS
        + PLATE
        + &pair("a", "hard", [0.0, 0.0, 1.5e-3], [0.2, 0.0, -0.3])
        + &angle("b", [0.1, 0.0, 1.5e-3], [0.1, 0.0, -0.3])
        + &angle("c", [0.1, 0.5e-3, 4e-3], [0.0, 0.1, -0.5]);
    let mut state = planned(&text).state;
    let mut largest = [0.0_f64; 3];
    let mut highest = 0;
    let (mut on_plate, mut on_clump) = (0, 0);
    while state.time_s < 0.02 {
        interact(&mut state);
        let errors = errors(&mut state);
        largest = [0, 1, 2].map(|k| largest[k].max(errors[k]));
        let free = state.particles.free as u32;
        let touching = state.walls[0].touching.iter();
        on_plate += touching.filter(|touch| touch.particle >= free).count();
        let contacts = state.contacts.as_ref().unwrap();
        for (pair, history) in contacts.pairs.iter().zip(&contacts.histories) {
            if history.overlap_m() > 0.0 && pair[0] >= free {
                on_clump += 1;
            }
            assert_eq!(history.origin_m(), 0.0, "listed too late");
        }
        highest = highest.max(level(&state, 0));
        advance(&mut state);
    }
    assert!(on_plate > 10 && on_clump > 10, "{on_plate} {on_clump}");
    assert!(highest > 1, "{highest}");
    assert!(largest[0] < 2e-3, "{largest:?}");
    assert!(largest[1] < 1e-11 && largest[2] < 1e-11, "{largest:?}");
}

/// A clump flies at a hard pair: they have one level when they touch, and keep their momentum.
#[test]
fn a_clump_takes_the_steps_of_what_it_touches() {
    // So hard that it sets the step.
    let text = head("run.end_time = 0.02").replace("1e8", "1e10")
        + CONTACTS
        + &pair("a", "hard", [0.0; 3], [0.0; 3])
        + &angle("b", [0.0, 8.0 * RADIUS_M, 0.0], [0.0, -1.0, 0.1])
        + &angle("c", [1.0, 0.0, 0.0], [0.0; 3]);
    let mut state = planned(&text).state;
    let mut touched = 0;
    let mut largest = 0.0_f64;
    let mut seen: Vec<[u8; 2]> = Vec::new();
    while state.time_s < 0.02 {
        interact(&mut state);
        let now = [0, 1].map(|clump| level(&state, clump));
        if seen.last() != Some(&now) {
            seen.push(now);
        }
        touched += touching_at_one_level(&state);
        let [energy, momentum, angular_momentum] = errors(&mut state);
        largest = largest.max(momentum).max(angular_momentum);
        assert!(energy < 0.01, "{energy}");
        advance(&mut state);
    }
    assert!(touched > 3);
    assert!(largest < 1e-11, "{largest}");
    assert_eq!(seen[0], [3, 3], "{seen:?}");
    assert!(seen.contains(&[0, 3]), "{seen:?}");
    assert_eq!(seen.last(), Some(&[3, 3]), "{seen:?}");
}

/// A hard clump and a soft one fall onto a plate: no particle is free.
#[test]
fn clumps_take_steps_of_their_own_where_nothing_is_bonded() {
    let hard = angle("a", [0.0, 0.0, 1.5e-3], [0.1, 0.0, -0.3]).replace("soft", "hard");
    let text = head("run.end_time = 0.02\nrun.gravity = [0, 0, -9.81]\nrun.safety_factor = 0.2")
        + CONTACTS
        + PLATE
        + &hard
        + &angle("b", [0.1, 0.0, 1.5e-3], [0.1, 0.0, -0.3]);
    let mut state = planned(&text).state;
    let (mut largest, mut touched, mut seen) = ([0.0_f64; 3], 0, [0; 2]);
    while state.time_s < 0.02 {
        interact(&mut state);
        let errors = errors(&mut state);
        largest = [0, 1, 2].map(|k| largest[k].max(errors[k]));
        seen = [0, 1].map(|n| seen[n].max(level(&state, n)));
        touched += state.walls[0].touching.len();
        advance(&mut state);
    }
    assert_eq!(state.particles.free, 0);
    assert!(touched > 10 && seen[1] > seen[0], "{touched} {seen:?}");
    assert!(largest[0] < 2e-3, "{largest:?}");
    assert!(largest[1] < 1e-11 && largest[2] < 1e-11, "{largest:?}");
}
