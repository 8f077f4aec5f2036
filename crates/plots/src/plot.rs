//! What a plot shows.

/// A plot of lines and marks over one pair of axes, 640 px wide.
///
/// Values that are not finite are gaps, and so are those of no logarithm on an axis that has one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// What it shows.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Lines, the first below the others.
    pub lines: Vec<Line>,
    /// Kinds of marks, drawn above the lines.
    pub marks: Vec<Marks>,
    /// What the kinds of marks have in common, such as the setting in which they differ: above
    /// their names in the legend.
    pub kinds: String,
    /// What a filled mark says and what a hollow one. None: it says nothing.
    pub filled: Option<[String; 2]>,
    /// Points `[x, y]` of a front, rising in x and falling in y: nothing lies below and left of the
    /// stairs through them.
    pub front: Vec<[f64; 2]>,
    /// A value on the vertical axis to compare with, and its name.
    pub reference: Option<(f64, String)>,
    /// What is said where there is nothing to draw. Empty: `no data`.
    pub if_empty: String,
}

/// An axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// Quantity and SI unit: `time (s)`. On a linear axis the unit gets a prefix that suits the
    /// values: `time (ms)`.
    pub label: String,
    /// Logarithmic.
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

    /// A logarithmic axis of a quantity and its SI unit.
    pub fn log(label: &str) -> Self {
        Self {
            log: true,
            ..Self::of(label)
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

/// Marks of one kind, which have one colour and one shape.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marks {
    /// Its name in the legend; empty: it is not in the legend.
    pub name: String,
    /// The marks.
    pub points: Vec<Point>,
    /// Thin lines through some of them: points `[x, y]` of each.
    pub chains: Vec<Vec<[f64; 2]>>,
}

/// A mark.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Point {
    /// x and y in the units of the axes. On an axis with logarithms what is not positive stands at
    /// its lower end.
    pub at: [f64; 2],
    /// Width of its error bar, which lies along x, in the unit of x.
    pub x_spread: f64,
    /// Filled, or hollow.
    pub filled: bool,
    /// What is told to who points at it.
    pub title: String,
}
