//! Dynamic laboratory tests from end to end: bars and a weight.

use std::fs;

use dem_physics::contact::restitution::{damping_ratio, restitution};
use serde_json::Value;

use crate::program::{Bench, scene_of_data, table};

/// A row of 21 spheres of radius 1 mm along z between the ends of two bars: bonds of 20 GPa.
fn row(test: &str, bonds: &str) -> String {
    let particles: Vec<String> = (0..21)
        .map(|i| format!("[0, 0, {}, 0.001]", 0.002 * f64::from(i)))
        .collect();
    let pairs: Vec<String> = (0..20).map(|i| format!("[{i}, {}]", i + 1)).collect();
    format!(
        r#"version = 1
[run]
gravity = [0, 0, 0]
[materials.rock]
density = 2600
young_modulus = "20 GPa"
[materials.steel]
young_modulus = "210 GPa"
[contacts]
rock-rock = {{ law = "linear", normal_stiffness = "20 MN/m", restitution = 1, friction = 0 }}
rock-steel = {{ law = "linear", normal_stiffness = "20 MN/m", restitution = 1, friction = 0 }}
[bonds.rock]
young_modulus = "20 GPa"
poisson_ratio = 0.2
{bonds}
[bodies.row]
particles = [{}]
bond_list = [{}]
material = "rock"
bonds = "rock"
[groups]
low = {{ particles = [0] }}
high = {{ particles = [20] }}
[walls.above]
plane = {{ point = [0, 0, 0.041], normal = [0, 0, -1] }}
material = "steel"
[walls.below]
plane = {{ point = [0, 0, -0.001], normal = [0, 0, 1] }}
material = "steel"
[test]
body = "row"
{test}
[output]
"#,
        particles.join(", "),
        pairs.join(", ")
    )
}

const BARS: &str = r#"
bars = { density = 7850, young_modulus = "210 GPa", diameter = "2 mm" }
striker = { length = "200 mm", velocity = "2 m/s", rise_time = "30 us" }
length = "40 mm"
area = "3.1416 mm2"
"#;

fn pressure() -> String {
    let names = "type = \"hopkinson-pressure\"\ncrosshead = [\"above\"]\ntransmission_bar = \"below\"\ndirection = [0, 0, -1]";
    row(&format!("{names}{BARS}"), "")
}

fn tension(strength: &str) -> String {
    let names = "type = \"hopkinson-tension\"\ncrosshead = [\"high\"]\ntransmission_bar = \"low\"\ndirection = [0, 0, 1]\nstrength = \"20 MPa\"";
    // The walls are out of the way of the grips.
    row(&format!("{names}{BARS}"), strength)
        .replace("point = [0, 0, 0.041]", "point = [0, 0, 1]")
        .replace("point = [0, 0, -0.001]", "point = [0, 0, -1]")
}

fn summary(bench: &Bench, name: &str, scene: &str, options: &[&str]) -> Value {
    let scene = bench.write(name, scene);
    let options = [&["--json", "--output", "out", "--force"], options].concat();
    serde_json::from_str(&bench.good(&scene, &options)).unwrap()
}

fn figure(summary: &Value, name: &str) -> f64 {
    let figures = summary["test"]["results"].as_array().unwrap();
    let found = figures.iter().find(|figure| figure["name"] == name);
    let found = found.unwrap_or_else(|| panic!("{name} in {figures:?}"));
    found["value"].as_f64().unwrap()
}

/// In equilibrium the specimen is a spring between two bars: it takes the same force on both ends,
/// and the pulse that is not reflected goes through it. Energy is accounted for by the pulses, by
/// the work of the bars and by the balance of the run.
#[test]
fn a_row_between_two_bars() {
    for (name, scene, work) in [
        ("pressure.toml", pressure(), "wall_work_j"),
        ("tension.toml", tension(""), "support_work_j"),
    ] {
        let bench = Bench::new();
        let found = summary(&bench, name, &scene, &[]);
        let of = |name: &str| figure(&found, name);
        assert!(of("force equilibrium").abs() < 0.1, "{name}: {found}");
        assert!(of("energy unaccounted for").abs() < 2e-3, "{name}: {found}");
        assert!(
            found["energy_error"].as_f64().unwrap() < 1e-3,
            "{name}: {found}"
        );
        assert_eq!(found["ended_by"], "end of the test");
        let booked = found["balance"][work].as_f64().unwrap();
        let absorbed = of("absorbed energy");
        let incident = of("incident energy");
        // Energies of pulses are sums over a thousand rows.
        assert!(
            (booked - absorbed).abs() < 1e-4 * incident,
            "{name}: {booked} {absorbed}"
        );
        // The pulse: Z v_I^2 over the flat part, and a third of it over rise and fall.
        let (c, v): (f64, f64) = ((210e9_f64 / 7850.0).sqrt(), 1.0);
        let z = 7850.0 * c * std::f64::consts::PI * 1e-6;
        let pulse_s = 0.4 / c;
        let wanted = z * v * v * (pulse_s - 30e-6 + 2.0 / 3.0 * 30e-6);
        assert!(
            (incident / wanted - 1.0).abs() < 2e-3,
            "{name}: {incident} {wanted}"
        );
        // A spring k between two bars: F' = 2 k (v_I - F/Z). The row has little mass.
        let bond = 20e9 * std::f64::consts::PI * 1e-6 / 2e-3;
        let contacts = if name == "pressure.toml" {
            2.0 / 20e6
        } else {
            0.0
        };
        let k = 1.0 / (20.0 / bond + contacts);
        let (mut force, mut largest) = (0.0_f64, 0.0_f64);
        let step_s = 1e-8;
        for i in 0..((pulse_s + 30e-6) / step_s) as usize {
            let time_s = step_s * i as f64;
            let wave = v
                * (time_s / 30e-6)
                    .min(1.0)
                    .min((pulse_s + 30e-6 - time_s) / 30e-6);
            force += step_s * 2.0 * k * (wave - force / z);
            largest = largest.max(force);
        }
        let found = of("largest force");
        assert!(
            (found / largest - 1.0).abs() < 0.05,
            "{name}: {found} {largest}"
        );
        for file in [
            "bar-signals.csv",
            "force-displacement.csv",
            "plots/bar-signals.svg",
            "plots/stress-strain.svg",
            "plots/force-time.svg",
        ] {
            assert!(bench.path("out").join(file).is_file(), "{file}");
        }
        let table = fs::read_to_string(bench.path("out/bar-signals.csv")).unwrap();
        let rows: Vec<Vec<f64>> = table
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect();
        assert!(rows.len() > 250, "{name}: {}", rows.len());
        for row in &rows {
            let force = z * c * (row[1] + row[2]);
            assert!((force - row[4]).abs() <= 1e-9 * z, "{name}: {row:?}");
        }
        let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
        assert!(page.contains("force equilibrium"));
    }
}

/// At a gauge, d'Alembert's two waves: the incident pulse passes it before it arrives at the body,
/// the reflected one after it has left, and the transmitted one as late in the other bar. The row
/// is a spring k between two bars, F' = 2 k (v_I - F/Z), so that all three are known.
#[test]
fn strain_gauges_record_the_waves_of_d_alembert() {
    let bench = Bench::new();
    let scene = pressure().replace(
        "diameter = \"2 mm\"",
        "diameter = \"2 mm\", gauge_distance = \"0.5 m\", length = \"1 m\"",
    );
    summary(&bench, "gauges.toml", &scene, &[]);
    let (c, v, rise_s): (f64, f64, f64) = ((210e9_f64 / 7850.0).sqrt(), 1.0, 30e-6);
    let z = 7850.0 * c * std::f64::consts::PI * 1e-6;
    let (pulse_s, way_s) = (0.4 / c, 0.5 / c);
    let wave = |t: f64| {
        v * (t / rise_s)
            .min(1.0)
            .min((pulse_s + rise_s - t) / rise_s)
            .max(0.0)
    };
    let bond = 20e9 * std::f64::consts::PI * 1e-6 / 2e-3;
    let k = 1.0 / (20.0 / bond + 2.0 / 20e6);
    let step_s = 1e-8;
    let forces: Vec<f64> = (0..40_000)
        .scan(0.0, |force: &mut f64, i| {
            let before = *force;
            *force += step_s * 2.0 * k * (wave(step_s * f64::from(i)) - before / z);
            Some(before)
        })
        .collect();
    let force = |t: f64| {
        if t < 0.0 {
            0.0
        } else {
            forces[(t / step_s) as usize]
        }
    };

    let (columns, rows) = table(&bench.path("out/gauge-signals.csv"));
    assert_eq!(
        columns,
        ["time_s", "incident_bar_strain", "transmission_bar_strain"]
    );
    let rows: Vec<[f64; 3]> = (rows.iter())
        .map(|row| [0, 1, 2].map(|k| row[k].parse().unwrap()))
        .collect();
    assert!((rows[0][0] / -way_s - 1.0).abs() < 1e-9, "{:?}", rows[0]);
    let (mut off, mut before_the_body) = ([0.0_f64; 2], 0);
    for [t, incident_bar, transmission_bar] in rows {
        let [to, from] = [wave(t + way_s), t - way_s];
        let wanted = to / c + force(from) / (z * c) - wave(from) / c;
        if from < 0.0 {
            // Nothing comes back yet: the pulse alone.
            assert!(
                (incident_bar - to / c).abs() < 1e-9 * v / c,
                "{t} {incident_bar}"
            );
            before_the_body += 1;
        }
        off[0] = off[0].max((incident_bar - wanted).abs() * c / v);
        off[1] = off[1].max((transmission_bar - force(from) / (z * c)).abs() * c / v);
    }
    assert!(before_the_body > 100, "{before_the_body}");
    // The row is no spring without mass: a wave takes 20 spheres' time along it, during which the
    // pulse rises by that part of its rise.
    let along_s = 20.0 * (2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9 / bond).sqrt();
    assert!(
        off.iter().all(|off| *off < along_s / rise_s),
        "{off:?} {along_s}"
    );
    assert!(bench.path("out/plots/gauge-signals.svg").is_file());
}

/// The disc of data that is seated on its bars is in equilibrium when it splits, and its verdict is
/// sound. The same disc between bars that only touch its rim is not, and the verdict says so.
#[test]
fn a_disc_is_in_equilibrium_if_it_is_seated_on_its_bars() {
    let bench = Bench::new();
    let scene = scene_of_data("hopkinson-disc.toml");
    let run = |name: &str, options: &[&str]| -> Value {
        let end = [
            "--quiet",
            "--json",
            "--output",
            name,
            "--set",
            "run.end_time=\"300 us\"",
        ];
        let said = bench.good(&scene, &[&end[..], options].concat());
        serde_json::from_str(&said).unwrap()
    };
    let seated = run("seated", &[]);
    assert_eq!(seated["test"]["broken"], true, "{seated}");
    let apart = figure(&seated, "force equilibrium");
    assert!(apart.abs() < 0.1, "{apart}");
    assert_eq!(seated["verdict"]["sound"], true, "{}", seated["verdict"]);
    let touching = run(
        "touching",
        &[
            "--set",
            "walls.incident-bar.plane.point=[0, 0, \"25.01 mm\"]",
            "--set",
            "walls.transmission-bar.plane.point=[0, 0, \"-25.01 mm\"]",
        ],
    );
    let apart = figure(&touching, "force equilibrium");
    assert!(apart.abs() > 0.1, "{apart}");
    let warnings = touching["verdict"]["warnings"].to_string();
    assert!(
        warnings.contains("the forces on the two ends differ by"),
        "{warnings}"
    );
}

/// A row that breaks has a strength and a dynamic increase factor; a run that was cut in two goes
/// on to the same bits.
#[test]
fn a_row_that_breaks_is_the_same_after_a_break_of_the_run() {
    let bench = Bench::new();
    let scene = tension("failure = { tensile_strength = \"20 MPa\" }");
    let scene = scene
        .replace("gravity = [0, 0, 0]", "time_step = \"20 ns\"")
        .replace("[output]\n", "[output]\nseries = \"0.2 us\"\n");
    let whole = summary(&bench, "whole.toml", &scene, &[]);
    assert_eq!(whole["test"]["broken"], true, "{whole}");
    let factor = figure(&whole, "dynamic increase factor");
    let strength = figure(&whole, "strength");
    assert!(
        (factor - strength / 20e6).abs() < 1e-9,
        "{factor} {strength}"
    );
    assert!(strength > 10e6 && strength < 30e6, "{strength}");
    let half = bench.write("whole.toml", &scene);
    let go = |options: &[&str]| {
        let options = [&["--json", "--output", "cut"], options].concat();
        serde_json::from_str::<Value>(&bench.good(&half, &options)).unwrap()
    };
    go(&["--set", "run.end_time=\"30 us\""]);
    let resumed = go(&["--resume"]);
    // Rows of the test stand as far apart as the end of the run says, so that figures read from
    // them differ; the run itself does not.
    for part in ["steps", "balance", "broken_bonds", "fragments"] {
        assert_eq!(resumed[part], whole[part], "{part}");
    }
}

/// A weight on a row of bonded spheres, a spring of 20 bonds and two contacts: energy and rebound.
#[test]
fn a_weight_on_a_row() {
    let bench = Bench::new();
    let test = "type = \"drop-weight\"\ncrosshead = [\"above\"]\ndirection = [0, 0, -1]\nstroke = \"2 mm\"\nweight = { mass = \"10 g\", height = \"5 mm\" }";
    let scene = row(test, "damping = { damping_ratio = 0 }")
        .replace("gravity = [0, 0, 0]", "gravity = [0, 0, -9.81]");
    let found = summary(&bench, "weight.toml", &scene, &[]);
    let of = |name: &str| figure(&found, name);
    let speed = (2.0 * 9.81 * 5e-3_f64).sqrt();
    let impact = 0.5 * 0.01 * speed * speed;
    assert!((of("impact energy") / impact - 1.0).abs() < 1e-9);
    assert!(of("energy unaccounted for").abs() < 2e-3, "{found}");
    assert!(found["energy_error"].as_f64().unwrap() < 1e-3, "{found}");
    // The row is light, but not without mass: it keeps a part of the energy as vibration.
    let rebound = of("rebound velocity");
    assert!(
        rebound < 1.001 * speed && rebound > 0.9 * speed,
        "{rebound} {speed}"
    );
    let bond = 20e9 * std::f64::consts::PI * 1e-6 / 2e-3;
    let spring = 1.0 / (20.0 / bond + 2.0 / 20e6);
    let largest = 0.01 * 9.81 + (0.01 * 9.81_f64).hypot((spring * 0.01).sqrt() * speed);
    let force = of("largest force");
    assert!((force / largest - 1.0).abs() < 0.1, "{force} {largest}");
}

/// A buffer of rubber: the weight on a Hertz contact, whose largest force and rebound are known.
#[test]
fn a_buffer_of_rubber_is_a_hertz_contact() {
    const MASS_KG: f64 = 0.01;
    const RADIUS_M: f64 = 1e-3;
    let [modulus_pa, poisson] = [5e6, 0.49];
    let test = "type = \"drop-weight\"\ncrosshead = [\"above\"]\ndirection = [0, 0, -1]\nstroke = \"2 mm\"\nweight = { mass = \"10 g\", height = \"5 mm\" }";
    let run = |restitution: f64| {
        let bench = Bench::new();
        let rubber = format!(
            "[materials.rubber]\nyoung_modulus = {modulus_pa}\npoisson_ratio = {poisson}\n[contacts]\nrock-rubber = {{ restitution = {restitution}, friction = 0 }}\n"
        );
        let scene = row(test, "damping = { damping_ratio = 0 }")
            .replace("gravity = [0, 0, 0]", "gravity = [0, 0, -9.81]")
            .replace(
                "young_modulus = \"20 GPa\"\n[materials",
                "young_modulus = \"20 GPa\"\npoisson_ratio = 0.2\n[materials",
            )
            .replace("[contacts]\n", &rubber)
            .replace(
                "normal = [0, 0, -1] }\nmaterial = \"steel\"",
                "normal = [0, 0, -1] }\nmaterial = \"rubber\"",
            );
        summary(&bench, "rubber.toml", &scene, &[])
    };
    let elastic = run(1.0);
    let impact_j = MASS_KG * 9.81 * 5e-3;
    let plane_strain = |modulus_pa: f64, poisson: f64| (1.0 - poisson * poisson) / modulus_pa;
    let effective_pa = 1.0 / (plane_strain(modulus_pa, poisson) + plane_strain(20e9, 0.2));
    // Energy at the largest depth: 8/15 E* R^(1/2) d^(5/2) = M g (h + d).
    let mut depth_m: f64 = 0.0;
    for _ in 0..50 {
        let energy_j = impact_j + MASS_KG * 9.81 * depth_m;
        depth_m = (energy_j * 15.0 / 8.0 / (effective_pa * RADIUS_M.sqrt())).powf(0.4);
    }
    let largest_n = 4.0 / 3.0 * effective_pa * RADIUS_M.sqrt() * depth_m.powf(1.5);
    let force_n = figure(&elastic, "largest force");
    // The row is far stiffer, and has a fortieth of the mass.
    assert!(
        (force_n / largest_n - 1.0).abs() < 0.02,
        "{force_n} {largest_n}"
    );
    // The restitution is that of a sphere alone: its dashpot is in proportion to the root of the
    // sphere's mass, so that the damping ratio of a weight M/m times as heavy is smaller.
    let sphere_kg = 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M.powi(3);
    let of_weight = restitution(damping_ratio(0.4) * (sphere_kg / MASS_KG).sqrt());
    let speed_m_s = (2.0 * 9.81 * 5e-3_f64).sqrt();
    for (found, restitution) in [(elastic, 1.0), (run(0.4), of_weight)] {
        let rebound = figure(&found, "rebound velocity") / speed_m_s;
        assert!(
            (rebound - restitution).abs() < 0.004,
            "{rebound} {restitution}"
        );
        assert!(
            figure(&found, "energy unaccounted for").abs() < 2e-3,
            "{found}"
        );
    }
}

/// A weight that a gas gun shoots: no gravity, a velocity instead of a height, and a row that
/// breaks.
#[test]
fn a_weight_of_a_gas_gun_breaks_a_row() {
    const MASS_KG: f64 = 0.01;
    const SPEED_M_S: f64 = 20.0;
    let test = "type = \"drop-weight\"\ncrosshead = [\"above\"]\ndirection = [0, 0, -1]\nstroke = \"5 mm\"\nweight = { mass = \"10 g\", velocity = \"20 m/s\" }";
    let bench = Bench::new();
    let bonds =
        "damping = { damping_ratio = 0.05 }\nfailure = { compressive_strength = \"100 MPa\" }";
    let found = summary(&bench, "gun.toml", &row(test, bonds), &[]);
    assert_eq!(found["test"]["rate_m_s"].as_f64(), Some(SPEED_M_S));
    let impact_j = 0.5 * MASS_KG * SPEED_M_S * SPEED_M_S;
    assert!((figure(&found, "impact energy") / impact_j - 1.0).abs() < 1e-9);
    // 2 J on a quarter of a gram crush it.
    assert!(found["broken_bonds"].as_u64().unwrap() > 0, "{found}");
    assert!(figure(&found, "largest fragment") < 1.0);
    assert!(
        figure(&found, "energy unaccounted for").abs() < 2e-3,
        "{found}"
    );
    assert!(found["energy_error"].as_f64().unwrap() < 2e-3, "{found}");
    let mass_kg = 21.0 * 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
    let kwh_t = figure(&found, "specific energy per tonne");
    assert!(
        (kwh_t * 3600.0 * mass_kg / impact_j - 1.0).abs() < 1e-6,
        "{kwh_t}"
    );
}

/// A test whose weight does not touch, that has no anvil, whose bars have another size than the
/// body, or that is cut short, says so.
#[test]
fn tests_that_say_nothing_of_the_body_are_doubtful() {
    let test = "type = \"drop-weight\"\ncrosshead = [\"above\"]\ndirection = [0, 0, -1]\nstroke = \"1 mm\"\nweight = { mass = \"10 g\", velocity = \"1 m/s\" }";
    let weight = row(test, "");
    let far = weight.replace("point = [0, 0, 0.041]", "point = [0, 0, 0.06]");
    let free = weight.replace("point = [0, 0, -0.001]", "point = [0, 0, -1]");
    let wide = pressure().replace("diameter = \"2 mm\"", "diameter = \"50 mm\"");
    let cut = "run.end_time=\"15 us\"";
    for (scene, set, said) in [
        (far, "run.seed=1", "the weight did not touch the body"),
        (
            free,
            "run.seed=1",
            "no wall or support behind the body took a load",
        ),
        (
            wide,
            "run.seed=1",
            "the section of the bars is 625 times that of the body",
        ),
        (pressure(), cut, "the run ended before the pulse"),
        (weight, cut, "the run ended while the weight pressed"),
    ] {
        let bench = Bench::new();
        let found = summary(&bench, "doubtful.toml", &scene, &["--set", set]);
        let warnings = found["verdict"]["warnings"].to_string();
        assert!(warnings.contains(said), "{said}: {warnings}");
    }
}

/// What only the plan can see is refused there.
#[test]
fn bodies_that_do_not_fit_are_refused() {
    let bench = Bench::new();
    let long = pressure().replace("length = \"200 mm\"", "length = \"15 mm\"");
    let long = long.replace("rise_time = \"30 us\"", "rise_time = 0");
    let scene = bench.write("long.toml", long);
    let said = bench.bad(std::path::Path::new(&scene), &[], 2);
    assert!(
        said.contains("the body 'row' is 40 mm long, and the pulse 30 mm, twice the striker"),
        "{said}"
    );
    let test = "type = \"drop-weight\"\ncrosshead = [\"above\"]\ndirection = [0, 0, -1]\nstroke = \"2 mm\"\nweight = { mass = \"0.1 g\", velocity = 1 }";
    let scene = bench.write("light.toml", row(test, ""));
    let said = bench.bad(std::path::Path::new(&scene), &[], 2);
    assert!(said.contains("is lighter than the body 'row'"), "{said}");
    for (old, new, wanted) in [
        (
            "direction = [0, 0, -1]",
            "direction = [0.1, 0, -1]",
            "the wall 'above' is not square to the direction in which it moves",
        ),
        (
            "area = \"3.1416 mm2\"",
            "area = \"3.1416 cm2\"",
            "test.area is 314.2 mm2, and the body 'row' has 4 mm2",
        ),
        (
            "length = \"40 mm\"",
            "length = \"40 m\"",
            "test.length is 40 m",
        ),
        (
            "density = 7850, young_modulus = \"210 GPa\"",
            "density = 7850, young_modulus = 210",
            "the wave speed of the bars",
        ),
    ] {
        let scene = pressure();
        assert!(scene.contains(old), "{old}");
        let scene = bench.write("wrong.toml", scene.replace(old, new));
        let said = bench.bad(std::path::Path::new(&scene), &[], 2);
        assert!(said.contains(wanted), "{wanted}: {said}");
    }
}
