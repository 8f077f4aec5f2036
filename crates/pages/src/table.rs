//! Tables between their markers on the pages.

use crate::bench::{Failed, root};

const END: &str = "<!-- end of table -->";

/// A table of a page. At first it has the cells that name its rows.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    /// The page, from the root of the repository.
    pub(crate) page: &'static str,
    /// The words of the program that write it.
    pub(crate) words: &'static str,
    pub(crate) head: Vec<&'static str>,
    pub(crate) rows: Vec<Vec<String>>,
    filled: usize,
}

impl Table {
    /// A table with this head, its cells between ` | `, and these first cells; none if they are
    /// results too.
    pub(crate) fn new<T: Into<String>>(
        page: &'static str,
        words: &'static str,
        head: &'static str,
        first_cells: impl IntoIterator<Item = T>,
    ) -> Self {
        let first_cells = first_cells.into_iter().map(|cell| vec![cell.into()]);
        Self {
            page,
            words,
            head: head.split(" | ").collect(),
            rows: first_cells.collect(),
            filled: 0,
        }
    }

    /// Adds the other cells of the next row, or a row without first cell.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        match self.rows.get_mut(self.filled) {
            Some(row) => row.extend(cells),
            None => self.rows.push(cells.into_iter().collect()),
        }
        self.filled += 1;
    }

    pub(crate) fn markdown(&self) -> Result<String, Failed> {
        let columns = self.head.len();
        if let Some(row) = self.rows.iter().find(|row| row.len() != columns) {
            return Err(format!("{}: not {columns} cells: {row:?}", self.words).into());
        }
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        let rule = "---|".repeat(columns);
        Ok(format!("| {} |\n|{rule}\n{rows}", self.head.join(" | ")))
    }
}

/// The text of a page before, within and behind its table of these words, the `at`-th of them.
pub(crate) fn parts<'a>(page: &'a str, words: &str, at: usize) -> Option<[&'a str; 3]> {
    let begin = format!("<!-- table: {words} -->\n");
    let from = page.match_indices(&begin).nth(at)?.0 + begin.len();
    let to = from + page[from..].find(END)?;
    Some([&page[..from], &page[from..to], &page[to..]])
}

/// The rows of a table as text, the head first.
pub(crate) fn rows(text: &str) -> Vec<Vec<String>> {
    let cells = |line: &str| {
        let line = line.trim().trim_start_matches('|').trim_end_matches('|');
        line.split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let lines = text.lines().filter(|line| !line.starts_with("|--"));
    lines.map(cells).collect()
}

/// Which of the tables with the same words on the same page a table is.
pub(crate) fn place(tables: &[Table], at: usize) -> usize {
    let own = &tables[at];
    let same = |other: &&Table| other.page == own.page && other.words == own.words;
    tables[..at].iter().filter(same).count()
}

/// Prints tables, and writes them into their pages: those of the same words stand there in this
/// order.
#[allow(clippy::print_stdout, reason = "it prints tables")]
pub(crate) fn write(tables: &[Table]) -> Result<(), Failed> {
    for (at, table) in tables.iter().enumerate() {
        let text = table.markdown()?;
        println!("{text}");
        let page = std::fs::read_to_string(root().join(table.page))?;
        let parts = parts(&page, table.words, place(tables, at));
        let [before, _, after] = parts.ok_or("the page has no such table")?;
        std::fs::write(root().join(table.page), format!("{before}{text}{after}"))?;
    }
    Ok(())
}
