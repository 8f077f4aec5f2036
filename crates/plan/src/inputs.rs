//! Inputs of a run: enough to repeat it, and to distinguish it from others.

use std::collections::BTreeMap;
use std::path::Path;

use dem_io::Body;
use dem_io::hash::file_hash;
use dem_results::summary::{InputBody, InputFile, Inputs};
use dem_scene::{BodySource, Region, Scene, Wall, WallShape};

/// Inputs of a run of a scene with these bodies, as they were read.
pub(crate) fn inputs(scene: &Scene, read: &BTreeMap<String, Body>) -> Inputs {
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
        Some((name.clone(), input_file(path)))
    });
    let regions = scene.regions.iter().filter_map(|(name, region)| {
        let Region::Stl { file, .. } = region else {
            return None;
        };
        Some((name.clone(), input_file(file)))
    });
    let is_solid = |wall: &Wall| !matches!(wall.shape, WallShape::Stl { .. });
    let solid_walls = scene.walls.iter().filter(|(_, wall)| is_solid(wall));
    let measured = scene.test.as_ref().and_then(|test| test.measured.as_ref());
    Inputs {
        scene: scene.values(),
        set: Vec::new(),
        seed: scene.run.seed,
        bodies: read.iter().filter_map(body).collect(),
        walls: walls.collect(),
        regions: regions.collect(),
        included: scene.included.iter().map(|path| input_file(path)).collect(),
        measured: measured.map(|measured| input_file(&measured.file)),
        view_from: scene.output.as_ref().and_then(|output| output.view_from),
        solid_walls: solid_walls.map(|(name, _)| name.clone()).collect(),
        program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
    }
}

fn input_file(file: &Path) -> InputFile {
    InputFile {
        file: file.display().to_string(),
        hash: file_hash(file).map(|hash| format!("{hash:016x}")),
    }
}
