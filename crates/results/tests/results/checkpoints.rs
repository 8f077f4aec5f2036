//! Checkpoints are restored bit by bit or refused.

use std::fs;

use dem_io::{Diagnostic, Result};
use dem_results::checkpoint::{FORMAT_VERSION, read_checkpoint, write_checkpoint};
use proptest::prelude::*;
use tempfile::tempdir;

fn bytes_of(payload: &[u8]) -> Vec<u8> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("checkpoint.dem");
    write_checkpoint(&path, payload).unwrap();
    fs::read(&path).unwrap()
}

fn read_bytes(bytes: &[u8]) -> Result<Vec<u8>> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("checkpoint.dem");
    fs::write(&path, bytes).unwrap();
    read_checkpoint(&path)
}

#[track_caller]
fn refusal(bytes: &[u8]) -> Diagnostic {
    let error = read_bytes(bytes).expect_err("a refusal");
    assert_eq!(error.exit_code(), 2);
    assert!(error.place.ends_with("checkpoint.dem"), "{error}");
    assert!(!error.remedy.is_empty(), "{error}");
    error
}

#[test]
fn each_kind_of_bad_file_has_its_message() {
    let good = bytes_of(b"state");
    assert_eq!(read_bytes(&good).unwrap(), b"state");
    for foreign in [
        &b""[..],
        b"solid part",
        b"dem checkpoint\n\n and text that was converted",
    ] {
        assert_eq!(refusal(foreign).problem, "this is not a checkpoint");
    }
    let cut = refusal(&good[..good.len() - 9]);
    assert!(cut.problem.starts_with("cut off or damaged"), "{cut}");
    let long = refusal(&[good.as_slice(), b"x"].concat());
    assert!(long.problem.contains("1 bytes follow"), "{long}");
    let mut turned = good.clone();
    let state = good.len() - 9;
    turned[state] ^= 1;
    let turned = refusal(&turned);
    assert!(turned.problem.contains("check sum"), "{turned}");
    let mut newer = good;
    newer[16] = FORMAT_VERSION as u8 + 1;
    let newer = refusal(&newer);
    let named = format!("format {}", FORMAT_VERSION + 1);
    assert!(newer.problem.contains(&named), "{newer}");
    assert!(newer.problem.contains("'dem-run "), "{newer}");
}

#[test]
fn no_file_and_no_folder() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("checkpoint.dem");
    let error = read_checkpoint(&path).unwrap_err();
    assert_eq!(error.problem, "there is no such file");
    assert_eq!(error.exit_code(), 2);
    let error = read_checkpoint(folder.path()).unwrap_err();
    assert_eq!(error.problem, "this is a folder");
    let error = write_checkpoint(&folder.path().join("missing/checkpoint.dem"), b"").unwrap_err();
    assert_eq!(error.exit_code(), 1);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read(payload in prop::collection::vec(any::<u8>(), 0..2000)) {
        prop_assert_eq!(read_bytes(&bytes_of(&payload)).unwrap(), payload);
    }

    #[test]
    fn a_file_cut_off_anywhere_is_refused(payload in prop::collection::vec(any::<u8>(), 0..100), end in any::<prop::sample::Index>()) {
        let bytes = bytes_of(&payload);
        refusal(&bytes[..end.index(bytes.len())]);
    }

    #[test]
    fn any_bit_turned_is_noticed(payload in prop::collection::vec(any::<u8>(), 0..100), bit in any::<prop::sample::Index>()) {
        let mut bytes = bytes_of(&payload);
        let bit = bit.index(8 * bytes.len());
        bytes[bit / 8] ^= 1 << (bit % 8);
        refusal(&bytes);
    }

    #[test]
    fn any_bytes_after_the_magic_are_refused(rest in prop::collection::vec(any::<u8>(), 0..200)) {
        refusal(&[&b"dem checkpoint\r\n"[..], &rest].concat());
    }
}
