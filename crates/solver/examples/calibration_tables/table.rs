//! A table as text of a page.

/// A table of the page.
pub(crate) struct Table {
    /// The word that selects it.
    pub(crate) word: &'static str,
    pub(crate) head: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

/// The head of a table of fixed columns.
pub(crate) fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

impl Table {
    /// The command that prints it, as a comment, and the table.
    pub(crate) fn markdown(&self) -> String {
        let command = "cargo run --release -p dem-run --example calibration_tables --";
        let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
        let mut lines = vec![
            format!("<!-- {command} {} -->", self.word),
            line(&self.head),
            format!("|{}", "---|".repeat(self.head.len())),
        ];
        lines.extend(self.rows.iter().map(|row| line(row)));
        lines.join("\n")
    }
}
