//! Spheres that hit a wet wall: a liquid bridge holds them or lets them go.

use std::f64::consts::PI;

use super::prediction::{Member, Shown};
use super::trial::Trial;
use dem_physics::contact::liquid_bridge::LiquidBridge;

/// Young's modulus, Pa, and density, kg/m3, of sphere and wall.
const YOUNG_PA: f64 = 1e11;
const DENSITY_KG_M3: f64 = 2500.0;
/// Duration of an elastic impact times speed over largest overlap (Johnson 1985, section 11.4).
const DURATION: f64 = 2.943_275_4;
/// Least number of steps in an impact.
const STEPS: f64 = 10.0;
/// Tolerance of the energy after an elastic impact: twice that of the speed in the case `impact`.
const ENERGY: f64 = 4e-3;

/// A sphere and the liquid between it and a wall.
struct Drop {
    radius_m: f64,
    /// Volume of the bridge over the cube of the radius.
    volume: f64,
}

impl Drop {
    fn bridge(&self) -> LiquidBridge {
        LiquidBridge {
            surface_tension_n_m: 0.073,
            contact_angle_rad: 0.0,
            volume_m3: self.volume * self.radius_m.powi(3),
        }
    }

    fn mass_kg(&self) -> f64 {
        DENSITY_KG_M3 * 4.0 / 3.0 * PI * self.radius_m.powi(3)
    }

    /// Speed at which the kinetic energy is the work of the bridge, m/s.
    fn critical_m_s(&self) -> f64 {
        (2.0 * self.bridge().work_j(self.radius_m) / self.mass_kg()).sqrt()
    }

    /// What the energy after an impact at this speed, m/s, may be off by, J: the error of the
    /// impact, and the pull over a step, as it begins and ends within one.
    fn energy_j(&self, speed_m_s: f64) -> f64 {
        let modulus_pa = YOUNG_PA / (2.0 * (1.0 - 0.3 * 0.3));
        let hertz = 4.0 / 3.0 * modulus_pa * self.radius_m.sqrt();
        let (mass_kg, pull_n) = (self.mass_kg(), self.bridge().largest_n(self.radius_m));
        let by_speed_m = (1.25 * mass_kg * speed_m_s * speed_m_s / hertz).powf(0.4);
        let by_pull_m = (2.5 * pull_n / hertz).powf(2.0 / 3.0);
        let step_m = DURATION * (by_speed_m + by_pull_m) / STEPS;
        ENERGY * 0.5 * mass_kg * speed_m_s * speed_m_s + pull_n * step_m
    }

    /// Arrives at this share of the critical speed and loses nothing to the impact.
    fn member(&self, share: f64, measure: &str, travel_m: f64, shown: Shown) -> Member {
        let (radius_m, volume_m3) = (self.radius_m, self.bridge().volume_m3);
        let speed_m_s = share * self.critical_m_s();
        let gap_m = 1e-3 * self.bridge().rupture_m();
        let end_s = travel_m / speed_m_s;
        let text = format!(
            "version = 1
run.end_time = {end_s:e}
materials.m = {{ density = {DENSITY_KG_M3}, young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3 }}
contacts.m-m = {{ restitution = 1, liquid_bridge = {{ surface_tension = \"73 mN/m\", volume = {volume_m3:e} }} }}
bodies.ball = {{ particles = [[0, 0, {:e}, {radius_m:e}]], material = \"m\", velocity = [0, 0, {:e}] }}
walls.floor = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"m\" }}
{measure}
",
            radius_m + gap_m,
            -speed_m_s
        );
        Member::ends(
            format!(
                "{radius_m:e} m, V/R^3 {:e}, {share} of the critical speed",
                self.volume
            ),
            Trial::of(text),
            vec![shown],
        )
    }

    /// Faster than the critical speed, it leaves with the rest of its energy.
    fn leaves(&self, share: f64) -> Member {
        let speed_m_s = (share * share - 1.0).sqrt() * self.critical_m_s();
        let permitted_m_s =
            self.energy_j(share * self.critical_m_s()) / (self.mass_kg() * speed_m_s);
        let measure = "measures.speed = { of = \"ball\", quantity = \"velocity_z\" }";
        let shown = Shown::measure("speed", "m/s", speed_m_s, permitted_m_s);
        let travel_m = 3.0 * self.bridge().rupture_m() * share / (share * share - 1.0).sqrt();
        self.member(share, measure, travel_m, shown)
    }

    /// Slower, it turns where the bridge has taken its energy.
    fn stays(&self, share: f64) -> Member {
        let (bridge, radius_m) = (self.bridge(), self.radius_m);
        let energy_j = share * share * bridge.work_j(radius_m);
        let [mut low_m, mut high_m] = [0.0, bridge.rupture_m()];
        for _ in 0..100 {
            let middle_m = 0.5 * (low_m + high_m);
            if bridge.energy_j(middle_m, radius_m) < energy_j {
                low_m = middle_m;
            } else {
                high_m = middle_m;
            }
        }
        let permitted_m =
            self.energy_j(share * self.critical_m_s()) / bridge.force_n(low_m, radius_m);
        let measure = "measures.height = { of = \"ball\", quantity = \"position_z\", statistic = \"largest\" }";
        let shown = Shown::measure("height", "m", radius_m + low_m, permitted_m);
        self.member(share, measure, 6.0 * low_m, shown)
    }
}

/// Spheres of 0.1 mm to 1 cm with little and with much liquid.
pub(crate) fn drops() -> Vec<Member> {
    let mut members = Vec::new();
    for radius_m in [1e-4, 1e-3, 1e-2] {
        for volume in [1e-6, 1e-3] {
            let drop = Drop { radius_m, volume };
            members.push(drop.stays(0.9));
            members.push(drop.leaves(1.1));
        }
    }
    members
}
