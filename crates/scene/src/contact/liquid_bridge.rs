//! `liquid_bridge` of a contact.

use std::f64::consts::PI;
use std::ops::Bound::{Excluded, Included};

use crate::field::Field;
use crate::listing::one_field_a_key;
use crate::schema::{Key, Schema};
use crate::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGLE, SURFACE_TENSION, VOLUME};

pub(in crate::contact) static LIQUID_BRIDGE: Schema = Schema {
    title: "Liquid bridge",
    doc: "Liquid between two ends. A bridge forms when they touch, and ruptures at a gap of (1 + contact_angle/2) volume^(1/3).",
    keys: &[
        Key::quantity(
            "surface_tension",
            &SURFACE_TENSION,
            "Surface tension of the liquid: the pull of ends that touch is 4 pi times it, the effective radius and the cosine of the contact angle.",
        )
        .positive()
        .required("\"73 mN/m\""),
        Key::quantity("contact_angle", &ANGLE, "Contact angle of the liquid on the ends.")
            .within(Included(0.0), Excluded(0.5 * PI))
            .remedy("a liquid that does not wet the ends makes no bridge that pulls: remove liquid_bridge")
            .or(0.0),
        Key::quantity(
            "volume",
            &VOLUME,
            "Liquid in each bridge. The force law holds for up to about a thousandth of the cube of the radius.",
        )
        .positive()
        .required("\"1e-3 mm3\""),
    ],
};

/// Liquid between ends that have touched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiquidBridge {
    /// `surface_tension`, N/m; more than 0.
    pub surface_tension_n_m: f64,
    /// `contact_angle`, rad; in [0, pi/2).
    pub contact_angle_rad: f64,
    /// `volume` of each bridge, m3; more than 0.
    pub volume_m3: f64,
}

one_field_a_key! {
    LiquidBridge {
        surface_tension_n_m: "surface_tension",
        contact_angle_rad: "contact_angle",
        volume_m3: "volume",
    }
}

pub(in crate::contact) fn read(field: &Field<'_>) -> Result<LiquidBridge> {
    fields(&Table::of(field, &LIQUID_BRIDGE)?)
}
