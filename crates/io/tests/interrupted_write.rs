//! The behaviour of an interrupted program.

use std::process::Command;

use dem_io::safe_write::{PendingFile, remove_unfinished};

/// Set if the test runs alone in a process.
const ALONE: &str = "DEM_IO_TEST_ALONE";

/// Runs in a process of its own, since it removes every unfinished file of the process.
#[test]
fn an_interrupted_program_leaves_no_half_file() {
    if std::env::var_os(ALONE).is_some() {
        return interrupt();
    }
    let name = "interrupted_write::an_interrupted_program_leaves_no_half_file";
    let alone = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", name])
        .env(ALONE, "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&alone.stdout);
    assert!(
        alone.status.success() && said.contains("1 passed"),
        "{said}"
    );
}

fn interrupt() {
    let folder = tempfile::tempdir().unwrap();
    let pending = PendingFile::write(&folder.path().join("cake.vtp"), |out| {
        out.write_all(b"half")
    })
    .unwrap();
    assert_eq!(folder.path().read_dir().unwrap().count(), 1);
    remove_unfinished();
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
    assert_eq!(pending.publish().unwrap_err().exit_code(), 1);
}
