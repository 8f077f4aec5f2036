//! The legend: in the plot where it covers nothing, or else below it.

use std::fmt::Write;

use super::contents::{Area, HEIGHT, WIDTH};
use super::text::{shortened, width};
use crate::text::for_page;

const FONT: f64 = 12.0;
const ROW: f64 = 17.0;
/// Width of the piece of line beside a name.
const SAMPLE: f64 = 24.0;
/// Between a frame and what is in it, and between the sample and its name.
const ROOM: f64 = 7.0;
/// Names are cut off at this width.
const NAME: f64 = 260.0;
const ROWS_BELOW: usize = 5;

/// A line of the legend.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub(super) name: String,
    /// Attributes of the line that it stands for.
    pub(super) stroke: String,
}

/// Where everything of a legend stands.
#[derive(Debug, Clone)]
pub(super) struct Legend {
    /// Left, top, width and height of the frame in the plot. None: it stands below.
    frame: Option<[f64; 4]>,
    /// Left end and middle of the entries that are shown.
    places: Vec<[f64; 2]>,
    /// How many entries are not, and where that is said.
    more: Option<(usize, [f64; 2])>,
    /// How much lower the plot ends because of it, px.
    pub(super) height: f64,
}

impl Legend {
    /// A legend in the plot that covers none of the lines in `segments` nor the level of the reference, if there is room.
    pub(super) fn inside(
        entries: &[Entry],
        segments: &[Vec<Vec<[f64; 2]>>],
        level: Option<f64>,
        area: Area,
    ) -> Option<Self> {
        let names = entries.iter().map(name_width).fold(0.0, f64::max);
        let wide = names + SAMPLE + 3.0 * ROOM;
        let high = ROW * entries.len() as f64 + ROOM;
        if wide > 0.6 * (area.right - area.left) || high > 0.7 * (area.bottom - area.top) {
            return None;
        }
        let (near, far) = (area.left + 10.0, area.right - 10.0 - wide);
        let middle = f64::midpoint(near, far);
        let (top, bottom) = (area.top + 10.0, area.bottom - 10.0 - high);
        let centre = f64::midpoint(top, bottom);
        let corners = [[far, top], [near, top], [far, bottom], [near, bottom]];
        let sides = [
            [middle, top],
            [middle, bottom],
            [far, centre],
            [near, centre],
        ];
        let is_free = |[x, y]: [f64; 2]| {
            let box_ = [x - 5.0, y - 5.0, x + wide + 5.0, y + high + 5.0];
            let level_is_free = level.is_none_or(|level| level < box_[1] || level > box_[3]);
            level_is_free && !segments.iter().flatten().any(|line| crosses(line, box_))
        };
        let [x, y] = corners
            .into_iter()
            .chain(sides)
            .find(|place| is_free(*place))?;
        let places = (0..entries.len())
            .map(|row| [x + ROOM, y + 0.5 * ROOM + ROW * (row as f64 + 0.5)])
            .collect();
        Some(Self {
            frame: Some([x, y, wide, high]),
            places,
            more: None,
            height: 0.0,
        })
    }

    /// A legend below the plot, in columns. If there are too many lines, it says how many are left out.
    pub(super) fn below(entries: &[Entry]) -> Self {
        let (left, right) = (30.0, WIDTH - 16.0);
        let names = entries.iter().map(name_width).fold(0.0, f64::max);
        let wide = SAMPLE + names + 3.0 * ROOM;
        let columns = ((right - left) / wide).floor().max(1.0) as usize;
        let cells = entries.len().min(columns * ROWS_BELOW);
        let rows = cells.div_ceil(columns) as f64;
        let left = (WIDTH - cells.min(columns) as f64 * wide) / 2.0;
        let top = HEIGHT - 8.0 - rows * ROW;
        let mut places: Vec<[f64; 2]> = (0..cells)
            .map(|cell| {
                let (column, row) = (cell % columns, cell / columns);
                [left + wide * column as f64, top + ROW * (row as f64 + 0.5)]
            })
            .collect();
        let more = if cells < entries.len() {
            let rest = entries.len() - cells + 1;
            places.pop().map(|place| (rest, place))
        } else {
            None
        };
        Self {
            frame: None,
            places,
            more,
            height: rows * ROW + 2.0,
        }
    }

    pub(super) fn write(&self, out: &mut String, entries: &[Entry]) -> std::fmt::Result {
        writeln!(out, "<g id=\"legend\">")?;
        if let Some([x, y, wide, high]) = self.frame {
            writeln!(
                out,
                "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{wide:.2}\" height=\"{high:.2}\" rx=\"3\" fill=\"#ffffff\" stroke=\"#cccccc\"/>"
            )?;
        }
        for (entry, [x, y]) in entries.iter().zip(&self.places) {
            let (end, stroke) = (x + SAMPLE, &entry.stroke);
            writeln!(
                out,
                "<path d=\"M{x:.2} {y:.2}H{end:.2}\" fill=\"none\" {stroke}/>"
            )?;
            let name = for_page(&shortened(&entry.name, FONT, NAME));
            writeln!(
                out,
                "<text x=\"{:.2}\" y=\"{:.2}\">{name}</text>",
                end + ROOM,
                y + 4.0
            )?;
        }
        if let Some((count, [x, y])) = self.more {
            writeln!(
                out,
                "<text x=\"{x:.2}\" y=\"{:.2}\">and {count} more</text>",
                y + 4.0
            )?;
        }
        writeln!(out, "</g>")
    }
}

fn name_width(entry: &Entry) -> f64 {
    width(&shortened(&entry.name, FONT, NAME), FONT)
}

/// Whether a line, or its only point, comes into a box: left, top, right, bottom.
fn crosses(line: &[[f64; 2]], box_: [f64; 4]) -> bool {
    match line {
        [point] => segment_crosses(*point, *point, box_),
        points => points
            .windows(2)
            .any(|ends| segment_crosses(ends[0], ends[1], box_)),
    }
}

/// Clips the segment to the box (Liang and Barsky 1984) and says whether anything is left.
fn segment_crosses(from: [f64; 2], to: [f64; 2], [left, top, right, bottom]: [f64; 4]) -> bool {
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (start, end, low, high) in [(from[0], to[0], left, right), (from[1], to[1], top, bottom)] {
        let way = end - start;
        if way == 0.0 {
            if start < low || start > high {
                return false;
            }
        } else {
            let (a, b) = ((low - start) / way, (high - start) / way);
            enters = enters.max(a.min(b));
            leaves = leaves.min(a.max(b));
        }
    }
    enters <= leaves
}
