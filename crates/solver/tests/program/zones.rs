//! Events of bodies that are bonded in a region only.

use serde_json::Value;

use super::{Bench, table};

/// A bar of which a plane goes to and fro by a sphere between two looks, and which vibrates.
const SCENE: &str = "version = 1
run = { end_time = 1.001e-4, time_step = 1e-7 }
materials.rock = { density = 2500, young_modulus = 1e9, poisson_ratio = 0.25 }
contacts.rock-rock = { restitution = 0.5, friction = 0.5 }
bonds.rock = { young_modulus = 1e9, poisson_ratio = 0.25 }
regions.zone.box = { min = [-1, -1, -1], max = [5e-3, 1, 1] }
[bodies.bar]
particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3], [4e-3, 0, 0, 1e-3], [6e-3, 0, 0, 1e-3], [8e-3, 0, 0, 1e-3], [1e-2, 0, 0, 1e-3]]
bond_list = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]]
material = \"rock\"
bonds = \"rock\"
bonded_within = { region = \"zone\", moves_with = \"carrier\", rejoin = { strain_energy = 1e9, fluctuation_velocity = 1e3 } }
[walls.carrier]
box = { min = [9, 9, 9], max = [9.1, 9.1, 9.1] }
material = \"rock\"
displacement = [2e-3, 0, 0]
table = [[0, 0], [5e-6, 1], [1e-5, 0], [1.5e-5, 1], [2e-5, 0], [2.5e-5, 1], [3e-5, 0]]
[groups.first]
body = \"bar\"
particles = [0]
[initial.first]
group = \"first\"
velocity = [0.3, 0.2, 0]
";

#[test]
fn events_tell_what_zones_release_and_take_back() {
    let bench = Bench::new();
    let file = bench.write("zone.toml", SCENE);
    let options = ["--json", "--quiet", "--output", "out"];
    let results: Value = serde_json::from_str(&bench.good(&file, &options)).unwrap();
    let (columns, rows) = table(&bench.path("out/events.csv"));
    let column = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let of = |kind: &str| -> Vec<&Vec<String>> {
        let rows = rows.iter();
        rows.filter(|row| row[column("event")] == kind).collect()
    };
    let steps = |rows: &[&Vec<String>]| -> Vec<String> {
        rows.iter().map(|row| row[column("step")].clone()).collect()
    };
    let (released, rejoined) = (of("released"), of("rejoined"));
    assert_eq!(steps(&released), ["50", "150", "250"]);
    assert_eq!(steps(&rejoined), ["100", "200", "300"]);
    let mut lost_j = 0.0;
    for row in released.iter().chain(&rejoined) {
        assert_eq!(row[column("cause")], "region");
        assert_eq!(row[column("detail")], "bar: 1 particle");
        let energy_j: f64 = row[column("energy_j")].parse().unwrap();
        assert!(row[column("event")] == "rejoined" || energy_j == 0.0);
        assert!(energy_j >= 0.0);
        lost_j += energy_j;
    }
    let balance = &results["balance"];
    assert!(lost_j > 0.0);
    assert_eq!(balance["rejoining_loss_j"].as_f64(), Some(lost_j));
    assert_eq!(balance["flow_energy_j"], 0.0);
    for (key, count) in [("released", 3), ("rejoined", 3)] {
        assert_eq!(results["population"][key], count);
    }
}
