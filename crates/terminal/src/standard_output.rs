//! Standard output and standard error: text without characters that control a terminal, JSON,
//! bytes.

use std::io::{self, Write};

use serde::Serialize;

use crate::colour::{Colour, on_standard_error, on_standard_output};
use dem_io::safe_write::{write_json_text, write_standard_bytes};
use dem_io::text::visible_lines;
use dem_io::{Diagnostic, Result};

/// Writes lines of text to standard output, without characters that control a terminal
/// ([`dem_io::text`]). A reader that closes the pipe early is not an error.
pub fn write_standard_output(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    write_standard_bytes(|out| {
        let mut lines = VisibleLines {
            out,
            last: Vec::new(),
        };
        write(&mut lines)?;
        lines.flush()
    })
}

/// Writes lines of text to standard output as [`write_standard_output`] does. The first word of a
/// line has the colour that `colour` gives for the line, where colours are shown.
pub fn write_standard_lines(text: &str, colour: impl Fn(&str) -> Option<Colour>) -> Result<()> {
    write_standard_bytes(|out| {
        for line in visible_lines(text).lines() {
            let (word, rest) = line.split_at(line.find(' ').unwrap_or(line.len()));
            match colour(line) {
                Some(colour) => writeln!(out, "{}{rest}", on_standard_output(word, colour))?,
                None => writeln!(out, "{line}")?,
            }
        }
        Ok(())
    })
}

/// Passes complete lines on, without characters that control a terminal.
struct VisibleLines<'a> {
    out: &'a mut dyn Write,
    last: Vec<u8>,
}

impl Write for VisibleLines<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.last.extend_from_slice(bytes);
        if bytes.contains(&b'\n') {
            let end = self.last.iter().rposition(|byte| *byte == b'\n');
            let rest = self.last.split_off(end.map_or(0, |at| at + 1));
            let whole = std::mem::replace(&mut self.last, rest);
            let text = String::from_utf8_lossy(&whole);
            self.out.write_all(visible_lines(&text).as_bytes())?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let text = String::from_utf8_lossy(&self.last);
        self.out.write_all(visible_lines(&text).as_bytes())?;
        self.last.clear();
        self.out.flush()
    }
}

/// Writes `value` to standard output as indented JSON. Numbers that are not finite become `null`.
pub fn write_standard_json(value: &impl Serialize) -> Result<()> {
    write_standard_output(|out| write_json_text(out, value))
}

/// Prints an error on standard error. If that is full or closed, there is nowhere to report it.
pub fn write_standard_error(error: &Diagnostic) {
    let word = on_standard_error("error:", Colour::Red);
    let _ = io::stderr().write_all(format!("{word} {error}\n").as_bytes());
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn lines_pass_without_what_a_terminal_obeys_however_they_are_cut() {
        let text = "a\u{1b}[2J é\u{202e}x\nsecond\r\n\nlast µ".as_bytes();
        for at in 0..text.len() {
            let mut shown = Vec::new();
            let mut lines = VisibleLines {
                out: &mut shown,
                last: Vec::new(),
            };
            lines.write_all(&text[..at]).unwrap();
            lines.write_all(&text[at..]).unwrap();
            lines.flush().unwrap();
            let wanted = "a\\u{1b}[2J é\\u{202e}x\nsecond\\u{d}\n\nlast µ";
            assert_eq!(String::from_utf8(shown).unwrap(), wanted, "cut at {at}");
        }
    }
}
