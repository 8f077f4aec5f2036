//! Clouds of spheres that fall on walls: fixed, rotating, a belt, loaded by a servo.

use std::sync::Arc;

use dem_engine::check::limit::{Bound, limit};
use dem_engine::check::linearised_contacts::{
    StiffestContacts, contact_rates, largest_contact_rate_1_s2,
};
use dem_engine::stages::ledger::bookkeeping::{balance, opened};
use dem_engine::state::State;
use dem_engine::state::walls::{Wall, WallModel};
use dem_engine::step::{advance, interact};
use dem_physics::geometry::{Frame, Plane, Shape, SolidBox};
use dem_physics::machine::{Gyration, Orbit};
use dem_scene::{Factor, WallMotion};

use super::clouds::{cloud, kinds};

fn wall(shape: Shape, motion: WallMotion, belt_m_s: [f64; 3]) -> Wall {
    let model = WallModel {
        name: String::new(),
        shape,
        motion,
        surface_velocity_m_s: belt_m_s,
        kind_of: vec![0, 2],
        kinds: kinds().to_vec(),
        book: None,
    };
    Wall::new(Arc::new(model), Frame::default())
}

fn floor(motion: WallMotion, belt_m_s: [f64; 3]) -> Wall {
    let plane = Plane::new([0.0, 0.0, -5e-3], [0.0, 0.0, 1.0]).unwrap();
    wall(Shape::Plane(plane), motion, belt_m_s)
}

/// A cloud that falls on these walls.
fn falling(walls: Vec<Wall>, time_step_s: f64) -> State {
    let mut state = cloud(0.1e-3, 2, time_step_s);
    state.model.gravity_m_s2 = [0.0, 0.0, -9.81];
    for motion in &mut state.particles.motions {
        motion.velocity_m_s[2] -= 1.0;
    }
    state.walls = walls;
    state.ledger = opened(&state);
    state
}

fn worst_energy_error(walls: &[Wall], time_step_s: f64) -> f64 {
    let mut state = falling(walls.to_vec(), time_step_s);
    let mut worst = 0.0_f64;
    while state.time_s < 4e-3 {
        interact(&mut state);
        if state.steps.is_multiple_of(20) {
            let balance = balance(&mut state);
            worst = worst.max(balance.energy_error.abs());
            // Contributions of walls are summed step by step, with rounding in each.
            let rounding = 1e-13 + f64::EPSILON * state.steps as f64;
            let errors = [balance.momentum_error, balance.angular_momentum_error];
            assert!(
                errors.iter().all(|e| *e < rounding),
                "{errors:?}, step {}",
                state.steps
            );
        }
        advance(&mut state);
    }
    interact(&mut state);
    eprintln!(
        "dt {time_step_s:e}: worst {worst:.2e} {:?}",
        balance(&mut state)
    );
    worst
}

#[test]
fn the_books_balance_whatever_the_walls_do() {
    let turning = WallMotion::Velocity {
        velocity_m_s: [0.1, 0.0, 0.3],
        spin_rad_s: [20.0, 10.0, 30.0],
        factor: Factor::One,
    };
    let shaken = WallMotion::Displacement {
        displacement_m: [1e-3, 0.0, 0.5e-3],
        angular_displacement_rad: [0.0; 3],
        factor: Factor::Ramp { until_s: 3e-3 },
    };
    let orbit = WallMotion::Orbit(Orbit {
        axis: [0.0, 1.0, 0.0],
        towards: [-1.0, 0.0, 0.0],
        radius_m: 0.5e-3,
        frequency_hz: 200.0,
    });
    let gyration = WallMotion::Gyration(Gyration {
        axis: [0.0, 0.0, 1.0],
        towards: [0.0, 1.0, 0.0],
        angle_rad: 0.1,
        frequency_hz: 200.0,
        spin_rad_s: 20.0,
    });
    let swing = WallMotion::Displacement {
        displacement_m: [0.0; 3],
        angular_displacement_rad: [0.1, 0.05, 0.0],
        factor: Factor::Oscillation {
            frequency_hz: 200.0,
            phase_rad: -0.5,
        },
    };
    let block = SolidBox::new([-4e-3, -4e-3, -12e-3], [4e-3, 4e-3, -5e-3]).unwrap();
    for (name, walls) in [
        ("floor", vec![floor(WallMotion::Fixed, [0.0; 3])]),
        ("belt", vec![floor(WallMotion::Fixed, [0.5, 0.2, 0.0])]),
        ("turning", vec![floor(turning.clone(), [0.0; 3])]),
        ("orbit", vec![floor(orbit, [0.0; 3])]),
        ("gyration", vec![floor(gyration, [0.0; 3])]),
        ("swing", vec![floor(swing, [0.0; 3])]),
        (
            "shaken block",
            vec![wall(Shape::Box(block), shaken, [0.0; 3])],
        ),
    ] {
        let errors = [4e-7, 2e-7, 1e-7].map(|dt| worst_energy_error(&walls, dt));
        eprintln!("{name}: {errors:?}");
        assert!(errors[2] < 2e-5, "{name}: {errors:?}");
        assert!(
            errors[0] > 3.0 * errors[1] && errors[1] > 3.0 * errors[2],
            "{name}: {errors:?}"
        );
    }
}

/// The limit of contacts alone, computed by the fast and the exact method: the first is never above
/// the second, and not far below.
#[test]
fn a_quick_bound_of_the_limit_is_on_the_safe_side() {
    let mut state = falling(vec![floor(WallMotion::Fixed, [0.0; 3])], 4e-7);
    let free = Bound {
        step_s: f64::INFINITY,
        is_damped: false,
    };
    let mut fractions = Vec::new();
    while state.time_s < 4e-3 {
        interact(&mut state);
        if state.steps.is_multiple_of(200) {
            let exact_s = limit(&mut state).step_s;
            let bound_s = free.with_more(contact_rates(&state));
            if exact_s.is_finite() {
                fractions.push(bound_s / exact_s);
            }
        }
        advance(&mut state);
    }
    let smallest = fractions
        .iter()
        .fold(f64::INFINITY, |least, fraction| least.min(*fraction));
    let largest = fractions
        .iter()
        .fold(0.0_f64, |most, fraction| most.max(*fraction));
    eprintln!(
        "{} limits, bounds {smallest:.3} to {largest:.3} of them",
        fractions.len()
    );
    assert!(
        fractions.len() > 30 && smallest > 0.3 && largest < 1.0 + 1e-4,
        "{fractions:?}"
    );
}

/// Contacts that cannot be stiffer than a limit are skipped; the stiffest is found whenever it is
/// above that limit.
#[test]
fn the_stiffest_contact_is_found_among_those_that_matter() {
    let mut state = falling(vec![floor(WallMotion::Fixed, [0.0; 3])], 4e-7);
    let p = &state.particles;
    let radius_m = p
        .poses
        .iter()
        .fold(0.0, |r: f64, pose| r.max(pose.radius_m()));
    let inverse_kg = p
        .motions
        .iter()
        .fold(0.0, |m: f64, motion| m.max(motion.inverse_mass));
    let mut looks = 0;
    while state.time_s < 4e-3 {
        interact(&mut state);
        if state.steps.is_multiple_of(100) {
            let largest = largest_contact_rate_1_s2(&state, StiffestContacts::ALL);
            looks += usize::from(largest > 0.0);
            for fraction in [0.0, 0.3, 0.9, 0.999, 1.001, 3.0] {
                let matters = StiffestContacts {
                    above_1_s2: fraction * largest,
                    extremes: Some([radius_m, inverse_kg]),
                };
                let found = largest_contact_rate_1_s2(&state, matters);
                if fraction < 1.0 {
                    assert_eq!(found, largest, "above {fraction} of it");
                } else {
                    assert!(found <= largest, "above {fraction} of it");
                }
            }
        }
        advance(&mut state);
    }
    assert!(looks > 30, "{looks} looks with contacts");
}
