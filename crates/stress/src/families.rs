//! Families of pairs, rows and impacts over orders of magnitude: ratios, sizes, moduli,
//! coordinates, short bonds.

use dem_io::Result;

use super::impact::{Impact, Target};
use super::limit_map::program_limit;
use super::oscillator::Row;
use super::prediction::Member;
use dem_physics::bond::stiffness::BondModel;

const TIMOSHENKO: (BondModel, &str) = (BondModel::Timoshenko, "timoshenko");

/// Three equal spheres, the second bond so much thinner than the first that it is softer by the
/// ratio.
pub(crate) fn stiffness_ratios() -> Result<Vec<Member>> {
    let member = |ratio: f64| {
        let row = Row {
            radii_m: vec![1e-3; 3],
            distances_m: vec![2e-3; 2],
            bond_radii_m: vec![1e-3, 1e-3 / ratio.sqrt()],
            fraction: 0.35,
            ..Row::pair()
        };
        row.member(format!("ratio {ratio:e}"), TIMOSHENKO)
    };
    [1e2, 1e4, 1e6].into_iter().map(member).collect()
}

/// A small sphere and a large one, bonded; and the same two in an impact.
pub(crate) fn mass_ratios() -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for ratio in [10.0, 100.0_f64] {
        let row = Row {
            radii_m: vec![1e-3, ratio * 1e-3],
            distances_m: vec![(1.0 + ratio) * 1e-3],
            ..Row::pair()
        };
        members.push(row.member(format!("bonded, ratio {:e}", ratio.powi(3)), TIMOSHENKO)?);
        let impact = Impact {
            target: Target::Sphere(ratio * 1e-3),
            restitution: 0.5,
            ..Impact::usual()
        };
        members.push(impact.member(format!("colliding, ratio {:e}", ratio.powi(3))));
    }
    Ok(members)
}

/// A pair and an impact of spheres of 0.1 m far from the origin, where a coordinate is rounded to
/// 1e-10 m; and of 1 um so far away that rounding would exceed the radius.
pub(crate) fn coordinates() -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for at_m in [0.0, 1e6] {
        let row = Row {
            radii_m: vec![0.1; 2],
            distances_m: vec![0.2],
            bond_radii_m: vec![0.1],
            at_m,
            ..Row::pair()
        };
        members.push(row.member(format!("bonded at {at_m:e} m"), TIMOSHENKO)?);
        let impact = Impact {
            radius_m: 0.1,
            at_m,
            ..Impact::usual()
        };
        members.push(impact.member(format!("colliding at {at_m:e} m")));
    }
    let lost = Impact {
        radius_m: 1e-6,
        at_m: 1e6,
        ..Impact::usual()
    };
    let trial = lost.trial("\"auto\"");
    let words = ["particle 0", "its coordinates are rounded by"];
    members.push(lost.ended_by("1 um at 1e6 m".to_owned(), trial, true, &words));
    Ok(members)
}

/// Pairs and impacts at one speed: the same numbers in units of the radius.
pub(crate) fn sizes() -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for radius_m in [1e-6, 1e-3, 1.0, 1e3] {
        let row = Row {
            radii_m: vec![radius_m; 2],
            distances_m: vec![2.0 * radius_m],
            bond_radii_m: vec![radius_m],
            ..Row::pair()
        };
        members.push(row.member(format!("bonded, {radius_m:e} m"), TIMOSHENKO)?);
        let impact = Impact {
            radius_m,
            ..Impact::usual()
        };
        members.push(impact.member(format!("colliding, {radius_m:e} m")));
    }
    Ok(members)
}

/// Pairs, and impacts at a hundredth of the speed of sound.
pub(crate) fn moduli() -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for young_modulus_pa in [1e3, 1e6, 1e9, 1e12_f64] {
        let row = Row {
            young_modulus_pa,
            ..Row::pair()
        };
        members.push(row.member(format!("bonded, {young_modulus_pa:e} Pa"), TIMOSHENKO)?);
        let usual = Impact::usual();
        let impact = Impact {
            young_modulus_pa,
            speed_m_s: 0.01 * (young_modulus_pa / usual.density_kg_m3).sqrt(),
            ..usual
        };
        members.push(impact.member(format!("colliding, {young_modulus_pa:e} Pa")));
    }
    Ok(members)
}

/// Spheres with nearly the same centre. The limit is the program's, as its linearisation must not
/// step over such a bond; the oscillation has a closed form.
pub(crate) fn short_bonds() -> Result<Vec<Member>> {
    let models = [
        (BondModel::Parallel { kappa: None }, "parallel"),
        TIMOSHENKO,
        (BondModel::ElasticSolid, "elastic-solid"),
    ];
    let mut members = Vec::new();
    for fraction in [1e-2, 1e-6, 1e-9] {
        for model in models {
            let row = Row {
                distances_m: vec![fraction * 1e-3],
                ..Row::pair()
            };
            let member = row.member(format!("{}, {fraction:e} of a radius", model.1), model)?;
            let mut trial = member.trial.clone();
            // So little that a thousandfold amplitude is still linear.
            for (_, body) in &mut trial.bodies {
                let [a, b] = [0, 1].map(|i| body.positions[i][0]);
                body.bond_lengths[0] = (b - a) / (1.0 + 1e-8);
            }
            members.push(program_limit(format!("{}, its limit", member.what), trial)?);
            members.push(member);
        }
    }
    Ok(members)
}
