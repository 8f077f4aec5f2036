//! Dumps of LAMMPS become frames, or are refused.

use std::fs;

use dem_io::body::{read_frame, read_particles};

use super::{SCENE, exported, go, near};
use crate::program::{Bench, refused, table};

/// A dump of two frames, in the second of which the bond is broken.
fn write_dumps(bench: &Bench) {
    let mut frames = "ITEM: UNITS\nsi\n".to_owned();
    let (mut bonds, mut broken) = (String::new(), String::new());
    for (n, [time, step]) in [[0.0, 0.0], [0.0010000000000000002, 1000.0]]
        .into_iter()
        .enumerate()
    {
        let head = format!("ITEM: TIME\n{time}\nITEM: TIMESTEP\n{step}\n");
        let bounds = "ITEM: BOX BOUNDS mm mm mm\n-1 1\n-1 1\n-1 1\n";
        frames += &format!("{head}ITEM: NUMBER OF ATOMS\n2\n{bounds}");
        frames += "ITEM: ATOMS id mol radius x y z vx vy vz omegax omegay omegaz \n";
        for id in [1, 2] {
            let x = 0.0091 * f64::from(id - 1);
            let radius = 0.003 + 0.001 * f64::from(id);
            frames += &format!("{id} 1 {radius} {x} {} 0.02 1 2 3 4 5 6 \n", 0.1 * n as f64);
        }
        let whole = 1 - n;
        bonds += &format!("{head}ITEM: NUMBER OF ENTRIES\n{whole}\n{bounds}");
        bonds += "ITEM: ENTRIES index c_bonds[1] c_bonds[2] c_bonds[3] \n";
        if n == 0 {
            bonds += "1 2 1 1 \n";
        }
        broken += &format!("ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ENTRIES\n{n}\n{bounds}");
        broken += "ITEM: ENTRIES f_broken[1] f_broken[2] f_broken[3] f_broken[4] f_broken[5] f_broken[6] \n";
        if n == 1 {
            broken += "950 2 1 0.0045 0.05 0.02 \n";
        }
    }
    bench.write("out/broken.dump", broken);
    bench.write("out/frames.dump", frames);
    bench.write("out/bonds.dump", bonds);
}

#[test]
fn dumps_become_frames_with_a_page_fragments_and_pictures() {
    let bench = Bench::new();
    bench.write("scene.toml", SCENE);
    exported(&bench, "scene.toml");
    write_dumps(&bench);
    let done = go(&bench, &["import", "out", "-o", "back"]);
    let said =
        "2 frames, the last at 0.0010000000000000002 s, 1 broken bond, 2 fragments -> back\n";
    assert_eq!(String::from_utf8_lossy(&done.stdout), said);
    let frame =
        |n: usize| read_particles(&bench.path(&format!("back/frames/frame_{n:06}.vtp"))).unwrap();
    let (first, last) = (frame(0), frame(1));
    assert_eq!([first.time_s, last.time_s], [0.0, 0.0010000000000000002]);
    assert_eq!(last.positions, [[0.0, 0.1, 0.02], [0.0091, 0.1, 0.02]]);
    assert_eq!(last.velocities_m_s[1], [1.0, 2.0, 3.0]);
    assert_eq!(last.radii, [0.004, 0.005]);
    assert_eq!(last.ids, [0, 1]);
    assert_eq!([first.broken, last.broken.clone()], [[false], [true]]);
    assert_eq!(first.fragments.unwrap(), [0, 0]);
    assert_eq!(last.fragments.unwrap(), [1, 2]);
    assert_eq!(last.body_names, ["pair"]);
    let fragments = read_frame(&bench.path("back/frames/frame_000001.vtp")).unwrap();
    near(fragments.densities_kg_m3[0], 2000.0);
    near(fragments.bond_lengths[0], 0.0091);
    near(fragments.bond_radii[0], 0.002);
    check_tables(&bench);
    for words in [
        &["picture", "back", "-o", "last.png"][..],
        &["fragment", "back", "--largest", "-o", "piece.vtp"],
        &["report", "back"],
        &["export", "back", "--to", "lammps-dump", "-o", "again.dump"],
    ] {
        let done = go(&bench, words);
        assert!(done.status.success(), "{words:?}: {done:?}");
    }
    let page = fs::read_to_string(bench.path("back/report.html")).unwrap();
    assert!(page.contains("computed by LAMMPS") && page.contains("id=\"view-data\""));
    for part in [
        "broken bonds",
        "largest fragment",
        "simulated by LAMMPS",
        "Curves",
    ] {
        assert!(page.contains(part), "{part}");
    }
    for part in ["Errors and run time", "0 threads"] {
        assert!(!page.contains(part), "{part}");
    }
}

/// The tables of the run of [`write_dumps`]: the bond broke in step 950, of 1 us.
fn check_tables(bench: &Bench) {
    let text = |name: &str| fs::read_to_string(bench.path(&format!("back/{name}"))).unwrap();
    let events = text("events.csv");
    let rows: Vec<&str> = events.lines().skip(1).collect();
    assert_eq!(
        rows,
        [
            "950,0.00095,bond_broken,0,0,1,0.0045,0.05,0.02,,,pair,,",
            "950,0.00095,split,,,,,,,,,\"fragment 0 -> 1, 2 (1 + 1 particles)\",,",
        ]
    );
    assert_eq!(
        text("fragment-tree.csv"),
        "fragment_id,parent_id,created_s,ended_s,particles\n\
         0,,0,0.00095,2\n1,0,0.00095,,1\n2,0,0.00095,,1\n"
    );
    assert_eq!(
        text("series.csv"),
        "time_s,broken_bonds,intact_bonds,particles,clumps\n\
         0,0,1,2,0\n0.0010000000000000002,1,0,2,0\n"
    );
    let (columns, rows) = table(&bench.path("back/fragments.csv"));
    let cell = |row: usize, name: &str| {
        let at = columns.iter().position(|column| column == name).unwrap();
        rows[row][at].clone()
    };
    let number = |row: usize, name: &str| cell(row, name).parse::<f64>().unwrap();
    assert_eq!(rows.len(), 3);
    let mass = |radius: f64| 2000.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let (a, b) = (mass(0.004), mass(0.005));
    near(number(0, "mass_kg"), a + b);
    near(number(0, "x_m"), 0.0091 * b / (a + b));
    near(number(0, "vy_m_s"), 2.0);
    near(number(2, "mass_kg"), b);
    near(number(2, "y_m"), 0.1);
    near(number(2, "wz_rad_s"), 6.0);
    for (name, wanted) in [
        ("parent_id", "0"),
        ("fx_n", ""),
        ("body", "pair"),
        ("material", "grain"),
    ] {
        assert_eq!(cell(2, name), wanted, "{name}");
    }
    let summary = fs::read_to_string(bench.path("back/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["broken_bonds"], 1);
    assert_eq!(summary["fragments"]["count"], 2);
    assert_eq!(summary["fragments"]["splits"], 1);
    let share = summary["fragments"]["mass_fraction_of_largest"].as_f64();
    near(share.unwrap(), b / (a + b));
    near(
        summary["sizes"]["all"]["both"]["d80_m"].as_f64().unwrap(),
        0.01,
    );
    assert!(summary.get("energy_error").is_none());
    assert!(bench.path("back/distribution.csv").exists());
    for plot in ["broken_bonds", "fragments", "fragment_sizes"] {
        assert!(
            bench.path(&format!("back/plots/{plot}.svg")).exists(),
            "{plot}"
        );
    }
}

/// The dump of broken bonds, with its row in the first section.
fn broken_early(broken: &str, row: &str) -> String {
    let second = broken.rfind("ITEM: TIMESTEP").unwrap();
    let first = broken[..second].replace("ENTRIES\n0\n", "ENTRIES\n1\n");
    let rest = broken[second..]
        .replace("ENTRIES\n1\n", "ENTRIES\n0\n")
        .replace(row, "");
    format!("{first}{}{rest}", row.replace("950", "0"))
}

#[test]
fn damaged_dumps_and_folders_without_are_refused() {
    let bench = Bench::new();
    bench.write("scene.toml", SCENE);
    exported(&bench, "scene.toml");
    let bad = |expected: &str| {
        let (said, code) = refused(&go(&bench, &["import", "out", "-o", "back"]));
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(expected), "{expected}: {said}");
        assert!(!bench.path("back").exists(), "{expected}");
    };
    bad("frames.dump: cannot be read");
    fs::create_dir(bench.path("out/frames.dump")).unwrap();
    bad("frames.dump: this is a folder, not a dump");
    fs::remove_dir(bench.path("out/frames.dump")).unwrap();
    write_dumps(&bench);
    let read = |name: &str| fs::read_to_string(bench.path(name)).unwrap();
    let (whole, bonds) = (read("out/frames.dump"), read("out/bonds.dump"));
    for (old, new, expected) in [
        ("ITEM: UNITS", "UNITS", "is not the head of a section"),
        ("0.0091", "here", "line 15: 'here' is not a finite number"),
        ("0.0091", "nan", "line 15: 'nan' is not a finite number"),
        (
            "0.0091",
            "-1e400",
            "line 15: '-1e400' is not a finite number",
        ),
        (" 4 5 6 \n", " 4 5 \n", "11 numbers for 12 columns"),
        (" x y z", " xs y z", "there is no column 'x'"),
        (
            "\n2 1 0.005",
            "\n7 1 0.005",
            "atom 7 is not in particles.data",
        ),
        (
            "\n2 1 0.005",
            "\n2.5 1 0.005",
            "atom 2.5 is not in particles.data",
        ),
        ("\n2 1 0.005", "\n1 1 0.004", "atom 1 is there twice"),
        (
            "\n2 1 0.005",
            "\n2 3 0.005",
            "atom 2 is of molecule 3, not 1",
        ),
        (
            "\n2 1 0.005",
            "\n2 1 -0.005",
            "atom 2 has a radius of -0.005 m, not 0.005 m",
        ),
        (
            "ATOMS\n2\n",
            "ATOMS\n-2\n",
            "'-2' is not a whole number from 0",
        ),
        (
            "ATOMS\n2\n",
            "ATOMS\n3\n",
            "a section begins after 2 rows of 3",
        ),
        ("ATOMS\n2\n", "ATOMS\n1\n", "atom 2 is missing"),
        ("ITEM: TIME\n0\n", "", "no time"),
        ("STEP\n1000\n", "STEP\n0\n", "step 0: it comes after step 0"),
    ] {
        assert!(whole.contains(old), "{old}");
        bench.write("out/frames.dump", whole.replacen(old, new, 1));
        bad(expected);
    }
    let second = whole.find("ITEM: TIME\n0.001").unwrap();
    bench.write(
        "out/frames.dump",
        format!("{}{}", &whole[second..], &whole[second..]),
    );
    bad("broken.dump: step 0: frames.dump has step 1000 there");
    bench.write("out/frames.dump", &whole);
    for (text, expected) in [
        ("", "bonds.dump: there is no complete frame in it"),
        (
            bonds.replace("1 2 1 1 ", "1 2 9 1 ").as_str(),
            "particles.data has no bond of the atoms 2 and 9",
        ),
        (
            bonds.replace("STEP\n1000\n", "STEP\n500\n").as_str(),
            "step 500: frames.dump has step 1000",
        ),
        (
            &bonds[bonds.find("ITEM: TIME\n0.001").unwrap()..],
            "frames.dump has step 0 there",
        ),
        (
            bonds.replace("c_bonds[2]", "c_bonds[9]").as_str(),
            "bonds.dump: step 0: there is no column 'c_bonds[2]'",
        ),
        (
            bonds
                .replacen("ENTRIES\n1\n", "ENTRIES\n0\n", 1)
                .replace("1 2 1 1 \n", "")
                .as_str(),
            "the bond of the atoms 1 and 2, which particles.data has, is missing, and broken.dump has not that it broke",
        ),
    ] {
        bench.write("out/bonds.dump", text);
        bad(expected);
    }
    bench.write("out/bonds.dump", &bonds);
    let broken = read("out/broken.dump");
    for (old, new, expected) in [
        (
            "f_broken[3]",
            "f_other[3]",
            "there is no column 'f_broken[3]'",
        ),
        (
            "950 2 1",
            "950 2 7",
            "particles.data has no bond of the atoms 2 and 7",
        ),
        (
            "950 2 1",
            "950 2.5 1",
            "particles.data has no bond of the atoms 1 and 2.5",
        ),
        (
            "950 2 1",
            "950 -2 1",
            "particles.data has no bond of the atoms -2 and 1",
        ),
        (
            "950 2 1",
            "0 2 1",
            "the bond of the atoms 2 and 1 broke in step 0",
        ),
        (
            "950 2 1",
            "1001 2 1",
            "the bond of the atoms 2 and 1 broke in step 1001",
        ),
        (
            "950 2 1",
            "949.5 2 1",
            "the bond of the atoms 2 and 1 broke in step 949.5",
        ),
        ("950 2 1", "nan 2 1", "'nan' is not a finite number"),
        ("STEP\n1000", "STEP\n999", "frames.dump has step 1000 there"),
        (
            "ENTRIES\n0\n",
            "ENTRIES\n1\n",
            "a section begins after 0 rows of 1",
        ),
    ] {
        assert!(broken.contains(old), "{old}");
        bench.write("out/broken.dump", broken.replacen(old, new, 1));
        bad(expected);
    }
    let row = "950 2 1 0.0045 0.05 0.02 \n";
    let twice = broken
        .replace("ENTRIES\n1\n", "ENTRIES\n2\n")
        .replace(row, &row.repeat(2));
    bench.write("out/broken.dump", twice);
    bad("the bond of the atoms 2 and 1 breaks twice");
    let never = broken
        .replace("ENTRIES\n1\n", "ENTRIES\n0\n")
        .replace(row, "");
    bench.write("out/broken.dump", never);
    bad(
        "bonds.dump: step 1000: the bond of the atoms 1 and 2, which particles.data has, is missing",
    );
    // The break stands in the first section.
    let early = broken_early(&broken, row);
    bench.write("out/broken.dump", early);
    bad(
        "bonds.dump: step 0: the bond of the atoms 1 and 2 is there, and broken.dump has it broken",
    );
    fs::remove_file(bench.path("out/broken.dump")).unwrap();
    bad("broken.dump: cannot be read");
    bench.write("out/broken.dump", &broken);
    // A run that goes on, or was stopped: the frames before are there, and it is said.
    let (row, bond, end) = (
        whole.rfind("2 1 0.005").unwrap(),
        bonds.rfind("ITEM: NUMBER").unwrap(),
        broken.rfind("950").unwrap(),
    );
    for (frames, bonds, broken) in [
        (&whole[..row], &bonds[..], &broken[..]),
        (&whole[..row + 4], &bonds[..], &broken[..]),
        (&whole[..], &bonds[..bond + 8], &broken[..]),
        (&whole[..], &bonds[..], &broken[..end]),
        (&whole[..], &bonds[..], &broken[..end + 8]),
    ] {
        bench.write("out/frames.dump", frames);
        bench.write("out/bonds.dump", bonds);
        bench.write("out/broken.dump", broken);
        let done = go(&bench, &["import", "out", "-o", "back", "--force"]);
        let said = String::from_utf8_lossy(&done.stdout).into_owned();
        assert_eq!(
            said,
            "1 frame, the last at 0 s, 0 broken bonds, 1 fragment -> back\n"
        );
        let warned = String::from_utf8_lossy(&done.stderr).into_owned();
        assert!(
            warned.contains("the frames end at 0 s, the run of the scene at"),
            "{warned}"
        );
        let page = read("back/report.html");
        assert!(
            page.contains("LAMMPS has stopped before, or goes on") && !page.contains("seed null")
        );
    }
    fs::remove_dir_all(bench.path("back")).unwrap();
    fs::remove_file(bench.path("out/export.json")).unwrap();
    bad("export.json: this file is missing");
}
