//! Loading devices of dynamic tests: ends of long bars as impedances, compared with bars of bonded
//! spheres and closed forms, and a falling weight.

use std::f64::consts::PI;

use dem_run::step::{advance, interact};
use dem_run::{Plan, State, balance, plan, step};
use dem_scene::{Factor, Hold, Scene, Support, WallMotion, read_bodies, scene_from_text};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::velocity;
use super::table::{Case, compared};

const RADIUS_M: f64 = 0.01;
const SPACING_M: f64 = 2.0 * RADIUS_M;
/// Spheres in each bar.
const BAR: usize = 250;
/// Length of a pulse, in spheres of the bar.
const PULSE: f64 = 80.0;
/// Velocity of the pulse.
const WAVE_M_S: f64 = 1.0;
/// Step over the time that a wave takes from sphere to sphere of the bar.
const STEP: f64 = 0.2;
/// Largest deviation of a pulse, over the incident one.
const BOUND: f64 = 0.01;

/// A chain of this many spheres along x.
fn chain(count: usize) -> Scene {
    let spheres = (0..count).map(|i| format!("[{:e}, 0, 0, {RADIUS_M}]", SPACING_M * i as f64));
    let bonds = (1..count).map(|i| format!("[{}, {i}]", i - 1));
    let list = |items: Vec<String>| items.join(", ");
    let text = format!(
        r#"
        version = 1
        run = {{ end_time = 1, time_step = 1e-9 }}
        materials.steel = {{ density = 7850 }}
        bonds.steel = {{ young_modulus = "210 GPa", poisson_ratio = 0.3 }}
        bodies.chain = {{ particles = [{}], bond_list = [{}], material = "steel", bonds = "steel" }}
        groups = {{ first = {{ particles = [0] }}, last = {{ particles = [{}] }} }}
        "#,
        list(spheres.collect()),
        list(bonds.collect()),
        count - 1
    );
    scene_from_text(&text, "verification.toml", &[]).unwrap()
}

fn started(scene: &Scene) -> State {
    let bodies = read_bodies(scene).unwrap();
    let Plan { state, .. } = plan(scene, bodies, 1, true).unwrap();
    state
}

/// Stiffness of a bond, N/m, and mass of a sphere, kg.
fn lattice() -> [f64; 2] {
    let state = started(&chain(2));
    [
        state.bonds.normal(0),
        1.0 / state.particles.motions[0].inverse_mass,
    ]
}

/// Time that a wave takes from sphere to sphere, s.
fn unit_s() -> f64 {
    let [k, m] = lattice();
    (m / k).sqrt()
}

/// Impedance of the chain, N s/m.
fn impedance_n_s_m() -> f64 {
    let [k, m] = lattice();
    (k * m).sqrt()
}

/// A pulse of velocity: half a wave of a sine, squared.
fn pulse() -> Factor {
    let points = 200;
    let point = |i: i32| {
        let share = f64::from(i) / f64::from(points);
        [share * PULSE * unit_s(), (PI * share).sin().powi(2)]
    };
    Factor::Table((0..=points).map(point).collect())
}

fn held(group: &str, along: Hold, factor: Factor) -> Support {
    Support {
        group: group.to_owned(),
        holds: [Some(along), None, None, None, None, None],
        factor,
        end_s: None,
    }
}

/// The ends of a chain.
#[derive(Clone, Copy)]
enum End {
    Free,
    Fixed,
    /// The end of a bar of this impedance.
    Bar(f64),
}

/// A chain with these masses over that of a sphere of the bar, a pulse at its left end, and this
/// right end.
fn bar(masses: &[f64], end: End) -> State {
    let mut scene = chain(masses.len());
    let left = held("first", Hold::Velocity(WAVE_M_S), pulse());
    scene.supports.insert("left".to_owned(), left);
    let right = match end {
        End::Free => None,
        End::Fixed => Some(Hold::Fixed),
        End::Bar(impedance_n_s_m) => Some(Hold::Bar {
            impedance_n_s_m,
            incident_m_s: 0.0,
        }),
    };
    if let Some(hold) = right {
        let right = held("last", hold, Factor::One);
        scene.supports.insert("right".to_owned(), right);
    }
    weighed(&scene, masses)
}

/// The state of a scene with these masses.
fn weighed(scene: &Scene, masses: &[f64]) -> State {
    let mut state = started(scene);
    for (motion, mass) in state.particles.motions.iter_mut().zip(masses) {
        motion.inverse_mass /= mass;
    }
    let lightest = masses.iter().copied().fold(1.0, f64::min);
    state.time_step_s = STEP * unit_s() * lightest.sqrt();
    state
}

/// Force of a bond, N, positive in compression.
fn pressed_n(state: &State, bond: usize) -> f64 {
    -state
        .bonds
        .forces(bond, &state.particles.poses)
        .load
        .normal_n
}

/// Forces over time, N, of some bonds, until `end` times the travel from sphere to sphere.
fn gauges(state: &mut State, bonds: &[usize], end: f64) -> Vec<(f64, Vec<f64>)> {
    let mut found = Vec::new();
    while state.time_s < end * unit_s() {
        let forces = bonds.iter().map(|&bond| pressed_n(state, bond)).collect();
        found.push((state.time_s, forces));
        step(state);
    }
    found
}

/// The force with the largest magnitude in a gauge between two times, in travels from sphere to
/// sphere.
fn largest(found: &[(f64, Vec<f64>)], gauge: usize, [from, to]: [f64; 2]) -> f64 {
    let during = found
        .iter()
        .filter(|(time_s, _)| (from..to).contains(&(time_s / unit_s())));
    let forces = during.map(|(_, forces)| forces[gauge]);
    forces.fold(0.0, |most: f64, force| {
        if force.abs() > most.abs() {
            force
        } else {
            most
        }
    })
}

/// Reflected over incident force in the middle of a bar that ends like this.
fn reflected(end: End) -> f64 {
    let mut masses = vec![1.0; BAR];
    masses[0] = 0.5;
    masses[BAR - 1] = 0.5;
    let mut state = bar(&masses, end);
    let (middle, length) = (BAR / 2, BAR as f64);
    let found = gauges(&mut state, &[middle], 2.0 * length);
    let incident = largest(&found, 0, [0.0, 0.5 * length + PULSE]);
    largest(&found, 0, [0.5 * length + PULSE, 2.0 * length]) / incident
}

/// Reflected and transmitted over incident force at a step of the impedance by this factor, by
/// spheres of other masses.
fn at_step(ratio: f64) -> [f64; 2] {
    let mass = ratio * ratio;
    let mut masses = vec![1.0; BAR];
    masses.extend(vec![mass; BAR]);
    masses[BAR] = 0.5 * (1.0 + mass);
    let mut state = bar(&masses, End::Free);
    let length = BAR as f64;
    let gauges_at = [BAR / 2, BAR + 30];
    let found = gauges(&mut state, &gauges_at, 1.5 * length + 1.5 * PULSE);
    let parted = 0.5 * length + PULSE;
    let incident = largest(&found, 0, [0.0, parted]);
    let back = largest(&found, 0, [parted, f64::INFINITY]);
    // The second half is left before its free end sends anything back.
    let through = largest(&found, 1, [0.0, length + 30.0 * ratio + 1.5 * PULSE]);
    [back / incident, through / incident]
}

fn ends() -> String {
    let z = impedance_n_s_m();
    let mut cases = vec![
        Case::new("free end", reflected(End::Free), -1.0, BOUND),
        Case::new("held end", reflected(End::Fixed), 1.0, BOUND),
    ];
    for ratio in [0.5, 2.0] {
        let [back, through] = at_step(ratio);
        let theory = (ratio - 1.0) / (ratio + 1.0);
        let what = format!("step to {ratio} Z");
        cases.push(Case::new(format!("{what}, reflected"), back, theory, BOUND));
        let theory = 2.0 * ratio / (ratio + 1.0);
        cases.push(Case::new(
            format!("{what}, transmitted"),
            through,
            theory,
            BOUND,
        ));
    }
    for ratio in [0.5, 1.0, 2.0] {
        let theory = (ratio - 1.0) / (ratio + 1.0);
        let what = format!("impedance of {ratio} Z, reflected");
        let back = reflected(End::Bar(ratio * z));
        cases.push(Case::of_scale(what, [back, theory], 1.0, BOUND));
    }
    compared("force over that of the incident pulse", "", &cases)
}

/// Spheres of the specimen; its impedance is that of the bar over 4, and its waves are 4 times as
/// fast.
const SPECIMEN: usize = 40;
const LIGHT: f64 = 1.0 / 16.0;

/// Pulses, N, reflected and transmitted, at the ends of a specimen, at times after the incident
/// pulse arrives there.
struct Pulses {
    step_s: f64,
    reflected: Vec<f64>,
    transmitted: Vec<f64>,
}

impl Pulses {
    fn at(of: &[f64], step_s: f64, time_s: f64) -> f64 {
        let place = time_s / step_s;
        let before = place.floor() as usize;
        let share = place - place.floor();
        of[before] + share * (of[before + 1] - of[before])
    }
}

/// Duration over which pulses are compared, in travels from sphere to sphere of the bar: before
/// anything comes back from the far ends.
const DURING: f64 = 160.0;

/// Between two bars of bonded spheres.
fn between_spheres() -> Pulses {
    let mut masses = vec![1.0; BAR + 1];
    masses.extend(vec![LIGHT; SPECIMEN]);
    masses.extend(vec![1.0; BAR]);
    masses[0] = 0.5;
    for end in [BAR, BAR + SPECIMEN] {
        masses[end] = 0.5 * (1.0 + LIGHT);
    }
    let mut state = bar(&masses, End::Free);
    // Gauges as far before and behind the specimen as the pulse is long.
    let away = PULSE + 20.5;
    let gauges_at = [
        BAR - (away + 0.5) as usize,
        BAR + SPECIMEN + (away - 0.5) as usize,
    ];
    let arrives = BAR as f64;
    let found = gauges(&mut state, &gauges_at, arrives + away + DURING + 1.0);
    let step_s = state.time_step_s;
    let of = |gauge: usize| -> Vec<f64> { found.iter().map(|(_, f)| f[gauge]).collect() };
    let (incident, transmitted) = (of(0), of(1));
    let moved = |of: &[f64]| -> Vec<f64> {
        let times = 0..(DURING * unit_s() / step_s) as usize;
        times
            .map(|i| Pulses::at(of, step_s, i as f64 * step_s + (arrives + away) * unit_s()))
            .collect()
    };
    Pulses {
        step_s,
        reflected: moved(&incident),
        transmitted: moved(&transmitted),
    }
}

/// Between the ends of two bars without particles.
fn between_impedances() -> Pulses {
    let mut masses = vec![LIGHT; SPECIMEN + 1];
    masses[0] = 0.5 * LIGHT;
    masses[SPECIMEN] = 0.5 * LIGHT;
    let mut scene = chain(masses.len());
    let z = impedance_n_s_m();
    for (group, incident_m_s, factor) in [("first", WAVE_M_S, pulse()), ("last", 0.0, Factor::One)]
    {
        let hold = Hold::Bar {
            impedance_n_s_m: z,
            incident_m_s,
        };
        let support = held(group, hold, factor);
        scene.supports.insert(group.to_owned(), support);
    }
    let mut state = weighed(&scene, &masses);
    let (mut reflected, mut transmitted) = (Vec::new(), Vec::new());
    while state.time_s < (DURING + 1.0) * unit_s() {
        interact(&mut state);
        let force = |support: usize| state.supports[support].held[0].reactions[0][0];
        let wave_m_s = WAVE_M_S
            * (PI * (state.time_s / unit_s() / PULSE).min(1.0))
                .sin()
                .powi(2);
        reflected.push(force(0) - z * wave_m_s);
        transmitted.push(-force(1));
        advance(&mut state);
    }
    Pulses {
        step_s: state.time_step_s,
        reflected,
        transmitted,
    }
}

fn specimen() -> String {
    let [spheres, walls] = [between_spheres(), between_impedances()];
    let incident = impedance_n_s_m() * WAVE_M_S;
    let mut cases = Vec::new();
    for (name, a, b) in [
        ("reflected", &spheres.reflected, &walls.reflected),
        ("transmitted", &spheres.transmitted, &walls.transmitted),
    ] {
        let most = |of: &[f64]| {
            of.iter().fold(
                0.0_f64,
                |most, f| {
                    if f.abs() > most.abs() { *f } else { most }
                },
            )
        };
        let what = format!("{name} pulse, largest");
        cases.push(Case::of_scale(
            what,
            [most(b) / incident, most(a) / incident],
            1.0,
            BOUND,
        ));
        let apart = (0..a.len() - 1).map(|i| {
            let time_s = i as f64 * spheres.step_s;
            (Pulses::at(b, walls.step_s, time_s) - a[i]).abs()
        });
        let apart = apart.fold(0.0, f64::max) / incident;
        let what = format!("{name} pulse, largest difference at any time");
        cases.push(Case::of_scale(what, [apart, 0.0], 1.0, BOUND));
    }
    compared("over the incident pulse", "", &cases)
}

const STIFFNESS_N_M: f64 = 1e5;
const SPEED_M_S: f64 = 0.5;
/// Steps in a contact.
const STEPS: f64 = 2000.0;

/// A ball beside a plane, with a linear spring between them.
fn ball(ball: &str, motion: WallMotion, step_s: f64) -> State {
    let text = format!(
        r#"
        version = 1
        run = {{ end_time = 1, time_step = {step_s:e} }}
        materials.ball = {{ density = 2500, young_modulus = 1e7, poisson_ratio = 0.3 }}
        materials.rigid = {{ rigid = true }}
        contacts.ball-ball = {{ law = "linear", normal_stiffness = {STIFFNESS_N_M:e}, restitution = 1 }}
        contacts.ball-rigid = {{ law = "linear", normal_stiffness = {STIFFNESS_N_M:e}, restitution = 1 }}
        bodies.ball = {{ particles = [[0, 0, {RADIUS_M}, {RADIUS_M}]], material = "ball" {ball} }}
        groups.ball = {{ particles = [0] }}
        walls.end = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = "rigid" }}
        "#
    );
    let text = text.replace("groups.ball", "groups.it");
    let mut scene = scene_from_text(&text, "verification.toml", &[]).unwrap();
    scene.walls.get_mut("end").unwrap().motion = motion;
    if !ball.contains("velocity") {
        let mut support = held("it", Hold::Fixed, Factor::One);
        support.holds = [Some(Hold::Fixed); 6];
        scene.supports.insert("it".to_owned(), support);
    }
    started(&scene)
}

/// A ball that hits the end of a bar: a mass, a spring and the impedance one after the other.
fn on_a_bar() -> [String; 2] {
    let mass_kg = 2500.0 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    let (mut forces, mut speeds) = (Vec::new(), Vec::new());
    for of_critical in [1.0, 2.0, 10.0] {
        // The damping ratio of the ball is k/(2 Z omega_0) = 1/(2 of_critical).
        let z = of_critical * (STIFFNESS_N_M * mass_kg).sqrt();
        let decay_1_s = 0.5 * STIFFNESS_N_M / z;
        let omega_1_s = (STIFFNESS_N_M / mass_kg - decay_1_s * decay_1_s).sqrt();
        let contact_s = PI / omega_1_s;
        let motion = WallMotion::Bar {
            direction: [0.0, 0.0, 1.0],
            impedance_n_s_m: z,
            incident_m_s: 0.0,
            factor: Factor::One,
        };
        let moves = format!(", velocity = [0, 0, {:e}]", -SPEED_M_S);
        let mut state = ball(&moves, motion, contact_s / STEPS);
        let (mut most_n, mut carried_j) = (0.0_f64, 0.0);
        while state.time_s < 1.2 * contact_s {
            step(&mut state);
            let force_n = state.walls[0].push.force_n[2];
            most_n = most_n.max(force_n);
            carried_j += state.time_step_s * force_n * force_n / z;
        }
        interact(&mut state);
        let booked_j = -balance(&mut state).wall_work_j;
        let at_s = (omega_1_s / decay_1_s).atan() / omega_1_s;
        let peak_n = STIFFNESS_N_M * SPEED_M_S / omega_1_s
            * (-decay_1_s * at_s).exp()
            * (omega_1_s * at_s).sin();
        let bound = 2.0 * PI / STEPS;
        let what = format!("Z = {of_critical} sqrt(k m)");
        forces.push(Case::new(what.clone(), most_n, peak_n, bound));
        let left = SPEED_M_S * (-decay_1_s * contact_s).exp();
        speeds.push(Case::new(
            format!("{what}, speed after the contact, m/s"),
            velocity(&state, 0).z,
            left,
            bound,
        ));
        let lost_j = 0.5 * mass_kg * (SPEED_M_S.powi(2) - left * left);
        let what = format!("{what}, energy carried off,");
        speeds.push(Case::new(
            format!("{what} uJ"),
            1e6 * carried_j,
            1e6 * lost_j,
            bound,
        ));
        speeds.push(Case::new(
            format!("{what} booked as work of the wall, uJ"),
            1e6 * booked_j,
            1e6 * lost_j,
            bound,
        ));
    }
    [
        compared("largest force", "N", &forces),
        compared("speed and energy", "", &speeds),
    ]
}

/// A weight on a spring: F = M g + sqrt((M g)^2 + k M v^2), without gravity for half a period.
fn weight() -> String {
    let mass_kg = 2.0;
    let mut cases = Vec::new();
    for gravity_m_s2 in [0.0, 9.81] {
        let period_s = PI * (mass_kg / STIFFNESS_N_M).sqrt();
        let motion = WallMotion::Weight {
            direction: [0.0, 0.0, 1.0],
            mass_kg,
            velocity_m_s: SPEED_M_S,
            gravity_m_s2,
        };
        let step_s = period_s / STEPS;
        let mut state = ball("", motion, step_s);
        let (mut most_n, mut contact_s) = (0.0_f64, 0.0);
        while state.steps == 0 || state.walls[0].frame.position_m[2] > 0.0 {
            step(&mut state);
            most_n = most_n.max(state.walls[0].push.force_n[2]);
            contact_s += state.time_step_s;
        }
        let weight_n = mass_kg * gravity_m_s2;
        let stiff_n = (STIFFNESS_N_M * mass_kg).sqrt() * SPEED_M_S;
        // Half a period, and the parts below the point of rest before and after it.
        let wanted_s = period_s * (1.0 + 2.0 / PI * (weight_n / stiff_n).atan());
        let what = format!("g = {gravity_m_s2} m/s²");
        let peak_n = weight_n + weight_n.hypot(stiff_n);
        let bound = (PI / STEPS).powi(2) + 1.0 / STEPS;
        cases.push(Case::new(
            format!("{what}, largest force, N"),
            most_n,
            peak_n,
            bound,
        ));
        cases.push(Case::new(
            format!("{what}, contact, ms"),
            1e3 * contact_s,
            1e3 * wanted_s,
            bound,
        ));
        let rebound = -state.walls[0].velocities_m_s[0][2];
        cases.push(Case::new(
            format!("{what}, rebound, m/s"),
            rebound,
            SPEED_M_S,
            bound,
        ));
        interact(&mut state);
        let work_j = balance(&mut state).wall_work_j;
        let scale_j = 0.5 * mass_kg * SPEED_M_S * SPEED_M_S;
        let what = format!("{what}, work left in the spring, over the impact energy");
        cases.push(Case::of_scale(what, [work_j / scale_j, 0.0], 1.0, bound));
    }
    compared("weight", "", &cases)
}

#[test]
fn dynamic_tests_are_as_on_the_page() {
    let page = on_one_thread(|| {
        let [forces, speeds] = on_a_bar();
        let tables = [
            ("ends", ends()),
            ("specimen", specimen()),
            ("forces", forces),
            ("speeds", speeds),
            ("weight", weight()),
        ];
        filled(include_str!("dynamic-tests.md"), &tables)
    });
    assert_shown(&[("dynamic-tests.md".to_owned(), page)]);
}
