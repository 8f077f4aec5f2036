//! Oscillations of one bond with damping of bonds or of particles, and their rest positions.

use std::f64::consts::PI;

use dem_run::physics::bond::damping_models::SMOOTHING;
use dem_run::{State, balance, step};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::{place, spin, started, velocity};
use super::table::{Case, compared};

const RADIUS_M: f64 = 1e-3;
const LENGTH_M: f64 = 3e-3;
const YOUNG_PA: f64 = 1e9;
const POISSON: f64 = 0.25;
const DENSITY_KG_M3: f64 = 2500.0;
const GRAVITY_M_S2: f64 = 9.81;

/// Step times angular frequency.
const STEP: f64 = 0.01;

/// Bound of structural damping. A reversal takes SMOOTHING radians, some steps: in them the error
/// of second order is that of (STEP/SMOOTHING)^2 over the part of the half period that they are.
const STRUCTURAL: f64 = STEP * STEP / SMOOTHING;

/// Mode in which two spheres oscillate against each other.
#[derive(Debug, Clone, Copy)]
enum Mode {
    Axial,
    Torsion,
    Bending,
    /// Across the bond: the ends move apart sideways and turn in the same sense.
    Shear,
}

/// Those of which Chen et al. 2022 and Platzer 2022 give the damping in closed form.
const MODES: [Mode; 3] = [Mode::Axial, Mode::Torsion, Mode::Bending];
const ALL_MODES: [Mode; 4] = [Mode::Axial, Mode::Torsion, Mode::Bending, Mode::Shear];

fn mass_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

fn inertia_kg_m2() -> f64 {
    0.4 * mass_kg() * RADIUS_M * RADIUS_M
}

/// What the rotation of the ends adds to the inverse reduced mass of shear, plus 1.
fn sideways() -> f64 {
    1.0 + 0.25 * LENGTH_M * LENGTH_M * mass_kg() / inertia_kg_m2()
}

/// Shear stiffness of the Timoshenko bond, N/m.
fn shear_n_m() -> f64 {
    let phi = 20.0 * RADIUS_M * RADIUS_M * (1.0 + POISSON) / (3.0 * LENGTH_M * LENGTH_M);
    12.0 * YOUNG_PA * second_moment_m4() / (LENGTH_M.powi(3) * (1.0 + phi))
}

fn second_moment_m4() -> f64 {
    0.25 * PI * RADIUS_M.powi(4)
}

impl Mode {
    fn name(self) -> &'static str {
        match self {
            Self::Axial => "axial",
            Self::Torsion => "torsion",
            Self::Bending => "bending",
            Self::Shear => "shear",
        }
    }

    /// Stiffness, N/m or N m/rad.
    fn stiffness(self) -> f64 {
        let shear = YOUNG_PA / (2.0 * (1.0 + POISSON));
        match self {
            Self::Axial => YOUNG_PA * PI * RADIUS_M * RADIUS_M / LENGTH_M,
            Self::Torsion => 2.0 * shear * second_moment_m4() / LENGTH_M,
            Self::Bending => YOUNG_PA * second_moment_m4() / LENGTH_M,
            Self::Shear => shear_n_m(),
        }
    }

    /// Reduced mass or inertia, kg or kg m2, of two equal spheres: of shear with their rotation,
    /// 1/(2/m + 2 l^2/I) with half of the length as the lever l.
    fn reduced(self) -> f64 {
        match self {
            Self::Axial => 0.5 * mass_kg(),
            Self::Torsion | Self::Bending => 0.5 * inertia_kg_m2(),
            Self::Shear => 0.5 * mass_kg() / sideways(),
        }
    }

    /// Rate of the mode over the speed of each sphere at the start.
    fn rate_per_speed(self) -> f64 {
        match self {
            Self::Axial | Self::Torsion | Self::Bending => 2.0,
            Self::Shear => 2.0 * sideways(),
        }
    }

    fn omega_rad_s(self) -> f64 {
        (self.stiffness() / self.reduced()).sqrt()
    }

    /// Initial speed of each of two free spheres, m/s or rad/s.
    fn start_speed(self) -> f64 {
        let moved = if matches!(self, Self::Axial | Self::Shear) {
            LENGTH_M
        } else {
            1.0
        };
        1e-5 * moved * self.omega_rad_s()
    }

    /// Initial condition of two free spheres: opposite velocities or spins.
    fn start(self) -> String {
        let of = match self {
            Self::Axial => "velocity = [V, 0, 0]",
            Self::Torsion => "angular_velocity = [V, 0, 0]",
            Self::Bending => "angular_velocity = [0, 0, V]",
            Self::Shear => "velocity = [0, V, 0], angular_velocity = [0, 0, W]",
        };
        let speed = self.start_speed();
        // Without angular momentum, both turn in the same sense.
        let spin = -0.5 * LENGTH_M * mass_kg() / inertia_kg_m2() * speed;
        let of = |speed: f64| {
            let of = of.replace('V', &format!("{speed:e}"));
            of.replace('W', &format!("{spin:e}"))
        };
        format!(
            "initial.left = {{ group = \"left\", {} }}\ninitial.right = {{ group = \"right\", {} }}",
            of(-speed),
            of(speed)
        )
    }

    /// Displacement of the second sphere relative to the first, and its rate half a step before.
    fn relative(self, state: &State) -> [f64; 2] {
        let turn = |i: usize| state.particles.poses[i].rotation().scaled_axis();
        let turned = turn(1) - turn(0);
        let turns = spin(state, 1) - spin(state, 0);
        match self {
            Self::Axial => {
                let moves = velocity(state, 1) - velocity(state, 0);
                [(place(state, 1) - place(state, 0)).x - LENGTH_M, moves.x]
            }
            Self::Torsion => [turned.x, turns.x],
            Self::Bending => [turned.z, turns.z],
            Self::Shear => {
                let lever = 0.5 * LENGTH_M;
                let moves = velocity(state, 1) - velocity(state, 0);
                let both = turn(1) + turn(0);
                let rates = spin(state, 1) + spin(state, 0);
                let apart = place(state, 1) - place(state, 0);
                [apart.y - lever * both.z, moves.y - lever * rates.z]
            }
        }
    }
}

/// Two spheres and their bond along x, with keys of `[run]`, damping of the bond, and further
/// tables for "left" and "right".
fn pair(run: &str, damping: &str, more: &str) -> State {
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 h", {run} }}
        materials.stone = {{ density = {DENSITY_KG_M3:e} }}
        bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{LENGTH_M:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue" }}
        groups.left = {{ particles = [0] }}
        groups.right = {{ particles = [1] }}
        bonds.glue = {{ model = "timoshenko", young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, damping = {{ {damping} }} }}
        {more}
        "#
    ))
}

/// Times and speeds at which an oscillation passes through its middle.
fn crossings(mode: Mode, state: &mut State, count: usize) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let mut before = mode.relative(state);
    let mut at_s = None;
    while found.len() < count {
        step(state);
        let now = mode.relative(state);
        // Rates are those of half a step earlier: the previous one and the next one.
        if let Some(at_s) = at_s.take() {
            let part: f64 = (at_s - state.time_s) / state.time_step_s + 1.5;
            found.push([at_s, (before[1] + part * (now[1] - before[1])).abs()]);
        }
        if before[0] * now[0] < 0.0 {
            let part = now[0] / (now[0] - before[0]);
            at_s = Some(state.time_s - part * state.time_step_s);
        }
        before = now;
    }
    found
}

/// Logarithmic decrement and duration of half an oscillation.
fn half_swing(crossings: &[[f64; 2]]) -> [f64; 2] {
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    let oscillations = (crossings.len() - 1) as f64;
    [
        (first[1] / last[1]).ln() / oscillations,
        (last[0] - first[0]) / oscillations,
    ]
}

/// Damping ratios and frequencies of damped bonds.
fn damped_bonds() -> [String; 2] {
    let (mut ratios, mut frequencies) = (Vec::new(), Vec::new());
    let fraction = |mode: Mode| match mode {
        Mode::Axial => 1.0,
        Mode::Torsion => 2.0_f64.sqrt(),
        Mode::Bending => (2.0 * Mode::Torsion.stiffness() / Mode::Bending.stiffness()).sqrt(),
        // Damping refers to the mass alone, and the ends turn as well.
        Mode::Shear => sideways().sqrt(),
    };
    let mut cases = Vec::new();
    for mode in MODES {
        for eta in [0.02, 0.1, 0.4] {
            let chen = format!("damping_ratio = {eta}");
            cases.push((mode, chen.clone(), fraction(mode) * eta));
            cases.push((mode, format!("{chen}, per_mode = true"), eta));
        }
    }
    let critical = 2.0 * (Mode::Axial.stiffness() * Mode::Axial.reduced()).sqrt();
    cases.push((
        Mode::Axial,
        format!("damping_coefficient = {:e}", 0.1 * critical),
        0.1,
    ));
    cases.push((Mode::Torsion, "torque_factor = 0.2".to_owned(), 0.1));
    cases.push((Mode::Bending, "torque_factor = 0.2".to_owned(), 0.1));
    for (mode, key, zeta) in [
        (Mode::Axial, "normal", 0.1),
        (Mode::Torsion, "torsion", 0.1),
        (Mode::Bending, "bending", 0.1),
        (Mode::Shear, "shear", 0.1 * fraction(Mode::Shear)),
    ] {
        cases.push((mode, format!("{key}_damping_ratio = 0.1"), zeta));
    }
    for (mode, damping, zeta) in cases {
        let omega = mode.omega_rad_s();
        let run = format!("time_step = {:e}", STEP / omega);
        let mut state = pair(&run, &damping, &mode.start());
        let [decrement, half_s] = half_swing(&crossings(mode, &mut state, 5));
        let bound = STEP * STEP;
        let damping = match damping.split_once('=') {
            Some(("damping_coefficient ", _)) => {
                "`damping_coefficient`, a tenth of the critical".to_owned()
            }
            _ => format!("`{damping}`"),
        };
        let what = format!("{}, {damping}", mode.name());
        ratios.push(Case::new(
            what.clone(),
            decrement / decrement.hypot(PI),
            zeta,
            bound,
        ));
        let wanted = omega * (1.0 - zeta * zeta).sqrt();
        frequencies.push(Case::new(
            what,
            PI / half_s,
            wanted,
            bound / (1.0 - zeta * zeta),
        ));
    }
    [
        compared("mode, damping", "", &ratios),
        compared("mode, damping", "rad/s", &frequencies),
    ]
}

/// Error of the displacement of two free spheres after ten radians of the undamped oscillation,
/// relative to the largest one without damping, with this omega dt.
fn error_after(mode: Mode, zeta: f64, step_rad: f64) -> f64 {
    let omega = mode.omega_rad_s();
    let run = format!("time_step = {:e}", step_rad / omega);
    let key = match mode {
        Mode::Axial => "normal",
        Mode::Torsion => "torsion",
        Mode::Bending => "bending",
        Mode::Shear => "shear",
    };
    let eta = match mode {
        Mode::Shear => zeta / sideways().sqrt(),
        _ => zeta,
    };
    let mut state = pair(
        &run,
        &format!("{key}_damping_ratio = {eta:e}"),
        &mode.start(),
    );
    for _ in 0..(10.0 / step_rad).round() as usize {
        step(&mut state);
    }
    let speed = mode.rate_per_speed() * mode.start_speed();
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let t = state.time_s;
    let wanted = speed / damped * (-zeta * omega * t).exp() * (damped * t).sin();
    (mode.relative(&state)[0] - wanted).abs() * omega / speed
}

/// Orders in the step of damped bonds: from the errors at omega dt = 0.02 and 0.01.
fn orders() -> String {
    let mut cases = Vec::new();
    for mode in ALL_MODES {
        for zeta in [0.1, 0.4] {
            let [coarse, fine] = [0.02, 0.01].map(|step_rad| error_after(mode, zeta, step_rad));
            let what = format!("{}, zeta = {zeta}", mode.name());
            cases.push(Case::new(what, (coarse / fine).log2(), 2.0, 0.02));
        }
    }
    compared("mode, damping ratio", "", &cases)
}

/// Energy recorded as dissipated by such damping once an oscillation has decayed, over the initial
/// energy.
fn booked(modes: &[Mode], damping: &str) -> String {
    let mut cases = Vec::new();
    for &mode in modes {
        let run = format!("time_step = {:e}", STEP / mode.omega_rad_s());
        let mut state = pair(&run, damping, &mode.start());
        let speed = mode.rate_per_speed() * mode.start_speed();
        let start_j = 0.5 * mode.reduced() * speed * speed;
        while state.time_s * mode.omega_rad_s() < 100.0 {
            step(&mut state);
        }
        let balance = balance(&mut state);
        let taken = (balance.bond_damping_j + balance.structural_damping_j) / start_j;
        cases.push(Case::new(mode.name(), taken, 1.0, STEP * STEP));
    }
    compared("mode", "", &cases)
}

/// Logarithmic decrement of half an oscillation of x'' = -x - gamma |x| v / sqrt(v^2 + (s x)^2),
/// and its duration: with x = A cos(phi), v = -A sin(phi), and c and n for cos and sin of phi, dA/A
/// = -gamma n^2 |c| / (r - gamma |c| c n) dphi and dt = r / (r - gamma |c| c n) dphi, where r^2 =
/// n^2 + (s c)^2. By Simpson's rule from one passage through the middle to the next.
fn half_swing_of(gamma: f64, smoothing: f64) -> [f64; 2] {
    const PARTS: usize = 20_000;
    let part = PI / PARTS as f64;
    let mut sums = [0.0; 2];
    for at in 0..=PARTS {
        let (n, c) = (0.5 * PI + part * at as f64).sin_cos();
        let r = n.hypot(smoothing * c);
        let weight = match at {
            0 | PARTS => 1.0,
            _ if at % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let slower = r - gamma * c.abs() * c * n;
        sums[0] += weight * gamma * n * n * c.abs() / slower;
        sums[1] += weight * r / slower;
    }
    sums.map(|sum| sum * part / 3.0)
}

/// Without smoothing the integrals are those of the sharp rule.
#[test]
fn half_a_swing_tends_to_that_of_the_sharp_rule() {
    for gamma in [0.05_f64, 0.2, 0.5] {
        let [decrement, half_rad] = half_swing_of(gamma, 1e-3);
        let sharp = 0.5 * ((1.0 + gamma) / (1.0 - gamma)).ln();
        assert!(
            (decrement / sharp - 1.0).abs() < 1e-4,
            "{decrement} {sharp}"
        );
        let quarter = |fraction: f64| 0.5 * PI / fraction.sqrt();
        let sharp = quarter(1.0 - gamma) + quarter(1.0 + gamma);
        assert!((half_rad / sharp - 1.0).abs() < 1e-3, "{half_rad} {sharp}");
    }
}

/// Structural damping of two free spheres: decrement and duration of half an oscillation.
fn structural() -> [String; 2] {
    let (mut decrements, mut durations) = (Vec::new(), Vec::new());
    for mode in ALL_MODES {
        for gamma in [0.05_f64, 0.2, 0.5] {
            let omega = mode.omega_rad_s();
            let run = format!("time_step = {:e}", STEP / omega);
            let damping = format!("structural_damping = {gamma:e}");
            let mut state = pair(&run, &damping, &mode.start());
            let [decrement, half_s] = half_swing(&crossings(mode, &mut state, 9));
            let what = format!("{}, {gamma}", mode.name());
            let smoothing = SMOOTHING * Mode::Axial.omega_rad_s() / omega;
            let [wanted, half_rad] = half_swing_of(gamma, smoothing);
            decrements.push(Case::new(what.clone(), decrement, wanted, STRUCTURAL));
            let wanted = half_rad / omega;
            durations.push(Case::new(what, 1e6 * half_s, 1e6 * wanted, STRUCTURAL));
        }
    }
    [
        compared("mode, gamma", "", &decrements),
        compared("mode, gamma", "us", &durations),
    ]
}

const HELD: &str = "supports.left = { group = \"left\", fixed = true }\n";

/// Particle damping of a sphere that oscillates on a fixed one: decrement and duration of half an
/// oscillation.
fn particle_damping() -> [String; 2] {
    let (mut decrements, mut durations) = (Vec::new(), Vec::new());
    let omega = (Mode::Axial.stiffness() / mass_kg()).sqrt();
    for gamma in [0.05_f64, 0.2, 0.5, 0.7] {
        let run = format!("time_step = {:e}, local_damping = {gamma:e}", STEP / omega);
        let speed = 1e-4 * LENGTH_M * omega;
        let more =
            format!("{HELD}initial.right = {{ group = \"right\", velocity = [{speed:e}, 0, 0] }}");
        let mut state = pair(&run, "damping_ratio = 0", &more);
        let [decrement, half_s] = half_swing(&crossings(Mode::Axial, &mut state, 9));
        let quarter = |fraction: f64| 0.5 * PI / omega / fraction.sqrt();
        let wanted = 0.5 * ((1.0 + gamma) / (1.0 - gamma)).ln();
        let bound = gamma * STEP + STEP * STEP;
        let what = format!("{gamma}");
        decrements.push(Case::new(what.clone(), decrement, wanted, bound));
        let wanted = quarter(1.0 - gamma) + quarter(1.0 + gamma);
        // One step late, the force is too large by 2 gamma for that time, and the following quarter
        // is shorter by the same effect.
        let late = 2.0 * gamma / (1.0 - gamma) * STEP / (omega * wanted);
        let bound = late + STEP * STEP;
        durations.push(Case::new(what, 1e6 * half_s, 1e6 * wanted, bound));
    }
    [
        compared("gamma", "", &decrements),
        compared("gamma", "us", &durations),
    ]
}

/// Fall of a sphere with local damping, which does not act on what nothing holds.
fn fall() -> String {
    let cases = [0.0, 0.2, 0.5].map(|gamma| {
        let mut state = started(&format!(
            r#"
            version = 1
            run = {{ end_time = "1 s", time_step = "0.1 ms", gravity = [0, 0, {:e}], local_damping = {gamma:e} }}
            materials.stone = {{ density = {DENSITY_KG_M3:e} }}
            bodies.ball = {{ particles = [[0, 0, 0, {RADIUS_M:e}]], material = "stone" }}
            "#,
            -GRAVITY_M_S2
        ));
        for _ in 0..1000 {
            step(&mut state);
        }
        let since_s = state.time_s - 0.5 * state.time_step_s;
        let acceleration = -velocity(&state, 0).z / since_s;
        Case::new(format!("{gamma}"), acceleration, GRAVITY_M_S2, 1e-9)
    });
    compared("gamma", "m/s2", &cases)
}

/// Rest position of a loaded sphere, for any type of damping.
fn rest() -> String {
    let shear = shear_n_m();
    let omega = (Mode::Axial.stiffness() / mass_kg()).sqrt();
    let (along, across) = (1.0, 1e-3);
    let mut cases = Vec::new();
    for (name, gamma, damping) in [
        ("bond damping", 0.0, "damping_ratio = 0.3, per_mode = true"),
        ("particle damping", 0.5, "damping_ratio = 0"),
        ("both", 0.5, "damping_ratio = 0.3"),
    ] {
        for (direction, force) in [("along", [along, 0.0]), ("across", [0.0, across])] {
            let run = format!("time_step = {:e}, local_damping = {gamma:e}", 0.2 / omega);
            let [fx, fy] = force;
            let more =
                format!("{HELD}loads.right = {{ group = \"right\", force = [{fx:e}, {fy:e}, 0] }}");
            let mut state = pair(&run, damping, &more);
            while state.time_s * omega < 5000.0 {
                step(&mut state);
            }
            let moved = place(&state, 1);
            // Half the length is the lever of a transverse force, for its moment and its rotation.
            let half = 0.5 * LENGTH_M;
            let (found, wanted) = if direction == "along" {
                (moved.x - LENGTH_M, along / Mode::Axial.stiffness())
            } else {
                let bent = half * half / Mode::Bending.stiffness();
                (moved.y, across * (bent + 1.0 / shear))
            };
            let bound = 1e-8;
            let what = format!("{name}, load {direction}");
            cases.push(Case::new(what, 1e9 * found, 1e9 * wanted, bound));
        }
    }
    compared("damping, load", "nm", &cases)
}

/// The page of damping equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [ratios, frequencies] = damped_bonds();
        let [decrements, durations] = particle_damping();
        let [structural_decrements, structural_durations] = structural();
        filled(
            include_str!("damping.md"),
            &[
                ("ratios", ratios),
                ("frequencies", frequencies),
                ("orders", orders()),
                (
                    "booked",
                    booked(&MODES, "damping_ratio = 0.2, per_mode = true"),
                ),
                ("structural decrements", structural_decrements),
                ("structural durations", structural_durations),
                (
                    "structural booked",
                    booked(&ALL_MODES, "structural_damping = 0.3"),
                ),
                ("decrements", decrements),
                ("durations", durations),
                ("fall", fall()),
                ("rest", rest()),
            ],
        )
    });
    assert_shown(&[("damping.md".to_owned(), page)]);
}
