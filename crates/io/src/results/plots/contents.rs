//! What a plot shows, and where in the picture.

/// Width of a plot, px.
pub const WIDTH: f64 = 640.0;

/// Height of a plot, px.
pub const HEIGHT: f64 = 400.0;

/// A plot of lines over one pair of axes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// What it shows.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, the first below the others.
    pub lines: Vec<Line>,
    /// A value on the vertical axis to compare with, and its name.
    pub reference: Option<(f64, String)>,
}

/// An axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// Quantity and SI unit: `time (s)`. The unit gets a prefix that suits the values: `time (ms)`.
    pub label: String,
    /// Logarithmic, in decades. Values that are not positive are left out.
    pub log: bool,
    /// Of counts: there are no numbers between whole ones. Not for an axis with logarithms.
    pub whole: bool,
}

impl Axis {
    /// A linear axis of a quantity and its SI unit: `time (s)`.
    pub fn of(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            ..Self::default()
        }
    }
}

/// A line through points in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Line {
    /// Its name in the legend.
    pub name: String,
    /// Points `[x, y]` in the units of the axes.
    pub points: Vec<[f64; 2]>,
    /// Broken, such as for a reference solution.
    pub dashed: bool,
}

/// The part of the picture where lines are drawn, px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    /// Where a point stands, given its shares of the width and the height.
    pub(super) fn place(&self, share: [f64; 2]) -> [f64; 2] {
        [
            self.left + share[0] * (self.right - self.left),
            self.bottom - share[1] * (self.bottom - self.top),
        ]
    }
}
