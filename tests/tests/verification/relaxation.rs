//! Overlaps of particles that separate by breakage, or overlap at the start: their forces, and the
//! absence of an energy gain.

use std::f64::consts::PI;

use dem_run::{State, step};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::{place, started, velocity};
use super::table::{Case, compared};

const RADIUS_M: f64 = 0.01;
const DENSITY_KG_M3: f64 = 2500.0;
const YOUNG_PA: f64 = 70e6;
const POISSON: f64 = 0.25;
const GRAVITY_M_S2: f64 = 9.81;
/// Initial overlap.
const OVERLAP_M: f64 = 1e-3;
/// Number of steps in an impact.
const STEPS: f64 = 1000.0;

/// Hertz's law between a ball and a rigid wall, or two balls.
#[derive(Debug, Clone, Copy)]
struct Hertz {
    pair: bool,
}

impl Hertz {
    fn mass_kg(self) -> f64 {
        let mass = DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
        if self.pair { 0.5 * mass } else { mass }
    }

    fn radius_m(self) -> f64 {
        if self.pair { 0.5 * RADIUS_M } else { RADIUS_M }
    }

    /// E* sqrt(R*).
    fn stiffness(self) -> f64 {
        let young = YOUNG_PA / (1.0 - POISSON * POISSON) * if self.pair { 0.5 } else { 1.0 };
        young * self.radius_m().sqrt()
    }

    fn energy_j(self, overlap_m: f64) -> f64 {
        8.0 / 15.0 * self.stiffness() * overlap_m.powf(2.5)
    }

    /// Speed with this kinetic energy, m/s.
    fn speed_m_s(self, energy_j: f64) -> f64 {
        (2.0 * energy_j / self.mass_kg()).sqrt()
    }

    /// Largest overlap of an impact at this speed, m.
    fn overlap_m(self, speed_m_s: f64) -> f64 {
        (15.0 / 16.0 * self.mass_kg() * speed_m_s * speed_m_s / self.stiffness()).powf(0.4)
    }

    fn duration_s(self, speed_m_s: f64) -> f64 {
        2.943_275_184 * self.overlap_m(speed_m_s) / speed_m_s
    }

    /// Overlapping balls, or a ball and a wall, that approach at this speed, or separate if it is
    /// below 0.
    fn scene(self, run: &str, restitution: f64, least: f64, speed_m_s: f64) -> State {
        let (height, other) = if self.pair {
            let below = format!("[[0, 0, 0, {RADIUS_M:e}]]");
            let other = format!("bodies.other = {{ particles = {below}, material = \"ball\" }}");
            (2.0 * RADIUS_M - OVERLAP_M, other)
        } else {
            let plane = "{ point = [0, 0, 0], normal = [0, 0, 1] }";
            let other = format!("walls.ground = {{ plane = {plane}, material = \"rigid\" }}");
            (RADIUS_M - OVERLAP_M, other)
        };
        started(&format!(
            r#"
            version = 1
            run = {{ end_time = "1 h", {run} }}
            materials.ball = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
            materials.rigid = {{ rigid = true }}
            contacts.ball-ball = {{ restitution = {restitution:e} }}
            contacts.ball-rigid = {{ restitution = {restitution:e} }}
            relaxation = {{ min_overlap = {least:e} }}
            bodies.ball = {{ particles = [[0, 0, {height:e}, {RADIUS_M:e}]], material = "ball", velocity = [0, 0, {:e}] }}
            {other}
            "#,
            -speed_m_s
        ))
    }

    /// Overlap, m, and separation speed, m/s, half a step before.
    fn apart(self, state: &State) -> [f64; 2] {
        if self.pair {
            let reach = (place(state, 0) - place(state, 1)).z;
            let speed = (velocity(state, 0) - velocity(state, 1)).z;
            [2.0 * RADIUS_M - reach, speed]
        } else {
            [RADIUS_M - place(state, 0).z, velocity(state, 0).z]
        }
    }

    fn name(self) -> &'static str {
        if self.pair {
            "ball and ball"
        } else {
            "ball and wall"
        }
    }
}

/// Runs until the ends are apart. Returns the largest overlap, m, and the separation speed, m/s.
fn parted(hertz: Hertz, state: &mut State) -> [f64; 2] {
    let mut largest = 0.0_f64;
    loop {
        let [overlap, speed] = hertz.apart(state);
        if overlap < 0.0 {
            return [largest, speed];
        }
        largest = largest.max(overlap);
        step(state);
    }
}

/// Balls that overlap at the start and are driven into each other: their initial overlap is the
/// origin of the law.
fn driven() -> [String; 2] {
    let (mut overlaps, mut speeds) = (Vec::new(), Vec::new());
    for pair in [false, true] {
        for (restitution, speed) in [(1.0, 0.1), (1.0, 1.0), (0.5, 1.0)] {
            let hertz = Hertz { pair };
            let step_s = hertz.duration_s(speed) / STEPS;
            let run = format!("time_step = {step_s:e}, initial_overlap = \"relax\"");
            let found = parted(hertz, &mut hertz.scene(&run, restitution, 0.0, speed));
            let what = format!("{}, {speed} m/s", hertz.name());
            if restitution == 1.0 {
                let wanted = 1e6 * hertz.overlap_m(speed);
                let beyond = 1e6 * (found[0] - OVERLAP_M);
                overlaps.push(Case::new(
                    what.clone(),
                    beyond,
                    wanted,
                    (PI / STEPS).powi(2),
                ));
            }
            let what = format!("{what}, restitution {restitution}");
            // The damped law is of first order in the step over the faster time of the damped
            // oscillation, as in any impact; 0.5 has this damping ratio.
            let zeta = 0.2553_f64;
            let bound = if restitution == 1.0 {
                (PI / STEPS).powi(2)
            } else {
                (zeta + zeta.hypot(1.0)) / STEPS
            };
            speeds.push(Case::new(what, found[1], restitution * speed, bound));
        }
    }
    [
        compared("driven together", "um", &overlaps),
        compared("driven together", "m/s", &speeds),
    ]
}

/// Balls at rest that overlap at the start, and balls that are pulled apart: all energy of the
/// overlap is released if it is kept, none if it is relaxed, and with a least overlap the energy of
/// that overlap.
fn released() -> String {
    let mut cases = Vec::new();
    for pair in [false, true] {
        let hertz = Hertz { pair };
        let kept = hertz.speed_m_s(hertz.energy_j(OVERLAP_M));
        let step_s = hertz.duration_s(kept) / STEPS;
        let with = |start: &str| format!("time_step = {step_s:e}, initial_overlap = \"{start}\"");
        let name = hertz.name();
        let [_, found] = parted(hertz, &mut hertz.scene(&with("keep"), 1.0, 0.0, 0.0));
        let square = (PI / STEPS).powi(2);
        cases.push(Case::new(
            format!("{name}, at rest, `keep`"),
            found,
            kept,
            square,
        ));
        let mut still = hertz.scene(&with("relax"), 1.0, 0.0, 0.0);
        for _ in 0..STEPS as usize {
            step(&mut still);
        }
        let [_, found] = hertz.apart(&still);
        let what = format!("{name}, at rest, `relax`");
        cases.push(Case::of_scale(what, [found, 0.0], kept, 1e-12));
        let slow = 0.1 * kept;
        let [_, found] = parted(hertz, &mut hertz.scene(&with("relax"), 1.0, 0.0, -slow));
        let what = format!("{name}, pulled apart, `relax`");
        cases.push(Case::new(what, found, slow, 1e-12));
        let least_m = 0.05 * hertz.radius_m();
        let [_, found] = parted(hertz, &mut hertz.scene(&with("relax"), 1.0, 0.05, -slow));
        let energy = hertz.energy_j(least_m);
        let wanted = hertz.speed_m_s(energy).hypot(slow);
        // The pair becomes ordinary up to a step late, and its energy grows with the overlap to the
        // power of 5/2.
        let late = 2.5 * slow * step_s / least_m + square;
        let what = format!("{name}, pulled apart, `relax`, `min_overlap = 0.05`");
        cases.push(Case::new(what, found, wanted, late));
    }
    compared("overlapping at the start", "m/s", &cases)
}

/// A ball that overlaps a wall is thrown up and falls back before it is free: the contact force
/// starts at the smallest overlap reached.
fn thrown() -> String {
    let hertz = Hertz { pair: false };
    let weight_n = hertz.mass_kg() * GRAVITY_M_S2;
    let sinks_m = (15.0 / 8.0 * weight_n / hertz.stiffness()).powf(2.0 / 3.0);
    let cases = [0.2, 0.5, 0.8].map(|fraction| {
        let rises_m = fraction * OVERLAP_M;
        let speed = (2.0 * GRAVITY_M_S2 * rises_m).sqrt();
        // The oscillation is about as slow as with the stiffness at half of its depth.
        let stiffness = 2.0 * hertz.stiffness() * (0.5 * sinks_m).sqrt();
        let step_s = (hertz.mass_kg() / stiffness).sqrt() * PI / STEPS;
        let run = format!(
            "time_step = {step_s:e}, initial_overlap = \"relax\", gravity = [0, 0, {:e}]",
            -GRAVITY_M_S2
        );
        let mut state = hertz.scene(&run, 1.0, 0.0, -speed);
        let [mut deepest, mut least] = [0.0, OVERLAP_M];
        while state.time_s < speed / GRAVITY_M_S2 + 2.0 * STEPS * step_s {
            step(&mut state);
            let [overlap, _] = hertz.apart(&state);
            least = overlap.min(least);
            deepest = if state.time_s < speed / GRAVITY_M_S2 {
                0.0
            } else {
                overlap.max(deepest)
            };
        }
        let found = 1e6 * (deepest - (OVERLAP_M - rises_m));
        // The top is accurate to half a step, and with it the position from which the ball falls.
        let top = 0.5 * GRAVITY_M_S2 * step_s * step_s / sinks_m;
        let bound = (PI / STEPS).powi(2) + top;
        Case::new(
            format!("rises by {fraction} mm"),
            found,
            1e6 * sinks_m,
            bound,
        )
    });
    compared("thrown up by", "um", &cases)
}

/// Young's modulus of the bond between two overlapping spheres.
const BOND_YOUNG_PA: f64 = 10e6;
const BOND_STRENGTH_PA: f64 = 100e3;
const BOND_LENGTH_M: f64 = 2.0 * RADIUS_M - OVERLAP_M;

/// Two overlapping bonded spheres driven together at this speed.
fn bonded(speed_m_s: f64, step_s: f64) -> State {
    let half = 0.5 * speed_m_s;
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 h", time_step = {step_s:e} }}
        materials.ball = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
        contacts.ball-ball = {{ restitution = 1 }}
        relaxation = {{ min_overlap = 0 }}
        bonds.glue = {{ young_modulus = {BOND_YOUNG_PA:e}, poisson_ratio = 0.3, radius_factor = 0.5, failure = {{ compressive_strength = {BOND_STRENGTH_PA:e} }} }}
        bodies.pair = {{ particles = [[0, 0, {BOND_LENGTH_M:e}, {RADIUS_M:e}], [0, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = "ball", bonds = "glue" }}
        groups.upper = {{ particles = [0] }}
        groups.lower = {{ particles = [1] }}
        initial.upper = {{ group = "upper", velocity = [0, 0, {:e}] }}
        initial.lower = {{ group = "lower", velocity = [0, 0, {half:e}] }}
        "#,
        -half
    ))
}

/// Two overlapping spheres, whose bond is compressed until it breaks: the contact starts from the
/// overlap at which they separate.
fn broken() -> String {
    let hertz = Hertz { pair: true };
    let stiffness = BOND_YOUNG_PA * PI * (0.5 * RADIUS_M).powi(2) / BOND_LENGTH_M;
    let pressed_m = BOND_STRENGTH_PA / BOND_YOUNG_PA * BOND_LENGTH_M;
    let mut cases = Vec::new();
    for speed in [0.7, 1.0, 2.0] {
        let bond_j = 0.5 * stiffness * pressed_m * pressed_m;
        let left_j = 0.5 * hertz.mass_kg() * speed * speed - bond_j;
        let left_m_s = hertz.speed_m_s(left_j);
        let step_s = hertz.duration_s(speed) / STEPS;
        let mut state = bonded(speed, step_s);
        let mut parts_m = 0.0;
        while state.broken_count == 0 {
            [parts_m, _] = hertz.apart(&state);
            step(&mut state);
        }
        let [deepest, found] = parted(hertz, &mut state);
        let met_m = OVERLAP_M + pressed_m;
        // The bond breaks up to a step late, and the contact begins up to a step after that.
        let late_m = 2.0 * speed * step_s;
        let beyond_m = hertz.overlap_m(left_m_s);
        // The bond takes additional energy by its force over that distance.
        let late = stiffness * (pressed_m + late_m) * late_m / (2.0 * left_j);
        let square = (PI / STEPS).powi(2);
        let deepest_bound = (late_m + beyond_m * late) / (met_m + beyond_m) + square;
        let [parts, met] = [parts_m, met_m].map(|overlap| 1e6 * overlap);
        let [deepest, wanted] = [deepest, met_m + beyond_m].map(|overlap| 1e6 * overlap);
        let name = |of: &str| format!("{speed} m/s: {of}");
        cases.push(Case::new(
            name("overlap as it breaks, um"),
            parts,
            met,
            late_m / met_m,
        ));
        cases.push(Case::new(
            name("largest overlap, um"),
            deepest,
            wanted,
            deepest_bound,
        ));
        cases.push(Case::new(
            name("speed when apart, m/s"),
            found,
            left_m_s,
            late + square,
        ));
    }
    compared("driven together at", "", &cases)
}

/// The page of relaxation equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [overlaps, speeds] = driven();
        filled(
            include_str!("relaxation.md"),
            &[
                ("overlaps", overlaps),
                ("speeds", speeds),
                ("released", released()),
                ("thrown", thrown()),
                ("broken", broken()),
            ],
        )
    });
    assert_shown(&[("relaxation.md".to_owned(), page)]);
}
