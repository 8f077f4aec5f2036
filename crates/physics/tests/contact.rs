//! Contact laws compared with an independent implementation and closed forms, and their invariants.

mod books;
mod dmt;
mod documented;
mod hertz;
mod impact;
mod keeping;
mod loops;
mod motion;
mod relaxation;
mod restitution;
mod rolling;
mod world;

use serde::Deserialize;

/// Results of an independent implementation, and analytical values.
#[derive(Deserialize)]
struct Reference {
    hertz_elastic: Vec<Elastic>,
    tsuji_restitution: Vec<Tsuji>,
    alpha_for_wanted_e_without_attraction: Vec<Alpha>,
    chung_ooi_4: Impacts,
    slide_to_roll: SlideToRoll,
    incline: Incline,
    static_weight_overlap: Weight,
}

#[derive(Deserialize)]
struct Elastic {
    #[serde(rename = "E")]
    young: f64,
    nu: f64,
    rho: f64,
    #[serde(rename = "R")]
    radius: f64,
    v_rel: f64,
    two_spheres: bool,
    #[serde(rename = "Es")]
    e_star: f64,
    #[serde(rename = "Gs")]
    g_star: f64,
    delta_max: f64,
    #[serde(rename = "F_max")]
    f_max: f64,
    t_contact: f64,
    tolerance_rel: f64,
}

#[derive(Deserialize)]
struct Tsuji {
    e_nominal: f64,
    beta: f64,
    e_actual_force_until_overlap_zero: f64,
    e_actual_truncated_no_attraction: f64,
    duration_ratio_vs_elastic: f64,
    duration_ratio_truncated: f64,
    max_overlap_ratio: f64,
}

#[derive(Deserialize)]
struct Alpha {
    e_wanted: f64,
    alpha: f64,
    beta_equiv: f64,
}

#[derive(Deserialize)]
struct Impacts {
    rows: Vec<Impact>,
}

#[derive(Deserialize)]
struct Impact {
    material: String,
    e: f64,
    angle: f64,
    mu: f64,
    variant1: Rebound,
    variant2: Rebound,
}

#[derive(Deserialize)]
struct Rebound {
    e_n: f64,
    e_t: f64,
    omega: f64,
}

#[derive(Deserialize)]
struct SlideToRoll {
    v0: f64,
    mu: f64,
    g: f64,
    #[serde(rename = "R")]
    radius: f64,
    t_roll: f64,
    x_roll: f64,
    v_final: f64,
    omega_final: f64,
    energy_lost_fraction: f64,
}

#[derive(Deserialize)]
struct Incline {
    g: f64,
    #[serde(rename = "R")]
    radius: f64,
    rows: Vec<Slope>,
}

#[derive(Deserialize)]
struct Slope {
    theta_deg: f64,
    mu: f64,
    sphere_rolls: bool,
    a_sphere: f64,
    alpha_sphere: f64,
    friction_over_weight_sphere: f64,
    block_sticks: bool,
    a_block: f64,
}

#[derive(Deserialize)]
struct Weight {
    #[serde(rename = "E")]
    young: f64,
    nu: f64,
    rho: f64,
    #[serde(rename = "R")]
    radius: f64,
    overlap: f64,
}

fn reference() -> Reference {
    serde_json::from_str(include_str!("contact/data/contact.json")).unwrap()
}

#[track_caller]
fn assert_near(found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found - wanted).abs() <= tolerance * wanted.abs().max(f64::MIN_POSITIVE),
        "{found} instead of {wanted}: {:e}",
        found / wanted - 1.0
    );
}
