//! Flat joints: the section of a bond is a disc of elements, each of which carries its part of the
//! load, fails by itself, and rubs under pressure once it has failed.
//!
//! Source: Potyondy 2012, as Platzer 2022, 2.2.1.2, quotes it; here as a bond of the total
//! formulation. In the frame of the bond, halfway between the rotations of its two ends, x is the
//! vector from the first to the second end, d its initial direction, and psi the rotation of the
//! second end relative to the first (twice the vector part of the quaternion). Both faces lie in
//! the middle of the bond; those of an element at r are apart by
//!
//! g = x - L0 d + psi x r,
//!
//! by delta = g . d along the bond and by s across it. With the stiffness per area of the bond, an
//! element of area A has the stress sigma = k_n delta and tau = k_s s. It fails at the tensile
//! strength, or where |tau| reaches c - sigma tan(phi). Then it carries pressure only, and shear up
//! to the friction of it.
//!
//! Force and moments are the gradient of the energy of the elements at their slip: no net force or
//! moment acts. Bending and torsion follow from the distribution of the elements.

use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::BondLoad;
use super::criteria::Cause;
use super::total::{BondEnergy, BondForces, End};

/// Elements of a flat joint, and their friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FlatJointLaw {
    /// Number of rings of equal width.
    pub radial_elements: u32,
    /// Number of equal sectors of each ring.
    pub circumferential_elements: u32,
    /// Friction coefficient of a failed element.
    pub friction: f64,
}

impl FlatJointLaw {
    /// Number of elements.
    pub fn count(&self) -> usize {
        self.radial_elements as usize * self.circumferential_elements as usize
    }
}

/// Strengths of the elements of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementStrengths {
    /// Tensile strength, Pa.
    pub tensile_pa: f64,
    /// Cohesion, Pa.
    pub cohesion_pa: f64,
    /// tan(phi).
    pub friction_tangent: f64,
}

/// An element of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Element {
    /// Its area, m2.
    pub area_m2: f64,
    /// Its centroid, from the axis of the bond, in the bond's frame, m.
    pub place_m: [f64; 3],
    /// Whether it has not failed.
    pub is_bonded: bool,
    /// Sliding of its faces past each other without load, m; of a bonded element 0.
    pub slip_m: [f64; 3],
}

/// Stiffness of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointStiffness {
    /// Along the bond, per area, Pa/m.
    pub normal_pa_m: f64,
    /// Across it, per area, Pa/m.
    pub shear_pa_m: f64,
}

/// Second moment of the elements over that of the disc: less than 1, and 1 for ever more elements.
pub fn moment_ratio(law: &FlatJointLaw) -> f64 {
    let of_unit = elements(law, 1.0, &Vector3::z());
    let moments = of_unit
        .iter()
        .map(|element| element.area_m2 * Vector3::from(element.place_m).norm_squared());
    2.0 / PI * moments.sum::<f64>()
}

/// A joint: its elements, and why the last one that failed did so.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FlatJoint {
    /// Empty for a bond of another model.
    pub elements: Vec<Element>,
    /// None: all hold.
    pub last_failure: Option<Cause>,
}

impl FlatJoint {
    /// Failed part of the area: 0 to 1.
    pub fn failed_fraction(&self) -> f64 {
        let area_m2 = |counts: fn(&Element) -> bool| -> f64 {
            let chosen = self.elements.iter().filter(|element| counts(element));
            chosen.map(|element| element.area_m2).sum()
        };
        if self.elements.is_empty() {
            return 0.0;
        }
        area_m2(|element| !element.is_bonded) / area_m2(|_| true)
    }

    /// Whether no element holds.
    pub fn has_failed(&self) -> bool {
        !self.elements.is_empty() && self.elements.iter().all(|element| !element.is_bonded)
    }
}

/// The elements of a joint of this radius whose axis has this direction.
pub fn elements(law: &FlatJointLaw, radius_m: f64, direction: &Vector3<f64>) -> Vec<Element> {
    let least = direction.iamin();
    let mut beside = Vector3::zeros();
    beside[least] = 1.0;
    let first = direction.cross(&beside).normalize();
    elements_from(law, radius_m, direction, &first)
}

/// The elements of a joint of this radius whose axis has this direction, the first of them from the
/// edge in the direction `first`, a unit vector across the axis. The centroid of a sector from r_1
/// to r_2 of the half angle a is at 2/3 (r_2^3 - r_1^3)/(r_2^2 - r_1^2) sin(a)/a.
pub fn elements_from(
    law: &FlatJointLaw,
    radius_m: f64,
    direction: &Vector3<f64>,
    first: &Vector3<f64>,
) -> Vec<Element> {
    let second = direction.cross(first);
    let (rings, sectors) = (law.radial_elements, law.circumferential_elements);
    let half = PI / f64::from(sectors);
    let mut found = Vec::new();
    for ring in 0..rings {
        let [inner, outer] = [ring, ring + 1].map(|k| radius_m * f64::from(k) / f64::from(rings));
        let [squares, cubes] = [2, 3].map(|power| outer.powi(power) - inner.powi(power));
        let from_axis_m = 2.0 / 3.0 * cubes / squares * half.sin() / half;
        for sector in 0..sectors {
            let (sine, cosine) = ((2.0 * f64::from(sector) + 1.0) * half).sin_cos();
            found.push(Element {
                area_m2: half * squares,
                place_m: (from_axis_m * (cosine * first + sine * second)).into(),
                is_bonded: true,
                slip_m: [0.0; 3],
            });
        }
    }
    found
}

/// Unit vector, in the bond's frame, to the edge at which the first of these elements begins: that
/// of [`elements_from`].
pub fn first_edge(
    law: &FlatJointLaw,
    elements: &[Element],
    direction: &Vector3<f64>,
) -> Vector3<f64> {
    let Some(element) = elements.first() else {
        return Vector3::zeros();
    };
    let middle = Vector3::from(element.place_m).normalize();
    let (sine, cosine) = (PI / f64::from(law.circumferential_elements)).sin_cos();
    cosine * middle - sine * direction.cross(&middle)
}

/// Relative position of the two faces of a joint.
struct Faces {
    direction: Vector3<f64>,
    /// x - L0 d.
    gap_m: Vector3<f64>,
    psi: Vector3<f64>,
    apart_m: Vector3<f64>,
    /// Cosine of half the relative rotation.
    cosine: f64,
    /// Rotation of the bond's frame, and of the first end.
    frame: UnitQuaternion<f64>,
    first: UnitQuaternion<f64>,
}

impl Faces {
    fn of(direction: &Vector3<f64>, length_m: f64, ends: &[End; 2]) -> Self {
        let [a, b] = ends.map(|end| end.turned);
        let relative = (a.inverse() * b).into_inner();
        let sign = relative.w.signum();
        let frame = UnitQuaternion::new_normalize(a.into_inner() + b.into_inner() * sign);
        let apart_m = ends[1].position_m - ends[0].position_m;
        Self {
            direction: *direction,
            gap_m: frame.inverse() * apart_m - length_m * direction,
            psi: 2.0 * sign * relative.imag(),
            apart_m,
            cosine: relative.w.abs(),
            frame,
            first: a,
        }
    }

    /// Opening of an element, m, and sliding of its faces, m.
    fn at(&self, element: &Element) -> (f64, Vector3<f64>) {
        let gap = self.gap_m + self.psi.cross(&Vector3::from(element.place_m));
        let opening = gap.dot(&self.direction);
        (opening, gap - opening * self.direction)
    }
}

/// Forces of a joint with these elements between these ends of a bond of this initial direction
/// and length. The energy of the elements along the bond counts as stretch, that across it as
/// shear.
pub fn forces(
    elements: &[Element],
    stiffness: &JointStiffness,
    direction: &Vector3<f64>,
    length_m: f64,
    ends: &[End; 2],
) -> BondForces {
    let faces = Faces::of(direction, length_m, ends);
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    let mut energy = BondEnergy::default();
    for element in elements {
        let (opening, sliding) = faces.at(element);
        if !element.is_bonded && opening >= 0.0 {
            continue;
        }
        let along = element.area_m2 * stiffness.normal_pa_m * opening;
        let elastic = sliding - Vector3::from(element.slip_m);
        let across = element.area_m2 * stiffness.shear_pa_m * elastic;
        let one = along * direction + across;
        force += one;
        moment += Vector3::from(element.place_m).cross(&one);
        energy.normal += 0.5 * along * opening;
        energy.shear += 0.5 * across.dot(&elastic);
    }
    // Gradients with respect to the position and to the rotations: the frame turns by half of the
    // sum of both, and by the cross product of half their difference with the tangent of a quarter
    // of the relative rotation.
    let on_a = faces.frame * force;
    let of_frame = on_a.cross(&faces.apart_m);
    let quarter = faces.first * faces.psi / (2.0 * (1.0 + faces.cosine));
    let tilted = quarter.cross(&of_frame);
    let bent = faces.first * (faces.cosine * moment + 0.5 * faces.psi.cross(&moment));
    let along = force.dot(direction);
    let twist = moment.dot(direction);
    BondForces {
        force_on_b: -on_a,
        torques: [
            bent - 0.5 * (of_frame - tilted),
            -bent - 0.5 * (of_frame + tilted),
        ],
        energy,
        load: BondLoad {
            normal_n: along,
            shear_n: (force - along * direction).norm(),
            torsion_n_m: twist.abs(),
            bending_n_m: (moment - twist * direction).norm(),
        },
    }
}

/// What happens to the elements of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// The elements afterwards.
    pub elements: Vec<Element>,
    /// Why the last of those that failed did so. None: none failed.
    pub failed: Option<Cause>,
    /// Whether failed elements slid under pressure.
    pub slid: bool,
    /// Work of friction on them: the limit of their shear stress times area and sliding, J.
    pub friction_j: f64,
}

/// Failure and sliding of elements between these ends. None: nothing changes.
pub fn change(
    elements: &[Element],
    (stiffness, friction): (&JointStiffness, f64),
    strengths: Option<&ElementStrengths>,
    direction: &Vector3<f64>,
    length_m: f64,
    ends: &[End; 2],
) -> Option<Change> {
    let faces = Faces::of(direction, length_m, ends);
    let mut change: Option<Change> = None;
    for (i, element) in elements.iter().enumerate() {
        let (opening, sliding) = faces.at(element);
        let stress = stiffness.normal_pa_m * opening;
        let elastic = sliding - Vector3::from(element.slip_m);
        let shear = stiffness.shear_pa_m * elastic.norm();
        let mut now = *element;
        let failed = strengths
            .filter(|_| element.is_bonded)
            .and_then(|strengths| strengths.reached(stress, shear));
        now.is_bonded &= failed.is_none();
        let (mut slid, mut friction_j) = (false, 0.0);
        if !now.is_bonded {
            let limit = friction * -stress;
            if stress >= 0.0 {
                now.slip_m = sliding.into();
            } else if shear > limit {
                now.slip_m = (sliding - elastic * (limit / shear)).into();
                slid = true;
                let way_m = (shear - limit) / stiffness.shear_pa_m;
                friction_j = element.area_m2 * limit * way_m;
            }
        }
        if now == *element {
            continue;
        }
        let change = change.get_or_insert_with(|| Change {
            elements: elements.to_vec(),
            failed: None,
            slid: false,
            friction_j: 0.0,
        });
        change.elements[i] = now;
        change.failed = failed.or(change.failed);
        change.slid |= slid;
        change.friction_j += friction_j;
    }
    change
}

impl ElementStrengths {
    /// The strength that these stresses reach, tension positive, Pa.
    fn reached(&self, stress_pa: f64, shear_pa: f64) -> Option<Cause> {
        let [tension, shear] = self.used(stress_pa, shear_pa);
        if tension < 1.0 && shear < 1.0 {
            None
        } else if tension >= shear {
            Some(Cause::Tension)
        } else {
            Some(Cause::MohrCoulomb)
        }
    }

    /// Utilisation of both strengths by these stresses; without load 0, even of a strength of 0.
    fn used(&self, stress_pa: f64, shear_pa: f64) -> [f64; 2] {
        let sheared = shear_pa + stress_pa * self.friction_tangent;
        let used = |stress: f64, strength: f64| {
            if stress > 0.0 { stress / strength } else { 0.0 }
        };
        [
            used(stress_pa, self.tensile_pa),
            used(sheared, self.cohesion_pa),
        ]
    }
}

/// Largest utilisation of the bonded elements of a joint.
pub fn utilisation(
    elements: &[Element],
    stiffness: &JointStiffness,
    strengths: &ElementStrengths,
    direction: &Vector3<f64>,
    length_m: f64,
    ends: &[End; 2],
) -> f64 {
    let faces = Faces::of(direction, length_m, ends);
    let bonded = elements.iter().filter(|element| element.is_bonded);
    bonded
        .map(|element| {
            let (opening, sliding) = faces.at(element);
            let stress = stiffness.normal_pa_m * opening;
            let [tension, shear] = strengths.used(stress, stiffness.shear_pa_m * sliding.norm());
            tension.max(shear)
        })
        .fold(0.0, f64::max)
}
