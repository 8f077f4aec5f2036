//! The angle of repose of a heap.
//!
//! A cone of height H and radius R has a variance of height of 3/80 H^2, a mean square distance
//! from its axis of 3/10 R^2 and a covariance of the two of -1/40 H R^2. The first two give its
//! slope independently of the ground and of mass missing uniformly over its surface: sqrt(8 var z /
//! mean r^2). Spheres count with their own extent. The third shows whether there is a slope at all:
//! a bed with a flat top has none. What is no cone has no slope, as [`shape`] finds it.

mod moments;
mod shape;

use nalgebra::Vector3;

use self::moments::{moments, turned};
use self::shape::is_one_heap;
use super::measurement::{Measurement, Planned, Settles};
use super::probe::Probe;
use super::spheres::{self, spheres};
use dem_scene::Measure;

/// Smallest number of particles for which an angle of repose has a meaning.
const FEWEST_IN_HEAP: usize = 50;

/// Spheres farther from the axis than this multiple of the cone's radius have rolled away.
const ROLLED_AWAY: f64 = 1.25;
/// The covariance gives a smaller slope than the variances: by up to a fifth for the layers of a
/// small cone. Any further difference means a flat top.
const CONICAL: f64 = 0.8;

pub(super) const MEASUREMENTS: &[Measurement] = &[Measurement {
    settles: Settles::Roughly,
    missing: |probe| Some(missing(probe)),
    refusal: |measure, planned| {
        let (count, of) = (few(measure, planned)?, &measure.of);
        let problem = format!(
            "an angle of repose needs {FEWEST_IN_HEAP} particles or more, and \"{of}\" has {count}"
        );
        Some((problem, "name a larger heap, or ask for a position"))
    },
    doubt: |scene| {
        (Vector3::from(scene.run.gravity_m_s2) == Vector3::zeros()).then_some(
            "an angle of repose has no meaning without gravity; set run.gravity, such as [0, 0, -9.81]",
        )
    },
    ..Measurement::new("angle_of_repose", |probe, view| {
        angle_of_repose_deg(&spheres(&probe.members, view.state), view.up())
    })
}];

fn missing(probe: &Probe) -> String {
    let (of, left) = (&probe.measure.of, probe.members.particles.len());
    if left >= FEWEST_IN_HEAP {
        format!(
            "\"{of}\" is not one round heap, but several, a ridge, a ring, a slope, a heap at a wall or in a corner, on a bed of its own spheres or with a flat top; name the body of one heap that stands free in \"of\", and give its bed another name"
        )
    } else {
        format!(
            "an angle of repose needs {FEWEST_IN_HEAP} particles or more, and \"{of}\" has {left}"
        )
    }
}

/// Number of particles of the heap, if they are too few and no more can be added.
fn few(measure: &Measure, planned: &Planned<'_>) -> Option<usize> {
    let of = &measure.of;
    let means = |name: &String| of == "all" || name == of;
    let mut fed = (planned.scene.inlets.values()).flat_map(|inlet| &inlet.bodies);
    if fed.any(|(name, _)| means(name)) {
        return None;
    }
    let standing = planned.groups.get(of).map_or(0, Vec::len);
    let clumps = planned.state.clumps.templates.iter();
    let clumps = clumps.filter(|template| means(&template.body));
    let count = standing + clumps.map(|template| template.spheres.len()).sum::<usize>();
    (count < FEWEST_IN_HEAP).then_some(count)
}

/// Slope, degrees, of the cone with the same vertical and horizontal spread of mass as the spheres;
/// 0 if their top is flat. A few that have rolled far away do not change it. NaN for fewer than
/// [`FEWEST_IN_HEAP`], and if they are not one round heap. `up`: unit vector.
fn angle_of_repose_deg(spheres: &[spheres::Sphere], up: Vector3<f64>) -> f64 {
    let mut heap = turned(spheres, &up);
    if heap.len() < FEWEST_IN_HEAP {
        return f64::NAN;
    }
    loop {
        let moments = moments(&heap);
        let radius_m = (10.0 / 3.0 * moments.across_m2).sqrt();
        let before = heap.len();
        let [x, y] = moments.middle_m;
        heap.retain(|sphere| {
            let [sx, sy] = sphere.across_m;
            (sx - x).hypot(sy - y) <= ROLLED_AWAY * radius_m
        });
        if heap.len() == before {
            let slope = (8.0 * moments.upright_m2 / moments.across_m2).sqrt();
            let falling = -40.0 * moments.covariance_m3 / radius_m.powi(3);
            if !is_one_heap(&heap, &moments, falling / slope) {
                return f64::NAN;
            }
            let fraction = (falling / (CONICAL * slope)).clamp(0.0, 1.0);
            return (fraction * slope).atan().to_degrees();
        }
    }
}
