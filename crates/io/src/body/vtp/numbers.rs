//! The numbers of an array as what they stand for.

use super::decode::{DAMAGED, Number, Values};
use super::header::{Array, Counts};
use crate::diagnostic::{Diagnostic, Result};

pub(super) fn check_count(found: u64, wanted: u128, what: &str) -> Result<()> {
    if u128::from(found) == wanted {
        return Ok(());
    }
    Err(Diagnostic::input(
        "",
        format!("{found} {what}, but the header says {wanted}"),
        DAMAGED,
    ))
}

/// The values in the middle: `counts` are those before, those wanted and those after.
pub(super) fn floats(array: &Array, values: Values<'_>, counts: [u64; 3]) -> Result<Vec<f64>> {
    let [before, wanted, after] = counts.map(u128::from);
    let mut kept = Vec::new();
    let mut number_of = 0_u64;
    values.for_each(array.scalar()?, |number| {
        if (before..before + wanted).contains(&u128::from(number_of)) {
            kept.push(float(number));
        }
        number_of += 1;
        Ok(())
    })?;
    check_count(number_of, before + wanted + after, "values")?;
    Ok(kept)
}

/// The values that belong to lines, of data for all cells.
pub(super) fn line_values(array: &Array, values: Values<'_>, counts: Counts) -> Result<Vec<f64>> {
    floats(
        array,
        values,
        [counts.cells_before, counts.lines, counts.cells_after],
    )
}

/// The values that belong to lines, of data for all cells with equally many numbers each.
pub(super) fn tuples(array: &Array, values: Values<'_>, counts: Counts) -> Result<Vec<f64>> {
    let mut all = Vec::new();
    values.for_each(array.scalar()?, |number| {
        all.push(float(number));
        Ok(())
    })?;
    let [before, lines, after] = [counts.cells_before, counts.lines, counts.cells_after];
    let cells = before.saturating_add(lines).saturating_add(after);
    let each = (all.len() as u64).checked_div(cells).unwrap_or(0);
    check_count(
        all.len() as u64,
        u128::from(each) * u128::from(cells),
        "values",
    )?;
    let number = |count: u64| (count * each) as usize;
    all.truncate(number(before + lines));
    Ok(all.split_off(number(before)))
}

/// A whole number for each point.
pub(super) fn particle_numbers(
    array: &Array,
    values: Values<'_>,
    counts: Counts,
) -> Result<Vec<u32>> {
    let mut numbers = Vec::new();
    values.for_each(array.scalar()?, |number| {
        numbers.push(particle(number)?);
        Ok(())
    })?;
    check_count(numbers.len() as u64, counts.points.into(), "values")?;
    Ok(numbers)
}

#[inline]
pub(super) fn float(number: Number) -> f64 {
    match number {
        Number::Float(value) => value,
        Number::Integer(value) => value as f64,
    }
}

#[inline]
pub(super) fn particle(number: Number) -> Result<u32> {
    if let Number::Integer(value) = number
        && let Ok(particle) = u32::try_from(value)
    {
        return Ok(particle);
    }
    Err(Diagnostic::input(
        "",
        format!("{} is not the number of a particle", float(number)),
        DAMAGED,
    ))
}

pub(super) fn whole(number: Number) -> Result<u64> {
    if let Number::Integer(value) = number
        && let Ok(value) = u64::try_from(value)
    {
        return Ok(value);
    }
    Err(Diagnostic::input(
        "",
        format!("{} is not a whole number of 64 bits", float(number)),
        DAMAGED,
    ))
}

/// Texts of one line, each terminated by a zero.
pub(super) fn texts(numbers: &[Number]) -> Result<Vec<String>> {
    let each = numbers.split(|number| *number == Number::Integer(0));
    let each = each.filter(|text| !text.is_empty()).map(text);
    let on_one_line = |text: String| text.replace(char::is_control, " ");
    each.map(|text| text.map(on_one_line)).collect()
}

/// A text, terminated by the first zero. Its bytes may be signed or not.
pub(super) fn text(numbers: &[Number]) -> Result<String> {
    let mut bytes = Vec::new();
    for &number in numbers {
        match number {
            Number::Integer(0) => break,
            Number::Integer(byte @ -128..256) => bytes.push(byte as u8),
            _ => {
                return Err(Diagnostic::input(
                    "",
                    format!("{} is not a byte of a text", float(number)),
                    DAMAGED,
                ));
            }
        }
    }
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
