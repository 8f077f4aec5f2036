//! Scenes whose results are right, which the verdict must not doubt, and that must not stop.

use serde_json::Value;

use super::{Bench, dem_run};

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

/// A contact law of the scene, and the time that an impact at a speed takes with it, s, with its
/// effective radius, m, and mass, kg.
fn impact(law: &str, young_pa: f64, radius_m: f64, mass_kg: f64, speed_m_s: f64) -> (String, f64) {
    let stiffness_n_m = 0.05 * young_pa * radius_m;
    let effective_pa = young_pa / (2.0 * (1.0 - 0.25 * 0.25));
    let hertz_s = 2.94 * (15.0 * mass_kg / (16.0 * radius_m.sqrt() * effective_pa)).powf(0.4)
        / speed_m_s.powf(0.2);
    let attraction_n = 2.0 * std::f64::consts::PI * 0.05 * radius_m;
    let at_rest_m = (attraction_n / (4.0 / 3.0 * effective_pa * radius_m.sqrt())).powf(2.0 / 3.0);
    match law {
        "linear" => (
            format!("law = \"linear\", normal_stiffness = {stiffness_n_m}"),
            std::f64::consts::PI * (mass_kg / stiffness_n_m).sqrt(),
        ),
        "dmt" => (
            "law = \"dmt\", work_of_adhesion = 0.05".to_owned(),
            hertz_s + 6.0 * (mass_kg * at_rest_m / (1.5 * attraction_n)).sqrt(),
        ),
        _ => ("law = \"hertz-mindlin\"".to_owned(), hertz_s),
    }
}

/// A sphere that meets a wall, or another of its size, until it has left again. `phase`: by how
/// much later it comes, in parts of its way.
fn meets(law: &str, [radius_m, speed_m_s]: [f64; 2], rest: f64, pair: bool, phase: f64) -> String {
    let young_pa = if speed_m_s > 10.0 { 50e9 } else { 50e6 };
    let share = if pair { 0.5 } else { 1.0 };
    let mass_kg = share * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3);
    let (law, impact_s) = impact(law, young_pa, share * radius_m, mass_kg, speed_m_s);
    let gap_m = (0.01 * radius_m).min(2.0 * speed_m_s * impact_s) * (1.0 + phase);
    let end_s = 2.0 * gap_m / speed_m_s + 3.0 * impact_s;
    let (other, height_m) = if pair {
        let other = "bodies.t = { particles = [[0, 0, 0, RADIUS]], material = \"a\" }";
        (
            other.replace("RADIUS", &radius_m.to_string()),
            2.0 * radius_m,
        )
    } else {
        let wall =
            "walls.w = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"a\" }";
        (wall.to_owned(), radius_m)
    };
    format!(
        "version = 1
run.end_time = {end_s}
materials.a = {{ density = 2500, young_modulus = {young_pa}, poisson_ratio = 0.25 }}
contacts.a-a = {{ restitution = {rest}, friction = 0.4, {law} }}
bodies.s = {{ particles = [[0, 0, {}, {radius_m}]], material = \"a\", velocity = [0, 0, {}] }}
{other}
",
        height_m + gap_m,
        -speed_m_s
    )
}

/// Over all sizes, speeds and laws: the automatic step resolves an impact so well that nothing
/// stops, and that its energy is not doubted. The force of the linear law begins with its full
/// slope: with the usual step, two spheres that lose nothing have an error of up to 1.4 %, and are
/// rightly doubted.
#[test]
fn the_energy_of_every_impact_closes() {
    let bench = Bench::new();
    let mut phase = 0.0;
    for radius_m in [1e-6, 1e-4, 1e-2, 1.0] {
        for speed_m_s in [1e-5, 1e-3, 0.1, 1.0, 100.0] {
            for law in ["linear", "hertz-mindlin", "dmt"] {
                for (restitution, pair) in [(1.0, true), (1.0, false), (0.9, true), (0.1, false)] {
                    phase = (phase + 0.0037) % 0.1;
                    let mut scene = meets(law, [radius_m, speed_m_s], restitution, pair, phase);
                    if law == "linear" {
                        scene += "run.safety_factor = 0.68\n";
                    }
                    let summary = json(&bench, "meets.toml", &scene);
                    let error = summary["energy_error"].as_f64().unwrap();
                    assert!(error < 0.01, "{error}\n{scene}");
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
    // Of what is unusual, check says everything and a run that there is something.
    let path = bench.write("swings.toml", scene);
    let checked = dem_run().arg("check").arg(&path).output().unwrap();
    let checked = String::from_utf8(checked.stdout).unwrap();
    let note = "\nnote           contacts.m-w: the law \"dmt\" holds for Tabor's parameter";
    assert!(checked.contains(note), "{checked}");
    let said = bench.good(&path, &["--force"]);
    assert!(said.contains("\nnote         1: see --verbose"), "{said}");
}

/// Numbers in other units than those that are meant.
#[test]
fn unusual_numbers_are_noted() {
    let bench = Bench::new();
    let scene = "version = 1
run = { end_time = 1e-4, gravity = [0, 0, -9.81] }
materials.m = { density = 2500, young_modulus = 1e7, poisson_ratio = 0.3 }
contacts.m-m = { restitution = 0.5, liquid_bridge = { surface_tension = 0.073, volume = 1e-13 } }
bodies.p = { particles = [[0, 0, 0.001, 0.001]], material = \"m\" }
walls.f = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"m\" }
";
    let notes = |scene: &str| json(&bench, "unusual.toml", scene)["notes"].to_string();
    assert_eq!(notes(scene), "[]");
    for (from, to, wanted) in [
        (
            "= 0.073",
            "= 73",
            "a surface tension of 73 N/m is 1000 times that of water",
        ),
        (
            "-9.81",
            "-981",
            "run.gravity is 981 m/s2, 100 times that of the earth",
        ),
    ] {
        let found = notes(&scene.replace(from, to));
        assert!(found.contains(wanted), "{found}");
    }
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

/// Bodies of all kinds beside a ball of some kJ: what walls, belts, loads, gravity, adhesion,
/// bridges and bonds do to each of them is in its own balance.
#[test]
fn bodies_by_themselves_are_sound() {
    let bench = Bench::new();
    let scene = "version = 1
run = { end_time = 0.1, gravity = [0, 0, -9.81] }
materials.stone = { density = 2000, young_modulus = \"50 MPa\", poisson_ratio = 0.3 }
materials.wet = { density = 2000, young_modulus = \"50 MPa\", poisson_ratio = 0.3 }
materials.glue = { density = 2000, young_modulus = \"50 MPa\", poisson_ratio = 0.3 }
contacts.stone-stone = { restitution = 0.6, friction = 0.5 }
contacts.wet-wet = { restitution = 0.6, liquid_bridge = { surface_tension = 0.073, volume = 1e-10 } }
contacts.wet-stone = { restitution = 0.6, liquid_bridge = { surface_tension = 0.073, volume = 1e-10 } }
contacts.glue-glue = { restitution = 0.6, law = \"dmt\", work_of_adhesion = 0.5 }
contacts.glue-stone = { restitution = 0.6, law = \"dmt\", work_of_adhesion = 0.5 }
contacts.glue-wet = { restitution = 0.6 }
bonds.bond = { young_modulus = \"50 MPa\", poisson_ratio = 0.3 }
bodies.heavy = { particles = [[0, 50, 30, 0.5]], material = \"stone\", velocity = [100, 0, 0] }
bodies.shaken = { particles = [[0, 0, 0.0101, 0.01]], material = \"stone\" }
bodies.carried = { particles = [[1, 0, 0.0101, 0.01]], material = \"stone\" }
bodies.pushed = { particles = [[2, 0, 0.0101, 0.01]], material = \"stone\" }
bodies.wet = { particles = [[2, 2, 0.0101, 0.01]], material = \"wet\" }
bodies.sticky = { particles = [[2, 1, 0.0101, 0.01]], material = \"glue\" }
bodies.bar = { particles = [[2, -1, 0.012, 0.01], [2.015, -1, 0.012, 0.01], [2.03, -1, 0.018, 0.01]], bond_list = [[0, 1], [1, 2]], material = \"stone\", bonds = \"bond\", velocity = [0, 0, -1] }
bodies.clump = { particles = [[2, -2, 0.012, 0.01], [2.015, -2, 0.014, 0.01]], material = \"stone\", start_as = \"clump\", velocity = [0.2, 0, -1] }
groups.it = { body = \"pushed\", particles = [0] }
loads.push = { group = \"it\", force = [0.5, 0, 0] }
walls.floor = { box = { min = [1.8, -3, -0.1], max = [9, 3, 0] }, material = \"stone\" }
walls.shaker = { box = { min = [-0.1, -0.1, -0.1], max = [0.1, 0.1, 0] }, material = \"stone\", displacement = [0, 0, 0.005], table = [[0, 0], [0.03, 1], [0.06, 0], [0.1, 1]] }
walls.belt = { box = { min = [0.9, -0.1, -0.1], max = [1.1, 0.1, 0] }, material = \"stone\", surface_velocity = [0.5, 0, 0] }
";
    let summary = json(&bench, "parts.toml", scene);
    let whole = summary["energy_error"].as_f64().unwrap();
    assert!(whole < 1e-6, "{whole}");
    let part = &summary["part_error"];
    let error = part["energy_error"].as_f64().unwrap();
    assert!(error > whole && error < 0.01, "{part}");
}

/// A ball rides on a belt asleep when another one falls onto the belt: the energy that it took
/// along into its sleep is not missing in that of both.
#[test]
fn a_body_that_lands_beside_one_that_rides_asleep_is_sound() {
    let bench = Bench::new();
    let scene = "version = 1
run = { end_time = \"0.5 s\", gravity = [0, 0, -9.81] }
sleep = { speed = \"20 mm/s\", after = \"20 ms\" }
materials.stone = { density = 2000, young_modulus = \"50 MPa\", poisson_ratio = 0.3 }
contacts.stone-stone = { restitution = 0.3, friction = 0.5, rolling_friction = 0.1 }
bodies.first = { particles = [[0, 0, 0.01, 0.01]], material = \"stone\", velocity = [2, 0, 0] }
bodies.second = { particles = [[0.5, 0.2, 0.3, 0.01]], material = \"stone\", velocity = [2, 0, 0] }
walls.belt = { box = { min = [-1, -1, -0.1], max = [9, 1, 0] }, material = \"stone\", surface_velocity = [2, 0, 0] }
";
    let summary = json(&bench, "belt.toml", scene);
    assert!(
        summary["sleep"]["bodies"].as_f64().unwrap() >= 1.0,
        "{}",
        summary["sleep"]
    );
    assert_eq!(
        summary["verdict"]["word"], "sound",
        "{}",
        summary["verdict"]
    );
}

/// A belt has thrown one ball off when a run is continued; the work that it did is not missing in
/// the energy of the next ball that lands on it.
#[test]
fn a_body_that_lands_on_a_belt_after_a_continuation_is_sound() {
    let bench = Bench::new();
    let scene = "version = 1
run = { end_time = \"0.3 s\", gravity = [0, 0, -9.81] }
materials.stone = { density = 2000, young_modulus = \"50 MPa\", poisson_ratio = 0.3 }
contacts.stone-stone = { restitution = 0.3, friction = 0.5, rolling_friction = 0.1 }
bodies.first = { particles = [[0.1, 0, 0.012, 0.01]], material = \"stone\" }
bodies.second = { particles = [[0, 0.2, 0.8, 0.01]], material = \"stone\" }
walls.belt = { box = { min = [-1, -1, -0.1], max = [0.2, 1, 0] }, material = \"stone\", surface_velocity = [2, 0, 0] }
";
    let path = bench.write("belt.toml", scene);
    let folder = bench.path("out").display().to_string();
    bench.good(&path, &["--quiet", "--output", &folder]);
    let longer = ["--resume", "--set", "run.end_time=0.5"];
    let all = [&["--json", "--quiet", "--output", &folder], &longer[..]].concat();
    let summary: Value = serde_json::from_str(&bench.good(&path, &all)).unwrap();
    let landed_j = summary["balance"]["wall_work_j"].as_f64().unwrap();
    assert!(landed_j > 0.02, "{landed_j}");
    assert_eq!(
        summary["verdict"]["word"], "sound",
        "{}",
        summary["verdict"]
    );
}
