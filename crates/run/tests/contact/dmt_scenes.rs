//! Adhesion in whole scenes: threads, checkpoints, the pull-off of two spheres, sleep and clumps.

use std::f64::consts::PI;
use std::fmt::Write;

use dem_engine::stages::clumps::motion::place_all;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact, step};

use crate::helpers::{started, step_and_balance};
use dem_testing::Random;

/// Radius of all spheres, m.
const RADIUS_M: f64 = 1e-4;
/// E, Pa, of all materials, of Poisson's ratio 0.3.
const YOUNG_PA: f64 = 1e8;
/// w, J/m2.
const WORK: f64 = 0.05;

fn head(run: &str, more: &str) -> String {
    format!(
        "version = 1
run = {{ end_time = 1{run} }}
materials.dust = {{ density = 2000, young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3 }}
contacts.dust-dust = {{ law = \"dmt\", work_of_adhesion = {WORK}, restitution = 0.2, friction = 0.4 }}
{more}
"
    )
}

fn ball(name: &str, radius_m: f64, place_m: [f64; 3], velocity_m_s: [f64; 3]) -> String {
    let [x, y, z] = place_m;
    format!(
        "[bodies.{name}]\nmaterial = \"dust\"\nparticles = [[{x:e}, {y:e}, {z:e}, {radius_m:e}]]\nvelocity = {velocity_m_s:?}\n"
    )
}

/// Overlap at which Hertz's force is the attraction plus this load, N, for this effective radius.
fn at_rest_m(effective_m: f64, load_n: f64) -> f64 {
    let hertz = 4.0 / 3.0 * YOUNG_PA / (2.0 * (1.0 - 0.09)) * effective_m.sqrt();
    ((2.0 * PI * WORK * effective_m + load_n) / hertz).powf(2.0 / 3.0)
}

/// Spheres on a jittered grid that fly into each other and stick.
fn cloud(seed: u64) -> State {
    const EDGE: i32 = 4;
    let mut random = Random(seed);
    let mut text = head("", "");
    for k in 0..EDGE.pow(3) {
        let at = [k % EDGE, k / EDGE % EDGE, k / EDGE / EDGE];
        let centre = at.map(|i| f64::from(i) - 0.5 * f64::from(EDGE - 1));
        let jitter = random.point(0.02 * RADIUS_M);
        let place = [0, 1, 2].map(|k| 2.1 * RADIUS_M * centre[k] + jitter[k]);
        let own = random.point(0.01);
        let velocity = [0, 1, 2].map(|k| own[k] - 0.03 * centre[k]);
        write!(
            text,
            "{}",
            ball(&format!("b{k}"), RADIUS_M, place, velocity)
        )
        .unwrap();
    }
    started(&text)
}

fn bits(state: &State) -> Vec<u64> {
    let p = &state.particles;
    let poses = p.poses.iter().flat_map(|pose| pose.position_m);
    let motions = p.motions.iter().flat_map(|motion| {
        let [x, y, z] = motion.velocity_m_s;
        let [u, v, w] = motion.spin_rad_s;
        [x, y, z, u, v, w]
    });
    let histories = &state.contacts.as_ref().unwrap().histories;
    let springs = histories.iter().flat_map(|history| history.tangential);
    let all = poses.chain(motions).chain(springs);
    all.map(f64::to_bits).collect()
}

/// Pairs that stick: they overlap, and by less than twice the overlap at rest.
fn stuck(state: &State) -> usize {
    let histories = &state.contacts.as_ref().unwrap().histories;
    let within = 0.0..2.0 * at_rest_m(0.5 * RADIUS_M, 0.0);
    let overlaps = histories
        .iter()
        .map(dem_engine::state::contacts::ContactHistory::overlap_m);
    overlaps
        .filter(|overlap_m| *overlap_m > 0.0 && within.contains(overlap_m))
        .count()
}

/// The energy of the attraction of each pair is - 2 pi w R* d.
#[test]
fn adhesion_has_its_own_energy() {
    let mut state = cloud(2);
    for _ in 0..2000 {
        step(&mut state);
    }
    let books = step_and_balance(&mut state);
    let histories = &state.contacts.as_ref().unwrap().histories;
    let overlaps = histories
        .iter()
        .map(dem_engine::state::contacts::ContactHistory::overlap_m);
    let overlaps_m: f64 = overlaps.filter(|overlap_m| *overlap_m > 0.0).sum();
    let wanted_j = -2.0 * PI * WORK * 0.5 * RADIUS_M * overlaps_m;
    assert!(wanted_j < 0.0);
    assert!(
        (books.adhesion_j / wanted_j - 1.0).abs() < 1e-9,
        "{books:?} {wanted_j}"
    );
    assert!(books.contact_elastic_j > 0.0 && books.energy_error.abs() < 1e-3);
}

#[test]
fn the_bits_do_not_depend_on_partitions_and_threads() {
    let after = |threads: usize| {
        crate::bars::with_threads(threads, || {
            let mut state = cloud(1);
            let contacts = state.contacts.as_mut().unwrap();
            contacts.divide(state.particles.len(), 2 * threads - 1);
            for _ in 0..3000 {
                step(&mut state);
            }
            assert!(stuck(&state) > 30, "{}", stuck(&state));
            bits(&state)
        })
    };
    let one = after(1);
    assert_eq!(one, after(2));
    assert_eq!(one, after(4));
}

#[test]
fn a_checkpoint_while_spheres_stick_continues_with_the_same_bits() {
    let mut state = cloud(2);
    while stuck(&state) < 30 {
        step(&mut state);
    }
    let saved = postcard::to_stdvec(&state).unwrap();
    let resumed: State = postcard::from_bytes(&saved).unwrap();
    let mut resumed = resumed
        .rebuilt(state.model.clone(), &state.scratch)
        .unwrap();
    for _ in 0..1000 {
        step_and_balance(&mut state);
        step_and_balance(&mut resumed);
    }
    assert_eq!(bits(&state), bits(&resumed));
    assert_eq!(state.ledger, resumed.ledger);
}

/// Two spheres of different size are pulled apart slowly: with 2 pi w R* at most, in the last step
/// of their touch. The bound is Hertz's force of the way in a step.
#[test]
fn two_spheres_are_pulled_apart_with_the_force_of_their_effective_radius() {
    let (speed_m_s, dt_s) = (1e-3, 1e-7);
    for radius_m in [RADIUS_M, 3.0 * RADIUS_M] {
        let effective_m = RADIUS_M * radius_m / (RADIUS_M + radius_m);
        let rest_m = at_rest_m(effective_m, 0.0);
        let distance_m = RADIUS_M + radius_m - rest_m;
        let text = head(
            &format!(", time_step = {dt_s:e}, initial_overlap = \"keep\""),
            "",
        ) + &ball("a", RADIUS_M, [0.0; 3], [0.0; 3])
            + &ball("b", radius_m, [distance_m, 0.0, 0.0], [speed_m_s, 0.0, 0.0])
            + &format!(
                "[supports]\na = {{ group = \"a\", fixed = true }}\n\
                 b = {{ group = \"b\", fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], velocity.x = {speed_m_s:e} }}\n"
            );
        let mut state = started(&text);
        let (mut largest_n, mut last_n) = (0.0_f64, f64::NAN);
        while state.time_s < 2.0 * rest_m / speed_m_s {
            interact(&mut state);
            last_n = -state.particles.wrenches[1].force_n[0];
            largest_n = largest_n.max(last_n);
            advance(&mut state);
        }
        let force_n = 2.0 * PI * WORK * effective_m;
        let bound = (speed_m_s * dt_s / rest_m).powf(1.5);
        let off = largest_n / force_n - 1.0;
        assert!(off <= 1e-12 && off > -2.0 * bound, "{off:e} {bound:e}");
        assert_eq!(last_n, 0.0);
    }
}

const CEILING: &str =
    "walls.ceiling = { plane = { point = [0, 0, 0], normal = [0, 0, -1] }, material = \"dust\" }\n";
const GRAVITY: &str = ", gravity = [0, 0, -9.81], initial_overlap = \"keep\"";
const WEIGHT_N: f64 = 2000.0 * 4.0 / 3.0 * PI * RADIUS_M * RADIUS_M * RADIUS_M * 9.81;

/// A sphere hangs from a ceiling by adhesion, falls asleep, and hangs there with closed books and
/// the force of its weight between both; when another hits it, it wakes and goes on hanging.
#[test]
fn what_hangs_by_adhesion_sleeps_and_wakes() {
    let hanging_m = at_rest_m(RADIUS_M, -WEIGHT_N);
    let top_m = -RADIUS_M + 1.01 * hanging_m;
    let text = head(
        GRAVITY,
        &format!("{CEILING}sleep = {{ speed = \"0.1 mm/s\", after = \"0.2 ms\" }}"),
    ) + &ball("a", RADIUS_M, [0.0, 0.0, top_m], [0.0; 3])
        + &ball("b", RADIUS_M, [0.0, 0.0, -0.01], [0.0, 0.0, 0.7]);
    let mut state = started(&text);
    let mut slept = false;
    while state.time_s < 0.02 {
        interact(&mut state);
        let books = balance(&mut state);
        assert!(books.energy_error.abs() < 1e-3, "{books:?}");
        let sleeps = state.particles.asleep.first() == Some(&true);
        if sleeps {
            let overlap_m = RADIUS_M + state.particles.poses[0].place().z;
            assert!((overlap_m / hanging_m - 1.0).abs() < 1e-2, "{overlap_m:e}");
            let held_n = state.walls[0].total_load()[0][2];
            assert!(
                (held_n / WEIGHT_N - 1.0).abs() < 1e-2,
                "{held_n:e} {WEIGHT_N:e}"
            );
            let adhesion_j = -2.0 * PI * WORK * RADIUS_M * overlap_m;
            assert!(
                (books.adhesion_j / adhesion_j - 1.0).abs() < 1e-9,
                "{books:?}"
            );
            assert!(books.contact_elastic_j > 0.0);
        }
        slept |= sleeps;
        if slept && state.particles.asleep.is_empty() && state.time_s > 0.0195 {
            break;
        }
        advance(&mut state);
    }
    assert!(slept);
}

/// A clump of three spheres hangs from the ceiling by two of them, each of which carries half of
/// its weight, and falls if adhesion is too weak.
#[test]
fn a_clump_hangs_by_the_adhesion_of_its_spheres() {
    let distance_m = 1.5 * RADIUS_M;
    let clump = |top_m: f64| {
        format!(
            "[bodies.clump]\nmaterial = \"dust\"\nstart_as = \"clump\"\nbonds = \"stiff\"\n\
             particles = [[{:e}, 0, {top_m:e}, {RADIUS_M:e}], [{distance_m:e}, 0, {top_m:e}, {RADIUS_M:e}], [0, 0, {:e}, {RADIUS_M:e}]]\n\
             bond_list = [[0, 2], [1, 2]]\n\
             [bonds.stiff]\nyoung_modulus = 1e8\npoisson_ratio = 0.3\n",
            -distance_m,
            top_m - distance_m,
        )
    };
    let text = |work: f64, top_m: f64| {
        head(GRAVITY, CEILING).replace(&format!("= {WORK}"), &format!("= {work:e}")) + &clump(top_m)
    };
    let hanging_m = at_rest_m(RADIUS_M, -1.5 * WEIGHT_N);
    let mut state = started(&text(WORK, -RADIUS_M + hanging_m));
    while state.time_s < 0.01 {
        step(&mut state);
    }
    interact(&mut state);
    assert!(balance(&mut state).energy_error.abs() < 1e-4);
    for touch in &state.walls[0].touching {
        let overlap_m = touch.history.overlap_m();
        assert!((overlap_m / hanging_m - 1.0).abs() < 1e-6, "{overlap_m:e}");
    }
    assert_eq!(state.walls[0].touching.len(), 2);

    // Half of what carries it: 2 (2 pi w R) = 3 W.
    let weak = 0.5 * 1.5 * WEIGHT_N / (2.0 * PI * RADIUS_M);
    let mut state = started(&text(weak, -RADIUS_M + 1e-3 * hanging_m));
    while state.time_s < 0.01 {
        step(&mut state);
    }
    let fallen_m = 0.5 * 9.81 * 1e-4 / 2.0;
    // Spheres of clumps that are near nothing are placed on demand only.
    place_all(&state.clumps, &mut state.particles);
    assert!(state.particles.poses[0].place().z < -RADIUS_M - 0.5 * fallen_m);
}
