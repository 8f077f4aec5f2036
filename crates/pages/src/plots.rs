//! Plots of lines, and their files.

use dem_plots::{Axis, Line, Plot};

use crate::bench::{Failed, root};

/// A line through points in the units of the axes.
pub(crate) fn line(name: &str, points: Vec<[f64; 2]>) -> Line {
    Line {
        name: name.to_owned(),
        points,
        dashed: false,
    }
}

/// As [`line`], but dashed, for a law.
pub(crate) fn dashed(name: &str, points: Vec<[f64; 2]>) -> Line {
    Line {
        dashed: true,
        ..line(name, points)
    }
}

/// A plot with linear axes: quantities and units.
pub(crate) fn plot(title: &str, x: &str, y: &str, lines: Vec<Line>) -> Plot {
    Plot {
        title: title.to_owned(),
        x: Axis::of(x),
        y: Axis::of(y),
        lines,
        ..Plot::default()
    }
}

/// Writes a plot into a file of the repository.
pub(crate) fn draw(file: &str, plot: &Plot) -> Result<(), Failed> {
    Ok(std::fs::write(root().join(file), plot.svg().file())?)
}
