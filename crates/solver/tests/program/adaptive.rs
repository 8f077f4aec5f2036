//! A time step that follows the limit.

use serde_json::Value;

use super::{Bench, good, table};

fn summary(bench: &Bench, scene: &std::path::Path, options: &[&str]) -> Value {
    serde_json::from_str(&bench.good(scene, &[options, &["--json"]].concat())).unwrap()
}

fn steps_of_events(bench: &Bench, out: &str) -> Vec<(String, [f64; 2])> {
    let (_, events) = table(&bench.path(&format!("{out}/events.csv")));
    let times = |detail: &str| -> [f64; 2] {
        let numbers: Vec<f64> = (detail.split(' '))
            .filter_map(|word| word.parse().ok())
            .collect();
        [numbers[0], numbers[1]]
    };
    (events.iter().filter(|row| row[2] == "time_step"))
        .map(|row| (row[9].clone(), times(&row[11])))
        .collect()
}

#[test]
fn it_falls_as_clumps_become_clusters_and_rises_when_it_may() {
    let bench = Bench::new();
    let run = |out: &str, adaptive: &str| {
        let set = format!("run.adaptive={adaptive}");
        summary(
            &bench,
            &good("following.toml"),
            &["--output", out, "--set", &set],
        )
    };
    let (following, falling) = (run("following", "true"), run("falling", "false"));
    assert!(falling["adaptive"].is_null());
    let changes = steps_of_events(&bench, "following");
    let (cause, [before_s, after_s]) = &changes[0];
    assert!(
        cause == "replacement" && *before_s > 2.0 * after_s,
        "{changes:?}"
    );
    let rises = |(cause, [before_s, after_s]): &(String, [f64; 2])| {
        cause == "adaptive" && after_s > before_s
    };
    assert!(changes[1..].iter().any(rises), "{changes:?}");
    let of_adaptive = &following["adaptive"];
    assert_eq!(of_adaptive["changes"], changes.len() as u64);
    let smallest_s = changes
        .iter()
        .map(|(_, s)| s[0].min(s[1]))
        .fold(f64::INFINITY, f64::min);
    assert!((of_adaptive["smallest_step_s"].as_f64().unwrap() / smallest_s - 1.0).abs() < 1e-4);
    // Its cost: hardly more energy error than without, both small, for fewer steps.
    let error = |of: &Value| of["energy_error"].as_f64().unwrap();
    assert!(
        error(&following) < 2.0 * error(&falling).max(1e-4),
        "{following}"
    );
    assert!(following["steps"].as_u64() < falling["steps"].as_u64());
    assert!(following["momentum_error"].as_f64().unwrap() < 1e-11);
}

/// One of two spheres is pulled until the bond between them breaks, soon; after that nothing
/// vibrates, and the effect of a constant force is exact for any step.
const DUMBBELL: &str = "version = 1
run = { end_time = 4, ADAPTIVE }
materials.stuff = { density = 2500 }
bonds.stiff = { young_modulus = 1e9, poisson_ratio = 0.25, failure = { tensile_strength = 1e5 } }
[bodies.dumbbell]
particles = [[0, 0, 0, 0.01], [0.02, 0, 0, 0.01]]
bond_list = [[0, 1]]
material = \"stuff\"
bonds = \"stiff\"
[groups.right]
body = \"dumbbell\"
particles = [1]
[loads.pull]
group = \"right\"
force = [100, 0, 0]
[measures.right]
of = \"right\"
quantity = \"displacement_x\"
";

#[test]
fn without_anything_that_vibrates_steps_are_large_and_a_flight_is_the_same() {
    let bench = Bench::new();
    let run = |name: &str, adaptive: &str| {
        let scene = bench.write(name, DUMBBELL.replace("ADAPTIVE", adaptive));
        summary(&bench, &scene, &["--output", &format!("{name}-out")])
    };
    let (following, falling) = (
        run("a.toml", "adaptive = true"),
        run("b.toml", "adaptive = false"),
    );
    assert_eq!(following["broken_bonds"], 1);
    let steps = |of: &Value| of["steps"].as_u64().unwrap();
    assert!(
        20 * steps(&following) < steps(&falling),
        "{following} {falling}"
    );
    let place = |of: &Value| measure(of, "right");
    let apart = (place(&following) / place(&falling) - 1.0).abs();
    assert!(apart < 1e-9, "{apart:e}");
}

fn measure(of: &Value, name: &str) -> f64 {
    of["measures"][name]["value"].as_f64().unwrap()
}

/// Two elastic spheres that are at rest against each other when the step is updated: their impact
/// is not over.
const MID_CONTACT: &str = r#"version = 1
[run]
end_time = "0.5 s"
adaptive = true
[materials.gel]
density = "1000 kg/m3"
young_modulus = "1 MPa"
poisson_ratio = 0.3
[contacts]
gel-gel = { restitution = 1.0 }
[bodies.a]
material = "gel"
particles = [[0, 0, 0, 0.01]]
velocity = [1, 0, 0]
[bodies.b]
material = "gel"
particles = [[0.2516, 0, 0, 0.01]]
velocity = [-1, 0, 0]
[measures.v]
of = "a"
quantity = "velocity_x"
"#;

#[test]
fn the_step_does_not_rise_in_the_middle_of_a_contact() {
    let bench = Bench::new();
    for gap in ["0.2516", "0.2503", "0.2527"] {
        let scene = bench.write("mid.toml", MID_CONTACT.replace("0.2516", gap));
        let run = |adaptive: &str| {
            let set = format!("run.adaptive={adaptive}");
            summary(&bench, &scene, &["--set", &set])
        };
        let (following, falling) = (run("true"), run("false"));
        let error = |of: &Value| of["energy_error"].as_f64().unwrap();
        assert!(
            error(&following) < 2.0 * error(&falling),
            "{gap}: {following}"
        );
        assert!((measure(&following, "v") + 1.0).abs() < 2e-3, "{following}");
    }
}

/// The step increases as the stiff body leaves, and the neighbour list was made for small steps:
/// then two soft spheres meet.
const LATE_LISTING: &str = r#"version = 1
[run]
end_time = "0.15 s"
adaptive = true
[materials.gel]
density = "1000 kg/m3"
young_modulus = "60 kPa"
poisson_ratio = 0.3
[materials.hard]
density = "1000 kg/m3"
young_modulus = "200 MPa"
poisson_ratio = 0.3
[contacts]
gel-gel = { restitution = 1.0 }
hard-gel = { restitution = 1.0 }
hard-hard = { restitution = 1.0 }
[bonds.b]
model="timoshenko"
young_modulus="200 MPa"
poisson_ratio=0.3
failure={tensile_strength="1 GPa"}
[search]
skin = 0.1
[bodies.a]
material = "gel"
particles = [[0, 0, 0, 0.01]]
velocity = [1, 0, 0]
[bodies.b]
material = "gel"
particles = [[0.181950588977714, 0, 0, 0.01]]
velocity = [-1, 0, 0]
[bonds.soft]
model="timoshenko"
young_modulus="1 kPa"
poisson_ratio=0.3
failure={tensile_strength="1 GPa"}
[bodies.stay]
material = "gel"
bonds = "soft"
particles = [[0, -1, 0, 0.01],[0,-1,0.02,0.01]]
bond_list = [[0,1]]
[bodies.fast]
material = "hard"
bonds = "b"
particles = [[0, 1, 0, 0.01],[0,1,0.02,0.01]]
bond_list = [[0,1]]
velocity = [0, 30, 0]
[regions.out]
box = { min = ["-10 m", "1.2 m", "-10 m"], max = ["10 m", "100 m", "10 m"] }
[outlets.o]
inside = "out"
[measures.v]
of = "a"
quantity = "velocity_x"
[measures.zz]
of="a"
quantity="position_x"
statistic="largest"
[measures.e]
quantity = "elastic_energy"
statistic = "largest"
"#;

#[test]
fn who_is_near_is_asked_anew_when_the_step_rises() {
    let bench = Bench::new();
    let scene = bench.write("late.toml", LATE_LISTING);
    let run = |adaptive: &str| {
        let set = format!("run.adaptive={adaptive}");
        summary(&bench, &scene, &["--set", &set])
    };
    let (following, falling) = (run("true"), run("false"));
    let largest = following["adaptive"]["largest_step_s"].as_f64().unwrap();
    assert!(largest > 20.0 * falling["time_step_s"].as_f64().unwrap());
    // Depth of their compression, and its elastic energy.
    let apart_m = measure(&following, "zz") - measure(&falling, "zz");
    assert!(apart_m.abs() < 2e-5, "{apart_m:e}");
    let fraction = measure(&following, "e") / measure(&falling, "e");
    assert!((fraction - 1.0).abs() < 0.01, "{fraction}");
}

/// Two clumps fall one after the other through a region in which they are bonded; nothing is hit.
const IN_AND_OUT: &str = r#"version = 1
[run]
end_time = "0.3 s"
gravity = [0, 0, -9.81]
[materials.stuff]
density = 2500
young_modulus = "0.1 MPa"
poisson_ratio = 0.25
[contacts]
stuff-stuff = { restitution = 0.5, friction = 0.3 }
[bonds.stiff]
young_modulus = "1 GPa"
poisson_ratio = 0.25
[bodies.first]
particles = [[0, 0, 0, "1 mm"], ["2 mm", 0, 0, "1 mm"], [0, "2 mm", 0, "1 mm"], ["2 mm", "2 mm", 0, "1 mm"]]
bond_list = [[0, 1], [0, 2], [1, 3], [2, 3]]
material = "stuff"
bonds = "stiff"
start_as = "clump"
position = [0, 0, "50 mm"]
[bodies.second]
particles = [[0, 0, 0, "1 mm"], ["2 mm", 0, 0, "1 mm"], [0, "2 mm", 0, "1 mm"], ["2 mm", "2 mm", 0, "1 mm"]]
bond_list = [[0, 1], [0, 2], [1, 3], [2, 3]]
material = "stuff"
bonds = "stiff"
start_as = "clump"
position = [0, 0, "300 mm"]
[regions.middle]
box = { min = [-1, -1, 0], max = [1, 1, "20 mm"] }
[replacement.first]
when = { enters = "middle" }
restore = { leaves = "middle", min_particles = 2 }
[replacement.second]
when = { enters = "middle" }
restore = { leaves = "middle", min_particles = 2 }
[walls.floor]
plane = { point = [0, 0, -1], normal = [0, 0, 1] }
material = "stuff"
"#;

#[test]
fn the_step_is_that_of_clumps_whenever_nothing_is_bonded() {
    let bench = Bench::new();
    let scene = bench.write("in-and-out.toml", IN_AND_OUT);
    let plain = summary(&bench, &scene, &[]);
    let adaptive = ["--set", "run.adaptive=true", "--output", "out"];
    let following = summary(&bench, &scene, &adaptive);
    let mut changes = steps_of_events(&bench, "out");
    // The limit of a bonded body is known to some digits only.
    changes.retain(|(_, [before_s, after_s])| (before_s / after_s - 1.0).abs() > 0.01);
    let causes: Vec<&str> = changes.iter().map(|(cause, _)| cause.as_str()).collect();
    let wanted = ["replacement", "adaptive", "replacement", "adaptive"];
    assert_eq!(causes, wanted, "{changes:?}");
    let number = |of: &Value, name: &str| of[name].as_f64().unwrap();
    let plain_s = number(&plain, "time_step_s");
    let [first_s, ..] = changes[0].1;
    for (cause, [before_s, after_s]) in &changes {
        let [clumps_s, bonded_s] = match cause.as_str() {
            "replacement" => [before_s, after_s],
            _ => [after_s, before_s],
        };
        // It falls with the speed of what is still to hit the floor.
        assert!((clumps_s / first_s - 1.0).abs() < 0.1, "{changes:?}");
        assert!((bonded_s / plain_s - 1.0).abs() < 0.01, "{changes:?}");
    }
    assert!(first_s > 5.0 * plain_s, "{changes:?}");
    assert!(4.0 * number(&following, "steps") < number(&plain, "steps"));
}
