//! The arrays of a .vtp file as walls.

use super::decode::{Number, Values};
use super::header::{Array, Counts, Role};
use super::numbers::{check_count, float, particle, texts};
use crate::body::stored_walls::{FIXED_WALLS, StoredWalls, WALL_FORCES, WALL_NAMES};
use crate::diagnostic::Result;

/// Fills the array of a role that only walls have.
pub(super) fn fill(
    walls: &mut StoredWalls,
    counts: Counts,
    array: &Array,
    values: Values<'_>,
) -> Result<()> {
    let mut numbers: Vec<u32> = Vec::new();
    values.for_each(array.scalar()?, |number| {
        numbers.push(particle(number)?);
        Ok(())
    })?;
    let triangles = u128::from(counts.cells_after);
    let found = numbers.len() as u64;
    match array.role {
        Role::Corners => {
            check_count(found, 3 * triangles, "corners")?;
            walls.triangles = numbers.as_chunks().0.to_vec();
        }
        Role::CornerOffsets => check_count(found, triangles, "offsets")?,
        _ => {
            check_count(found, triangles, "values")?;
            walls.wall_of_triangle = numbers;
        }
    }
    Ok(())
}

/// Fills a field that only walls have.
pub(super) fn fill_field(walls: &mut StoredWalls, name: &str, numbers: &[Number]) -> Result<()> {
    match name {
        WALL_NAMES => walls.names = texts(numbers)?,
        WALL_FORCES => {
            let values: Vec<f64> = numbers.iter().map(|number| float(*number)).collect();
            walls.forces_n = values.as_chunks().0.to_vec();
        }
        FIXED_WALLS => walls.has_fixed = true,
        _ => {}
    }
    Ok(())
}
