//! What the bonds of a body have been through, beyond their damage: plastic deformation, and failed
//! elements of flat joints.

use crate::diagnostic::{Diagnostic, Result};
use crate::vtk::{NamedArray, Values};

/// Plastic deformation of a bond. Vectors are in the axes of its body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PlasticBond {
    /// Part of its length, m.
    pub elongation_m: f64,
    /// Sliding of its ends past each other, m.
    pub slip_m: [f64; 3],
    /// Rotation of its second end relative to the first about its axis, rad.
    pub twist_rad: f64,
    /// The same about the axes across it, rad.
    pub bend_rad: [f64; 3],
    /// Plastic work, J.
    pub work_j: f64,
}

/// Failed elements of a flat joint.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct JointBond {
    /// Unit vector from the axis of the bond to the edge at which the first element begins, in the
    /// axes of its body.
    pub first_edge: [f64; 3],
    /// For each element, ring by ring from the axis, whether it has failed. Empty: the bond is no
    /// flat joint.
    pub failed: Vec<bool>,
}

/// Bond array: plastic part of the length, m.
pub const PLASTIC_ELONGATION: &str = "plastic_elongation_m";
/// Bond array: plastic sliding, m, a vector.
pub const PLASTIC_SLIP: &str = "plastic_slip_m";
/// Bond array: plastic twist, rad.
pub const PLASTIC_TWIST: &str = "plastic_twist_rad";
/// Bond array: plastic bending, rad, a vector.
pub const PLASTIC_BEND: &str = "plastic_bend_rad";
/// Bond array: plastic work, J.
pub const PLASTIC_WORK: &str = "plastic_work_j";
/// Bond array: unit vector to the edge at which the first element of a flat joint begins.
pub const FIRST_EDGE: &str = "first_element_edge";
/// Bond array: 1 for a failed element of a flat joint, else 0, for each of its elements.
pub const FAILED_ELEMENTS: &str = "failed_elements";

/// Names of all these arrays.
pub(crate) const ALL: [&str; 7] = [
    PLASTIC_ELONGATION,
    PLASTIC_SLIP,
    PLASTIC_TWIST,
    PLASTIC_BEND,
    PLASTIC_WORK,
    FIRST_EDGE,
    FAILED_ELEMENTS,
];

/// The numbers of these arrays as read from a file; empty for those that it lacks.
#[derive(Debug, Clone, Default)]
pub(crate) struct HistoryArrays {
    pub(crate) arrays: [Vec<f64>; ALL.len()],
}

impl HistoryArrays {
    fn of(&self, name: &str) -> &[f64] {
        let at = ALL.iter().position(|other| *other == name);
        at.map_or(&[], |at| &self.arrays[at])
    }

    /// Plastic deformation of each bond. Empty: the file has none.
    pub(crate) fn plastics(&self, bonds: usize) -> Vec<PlasticBond> {
        if self.of(PLASTIC_ELONGATION).is_empty() {
            return Vec::new();
        }
        let number = |name: &str, bond: usize| self.of(name).get(bond).copied().unwrap_or(0.0);
        let vector = |name: &str, bond: usize| self.vector(name, bond).unwrap_or_default();
        let one = |bond: usize| PlasticBond {
            elongation_m: number(PLASTIC_ELONGATION, bond),
            slip_m: vector(PLASTIC_SLIP, bond),
            twist_rad: number(PLASTIC_TWIST, bond),
            bend_rad: vector(PLASTIC_BEND, bond),
            work_j: number(PLASTIC_WORK, bond),
        };
        (0..bonds).map(one).collect()
    }

    /// Elements of each bond. Empty: the file has none.
    pub(crate) fn joints(&self, bonds: usize) -> Vec<JointBond> {
        let flags = self.of(FAILED_ELEMENTS);
        if flags.is_empty() || bonds == 0 {
            return Vec::new();
        }
        let count = flags.len() / bonds;
        let one = |bond: usize| JointBond {
            first_edge: self.vector(FIRST_EDGE, bond).unwrap_or_default(),
            failed: flags[bond * count..(bond + 1) * count]
                .iter()
                .map(|flag| *flag != 0.0)
                .collect(),
        };
        (0..bonds).map(one).collect()
    }

    fn vector(&self, name: &str, bond: usize) -> Option<[f64; 3]> {
        self.of(name).as_chunks::<3>().0.get(bond).copied()
    }
}

/// Calls `then` with the arrays of these, one entry for each bond; of each kind all or none.
pub fn with_arrays<R>(
    plastics: &[PlasticBond],
    joints: &[JointBond],
    then: impl FnOnce(&[NamedArray<'_>]) -> R,
) -> R {
    let elongation = |bond: usize| plastics[bond].elongation_m;
    let slip = |bond: usize| plastics[bond].slip_m;
    let twist = |bond: usize| plastics[bond].twist_rad;
    let bend = |bond: usize| plastics[bond].bend_rad;
    let work = |bond: usize| plastics[bond].work_j;
    let edge = |bond: usize| joints[bond].first_edge;
    let count = joints.iter().map(|joint| joint.failed.len());
    let count = count.max().unwrap_or(0);
    let failed = |bond: usize, element: usize| {
        let flag = joints[bond].failed.get(element);
        u8::from(flag == Some(&true))
    };
    let named = |(name, values)| NamedArray { name, values };
    let of_plastics = [
        (PLASTIC_ELONGATION, Values::Scalars(&elongation)),
        (PLASTIC_SLIP, Values::Vectors(&slip)),
        (PLASTIC_TWIST, Values::Scalars(&twist)),
        (PLASTIC_BEND, Values::Vectors(&bend)),
        (PLASTIC_WORK, Values::Scalars(&work)),
    ];
    let of_joints = [
        (FIRST_EDGE, Values::Vectors(&edge)),
        (FAILED_ELEMENTS, Values::Flags(count, &failed)),
    ];
    let some = |is_there: bool| move |array: &_| is_there.then_some(*array);
    let arrays = of_plastics.iter().filter_map(some(!plastics.is_empty()));
    let arrays = arrays.chain(of_joints.iter().filter_map(some(count > 0)));
    let arrays: Vec<NamedArray<'_>> = arrays.map(named).collect();
    then(&arrays)
}

/// Checks the history of bonds of these lengths, m.
pub(super) fn check(
    plastics: &[PlasticBond],
    joints: &[JointBond],
    lengths_m: &[f64],
) -> Result<()> {
    for (bond, plastic) in plastics.iter().enumerate() {
        let angles = [plastic.elongation_m, plastic.twist_rad, plastic.work_j];
        let vectors = [plastic.slip_m, plastic.bend_rad];
        let numbers = angles.iter().chain(vectors.as_flattened());
        if numbers.clone().any(|number| !number.is_finite()) {
            return Err(wrong(bond, "its plastic deformation is not finite"));
        }
        if plastic.elongation_m >= lengths_m[bond] {
            return Err(wrong(
                bond,
                "its plastic elongation is not less than its length",
            ));
        }
    }
    for (bond, joint) in joints.iter().enumerate() {
        let [x, y, z] = joint.first_edge;
        let size = (x * x + y * y + z * z).sqrt();
        if !joint.failed.is_empty() && !(0.5..2.0).contains(&size) {
            return Err(wrong(
                bond,
                "the edge of its first element is no unit vector",
            ));
        }
        if !joint.failed.is_empty() && joint.failed.iter().all(|failed| *failed) {
            return Err(wrong(bond, "all of its elements have failed"));
        }
    }
    Ok(())
}

fn wrong(bond: usize, problem: &str) -> Diagnostic {
    Diagnostic::input(
        format!("bond {bond}"),
        problem,
        "remove this bond, or the arrays of its history",
    )
}
