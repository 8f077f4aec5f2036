//! The head of a table: names and units of its columns.

use crate::numbers::{Notation, Separator};
use crate::units::{is_travel_or_force, is_unit};

/// A column of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Column {
    /// Its name, without the unit; empty: it has none.
    pub name: String,
    /// Its unit as written; empty: it has none.
    pub unit: String,
}

/// The cells of a line above the numbers. None: it has other columns than the numbers, of which the
/// last `empty` are empty.
pub(crate) fn head_cells(
    line: &str,
    notation: &Notation,
    width: usize,
    empty: usize,
) -> Option<Vec<String>> {
    let line = line.trim_start_matches(['#', '%']);
    let owned = |cells: Vec<&str>| {
        cells
            .into_iter()
            .map(str::to_owned)
            .collect::<Vec<String>>()
    };
    if notation.separator != Separator::Space {
        let mut cells = owned(notation.cells(line));
        while cells.len() > width && cells.last().is_some_and(String::is_empty) {
            cells.pop();
        }
        if (width - empty..width).contains(&cells.len()) {
            cells.resize(width, String::new());
        }
        return (cells.len() == width).then_some(cells);
    }
    // Names may have spaces in them: "Travel [mm]   Force [N]", "Travel [mm] Force [N]".
    let words = notation.cells(line);
    let wide: Vec<&str> = line
        .split(['\t'])
        .flat_map(|part| part.split("  "))
        .collect();
    let wide: Vec<&str> = wide
        .into_iter()
        .map(str::trim)
        .filter(|cell| !cell.is_empty())
        .collect();
    let pairs: Vec<String> = words.chunks(2).map(|pair| pair.join(" ")).collect();
    [owned(wide), owned(words), pairs]
        .into_iter()
        .find(|cells| cells.len() == width)
}

/// Names and units of the columns from the lines above the numbers, the nearest last.
pub(crate) fn columns(head: &[Vec<String>], width: usize) -> Vec<Column> {
    let is_filled = |cells: &&Vec<String>| cells.iter().any(|cell| !cell.is_empty());
    let mut lines = head.iter().rev().filter(is_filled);
    let mut nearest = lines.next();
    let mut units = None;
    if nearest.is_some_and(|cells| is_row_of_units(cells)) {
        units = nearest;
        nearest = lines.next();
    }
    let column = |at: usize| {
        let cell = nearest.and_then(|cells| cells.get(at));
        let mut column = named(cell.map_or("", String::as_str));
        if let Some(unit) = units.and_then(|cells| cells.get(at))
            && !unit.is_empty()
        {
            bare(unit).clone_into(&mut column.unit);
        }
        column
    };
    (0..width).map(column).collect()
}

/// Whether cells are units: all of them, or a unit of travel or force and at least half of them, as
/// long as the others are single words.
fn is_row_of_units(cells: &[String]) -> bool {
    let filled: Vec<&str> = cells
        .iter()
        .map(|cell| bare(cell))
        .filter(|cell| !cell.is_empty())
        .collect();
    let known = filled.iter().filter(|cell| is_unit(cell)).count();
    if known == filled.len() {
        return true;
    }
    let is_name = |cell: &&str| !is_unit(cell) && (cell.contains(' ') || cell.contains(['(', '[']));
    filled.iter().any(|cell| is_travel_or_force(cell))
        && 2 * known >= filled.len()
        && !filled.iter().any(is_name)
}

/// Whether cells are the head of a table: one of them is a unit, or a name with one.
pub(crate) fn has_units(cells: &[&str]) -> bool {
    cells
        .iter()
        .any(|cell| is_unit(bare(cell)) || !named(cell).unit.is_empty())
}

/// A unit without the brackets around it.
fn bare(cell: &str) -> &str {
    cell.trim_matches(['[', ']', '(', ')', '<', '>']).trim()
}

/// Name and unit from the head of a column: "Force [N]", "Force (N)", "Force / N", "Force in N",
/// "force_n".
pub(crate) fn named(cell: &str) -> Column {
    let of = |name: &str, unit: &str| Column {
        name: name.trim().to_owned(),
        unit: unit.trim().to_owned(),
    };
    if let Some((name, unit)) = in_brackets(cell) {
        return of(name, unit);
    }
    for between in ["/", " in ", ",", " "] {
        if let Some((name, unit)) = cell.rsplit_once(between)
            && is_last_word(unit.trim())
        {
            return of(name, unit);
        }
    }
    if let Some((name, unit)) = cell.rsplit_once('_') {
        let known = ["m", "mm", "um", "in", "N", "kN", "MN", "lbf", "kgf"];
        if let Some(unit) = known.iter().find(|known| known.eq_ignore_ascii_case(unit)) {
            return of(name, unit);
        }
    }
    of(cell, "")
}

/// Whether the last word of a head is its unit. A single letter has to be written as the unit is.
fn is_last_word(word: &str) -> bool {
    let is_letter = word.chars().count() == 1 && word.chars().all(char::is_alphabetic);
    is_unit(word) && (!is_letter || matches!(word, "m" | "N" | "s"))
}

/// What stands before the brackets around the unit, and the unit: of several brackets the first
/// that hold a known unit, or else the first.
fn in_brackets(cell: &str) -> Option<(&str, &str)> {
    let mut found: Vec<(&str, &str)> = Vec::new();
    for (open, close) in [('[', ']'), ('(', ')'), ('<', '>')] {
        for (at, _) in cell.match_indices(open) {
            let rest = &cell[at + 1..];
            found.extend(rest.split_once(close).map(|(unit, _)| (&cell[..at], unit)));
        }
    }
    let known = found.iter().find(|(_, unit)| is_unit(unit.trim()));
    known.or(found.first()).copied()
}
