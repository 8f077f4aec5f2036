//! The scenes of the repository, run as described on its pages.

use rayon::prelude::*;

use super::{Bench, corpus, dem_pack, dem_run, names_in, root, scene_of_data};

#[test]
fn cantilever() {
    let bench = Bench::new();
    let said = bench.good(&scene_of_data("cantilever.toml"), &["--verbose"]);
    let line = |name: &str| {
        let found = said.lines().find(|line| line.starts_with(name));
        found
            .unwrap_or_else(|| panic!("{name} in {said}"))
            .to_owned()
    };
    assert!(said.lines().next().unwrap().contains(" s simulated in "));
    assert!(line("tip_deflection").contains("-8.5342 mm   theory -8.53424 mm   error "));
    assert!(line("clamp_force").contains("theory 100000 N"));
    assert!(line("error ").contains("energy "));
    assert!(line("steps ").ends_with("ended by rest"));
    assert!(line("verdict").ends_with(" sound"));
    // A scene without [output] writes nothing.
    assert!(bench.files().is_empty());
}

#[test]
fn spinning_bar() {
    let bench = Bench::new();
    let scene = scene_of_data("spinning-bar.toml");
    bench.good(&scene, &["--set", "run.end_time=0.02", "--output", "spin"]);
    assert_eq!(bench.files(), ["spin"]);
    let json = bench.good(
        &scene,
        &["--set", "run.end_time=0.02", "--json", "--output", "again"],
    );
    let summary: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(summary["energy_error"].as_f64().unwrap() < 1e-6);
    assert!(summary["momentum_error"].as_f64().unwrap() < 1e-12);
    assert!(summary["angular_momentum_error"].as_f64().unwrap() < 1e-12);
    assert!((summary["simulated_s"].as_f64().unwrap() / 0.02 - 1.0).abs() < 1e-9);
    assert_eq!(summary["results"], "again");
    let written = std::fs::read_to_string(bench.path("again/summary.json")).unwrap();
    assert_eq!(json, written);
}

#[test]
fn every_scene_of_data_is_planned_or_asks_for_its_body() {
    let bench = Bench::new();
    let mut seen = 0;
    for entry in root().join("data/scenes").read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        seen += 1;
        let output = dem_run()
            .current_dir(bench.path(""))
            .arg("check")
            .arg(&path)
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        let asks =
            said.contains("there is no such file; make it, or name another file with --body");
        assert!(
            output.status.success() || asks,
            "{}: {said}",
            path.display()
        );
    }
    assert!(seen >= 3);
    assert!(bench.files().is_empty());
}

#[test]
fn materials_of_data_fit_into_a_scene() {
    let bench = Bench::new();
    bench.write("row.vtp", super::vtp_bytes(&super::row(5)));
    for number in [1, 2] {
        let path = root().join(format!("data/materials/filter-cake-table-{number}.toml"));
        let material = std::fs::read_to_string(path).unwrap();
        let text = format!(
            "version = 1\nrun.end_time = \"1 us\"\n{material}\n[bodies.cake]\nfile = \"row.vtp\"\nmaterial = \"cake\"\nbonds = \"cake\"\n\
             [walls.plate]\nplane = {{ point = [0, 0, \"-1 m\"], normal = [0, 0, 1] }}\nmaterial = \"steel\"\n"
        );
        let scene = bench.write("scene.toml", text);
        let said = bench.good(&scene, &[]);
        assert!(said.contains("verdict"), "{said}");
    }
}

/// The page on materials interprets the sizes of Platzer's tables as radii: with radii his time
/// steps are consistent with eq. 15, with half of them not.
#[test]
fn spheres_of_the_tables_allow_the_time_steps_printed_there() {
    let page = std::fs::read_to_string(root().join("data/materials/README.md")).unwrap();
    for (table, young_modulus_pa, printed_s) in [(1, 12.05e6, 2e-6), (2, 15e6, 4e-6)] {
        let file = format!("`filter-cake-table-{table}.toml`");
        let row = page.lines().find(|line| line.contains(&file)).unwrap();
        let after = |option: &str| {
            let rest = row.split_once(option).unwrap().1;
            rest.split([' ', '`'])
                .find(|word| !word.is_empty())
                .unwrap()
        };
        let (smallest, _) = after("--diameter").split_once("..").unwrap();
        let radius_m = 0.5 * dem_io::units::length_m(smallest).unwrap();
        let overlap: f64 = after("--overlap").parse().unwrap();
        // m/K of the smallest sphere with a bond of its radius to an equal one, 2 R/(1 + overlap)
        // away.
        let squared_s2 = 8.0 / 3.0 / (1.0 + overlap) * radius_m.powi(2) * 2050.0 / young_modulus_pa;
        let limit_s = 0.17 * squared_s2.sqrt();
        assert!(limit_s > printed_s, "table {table}: {limit_s:e}");
        assert!(0.5 * limit_s < printed_s, "table {table}: {limit_s:e}");
    }
}

#[test]
fn quiet_means_quiet() {
    let bench = Bench::new();
    let scene = scene_of_data("spinning-bar.toml");
    let short = ["--set", "run.end_time=1 ms", "--output"];
    assert_eq!(
        bench.good(&scene, &[&short[..], &["a", "--quiet"]].concat()),
        ""
    );
    let json = bench.good(&scene, &[&short[..], &["b", "-q", "--json"]].concat());
    let summary: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(summary["ended_by"], "end time");
}

#[test]
fn every_good_scene_of_the_corpus_runs() {
    let scenes = corpus("good");
    assert!(scenes.len() >= 7);
    for scene in scenes {
        let bench = Bench::new();
        let said = bench.good(&scene, &["--threads", "1"]);
        assert!(said.contains("verdict"), "{said}");
    }
}

/// End time of each scene for a test without false alarms, and the shape and diameters of its body
/// if it needs one. Laboratory tests, which have no end time of their own, load within one period
/// of the body.
const SHORT: [[&str; 4]; 45] = [
    ["brazilian-disc", "", "disc", "4mm..6mm"],
    ["brazilian-disc-rock", "", "disc", "4mm..6mm"],
    ["cantilever", "4 s", "", ""],
    ["chute", "0.2 s", "", ""],
    ["chute-region", "20 ms", "", ""],
    ["chute-bonded", "20 ms", "", ""],
    ["clamped", "2 ms", "bending-sample", "5mm..7mm"],
    ["compression", "", "bar", "4mm..6mm"],
    ["direct-shear", "20 us", "", ""],
    ["dog-bone", "20 us", "", ""],
    ["drop-flat", "10 ms", "", ""],
    ["drop-height", "3 ms", "", ""],
    ["drop-inclined", "5 ms", "", ""],
    ["drop-weight", "0.1 ms", "", ""],
    ["drum", "20 ms", "", ""],
    ["four-point-bending", "", "bending-sample", "5mm..7mm"],
    ["hopkinson-disc", "60 us", "", ""],
    ["hopkinson-pressure", "40 us", "", ""],
    ["hopkinson-tension", "60 us", "", ""],
    ["jaw-crusher", "0.1 s", "", ""],
    ["jaw-crusher-ore", "0.3 s", "", ""],
    ["lifted-cylinder", "30 ms", "", ""],
    ["lumps", "0.1 s", "", ""],
    ["one-cake", "60 ms", "", ""],
    ["pour-box", "20 ms", "", ""],
    ["penetration", "5 ms", "", ""],
    ["press-mould", "20 ms", "", ""],
    ["press-tube", "20 ms", "", ""],
    ["process", "20 ms", "", ""],
    ["repeated-drops", "3 ms", "", ""],
    ["roll-crusher", "0.2 s", "", ""],
    ["shatter", "5 ms", "", ""],
    ["shatter-box", "20 ms", "", ""],
    ["silo", "20 ms", "", ""],
    ["silo-cone", "20 ms", "", ""],
    ["silo-round-robin", "20 ms", "", ""],
    ["spinning-bar", "50 ms", "", ""],
    ["stalk-cut", "0.5 ms", "", ""],
    ["tablet-drop", "0.1 ms", "", ""],
    ["tablet-press", "20 us", "", ""],
    ["tension", "", "bar", "4mm..6mm"],
    ["three-point-bending", "", "bending-sample", "5mm..7mm"],
    ["transfer-chute", "20 ms", "", ""],
    ["triaxial-compression", "20 us", "", ""],
    ["wet-heap", "50 ms", "", ""],
];

/// The watchdog, walls and contacts stop none of them: no false alarm.
#[test]
fn no_scene_of_data_is_stopped() {
    let bench = Bench::new();
    let mut known: Vec<String> = SHORT
        .iter()
        .map(|[name, ..]| format!("{name}.toml"))
        .collect();
    known.sort();
    assert_eq!(names_in(&root().join("data/scenes")), known);
    let mut shapes: Vec<[&str; 2]> = SHORT
        .map(|[_, _, shape, diameters]| [shape, diameters])
        .into();
    shapes.retain(|[shape, _]| !shape.is_empty());
    shapes.sort_unstable();
    shapes.dedup();
    shapes.into_par_iter().for_each(|[shape, diameters]| {
        let stl = root().join(format!("data/shapes/{shape}.stl"));
        let radii = ["--overlap", "0.296", "--bond-range", "1.0"];
        let options = [&["--diameter", diameters], &radii[..]].concat();
        dem_pack(&stl, &options, &bench.path(&format!("{shape}.vtp")));
    });
    SHORT.into_par_iter().for_each(|[name, end, shape, _]| {
        let mut options = Vec::new();
        if !shape.is_empty() {
            options.extend(["--body".to_owned(), format!("{shape}.vtp")]);
        }
        let set: &[String] = if end.is_empty() {
            &[
                "test.periods=1".to_owned(),
                "test.rate_check=false".to_owned(),
            ]
        } else {
            &[format!("run.end_time=\"{end}\"")]
        };
        options.extend(set.iter().flat_map(|set| ["--set".to_owned(), set.clone()]));
        let out = format!("{name}-short");
        options.extend(["--json", "--quiet", "--output", &out].map(str::to_owned));
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        let said = bench.good(&scene_of_data(&format!("{name}.toml")), &options);
        let summary: serde_json::Value = serde_json::from_str(&said).unwrap();
        let error = summary["energy_error"].as_f64().unwrap();
        // A tensile test breaks immediately at this rate.
        assert!(error < 0.01, "{name}: {error}");
    });
}

/// Two bodies of one shape, one with stiff bonds: the step is that of the stiff one.
const ONE_SHAPE: &str = r#"version = 1
[run]
end_time = "0.3 s"
[materials.m]
density = "2000 kg/m3"
young_modulus = "1 MPa"
poisson_ratio = 0.3
[contacts]
m-m = { restitution = 0.9, friction = 0.3 }
[bonds.soft]
model = "timoshenko"
young_modulus = "1 MPa"
poisson_ratio = 0.3
[bonds.stiff]
model = "timoshenko"
young_modulus = "1600 MPa"
poisson_ratio = 0.3
[bodies.a]
material = "m"
bonds = "soft"
start_as = "clump"
particles = [[0,0,0,0.01],[0.019,0,0,0.01]]
bond_list = [[0,1]]
angular_velocity = [0,0,5]
[replacement.a]
when = { time = "0.1 s" }
[bodies.b]
material = "m"
bonds = "stiff"
start_as = "clump"
particles = [[0,0,0,0.01],[0.019,0,0,0.01]]
bond_list = [[0,1]]
position = [0.2,0,0]
angular_velocity = [0,0,5]
[replacement.b]
when = { time = "0.1 s" }
"#;

#[test]
fn bodies_of_one_shape_may_have_bonds_of_two_kinds() {
    let bench = Bench::new();
    let scene = bench.write("scene.toml", ONE_SHAPE);
    let step_s = |options: &[&str]| {
        let said = bench.good(&scene, &[options, &["--json"]].concat());
        let summary: serde_json::Value = serde_json::from_str(&said).unwrap();
        // In the step in which clumps become clusters, an adaptive step is still that of the
        // clumps, in which spinning bodies are stretched.
        let allowed = if summary["adaptive"].is_null() {
            1e-5
        } else {
            1e-3
        };
        let error = summary["energy_error"].as_f64().unwrap();
        assert!(error < allowed, "{summary}");
        summary["time_step_s"].as_f64().unwrap()
    };
    let both = step_s(&[]);
    let stiff_too = step_s(&["--set", "bodies.a.bonds=stiff"]);
    assert!(
        (both / stiff_too - 1.0).abs() < 1e-3,
        "{both:e} {stiff_too:e}"
    );
    let soft = step_s(&["--set", "bodies.b.bonds=soft"]);
    assert!(soft > 9.0 * both, "{soft:e} {both:e}");
    let adaptive = ["--set", "bodies.b.bonds=soft", "--set", "run.adaptive=true"];
    let adaptive = step_s(&adaptive);
    assert!(adaptive < 1.001 * soft, "{adaptive:e}");
}
