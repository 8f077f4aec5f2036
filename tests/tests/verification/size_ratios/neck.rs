//! A small sphere rolls off the neck between two fixed large spheres that touch.

use std::f64::consts::PI;

use dem_run::{State, step};

use super::RATIOS;
use crate::verification::scene::{place, started, velocity};
use crate::verification::table::{Case, compared, digits, head, row};

const LARGE_M: f64 = 5e-3;
const DENSITY_KG_M3: f64 = 2500.0;
const GRAVITY_M_S2: f64 = 9.81;
const FRICTION: f64 = 0.5;
/// Angle at which it starts at rest, from the highest point of the neck.
const START_RAD: f64 = PI / 180.0;
/// Static overlap over the radius of the small sphere.
const OVERLAP: f64 = 1e-5;
/// It leaves well before this time, s.
const LONGEST_S: f64 = 1.0;
/// Steps in a period of its vibration in the neck.
const STEPS: f64 = 100.0;

/// The small sphere on its way around the neck; its large neighbours have their centres on x.
#[derive(Debug, Clone, Copy)]
struct Neck {
    radius_m: f64,
    /// Sine of the angle between x and the line to the centre of a large sphere.
    sine: f64,
    /// Radius of the circle of its centre, m.
    circle_m: f64,
}

impl Neck {
    fn of(ratio: f64) -> Self {
        let radius_m = LARGE_M / ratio;
        let reach_m = LARGE_M + radius_m;
        let circle_m = (reach_m * reach_m - LARGE_M * LARGE_M).sqrt();
        Self {
            radius_m,
            sine: circle_m / reach_m,
            circle_m,
        }
    }

    fn mass_kg(&self) -> f64 {
        DENSITY_KG_M3 * 4.0 / 3.0 * PI * self.radius_m.powi(3)
    }

    /// Of its vibration towards and from x, s: under its weight it sinks by the overlap.
    fn period_s(&self) -> f64 {
        2.0 * PI * (OVERLAP * self.radius_m / (GRAVITY_M_S2 * self.sine)).sqrt()
    }

    /// Inertia that rolling moves, over the mass: it turns about the line through its two contacts.
    fn rolling(&self) -> f64 {
        1.0 + 0.4 / (self.sine * self.sine)
    }

    /// Speed of its centre at this angle if it has rolled, m/s.
    fn speed_m_s(&self, angle_rad: f64) -> f64 {
        let fallen_m = self.circle_m * (START_RAD.cos() - angle_rad.cos());
        (2.0 * GRAVITY_M_S2 * fallen_m / self.rolling()).sqrt()
    }

    /// Angle at which it leaves, rad. It rolls until friction cannot hold it, then slides. Both are
    /// integrated, as a rigid body, from the middle of the way.
    fn leaves_rad(&self) -> f64 {
        const STEP: f64 = 1e-6;
        let grip = FRICTION / self.sine;
        let (mut angle, mut slides) = (30.0 * START_RAD, false);
        let mut square = self.speed_m_s(angle).powi(2);
        loop {
            let (sine, cosine) = angle.sin_cos();
            // Over the weight: radial force of both contacts, friction that rolling takes.
            let pressed = cosine - square / (GRAVITY_M_S2 * self.circle_m);
            if pressed <= 0.0 {
                return angle;
            }
            let needed = sine * (1.0 - 1.0 / self.rolling());
            slides |= needed > grip * pressed;
            let friction = if slides { grip * pressed } else { needed };
            square += 2.0 * GRAVITY_M_S2 * self.circle_m * (sine - friction) * STEP;
            angle += STEP;
        }
    }

    fn scene(&self) -> String {
        let weight_n = self.mass_kg() * GRAVITY_M_S2;
        let overlap_m = OVERLAP * self.radius_m;
        let stiffness = weight_n / (2.0 * self.sine * overlap_m);
        let step_s = self.period_s() / STEPS;
        let reach_m = LARGE_M + self.radius_m - overlap_m;
        let circle_m = (reach_m * reach_m - LARGE_M * LARGE_M).sqrt();
        let [y, z] = [START_RAD.sin(), START_RAD.cos()].map(|part| part * circle_m);
        format!(
            r#"
            version = 1
            run = {{ end_time = "10 s", time_step = {step_s:e}, gravity = [0, 0, {:e}], initial_overlap = "keep" }}
            materials.stone = {{ density = {DENSITY_KG_M3:e}, young_modulus = "10 GPa" }}
            contacts.stone-stone = {{ law = "linear", normal_stiffness = {stiffness:e}, restitution = 0.5, friction = {FRICTION:e} }}
            bodies.fine = {{ particles = [[0, {y:e}, {z:e}, {:e}]], material = "stone" }}
            bodies.large = {{ particles = [[{LARGE_M:e}, 0, 0, {LARGE_M:e}], [{:e}, 0, 0, {LARGE_M:e}]], material = "stone" }}
            supports.large = {{ group = "large", fixed = true }}
            "#,
            -GRAVITY_M_S2, self.radius_m, -LARGE_M,
        )
    }
}

/// Angle of the small sphere from the highest point of the neck, rad.
fn angle_rad(state: &State) -> f64 {
    let at = place(state, 0);
    at.y.atan2(at.z)
}

/// Speed of its centre half a step ago, m/s, over that of rolling at its angle then.
fn over_rolling(state: &State, neck: &Neck) -> f64 {
    let moves = velocity(state, 0);
    let then = place(state, 0) - moves * (0.5 * state.time_step_s);
    moves.norm() / neck.speed_m_s(then.y.atan2(then.z))
}

/// The speed of the small sphere at two angles, and the angle at which it leaves.
pub(super) fn rolls_off() -> String {
    let mut cases = Vec::new();
    for ratio in RATIOS {
        let neck = Neck::of(ratio);
        let mut state = started(&neck.scene());
        for degrees in [20.0_f64, 40.0] {
            while angle_rad(&state) < degrees.to_radians() {
                step(&mut state);
                assert!(state.time_s < LONGEST_S, "{ratio}: it rests in the neck");
            }
            let wanted = neck.speed_m_s(degrees.to_radians());
            let found = over_rolling(&state, &neck) * wanted;
            let what = format!("{ratio}: speed at {degrees}°, mm/s");
            // The overlap shortens both the lever of rolling and the circle.
            cases.push(Case::new(what, 1e3 * found, 1e3 * wanted, 2.0 * OVERLAP));
        }
        let reach_m = LARGE_M + neck.radius_m;
        let touches = |state: &State| (place(state, 0) - place(state, 1)).norm() < reach_m;
        // It vibrates in the neck: it has left when it has lost touch for a period.
        let (mut left_rad, mut steps) = (0.0, 0.0);
        while steps < STEPS {
            step(&mut state);
            assert!(state.time_s < LONGEST_S, "{ratio}: it stays in the neck");
            if touches(&state) {
                (left_rad, steps) = (angle_rad(&state), 0.0);
            } else {
                steps += 1.0;
            }
        }
        let wanted_rad = neck.leaves_rad();
        let [found, wanted] = [left_rad, wanted_rad].map(f64::to_degrees);
        // It vibrates: the way in a period of that, at its speed where it leaves.
        let pace_1_s = (GRAVITY_M_S2 * wanted_rad.cos() / neck.circle_m).sqrt();
        let bound = pace_1_s * neck.period_s() / wanted_rad;
        let what = format!("{ratio}: angle at which it leaves, °");
        cases.push(Case::new(what, found, wanted, bound));
    }
    compared("ratio of the radii", "", &cases)
}

/// The angles at which it leaves in LAMMPS, stored by tests/lammps/size_ratios.py, beside the
/// closed form; and the version of LAMMPS.
pub(super) fn by_lammps() -> [String; 2] {
    let stored = include_str!("../../../lammps/size-ratios.json");
    let stored: serde_json::Value = serde_json::from_str(stored).unwrap();
    let mut table = head(&[
        "ratio of the radii",
        "reference, °",
        "LAMMPS, °",
        "LAMMPS, synchronized, °",
    ]);
    for (ratio, of) in RATIOS.iter().zip(stored["rows"].as_array().unwrap()) {
        assert_eq!(of["ratio"].as_f64(), Some(*ratio));
        let angle = |name: &str| match of[name].as_f64() {
            Some(angle) => digits(angle, 1, 0.0),
            None => "stays".to_owned(),
        };
        table += &row(&[
            ratio.to_string(),
            digits(Neck::of(*ratio).leaves_rad().to_degrees(), 1, 1e-3),
            angle("leaves_deg"),
            angle("synchronized_leaves_deg"),
        ]);
    }
    [table, stored["version"].as_str().unwrap().to_owned()]
}
