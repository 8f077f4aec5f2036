//! A CSV table that grows by complete rows while a program runs.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::{explain, write_file};

const PUT_BACK: &str =
    "put back the file that belongs to the checkpoint, or start the run again without --resume";

/// The file of a table. Every row is passed to the system as soon as it is appended, so that a
/// crash of the program loses none.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    file: File,
    length_bytes: u64,
    held: Option<String>,
}

impl Table {
    /// A table with only its `header`, a line without its line break. Replaces an existing one.
    pub fn create(path: &Path, header: &str) -> Result<Self> {
        write_file(path, |out| writeln!(out, "{header}"))?;
        Self::continue_at(path, header, header.len() as u64 + 1)
    }

    /// The table of an interrupted run, truncated to its length at the checkpoint, `length_bytes`;
    /// refuses other columns, a shorter file, and one without a row that ends there (exit code 2).
    pub fn continue_at(path: &Path, header: &str, length_bytes: u64) -> Result<Self> {
        let file = OpenOptions::new().read(true).write(true).open(path);
        let file = file.map_err(|error| match error.kind() {
            ErrorKind::NotFound => Diagnostic::input(
                path.display().to_string(),
                "there is no such file, which was there when the checkpoint was written",
                PUT_BACK,
            ),
            _ => explain(path, &error),
        })?;
        let mut table = Self {
            path: path.to_owned(),
            file,
            length_bytes,
            held: None,
        };
        table.check(header)?;
        let cut = table.file.set_len(length_bytes);
        cut.and_then(|()| table.file.seek(SeekFrom::End(0)))
            .map_err(|error| explain(path, &error))?;
        Ok(table)
    }

    /// Checks that the file has this header and a row that ends at the expected position.
    fn check(&mut self, header: &str) -> Result<()> {
        let refused =
            |problem: String| Diagnostic::input(self.path.display().to_string(), problem, PUT_BACK);
        let unreadable = |error| explain(&self.path, &error);
        let length = self.file.metadata().map_err(unreadable)?.len();
        if length < self.length_bytes {
            return Err(refused(format!(
                "has {length} bytes, but had {} when the checkpoint was written",
                self.length_bytes
            )));
        }
        let mut first = String::new();
        let longest = header.len() as u64 + 1;
        let read = BufReader::new((&self.file).take(longest)).read_line(&mut first);
        if read.is_err() || first.strip_suffix('\n') != Some(header) {
            return Err(refused(format!(
                "its first line is not the one of this scene, '{header}'"
            )));
        }
        let mut last = [0];
        let end = self.length_bytes.max(longest) - 1;
        self.file
            .seek(SeekFrom::Start(end))
            .and_then(|_| self.file.read_exact(&mut last))
            .map_err(unreadable)?;
        if self.length_bytes < longest || last != *b"\n" {
            return Err(refused(format!(
                "no row ends at byte {}, where one ended when the checkpoint was written",
                self.length_bytes
            )));
        }
        Ok(())
    }

    /// Appends complete rows, each with its line break, unless they are [held](Table::hold). If
    /// that fails, the file keeps its previous rows.
    pub fn append(&mut self, rows: &str) -> Result<()> {
        if let Some(held) = &mut self.held {
            held.push_str(rows);
            return Ok(());
        }
        match self.file.write_all(rows.as_bytes()) {
            Ok(()) => {
                self.length_bytes += rows.len() as u64;
                Ok(())
            }
            Err(error) => {
                // If this fails as well, the last row stays truncated; the cause is reported in
                // either case.
                let _ = self.file.set_len(self.length_bytes);
                let _ = self.file.seek(SeekFrom::End(0));
                Err(explain(&self.path, &error))
            }
        }
    }

    /// Keeps the rows from now on out of the file: only a run that is continued shows them.
    pub fn hold(&mut self) {
        self.held.get_or_insert_default();
    }

    /// The rows that have been held.
    pub fn held(&self) -> &str {
        self.held.as_deref().unwrap_or_default()
    }

    /// Name of the file in its folder.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// Length of the file, stored in a checkpoint, at which it is continued.
    pub fn length_bytes(&self) -> u64 {
        self.length_bytes
    }

    /// Waits until all rows are on the disk, safe from a power failure. To be called before writing
    /// a checkpoint that relies on them.
    pub fn sync(&self) -> Result<()> {
        self.file
            .sync_data()
            .map_err(|error| explain(&self.path, &error))
    }
}

/// A text in a form that is valid between two commas: quoted if necessary (RFC 4180). Line breaks
/// become blanks, so that a row is a line.
pub(super) fn field(text: &str) -> String {
    let line = text.replace(['\n', '\r'], " ");
    if line.contains([',', '"']) {
        format!("\"{}\"", line.replace('"', "\"\""))
    } else {
        line
    }
}

/// The texts between the commas of a line, as written by [`field`].
pub(super) fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                push(&mut fields, '"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            other => push(&mut fields, other),
        }
    }
    fields
}

fn push(fields: &mut [String], letter: char) {
    if let Some(last) = fields.last_mut() {
        last.push(letter);
    }
}
