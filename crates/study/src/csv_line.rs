//! Lines of the CSV files of a sweep.

use dem_io::text::{exact, visible};

/// A number, or nothing.
pub(crate) fn number(value: Option<f64>) -> String {
    value.map_or(String::new(), exact)
}

/// Cells between commas, in quotes where needed.
pub(crate) fn line(cells: &[String]) -> String {
    let cells: Vec<String> = cells
        .iter()
        .map(|cell| {
            let cell = visible(cell);
            if cell.contains([',', '"']) {
                format!("\"{}\"", cell.replace('"', "\"\""))
            } else {
                cell.into_owned()
            }
        })
        .collect();
    format!("{}\n", cells.join(","))
}
