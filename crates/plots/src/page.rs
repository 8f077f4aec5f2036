//! Self-contained pages.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::svg::Svg;
use crate::text::shown;

/// The common style of all pages.
const STYLE: &str = include_str!("page.css");

/// A page, from its title downwards.
#[derive(Debug, Clone)]
pub struct Page {
    title: String,
    content: Vec<Markup>,
}

/// A table. Without column names it has no header.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// The columns, from the left.
    pub columns: Vec<Column>,
    /// The rows, from the top.
    pub rows: Vec<Row>,
}

/// A column of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// True if it contains numbers, which are right-aligned.
    pub is_number: bool,
}

/// A row of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// The texts of its columns; those at the end may be missing.
    pub cells: Vec<String>,
    /// True for a failure, shown in red.
    pub is_bad: bool,
    /// The file to which its first cell links, relative to the page.
    pub link: Option<String>,
}

impl From<Vec<String>> for Row {
    /// A row without failures.
    fn from(cells: Vec<String>) -> Self {
        Self {
            cells,
            ..Self::default()
        }
    }
}

impl Column {
    /// A column of texts.
    pub fn text(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            is_number: false,
        }
    }

    /// A column of numbers.
    pub fn number(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            is_number: true,
        }
    }

    fn class(&self) -> Option<&'static str> {
        self.is_number.then_some("n")
    }
}

impl Page {
    /// A page with only its title.
    pub fn new(title: &str) -> Self {
        Self {
            title: shown(title),
            content: Vec::new(),
        }
    }

    /// Adds a heading.
    pub fn heading(&mut self, text: &str) {
        self.content.push(html! { h2 { (shown(text)) } });
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) {
        self.content.push(html! { p { (shown(text)) } });
    }

    /// Adds a paragraph in small letters.
    pub fn small(&mut self, text: &str) {
        self.content
            .push(html! { p class="small" { (shown(text)) } });
    }

    /// Adds a list, unless it is empty.
    pub fn list(&mut self, items: &[String]) {
        if !items.is_empty() {
            let items = html! { ul { @for item in items { li { (shown(item)) } } } };
            self.content.push(items);
        }
    }

    /// Adds whether the result can be trusted, in `word` ("sound", "coarse" or "doubtful"), and
    /// why.
    pub fn verdict(&mut self, headline: &str, word: &str, reasons: &[String]) {
        let class = format!("verdict {word}");
        self.content.push(html! {
            div class=(class) {
                p { strong { (shown(headline)) } }
                @if !reasons.is_empty() {
                    ul { @for reason in reasons { li { (shown(reason)) } } }
                }
            }
        });
    }

    /// Adds a text of many lines that opens on demand.
    pub fn details(&mut self, title: &str, text: &str) {
        let lines: Vec<String> = text.lines().map(shown).collect();
        self.content.push(html! {
            details { summary { (shown(title)) } pre { (lines.join("\n")) } }
        });
    }

    /// Adds named fractions as bars, each with its text.
    pub fn bars(&mut self, bars: &[(String, f64, String)]) {
        self.content.push(html! {
            table class="bars" {
                @for (name, fraction, text) in bars {
                    tr {
                        td { (shown(name)) }
                        td class="n" { (shown(text)) }
                        td class="bar" {
                            span style={ "width:" (format!("{:.1}", 100.0 * fraction)) "%" } {}
                        }
                    }
                }
            }
        });
    }

    /// Adds drawings, side by side where there is room: texts of SVG files that this program wrote.
    pub fn gallery(&mut self, files: &[String]) {
        self.content.push(html! {
            div class="gallery" { @for file in files { (PreEscaped(file)) } }
        });
    }

    /// Adds a part of a page as it stands.
    pub fn part(&mut self, part: Markup) {
        self.content.push(part);
    }

    /// Adds a plot or a map.
    pub fn figure(&mut self, svg: &Svg) {
        self.content.push(PreEscaped(svg.element().to_owned()));
    }

    /// Adds a table.
    pub fn table(&mut self, table: &Table) {
        let Table { columns, rows } = table;
        let class = |at: usize| columns.get(at).and_then(Column::class);
        self.content.push(html! {
            div class="wide" {
                table {
                    @if columns.iter().any(|column| !column.name.is_empty()) {
                        tr { @for column in columns { th class=[column.class()] { (shown(&column.name)) } } }
                    }
                    @for Row { cells, is_bad, link } in rows {
                        tr class=[is_bad.then_some("bad")] {
                            @for (at, cell) in cells.iter().enumerate() {
                                td class=[class(at)] {
                                    @match link.as_ref().filter(|_| at == 0) {
                                        Some(link) => a href=(shown(link)) { (shown(cell)) },
                                        None => (shown(cell)),
                                    }
                                }
                            }
                        }
                        "\n"
                    }
                }
            }
        });
    }

    /// The text of an HTML file.
    pub fn html(&self) -> String {
        let whole = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) }
                }
                "\n"
                body {
                    h1 { (self.title) }
                    @for part in &self.content { "\n" (part) }
                    "\n"
                }
            }
        };
        whole.into_string() + "\n"
    }
}
