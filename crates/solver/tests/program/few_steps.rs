//! Contacts that last for a few steps.

use serde_json::Value;

use super::Bench;

/// A bounce of six steps: it is seen, with the overlap that the measure gives.
#[test]
fn a_bounce_of_a_few_steps_is_seen() {
    let bench = Bench::new();
    let scene = bench.write(
        "bounce.toml",
        "version = 1
run = { end_time = 0.004, time_step = 2.3e-5 }
materials.a = { density = 2500, young_modulus = 1e9, poisson_ratio = 0.3 }
materials.s = { rigid = true }
contacts.a-s = { restitution = 1, friction = 0 }
bodies.b = { particles = [[0, 0, 0.00556, 0.005]], material = \"a\", velocity = [0, 0, -1] }
walls.f = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"s\" }
measures.o = { of = \"b\", quantity = \"contact_overlap\", statistic = \"largest\", with = \"f\" }
",
    );
    let told = bench.good(&scene, &["--json", "--quiet"]);
    let summary: Value = serde_json::from_str(&told).unwrap();
    assert!(!told.contains("nothing touched"), "{told}");
    let overlap_m = summary["measures"]["o"]["value"].as_f64().unwrap();
    let ratio = summary["largest_overlap"].as_f64().unwrap();
    assert!(
        (ratio / (overlap_m / 0.005) - 1.0).abs() < 1e-6,
        "{ratio} {overlap_m}"
    );
}
