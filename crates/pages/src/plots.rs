//! Files of plots.

use dem_plots::Plot;

use crate::bench::{Failed, root};

/// Writes a plot into a file of the repository.
pub(crate) fn draw(file: &str, plot: &Plot) -> Result<(), Failed> {
    Ok(std::fs::write(root().join(file), plot.svg().file())?)
}
