//! Masses of bodies, and warnings of dem-pack: printed by `check`, by runs, and for scripts.

use serde_json::Value;

use super::{Bench, dem_run, row, vtp_bytes};

/// Two rows of five spheres of 2050 kg/m3, with a shape whose mass would be 1.025e-4 kg.
const SHAPE_M3: f64 = 5e-8;
const MASS_KG: f64 = 2050.0 * 10.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;

const SCENE: &str = r#"version = 1
run.end_time = "1e-5 s"
materials.any = { young_modulus = "1 MPa" }
bonds.any = { young_modulus = "1 MPa", poisson_ratio = 0.3 }
bodies.row = { file = "row.vtp", material = "any", bonds = "any" }
"#;

fn bench(warnings: &[&str], volume_m3: Option<f64>) -> Bench {
    let bench = Bench::new();
    let mut body = row(10);
    body.about.shape_volume_m3 = volume_m3;
    body.about.program = Some("dem-pack 0.1.0".to_owned());
    body.about.warnings = warnings.iter().map(|text| (*text).to_owned()).collect();
    bench.write("row.vtp", vtp_bytes(&body));
    bench.write("scene.toml", SCENE);
    bench
}

/// Standard output and standard error of `dem-run ARGUMENTS`, which succeeds.
fn said(bench: &Bench, arguments: &[&str]) -> [String; 2] {
    let output = dem_run()
        .current_dir(bench.path(""))
        .args(arguments)
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].map(|said| String::from_utf8(said).unwrap());
    assert!(output.status.success(), "{said:?}");
    said
}

fn json(bench: &Bench, arguments: &[&str]) -> Value {
    serde_json::from_str(&said(bench, arguments)[0]).unwrap()
}

#[test]
fn mass_of_spheres_and_of_the_shape() {
    let bench = bench(&[], Some(SHAPE_M3));
    let mass = "row 8.587e-5 kg; its shape filled with 2050 kg/m3 would weigh 0.0001025 kg (-16 %); solid density 1717 kg/m3";
    let centre = "  centre 9 mm, 0 m, 0 m; principal moments 3.435e-11, 2.868e-9, 2.868e-9 kg m2";
    let [text, _] = said(&bench, &["check", "scene.toml", "--verbose"]);
    let lines = format!("mass           {mass}\n               {centre}\n");
    assert!(text.contains(&lines), "{text}");
    let [text, errors] = said(&bench, &["scene.toml", "--verbose", "--output", "out"]);
    let lines = format!("mass         {mass}\n             {centre}\n");
    assert!(text.contains(&lines), "{text}");
    let remedy = "body 'row' weighs 8.587e-5 kg, -16 % against its shape filled with 2050 kg/m3: bodies.row.body_density = \"2050 kg/m3\" gives it that mass";
    assert_eq!(errors, format!("note: {remedy}\n"));
    let [info, _] = said(&bench, &["row.vtp"]);
    assert!(
        info.contains(
            "\n           its shape filled with 2050 kg/m3 would weigh 0.0001025 kg (-16 %)\n"
        ) && info.contains(
            "\ncentre     9 mm, 0 m, 0 m; principal moments 3.435e-11, 2.868e-9, 2.868e-9 kg m2\n"
        ),
        "{info}"
    );
    // A note does not change the verdict.
    let summary = std::fs::read(bench.path("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    assert_eq!(summary["verdict"]["sound"], true);
    for of in [
        json(&bench, &["check", "scene.toml", "--json"]),
        json(&bench, &["scene.toml", "--json"]),
        summary,
    ] {
        assert_eq!(of["notes"][0], remedy);
        let row = &of["bodies"]["row"];
        let number = |pointer: &str| row.pointer(pointer).unwrap().as_f64().unwrap();
        let near = |pointer: &str, wanted: f64| {
            let found = number(pointer);
            assert!(
                (found / wanted - 1.0).abs() < 1e-12,
                "{pointer}: {found} {wanted}"
            );
        };
        near("/mass_kg", MASS_KG);
        near("/shape_mass_kg", 2050.0 * SHAPE_M3);
        near(
            "/difference_percent",
            100.0 * (MASS_KG / (2050.0 * SHAPE_M3) - 1.0),
        );
        near("/centre_m/0", 9e-3);
        // A row of spheres: along it only their own inertia, 2/5 m r^2; perpendicular to it also
        // that of ten positions 2 mm apart.
        let own = 0.4 * MASS_KG * 1e-6;
        let apart = MASS_KG * 4e-6 * (100.0 - 1.0) / 12.0;
        near("/inertia_kg_m2/0/0", own);
        near("/inertia_kg_m2/1/1", own + apart);
        near("/principal_moments_kg_m2/2", own + apart);
    }
}

#[test]
fn a_body_density_and_a_mass_are_kept_and_noted_no_more() {
    let bench = bench(&[], Some(SHAPE_M3));
    for (set, kg) in [
        ("bodies.row.body_density=2050 kg/m3", 2050.0 * SHAPE_M3),
        ("bodies.row.mass=0.1 g", 1e-4),
    ] {
        let [_, errors] = said(&bench, &["scene.toml", "--set", set]);
        assert_eq!(errors, "");
        let found = json(&bench, &["check", "scene.toml", "--json", "--set", set]);
        let mass_kg = found["bodies"]["row"]["mass_kg"].as_f64().unwrap();
        assert!((mass_kg / kg - 1.0).abs() < 1e-12, "{mass_kg}");
        assert_eq!(found["notes"], serde_json::json!([]));
    }
}

#[test]
fn without_a_shape_the_mass_alone_is_told() {
    let bench = bench(&[], None);
    let [text, _] = said(&bench, &["check", "scene.toml", "--verbose"]);
    assert!(text.contains("mass           row 8.587e-5 kg\n"), "{text}");
    assert!(!text.contains("its shape filled"), "{text}");
    let found = json(&bench, &["check", "scene.toml", "--json"]);
    assert_eq!(found["bodies"]["row"]["shape_mass_kg"], Value::Null);
}

/// The weight on a plate is m g, for loose and for bonded spheres.
#[test]
fn a_plate_carries_the_weight() {
    let bench = Bench::new();
    let scene = bench.write(
        "scene.toml",
        r#"version = 1
[run]
end_time = "0.5 s"
gravity = [0, 0, -10]
local_damping = 0.7
[materials.any]
young_modulus = "10 MPa"
[contacts.any-any]
restitution = 0.5
friction = 0.5
[bonds.any]
young_modulus = "10 MPa"
poisson_ratio = 0.3
[bodies.tripod]
particles = [[0, 0, 0.01, 0.01], [0.02, 0, 0.01, 0.01], [0.01, 0.017, 0.01, 0.01]]
bond_list = [[0, 1], [1, 2], [0, 2]]
material = "any"
bonds = "any"
mass = "0.372 kg"
[walls.plate]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
material = "any"
[measures.weight]
of = "plate"
quantity = "force_z"
"#,
    );
    let summary: Value = serde_json::from_str(&bench.good(&scene, &["--json"])).unwrap();
    let weight_n = summary["measures"]["weight"]["value"].as_f64().unwrap();
    assert!((weight_n / -3.72 - 1.0).abs() < 1e-6, "{weight_n}");
}

#[test]
fn what_dem_pack_warned_of_is_not_forgotten() {
    let few = "3 bonds per particle, fewer than 4 are hardly rigid";
    let bench = bench(&[few, "2 pieces"], Some(MASS_KG / 2050.0));
    let wanted = [few, "2 pieces"].map(|text| {
        format!(
            "body 'row' ({}): dem-pack warned: {text}",
            bench.path("row.vtp").display()
        )
    });
    let [info, _] = said(&bench, &["row.vtp"]);
    assert!(
        info.contains(&format!("warning    when it was made: {few}\n")),
        "{info}"
    );
    let scene = bench.path("scene.toml");
    let scene = scene.to_str().unwrap();
    let checked = json(&bench, &["check", scene, "--json"]);
    assert_eq!(checked["warnings"], serde_json::json!(wanted));
    let [text, errors] = said(&bench, &[scene]);
    assert_eq!(
        errors,
        format!("warning: {}\nwarning: {}\n", wanted[0], wanted[1])
    );
    assert!(
        text.contains("\nverdict      doubtful: 2 warnings"),
        "{text}"
    );
    let ran = json(&bench, &[scene, "--json"]);
    assert_eq!(ran["verdict"]["sound"], false);
    assert_eq!(ran["verdict"]["word"], "doubtful");
    assert_eq!(ran["verdict"]["warnings"], serde_json::json!(wanted));
}

/// A row of spheres 4.9 across, with and without bonds that were calibrated with such spheres, and
/// as a rigid clump.
#[test]
fn a_body_of_few_spheres_is_coarse_unless_it_is_rigid_or_calibrated() {
    let bench = bench(&[], Some(MASS_KG / 2050.0));
    let mut body = row(5);
    body.about.program = Some("dem-pack 0.1.0".to_owned());
    body.about.particles_across = Some(4.9);
    body.about.thinnest_part_m = Some(9.8e-3);
    bench.write("row.vtp", vtp_bytes(&body));
    let scene = bench.path("scene.toml");
    let scene = scene.to_str().unwrap();
    let diameter_m = 2.0 * body.radii.iter().sum::<f64>() / body.radii.len() as f64;
    let verdict = |set: &[&str]| {
        let all = [&[scene, "--json"], set].concat();
        json(&bench, &all)["verdict"].clone()
    };
    let coarse = verdict(&[]);
    assert_eq!(coarse["word"], "coarse", "{coarse}");
    assert_eq!(coarse["sound"], false);
    let why_few = &coarse["coarse"][0];
    let why = why_few.as_str().unwrap();
    assert!(
        why.contains("only about 4.9 particles across the thinnest part (9.8 mm)"),
        "{why}"
    );
    let [text, errors] = said(&bench, &[scene]);
    assert!(text.contains("\nverdict      coarse: "), "{text}");
    assert!(errors.is_empty(), "{errors}");
    let calibrated = |factor: f64| format!("bonds.any.calibrated_diameter={}", factor * diameter_m);
    assert_eq!(verdict(&["--set", &calibrated(1.05)])["word"], "sound");
    assert_eq!(verdict(&["--set", &calibrated(1.2)])["word"], "coarse");
    // In a body of as many across, or of more.
    let across = |number: f64| format!("bonds.any.calibrated_across={number}");
    let with = |number: f64| verdict(&["--set", &calibrated(1.0), "--set", &across(number)]);
    assert_eq!(with(5.2)["word"], "sound");
    assert_eq!(with(8.0)["word"], "coarse");
    let why = with(8.0)["coarse"][0].as_str().unwrap().to_owned();
    assert!(
        why.contains("4.9 particles across; its bonds were calibrated in a body of 8:"),
        "{why}"
    );
    let correct = ["--set", "bonds.any.size_correction=true"];
    let corrected = verdict(&[&correct[..], &["--set", &across(8.0)]].concat());
    assert_eq!(corrected["word"], "sound", "{corrected}");
    let rigid = ["--set", "bodies.row.start_as=clump"];
    assert_eq!(verdict(&rigid)["word"], "sound", "{}", verdict(&rigid));
    // Of bonds that do not hold the weight of a sphere, 2/3 rho g d, it is a granulate.
    let weight_pa = 2.0 / 3.0 * 2050.0 * 9.81 * diameter_m;
    let held = |factor: f64| {
        let strength = format!(
            "bonds.any.failure={{tensile_strength=\"{} Pa\"}}",
            factor * weight_pa
        );
        let gravity = "run.gravity=[0, 0, -9.81]";
        let checked = [
            "check", scene, "--json", "--set", &strength, "--set", gravity,
        ];
        json(&bench, &checked)["coarse"].clone()
    };
    assert_eq!(held(0.5), serde_json::json!([]));
    assert_eq!(held(2.0)[0], *why_few);
}
