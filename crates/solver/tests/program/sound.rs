//! Scenes whose results are right, which the verdict must not doubt, and that must not stop.

use serde_json::Value;

use super::Bench;

fn json(bench: &Bench, name: &str, scene: &str) -> Value {
    let path = bench.write(name, scene);
    serde_json::from_str(&bench.good(&path, &["--json", "--quiet"])).unwrap()
}

/// A sphere that comes to a wall with adhesion, and stays there or not.
fn adhesive(radius_m: f64, speed_m_s: f64, restitution: f64, wet: bool) -> String {
    let law = if wet {
        let volume_m3 = 1e-4 * radius_m.powi(3);
        format!("liquid_bridge = {{ surface_tension = 0.073, volume = {volume_m3} }}")
    } else {
        "law = \"dmt\", work_of_adhesion = 0.05".to_owned()
    };
    let (height_m, end_s) = (1.01 * radius_m, 0.05 * radius_m / speed_m_s);
    format!(
        "version = 1
run.end_time = {end_s}
materials.a = {{ density = 2500, young_modulus = 50e6, poisson_ratio = 0.25 }}
contacts.a-a = {{ restitution = {restitution}, friction = 0.4, {law} }}
bodies.s = {{ particles = [[0, 0, {height_m}, {radius_m}]], material = \"a\", velocity = [0, 0, {}] }}
walls.w = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"a\" }}
",
        -speed_m_s
    )
}

/// Over all sizes and speeds: the energy that attraction releases is no spurious energy, even where
/// it is many times the kinetic energy.
#[test]
fn attraction_does_not_stop_a_run() {
    let bench = Bench::new();
    for radius_m in [1e-6, 1e-4, 1e-2, 1.0] {
        for speed_m_s in [1e-5, 1e-3, 0.1, 10.0] {
            // A slow large sphere would take many steps to come.
            if radius_m / speed_m_s > 2.0 {
                continue;
            }
            for restitution in [1.0, 0.5] {
                for wet in [false, true] {
                    let scene = adhesive(radius_m, speed_m_s, restitution, wet);
                    json(&bench, "scene.toml", &scene);
                }
            }
        }
    }
}

/// LAMMPS report 4180: it must stick, and nothing is wrong with its energy.
#[test]
fn a_slow_sphere_sticks_and_its_energy_closes() {
    let bench = Bench::new();
    let scene =
        adhesive(1e-4, 1e-3, 0.5, false).replace("run.end_time = 0.005", "run.end_time = 0.02");
    let summary = json(&bench, "slow.toml", &scene);
    assert_eq!(summary["verdict"]["sound"], true, "{}", summary["verdict"]);
    assert!(summary["energy_error"].as_f64().unwrap() < 0.01);
}

/// It swings about its overlap at rest: adhesion and elastic energy, of some 1e-8 J each, nearly
/// cancel.
#[test]
fn energies_that_cancel_are_each_counted() {
    let bench = Bench::new();
    let scene = "version = 1
run = { end_time = 0.02, initial_overlap = \"keep\" }
materials.m = { density = 2500, young_modulus = 1e7, poisson_ratio = 0.3 }
materials.w.rigid = true
contacts.m-w = { law = \"dmt\", work_of_adhesion = 0.5, restitution = 1 }
bodies.p = { particles = [[0, 0, 0.000999, 0.001]], material = \"m\" }
walls.f = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"w\" }
";
    let summary = json(&bench, "swings.toml", scene);
    assert_eq!(summary["verdict"]["sound"], true, "{}", summary["verdict"]);
    assert!(summary["balance"]["energy_scale_j"].as_f64().unwrap() > 1e-8);
    // Tabor's parameter is above 5.
    let notes = summary["notes"].to_string();
    assert!(notes.contains("Tabor"), "{notes}");
}

/// A damped cantilever that has come to rest, a load that has risen in time, a servo that presses.
#[test]
fn what_is_final_is_not_doubted() {
    let bench = Bench::new();
    let scene = "version = 1
run = { end_time = 0.4, local_damping = 0.3 }
materials.stone.density = 2000
bonds.glue = { young_modulus = \"1 GPa\", poisson_ratio = 0.3 }
bodies.bar = { particles = [[0, 0, 0, 0.01], [0.02, 0, 0, 0.01], [0.04, 0, 0, 0.01]], bond_list = [[0, 1], [1, 2]], material = \"stone\", bonds = \"glue\" }
groups.left = { body = \"bar\", particles = [0] }
groups.right = { body = \"bar\", particles = [2] }
supports.clamp = { group = \"left\", fixed = true }
loads.bend = { group = \"right\", force = [0, \"0.3 N\", 0], ramp = \"20 ms\" }
measures.tip = { of = \"right\", quantity = \"displacement_y\" }
measures.across = { of = \"right\", quantity = \"displacement_z\" }
measures.clamp = { of = \"left\", quantity = \"reaction_y\" }
";
    let summary = json(&bench, "rests.toml", scene);
    assert_eq!(summary["verdict"]["sound"], true, "{}", summary["verdict"]);
    let scene = "version = 1
run = { end_time = 0.2, gravity = [0, 0, -9.81] }
materials.stone = { density = 2000, young_modulus = \"50 MPa\" }
contacts.stone-stone = { restitution = 0.2, friction = 0.3 }
bodies.ball = { particles = [[0, 0, 0.01, 0.01]], material = \"stone\" }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"stone\" }
walls.lid = { plane = { point = [0, 0, 0.0201], normal = [0, 0, -1] }, material = \"stone\", servo = { force = \"5 N\", direction = [0, 0, -1], max_velocity = \"50 mm/s\" } }
";
    let summary = json(&bench, "pressed.toml", scene);
    assert_eq!(summary["verdict"]["sound"], true, "{}", summary["verdict"]);
}
