//! Tables of benchmarks: printed row by row, and written into a page if `--page FILE` is given.

use std::path::{Path, PathBuf};

/// A table that grows row by row.
pub(crate) struct Table {
    rows: String,
    page: Option<PathBuf>,
}

impl Table {
    /// An empty one, for the page that the program's arguments name, from the root of the
    /// repository. A page has whole tables: with the names of some cases as well it is refused.
    pub(crate) fn new() -> Self {
        let mut after = std::env::args().skip_while(|word| word != "--page").skip(1);
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let page = after.next().map(|page| root.join(page));
        assert!(
            page.is_none() || words().is_empty(),
            "--page is for all cases: a page has whole tables"
        );
        Self {
            rows: String::new(),
            page,
        }
    }

    /// Prints a row.
    pub(crate) fn row(&mut self, row: &str) {
        println!("{row}");
        self.rows += row;
        self.rows.push('\n');
    }

    /// Writes the rows into the page, between the line `<!-- table: cargo bench NAME -->` and the
    /// end of that table.
    pub(crate) fn write(&self, name: &str) {
        let Some(page) = &self.page else {
            return;
        };
        let text = std::fs::read_to_string(page).expect("the page is there");
        let (begin, end) = (
            format!("<!-- table: cargo bench {name} -->\n"),
            "<!-- end of table -->",
        );
        let (before, after) = text.split_once(&begin).expect("the page has the table");
        let (_, after) = after.split_once(end).expect("the table ends");
        let text = format!("{before}{begin}{}{end}{after}", self.rows);
        std::fs::write(page, text).expect("the page can be written");
    }
}

/// Arguments that are neither options nor the page.
pub(crate) fn words() -> Vec<String> {
    let mut words = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(word) = arguments.next() {
        if word == "--page" {
            arguments.next();
        } else if !word.starts_with('-') {
            words.push(word);
        }
    }
    words
}
