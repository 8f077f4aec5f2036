//! The folder of a run, and the paths of its files.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::names::{PICTURES, PLOTS, fixed_walls_name, frame_in, walls_in};

/// The folder to which a run writes. No other run can write to it as long as this or a clone of it
/// exists.
#[derive(Debug, Clone)]
pub struct ResultsFolder {
    pub(super) path: PathBuf,
    pub(super) _lock: Arc<File>,
}

impl ResultsFolder {
    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A file of which a run writes one, by its name in [`names`](super::names).
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Frame `number`, counted from 0: `frames/frame_000123.vtp`.
    pub fn frame(&self, number: usize) -> PathBuf {
        frame_in(&self.path, number)
    }

    /// The walls of frame `number`: `frames/walls_000123.vtp`.
    pub fn walls(&self, number: usize) -> PathBuf {
        walls_in(&self.path, number)
    }

    /// The large walls that never move: `frames/walls_fixed.vtp`.
    pub fn fixed_walls(&self) -> PathBuf {
        self.path.join(fixed_walls_name())
    }

    /// Picture `number`, counted from 0: `pictures/picture-00123.png`.
    pub fn picture(&self, number: usize) -> PathBuf {
        self.path
            .join(PICTURES)
            .join(format!("picture-{number:05}.png"))
    }

    /// A plot: `plots/NAME.svg`. Characters that a file name may not contain become `_`.
    pub fn plot(&self, name: &str) -> PathBuf {
        let name: String = name
            .chars()
            .map(|letter| match letter {
                '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '_',
                control if control.is_control() => '_',
                other => other,
            })
            .collect();
        self.path.join(PLOTS).join(format!("{name}.svg"))
    }
}
