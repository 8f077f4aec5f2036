//! A round tube.

use crate::bond::rod::{Rod, RodModel, Stiffness};

/// The elastic solid bond with a hole: a ring as section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tube {
    /// Inner over outer radius, 0 to 1.
    pub hollow: f64,
}

impl RodModel for Tube {
    fn stiffness(&self, rod: &Rod) -> Stiffness {
        // What the hole leaves of the section and of its second moment.
        let section = 1.0 - self.hollow.powi(2);
        let moment = 1.0 - self.hollow.powi(4);
        let length_m = rod.shape.length_m;
        let solid = rod.with_shear(rod.shear_modulus_pa() * rod.area_m2() / length_m);
        Stiffness {
            normal: section * solid.normal,
            shear: section * solid.shear,
            torsion: moment * solid.torsion,
            bending: moment * solid.bending,
            ..solid
        }
    }
}
