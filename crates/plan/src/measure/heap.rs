//! The angle of repose of a heap.
//!
//! A cone of height H and radius R has a variance of height of 3/80 H^2, a mean square distance
//! from its axis of 3/10 R^2 and a covariance of the two of -1/40 H R^2. The first two give its
//! slope independently of the ground and of mass missing uniformly over its surface: sqrt(8 var z /
//! mean r^2). Spheres count with their own extent. The third shows whether there is a slope at all:
//! a bed with a flat top has none. What is no cone has no slope, as [`shape`] finds it.

mod shape;

use nalgebra::Vector3;

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

/// A sphere: mass, kg, radius, m, height, and two coordinates across, m.
struct Sphere {
    mass_kg: f64,
    radius_m: f64,
    height_m: f64,
    across_m: [f64; 2],
}

/// Moments of a heap's mass.
struct Moments {
    /// Position of the axis.
    middle_m: [f64; 2],
    /// Variance of the height, m2.
    upright_m2: f64,
    /// Mean square distance from the axis, m2.
    across_m2: f64,
    /// Covariance of height and square distance, m3.
    covariance_m3: f64,
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

/// The spheres, along axes of which one points up.
fn turned(spheres: &[spheres::Sphere], up: &Vector3<f64>) -> Vec<Sphere> {
    let [aside, across] = spheres::across(up);
    let turned = |sphere: &spheres::Sphere| Sphere {
        mass_kg: sphere.mass_kg,
        radius_m: sphere.radius_m,
        height_m: sphere.place_m.dot(up),
        across_m: [sphere.place_m.dot(&aside), sphere.place_m.dot(&across)],
    };
    spheres.iter().map(turned).collect()
}

fn moments(heap: &[Sphere]) -> Moments {
    let mass_kg: f64 = heap.iter().map(|sphere| sphere.mass_kg).sum();
    let mean =
        |of: &dyn Fn(&Sphere) -> f64| heap.iter().map(|s| s.mass_kg * of(s)).sum::<f64>() / mass_kg;
    let middle_m = [0, 1].map(|k| mean(&|s| s.across_m[k]));
    let height_m = mean(&|s| s.height_m);
    let square = |s: &Sphere| {
        let [x, y] = [0, 1].map(|k| s.across_m[k] - middle_m[k]);
        x * x + y * y
    };
    let square_m2 = mean(&square);
    // A solid sphere's own variance along any axis.
    let own_m2 = 0.2 * mean(&|s| s.radius_m * s.radius_m);
    Moments {
        middle_m,
        upright_m2: own_m2 + mean(&|s| (s.height_m - height_m).powi(2)),
        across_m2: 2.0 * own_m2 + square_m2,
        covariance_m3: mean(&|s| (s.height_m - height_m) * (square(s) - square_m2)),
    }
}
