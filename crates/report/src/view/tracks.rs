//! The frames as tracks of whole numbers on scales that all frames share.

use std::collections::BTreeMap;

use dem_io::body::stored_walls::StoredWalls;
use dem_io::units::show_quantity;
use serde_json::{Value, json};

use super::encode::{Track, level};
use super::spheres::{Bond, Spheres};
use crate::home::Home;
use crate::load_cells::{LoadCells, WallQuantity};

/// Steps along the longest edge of the scene: floating point numbers of 32 bits hold them exactly.
const STEPS: f64 = 16_777_215.0;
/// Steps of a radius.
const RADIUS_STEPS: i32 = 65_535;
/// Fraction of the spheres that the first view leaves out on each side, so that a few that fly away
/// do not shrink the rest.
const ASIDE: f64 = 0.01;

/// Extents and largest values of all frames.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ranges {
    all_m: Option<[[f64; 3]; 2]>,
    middle_m: Option<[[f64; 3]; 2]>,
    radius_m: f64,
    speed_m_s: f64,
    mass_kg: f64,
    utilisation: f64,
    stress_pa: f64,
    loads: [f64; 4],
}

/// What the whole numbers of the tracks mean.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scales {
    pub(crate) low_m: [f64; 3],
    pub(crate) high_m: [f64; 3],
    pub(crate) resolution_m: f64,
    pub(crate) radius_unit_m: f64,
    pub(crate) focus_m: [f64; 3],
    pub(crate) reach_m: f64,
    speed_m_s: f64,
    mass_kg: f64,
    utilisation: f64,
    stress_pa: f64,
    /// Of each [`WallQuantity`], in its unit.
    loads: [f64; 4],
}

impl Ranges {
    /// Extends the ranges to the spheres of a frame. The first view shows those at `home`.
    pub(crate) fn include(&mut self, spheres: &Spheres, home: &Home) {
        for (centre, radius_m) in spheres.centres_m.iter().zip(&spheres.radii_m) {
            self.all_m = joined(self.all_m, [0, 1].map(|_| *centre));
            self.radius_m = self.radius_m.max(*radius_m);
        }
        let at_home = spheres.centres_m.iter().filter(|at| home.contains(at));
        let at_home: Vec<[f64; 3]> = at_home.copied().collect();
        if !at_home.is_empty() {
            self.middle_m = joined(self.middle_m, middle(&at_home));
        }
        self.speed_m_s = self.speed_m_s.max(most_of(&spheres.speeds_m_s));
        self.mass_kg = spheres
            .masses_kg
            .iter()
            .copied()
            .fold(self.mass_kg, f64::max);
        let intact = || spheres.bonds.iter().filter(|bond| !bond.is_broken);
        let utilisations: Vec<f64> = intact().map(|bond| bond.utilisation).collect();
        self.utilisation = self.utilisation.max(most_of(&utilisations).min(1.0));
        let stresses: Vec<f64> = intact().map(|bond| bond.stress_pa.abs()).collect();
        self.stress_pa = self.stress_pa.max(most_of(&stresses));
    }

    /// Extends the ranges to the corners of walls.
    pub(crate) fn include_walls(&mut self, corners_m: &[[f64; 3]]) {
        for corner in corners_m {
            self.all_m = joined(self.all_m, [*corner; 2]);
        }
    }

    /// Extends the ranges to the loads of walls.
    pub(crate) fn include_loads(&mut self, loads: &LoadCells) {
        for values in &loads.values {
            for (highest, value) in self.loads.iter_mut().zip(values) {
                *highest = highest.max(*value);
            }
        }
    }

    /// The scales of these ranges. None: there is nothing.
    pub(crate) fn scales(&self) -> Option<Scales> {
        let [low_m, high_m] = self.all_m?;
        let middle_m = self.middle_m.unwrap_or([low_m, high_m]);
        let longest_m = (0..3).map(|k| high_m[k] - low_m[k]).fold(0.0, f64::max);
        let half = [0, 1, 2].map(|k| 0.5 * (middle_m[1][k] - middle_m[0][k]));
        let reach_m = half.iter().map(|half| half * half).sum::<f64>().sqrt();
        let or_one = |value: f64| if value > 0.0 { value } else { 1.0 };
        Some(Scales {
            low_m,
            high_m,
            resolution_m: or_one(longest_m / STEPS),
            radius_unit_m: or_one(self.radius_m / f64::from(RADIUS_STEPS)),
            focus_m: [0, 1, 2].map(|k| 0.5 * (middle_m[0][k] + middle_m[1][k])),
            reach_m: or_one(reach_m + self.radius_m),
            speed_m_s: or_one(self.speed_m_s),
            mass_kg: or_one(self.mass_kg),
            utilisation: or_one(self.utilisation),
            stress_pa: or_one(self.stress_pa),
            loads: self.loads,
        })
    }
}

impl Scales {
    /// The largest value of each scale of colours.
    pub(crate) fn highest_texts(&self) -> Value {
        json!({
            "speed": show_quantity(self.speed_m_s, "m/s"),
            "mass": show_quantity(self.mass_kg, "kg"),
            "utilisation": show_quantity(self.utilisation, ""),
            "stress": show_quantity(self.stress_pa, "Pa"),
        })
    }

    /// The loads of walls that are above 0 anywhere: track, name, and largest value.
    pub(crate) fn loads(&self) -> Vec<Value> {
        let quantities = WallQuantity::WORDS.iter().zip(self.loads);
        let shown = quantities.filter(|(_, highest)| *highest > 0.0);
        let shown = shown.map(|((track, quantity), highest)| {
            let (name, unit) = quantity.label();
            json!({ "track": track, "name": name, "highest": show_quantity(highest, unit) })
        });
        shown.collect()
    }

    fn steps(&self, place_m: [f64; 3]) -> [i32; 3] {
        [0, 1, 2].map(|k| ((place_m[k] - self.low_m[k]) / self.resolution_m).round() as i32)
    }

    fn radius(&self, radius_m: f64) -> i32 {
        (radius_m / self.radius_unit_m).round() as i32
    }

    /// From 1 for the largest pressure over 128 to 255 for the largest tension.
    fn stress(&self, stress_pa: f64) -> i32 {
        let size = level(stress_pa.abs(), self.stress_pa, 127);
        if stress_pa < 0.0 {
            128 - size
        } else {
            128 + size
        }
    }
}

/// The tracks of all frames.
pub(crate) struct Tracks {
    tracks: BTreeMap<&'static str, Track>,
    last_fragment: u32,
    last_body: u32,
}

/// Names of the tracks, and bytes of their values.
const TRACKS: [(&str, usize); 17] = [
    ("x", 4),
    ("y", 4),
    ("z", 4),
    ("radius", 2),
    ("fragment", 4),
    ("body", 2),
    ("speed", 1),
    ("mass", 1),
    ("utilisation", 1),
    ("stress", 1),
    ("a", 4),
    ("b", 4),
    ("bond_radius", 2),
    ("bond_utilisation", 1),
    ("bond_stress", 1),
    ("broken", 1),
    ("corner", 4),
];
const OF_WALLS: [&str; 3] = ["wall_x", "wall_y", "wall_z"];
const OF_LOADS: [&str; 3] = ["load_x", "load_y", "load_z"];

impl Tracks {
    pub(crate) fn new() -> Self {
        let of_walls = OF_WALLS.into_iter().chain(OF_LOADS).map(|name| (name, 4));
        let of_loads = WallQuantity::WORDS.map(|(name, _)| (name, 1));
        let all = TRACKS.into_iter().chain(of_walls).chain(of_loads);
        Self {
            tracks: all
                .map(|(name, bytes)| (name, Track::new(name, bytes)))
                .collect(),
            last_fragment: 0,
            last_body: 0,
        }
    }

    /// In the order in which they are written.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Track> {
        self.tracks.values()
    }

    pub(crate) fn last_fragment(&self) -> u32 {
        self.last_fragment
    }

    pub(crate) fn last_body(&self) -> u32 {
        self.last_body
    }

    /// Appends a frame.
    pub(crate) fn push(&mut self, spheres: &Spheres, scales: &Scales) {
        let places: Vec<[i32; 3]> = spheres
            .centres_m
            .iter()
            .map(|at| scales.steps(*at))
            .collect();
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            self.put(name, places.iter().map(|place| place[k]));
        }
        let largest = |values: &[u32]| values.iter().copied().max().unwrap_or(0);
        self.last_fragment = self.last_fragment.max(largest(&spheres.fragments));
        self.last_body = self.last_body.max(largest(&spheres.bodies));
        let levels = |values: &[f64], highest: f64| -> Vec<i32> {
            values
                .iter()
                .map(|value| level(*value, highest, 255))
                .collect()
        };
        self.put(
            "radius",
            spheres.radii_m.iter().map(|radius| scales.radius(*radius)),
        );
        self.put("fragment", spheres.fragments.iter().map(|id| *id as i32));
        self.put("body", spheres.bodies.iter().map(|id| *id as i32));
        self.put("speed", levels(&spheres.speeds_m_s, scales.speed_m_s));
        self.put("mass", levels(&spheres.masses_kg, scales.mass_kg));
        self.put(
            "utilisation",
            levels(&spheres.utilisations, scales.utilisation),
        );
        self.put(
            "stress",
            spheres
                .stresses_pa
                .iter()
                .map(|stress| scales.stress(*stress)),
        );
        let bonds = &spheres.bonds;
        self.put("a", bonds.iter().map(|bond| bond.ends[0] as i32));
        self.put("b", bonds.iter().map(|bond| bond.ends[1] as i32));
        self.put(
            "bond_radius",
            bonds.iter().map(|bond| scales.radius(bond.radius_m)),
        );
        let utilisation = |bond: &Bond| level(bond.utilisation, scales.utilisation, 255);
        self.put("bond_utilisation", bonds.iter().map(utilisation));
        self.put(
            "bond_stress",
            bonds.iter().map(|bond| scales.stress(bond.stress_pa)),
        );
        self.put("broken", bonds.iter().map(|bond| i32::from(bond.is_broken)));
    }

    /// Appends the walls of a frame.
    pub(crate) fn push_walls(&mut self, walls: Option<&StoredWalls>, scales: &Scales) {
        let none = StoredWalls::default();
        let walls = walls.unwrap_or(&none);
        let places: Vec<[i32; 3]> = walls.points_m.iter().map(|at| scales.steps(*at)).collect();
        for (k, name) in OF_WALLS.into_iter().enumerate() {
            self.put(name, places.iter().map(|place| place[k]));
        }
        let corners = walls.triangles.as_flattened();
        self.put("corner", corners.iter().map(|at| *at as i32));
    }

    /// Appends the loads of the walls of a frame: three corners, and a level of each quantity, for
    /// each triangle.
    pub(crate) fn push_loads(&mut self, loads: &LoadCells, scales: &Scales) {
        let corners = loads.triangles_m.as_flattened();
        let places: Vec<[i32; 3]> = corners.iter().map(|at| scales.steps(*at)).collect();
        for (k, name) in OF_LOADS.into_iter().enumerate() {
            self.put(name, places.iter().map(|place| place[k]));
        }
        for (k, (name, _)) in WallQuantity::WORDS.into_iter().enumerate() {
            let values = loads.values.iter();
            self.put(name, values.map(|of| level(of[k], scales.loads[k], 255)));
        }
    }

    fn put(&mut self, name: &str, values: impl IntoIterator<Item = i32>) {
        if let Some(track) = self.tracks.get_mut(name) {
            track.push(values.into_iter().collect());
        }
    }
}

/// The box around two boxes, each by its lowest and highest corner.
fn joined(some: Option<[[f64; 3]; 2]>, more: [[f64; 3]; 2]) -> Option<[[f64; 3]; 2]> {
    let Some([low, high]) = some else {
        return Some(more);
    };
    Some([
        [0, 1, 2].map(|k| low[k].min(more[0][k])),
        [0, 1, 2].map(|k| high[k].max(more[1][k])),
    ])
}

/// The box around all points but the outermost on each side.
fn middle(places_m: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let aside = (places_m.len() as f64 * ASIDE) as usize;
    let mut ends = [[0.0; 3]; 2];
    for k in 0..3 {
        let mut along: Vec<f64> = places_m.iter().map(|place| place[k]).collect();
        along.sort_unstable_by(f64::total_cmp);
        ends[0][k] = along[aside];
        ends[1][k] = along[along.len() - 1 - aside];
    }
    ends
}

/// The value that one of a thousand exceeds; 0 of none.
pub(crate) fn most_of(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = sorted.len().saturating_sub(1 + sorted.len() / 1000);
    sorted.get(at).copied().unwrap_or(0.0)
}
