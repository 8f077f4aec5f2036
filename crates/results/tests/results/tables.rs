//! Series and events: full precision, complete rows, and the same bytes after an interruption.

use std::fs;
use std::io::Write;

use dem_results::columns::header;
use dem_results::{Event, SeriesFile, Table, event_lines, read_series, read_strengthened};
use proptest::prelude::*;
use tempfile::tempdir;

fn columns(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn event(step: u64) -> Event<'static> {
    Event {
        step,
        time_s: 1e-6 * step as f64,
        kind: "bond_broken",
        bond: Some(3),
        particle_a: Some(1),
        particle_b: Some(2),
        position_m: Some([0.5, -1e-3, 0.0]),
        cause: "tension",
        energy_j: Some(0.1),
        detail: "",
        strengthened: None,
    }
}

#[test]
fn a_series_looks_as_documented() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("series.csv");
    let names = columns(&["kinetic_energy_j", "share of \"a\", b"]);
    let mut series = SeriesFile::create(&path, &names).unwrap();
    series.append(0.0, &[1.0 / 3.0, -0.0]).unwrap();
    series.append(5e-4, &[f64::NAN, f64::NEG_INFINITY]).unwrap();
    let text = "time_s,kinetic_energy_j,\"share of \"\"a\"\", b\"\n\
                0,0.3333333333333333,-0\n\
                0.0005,NaN,-inf\n";
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
    assert_eq!(series.table.length_bytes(), text.len() as u64);
    assert_eq!(series.append(1.0, &[1.0]).unwrap_err().exit_code(), 1);
    series.table.sync().unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
    let read = read_series(&path).unwrap();
    assert_eq!(read.columns, names);
    assert_eq!(read.times_s, [0.0, 5e-4]);
    assert_eq!(read.values[0][0], 1.0 / 3.0);
    assert_eq!(read.values[1], [-0.0, f64::NEG_INFINITY]);
}

#[test]
fn a_series_that_was_damaged_is_refused_with_the_line() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("series.csv");
    for (text, place, problem) in [
        ("", "line 1", "the first column"),
        ("step,a_m\n", "line 1", "the first column"),
        ("time_s,a_m\n0e0,1e0\n1e0\n", "line 3", "a_m is missing"),
        ("time_s,a_m\n0e0,1e0,2e0\n", "line 2", "more than 2 values"),
        ("time_s,a_m\n0e0,x\n", "line 2", "a_m is 'x'"),
        ("time_s,a_m\n0e0,1e0\n1e0,2", "line 3", "the file ends"),
    ] {
        fs::write(&path, text).unwrap();
        let error = read_series(&path).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.place.ends_with(place), "{error}");
        assert!(error.problem.starts_with(problem), "{error}");
    }
    let error = read_series(&folder.path().join("none.csv")).unwrap_err();
    assert_eq!(error.problem, "there is no such file");
}

#[test]
fn events_look_as_documented() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("events.csv");
    let mut events = Table::create(&path, &header(&Event::COLUMNS)).unwrap();
    let planned = Event {
        step: 12,
        time_s: 0.25,
        kind: "plan",
        bond: None,
        particle_a: None,
        particle_b: None,
        position_m: None,
        cause: "",
        energy_j: None,
        detail: "search begins,\nbodies are near",
        strengthened: None,
    };
    let fast = Event {
        detail: "a, b",
        strengthened: Some([10.0, 3.5675]),
        ..event(3)
    };
    events.append(&event_lines([])).unwrap();
    let rows = [event(2), planned, fast];
    events.append(&event_lines(rows)).unwrap();
    let text = "step,time_s,event,bond,particle_a,particle_b,x_m,y_m,z_m,cause,energy_j,detail,strain_rate_1_s,dynamic_increase_factor\n\
                2,2e-6,bond_broken,3,1,2,0.5,-0.001,0,tension,0.1,,,\n\
                12,0.25,plan,,,,,,,,,\"search begins, bodies are near\",,\n\
                3,3e-6,bond_broken,3,1,2,0.5,-0.001,0,tension,0.1,\"a, b\",10,3.5675\n";
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
    assert_eq!(read_strengthened(&path).unwrap(), [[10.0, 3.5675]]);
    assert_eq!(events.length_bytes(), text.len() as u64);
    events.sync().unwrap();
}

#[test]
fn a_table_that_does_not_fit_its_checkpoint_is_refused_and_stays_as_it_is() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("series.csv");
    let names = columns(&["a_m"]);
    let mut series = SeriesFile::create(&path, &names).unwrap();
    series.append(0.0, &[1.0]).unwrap();
    let length = series.table.length_bytes();
    let before = fs::read(&path).unwrap();
    let refused = |names: &[&str], length, said: &str| {
        let error = SeriesFile::continue_at(&path, &columns(names), length).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.problem.contains(said), "{error}");
        assert!(!error.remedy.is_empty());
        assert_eq!(fs::read(&path).unwrap(), before);
    };
    refused(&["a_m"], length + 1, "bytes, but had");
    refused(&["a_m"], length - 1, "no row ends");
    refused(&["a_m"], 0, "no row ends");
    refused(&["a_m"], 3, "no row ends");
    refused(&["b_m"], length, "first line");
    refused(&["a_m", "b_m"], length, "first line");
    refused(&[], length, "first line");
    SeriesFile::continue_at(&path, &names, length).unwrap();
    let error = SeriesFile::continue_at(&folder.path().join("none.csv"), &names, 7).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(
        error.problem.starts_with("there is no such file"),
        "{error}"
    );
}

#[test]
fn a_missing_folder_is_told() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("missing/series.csv");
    let error = SeriesFile::create(&path, &[]).unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(error.problem.starts_with("there is no folder"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn an_interrupted_series_ends_as_one_that_was_not(
        rows in prop::collection::vec(prop::array::uniform3(any::<f64>()), 0..40),
        checkpoint in any::<prop::sample::Index>(),
        crash in any::<prop::sample::Index>(),
        half in "[0-9e,.-]{0,20}",
    ) {
        let folder = tempdir().unwrap();
        let names = columns(&["a_m", "b_j"]);
        let whole = folder.path().join("whole.csv");
        let mut series = SeriesFile::create(&whole, &names).unwrap();
        for [time, a, b] in &rows {
            series.append(*time, &[*a, *b]).unwrap();
        }
        let crash = crash.index(rows.len() + 1);
        let checkpoint = checkpoint.index(crash + 1);
        let path = folder.path().join("series.csv");
        let mut series = SeriesFile::create(&path, &names).unwrap();
        let mut kept = series.table.length_bytes();
        for (row, [time, a, b]) in rows[..crash].iter().enumerate() {
            series.append(*time, &[*a, *b]).unwrap();
            if row + 1 == checkpoint {
                kept = series.table.length_bytes();
            }
        }
        drop(series);
        // A possible state of a row that was being written.
        fs::OpenOptions::new().append(true).open(&path).unwrap().write_all(half.as_bytes()).unwrap();
        let mut series = SeriesFile::continue_at(&path, &names, kept).unwrap();
        for [time, a, b] in &rows[checkpoint..] {
            series.append(*time, &[*a, *b]).unwrap();
        }
        prop_assert_eq!(fs::read(&path).unwrap(), fs::read(&whole).unwrap());
        // The numbers are read back unchanged.
        let text = fs::read_to_string(&whole).unwrap();
        for (line, row) in text.lines().skip(1).zip(&rows) {
            for (word, value) in line.split(',').zip(row) {
                let read: f64 = word.parse().unwrap();
                prop_assert!(read.to_bits() == value.to_bits() || (read.is_nan() && value.is_nan()));
            }
        }
    }

    #[test]
    fn interrupted_events_end_as_those_that_were_not(steps in prop::collection::vec(0..9_usize, 0..20), at in any::<prop::sample::Index>()) {
        let folder = tempdir().unwrap();
        let at = at.index(steps.len() + 1);
        let of_step = |(step, count): (usize, &usize)| vec![event(step as u64); *count];
        let write = |name: &str, interrupted: bool| {
            let path = folder.path().join(name);
            let mut events = Table::create(&path, &header(&Event::COLUMNS)).unwrap();
            for (number, step) in steps.iter().enumerate() {
                if interrupted && number == at {
                    let length = events.length_bytes();
                    events.append(&event_lines([event(1000)])).unwrap();
                    events = Table::continue_at(&path, &header(&Event::COLUMNS), length).unwrap();
                }
                events.append(&event_lines(of_step((number, step)))).unwrap();
            }
            fs::read(&path).unwrap()
        };
        prop_assert_eq!(write("a.csv", true), write("b.csv", false));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let error = SeriesFile::create(std::path::Path::new("/dev/full"), &[]).unwrap_err();
    assert_eq!(error.exit_code(), 1);
    assert!(error.problem.starts_with("no space left"), "{error}");
}
