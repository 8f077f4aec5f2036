//! What a run was of: enough to do it again, and to tell it from others.

use std::collections::BTreeMap;
use std::path::Path;

use dem_io::Body;
use dem_io::hash::file_hash;
use dem_scene::{BodySource, Scene, WallShape};
use serde::{Serialize, Serializer};

/// What was run.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Inputs {
    /// Every value of the scene in SI, defaults included, by its key.
    #[serde(serialize_with = "as_map")]
    pub scene: Vec<(String, String)>,
    /// What `--set` laid over it, as typed.
    pub set: Vec<String>,
    /// Of all that is random.
    pub seed: u64,
    /// Bodies by name.
    pub bodies: BTreeMap<String, InputBody>,
    /// STL files of walls by name of the wall.
    pub walls: BTreeMap<String, InputFile>,
}

/// A body that went into a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputBody {
    /// Its file; `-` for standard input. None: it stands in the scene.
    pub file: Option<String>,
    /// Of its numbers, see [`Body::hash`]; 16 hexadecimal digits.
    pub hash: String,
    /// Number of particles.
    pub particles: usize,
    /// Number of bonds.
    pub bonds: usize,
}

/// A file that went into a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputFile {
    /// Its name.
    pub file: String,
    /// Of its bytes: FNV-1a, 64 bit, 16 hexadecimal digits. None: it cannot be read.
    pub hash: Option<String>,
}

impl Inputs {
    /// Of a scene and its bodies as they were read.
    pub fn of(scene: &Scene, read: &BTreeMap<String, Body>) -> Self {
        let body = |(name, body): (&String, &Body)| {
            let source = &scene.bodies.get(name)?.source;
            let input = InputBody {
                file: match source {
                    BodySource::File(path) => Some(path.display().to_string()),
                    BodySource::Inline { .. } => None,
                },
                hash: format!("{:016x}", body.hash()),
                particles: body.positions.len(),
                bonds: body.bonds.len(),
            };
            Some((name.clone(), input))
        };
        let walls = scene.walls.iter().filter_map(|(name, wall)| {
            let WallShape::Stl { path, .. } = &wall.shape else {
                return None;
            };
            Some((name.clone(), InputFile::of(path)))
        });
        Self {
            scene: scene.values(),
            set: Vec::new(),
            seed: scene.run.seed,
            bodies: read.iter().filter_map(body).collect(),
            walls: walls.collect(),
        }
    }
}

impl InputFile {
    fn of(file: &Path) -> Self {
        Self {
            file: file.display().to_string(),
            hash: file_hash(file).map(|hash| format!("{hash:016x}")),
        }
    }
}

fn as_map<S: Serializer>(values: &[(String, String)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(values.iter().map(|(key, value)| (key, value)))
}
