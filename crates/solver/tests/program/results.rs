//! The folder of results: its contents, and the treatment of existing files.

use std::fs;

use dem_io::body::vtp;
use serde_json::Value;

use super::{Bench, good, names_in, numbers, results, scene_of_data, table};

fn breaking() -> Bench {
    let bench = Bench::new();
    bench.good(&good("breaking.toml"), &["--output", "out"]);
    bench
}

#[test]
fn holds_frames_series_events_plots_summary_and_checkpoint() {
    let bench = breaking();
    assert_eq!(
        names_in(&bench.path("out")),
        [
            ".ended.json",
            ".lock",
            "checkpoint.dem",
            "distribution.csv",
            "events.csv",
            "fragment-tree.csv",
            "fragments.csv",
            "frames",
            "frames.pvd",
            "plots",
            "report.html",
            "scene.toml",
            "series.csv",
            "summary.json"
        ]
    );
    // At 0, 0.5, ..., 4 ms.
    assert_eq!(names_in(&bench.path("out/frames")).len(), 9);
    assert_eq!(
        names_in(&bench.path("out/plots")),
        [
            "broken.svg",
            "broken_bonds.svg",
            "energy.svg",
            "errors.svg",
            "fragment_sizes.svg",
            "fragments.svg",
            "pull.svg",
            "rate_strengthening.svg",
        ]
    );
    let index = fs::read_to_string(bench.path("out/frames.pvd")).unwrap();
    assert_eq!(index.matches("<DataSet ").count(), 9);
    for name in names_in(&bench.path("out/frames")) {
        assert!(index.contains(&format!("file=\"frames/{name}\"")));
    }
}

#[test]
fn events_tell_every_bond_that_broke() {
    let bench = breaking();
    let summary: Value =
        serde_json::from_slice(&fs::read(bench.path("out/summary.json")).unwrap()).unwrap();
    let (columns, rows) = table(&bench.path("out/events.csv"));
    assert_eq!(
        columns.join(","),
        "step,time_s,event,bond,particle_a,particle_b,x_m,y_m,z_m,cause,energy_j,detail,strain_rate_1_s,dynamic_increase_factor"
    );
    let rows: Vec<_> = rows
        .into_iter()
        .filter(|row| row[2] == "bond_broken")
        .collect();
    assert!(rows.len() >= 4);
    assert_eq!(summary["broken_bonds"], rows.len());
    for cause in ["tension", "compression", "shear", "von_mises"] {
        let counted = rows.iter().filter(|row| row[9] == cause).count();
        assert_eq!(summary["broken_by_cause"][cause], counted, "{cause}");
    }
    let bonds = [
        [0, 1],
        [1, 2],
        [2, 3],
        [4, 5],
        [5, 6],
        [6, 7],
        [0, 4],
        [1, 5],
        [2, 6],
        [3, 7],
    ];
    let mut released = 0.0;
    for row in &rows {
        assert_eq!(row[2], "bond_broken");
        let bond: usize = row[3].parse().unwrap();
        let ends: [usize; 2] = [row[4].parse().unwrap(), row[5].parse().unwrap()];
        assert_eq!(ends, bonds[bond], "bond {bond}");
        assert!(["tension", "shear", "compression"].contains(&row[9].as_str()));
        released += row[10].parse::<f64>().unwrap();
        assert_eq!(row[11], "bar");
    }
    let booked = summary["balance"]["bond_breakage_j"].as_f64().unwrap();
    assert!((released / booked - 1.0).abs() < 1e-12);
    let broken = numbers(&bench.path("out/series.csv"), "broken_bonds");
    assert_eq!(broken[broken.len() - 1], rows.len() as f64);
    assert!(broken.is_sorted());
}

#[test]
fn events_of_several_bodies_have_each_bodys_numbers() {
    let bench = Bench::new();
    let options = [
        "--set",
        "bonds.brittle.failure.tensile_strength=3 kPa",
        "--output",
        "out",
    ];
    bench.good(&good("bodies.toml"), &options);
    let (_, rows) = table(&bench.path("out/events.csv"));
    let bonds = [["0", "3"], ["0", "1"], ["1", "2"]];
    let rows: Vec<_> = rows
        .into_iter()
        .filter(|row| row[2] == "bond_broken")
        .collect();
    assert!(!rows.is_empty());
    for row in rows {
        let bond: usize = row[3].parse().unwrap();
        assert_eq!([row[4].as_str(), row[5].as_str()], bonds[bond]);
        assert_eq!(row[11], "b");
    }
}

#[test]
fn series_have_a_row_at_every_time_asked_for() {
    let bench = Bench::new();
    // A step shorter than the time between two rows.
    let step = ["--set", "run.safety_factor=0.16", "--output", "out"];
    bench.good(&good("breaking.toml"), &step);
    let path = bench.path("out/series.csv");
    let times = numbers(&path, "time_s");
    // A thousandth of the end time apart, and one at the start.
    assert_eq!(times.len(), 1001);
    assert_eq!(times[0], 0.0);
    assert!((times[1000] / 4e-3 - 1.0).abs() < 1e-9);
    for (at, time) in times.iter().enumerate() {
        assert!((time - 4e-6 * at as f64).abs() < 1.7e-6, "row {at}: {time}");
    }
    let (columns, rows) = table(&path);
    assert!(rows.iter().all(|row| row.len() == columns.len()));
    assert!(columns.contains(&"pull_n".to_owned()) && columns.contains(&"broken".to_owned()));
    let largest = numbers(&path, "pull_n")
        .into_iter()
        .fold(f64::MIN, f64::max);
    let summary: Value =
        serde_json::from_slice(&fs::read(bench.path("out/summary.json")).unwrap()).unwrap();
    let pull = &summary["measures"]["pull"];
    assert_eq!(pull["value"], largest);
    assert_eq!(pull["unit"], "N");
}

#[test]
fn measures_named_like_other_columns_and_plots_stand_beside_them() {
    let bench = Bench::new();
    bench.good(&good("every-measure.toml"), &["--output", "out"]);
    let (columns, _) = table(&bench.path("out/series.csv"));
    let mut unique = columns.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), columns.len());
    let plots = names_in(&bench.path("out/plots"));
    for name in [
        "energy.svg",
        "errors.svg",
        "broken_bonds.svg",
        "measured_energy.svg",
        "measured_errors.svg",
    ] {
        assert!(plots.contains(&name.to_owned()), "{name} in {plots:?}");
    }
    assert_eq!(plots.len(), 4 + 37 + 2);
    for name in plots {
        let text = fs::read_to_string(bench.path("out/plots").join(&name)).unwrap();
        assert!(text.starts_with("<!-- dem-run plot -->\n<svg "), "{name}");
        assert!(text.trim_end().ends_with("</svg>"), "{name}");
        assert_eq!(
            text.matches("<text").count(),
            text.matches("</text>").count()
        );
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    }
}

/// Every frame is one header and the arrays declared in it, one after another.
#[test]
fn frames_have_every_array_at_full_length() {
    let bench = breaking();
    for name in names_in(&bench.path("out/frames")) {
        let bytes = fs::read(bench.path("out/frames").join(&name)).unwrap();
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap();
        let header = std::str::from_utf8(&bytes[..at]).unwrap();
        let data = &bytes[at + mark.len()..];
        assert!(header.contains("NumberOfPoints=\"8\"") && header.contains("NumberOfLines=\"10\""));
        let mut end = 0;
        for array in header.split("<DataArray ").skip(1) {
            let attribute = |name: &str| {
                let (_, rest) = array.split_once(&format!(" {name}=\"")).or_else(|| {
                    array
                        .strip_prefix(&format!("{name}=\""))
                        .map(|rest| ("", rest))
                })?;
                Some(rest.split_once('"').unwrap().0)
            };
            let Some(offset) = attribute("offset") else {
                continue;
            };
            assert_eq!(offset.parse::<usize>().unwrap(), end, "{name}: {array}");
            let length = u64::from_le_bytes(data[end..end + 8].try_into().unwrap()) as usize;
            let name = attribute("Name").unwrap();
            let size = match attribute("type").unwrap() {
                "Float64" | "Int64" => 8,
                "Float32" | "Int32" | "UInt32" => 4,
                other => panic!("{other}"),
            };
            let components: usize =
                attribute("NumberOfComponents").map_or(1, |n| n.parse().unwrap());
            let values = length / size / components;
            assert_eq!(values * size * components, length);
            let wanted: &[usize] = match name {
                "connectivity" => &[20],
                "offsets" => &[10],
                _ => &[8, 10],
            };
            assert!(wanted.contains(&values), "{name}: {values}");
            end += 8 + length;
        }
        assert_eq!(&data[end..], b"\n  </AppendedData>\n</VTKFile>\n");
        for array in [
            "displacement_m",
            "particle_id",
            "body_names",
            "velocity_m_s",
            "normal_force_n",
            "utilisation",
            "broken",
            "fragment_mass_kg",
            "strain_rate_1_s",
            "dynamic_increase_factor",
            "dynamic_utilisation",
            "TimeValue",
        ] {
            assert!(header.contains(&format!("Name=\"{array}\"")), "{array}");
        }
        // It is not accepted as a body: broken bonds would be intact again.
        assert!(vtp::read(&mut bytes.as_slice()).is_err());
    }
}

#[test]
fn a_folder_with_something_in_it_is_refused_or_replaced() {
    let bench = breaking();
    let before = results(&bench.path("out"));
    let said = bench.bad(&good("bodies.toml"), &["--output", "out"], 2);
    assert!(
        said.contains("out: this folder is not empty")
            && said.contains("--force")
            && said.contains("--resume"),
        "{said}"
    );
    assert!(before == results(&bench.path("out")));
    // Only files written by dem-run are removed.
    bench.write("out/notes.txt", "mine");
    bench.write("out/frames/frame_mine.vtp", "mine");
    bench.write("out/plots/mine.svg", "<svg/>");
    bench.good(&good("bodies.toml"), &["--output", "out", "--force"]);
    for mine in [
        "out/notes.txt",
        "out/frames/frame_mine.vtp",
        "out/plots/mine.svg",
    ] {
        assert!(bench.path(mine).exists(), "{mine}");
    }
    assert_eq!(names_in(&bench.path("out/frames")).len(), 6);
    assert!(!bench.path("out/plots/pull.svg").exists());
    // A refused run removes nothing.
    let before = results(&bench.path("out"));
    bench.bad(
        &good("bodies.toml"),
        &["--output", "out", "--force", "--set", "run.time_step=1 ms"],
        2,
    );
    assert!(before == results(&bench.path("out")));
}

#[test]
fn folders_that_cannot_be() {
    let bench = Bench::new();
    let scene = good("alone.toml");
    bench.write("file", "mine");
    let said = bench.bad(&scene, &["--output", "file"], 1);
    assert!(
        said.contains("file: this is a file, where a folder is needed"),
        "{said}"
    );
    assert_eq!(bench.files(), ["file"]);
}

#[test]
fn without_out_the_folder_is_named_by_the_scene() {
    let bench = Bench::new();
    bench.good(&good("alone.toml"), &[]);
    assert_eq!(bench.files(), ["alone-out"]);
    bench.good(
        &scene_of_data("cantilever.toml"),
        &["--set", "run.end_time=10 ms", "-o", "here"],
    );
    assert_eq!(bench.files(), ["alone-out", "here"]);
}
