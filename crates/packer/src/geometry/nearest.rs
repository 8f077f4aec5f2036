//! The point of the wall nearest to another point, and what it hides.

use crate::spheres::Vector3;

/// The point of the surface nearest to some other point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Its position, in local units.
    pub point: Vector3,
    /// Its distance, in local units.
    pub distance: f64,
    /// The triangle of the wall on which it lies.
    pub triangle: u32,
}

impl Nearest {
    /// True if a point, given from the centre of a ball, is behind the plane of this wall.
    #[inline(always)]
    pub(super) fn hides(&self, centre: &Vector3, from_centre: &Vector3) -> bool {
        self.towards(centre).dot(from_centre) > self.hides_beyond()
    }

    /// The distance of its plane from the centre of a ball, to see what it hides: the plane is
    /// taken to be nearer by 3 %.
    #[inline(always)]
    pub(super) fn hides_beyond(&self) -> f64 {
        const NEARER: f64 = 0.97;
        NEARER * self.distance
    }

    /// The direction of this wall from the centre of a ball: a unit vector if the distance is
    /// measured from there.
    #[inline(always)]
    pub(crate) fn towards(&self, centre: &Vector3) -> Vector3 {
        (self.point - centre) / self.distance
    }
}
