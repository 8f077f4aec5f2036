//! Runs of many steps: conserved quantities must not drift.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use dem_io::Result;

use super::prediction::{Member, Quantity, Shown};
use super::trial::{Outcome, Trial};
use dem_physics::bond::damping::{DampingModel, ReducedInertia};
use dem_physics::bond::damping_models::Chen;
use dem_physics::bond::pair::frequencies;
use dem_physics::bond::stiffness::{BondModel, BondShape, stiffness};

/// Number of steps of the spinning pair.
const STEPS: f64 = 1e6;
/// s
const DAY: f64 = 86_400.0;
/// s
const HOUR: f64 = 3600.0;

/// Time step of resting bodies, s: the same for an hour and for a day, as friction holds bodies
/// where they came to rest, step by step.
const REST_STEP_S: f64 = 0.05;

/// Radius of each sphere of the spinning pair, m.
const RADIUS_M: f64 = 1e-3;
/// Their density, kg/m3.
const DENSITY_KG_M3: f64 = 2500.0;
/// Young's modulus of their bond, Pa.
const YOUNG_PA: f64 = 1e9;
/// How fast the pair spins at the start, rad/s.
const SPIN_RAD_S: f64 = 1e4;

/// Two bonded spheres that spin about each other, damped by this ratio, for [`STEPS`] steps.
fn spinning_pair(damping_ratio: f64, step_s: f64) -> String {
    format!(
        "version = 1
run = {{ end_time = {:e}, time_step = {step_s:e} }}
materials.rock.density = {DENSITY_KG_M3}
bonds.rock = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.25, damping = {{ damping_ratio = {damping_ratio} }} }}
measures.elastic_energy = {{ quantity = \"elastic_energy\", statistic = \"{}\" }}
[bodies.pair]
particles = [[0, 0, 0, {RADIUS_M:e}], [{:e}, 0, 0, {RADIUS_M:e}]]
bond_list = [[0, 1]]
material = \"rock\"
bonds = \"rock\"
angular_velocity = [0, 0, {SPIN_RAD_S:e}]
",
        STEPS * step_s,
        if damping_ratio > 0.0 { "end" } else { "largest" },
        2.0 * RADIUS_M,
    )
}

/// Two bonded spheres of 1 mm rotate about the point midway between them. Without damping, they
/// oscillate about the elongation at which the bond holds them on their circle, up to twice that.
/// With damping, they reach it, and the dashpot along the bond carries nothing. That state is known
/// in closed form as leapfrog steps it: a rotation by theta in each step needs the force
/// 2 (1 - cos theta) m r/dt^2 and has the angular momentum m r^2 sin(theta)/dt about the centre.
/// The spheres turn by theta as well, with the speed r theta/dt at the contact point, and the shear
/// spring holds against the dashpot of the difference. Of the force of that dashpot in the last
/// step, with which weak damping predicts the velocities, the part sin(theta) has turned into the
/// bond: c_n dt/m of it is what the dashpot along the bond carries of the load.
pub(crate) fn spin() -> Result<Vec<Member>> {
    let (radius_m, young_pa, spin_rad_s) = (RADIUS_M, YOUNG_PA, SPIN_RAD_S);
    let mass_kg = DENSITY_KG_M3 * 4.0 / 3.0 * PI * radius_m.powi(3);
    let own_kg_m2 = 0.4 * mass_kg * radius_m.powi(2);
    let length_m = 2.0 * radius_m;
    let shape = BondShape {
        length_m,
        radius_m,
        end_radii_m: [radius_m; 2],
    };
    let answer = stiffness(BondModel::Timoshenko, &shape, young_pa, 0.25);
    let step_s =
        0.25 * frequencies(&answer, [1.0 / mass_kg; 2], [1.0 / own_kg_m2; 2]).critical_step_s();
    // The elongation of that rotation, which slows down as the moment of inertia grows.
    let turned = (2.0 * own_kg_m2 + 0.5 * mass_kg * length_m.powi(2)) * spin_rad_s * step_s;
    let (mut stretch_m, mut theta) = (0.0, spin_rad_s * step_s);
    for _ in 0..100 {
        let radius_m = 0.5 * (length_m + stretch_m);
        let orbit = 2.0 * mass_kg * radius_m.powi(2) * theta.sin();
        theta *= turned / (2.0 * own_kg_m2 * theta + orbit);
        let pull_n = mass_kg * radius_m * (2.0 * (0.5 * theta).sin() / step_s).powi(2);
        stretch_m = pull_n / answer.normal;
    }
    let strain = stretch_m / length_m;
    let reduced = ReducedInertia {
        mass_kg: 0.5 * mass_kg,
        inertia_kg_m2: 0.5 * own_kg_m2,
    };
    let slip_m_s = (length_m + stretch_m) * (theta - theta.sin()) / step_s;
    // A rotation of w dt in a step: stepping along a circle has errors of the order of its square.
    let turn = spin_rad_s * step_s;
    let member = |eta: f64| {
        let scene = spinning_pair(eta, step_s);
        let dashpots = Chen { damping_ratio: eta }.coefficients(&answer, &reduced);
        let shear_n_s_m = dashpots.shear;
        let turned_n = shear_n_s_m * slip_m_s * theta.sin();
        let carried_n = dashpots.normal * step_s / mass_kg * turned_n;
        let at_rest_j = 0.5 * answer.normal * stretch_m.powi(2);
        let sheared_j = 0.5 * (shear_n_s_m * slip_m_s).powi(2) / answer.shear;
        let carried_j = carried_n * stretch_m;
        let stored = if eta > 0.0 {
            // In a step of this length the dashpot of shear takes up to a third less than its
            // coefficient says. The angular momentum has a rounding error in each step, and the
            // energy grows with its fourth power.
            let rounding_j = 4.0 * STEPS * f64::EPSILON * at_rest_j;
            Shown::measure(
                "elastic_energy",
                "J",
                at_rest_j - carried_j + sheared_j,
                (carried_j + sheared_j) / 3.0 + rounding_j,
            )
        } else {
            // An oscillation of twice the elongation has an error of that fraction of the length,
            // and a row of the time series can miss its peak.
            Shown::measure(
                "elastic_energy",
                "J",
                4.0 * at_rest_j,
                (10.0 * strain + 1e-3) * 4.0 * at_rest_j,
            )
        };
        Member::ends(
            if eta > 0.0 { "damped" } else { "undamped" },
            Trial::of(scene),
            vec![
                stored,
                // Each step has rounding errors.
                Shown::at_most(Quantity::AngularMomentumError, STEPS * f64::EPSILON),
                Shown::at_most(Quantity::EnergyError, turn.powi(2)),
            ],
        )
    };
    Ok(vec![member(0.0), member(0.1)])
}

/// Large soft spheres under their own weight for a day, so that a step is some milliseconds: one,
/// with the overlap of Hertz; and a tetrahedron on a slope, bonded and as a clump, held by
/// friction. Its position after a day is predicted from that after an hour.
pub(crate) fn rest(interrupted: &AtomicBool) -> Result<Vec<Member>> {
    let (radius_m, density, young_pa, g) = (20.0_f64, 2000.0, 1.5e7, 9.81);
    let scene = |end_s: f64, gravity: &str, body: &str| {
        format!(
            "version = 1
run = {{ end_time = {end_s:e}, time_step = {REST_STEP_S}, gravity = {gravity} }}
materials.m = {{ density = {density}, young_modulus = {young_pa:e}, poisson_ratio = 0.3 }}
contacts.m-m = {{ restitution = 0.3, friction = 0.6 }}
bonds.m = {{ young_modulus = {young_pa:e}, poisson_ratio = 0.3, damping = {{ damping_ratio = 0.3 }} }}
walls.floor = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"m\" }}
measures.height = {{ quantity = \"position_z\" }}
measures.way = {{ quantity = \"position_x\" }}
{body}"
        )
    };
    let mass_kg = density * 4.0 / 3.0 * PI * radius_m.powi(3);
    let reduced_pa = young_pa / (2.0 * (1.0 - 0.3 * 0.3));
    let overlap_m = (mass_kg * g / (4.0 / 3.0 * reduced_pa * radius_m.sqrt())).powf(2.0 / 3.0);
    let ball = format!(
        "bodies.ball = {{ particles = [[0, 0, {radius_m}, {radius_m}]], material = \"m\" }}\n"
    );
    // Equilibrium of forces, except for the rounding of the position.
    let rounding_m = 100.0 * f64::EPSILON * radius_m;
    // Every step rounds every coordinate once.
    let grown_m = DAY / REST_STEP_S * f64::EPSILON * 4.0 * radius_m;
    let mut members = vec![Member::ends(
        "a sphere",
        Trial::of(scene(DAY, &format!("[0, 0, {}]", -g), &ball)),
        vec![
            Shown::measure("height", "m", radius_m - overlap_m, rounding_m),
            Shown::measure("way", "m", 0.0, 0.0),
        ],
    )];
    let (sine, cosine) = 15.0_f64.to_radians().sin_cos();
    let slope = format!("[{}, 0, {}]", g * sine, -g * cosine);
    let side = 2.0 * radius_m;
    let rows = [
        [0.0, 0.0, radius_m],
        [side, 0.0, radius_m],
        [0.5 * side, side * 0.75_f64.sqrt(), radius_m],
        [
            0.5 * side,
            side * (1.0 / 12.0_f64).sqrt(),
            radius_m + side * (2.0 / 3.0_f64).sqrt(),
        ],
    ];
    let spheres: Vec<String> = rows
        .iter()
        .map(|[x, y, z]| format!("[{x:e}, {y:e}, {z:e}, {radius_m}]"))
        .collect();
    for start_as in ["bonded", "clump"] {
        let body = format!(
            "[bodies.stone]
particles = [{}]
bond_list = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
material = \"m\"
bonds = \"m\"
start_as = \"{start_as}\"
",
            spheres.join(", ")
        );
        let hour = Trial::of(scene(HOUR, &slope, &body)).run(interrupted)?;
        let Outcome::Ended(hour) = hour else {
            continue;
        };
        let of = |name: &'static str| {
            let value = Quantity::Measure(name).of(&hour);
            Shown::measure(name, "m", value, grown_m)
        };
        members.push(Member::ends(
            format!("a tetrahedron on a slope of 15 degrees, {start_as}"),
            Trial::of(scene(DAY, &slope, &body)),
            vec![of("height"), of("way")],
        ));
    }
    Ok(members)
}
