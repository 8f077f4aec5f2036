//! The initial arrangement of a test, and the extent of its body.

use dem_engine::state::State;
use dem_laboratory::Specimen;
use nalgebra::Vector3;

use super::given::Said;

/// Gauge length of a bar as a fraction of its length.
pub(super) const GAUGE: f64 = 0.5;

/// A wall that keeps a pressure on a side of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// Number of the wall in the state.
    pub wall: usize,
    /// Unit vector towards the body. Length 3.
    pub inwards: [f64; 3],
    /// Area of the side, m2.
    pub area_m2: f64,
    /// Particles halfway between the middle of the body and this wall, at half its height, whose
    /// mean displacement is that of the side.
    pub near: Vec<u32>,
    /// Distance of their mean from that of the opposite side, m; 0: the side is not measured.
    pub gauge_m: f64,
}

impl Side {
    /// Mean coordinate of the particles near it, towards the middle of the body, m.
    pub(crate) fn place_m(&self, state: &State) -> f64 {
        let places = self
            .near
            .iter()
            .map(|&i| state.particles.poses[i as usize].place());
        let sum: f64 = places
            .map(|place| place.dot(&Vector3::from(self.inwards)))
            .sum();
        sum / self.near.len().max(1) as f64
    }

    /// Force of the wall on the body, N.
    pub(crate) fn force_n(&self, state: &State) -> f64 {
        Vector3::from(state.walls[self.wall].push.force_n).dot(&Vector3::from(self.inwards))
    }
}

/// A particle near the loaded diameter of a disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InSlab {
    /// Its number in the state.
    pub particle: u32,
    /// Its slab along the diameter, in the direction of the load.
    pub slab: usize,
    /// Its share of the volume of the disc, m3.
    pub volume_m3: f64,
}

/// Initial arrangement of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// The specimen.
    pub specimen: Specimen,
    /// Unit vector of the load's motion. Length 3.
    pub direction: [f64; 3],
    /// Unit vector along which the position of the crack is measured: along a beam or bar, across
    /// the loaded diameter of a disc. Length 3.
    pub along: [f64; 3],
    /// Middle of the body, and of the span of a beam, m. Length 3.
    pub middle_m: [f64; 3],
    /// The crack is in the expected place if its mean distance from the middle is at most this, m.
    pub crack_within_m: f64,
    /// Particles whose displacement, minus that of `resting`, is the body's deflection or
    /// elongation. Empty: not measured.
    pub moving: Vec<u32>,
    /// The reference particles.
    pub resting: Vec<u32>,
    /// Their distance along a bar, or along the loaded diameter of a disc, m; otherwise 0.
    pub gauge_m: f64,
    /// Mean radius of the particles, m.
    pub mean_radius_m: f64,
    /// The walls on the sides of a triaxial test.
    pub sides: Vec<Side>,
    /// The particles along the loaded diameter of a disc.
    pub strip: Vec<InSlab>,
    /// Number of slabs of equal height into which they fall.
    pub slabs: usize,
    /// Section of a body that is pressed or pulled along its length, measured on it, m2. None: it
    /// is not measured.
    pub section_m2: Option<f64>,
    /// The smaller of the parts of its two ends that plates press. None: it is not measured.
    pub pressed: Option<f64>,
    /// What was assumed, a sentence each.
    pub notes: Vec<String>,
    /// Reasons to doubt the test, a sentence each.
    pub warnings: Vec<String>,
}

impl Setup {
    /// An arrangement without the particles that are chosen for measurements.
    pub(super) fn of(
        specimen: Specimen,
        direction: [f64; 3],
        along: [f64; 3],
        middle_m: [f64; 3],
        crack_within_m: f64,
    ) -> Self {
        Self {
            specimen,
            direction,
            along,
            middle_m,
            crack_within_m,
            moving: Vec::new(),
            resting: Vec::new(),
            gauge_m: 0.0,
            mean_radius_m: 0.0,
            sides: Vec::new(),
            strip: Vec::new(),
            slabs: 0,
            section_m2: None,
            pressed: None,
            notes: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The arrangement with the notes and warnings on its dimensions.
    pub(super) fn saying(self, said: Said) -> Self {
        Self {
            notes: said.notes,
            warnings: said.warnings,
            ..self
        }
    }
}

pub(super) type Refusal = (String, &'static str);

/// Smallest and largest coordinate of the body along an axis, m.
pub(crate) fn extent(state: &State, particles: &[u32], axis: &Vector3<f64>) -> [f64; 2] {
    particles
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &i| {
            let pose = &state.particles.poses[i as usize];
            let (at, radius) = (pose.place().dot(axis), pose.radius_m());
            [low.min(at - radius), high.max(at + radius)]
        })
}

pub(super) fn size([low, high]: [f64; 2]) -> f64 {
    high - low
}

pub(super) fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// A unit vector or its opposite, whichever has a positive largest component.
pub(super) fn forwards(along: Vector3<f64>) -> Vector3<f64> {
    if along[along.iamax()] < 0.0 {
        -along
    } else {
        along
    }
}
