//! The legend: in the plot if it covers nothing there, otherwise below it.

use maud::{Markup, html};

use crate::colours::{Stroke, shape};
use crate::numbers::px;
use crate::svg::WIDTH;
use crate::text::{shortened, width};

const FONT: f64 = 12.0;
const ROW: f64 = 17.0;
/// Width of the sample next to a name.
const SAMPLE: f64 = 24.0;
/// Gap between a frame and its content, and between the sample and its name.
const ROOM: f64 = 7.0;
/// Names are cut off at this width.
const NAME: f64 = 260.0;
/// For rows below the plot: their left end, px, and their largest number.
const LEFT: f64 = 46.0;
const ROWS_BELOW: u32 = 9;

/// A line of the legend.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) name: String,
    pub(crate) sample: Sample,
}

/// The sample in front of a name.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sample {
    /// None: it is the heading of other names.
    Heading,
    Line(Stroke),
    /// A mark: its kind, colour and fill.
    Mark(usize, &'static str, &'static str),
}

/// The layout of a legend.
#[derive(Debug, Clone)]
pub(crate) struct Legend {
    /// Left, top, width and height of the frame in the plot. None if it is below.
    frame: Option<[f64; 4]>,
    /// Left end and middle of the entries shown.
    places: Vec<[f64; 2]>,
    /// Number of entries not shown, and the position of the note.
    more: Option<(usize, [f64; 2])>,
    /// Height that it adds to the plot, px.
    pub(crate) height: f64,
}

impl Legend {
    /// A legend that covers nothing: within the part of the area (left, top, right, bottom) that
    /// the `drawn` lines leave free, or else below `bottom`. All in px.
    pub(crate) fn new(
        entries: &[Entry],
        drawn: &[Vec<[f64; 2]>],
        area: [f64; 4],
        bottom: f64,
    ) -> Self {
        Self::inside(entries, drawn, area).unwrap_or_else(|| Self::below(entries, bottom))
    }

    fn inside(
        entries: &[Entry],
        drawn: &[Vec<[f64; 2]>],
        [left, top, right, bottom]: [f64; 4],
    ) -> Option<Self> {
        let names = entries.iter().map(name_width).fold(0.0, f64::max);
        let wide = names + SAMPLE + 3.0 * ROOM;
        let high = ROW * entries.len() as f64 + ROOM;
        if wide > 0.6 * (right - left) || high > 0.7 * (bottom - top) {
            return None;
        }
        let (near, far) = (left + 10.0, right - 10.0 - wide);
        let middle = f64::midpoint(near, far);
        let (top, bottom) = (top + 10.0, bottom - 10.0 - high);
        let centre = f64::midpoint(top, bottom);
        let corners = [[far, top], [near, top], [far, bottom], [near, bottom]];
        let sides = [
            [middle, top],
            [middle, bottom],
            [far, centre],
            [near, centre],
        ];
        let is_free = |[x, y]: [f64; 2]| {
            let frame = [x - 5.0, y - 5.0, x + wide + 5.0, y + high + 5.0];
            !drawn.iter().any(|line| crosses(line, frame))
        };
        let mut all = corners.into_iter().chain(sides);
        let [x, y] = all.find(|place| is_free(*place))?;
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

    /// In rows, a new one for each heading. If there are too many names, a note gives the number
    /// left out.
    fn below(entries: &[Entry], top: f64) -> Self {
        let (mut x, mut row) = (LEFT, 0);
        let mut places = Vec::new();
        for entry in entries {
            let is_heading = matches!(entry.sample, Sample::Heading);
            let wide = SAMPLE + name_width(entry) + 3.0 * ROOM;
            if x > LEFT && (is_heading || x + wide > WIDTH) {
                (x, row) = (LEFT, row + 1);
            }
            if row == ROWS_BELOW {
                break;
            }
            places.push([x, top + ROW * (f64::from(row) + 0.5)]);
            x += wide;
        }
        let left_out = entries.len() - places.len();
        let more = (left_out > 0).then(|| places.pop()).flatten();
        Self {
            frame: None,
            places,
            more: more.map(|place| (left_out + 1, place)),
            height: f64::from((row + 1).min(ROWS_BELOW)) * ROW + 8.0,
        }
    }

    pub(crate) fn markup(&self, entries: &[Entry]) -> Markup {
        html! {
            g class="legend" {
                @if let Some([x, y, wide, high]) = self.frame {
                    rect x=(px(x)) y=(px(y)) width=(px(wide)) height=(px(high)) rx="3"
                        fill="#ffffff" stroke="#cccccc" {}
                }
                @for (entry, place) in entries.iter().zip(&self.places) { (entry.markup(*place)) }
                @if let Some((count, [x, y])) = self.more {
                    text x=(px(x)) y=(px(y + 4.0)) { "and " (count) " more" }
                }
            }
        }
    }
}

impl Entry {
    fn markup(&self, [x, y]: [f64; 2]) -> Markup {
        let name = shortened(&self.name, FONT, NAME);
        let (end, below) = (px(x + SAMPLE + ROOM), px(y + 4.0));
        html! {
            @match self.sample {
                Sample::Heading => text x=(px(x)) y=(below) font-weight="bold" { (name) },
                Sample::Line(Stroke { colour, width, dashes }) => {
                    path d={ "M" (px(x)) " " (px(y)) "H" (px(x + SAMPLE)) } fill="none"
                        stroke=(colour) stroke-width=(width) stroke-dasharray=[dashes] {}
                    text x=(end) y=(below) { (name) }
                }
                Sample::Mark(kind, colour, fill) => {
                    g stroke=(colour) { (shape(kind, [x + 0.5 * SAMPLE, y], fill)) }
                    text x=(end) y=(below) { (name) }
                }
            }
        }
    }
}

fn name_width(entry: &Entry) -> f64 {
    let wide = width(&shortened(&entry.name, FONT, NAME), FONT);
    match entry.sample {
        // Bold letters are wider, and it has no sample.
        Sample::Heading => (1.1 * wide - SAMPLE).max(0.0),
        _ => wide,
    }
}

/// True if a line, or its only point, crosses a box: left, top, right, bottom.
fn crosses(line: &[[f64; 2]], frame: [f64; 4]) -> bool {
    match line {
        [point] => segment_crosses([*point; 2], frame),
        points => (points.windows(2)).any(|ends| segment_crosses([ends[0], ends[1]], frame)),
    }
}

/// True if the bounds of the segment and the box overlap, and the box is not entirely on one side
/// of it.
fn segment_crosses([a, b]: [[f64; 2]; 2], [left, top, right, bottom]: [f64; 4]) -> bool {
    let overlap = |k: usize, low, high| a[k].min(b[k]) <= high && a[k].max(b[k]) >= low;
    let corners = [[left, top], [right, top], [left, bottom], [right, bottom]];
    let sides = corners.map(|[x, y]| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]));
    overlap(0, left, right)
        && overlap(1, top, bottom)
        && sides.iter().any(|side| *side >= 0.0)
        && sides.iter().any(|side| *side <= 0.0)
}
