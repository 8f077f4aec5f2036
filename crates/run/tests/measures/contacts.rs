//! Forces, overlaps and durations of contacts compared with closed forms, read once at the end.

use std::f64::consts::PI;

use super::{Measured, assert_near};

const YOUNG_PA: f64 = 1e7;
const POISSON: f64 = 0.3;
const RADIUS_M: f64 = 5e-3;
const DENSITY: f64 = 2000.0;

fn mass_kg() -> f64 {
    DENSITY * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

/// A falling ball that hits `with` at this speed, m/s; `more` describes the object.
fn ball(speed_m_s: f64, with: &str, law: &str, more: &str) -> String {
    let mut text = format!(
        "version = 1
run = {{ end_time = 1, safety_factor = 0.05 }}
materials.m = {{ density = {DENSITY}, young_modulus = {YOUNG_PA}, poisson_ratio = {POISSON} }}
contacts.m-m = {{ restitution = 1, friction = 0{law} }}
bodies.ball = {{ particles = [[0, 0, 6e-3, {RADIUS_M}]], material = \"m\", velocity = [0, 0, {}] }}
{more}
",
        -speed_m_s
    );
    for (quantity, at) in [
        ("contact_force", "largest"),
        ("contact_force_z", "largest"),
        ("contact_force_x", "largest"),
        ("contact_overlap", "largest"),
        ("contact_duration", "end"),
    ] {
        text += &format!(
            "measures.{quantity} = {{ of = \"ball\", with = \"{with}\", quantity = \"{quantity}\", statistic = \"{at}\" }}\n"
        );
    }
    for quantity in ["force", "force_z"] {
        text += &format!(
            "measures.{quantity} = {{ of = \"ball\", quantity = \"{quantity}\", statistic = \"largest\" }}\n"
        );
    }
    text += "measures.impulse = { of = \"ball\", quantity = \"force_z\", statistic = \"mean\" }\n";
    text
}

const FLOOR: &str =
    "walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"m\" }
measures.on_floor = { of = \"floor\", quantity = \"force_z\", statistic = \"smallest\" }";

/// Checks the largest force, largest overlap and duration, each to 1 %, and the total force on the
/// ball.
fn assert_impact(text: &str, [force_n, overlap_m, duration_s]: [f64; 3], end_s: f64) {
    let values = Measured::new(text).run(end_s);
    for name in ["contact_force", "contact_force_z", "force", "force_z"] {
        assert_near(values[name], force_n, 0.01 * force_n);
    }
    assert_eq!(values["contact_force_x"], 0.0);
    assert_near(values["contact_overlap"], overlap_m, 0.01 * overlap_m);
    assert_near(values["contact_duration"], duration_s, 0.01 * duration_s);
    if let Some(on_floor) = values.get("on_floor") {
        assert_eq!(-on_floor, values["force_z"]);
    }
}

/// Hertz: d = (15 m v^2/(16 E* sqrt(R)))^(2/5), F = 4/3 E* sqrt(R) d^(3/2), t = 2.9432 d/v.
fn hertz(radius_m: f64, mass_kg: f64, speed_m_s: f64) -> [f64; 3] {
    let reduced_pa = YOUNG_PA / (2.0 * (1.0 - POISSON * POISSON));
    let stiff = reduced_pa * radius_m.sqrt();
    let overlap_m = (15.0 * mass_kg * speed_m_s.powi(2) / (16.0 * stiff)).powf(0.4);
    let force_n = 4.0 / 3.0 * stiff * overlap_m.powf(1.5);
    [force_n, overlap_m, 2.943_2 * overlap_m / speed_m_s]
}

#[test]
fn a_sphere_on_a_wall_by_hertz() {
    let text = ball(1.0, "floor", "", FLOOR);
    assert_impact(&text, hertz(RADIUS_M, mass_kg(), 1.0), 3e-3);
}

#[test]
fn two_spheres_by_hertz() {
    let other = format!(
        "bodies.other = {{ particles = [[0, 0, -6e-3, {RADIUS_M}]], material = \"m\", velocity = [0, 0, 0.5] }}"
    );
    let text = ball(0.5, "other", "", &other);
    assert_impact(&text, hertz(0.5 * RADIUS_M, 0.5 * mass_kg(), 1.0), 5e-3);
}

/// A spring: t = pi sqrt(m/k), F = v sqrt(m k), d = v sqrt(m/k).
#[test]
fn a_sphere_on_a_wall_by_the_linear_law() {
    let stiffness = 1e4;
    let text = ball(
        1.0,
        "floor",
        ", law = \"linear\", normal_stiffness = 1e4",
        FLOOR,
    );
    let (mass, root) = (mass_kg(), (mass_kg() / stiffness).sqrt());
    assert_impact(&text, [(mass * stiffness).sqrt(), root, PI * root], 5e-3);
}

/// The time integral of the force is the change of the momentum, to rounding, also for a body that
/// becomes a cluster during contact.
#[test]
fn force_times_time_is_momentum_through_a_replacement() {
    let text = "version = 1
run = { end_time = 1, time_step = 1e-6 }
materials.m = { density = 2000, young_modulus = 1e7 }
contacts.m-m = { restitution = 0.7, friction = 0.4 }
bonds.stiff = { young_modulus = 1e7, poisson_ratio = 0.3 }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"m\" }
[bodies.lump]
material = \"m\"
bonds = \"stiff\"
particles = [[0, 0, 0, 5e-3], [8e-3, 0, 1e-3, 5e-3], [0, 8e-3, 2e-3, 4e-3], [8e-3, 8e-3, 0, 3e-3]]
bond_list = [[0, 1], [0, 2], [1, 3], [2, 3]]
position = [0, 0, 5.1e-3]
velocity = [0.3, 0, -1]
start_as = \"clump\"
[replacement.lump]
when = { time = 3e-4 }
[measures]
force_x = { of = \"lump\", quantity = \"force_x\", statistic = \"mean\" }
force_z = { of = \"lump\", quantity = \"force_z\", statistic = \"mean\" }
with_floor = { of = \"lump\", with = \"floor\", quantity = \"contact_force_z\", statistic = \"mean\" }
deepest = { of = \"lump\", with = \"floor\", quantity = \"contact_overlap\", statistic = \"largest\" }
duration = { of = \"lump\", with = \"floor\", quantity = \"contact_duration\" }
speed_x = { of = \"lump\", quantity = \"velocity_x\" }
speed_z = { of = \"lump\", quantity = \"velocity_z\" }
";
    let mut run = Measured::new(text);
    let template = run.state.clumps.templates[0].clone();
    let end_s = 4e-3;
    let values = run.run(end_s);
    assert!(run.state.clumps.all.is_empty());
    // It has separated from the floor.
    assert!(run.state.walls[0].touching.is_empty());
    assert!(values["duration"] > 4e-4 && values["duration"] < end_s);
    assert!(values["deepest"] > 0.0);
    assert_eq!(values["force_z"], values["with_floor"]);
    let time_s = run.state.time_s;
    for (force, speed, before) in [("force_x", "speed_x", 0.3), ("force_z", "speed_z", -1.0)] {
        let gained = template.mass_kg * (values[speed] - before);
        assert_near(values[force] * time_s, gained, 1e-10 * template.mass_kg);
    }
}

/// Each of two exerts the same force on the other, and a third counts with neither.
#[test]
fn what_two_do_to_each_other_is_opposite() {
    let text = "version = 1
run = { end_time = 1, safety_factor = 0.3 }
materials.m = { density = 2000, young_modulus = 1e7 }
contacts.m-m = { restitution = 0.8, friction = 0.5 }
bodies.a = { particles = [[0, 0, 0, 5e-3]], material = \"m\", velocity = [0, 0, 1], angular_velocity = [0, 90, 0] }
bodies.b = { particles = [[1e-3, 0, 10.1e-3, 5e-3]], material = \"m\" }
bodies.c = { particles = [[1e-3, 0, 20.2e-3, 5e-3]], material = \"m\" }
[measures]
ab = { of = \"a\", with = \"b\", quantity = \"contact_force_x\", statistic = \"mean\" }
ba = { of = \"b\", with = \"a\", quantity = \"contact_force_x\", statistic = \"mean\" }
bc = { of = \"b\", with = \"c\", quantity = \"contact_force_x\", statistic = \"mean\" }
b = { of = \"b\", quantity = \"force_x\", statistic = \"mean\" }
ac = { of = \"a\", with = \"c\", quantity = \"contact_duration\" }
all = { quantity = \"force\", statistic = \"largest\" }
";
    let values = Measured::new(text).run(4e-3);
    let size = values["ab"].abs();
    assert!(size > 0.0 && values["bc"].abs() > 0.0);
    assert_near(values["ab"], -values["ba"], 1e-13 * size);
    assert_near(values["b"], values["ba"] + values["bc"], 1e-13 * size);
    assert_eq!((values["ac"], values["all"]), (0.0, 0.0));
}

/// Forces and contacts of sleeping bodies are still measured.
#[test]
fn a_body_that_sleeps_rests_on_its_floor() {
    let text = "version = 1
run = { end_time = 1, gravity = [0, 0, -9.81] }
materials.m = { density = 2000, young_modulus = 1e6 }
contacts.m-m = { restitution = 0.1, friction = 0.5 }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"m\" }
bodies.ball = { particles = [[0, 0, 5.001e-3, 5e-3]], material = \"m\" }
sleep = { after = \"20 ms\" }
[measures]
force = { of = \"ball\", quantity = \"force_z\" }
overlap = { of = \"ball\", with = \"floor\", quantity = \"contact_overlap\" }
duration = { of = \"ball\", with = \"floor\", quantity = \"contact_duration\" }
";
    let mut run = Measured::new(text);
    let values = run.run(0.3);
    assert_eq!(run.state.sleep.as_ref().unwrap().bodies, 1);
    let weight = 9.81 * mass_kg();
    assert_near(values["force"], weight, 0.02 * weight);
    assert!(values["overlap"] > 0.0);
    assert!(values["duration"] > 0.27, "{}", values["duration"]);
}

#[test]
fn nothing_is_followed_where_nobody_asks() {
    let text = ball(1.0, "floor", "", FLOOR);
    let text = text.split("measures").next().unwrap();
    let run = Measured::new(&format!(
        "{text}\nmeasures.place = {{ quantity = \"position_z\" }}"
    ));
    assert!(run.state.watches.is_empty());
}
