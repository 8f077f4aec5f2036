//! All fragments of a frame at once, and all frames as one file for other programs.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use dem_io::body::{read_frame, read_particles, read_walls};
use dem_io::surface::{ReadSettings, read_surface};
use dem_io::units::significant;
use dem_results::folder::walls_in;
use nalgebra::Vector3;

use super::burst::burst;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dem-run"));
    command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

fn good(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

fn bad(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8(output.stderr).unwrap()
}

/// Corners of the triangles of a binary STL, in its unit.
fn facets(path: &Path) -> Vec<[Vector3<f64>; 3]> {
    let bytes = fs::read(path).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
    let corner = |at: usize| Vector3::new(number(at), number(at + 4), number(at + 8));
    let facet = |n: usize| [12, 24, 36].map(|at| corner(84 + 50 * n + at));
    (0..count).map(facet).collect()
}

#[test]
fn hulls_hold_the_spheres_within_the_stated_share() {
    let (parent, folder, _) = burst();
    let here = parent.path();
    let said = good(here, &["fragment", "out", "--all", "--stl", "-o", "hulls"]);
    assert!(
        said.contains("-> hulls: convex hulls, in mm") && said.contains("0.02"),
        "{said}"
    );
    let frame = read_frame(&folder.frame(5)).unwrap();
    let fragments = frame.fragments();
    assert!(fragments.len() > 5);
    assert_eq!(
        fs::read_dir(here.join("hulls")).unwrap().count(),
        fragments.len()
    );
    for fragment in &fragments {
        let path = here.join(format!("hulls/fragment_{:06}.stl", fragment.id));
        let spheres: Vec<(Vector3<f64>, f64)> = (0..frame.clusters.len())
            .filter(|i| frame.clusters[*i] == fragment.id)
            .map(|i| {
                (
                    1e3 * Vector3::from(frame.positions[i]),
                    1e3 * frame.radii[i],
                )
            })
            .collect();
        // Single precision, at some hundred millimetres.
        let rounding_mm = 1e-4;
        for [a, b, c] in facets(&path) {
            let across = (b - a).cross(&(c - a));
            if across.norm() < 1e-3 {
                // Too small to have a direction.
                continue;
            }
            let normal = across.normalize();
            let offset = normal.dot(&a);
            let reach = |shrunk: f64| {
                let ends = spheres
                    .iter()
                    .map(|(place, r)| place.dot(&normal) + shrunk * r);
                ends.fold(f64::NEG_INFINITY, f64::max)
            };
            assert!(
                reach(0.98) <= offset + rounding_mm,
                "{} < {}",
                offset,
                reach(0.98)
            );
            assert!(
                reach(1.0) >= offset - rounding_mm,
                "{} > {}",
                offset,
                reach(1.0)
            );
        }
        // It is a closed solid, wound outwards, that dem-pack reads without a repair.
        let bytes = fs::read(&path).unwrap();
        let settings = ReadSettings {
            unit_m: Some(1e-3),
            scale: 1.0,
            fill_holes: false,
        };
        let surface = read_surface(&bytes, "hull.stl", settings).unwrap();
        let volume_m3 = 1e-9 * volume(&facets(&path));
        assert!((surface.volume_m3() / volume_m3 - 1.0).abs() < 1e-3);
        let of_largest = spheres.iter().map(|(_, r)| 4.1 * (1e-3 * r).powi(3));
        assert!(
            volume_m3 > 0.9 * of_largest.fold(0.0, f64::max),
            "{volume_m3}"
        );
    }
}

/// Of a closed surface whose triangles are counterclockwise as seen from outside.
fn volume(facets: &[[Vector3<f64>; 3]]) -> f64 {
    let origin = facets[0][0];
    let of =
        |[a, b, c]: &[Vector3<f64>; 3]| (a - origin).dot(&(b - origin).cross(&(c - origin))) / 6.0;
    facets.iter().map(of).sum()
}

#[test]
fn all_bodies_are_those_written_one_by_one() {
    let (parent, folder, _) = burst();
    let here = parent.path();
    let said = good(
        here,
        &["fragment", "out", "--all", "--frame", "3", "-o", "pieces"],
    );
    assert!(said.contains("-> pieces: bodies"), "{said}");
    let frame = read_frame(&folder.frame(3)).unwrap();
    for fragment in frame.fragments() {
        let id = fragment.id.to_string();
        good(
            here,
            &[
                "fragment", "out", "--frame", "3", "--id", &id, "-o", "one.vtp",
            ],
        );
        let of_all = fs::read(here.join(format!("pieces/fragment_{:06}.vtp", fragment.id)));
        assert!(
            of_all.unwrap() == fs::read(here.join("one.vtp")).unwrap(),
            "{id}"
        );
    }
}

#[test]
fn the_current_folder_is_filled() {
    let (parent, _, _) = burst();
    let here = parent.path().join("here");
    fs::create_dir(&here).unwrap();
    good(&here, &["fragment", "../out", "--all", "--stl", "-o", "."]);
    let out = parent.path().join("there");
    good(
        &here,
        &["fragment", "../out", "--all", "--stl", "-o", "../there"],
    );
    let count = |folder: &Path| fs::read_dir(folder).unwrap().count();
    assert!(count(&here) > 1 && count(&here) == count(&out));
}

#[test]
fn nothing_is_written_where_something_is() {
    let (parent, _, _) = burst();
    let here = parent.path();
    fs::create_dir(here.join("full")).unwrap();
    fs::write(here.join("full/mine.stl"), "mine").unwrap();
    let before = fs::read_dir(here.join("out")).unwrap().count();
    let said = bad(
        here,
        &["fragment", "out", "--all", "-o", "full/mine.stl/new"],
    );
    assert!(said.contains("a part of this path is a file"), "{said}");
    for (output, problem) in [
        ("full", "this folder is not empty"),
        ("full/mine.stl", "this is not a folder"),
        ("out", "this folder is not empty"),
        ("out/frames", "this folder is not empty"),
    ] {
        let said = bad(here, &["fragment", "out", "--all", "--stl", "-o", output]);
        assert!(said.contains(problem), "{said}");
    }
    let said = bad(here, &["fragment", "out", "--all"]);
    assert!(said.contains("add --output FOLDER"), "{said}");
    assert!(bad(here, &["fragment", "out", "--all", "--id", "1", "-o", "x"]).contains("--all"));
    assert_eq!(fs::read_dir(here.join("out")).unwrap().count(), before);
    assert_eq!(fs::read_dir(here.join("full")).unwrap().count(), 1);
}

/// A section of a dump: time, timestep, columns and rows.
type Section = (f64, usize, Vec<String>, Vec<Vec<String>>);

fn sections(path: &Path) -> Vec<Section> {
    let text = fs::read_to_string(path).unwrap();
    let text = text.strip_prefix("ITEM: UNITS\nsi\n").unwrap();
    let mut lines = text.lines();
    let mut sections = Vec::new();
    while let Some(first) = lines.next() {
        assert_eq!(first, "ITEM: TIME");
        let time_s = lines.next().unwrap().parse().unwrap();
        assert_eq!(lines.next(), Some("ITEM: TIMESTEP"));
        let step = lines.next().unwrap().parse().unwrap();
        assert!(lines.next().unwrap().starts_with("ITEM: NUMBER OF "));
        let count: usize = lines.next().unwrap().parse().unwrap();
        assert_eq!(lines.next(), Some("ITEM: BOX BOUNDS ff ff ff"));
        lines.by_ref().take(3).for_each(drop);
        let columns = lines
            .next()
            .unwrap()
            .split(' ')
            .skip(2)
            .map(str::to_owned)
            .collect();
        let row = |line: &str| line.split(' ').map(str::to_owned).collect();
        let rows = lines.by_ref().take(count).map(row).collect();
        sections.push((time_s, step, columns, rows));
    }
    sections
}

#[test]
fn a_dump_has_every_particle_and_bond_of_every_frame() {
    let (parent, folder, _) = burst();
    let here = parent.path();
    let options = [
        "--to",
        "lammps-dump",
        "-o",
        "frames.dump",
        "--bonds",
        "bonds.dump",
    ];
    let said = good(here, &[&["export", "out"], &options[..]].concat());
    assert!(said.contains("frames -> frames.dump, bonds.dump"), "{said}");
    let number = |word: &String| word.parse::<f64>().unwrap();
    let particles = sections(&here.join("frames.dump"));
    let bonds = sections(&here.join("bonds.dump"));
    assert_eq!(particles.len(), bonds.len());
    assert!(particles.len() > 5);
    let mut broken = 0;
    let mut thinnest_m = f64::INFINITY;
    for (at, (time_s, step, columns, rows)) in particles.iter().enumerate() {
        let frame = read_particles(&folder.frame(at)).unwrap();
        assert_eq!(
            columns.join(" "),
            "id type element radius x y z vx vy vz body fragment_id"
        );
        assert_eq!((*time_s, *step), (frame.time_s, at));
        assert_eq!(rows.len(), frame.positions.len());
        let mut place_of: BTreeMap<u64, [f64; 3]> = BTreeMap::new();
        for (i, row) in rows.iter().enumerate() {
            let [x, y, z] = frame.positions[i];
            let [u, v, w] = frame.velocities_m_s[i];
            let body = f64::from(frame.bodies[i]);
            let id = f64::from(frame.ids[i] + 1);
            let fragment = f64::from(frame.fragments.as_ref().unwrap()[i]);
            let wanted = [
                id,
                body + 1.0,
                frame.radii[i],
                x,
                y,
                z,
                u,
                v,
                w,
                body,
                fragment,
            ];
            let mut numbers = row.clone();
            let name = numbers.remove(2);
            assert_eq!(name, frame.body_names[frame.bodies[i] as usize]);
            assert_eq!(numbers.iter().map(number).collect::<Vec<f64>>(), wanted);
            place_of.insert(u64::from(frame.ids[i] + 1), [x, y, z]);
        }
        assert_eq!(place_of.len(), rows.len(), "an id occurs twice");
        let (bond_time_s, _, columns, rows) = &bonds[at];
        assert_eq!(bond_time_s, time_s);
        assert_eq!(columns.join(" "), "index btype batom1 batom2 width_m");
        let unbroken: Vec<usize> = (0..frame.broken.len())
            .filter(|&bond| !frame.broken[bond])
            .collect();
        assert_eq!(rows.len(), unbroken.len());
        broken = frame.broken.len() - unbroken.len();
        for (row, &bond) in rows.iter().zip(&unbroken) {
            assert_eq!(number(&row[4]), 2.0 * frame.bond_radii[bond]);
            thinnest_m = thinnest_m.min(number(&row[4]));
            let [a, b] = [2, 3].map(|k| Vector3::from(place_of[&row[k].parse().unwrap()]));
            assert!(
                (a - b).norm() < 4e-3,
                "bonded particles are near each other"
            );
        }
    }
    assert!(broken > 5);
    let width = significant(thinnest_m, 2);
    assert!(
        said.contains(&format!("or set the width of bonds to {width} (m)")),
        "{said}"
    );
    let body_names = read_particles(&folder.frame(0)).unwrap().body_names;
    assert!(body_names.is_sorted() && body_names.len() == 2);
    for (arguments, problem) in [
        (
            [
                "export",
                "out",
                "--to",
                "lammps-dump",
                "-o",
                "out/series.csv",
            ],
            "one of the results",
        ),
        (
            ["export", "none", "--to", "lammps-dump", "-o", "x.dump"],
            "no such folder",
        ),
        (
            ["export", "out", "--to", "vtk", "-o", "x.dump"],
            "lammps-dump",
        ),
    ] {
        assert!(bad(here, &arguments).contains(problem));
    }
    fs::write(folder.frame(2), "damaged").unwrap();
    let said = bad(
        here,
        &["export", "out", "--to", "lammps-dump", "-o", "x.dump"],
    );
    assert!(
        said.contains("frame_000002.vtp") && !here.join("x.dump").exists(),
        "{said}"
    );
}

/// A ball above a floor, and a lid that moves if asked for: two frames.
const BOXED: &str = r#"version = 1
run = { end_time = "1 ms" }
materials.stone = { density = 2600, young_modulus = "1 GPa" }
contacts.stone-stone = { law = "hertz-mindlin", restitution = 0.5, friction = 0.3 }
bodies.ball = { particles = [[0, 0, 0.02, 0.01]], material = "stone" }
walls.floor = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = "stone" }
walls.lid = { box = { min = [-0.02, -0.02, 0.045], max = [0.02, 0.02, 0.055] }, material = "stone" }
output = { frames = "0.5 ms" }
"#;

#[test]
fn walls_are_those_of_the_frames() {
    let parent = tempfile::tempdir().unwrap();
    let here = parent.path();
    fs::write(here.join("scene.toml"), BOXED).unwrap();
    let export = |results: &str, walls: &str| {
        let fixed = ["--to", "lammps-dump", "-o", "frames.dump", "--walls"];
        good(here, &[&["export", results][..], &fixed, &[walls]].concat())
    };
    let names = |folder: &str| {
        let entries = fs::read_dir(here.join(folder)).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
        names.sort();
        names
    };
    good(here, &["scene.toml", "--output", "still", "-q"]);
    assert!(export("still", "fixed").contains("3 frames -> frames.dump, fixed"));
    assert_eq!(names("fixed"), ["walls_000000.stl"]);
    let moving = ["--set", "walls.lid.velocity=[0, 0, -1]"];
    good(
        here,
        &[&["scene.toml", "--output", "out", "-q"][..], &moving].concat(),
    );
    export("out", "walls");
    assert_eq!(
        names("walls"),
        ["walls_000000.stl", "walls_000001.stl", "walls_000002.stl"]
    );
    let mut lowest_m = Vec::new();
    for number in 0..3 {
        let walls = read_walls(&walls_in(&here.join("out"), number)).unwrap();
        let corner = |point: u32| Vector3::from(walls.points_m[point as usize]);
        let wanted: Vec<[Vector3<f64>; 3]> =
            walls.triangles.iter().map(|t| t.map(corner)).collect();
        let found = facets(&here.join(format!("walls/walls_{number:06}.stl")));
        assert_eq!(found, wanted, "frame {number}");
        assert!(wanted.len() > 12);
        let lid = found
            .iter()
            .flatten()
            .map(|corner| corner.z)
            .filter(|z| *z > 0.01);
        lowest_m.push(lid.fold(f64::INFINITY, f64::min));
    }
    // In metres: the lid moves by 0.5 mm from frame to frame.
    for (number, z) in lowest_m.iter().enumerate() {
        assert!(
            (z - 0.045 + 5e-4 * number as f64).abs() < 1e-6,
            "{lowest_m:?}"
        );
    }
}

#[test]
fn walls_that_cannot_be_exported_leave_nothing() {
    let (parent, ..) = burst();
    let here = parent.path();
    fs::create_dir(here.join("full")).unwrap();
    fs::write(here.join("full/mine"), "").unwrap();
    for (walls, problem) in [
        ("walls", "out: its frames have no walls; leave out --walls"),
        (
            "full",
            "full: this folder is not empty; name a new folder with --walls",
        ),
    ] {
        let words = [
            "export",
            "out",
            "--to",
            "lammps-dump",
            "-o",
            "x.dump",
            "--walls",
            walls,
        ];
        let said = bad(here, &words);
        assert!(said.contains(problem), "{said}");
        assert!(!here.join("x.dump").exists() && !here.join("walls").exists());
    }
}
