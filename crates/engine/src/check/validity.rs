//! Range of validity of the bond and contact laws, and warnings before a run that a scene will
//! exceed it.

use dem_io::units::{show_length, show_quantity, significant};
use nalgebra::Vector3;
use std::ops::Range;

use crate::check::linearised_contacts::impact::indentation_at_impact;
use crate::state::State;
use crate::state::bodies::PlacedBody;
use crate::state::bonds::Bonds;
use crate::state::events::REMOVED;

/// Strain at the edge of a bond above which linear elasticity is doubtful: its error is of the same
/// order.
pub const LARGEST_STRAIN: f64 = 0.1;
/// [Indentation] above which the contact laws are doubtful: the radius of Hertz's contact, which
/// should be small, is then 0.55 of the sphere's.
///
/// [Indentation]: dem_physics::contact::kinematics::indentation
pub const LARGEST_INDENTATION: f64 = 0.3;

/// Warning that bonds are strained beyond the validity of their law, `where_`. None: they are not.
pub fn strain_warning(largest: f64, where_: &str) -> Option<String> {
    (largest > LARGEST_STRAIN).then(|| {
        format!(
            "a bond was strained by {} %{where_}: bonds are linear elastic, which holds up to about {} %; check its Young's modulus, the loads and the speeds",
            significant(100.0 * largest, 3),
            100.0 * LARGEST_STRAIN,
        )
    })
}

/// Warning that a bond has flowed beyond the validity of its law, `where_`. None: none has.
pub fn plastic_strain_warning(largest: f64, where_: &str) -> Option<String> {
    (largest > LARGEST_STRAIN).then(|| {
        format!(
            "a bond yielded by {} % at its edge{where_}: the plastic law of bonds is for strains up to about {} %, beyond which spheres pass into each other without touching; check its yield strengths and their units, the loads and the speeds",
            significant(100.0 * largest, 3),
            100.0 * LARGEST_STRAIN,
        )
    })
}

/// Warning that a contact presses a sphere in beyond the validity of its law, `where_`. None: none
/// does.
pub fn indentation_warning(largest: f64, where_: &str) -> Option<String> {
    (largest > LARGEST_INDENTATION).then(|| {
        // A value that three digits do not tell from the limit gets more.
        let digits = if largest < 1.01 * LARGEST_INDENTATION { 6 } else { 3 };
        format!(
            "a contact pressed a sphere in by {} of its radius{where_}: contact laws hold for small deformations, up to about {LARGEST_INDENTATION}; check the moduli of the materials, the loads and the speeds",
            significant(largest, digits),
        )
    })
}

/// Predicted effects of loads, weight and impacts at this speed, m/s (None: nothing can touch),
/// beyond the validity of the laws, a sentence each.
pub fn foreseen(
    state: &State,
    bodies: &[PlacedBody],
    impact_speed_m_s: Option<f64>,
) -> Vec<String> {
    let mut warnings = Vec::new();
    let limit = format!(
        "bonds are linear elastic, which holds up to about {} %",
        100.0 * LARGEST_STRAIN
    );
    for body in assemblies(state, bodies) {
        let of_bonds = format!(
            "bonds of '{}', of a Young's modulus of {},",
            body.name,
            show_quantity(body.modulus_pa, "Pa")
        );
        let wave_m_s = (body.modulus_pa / body.density_kg_m3).sqrt();
        if let Some(speed_m_s) = impact_speed_m_s
            && speed_m_s > LARGEST_STRAIN * wave_m_s
        {
            warnings.push(format!(
                "an impact at {} m/s strains {of_bonds} by about {} %: {limit}; check the modulus and its unit",
                significant(speed_m_s, 3),
                significant(100.0 * speed_m_s / wave_m_s, 2)
            ));
        }
        let gravity = Vector3::from(state.model.gravity_m_s2).norm();
        let by_weight = body.density_kg_m3 * gravity * body.height_m / body.modulus_pa;
        if by_weight > LARGEST_STRAIN {
            warnings.push(format!(
                "the weight of a column of {} strains {of_bonds} by about {} %: {limit}; check the modulus and its unit",
                show_length(body.height_m),
                significant(100.0 * by_weight, 2)
            ));
        }
    }
    warnings.extend(by_loads(state));
    if let Some(speed_m_s) = impact_speed_m_s
        && let pressed = indentation_at_impact(state, speed_m_s)
        && pressed > LARGEST_INDENTATION
    {
        warnings.push(format!(
            "an impact at {} m/s presses a single particle in by about {} of its radius: contact laws hold for small deformations, up to about {LARGEST_INDENTATION}; check the moduli of the materials and their units",
            significant(speed_m_s, 3),
            significant(pressed, 2)
        ));
    }
    warnings
}

/// A bonded body, or one that clumps become.
struct Assembly<'a> {
    name: &'a str,
    /// Modulus of its softest bond.
    modulus_pa: f64,
    /// Density of a sphere that this bond joins.
    density_kg_m3: f64,
    /// Height along gravity; half the largest extent for a body that may have any orientation.
    height_m: f64,
}

fn assemblies<'a>(state: &'a State, bodies: &'a [PlacedBody]) -> Vec<Assembly<'a>> {
    let down = Vector3::from(state.model.gravity_m_s2).try_normalize(0.0);
    let of_bodies = bodies.iter().filter_map(|body| {
        let range = body.first_bond..body.first_bond + body.bonds.len();
        let (modulus_pa, at) = softest_bond(&state.bonds, range)?;
        let end = state.bonds.ends[at][0] as usize;
        let depths = body.particles.iter().filter(|i| **i != REMOVED).map(|&i| {
            let place = state.particles.poses[i as usize].place();
            down.map_or(0.0, |down| place.dot(&down))
        });
        let (low, high) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), depth| {
            (low.min(depth), high.max(depth))
        });
        Some(Assembly {
            name: &body.name,
            modulus_pa,
            density_kg_m3: state.density_kg_m3(end),
            height_m: (high - low).max(0.0),
        })
    });
    let templates = state.clumps.templates.iter().enumerate();
    let of_templates = templates.filter_map(|(n, template)| {
        let rules = &state.model.rules;
        let becomes_bonded = rules.starts.get(n).is_some_and(|start| start.bonded)
            || rules.triggers.get(n).is_some_and(Option::is_some);
        let (modulus_pa, at) = softest_bond(&template.bonds, 0..template.bonds.len())?;
        let sphere = &template.spheres[template.bonds.ends[at][0] as usize];
        let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * sphere.radius_m.powi(3);
        becomes_bonded.then(|| Assembly {
            name: &template.body,
            modulus_pa,
            density_kg_m3: sphere.mass_kg / volume_m3,
            height_m: template.reach_m,
        })
    });
    of_bodies.chain(of_templates).collect()
}

/// The softest unbroken bond in a range, and its Young's modulus, Pa.
fn softest_bond(bonds: &Bonds, range: Range<usize>) -> Option<(f64, usize)> {
    let modulus_pa = |at: usize| {
        let radius_m = bonds.radius_m(at);
        let area_m2 = std::f64::consts::PI * radius_m * radius_m;
        bonds.stiffness(at).normal * bonds.initial_length_m(at) / area_m2
    };
    let whole = range.filter(|&at| !bonds.is_broken(at));
    let softest = whole.map(|at| (modulus_pa(at), at));
    softest.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Loads that by themselves strain the bonds of their particles beyond the range of validity.
fn by_loads(state: &State) -> Option<String> {
    let mut holds_n = vec![0.0; state.particles.len()];
    for (at, ends) in state.bonds.ends.iter().enumerate() {
        let stiff_n = state.bonds.stiffness(at).normal * state.bonds.initial_length_m(at);
        for &end in ends {
            holds_n[end as usize] += stiff_n;
        }
    }
    let strains = state.loads.iter().flat_map(|load| {
        let force_n = Vector3::from(load.force_n).norm() * load.factor.largest();
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
