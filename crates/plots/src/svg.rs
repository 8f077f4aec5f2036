//! The frame of every plot: size, font, title and white background.

use maud::{Markup, html};

use crate::colours::INK;
use crate::text::{shortened, shown};

/// Width of every plot, px.
pub(crate) const WIDTH: f64 = 640.0;

const SPACE: &str = " xmlns=\"http://www.w3.org/2000/svg\"";
const FONTS: &str = "Helvetica, Arial, 'DejaVu Sans', sans-serif";

/// Elements without content, which XML closes in short form.
const EMPTY: [&str; 5] = ["circle", "path", "polygon", "polyline", "rect"];

/// A plot as the text of a file or as an element of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Svg(String);

impl Svg {
    /// `height`, px. `title`: in bold above the plot, and as its tooltip.
    pub(crate) fn new(height: f64, title: &str, content: &Markup) -> Self {
        let size = format!("0 0 {WIDTH} {height:.0}");
        let whole = html! {
            svg width=(WIDTH) height={ (format!("{height:.0}")) } viewBox=(size)
                font-family=(FONTS) font-size="12" fill=(INK) {
                title { (shown(title)) }
                rect width=(WIDTH) height={ (format!("{height:.0}")) } fill="#ffffff" {}
                @if !title.is_empty() {
                    // Bold letters are wider.
                    text x=(WIDTH / 2.0) y="25" text-anchor="middle" font-size="15"
                        font-weight="bold" { (shortened(title, 17.0, WIDTH - 40.0)) }
                }
                (content)
            }
        };
        let short = EMPTY.iter().fold(whole.into_string(), |text, name| {
            text.replace(&format!("></{name}>"), "/>")
        });
        // One element per line. Within texts `>` is escaped.
        Self(short.replace("><", ">\n<") + "\n")
    }

    /// The text of an SVG file.
    pub fn file(&self) -> String {
        self.0.replacen("<svg", &format!("<svg{SPACE}"), 1)
    }

    /// The element within a page.
    pub(crate) fn element(&self) -> &str {
        &self.0
    }
}
