//! Tables of fragments: full precision, complete rows, and the same bytes after an interruption.

use std::fs;
use std::io::Write;

use dem_results::columns::{header, write_table};
use dem_results::{FragmentRow, Table, TreeRow, append_fragments};
use proptest::prelude::*;
use tempfile::tempdir;

fn fragment(time_s: f64, id: u32, numbers: [f64; 15]) -> FragmentRow<'static> {
    let three = |first: usize| [numbers[first], numbers[first + 1], numbers[first + 2]];
    FragmentRow {
        time_s,
        fragment_id: id,
        parent_id: id.checked_sub(1),
        particles: 10 * id,
        mass_kg: numbers[0],
        centre_m: three(1),
        velocity_m_s: three(4),
        angular_velocity_rad_s: three(7),
        force_n: Some(three(10)),
        equivalent_diameter_m: numbers[13],
        box_diagonal_m: numbers[14],
        body: "cake, \"old\"",
        material: "stone",
    }
}

#[test]
fn fragments_look_as_documented() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("fragments.csv");
    let mut file = Table::create(&path, &header(&FragmentRow::COLUMNS)).unwrap();
    let whole = [
        0.25, 1.0, -2.0, 3.0, 0.5, -0.0, 1e-9, 7.0, 8.0, 9.0, -1.0, 0.0, 1e3, 0.125, 0.75,
    ];
    append_fragments(&mut file, &[fragment(0.0, 0, whole)]).unwrap();
    append_fragments(&mut file, &[]).unwrap();
    append_fragments(&mut file, &[fragment(2.5e-3, 2, [1.0 / 3.0; 15])]).unwrap();
    let third = ",0.3333333333333333".repeat(15);
    let text = format!(
        "time_s,fragment_id,parent_id,particles,mass_kg,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,fx_n,fy_n,fz_n,equivalent_diameter_m,box_diagonal_m,body,material\n\
         0,0,,0,0.25,1,-2,3,0.5,0,1e-9,7,8,9,-1,0,1000,0.125,0.75,\"cake, \"\"old\"\"\",stone\n\
         0.0025,2,1,20{third},\"cake, \"\"old\"\"\",stone\n"
    );
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
    assert_eq!(file.length_bytes(), text.len() as u64);
    file.sync().unwrap();
}

#[test]
fn the_tree_looks_as_documented_and_is_replaced_whole() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("fragment-tree.csv");
    let root = TreeRow {
        fragment_id: 0,
        parent_id: None,
        created_s: 0.0,
        ended_s: Some(2.5e-3),
        particles: 7,
    };
    let child = TreeRow {
        fragment_id: 1,
        parent_id: Some(0),
        created_s: 2.5e-3,
        ended_s: None,
        particles: 4,
    };
    write_table(&path, &TreeRow::COLUMNS, [root, root, root]).unwrap();
    write_table(&path, &TreeRow::COLUMNS, [root, child]).unwrap();
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "fragment_id,parent_id,created_s,ended_s,particles\n0,,0,0.0025,7\n1,0,0.0025,,4\n"
    );
    assert_eq!(TreeRow::COLUMNS.len(), 5);
    let missing = folder.path().join("missing/tree.csv");
    let error = write_table(&missing, &TreeRow::COLUMNS, [root]).unwrap_err();
    assert_eq!(error.exit_code(), 1);
}

#[test]
fn a_file_that_does_not_fit_its_checkpoint_is_refused_and_stays_as_it_is() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("fragments.csv");
    let mut file = Table::create(&path, &header(&FragmentRow::COLUMNS)).unwrap();
    append_fragments(&mut file, &[fragment(0.0, 0, [1.0; 15])]).unwrap();
    let length = file.length_bytes();
    let before = fs::read(&path).unwrap();
    for (length, said) in [
        (length + 1, "bytes, but had"),
        (length - 1, "no row ends"),
        (0, "no row ends"),
    ] {
        let error = Table::continue_at(&path, &header(&FragmentRow::COLUMNS), length).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.problem.contains(said), "{error}");
        assert_eq!(fs::read(&path).unwrap(), before);
    }
    let other = folder.path().join("other.csv");
    fs::write(&other, format!("{}\n", header(&TreeRow::COLUMNS))).unwrap();
    let at = header(&TreeRow::COLUMNS).len() as u64 + 1;
    let error = Table::continue_at(&other, &header(&FragmentRow::COLUMNS), at).unwrap_err();
    assert!(error.problem.contains("first line"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn interrupted_fragments_end_as_those_that_were_not(
        moments in prop::collection::vec(0..4_u32, 0..12),
        numbers in prop::array::uniform15(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL),
        at in any::<prop::sample::Index>(),
        half in "[0-9e,.-]{0,20}",
    ) {
        let folder = tempdir().unwrap();
        let at = at.index(moments.len() + 1);
        let rows = |time_s: f64, count: u32| (0..count).map(|id| fragment(time_s, id, numbers)).collect::<Vec<_>>();
        let write = |name: &str, interrupted: bool| {
            let path = folder.path().join(name);
            let mut file = Table::create(&path, &header(&FragmentRow::COLUMNS)).unwrap();
            for (number, count) in moments.iter().enumerate() {
                if interrupted && number == at {
                    let length = file.length_bytes();
                    append_fragments(&mut file, &rows(9.0, 3)).unwrap();
                    drop(file);
                    // A possible state of a row that was being written.
                    fs::OpenOptions::new().append(true).open(&path).unwrap().write_all(half.as_bytes()).unwrap();
                    file = Table::continue_at(&path, &header(&FragmentRow::COLUMNS), length).unwrap();
                }
                append_fragments(&mut file, &rows(number as f64, *count)).unwrap();
            }
            fs::read_to_string(&path).unwrap()
        };
        let text = write("whole.csv", false);
        prop_assert_eq!(&write("part.csv", true), &text);
        // The numbers are read back unchanged.
        let mut lines = text.lines();
        prop_assert_eq!(lines.next(), Some(&*header(&FragmentRow::COLUMNS)));
        let wanted = moments.iter().enumerate().flat_map(|(number, count)| (0..*count).map(move |id| (number, id)));
        let mut read = 0;
        for (line, (number, id)) in lines.zip(wanted) {
            let words: Vec<&str> = line.split(',').collect();
            prop_assert_eq!(words[0].parse::<f64>().unwrap(), number as f64);
            prop_assert_eq!(words[1].parse::<u32>().unwrap(), id);
            let back: Vec<f64> = words[4..19].iter().map(|word| word.parse().unwrap()).collect();
            prop_assert_eq!(&back[..], &numbers[..]);
            read += 1;
        }
        prop_assert_eq!(read, moments.iter().sum::<u32>());
    }
}

/// Rows are passed on in groups: none is lost or doubled at their borders.
#[test]
fn thousands_of_fragments_of_one_moment_are_all_there() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("fragments.csv");
    let mut file = Table::create(&path, &header(&FragmentRow::COLUMNS)).unwrap();
    let rows: Vec<FragmentRow> = (0..2500).map(|id| fragment(1.0, id, [1.0; 15])).collect();
    append_fragments(&mut file, &rows).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let ids: Vec<u32> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(1).unwrap().parse().unwrap())
        .collect();
    assert_eq!(ids, (0..2500).collect::<Vec<u32>>());
    assert_eq!(file.length_bytes(), text.len() as u64);
}
