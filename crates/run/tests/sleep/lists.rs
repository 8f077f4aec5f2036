//! What is near something awake is listed, among many bodies asleep, and only that is searched.

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::state::State;
use dem_engine::step::{advance, interact, stages};

use super::{CLUMP, GROUND, SLEEP, ball, go_until_asleep, head, slab, sleep, started};

/// Bodies at rest, every third of them rigid: their particles are more than twice as many as those
/// that one task handles.
const LYING: u16 = 560;
const COLUMNS: u16 = 40;
/// The bodies below the balls: at three corners of the field, and far apart in the lists.
const UNDER_BALLS: [u16; 3] = [0, COLUMNS - 1, LYING - 1];

/// They lie in a field, and up to three balls are thrown up at its corners.
fn field(balls: usize) -> State {
    let mut text = format!("{}{SLEEP}{GROUND}", head(0.0));
    let at = |n: u16| [n % COLUMNS, n / COLUMNS].map(|at| 5e-3 * f64::from(at));
    for n in 0..LYING {
        let [x, y] = at(n);
        let start = if n % 3 == 0 { CLUMP } else { "" };
        text += &slab(&format!("slab{n}"), [x, y, 0.0], start);
        let number = UNDER_BALLS.iter().position(|under| *under == n);
        if let Some(number) = number.filter(|number| *number < balls) {
            // The third flies past the field.
            let aside = if number == 2 { 9e-3 } else { 1e-3 };
            let more = format!("velocity = [0, 0, {}]", 0.25 + 0.01 * number as f64);
            text += &ball(&format!("slab{n}ball"), [x + aside, y + 1e-3, 4e-3], &more);
        }
    }
    started(&text)
}

/// Everything awake is in the lists with all that it touches, and nothing that sleeps is with
/// another that sleeps.
fn assert_listed(state: &State) {
    let mut particles = state.particles.clone();
    place_all(&state.clumps, &mut particles);
    let (poses, contacts) = (&particles.poses, state.contacts.as_ref().unwrap());
    let clusters = &state.clusters.as_ref().unwrap().of_particle;
    let pairs = &contacts.pairs;
    assert!(pairs.is_sorted());
    let both_sleep = |pair: &[u32; 2]| pair.iter().all(|&i| particles.sleeps(i as usize));
    assert!(!pairs.iter().any(both_sleep));
    for i in (0..poses.len()).filter(|&i| !particles.sleeps(i)) {
        for j in (0..poses.len()).filter(|&j| clusters[j] != clusters[i]) {
            let [a, b] = [i, j].map(|i| &poses[i]);
            if (b.place() - a.place()).norm() < a.radius_m() + b.radius_m() {
                let pair = [i.min(j) as u32, i.max(j) as u32];
                assert!(pairs.binary_search(&pair).is_ok(), "{pair:?}");
            }
        }
        for wall in &state.walls {
            let depth_m = poses[i].radius_m() - poses[i].place().z;
            assert!(depth_m < 0.0 || wall.near.contains(&(i as u32)), "{i}");
        }
    }
}

/// Goes on until the balls have come down, and returns the largest number of particles that a
/// search looked at while all other bodies slept, the number of steps with a contact, and that of
/// bodies which woke.
fn watched(balls: usize) -> [usize; 3] {
    let mut state = field(balls);
    let lying = usize::from(LYING);
    go_until_asleep(&mut state, lying);
    let search = stages().iter().position(|s| s.name == "neighbour search");
    let done = |state: &State| state.scratch.clock.done(search.unwrap()) as usize;
    let (mut most_searched, mut touching, mut awake) = (0, 0, 0);
    while state.time_s < 0.07 {
        let before = done(&state);
        interact(&mut state);
        assert_listed(&state);
        if sleep(&state).bodies == lying {
            most_searched = most_searched.max(done(&state) - before);
        }
        let histories = &state.contacts.as_ref().unwrap().histories;
        touching += usize::from(histories.iter().any(|contact| contact.overlap_m() > 0.0));
        awake = awake.max(lying - sleep(&state).bodies.min(lying));
        advance(&mut state);
    }
    let all = state.particles.len();
    eprintln!("{most_searched} of {all} particles searched for at most, {awake} bodies woke");
    [most_searched, touching, awake]
}

#[test]
fn what_is_awake_far_apart_among_sleepers_is_listed() {
    let [most_searched, touching, awake] = watched(3);
    // The first two balls hit the field, the third lands beside it.
    assert!(touching > 10 && awake == 2, "{touching} {awake}");
    // Three balls, and up to four spheres of each slab below two of them.
    assert!((3..12).contains(&most_searched), "{most_searched}");
}

#[test]
fn a_search_looks_only_at_the_sleepers_beside_what_is_awake() {
    let [most_searched, touching, awake] = watched(1);
    assert!(touching > 10 && awake == 1, "{touching} {awake}");
    // The ball, and up to four spheres of the slab below it.
    assert!((1..6).contains(&most_searched), "{most_searched}");
}
