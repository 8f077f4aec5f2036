//! `drop` of `[bodies.NAME]`: a body just above a wall, with the speed of a fall.

use std::collections::BTreeMap;

use super::body::BodyEntry;
use super::inlet::Inlet;
use super::listing::Listing;
use super::run::Run;
use super::schema::{Key, Schema};
use super::table::Table;
use super::wall::Wall;
use dem_io::diagnostic::Result;
use dem_io::units::LENGTH;

/// A smaller cosine between a position and gravity is due to rounding.
const ROUNDING: f64 = 1e-12;

/// Where a body falls from, and onto what.
#[derive(Debug, Clone, PartialEq)]
pub struct Fall {
    /// `height`: distance, along gravity, that the first point of the body to touch the wall has
    /// fallen from rest when it does so, m; above 0.
    pub height_m: f64,
    /// `onto`: a name of `[walls]`.
    pub onto: String,
}

pub(super) static DROP: Schema = Schema {
    title: "Drop",
    doc: "A fall from rest onto a wall, from above it.",
    keys: &[
        Key::quantity(
            "height",
            &LENGTH,
            "Distance along gravity that the first point to touch the wall has fallen by then: the speed of impact is sqrt(2 g height).",
        )
        .positive()
        .required("\"1 m\""),
        Key::text("onto", "a name in [walls]", "The wall that the body falls onto: a plane, a box, a cylinder or an STL surface below it.")
            .required("\"NAME\", a name in [walls]"),
    ],
};

/// `drop` of a body.
///
/// # Errors
/// A key is missing or bad, or the body has a velocity as well.
pub(super) fn read(body: &Table<'_>) -> Result<Option<Fall>> {
    let Some(field) = body.get("drop") else {
        return Ok(None);
    };
    let table = Table::of(&field, &DROP)?;
    if let Some(velocity) = body.get("velocity") {
        let problem = format!("{} cannot be combined with drop", velocity.path);
        let remedy = "either gives the speed at the start: remove the other";
        return Err(velocity.refuse(problem, remedy));
    }
    Ok(Some(Fall {
        height_m: table.read("height")?,
        onto: table.need("onto")?.text()?.to_owned(),
    }))
}

/// Refuses falls without gravity, onto an unknown wall, or of bodies that are fed;
/// and a `position` along gravity, which is that of the fall.
pub(super) fn refuse_falls(
    root: &Table<'_>,
    run: &Run,
    bodies: &BTreeMap<String, BodyEntry>,
    walls: &BTreeMap<String, Wall>,
    inlets: &BTreeMap<String, Inlet>,
) -> Result<()> {
    for (name, body) in bodies {
        let (Some(_), Some(field)) = (&body.fall, root.find(&["bodies", name, "drop"])) else {
            continue;
        };
        let onto = Table::of(&field, &DROP)?.need("onto")?;
        onto.reference(walls.keys(), "walls")?;
        let gravity = run.gravity_m_s2;
        if gravity == [0.0; 3] {
            let problem = format!("{} needs gravity, and there is none", field.path);
            return Err(field.refuse(problem, "add gravity = [0, 0, -9.81] to [run]"));
        }
        if let Some((inlet, _)) = inlets.iter().find(|(_, inlet)| feeds(inlet, name)) {
            let problem = format!(
                "{} is of the start, but [inlets.{inlet}] feeds the body: it is not there then",
                field.path
            );
            return Err(field.refuse(problem, format!("remove it, or [inlets.{inlet}]")));
        }
        let along = |one: [f64; 3], other: [f64; 3]| (0..3).map(|k| one[k] * other[k]).sum::<f64>();
        let position = body.position_m;
        let sizes = along(position, position) * along(gravity, gravity);
        let is_along = along(position, gravity).abs() > ROUNDING * sizes.sqrt();
        if let (Some(field), true) = (root.find(&["bodies", name, "position"]), is_along) {
            let problem = format!(
                "{} moves the body along gravity, and so does drop",
                field.path
            );
            let remedy = "leave its part along gravity at 0: it follows from the wall";
            return Err(field.refuse(problem, remedy));
        }
    }
    Ok(())
}

fn feeds(inlet: &Inlet, body: &str) -> bool {
    inlet.bodies.iter().any(|(name, _)| name == body)
}

pub(super) fn list(fall: &Fall, listing: &mut Listing) {
    listing.table("drop", &DROP, |listing| {
        listing.value("height", &fall.height_m);
        listing.text("onto", &fall.onto);
    });
}
