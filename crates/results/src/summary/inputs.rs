//! Inputs of a run: enough to repeat it, and to distinguish it from others.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::by_name;

/// Inputs of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Inputs {
    /// Every value of the scene in SI, defaults included, by its key.
    #[serde(with = "by_name")]
    pub scene: Vec<(String, String)>,
    /// Overrides by `--set`, as typed.
    pub set: Vec<String>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Bodies by name.
    pub bodies: BTreeMap<String, InputBody>,
    /// Files of triangles of walls by name of the wall.
    pub walls: BTreeMap<String, InputFile>,
    /// Files of triangles of regions by name of the region.
    pub regions: BTreeMap<String, InputFile>,
    /// Files of materials that the scene includes, in order.
    pub included: Vec<InputFile>,
    /// The measured material of a laboratory test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<InputFile>,
    /// Direction from the bodies to the camera that the scene gives, of length 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view_from: Option<[f64; 3]>,
    /// Walls that are solid and seen from outside only: surfaces from files of triangles have two sides.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub solid_walls: Vec<String>,
    /// Program and version.
    pub program: String,
}

/// A body used in a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct InputBody {
    /// Its file; `-` for standard input. None: it is defined in the scene.
    pub file: Option<String>,
    /// Hash of its numbers, see [`Body::hash`](dem_io::Body::hash); 16 hexadecimal digits.
    pub hash: String,
    /// Number of particles.
    pub particles: usize,
    /// Number of bonds.
    pub bonds: usize,
}

/// A file used in a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct InputFile {
    /// Its name.
    pub file: String,
    /// Hash of its bytes: FNV-1a, 64 bit, 16 hexadecimal digits. None: it cannot be read.
    pub hash: Option<String>,
}
