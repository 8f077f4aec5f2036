//! Contacts beside bonds: from the overlap at which the ends were bonded, while the bond holds and
//! after it broke.

use std::fs;

use dem_engine::stages::ledger::bookkeeping::{balance, opened};
use dem_engine::state::State;
use dem_engine::step::{advance, interact, step};
use dem_plan::{Plan, plan};
use dem_results::checkpoint::read_checkpoint;
use dem_results::folder::names;
use dem_results::{Existing, ResultsFolder};
use dem_runner::snapshot::Snapshot;
use dem_scene::{Scene, read_bodies};

use crate::fragments::burst::run_into;
use crate::helpers::scene;

const APART_M: f64 = 1.9e-3;
/// E of the material, Pa, and Poisson's ratio.
const MATERIAL: [f64; 2] = [1e6, 0.25];

/// A scene whose bonds have these further keys.
fn head(run: &str, restitution: f64, bond: &str) -> String {
    let [young_pa, poisson] = MATERIAL;
    format!(
        "version = 1\n{run}\nrelaxation.min_overlap = 0\n\
         materials.m = {{ density = 2500, young_modulus = {young_pa:e}, poisson_ratio = {poisson} }}\n\
         contacts.m-m = {{ restitution = {restitution}, friction = 0.5 }}\n\
         bonds.m = {{ young_modulus = 1e5, poisson_ratio = 0.25, contact_beside_bond = true{bond} }}\n"
    )
}

/// Two spheres of 1 mm that overlap by 0.1 mm.
fn pair(restitution: f64, bond: &str) -> State {
    let text = head(
        "run.end_time = 1\nrun.safety_factor = 0.02",
        restitution,
        bond,
    ) + &format!(
        "[bodies.pair]\nmaterial = \"m\"\nbonds = \"m\"\n\
             particles = [[0, 0, 0, 1e-3], [{APART_M:e}, 0, 0, 1e-3]]\nbond_list = [[0, 1]]\n"
    );
    planned(&scene(&text), 1).state
}

fn planned(scene: &Scene, threads: usize) -> Plan {
    plan(scene, read_bodies(scene).unwrap(), threads, false).unwrap()
}

/// The ends approach with this speed, m/s.
fn approach(state: &mut State, speed_m_s: f64) {
    state.particles.motions[0].velocity_m_s[0] = 0.5 * speed_m_s;
    state.particles.motions[1].velocity_m_s[0] = -0.5 * speed_m_s;
    state.ledger = opened(state);
}

fn distance_m(state: &State) -> f64 {
    let [a, b] = [0, 1].map(|i| state.particles.poses[i].place());
    (b - a).norm()
}

/// Force of Hertz between the two at this overlap, N.
fn hertz_n(overlap_m: f64) -> f64 {
    let [young_pa, poisson] = MATERIAL;
    let effective_pa = 0.5 * young_pa / (1.0 - poisson * poisson);
    let effective_m = 0.5e-3_f64;
    4.0 / 3.0 * effective_pa * (effective_m * overlap_m.max(0.0).powi(3)).sqrt()
}

/// Pressed and pulled, again and again: the spring of the bond, and that of Hertz beside it for the
/// overlap beyond the first.
#[test]
fn a_pressed_pair_has_the_forces_of_both() {
    let mut state = pair(1.0, "");
    let stiffness_n_m = state.bonds.normal(0);
    for pressed_m in [0.0, 2e-5, -5e-5, 1e-5, -3e-4, 4e-5] {
        state.particles.poses[1].position_m[0] = APART_M - pressed_m;
        interact(&mut state);
        let force_n = state.particles.wrenches[1].force_n[0];
        let should_n = stiffness_n_m * pressed_m + hertz_n(pressed_m);
        let scale_n = stiffness_n_m * 1e-5;
        assert!(
            (force_n - should_n).abs() < 1e-9 * scale_n,
            "{pressed_m}: {force_n} {should_n}"
        );
        state.particles.motions[1].velocity_m_s = [0.0; 3];
        state.particles.motions[0].velocity_m_s = [0.0; 3];
    }
}

/// The pair vibrates: the deepest compression is that at which bond and contact hold the energy of
/// the approach, the largest elongation that of the bond alone. Energy is kept, and with a
/// restitution below 1 what is lost is booked.
#[test]
fn the_energy_of_a_vibrating_pair_is_kept() {
    let speed_m_s = 0.1;
    let mut state = pair(1.0, "");
    let reduced_kg = 0.5 / state.particles.motions[0].inverse_mass;
    let stiffness_n_m = state.bonds.normal(0);
    approach(&mut state, speed_m_s);
    let energy_j = 0.5 * reduced_kg * speed_m_s * speed_m_s;
    let mut ends_m = [APART_M; 2];
    let mut largest = 0.0_f64;
    for _ in 0..20_000 {
        interact(&mut state);
        largest = largest.max(balance(&mut state).energy_error_j.abs() / energy_j);
        let now_m = distance_m(&state);
        ends_m = [ends_m[0].min(now_m), ends_m[1].max(now_m)];
        advance(&mut state);
    }
    let stored_j = |pressed_m: f64| {
        0.5 * stiffness_n_m * pressed_m * pressed_m + 0.4 * pressed_m * hertz_n(pressed_m)
    };
    let pressed_j = stored_j(APART_M - ends_m[0]);
    let pulled_j = stored_j(APART_M - ends_m[1]);
    assert!(
        (pressed_j / energy_j - 1.0).abs() < 2e-3,
        "{pressed_j} {energy_j}"
    );
    assert!(
        (pulled_j / energy_j - 1.0).abs() < 2e-3,
        "{pulled_j} {energy_j}"
    );
    assert!(largest < 1e-3, "{largest}");

    let mut state = pair(0.5, "");
    approach(&mut state, speed_m_s);
    for _ in 0..20_000 {
        step(&mut state);
    }
    interact(&mut state);
    let books = balance(&mut state);
    assert!(
        books.contact_damping_j > 0.2 * energy_j,
        "{}",
        books.contact_damping_j
    );
    assert!(
        books.energy_error_j.abs() < 1e-3 * energy_j,
        "{}",
        books.energy_error_j
    );
}

/// The bond breaks while the pair is pressed: the contact goes on with the same overlap of its law,
/// from the same origin, which falls once the two part.
#[test]
fn a_contact_goes_on_when_its_bond_breaks() {
    let mut state = pair(1.0, ", failure = { compressive_strength = 400 }");
    let origin_m = 2e-3 - APART_M;
    approach(&mut state, 0.1);
    let energy_j = 0.25 / state.particles.motions[0].inverse_mass * 0.01;
    let mut broke_at_m = None;
    while state.steps < 20_000 {
        interact(&mut state);
        let broken = state.bonds.is_broken(0);
        let pressed_m = APART_M - distance_m(&state);
        let contacts = state.contacts.as_ref().unwrap();
        if let Some(at) = contacts.pairs.iter().position(|pair| *pair == [0, 1]) {
            let history = &contacts.histories[at];
            if broken && broke_at_m.is_none() {
                assert!(pressed_m > 0.0);
                broke_at_m = Some(pressed_m);
            }
            if pressed_m > 0.0 && history.origin_m() == origin_m {
                assert!((history.overlap_m() - pressed_m).abs() < 1e-15);
            }
            assert!(history.origin_m() <= origin_m * (1.0 + 1e-12));
        }
        let books = balance(&mut state);
        assert!(
            books.energy_error_j.abs() < 2e-3 * energy_j,
            "{}",
            books.energy_error_j
        );
        advance(&mut state);
    }
    let broke_at_m = broke_at_m.expect("the bond breaks");
    assert!(
        broke_at_m > 1e-6 && distance_m(&state) > 2e-3,
        "{broke_at_m}"
    );
}

/// A row of overlapping spheres that hits another, with breakage.
fn rows(end_s: f64) -> String {
    let row = |name: &str, x_m: f64, speed_m_s: f64| {
        let spheres: Vec<String> = (0..12)
            .map(|n| {
                format!(
                    "[{:e}, {:e}, 0, 1e-3]",
                    1.9e-3 * f64::from(n),
                    1e-4 * f64::from(n % 3)
                )
            })
            .collect();
        let bonds: Vec<String> = (0..11).map(|n| format!("[{n}, {}]", n + 1)).collect();
        format!(
            "[bodies.{name}]\nmaterial = \"m\"\nbonds = \"m\"\nparticles = [{}]\nbond_list = [{}]\n\
             position = [{x_m:e}, 0, 0]\nvelocity = [{speed_m_s:e}, 0, 0]\n",
            spheres.join(", "),
            bonds.join(", ")
        )
    };
    head(
        &format!("run.end_time = {end_s:e}"),
        0.7,
        ", failure = { compressive_strength = 5e3, shear_strength = 3e3 }",
    ) + &row("a", 0.0, 0.0)
        + &row("b", -25e-3, 1.0)
}

#[test]
fn threads_and_interruptions_do_not_change_the_bits() {
    let end_s = 2e-2;
    let text = rows(end_s);
    let ends = [1, 2, 3].map(|threads| {
        let mut state = planned(&scene(&text), threads).state;
        while state.time_s < end_s {
            step(&mut state);
        }
        state
    });
    assert!(ends[0].broken_count > 0);
    for other in &ends[1..] {
        assert_eq!(ends[0].particles.poses, other.particles.poses);
        assert_eq!(ends[0].ledger, other.ledger);
    }
    let scene = scene(&(text + "[output]\nseries = 1e-3\nframes = 1e-2\n"));
    let parent = tempfile::tempdir().unwrap();
    let [whole, parted] = ["whole", "parted"].map(|name| parent.path().join(name));
    let of_whole = ResultsFolder::create(&whole, Existing::Refuse).unwrap();
    run_into(&of_whole, planned(&scene, 1), &scene, None, 2.0).unwrap();
    let folder = ResultsFolder::create(&parted, Existing::Refuse).unwrap();
    run_into(&folder, planned(&scene, 1), &scene, None, 0.4).unwrap_err();
    drop(folder);
    let folder = ResultsFolder::create(&parted, Existing::Continue).unwrap();
    let snapshot = read_checkpoint(&folder.file(names::CHECKPOINT)).unwrap();
    let snapshot = Snapshot::from_bytes(&snapshot).unwrap();
    run_into(&folder, planned(&scene, 1), &scene, Some(snapshot), 2.0).unwrap();
    for name in ["series.csv", "events.csv", "frames/frame_000002.vtp"] {
        let [one, other] = [&whole, &parted].map(|at| fs::read(at.join(name)).unwrap());
        assert!(one == other, "{name}");
    }
}
