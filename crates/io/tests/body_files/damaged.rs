//! Truncated, corrupted and made-up files.

use dem_io::Body;
use dem_io::body::{csv, lammps, txt, vtp};
use proptest::prelude::*;

use super::bodies::triangle;
use super::every_reader::every_reader;

fn vtp_bytes() -> Vec<u8> {
    let mut bytes = Vec::new();
    vtp::write(&triangle(), &mut bytes).unwrap();
    bytes
}

fn lammps_bytes() -> Vec<u8> {
    let mut bytes = Vec::new();
    lammps::write(&triangle(), &mut bytes).unwrap();
    bytes
}

/// One small file of each format. Pairs are one after the other, with an empty line between.
fn corpus() -> Vec<Vec<u8>> {
    let (mut tables, mut texts) = (Vec::new(), Vec::new());
    csv::write_particles(&triangle(), &mut tables).unwrap();
    tables.push(b'\n');
    csv::write_bonds(&triangle(), &mut tables).unwrap();
    txt::write_particles(&triangle(), &mut texts).unwrap();
    texts.push(b'\n');
    txt::write_bonds(&triangle(), &mut texts).unwrap();
    vec![
        vtp_bytes(),
        lammps_bytes(),
        tables,
        texts,
        include_bytes!("vtk-ascii.vtp").to_vec(),
        include_bytes!("vtk-base64.vtp").to_vec(),
        include_bytes!("vtk-appended-base64.vtp").to_vec(),
        include_bytes!("vtk-appended-raw.vtp").to_vec(),
        include_bytes!("vtk-with-vertices.vtp").to_vec(),
    ]
}

#[test]
fn a_vtp_cut_off_anywhere_is_refused() {
    let files = corpus();
    for bytes in files.iter().filter(|bytes| bytes.starts_with(b"<")) {
        let complete = bytes.trim_ascii_end().len();
        assert!(vtp::read(&mut &bytes[..complete]).is_ok());
        for end in 0..complete {
            let error = vtp::read(&mut &bytes[..end]).expect_err("cut off");
            assert_eq!(error.exit_code(), 2, "{end}: {error}");
            assert!(!error.remedy.is_empty(), "{end}: {error}");
        }
    }
}

#[test]
fn other_files_cut_off_anywhere_never_break_the_reader() {
    for bytes in corpus() {
        for end in 0..bytes.len() {
            every_reader(&bytes[..end]);
        }
    }
    // A truncated LAMMPS file is detected by the counts in its header; within its last number by
    // the missing line break.
    let bytes = lammps_bytes();
    for end in 0..bytes.len() {
        assert!(lammps::read(&mut &bytes[..end]).is_err(), "{end}");
    }
}

type Write = fn(&Body, &mut dyn std::io::Write) -> std::io::Result<()>;
type Read = fn(&mut dyn std::io::BufRead, &mut dyn std::io::BufRead) -> dem_io::Result<Body>;

/// Tables do not give their length. A truncation is detected within a line, or where a bond names a
/// missing particle.
#[test]
fn tables_cut_off_are_refused_unless_whole_bonds_are_missing() {
    let kinds: [(Write, Write, Read); 2] = [
        (csv::write_particles, csv::write_bonds, csv::read),
        (txt::write_particles, txt::write_bonds, txt::read),
    ];
    for (write_particles, write_bonds, read) in kinds {
        let (mut particles, mut bonds) = (Vec::new(), Vec::new());
        write_particles(&triangle(), &mut particles).unwrap();
        write_bonds(&triangle(), &mut bonds).unwrap();
        assert!(read(&mut particles.as_slice(), &mut bonds.as_slice()).is_ok());
        for end in 0..particles.len() {
            let error = read(&mut &particles[..end], &mut bonds.as_slice()).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{end}: {error}");
        }
        for end in (1..bonds.len()).filter(|end| bonds[end - 1] != b'\n') {
            let error = read(&mut particles.as_slice(), &mut &bonds[..end]).unwrap_err();
            let place = format!(
                "bonds: line {}",
                bonds[..end].split(|b| *b == b'\n').count()
            );
            assert_eq!(
                error.to_string(),
                format!(
                    "{place}: the file ends within this line; it may be cut off: make it again, or end its last line \
                     with a line break if nothing is missing"
                )
            );
        }
    }
}

#[test]
fn a_later_version_is_refused_with_the_remedy() {
    let bytes = vtp_bytes();
    let version = b"Name=\"body_format_version\" NumberOfTuples=\"1\" format=\"ascii\">1<";
    let at = bytes
        .windows(version.len())
        .position(|window| window == version)
        .unwrap()
        + version.len()
        - 2;
    let mut later = bytes;
    later[at] = b'2';
    let error = vtp::read(&mut later.as_slice()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "array 'body_format_version': the body has format version 2; this program knows 1; \
         use a newer program, or write the body with an older one"
    );
    later[at] = b'x';
    assert!(vtp::read(&mut later.as_slice()).is_err());
}

/// A header that gives a larger size than the file must not make the reader allocate the memory.
#[test]
fn enormous_counts_are_refused() {
    let bytes = vtp_bytes();
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let header = &text[..text.find("<AppendedData").unwrap()];
    let huge = header.replace(
        "NumberOfPoints=\"3\"",
        "NumberOfPoints=\"18446744073709551615\"",
    );
    for length in [u64::MAX, u64::MAX - 7, 1 << 62, 1 << 40] {
        let mut file = huge.clone().into_bytes();
        file.extend_from_slice(b"<AppendedData encoding=\"raw\">_");
        file.extend_from_slice(&length.to_le_bytes());
        file.extend_from_slice(&[0; 100]);
        assert_eq!(vtp::read(&mut file.as_slice()).unwrap_err().exit_code(), 2);
    }
    let data = "x\n\n18446744073709551615 atoms\n\nAtoms\n\n1 1 1 1 1 0 0 0\n";
    assert!(
        lammps::read(&mut data.as_bytes())
            .unwrap_err()
            .problem
            .contains("head of the file")
    );
}

/// One change to a file.
#[derive(Debug, Clone)]
enum Change {
    Set(usize, u8),
    Insert(usize, Vec<u8>),
    Remove(usize, usize),
    Repeat(usize, usize),
}

fn any_change() -> impl Strategy<Value = Change> {
    let words: Vec<&[u8]> = vec![
        b"nan",
        b"-1",
        b"1e999",
        b"18446744073709551616",
        b"/>",
        b"<Piece",
        b"\"",
        b"</DataArray>",
        b"_",
        b"\n\n",
        b",,",
        b"=",
    ];
    let piece = prop_oneof![
        prop::sample::select(words).prop_map(<[u8]>::to_vec),
        prop::collection::vec(any::<u8>(), 1..9),
    ];
    prop_oneof![
        (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Change::Set(at, byte)),
        (any::<usize>(), piece).prop_map(|(at, bytes)| Change::Insert(at, bytes)),
        (any::<usize>(), 1_usize..64).prop_map(|(at, length)| Change::Remove(at, length)),
        (any::<usize>(), 1_usize..64).prop_map(|(at, length)| Change::Repeat(at, length)),
    ]
}

fn apply(change: &Change, data: &mut Vec<u8>) {
    let size = data.len() + 1;
    let range = |at: usize, length: usize| at % size..(at % size + length).min(size - 1);
    match change {
        Change::Set(at, byte) => {
            if let Some(place) = data.get_mut(at % size) {
                *place = *byte;
            }
        }
        Change::Insert(at, bytes) => drop(data.splice(at % size..at % size, bytes.iter().copied())),
        Change::Remove(at, length) => drop(data.drain(range(*at, *length))),
        Change::Repeat(at, length) => {
            let again = data[range(*at, *length)].to_vec();
            drop(data.splice(at % size..at % size, again));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    /// The same as the fuzz target, with a fixed number of tries.
    #[test]
    fn changed_files_never_break_a_reader(
        file in 0_usize..9,
        changes in prop::collection::vec(any_change(), 1..6),
    ) {
        let mut data = corpus().swap_remove(file);
        for change in &changes {
            apply(change, &mut data);
        }
        every_reader(&data);
    }

    #[test]
    fn any_bytes_never_break_a_reader(data in prop::collection::vec(any::<u8>(), 0..400)) {
        every_reader(&data);
    }
}
