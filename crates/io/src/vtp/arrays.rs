//! The arrays of a .vtp file by their names.

use std::collections::BTreeMap;

use super::decode::{DAMAGED, Number, Values};
use super::header::Declared;
use super::shape::{Counts, Shape};
use crate::diagnostic::{Diagnostic, Result};

/// An array of points or cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Array {
    /// Its numbers, those of each point or cell after the other.
    pub values: Vec<f64>,
    /// Numbers of each point or cell: 1, or 3 for vectors.
    pub components: usize,
    /// True if the file holds them as whole numbers: counts, indices, flags.
    pub is_whole: bool,
}

/// The arrays that were read.
#[derive(Debug, Clone, Default)]
pub struct Arrays {
    pub(super) counts: Option<Counts>,
    /// Names of all point data, in their order.
    pub(super) point_data: Vec<String>,
    named: BTreeMap<String, Array>,
    fields: BTreeMap<String, Vec<Number>>,
}

impl Arrays {
    /// Numbers of points and cells.
    pub fn counts(&self) -> Counts {
        self.counts.unwrap_or_default()
    }

    /// Names of all point data, read or not, in their order.
    pub fn point_data(&self) -> &[String] {
        &self.point_data
    }

    /// The arrays of points and cells by their sections and names: `PointData/radius_m`,
    /// `CellData/broken`, `Lines/connectivity`. The positions are always `Points/positions_m`.
    pub fn named(&self) -> &BTreeMap<String, Array> {
        &self.named
    }

    /// The same arrays without the rest.
    pub fn into_named(self) -> BTreeMap<String, Array> {
        self.named
    }

    /// Takes the numbers of an array of points or cells.
    pub fn take(&mut self, key: &str) -> Option<Vec<f64>> {
        self.named.remove(key).map(|array| array.values)
    }

    /// Takes a vector for each point or line. Empty: there is no such array.
    pub fn take_vectors<const SIZE: usize>(&mut self, key: &str) -> Vec<[f64; SIZE]> {
        let values = self.take(key).unwrap_or_default();
        values.as_chunks().0.to_vec()
    }

    /// Takes an array of numbers of particles, or of others of which there are no negative ones.
    ///
    /// # Errors
    /// A number is not whole, negative, or beyond 32 bits.
    pub fn take_indices(&mut self, key: &str) -> Result<Option<Vec<u32>>> {
        let Some(array) = self.named.remove(key) else {
            return Ok(None);
        };
        let index = |value: &f64| match *value as u32 {
            index if array.is_whole && f64::from(index) == *value => Ok(index),
            _ => {
                let problem = format!("{value} is not the number of a particle");
                Err(in_array(key, Diagnostic::input("", problem, DAMAGED)))
            }
        };
        array
            .values
            .iter()
            .map(index)
            .collect::<Result<_>>()
            .map(Some)
    }

    /// Whether there is field data of this name.
    pub fn has_field(&self, name: &str) -> bool {
        self.fields.contains_key(name)
    }

    /// The first number of a field.
    pub fn float(&self, name: &str) -> Option<f64> {
        self.numbers(name).first().copied().map(float)
    }

    /// All numbers of a field.
    pub fn floats(&self, name: &str) -> Vec<f64> {
        self.numbers(name).iter().copied().map(float).collect()
    }

    /// The first number of a field, which must be a whole one of 64 bits.
    ///
    /// # Errors
    /// It is not.
    pub fn whole(&self, name: &str) -> Result<Option<u64>> {
        let whole = self.numbers(name).first().copied().map(whole);
        whole.transpose().map_err(|error| in_array(name, error))
    }

    /// The first text of a field. None: there is no such field.
    ///
    /// # Errors
    /// A number is not a byte.
    pub fn text(&self, name: &str) -> Result<Option<String>> {
        let text = self.fields.get(name).map(|numbers| text(numbers));
        text.transpose().map_err(|error| in_array(name, error))
    }

    /// All texts of a field, each on one line. Empty: there is no such field.
    ///
    /// # Errors
    /// A number is not a byte.
    pub fn texts(&self, name: &str) -> Result<Vec<String>> {
        texts(self.numbers(name)).map_err(|error| in_array(name, error))
    }

    fn numbers(&self, field: &str) -> &[Number] {
        self.fields.get(field).map_or(&[], Vec::as_slice)
    }

    /// Stores the values of an array, if it is used.
    pub(super) fn fill(&mut self, declared: &Declared, values: Values<'_>) -> Result<()> {
        let filled = match declared.shape {
            None => Ok(()),
            Some(Shape::Field(_)) => all_numbers(declared, values, |number| number)
                .map(|all| drop(self.fields.insert(declared.name.clone(), all))),
            Some(shape) => self.fill_counted(declared, shape, values),
        };
        filled.map_err(|error| in_array(&declared.name, error))
    }

    fn fill_counted(
        &mut self,
        declared: &Declared,
        shape: Shape,
        values: Values<'_>,
    ) -> Result<()> {
        let counts = self
            .counts
            .ok_or_else(|| Diagnostic::input("", "it stands outside of a piece", DAMAGED))?;
        let array = self.named.entry(declared.key.clone()).or_default();
        let values = match shape {
            Shape::Each(of, each, what) => {
                let parts = counts
                    .parts(of)
                    .map(|count| u128::from(count) * u128::from(each));
                let (kept, found) = kept_of(declared, values, parts)?;
                // There is one set of points, and one of cells.
                let before = if declared.is_of_mesh {
                    array.values.len()
                } else {
                    0
                };
                check_count(found + before as u64, parts.iter().sum(), what)?;
                kept
            }
            Shape::Tuples => tuples(declared, values, &counts)?,
            Shape::Any | Shape::Field(_) => all_numbers(declared, values, float)?,
        };
        *array = Array {
            values,
            components: declared.components,
            is_whole: declared.scalar()?.is_whole(),
        };
        Ok(())
    }
}

/// The same message, with the array of this name, or of this section and name, as its place.
fn in_array(key: &str, error: Diagnostic) -> Diagnostic {
    let name = key.rsplit('/').next().unwrap_or(key);
    error.within(&format!("array '{name}'"))
}

pub(crate) fn check_count(found: u64, wanted: u128, what: &str) -> Result<()> {
    if u128::from(found) == wanted {
        return Ok(());
    }
    Err(Diagnostic::input(
        "",
        format!("{found} {what}, but the header says {wanted}"),
        DAMAGED,
    ))
}

fn all_numbers<T>(
    declared: &Declared,
    values: Values<'_>,
    of: impl Fn(Number) -> T,
) -> Result<Vec<T>> {
    let mut all = Vec::new();
    values.for_each(declared.scalar()?, |number| {
        all.push(of(number));
        Ok(())
    })?;
    Ok(all)
}

/// The values in the middle, and the number of all; `parts` are the numbers of those before, those
/// kept and those after.
fn kept_of(declared: &Declared, values: Values<'_>, parts: [u128; 3]) -> Result<(Vec<f64>, u64)> {
    let [before, wanted, _] = parts;
    let mut kept = Vec::new();
    let mut found = 0_u64;
    values.for_each(declared.scalar()?, |number| {
        if (before..before + wanted).contains(&u128::from(found)) {
            kept.push(float(number));
        }
        found += 1;
        Ok(())
    })?;
    Ok((kept, found))
}

/// The values that belong to lines, of data for all cells with equally many numbers each.
fn tuples(declared: &Declared, values: Values<'_>, counts: &Counts) -> Result<Vec<f64>> {
    let mut all = all_numbers(declared, values, float)?;
    let cells = counts.cells();
    let each = (all.len() as u64).checked_div(cells).unwrap_or(0);
    check_count(
        all.len() as u64,
        u128::from(each) * u128::from(cells),
        "values",
    )?;
    let number = |count: u64| (count * each) as usize;
    all.truncate(number(counts.cells_before + counts.lines));
    Ok(all.split_off(number(counts.cells_before)))
}

#[inline]
fn float(number: Number) -> f64 {
    match number {
        Number::Float(value) => value,
        Number::Integer(value) => value as f64,
    }
}

fn whole(number: Number) -> Result<u64> {
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
fn texts(numbers: &[Number]) -> Result<Vec<String>> {
    let each = numbers.split(|number| *number == Number::Integer(0));
    let each = each.filter(|text| !text.is_empty()).map(text);
    let on_one_line = |text: String| text.replace(char::is_control, " ");
    each.map(|text| text.map(on_one_line)).collect()
}

/// A text, terminated by the first zero. Its bytes may be signed or not.
fn text(numbers: &[Number]) -> Result<String> {
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
