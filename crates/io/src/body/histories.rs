//! What the bonds of a body have been through, beyond their damage: how they lie without load,
//! loads that are summed step by step, plastic deformation, and failed elements of flat joints.

use crate::diagnostic::{Diagnostic, Result};
use crate::vtk::{NamedArray, Values};
use crate::vtp::Arrays;

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
    /// Rotation vectors of the bond's two ends relative to their particles, in the axes of the
    /// particles before they turned, rad.
    pub turns_rad: [[f64; 3]; 2],
}

/// Load of a bond of the incremental formulation, which is summed step by step. Vectors are in the
/// axes of its body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SummedBond {
    /// Shear force on its second end, N.
    pub shear_n: [f64; 3],
    /// Moment on its second end, N m.
    pub moment_n_m: [f64; 3],
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
    /// For each element, how far its faces have slid past each other, m, in the axes of its body.
    /// Empty: they have not.
    pub slips_m: Vec<[f64; 3]>,
}

/// What the bonds of a body or a frame have been through, one entry for each bond; of each kind all
/// or none.
#[derive(Debug, Clone, Copy, Default)]
pub struct BondHistories<'a> {
    /// Unit vectors from the first to the second end without load, in the axes that the particles
    /// had before they turned.
    pub directions: &'a [[f64; 3]],
    /// Loads of bonds of the incremental formulation.
    pub sums: &'a [SummedBond],
    /// Plastic deformation.
    pub plastics: &'a [PlasticBond],
    /// Elements of flat joints.
    pub joints: &'a [JointBond],
}

/// Bond array: unit vector along the bond without load, in the axes of the unturned particles.
pub const DIRECTION: &str = "initial_direction";
/// Bond array: summed shear force on the second end, N, a vector.
pub const SUMMED_SHEAR: &str = "summed_shear_n";
/// Bond array: summed moment on the second end, N m, a vector.
pub const SUMMED_MOMENT: &str = "summed_moment_n_m";
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
/// Bond arrays: rotation vectors of the two ends relative to their particles, rad.
pub const PLASTIC_TURNS: [&str; 2] = ["plastic_turn_a_rad", "plastic_turn_b_rad"];
/// Bond array: unit vector to the edge at which the first element of a flat joint begins.
pub const FIRST_EDGE: &str = "first_element_edge";
/// Bond array: 1 for a failed element of a flat joint, else 0, for each of its elements.
pub const FAILED_ELEMENTS: &str = "failed_elements";
/// Bond array: sliding of the elements of a flat joint, m, a vector for each of its elements.
pub const ELEMENT_SLIP: &str = "element_slip_m";

/// Largest difference between the length of a direction and 1.
const LENGTH_OF_UNIT: f64 = 1e-6;

/// Names of all these arrays.
pub(crate) const ALL: [&str; 13] = [
    DIRECTION,
    SUMMED_SHEAR,
    SUMMED_MOMENT,
    PLASTIC_TURNS[0],
    PLASTIC_TURNS[1],
    ELEMENT_SLIP,
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
    arrays: [Vec<f64>; ALL.len()],
}

impl HistoryArrays {
    pub(crate) fn take(arrays: &mut Arrays) -> Self {
        let array = |name| arrays.take(&format!("CellData/{name}")).unwrap_or_default();
        Self {
            arrays: ALL.map(array),
        }
    }

    fn of(&self, name: &str) -> &[f64] {
        let at = ALL.iter().position(|other| *other == name);
        at.map_or(&[], |at| &self.arrays[at])
    }

    /// Direction of each bond without load. Empty: the file has none.
    pub(crate) fn directions(&self, bonds: usize) -> Vec<[f64; 3]> {
        self.vectors(DIRECTION, bonds)
    }

    /// Summed load of each bond. Empty: the file has none.
    pub(crate) fn sums(&self, bonds: usize) -> Vec<SummedBond> {
        let shear = self.vectors(SUMMED_SHEAR, bonds);
        let one = |(shear_n, moment_n_m)| SummedBond {
            shear_n,
            moment_n_m,
        };
        let moments = self.vectors(SUMMED_MOMENT, bonds);
        shear.into_iter().zip(moments).map(one).collect()
    }

    /// A vector for each bond. Empty: the file has no such array.
    fn vectors(&self, name: &str, bonds: usize) -> Vec<[f64; 3]> {
        let found = self.of(name).as_chunks().0;
        found[..bonds.min(found.len())].to_vec()
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
            turns_rad: PLASTIC_TURNS.map(|name| vector(name, bond)),
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
        let slips = self.of(ELEMENT_SLIP).as_chunks().0;
        let one = |bond: usize| JointBond {
            first_edge: self.vector(FIRST_EDGE, bond).unwrap_or_default(),
            failed: flags[bond * count..(bond + 1) * count]
                .iter()
                .map(|flag| *flag != 0.0)
                .collect(),
            slips_m: slips
                .get(bond * count..(bond + 1) * count)
                .map_or_else(Vec::new, <[[f64; 3]]>::to_vec),
        };
        (0..bonds).map(one).collect()
    }

    fn vector(&self, name: &str, bond: usize) -> Option<[f64; 3]> {
        self.of(name).as_chunks::<3>().0.get(bond).copied()
    }
}

/// Calls `then` with the arrays of these.
pub fn with_arrays<R>(
    histories: &BondHistories<'_>,
    then: impl FnOnce(&[NamedArray<'_>]) -> R,
) -> R {
    let BondHistories {
        directions,
        sums,
        plastics,
        joints,
    } = *histories;
    let direction = |bond: usize| directions[bond];
    let shear = |bond: usize| sums[bond].shear_n;
    let moment = |bond: usize| sums[bond].moment_n_m;
    let turn_a = |bond: usize| plastics[bond].turns_rad[0];
    let turn_b = |bond: usize| plastics[bond].turns_rad[1];
    let elongation = |bond: usize| plastics[bond].elongation_m;
    let plastic_slip = |bond: usize| plastics[bond].slip_m;
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
    let slip = |bond: usize, number: usize| {
        let slips = joints[bond].slips_m.as_flattened();
        slips.get(number).copied().unwrap_or(0.0)
    };
    let has_slid = joints.iter().any(|joint| !joint.slips_m.is_empty());
    let named = |(name, values)| NamedArray { name, values };
    let of_rest = [(DIRECTION, Values::Vectors(&direction))];
    let of_sums = [
        (SUMMED_SHEAR, Values::Vectors(&shear)),
        (SUMMED_MOMENT, Values::Vectors(&moment)),
    ];
    let of_slips = [(ELEMENT_SLIP, Values::Tuples(3 * count, &slip))];
    let of_plastics = [
        (PLASTIC_TURNS[0], Values::Vectors(&turn_a)),
        (PLASTIC_TURNS[1], Values::Vectors(&turn_b)),
        (PLASTIC_ELONGATION, Values::Scalars(&elongation)),
        (PLASTIC_SLIP, Values::Vectors(&plastic_slip)),
        (PLASTIC_TWIST, Values::Scalars(&twist)),
        (PLASTIC_BEND, Values::Vectors(&bend)),
        (PLASTIC_WORK, Values::Scalars(&work)),
    ];
    let of_joints = [
        (FIRST_EDGE, Values::Vectors(&edge)),
        (FAILED_ELEMENTS, Values::Flags(count, &failed)),
    ];
    let some = |is_there: bool| move |array: &_| is_there.then_some(*array);
    let arrays = of_rest.iter().filter_map(some(!directions.is_empty()));
    let arrays = arrays.chain(of_sums.iter().filter_map(some(!sums.is_empty())));
    let arrays = arrays.chain(of_plastics.iter().filter_map(some(!plastics.is_empty())));
    let arrays = arrays.chain(of_joints.iter().filter_map(some(count > 0)));
    let arrays = arrays.chain(of_slips.iter().filter_map(some(has_slid)));
    let arrays: Vec<NamedArray<'_>> = arrays.map(named).collect();
    then(&arrays)
}

/// Checks the history of bonds of these lengths, m.
pub(super) fn check(histories: &BondHistories<'_>, lengths_m: &[f64]) -> Result<()> {
    let BondHistories {
        directions,
        sums,
        plastics,
        joints,
    } = *histories;
    for (bond, [x, y, z]) in directions.iter().enumerate() {
        let size = (x * x + y * y + z * z).sqrt();
        let is_unit = (size - 1.0).abs() < LENGTH_OF_UNIT;
        if !is_unit {
            return Err(wrong(bond, "its direction without load is no unit vector"));
        }
    }
    for (bond, sum) in sums.iter().enumerate() {
        let mut numbers = sum.shear_n.iter().chain(&sum.moment_n_m);
        if numbers.any(|number| !number.is_finite()) {
            return Err(wrong(bond, "its summed load is not finite"));
        }
    }
    for (bond, plastic) in plastics.iter().enumerate() {
        let angles = [plastic.elongation_m, plastic.twist_rad, plastic.work_j];
        let [turn_a, turn_b] = plastic.turns_rad;
        let vectors = [plastic.slip_m, plastic.bend_rad, turn_a, turn_b];
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
        let mut slips = joint.slips_m.as_flattened().iter();
        if slips.any(|number| !number.is_finite()) {
            return Err(wrong(bond, "the sliding of its elements is not finite"));
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
