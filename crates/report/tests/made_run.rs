//! A folder of results with frames that are known.

use std::path::Path;

use dem_physics::contact::patch_book::PatchBook;
use dem_physics::geometry::patches::Patch;
use dem_results::{
    Existing, Frame, FrameFiles, NamedArray, ResultsFolder, Values, WallFiles, WallFrame,
    WallPatch, WallTriangles,
};
use serde_json::{Value, json};
use tempfile::TempDir;

/// A frame: particles fly apart along x, a bond joins each to the next.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    pub(crate) time_s: f64,
    pub(crate) particles: usize,
}

impl Moment {
    pub(crate) fn place_m(self, i: usize) -> [f64; 3] {
        let i = i as f64;
        [0.01 * i * (1.0 + self.time_s), 0.002 * i.sin(), 0.5]
    }

    pub(crate) fn radius_m(i: usize) -> f64 {
        1e-3 * (1.0 + (i % 3) as f64)
    }

    pub(crate) fn is_broken(self, bond: usize) -> bool {
        bond % 4 == 3 && self.time_s > 0.5
    }

    /// Two patches of the floor, of 0.5 m2 each. After the start the first is hit with 1 J and
    /// worn by 1 um in each second; nothing touches the second.
    fn loads(self) -> Vec<WallPatch> {
        let patch = |first: f64, book, wear_m3| WallPatch {
            wall: 0,
            patch: Patch {
                centre_m: [first + 0.5, 0.25, self.time_s / 8.0],
                normal: [0.0, 0.0, 1.0],
                area_m2: 0.5,
                corners_m: [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]]
                    .map(|[x, y]| [first + x, y, self.time_s / 8.0])
                    .to_vec(),
            },
            book,
            wear_m3,
        };
        let hit = PatchBook {
            impact_j: self.time_s,
            ..PatchBook::default()
        };
        vec![
            patch(0.0, hit, 0.5e-6 * self.time_s),
            patch(1.0, PatchBook::default(), 0.0),
        ]
    }
}

/// Writes the frames into a new folder.
pub(crate) fn folder_with(moments: &[Moment]) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    let folder = ResultsFolder::create(&place.path().join("out"), Existing::Refuse).unwrap();
    let mut files = FrameFiles::create(
        &folder,
        WallFiles {
            each_frame: true,
            fixed: false,
            loads: true,
        },
    );
    for moment in moments {
        append(&mut files, *moment);
    }
    place
}

fn append(files: &mut FrameFiles, moment: Moment) {
    let bonds = moment.particles.saturating_sub(1);
    let array = |name, values| NamedArray { name, values };
    let radius = Moment::radius_m;
    let speed = |i: usize| [0.3 * i as f64, 0.4 * i as f64, 0.0];
    let fragment = |i: usize| i as u32 / 4;
    let body = |i: usize| (i % 2) as u32;
    let mass = |i: usize| 0.5 + i as f64;
    let bond_radius = |_: usize| 5e-4;
    let utilisation = |bond: usize| bond as f64 / bonds as f64;
    let stress = |bond: usize| if bond.is_multiple_of(2) { 2e5 } else { -1e5 };
    let broken = |bond: usize| u32::from(moment.is_broken(bond));
    let names = ["cake", "rock"];
    let mut floor = WallTriangles::default();
    let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| [x, y, moment.time_s / 8.0]);
    floor.add(0, corners.into_iter(), &[[0, 1, 2]]);
    let walls = WallFrame {
        names: vec!["floor".to_owned()],
        forces_n: vec![[0.0; 3]],
        triangles: floor,
        velocities_m_s: vec![[0.0; 3]],
        loads: moment.loads(),
    };
    let frame = Frame {
        time_s: moment.time_s,
        body_names: &names,
        particles: moment.particles,
        position_m: &|i| moment.place_m(i),
        particle_arrays: &[
            array("radius_m", Values::Scalars(&radius)),
            array("body", Values::Counts(&body)),
            array("velocity_m_s", Values::Vectors(&speed)),
            array("fragment_id", Values::Counts(&fragment)),
            array("fragment_mass_kg", Values::Scalars(&mass)),
        ],
        bonds,
        ends: &|bond| [bond as u32, bond as u32 + 1],
        bond_arrays: &[
            array("bond_radius_m", Values::Scalars(&bond_radius)),
            array("utilisation", Values::Scalars(&utilisation)),
            array("normal_stress_pa", Values::Scalars(&stress)),
            array("broken", Values::Counts(&broken)),
        ],
    };
    files
        .append(&frame, &walls, &WallTriangles::default())
        .unwrap();
}

/// A short summary, as `dem-run` writes it.
pub(crate) fn summary() -> Value {
    json!({
        "scene": "/home/somebody/mill/drop.toml",
        "program": "dem-run 0.1.0",
        "ended_by": "end time",
        "simulated_s": 0.02,
        "wall_s": 1.5,
        "threads": 2,
        "machine": "a machine, 2 cores",
        "verdict": {"word": "sound", "sound": true, "warnings": []},
        "inputs": {
            "seed": 7,
            "set": ["run.end_time=0.02"],
            "scene": {"run.gravity": "[0, 0, -9.81] m/s2"},
            "bodies": {"cake": {
                "file": "/home/somebody/mill/cake.vtp", "hash": "ba35", "particles": 9, "bonds": 8,
            }},
        },
        "bodies": {"cake": {"mass_kg": 0.25}},
        "broken_bonds": 3,
        "broken_by_cause": {"tension": 3, "shear": 0},
        "measures": {"height": {"value": 0.25, "unit": "m", "reference": 0.2, "error": 0.25}},
        "time_by_stage": {"bond forces": 0.75, "motion": 0.24, "loads": 0.0},
        "inactive_stages": ["loads"],
        "steps": 1000, "time_step_s": 2e-5, "fraction_of_limit": 0.9, "steps_per_s": 666.0,
    })
}

/// The page of a folder of [`folder_with`].
pub(crate) fn page_of(folder: &TempDir, summary: &Value) -> String {
    dem_report::report(&out(folder), &summary.to_string()).unwrap()
}

pub(crate) fn out(folder: &TempDir) -> std::path::PathBuf {
    Path::join(folder.path(), "out")
}
