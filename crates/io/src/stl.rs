//! STL bytes -> facets, behind our own checks; and facets as binary STL.
//!
//! Binary or ASCII is decided by the length (a binary file of n facets has 84 + 50 n bytes),
//! because binary headers may begin with "solid" too. The facets of a binary file are read by
//! stl_io, after the length and the header have been checked here. ASCII is read by our own code:
//! stl_io stops after the first `solid` block and gives no line numbers.

mod ascii;
mod facets;
mod precision;
mod write;

use crate::diagnostic::{Diagnostic, Result};
use ascii::begins_with_solid;
use facets::is_blank;
pub(crate) use facets::{Facets, REMEDY_AGAIN, REMEDY_OTHER, REMEDY_REPAIR};
pub(crate) use precision::precision_note;
pub use precision::single_precision_keeps;
use std::io::{Cursor, Read, Seek, SeekFrom};
pub use write::{write_stl, write_stl_text};

/// Bytes of the header and the count of a binary file.
pub(crate) const BINARY_START: usize = 84;
/// Bytes of one facet of a binary file.
const BINARY_FACET: usize = 50;
/// Largest number of facets: three corners each must be numbered with 32 bits.
const MOST_FACETS: usize = 1_000_000_000;

/// Whether the bytes are those of an STL. `text` are those without marks of an encoding.
pub(crate) fn is_stl(bytes: &[u8], text: &[u8]) -> bool {
    binary_length(bytes) == Some(bytes.len()) || is_text(text) && begins_with_solid(text)
}

/// Reads an ASCII or binary STL. `text` are the bytes without marks of an encoding.
///
/// # Errors
/// Not an STL, missing or too many bytes (zeros and blanks may follow the last facet of a binary
/// file), a coordinate that is not a finite number, or ASCII that does not follow the grammar.
pub(crate) fn read_facets(bytes: &[u8], text: &[u8]) -> Result<Facets> {
    if binary_length(bytes) == Some(bytes.len()) {
        return read_binary(bytes);
    }
    if is_text(text) {
        if !begins_with_solid(text) {
            let start: String = String::from_utf8_lossy(&text[..text.len().min(20)])
                .escape_debug()
                .collect();
            return Err(Diagnostic::input(
                "",
                format!("not an STL: it is text that begins with '{start}', not with 'solid'"),
                REMEDY_OTHER,
            ));
        }
        return ascii::read(text);
    }
    if let Some(plain) = without_attributes(bytes) {
        let mut facets = read_binary(&plain)?;
        facets.warnings.push(format!(
            "{} bytes of attributes after its facets were ignored.",
            bytes.len() - plain.len()
        ));
        return Ok(facets);
    }
    let mut facets = read_binary(checked_binary(bytes)?)?;
    let trailing = bytes.len() - BINARY_START - BINARY_FACET * facets.corners.len();
    facets.warnings.push(format!(
        "{trailing} bytes of padding after the last facet were ignored."
    ));
    Ok(facets)
}

/// A binary file without the attributes of its facets, if these have as many bytes as each facet
/// says at its end, as the definition of the format has it. None: they do not, or have none.
fn without_attributes(bytes: &[u8]) -> Option<Vec<u8>> {
    let count = (binary_length(bytes)? - BINARY_START) / BINARY_FACET;
    let mut plain = bytes[..BINARY_START].to_vec();
    let mut rest = &bytes[BINARY_START..];
    for _ in 0..count {
        let (facet, after) = rest.split_at_checked(BINARY_FACET)?;
        let length = u16::from_le_bytes([facet[BINARY_FACET - 2], facet[BINARY_FACET - 1]]);
        plain.extend(facet);
        rest = after.get(usize::from(length)..)?;
    }
    (rest.is_empty() && plain.len() < bytes.len()).then_some(plain)
}

/// Length according to the header of a binary file; `None` for fewer bytes than a header.
pub(crate) fn binary_length(bytes: &[u8]) -> Option<usize> {
    let count: [u8; 4] = bytes.get(80..BINARY_START)?.try_into().ok()?;
    Some(BINARY_START + BINARY_FACET * u32::from_le_bytes(count) as usize)
}

/// True if the beginning contains only bytes that occur in text. The count and the numbers of a
/// binary file always contain others. Only a file that begins with "solid" may have letters beyond
/// ASCII (in names), in any encoding.
pub(crate) fn is_text(bytes: &[u8]) -> bool {
    let beginning = &bytes[..bytes.len().min(4096)];
    let has_control = beginning
        .iter()
        .any(|b| b.is_ascii_control() && !is_blank(*b) && *b != 0x1a);
    !has_control && (beginning.is_ascii() || begins_with_solid(bytes))
}

/// A text in UTF-16, with or without a mark of the order of its bytes, in UTF-8; none if it is not
/// one that begins like a text of ASCII.
pub(crate) fn text_of_utf_16(bytes: &[u8]) -> Option<Vec<u8>> {
    let is_big = match bytes.get(..4)? {
        [0xff, 0xfe, letter, 0] | [letter, 0, _, 0] if is_letter(*letter) => false,
        [0xfe, 0xff, 0, letter] | [0, letter, 0, _] if is_letter(*letter) => true,
        _ => return None,
    };
    let units = bytes.chunks_exact(2).map(|pair| match is_big {
        true => u16::from_be_bytes([pair[0], pair[1]]),
        false => u16::from_le_bytes([pair[0], pair[1]]),
    });
    let text: String = char::decode_utf16(units)
        .map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect();
    Some(text.into_bytes())
}

/// True for a byte with which a text can begin.
fn is_letter(byte: u8) -> bool {
    byte.is_ascii_graphic() || is_blank(byte)
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
                REMEDY_REPAIR,
            ));
        }
        corners.push(facet);
    }
    Ok(Facets {
        unit_m: None,
        warnings: precision_note(&corners, "STL").into_iter().collect(),
        corners,
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
    use crate::triangles::{read_facets, read_stream};
    use std::io;

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
        read_facets(bytes, "").expect_err("refused").to_string()
    }

    #[test]
    fn a_binary_that_says_solid_is_binary() {
        for header in [&b"solid\n"[..], b"solid part\nfacet normal", b"SOLID"] {
            let facets = read_facets(&binary(header, &[FACET, FACET]), "").unwrap();
            assert_eq!(facets.corners, vec![FACET.map(|v| v.map(f64::from)); 2]);
            assert!(facets.warnings.is_empty());
        }
    }

    #[test]
    fn padding_is_ignored_with_a_warning_and_other_bytes_are_refused() {
        let mut bytes = binary(b"", &[FACET]);
        bytes.extend(b"\r\n\0\0");
        let facets = read_facets(&bytes, "").unwrap();
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
            problem(b"hello\nformat ascii 1.0\n")
                .starts_with("not an STL: it is text that begins with 'hello")
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

    /// As the format is defined, each facet says how many bytes of attributes follow it.
    #[test]
    fn attributes_that_follow_facets_are_ignored_with_a_note() {
        let plain = binary(b"", &[FACET, FACET]);
        let with = |lengths: [u16; 2]| {
            let mut bytes = plain[..BINARY_START].to_vec();
            for (facet, length) in plain[BINARY_START..].chunks(BINARY_FACET).zip(lengths) {
                bytes.extend(&facet[..BINARY_FACET - 2]);
                bytes.extend(length.to_le_bytes());
                bytes.extend(vec![7; usize::from(length)]);
            }
            bytes
        };
        let wanted = read_facets(&plain, "").unwrap().corners;
        for lengths in [[4, 4], [0, 9], [300, 0]] {
            let facets = read_facets(&with(lengths), "").unwrap();
            assert_eq!(facets.corners, wanted);
            let count = lengths[0] + lengths[1];
            assert!(
                facets.warnings[0].starts_with(&format!("{count} bytes of attributes")),
                "{:?}",
                facets.warnings
            );
        }
        // Colours in the place of the count, and nothing that follows.
        let mut coloured = plain.clone();
        coloured[BINARY_START + BINARY_FACET - 1] = 0x80;
        assert!(read_facets(&coloured, "").unwrap().warnings.is_empty());
        // Not all of them are there.
        let cut = with([4, 4]);
        assert!(problem(&cut[..cut.len() - 1]).contains("bytes too many"));
    }

    #[test]
    fn a_damaged_corner_is_named() {
        let mut facet = FACET;
        facet[1] = [1e31, 2e25, -1e23];
        let text = problem(&binary(b"", &[FACET, FACET, facet]));
        assert!(
            text.starts_with("triangle 3 of 3: corner 2 is at (1.00e31, "),
            "{text}"
        );
        // A long needle is none.
        facet[1] = [1e6, 0.0, 0.0];
        assert!(read_facets(&binary(b"", &[FACET, FACET, facet]), "").is_ok());
    }

    #[test]
    fn reading_of_what_has_no_end_stops() {
        let whole = binary(b"", &[FACET, FACET]);
        assert_eq!(read_stream(&mut &whole[..]).unwrap(), whole);
        let text = b"solid a\nendsolid a\n";
        assert_eq!(read_stream(&mut &text[..]).unwrap(), text);
        for beginning in [&[0; 10][..], &whole] {
            let mut endless = beginning.chain(io::repeat(0));
            let said = read_stream(&mut endless).expect_err("refused").to_string();
            assert!(said.starts_with("it goes on after 104"), "{said}");
        }
    }

    #[test]
    fn a_binary_far_from_the_origin_has_a_note() {
        let note = |offset: f32| {
            let far = FACET.map(|corner| corner.map(|x| x + offset));
            read_facets(&binary(b"", &[far]), "").unwrap().warnings
        };
        assert!(note(0.0).is_empty() && note(1e2).is_empty());
        // The numbers from 2^19 to 2^20 are 1/16 apart.
        let warnings = note(1e6);
        assert!(
            warnings[0].contains("may be off by 0.031 units of the file, 3.1 % of its size"),
            "{warnings:?}"
        );
    }

    #[test]
    fn a_bad_normal_or_attribute_of_a_binary_does_not_matter() {
        let mut bytes = binary(b"", &[FACET]);
        bytes[84..96].fill(0xff);
        bytes[132..134].fill(0xff);
        assert_eq!(read_facets(&bytes, "").unwrap().corners.len(), 1);
    }
}
