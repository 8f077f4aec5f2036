//! Endless pipes: the reader stops at the first bytes that are not a body, and uses little memory.

use std::io::{self, BufRead, Read};

use dem_io::body::vtp;

/// Largest number of bytes that may be read of an input that is not a body.
const MOST: usize = 12 << 20;

/// A beginning, and then the same bytes endlessly repeated.
struct Endless<'a> {
    beginning: &'a [u8],
    again: Vec<u8>,
    at: usize,
    given: usize,
}

impl<'a> Endless<'a> {
    fn new(beginning: &'a [u8], pattern: &[u8]) -> Self {
        Self {
            beginning,
            again: pattern.repeat(1 << 12),
            at: 0,
            given: 0,
        }
    }
}

impl Read for Endless<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(to)?;
        self.consume(read);
        Ok(read)
    }
}

impl BufRead for Endless<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if !self.beginning.is_empty() {
            return Ok(self.beginning);
        }
        Ok(&self.again[self.at..])
    }

    fn consume(&mut self, bytes: usize) {
        self.given += bytes;
        assert!(self.given < MOST, "it goes on reading");
        if self.beginning.is_empty() {
            self.at = (self.at + bytes) % self.again.len();
        } else {
            self.beginning = &self.beginning[bytes..];
        }
    }
}

/// The single message with which such an input is refused.
fn refused(beginning: &[u8], pattern: &[u8]) -> String {
    let mut input = Endless::new(beginning, pattern);
    let error = vtp::read(&mut input).expect_err("no body");
    assert_eq!(error.exit_code(), 2, "{error}");
    assert!(!error.remedy.is_empty(), "{error}");
    error.to_string()
}

#[test]
fn garbage_is_no_vtk_file() {
    for pattern in [&b"\0"[..], b"y\n", b" ", b"\n", b"<!-- -->", b"\xff\xfe"] {
        let said = refused(b"", pattern);
        assert!(said.starts_with("this is not a VTK XML file"), "{said}");
    }
    // One endless comment.
    let said = refused(b"<!-- ", b"cake ");
    assert!(said.starts_with("this is not a VTK XML file"), "{said}");
}

/// Complete files of other programs, cut off after a part of them and followed by garbage.
#[test]
fn garbage_after_a_header() {
    let files = [
        &include_bytes!("vtk-ascii.vtp")[..],
        include_bytes!("vtk-base64.vtp"),
        include_bytes!("vtk-appended-base64.vtp"),
        include_bytes!("vtk-appended-raw.vtp"),
        include_bytes!("vtk-with-vertices.vtp"),
    ];
    for file in files {
        let last = file.len() - "</VTKFile>".len() - 4;
        for end in (10..last).step_by(97) {
            for pattern in [&b"y\n"[..], b"\0", b"1 ", b"<a/>", b"<a>", b"AAAA", b" "] {
                refused(&file[..end], pattern);
            }
        }
    }
}

#[test]
fn what_stands_in_an_array_is_named() {
    let head = b"<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"2\"><Points><DataArray type=\"Float64\" Name=\"Points\" format=\"ascii\">";
    assert_eq!(
        refused(head, b"y\n"),
        "'y' is no part of a number; the file is damaged: write or copy it again"
    );
    assert_eq!(
        refused(head, b"1 "),
        "an array has more values than the header says; the file is damaged: write or copy it again"
    );
    let head = b"<VTKFile type=\"PolyData\"><PolyData>";
    assert_eq!(
        refused(head, b"y\n"),
        "its XML is longer than 1048576 bytes; the file is damaged: write or copy it again"
    );
}

#[test]
fn a_line_that_never_ends() {
    let mut input = Endless::new(b"LAMMPS", b"y");
    let error = dem_io::body::lammps::read(&mut input).expect_err("no body");
    assert_eq!(error.exit_code(), 2);
    assert!(
        error.problem.contains("longer than 1048576 bytes"),
        "{error}"
    );
}
