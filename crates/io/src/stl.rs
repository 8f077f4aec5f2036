//! STL bytes -> facets, behind our own checks; and facets as binary STL.
//!
//! Binary or ASCII is decided by the length (a binary file of n facets has 84 + 50 n bytes),
//! because binary headers may begin with "solid" too. The facets of a binary file are read by
//! stl_io, after the length and the header have been checked here. ASCII is read by our own code:
//! stl_io stops after the first `solid` block and gives no line numbers.

mod ascii;
mod facets;
mod write;

use crate::diagnostic::{Diagnostic, Result};
pub(crate) use facets::Facets;
use facets::{REMEDY_AGAIN, is_blank};
use std::io::{Cursor, Read, Seek, SeekFrom};
pub use write::write_stl;

/// Bytes of the header and the count of a binary file.
const BINARY_START: usize = 84;
/// Bytes of one facet of a binary file.
const BINARY_FACET: usize = 50;
/// Largest number of facets: three corners each must be numbered with 32 bits.
const MOST_FACETS: usize = 1_000_000_000;

/// The remedy for a file that is not truncated but of another type.
const REMEDY_OTHER: &str = "give an ASCII or binary STL file";
/// Reads an ASCII or binary STL.
///
/// # Errors Not an STL, no facet, missing or too many bytes (bytes after the last facet of a binary
/// file are accepted if all are zeros or blanks), a coordinate that is not a finite number (with
/// the facet counted from 1, and the line of an ASCII file), or ASCII that does not follow the
/// grammar (with the line). The place does not name the file.
pub(crate) fn read_facets(bytes: &[u8]) -> Result<Facets> {
    if bytes.is_empty() {
        return Err(Diagnostic::input(
            "",
            "not an STL: the file is empty",
            REMEDY_OTHER,
        ));
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let facets = if binary_length(bytes) == Some(bytes.len()) {
        read_binary(bytes)?
    } else if is_text(text) {
        if !starts_with_word(text, b"solid") {
            let start: String = String::from_utf8_lossy(&text[..text.len().min(20)])
                .escape_debug()
                .collect();
            return Err(Diagnostic::input(
                "",
                format!("not an STL: it is text that begins with '{start}', not with 'solid'"),
                REMEDY_OTHER,
            ));
        }
        ascii::read(text)?
    } else {
        let mut facets = read_binary(checked_binary(bytes)?)?;
        let trailing = bytes.len() - BINARY_START - BINARY_FACET * facets.corners.len();
        facets.warnings.push(format!(
            "{trailing} bytes of padding after the last facet were ignored."
        ));
        facets
    };
    if facets.corners.is_empty() {
        return Err(Diagnostic::input(
            "",
            "the STL contains no triangles",
            "export the shape again",
        ));
    }
    Ok(facets)
}

/// Length according to the header of a binary file; `None` for fewer bytes than a header.
fn binary_length(bytes: &[u8]) -> Option<usize> {
    let count: [u8; 4] = bytes.get(80..BINARY_START)?.try_into().ok()?;
    Some(BINARY_START + BINARY_FACET * u32::from_le_bytes(count) as usize)
}

/// True if the beginning contains only bytes that occur in text. The count and the numbers of a
/// binary file always contain others. Only a file that begins with "solid" may have letters beyond
/// ASCII (in names), in any encoding.
fn is_text(bytes: &[u8]) -> bool {
    let beginning = &bytes[..bytes.len().min(4096)];
    let has_control = beginning
        .iter()
        .any(|b| b.is_ascii_control() && !is_blank(*b) && *b != 0x1a);
    !has_control && (beginning.is_ascii() || starts_with_word(bytes, b"solid"))
}

/// True if the first word is `word`, in upper or lower case.
fn starts_with_word(text: &[u8], word: &[u8]) -> bool {
    let text = text.trim_ascii_start();
    text.len() >= word.len()
        && text[..word.len()].eq_ignore_ascii_case(word)
        && text.get(word.len()).is_none_or(u8::is_ascii_whitespace)
}

/// The part of a binary file with the length given in its header. An error for another type of
/// file, missing bytes, or surplus bytes that are not padding.
fn checked_binary(bytes: &[u8]) -> Result<&[u8]> {
    let length = bytes.len();
    let Some(promised) = binary_length(bytes) else {
        let problem = format!(
            "not an STL: {length} bytes, fewer than the 84 of a binary STL's header, and not text that begins with 'solid'"
        );
        return Err(Diagnostic::input("", problem, REMEDY_OTHER));
    };
    let count = (promised - BINARY_START) / BINARY_FACET;
    let header = format!("header promises {count} triangles ({promised} bytes), file has {length}");
    if length < promised {
        let problem = if count > MOST_FACETS {
            format!("not an STL, or truncated: {header}")
        } else {
            format!("truncated: {header}")
        };
        return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
    }
    let trailing = &bytes[promised..];
    if !trailing
        .iter()
        .all(|b| *b == 0 || b.is_ascii_whitespace() || *b == 0x1a)
        || count == 0
    {
        let problem = format!("{} bytes too many: {header}", trailing.len());
        return Err(Diagnostic::input("", problem, REMEDY_AGAIN));
    }
    Ok(&bytes[..promised])
}

/// The facets of a binary file of exactly that length.
fn read_binary(bytes: &[u8]) -> Result<Facets> {
    let count = (bytes.len() - BINARY_START) / BINARY_FACET;
    if count > MOST_FACETS {
        return Err(Diagnostic::input(
            "",
            format!("{count} triangles, more than the {MOST_FACETS} that can be read"),
            "use a coarser surface",
        ));
    }
    let failed = |error: std::io::Error| {
        Diagnostic::input(
            "",
            format!("not readable as a binary STL: {error}"),
            REMEDY_AGAIN,
        )
    };
    let mut reader = NeverAscii(Cursor::new(bytes));
    let triangles = stl_io::create_stl_reader(&mut reader).map_err(failed)?;
    let mut corners = Vec::with_capacity(count);
    for (index, triangle) in triangles.enumerate() {
        let triangle = triangle.map_err(failed)?;
        let facet: [[f64; 3]; 3] = triangle.vertices.map(|v| v.0.map(f64::from));
        if let Some(bad) = facet.as_flattened().iter().position(|x| !x.is_finite()) {
            let problem = format!(
                "coordinate {} of corner {} is {}, not a finite number",
                ["x", "y", "z"][bad % 3],
                bad / 3 + 1,
                facet[bad / 3][bad % 3]
            );
            return Err(Diagnostic::input(
                format!("triangle {} of {count}", index + 1),
                problem,
                "repair or export the shape again",
            ));
        }
        corners.push(facet);
    }
    Ok(Facets {
        corners,
        warnings: Vec::new(),
    })
}

/// A binary STL with a line feed as its first byte, so that stl_io cannot take it for ASCII. The
/// header has no meaning.
struct NeverAscii<'a>(Cursor<&'a [u8]>);

impl Read for NeverAscii<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let at_start = self.0.position() == 0;
        let length = self.0.read(buffer)?;
        if at_start && length > 0 {
            buffer[0] = b'\n';
        }
        Ok(length)
    }
}

impl Seek for NeverAscii<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    fn binary(header: &[u8], facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes[..header.len()].copy_from_slice(header);
        bytes.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            bytes.extend([0; 12]);
            bytes.extend(facet.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    const FACET: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.0, 1.0, -0.25]];

    fn problem(bytes: &[u8]) -> String {
        read_facets(bytes).expect_err("refused").to_string()
    }

    #[test]
    fn a_binary_that_says_solid_is_binary() {
        for header in [&b"solid\n"[..], b"solid part\nfacet normal", b"SOLID"] {
            let facets = read_facets(&binary(header, &[FACET, FACET])).unwrap();
            assert_eq!(facets.corners, vec![FACET.map(|v| v.map(f64::from)); 2]);
            assert!(facets.warnings.is_empty());
        }
    }

    #[test]
    fn padding_is_ignored_with_a_warning_and_other_bytes_are_refused() {
        let mut bytes = binary(b"", &[FACET]);
        bytes.extend(b"\r\n\0\0");
        let facets = read_facets(&bytes).unwrap();
        assert_eq!((facets.corners.len(), facets.warnings.len()), (1, 1));
        assert!(facets.warnings[0].starts_with("4 bytes"));
        bytes.push(7);
        assert_eq!(
            problem(&bytes),
            "5 bytes too many: header promises 1 triangles (134 bytes), file has 139; export or copy the file again"
        );
    }

    #[test]
    fn each_way_of_not_being_a_binary_has_its_message() {
        let bytes = binary(b"solid", &[FACET, FACET]);
        assert!(
            problem(&bytes[..150])
                .starts_with("truncated: header promises 2 triangles (184 bytes), file has 150")
        );
        assert!(problem(&bytes[..84]).starts_with("truncated: header promises 2 triangles"));
        assert!(problem(&[0; 83]).starts_with("not an STL: 83 bytes"));
        assert!(problem(&[0xee; 500]).starts_with("not an STL, or truncated"));
        assert!(problem(b"").starts_with("not an STL"));
        assert!(
            problem(b"ply\nformat ascii 1.0\n")
                .starts_with("not an STL: it is text that begins with 'ply")
        );
        assert!(problem(b"solidworks").starts_with("not an STL"));
        assert!(problem(&binary(b"", &[])).starts_with("the STL contains no triangles"));
        let mut streamed = binary(b"", &[FACET]);
        streamed[80] = 0;
        assert!(problem(&streamed).starts_with("50 bytes too many: header promises 0 triangles"));
    }

    #[test]
    fn a_number_that_is_not_finite_is_named() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut facet = FACET;
            facet[1][2] = bad;
            let text = problem(&binary(b"", &[FACET, FACET, facet]));
            assert!(
                text.starts_with("triangle 3 of 3: coordinate z of corner 2 is "),
                "{text}"
            );
        }
    }

    #[test]
    fn a_bad_normal_or_attribute_of_a_binary_does_not_matter() {
        let mut bytes = binary(b"", &[FACET]);
        bytes[84..96].fill(0xff);
        bytes[132..134].fill(0xff);
        assert_eq!(read_facets(&bytes).unwrap().corners.len(), 1);
    }
}
