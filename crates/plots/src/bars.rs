//! Horizontal bars with names, such as the effects of parameters in the order of their rank.

use maud::{Markup, html};

use crate::colours::{GREY, INK, colour};
use crate::numbers::px;
use crate::plot::Axis;
use crate::scale::{Scale, is_drawn};
use crate::svg::{Svg, WIDTH};
use crate::text::{shortened, shown, width};

/// Height of a row and of the bars in it, px.
const ROW: f64 = 28.0;
const THICK: f64 = 18.0;
/// Margins around the bars, px.
const ABOVE: f64 = 40.0;
const BELOW: f64 = 52.0;
const RIGHT: f64 = 24.0;
/// Room between names and bars, and the largest width of a name, px.
const ROOM: f64 = 8.0;
const NAME: f64 = 250.0;
/// Height of the legend, px.
const LEGEND: f64 = 24.0;

/// Rows of bars from a common zero line, 640 px wide.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bars {
    /// Title.
    pub title: String,
    /// Quantity of the bars and its SI unit, as of an [`Axis`].
    pub label: String,
    /// What the bars of a row are, from the upper one: names in the legend. One: no legend.
    pub kinds: Vec<String>,
    /// Meaning of a hollow bar, in the legend if there is one.
    pub hollow: String,
    /// From the top.
    pub rows: Vec<BarRow>,
}

/// A row of bars.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BarRow {
    /// Its name, on the left.
    pub name: String,
    /// A bar of each kind; None: its length is not known.
    pub bars: Vec<Option<Bar>>,
}

/// A bar.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bar {
    /// Its end, in the unit of the label; it begins at 0.
    pub end: f64,
    /// The interval in which its end lies, drawn as a line. None: it is not known.
    pub interval: Option<[f64; 2]>,
    /// True if it is drawn hollow.
    pub is_hollow: bool,
    /// Tooltip.
    pub title: String,
}

impl Bars {
    /// The bars as SVG.
    pub fn svg(&self) -> Svg {
        let all = || self.rows.iter().flat_map(|row| row.bars.iter().flatten());
        let ends = all().flat_map(|bar| {
            let interval = bar.interval.into_iter().flatten();
            [bar.end].into_iter().chain(interval)
        });
        let scale = Scale::new(&Axis::of(&self.label), ends.chain([0.0]), true);
        let names = self.rows.iter().map(|row| width(&row.name, 12.0));
        let left = (names.fold(0.0, f64::max).min(NAME) + 2.0 * ROOM).ceil();
        let bottom = ABOVE + ROW * self.rows.len().max(1) as f64;
        let across = |value: f64| left + scale.fraction(value) * (WIDTH - RIGHT - left);
        let has_hollow = all().any(|bar| bar.is_hollow) && !self.hollow.is_empty();
        let has_legend = has_hollow || self.kinds.len() > 1;
        let content = html! {
            (grid(&scale, [left, bottom]))
            @for (at, row) in self.rows.iter().enumerate() {
                @let middle = ABOVE + ROW * (at as f64 + 0.5);
                text x=(px(left - ROOM)) y=(px(middle + 4.0)) text-anchor="end" {
                    (shortened(&row.name, 12.0, NAME))
                }
                @let thick = THICK / row.bars.len().max(1) as f64;
                @for (kind, bar) in row.bars.iter().enumerate() {
                    @if let Some(bar) = bar.as_ref().filter(|bar| is_drawn(bar.end, false)) {
                        (drawn(bar, kind, &across, [middle - 0.5 * THICK + thick * kind as f64, thick]))
                    }
                }
            }
            path class="zero" d={ "M" (px(across(0.0))) " " (px(ABOVE)) "V" (px(bottom)) }
                stroke=(INK) fill="none" {}
            @if self.rows.is_empty() {
                text x=(px(f64::midpoint(left, WIDTH - RIGHT))) y=(px(ABOVE + 0.5 * ROW + 4.0))
                    text-anchor="middle" fill=(GREY) { "no data" }
            }
            @if has_legend { (self.legend(left, bottom + BELOW, has_hollow)) }
        };
        let below = if has_legend { BELOW + LEGEND } else { BELOW };
        Svg::new(bottom + below, &self.title, &content)
    }

    /// Kinds and the meaning of hollow bars, in one line that begins at `left`.
    fn legend(&self, left: f64, y: f64, has_hollow: bool) -> Markup {
        let kinds = self
            .kinds
            .iter()
            .enumerate()
            .filter(|_| self.kinds.len() > 1);
        let mut entries: Vec<(&str, &str, &str)> = kinds
            .map(|(kind, name)| (name.as_str(), colour(kind), colour(kind)))
            .collect();
        if has_hollow {
            entries.push((&self.hollow, INK, "#ffffff"));
        }
        let mut x = left;
        let placed = entries.into_iter().map(|(name, line, fill)| {
            let at = x;
            x += 20.0 + width(name, 12.0) + 2.0 * ROOM;
            (at, name, line, fill)
        });
        html! {
            g class="legend" {
                @for (x, name, line, fill) in placed {
                    rect x=(px(x)) y=(px(y - 5.0)) width="14" height="10" stroke=(line) fill=(fill) {}
                    text x=(px(x + 20.0)) y=(px(y + 4.0)) { (shown(name)) }
                }
            }
        }
    }
}

/// Vertical lines with their numbers, and the label below them.
fn grid(scale: &Scale, [left, bottom]: [f64; 2]) -> Markup {
    let across = |fraction: f64| left + fraction * (WIDTH - RIGHT - left);
    let line = |fraction: f64| format!("M{} {ABOVE:.2}V{bottom:.2}", px(across(fraction)));
    let path: String = scale.ticks.iter().map(|tick| line(tick.fraction)).collect();
    html! {
        path d=(path) stroke="#e4e4e4" fill="none" {}
        g class="x" text-anchor="middle" {
            @for tick in &scale.ticks {
                text x=(px(across(tick.fraction))) y=(px(bottom + 17.0)) { (tick.label) }
            }
        }
        text class="axes" x=(px(f64::midpoint(left, WIDTH - RIGHT))) y=(px(bottom + 38.0))
            text-anchor="middle" font-size="13" {
            (shortened(&scale.label, 13.0, WIDTH - RIGHT - left))
        }
    }
}

/// A bar with its upper edge and height `[y, thick]`, px.
fn drawn(bar: &Bar, kind: usize, across: &dyn Fn(f64) -> f64, [y, thick]: [f64; 2]) -> Markup {
    let ends = [across(0.0), across(bar.end)];
    let [from, to] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    let fill = if bar.is_hollow {
        "#ffffff"
    } else {
        colour(kind)
    };
    let middle = y + 0.5 * thick;
    let interval = bar
        .interval
        .filter(|ends| ends.iter().all(|end| is_drawn(*end, false)));
    html! {
        g class="bar" stroke=(colour(kind)) {
            title { (shown(&bar.title)) }
            rect x=(px(from)) y=(px(y)) width=(px(to - from)) height=(px(thick)) fill=(fill) {}
            @if let Some([low, high]) = interval.map(|ends| ends.map(across)) {
                path d={ "M" (px(low)) " " (px(middle)) "H" (px(high))
                    "M" (px(low)) " " (px(middle - 3.0)) "v6"
                    "M" (px(high)) " " (px(middle - 3.0)) "v6" } stroke=(INK) fill="none" {}
            }
        }
    }
}
