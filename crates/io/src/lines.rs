//! Lines and words of text files, with messages that name the line.

use std::io::{BufRead, Read};

use crate::diagnostic::{Diagnostic, Result};

/// Bytes of the longest line that is read; no table has one nearly as long.
const LONGEST_LINE: u64 = 1 << 20;

/// The lines of a text file, one at a time.
pub struct Lines<'a> {
    input: &'a mut dyn BufRead,
    bytes: Vec<u8>,
    number: u64,
}

impl<'a> Lines<'a> {
    /// The remaining lines of `input`.
    pub fn new(input: &'a mut dyn BufRead) -> Self {
        Self {
            input,
            bytes: Vec::new(),
            number: 0,
        }
    }

    /// The next line without the white space around it, and its number, counted from 1. Refuses
    /// bytes that are not text, and a line without its line break, as the file is cut off.
    pub fn next_line(&mut self) -> Result<Option<(u64, &str)>> {
        if self.read_line()? && !self.bytes.ends_with(b"\n") {
            return Err(on_line(
                self.number,
                Diagnostic::input(
                    "",
                    "the file ends within this line",
                    "it may be cut off: make it again, or end its last line with a line break if nothing is missing",
                ),
            ));
        }
        self.line()
    }

    /// As [`Self::next_line`], for a file that may still be written: an unfinished last line is
    /// none.
    pub fn next_whole_line(&mut self) -> Result<Option<(u64, &str)>> {
        if self.read_line()? && !self.bytes.ends_with(b"\n") {
            return Ok(None);
        }
        self.line()
    }

    /// Reads a line. False: there is none.
    fn read_line(&mut self) -> Result<bool> {
        self.bytes.clear();
        let mut some = Read::take(&mut *self.input, LONGEST_LINE);
        let read = some.read_until(b'\n', &mut self.bytes);
        if read.map_err(|error| Diagnostic::failed("", format!("cannot be read: {error}"), ""))?
            == 0
        {
            return Ok(false);
        }
        self.number += 1;
        if self.bytes.len() as u64 == LONGEST_LINE {
            let problem = format!("this line is longer than {LONGEST_LINE} bytes");
            let error = Diagnostic::input("", problem, "write one particle or bond per line");
            return Err(on_line(self.number, error));
        }
        Ok(true)
    }

    /// The line that was read last. None: there was none.
    fn line(&self) -> Result<Option<(u64, &str)>> {
        if self.bytes.is_empty() {
            return Ok(None);
        }
        // Spreadsheets put this mark (BOM) at the beginning of a text.
        let start = if self.number == 1 && self.bytes.starts_with(b"\xEF\xBB\xBF") {
            3
        } else {
            0
        };
        match std::str::from_utf8(&self.bytes[start..]) {
            Ok(text) => Ok(Some((self.number, text.trim()))),
            Err(_) => Err(on_line(
                self.number,
                Diagnostic::input("", "this is not text", "save the file as plain text"),
            )),
        }
    }
}

/// The message with a line as its place.
pub fn on_line(number: u64, error: Diagnostic) -> Diagnostic {
    error.within(&format!("line {number}"))
}

/// The number in `word`; `what` is its name in messages.
pub fn float(word: Option<&str>, what: &str) -> Result<f64> {
    let word = word.ok_or_else(|| missing(what))?;
    word.parse()
        .map_err(|_| not_a_number(word, what, "a number"))
}

pub(crate) fn missing(what: &str) -> Diagnostic {
    Diagnostic::input("", format!("{what} is missing"), "the line is incomplete")
}

pub(crate) fn not_a_number(word: &str, what: &str, wanted: &str) -> Diagnostic {
    let problem = format!("{what} is '{}', not {wanted}", word.escape_debug());
    Diagnostic::input("", problem, "numbers have a decimal point and no unit")
}
