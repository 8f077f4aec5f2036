//! Bodies that are bonded in a region only, and rigid elsewhere.

use std::f64::consts::PI;

use dem_io::{Body, Result};

use super::bonded::{RADIUS_M, mass_kg, momenta_stay};
use super::prediction::{Member, Quantity, Shown};
use super::trial::Trial;

/// Distance of neighbours, m: their spheres touch.
const APART_M: f64 = 2.0 * RADIUS_M;
const DENSITY: f64 = 2500.0;
const YOUNG_MODULUS_PA: f64 = 1e9;
/// Steps between two looks at what a zone contains.
const EVERY: u32 = 50;
/// Error of the energy of bars that vibrate at a tenth of the limit of the step.
const ENERGY_ERROR: f64 = 1e-3;

/// Rows whose border lies in a bond that is softer or harder than the others, by a closed form; a
/// zone that runs along a bar faster than it is long in ten looks; spheres that are released and
/// join again at every look; a row that tears at its border.
pub(crate) fn zones() -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for ratio in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        members.push(border(ratio)?);
    }
    members.extend([fast()?, at_every_look()?, torn()?]);
    Ok(members)
}

/// A lattice of this many touching spheres along x, y and z, the first at the origin, each bonded
/// to its neighbours.
fn lattice([nx, ny, nz]: [u32; 3]) -> Result<Body> {
    let number = |[x, y, z]: [u32; 3]| x + nx * (y + ny * z);
    let (mut spheres, mut bonds) = (Vec::new(), Vec::new());
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let [px, py, pz] = [x, y, z].map(|k| APART_M * f64::from(k));
                spheres.push([px, py, pz, RADIUS_M]);
                let after = [[x + 1, y, z], [x, y + 1, z], [x, y, z + 1]];
                let present = after
                    .iter()
                    .filter(|[x, y, z]| *x < nx && *y < ny && *z < nz);
                bonds.extend(present.map(|place| [number([x, y, z]), number(*place)]));
            }
        }
    }
    Body::from_spheres(&spheres, &bonds)
}

/// The scene of a body that is bonded within `zone`, from x to x, m, with these keys of the run,
/// the bonds and the zone.
fn scene(run: &str, bonds: &str, [from_m, to_m]: [f64; 2], zone: &str) -> String {
    format!(
        "version = 1
run = {{ {run} }}
materials.rock = {{ density = {DENSITY}, young_modulus = {YOUNG_MODULUS_PA:e}, poisson_ratio = 0.25 }}
contacts.rock-rock = {{ restitution = 0.5, friction = 0.5 }}
bonds.rock = {{ young_modulus = {YOUNG_MODULUS_PA:e}, poisson_ratio = 0.25, {bonds} }}
regions.zone.box = {{ min = [{from_m}, -1, -1], max = [{to_m}, 1, 1] }}
bodies.bar = {{ file = \"bar.vtp\", material = \"rock\", bonds = \"rock\", bonded_within = {{ region = \"zone\"{zone} }} }}
"
    )
}

fn member(what: String, scene: String, body: Body, shown: Vec<Shown>) -> Member {
    let mut prediction = shown;
    prediction.extend(momenta_stay());
    Member::ends(
        what,
        Trial {
            bodies: vec![("bar.vtp", body)],
            ..Trial::of(scene)
        },
        prediction,
    )
}

/// A sphere that a stretched bond joins to four others, which are rigid: it oscillates as leapfrog
/// integrates it, x_n = x_0 cos(n theta) with sin(theta/2) = w dt/2. `ratio`: stiffness of that
/// bond over that of the others.
fn border(ratio: f64) -> Result<Member> {
    const STRAIN: f64 = 1e-4;
    const RIGID: f64 = 4.0;
    let mut body = lattice([5, 1, 1])?;
    let radii_m = [ratio.min(1.0), (1.0 / ratio).min(1.0)].map(|part| part.sqrt() * RADIUS_M);
    for (bond, radius_m) in body.bond_radii.iter_mut().enumerate() {
        *radius_m = radii_m[bond.min(1)];
    }
    body.bond_lengths[0] = APART_M / (1.0 + STRAIN);
    let stiffness = |radius_m: f64| YOUNG_MODULUS_PA * PI * radius_m * radius_m / APART_M;
    // Twice the frequency of a pair is more than that of any row.
    let step_s = 0.3 / (4.0 * stiffness(RADIUS_M) / mass_kg()).sqrt();
    let square = stiffness(radii_m[0]) * (1.0 + STRAIN) * (1.0 + 1.0 / RIGID) / mass_kg();
    let angle = 2.0 * (0.5 * square.sqrt() * step_s).asin();
    let steps = (2.25 * 2.0 * PI / angle).round();
    let stretch_m = APART_M - body.bond_lengths[0];
    let share = RIGID / (1.0 + RIGID);
    let moved_m = share * stretch_m * (1.0 - (steps * angle).cos());
    let run = format!("end_time = {:e}, time_step = {step_s:e}", steps * step_s);
    let mut text = scene(&run, "", [-1.0, 0.5 * APART_M], "");
    text += "groups.first = { body = \"bar\", particles = [0] }
measures.first_moved = { of = \"first\", quantity = \"displacement_x\" }
";
    let rounding_m = steps * f64::EPSILON * 5.0 * APART_M;
    Ok(member(
        format!("border {ratio:e} times as stiff"),
        text,
        body,
        vec![Shown::measure("first_moved", "m", moved_m, rounding_m)],
    ))
}

/// Keys of a zone that a wall carries, and which spheres may leave as they are.
const CARRIED: &str =
    ", moves_with = \"carrier\", rejoin = { strain_energy = 1e9, fluctuation_velocity = 1e3 }";

/// Velocities that shake a bar of this length, m: it stretches, bends and twists.
fn shaken(length: u32) -> String {
    let mut text = String::new();
    for x in 0..length {
        let phase = PI * f64::from(x) / f64::from(length - 1);
        let [from_m, to_m] = [-0.5, 0.5].map(|off| (f64::from(x) + off) * APART_M);
        let (along, across, spin) = (-0.3 * phase.cos(), 0.3 * phase.sin(), 50.0 * phase.cos());
        text += &format!(
            "[groups.layer-{x}]
body = \"bar\"
box = {{ min = [{from_m}, -1, -1], max = [{to_m}, 1, 1] }}
[initial.layer-{x}]
group = \"layer-{x}\"
velocity = [{along}, {across}, 1]
angular_velocity = [{spin}, 0, {spin}]
"
        );
    }
    text
}

/// A zone of four layers of a bar of twenty, which is over its end after seven looks. The part
/// behind it grows by a layer at each look, until it is the whole bar.
fn fast() -> Result<Member> {
    let [length, first, thick] = [20, 2, 4];
    let edge_m = |layer: u32| (f64::from(layer) - 0.5) * APART_M;
    let step_s = 1e-7;
    // Two and a half layers in the time between two looks.
    let speed_m_s = 2.5 * APART_M / (f64::from(EVERY) * step_s);
    let looks = length + 5;
    let run = format!(
        "end_time = {:e}, time_step = {step_s:e}",
        f64::from(looks * EVERY) * step_s
    );
    let mut text = scene(&run, "", [edge_m(first), edge_m(first + thick)], CARRIED);
    text += &format!(
        "[walls.carrier]
box = {{ min = [9, 9, 9], max = [9.1, 9.1, 9.1] }}
material = \"rock\"
velocity = [{speed_m_s:e}, 0, 0]
{}",
        shaken(length)
    );
    let layer = 9;
    Ok(member(
        format!("zone at {speed_m_s:.0} m/s"),
        text,
        lattice([length, 3, 3])?,
        vec![
            Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
            Shown::count(
                Quantity::Released,
                (layer * (length - first - thick)) as usize,
            ),
            Shown::count(Quantity::Rejoined, (layer * (length - first)) as usize),
            Shown::count(Quantity::Fragments, 1),
        ],
    ))
}

/// A zone that goes to and fro by a layer between two looks: nine spheres are released at one and
/// join again at the next.
fn at_every_look() -> Result<Member> {
    let (step_s, looks, layer) = (1e-7, 40_u32, 9);
    let between_s = f64::from(EVERY) * step_s;
    let run = format!(
        "end_time = {:e}, time_step = {step_s:e}",
        (f64::from(looks) + 0.5) * between_s
    );
    let mut text = scene(&run, "", [-1.0, 2.5 * APART_M], CARRIED);
    let rows: Vec<String> = (0..=looks)
        .map(|look| format!("[{:e}, {}]", f64::from(look) * between_s, look % 2))
        .collect();
    text += &format!(
        "[walls.carrier]
box = {{ min = [9, 9, 9], max = [9.1, 9.1, 9.1] }}
material = \"rock\"
displacement = [{APART_M}, 0, 0]
table = [{}]
{}",
        rows.join(", "),
        shaken(8)
    );
    let moved = (layer * looks / 2) as usize;
    Ok(member(
        "released and joined at every look".to_owned(),
        text,
        lattice([8, 3, 3])?,
        vec![
            Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
            Shown::count(Quantity::Released, moved),
            Shown::count(Quantity::Rejoined, moved),
            Shown::count(Quantity::Fragments, 1),
        ],
    ))
}

/// A row that a load pulls off its rigid part: the bond across the border is the thinnest.
fn torn() -> Result<Member> {
    let mut body = lattice([6, 1, 1])?;
    body.bond_radii[3] *= 0.5;
    let mut text = scene(
        "end_time = \"2 ms\", safety_factor = 0.2",
        "damping = { damping_ratio = 0.1 }, failure = { tensile_strength = \"1 MPa\" }",
        [3.5 * APART_M, 1.0],
        "",
    );
    text += "groups.last = { body = \"bar\", particles = [5] }
loads.pull = { group = \"last\", force = [3, 0, 0], ramp = \"1 ms\" }
";
    Ok(member(
        "torn at its border".to_owned(),
        text,
        body,
        vec![
            Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
            Shown::count(Quantity::BrokenBonds, 1),
            Shown::count(Quantity::Fragments, 2),
        ],
    ))
}
