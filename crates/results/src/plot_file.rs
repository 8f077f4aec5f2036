//! Files of plots. They are recognised by their beginning, so that other files are not removed.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;

/// The beginning of a plot of a run or of a study.
const BEGIN: &str = "<!-- dem-run plot -->\n";

/// Writes a plot, replacing an earlier one. `svg`: the text of an SVG file.
pub fn write_plot_file(path: &Path, svg: &str) -> Result<()> {
    write_file(path, |out| out.write_all([BEGIN, svg].concat().as_bytes()))
}

/// True if a file was written by [`write_plot_file`].
pub fn is_plot_file(path: &Path) -> bool {
    let mut begin = [0; BEGIN.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut begin));
    read.is_ok() && begin == BEGIN.as_bytes()
}
