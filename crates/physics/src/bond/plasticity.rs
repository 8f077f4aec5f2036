//! Elasto-plastic bonds: each mode is elastic up to its yield strength and then flows, with linear
//! hardening or without.
//!
//! Source: Platzer 2022, 2.2.1.3, which names the behaviour (after Nguyen et al. 2021); the law of
//! a mode is that of the text books, with the kinematic hardening of Prager. With F the force of a
//! mode, k its stiffness, u its deformation and u_p the plastic part of it:
//!
//! F = k (u - u_p), |F - H u_p| <= F_y, H = k h/(1 - h).
//!
//! Beyond yield F rises by h k, and a mode that was pulled to F_1 yields the other way at
//! F_1 - 2 F_y. A cycle of amplitude u_a takes 4 F_y (1 - h) (u_a - F_y/k). F_y is s A for the
//! axial and the shear force, s I/r for bending and s J/r for torsion: the stresses that failure
//! criteria use. Modes yield independently of each other, and time does not enter.
//!
//! Plastic deformation changes the bond at which no force acts: its length, its direction, and how
//! its two ends are turned relative to their particles. The total formulation acts on that bond, so
//! that force and torques are the gradient of an energy at any rotation.

use std::f64::consts::PI;

use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector1, Vector3};
use serde::{Deserialize, Serialize};

use super::rod::Stiffness;
use super::total::End;

/// When the modes of a bond yield.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Plasticity {
    /// Yield strengths of axial force, shear force, torsion and bending, Pa, above 0. Infinite: the
    /// mode stays elastic.
    pub yield_strengths_pa: [f64; 4],
    /// h: stiffness beyond yield over elastic stiffness, at least 0 and below 1.
    pub hardening_ratio: f64,
}

/// Plastic deformation of a bond. Vectors are in the bond's frame, which is halfway between the
/// frames of its two ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlasticDeformation {
    /// Change of the stress-free length, m.
    pub elongation_m: f64,
    /// Sliding of the ends past each other, m, as in the shear displacement of the elastic bond.
    pub slip_m: [f64; 3],
    /// About the axis of the bond, rad.
    pub twist_rad: f64,
    /// About the axes across it, rad.
    pub bend_rad: [f64; 3],
    /// Rotations of the frames of the two ends relative to their particles: quaternions x, y, z, w.
    pub turned: [[f64; 4]; 2],
    /// Plastic work so far, J.
    pub work_j: f64,
}

impl Default for PlasticDeformation {
    fn default() -> Self {
        Self::NONE
    }
}

impl PlasticDeformation {
    /// Of a bond that has not yielded.
    pub const NONE: Self = Self {
        elongation_m: 0.0,
        slip_m: [0.0; 3],
        twist_rad: 0.0,
        bend_rad: [0.0; 3],
        turned: [[0.0, 0.0, 0.0, 1.0]; 2],
        work_j: 0.0,
    };

    /// The ends of the bond from those of its particles.
    pub fn ends(&self, of_particles: &[End; 2]) -> [End; 2] {
        [0, 1].map(|k| End {
            turned: of_particles[k].turned * rotation(self.turned[k]),
            ..of_particles[k]
        })
    }
}

/// A bond at which no force acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressFree {
    /// Distances of the contact point from the two centres, m.
    pub levers_m: [f64; 2],
    /// From the first to the second end, a unit vector in the bond's frame.
    pub direction: Vector3<f64>,
    /// How it came about.
    pub plastic: PlasticDeformation,
}

/// Elastic deformation of a bond.
struct Strain {
    elongation_m: f64,
    shear_m: Vector3<f64>,
    /// Unit vector of the axis of twist.
    axis: Vector3<f64>,
    twist: f64,
    bend: Vector3<f64>,
    /// Cosine of half the relative rotation.
    cosine: f64,
    /// Rotation of the bond's frame.
    frame: UnitQuaternion<f64>,
}

impl StressFree {
    /// This stiffness with the contact point of the bond.
    pub fn with_levers(&self, stiffness: &Stiffness) -> Stiffness {
        Stiffness {
            levers_m: self.levers_m,
            ..*stiffness
        }
    }

    /// Elastic deformation between these ends of particles: that of the total formulation.
    fn strain(&self, of_particles: &[End; 2]) -> Strain {
        let ends = self.plastic.ends(of_particles);
        let apart = ends[1].position_m - ends[0].position_m;
        let c = apart.normalize();
        let axes = ends.map(|end| end.turned * self.direction);
        let carried = self.levers_m[0] * axes[0] + self.levers_m[1] * axes[1];
        let relative = (ends[1].turned * ends[0].turned.inverse()).into_inner();
        let sign = relative.w.signum();
        let phi = 2.0 * sign * relative.imag();
        let axis = (axes[0] + axes[1]).normalize();
        let twist = phi.dot(&axis);
        let [a, b] = ends.map(|end| end.turned.into_inner());
        Strain {
            elongation_m: apart.norm() - self.levers_m[0] - self.levers_m[1],
            shear_m: carried - c * c.dot(&carried),
            axis,
            twist,
            bend: phi - axis * twist,
            cosine: relative.w.abs(),
            frame: UnitQuaternion::new_normalize(a + b * sign),
        }
    }
}

impl Plasticity {
    /// Loads at which the modes of a bond of this radius yield: N, N, N m, N m.
    pub fn limits(&self, radius_m: f64) -> [f64; 4] {
        let area_m2 = PI * radius_m * radius_m;
        let [normal, shear, torsion, bending] = self.yield_strengths_pa;
        [
            normal * area_m2,
            shear * area_m2,
            torsion * area_m2 * 0.5 * radius_m,
            bending * area_m2 * 0.25 * radius_m,
        ]
    }

    /// Plastic flow of a mode with this stiffness and elastic and plastic deformation, which yields
    /// at this load: 0 if it does not.
    fn flow<const N: usize>(
        &self,
        (stiffness, limit): (f64, f64),
        elastic: SVector<f64, N>,
        plastic: SVector<f64, N>,
    ) -> SVector<f64, N> {
        let h = self.hardening_ratio;
        let load = stiffness * (elastic - h / (1.0 - h) * plastic);
        let size = load.norm();
        if size <= limit {
            return SVector::zeros();
        }
        load * ((1.0 - h) * (size - limit) / (size * stiffness))
    }

    /// The bond of this radius and stiffness after its plastic flow between these ends of its
    /// particles. None: it does not yield.
    pub fn yielded(
        &self,
        bond: &StressFree,
        stiffness: &Stiffness,
        radius_m: f64,
        of_particles: &[End; 2],
    ) -> Option<StressFree> {
        let limits = self.limits(radius_m);
        let (is, was) = (bond.strain(of_particles), &bond.plastic);
        let turned_back = |v: Vector3<f64>| is.frame.inverse() * v;
        let elongation = self.flow(
            (stiffness.normal, limits[0]),
            Vector1::new(is.elongation_m),
            Vector1::new(was.elongation_m),
        );
        let slip = self.flow(
            (stiffness.shear, limits[1]),
            turned_back(is.shear_m),
            was.slip_m.into(),
        );
        let twist = self.flow(
            (stiffness.torsion, limits[2]),
            Vector1::new(is.twist),
            Vector1::new(was.twist_rad),
        );
        let bend = self.flow(
            (stiffness.bending, limits[3]),
            turned_back(is.bend),
            was.bend_rad.into(),
        );
        let (elongation, twist) = (elongation.x, twist.x);
        if elongation == 0.0 && twist == 0.0 && slip.amax() == 0.0 && bend.amax() == 0.0 {
            return None;
        }
        let length_m = bond.levers_m[0] + bond.levers_m[1];
        let turn = (turned_back(is.axis) * twist + bend) / is.cosine;
        // Each end turns by the other's part of the length: that turns the line of centres, but
        // shears nothing.
        let parts = [bond.levers_m[1] / length_m, -bond.levers_m[0] / length_m];
        let mut after = StressFree {
            levers_m: bond.levers_m.map(|l| l * (1.0 + elongation / length_m)),
            plastic: PlasticDeformation {
                elongation_m: was.elongation_m + elongation,
                slip_m: (Vector3::from(was.slip_m) + slip).into(),
                twist_rad: was.twist_rad + twist,
                bend_rad: (Vector3::from(was.bend_rad) + bend).into(),
                turned: [0, 1].map(|k| {
                    let more = UnitQuaternion::from_scaled_axis(parts[k] * turn);
                    quaternion(rotation(was.turned[k]) * more)
                }),
                work_j: was.work_j,
            },
            ..*bond
        };
        // The direction takes the slip, and what the flow of the other modes would shear.
        let now = after.strain(of_particles);
        let missing = turned_back(is.shear_m) - slip - now.frame.inverse() * now.shear_m;
        let direction = after.direction + missing / (after.levers_m[0] + after.levers_m[1]);
        after.direction = direction.normalize();
        Some(after)
    }
}

fn rotation([x, y, z, w]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
}

/// x, y, z, w of a rotation, of length 1 to rounding after any number of products.
fn quaternion(rotation: UnitQuaternion<f64>) -> [f64; 4] {
    let [x, y, z, w] = UnitQuaternion::new_normalize(rotation.into_inner())
        .coords
        .into();
    [x, y, z, w]
}
