//! What the bonds of a body have been through, as columns of numbers with names: loads that are
//! summed step by step, plastic deformation, elements of flat joints, and the history of any other
//! law, whose columns begin with [`PREFIX`]. The law knows what they mean. Here are the rules of
//! those that are older than the prefix.

use crate::diagnostic::{Diagnostic, Result};
use crate::vtk::{NamedArray, Values};
use crate::vtp::{Arrays, Of, Shape};

/// A column: the same number of numbers for each bond. Vectors are in the axes of the body, or in
/// those of the scene of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BondColumn {
    /// Its name, with the unit at its end: `plastic_slip_m`.
    pub name: String,
    /// Numbers of each bond: 1, 3 for a vector, or more.
    pub components: usize,
    /// Those of each bond after those of the one before. Length: `components` times bonds.
    pub values: Vec<f64>,
}

impl BondColumn {
    /// A column of these values.
    pub fn new(name: &str, components: usize, values: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            components,
            values,
        }
    }

    /// The numbers of a bond. Empty: there is no such bond.
    pub fn of(&self, bond: usize) -> &[f64] {
        let from = bond * self.components;
        let numbers = self.values.get(from..from + self.components);
        numbers.unwrap_or_default()
    }

    /// As an array of a file.
    pub fn array(&self) -> NamedArray<'_> {
        let values = match self.components {
            components if self.is_flags() => Values::Flags(components, &self.values),
            components => Values::Tuples(components, &self.values),
        };
        NamedArray {
            name: &self.name,
            values,
        }
    }

    /// Makes it that of a body that has grown by a factor with the same strains and stresses: its
    /// unit tells how its numbers grow.
    pub fn grow(&mut self, factor: f64) {
        // Forces grow with the area of the bonds, moments and energies with the length as well.
        let powers = [("_n_m", 3), ("_j", 3), ("_n", 2), ("_m", 1)];
        let power = powers.iter().find(|(unit, _)| self.name.ends_with(unit));
        if let Some((_, power)) = power {
            let factor = factor.powi(*power);
            self.values.iter_mut().for_each(|value| *value *= factor);
        }
    }

    /// Whether it is of zeros and ones, one byte each in files.
    fn is_flags(&self) -> bool {
        self.name == FAILED_ELEMENTS
    }

    fn has_any(&self) -> bool {
        self.values.iter().any(|value| *value != 0.0)
    }

    fn is_finite(&self, bond: usize) -> bool {
        self.of(bond).iter().all(|value| value.is_finite())
    }
}

/// Begins the names of columns, but for those below.
pub const PREFIX: &str = "history_";
/// Bond array: unit vector along the bond without load, in the axes of the unturned particles.
pub const DIRECTION: &str = "initial_direction";
/// Bond array: summed shear force on the second end, N, a vector.
pub const SUMMED_SHEAR: &str = "summed_shear_n";
/// Bond array: summed moment on the second end, N m, a vector.
pub const SUMMED_MOMENT: &str = "summed_moment_n_m";
/// Bond array: plastic part of the length, m.
pub const PLASTIC_ELONGATION: &str = "plastic_elongation_m";
/// Bond array: plastic sliding, m, a vector.
pub const PLASTIC_SLIP: &str = "plastic_slip_m";
/// Bond array: plastic twist, rad.
pub const PLASTIC_TWIST: &str = "plastic_twist_rad";
/// Bond array: plastic bending, rad, a vector.
pub const PLASTIC_BEND: &str = "plastic_bend_rad";
/// Bond array: plastic work, J.
pub const PLASTIC_WORK: &str = "plastic_work_j";
/// Bond arrays: rotation vectors of the two ends relative to their particles, rad.
pub const PLASTIC_TURNS: [&str; 2] = ["plastic_turn_a_rad", "plastic_turn_b_rad"];
/// Bond array: unit vector to the edge at which the first element of a flat joint begins.
pub const FIRST_EDGE: &str = "first_element_edge";
/// Bond array: 1 for a failed element of a flat joint, else 0, for each of its elements.
pub const FAILED_ELEMENTS: &str = "failed_elements";
/// Bond array: sliding of the elements of a flat joint, m, a vector for each of its elements.
pub const ELEMENT_SLIP: &str = "element_slip_m";

/// Largest difference between the length of a direction and 1.
const LENGTH_OF_UNIT: f64 = 1e-6;

const SUMS: [&str; 2] = [SUMMED_SHEAR, SUMMED_MOMENT];
const PLASTICS: [&str; 7] = [
    PLASTIC_TURNS[0],
    PLASTIC_TURNS[1],
    PLASTIC_ELONGATION,
    PLASTIC_SLIP,
    PLASTIC_TWIST,
    PLASTIC_BEND,
    PLASTIC_WORK,
];
const JOINTS: [&str; 3] = [FIRST_EDGE, FAILED_ELEMENTS, ELEMENT_SLIP];

/// How many numbers a column of bonds has in files. None: it is no history.
pub(crate) fn shape(name: &str) -> Option<Shape> {
    match name {
        PLASTIC_ELONGATION | PLASTIC_TWIST | PLASTIC_WORK => {
            Some(Shape::Each(Of::Cells, 1, "values"))
        }
        FAILED_ELEMENTS | ELEMENT_SLIP => Some(Shape::Tuples),
        FIRST_EDGE => Some(Shape::Each(Of::Cells, 3, "values")),
        name if SUMS.contains(&name) || PLASTICS.contains(&name) => {
            Some(Shape::Each(Of::Cells, 3, "values"))
        }
        name => name.starts_with(PREFIX).then_some(Shape::Tuples),
    }
}

/// Takes the columns of so many bonds from a file, in the order in which this program writes them.
pub(crate) fn take(arrays: &mut Arrays, bonds: usize) -> Vec<BondColumn> {
    let old = SUMS.iter().chain(&PLASTICS).chain(&JOINTS);
    let keys = arrays.named().keys();
    let newer = keys.filter_map(|key| key.strip_prefix("CellData/"));
    let newer: Vec<String> = (newer.filter(|name| name.starts_with(PREFIX)))
        .map(str::to_owned)
        .collect();
    let names = old.copied().chain(newer.iter().map(String::as_str));
    let column = |name: &str| {
        let values = arrays.take(&format!("CellData/{name}"))?;
        let components = values.len().checked_div(bonds)?;
        let mut column = BondColumn::new(name, components, values);
        if column.is_flags() {
            let flag = |value: &mut f64| *value = f64::from(u8::from(*value != 0.0));
            column.values.iter_mut().for_each(flag);
        }
        (components > 0).then_some(column)
    };
    names.filter_map(column).collect()
}

/// The columns of some bonds, without what says nothing of them.
pub(super) fn of_some(columns: &[BondColumn], bonds: &[usize]) -> Vec<BondColumn> {
    let of = |column: &BondColumn| {
        let values = bonds.iter().flat_map(|bond| column.of(*bond));
        BondColumn {
            values: values.copied().collect(),
            ..column.clone()
        }
    };
    let some: Vec<BondColumn> = columns.iter().map(of).collect();
    let any_of = |names: &[&str]| among(&some, names).into_iter().any(BondColumn::has_any);
    let says_something = |column: &&BondColumn| match column.name.as_str() {
        name if SUMS.contains(&name) => !bonds.is_empty(),
        name if PLASTICS.contains(&name) => any_of(&PLASTICS),
        name if JOINTS.contains(&name) => any_of(&[FAILED_ELEMENTS]),
        _ => column.has_any(),
    };
    some.iter().filter(says_something).cloned().collect()
}

/// Whether any bond carries a load that was summed.
pub(super) fn are_loaded(columns: &[BondColumn]) -> bool {
    among(columns, &SUMS).into_iter().any(BondColumn::has_any)
}

/// Whether there is more than loads that were summed.
pub(super) fn are_more_than_sums(columns: &[BondColumn]) -> bool {
    columns.iter().any(|column| !SUMS.contains(&&*column.name))
}

/// Whether a column is of a law that came with the prefix.
fn is_newer(column: &&BondColumn) -> bool {
    let name = &&*column.name;
    ![&SUMS[..], &PLASTICS, &JOINTS]
        .iter()
        .any(|names| names.contains(name))
}

fn find<'a>(columns: &'a [BondColumn], name: &str) -> Option<&'a BondColumn> {
    columns.iter().find(|column| column.name == name)
}

/// The columns of these names that there are, in the order of the names.
fn among<'a>(columns: &'a [BondColumn], names: &[&str]) -> Vec<&'a BondColumn> {
    (names.iter().filter_map(|name| find(columns, name))).collect()
}

/// Bytes of summed loads for the hash of a body.
pub(super) fn hashed_sums(columns: &[BondColumn], bonds: usize) -> Vec<u8> {
    hashed(columns, &SUMS, bonds)
}

/// Bytes of all other columns for the hash of a body.
pub(super) fn hashed_others(columns: &[BondColumn], bonds: usize) -> Vec<u8> {
    let [turn_a, turn_b, rest @ ..] = PLASTICS;
    let [edge, failed, slip] = JOINTS;
    let mut bytes = hashed(columns, &[&rest[..], &[turn_a, turn_b]].concat(), bonds);
    bytes.extend(hashed(columns, &[edge, slip, failed], bonds));
    for column in columns.iter().filter(is_newer) {
        bytes.extend(column.name.bytes());
        bytes.extend(hashed(columns, &[&column.name], bonds));
    }
    bytes
}

/// Bytes of these columns, bond by bond.
fn hashed(columns: &[BondColumn], names: &[&str], bonds: usize) -> Vec<u8> {
    let columns = among(columns, names);
    let mut bytes = Vec::new();
    for bond in 0..bonds {
        for column in &columns {
            for number in column.of(bond) {
                match column.is_flags() {
                    true => bytes.push(u8::from(*number != 0.0)),
                    false => bytes.extend(number.to_bits().to_le_bytes()),
                }
            }
        }
    }
    bytes
}

/// Checks directions without load: unit vectors.
pub(super) fn check_directions(directions: &[[f64; 3]]) -> Result<()> {
    for (bond, [x, y, z]) in directions.iter().enumerate() {
        let size = (x * x + y * y + z * z).sqrt();
        let is_unit = (size - 1.0).abs() < LENGTH_OF_UNIT;
        if !is_unit {
            return Err(wrong(bond, "its direction without load is no unit vector"));
        }
    }
    Ok(())
}

/// Checks the history of bonds of these lengths, m: names, shapes, finite numbers, and the limits
/// of plastic deformation and of flat joints.
pub(super) fn check(columns: &[BondColumn], lengths_m: &[f64]) -> Result<()> {
    let bonds = lengths_m.len();
    for column in columns {
        let (name, found, each) = (&column.name, column.values.len(), column.components);
        if shape(name).is_none() {
            let problem = format!("bonds have a history '{name}', which no file can hold");
            let remedy = format!("its name must begin with {PREFIX}");
            return Err(Diagnostic::input("", problem, remedy));
        }
        if found != each * bonds {
            let problem = format!("{found} values of '{name}' for {bonds} bonds");
            let remedy = format!("there must be {each} each");
            return Err(Diagnostic::input("", problem, remedy));
        }
    }
    check_finite(columns, &SUMS, bonds, "its summed load is not finite")?;
    check_plastics(columns, lengths_m)?;
    check_joints(columns, bonds)?;
    columns.iter().filter(is_newer).try_for_each(|column| {
        let problem = format!("its '{}' is not finite", column.name);
        check_finite(columns, &[&column.name], bonds, &problem)
    })
}

fn check_finite(columns: &[BondColumn], names: &[&str], bonds: usize, problem: &str) -> Result<()> {
    let columns = among(columns, names);
    let is_wrong = |bond: &usize| columns.iter().any(|column| !column.is_finite(*bond));
    (0..bonds)
        .find(is_wrong)
        .map_or(Ok(()), |bond| Err(wrong(bond, problem)))
}

fn check_plastics(columns: &[BondColumn], lengths_m: &[f64]) -> Result<()> {
    let plastics = among(columns, &PLASTICS);
    let elongations = find(columns, PLASTIC_ELONGATION);
    for (bond, length_m) in lengths_m.iter().enumerate() {
        if !plastics.iter().all(|column| column.is_finite(bond)) {
            return Err(wrong(bond, "its plastic deformation is not finite"));
        }
        let elongation_m = elongations.and_then(|column| column.of(bond).first());
        if elongation_m.is_some_and(|elongation_m| elongation_m >= length_m) {
            let problem = "its plastic elongation is not less than its length";
            return Err(wrong(bond, problem));
        }
    }
    Ok(())
}

fn check_joints(columns: &[BondColumn], bonds: usize) -> Result<()> {
    let [edges, failed, slips] = JOINTS.map(|name| find(columns, name));
    for bond in 0..bonds {
        if let Some(failed) = failed.map(|column| column.of(bond)) {
            let edge = edges.map_or(&[][..], |column| column.of(bond));
            let size = edge.iter().map(|x| x * x).sum::<f64>().sqrt();
            if !(0.5..2.0).contains(&size) {
                let problem = "the edge of its first element is no unit vector";
                return Err(wrong(bond, problem));
            }
            if failed.iter().all(|failed| *failed != 0.0) {
                return Err(wrong(bond, "all of its elements have failed"));
            }
        }
        if slips.is_some_and(|column| !column.is_finite(bond)) {
            return Err(wrong(bond, "the sliding of its elements is not finite"));
        }
    }
    Ok(())
}

fn wrong(bond: usize, problem: &str) -> Diagnostic {
    Diagnostic::input(
        format!("bond {bond}"),
        problem,
        "remove this bond, or the arrays of its history",
    )
}
