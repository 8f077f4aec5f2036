//! What leaves, and the sizes of all fragments, as tables that add up.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

use super::{Bench, good, table};

/// Columns by name: the texts of each row.
fn rows(bench: &Bench, name: &str) -> Vec<BTreeMap<String, String>> {
    let (columns, rows) = table(&bench.path("out").join(name));
    let row = |row: Vec<String>| columns.iter().cloned().zip(row).collect();
    rows.into_iter().map(row).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

#[test]
fn what_leaves_is_in_the_table_with_its_body_and_size() {
    let bench = Bench::new();
    bench.good(&good("following.toml"), &["--output", "out"]);
    let summary: Value =
        serde_json::from_slice(&fs::read(bench.path("out/summary.json")).unwrap()).unwrap();
    let gone = rows(&bench, "discharge.csv");
    let population = &summary["population"];
    assert!(gone.len() > 3);
    assert_eq!(population["discharged"], gone.len());
    let sum_kg: f64 = gone.iter().map(|row| number(row, "mass_kg")).sum();
    let discharged_kg = population["discharged_kg"].as_f64().unwrap();
    assert!(
        (sum_kg / discharged_kg - 1.0).abs() < 1e-12,
        "{sum_kg} {discharged_kg}"
    );
    let plot = fs::read_to_string(bench.path("out/plots/discharged_mass.svg")).unwrap();
    assert!(plot.contains(">Discharged mass</text>"), "{plot}");
    // The same moments and fragments as in the table of events.
    let events = rows(&bench, "events.csv");
    let events = events.iter().filter(|row| row["event"] == "discharged");
    let of_events: Vec<[&String; 2]> = events.map(|row| [&row["time_s"], &row["cause"]]).collect();
    let of_rows: Vec<[&String; 2]> = gone
        .iter()
        .map(|row| [&row["time_s"], &row["outlet"]])
        .collect();
    assert_eq!(of_events, of_rows);
    let tree = rows(&bench, "fragment-tree.csv");
    for row in &gone {
        assert!(
            row["body"].starts_with("lump") && row["material"] == "stuff",
            "{row:?}"
        );
        let of_tree = tree
            .iter()
            .find(|one| one["fragment_id"] == row["fragment_id"])
            .unwrap();
        assert_eq!(of_tree["ended_s"], row["time_s"]);
        let [length, width, thickness, diameter] = [
            "length_m",
            "width_m",
            "thickness_m",
            "equivalent_diameter_m",
        ]
        .map(|column| number(row, column));
        assert!(length >= width && width >= thickness && thickness > 0.0);
        // The box holds spheres of that volume, unless they overlap.
        assert!(
            length * width * thickness > 0.5 * diameter.powi(3),
            "{row:?}"
        );
    }
    let bodies = rows(&bench, "fragments.csv");
    assert!(
        bodies
            .iter()
            .all(|row| row["body"].starts_with("lump") && row["material"] == "stuff")
    );
}

#[test]
fn the_distribution_holds_all_of_the_mass() {
    let bench = Bench::new();
    bench.good(&good("following.toml"), &["--output", "out"]);
    let summary: Value =
        serde_json::from_slice(&fs::read(bench.path("out/summary.json")).unwrap()).unwrap();
    let rows = rows(&bench, "distribution.csv");
    let mut last: BTreeMap<[String; 2], [f64; 3]> = BTreeMap::new();
    for row in &rows {
        let key = [row["body"].clone(), row["location"].clone()];
        let now = ["sieve_m", "passing_kg", "passing_fraction"].map(|column| number(row, column));
        if let Some(before) = last.insert(key, now) {
            assert!(before[0] < now[0] && before[1] <= now[1] && before[2] <= now[2]);
        } else {
            assert_eq!(now[1], 0.0, "the first sieve lets nothing pass");
        }
    }
    assert!(last.values().all(|end| end[2] == 1.0));
    let of = |body: &str, location: &str| last[&[body.to_owned(), location.to_owned()]][1];
    let all_kg = of("all", "both");
    let parts_kg = of("all", "inside") + of("all", "discharged");
    assert!((all_kg / parts_kg - 1.0).abs() < 1e-12);
    let bodies_kg: f64 = (summary["bodies"].as_object().unwrap().values())
        .map(|body| body["mass_kg"].as_f64().unwrap())
        .sum();
    assert!(
        (all_kg / bodies_kg - 1.0).abs() < 1e-9,
        "{all_kg} kg of {bodies_kg} kg"
    );
    let discharged_kg = summary["population"]["discharged_kg"].as_f64().unwrap();
    assert!((of("all", "discharged") / discharged_kg - 1.0).abs() < 1e-12);
    for (body, location) in [("all", "both"), ("lump0", "both"), ("all", "discharged")] {
        let sizes = &summary["sizes"];
        let found = match body {
            "all" => &sizes["all"][location],
            body => &sizes["bodies"][body][location],
        };
        assert!((found["mass_kg"].as_f64().unwrap() / of(body, location) - 1.0).abs() < 1e-12);
        // Half of the mass passes the first sieve that is not smaller than d50, and less than half
        // every one that is smaller.
        let d50_m = found["d50_m"].as_f64().unwrap();
        let own = rows
            .iter()
            .filter(|row| row["body"] == body && row["location"] == location);
        for row in own {
            let passes_half = number(row, "passing_fraction") >= 0.5 - 1e-12;
            assert_eq!(
                passes_half,
                number(row, "sieve_m") >= d50_m,
                "{row:?}, d50 {d50_m}"
            );
        }
    }
    // Written again if it is lost.
    fs::remove_file(bench.path("out/distribution.csv")).unwrap();
    let said = bench.good(&good("following.toml"), &["--output", "out", "--resume"]);
    assert!(said.contains("distribution.csv"), "{said}");
}

/// A body that an inlet would feed at the very end is not in the results, in none of them; a run
/// that goes on has it, and the same tables as one that was never interrupted.
#[test]
fn the_last_moment_belongs_to_the_run_that_goes_on() {
    let bench = Bench::new();
    let scene = bench.write(
        "feed.toml",
        "version = 1
run = { end_time = \"0.4 s\", gravity = [0, 0, -9.81], time_step = \"0.1 ms\" }
materials.stone = { density = 2000, young_modulus = \"1 MPa\" }
contacts.stone-stone = { restitution = 0.5, friction = 0.3 }
bonds.glue = { young_modulus = \"1 MPa\", poisson_ratio = 0.3 }
bodies.pair = { particles = [[0, 0, 0, 0.01], [0.02, 0, 0, 0.01]], bond_list = [[0, 1]], material = \"stone\", bonds = \"glue\", start_as = \"clump\" }
regions.gate = { box = { min = [0, 0, 0.2], max = [0.2, 0.2, 0.3] } }
regions.bin = { box = { min = [-9, -9, -9], max = [9, 9, 0.0] } }
inlets.gate = { bodies = [\"pair\"], region = \"gate\", rate = \"10 /s\" }
outlets.bin = { inside = \"bin\" }
replacement.pair.when = { time = \"0.2 s\" }
output.frames = \"0.1 s\"
",
    );
    let run = |end: &str, more: &[&str]| -> Value {
        let end = format!("run.end_time={end}");
        let options = [
            &["--set", &end, "--output", "out", "--json", "--quiet"],
            more,
        ]
        .concat();
        serde_json::from_str(&bench.good(&scene, &options)).unwrap()
    };
    let read = |name: &str| fs::read_to_string(bench.path("out").join(name)).unwrap();
    let of_event = |event: &str| {
        let events = rows(&bench, "events.csv");
        events.iter().filter(|row| row["event"] == event).count()
    };
    let summary = run("0.2 s", &[]);
    // At 0 and 0.1 s.
    assert_eq!(summary["population"]["fed"], 2);
    assert_eq!(of_event("fed"), 2);
    assert_eq!(
        [
            of_event("replaced"),
            rows(&bench, "fragment-tree.csv").len()
        ],
        [0, 2]
    );
    let all = rows(&bench, "distribution.csv");
    let whole = all
        .iter()
        .filter(|row| row["body"] == "all" && row["location"] == "both");
    let heaviest_kg = whole
        .map(|row| number(row, "passing_kg"))
        .fold(0.0, f64::max);
    let fed_kg = summary["population"]["fed_kg"].as_f64().unwrap();
    assert!(
        (heaviest_kg / fed_kg - 1.0).abs() < 1e-12,
        "{heaviest_kg} {fed_kg}"
    );
    run("0.4 s", &["--resume"]);
    let continued = [
        "events.csv",
        "discharge.csv",
        "distribution.csv",
        "fragment-tree.csv",
    ]
    .map(read);
    run("0.4 s", &["--force"]);
    let at_once = [
        "events.csv",
        "discharge.csv",
        "distribution.csv",
        "fragment-tree.csv",
    ]
    .map(read);
    assert_eq!(continued, at_once);
    assert!(of_event("fed") == 4 && of_event("replaced") > 0 && of_event("discharged") > 0);
    let mut check = super::dem_run();
    let output = check
        .arg("check")
        .arg(&scene)
        .arg("--json")
        .output()
        .unwrap();
    let checked: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(checked["to_be_fed"][0]["bodies"], 4.0);
}

/// Two bodies that two inlets feed, one of which breaks, and two outlets.
const TWO: &str = "version = 1
run = { end_time = \"1 s\", gravity = [0, 0, -9.81], time_step = \"0.1 ms\" }
materials.stone = { density = 2000, young_modulus = \"1 MPa\" }
contacts.stone-stone = { restitution = 0.5, friction = 0.3 }
bonds.glue = { young_modulus = \"1 MPa\", poisson_ratio = 0.3, failure = { tensile_strength = \"1 kPa\", shear_strength = \"1 kPa\" } }
bodies.pair = { particles = [[0, 0, 0, 0.01], [0.02, 0, 0, 0.007]], bond_list = [[0, 1]], material = \"stone\", bonds = \"glue\", start_as = \"clump\" }
bodies.pebble = { particles = [[0, 0, 0, 0.013]], material = \"stone\", start_as = \"clump\" }
bodies.there = { particles = [[0, 0, 0.05, 0.013]], material = \"stone\", start_as = \"clump\" }
walls.plate = { box = { min = [-0.1, 0.0, -0.1], max = [0.3, 0.1, 0.0] }, material = \"stone\", rotation = { axis = [0, 1, 0], angle = \"20 deg\" } }
regions.gate = { box = { min = [0, 0, 0.2], max = [0.2, 0.2, 0.3] } }
regions.side = { box = { min = [0, 0.4, 0.2], max = [0.2, 0.6, 0.3] } }
regions.bin = { box = { min = [-9, -9, -9], max = [9, 0.3, -0.2] } }
regions.scene = { box = { min = [-1, -1, -0.4], max = [1, 1, 1] } }
inlets.pairs = { bodies = [\"pair\"], region = \"gate\", rate = \"20 /s\" }
inlets.both = { bodies = { pair = 0.3, pebble = 0.7 }, region = \"side\", rate = \"15 /s\" }
outlets.bin = { inside = \"bin\" }
outlets.lost = { outside = \"scene\" }
replacement.pair.when = { impact_energy = \"1e-6 J\" }
output = { frames = \"0.5 s\", flow = \"0.3 s\", sieves = [\"10 mm\", \"15 mm\", \"30 mm\"] }
";

#[test]
fn what_is_fed_is_what_left_and_what_is_inside() {
    let bench = Bench::new();
    let scene = bench.write("two.toml", TWO);
    let options = ["--output", "out", "--json", "--quiet"];
    let summary: Value = serde_json::from_str(&bench.good(&scene, &options)).unwrap();
    let gone = rows(&bench, "discharge.csv");
    let flows = rows(&bench, "flow.csv");
    let fed = rows(&bench, "events.csv");
    let mut fed_kg = 0.0;
    for (name, flow) in summary["flows"].as_object().unwrap() {
        let kg = |key: &str| flow[key].as_f64().unwrap();
        let of_body = |row: &&BTreeMap<String, String>| row["body"] == *name;
        let mass_kg = summary["bodies"][name]["mass_kg"].as_f64().unwrap();
        let is_fed = name != "there";
        let count = if is_fed { kg("fed") } else { 0.0 };
        assert!((kg("fed_kg") - count * mass_kg).abs() < 1e-12 * mass_kg * (count + 1.0));
        assert_eq!(kg("start_kg"), if is_fed { 0.0 } else { mass_kg });
        fed_kg += kg("fed_kg");
        let mut left_kg = 0.0;
        for (outlet, out_kg) in flow["discharged_kg"].as_object().unwrap() {
            let through = gone
                .iter()
                .filter(of_body)
                .filter(|row| row["outlet"] == *outlet);
            let sum_kg = through.fold(0.0, |sum, row| sum + number(row, "mass_kg"));
            assert_eq!(out_kg.as_f64().unwrap(), sum_kg, "{name} through {outlet}");
            left_kg += sum_kg;
            // The last row has all of it, and the flows times their intervals give it.
            let own = flows.iter().filter(of_body);
            let own: Vec<_> = own.filter(|row| row["outlet"] == *outlet).collect();
            assert_eq!(own.is_empty(), sum_kg == 0.0);
            let mut before_s = 0.0;
            let mut flown_kg = 0.0;
            for row in &own {
                flown_kg += number(row, "flow_kg_s") * (number(row, "time_s") - before_s);
                before_s = number(row, "time_s");
                assert!((flown_kg - number(row, "mass_kg")).abs() < 1e-12);
            }
            assert!((flown_kg - sum_kg).abs() < 1e-12);
        }
        let all_kg = kg("start_kg") + kg("fed_kg");
        let missing_kg = all_kg - left_kg - kg("inside_kg");
        assert!(missing_kg.abs() < 1e-12 * all_kg, "{name}: {missing_kg}");
        assert!(kg("missing_kg").abs() < 1e-12 * all_kg);
    }
    let population = &summary["population"];
    assert!((population["fed_kg"].as_f64().unwrap() / fed_kg - 1.0).abs() < 1e-12);
    let fed_count = fed.iter().filter(|row| row["event"] == "fed").count();
    let counted = ["pair", "pebble"].map(|name| summary["flows"][name]["fed"].as_u64().unwrap());
    assert_eq!(counted.iter().sum::<u64>(), fed_count as u64);
    // Both inlets and both outlets were at work, and pairs broke.
    let through = |outlet: &str| gone.iter().any(|row| row["outlet"] == outlet);
    assert!(through("bin") && through("lost"));
    assert!(summary["broken_bonds"].as_u64().unwrap() > 0);
    let times: Vec<f64> = flows.iter().map(|row| number(row, "time_s")).collect();
    assert!((times[0] - 0.3).abs() < 1e-12 && (times[times.len() - 1] - 1.0).abs() < 1e-3);
    let sieves = rows(&bench, "distribution.csv");
    let of_pair = sieves
        .iter()
        .filter(|row| row["body"] == "pair" && row["location"] == "both");
    let sieves: Vec<f64> = of_pair.map(|row| number(row, "sieve_m")).collect();
    assert_eq!(sieves, [0.01, 0.015, 0.03]);
    // Written again if it is lost.
    fs::remove_file(bench.path("out/flow.csv")).unwrap();
    let said = bench.good(&scene, &["--output", "out", "--resume"]);
    assert!(said.contains("flow.csv"), "{said}");
}

/// Three spinning pairs break at once; one of them has left when the run ends, and the halves of
/// another are rigid again: measures count what the summary counts.
#[test]
fn measures_do_not_forget_what_has_left() {
    let bench = Bench::new();
    let pair = |name: &str, x_m: f64, speed: f64| {
        format!(
            "bodies.{name} = {{ particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3], [4e-3, 0, 0, 1e-3]], bond_list = [[0, 1], [1, 2]], material = \"rock\", bonds = \"{name}\", position = [{x_m}, 0, 0], velocity = [0, {speed}, 0], angular_velocity = [0, 0, 3000] }}
             bonds.{name} = {{ young_modulus = 1e8, poisson_ratio = 0.25, failure = {{ tensile_strength = {} }} }}
             measures.broken-{name} = {{ of = \"{name}\", quantity = \"broken_bonds\" }}\n",
            if name == "stays" { 1e12 } else { 1e2 }
        )
    };
    let scene = |end: &str| {
        format!(
            "version = 1
             run = {{ end_time = \"{end}\" }}
             materials.rock = {{ density = 2500, young_modulus = 1e8 }}
             contacts.rock-rock = {{ restitution = 0.5 }}
             {}{}{}
             regions.box = {{ box = {{ min = [-1, -1, -1], max = [1, 0.03, 1] }} }}
             outlets.gone = {{ outside = \"box\" }}
             measures.broken = {{ quantity = \"broken_bonds\" }}
             measures.pieces = {{ of = \"fragments\", quantity = \"count\" }}
             measures.largest = {{ of = \"fragments\", quantity = \"mass_fraction_of_largest\" }}
             measures.heaviest = {{ of = \"fragments\", quantity = \"mass_of_largest\" }}",
            pair("goes", 0.0, 20.0),
            pair("near", 0.1, 0.0),
            pair("stays", 0.2, 0.0),
        )
    };
    let run = |end: &str| -> Value {
        let file = bench.write("scene.toml", scene(end));
        serde_json::from_str(&bench.good(&file, &["--json", "--quiet"])).unwrap()
    };
    let results = run("5 ms");
    let value = |name: &str| results["measures"][name]["value"].as_f64().unwrap();
    assert!(results["population"]["discharged"].as_u64().unwrap() >= 2);
    assert_eq!(results["broken_bonds"], 4);
    assert_eq!(value("broken"), 4.0);
    assert_eq!(
        ["goes", "near", "stays"].map(|n| value(&format!("broken-{n}"))),
        [2.0, 2.0, 0.0]
    );
    assert_eq!(value("pieces"), 7.0);
    assert_eq!(results["fragments"]["count"], 7);
    let gone = results["population"]["discharged"].as_u64().unwrap();
    assert_eq!(results["fragments"]["inside"], 7 - gone);
    assert!((value("largest") - 3.0 / 9.0).abs() < 1e-12);
    let fraction = results["fragments"]["mass_fraction_of_largest"]
        .as_f64()
        .unwrap();
    assert!((fraction - 3.0 / 9.0).abs() < 1e-12);
    // A group of particles would forget them.
    let group = format!(
        "{}\ngroups.some = {{ body = \"goes\", particles = [0] }}\nmeasures.bad = {{ of = \"some\", quantity = \"broken_bonds\" }}",
        scene("1 us")
    );
    let said = bench.bad(&bench.write("group.toml", group), &[], 2);
    assert!(
        said.contains("[measures.bad]: \"some\" is a group, which forgets"),
        "{said}"
    );
}

/// In every scene of the repository that has a measure of what breaks, it is what the summary says.
#[test]
fn measures_agree_with_the_summary_in_every_scene() {
    use rayon::prelude::*;
    let folder = super::root().join("data/scenes");
    let mut scenes: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    scenes.retain(|path| {
        let text = fs::read_to_string(path).unwrap_or_default();
        let asks = [
            "\"broken_bonds\"",
            "\"count\"",
            "\"mass_fraction_of_largest\"",
        ];
        asks.iter().any(|quantity| text.contains(quantity)) && text.contains("[outlets")
    });
    assert!(scenes.len() >= 3, "{scenes:?}");
    scenes.par_iter().for_each(|path| {
        let bench = Bench::new();
        let options = [
            "--set",
            "run.end_time=20 ms",
            "--set",
            "measures.broken-in-all.quantity=broken_bonds",
            "--json",
            "--quiet",
            "--output",
            "out",
        ];
        let results: Value = serde_json::from_str(&bench.good(path, &options)).unwrap();
        let value = |name: &str| results["measures"][name]["value"].as_f64().unwrap();
        assert_eq!(
            value("broken-in-all"),
            results["broken_bonds"].as_f64().unwrap(),
            "{path:?}"
        );
        let text = fs::read_to_string(path).unwrap();
        if text.contains("[measures.pieces]") {
            assert_eq!(
                value("pieces"),
                results["fragments"]["count"].as_f64().unwrap(),
                "{path:?}"
            );
        }
    });
}
