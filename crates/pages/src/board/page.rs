//! The table of the board.

use super::rows::{Row, bonded, measured, of_programs, of_rocks, of_sections, of_sizes, of_tables};
use super::{quasi_static, robin};
use crate::bench::{Bench, Failed};
use crate::table::{Table, write as write_tables};

const HEAD: &str = "case | source | ours | theirs | error | hardware | run time";

fn row_cells(row: Row) -> Vec<String> {
    [
        row.case,
        row.source,
        row.ours,
        row.theirs,
        row.error,
        row.hardware,
        row.time,
    ]
    .into()
}

/// The tables of the page, whole: one for each kind of source.
pub(crate) fn tables() -> Result<[Table; 6], Failed> {
    let mut tables = Vec::new();
    let of_others = [
        robin::rows()?,
        measured()?,
        of_rocks()?,
        quasi_static::rows()?,
    ]
    .concat();
    for rows in [
        of_others,
        of_programs()?,
        bonded()?,
        of_tables()?,
        of_sizes()?,
        of_sections()?,
    ] {
        let page = "tests/verification/board.md";
        let none: [String; 0] = [];
        let mut table = Table::new(page, "board page", HEAD, none);
        for row in rows {
            table.row(row_cells(row));
        }
        tables.push(table);
    }
    tables.try_into().map_err(|_| "not six tables".into())
}

pub(crate) fn write(_: &Bench) -> Result<(), Failed> {
    write_tables(&tables()?)
}
