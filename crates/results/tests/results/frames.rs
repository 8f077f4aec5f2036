//! Frames: read back by the reader of bodies, which share their format, and checked array by array.

use std::fs;

use dem_io::body::vtp;
use dem_results::folder::names;
use dem_results::{
    Frame, FrameFiles, NamedArray, ResultsFolder, Values, WallFiles, WallFrame, WallTriangles,
    read_all_arrays, write_frame,
};
use proptest::prelude::*;
use quick_xml::Reader;
use quick_xml::events::Event;
use tempfile::tempdir;

use super::{contents, results_in};

const POSITIONS: [[f64; 3]; 3] = [[0.0; 3], [1e-3, 0.0, 0.0], [-0.0, 1e-3, 1e-4]];
const VELOCITIES: [[f64; 3]; 3] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]];
const BONDS: [[u32; 2]; 2] = [[0, 1], [0, 2]];

const PARTICLE_ARRAYS: [NamedArray<'static>; 4] = [
    NamedArray {
        name: "velocity_m_s",
        values: Values::Vectors(&|i| VELOCITIES[i]),
    },
    NamedArray {
        name: "body \"a\" & <b>",
        values: Values::Counts(&|i| [7, 8, u32::MAX][i]),
    },
    NamedArray {
        name: "radius_m",
        values: Values::Scalars(&|i| [6e-4, 5e-4, 7e-4][i]),
    },
    NamedArray {
        name: "cluster",
        values: Values::Integers(&|i| [-1, 0, i32::MIN][i]),
    },
];

const BOND_ARRAYS: [NamedArray<'static>; 3] = [
    NamedArray {
        name: "state",
        values: Values::Integers(&|bond| [1, -1][bond]),
    },
    NamedArray {
        name: "bond_radius_m",
        values: Values::Scalars(&|bond| [4e-4, 3e-4][bond]),
    },
    NamedArray {
        name: "force_n",
        values: Values::Vectors(&|bond| [[1.0; 3], [f64::NAN; 3]][bond]),
    },
];

pub(super) fn frame(time_s: f64) -> Frame<'static> {
    Frame {
        time_s,
        body_names: &["a\"b", "K\u{f6}rper"],
        particles: POSITIONS.len(),
        position_m: &|i| POSITIONS[i],
        particle_arrays: &PARTICLE_ARRAYS,
        bonds: BONDS.len(),
        ends: &|bond| BONDS[bond],
        bond_arrays: &BOND_ARRAYS,
    }
}

/// Appends the frame of this time, of a scene without walls.
fn append(frames: &mut FrameFiles, time_s: f64) {
    let walls = (&WallFrame::default(), &WallTriangles::default());
    frames.append(&frame(time_s), walls.0, walls.1).unwrap();
}

fn bytes_of(frame: &Frame<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    frame.check().unwrap();
    write_frame(frame, &mut bytes).unwrap();
    bytes
}

/// Section, type, name, components and bytes of an appended array.
type Found = (String, String, String, usize, Vec<u8>);

/// Every appended array, and the text of the time.
fn arrays(bytes: &[u8]) -> (Vec<Found>, String) {
    let begin = b"<AppendedData encoding=\"raw\">\n_";
    let at = bytes
        .windows(begin.len())
        .position(|part| part == begin)
        .unwrap();
    let data = &bytes[at + begin.len()..];
    let header = std::str::from_utf8(&bytes[..at]).unwrap();
    let mut xml = Reader::from_str(header);
    let (mut found, mut time, mut section, mut end) = (Vec::new(), String::new(), String::new(), 0);
    loop {
        match xml.read_event().unwrap() {
            Event::Start(element) => section = element.name().as_ref().to_owned(),
            Event::Text(text) if section == "DataArray" => time = text.to_string(),
            Event::End(_) => section.clear(),
            Event::Empty(array) => {
                let attribute = |name: &str| {
                    let found = array.try_get_attribute(name).unwrap();
                    found.map(|found| {
                        found
                            .normalized_value(quick_xml::XmlVersion::Implicit1_0)
                            .unwrap()
                            .into_owned()
                    })
                };
                let offset: usize = attribute("offset").unwrap().parse().unwrap();
                assert_eq!(offset, end, "the arrays stand one after the other");
                let size =
                    u64::from_le_bytes(data[offset..offset + 8].try_into().unwrap()) as usize;
                end = offset + 8 + size;
                found.push((
                    section.clone(),
                    attribute("type").unwrap(),
                    attribute("Name").unwrap(),
                    attribute("NumberOfComponents").map_or(1, |number| number.parse().unwrap()),
                    data[offset + 8..end].to_vec(),
                ));
            }
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(&data[end..], b"\n  </AppendedData>\n</VTKFile>\n");
    (found, time)
}

#[test]
fn every_array_stands_where_the_header_says() {
    let (found, time) = arrays(&bytes_of(&frame(1.0 / 3.0)));
    assert_eq!(
        time.parse::<f64>().unwrap().to_bits(),
        (1.0_f64 / 3.0).to_bits()
    );
    let shapes: Vec<_> = found
        .iter()
        .map(|(section, kind, name, components, bytes)| {
            (
                section.as_str(),
                kind.as_str(),
                name.as_str(),
                *components,
                bytes.len(),
            )
        })
        .collect();
    assert_eq!(
        shapes,
        [
            ("Points", "Float64", "Points", 3, 72),
            ("Lines", "Int64", "connectivity", 1, 32),
            ("Lines", "Int64", "offsets", 1, 16),
            ("PointData", "Float64", "velocity_m_s", 3, 72),
            ("PointData", "UInt32", "body \"a\" & <b>", 1, 12),
            ("PointData", "Float64", "radius_m", 1, 24),
            ("PointData", "Int32", "cluster", 1, 12),
            ("CellData", "Int32", "state", 1, 8),
            ("CellData", "Float64", "bond_radius_m", 1, 16),
            ("CellData", "Float64", "force_n", 3, 48),
        ]
    );
    assert_eq!(
        found[4].4,
        [7_u32, 8, u32::MAX].map(u32::to_le_bytes).concat()
    );
    assert_eq!(
        found[6].4,
        [-1_i32, 0, i32::MIN].map(i32::to_le_bytes).concat()
    );
    let velocities: Vec<u8> = VELOCITIES
        .as_flattened()
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    assert_eq!(found[3].4, velocities);
}

#[test]
fn all_arrays_are_read_with_their_kinds() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("frame.vtp");
    fs::write(&path, bytes_of(&frame(0.25))).unwrap();
    let arrays = read_all_arrays(&path).unwrap();
    assert_eq!((arrays.points, arrays.lines), (3, 2));
    assert_eq!(arrays.time_s, Some(0.25));
    let kinds: Vec<(&str, usize, bool)> = arrays
        .named()
        .iter()
        .map(|(name, array)| (name.as_str(), array.components, array.is_whole))
        .collect();
    let wanted = [
        ("CellData/bond_radius_m", 1, false),
        ("CellData/force_n", 3, false),
        ("CellData/state", 1, true),
        ("Lines/connectivity", 1, true),
        ("Lines/offsets", 1, true),
        ("PointData/body \"a\" & <b>", 1, true),
        ("PointData/cluster", 1, true),
        ("PointData/radius_m", 1, false),
        ("PointData/velocity_m_s", 3, false),
        ("Points/positions_m", 3, false),
    ];
    assert_eq!(kinds, wanted);
    let values = |name: &str| arrays.get(name).unwrap();
    assert_eq!(values("PointData/velocity_m_s"), VELOCITIES.as_flattened());
    assert_eq!(values("Lines/connectivity"), [0.0, 1.0, 0.0, 2.0]);
    assert_eq!(
        values("PointData/cluster"),
        [-1.0, 0.0, f64::from(i32::MIN)]
    );
}

/// Flat joints may have 10,000 elements and more.
#[test]
fn an_array_of_many_numbers_for_each_bond_is_read() {
    let (bonds, elements) = (10_i32, 20_000_i32);
    let failed: Vec<f64> = (0..bonds * elements).map(|n| f64::from(n % 2)).collect();
    let frame = Frame {
        bonds: bonds as usize,
        ends: &|bond| BONDS[bond % 2],
        bond_arrays: &[NamedArray {
            name: "failed_elements",
            values: Values::Flags(elements as usize, &failed),
        }],
        ..frame(0.0)
    };
    let folder = tempdir().unwrap();
    let path = folder.path().join("frame.vtp");
    fs::write(&path, bytes_of(&frame)).unwrap();
    let arrays = read_all_arrays(&path).unwrap();
    assert_eq!(arrays.get("CellData/failed_elements").unwrap(), failed);
}

#[test]
fn the_reader_of_bodies_reads_a_frame() {
    let body = vtp::read(&mut bytes_of(&frame(0.5)).as_slice()).unwrap();
    assert_eq!(body.positions, POSITIONS);
    assert_eq!(body.bonds, BONDS);
    assert_eq!(body.radii, [6e-4, 5e-4, 7e-4]);
    assert_eq!(body.bond_radii, [4e-4, 3e-4]);
}

#[test]
fn a_wrong_frame_is_a_fault_with_a_name() {
    let mut wrong = frame(0.0);
    wrong.ends = &|bond| [[0, 1], [1, 3]][bond];
    let error = wrong.check().unwrap_err();
    assert_eq!(error.problem, "bond 1 joins [1, 3] of 3 particles");
    let mut wrong = frame(0.0);
    wrong.particles = 2;
    let error = wrong.check().unwrap_err();
    assert_eq!(error.problem, "bond 1 joins [0, 2] of 2 particles");
}

/// A frame of `count` particles in a row, each joined to the next, with an array of each type.
fn bytes_of_row(count: usize) -> Vec<u8> {
    let row = Frame {
        time_s: 0.0,
        body_names: &["a\"b", "K\u{f6}rper"],
        particles: count,
        position_m: &|i| [i as f64, 0.5, -(i as f64)],
        particle_arrays: &[NamedArray {
            name: "half",
            values: Values::Scalars(&|i| 0.5 * i as f64),
        }],
        bonds: count.saturating_sub(1),
        ends: &|bond| [bond as u32, bond as u32 + 1],
        bond_arrays: &[NamedArray {
            name: "number",
            values: Values::Counts(&|bond| bond as u32),
        }],
    };
    bytes_of(&row)
}

#[test]
fn arrays_of_any_length_hold_every_value_in_order() {
    for count in [0, 1, 2, 1023, 1024, 1025, 1026, 3000] {
        let (found, _) = arrays(&bytes_of_row(count));
        let bonds = count.saturating_sub(1);
        let floats = |values: Vec<f64>| values.into_iter().flat_map(f64::to_le_bytes).collect();
        let longs = |values: Vec<i64>| values.into_iter().flat_map(i64::to_le_bytes).collect();
        let expected: [Vec<u8>; 5] = [
            floats(
                (0..count)
                    .flat_map(|i| [i as f64, 0.5, -(i as f64)])
                    .collect(),
            ),
            longs(
                (0..bonds as i64)
                    .flat_map(|bond| [bond, bond + 1])
                    .collect(),
            ),
            longs((1..=bonds as i64).map(|bond| 2 * bond).collect()),
            floats((0..count).map(|i| 0.5 * i as f64).collect()),
            (0..bonds as u32).flat_map(u32::to_le_bytes).collect(),
        ];
        for (found, expected) in found.iter().zip(&expected) {
            assert!(found.4 == *expected, "'{}' of {count}", found.2);
        }
        assert_eq!(found.len(), expected.len());
    }
}

#[test]
fn the_index_lists_every_frame_with_its_time() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let mut frames = FrameFiles::create(&folder, WallFiles::default());
    assert!(contents(folder.path()).is_empty());
    for time_s in [0.0, 5e-3, 0.01] {
        append(&mut frames, time_s);
    }
    assert_eq!(frames.times_s(), [0.0, 5e-3, 0.01]);
    assert_eq!(
        fs::read_to_string(folder.file(names::INDEX)).unwrap(),
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n    \
         <DataSet timestep=\"0e0\" part=\"0\" file=\"frames/frame_000000.vtp\"/>\n    \
         <DataSet timestep=\"5e-3\" part=\"0\" file=\"frames/frame_000001.vtp\"/>\n    \
         <DataSet timestep=\"1e-2\" part=\"0\" file=\"frames/frame_000002.vtp\"/>\n  </Collection>\n</VTKFile>\n"
    );
    assert_eq!(fs::read(folder.frame(2)).unwrap(), bytes_of(&frame(0.01)));
    assert_eq!(contents(folder.path()).len(), 4);
}

pub(super) fn written(folder: &ResultsFolder) -> Vec<(String, Vec<u8>)> {
    contents(folder.path())
        .into_iter()
        .map(|(path, bytes)| {
            (
                path.strip_prefix(folder.path())
                    .unwrap()
                    .display()
                    .to_string(),
                bytes,
            )
        })
        .collect()
}

#[test]
fn a_missing_frame_is_told_when_a_run_continues() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    append(&mut FrameFiles::create(&folder, WallFiles::default()), 0.0);
    let error = FrameFiles::continue_at(&folder, WallFiles::default(), vec![0.0, 1.0]).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.place.ends_with("frame_000001.vtp"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn an_interrupted_run_leaves_the_same_frames(times in prop::collection::vec(0.0..1e3_f64, 0..6), crash in any::<prop::sample::Index>(), checkpoint in any::<prop::sample::Index>()) {
        let crash = crash.index(times.len() + 1);
        let checkpoint = checkpoint.index(crash + 1);
        let [a, b] = [tempdir().unwrap(), tempdir().unwrap()];
        let [whole, resumed] = [results_in(&a), results_in(&b)];
        let mut frames = FrameFiles::create(&whole, WallFiles::default());
        times.iter().for_each(|time| append(&mut frames, *time));
        let mut frames = FrameFiles::create(&resumed, WallFiles::default());
        times[..crash].iter().for_each(|time| append(&mut frames, *time));
        let mut frames = FrameFiles::continue_at(&resumed, WallFiles::default(), times[..checkpoint].to_vec()).unwrap();
        prop_assert_eq!(written(&resumed).len(), if checkpoint == 0 { 0 } else { checkpoint + 1 });
        times[checkpoint..].iter().for_each(|time| append(&mut frames, *time));
        prop_assert_eq!(written(&resumed), written(&whole));
    }
}
