//! Plots as SVG and pages as HTML: each is a self-contained file for every browser, editor and word
//! processor.
//!
//! A [`Plot`] has lines, marks with error bars or both over a pair of axes; a [`Map`] shows
//! positions to scale; [`Bars`] rank; a [`Page`] contains text, tables, plots and maps. All are
//! plain data, and equal data gives equal bytes. Only `maud` writes tags, so that no text can be
//! taken for one.

mod bars;
mod colours;
mod draw;
mod legend;
mod map;
mod numbers;
mod page;
mod plot;
mod scale;
mod svg;
mod text;
mod thin;

pub use bars::{Bar, BarRow, Bars};
pub use colours::{MOST_LINES, blue_to_red, viridis};
pub use map::{Circle, Dot, Guide, Map};
pub use page::{Column, Page, Row, Table};
pub use plot::{Axis, Line, Marks, Plot, Point};
pub use svg::Svg;
