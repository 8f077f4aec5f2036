//! A map of the crack: the body in its initial state, seen from the side, and the broken bonds.

use dem_plots::{Circle, Dot, Guide, Map};
use nalgebra::Vector3;

use crate::setup::Setup;
use dem_laboratory::Specimen;
use dem_laboratory::test_result::Crack;

/// Largest number of particles drawn, those nearest to the viewer.
const MOST_PARTICLES: usize = 4000;

/// A particle of the body in its initial position: centre x, y, z and radius, m.
pub type Sphere = [f64; 4];

/// Content of the map.
#[derive(Debug, Clone, Copy)]
pub struct CrackPicture<'a> {
    /// Arrangement of the test.
    pub setup: &'a Setup,
    /// Particles of the body in their initial positions.
    pub spheres: &'a [Sphere],
    /// Initial position, m, and time of breakage, s, of each broken bond, in order of time.
    pub broken: &'a [([f64; 3], f64)],
    /// Mean position of the crack.
    pub crack: Option<&'a Crack>,
}

/// Unit vectors: across the map, up the map, towards the viewer.
struct View([Vector3<f64>; 3]);

impl View {
    fn of(setup: &Setup) -> Self {
        let direction = Vector3::from(setup.direction);
        let along = match setup.specimen {
            // Along x or y, perpendicular to a bar along another axis.
            Specimen::Bar { .. } if direction.x.abs() < 0.5 => Vector3::x(),
            Specimen::Bar { .. } => Vector3::y(),
            _ => setup.along.into(),
        };
        let along = if along.sum() < 0.0 { -along } else { along };
        // The load comes from above; a bar pulled along x is drawn upright as well.
        let up = -direction;
        Self([along, up, along.cross(&up)])
    }

    /// x and y in the map, m.
    fn place_m(&self, point_m: [f64; 3]) -> [f64; 2] {
        let [across, up, _] = self.0;
        [across, up].map(|axis| axis.dot(&Vector3::from(point_m)))
    }

    /// Nearest coordinate of a sphere towards the viewer, m.
    fn nearness_m(&self, &[x, y, z, radius_m]: &Sphere) -> f64 {
        self.0[2].dot(&Vector3::new(x, y, z)) + radius_m
    }
}

/// The map: early breaks dark violet, late ones yellow.
pub fn crack_map(picture: &CrackPicture<'_>) -> Map {
    let view = View::of(picture.setup);
    let bonds = match picture.broken.len() {
        1 => "1 broken bond".to_owned(),
        count => format!("{count} broken bonds"),
    };
    let dot = |&(place, time_s): &([f64; 3], f64)| Dot {
        at_m: view.place_m(place),
        time_s,
    };
    let (guides, pointer_m) = marks(picture, &view);
    Map {
        title: format!("{bonds}, from the side, in the body at the start"),
        corners_m: corners_m(picture.spheres, &view),
        circles: particles(picture.spheres, &view),
        dots: picture.broken.iter().map(dot).collect(),
        guides,
        pointer_m,
    }
}

/// Corners of the body in the map, m: lower left and upper right.
fn corners_m(spheres: &[Sphere], view: &View) -> [[f64; 2]; 2] {
    let places = || {
        spheres
            .iter()
            .map(|&[x, y, z, r]| (view.place_m([x, y, z]), r))
    };
    [
        places().fold([f64::INFINITY; 2], |low, (at, r)| {
            [0, 1].map(|k| low[k].min(at[k] - r))
        }),
        places().fold([f64::NEG_INFINITY; 2], |high, (at, r)| {
            [0, 1].map(|k| high[k].max(at[k] + r))
        }),
    ]
}

/// The particles nearest to the viewer.
fn particles(spheres: &[Sphere], view: &View) -> Vec<Circle> {
    let front_m = spheres.iter().map(|s| view.nearness_m(s));
    let front_m = front_m.fold(f64::NEG_INFINITY, f64::max);
    let is_in_front = |s: &&Sphere| front_m - view.nearness_m(s) < 2.0 * s[3];
    let mut shown: Vec<&Sphere> = spheres.iter().filter(is_in_front).collect();
    // If too few are at the very front, as on a curved surface, those further back are drawn as
    // well.
    if shown.len() < spheres.len().min(200) {
        shown = spheres.iter().collect();
    }
    shown.sort_by(|a, b| view.nearness_m(b).total_cmp(&view.nearness_m(a)));
    shown.truncate(MOST_PARTICLES);
    let circle = |sphere: &&Sphere| Circle {
        centre_m: view.place_m([sphere[0], sphere[1], sphere[2]]),
        radius_m: sphere[3],
    };
    shown.iter().rev().map(circle).collect()
}

/// Expected range of the crack: lines at both sides; and the mean position of the broken bonds, m
/// along x.
fn marks(picture: &CrackPicture<'_>, view: &View) -> (Vec<Guide>, Option<f64>) {
    let setup = picture.setup;
    let at = |offset_m: f64| {
        view.place_m([0, 1, 2].map(|k| setup.middle_m[k] + offset_m * setup.along[k]))
    };
    let upright = matches!(setup.specimen, Specimen::Bar { .. });
    let guide = |side: f64| match (upright, at(side * setup.crack_within_m)) {
        (true, [_, y]) => Guide::Level(y),
        (false, [x, _]) => Guide::Upright(x),
    };
    let mean = picture.crack.filter(|_| !upright);
    let guides = [-1.0, 1.0].map(guide).to_vec();
    (guides, mean.map(|crack| at(crack.offset_m)[0]))
}
