//! Bodies that break completely at once, and bodies of a single particle.

use std::f64::consts::PI;

use dem_io::{Body, Result};

use super::impact::Impact;
use super::limit_map::block;
use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;

/// kg/m3
const DENSITY: f64 = 2500.0;
/// Initial strain of the bonds: 10 kPa, while their strength is 1 Pa.
const STRAIN: f64 = 1e-5;

/// Spinning blocks whose bonds all fail at the start. Each sphere keeps its motion: two spheres
/// that separate on a circle never approach each other, so with relaxation they never push each
/// other. Without relaxation they explode, and the run is stopped.
pub(crate) fn overlaps() -> Result<Vec<Member>> {
    let member = |overlap: f64| {
        let body = block(4, overlap, STRAIN)?;
        Ok(breaks(format!("overlap {overlap}"), body, "5 ms"))
    };
    let all = [0.1, 0.25, 0.5, 0.75, 0.9].into_iter().map(member);
    let mut members = all.collect::<Result<Vec<Member>>>()?;
    if let Some(last) = members.last().cloned() {
        let words = ["of energy were created", "set relaxation.enabled = true"];
        members.push(Member {
            what: format!("{}, relaxation off", last.what),
            trial: Trial {
                scene: format!("{}relaxation.enabled = false\n", last.trial.scene),
                ..last.trial
            },
            prediction: Prediction::Stopped(words.map(str::to_owned).to_vec()),
            ..last
        });
    }
    Ok(members)
}

/// A large block of the same type.
pub(crate) fn shatter() -> Result<Vec<Member>> {
    let body = block(24, 0.25, STRAIN)?;
    Ok(vec![breaks(
        format!("{} bonds", body.bonds.len()),
        body,
        "0.1 ms",
    )])
}

/// A body that spins at 1000 rad/s and whose bonds all fail at once: kinetic energy, momenta and
/// fragments are known.
fn breaks(what: String, body: Body, end_time: &str) -> Member {
    let spin_rad_s = 1e3;
    let kinetic_j = kinetic_j(&body, spin_rad_s);
    let scene = format!(
        "version = 1
run = {{ end_time = \"{end_time}\" }}
materials.rock = {{ density = {DENSITY}, young_modulus = \"1 GPa\", poisson_ratio = 0.25 }}
contacts.rock-rock = {{ restitution = 0.5, friction = 0.5 }}
bonds.rock = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25, failure = {{ tensile_strength = \"1 Pa\", compressive_strength = \"1 Pa\" }} }}
bodies.block = {{ file = \"block.vtp\", material = \"rock\", bonds = \"rock\", angular_velocity = [0, 0, {spin_rad_s}] }}
measures.largest_kinetic_energy = {{ quantity = \"kinetic_energy\", statistic = \"largest\" }}
measures.smallest_kinetic_energy = {{ quantity = \"kinetic_energy\", statistic = \"smallest\" }}
"
    );
    // Sums over all particles, each with rounding errors.
    let rounding = 2.0 * body.radii.len() as f64 * f64::EPSILON;
    let prediction = Prediction::Ends(vec![
        Shown::measure(
            "largest_kinetic_energy",
            "J",
            kinetic_j,
            rounding * kinetic_j,
        ),
        Shown::measure(
            "smallest_kinetic_energy",
            "J",
            kinetic_j,
            rounding * kinetic_j,
        ),
        Shown::count(Quantity::BrokenBonds, body.bonds.len()),
        Shown::count(Quantity::Fragments, body.radii.len()),
    ]);
    Member {
        what,
        trial: Trial {
            bodies: vec![("block.vtp", body)],
            ..Trial::of(scene)
        },
        way: ObservationMethod::Run,
        prediction,
    }
}

/// Kinetic energy of a body that spins about z through its centre of mass, J.
fn kinetic_j(body: &Body, spin_rad_s: f64) -> f64 {
    let masses = body
        .radii
        .iter()
        .map(|r| DENSITY * 4.0 / 3.0 * PI * r.powi(3));
    let masses: Vec<f64> = masses.collect();
    let centre = |k: usize| {
        let moments = masses.iter().zip(&body.positions).map(|(m, x)| m * x[k]);
        moments.sum::<f64>() / masses.iter().sum::<f64>()
    };
    let [x, y] = [0, 1].map(centre);
    let of_one = |(i, m): (usize, &f64)| {
        let place = &body.positions[i];
        let arm = (place[0] - x).powi(2) + (place[1] - y).powi(2);
        m * (arm + 0.4 * body.radii[i].powi(2))
    };
    let inertia: f64 = masses.iter().enumerate().map(of_one).sum();
    0.5 * inertia * spin_rad_s.powi(2)
}

/// A sphere without bonds as a cluster and as a clump; a body of three spheres without bonds.
pub(crate) fn one_particle() -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for start_as in ["bonded", "clump"] {
        for restitution in [1.0, 0.5] {
            let impact = Impact {
                restitution,
                start_as,
                ..Impact::usual()
            };
            members.push(impact.member(format!("{start_as}, restitution {restitution}")));
        }
    }
    let scene = format!(
        "version = 1
run = {{ end_time = \"1 ms\" }}
materials.rock = {{ density = {DENSITY}, young_modulus = \"1 GPa\", poisson_ratio = 0.25 }}
contacts.rock-rock = {{ restitution = 0.5 }}
bodies.loose = {{ particles = [[-3e-3, 0, 0, 1e-3], [0, 0, 0, 1e-3], [3e-3, 0, 0, 1e-3]], material = \"rock\", angular_velocity = [0, 0, 1000] }}
groups.last = {{ body = \"loose\", particles = [2] }}
measures.along = {{ of = \"last\", quantity = \"displacement_x\" }}
measures.across = {{ of = \"last\", quantity = \"displacement_y\" }}
measures.turned = {{ of = \"last\", quantity = \"rotation_z\" }}
"
    );
    // Straight on, at 3 mm times 1000 rad/s for 1 ms, with a rotation of 1 rad.
    let rounding = 1e-12;
    members.push(Member::ends(
        "three loose spheres",
        Trial::of(scene),
        vec![
            Shown::measure("along", "m", 0.0, rounding * 3e-3),
            Shown::measure("across", "m", 3e-3, rounding * 3e-3),
            Shown::measure("turned", "rad", 1.0, rounding),
            Shown::count(Quantity::Fragments, 3),
        ],
    ));
    Ok(members)
}
