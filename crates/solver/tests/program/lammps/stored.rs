//! Dumps that LAMMPS has written, beside a run of the same scene.

use std::fs;
use std::path::PathBuf;

use super::{exported, go};
use crate::program::{Bench, table};

/// A block of 27 spheres that falls on its edge, with the dumps of LAMMPS (22 Jul 2025 - Update 4).
fn stored(name: &str) -> PathBuf {
    let folder = "tests/program/lammps/small-drop";
    [env!("CARGO_MANIFEST_DIR"), folder, name].iter().collect()
}

/// The broken bonds of a run, with their times, s, and its splits in words.
fn breakage(bench: &Bench, results: &str) -> (Vec<(String, f64)>, Vec<String>) {
    let (_, rows) = table(&bench.path(&format!("{results}/events.csv")));
    let broken = rows.iter().filter(|row| row[2] == "bond_broken");
    let broken = broken.map(|row| {
        let [bond, a, b] = [3, 4, 5].map(|k| row[k].as_str());
        (format!("{bond} {a} {b}"), row[1].parse().unwrap())
    });
    let splits = rows.iter().filter(|row| row[2] == "split");
    // Without the numbers of the fragments, which depend on the order of the particles.
    let sizes = |row: &Vec<String>| row[11..].join(",").split(" (").nth(1).unwrap().to_owned();
    (broken.collect(), splits.map(sizes).collect())
}

#[test]
fn what_lammps_broke_is_what_a_run_breaks() {
    let bench = Bench::new();
    bench.write(
        "scene.toml",
        fs::read_to_string(stored("scene.toml")).unwrap(),
    );
    exported(&bench, "scene.toml");
    for name in ["frames.dump", "bonds.dump", "broken.dump"] {
        fs::copy(stored(name), bench.path(&format!("out/{name}"))).unwrap();
    }
    let done = go(&bench, &["import", "out", "-o", "back"]);
    let said = String::from_utf8_lossy(&done.stdout);
    let wanted = "6 frames, the last at 0.00105 s, 8 broken bonds, 3 fragments -> back\n";
    assert_eq!(said, wanted, "{done:?}");
    let done = go(&bench, &["scene.toml", "-o", "ours", "-q"]);
    assert!(done.status.success(), "{done:?}");
    let (ours, our_splits) = breakage(&bench, "ours");
    let (found, splits) = breakage(&bench, "back");
    // The next one breaks here at the end, and in LAMMPS after it.
    assert_eq!([found.len(), ours.len()], [8, 9]);
    for ((bond, at_s), (wanted, wanted_s)) in found.iter().zip(&ours) {
        // Steps of 0.5 us, in which damping of LAMMPS is of first order.
        assert_eq!(bond, wanted);
        assert!(
            (at_s / wanted_s - 1.0).abs() < 0.01,
            "{bond}: {at_s} {wanted_s}"
        );
    }
    assert_eq!(splits, our_splits);
    assert_eq!(splits, ["26 + 1 particles)\",,", "25 + 1 particles)\",,"]);
    let particles = |results: &str| {
        let (_, rows) = table(&bench.path(&format!("{results}/fragment-tree.csv")));
        let living = rows.iter().filter(|row| row[3].is_empty());
        let mut sizes: Vec<u32> = living.map(|row| row[4].parse().unwrap()).collect();
        sizes.sort_unstable();
        sizes
    };
    assert_eq!(particles("back"), particles("ours"));
    // The particles are where those of the run are, up to the times of the breaks.
    let largest = |results: &str| {
        let (columns, rows) = table(&bench.path(&format!("{results}/fragments.csv")));
        let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
        let last = rows.iter().rev();
        let most = last
            .take(3)
            .max_by_key(|row| row[at("particles")].parse::<u32>().unwrap());
        let row = most.unwrap().clone();
        ["mass_kg", "x_m", "z_m", "vz_m_s"].map(|name| row[at(name)].parse::<f64>().unwrap())
    };
    for (found, wanted) in largest("back").iter().zip(largest("ours")) {
        assert!((found / wanted - 1.0).abs() < 0.02, "{found} {wanted}");
    }
}

#[test]
fn dumps_of_another_body_are_refused() {
    let bench = Bench::new();
    let scene = fs::read_to_string(stored("scene.toml")).unwrap();
    // Its last sphere is smaller.
    let other = scene.replace("[0.02, 0.02, 0.02, 0.005]", "[0.02, 0.02, 0.02, 0.004]");
    assert_ne!(other, scene);
    bench.write("scene.toml", other);
    exported(&bench, "scene.toml");
    for name in ["frames.dump", "bonds.dump", "broken.dump"] {
        fs::copy(stored(name), bench.path(&format!("out/{name}"))).unwrap();
    }
    let (said, code) = crate::program::refused(&go(&bench, &["import", "out", "-o", "back"]));
    assert!(
        code == 2 && said.contains("atom 27 has a radius of 0.005 m, not 0.004 m"),
        "{said}"
    );
    assert!(!bench.path("back").exists());
}
