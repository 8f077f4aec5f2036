//! Impacts of a ball on a wall or another ball: head-on and oblique.

use std::f64::consts::PI;

use dem_run::{State, step};
use nalgebra::Vector3;

use super::ball::{DENSITY_KG_M3, POISSON, RADIUS_M, YOUNG_PA, mass_kg};
use crate::verification::scene::{place, planned, spin, started, velocity};
use crate::verification::table::{Case, compared};

/// Stiffness of the linear law.
const STIFFNESS_N_M: f64 = 1e5;

/// Number of steps in an elastic impact.
const STEPS: f64 = 1000.0;

/// Duration of an elastic impact of Hertz's law over largest overlap and speed: the integral of
/// dx/sqrt(1 - x^(5/2)) from 0 to 1, twice.
const HERTZ_DURATION: f64 = 2.943_275_184_324_704;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    Hertz,
    Linear,
}

/// A ball that hits a rigid wall, or another equal ball.
#[derive(Debug, Clone, Copy)]
struct Impact {
    law: Law,
    pair: bool,
    restitution: f64,
    friction: f64,
    /// Velocity of the ball relative to the other object: tangential and normal, m/s.
    velocity_m_s: [f64; 2],
}

/// Result of an impact.
#[derive(Debug, Clone, Copy)]
struct Rebound {
    /// Tangential and normal, m/s.
    velocity_m_s: [f64; 2],
    spin_rad_s: f64,
    duration_s: f64,
    overlap_m: f64,
}

impl Law {
    fn name(self) -> &'static str {
        match self {
            Self::Hertz => "Hertz-Mindlin",
            Self::Linear => "linear",
        }
    }
}

impl Impact {
    fn head_on(law: Law, pair: bool, restitution: f64, speed_m_s: f64) -> Self {
        Self {
            law,
            pair,
            restitution,
            friction: 0.0,
            velocity_m_s: [0.0, speed_m_s],
        }
    }

    fn effective_radius_m(&self) -> f64 {
        if self.pair { 0.5 * RADIUS_M } else { RADIUS_M }
    }

    fn effective_mass_kg(&self) -> f64 {
        if self.pair {
            0.5 * mass_kg()
        } else {
            mass_kg()
        }
    }

    fn effective_young_pa(&self) -> f64 {
        YOUNG_PA / (1.0 - POISSON * POISSON) / if self.pair { 2.0 } else { 1.0 }
    }

    /// Largest overlap without damping, m.
    fn overlap_m(&self) -> f64 {
        let (mass, speed) = (self.effective_mass_kg(), self.velocity_m_s[1]);
        match self.law {
            Law::Hertz => {
                let stiffness = self.effective_young_pa() * self.effective_radius_m().sqrt();
                (15.0 * mass * speed * speed / (16.0 * stiffness)).powf(0.4)
            }
            Law::Linear => speed * (mass / STIFFNESS_N_M).sqrt(),
        }
    }

    /// Duration without damping, s.
    fn duration_s(&self) -> f64 {
        match self.law {
            Law::Hertz => HERTZ_DURATION * self.overlap_m() / self.velocity_m_s[1],
            Law::Linear => PI * (self.effective_mass_kg() / STIFFNESS_N_M).sqrt(),
        }
    }

    /// The ball at the distance that it covers in `away` seconds, with this time step.
    fn scene(&self, time_step: &str, away_s: f64) -> String {
        let law = match self.law {
            Law::Hertz => "law = \"hertz-mindlin\"".to_owned(),
            Law::Linear => format!("law = \"linear\", normal_stiffness = {STIFFNESS_N_M:e}"),
        };
        let (restitution, friction) = (self.restitution, self.friction);
        let [across, along] = self.velocity_m_s;
        let height = RADIUS_M + along * away_s;
        let other = if self.pair {
            format!(
                "bodies.other = {{ particles = [[0, 0, {:e}, {RADIUS_M:e}]], material = \"ball\" }}",
                -RADIUS_M
            )
        } else {
            "walls.ground = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"rigid\" }"
                .to_owned()
        };
        format!(
            r#"
            version = 1
            run = {{ end_time = "1 s", time_step = {time_step} }}
            materials.ball = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
            materials.rigid = {{ rigid = true }}
            contacts.ball-ball = {{ {law}, restitution = {restitution:e}, friction = {friction:e} }}
            contacts.ball-rigid = {{ {law}, restitution = {restitution:e}, friction = {friction:e} }}
            bodies.ball = {{ particles = [[0, 0, {height:e}, {RADIUS_M:e}]], material = "ball", velocity = [{across:e}, 0, {:e}] }}
            {other}
            "#,
            -along
        )
    }

    /// Runs until the ends separate. They meet in the middle of a step; the time of separation
    /// within its step is found by linear interpolation.
    fn run(&self, steps: f64) -> Rebound {
        let step_s = self.duration_s() / steps;
        self.run_from(&mut started(
            &self.scene(&format!("{step_s:e}"), 2.5 * step_s),
        ))
    }

    /// The same with the time step chosen by the solver, where the ends meet after this number of
    /// steps.
    fn run_as_planned(&self, after_steps: f64) -> Rebound {
        let step_s = planned(&self.scene("\"auto\"", 0.0)).step.step_s;
        let mut state = started(&self.scene("\"auto\"", after_steps * step_s));
        self.run_from(&mut state)
    }

    fn run_from(&self, state: &mut State) -> Rebound {
        let overlap = |state: &State| {
            let apart = if self.pair {
                (place(state, 0) - place(state, 1)).norm() - RADIUS_M
            } else {
                place(state, 0).z
            };
            RADIUS_M - apart
        };
        let met_s = -overlap(state) / self.velocity_m_s[1];
        let (mut before, mut largest) = (overlap(state), 0.0_f64);
        loop {
            step(state);
            let now = overlap(state);
            largest = largest.max(now);
            if before > 0.0 && now <= 0.0 {
                let parted_s = state.time_s - state.time_step_s * now / (now - before);
                // Another step, so that velocities are those after the last force.
                step(state);
                let other = if self.pair {
                    velocity(state, 1)
                } else {
                    Vector3::zeros()
                };
                let velocity = velocity(state, 0) - other;
                return Rebound {
                    velocity_m_s: [velocity.x, velocity.z],
                    spin_rad_s: spin(state, 0).y,
                    duration_s: parted_s - met_s,
                    overlap_m: largest,
                };
            }
            before = now;
        }
    }
}
/// The other object of an impact.
fn other(pair: bool) -> &'static str {
    if pair {
        "ball and ball"
    } else {
        "ball and wall"
    }
}

/// Elastic impacts: duration and largest overlap. Leapfrog is of second order, with the duration as
/// half a period.
pub(crate) fn elastic() -> [String; 3] {
    let bound = (PI / STEPS).powi(2);
    let mut tables = [Vec::new(), Vec::new(), Vec::new()];
    for law in [Law::Hertz, Law::Linear] {
        for pair in [false, true] {
            for speed in [0.01, 0.1, 1.0] {
                let impact = Impact::head_on(law, pair, 1.0, speed);
                let found = impact.run(STEPS);
                let what = format!("{}, {}, {speed} m/s", law.name(), other(pair));
                let of = [
                    (1e6 * found.duration_s, 1e6 * impact.duration_s()),
                    (1e6 * found.overlap_m, 1e6 * impact.overlap_m()),
                    (found.velocity_m_s[1], speed),
                ];
                for (table, (found, wanted)) in tables.iter_mut().zip(of) {
                    table.push(Case::new(what.clone(), found, wanted, bound));
                }
            }
        }
    }
    let [durations, overlaps, speeds] = tables;
    [
        compared("elastic impact", "us", &durations),
        compared("elastic impact", "um", &overlaps),
        compared("elastic impact", "m/s", &speeds),
    ]
}

/// Damping ratio for a restitution, by bisection of the closed form of `doc/inside/contacts.md`.
pub(crate) fn damping_ratio(restitution: f64) -> f64 {
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..100 {
        let zeta: f64 = 0.5 * (low + high);
        let angle = if zeta < 1.0 {
            zeta.acos() / (1.0 - zeta * zeta).sqrt()
        } else {
            zeta.acosh() / (zeta * zeta - 1.0).sqrt()
        };
        if (-2.0 * zeta * angle).exp() > restitution {
            low = zeta;
        } else {
            high = zeta;
        }
    }
    low
}

/// Bound of the restitution error. That of the linear law is of second order in the step over the
/// faster of the two times of a damped oscillation; Hertz's stiffness grows within a step, which
/// leaves a part of first order.
fn restitution_bound(law: Law, restitution: f64, fraction: f64) -> f64 {
    let zeta = damping_ratio(restitution);
    let fraction = fraction * (zeta + zeta.hypot(1.0));
    match law {
        Law::Hertz => fraction,
        Law::Linear => (PI * fraction).powi(2),
    }
}

/// Restitution at a small step.
pub(crate) fn restitution() -> String {
    let mut cases = Vec::new();
    for law in [Law::Hertz, Law::Linear] {
        for pair in [false, true] {
            for wanted in [0.9, 0.7, 0.5, 0.3, 0.1] {
                for speed in [0.01, 1.0] {
                    let found = Impact::head_on(law, pair, wanted, speed).run(STEPS);
                    let bound = restitution_bound(law, wanted, 1.0 / STEPS);
                    let what = format!("{}, {}, {speed} m/s", law.name(), other(pair));
                    cases.push(Case::new(
                        what,
                        found.velocity_m_s[1] / speed,
                        wanted,
                        bound,
                    ));
                }
            }
        }
    }
    compared("impact", "", &cases)
}

/// The same at the step chosen by the solver: the worst of twenty times within a step at which the
/// ends may meet.
pub(crate) fn restitution_as_planned() -> String {
    let mut cases = Vec::new();
    for law in [Law::Hertz, Law::Linear] {
        for wanted in [1.0, 0.9, 0.7, 0.5, 0.3, 0.1] {
            let impact = Impact::head_on(law, false, wanted, 1.0);
            let step_s = planned(&impact.scene("\"auto\"", 0.0)).step.step_s;
            let bound = match law {
                Law::Hertz => restitution_bound(law, wanted, step_s / impact.duration_s()),
                // The tolerance for which the step is chosen.
                Law::Linear => 0.01,
            };
            let moments = (0..20).map(|n| 2.0 + (f64::from(n) + 0.5) / 20.0);
            let found = moments.map(|moment| impact.run_as_planned(moment).velocity_m_s[1]);
            let worst = found.max_by(|a, b| (a - wanted).abs().total_cmp(&(b - wanted).abs()));
            cases.push(Case::new(law.name(), worst.unwrap(), wanted, bound));
        }
    }
    compared("impact", "", &cases)
}

/// Rebound of the Hertz-Mindlin law at restitution 1 by its equations, integrated step by step
/// without the solver: tangential velocity and spin.
fn integrated(impact: &Impact, steps: f64) -> [f64; 2] {
    let step_s = impact.duration_s() / steps;
    let mass = mass_kg();
    let shear_pa = YOUNG_PA / (2.0 * (1.0 + POISSON)) / (2.0 - POISSON);
    let [mut across, speed] = impact.velocity_m_s;
    let (mut along, mut overlap, mut spin) = (speed, 0.0_f64, 0.0);
    let (mut spring, mut stiffness_before) = (0.0, 0.0);
    loop {
        overlap += along * step_s;
        if overlap <= 0.0 {
            return [across, spin];
        }
        let root = (RADIUS_M * overlap).sqrt();
        let normal = 4.0 / 3.0 * impact.effective_young_pa() * root * overlap;
        let stiffness = 8.0 * shear_pa * root;
        let lever = RADIUS_M - 0.5 * overlap;
        // While the load increases the spring keeps its force, while it decreases its elongation.
        if stiffness > stiffness_before {
            spring *= stiffness_before / stiffness;
        }
        spring += (across - lever * spin) * step_s;
        let limit = impact.friction * normal / stiffness;
        spring = spring.clamp(-limit, limit);
        stiffness_before = stiffness;
        along -= normal / mass * step_s;
        across -= stiffness * spring / mass * step_s;
        spin += lever * stiffness * spring / (0.4 * mass * RADIUS_M * RADIUS_M) * step_s;
    }
}

/// Oblique impacts on a wall: tangential velocities and spins after them.
pub(crate) fn oblique() -> [String; 2] {
    let mut tables = [Vec::new(), Vec::new()];
    for angle in [5.0_f64, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 85.0] {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let impact = Impact {
            friction: 0.1,
            velocity_m_s: [sine, cosine].map(|part| 0.01 * part),
            ..Impact::head_on(Law::Hertz, false, 1.0, 0.0)
        };
        let found = impact.run(STEPS);
        let [across, along] = impact.velocity_m_s;
        let slides = across > 3.5 * 0.1 * 2.0 * along;
        // Relative error of the lever, for which the closed form uses the radius.
        let lever = 0.5 * impact.overlap_m() / RADIUS_M;
        let (what, wanted, bounds) = if slides {
            let pushed = 0.1 * 2.0 * along;
            let wanted = [across - pushed, 2.5 * pushed / RADIUS_M];
            (
                "slides: closed form",
                wanted,
                [1.0 / STEPS, 1.0 / STEPS + lever],
            )
        } else {
            (
                "sticks: integrated",
                integrated(&impact, 100.0 * STEPS),
                [1.0 / STEPS; 2],
            )
        };
        let what = format!("{angle}°, {what}");
        let found = [found.velocity_m_s[0], found.spin_rad_s];
        for (i, table) in tables.iter_mut().enumerate() {
            let scale = [across, 2.5 * across / RADIUS_M][i];
            table.push(Case::of_scale(
                what.clone(),
                [found[i], wanted[i]],
                scale,
                bounds[i],
            ));
        }
    }
    let [velocities, spins] = tables;
    [
        compared("angle to the normal", "m/s", &velocities),
        compared("angle to the normal", "rad/s", &spins),
    ]
}

/// The linear law without damping, where friction holds the ball throughout.
pub(crate) fn oblique_linear() -> String {
    let mut linear = Vec::new();
    for angle in [1.0_f64, 5.0, 10.0, 15.0] {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let impact = Impact {
            friction: 0.1,
            velocity_m_s: [sine, cosine].map(|part| 0.01 * part),
            ..Impact::head_on(Law::Linear, false, 1.0, 0.0)
        };
        let found = impact.run(STEPS).velocity_m_s[0];
        let wanted = 3.0 / 7.0 * impact.velocity_m_s[0];
        let bound = impact.overlap_m() / RADIUS_M + (PI / STEPS).powi(2);
        linear.push(Case::new(format!("{angle}°"), found, wanted, bound));
    }
    compared("angle to the normal", "m/s", &linear)
}
