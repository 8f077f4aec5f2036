//! A limit on the memory that the XML of a .vtp file makes its reader use, so that an endless pipe
//! ends at the first bytes that are not a body.

use std::io::{self, BufRead, Read};

use super::decode::DAMAGED;
use super::header::not_vtp;
use crate::diagnostic::Diagnostic;

/// Largest number of bytes before the first element: a declaration, comments.
const BEFORE_FIRST: u64 = 1 << 16;
/// Largest number of bytes of all XML except the values of arrays.
const MARKUP: u64 = 1 << 20;
/// Largest number of bytes of a value as text: more than any program writes.
const PER_VALUE: u64 = 64;

/// An input whose XML may not be longer than that of a body.
pub(super) struct Guarded<'a> {
    input: &'a mut dyn BufRead,
    /// True if the first element has been read.
    has_begun: bool,
    markup_left: u64,
    /// Number of values left in the open array.
    values_left: u64,
    /// True if the following text is that of an array; and if so, true if it is decimal numbers.
    in_values: bool,
    is_decimal: bool,
    /// True if the next byte is between < and >.
    in_tag: bool,
}

impl<'a> Guarded<'a> {
    pub(super) fn new(input: &'a mut dyn BufRead) -> Self {
        Self {
            input,
            has_begun: false,
            markup_left: BEFORE_FIRST,
            values_left: 0,
            in_values: false,
            is_decimal: false,
            in_tag: false,
        }
    }

    /// The input, for the appended data.
    pub(super) fn into_input(self) -> &'a mut dyn BufRead {
        self.input
    }

    /// Records the start of an element: the file is one of VTK.
    pub(super) fn begin(&mut self) {
        if !self.has_begun {
            self.has_begun = true;
            self.markup_left = MARKUP;
        }
    }

    /// Records the start of an array of at most this number of values, as decimal numbers or in
    /// base64.
    pub(super) fn expect_values(&mut self, most: u64, is_decimal: bool) {
        self.values_left = most.saturating_mul(PER_VALUE).saturating_add(BEFORE_FIRST);
        self.is_decimal = is_decimal;
    }

    /// Sets whether the following text is that of the open array.
    pub(super) fn set_in_values(&mut self, in_values: bool) {
        self.in_values = in_values;
        self.in_tag = false;
    }

    fn refusal(&self) -> Diagnostic {
        if !self.has_begun {
            not_vtp()
        } else if self.in_values {
            let problem = "an array has more values than the header says";
            Diagnostic::input("", problem, DAMAGED)
        } else {
            let problem = format!("its XML is longer than {MARKUP} bytes");
            Diagnostic::input("", problem, DAMAGED)
        }
    }
}

/// The first byte before the next element that is not part of a value.
fn foreign(chunk: &[u8], is_decimal: bool) -> Option<u8> {
    let belongs = |byte: u8| {
        byte.is_ascii_whitespace()
            || if is_decimal {
                // Including those of nan and inf.
                b"0123456789+-.eEnaNAifIF".contains(&byte)
            } else {
                byte.is_ascii_alphanumeric() || b"+/=".contains(&byte)
            }
    };
    let mut text = chunk.iter().copied().take_while(|byte| *byte != b'<');
    text.find(|byte| !belongs(*byte))
}

impl Read for Guarded<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(to)?;
        self.consume(read);
        Ok(read)
    }
}

impl BufRead for Guarded<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        let left = if self.in_values {
            self.values_left
        } else {
            self.markup_left
        };
        if left == 0 {
            return Err(io::Error::other(self.refusal()));
        }
        let is_text = self.in_values && !self.in_tag;
        let most = usize::try_from(left).unwrap_or(usize::MAX);
        let chunk = self.input.fill_buf()?;
        let chunk = &chunk[..chunk.len().min(most)];
        let found = is_text.then(|| foreign(chunk, self.is_decimal)).flatten();
        match found {
            None => Ok(chunk),
            Some(byte) => {
                let problem = format!("'{}' is no part of a number", byte.escape_ascii());
                Err(io::Error::other(Diagnostic::input("", problem, DAMAGED)))
            }
        }
    }

    fn consume(&mut self, bytes: usize) {
        if self.in_values {
            // The bytes returned before are still there.
            let chunk = self.input.fill_buf().unwrap_or_default();
            let used = &chunk[..bytes.min(chunk.len())];
            if let Some(last) = used.iter().rfind(|byte| b"<>".contains(byte)) {
                self.in_tag = *last == b'<';
            }
            self.values_left = self.values_left.saturating_sub(bytes as u64);
        } else {
            self.markup_left = self.markup_left.saturating_sub(bytes as u64);
        }
        self.input.consume(bytes);
    }
}
