//! Directions, and rotations about them.

use super::field::Field;
use super::schema::{Kind, table_schema};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGLE, NUMBER};

table_schema! {
    /// A rotation.
    pub(super) static ROTATION = "Rotation";

    /// Axis of rotation; its length does not matter.
    new("axis", Kind::Direction("an axis")).required("[0, 0, 1]");
    /// Angle, right-handed about the axis.
    quantity("angle", &ANGLE).required("\"45 deg\"");
}

/// A vector of length 1 along the three numbers of `field`, called `what` in messages: "an axis".
/// Not all of them may be zero.
pub(super) fn direction(field: &Field<'_>, what: &str) -> Result<[f64; 3]> {
    let given = field.vector(&NUMBER)?;
    // Scaled first: squares of very large or small numbers leave the range of f64.
    let largest = given.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if largest == 0.0 {
        let problem = "is [0, 0, 0], which points nowhere";
        return Err(field.fault(problem, format!("give {what} such as [0, 0, 1]")));
    }
    let scaled = given.map(|c| c / largest);
    let length = scaled.iter().map(|c| c * c).sum::<f64>().sqrt();
    Ok(scaled.map(|c| c / length))
}

/// `{ axis, angle }` as a rotation vector, rad.
pub(super) fn rotation(field: &Field<'_>) -> Result<[f64; 3]> {
    let table = Table::of(field, &ROTATION)?;
    let axis = direction(&table.need("axis")?, "an axis")?;
    let angle = table.need("angle")?.quantity(&ANGLE)?;
    Ok(axis.map(|c| c * angle))
}
