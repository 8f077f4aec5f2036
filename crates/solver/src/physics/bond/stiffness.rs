//! Stiffnesses of a bond in its four modes, and where along it shear acts, for five bond models.
//!
//! Sources: Chen et al. 2022, table 9 (parallel, Euler-Bernoulli, Timoshenko); MUSEN's elastic
//! solid bond; Platzer 2022, eqs. 6 and 8 (shear-coefficient beam). In this order they go back to
//! Potyondy and Cundall 2004, Andre et al. 2012, Brown et al. 2014, Dosta et al. 2013 and Obermayr
//! et al. 2013.

use std::f64::consts::PI;

/// Which beam a bond is taken for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondModel {
    /// Parallel bond: shear stiffness is the normal stiffness over `kappa`, 2 (1 + nu) unless
    /// given. Shear acts halfway between the surfaces of the spheres.
    Parallel {
        /// Normal over shear stiffness.
        kappa: Option<f64>,
    },
    /// Slender beam: no shear deformation.
    EulerBernoulli,
    /// Beam with shear deformation, shear form factor 10/9.
    Timoshenko,
    /// MUSEN's bond: each mode as for a rod of the bond's length.
    ElasticSolid,
    /// Beam of Platzer 2022: as the elastic solid bond, with the shear stiffness times a
    /// coefficient.
    ShearCoefficient {
        /// Shear coefficient, 0.9 for a circular section.
        alpha: f64,
    },
}

/// A bond before it is loaded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondShape {
    /// Distance between the centres, m.
    pub length_m: f64,
    /// Radius of the bond, m.
    pub radius_m: f64,
    /// Radii of the spheres at its two ends, m.
    pub end_radii_m: [f64; 2],
}

/// What a bond answers to being stretched, sheared, twisted and bent, and where its contact point
/// lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness<T = f64> {
    /// Along the bond, N/m.
    pub normal: T,
    /// Across the bond at the contact point, N/m.
    pub shear: T,
    /// Torsion, N m/rad.
    pub torsion: T,
    /// Bending, N m/rad.
    pub bending: T,
    /// Distances of the contact point from the two centres, m; together the bond's length.
    pub levers_m: [T; 2],
}

/// Stiffness of a bond of Young's modulus `young_modulus_pa` and Poisson's ratio `poisson_ratio`.
pub fn stiffness(
    model: BondModel,
    shape: &BondShape,
    young_modulus_pa: f64,
    poisson_ratio: f64,
) -> Stiffness {
    let (length, radius) = (shape.length_m, shape.radius_m);
    let [radius_a, radius_b] = shape.end_radii_m;
    let area = PI * radius.powi(2);
    let second_moment = 0.25 * PI * radius.powi(4);
    let shear_modulus = young_modulus_pa / (2.0 * (1.0 + poisson_ratio));
    let normal = young_modulus_pa * area / length;
    let middle = [0.5 * length; 2];
    let beam = 12.0 * young_modulus_pa * second_moment / length.powi(3);
    // A round rod: J = 2 I, I = A r^2 / 4.
    let torsion = 2.0 * shear_modulus * second_moment / length;
    let bending = young_modulus_pa * second_moment / length;
    match model {
        BondModel::Parallel { kappa } => {
            let shear = normal / kappa.unwrap_or(2.0 * (1.0 + poisson_ratio));
            // The longer lever first: what is left for the other is then exact, and both together
            // are the length to the last bit.
            let longer = 0.5 * (length + (radius_a - radius_b).abs());
            let shorter = length - longer;
            Stiffness {
                normal,
                shear,
                torsion: 0.5 * shear * radius.powi(2),
                bending,
                levers_m: if radius_a >= radius_b {
                    [longer, shorter]
                } else {
                    [shorter, longer]
                },
            }
        }
        BondModel::EulerBernoulli => Stiffness {
            normal,
            shear: beam,
            torsion,
            bending,
            levers_m: middle,
        },
        BondModel::Timoshenko => {
            let phi = 20.0 * radius.powi(2) * (1.0 + poisson_ratio) / (3.0 * length.powi(2));
            Stiffness {
                normal,
                shear: beam / (1.0 + phi),
                torsion,
                bending,
                levers_m: middle,
            }
        }
        BondModel::ElasticSolid => Stiffness {
            normal,
            shear: shear_modulus * area / length,
            torsion,
            bending,
            levers_m: middle,
        },
        BondModel::ShearCoefficient { alpha } => Stiffness {
            normal,
            shear: alpha * shear_modulus * area / length,
            torsion,
            bending,
            levers_m: middle,
        },
    }
}
