//! Fine spheres that adhesion holds on a wall: contact law `dmt`.
//!
//! The attraction F = 2 pi w R balances Hertz's force k d^(3/2), with k = 4/3 E* sqrt(R), at the
//! overlap d_0 = (F/k)^(2/3). At the first touch the elastic energy is 0, and F d_0 is what it
//! takes to compare an impact with.

use std::f64::consts::PI;

use super::prediction::{Member, Shown};
use super::trial::Trial;

/// Kinetic energy over F d_0 of a sphere that sticks: less than the 0.6 that separate d_0 from the
/// end of the contact.
const SLOW: f64 = 0.1;
/// Largest overlap over d_0 of a sphere that rebounds, by Hertz alone.
const DEEP: f64 = 10.0;
/// Duration of an elastic impact times speed over largest overlap (Johnson 1985, section 11.4).
const DURATION: f64 = 2.943_275_4;
/// Least number of steps in an impact.
const STEPS: f64 = 10.0;
/// Tolerance of the speed after an elastic impact: that of the case `impact`.
const SPEED: f64 = 2e-3;
/// Tolerance of the place at rest over d_0: what is left of the motion after `PERIODS`.
const PLACE: f64 = 1e-6;
const PERIODS: f64 = 40.0;

/// A sphere of 1 GPa above a wall of the same.
struct Grain {
    radius_m: f64,
    work_j_m2: f64,
}

impl Grain {
    fn mass_kg(&self) -> f64 {
        2500.0 * 4.0 / 3.0 * PI * self.radius_m.powi(3)
    }

    fn attraction_n(&self) -> f64 {
        2.0 * PI * self.work_j_m2 * self.radius_m
    }

    /// k, N/m^1.5.
    fn hertz(&self) -> f64 {
        4.0 / 3.0 * 1e9 / (2.0 * (1.0 - 0.3 * 0.3)) * self.radius_m.sqrt()
    }

    /// d_0, m.
    fn at_rest_m(&self) -> f64 {
        (self.attraction_n() / self.hertz()).powf(2.0 / 3.0)
    }

    /// Arrives at this speed, m/s, and is observed for this time after it, s.
    fn member(
        &self,
        what: &str,
        restitution: f64,
        speed_m_s: f64,
        then_s: f64,
        shown: Shown,
    ) -> Member {
        let gap_m = 0.1 * self.at_rest_m();
        let end_s = gap_m / speed_m_s + then_s;
        let text = format!(
            "version = 1
run.end_time = {end_s:e}
materials.m = {{ density = 2500, young_modulus = 1e9, poisson_ratio = 0.3 }}
contacts.m-m = {{ law = \"dmt\", work_of_adhesion = {:e}, restitution = {restitution} }}
bodies.ball = {{ particles = [[0, 0, {:e}, {:e}]], material = \"m\", velocity = [0, 0, {:e}] }}
walls.floor = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"m\" }}
measures.speed = {{ of = \"ball\", quantity = \"velocity_z\" }}
measures.place = {{ of = \"ball\", quantity = \"position_z\" }}
output = {{ series = {end_s:e} }}
",
            self.work_j_m2,
            self.radius_m + gap_m,
            self.radius_m,
            -speed_m_s
        );
        let (radius_m, work) = (self.radius_m, self.work_j_m2);
        Member::ends(
            format!("{radius_m:e} m, {work:e} J/m2, {what}"),
            Trial::of(text),
            vec![shown],
        )
    }

    /// A slow sphere comes to rest at d_0.
    fn sticks(&self) -> Member {
        let rest_m = self.at_rest_m();
        let speed_m_s = (2.0 * SLOW * self.attraction_n() * rest_m / self.mass_kg()).sqrt();
        let stiffness = 1.5 * self.hertz() * rest_m.sqrt();
        let period_s = 2.0 * PI * (self.mass_kg() / stiffness).sqrt();
        let place = Shown::measure("place", "m", self.radius_m - rest_m, PLACE * rest_m);
        self.member("sticks", 0.3, speed_m_s, PERIODS * period_s, place)
    }

    /// A fast one that loses nothing leaves as fast as it came: the attraction takes back what it
    /// gave. It acts from the first step in which the ends touch to the last, each by up to a step
    /// too long or too short.
    fn rebounds(&self) -> Member {
        let deepest_m = DEEP * self.at_rest_m();
        let speed_m_s = (0.8 * self.hertz() * deepest_m.powf(2.5) / self.mass_kg()).sqrt();
        let duration_s = DURATION * deepest_m / speed_m_s;
        let by_a_step = self.attraction_n() / self.mass_kg() * duration_s / STEPS;
        let speed = Shown::measure("speed", "m/s", speed_m_s, SPEED * speed_m_s + by_a_step);
        self.member("rebounds", 1.0, speed_m_s, 3.0 * duration_s, speed)
    }
}

/// Grains of 1 um to 1 cm.
pub(crate) fn grains() -> Vec<Member> {
    let mut members = Vec::new();
    for radius_m in [1e-6, 1e-4, 1e-2] {
        for work_j_m2 in [1e-3, 0.1] {
            let grain = Grain {
                radius_m,
                work_j_m2,
            };
            members.push(grain.sticks());
            members.push(grain.rebounds());
        }
    }
    members
}
