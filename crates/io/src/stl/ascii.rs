//! ASCII STL -> facets: `solid NAME (facet normal N N N outer loop (vertex X Y Z)*3 endloop
//! endfacet)* endsolid NAME`, any number of times; upper or lower case, any white space. Normals
//! are skipped: many programs write them wrongly or not at all. Comments, `end loop` in two words
//! and files of one line are read as well.

use super::facets::{Facets, REMEDY_AGAIN, REMEDY_REPAIR, is_blank};
use crate::diagnostic::{Diagnostic, Result};
use crate::triangles::words::{finite, shown};

/// Reads the facets of all `solid` blocks in `text`, which begins with "solid" after comments.
pub(super) fn read(text: &[u8]) -> Result<Facets> {
    let mut words = Words::of(text);
    let mut facets = Facets::default();
    while let Some(word) = words.next_word() {
        if is(word, "solid") {
            words.skip_name("facet");
            read_solid(&mut words, &mut facets)?;
        } else if !word.iter().all(|b| *b == 0 || *b == 0x1a) {
            return Err(unexpected(&words, word, "'solid' or the end of the file"));
        }
    }
    Ok(facets)
}

/// True if the first word after comments is "solid".
pub(super) fn begins_with_solid(text: &[u8]) -> bool {
    Words::of(text)
        .next_word()
        .is_some_and(|word| is(word, "solid"))
}

/// Reads facets up to `endsolid`.
fn read_solid(words: &mut Words, facets: &mut Facets) -> Result<()> {
    loop {
        let Some(word) = words.next_word() else {
            facets.warnings.push(format!(
                "The file ends at line {} without 'endsolid'.",
                words.line
            ));
            return Ok(());
        };
        let number = facets.corners.len() + 1;
        if is(word, "facet") {
            let facet = read_facet(words, number)?;
            facets.corners.push(facet);
        } else if is(word, "outer") {
            // Some programs leave out the lines of facets.
            let facet = read_loop(words, number)?;
            facets.corners.push(facet);
        } else if words.is_end_of(word, "solid") {
            words.skip_name("solid");
            return Ok(());
        } else {
            return Err(unexpected(words, word, "'facet' or 'endsolid'"));
        }
    }
}

/// Reads the text after the word `facet`, up to `endfacet`. `number` counts from 1.
fn read_facet(words: &mut Words, number: usize) -> Result<[[f64; 3]; 3]> {
    let mut word = words.need(number)?;
    for _ in 0..4 {
        if !is(word, "outer") {
            word = words.need(number)?;
        }
    }
    expect(words, word, "outer")?;
    let corners = read_loop(words, number)?;
    let word = words.need(number)?;
    expect_end(words, word, "facet")?;
    Ok(corners)
}

/// Reads the text after the word `outer`, up to `endloop`.
fn read_loop(words: &mut Words, number: usize) -> Result<[[f64; 3]; 3]> {
    let word = words.need(number)?;
    expect(words, word, "loop")?;
    let mut corners = [[0.0; 3]; 3];
    for corner in &mut corners {
        let word = words.need(number)?;
        expect(words, word, "vertex")?;
        for coordinate in corner {
            let word = words.need(number)?;
            *coordinate = finite_number(words, word, number)?;
        }
    }
    let word = words.need(number)?;
    expect_end(words, word, "loop")?;
    Ok(corners)
}

fn finite_number(words: &Words, word: &[u8], facet: usize) -> Result<f64> {
    finite(word).map_err(|problem| {
        let place = format!("line {}, triangle {facet}", words.line);
        Diagnostic::input(place, problem, REMEDY_REPAIR)
    })
}

fn expect(words: &Words, word: &[u8], keyword: &str) -> Result<()> {
    if is(word, keyword) {
        Ok(())
    } else {
        Err(unexpected(words, word, &format!("'{keyword}'")))
    }
}

/// As [`expect`], for `endloop` and `endfacet`, which may be two words.
fn expect_end(words: &mut Words, word: &[u8], of: &str) -> Result<()> {
    if words.is_end_of(word, of) {
        Ok(())
    } else {
        Err(unexpected(words, word, &format!("'end{of}'")))
    }
}

fn unexpected(words: &Words, word: &[u8], wanted: &str) -> Diagnostic {
    let found = if words.at_end() {
        "truncated: the file ends with"
    } else {
        "found"
    };
    let problem = format!("{found} '{}' where an ASCII STL has {wanted}", shown(word));
    Diagnostic::input(format!("line {}", words.line), problem, REMEDY_REPAIR)
}

fn is(word: &[u8], keyword: &str) -> bool {
    word.eq_ignore_ascii_case(keyword.as_bytes())
}

/// The words of a text and the line (from 1) of the last one.
struct Words<'a> {
    text: &'a [u8],
    next: usize,
    line: usize,
}

impl<'a> Words<'a> {
    fn of(text: &'a [u8]) -> Self {
        Self {
            text,
            next: 0,
            line: 1,
        }
    }

    /// The next word that is not in a comment: from `#`, `;`, `!` or `//` to the end of the line.
    fn next_word(&mut self) -> Option<&'a [u8]> {
        loop {
            let word = self.any_word()?;
            let is_comment = matches!(word[0], b'#' | b';' | b'!') || word.starts_with(b"//");
            if !is_comment {
                return Some(word);
            }
            self.skip_line();
        }
    }

    fn any_word(&mut self) -> Option<&'a [u8]> {
        while let Some(byte) = self.text.get(self.next).filter(|b| is_blank(**b)) {
            let line_end =
                *byte == b'\n' || *byte == b'\r' && self.text.get(self.next + 1) != Some(&b'\n');
            self.line += usize::from(line_end);
            self.next += 1;
        }
        let start = self.next;
        while self.text.get(self.next).is_some_and(|b| !is_blank(*b)) {
            self.next += 1;
        }
        (self.next > start).then(|| &self.text[start..self.next])
    }

    /// True if a word just read ends a block: `endloop`, or `end loop`, whose second word is then
    /// read as well.
    fn is_end_of(&mut self, word: &[u8], of: &str) -> bool {
        if !is(word, "end") {
            return is(word, &format!("end{of}"));
        }
        let before = (self.next, self.line);
        let is_end = self.next_word().is_some_and(|word| is(word, of));
        if !is_end {
            (self.next, self.line) = before;
        }
        is_end
    }

    /// The next word of an incomplete facet. A word at the very end of the text may be truncated.
    fn need(&mut self, facet: usize) -> Result<&'a [u8]> {
        let word = self
            .next_word()
            .filter(|word| !self.at_end() || is(word, "endfacet"));
        word.ok_or_else(|| {
            Diagnostic::input(
                format!("line {}", self.line),
                format!("truncated: the file ends in the middle of triangle {facet}"),
                REMEDY_AGAIN,
            )
        })
    }

    fn at_end(&self) -> bool {
        self.next == self.text.len()
    }

    /// Skips the rest of the line.
    fn skip_line(&mut self) {
        while self
            .text
            .get(self.next)
            .is_some_and(|b| !matches!(b, b'\n' | b'\r'))
        {
            self.next += 1;
        }
    }

    /// Skips the name of a solid, which can be anything: the rest of the line, unless facets follow
    /// in it, as in a file of one line. After `endsolid` these begin with another `solid`.
    fn skip_name(&mut self, begins_with: &str) {
        let before = self.next;
        self.skip_line();
        let mut words = Words::of(&self.text[before..self.next]);
        let (mut begin, mut last_two) = (None, [&b""[..]; 2]);
        while let Some(word) = words.any_word() {
            if is(word, begins_with) {
                begin = Some(words.next - word.len());
            }
            let is_facet = is(last_two[0], "outer") && is(last_two[1], "loop");
            if let Some(begin) = begin.filter(|_| is_facet && is(word, "vertex")) {
                self.next = before + begin;
                return;
            }
            last_two = [last_two[1], word];
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use crate::triangles::read_facets;

    const FACET: &str = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";

    fn problem(text: &str) -> String {
        read_facets(text.as_bytes(), "")
            .expect_err("refused")
            .to_string()
    }

    #[test]
    fn all_solids_are_read() {
        let text = format!(
            "solid a facet\n{FACET}{FACET}endsolid a\n\nsolid\n{FACET}endsolid\nsolid empty\nendsolid empty\n"
        );
        let facets = read_facets(text.as_bytes(), "").unwrap();
        assert_eq!(facets.corners.len(), 3);
        assert!(facets.warnings.is_empty());
    }

    #[test]
    fn case_white_space_and_bad_normals_do_not_matter() {
        let plain = read_facets(format!("solid a\n{FACET}endsolid a\n").as_bytes(), "").unwrap();
        let shouted = format!(
            "SOLID A\r\n{}ENDSOLID A\r\n",
            FACET.to_uppercase().replace('\n', "\r\n\t")
        );
        let marked = format!("\u{feff}solid a\n{FACET}endsolid a\n\u{1a}");
        let without_normal = format!("solid a\n{}endsolid a", FACET.replace("normal 0 0 1", ""));
        let nan_normal = format!(
            "solid a\n{}endsolid a",
            FACET.replace("0 0 1", "nan -nan(ind) 1e999")
        );
        let parted = format!("solid a\n{FACET}end solid a\n").replace("end", "end ");
        let parted = parted.replace("end  ", "end ");
        let fortran = format!(
            "solid a\n{}endsolid a",
            FACET.replace("1 0", "1.0D+00 0.d0")
        );
        let one_line = format!("solid facet normal\n{FACET}endsolid a\n").replace('\n', "\t");
        let commented = format!(
            "# by hand\nsolid a # b\n; second\n{}endsolid a\n// end\n",
            FACET.replace("endloop", "endloop ! of three")
        );
        let bare = format!("solid a\n{FACET}endsolid a\n")
            .replace("facet normal 0 0 1\n", "")
            .replace("endfacet\n", "");
        for text in [parted, fortran, one_line, commented, bare] {
            assert_eq!(read_facets(text.as_bytes(), "").unwrap(), plain, "{text}");
        }
        let two_in_a_line = format!("solid a solid\n{FACET}endsolid a solid b\n{FACET}endsolid");
        let two_in_a_line = read_facets(two_in_a_line.replace('\n', " ").as_bytes(), "").unwrap();
        assert_eq!(two_in_a_line.corners.len(), 2);
        for big in [false, true] {
            let units = format!("\u{feff}solid a\n{FACET}endsolid a\n");
            let bytes: Vec<u8> = (units.encode_utf16())
                .flat_map(|unit| {
                    if big {
                        unit.to_be_bytes()
                    } else {
                        unit.to_le_bytes()
                    }
                })
                .collect();
            assert_eq!(read_facets(&bytes, "").unwrap(), plain);
            assert_eq!(read_facets(&bytes[2..], "").unwrap(), plain);
        }
        let old_mac = format!("solid a\n{FACET}endsolid a\n").replace('\n', "\r");
        for text in [shouted, marked, old_mac, without_normal, nan_normal] {
            assert_eq!(read_facets(text.as_bytes(), "").unwrap(), plain, "{text}");
        }
    }

    #[test]
    fn errors_carry_the_line() {
        let with = |from: &str, to: &str| {
            problem(&format!(
                "solid a\n{FACET}{}endsolid a\n",
                FACET.replacen(from, to, 1)
            ))
        };
        assert!(
            with("vertex 1 0 0", "vertex 1 0,5 0")
                .starts_with("line 12, triangle 2: coordinate '0,5' is not a number")
        );
        assert!(
            with("vertex 1 0 0", "vertex 1 0 NaN")
                .starts_with("line 12, triangle 2: coordinate 'NaN' is not a finite number")
        );
        assert!(
            with("vertex 1 0 0", "vertex 1 0 1e999")
                .starts_with("line 12, triangle 2: coordinate '1e999' is not a finite")
        );
        assert!(
            with("vertex 1 0 0", "vertex 1 0")
                .starts_with("line 13, triangle 2: coordinate 'vertex' is not a number")
        );
        assert!(
            with(" endloop", "  vertex 1 1 0\n endloop")
                .starts_with("line 14: found 'vertex' where an ASCII STL has 'endloop'")
        );
        assert!(
            with("facet normal", "color 1 1 1\nfacet normal").starts_with("line 9: found 'color'")
        );
        assert!(
            problem(&format!("solid a\n{FACET}endsolid a\nmore"))
                .starts_with("line 10: truncated: the file ends with 'more'")
        );
    }

    #[test]
    fn a_file_that_ends_within_a_facet_is_refused_and_one_without_endsolid_is_not() {
        let whole = format!("solid a\n{FACET}{FACET}");
        let facets = read_facets(whole.as_bytes(), "").unwrap();
        assert_eq!((facets.corners.len(), facets.warnings.len()), (2, 1));
        for cut in 9..FACET.len() - 1 {
            let text = &whole[..whole.len() - cut];
            let line = text.trim_end().lines().count();
            let message = problem(text);
            assert!(message.contains("line "), "{message}");
            if text.ends_with('\n') {
                assert!(
                    message.contains(&format!("line {}", line + 1))
                        && message.contains("middle of triangle 2"),
                    "{message}"
                );
            }
        }
        assert!(problem("solid a\nendsolid a\n").contains("no triangles"));
    }
}
