//! Checkpoints: the state of a run in one file that is either complete or refused.
//!
//! The meaning of the state's bytes is known only to the program that writes them. Layout, numbers
//! little endian:
//!
//! | bytes | what |
//! |---|---|
//! | 16 | `dem checkpoint` and a line break as of DOS, which copying as text would change |
//! | 4 | [`FORMAT_VERSION`] |
//! | 4 | length of the next |
//! | ... | program and version that wrote it, UTF-8 |
//! | 8 | length of the next |
//! | ... | the state |
//! | 8 | FNV-1a, 64 bit, of all bytes before |
//!
//! FNV-1a is good enough here: it detects every change of a single byte (each of its steps is
//! reversible), and misses any other damage once in 2^64 times. It takes a nanosecond per byte,
//! less than the disk.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::hash::fnv1a_of_parts;
use dem_io::safe_write::write_file;

/// Version of the layout and of the state in it: increased when either changes. Other versions are
/// refused.
pub const FORMAT_VERSION: u32 = 25;

/// Program and version that writes checkpoints.
const PROGRAM: &str = concat!("dem-run ", env!("CARGO_PKG_VERSION"));

const MAGIC: &[u8; 16] = b"dem checkpoint\r\n";

const START_AGAIN: &str = "take an older checkpoint, or start the run again without --resume";

/// Writes the state of a run, `payload`, to the file `path`, which appears complete or not at all.
pub fn write_checkpoint(path: &Path, payload: &[u8]) -> Result<()> {
    let mut head = MAGIC.to_vec();
    head.extend(FORMAT_VERSION.to_le_bytes());
    head.extend((PROGRAM.len() as u32).to_le_bytes());
    head.extend(PROGRAM.bytes());
    head.extend((payload.len() as u64).to_le_bytes());
    let sum = fnv1a_of_parts(&[&head, payload]);
    write_file(path, |out| {
        out.write_all(&head)?;
        out.write_all(payload)?;
        out.write_all(&sum.to_le_bytes())
    })
}

/// The state that [`write_checkpoint`] wrote to the file `path`; refuses other versions, and
/// truncated or damaged files.
pub fn read_checkpoint(path: &Path) -> Result<Vec<u8>> {
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    let mut bytes = fs::read(path).map_err(|error| {
        within(match error.kind() {
            ErrorKind::NotFound => Diagnostic::input(
                "",
                "there is no such file",
                "check its name and folder; a run writes its first checkpoint only after a while",
            ),
            ErrorKind::IsADirectory => {
                Diagnostic::input("", "this is a folder", "name a file in it")
            }
            _ => Diagnostic::failed("", format!("cannot be read: {error}"), ""),
        })
    })?;
    let payload = payload_of(&bytes).map_err(within)?;
    bytes.truncate(payload.end);
    bytes.drain(..payload.start);
    Ok(bytes)
}

/// The range of the state in a checkpoint.
fn payload_of(bytes: &[u8]) -> Result<std::ops::Range<usize>> {
    let known = bytes.len().min(MAGIC.len());
    if bytes[..known] != MAGIC[..known] || bytes.is_empty() {
        return Err(Diagnostic::input(
            "",
            "this is not a checkpoint",
            "name a file checkpoint.dem that dem-run wrote",
        ));
    }
    let mut rest = Rest {
        bytes,
        at: MAGIC.len(),
    };
    let version = u32::from_le_bytes(rest.number()?);
    let length = u32::from_le_bytes(rest.number()?);
    let program = rest.take(u64::from(length), "the name of the program")?;
    if version != FORMAT_VERSION {
        let program: String = String::from_utf8_lossy(&bytes[program])
            .chars()
            .filter(|letter| !letter.is_control())
            .take(40)
            .collect();
        return Err(Diagnostic::input(
            "",
            format!(
                "'{program}' wrote this checkpoint in format {version}; {PROGRAM} reads format {FORMAT_VERSION}"
            ),
            "resume with that program, or start the run again without --resume",
        ));
    }
    let length = u64::from_le_bytes(rest.number()?);
    let payload = rest.take(length, "the state")?;
    let summed = rest.at;
    let sum = u64::from_le_bytes(rest.number()?);
    if rest.at < bytes.len() {
        let more = bytes.len() - rest.at;
        return Err(Diagnostic::input(
            "",
            format!(
                "damaged: {more} bytes follow the end at byte {}, where there should be none",
                rest.at
            ),
            START_AGAIN,
        ));
    }
    let found = fnv1a_of_parts(&[&bytes[..summed]]);
    if sum != found {
        return Err(Diagnostic::input(
            "",
            format!("damaged: its check sum is {found:016x}, but {sum:016x} was written"),
            START_AGAIN,
        ));
    }
    Ok(payload)
}

/// The bytes not read yet.
struct Rest<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Rest<'_> {
    /// The range of the next `length` bytes, called `what` in messages.
    fn take(&mut self, length: u64, what: &str) -> Result<std::ops::Range<usize>> {
        let end = usize::try_from(length)
            .ok()
            .and_then(|length| self.at.checked_add(length))
            .filter(|end| *end <= self.bytes.len())
            .ok_or_else(|| {
                let left = self.bytes.len().saturating_sub(self.at);
                Diagnostic::input(
                    "",
                    format!(
                        "cut off or damaged: {what} at byte {} should have {length} bytes, but {left} follow",
                        self.at
                    ),
                    START_AGAIN,
                )
            })?;
        let start = std::mem::replace(&mut self.at, end);
        Ok(start..end)
    }

    fn number<const BYTES: usize>(&mut self) -> Result<[u8; BYTES]> {
        let range = self.take(BYTES as u64, "a number")?;
        let mut number = [0; BYTES];
        number.copy_from_slice(&self.bytes[range]);
        Ok(number)
    }
}
