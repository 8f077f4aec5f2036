//! Local damping spares the rigid motion of what nothing holds.

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact, step};
use nalgebra::Vector3;

use crate::bars::{ELASTIC, bar, damp_particles, reopen, shake, tumble};
use crate::helpers::started;
use dem_physics::bond::stiffness::BondModel;

/// Momentum, and angular momentum about the centre of mass, of all particles.
fn momenta(state: &State) -> [Vector3<f64>; 2] {
    let p = &state.particles;
    let each = || p.poses.iter().zip(&p.motions);
    let mass_kg: f64 = each().map(|(_, motion)| 1.0 / motion.inverse_mass).sum();
    let moments = each().map(|(pose, motion)| pose.place() / motion.inverse_mass);
    let centre = moments.sum::<Vector3<f64>>() / mass_kg;
    let linear = |velocity: [f64; 3], inverse: f64| Vector3::from(velocity) / inverse;
    let along = each().map(|(_, motion)| linear(motion.velocity_m_s, motion.inverse_mass));
    let about = each().map(|(pose, motion)| {
        let own = linear(motion.velocity_m_s, motion.inverse_mass);
        (pose.place() - centre).cross(&own) + linear(motion.spin_rad_s, motion.inverse_inertia)
    });
    [along.sum(), about.sum()]
}

/// A bar that tumbles and vibrates keeps its momenta to rounding, and falls with g; what is lost is
/// its vibration alone.
#[test]
fn a_free_body_keeps_its_momenta_and_falls_with_g() {
    let mut state = bar(BondModel::Timoshenko, ELASTIC, 2e-5);
    damp_particles(&mut state, 0.3);
    tumble(&mut state);
    let before = momenta(&state);
    for _ in 0..2000 {
        step(&mut state);
    }
    // Over the sum of the magnitudes, of which rounding is a part.
    let scales = balance(&mut state).momentum_scales;
    for ((now, then), scale) in momenta(&state).iter().zip(&before).zip(scales) {
        assert!((now - then).norm() < 1e-11 * scale, "{now} {then}");
    }
    // Without turning nothing but vibration is left to lose, and it goes.
    let mut state = bar(BondModel::Timoshenko, ELASTIC, 2e-5);
    damp_particles(&mut state, 0.3);
    state.model.gravity_m_s2 = [0.0, 0.0, -9.81];
    shake(&mut state, 0.1);
    let before = momenta(&state);
    let mass_kg: f64 = state
        .particles
        .motions
        .iter()
        .map(|m| 1.0 / m.inverse_mass)
        .sum();
    for motion in &mut state.particles.motions {
        let [x, y, z] = (before[0] / mass_kg).into();
        let own = &mut motion.velocity_m_s;
        *own = [own[0] - x, own[1] - y, own[2] - z];
    }
    reopen(&mut state);
    let start_s = state.time_s;
    let mut elastic_j = 0.0_f64;
    let mut last_j = 0.0;
    for _ in 0..20_000 {
        interact(&mut state);
        if state.steps.is_multiple_of(100) {
            let now = balance(&mut state);
            last_j = now.elastic_j();
            elastic_j = elastic_j.max(last_j);
            assert!(now.energy_error.abs() < 1e-2, "{}", now.energy_error);
        }
        advance(&mut state);
    }
    assert!(last_j < 0.02 * elastic_j, "{last_j} of {elastic_j}");
    let fallen_m_s = momenta(&state)[0].z / mass_kg;
    let wanted_m_s = -9.81 * (state.time_s - start_s);
    assert!(
        (fallen_m_s / wanted_m_s - 1.0).abs() < 1e-3,
        "{fallen_m_s} {wanted_m_s}"
    );
}

const BLOCK: &str = "version = 1
run = { end_time = 1, gravity = [0, 0, -9.81], local_damping = 0.3, time_step = \"2 us\" }
materials.m = { density = 2000, young_modulus = \"10 MPa\", poisson_ratio = 0.25 }
contacts.m-m = { restitution = 0.9, friction = 0.3 }
bonds.m = { young_modulus = \"10 MPa\", poisson_ratio = 0.25 }
";

/// A row of two bonded spheres, one above the other, from a height.
fn pair(name: &str, height_m: f64, velocity_m_s: f64) -> String {
    let [low, high] = [height_m + 5e-3, height_m + 15e-3];
    format!(
        "bodies.{name} = {{ material = \"m\", bonds = \"m\", velocity = [0, 0, {velocity_m_s}], \
         particles = [[0, 0, {low}, 5e-3], [0, 0, {high}, 5e-3]], bond_list = [[0, 1]] }}\n"
    )
}

/// Falls undamped, and comes to rest on the floor.
#[test]
fn a_body_falls_undamped_and_rests_on_a_wall() {
    let floor =
        "walls.f = { material = \"m\", plane = { point = [0, 0, 0], normal = [0, 0, 1] } }\n";
    let mut state = started(&format!("{BLOCK}{}{floor}", pair("b", 0.01, 0.0)));
    let mut fastest_m_s = 0.0_f64;
    while state.time_s < 0.5 {
        step(&mut state);
        fastest_m_s = fastest_m_s.min(state.particles.motions[0].velocity_m_s[2]);
    }
    let wanted_m_s = -(2.0 * 9.81 * 0.01_f64).sqrt();
    assert!(
        (fastest_m_s / wanted_m_s - 1.0).abs() < 0.02,
        "{fastest_m_s} {wanted_m_s}"
    );
    for motion in &state.particles.motions {
        assert!(
            Vector3::from(motion.velocity_m_s).norm() < 1e-3,
            "{motion:?}"
        );
    }
    assert!(state.particles.poses[0].place().z > 4.5e-3);
}

/// Two bodies that meet in flight push each other with equal and opposite forces, and nothing else.
#[test]
fn an_impact_in_flight_keeps_the_momentum_of_both() {
    let text = format!("{BLOCK}{}{}", pair("a", 0.0, 1.0), pair("b", 0.021, -0.5));
    let text = text.replace("gravity = [0, 0, -9.81], ", "");
    let mut state = started(&text);
    let before = momenta(&state)[0];
    while state.time_s < 4e-3 {
        step(&mut state);
    }
    let p = &state.particles;
    assert!(p.motions[2].velocity_m_s[2] > 0.1, "they have met");
    assert!((momenta(&state)[0] - before).norm() < 1e-12 * before.norm());
}
