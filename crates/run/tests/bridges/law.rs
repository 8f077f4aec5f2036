//! The force law of a bridge and its energy.

use std::f64::consts::PI;

use dem_physics::contact::liquid_bridge::LiquidBridge;

use super::{RADIUS_M, WATER, assert_near};

/// Effective radius of two equal spheres, m.
const BETWEEN_M: f64 = 0.5 * RADIUS_M;

#[test]
fn the_pull_of_ends_that_touch_is_that_of_the_closed_form() {
    let per_radius = PI * WATER.surface_tension_n_m * WATER.contact_angle_rad.cos();
    assert_near(
        WATER.force_n(0.0, BETWEEN_M),
        2.0 * per_radius * RADIUS_M,
        1e-14,
    );
    // At a wall.
    assert_near(
        WATER.force_n(0.0, RADIUS_M),
        4.0 * per_radius * RADIUS_M,
        1e-14,
    );
    let overlapping = WATER.force_n(-0.1 * RADIUS_M, RADIUS_M);
    assert_eq!(overlapping, WATER.force_n(0.0, RADIUS_M));
    // Independent of the volume.
    let more = LiquidBridge {
        volume_m3: 1e-11,
        ..WATER
    };
    assert_eq!(more.force_n(0.0, RADIUS_M), WATER.force_n(0.0, RADIUS_M));
}

/// Equation 12 of Willett et al. 2000 as printed: with half the gap.
#[test]
fn the_fall_with_the_gap_is_that_of_the_source() {
    for share in [0.01, 0.1, 0.5, 1.0] {
        let gap_m = share * WATER.rupture_m();
        let half = 0.5 * gap_m / (WATER.volume_m3 / RADIUS_M).sqrt();
        let star = WATER.contact_angle_rad.cos() / (1.0 + 2.1 * half + 10.0 * half * half);
        let printed_n = 2.0 * PI * RADIUS_M * WATER.surface_tension_n_m * star;
        assert_near(WATER.force_n(gap_m, BETWEEN_M), printed_n, 1e-13);
    }
}

/// Lian et al. 1993.
#[test]
fn the_gap_at_rupture_is_that_of_the_source() {
    assert_near(WATER.rupture_m(), 1.15e-4, 1e-12);
    let wetting = LiquidBridge {
        contact_angle_rad: 0.0,
        ..WATER
    };
    assert_near(wetting.rupture_m(), 1e-4, 1e-12);
}

/// Central differences, and Simpson's rule for the work.
#[test]
fn force_energy_and_stiffness_belong_together() {
    let end_m = WATER.rupture_m();
    for radius_m in [BETWEEN_M, RADIUS_M, 10.0 * RADIUS_M] {
        let h = 2e-6 * end_m;
        for share in [-0.2, -1e-3, 1e-3, 0.05, 0.3, 0.9] {
            let gap_m = share * end_m;
            let energy = |gap_m: f64| WATER.energy_j(gap_m, radius_m);
            let slope = (energy(gap_m + h) - energy(gap_m - h)) / (2.0 * h);
            assert_near(slope, WATER.force_n(gap_m, radius_m), 1e-8);
            let force = |gap_m: f64| WATER.force_n(gap_m, radius_m);
            let fall = (force(gap_m - h) - force(gap_m + h)) / (2.0 * h);
            let wanted = WATER.fall_n_m(gap_m, radius_m);
            assert!((fall - wanted).abs() <= 1e-7 * WATER.steepest_n_m(radius_m));
        }
        let count = 20_000;
        let simpson: f64 = (0..=count)
            .map(|n| {
                let weight = if n == 0 || n == count {
                    1.0
                } else {
                    2.0 + 2.0 * f64::from(n % 2)
                };
                weight * WATER.force_n(end_m * f64::from(n) / f64::from(count), radius_m)
            })
            .sum();
        assert_near(
            WATER.work_j(radius_m),
            simpson * end_m / (3.0 * f64::from(count)),
            1e-10,
        );
        let falls =
            (0..=count).map(|n| WATER.fall_n_m(end_m * f64::from(n) / f64::from(count), radius_m));
        let steepest = falls.fold(0.0, f64::max);
        assert_near(steepest, WATER.steepest_n_m(radius_m), 1e-4);
        assert!(steepest <= WATER.steepest_n_m(radius_m));
    }
}

/// What forms at a touch and ruptures apart loses its work, whatever the gaps in between.
#[test]
fn a_cycle_loses_the_work_of_the_bridge() {
    let ends = WATER.rupture_m();
    // A step ends at the touch and another at the rupture.
    let formed = WATER.after_step(BETWEEN_M, [1e-9 * ends, 0.0], [false, true]);
    let ruptured = WATER.after_step(BETWEEN_M, [ends, (1.0 + 1e-9) * ends], [true, false]);
    let held = WATER.after_step(BETWEEN_M, [0.0, ends], [true, true]);
    assert_eq!(held, [WATER.force_n(ends, BETWEEN_M), 0.0]);
    assert_near(formed[1] + ruptured[1], WATER.work_j(BETWEEN_M), 1e-8);
    assert_eq!(ruptured[0], 0.0);
}
