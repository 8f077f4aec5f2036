//! The files of a run that its page shows.

use std::fs;
use std::path::{Path, PathBuf};

use dem_io::{Diagnostic, Result, explain_read};
use dem_results::Summary;

use crate::view::Subject;

/// The folder of a run.
pub(crate) struct Folder {
    path: PathBuf,
    frames: Vec<(PathBuf, f64)>,
}

impl Folder {
    /// Reads the list of its frames.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let index = path.join("frames.pvd");
        let text = match fs::read_to_string(&index) {
            Ok(text) => text,
            // A run without frames has no list.
            Err(_) if path.is_file() => {
                let problem = "this is a file, not a folder of results";
                return Err(Diagnostic::input(
                    path.display().to_string(),
                    problem,
                    "name the folder",
                ));
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(explain_read(&index, &error, "a file")),
        };
        let frame = |line: &str| {
            let time_s = attribute(line, "timestep")?.parse().ok()?;
            let file = attribute(line, "file")?;
            file.contains("frame_").then(|| (path.join(file), time_s))
        };
        Ok(Self {
            path: path.to_owned(),
            frames: text.lines().filter_map(frame).collect(),
        })
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Its frames and their times, s.
    pub(crate) fn frames(&self) -> &[(PathBuf, f64)] {
        &self.frames
    }

    /// What the view shows.
    pub(crate) fn subject(&self, summary: &Summary) -> Subject<'_> {
        const FROM: [f64; 3] = [0.5, -0.8, 0.4];
        Subject {
            folder: &self.path,
            frames: &self.frames,
            from: summary.inputs.view_from.unwrap_or(FROM),
        }
    }

    /// A file of text. None: it does not exist.
    pub(crate) fn text(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.path.join(name)).ok()
    }

    /// The plots, by name: those named in `first` before the others.
    pub(crate) fn plots(&self, first: &[&str]) -> Result<Vec<String>> {
        let entries = fs::read_dir(self.path.join("plots")).into_iter().flatten();
        let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
        let mut paths: Vec<PathBuf> = paths
            .filter(|path| path.extension().is_some_and(|ending| ending == "svg"))
            .collect();
        let place = |path: &PathBuf| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            first
                .iter()
                .position(|name| *name == stem)
                .unwrap_or(first.len())
        };
        paths.sort_by_key(|path| (place(path), path.clone()));
        let read = |path: &PathBuf| {
            fs::read_to_string(path).map_err(|error| explain_read(path, &error, "a plot"))
        };
        paths.iter().map(read).collect()
    }
}

fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let start = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[start..].split('"').next()
}
