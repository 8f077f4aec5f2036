//! The speed from which a rigid row of spheres that hits a pin counts as broken by bending, beside
//! that from which bonds of the row break when it is bonded.

use std::fmt::Write;

use dem_engine::state::clumps::Clump;

use super::{happens, planned};

const APART_M: f64 = 9e-3;
const RADIUS_M: f64 = 5e-3;
/// The two agree within this factor.
const FACTOR: f64 = 1.6;

/// Whether a row of this many spheres, with contacts of this modulus, breaks when it hits a pin at
/// this fraction of its length.
fn breaks((count, at, contact_mpa): (u32, f64, f64), start_as: &str, speed_m_s: f64) -> bool {
    let first_m = -0.5 * APART_M * f64::from(count - 1);
    let pin_m = first_m * (1.0 - 2.0 * at);
    let (mut places, mut bonds) = (String::new(), String::new());
    for n in 0..count {
        let x_m = first_m + APART_M * f64::from(n);
        write!(places, "[{x_m}, 0, 0.00502, {RADIUS_M}], ").unwrap();
        if n > 0 {
            write!(bonds, "[{}, {n}], ", n - 1).unwrap();
        }
    }
    let mut state = planned(&format!(
        "version = 1\n\
         run.end_time = \"20 ms\"\n\
         materials.stone = {{ density = 2500, young_modulus = \"{contact_mpa} MPa\", poisson_ratio = 0.25 }}\n\
         contacts.stone-stone = {{ restitution = 0.5, friction = 0.3 }}\n\
         bonds.glue = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25, failure = {{ tensile_strength = \"3 MPa\" }} }}\n\
         bodies.rod = {{ particles = [{places}], bond_list = [{bonds}], material = \"stone\", bonds = \"glue\", start_as = \"{start_as}\", velocity = [0, 0, {}] }}\n\
         walls.pin = {{ cylinder = {{ from = [{pin_m}, -0.1, -0.005], to = [{pin_m}, 0.1, -0.005], radius = 0.005 }}, material = \"stone\" }}\n",
        -speed_m_s
    ))
    .state;
    while state.time_s < 20e-3 {
        happens(&mut state);
        let hit = |clump: &Clump| clump.hits.over > 0 || clump.hits.now_n_m > 0.0;
        if state.broken_count > 0 || state.clumps.all.iter().any(hit) {
            return true;
        }
    }
    false
}

#[test]
fn a_rigid_row_counts_as_broken_where_the_bonded_one_breaks() {
    for case in [
        (10, 0.5, 10.0),
        (20, 0.25, 1000.0),
        (30, 0.5, 1000.0),
        (30, 0.0, 1000.0),
        (60, 0.25, 10.0),
    ] {
        let [mut whole_m_s, mut broken_m_s] = [0.1, 10.0];
        assert!(!breaks(case, "bonded", whole_m_s) && breaks(case, "bonded", broken_m_s));
        while broken_m_s > 1.02 * whole_m_s {
            let between_m_s = f64::sqrt(whole_m_s * broken_m_s);
            if breaks(case, "bonded", between_m_s) {
                broken_m_s = between_m_s;
            } else {
                whole_m_s = between_m_s;
            }
        }
        let counts = [1.0 / FACTOR, FACTOR].map(|by| breaks(case, "clump", by * broken_m_s));
        assert_eq!(
            counts,
            [false, true],
            "{case:?}, breaks at {broken_m_s} m/s"
        );
    }
}
