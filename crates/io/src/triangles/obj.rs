//! OBJ (Wavefront) -> facets: the lines `v` and `f`. Normals, textures, groups and materials say
//! nothing of the shape. Our own code: `tobj` has no line numbers for messages, and splits polygons
//! without a check.

use super::polygon::{self, REMEDY_SPLIT};
use super::words::{finite, shown};
use crate::diagnostic::{Diagnostic, Result};
use crate::stl::{Facets, REMEDY_REPAIR};
use std::borrow::Cow;

/// What a line may begin with that is neither a corner nor a face.
const OTHER: [&str; 20] = [
    "vn",
    "vt",
    "vp",
    "l",
    "p",
    "g",
    "o",
    "s",
    "mg",
    "mtllib",
    "usemtl",
    "maplib",
    "usemap",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "end",
];
/// What a line of a smooth surface begins with.
const SMOOTH: [&str; 8] = [
    "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm",
];

/// True if the first word after comments is one of an OBJ.
pub(super) fn is_obj(text: &[u8]) -> bool {
    let mut firsts = lines(text).filter_map(|(_, line)| Some(words(&line).next()?.to_owned()));
    firsts.next().is_some_and(|word| {
        matches!(&word[..], b"v" | b"f") || is_one(&word, &OTHER) || is_one(&word, &SMOOTH)
    })
}

/// Reads the facets of all objects in `text`.
pub(super) fn read(text: &[u8]) -> Result<Facets> {
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut faces = Faces::default();
    for (number, line) in lines(text) {
        let at_line =
            |problem: String| Diagnostic::input(format!("line {number}"), problem, REMEDY_REPAIR);
        let mut words = words(&line);
        match words.next() {
            None => {}
            Some(b"v") => corners.push(corner(words).map_err(at_line)?),
            Some(b"f") => faces.push(number, words, corners.len()).map_err(at_line)?,
            Some(other) if is_one(other, &OTHER) => {}
            Some(other) if is_one(other, &SMOOTH) => {
                let word = shown(other);
                return Err(Diagnostic::input(
                    format!("line {number}"),
                    format!("'{word}' belongs to a smooth surface, which has no triangles"),
                    "export the shape as a mesh",
                ));
            }
            Some(other) => {
                let word = shown(other);
                return Err(at_line(format!(
                    "found '{word}' where an OBJ has 'v' or 'f'"
                )));
            }
        }
    }
    let mut facets = faces.split(&corners)?;
    if !matches!(text.last(), Some(b'\n' | b'\r')) {
        let note = "The last line has no end: the file may be cut short.";
        facets.warnings.push(note.to_owned());
    }
    Ok(facets)
}

/// The faces of a file, whose corners may follow later.
#[derive(Default)]
struct Faces {
    /// The line of each, and where its corners begin in `named`.
    begins: Vec<(usize, usize)>,
    /// Indices of corners, from 0.
    named: Vec<usize>,
}

impl Faces {
    fn push<'a>(
        &mut self,
        line: usize,
        words: impl Iterator<Item = &'a [u8]>,
        corners_so_far: usize,
    ) -> std::result::Result<(), String> {
        let begin = self.named.len();
        for word in words {
            let index = index(word, corners_so_far);
            let wrong = || format!("'{}' is not the number of a corner", shown(word));
            self.named.push(index.ok_or_else(wrong)?);
        }
        self.begins.push((line, begin));
        match self.named.len() - begin {
            0..3 => Err(format!(
                "face {} has fewer than three corners",
                self.begins.len()
            )),
            _ => Ok(()),
        }
    }

    fn split(self, corners: &[[f64; 3]]) -> Result<Facets> {
        let mut facets = Facets::default();
        let mut polygon = Vec::new();
        for (at, (line, begin)) in self.begins.iter().enumerate() {
            let place = || format!("line {line}, face {}", at + 1);
            let next = self.begins.get(at + 1);
            let named = &self.named[*begin..next.map_or(self.named.len(), |(_, begin)| *begin)];
            polygon.clear();
            for index in named {
                let Some(corner) = corners.get(*index) else {
                    let problem = format!("corner {} of {} is named", index + 1, corners.len());
                    return Err(Diagnostic::input(place(), problem, REMEDY_REPAIR));
                };
                polygon.push(*corner);
            }
            polygon::split(&polygon, &mut facets.corners)
                .map_err(|problem| Diagnostic::input(place(), problem, REMEDY_SPLIT))?;
        }
        Ok(facets)
    }
}

/// Three coordinates; a weight or a colour may follow.
fn corner<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> std::result::Result<[f64; 3], String> {
    let mut corner = [0.0; 3];
    for coordinate in &mut corner {
        let word = words
            .next()
            .ok_or("a corner has fewer than three coordinates")?;
        *coordinate = finite(word)?;
    }
    Ok(corner)
}

/// The index, from 0, of a corner such as `7`, `7/1/3`, or `-1` for the last of those so far.
fn index(word: &[u8], so_far: usize) -> Option<usize> {
    let number = word.split(|b| *b == b'/').next()?;
    let number: i64 = std::str::from_utf8(number).ok()?.parse().ok()?;
    let distance = usize::try_from(number.unsigned_abs()).ok()?;
    match number {
        1.. => Some(distance - 1),
        0 => None,
        ..0 => so_far.checked_sub(distance),
    }
}

fn is_one(word: &[u8], of: &[&str]) -> bool {
    of.iter().any(|one| one.as_bytes() == word)
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let comment = line.iter().position(|b| *b == b'#');
    let line = &line[..comment.unwrap_or(line.len())];
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// The lines and their numbers, from 1. A line that ends with a backslash goes on in the next.
fn lines(text: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, [u8]>)> {
    let mut rest = Some(text);
    let mut number = 0;
    let mut plain_line = move || {
        let text = rest?;
        let end = text.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let line = &text[..end.unwrap_or(text.len())];
        rest = end.map(|end| {
            let width = if text[end..].starts_with(b"\r\n") {
                2
            } else {
                1
            };
            &text[end + width..]
        });
        number += 1;
        Some((number, line))
    };
    std::iter::from_fn(move || {
        let (number, line) = plain_line()?;
        let mut whole = Cow::Borrowed(line);
        // A comment ends with its line.
        while whole.last() == Some(&b'\\') && !whole.contains(&b'#') {
            let joined = whole.to_mut();
            joined.pop();
            joined.push(b' ');
            joined.extend(plain_line().map_or(&b""[..], |(_, line)| line));
        }
        Some((number, whole))
    })
}
