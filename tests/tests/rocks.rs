//! A stored fast test of tests/verification/rocks.md, computed again.

use std::f64::consts::PI;

use crate::{dem_pack, dem_run, root};

/// A row of tests/rocks/computed.csv.
const ROW: &str = "Taunus Quartzite,false,1,24.2,";
const DENSITY: &str = "2645 kg/m3";
const DIAMETER_M: f64 = 0.041;

#[test]
fn a_stored_test_of_a_rock_comes_out_again() {
    let rocks = root().join("tests/rocks");
    let stored = std::fs::read_to_string(rocks.join("computed.csv")).unwrap();
    let row = stored
        .lines()
        .find_map(|line| line.strip_prefix(ROW))
        .unwrap();
    let stored_mpa: f64 = row.split(',').nth(1).unwrap().parse().unwrap();

    let folder = tempfile::tempdir().unwrap();
    let body = folder.path().join("rock.vtp");
    let mut pack = dem_pack();
    pack.arg(rocks.join("fast.stl"))
        .args(["--diameter=3.4mm..4.6mm", "--overlap=0.25"]);
    pack.args(["--bond-range=1.1", "--seed=1", "-o"]).arg(&body);
    assert!(pack.output().unwrap().status.success());

    let results = folder.path().join("results");
    let mut run = dem_run();
    run.arg(rocks.join("fast.toml")).arg("--body").arg(&body);
    run.arg("--material")
        .arg(rocks.join("taunus-quartzite.toml"));
    for set in [
        "test.striker.velocity=\"24.2 m/s\"",
        &format!("bodies.rock.body_density=\"{DENSITY}\""),
        "test.strength=\"255.3 MPa\"",
        "bonds.rock.damping={damping_ratio=0.05}",
        "bonds.rock.failure.rate_strengthening=false",
        "output.frames=\"10 s\"",
        "output.pictures=\"10 s\"",
    ] {
        run.args(["--set", set]);
    }
    let done = run
        .args(["--quiet", "--output"])
        .arg(&results)
        .output()
        .unwrap();
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );

    let signals = std::fs::read_to_string(results.join("bar-signals.csv")).unwrap();
    let forces_n = signals.lines().skip(1).map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        0.5 * (cells[4] + cells[5])
    });
    let strength_mpa = 1e-6 * forces_n.fold(0.0, f64::max) / (0.25 * PI * DIAMETER_M.powi(2));
    assert!(
        (strength_mpa / stored_mpa - 1.0).abs() < 1e-5,
        "{strength_mpa} MPa"
    );
}
