//! Bonds of the bodies of a scene.

use std::ops::Add;

use dem_io::body::histories::PLASTIC_ELONGATION;
use dem_io::units::significant;
use dem_io::{Body, Diagnostic, Result};
use dem_scene::BondKind;

use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bonds::{BondRule, Bonds, moment_ratios, share_moment_ratios};
use dem_engine::state::particles::Particles;
use dem_physics::bond::damping::{DampingCoefficients, DampingModel, reduced};
use dem_physics::bond::damping_models::{Chen, ChenByMode, ModeRatios, Platzer};
use dem_physics::bond::pair::frequencies;
use dem_physics::bond::scatter::strength_factor;
use dem_physics::bond::stiffness::{BondShape, Stiffness, stiffness};
use dem_physics::bond::total::direction;

/// A length in a file counts as the rest length of the bond in its initial position if the two
/// differ by less than this fraction.
const SAME_LENGTH: f64 = 1e-9;

/// Adds the bonds of a body, of the kind `kind` with the number `rule`, whose strengths scatter by
/// this seed and key.
pub(super) fn place_bonds(
    body: &Body,
    kind: &BondKind,
    rule: usize,
    (seed, body_key): (u64, u64),
    particles: &Particles,
    placed: &mut PlacedBody,
    bonds: &mut Bonds,
) -> Result<()> {
    let sorted = in_order(body, placed);
    bonds.reserve_exact(sorted.len());
    placed.bonds.reserve_exact(sorted.len());
    let damped = bonds.rules.iter().any(|rule| rule.damped);
    let mut ratios = bonds.moment_ratios_of(rule);
    for (ends, original) in sorted {
        placed.bonds.push(original);
        let original = original as usize;
        let [a, b] = ends.map(|end| end as usize);
        let apart = particles.poses[b].place() - particles.poses[a].place();
        let shape = shape(body, kind, original, particles, [a, b]);
        let answer = stiffness(
            kind.model,
            &shape,
            kind.young_modulus_pa,
            kind.poisson_ratio,
        );
        check_bond(original, apart.norm(), &answer, particles, [a, b])?;
        let own_ratios = moment_ratios(&answer, shape.radius_m);
        check_ratios(original, ratios.get_or_insert(own_ratios), &own_ratios)?;
        bonds.push(
            ends,
            direction(&apart).into(),
            shape.radius_m,
            &answer,
            rule,
        );
        let at = bonds.len() - 1;
        if damped {
            bonds.set_damping(at, damping(kind, &answer, particles, [a, b]));
        }
        if let Some(modulus) = kind.failure.weibull_modulus {
            let pair = body.bonds[original].map(u64::from);
            bonds.set_strength_factor(at, strength_factor(seed, body_key, pair, modulus));
        }
        let damage = body.bond_damages.get(original).copied().unwrap_or(0.0);
        damage_last(original, bonds, rule, damage)?;
    }
    Ok(())
}

/// The particles of each bond of a body in the state, and its number in the body's file, in the
/// order of [`Bonds`].
fn in_order(body: &Body, placed: &PlacedBody) -> Vec<([u32; 2], u32)> {
    let mut sorted: Vec<([u32; 2], u32)> = (0..)
        .zip(&body.bonds)
        .map(|(original, ends)| {
            let [a, b] = ends.map(|end| placed.particles[end as usize]);
            ([a.min(b), a.max(b)], original)
        })
        .collect();
    sorted.sort_unstable();
    sorted
}

/// The bond with this number in its file, between these particles, before it was loaded.
fn shape(
    body: &Body,
    kind: &BondKind,
    number: usize,
    particles: &Particles,
    ends: [usize; 2],
) -> BondShape {
    let [a, b] = ends.map(|end| &particles.poses[end]);
    let distance = (b.place() - a.place()).norm();
    let end_radii_m = [a.radius_m(), b.radius_m()];
    let given = body.bond_lengths[number];
    let at_rest = (given - distance).abs() <= SAME_LENGTH * distance;
    let elongation_m = body.history_of(PLASTIC_ELONGATION, number).first();
    BondShape {
        length_m: if at_rest { distance } else { given } - elongation_m.unwrap_or(&0.0),
        radius_m: match kind.radius_factor {
            Some(factor) => factor * end_radii_m[0].min(end_radii_m[1]),
            None => body.bond_radii[number],
        },
        end_radii_m,
    }
}

/// Gives the last bond, with this number in its file, the damage that it has there.
fn damage_last(number: usize, bonds: &mut Bonds, rule: usize, damage: f64) -> Result<()> {
    if bonds.rules[rule].law.fracture_energy_j_m2().is_some() {
        check_fracture_energy(number, bonds, &bonds.rules[rule])?;
    } else if damage > 0.0 {
        return Err(Diagnostic::input(
            format!("bond {number}"),
            format!("it is damaged ({damage}), and its kind of bonds has no fracture_energy"),
            "add fracture_energy to its failure table, or remove the array 'damage' from the file",
        ));
    }
    if damage > 0.0 {
        bonds.set_damage(bonds.len() - 1, damage);
    }
    Ok(())
}

/// Whether the last bond, with this number in its file, stores less than its fracture energy when
/// it reaches a strength, apart from scatter.
fn check_fracture_energy(number: usize, bonds: &Bonds, rule: &BondRule) -> Result<()> {
    let at = bonds.len() - 1;
    let energy_j_m2 = rule.law.fracture_energy_j_m2().unwrap_or_default();
    let factor = bonds.undamaged_strength_factor(at);
    let ratios = bonds.opening_ratios(at).into_iter().flatten();
    let least = ratios.fold(f64::INFINITY, f64::min) * factor * factor;
    if least > 1.0 {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("bond {number}"),
        format!(
            "{} m long, it stores {} J/m2 when it reaches its strength, not less than its fracture_energy of {} J/m2",
            significant(bonds.initial_length_m(at), 4),
            significant(energy_j_m2 / least, 4),
            significant(energy_j_m2, 4),
        ),
        "give more fracture energy or less strength, pack smaller spheres, or leave fracture_energy out: such bonds break at once",
    ))
}

/// Whether a bond of a body's file has a direction, and a frequency in the range of floating-point
/// numbers.
fn check_bond(
    number: usize,
    distance_m: f64,
    answer: &Stiffness,
    particles: &Particles,
    ends: [usize; 2],
) -> Result<()> {
    if distance_m == 0.0 {
        return Err(Diagnostic::input(
            format!("bond {number}"),
            "its two particles are at the same place",
            "move one of them, or remove the bond",
        ));
    }
    let step_s = frequencies(
        answer,
        ends.map(|end| particles.motions[end].inverse_mass),
        ends.map(|end| particles.motions[end].inverse_inertia),
    )
    .critical_step_s();
    let is_usable = |x: f64| x.is_normal() && x > 0.0;
    if [distance_m, step_s, answer.normal]
        .into_iter()
        .all(is_usable)
    {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("bond {number}"),
        format!(
            "{distance_m:.3e} m long and {:.3e} N/m stiff, it would need a time step of {step_s:.3e} s, which is too small to integrate",
            answer.normal
        ),
        "check the units of places, radii, density and modulus",
    ))
}

/// Whether a bond of a body's file has the ratios of its stiffnesses in common with those of its
/// kind.
fn check_ratios(number: usize, of_kind: &[f64; 2], own: &[f64; 2]) -> Result<()> {
    if share_moment_ratios(of_kind, own) {
        return Ok(());
    }
    let [torsion, bending] = own.map(|ratio| significant(ratio, 4));
    let [torsion_before, bending_before] = of_kind.map(|ratio| significant(ratio, 4));
    Err(Diagnostic::input(
        format!("bond {number}"),
        format!(
            "its torsional over its bending stiffness is {torsion}, and bending over normal stiffness and radius squared {bending}, where bonds of its kind have {torsion_before} and {bending_before}"
        ),
        "choose a model whose ratios do not vary from bond to bond, or give these bonds a kind of their own",
    ))
}

fn damping(
    kind: &BondKind,
    answer: &Stiffness,
    particles: &Particles,
    ends: [usize; 2],
) -> [f64; 4] {
    let damping = &kind.damping;
    let reduced = reduced(
        ends.map(|end| particles.motions[end].inverse_mass),
        ends.map(|end| particles.motions[end].inverse_inertia),
    );
    let damping_ratio = damping.damping_ratio;
    let by_ratio: &dyn DampingModel = if damping.per_mode {
        &ChenByMode { damping_ratio }
    } else {
        &Chen { damping_ratio }
    };
    let by_coefficient = Platzer {
        coefficient_n_s_m: damping.damping_coefficient_n_s_m,
        moment_factor: damping.torque_factor,
    };
    let by_mode = ModeRatios {
        normal: damping.normal_damping_ratio,
        shear: damping.shear_damping_ratio,
        torsion: damping.torsion_damping_ratio,
        bending: damping.bending_damping_ratio,
    };
    let models: [&dyn DampingModel; 3] = [by_ratio, &by_coefficient, &by_mode];
    let coefficients = models.map(|model| model.coefficients(answer, &reduced));
    let all = coefficients
        .into_iter()
        .fold(DampingCoefficients::default(), Add::add);
    all.into()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A kind of bonds stores two ratios of stiffnesses for all of its bonds: a model whose ratios
    /// vary is refused instead of computed with those of another bond.
    #[test]
    fn bonds_of_other_ratios_are_refused() {
        let of = |torsion: f64, bending: f64| {
            let stiffness = Stiffness {
                normal: 1e6,
                shear: 4e5,
                torsion,
                bending,
                levers_m: [1e-3; 2],
            };
            moment_ratios(&stiffness, 1e-3)
        };
        let round = of(0.19, 0.25);
        check_ratios(1, &round, &of(0.19 * (1.0 + 1e-12), 0.25)).unwrap();
        check_ratios(1, &of(0.0, 0.0), &of(0.0, 0.0)).unwrap();
        for other in [of(0.2, 0.25), of(0.19, 0.26), of(0.0, 0.0)] {
            let said = check_ratios(7, &round, &other).unwrap_err().to_string();
            assert!(
                said.starts_with("bond 7: its torsional over its bending"),
                "{said}"
            );
        }
    }
}
