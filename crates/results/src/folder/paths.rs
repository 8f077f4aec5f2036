//! The folder of a run, and the paths of its files.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::names::{
    BAR_SIGNALS, CHECKPOINT, DISC_STRESS, DISCHARGE, DISTRIBUTION, ENDED, EVENTS, FILM, FILM_STRIP,
    FLOW, FRAGMENT_TREE, FRAGMENTS, GAUGE_SIGNALS, INDEX, MIXING, PICTURES, PLOTS, REPORT, SCENE,
    SERIES, SUMMARY, TEST_CURVE, fixed_walls_name, frame_in, walls_in,
};

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

    /// The list of all frames with their times, which ParaView opens: `frames.pvd`.
    pub fn frames_index(&self) -> PathBuf {
        self.path.join(INDEX)
    }

    /// Picture `number`, counted from 0: `pictures/picture-00123.png`.
    pub fn picture(&self, number: usize) -> PathBuf {
        self.path
            .join(PICTURES)
            .join(format!("picture-{number:05}.png"))
    }

    /// Some pictures side by side: `film-strip.png`.
    pub fn film_strip(&self) -> PathBuf {
        self.path.join(FILM_STRIP)
    }

    /// The pictures one after the other: `film.png`.
    pub fn film(&self) -> PathBuf {
        self.path.join(FILM)
    }

    /// Time series: `series.csv`.
    pub fn series(&self) -> PathBuf {
        self.path.join(SERIES)
    }

    /// Events: `events.csv`.
    pub fn events(&self) -> PathBuf {
        self.path.join(EVENTS)
    }

    /// Fragments at chosen moments: `fragments.csv`.
    pub fn fragments(&self) -> PathBuf {
        self.path.join(FRAGMENTS)
    }

    /// The origin of each fragment: `fragment-tree.csv`.
    pub fn fragment_tree(&self) -> PathBuf {
        self.path.join(FRAGMENT_TREE)
    }

    /// What leaves through outlets: `discharge.csv`.
    pub fn discharge(&self) -> PathBuf {
        self.path.join(DISCHARGE)
    }

    /// The size distribution of all fragments: `distribution.csv`.
    pub fn distribution(&self) -> PathBuf {
        self.path.join(DISTRIBUTION)
    }

    /// Mass flows over time: `flow.csv`.
    pub fn flow(&self) -> PathBuf {
        self.path.join(FLOW)
    }

    /// The cells of mixtures: `mixing.csv`.
    pub fn mixing(&self) -> PathBuf {
        self.path.join(MIXING)
    }

    /// Summary: `summary.json`.
    pub fn summary(&self) -> PathBuf {
        self.path.join(SUMMARY)
    }

    /// The scene as it was run: `scene.toml`.
    pub fn scene(&self) -> PathBuf {
        self.path.join(SCENE)
    }

    /// The data written at the end of a run, kept until all files are complete: `.ended.json`.
    pub fn ended(&self) -> PathBuf {
        self.path.join(ENDED)
    }

    /// The latest state of the run: `checkpoint.dem`.
    pub fn checkpoint(&self) -> PathBuf {
        self.path.join(CHECKPOINT)
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

    /// The page of the run: `report.html`.
    pub fn report(&self) -> PathBuf {
        self.path.join(REPORT)
    }

    /// The curve of a laboratory test: `force-displacement.csv`.
    pub fn test_curve(&self) -> PathBuf {
        self.path.join(TEST_CURVE)
    }

    /// The pulses of a split-Hopkinson test: `bar-signals.csv`.
    pub fn bar_signals(&self) -> PathBuf {
        self.path.join(BAR_SIGNALS)
    }

    /// What the strain gauges of a split-Hopkinson test record: `gauge-signals.csv`.
    pub fn gauge_signals(&self) -> PathBuf {
        self.path.join(GAUGE_SIGNALS)
    }

    /// The stress over the loaded diameter of a disc: `disc-stress.csv`.
    pub fn disc_stress(&self) -> PathBuf {
        self.path.join(DISC_STRESS)
    }
}
