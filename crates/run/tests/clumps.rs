//! Rigid clumps in the solver: rigid-body motion, conservation when bonded clusters replace them,
//! and bodies that are fed and removed as defined in the scene.

mod again;
mod bending;
mod books;
mod bounce;
mod breakage;
mod carried;
mod daughters;
mod ids;
mod inlets;
mod lists;
mod masses;
mod measured_breakage;
mod outer;
mod outlets;
mod refused;
mod regions;
mod rest;
mod restored;
mod rigid;
mod squeezed;
mod step_limit;
mod swap;
mod touched;
mod triggers;

use std::fmt::Write;

use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bodies::renumber;
use dem_engine::state::events::Events;
use dem_engine::state::events::PopulationEvent;
use dem_engine::state::particles::Particles;
use dem_engine::step::step;
use nalgebra::Vector3;

use crate::helpers::{planned, try_planned};

/// The head of a scene: one material with this contact, and bonds.
pub(crate) const HEAD: &str = "version = 1
run.end_time = 1
materials.stuff = { density = 2500, young_modulus = 1e8, poisson_ratio = 0.25 }
bonds.stiff = { young_modulus = 1e9, poisson_ratio = 0.25 }
";

/// The contact of the material with itself.
pub(crate) const MEETS: &str = "contacts.stuff-stuff = { restitution = 0.5, friction = 0.5 }\n";

/// A body of a block of spheres in which neighbours are bonded. `radius_m`: radius of the sphere at
/// a position, or none.
pub(crate) fn block(
    name: &str,
    counts: [i32; 3],
    apart_m: f64,
    radius_m: impl Fn([i32; 3]) -> Option<f64>,
    more: &str,
) -> String {
    let mut text = format!("[bodies.{name}]\nmaterial = \"stuff\"\nbonds = \"stiff\"\n{more}\n");
    let mut there: Vec<[i32; 3]> = Vec::new();
    let (mut particles, mut bonds) = (String::new(), String::new());
    for n in 0..counts.iter().product() {
        let at = [
            n % counts[0],
            n / counts[0] % counts[1],
            n / counts[0] / counts[1],
        ];
        let Some(radius_m) = radius_m(at) else {
            continue;
        };
        let [x, y, z] = at.map(|k| apart_m * f64::from(k));
        write!(particles, "[{x:e}, {y:e}, {z:e}, {radius_m:e}],").unwrap();
        for (other, place) in there.iter().enumerate() {
            let steps: i32 = (0..3).map(|k| (place[k] - at[k]).abs()).sum();
            if steps == 1 {
                write!(bonds, "[{other}, {}],", there.len()).unwrap();
            }
        }
        there.push(at);
    }
    write!(text, "particles = [{particles}]\nbond_list = [{bonds}]\n").unwrap();
    text
}

/// A body of 11 spheres of 2 mm without any symmetry, with bonded neighbours.
pub(crate) fn lump(name: &str, more: &str) -> String {
    let radius = |[x, y, z]: [i32; 3]| {
        let is_there = [x, y, z] != [2, 1, 1];
        is_there.then(|| 1e-3 * (1.0 - 0.02 * f64::from(x) - 0.04 * f64::from(y * z)))
    };
    block(name, [3, 2, 2], 2e-3, radius, more)
}

/// A step, after which the bodies are listed again.
pub(crate) fn go<'a>(state: &'a mut State, bodies: &mut Vec<PlacedBody>) -> &'a Events {
    let events = step(state);
    for by in &events.renumberings {
        renumber(bodies, by);
    }
    events
}

/// A step of which only the events are returned.
pub(crate) fn happens(state: &mut State) -> Vec<PopulationEvent> {
    step(state).population.clone()
}

/// Mass, centre of mass, momentum, angular momentum about a point and kinetic energy of some
/// particles.
pub(crate) struct Whole {
    pub(crate) mass_kg: f64,
    pub(crate) centre: Vector3<f64>,
    pub(crate) momentum: Vector3<f64>,
    pub(crate) angular_momentum: Vector3<f64>,
    pub(crate) kinetic_j: f64,
}

impl Whole {
    pub(crate) fn of(
        particles: &Particles,
        some: impl IntoIterator<Item = usize>,
        about: &Vector3<f64>,
    ) -> Self {
        let zero = Vector3::zeros();
        let (mut mass_kg, mut arms, mut momentum, mut angular_momentum) = (0.0, zero, zero, zero);
        let mut kinetic_j = 0.0;
        for i in some {
            let motion = &particles.motions[i];
            let (m, j) = (1.0 / motion.inverse_mass, 1.0 / motion.inverse_inertia);
            let (v, w) = (
                Vector3::from(motion.velocity_m_s),
                Vector3::from(motion.spin_rad_s),
            );
            let arm = particles.poses[i].place() - about;
            mass_kg += m;
            arms += m * arm;
            momentum += m * v;
            angular_momentum += m * arm.cross(&v) + j * w;
            kinetic_j += 0.5 * (m * v.norm_squared() + j * w.norm_squared());
        }
        Self {
            mass_kg,
            centre: about + arms / mass_kg,
            momentum,
            angular_momentum,
            kinetic_j,
        }
    }
}
