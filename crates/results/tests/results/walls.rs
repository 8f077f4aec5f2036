//! Walls in frames: read back by their reader, and checked number by number in the bytes.

use std::fs;

use dem_io::body::{StoredWalls, read_walls};
use dem_results::folder::names;
use dem_results::folder::walls_in;
use dem_results::{FrameFiles, ResultsFolder, WallFiles, WallFrame, WallTriangles};
use proptest::prelude::*;
use tempfile::tempdir;

use super::frames::{frame, written};
use super::results_in;

const EACH_FRAME: WallFiles = WallFiles {
    each_frame: true,
    fixed: false,
    loads: false,
};
const FIXED: WallFiles = WallFiles {
    fixed: true,
    ..EACH_FRAME
};

/// A square of two triangles at this height, m, and a triangle above it.
fn walls(height_m: f64) -> WallFrame {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| [x, y, height_m]);
    let above = [0, 1, 2].map(|i| square[i].map(|x| x + 0.5));
    let mut triangles = WallTriangles::default();
    triangles.add(0, square.into_iter(), &[[0, 1, 2], [0, 2, 3]]);
    triangles.add(1, above.into_iter(), &[[0, 1, 2]]);
    WallFrame {
        names: vec!["floor, \"left\"".to_owned(), "Walze \u{e9}".to_owned()],
        forces_n: vec![[1.0 / 3.0, -2.0, 3.0e-7], [0.0, 0.0, height_m]],
        triangles,
        velocities_m_s: vec![[0.0; 3], [1.0, 2.0, 3.0], [-0.5, 0.0, 4.0]],
        loads: Vec::new(),
    }
}

/// A triangle of wall 1 that never moves.
fn fixed() -> WallTriangles {
    let mut triangles = WallTriangles::default();
    let corners = [[0.0, 0.0, 7.0], [1.0, 0.0, 7.0], [0.0, 1.0, 7.0]];
    triangles.add(1, corners.into_iter(), &[[0, 1, 2]]);
    triangles
}

fn append(frames: &mut FrameFiles, time_s: f64) {
    let walls = walls(time_s);
    frames.append(&frame(time_s), &walls, &fixed()).unwrap();
}

fn read(folder: &ResultsFolder, number: usize) -> StoredWalls {
    read_walls(&walls_in(folder.path(), number)).unwrap()
}

#[test]
fn walls_are_read_back_as_they_were() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let mut frames = FrameFiles::create(&folder, EACH_FRAME);
    append(&mut frames, 0.25);
    let (found, written) = (read(&folder, 0), walls(0.25));
    assert_eq!(found.time_s, 0.25);
    assert_eq!(found.names, written.names);
    assert_eq!(found.forces_n, written.forces_n);
    // These coordinates are exact in single precision.
    assert_eq!(found.points_m, written.triangles.points_m);
    assert_eq!(found.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6]]);
    assert_eq!(found.wall_of_triangle, [0, 0, 1]);
    assert!(!folder.fixed_walls().exists());
}

#[test]
fn large_walls_that_never_move_are_written_once() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let mut frames = FrameFiles::create(&folder, FIXED);
    append(&mut frames, 0.25);
    append(&mut frames, 0.5);
    for (number, time_s) in [(0, 0.25), (1, 0.5)] {
        let found = read(&folder, number);
        assert_eq!(found.triangles.len(), 4);
        assert_eq!(found.wall_of_triangle, [0, 0, 1, 1]);
        let corners = found.triangles[3].map(|point| found.points_m[point as usize]);
        assert_eq!(corners.to_vec(), fixed().points_m);
        assert_eq!(found.forces_n[1], [0.0, 0.0, time_s]);
    }
    fs::remove_file(folder.fixed_walls()).unwrap();
    let error = read_walls(&folder.walls(0)).unwrap_err();
    assert!(error.place.ends_with("walls_fixed.vtp"), "{error}");
    let times = frames.times_s().to_vec();
    let error = FrameFiles::continue_at(&folder, FIXED, times).unwrap_err();
    assert!(error.place.ends_with("walls_fixed.vtp"), "{error}");
}

#[test]
fn the_index_lists_walls_as_parts_of_a_time() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    let mut frames = FrameFiles::create(&folder, FIXED);
    append(&mut frames, 0.5);
    let index = fs::read_to_string(folder.file(names::INDEX)).unwrap();
    let parts: Vec<&str> = index
        .lines()
        .filter(|line| line.contains("DataSet"))
        .collect();
    assert_eq!(
        parts,
        [
            "    <DataSet timestep=\"5e-1\" part=\"0\" file=\"frames/frame_000000.vtp\"/>",
            "    <DataSet timestep=\"5e-1\" part=\"1\" file=\"frames/walls_000000.vtp\"/>",
            "    <DataSet timestep=\"5e-1\" part=\"2\" file=\"frames/walls_fixed.vtp\"/>",
        ]
    );
}

/// The bytes of the array of this name, found by its offset in the header.
fn array<'a>(bytes: &'a [u8], name: &str) -> (&'a [u8], String) {
    let begin = b"<AppendedData encoding=\"raw\">\n_";
    let is_begin = |part: &[u8]| part == begin;
    let at = bytes.windows(begin.len()).position(is_begin).unwrap();
    let header = std::str::from_utf8(&bytes[..at]).unwrap();
    let line = header
        .lines()
        .find(|line| line.contains(&format!("Name=\"{name}\"")))
        .unwrap();
    let offset = line
        .split("offset=\"")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap();
    let data = &bytes[at + begin.len() + offset.parse::<usize>().unwrap()..];
    let size = u64::from_le_bytes(data[..8].try_into().unwrap()) as usize;
    (&data[8..8 + size], line.trim().to_owned())
}

#[test]
fn arrays_of_walls_have_the_numbers_and_types_that_vtk_reads() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    append(&mut FrameFiles::create(&folder, EACH_FRAME), 0.5);
    let bytes = fs::read(folder.walls(0)).unwrap();
    let header = String::from_utf8_lossy(&bytes);
    assert!(header.contains(
        "<Piece NumberOfPoints=\"7\" NumberOfPolys=\"3\" NumberOfVerts=\"0\" NumberOfStrips=\"0\" NumberOfLines=\"0\">"
    ));
    let integers =
        |values: &[i32]| -> Vec<u8> { values.iter().flat_map(|v| v.to_le_bytes()).collect() };
    let (connectivity, line) = array(&bytes, "connectivity");
    assert!(line.contains("Int32"), "{line}");
    assert_eq!(connectivity, integers(&[0, 1, 2, 0, 2, 3, 4, 5, 6]));
    assert_eq!(array(&bytes, "offsets").0, integers(&[3, 6, 9]));
    assert_eq!(array(&bytes, "wall").0, integers(&[0, 0, 1]));
    let single = |values: &[[f64; 3]]| -> Vec<u8> {
        values
            .as_flattened()
            .iter()
            .flat_map(|v| (*v as f32).to_le_bytes())
            .collect()
    };
    let expected = walls(0.5);
    let [a, b] = [expected.forces_n[0], expected.forces_n[1]];
    let (forces, line) = array(&bytes, "force_n");
    assert!(
        line.contains("Float32") && line.contains("NumberOfComponents=\"3\""),
        "{line}"
    );
    assert_eq!(forces, single(&[a, a, b]));
    assert_eq!(
        array(&bytes, "velocity_m_s").0,
        single(&expected.velocities_m_s)
    );
    assert_eq!(
        array(&bytes, "Points").0,
        single(&expected.triangles.points_m)
    );
}

#[test]
fn damaged_walls_are_refused() {
    let parent = tempdir().unwrap();
    let folder = results_in(&parent);
    append(&mut FrameFiles::create(&folder, EACH_FRAME), 0.5);
    let path = folder.walls(0);
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        // Only the last line break may be missing.
        assert!(
            read_walls(&path).is_err() || length + 1 == whole.len(),
            "{length}"
        );
    }
    let text = String::from_utf8_lossy(&whole).into_owned();
    let many = "NumberOfPolys=\"3\"";
    let at = text.find(many).unwrap();
    let mut changed = whole.clone();
    changed[at + many.len() - 2] = b'2';
    fs::write(&path, &changed).unwrap();
    assert!(read_walls(&path).unwrap_err().problem.contains('2'));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn an_interrupted_run_leaves_the_same_walls(times in prop::collection::vec(0.0..1e3_f64, 0..6), crash in any::<prop::sample::Index>(), checkpoint in any::<prop::sample::Index>()) {
        let files = FIXED;
        let crash = crash.index(times.len() + 1);
        let checkpoint = checkpoint.index(crash + 1);
        let [a, b] = [tempdir().unwrap(), tempdir().unwrap()];
        let [whole, resumed] = [results_in(&a), results_in(&b)];
        let mut frames = FrameFiles::create(&whole, files);
        times.iter().for_each(|time| append(&mut frames, *time));
        let mut frames = FrameFiles::create(&resumed, files);
        times[..crash].iter().for_each(|time| append(&mut frames, *time));
        let mut frames = FrameFiles::continue_at(&resumed, files, times[..checkpoint].to_vec()).unwrap();
        prop_assert_eq!(written(&resumed).len(), if checkpoint == 0 { 0 } else { 2 * checkpoint + 2 });
        times[checkpoint..].iter().for_each(|time| append(&mut frames, *time));
        prop_assert_eq!(written(&resumed), written(&whole));
    }
}
