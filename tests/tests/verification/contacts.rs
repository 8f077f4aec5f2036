//! Impacts, head-on and oblique, and rolling, compared with closed forms.

use std::f64::consts::PI;

use dem_run::{State, step};
use nalgebra::Vector3;

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::{place, planned, spin, started, velocity};
use super::table::{Case, compared};

const RADIUS_M: f64 = 0.01;
const DENSITY_KG_M3: f64 = 2500.0;
const YOUNG_PA: f64 = 70e6;
const POISSON: f64 = 0.25;
/// Stiffness of the linear law.
const STIFFNESS_N_M: f64 = 1e5;
const GRAVITY_M_S2: f64 = 9.81;

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

fn mass_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
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
fn elastic() -> [String; 3] {
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

/// Damping ratio for a restitution, by bisection of the closed form of `doc/contacts.md`.
fn damping_ratio(restitution: f64) -> f64 {
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
fn restitution() -> String {
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
fn restitution_as_planned() -> String {
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
fn oblique() -> [String; 2] {
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
fn oblique_linear() -> String {
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

/// A ball at rest on a plane, with the overlap due to its weight, under gravity rotated by `angle`.
fn on_plane(angle_rad: f64, friction: &str, velocity_m_s: f64, spin_rad_s: f64) -> State {
    let normal_n = mass_kg() * GRAVITY_M_S2 * angle_rad.cos();
    let young = YOUNG_PA / (1.0 - POISSON * POISSON);
    let overlap = (0.75 * normal_n / (young * RADIUS_M.sqrt())).powf(2.0 / 3.0);
    let [gx, gz] = [angle_rad.sin(), -angle_rad.cos()].map(|part| part * GRAVITY_M_S2);
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = "10 s", time_step = 1e-5, gravity = [{gx:e}, 0, {gz:e}], initial_overlap = "keep" }}
        materials.ball = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
        materials.rigid = {{ rigid = true }}
        contacts.ball-ball = {{ restitution = 0.3, {friction} }}
        contacts.ball-rigid = {{ restitution = 0.3, {friction} }}
        bodies.ball = {{ particles = [[0, 0, {:e}, {RADIUS_M:e}]], material = "ball", velocity = [{velocity_m_s:e}, 0, 0], angular_velocity = [0, {spin_rad_s:e}, 0] }}
        walls.ground = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = "rigid" }}
        "#,
        RADIUS_M - overlap
    ))
}

/// Ratio of overlap to radius of a ball on a plane: the relative reduction of its lever; for
/// friction and inertia twice that.
fn sunk() -> f64 {
    let young = YOUNG_PA / (1.0 - POISSON * POISSON);
    let force = mass_kg() * GRAVITY_M_S2;
    (0.75 * force / (young * RADIUS_M.sqrt())).powf(2.0 / 3.0) / RADIUS_M
}

fn until(state: &mut State, time_s: f64) {
    while state.time_s < time_s {
        step(state);
    }
}

/// Mean acceleration along x between two times, m/s2. Both velocities are those of half a step
/// before the state's time.
fn acceleration(state: &mut State, from_s: f64, to_s: f64) -> [f64; 2] {
    until(state, from_s);
    let (start_s, before) = (state.time_s, [velocity(state, 0).x, spin(state, 0).y]);
    until(state, to_s);
    let after = [velocity(state, 0).x, spin(state, 0).y];
    [0, 1].map(|k| (after[k] - before[k]) / (state.time_s - start_s))
}

/// From sliding to rolling.
fn sliding_to_rolling() -> String {
    let (friction, start) = (0.3, 1.0);
    let mut state = on_plane(0.0, "friction = 0.3", start, 0.0);
    let slip = |state: &State| velocity(state, 0).x - RADIUS_M * spin(state, 0).y;
    let (mut before, mut rolls) = (slip(&state), None);
    let rolls_s = 2.0 * start / (7.0 * friction * GRAVITY_M_S2);
    let mut x_m = 0.0;
    while state.time_s < 2.0 * rolls_s {
        step(&mut state);
        let now = slip(&state);
        if rolls.is_none() && now <= 0.0 {
            let part = now / (now - before);
            rolls = Some(state.time_s - state.time_step_s * (0.5 + part));
            x_m = place(&state, 0).x - velocity(&state, 0).x * state.time_step_s * (0.5 + part);
        }
        before = now;
    }
    let bound = sunk();
    let [speed, spin] = [velocity(&state, 0).x, spin(&state, 0).y];
    let energy = 0.5 * mass_kg() * (speed * speed + 0.4 * (RADIUS_M * spin).powi(2));
    let lost = 1.0 - energy / (0.5 * mass_kg() * start * start);
    compared(
        "from 1 m/s without spin, friction 0.3",
        "SI",
        &[
            Case::new("slides until, s", rolls.unwrap(), rolls_s, bound),
            Case::new(
                "distance, m",
                x_m,
                12.0 * start * start / (49.0 * friction * GRAVITY_M_S2),
                bound,
            ),
            Case::new("velocity then, m/s", speed, 5.0 / 7.0 * start, bound),
            Case::new(
                "spin then, rad/s",
                spin,
                5.0 / 7.0 * start / RADIUS_M,
                bound,
            ),
            Case::new("fraction of energy lost", lost, 2.0 / 7.0, bound),
        ],
    )
}

/// Accelerations on an incline, of a rolling or sliding ball.
fn incline() -> [String; 2] {
    let mut tables = [Vec::new(), Vec::new()];
    for degrees in [5.0_f64, 15.0, 30.0, 45.0, 50.0, 60.0] {
        let angle = degrees.to_radians();
        let mut state = on_plane(angle, "friction = 0.3", 0.0, 0.0);
        let found = acceleration(&mut state, 0.1, 0.3);
        let (rolling, what) = (angle.tan() < 3.5 * 0.3, format!("{degrees}°"));
        let (what, wanted) = if rolling {
            let along = 5.0 / 7.0 * GRAVITY_M_S2 * angle.sin();
            (what + ", rolls", [along, along / RADIUS_M])
        } else {
            let pull = GRAVITY_M_S2 * (angle.sin() - 0.3 * angle.cos());
            let turn = 2.5 * 0.3 * GRAVITY_M_S2 * angle.cos() / RADIUS_M;
            (what + ", slides", [pull, turn])
        };
        for (table, (found, wanted)) in tables.iter_mut().zip(found.into_iter().zip(wanted)) {
            table.push(Case::new(what.clone(), found, wanted, sunk()));
        }
    }
    let [along, turn] = tables;
    [
        compared("incline", "m/s2", &along),
        compared("incline", "rad/s2", &turn),
    ]
}

/// Rolling friction: deceleration of a ball on the flat and on an incline.
fn rolling_friction() -> String {
    let mut cases = Vec::new();
    for kind in ["constant-torque", "spring-dashpot"] {
        for coefficient in [0.01_f64, 0.05] {
            for degrees in [0.0_f64, 10.0] {
                let angle = degrees.to_radians();
                let friction = format!(
                    "friction = 0.5, rolling = \"{kind}\", rolling_friction = {coefficient:e}"
                );
                let mut state = on_plane(angle, &friction, 1.0, 1.0 / RADIUS_M);
                let [found, _] = acceleration(&mut state, 0.1, 0.3);
                let wanted = 5.0 / 7.0 * GRAVITY_M_S2 * (angle.sin() - coefficient * angle.cos());
                let what = format!("{kind}, {coefficient}, {degrees}°");
                cases.push(Case::new(what, found, wanted, sunk()));
            }
        }
    }
    compared("rolling friction, incline", "m/s2", &cases)
}

/// A ball that starts at rest on an incline on which rolling friction can hold it: with a spring it
/// stays, with a constant moment it creeps, which is not shown.
fn held() -> String {
    let cases = [1.0_f64, 2.0, 4.0].map(|degrees| {
        let angle = degrees.to_radians();
        let rolling = "rolling = \"spring-dashpot\", rolling_friction = 0.1";
        let mut state = on_plane(angle, &format!("friction = 0.5, {rolling}"), 0.0, 0.0);
        until(&mut state, 1.0);
        let free = 5.0 / 7.0 * GRAVITY_M_S2 * angle.sin();
        Case::of_scale(
            format!("{degrees}°"),
            [velocity(&state, 0).x, 0.0],
            free,
            1e-9,
        )
    });
    compared("incline", "m/s", &cases)
}

/// A fine sphere that sticks to a plate, without gravity. `overlap_m`: at the start; `more`: what
/// else the scene has; `motion`: of the plate.
fn sticking(work_j_m2: f64, overlap_m: f64, [motion, more]: [&str; 2]) -> State {
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = "0.1 us", initial_overlap = "keep" }}
        materials.powder = {{ density = {DENSITY_KG_M3:e}, young_modulus = {FINE_PA:e}, poisson_ratio = {POISSON} }}
        contacts.powder-powder = {{ law = "dmt", work_of_adhesion = {work_j_m2:e}, restitution = 0.1 }}
        bodies.ball = {{ particles = [[0, 0, {:e}, {FINE_M:e}]], material = "powder" }}
        walls.plate = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = "powder"{motion} }}
        {more}
        "#,
        FINE_M - overlap_m,
    ))
}

/// Radius, m, and Young's modulus, Pa, of a sphere that sticks.
const FINE_M: f64 = 1e-4;
const FINE_PA: f64 = 1e8;

/// The sphere comes to rest at the overlap at which Hertz's force is the attraction. Held there, it
/// is pulled with at most 2 pi w R by a plate that retreats.
fn adhesion() -> String {
    let hertz = 4.0 / 3.0 * FINE_PA / (2.0 * (1.0 - POISSON * POISSON)) * FINE_M.sqrt();
    let overlap_m = |state: &State| FINE_M - place(state, 0).z;
    let mut cases = Vec::new();
    for work_j_m2 in [5e-3, 0.05] {
        let force_n = 2.0 * PI * work_j_m2 * FINE_M;
        let wanted_m = (force_n / hertz).powf(2.0 / 3.0);
        let mut state = sticking(work_j_m2, 1e-9, ["", ""]);
        while state.time_s < 2e-3 {
            step(&mut state);
        }
        let name = format!("{} mJ/m2", 1e3 * work_j_m2);
        let rest = [overlap_m(&state), wanted_m].map(|x| 1e6 * x);
        let what = format!("{name}: overlap at rest, um");
        cases.push(Case::new(what, rest[0], rest[1], 1e-6));

        let motion = ", velocity = [0, 0, -1e-3]";
        let held = "supports.ball = { group = \"ball\", velocity.z = 0 }";
        let mut state = sticking(work_j_m2, wanted_m, [motion, held]);
        let mut largest_n = 0.0_f64;
        while state.time_s < 2.0 * wanted_m / 1e-3 {
            dem_run::step::interact(&mut state);
            largest_n = largest_n.max(-state.walls[0].total_load()[0][2]);
            dem_run::step::advance(&mut state);
        }
        // Hertz's force one step before the separation.
        let bound = hertz * 1e-10_f64.powf(1.5) / force_n;
        let pull = [largest_n, force_n].map(|x| 1e6 * x);
        let what = format!("{name}: pull-off force, uN");
        cases.push(Case::new(what, pull[0], pull[1], bound));
        for times in [1.0, 3.0] {
            let [found_n, wanted_n, bound] = parted(work_j_m2, times * FINE_M);
            let what = format!(
                "{name}: pull-off force from a sphere of {:.1} mm, uN",
                0.1 * times
            );
            cases.push(Case::new(what, 1e6 * found_n, 1e6 * wanted_n, bound));
        }
    }
    compared("work of adhesion", "", &cases)
}

/// Two spheres, one of them of this radius, m, are pulled apart from their overlap at rest at
/// 1 mm/s: the largest force, N, and that of the closed form with its bound.
fn parted(work_j_m2: f64, radius_m: f64) -> [f64; 3] {
    let effective_m = FINE_M * radius_m / (FINE_M + radius_m);
    let hertz = 4.0 / 3.0 * FINE_PA / (2.0 * (1.0 - POISSON * POISSON)) * effective_m.sqrt();
    let force_n = 2.0 * PI * work_j_m2 * effective_m;
    let rest_m = (force_n / hertz).powf(2.0 / 3.0);
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = 1e-7, initial_overlap = "keep" }}
        materials.powder = {{ density = 2500, young_modulus = {FINE_PA:e}, poisson_ratio = {POISSON} }}
        contacts.powder-powder = {{ law = "dmt", work_of_adhesion = {work_j_m2:e}, restitution = 0.1 }}
        bodies.ball = {{ particles = [[0, 0, 0, {FINE_M:e}]], material = "powder" }}
        bodies.other = {{ particles = [[{:e}, 0, 0, {radius_m:e}]], material = "powder" }}
        supports.ball = {{ group = "ball", fixed = true }}
        supports.other = {{ group = "other", fixed = ["y", "z", "rx", "ry", "rz"], velocity.x = 1e-3 }}
        "#,
        FINE_M + radius_m - rest_m
    ));
    let mut largest_n = 0.0_f64;
    while state.time_s < 2.0 * rest_m / 1e-3 {
        dem_run::step::interact(&mut state);
        largest_n = largest_n.max(-state.particles.wrenches[1].force_n[0]);
        dem_run::step::advance(&mut state);
    }
    // Hertz's force one step before the separation.
    [largest_n, force_n, hertz * 1e-10_f64.powf(1.5) / force_n]
}

/// A sphere of 1 mm is pulled from another, or from a wall, at 1 mm/s: the pull-off force, the gap
/// at rupture and the energy lost are those of the closed forms, to the movement in a step.
fn liquid_bridge() -> String {
    const RADIUS_M: f64 = 1e-3;
    const STEP_S: f64 = 5e-6;
    const SPEED_M_S: f64 = 1e-3;
    let mut cases = Vec::new();
    for degrees in [0.0_f64, 30.0] {
        let angle = degrees.to_radians();
        let rupture_m = (1.0 + 0.5 * angle) * 1e-4;
        // R of Derjaguin: that of two equal spheres; of a sphere and a wall twice that.
        for (what, derjaguin_m) in [("sphere", RADIUS_M), ("wall", 2.0 * RADIUS_M)] {
            let other = if what == "wall" {
                "walls.plate = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"glass\", velocity = [0, 0, -1e-3] }"
            } else {
                "bodies.other = { particles = [[0, 0, -1e-3, 1e-3]], material = \"glass\", velocity = [0, 0, -1e-3] }
                 supports.other = { group = \"other\", fixed = [\"x\", \"y\"], velocity.z = -1e-3 }"
            };
            let mut state = started(&format!(
                r#"
                version = 1
                run = {{ end_time = "1 s", time_step = {STEP_S:e}, initial_overlap = "keep" }}
                materials.glass = {{ density = 2500, young_modulus = "100 MPa" }}
                contacts.glass-glass = {{ restitution = 1, liquid_bridge = {{ surface_tension = "73 mN/m", contact_angle = "{degrees} deg", volume = "1e-3 mm3" }} }}
                bodies.ball = {{ particles = [[0, 0, {:e}, 1e-3]], material = "glass" }}
                supports.ball = {{ group = "ball", fixed = ["x", "y", "z"] }}
                {other}
                "#,
                RADIUS_M - 1e-9
            ));
            let (mut largest_n, mut gap_m) = (0.0_f64, 0.0_f64);
            while state.time_s < 1.1 * rupture_m / SPEED_M_S {
                dem_run::step::interact(&mut state);
                let down_n = -state.particles.wrenches[0].force_n[2];
                largest_n = largest_n.max(down_n);
                if down_n > 0.0 {
                    gap_m = SPEED_M_S * state.time_s;
                }
                dem_run::step::advance(&mut state);
            }
            let pull_n = 2.0 * PI * derjaguin_m * 0.073 * angle.cos();
            let scale_m = (1e-12 / derjaguin_m).sqrt();
            let x = rupture_m / scale_m;
            let root = 8.8975_f64.sqrt();
            let work_j = pull_n * scale_m * 2.0 / root * (root * x / (2.0 + 1.05 * x)).atan();
            let step_m = SPEED_M_S * STEP_S;
            let last_n = pull_n / (1.0 + 1.05 * x + 2.5 * x * x);
            let lost_j = state.bridges.as_ref().map_or(0.0, |bridges| bridges.lost_j);
            let name = format!("{what}, {degrees}°");
            let [found, wanted] = [largest_n, pull_n].map(|x| 1e6 * x);
            cases.push(Case::new(
                format!("{name}: pull-off force, uN"),
                found,
                wanted,
                1.05 * step_m / scale_m,
            ));
            let [found, wanted] = [gap_m, rupture_m].map(|x| 1e6 * x);
            cases.push(Case::new(
                format!("{name}: gap at rupture, um"),
                found,
                wanted,
                1.01 * step_m / rupture_m,
            ));
            let [found, wanted] = [lost_j, work_j].map(|x| 1e9 * x);
            let bound = (last_n * step_m + pull_n * 1e-9) / work_j;
            cases.push(Case::new(
                format!("{name}: energy lost, nJ"),
                found,
                wanted,
                bound,
            ));
        }
    }
    compared("liquid bridge", "", &cases)
}

/// Two bonded spheres that overlap are pressed and pulled by supports, at 1 mm/s, with the contact
/// beside their bond: in compression beyond the overlap at which they were bonded Hertz's force is
/// added to that of the bond, to the movement in a step.
fn beside_bond() -> String {
    const LENGTH_M: f64 = 1.9e-3;
    const STEP_S: f64 = 1e-6;
    let bond_n_m = 1e5 * PI * 1e-6 / LENGTH_M;
    let hertz = 4.0 / 3.0 * 1e6 / (2.0 * (1.0 - POISSON * POISSON)) * 0.5e-3_f64.sqrt();
    let cases = [10.0, 50.0, -50.0].map(|inwards_um| {
        let speed_m_s = -1e-3 * f64::signum(inwards_um);
        let mut state = started(&format!(
            r#"
            version = 1
            run = {{ end_time = "1 s", time_step = {STEP_S:e} }}
            relaxation.min_overlap = 0
            materials.m = {{ density = 2500, young_modulus = "1 MPa", poisson_ratio = {POISSON} }}
            contacts.m-m = {{ restitution = 1, friction = 0 }}
            bonds.b = {{ young_modulus = "0.1 MPa", poisson_ratio = {POISSON}, contact_beside_bond = true }}
            bodies.pair = {{ particles = [[0, 0, 0, 1e-3], [{LENGTH_M:e}, 0, 0, 1e-3]], bond_list = [[0, 1]], material = "m", bonds = "b" }}
            groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
            supports.left = {{ group = "left", fixed = true }}
            supports.right = {{ group = "right", velocity.x = {speed_m_s:e} }}
            "#,
        ));
        let inwards_m: f64 = 1e-6 * inwards_um;
        while state.time_s < inwards_m.abs() / 1e-3 - 0.5 * STEP_S {
            step(&mut state);
        }
        dem_run::step::interact(&mut state);
        let found_n = state.particles.wrenches[1].force_n[0];
        let wanted_n = bond_n_m * inwards_m + hertz * inwards_m.max(0.0).powf(1.5);
        let bound = 1.5 * 1e-3 * STEP_S / inwards_m.abs();
        let [found, wanted] = [found_n, wanted_n].map(|x| 1e3 * x);
        Case::new(format!("{inwards_um} um inwards: force, mN"), found, wanted, bound)
    });
    compared("contact beside a bond", "", &cases)
}

/// The page of contacts equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [durations, overlaps, speeds] = elastic();
        let [velocities, spins] = oblique();
        let [along, turn] = incline();
        filled(
            include_str!("contacts.md"),
            &[
                ("durations", durations),
                ("overlaps", overlaps),
                ("speeds", speeds),
                ("restitution", restitution()),
                ("restitution as planned", restitution_as_planned()),
                ("oblique velocities", velocities),
                ("oblique spins", spins),
                ("oblique linear", oblique_linear()),
                ("sliding to rolling", sliding_to_rolling()),
                ("incline", along),
                ("incline spins", turn),
                ("rolling friction", rolling_friction()),
                ("held", held()),
                ("adhesion", adhesion()),
                ("liquid bridge", liquid_bridge()),
                ("contact beside a bond", beside_bond()),
            ],
        )
    });
    assert_shown(&[("contacts.md".to_owned(), page)]);
}
