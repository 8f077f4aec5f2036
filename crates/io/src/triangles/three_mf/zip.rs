//! The files in a zip archive that stays in memory: stored or deflated, also with the sizes of
//! ZIP64, which some programs always write. Our own code, on flate2: the crate `zip` needs five
//! more, for encryption above all.

use crate::diagnostic::{Diagnostic, Result};
use crate::stl::REMEDY_AGAIN;
use flate2::read::DeflateDecoder;
use std::io::Read;

/// Largest number of bytes of an unpacked file.
const MOST_BYTES: u64 = 1 << 30;

const END: &[u8] = b"PK\x05\x06";
const END_64: &[u8] = b"PK\x06\x06";
const LOCATOR_64: &[u8] = b"PK\x06\x07";
const ENTRY: &[u8] = b"PK\x01\x02";
const LOCAL: &[u8] = b"PK\x03\x04";
/// Bytes of the records before their names.
const END_BYTES: usize = 22;
const LOCATOR_BYTES: usize = 20;
const ENTRY_BYTES: usize = 46;
const LOCAL_BYTES: usize = 30;
/// In place of a number that stands in the ZIP64 field.
const IN_64: u64 = 0xffff_ffff;

/// An archive.
pub(super) struct Archive<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry>,
}

/// A packed file.
struct Entry {
    name: String,
    is_encrypted: bool,
    /// 0: stored, 8: deflated.
    method: u16,
    checksum: u32,
    packed_bytes: u64,
    bytes: u64,
    /// Where its local header begins.
    begins: u64,
}

/// True if the bytes begin as a zip archive does.
pub(in super::super) fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(LOCAL) || bytes.starts_with(END)
}

impl<'a> Archive<'a> {
    /// The archive in `bytes`.
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self> {
        let entries = entries(bytes).ok_or_else(|| {
            let problem = "truncated or damaged: the list of its files is missing";
            Diagnostic::input("", problem, REMEDY_AGAIN)
        })?;
        Ok(Self { bytes, entries })
    }

    /// The names of the files, with `/` between folders.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// The unpacked file of this name, upper or lower case. None: there is none.
    pub(super) fn file(&self, name: &str) -> Option<Result<Vec<u8>>> {
        let is_it = |entry: &&Entry| entry.name.eq_ignore_ascii_case(name);
        let entry = self.entries.iter().find(is_it)?;
        Some(
            self.unpack(entry)
                .map_err(|problem| Diagnostic::input(entry.name.clone(), problem, REMEDY_AGAIN)),
        )
    }

    fn unpack(&self, entry: &Entry) -> std::result::Result<Vec<u8>, String> {
        if entry.is_encrypted {
            return Err("it is encrypted".to_owned());
        }
        if entry.bytes > MOST_BYTES {
            return Err(format!("{} bytes are too many to read", entry.bytes));
        }
        let packed = self.packed(entry).ok_or("truncated: the file ends in it")?;
        let mut bytes = Vec::new();
        let unpacked = match entry.method {
            0 => (&mut &*packed)
                .take(entry.bytes + 1)
                .read_to_end(&mut bytes),
            8 => DeflateDecoder::new(packed)
                .take(entry.bytes + 1)
                .read_to_end(&mut bytes),
            other => return Err(format!("it is packed by method {other}, which is not read")),
        };
        unpacked.map_err(|error| format!("damaged: {error}"))?;
        let mut sum = flate2::Crc::new();
        sum.update(&bytes);
        if bytes.len() as u64 != entry.bytes || sum.sum() != entry.checksum {
            return Err("damaged: it is not what was packed".to_owned());
        }
        Ok(bytes)
    }

    fn packed(&self, entry: &Entry) -> Option<&'a [u8]> {
        let local = self.bytes.get(usize::try_from(entry.begins).ok()?..)?;
        if !local.starts_with(LOCAL) {
            return None;
        }
        let names = usize::from(number_16(local, 26)?) + usize::from(number_16(local, 28)?);
        let packed = local.get(LOCAL_BYTES + names..)?;
        packed.get(..usize::try_from(entry.packed_bytes).ok()?)
    }
}

/// The files of the archive's list. None: it has no whole list.
fn entries(bytes: &[u8]) -> Option<Vec<Entry>> {
    let longest_comment = usize::from(u16::MAX);
    let last = bytes.len().checked_sub(END_BYTES)?;
    let mut ends = (last.saturating_sub(longest_comment)..=last).rev();
    let end = ends.find(|at| bytes[*at..].starts_with(END))?;
    let mut count = u64::from(number_16(bytes, end + 10)?);
    let mut begins = number_32(bytes, end + 16)?;
    let locator = end.checked_sub(LOCATOR_BYTES);
    if let Some(locator) = locator.filter(|at| bytes[*at..].starts_with(LOCATOR_64)) {
        let end_64 = usize::try_from(number_64(bytes, locator + 8)?).ok()?;
        if !bytes.get(end_64..)?.starts_with(END_64) {
            return None;
        }
        count = number_64(bytes, end_64.checked_add(32)?)?;
        begins = number_64(bytes, end_64.checked_add(48)?)?;
    }
    let mut rest = bytes.get(usize::try_from(begins).ok()?..)?;
    let mut entries = Vec::new();
    for _ in 0..count {
        let (entry, after) = entry(rest)?;
        entries.push(entry);
        rest = after;
    }
    Some(entries)
}

/// The first entry of a list, and the bytes after it.
fn entry(list: &[u8]) -> Option<(Entry, &[u8])> {
    if !list.starts_with(ENTRY) {
        return None;
    }
    let lengths = [28, 30, 32].map(|at| number_16(list, at).map(usize::from));
    let [Some(name), Some(extra), Some(comment)] = lengths else {
        return None;
    };
    let (text, rest) = list.get(ENTRY_BYTES..)?.split_at_checked(name)?;
    let (extra, rest) = rest.split_at_checked(extra)?;
    let mut sizes = [24, 20, 42].map(|at| number_32(list, at));
    let mut wide = field_64(extra);
    for size in &mut sizes {
        if *size == Some(IN_64) {
            *size = number_64(wide, 0);
            wide = wide.get(8..).unwrap_or_default();
        }
    }
    let entry = Entry {
        name: String::from_utf8_lossy(text).replace('\\', "/"),
        is_encrypted: number_16(list, 8)? & 1 == 1,
        method: number_16(list, 10)?,
        checksum: u32::try_from(number_32(list, 16)?).ok()?,
        bytes: sizes[0]?,
        packed_bytes: sizes[1]?,
        begins: sizes[2]?,
    };
    Some((entry, rest.get(comment..)?))
}

/// The ZIP64 field among the extra fields of an entry; empty if there is none.
fn field_64(mut extra: &[u8]) -> &[u8] {
    while let (Some(kind), Some(length)) = (number_16(extra, 0), number_16(extra, 2)) {
        let Some((field, rest)) = extra[4..].split_at_checked(usize::from(length)) else {
            break;
        };
        if kind == 1 {
            return field;
        }
        extra = rest;
    }
    &[]
}

fn number_16(bytes: &[u8], at: usize) -> Option<u16> {
    bytes
        .get(at..)?
        .first_chunk()
        .map(|b| u16::from_le_bytes(*b))
}

fn number_32(bytes: &[u8], at: usize) -> Option<u64> {
    let number = bytes.get(at..)?.first_chunk()?;
    Some(u64::from(u32::from_le_bytes(*number)))
}

fn number_64(bytes: &[u8], at: usize) -> Option<u64> {
    bytes
        .get(at..)?
        .first_chunk()
        .map(|b| u64::from_le_bytes(*b))
}
