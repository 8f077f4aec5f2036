//! Any number of threads gives the same bits in all files.

use std::fmt::Write;

use dem_io::Body;
use dem_io::body::About;

use super::{Bench, assert_same, corpus, vtp_bytes};

#[test]
fn of_every_good_scene() {
    for scene in corpus("good") {
        let bench = Bench::new();
        for threads in ["1", "2", "3"] {
            bench.good(&scene, &["--threads", threads, "--output", threads]);
        }
        assert_same(&bench.path("1"), &bench.path("2"));
        assert_same(&bench.path("1"), &bench.path("3"));
    }
}

/// A block of n x n x 4n particles, each bonded to its neighbours.
fn block(n: usize) -> Body {
    let number = |i: usize, j: usize, k: usize| ((k * n + j) * n + i) as u32;
    let (mut positions, mut bonds) = (Vec::new(), Vec::new());
    for k in 0..4 * n {
        for j in 0..n {
            for i in 0..n {
                positions.push([i, j, k].map(|x| 2e-3 * x as f64));
                let here = number(i, j, k);
                for (is_in, [di, dj, dk]) in [
                    (i + 1 < n, [1, 0, 0]),
                    (j + 1 < n, [0, 1, 0]),
                    (k + 1 < 4 * n, [0, 0, 1]),
                ] {
                    if is_in {
                        bonds.push([here, number(i + di, j + dj, k + dk)]);
                    }
                }
            }
        }
    }
    Body {
        radii: vec![1e-3; positions.len()],
        bond_radii: vec![5e-4; bonds.len()],
        bond_lengths: vec![2e-3; bonds.len()],
        bond_damages: Vec::new(),
        turns_rad: Vec::new(),
        bond_directions: Vec::new(),
        bond_histories: Vec::new(),
        positions,
        bonds,
        about: About::default(),
    }
}

#[test]
fn of_a_body_that_is_divided_among_them() {
    let bench = Bench::new();
    let block = block(9);
    assert!(block.positions.len() > 2500);
    bench.write("block.vtp", vtp_bytes(&block));
    for formulation in ["total", "incremental"] {
        let mut scene = String::new();
        write!(
            scene,
            "version = 1\n\
             run = {{ end_time = \"0.5 ms\", gravity = [0, 0, -9.81], local_damping = 0.1 }}\n\
             materials.cake.density = 2050\n\
             output.frames = \"0.25 ms\"\n\
             [bonds.cake]\nyoung_modulus = \"12 MPa\"\npoisson_ratio = 0.3\nformulation = \"{formulation}\"\n\
             damping = {{ damping_ratio = 0.1 }}\n\
             failure = {{ von_mises_strength = \"20 kPa\", equivalent_stress = \"axial-in-tension\", weibull_modulus = 4, rate_strengthening = true }}\n\
             [bodies.block]\nfile = \"block.vtp\"\nmaterial = \"cake\"\nbonds = \"cake\"\n\
             [groups.foot]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1e-3] }}\n\
             [groups.head]\nbox = {{ min = [-1, -1, 69e-3], max = [1, 1, 1] }}\n\
             [supports.foot]\ngroup = \"foot\"\nfixed = true\n\
             [loads.head]\ngroup = \"head\"\nforce = [\"3 N\", 0, \"5 N\"]\nramp = \"0.1 ms\"\n\
             [measures.broken]\nquantity = \"broken_bonds\"\n\
             [measures.energy]\nof = \"head\"\nquantity = \"elastic_energy\"\n"
        )
        .unwrap();
        let path = bench.write(&format!("{formulation}.toml"), scene);
        for threads in ["1", "2", "3"] {
            let out = format!("{formulation}-{threads}");
            let said = bench.good(&path, &["--threads", threads, "--output", &out]);
            assert!(!said.contains("broken       0 of"), "{said}");
        }
        for other in ["2", "3"] {
            assert_same(
                &bench.path(&format!("{formulation}-1")),
                &bench.path(&format!("{formulation}-{other}")),
            );
        }
    }
}
