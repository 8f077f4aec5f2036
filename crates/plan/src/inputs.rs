//! Inputs of a run: enough to repeat it, and to distinguish it from others.

use std::collections::BTreeMap;
use std::path::Path;

use dem_io::Body;
use dem_io::hash::file_hash;
use dem_scene::{BodySource, Region, Scene, WallShape};
use serde::{Serialize, Serializer};

/// Inputs of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Inputs {
    /// Every value of the scene in SI, defaults included, by its key.
    #[serde(serialize_with = "as_map")]
    pub scene: Vec<(String, String)>,
    /// Overrides by `--set`, as typed.
    pub set: Vec<String>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Bodies by name.
    pub bodies: BTreeMap<String, InputBody>,
    /// STL files of walls by name of the wall.
    pub walls: BTreeMap<String, InputFile>,
    /// STL files of regions by name of the region.
    pub regions: BTreeMap<String, InputFile>,
    /// Files of materials that the scene includes, in order.
    pub included: Vec<InputFile>,
    /// The measured material of a laboratory test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<InputFile>,
    /// Program and version.
    pub program: String,
}

/// A body used in a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputBody {
    /// Its file; `-` for standard input. None: it is defined in the scene.
    pub file: Option<String>,
    /// Hash of its numbers, see [`Body::hash`]; 16 hexadecimal digits.
    pub hash: String,
    /// Number of particles.
    pub particles: usize,
    /// Number of bonds.
    pub bonds: usize,
}

/// A file used in a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputFile {
    /// Its name.
    pub file: String,
    /// Hash of its bytes: FNV-1a, 64 bit, 16 hexadecimal digits. None: it cannot be read.
    pub hash: Option<String>,
}

impl Inputs {
    /// From a scene and its bodies as they were read.
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
        let regions = scene.regions.iter().filter_map(|(name, region)| {
            let Region::Stl { file, .. } = region else {
                return None;
            };
            Some((name.clone(), InputFile::of(file)))
        });
        let measured = scene.test.as_ref().and_then(|test| test.measured.as_ref());
        Self {
            scene: scene.values(),
            set: Vec::new(),
            seed: scene.run.seed,
            bodies: read.iter().filter_map(body).collect(),
            walls: walls.collect(),
            regions: regions.collect(),
            included: scene
                .included
                .iter()
                .map(|path| InputFile::of(path))
                .collect(),
            measured: measured.map(|measured| InputFile::of(&measured.file)),
            program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
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
