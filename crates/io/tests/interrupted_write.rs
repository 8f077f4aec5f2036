//! What an interrupted program does: alone in its process, since it removes every unfinished file.
#![allow(clippy::unwrap_used)]

use dem_io::safe_write::{PendingFile, remove_unfinished};

#[test]
fn an_interrupted_program_leaves_no_half_file() {
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
