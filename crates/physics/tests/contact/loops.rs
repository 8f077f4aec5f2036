//! No closed loop creates energy.

use super::world::{Vector, Z, ZERO, material};
use dem_physics::contact::kinematics::ContactKinematics;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::pair_parameters::{PairInput, TangentialUnloading};
use dem_physics::contact::rolling::ElasticPlastic;
use dem_physics::contact::{ContactEnergy, ContactSprings, NormalLaw, Response, response};
use dem_physics::number::Vec3;
use proptest::prelude::*;

/// A state of a prescribed contact: overlap over 1e-5 m, tangential displacement over 1e-6 m,
/// tangential rotation over 1e-3 rad.
type Place = [f64; 5];

const ROLLING: ElasticPlastic = ElasticPlastic {
    friction: 0.1,
    damping_ratio: 0.0,
};

fn undamped(kept: TangentialUnloading) -> PairInput {
    PairInput {
        kept,
        ..PairInput::new(1.0, 0.3)
    }
}

fn hertz(kept: TangentialUnloading) -> HertzMindlin {
    let rock = material(1e9, 0.25);
    HertzMindlin::new([rock, rock], &undamped(kept))
}

fn touch(overlap_m: f64, moved: Vector, turned: Vector) -> ContactKinematics {
    ContactKinematics {
        normal: Z,
        middle: Z,
        overlap_m,
        levers_m: [0.01; 2],
        velocity_m_s: moved,
        spin_rad_s: turned,
        mean_spin_rad_s: 0.0,
        effective_radius_m: 0.005,
        effective_mass_kg: 0.01,
        effective_rolling_inertia_kg_m2: 1e-6,
    }
}

/// Result of a path: work done tangentially and by rotation, and the loss given by the law.
struct Led {
    work: f64,
    lost: f64,
    /// The smallest loss of the law by its own bound, and the largest energy stored.
    bound: f64,
    scale: f64,
    last: Response,
}

/// Moves a contact along straight lines between states, in this many steps each, of 1 s.
fn lead<L: NormalLaw<f64>>(law: &L, places: &[Place], steps: u32) -> Led {
    let start = touch(places[0][0] * 1e-5, ZERO, ZERO);
    let mut last = response(law, &ROLLING, &start, &ContactSprings::default(), 0.0);
    let (mut work, mut lost, mut bound, mut scale) = (0.0, 0.0, 0.0, 0.0_f64);
    for pair in places.windows(2) {
        for step in 1..=steps {
            let at =
                |place: usize, part: f64| pair[0][place] * (1.0 - part) + pair[1][place] * part;
            let part = f64::from(step) / f64::from(steps);
            let by = |place: usize| (pair[1][place] - pair[0][place]) / f64::from(steps);
            let moved = Vec3(by(1) * 1e-6, by(2) * 1e-6, 0.0);
            let turned = Vec3(by(3) * 1e-3, by(4) * 1e-3, 0.0);
            let touch = touch(at(0, part) * 1e-5, moved, turned);
            let next = response(law, &ROLLING, &touch, &last.springs, 1.0);
            let held = |r: &Response| Vec3(r.force_on_b.0, r.force_on_b.1, 0.0);
            work -= 0.5 * (held(&last) + held(&next)).dot(moved);
            work -= 0.5 * (last.moment_on_b + next.moment_on_b).dot(turned);
            lost += next.lost.sliding + next.lost.rolling;

            let normal_response = law.evaluate(&touch, last.springs.overlap_m, 1.0);
            let kept = normal_response.stiffness_ratio.min(1.0);
            let [before, now] = normal_response.tangential_n_m;
            bound += least(
                before,
                now,
                kept,
                last.springs.tangential_m,
                moved,
                next.springs.tangential_m,
            );
            let rolling = |k: f64| k * 2.25 * (0.1 * 0.005_f64).powi(2);
            let [before, now] = normal_response.normal_n_m.map(rolling);
            bound += least(
                before,
                now,
                kept,
                last.springs.rolling_rad,
                turned,
                next.springs.rolling_rad,
            );
            scale = scale.max(next.energy.tangential + next.energy.rolling);
            last = next;
        }
    }
    Led {
        work,
        lost,
        bound,
        scale,
        last,
    }
}

/// The smallest loss of a step. With W the mean of the old and the new force times the motion x,
/// and c the factor to which sliding reduces the spring, W - (U_new - U_old) is concave in c. At
/// c = 0 it is at least -k_old x^2 / 8; at c = 1 at least -(k_old - k_new) x^2 / 8 while the load
/// decreases, and at least 0 while it increases. Both bounds are reached only if the motion
/// reverses more than the entire force.
fn least(before: f64, now: f64, kept: f64, old: Vector, moved: Vector, new: Vector) -> f64 {
    let stuck = old * kept + moved * (0.5 * (1.0 + kept));
    let cut = (new.square() / stuck.square().max(f64::MIN_POSITIVE))
        .sqrt()
        .min(1.0);
    if old.dot(moved) >= 0.0 {
        return 0.0;
    }
    -((1.0 - cut) * before + cut * (before - now).max(0.0)) * moved.square() / 8.0
}

fn stored(energy: &ContactEnergy) -> f64 {
    energy.tangential + energy.rolling
}

/// Pressed, displaced, partly unloaded, moved back: a spring that keeps its force gains energy,
/// this law does not.
#[test]
fn a_stuck_contact_creates_no_energy() {
    let places = [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.1, 0.0, 0.0, 0.0],
        [0.25, 0.1, 0.0, 0.0, 0.0],
        [0.25, -0.1, 0.0, 0.0, 0.0],
    ];
    let forceful = lead(&hertz(TangentialUnloading::Force), &places, 1000);
    assert!(forceful.work < -0.1 * forceful.scale, "{}", forceful.work);
    let careful = lead(&hertz(TangentialUnloading::LesserForce), &places, 1000);
    assert!(careful.work > 0.0, "{}", careful.work);
}

/// The normal force is the derivative of the energy, so loading and unloading loses nothing.
#[test]
fn the_normal_force_comes_from_an_energy() {
    check_energy(&hertz(TangentialUnloading::LesserForce));
    check_energy(&Linear::new(
        1e6,
        0.8,
        &undamped(TangentialUnloading::LesserForce),
    ));
}

fn check_energy(law: &impl NormalLaw<f64>) {
    let at = |overlap: f64| {
        let touch = touch(overlap, ZERO, ZERO);
        response(law, &ROLLING, &touch, &ContactSprings::default(), 0.0)
    };
    for overlap in [1e-7, 1e-6, 1e-5] {
        let h = 1e-4 * overlap;
        let rise = at(overlap + h).energy.normal - at(overlap - h).energy.normal;
        super::assert_near(at(overlap).force_on_b.2, rise / (2.0 * h), 1e-8);
    }
}

fn places() -> impl Strategy<Value = Vec<Place>> {
    let place = (
        -0.3..1.0_f64,
        -1.0..1.0_f64,
        -1.0..1.0_f64,
        -1.0..1.0_f64,
        -1.0..1.0_f64,
    );
    prop::collection::vec(place.prop_map(|(a, b, c, d, e)| [a, b, c, d, e]), 2..8)
}

fn check<L: NormalLaw<f64>>(
    law: &L,
    mut places: Vec<Place>,
    steps: u32,
) -> Result<(), TestCaseError> {
    places.push(places[0]);
    let led = lead(law, &places, steps);
    let rounding = 1e-13 * led.scale * f64::from(steps) * places.len() as f64;
    prop_assert!(
        led.lost >= led.bound - rounding,
        "{} below {}",
        led.lost,
        led.bound
    );
    // The losses are the work done minus the stored energy.
    let there = stored(&led.last.energy);
    prop_assert!(
        (led.work - there - led.lost).abs() <= rounding,
        "{} {} {}",
        led.work,
        there,
        led.lost
    );
    // Once apart, no energy is left to return.
    places.push([-0.1, 0.0, 0.0, 0.0, 0.0]);
    let led = lead(law, &places, steps);
    prop_assert_eq!(stored(&led.last.energy), 0.0);
    prop_assert!(led.work >= led.bound - rounding);
    Ok(())
}

proptest! {
    #[test]
    fn no_loop_creates_energy_with_hertz(places in places(), steps in 1..200_u32) {
        check(&hertz(TangentialUnloading::LesserForce), places, steps)?;
    }

    #[test]
    fn no_loop_creates_energy_with_a_linear_law(places in places(), steps in 1..200_u32) {
        check(&Linear::new(1e6, 0.8, &undamped(TangentialUnloading::LesserForce)), places, steps)?;
    }
}
