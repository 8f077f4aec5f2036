//! Freely rotating rigid clumps, and their replacement by bonded clusters.

use std::f64::consts::PI;

use dem_run::step::exchange;
use dem_run::{State, step};
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::{place, spin, started, velocity};
use super::table::{Case, compared};

const RADIUS_M: f64 = 5e-3;
const DENSITY_KG_M3: f64 = 2500.0;

/// Number of steps per radian of rotation.
const PER_RADIAN: f64 = 20.0;

/// A body of equal spheres whose principal axes are x, y and z and whose centre is the origin.
#[derive(Debug, Clone, Copy)]
struct Body<'a> {
    places_m: &'a [[f64; 3]],
}

/// Two spheres along x: a symmetric top.
const PAIR: Body = Body {
    places_m: &[[-6e-3, 0.0, 0.0], [6e-3, 0.0, 0.0]],
};

/// Four spheres in the plane of x and y: three different moments of inertia.
const CROSS: Body = Body {
    places_m: &[
        [-9e-3, 0.0, 0.0],
        [9e-3, 0.0, 0.0],
        [0.0, -5e-3, 0.0],
        [0.0, 5e-3, 0.0],
    ],
};

fn sphere_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

fn sphere_inertia_kg_m2() -> f64 {
    0.4 * sphere_kg() * RADIUS_M * RADIUS_M
}

impl Body<'_> {
    /// Principal moments of inertia about x, y and z, kg m2.
    fn moments_kg_m2(&self) -> Vector3<f64> {
        let of_place = |&[x, y, z]: &[f64; 3]| {
            let squares = Vector3::new(y * y + z * z, x * x + z * z, x * x + y * y);
            squares * sphere_kg() + Vector3::repeat(sphere_inertia_kg_m2())
        };
        self.places_m.iter().map(of_place).sum()
    }

    /// The body as a clump with this spin and velocity, and keys of its replacement.
    fn state(&self, step_s: f64, spin: [f64; 3], velocity: [f64; 3], replacement: &str) -> State {
        let spheres = self.places_m.iter();
        let spheres = spheres.map(|[x, y, z]| format!("[{x:e}, {y:e}, {z:e}, {RADIUS_M:e}]"));
        let spheres: Vec<String> = spheres.collect();
        let bonds = (1..self.places_m.len()).map(|i| format!("[0, {i}]"));
        let bonds: Vec<String> = bonds.collect();
        let triple = |[x, y, z]: [f64; 3]| format!("[{x:e}, {y:e}, {z:e}]");
        started(&format!(
            r#"
            version = 1
            run = {{ end_time = "1 h", time_step = {step_s:e} }}
            materials.stone = {{ density = {DENSITY_KG_M3:e}, young_modulus = "10 MPa" }}
            bonds.glue = {{ young_modulus = "10 MPa", poisson_ratio = 0.3 }}
            contacts.stone-stone = {{ restitution = 0.5 }}
            bodies.top = {{ particles = [{}], bond_list = [{}], material = "stone", bonds = "glue", start_as = "clump", velocity = {}, angular_velocity = {} }}
            {replacement}
            "#,
            spheres.join(", "),
            bonds.join(", "),
            triple(velocity),
            triple(spin),
        ))
    }
}

/// Rotation of the only clump, from its principal axes to space.
fn rotation(state: &State) -> UnitQuaternion<f64> {
    let [x, y, z, w] = state.clumps.all[0].turned;
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), angle)
}

/// Rotation since the start of a symmetric top about x with this spin: it rotates about its own
/// axis, while that precesses about its angular momentum.
fn symmetric_top(body: &Body, spin: Vector3<f64>, time_s: f64) -> UnitQuaternion<f64> {
    let moments = body.moments_kg_m2();
    let momentum = moments.component_mul(&spin);
    let own = spin.x * (1.0 - moments.x / moments.y);
    about(momentum, momentum.norm() / moments.y * time_s) * about(Vector3::x(), own * time_s)
}

/// Deviation of the rotation of a symmetric top from the closed form, over the angle of rotation:
/// the splitting is exact for it, except for rounding.
fn symmetric() -> String {
    let mut cases = Vec::new();
    for spin in [[100.0, 10.0, 0.0], [100.0, 60.0, 0.0], [10.0, 100.0, 20.0]] {
        for turns in [1.0, 10.0, 100.0] {
            let size = Vector3::from(spin).norm();
            let mut state = PAIR.state(1.0 / (PER_RADIAN * size), spin, [0.0; 3], "");
            let before = rotation(&state);
            while state.time_s * size < turns * 2.0 * PI {
                step(&mut state);
            }
            let turned = rotation(&state) * before.inverse();
            let off = turned.angle_to(&symmetric_top(&PAIR, spin.into(), state.time_s));
            let what = format!("spin {spin:?} rad/s; turns: {turns}");
            let angle = 2.0 * PI * turns;
            cases.push(Case::of_scale(what, [off, 0.0], angle, 1e-9));
        }
    }
    compared("top", "rad", &cases)
}

/// Complete elliptic integral of the first kind, by the arithmetic-geometric mean.
fn elliptic(modulus_squared: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus_squared).sqrt());
    while (a - b).abs() > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * PI / a
}

/// Period of the spin of a free body in its own axes, from its moments of inertia, ascending, s.
fn euler_period_s(moments: Vector3<f64>, spin: Vector3<f64>) -> f64 {
    let momentum = moments.component_mul(&spin);
    let (square, twice_energy) = (momentum.norm_squared(), momentum.dot(&spin));
    let [i1, i2, i3] = [moments.x, moments.y, moments.z];
    // About the axis of the largest moment, or that of the smallest.
    let (low, high) = (square - twice_energy * i1, twice_energy * i3 - square);
    let (rate, part) = if square > twice_energy * i2 {
        ((i3 - i2) * low, (i2 - i1) * high)
    } else {
        ((i2 - i1) * high, (i3 - i2) * low)
    };
    4.0 * elliptic(part / rate) / (rate / (i1 * i2 * i3)).sqrt()
}

/// Period of the spin of the cross in its own axes, measured in a run, s.
fn period_s(spin: [f64; 3], per_radian: f64) -> f64 {
    let size = Vector3::from(spin).norm();
    let momentum = CROSS.moments_kg_m2().component_mul(&Vector3::from(spin));
    let mut state = CROSS.state(1.0 / (per_radian * size), spin, [0.0; 3], "");
    let start = rotation(&state);
    // The component of the angular momentum along the body's x or z axis, whichever changes sign.
    let axis = if spin[0] > spin[2] {
        Vector3::z()
    } else {
        Vector3::x()
    };
    let along = |state: &State| {
        let turned = rotation(state) * start.inverse();
        (turned.inverse() * momentum).dot(&axis)
    };
    let (mut before, mut crossings) = (along(&state), Vec::new());
    while crossings.len() < 11 {
        step(&mut state);
        let now = along(&state);
        if before * now < 0.0 {
            crossings.push(state.time_s - state.time_step_s * now / (now - before));
        }
        before = now;
    }
    (crossings[10] - crossings[0]) / 5.0
}

/// Periods of a free body with three different moments of inertia, at two steps.
fn asymmetric() -> String {
    let mut cases = Vec::new();
    for (name, spin) in [
        ("smallest moment", [100.0, 20.0, 30.0]),
        ("largest moment", [30.0, 20.0, 100.0]),
        ("middle moment, which is unstable", [3.0, 100.0, 3.1]),
    ] {
        let wanted = euler_period_s(CROSS.moments_kg_m2(), spin.into());
        for per_radian in [PER_RADIAN, 2.0 * PER_RADIAN] {
            let found = period_s(spin, per_radian);
            let what = format!("{name}, {per_radian} steps per radian");
            let bound = 1.0 / (per_radian * per_radian);
            cases.push(Case::new(what, 1e3 * found, 1e3 * wanted, bound).rounding(1e-8));
        }
    }
    compared("turns about", "ms", &cases)
}

/// Sums over spheres, at the time of their velocities, half a step before that of their positions.
#[derive(Debug, Clone, Copy, Default)]
struct Whole {
    mass_kg: f64,
    centre_m: Vector3<f64>,
    momentum_n_s: Vector3<f64>,
    /// Angular momentum about the centre.
    angular_n_m_s: Vector3<f64>,
    /// Sum of the three moments.
    inertia_kg_m2: f64,
    kinetic_j: f64,
}

impl Whole {
    fn of(state: &State) -> Self {
        let spheres = 0..state.particles.poses.len();
        let mass = |i: usize| 1.0 / state.particles.motions[i].inverse_mass;
        let before = |i: usize| place(state, i) - velocity(state, i) * (0.5 * state.time_step_s);
        let mut whole = Self::default();
        for i in spheres.clone() {
            whole.mass_kg += mass(i);
            whole.centre_m += before(i) * mass(i);
        }
        whole.centre_m /= whole.mass_kg;
        let own = sphere_inertia_kg_m2();
        for i in spheres {
            let (arm, v, w) = (
                before(i) - whole.centre_m,
                velocity(state, i),
                spin(state, i),
            );
            whole.momentum_n_s += v * mass(i);
            whole.angular_n_m_s += arm.cross(&v) * mass(i) + w * own;
            whole.inertia_kg_m2 += 2.0 * arm.norm_squared() * mass(i) + 3.0 * own;
            whole.kinetic_j += 0.5 * (mass(i) * v.norm_squared() + own * w.norm_squared());
        }
        whole
    }

    /// The cross as a clump that has flown for a time.
    fn of_clump(velocity: Vector3<f64>, spin: Vector3<f64>, flown_s: f64) -> Self {
        let mass_kg = CROSS.places_m.len() as f64 * sphere_kg();
        let moments = CROSS.moments_kg_m2();
        let angular_n_m_s = moments.component_mul(&spin);
        Self {
            mass_kg,
            centre_m: velocity * flown_s,
            momentum_n_s: velocity * mass_kg,
            angular_n_m_s,
            inertia_kg_m2: moments.sum(),
            kinetic_j: 0.5 * (mass_kg * velocity.norm_squared() + spin.dot(&angular_n_m_s)),
        }
    }
}

/// The quantities that a clump and the cluster that replaces it have in common: sums over the
/// spheres, and their positions.
fn replaced() -> [String; 2] {
    let (spin, velocity) = ([30.0, 20.0, 100.0], [3.0, -2.0, 1.0]);
    let step_s = 1e-5;
    let when = "replacement.top.when = { time = \"5 ms\" }";
    let mut state = CROSS.state(step_s, spin, velocity, when);
    let start = rotation(&state);
    let mut turned = UnitQuaternion::identity();
    while !state.clumps.all.is_empty() {
        turned = rotation(&state) * start.inverse();
        step(&mut state);
    }
    let (spin, velocity) = (Vector3::from(spin), Vector3::from(velocity));
    let found = Whole::of(&state);
    let wanted = Whole::of_clump(velocity, spin, state.time_s - 0.5 * step_s);
    // Spheres move in straight lines in the first step, which deviate from their circle by the
    // square of its angle.
    let straight = (spin.norm() * step_s).powi(2);
    let off = found.angular_n_m_s - wanted.angular_n_m_s;
    let angular = wanted.angular_n_m_s.norm();
    let rounding = 1e-12;
    let vectors = |name: &str, pair: [Vector3<f64>; 2], bound: f64| {
        Case::new(name, pair[0].norm(), pair[1].norm(), bound)
    };
    let sums = [
        Case::new("mass, kg", found.mass_kg, wanted.mass_kg, rounding),
        vectors(
            "momentum, N s",
            [found.momentum_n_s, wanted.momentum_n_s],
            rounding,
        ),
        vectors("centre, m", [found.centre_m, wanted.centre_m], rounding),
        Case::new(
            "sum of the moments of inertia, kg m2",
            found.inertia_kg_m2,
            wanted.inertia_kg_m2,
            straight,
        ),
        vectors(
            "angular momentum, N m s",
            [found.angular_n_m_s, wanted.angular_n_m_s],
            straight,
        ),
        Case::of_scale(
            "change of it as a vector, N m s",
            [off.norm(), 0.0],
            angular,
            straight,
        ),
        Case::new(
            "kinetic energy, J",
            found.kinetic_j,
            wanted.kinetic_j,
            straight,
        ),
    ];
    // The path of the clump of the previous step.
    let in_body = (turned.inverse() * wanted.angular_n_m_s).component_div(&CROSS.moments_kg_m2());
    let spin = turned * in_body;
    let turned = about(spin, spin.norm() * step_s) * turned;
    let places = CROSS.places_m.iter().enumerate().map(|(i, &there)| {
        let wanted = velocity * state.time_s + turned * Vector3::from(there);
        let off = (place(&state, i) - wanted).norm();
        let arm = Vector3::from(there).norm();
        Case::of_scale(format!("sphere {i}"), [1e3 * off, 0.0], 1e3 * arm, straight)
    });
    let places: Vec<Case> = places.collect();
    [compared("sum", "", &sums), compared("place", "mm", &places)]
}

/// Speed of each of two plates that close on the pair, m/s.
const CLOSING_M_S: f64 = 0.05;

/// Overlap of the contacts with two plates at which the pair is replaced, m. `when`: its trigger.
fn overlap_at_replacement_m(when: &str) -> f64 {
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = "1 us" }}
        materials.stone = {{ density = {DENSITY_KG_M3:e}, young_modulus = "10 MPa", poisson_ratio = 0.25 }}
        bonds.glue = {{ young_modulus = "10 MPa", poisson_ratio = 0.3 }}
        contacts.stone-stone = {{ restitution = 1 }}
        bodies.pair = {{ particles = [[-6e-3, 0, 0, {RADIUS_M:e}], [6e-3, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue", start_as = "clump" }}
        walls.below = {{ plane = {{ point = [0, 0, {:e}], normal = [0, 0, 1] }}, material = "stone", velocity = [0, 0, {CLOSING_M_S:e}] }}
        walls.above = {{ plane = {{ point = [0, 0, {RADIUS_M:e}], normal = [0, 0, -1] }}, material = "stone", velocity = [0, 0, {:e}] }}
        replacement.pair.when = {{ {when} }}
        "#,
        -RADIUS_M, -CLOSING_M_S
    ));
    let mut now_s = state.time_s;
    while !state.clumps.all.is_empty() {
        now_s = state.time_s;
        step(&mut state);
    }
    CLOSING_M_S * now_s
}

/// The two triggers that see a squeeze, at the value that Hertz's law gives for an overlap.
fn squeezed() -> String {
    let modulus_pa = 1e7 / (2.0 * (1.0 - 0.25 * 0.25));
    let volume_m3 = 8.0 / 3.0 * PI * RADIUS_M.powi(3);
    let mut cases = Vec::new();
    // Reached in the middle of a step.
    for overlap_m in [2.0025e-5, 2.00025e-4] {
        let force_n = 4.0 / 3.0 * modulus_pa * RADIUS_M.sqrt() * f64::powf(overlap_m, 1.5);
        let stress_pa = 4.0 * force_n * (RADIUS_M - overlap_m) / volume_m3;
        // One step.
        let bound = 1.01e-6 * CLOSING_M_S / overlap_m;
        for (name, limit, unit) in [
            ("contact_force", force_n, "N"),
            ("principal_stress", stress_pa, "Pa"),
        ] {
            let found_m = overlap_at_replacement_m(&format!("{name} = {limit:e}"));
            let what = format!("{name} = {limit:.4e} {unit}");
            cases.push(Case::new(what, 1e3 * found_m, 1e3 * overlap_m, bound));
        }
    }
    compared("trigger", "mm", &cases)
}

/// Energy over mass that a sphere takes in during its first impact, at 3 m/s relative to what it
/// hits, J/kg, with this step.
fn taken_in_j_kg(target: &str, restitution: f64, step_s: f64) -> f64 {
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = {step_s:e} }}
        materials.stone = {{ density = {DENSITY_KG_M3:e}, young_modulus = "100 MPa", poisson_ratio = 0.25 }}
        materials.steel = {{ young_modulus = "300 MPa", poisson_ratio = 0.3 }}
        materials.anvil.rigid = true
        contacts.stone-stone = {{ restitution = {restitution} }}
        contacts.stone-steel = {{ restitution = {restitution} }}
        contacts.stone-anvil = {{ restitution = {restitution} }}
        bodies.ball = {{ particles = [[0, 0, 5.001e-3, {RADIUS_M:e}]], material = "stone", start_as = "clump", velocity = [0, 0, -3] }}
        bodies.halves = {{ particles = [[0, 0, 0, 1], [1, 0, 0, 1]], material = "stone" }}
        replacement.ball.daughters.classes = [{{ from = "1000 kJ/kg", body = "halves" }}]
        {target}
        "#
    ));
    let mut largest_j: f64 = 0.0;
    while state.time_s < 1e-3 {
        step(&mut state);
        largest_j = largest_j.max(state.clumps.all[0].intake.impact_j);
    }
    largest_j / sphere_kg()
}

/// The energy of a single normal impact: that of the relative motion, and the sphere's share of it.
fn impacts() -> String {
    let plate = |material: &str| {
        format!(
            "walls.plate = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"{material}\" }}"
        )
    };
    let other = format!(
        "bodies.other = {{ particles = [[0, 0, -5.001e-3, {RADIUS_M:e}]], material = \"stone\", start_as = \"clump\" }}"
    );
    let steel = 0.9375 / (0.9375 + 0.91 / 3.0);
    let mut cases = Vec::new();
    for restitution in [1.0, 0.5] {
        for (what, target, share, reduced) in [
            ("rigid plate", plate("anvil"), 1.0, 1.0),
            ("plate of 300 MPa", plate("steel"), steel, 1.0),
            ("equal sphere", other.clone(), 0.5, 0.5),
        ] {
            let wanted = share * reduced * 0.5 * 9.0;
            // The last step before the turn ends at most half a step away from it: (a dt/2v)^2
            // with Hertz's largest deceleration.
            let step_s = 1e-6;
            let modulus_pa = share * 1e8 / 0.9375;
            let deep_m = (0.9375 * sphere_kg() * 9.0 / (modulus_pa * RADIUS_M.sqrt())).powf(0.4);
            let bound = 2.0 * (0.625 * step_s * 3.0 / (reduced * deep_m)).powi(2);
            let found = taken_in_j_kg(&target, restitution, step_s);
            let what = format!("{what}, restitution {restitution}");
            cases.push(Case::new(what, found, wanted, bound));
        }
    }
    compared("impact on", "J/kg", &cases)
}

/// A sphere that daughters replace by this rule, with further keys of the sphere.
fn to_be_replaced(rule: &str, more: &str) -> State {
    let daughters = [
        ("halves", "[[0, 0, 0, 1], [2, 0.1, 0, 0.8]]"),
        (
            "pieces",
            "[[0, 0, 0, 1], [2, 0.1, 0, 0.8], [0.9, 1.4, 0.2, 0.6], [1, 0.3, 1.5, 0.7], [0.8, -1.2, -0.4, 0.5]]",
        ),
    ];
    let named = daughters.iter().filter(|(name, _)| rule.contains(name));
    let named = named.map(|(name, spheres)| {
        format!("bodies.{name} = {{ particles = {spheres}, material = \"stone\" }}\n")
    });
    let named: String = named.collect();
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = 2e-6, seed = 1 }}
        materials.stone = {{ density = {DENSITY_KG_M3:e}, young_modulus = "100 MPa", poisson_ratio = 0.25 }}
        materials.anvil.rigid = true
        contacts.stone-stone = {{ restitution = 0.5 }}
        contacts.stone-anvil = {{ restitution = 0.5 }}
        bodies.ball = {{ particles = [[0, 0, 0, {RADIUS_M:e}]], material = "stone", start_as = "clump", {more} }}
        {named}
        walls.plate = {{ plane = {{ point = [0, 0, -5.01e-3], normal = [0, 0, 1] }}, material = "anvil" }}
        replacement.ball.daughters = {{ {rule} }}
        "#
    ))
}

/// Mass, centre, momentum and angular momentum about the centre of all clumps.
fn sums_of_clumps(state: &State) -> (f64, [Vector3<f64>; 3]) {
    let zero = Vector3::zeros();
    let (mut mass_kg, mut moment, mut momentum, mut angular) = (0.0, zero, zero, zero);
    for clump in &state.clumps.all {
        let kg = state.clumps.template(clump).mass_kg;
        let [at, v] = [clump.place_m, clump.velocity_m_s].map(Vector3::from);
        mass_kg += kg;
        moment += kg * at;
        momentum += kg * v;
        angular += kg * at.cross(&v) + Vector3::from(clump.angular_momentum);
    }
    let centre = moment / mass_kg;
    (
        mass_kg,
        [centre, momentum, angular - centre.cross(&momentum)],
    )
}

/// What five daughters have in common with the sphere that they replace, which flies and spins.
fn kept_by_daughters() -> String {
    let rule = r#"classes = [{ from = 10, body = "pieces" }], energy = "all-impacts""#;
    let motion = "velocity = [3, -2, 1], angular_velocity = [300, 200, -500]";
    let mut state = to_be_replaced(rule, motion);
    state.clumps.all[0].intake.before_j = 100.0 * sphere_kg();
    let (wanted_kg, wanted) = sums_of_clumps(&state);
    exchange(&mut state);
    assert_eq!(state.clumps.all.len(), 5);
    let (found_kg, found) = sums_of_clumps(&state);
    let spin = wanted[2].norm();
    let sizes = [RADIUS_M, wanted[1].norm(), spin];
    let names = [
        "centre, m",
        "momentum, N s",
        "angular momentum about the centre, N m s",
    ];
    let mut cases = vec![Case::new("mass, kg", found_kg, wanted_kg, 1e-12)];
    for (k, name) in names.into_iter().enumerate() {
        let off = (found[k] - wanted[k]).norm();
        cases.push(Case::of_scale(
            format!("change of the {name}"),
            [off, 0.0],
            sizes[k],
            1e-12,
        ));
    }
    compared("sum", "", &cases)
}

/// Spheres that hit the plate, with the energy over mass of the impact, J/kg: the number of pieces.
fn by_class() -> String {
    let rule = r#"classes = [{ from = 2, body = "halves" }, { from = 10, body = "pieces" }]"#;
    let cases = [(1.9_f64, 1.0), (2.1, 2.0), (9.5, 2.0), (10.5, 5.0)].map(|(j_kg, wanted)| {
        let motion = format!("velocity = [0, 0, {:e}]", -(2.0 * j_kg).sqrt());
        let mut state = to_be_replaced(rule, &motion);
        while state.time_s < 3e-3 {
            step(&mut state);
        }
        let pieces = state.clumps.all.len() as f64;
        Case::new(format!("{j_kg} J/kg"), pieces, wanted, 1e-9)
    });
    compared("energy of the impact", "", &cases)
}

/// Fraction of 2000 spheres of the same energy that are replaced, with scattered strengths. Bounds
/// are three standard deviations of so many draws.
fn by_scatter() -> String {
    const COUNT: u32 = 2000;
    let mut cases = Vec::new();
    for modulus in [2.0, 6.0] {
        let rule = format!(
            r#"classes = [{{ from = 10, body = "halves" }}], energy = "all-impacts", weibull_modulus = {modulus}"#
        );
        let start = to_be_replaced(&rule, "velocity = [0, 0, 0]");
        for j_kg in [6.0_f64, 9.0, 12.0] {
            let is_replaced = |first_id: &u32| {
                let mut state = start.clone();
                state.clumps.all[0].first_id = *first_id;
                state.clumps.all[0].intake.before_j = j_kg * sphere_kg();
                exchange(&mut state);
                state.clumps.all.len() > 1
            };
            let found = (0..COUNT).filter(is_replaced).count() as f64 / f64::from(COUNT);
            let wanted = 1.0 - (-(j_kg / 10.0).powf(modulus)).exp();
            let bound = 3.0 * (wanted * (1.0 - wanted) / f64::from(COUNT)).sqrt();
            let what = format!("modulus {modulus}, {j_kg} J/kg");
            cases.push(Case::of_scale(what, [found, wanted], 1.0, bound));
        }
    }
    compared("strengths", "", &cases)
}

/// The page of clumps equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [sums, places] = replaced();
        filled(
            include_str!("clumps.md"),
            &[
                ("angles", symmetric()),
                ("periods", asymmetric()),
                ("squeezes", squeezed()),
                ("impacts", impacts()),
                ("kept by daughters", kept_by_daughters()),
                ("classes", by_class()),
                ("scatter", by_scatter()),
                ("sums", sums),
                ("places", places),
            ],
        )
    });
    assert_shown(&[("clumps.md".to_owned(), page)]);
}
