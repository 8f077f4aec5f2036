//! Flat joints: their elements, and the forces and strengths of these.

use std::f64::consts::PI;

use super::Bonds;
use crate::state::particles::Pose;
use dem_physics::bond::flat_joint::{self, ElementStrengths, FlatJoint, JointStiffness};
use dem_physics::bond::total::{BondForces, End};

impl Bonds {
    /// Failed part of the area of bond `at`, unless it is broken: 0 if it is no flat joint.
    pub fn failed_fraction(&self, at: usize) -> f64 {
        let joint = self.histories.joints.get(at);
        joint.map_or(0.0, FlatJoint::failed_fraction)
    }

    /// Stiffness per area of bond `at`.
    pub(crate) fn joint_stiffness(&self, at: usize) -> JointStiffness {
        let (stiffness, radius_m) = (self.stiffness(at), self.radius_m(at));
        let per_area = 1.0 / (PI * radius_m * radius_m);
        JointStiffness {
            normal_pa_m: per_area * stiffness.normal,
            shear_pa_m: per_area * stiffness.shear,
        }
    }

    /// Strengths of the elements of flat joint `at`. None: they do not fail.
    pub(crate) fn element_strengths(&self, at: usize) -> Option<ElementStrengths> {
        let criteria = self.rules[self.rule_of(at)].criteria?;
        let factor = self.strength_factor(at);
        Some(ElementStrengths {
            tensile_pa: factor * criteria.tensile_strength_pa,
            cohesion_pa: factor * criteria.cohesion_pa,
            friction_tangent: criteria.friction_tangent,
        })
    }

    /// Largest utilisation of the bonded elements of flat joint `at`, which must not be broken.
    pub fn element_utilisation(&self, at: usize, poses: &[Pose]) -> f64 {
        let Some(strengths) = self.element_strengths(at) else {
            return 0.0;
        };
        flat_joint::utilisation(
            &self.histories.joints[at].elements,
            &self.joint_stiffness(at),
            &strengths,
            &self.direction(at),
            self.initial_length_m(at),
            &self.ends_of(at, poses),
        )
    }

    /// Forces of flat joint `at` with these elements between these ends.
    pub(crate) fn joint_forces(
        &self,
        at: usize,
        elements: &[flat_joint::Element],
        ends: &[End; 2],
    ) -> BondForces {
        let stiffness = self.joint_stiffness(at);
        let length_m = self.initial_length_m(at);
        flat_joint::forces(elements, &stiffness, &self.direction(at), length_m, ends)
    }
}
