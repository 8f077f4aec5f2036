//! Any bytes through every reader of bodies. Used by the tests here and by the fuzz target
//! `read_body`.

use dem_io::body::{csv, lammps, txt, vtp};
use dem_io::{Body, Result};

/// For any `data`, each reader returns a valid body or an error. A body that was read survives
/// writing and reading again.
pub(crate) fn every_reader(data: &[u8]) {
    check(vtp::read(&mut &data[..]));
    check(lammps::read(&mut &data[..]));
    // Formats of two files: the second begins after an empty line.
    let split = data
        .windows(2)
        .position(|pair| pair == b"\n\n")
        .map_or(data.len(), |end| end + 2);
    let (particles, bonds) = data.split_at(split);
    check(csv::read(&mut &particles[..], &mut &bonds[..]));
    check(txt::read(&mut &particles[..], &mut &bonds[..]));
}

fn check(read: Result<Body>) {
    match read {
        Err(error) => assert!(!error.problem.is_empty()),
        Ok(body) => {
            body.check().expect("what is read keeps the rules");
            let mut bytes = Vec::new();
            vtp::write(&body, &mut bytes).expect("memory takes everything");
            assert_eq!(
                vtp::read(&mut bytes.as_slice()).expect("what is written can be read"),
                body
            );
        }
    }
}
