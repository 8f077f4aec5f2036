//! How this program is started once more.

use std::path::PathBuf;
use std::sync::OnceLock;

static OWN_COMMAND: OnceLock<(PathBuf, Vec<String>)> = OnceLock::new();

/// Says how this program is started where the file of the process is an interpreter: that file and
/// its first arguments. Only the first call counts.
pub fn set_own_command(file: PathBuf, first_arguments: Vec<String>) {
    OWN_COMMAND.get_or_init(|| (file, first_arguments));
}

/// The file that starts this program once more, and the arguments before its own: the file of the
/// process without any, unless [`set_own_command`] says others.
pub fn own_command() -> std::io::Result<(PathBuf, Vec<String>)> {
    match OWN_COMMAND.get() {
        Some(command) => Ok(command.clone()),
        None => Ok((std::env::current_exe()?, Vec::new())),
    }
}
