//! Closed forms compared with an independent implementation.

use std::f64::consts::PI;

use dem_laboratory::theory::{Beam, KAPPA, ON_PINS, bar_stress_pa, disc_stress_pa};
use serde::Deserialize;

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "names of the reference values")]
struct Reference {
    input: Input,
    I: f64,
    a: f64,
    failure_force_eq19_N: f64,
    w_eq18_at_failure: f64,
    stiffness_eq18_N_per_m: f64,
    outer_fibre_strain_at_failure: f64,
    shear_deflection_at_pin: ByKappa,
    w_timo_at_failure: ByKappa,
    shear_over_bending: ByKappa,
    fe3d: Vec<FiniteElements>,
}

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "names of the reference values")]
struct Input {
    L: f64,
    b: f64,
    h: f64,
    d: f64,
    E: f64,
    nu_assumed: f64,
    sigma: f64,
}

#[derive(Deserialize)]
struct ByKappa {
    #[serde(rename = "kappa_5/6")]
    five_sixths: f64,
    kappa_cowper: f64,
}

#[derive(Deserialize)]
struct FiniteElements {
    neutral: f64,
    sigma_bottom_over_eq19: f64,
}

fn reference() -> (Reference, Beam) {
    let read: Reference = serde_json::from_str(include_str!("data/bending.json")).unwrap();
    let beam = Beam {
        span_m: read.input.L,
        loading_span_m: read.input.d,
        width_m: read.input.b,
        height_m: read.input.h,
    };
    (read, beam)
}

/// Equal except for the rounding of a few operations.
#[track_caller]
fn assert_same(got: f64, wanted: f64) {
    assert!(
        (got / wanted - 1.0).abs() < 1e-14,
        "{got:e} is not {wanted:e}"
    );
}

/// Shear coefficient of a rectangle by Cowper 1966.
fn kappa_cowper(poisson_ratio: f64) -> f64 {
    10.0 * (1.0 + poisson_ratio) / (12.0 + 11.0 * poisson_ratio)
}

#[test]
fn four_point_bending_is_that_of_the_reference() {
    let (read, beam) = reference();
    let (modulus, nu) = (read.input.E, read.input.nu_assumed);
    let force = beam.force_n(read.input.sigma);
    assert_same(beam.second_moment_m4(), read.I);
    assert_same(beam.arm_m(), read.a);
    assert_same(force, read.failure_force_eq19_N);
    assert_same(beam.stress_pa(force), read.input.sigma);
    let bending = beam.deflection_m(force, modulus);
    assert_same(bending, read.w_eq18_at_failure);
    assert_same(
        modulus * beam.bending_shape_m(),
        read.stiffness_eq18_N_per_m,
    );
    assert_same(
        read.input.sigma / modulus,
        read.outer_fibre_strain_at_failure,
    );
    for (kappa, shear, both, fraction) in [
        (
            KAPPA,
            read.shear_deflection_at_pin.five_sixths,
            read.w_timo_at_failure.five_sixths,
            read.shear_over_bending.five_sixths,
        ),
        (
            kappa_cowper(nu),
            read.shear_deflection_at_pin.kappa_cowper,
            read.w_timo_at_failure.kappa_cowper,
            read.shear_over_bending.kappa_cowper,
        ),
    ] {
        assert_same(beam.shear_deflection_m(force, modulus, nu, kappa), shear);
        assert_same(beam.shear_over_bending(nu, kappa), fraction);
        assert_same(force / beam.stiffness_n_m(modulus, nu, kappa), both);
    }
}

/// Finite-element solids bend slightly less than Timoshenko's beam, and their stress is that of
/// eq. 19.
#[test]
fn finite_elements_agree_with_the_beam_with_shear() {
    let (read, beam) = reference();
    let force = beam.force_n(read.input.sigma);
    let with_shear = force / beam.stiffness_n_m(read.input.E, read.input.nu_assumed, KAPPA);
    assert_eq!(read.fe3d.len(), 5);
    for solid in &read.fe3d {
        let off = solid.neutral / with_shear - 1.0;
        assert!((-0.025..0.0).contains(&off), "{off}");
        assert!((solid.sigma_bottom_over_eq19 - 1.0).abs() < 0.004);
    }
}

#[test]
fn one_pin_is_the_beam_of_the_text_books() {
    let beam = Beam {
        span_m: 0.16,
        loading_span_m: 0.0,
        width_m: 0.03,
        height_m: 0.02,
    };
    let (force, modulus) = (40.0, 1e7);
    let second_moment = 0.03 * 0.02_f64.powi(3) / 12.0;
    let wanted = force * 0.16_f64.powi(3) / (48.0 * modulus * second_moment);
    assert_same(beam.deflection_m(force, modulus), wanted);
    let moment = force * 0.16 / 4.0;
    assert_same(beam.stress_pa(force), moment * 0.01 / second_moment);
    // F L/(4 kappa G A)
    let shear = beam.shear_deflection_m(force, modulus, 0.25, KAPPA);
    assert_same(shear, force * 0.16 / (4.0 * KAPPA * 4e6 * 0.0006));
}

#[test]
fn discs_and_bars() {
    assert_same(disc_stress_pa(100.0, 0.05, 0.02), 200.0 / (PI * 0.001));
    assert_same(bar_stress_pa(100.0, 0.0004), 250_000.0);
    // The first root of cos x cosh x = 1.
    let mut x = 4.7_f64;
    for _ in 0..50 {
        let slope = x.cos() * x.sinh() - x.sin() * x.cosh();
        x -= (x.cos() * x.cosh() - 1.0) / slope;
    }
    assert!((ON_PINS / (PI / x).powi(2) - 1.0).abs() < 1e-6);
}
