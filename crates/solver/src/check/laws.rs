//! Up to where the laws of bonds and contacts hold, and what says beforehand that a scene goes
//! beyond.

use dem_io::scene::Factor;
use dem_io::units::{show_length, significant};
use nalgebra::Vector3;

use crate::check::linear::overlap_at_impact;
use crate::state::State;

/// Elongation of a bond above which linear elasticity is doubtful: an error of the same order.
pub const LARGEST_STRAIN: f64 = 0.1;
/// Overlap over the smaller radius above which the contact laws are doubtful: the radius of Hertz's
/// contact, which should be small, is 0.55 of the sphere's there.
pub const LARGEST_OVERLAP: f64 = 0.3;

/// That bonds are strained beyond what they mean, `where_`. None: they are not.
pub fn strain_warning(largest: f64, where_: &str) -> Option<String> {
    (largest > LARGEST_STRAIN).then(|| {
        format!(
            "a bond was strained by {} %{where_}: bonds are linear elastic, which holds up to about {} %; check its Young's modulus, the loads and the speeds",
            significant(100.0 * largest, 3),
            100.0 * LARGEST_STRAIN,
        )
    })
}

/// That a contact is pressed in beyond what its law means, `where_`. None: it is not.
pub fn overlap_warning(largest: f64, where_: &str) -> Option<String> {
    (largest > LARGEST_OVERLAP).then(|| {
        format!(
            "a contact was pressed in by {} of the smaller radius{where_}: contact laws hold for small overlaps, up to about {LARGEST_OVERLAP}; check the moduli of the materials, the loads and the speeds",
            significant(largest, 3),
        )
    })
}

/// What loads, weight and impacts at this speed, m/s, will do beyond the laws, a sentence each. None:
/// nothing can meet anything.
pub fn foreseen(state: &State, impact_speed_m_s: Option<f64>) -> Vec<String> {
    let mut warnings = Vec::new();
    let softest = softest_bond(state);
    if let Some((modulus_pa, density_kg_m3)) = softest {
        let modulus = format!("a Young's modulus of {} Pa", significant(modulus_pa, 3));
        let wave_m_s = (modulus_pa / density_kg_m3).sqrt();
        if let Some(impact_speed_m_s) = impact_speed_m_s
            && impact_speed_m_s > LARGEST_STRAIN * wave_m_s
        {
            warnings.push(format!(
                "an impact at {} m/s strains bonds of {modulus} by about {} %: bonds are linear elastic, which holds up to about {} %; check the modulus and its unit",
                significant(impact_speed_m_s, 3),
                significant(100.0 * impact_speed_m_s / wave_m_s, 2),
                100.0 * LARGEST_STRAIN
            ));
        }
        let gravity = Vector3::from(state.gravity_m_s2);
        let height_m = height_m(state, &gravity);
        let by_weight = density_kg_m3 * gravity.norm() * height_m / modulus_pa;
        if by_weight > LARGEST_STRAIN {
            warnings.push(format!(
                "its own weight strains a column of {} of bonds of {modulus} by about {} %: bonds are linear elastic, which holds up to about {} %; check the modulus and its unit",
                show_length(height_m),
                significant(100.0 * by_weight, 2),
                100.0 * LARGEST_STRAIN
            ));
        }
    }
    warnings.extend(by_loads(state));
    if let Some(impact_speed_m_s) = impact_speed_m_s
        && let overlap = overlap_at_impact(state, impact_speed_m_s)
        && overlap > LARGEST_OVERLAP
    {
        warnings.push(format!(
            "an impact at {} m/s presses a single particle in by about {} of its radius: contact laws hold for small overlaps, up to about {LARGEST_OVERLAP}; check the moduli of the materials and their units",
            significant(impact_speed_m_s, 3),
            significant(overlap, 2)
        ));
    }
    warnings
}

/// Young's modulus, Pa, of the softest bond, and the density of a particle that it joins, kg/m3.
fn softest_bond(state: &State) -> Option<(f64, f64)> {
    let bonds = &state.bonds;
    let modulus_pa = |at: usize| {
        let radius_m = bonds.radius_m(at);
        let area_m2 = std::f64::consts::PI * radius_m * radius_m;
        bonds.stiffness(at).normal * bonds.initial_length_m(at) / area_m2
    };
    let whole = (0..bonds.len()).filter(|&at| !bonds.is_broken(at));
    let softest = whole.map(|at| (modulus_pa(at), at));
    let (modulus_pa, at) = softest.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((modulus_pa, state.density_kg_m3(bonds.ends[at][0] as usize)))
}

/// Height of all bonded particles along gravity, m; 0 without gravity.
fn height_m(state: &State, gravity: &Vector3<f64>) -> f64 {
    let Some(down) = gravity.try_normalize(0.0) else {
        return 0.0;
    };
    let bodies = state.bonds.ends.iter().flatten();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &end in bodies {
        let depth_m = state.particles.poses[end as usize].place().dot(&down);
        (low, high) = (low.min(depth_m), high.max(depth_m));
    }
    (high - low).max(0.0)
}

/// Largest value of a factor over time.
fn largest(factor: &Factor) -> f64 {
    match factor {
        Factor::One | Factor::Ramp { .. } => 1.0,
        Factor::Table(points) => points.iter().fold(0.0, |most, [_, f]| most.max(f.abs())),
    }
}

/// Loads that alone strain the bonds of the particles that they act on beyond what is meant.
fn by_loads(state: &State) -> Option<String> {
    let mut holds_n = vec![0.0; state.particles.len()];
    for (at, ends) in state.bonds.ends.iter().enumerate() {
        let stiff_n = state.bonds.stiffness(at).normal * state.bonds.initial_length_m(at);
        for &end in ends {
            holds_n[end as usize] += stiff_n;
        }
    }
    let strains = state.loads.iter().flat_map(|load| {
        let force_n = Vector3::from(load.force_n).norm() * largest(&load.factor);
        let held = load.particles.iter().map(|&i| holds_n[i as usize]);
        held.filter(|stiff_n| *stiff_n > 0.0)
            .map(move |stiff_n| force_n / stiff_n)
    });
    let largest = strains.fold(0.0, f64::max);
    (largest > LARGEST_STRAIN).then(|| {
        format!(
            "a load strains the bonds of a particle on which it acts by at least {} %: bonds are linear elastic, which holds up to about {} %; check the load, the modulus and their units",
            significant(100.0 * largest, 2),
            100.0 * LARGEST_STRAIN
        )
    })
}
