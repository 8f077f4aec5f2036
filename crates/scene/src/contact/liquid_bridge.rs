//! `liquid_bridge` of a contact.

use std::f64::consts::PI;
use std::ops::Bound::{Excluded, Included};

use crate::plain_table::plain_table;
use dem_io::units::{ANGLE, SURFACE_TENSION, VOLUME};

plain_table! {
    LIQUID_BRIDGE = "Liquid bridge";
    /// Liquid between two ends. A bridge forms when they touch, and ruptures at a gap of (1 +
    /// contact_angle/2) volume^(1/3).
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct LiquidBridge {
        /// Surface tension of the liquid: the pull of ends that touch is 4 pi times it, the
        /// effective radius and the cosine of the contact angle.
        surface_tension_n_m: f64 = quantity("surface_tension", &SURFACE_TENSION)
            .positive()
            .required("\"73 mN/m\"");
        /// Contact angle of the liquid on the ends.
        contact_angle_rad: f64 = quantity("contact_angle", &ANGLE)
            .within(Included(0.0), Excluded(0.5 * PI))
            .remedy("a liquid that does not wet the ends makes no bridge that pulls: remove liquid_bridge")
            .or(0.0);
        /// Liquid in each bridge. The force law holds for up to about a thousandth of the cube of
        /// the radius.
        volume_m3: f64 = quantity("volume", &VOLUME).positive().required("\"1e-3 mm3\"");
    }
}
