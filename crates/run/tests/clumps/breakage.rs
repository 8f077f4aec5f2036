//! Particles that break by the law of their material: into what, what is kept, and damage.

use std::f64::consts::PI;

use dem_engine::Balance;
use dem_engine::state::State;
use dem_engine::state::events::{BrokenInto, PopulationEvent};
use dem_engine::step::exchange;
use dem_physics::breakage::daughters::diameters_m;
use dem_physics::breakage::{BreakageLaw, damage};

use super::planned;
use crate::helpers::step_and_balance;

const RADIUS_M: f64 = 5e-3;
const DENSITY_KG_M3: f64 = 2500.0;
const LAW: BreakageLaw = BreakageLaw {
    largest_t10: 0.6,
    b_kg_j: 0.2,
    fracture_energy_j_kg: 3.0,
    energy_scatter: 0.0,
    reference_size_m: 20e-3,
    b_exponent: 0.5,
    energy_exponent: 1.0,
    family_exponent: 0.87,
};

fn ball_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

/// A ball that breaks by the law, and plates.
fn scene(ball: &str, rule: &str, more: &str, scatter: f64, restitution: f64) -> String {
    format!(
        "version = 1
run.end_time = 0.1
materials.anvil.rigid = true
contacts.ore-ore = {{ restitution = {restitution}, friction = 0.4 }}
contacts.ore-anvil = {{ restitution = {restitution}, friction = 0.0 }}
replacement.ball.breakage = {{ {rule} }}
[materials.ore]
density = {DENSITY_KG_M3}
young_modulus = 1e8
poisson_ratio = 0.25
breakage = {{ largest_t10 = 0.6, b = 0.2, fracture_energy = 3, energy_scatter = {scatter}, reference_size = 20e-3, b_exponent = 0.5, energy_exponent = 1, family_exponent = 0.87 }}
[bodies.ball]
particles = [[0, 0, 0, {RADIUS_M}]]
material = \"ore\"
start_as = \"clump\"
{ball}
[walls.plate]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = \"anvil\"
{more}\n"
    )
}

/// Falls on the plate with this speed. The state at the end, what happened, and the last balance.
fn hit(speed_m_s: f64, rule: &str, step: f64) -> (State, Vec<PopulationEvent>, Balance) {
    let ball = format!(
        "position = [0, 0, {}]\nvelocity = [1, 0.3, {}]\nangular_velocity = [30, 0, -20]",
        RADIUS_M + 1e-5,
        -speed_m_s
    );
    let mut state = planned(&scene(&ball, rule, "", 0.0, 0.7)).state;
    state.time_step_s *= step;
    let mut events = Vec::new();
    let mut last = Balance::default();
    while state.time_s < 3e-3 {
        last = step_and_balance(&mut state);
        events.extend(state.scratch.events.population.clone());
    }
    (state, events, last)
}

fn mass_kg(state: &State) -> f64 {
    let clumps = state.clumps.all.iter();
    clumps
        .map(|clump| state.clumps.template(clump).mass_kg)
        .sum()
}

#[test]
fn an_impact_breaks_a_particle_into_what_the_law_says_and_keeps_its_mass_and_motion() {
    let size_m = 2.0 * RADIUS_M;
    // Particles of half the reference size break from 6 J/kg.
    let (state, events, _) = hit(11.9_f64.sqrt(), "smallest_size = 2e-3", 1.0);
    assert!(events.is_empty() && state.clumps.all.len() == 1);
    for speed_m_s in [4.0, 8.0, 13.0] {
        let (state, events, last) = hit(speed_m_s, "smallest_size = 2e-3", 1.0);
        let Some(PopulationEvent::Broken {
            into: BrokenInto::Law { t10, fines_kg },
            specific_j_kg,
            daughters,
            mass_kg: masses,
            momentum_n_s,
            ..
        }) = events.first()
        else {
            panic!("{events:?}");
        };
        let energy_j_kg = 0.5 * speed_m_s * speed_m_s;
        let crushed = *t10 >= LAW.nearly_largest_t10();
        assert!(crushed || (specific_j_kg / energy_j_kg - 1.0).abs() < 0.03);
        assert!((t10 - LAW.t10(size_m, *specific_j_kg, 6.0)).abs() < 1e-12);
        let wanted = diameters_m(LAW.family_exponent, *t10, size_m, 2e-3);
        assert_eq!(daughters.1, wanted.len());
        let part: f64 = wanted.iter().map(|d| (d / size_m).powi(3)).sum();
        assert!((masses[1] / (part * masses[0]) - 1.0).abs() < 1e-12);
        assert!(((masses[1] + fines_kg) / masses[0] - 1.0).abs() < 1e-14);
        assert!((momentum_n_s[1] / (part * momentum_n_s[0]) - 1.0).abs() < 1e-12);
        let fines_kg: f64 = state.population.fines_kg.iter().sum();
        assert!(((mass_kg(&state) + fines_kg) / ball_kg() - 1.0).abs() < 1e-13);
        assert!(last.momentum_error < 1e-11, "{last:?}");
        assert!(last.angular_momentum_error < 1e-9, "{last:?}");
    }
}

#[test]
fn the_balance_closes_with_the_step() {
    let errors = [1.0, 0.5, 0.25].map(|step| {
        let (state, events, last) = hit(5.0, "smallest_size = 3e-3", step);
        assert!(!events.is_empty() && state.clumps.all.len() > 3);
        last.energy_error.abs()
    });
    eprintln!("{errors:?}");
    assert!(errors[0] < 1e-3 && errors[2] < 1e-4, "{errors:?}");
}

#[test]
fn a_particle_too_small_for_daughters_becomes_fines() {
    let (state, events, last) = hit(20.0, "smallest_size = 9.9e-3", 1.0);
    assert_eq!((events.len(), state.clumps.all.len()), (1, 0));
    let fines_kg: f64 = state.population.fines_kg.iter().sum();
    assert!((fines_kg / ball_kg() - 1.0).abs() < 1e-14);
    assert!(last.momentum_error < 1e-12, "{last:?}");
}

#[test]
fn hits_below_the_fracture_energy_add_up_as_tavares_says() {
    // A ball bounces between two plates without loss: the same energy in every hit.
    for part in [0.5, 0.7, 0.9] {
        let speed_m_s = (2.0 * part * 6.0_f64).sqrt();
        let above = format!(
            "[walls.above]\nplane = {{ point = [0, 0, {}], normal = [0, 0, -1] }}\nmaterial = \"anvil\"",
            2.2 * RADIUS_M
        );
        let ball = format!(
            "position = [0, 0, {}]\nvelocity = [0, 0, {}]",
            1.1 * RADIUS_M,
            -speed_m_s
        );
        let rule = "smallest_size = 2e-3, damage_exponent = 5";
        let mut state = planned(&scene(&ball, rule, &above, 0.0, 1.0)).state;
        let (mut left, mut wanted) = (1.0, 1);
        while left > part {
            left *= 1.0 - damage(part / left, 5.0);
            wanted += 1;
        }
        let mut hits = 0;
        let mut touches = false;
        let mut broken = false;
        while !broken && hits < 100 {
            step_and_balance(&mut state);
            let touched = touches;
            touches = state.walls.iter().any(|wall| {
                let mut touching = wall.touching.iter();
                touching.any(|touch| touch.history.overlap_m() > 0.0)
            });
            hits += usize::from(touches && !touched);
            broken = !state.scratch.events.population.is_empty();
        }
        assert!(wanted > 1);
        assert_eq!(hits, wanted, "{part}");
    }
}

#[test]
fn fracture_energies_scatter_as_stated() {
    // A ball in mid-air that has taken in 8 J/kg, fed often.
    let state = planned(&scene(
        "position = [0, 0, 1]",
        "smallest_size = 2e-3",
        "",
        0.5,
        0.5,
    ))
    .state;
    let count = 2000_u32;
    let broken = (0..count)
        .filter(|first_id| {
            let mut state = state.clone();
            state.clumps.all[0].first_id = *first_id;
            state.clumps.all[0].intake.impact_j = 8.0 * ball_kg();
            exchange(&mut state);
            state.population.by_daughters.iter().sum::<u32>() > 0
        })
        .count();
    let law = BreakageLaw {
        energy_scatter: 0.5,
        ..LAW
    };
    let wanted = law.broken_share(2.0 * RADIUS_M, 8.0);
    let deviation = (wanted * (1.0 - wanted) / f64::from(count)).sqrt();
    let share = broken as f64 / f64::from(count);
    assert!((share - wanted).abs() < 4.0 * deviation, "{share} {wanted}");
}
