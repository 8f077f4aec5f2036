//! The content of a plot.

/// A plot of lines and marks over one pair of axes, 640 px wide.
///
/// Values that are not finite are gaps, and so are values without a logarithm on a logarithmic
/// axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Lines, the first below the others.
    pub lines: Vec<Line>,
    /// Kinds of marks, drawn above the lines.
    pub marks: Vec<Marks>,
    /// The common property of the kinds of marks, such as the setting in which they differ: a
    /// heading above their names in the legend.
    pub kinds: String,
    /// Meanings of a filled and of a hollow mark. None: no meaning.
    pub filled: Option<[String; 2]>,
    /// Points `[x, y]` of a front, ascending in x and descending in y: nothing lies below and left
    /// of the stairs through them.
    pub front: Vec<[f64; 2]>,
    /// A reference value on the vertical axis, and its name.
    pub reference: Option<(f64, String)>,
    /// Text if there is nothing to draw. Empty: `no data`.
    pub if_empty: String,
}

impl Plot {
    /// Lines over linear axes of these quantities and units: `time (s)`.
    pub fn of(title: impl Into<String>, x: &str, y: &str, lines: Vec<Line>) -> Self {
        Self {
            title: title.into(),
            x: Axis::of(x),
            y: Axis::of(y),
            lines,
            ..Self::default()
        }
    }
}

/// An axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// Quantity and SI unit: `time (s)`. On a linear axis the unit gets a suitable prefix: `time
    /// (ms)`.
    pub label: String,
    /// True if logarithmic.
    pub log: bool,
    /// True for counts: there are no ticks between whole numbers. Not for a logarithmic axis.
    pub whole: bool,
    /// For values without an order: their names. The first lies at 0, the second at 1. Empty for
    /// numbers.
    pub names: Vec<String>,
}

impl Axis {
    /// A linear axis of a quantity and its SI unit: `time (s)`.
    pub fn of(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            ..Self::default()
        }
    }

    /// An axis of values with these names, at 0, 1, ...
    pub fn named(label: &str, names: Vec<String>) -> Self {
        Self {
            names,
            ..Self::of(label)
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
    /// True if dashed.
    pub dashed: bool,
}

impl Line {
    /// A solid line.
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            points,
            dashed: false,
        }
    }

    /// A dashed line, for example for a reference solution.
    pub fn dashed(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self {
            dashed: true,
            ..Self::new(name, points)
        }
    }
}

/// Marks of one kind, with a common colour and shape.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marks {
    /// Its name in the legend; empty: it is not in the legend.
    pub name: String,
    /// The marks.
    pub points: Vec<Point>,
    /// Thin lines through some of the marks: points `[x, y]` of each.
    pub chains: Vec<Vec<[f64; 2]>>,
}

/// A mark.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Point {
    /// x and y in the units of the axes. On a logarithmic axis values that are not positive are
    /// placed at its lower end.
    pub at: [f64; 2],
    /// Width of its error bar, which lies along x, in the unit of x.
    pub x_spread: f64,
    /// Height of its error bar along y, in the unit of y.
    pub y_spread: f64,
    /// True if filled, false if hollow.
    pub filled: bool,
    /// Tooltip.
    pub title: String,
}
