//! A frame read back: its fragments, and each of them as a body that can be written to files.

use std::fs;
use std::path::{Path, PathBuf};

use dem_io::body::{BondColumn, StoredFrame, read_frame};
use dem_io::body::{read_body, write_body};
use dem_io::hash::fnv1a_of_parts;
use dem_results::{Frame, NamedArray, Values, write_frame};
use proptest::prelude::*;
use tempfile::{TempDir, tempdir};

/// Two fragments of one body, and a third body. Bond 1 is broken; bond 3 names its larger end
/// first.
fn stored() -> StoredFrame {
    StoredFrame {
        time_s: 0.25,
        positions: (0..6).map(|i| [2e-3 * f64::from(i), 1e-5, 0.0]).collect(),
        radii: vec![1e-3, 1.1e-3, 1e-3, 1.2e-3, 1e-3, 1e-3],
        // As computed by a program from masses.
        densities_kg_m3: vec![
            2050.0,
            2050.0000000000002,
            2049.9999999999998,
            2050.0,
            1000.0,
            3000.0,
        ],
        turns_rad: Some((0..6).map(|i| [0.01 * f64::from(i), 0.0, -0.02]).collect()),
        clusters: vec![7, 7, 3, 3, 5, 5],
        rigid: Vec::new(),
        bonds: vec![[0, 1], [1, 2], [4, 5], [3, 2]],
        bond_radii: vec![1e-4, 2e-4, 3e-4, 4e-4],
        bond_lengths: vec![1.9e-3, 2e-3, 2e-3, 2.1e-3],
        bond_directions: vec![
            [1.0, 0.0, 0.0],
            [0.6, 0.8, 0.0],
            [0.0, 1.0, 0.0],
            [0.8, 0.0, -0.6],
        ],
        histories: Vec::new(),
        broken: vec![false, true, false, false],
        damages: Vec::new(),
    }
}

/// Writes a frame like a run, without the array named `without`.
fn written(frame: &StoredFrame, without: &str) -> (TempDir, PathBuf) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("frame.vtp");
    let broken = |bond: usize| u32::from(frame.broken[bond]);
    let array = |name, values| NamedArray { name, values };
    let velocity = |i: usize| [i as f64; 3];
    let radius = |i: usize| frame.radii[i];
    let cluster = |i: usize| frame.clusters[i];
    let density = |i: usize| frame.densities_kg_m3[i];
    let turn = |i: usize| frame.turns_rad.as_ref().unwrap()[i];
    let bond_radius = |bond: usize| frame.bond_radii[bond];
    let bond_length = |bond: usize| frame.bond_lengths[bond];
    let damage = |bond: usize| frame.damages[bond];
    let mut of_particles = vec![
        array("radius_m", Values::Scalars(&radius)),
        array("velocity_m_s", Values::Vectors(&velocity)),
        array("fragment_id", Values::Counts(&cluster)),
        array("density_kg_m3", Values::Scalars(&density)),
    ];
    let mut of_bonds = vec![
        array("bond_radius_m", Values::Scalars(&bond_radius)),
        array("initial_length_m", Values::Scalars(&bond_length)),
        array("broken", Values::Counts(&broken)),
    ];
    if !frame.damages.is_empty() {
        of_bonds.push(array("damage", Values::Scalars(&damage)));
    }
    if frame.turns_rad.is_some() {
        of_particles.push(array("rotation_rad", Values::Vectors(&turn)));
    }
    let direction = |bond: usize| frame.bond_directions[bond];
    if !frame.bond_directions.is_empty() {
        of_bonds.push(array("initial_direction", Values::Vectors(&direction)));
    }
    of_bonds.extend(frame.histories.iter().map(BondColumn::array));
    of_particles.retain(|array| array.name != without);
    of_bonds.retain(|array| array.name != without);
    let mut bytes = Vec::new();
    let frame = Frame {
        time_s: frame.time_s,
        body_names: &["a\"b", "K\u{f6}rper"],
        particles: frame.positions.len(),
        position_m: &|i| frame.positions[i],
        particle_arrays: &of_particles,
        bonds: frame.bonds.len(),
        ends: &|bond| frame.bonds[bond],
        bond_arrays: &of_bonds,
    };
    write_frame(&frame, &mut bytes).unwrap();
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

#[test]
fn a_frame_reads_back_bit_by_bit() {
    let (_folder, path) = written(&stored(), "");
    assert_eq!(read_frame(&path).unwrap(), stored());
}

#[test]
fn fragments_come_the_heaviest_first() {
    let fragments = stored().fragments();
    let ids: Vec<u32> = fragments.iter().map(|fragment| fragment.id).collect();
    // 3 has the largest sphere; 5 is 4000 kg/m3 times one sphere of 1 mm, which is the smallest
    // mass.
    assert_eq!(ids, [3, 7, 5]);
    let volume = |r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
    let mass = 2050.0 * (volume(1e-3) + volume(1.2e-3));
    assert!((fragments[0].mass_kg / mass - 1.0).abs() < 1e-14);
    assert!(fragments.iter().all(|fragment| fragment.particles == 2));
    // Of two with equal mass, the one with the smaller number.
    let mut equal = stored();
    equal.radii = vec![1e-3; 6];
    equal.densities_kg_m3 = vec![1000.0; 6];
    let ids: Vec<u32> = equal.fragments().iter().map(|f| f.id).collect();
    assert_eq!(ids, [3, 5, 7]);
}

#[test]
fn a_fragment_is_a_body_with_its_bonds_and_their_lengths() {
    let body = stored().body(3).unwrap();
    assert_eq!(body.turns_rad, [[0.02, 0.0, -0.02], [0.03, 0.0, -0.02]]);
    assert_eq!(body.bond_directions, [[0.8, 0.0, -0.6]]);
    assert_eq!(body.positions, stored().positions[2..4]);
    assert_eq!(body.radii, [1e-3, 1.2e-3]);
    assert_eq!(body.bonds, [[0, 1]]);
    assert_eq!(body.bond_radii, [4e-4]);
    // Not the distance of its ends, 2 mm: it is compressed.
    assert_eq!(body.bond_lengths, [2.1e-3]);
    assert_eq!(body.about.particle_density_kg_m3, Some(2050.0));
    // Two materials have no common density.
    assert_eq!(stored().body(5).unwrap().about.particle_density_kg_m3, None);
    let folder = tempdir().unwrap();
    let sheared = write_body(&body, &folder.path().join("body.csv")).unwrap_err();
    assert!(sheared.problem.contains("bent, twisted or sheared"));
    let path = folder.path().join("body.vtp");
    write_body(&body, &path).unwrap();
    assert_eq!(read_body(&path).unwrap(), body);
    // At rest.
    let body = dem_io::Body {
        turns_rad: Vec::new(),
        bond_directions: Vec::new(),
        bond_lengths: vec![2e-3],
        ..body
    };
    for name in ["body.vtp", "body.csv", "body.data", "body.txt"] {
        let path = folder.path().join(name);
        write_body(&body, &path).unwrap();
        let read = read_body(&path).unwrap();
        assert_eq!(read.positions, body.positions, "{name}");
        assert_eq!(read.radii, body.radii, "{name}");
        assert_eq!(read.bonds, body.bonds, "{name}");
        if ["body.vtp", "body.csv"].contains(&name) {
            assert_eq!(read.bond_lengths, body.bond_lengths, "{name}");
            assert_eq!(read.bond_radii, body.bond_radii, "{name}");
        }
    }
}

/// A column of these numbers of the first bond times the amount of each bond.
fn column(name: &str, one: &[f64], amounts: &[f64]) -> BondColumn {
    let of_bond = |much: &f64| {
        one.iter()
            .map(|number| number * *much)
            .collect::<Vec<f64>>()
    };
    BondColumn::new(name, one.len(), amounts.iter().flat_map(of_bond).collect())
}

/// Bonds that have yielded in every way, by these amounts.
fn plastics(amounts: &[f64]) -> Vec<BondColumn> {
    [
        ("plastic_turn_a_rad", &[0.0, 0.01, 0.0][..]),
        ("plastic_turn_b_rad", &[0.02, 0.0, 0.0]),
        ("plastic_elongation_m", &[1e-5]),
        ("plastic_slip_m", &[0.0, 2e-5, -3e-5]),
        ("plastic_twist_rad", &[-0.1]),
        ("plastic_bend_rad", &[0.0, 0.2, 0.3]),
        ("plastic_work_j", &[1.0]),
    ]
    .map(|(name, one)| column(name, one, amounts))
    .to_vec()
}

/// Loads that were summed, of these amounts.
fn sums(amounts: &[f64]) -> Vec<BondColumn> {
    vec![
        column("summed_shear_n", &[1.0, 0.0, -1.0], amounts),
        column("summed_moment_n_m", &[0.0, 0.1, 0.0], amounts),
    ]
}

/// Flat joints of three elements each, of which these have failed, 1, and slid.
fn joints(failed: &[[f64; 3]]) -> Vec<BondColumn> {
    let slips = failed.as_flattened().iter();
    let slips = slips.flat_map(|failed| [0.0, 0.0, 1e-6 * failed]);
    let edge = [0.0, 0.6, 0.8];
    vec![
        column("first_element_edge", &edge, &vec![1.0; failed.len()]),
        BondColumn::new("failed_elements", 3, failed.as_flattened().to_vec()),
        BondColumn::new("element_slip_m", 9, slips.collect()),
    ]
}

#[test]
fn plastic_deformation_goes_with_the_bonds() {
    let yielded = StoredFrame {
        histories: plastics(&[0.0, 1.0, 0.0, 2.0]),
        ..stored()
    };
    let (folder, path) = written(&yielded, "");
    let frame = read_frame(&path).unwrap();
    assert_eq!(frame, yielded);
    // Where no bond has yielded, nothing is said of it: the one that has is broken.
    assert_eq!(frame.body(7).unwrap(), stored().body(7).unwrap());
    let body = frame.body(3).unwrap();
    assert_eq!(body.bond_histories, plastics(&[2.0]));
    assert_ne!(body.hash(), stored().body(3).unwrap().hash());
    let file = folder.path().join("body.vtp");
    write_body(&body, &file).unwrap();
    assert_eq!(read_body(&file).unwrap(), body);
    let mut longer = body;
    longer.bond_histories[2].values[0] = 2.1e-3;
    let error = longer.check().unwrap_err().to_string();
    assert!(
        error.starts_with("bond 0: its plastic elongation is not less than its length"),
        "{error}"
    );
}

#[test]
fn summed_loads_go_with_the_bonds() {
    let summed = StoredFrame {
        histories: sums(&[0.0, 1.0, 2.0, 3.0]),
        ..stored()
    };
    let (folder, path) = written(&summed, "");
    let frame = read_frame(&path).unwrap();
    assert_eq!(frame, summed);
    let body = frame.body(3).unwrap();
    assert_eq!(body.bond_histories, sums(&[3.0]));
    assert_ne!(body.hash(), stored().body(3).unwrap().hash());
    let file = folder.path().join("body.vtp");
    write_body(&body, &file).unwrap();
    assert_eq!(read_body(&file).unwrap(), body);
}

/// The columns of a law that is not known here go with the bonds as well.
#[test]
fn any_history_goes_with_the_bonds() {
    let histories = |amounts: &[f64]| {
        vec![
            column("history_strain", &[0.25], amounts),
            column(
                "history_stress_pa",
                &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
                amounts,
            ),
        ]
    };
    let strained = StoredFrame {
        histories: histories(&[0.0, 1.0, 0.0, 2.0]),
        ..stored()
    };
    let (folder, path) = written(&strained, "");
    let frame = read_frame(&path).unwrap();
    assert_eq!(frame, strained);
    assert_eq!(frame.body(7).unwrap(), stored().body(7).unwrap());
    let body = frame.body(3).unwrap();
    assert_eq!(body.bond_histories, histories(&[2.0]));
    let mut other = body.clone();
    other.bond_histories[0].values[0] = 0.75;
    assert_ne!(body.hash(), other.hash());
    assert_ne!(body.hash(), stored().body(3).unwrap().hash());
    let file = folder.path().join("body.vtp");
    write_body(&body, &file).unwrap();
    assert_eq!(read_body(&file).unwrap(), body);
    other.bond_histories[1].values[5] = f64::NAN;
    let error = other.check().unwrap_err().to_string();
    assert!(
        error.starts_with("bond 0: its 'history_stress_pa' is not finite"),
        "{error}"
    );
    other.bond_histories[1].values.pop();
    let error = other.check().unwrap_err().to_string();
    assert!(
        error.starts_with("5 values of 'history_stress_pa' for 1 bonds"),
        "{error}"
    );
    other.bond_histories[1].name = "stress_pa".to_owned();
    let error = other.check().unwrap_err().to_string();
    assert!(
        error.starts_with("bonds have a history 'stress_pa', which no file can hold"),
        "{error}"
    );
}

/// Hashes of bodies with a history, and the bytes of their files and frames, which earlier versions
/// wrote.
#[test]
fn hashes_and_files_of_histories_stay() {
    let hash_of_file = |path: &Path| fnv1a_of_parts(&[&fs::read(path).unwrap()]);
    for (histories, wanted) in [
        (
            sums(&[0.0, 1.0, 2.0, 3.0]),
            [0x91f06e98516d38bc, 0x8761712f0040f0b2, 0xc59f96c1f3443de0],
        ),
        (
            plastics(&[0.0, 1.0, 0.0, 2.0]),
            [0x550dd9fb5787f11d, 0xe1a26022b10bc008, 0x1817d1629bbbe665],
        ),
        (
            joints(&[[0.0; 3], [1.0; 3], [0.0; 3], [1.0, 0.0, 1.0]]),
            [0x6e75dbc10c3ebf5e, 0xb44e0ad81fa7c95a, 0x0d437dd9f7bbb6a0],
        ),
    ] {
        let frame = StoredFrame {
            histories,
            ..stored()
        };
        let (folder, path) = written(&frame, "");
        let body = read_frame(&path).unwrap().body(3).unwrap();
        let file = folder.path().join("body.vtp");
        write_body(&body, &file).unwrap();
        let found = [body.hash(), hash_of_file(&path), hash_of_file(&file)];
        assert_eq!(found, wanted);
    }
}

#[test]
fn failed_elements_go_with_the_bonds() {
    let cracked = StoredFrame {
        histories: joints(&[[0.0; 3], [1.0; 3], [0.0; 3], [1.0, 0.0, 1.0]]),
        ..stored()
    };
    let (folder, path) = written(&cracked, "");
    let frame = read_frame(&path).unwrap();
    assert_eq!(frame, cracked);
    assert_eq!(frame.body(7).unwrap(), stored().body(7).unwrap());
    let body = frame.body(3).unwrap();
    assert_eq!(body.bond_histories, joints(&[[1.0, 0.0, 1.0]]));
    assert_ne!(body.hash(), stored().body(3).unwrap().hash());
    let file = folder.path().join("body.vtp");
    write_body(&body, &file).unwrap();
    assert_eq!(read_body(&file).unwrap(), body);
    let mut bad = body.clone();
    bad.bond_histories = joints(&[[1.0; 3]]);
    let error = bad.check().unwrap_err().to_string();
    assert!(
        error.starts_with("bond 0: all of its elements have failed"),
        "{error}"
    );
    bad.bond_histories = joints(&[[1.0, 0.0, 0.0]]);
    bad.bond_histories[0].values = vec![0.0; 3];
    let error = bad.check().unwrap_err().to_string();
    assert!(
        error.starts_with("bond 0: the edge of its first element is no unit vector"),
        "{error}"
    );
}

#[test]
fn damage_goes_with_the_bonds() {
    let damaged = StoredFrame {
        damages: vec![0.0, 1.0, 0.0, 0.75],
        ..stored()
    };
    let (folder, path) = written(&damaged, "");
    let frame = read_frame(&path).unwrap();
    assert_eq!(frame, damaged);
    // Where no bond is damaged, nothing is said of damage.
    assert!(frame.body(7).unwrap().bond_damages.is_empty());
    let body = frame.body(3).unwrap();
    assert_eq!(body.bond_damages, [0.75]);
    let intact = stored().body(3).unwrap();
    assert_ne!(body.hash(), intact.hash());
    let file = folder.path().join("body.vtp");
    write_body(&body, &file).unwrap();
    assert_eq!(read_body(&file).unwrap().bond_damages, [0.75]);
    for name in ["body.csv", "body.data", "body.txt"] {
        let error = write_body(&body, &folder.path().join(name)).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let text = error.to_string();
        assert!(
            text.ends_with("damage or a history, which such a file does not hold; write a .vtp"),
            "{text}"
        );
    }
}

#[test]
fn a_bond_within_a_fragment_that_is_broken_stays_away() {
    let mut frame = stored();
    // Broken, and not yet searched for fragments.
    frame.clusters = vec![0; 6];
    let body = frame.body(0).unwrap();
    assert_eq!(body.bonds, [[0, 1], [4, 5], [2, 3]]);
    assert_eq!(body.bond_lengths, [1.9e-3, 2e-3, 2.1e-3]);
}

#[test]
fn an_unknown_fragment_is_told_with_the_heaviest() {
    let error = stored().body(4).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert_eq!(
        error.to_string(),
        "there is no fragment 4 at 0.25 s among the 3 that there are; \
         the heaviest are 3 (2 particles), 7 (2 particles), 5 (2 particles)"
    );
    let mut dust = stored();
    dust.clusters = vec![10, 11, 12, 13, 14, 15];
    let error = dust.body(4).unwrap_err();
    assert_eq!(error.remedy.matches("(1 particle)").count(), 5, "{error}");
}

#[test]
fn frames_without_fragments_and_other_files_are_refused() {
    for name in [
        "radius_m",
        "density_kg_m3",
        "bond_radius_m",
        "initial_length_m",
        "broken",
    ] {
        let (_folder, path) = written(&stored(), name);
        let error = read_frame(&path).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let said = format!("no body can be made from this frame: there is no array '{name}'");
        assert_eq!(error.problem, said);
        assert_eq!(error.place, path.display().to_string());
    }
    // Without fragments, what bonds join is one: bond 1, between 1 and 2, is broken.
    let (_folder, path) = written(&stored(), "fragment_id");
    assert_eq!(read_frame(&path).unwrap().clusters, [0, 0, 1, 1, 2, 2]);
    // Without the form of the bonds, no body with bonds.
    for name in ["rotation_rad", "initial_direction"] {
        let mut frame = stored();
        match name {
            "rotation_rad" => frame.turns_rad = None,
            _ => frame.bond_directions.clear(),
        }
        let (_folder, path) = written(&frame, "");
        let said = read_frame(&path).unwrap().body(3).unwrap_err();
        assert!(
            said.problem
                .contains("how the bonds of fragment 3 are bent"),
            "{said}"
        );
    }
    let mut frame = stored();
    frame.bonds[1] = [1, 6];
    let (_folder, path) = written(&frame, "");
    let error = read_frame(&path).unwrap_err();
    assert_eq!(error.problem, "a bond joins particle 6, but there are 6");
    let error = read_frame(&path.with_file_name("none.vtp")).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert_eq!(error.problem, "there is no such file");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    /// The particles, the mass and the unbroken bonds are divided completely among the fragments.
    #[test]
    fn bodies_of_all_fragments_make_up_the_frame(
        clusters in prop::collection::vec(0_u32..6, 1..40),
        pairs in prop::collection::btree_set((0_u32..40, 0_u32..40), 0..80),
        whole in prop::collection::vec(any::<bool>(), 80),
    ) {
        let count = clusters.len() as u32;
        let bonds: Vec<[u32; 2]> = pairs
            .into_iter()
            .filter(|(a, b)| a < b && *b < count)
            .filter(|(a, b)| clusters[*a as usize] == clusters[*b as usize])
            .map(|(a, b)| [a, b])
            .collect();
        let frame = StoredFrame {
            time_s: 0.0,
            positions: (0..count).map(|i| [f64::from(i), 0.5, -1.0]).collect(),
            turns_rad: Some(vec![[0.0; 3]; clusters.len()]),
            bond_directions: vec![[1.0, 0.0, 0.0]; bonds.len()],
            rigid: Vec::new(),
            histories: Vec::new(),
            radii: (0..count).map(|i| 0.1 + 0.01 * f64::from(i)).collect(),
            densities_kg_m3: vec![1000.0; clusters.len()],
            bond_radii: (0..bonds.len()).map(|bond| 0.1 + 0.001 * bond as f64).collect(),
            bond_lengths: (0..bonds.len()).map(|bond| 1.0 + 0.001 * bond as f64).collect(),
            broken: (0..bonds.len()).map(|bond| !whole[bond]).collect(),
            damages: Vec::new(),
            bonds,
            clusters,
        };
        let fragments = frame.fragments();
        let bodies: Vec<_> = fragments.iter().map(|f| frame.body(f.id).unwrap()).collect();
        let mut places: Vec<[f64; 3]> = bodies.iter().flat_map(|b| b.positions.clone()).collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        prop_assert_eq!(&places, &frame.positions);
        // For each bond, the positions of its ends, its radius and its length.
        let mut found: Vec<[f64; 4]> = Vec::new();
        for body in &bodies {
            for (at, ends) in body.bonds.iter().enumerate() {
                let [a, b] = ends.map(|end| body.positions[end as usize][0]);
                found.push([a, b, body.bond_radii[at], body.bond_lengths[at]]);
            }
        }
        let mut wanted: Vec<[f64; 4]> = (0..frame.bonds.len())
            .filter(|&bond| !frame.broken[bond])
            .map(|bond| {
                let [a, b] = frame.bonds[bond].map(f64::from);
                [a, b, frame.bond_radii[bond], frame.bond_lengths[bond]]
            })
            .collect();
        for list in [&mut found, &mut wanted] {
            list.sort_by(|a, b| a[3].total_cmp(&b[3]));
        }
        prop_assert_eq!(found, wanted);
        let (_folder, path) = written(&frame, "");
        prop_assert_eq!(read_frame(&path).unwrap(), frame);
    }
}

#[test]
fn a_frame_is_no_body() {
    let (_folder, path) = written(&stored(), "");
    let said = read_body(&path).unwrap_err().to_string();
    assert!(said.contains("this is a frame of a run"), "{said}");
    assert!(said.contains("dem-run fragment"), "{said}");
}
