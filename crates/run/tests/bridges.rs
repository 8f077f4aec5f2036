//! Liquid bridges: closed forms, ruptures, energies, and what else of the program must know them.

mod bodies;
mod cloud;
mod law;
mod pairs;
mod swapped;
mod walls;

use dem_engine::state::State;
use dem_engine::state::bridges::Bridges;
use dem_physics::contact::liquid_bridge::LiquidBridge;

use crate::helpers::{started, step_and_balance};

/// Water on glass.
pub(crate) const WATER: LiquidBridge = LiquidBridge {
    surface_tension_n_m: 0.073,
    contact_angle_rad: 0.3,
    volume_m3: 1e-12,
};
/// Radius of all spheres, m.
pub(crate) const RADIUS_M: f64 = 1e-3;
/// Density of all spheres, kg/m3.
pub(crate) const DENSITY_KG_M3: f64 = 2500.0;

/// The head of a scene of wet glass with this restitution.
pub(crate) fn head(end_s: f64, restitution: f64, more: &str) -> String {
    format!(
        "version = 1
run = {{ end_time = {end_s:e}, {more} }}
materials.glass = {{ density = {DENSITY_KG_M3}, young_modulus = 1e8, poisson_ratio = 0.25 }}
[contacts.glass-glass]
restitution = {restitution}
friction = 0.3
liquid_bridge = {{ surface_tension = \"73 mN/m\", contact_angle = 0.3, volume = \"1e-3 mm3\" }}
"
    )
}

/// A sphere with its centre at this place and with this velocity, m/s.
pub(crate) fn ball(name: &str, place_m: [f64; 3], velocity_m_s: [f64; 3]) -> String {
    let [x, y, z] = place_m;
    format!(
        "[bodies.{name}]\nmaterial = \"glass\"\nparticles = [[{x:e}, {y:e}, {z:e}, {RADIUS_M:e}]]\nvelocity = {velocity_m_s:?}\n"
    )
}

pub(crate) fn bridges(state: &State) -> &Bridges {
    state.bridges.as_ref().unwrap()
}

/// Mass of a sphere, kg.
pub(crate) fn mass_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M.powi(3)
}

#[track_caller]
pub(crate) fn assert_near(found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found - wanted).abs() <= tolerance * wanted.abs(),
        "{found:e} instead of {wanted:e}: {:e}",
        found / wanted - 1.0
    );
}
