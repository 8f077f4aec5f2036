//! A bond on its way to a file or from one, and the columns of numbers there.

use dem_physics::bond::flat_joint::FlatJointLaw;
use dem_physics::bond::total::End;
use nalgebra::{UnitQuaternion, Vector3};

use super::law::BondRule;

/// A bond whose history goes to a file or comes from one. There, vectors are in the axes of the
/// body, and each goes from the particle with the smaller number to the other one.
pub(crate) struct StoredBond {
    pub(crate) rule: BondRule,
    /// Unit vector from the first to the second end without load.
    pub(crate) direction: Vector3<f64>,
    pub(crate) radius_m: f64,
    pub(crate) levers_m: [f64; 2],
    /// Those of its particles.
    pub(crate) ends: [End; 2],
    /// From the axes of the bond to those of the scene.
    pub(crate) frame: UnitQuaternion<f64>,
    /// From the axes of the file to those of the scene.
    pub(crate) rotation: UnitQuaternion<f64>,
    /// Whether its particles have the opposite order in the file.
    pub(crate) is_reversed: bool,
    pub(crate) is_broken: bool,
}

impl StoredBond {
    pub(super) fn sign(&self) -> f64 {
        sign(self.is_reversed)
    }

    /// Two values in the order of the other end of the bond.
    pub(super) fn ends_in_order<T>(&self, [a, b]: [T; 2]) -> [T; 2] {
        if self.is_reversed { [b, a] } else { [a, b] }
    }

    /// Values of elements from the other end of the bond: their sectors follow each other the other
    /// way round.
    pub(super) fn elements_in_order<T>(&self, mut values: Vec<T>, law: &FlatJointLaw) -> Vec<T> {
        if self.is_reversed {
            let rings = values.chunks_mut(law.circumferential_elements as usize);
            rings.for_each(<[T]>::reverse);
        }
        values
    }

    /// A vector of the axes of the bond in those of the file of a frame.
    pub(super) fn stored(&self, own: [f64; 3]) -> [f64; 3] {
        (self.sign() * (self.frame * Vector3::from(own))).into()
    }
}

/// Sign of a vector along a bond whose particles may have the opposite order in the file.
pub(crate) fn sign(is_reversed: bool) -> f64 {
    if is_reversed { -1.0 } else { 1.0 }
}

/// Rotation of the frame of a bond between these ends: halfway between those of the two.
pub(super) fn frame_between(ends: &[End; 2]) -> UnitQuaternion<f64> {
    let [a, b] = [0, 1].map(|k| ends[k].turned.into_inner());
    let sign = a.dot(&b).signum();
    UnitQuaternion::new_normalize(a + b * sign)
}

/// A column of the numbers of a history in files.
pub(crate) struct FileColumn {
    /// Its name, which begins with [`dem_io::body::histories::PREFIX`] unless it is one of that
    /// module's names.
    pub(super) name: &'static str,
    /// Numbers of each bond.
    pub(super) numbers: usize,
    /// Whether each element of a bond has so many.
    pub(super) is_of_elements: bool,
    /// Whether a column of zeros is left out.
    pub(super) is_optional: bool,
}

pub(super) const fn column(name: &'static str, numbers: usize) -> FileColumn {
    FileColumn {
        name,
        numbers,
        is_of_elements: false,
        is_optional: false,
    }
}

/// The vector of these numbers; zero if there are none.
pub(super) fn vector(numbers: &[f64]) -> Vector3<f64> {
    Vector3::from(*numbers.first_chunk().unwrap_or(&[0.0; 3]))
}

pub(super) fn number(numbers: &[f64]) -> f64 {
    numbers.first().copied().unwrap_or(0.0)
}
