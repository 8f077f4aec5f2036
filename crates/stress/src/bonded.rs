//! Scenes of bonded spheres: two that fly apart, and a row that rattles.

use std::f64::consts::PI;

use super::prediction::{Member, Quantity, Shown};
use super::trial::Trial;

/// Radius of spheres and bonds, m.
pub(super) const RADIUS_M: f64 = 1e-3;
/// kg/m3
const DENSITY: f64 = 2500.0;
/// Strength over Young's modulus of the bond of a pair.
pub(super) const STRAIN: f64 = 1e-6;
/// Energy error that the verdict of a run permits.
const ENERGY_ERROR: f64 = 0.01;
/// Spheres in a row.
const ROW: u32 = 7;

/// Mass of a sphere, kg.
pub(super) fn mass_kg() -> f64 {
    DENSITY * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

/// Two spheres that fly apart with this speed each, m/s, for the first time of `times_s`, with a
/// step of the second, s. `bonds`: keys of their bond; `measures`: lines of the scene.
pub(super) fn flying_apart(
    times_s: [f64; 2],
    bonds: &str,
    speed_m_s: f64,
    measures: &str,
) -> Trial {
    let [end_s, step_s] = times_s;
    let length_m = 2.0 * RADIUS_M;
    Trial::of(format!(
        "version = 1
run = {{ end_time = {end_s:e}, time_step = {step_s:e} }}
materials.rock.density = {DENSITY}
bonds.rock = {{ poisson_ratio = 0.25, {bonds} }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M}], [{length_m}, 0, 0, {RADIUS_M}]], bond_list = [[0, 1]], material = \"rock\", bonds = \"rock\" }}
groups.left.particles = [0]
groups.right.particles = [1]
initial.left = {{ group = \"left\", velocity = [-{speed_m_s:e}, 0, 0] }}
initial.right = {{ group = \"right\", velocity = [{speed_m_s:e}, 0, 0] }}
{measures}
"
    ))
}

/// A row that vibrates at half of the limit, bonds of 1 GPa with these keys. `motion`: velocity
/// along and across, m/s, and spin about both axes, rad/s, of the sphere at a phase, which goes
/// from 0 to pi along the row.
pub(super) fn rattling(
    end_time: &str,
    bonds: &str,
    motion: impl Fn(f64) -> [f64; 3],
    measures: &str,
) -> Trial {
    let spheres: Vec<String> = (0..ROW)
        .map(|i| format!("[{}, 0, 0, {RADIUS_M}]", 2e-3 * f64::from(i)))
        .collect();
    let pairs: Vec<String> = (1..ROW).map(|i| format!("[{}, {i}]", i - 1)).collect();
    let mut scene = format!(
        "version = 1
run = {{ end_time = \"{end_time}\", safety_factor = 0.5 }}
materials.rock.density = {DENSITY}
bonds.rock = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25, {bonds} }}
bodies.row = {{ particles = [{}], bond_list = [{}], material = \"rock\", bonds = \"rock\" }}
{measures}
",
        spheres.join(", "),
        pairs.join(", ")
    );
    for i in 0..ROW {
        let [x, y, spin] = motion(PI * f64::from(i) / f64::from(ROW - 1));
        scene += &format!(
            "groups.g{i}.particles = [{i}]\ninitial.i{i} = {{ group = \"g{i}\", velocity = [{x}, {y}, 0], angular_velocity = [{spin}, 0, {spin}] }}\n"
        );
    }
    Trial::of(scene)
}

/// The row of [`rattling`], with an energy as good as the verdict of a run asks for.
pub(super) fn row(trial: Trial, more: impl IntoIterator<Item = Shown>) -> Member {
    let mut shown = vec![Shown::at_most(Quantity::EnergyError, ENERGY_ERROR)];
    shown.extend(more);
    Member::ends("row at half of the limit", trial, shown)
}

/// Momenta that nothing changes.
pub(super) fn momenta_stay() -> [Shown; 2] {
    [Quantity::MomentumError, Quantity::AngularMomentumError]
        .map(|error| Shown::at_most(error, 1e-9))
}
