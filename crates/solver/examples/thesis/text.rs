//! Tables and cells of the page.

use serde_json::Value;

/// A table of the page: its head and its rows, each with as many cells.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    /// What computes it: a word of the program.
    pub(crate) word: &'static str,
    pub(crate) head: &'static [&'static str],
    /// Number of cells at the beginning of a row that name it.
    pub(crate) names: usize,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    /// The command that computes it, as a comment, and the table.
    pub(crate) fn markdown(&self) -> String {
        let command = "cargo run --release -p dem-run --example thesis --";
        let mut lines = vec![
            format!("<!-- {command} {} -->", self.word),
            line(self.head),
            format!("|{}", "---|".repeat(self.head.len())),
        ];
        lines.extend(self.rows.iter().map(|row| line(row)));
        lines.join("\n")
    }

    /// The table with what earlier rows have more: cells that are empty now, and rows of more
    /// packings. Rows without any result are left out.
    pub(crate) fn kept(mut self, earlier: &[Vec<String>]) -> Self {
        let count = self.head.iter().position(|head| *head == "packings");
        let names = self.names;
        for row in &mut self.rows {
            let same = |other: &&Vec<String>| other[..names] == row[..names];
            let Some(other) = earlier.iter().find(same) else {
                continue;
            };
            let packings = |row: &[String]| count.map_or(0, |at| row[at].parse().unwrap_or(0));
            if packings(other) > packings(row) {
                row.clone_from(other);
            }
            for (cell, other) in row.iter_mut().zip(other) {
                if cell.is_empty() || packings_within(other) > packings_within(cell) {
                    cell.clone_from(other);
                }
            }
        }
        self.rows.retain(|row| {
            let mut results = row[names..].iter().enumerate();
            results.any(|(at, cell)| Some(names + at) != count && !cell.is_empty())
        });
        self
    }
}

/// Number of packings at the end of a cell: 4 in `broken (4)`; 0 if there is none.
fn packings_within(cell: &str) -> u32 {
    let inside = cell
        .rsplit_once('(')
        .and_then(|(_, end)| end.strip_suffix(')'));
    inside.and_then(|count| count.parse().ok()).unwrap_or(0)
}

/// The rows of the table below the comment with this word: the `at`-th such table.
pub(crate) fn rows(page: &str, word: &str, at: usize) -> Vec<Vec<String>> {
    let comment = format!("--example thesis -- {word} -->");
    let after = page.split(&comment).nth(at + 1).unwrap_or_default();
    let lines = after
        .lines()
        .skip(3)
        .take_while(|line| line.starts_with('|'));
    let cells = |line: &str| {
        let cells = line.trim_matches('|').split('|');
        cells.map(|cell| cell.trim().to_owned()).collect()
    };
    lines.map(cells).collect()
}

fn line<T: AsRef<str>>(cells: &[T]) -> String {
    let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
    format!("| {} |", cells.join(" | "))
}

/// Cells of one row of the thesis, or of ours.
pub(crate) fn cells<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).into()
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// A number with so many digits behind the point. Empty if there is none.
pub(crate) fn rounded(number: f64, digits: usize) -> String {
    if number.is_finite() {
        format!("{number:.digits$}")
    } else {
        String::new()
    }
}

/// Mean, and standard deviation if there are several: `12.05 +- 0.16`. Empty if there are none.
pub(crate) fn mean(values: &[f64], digits: usize) -> String {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    match values.len() {
        0 => String::new(),
        1 => format!("{mean:.digits$}"),
        _ => format!(
            "{mean:.digits$} +- {:.digits$}",
            (squares / (count - 1.0)).sqrt()
        ),
    }
}

/// Smallest to largest: `0.50 to 0.68`. Empty if there are none.
pub(crate) fn range(values: &[f64], digits: usize) -> String {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted[..] {
        [] => String::new(),
        [least, .., most] if format!("{least:.digits$}") != format!("{most:.digits$}") => {
            format!("{least:.digits$} to {most:.digits$}")
        }
        [least, ..] => format!("{least:.digits$}"),
    }
}

/// A whole number with commas between thousands.
pub(crate) fn thousands(number: f64) -> String {
    let digits = format!("{number:.0}");
    let mut text = String::new();
    for (place, digit) in digits.char_indices() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
