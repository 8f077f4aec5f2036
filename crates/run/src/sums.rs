//! Check sums of the tables and frames of a run, stored with its checkpoint: a resumed run goes on
//! only from files whose bytes are those that were there.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use dem_io::hash::Fnv1a;
use dem_io::safe_write::explain;
use dem_io::{Diagnostic, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Length and hash of the first bytes of a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct Sum {
    bytes: u64,
    hash: u64,
}

/// Check sums of files in a results folder, by their names in it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Sums {
    files: BTreeMap<String, Sum>,
}

impl Sums {
    /// Whether a file has a sum already. A frame, which does not change, is summed once.
    pub(super) fn has(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// Sums the first `bytes` of a file, of which those summed before have not changed; all of it
    /// if no number is given.
    pub(super) fn update(&mut self, folder: &Path, name: &str, bytes: Option<u64>) -> Result<()> {
        let path = folder.join(name);
        let known = self.files.get(name).copied();
        let known = known.filter(|sum| bytes.is_none_or(|bytes| sum.bytes <= bytes));
        let start = known.unwrap_or(Sum {
            bytes: 0,
            hash: Fnv1a::default().0,
        });
        let sum = extended(&path, start, bytes).map_err(|error| explain(&path, &error))?;
        self.files.insert(name.to_owned(), sum);
        Ok(())
    }

    /// Refuses files whose first bytes are not those that were summed.
    pub(super) fn check(&self, folder: &Path) -> Result<()> {
        let is_changed = |(name, sum): &(&String, &Sum)| {
            let none = Sum {
                bytes: 0,
                hash: Fnv1a::default().0,
            };
            // A file that is missing or shorter is named where it is opened.
            let found = extended(&folder.join(name), none, Some(sum.bytes)).ok();
            found.is_some_and(|found| found.bytes == sum.bytes && found.hash != sum.hash)
        };
        let files: Vec<(&String, &Sum)> = self.files.iter().collect();
        let changed = files.into_par_iter().filter(is_changed).min();
        let Some((name, sum)) = changed.map(|(name, sum)| (name, sum.bytes)) else {
            return Ok(());
        };
        Err(Diagnostic::input(
            folder.join(name).display().to_string(),
            format!(
                "its first {sum} bytes are not those that were there when the checkpoint was written: their check sum differs"
            ),
            "put back the file that belongs to the checkpoint, or start the run again without --resume",
        ))
    }
}

/// A sum extended to the first `bytes` of a file, or to its end.
fn extended(path: &Path, sum: Sum, bytes: Option<u64>) -> io::Result<Sum> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(sum.bytes))?;
    let mut hash = Fnv1a(sum.hash);
    let most = bytes.map_or(u64::MAX, |bytes| bytes.saturating_sub(sum.bytes));
    let more = io::copy(&mut file.take(most), &mut hash)?;
    Ok(Sum {
        bytes: sum.bytes + more,
        hash: hash.0,
    })
}
