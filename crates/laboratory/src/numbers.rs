//! Numbers and cells as test rigs write them.

/// Separator of the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    /// One character.
    Character(char),
    /// Any run of spaces and tabs.
    Space,
}

/// Separator and decimal sign of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Notation {
    /// Between cells.
    pub(crate) separator: Separator,
    /// Decimal sign: point or comma.
    pub(crate) decimal: char,
    /// Whether numbers of the file show that this is the decimal sign: the other one then stands
    /// between thousands.
    pub(crate) is_shown: bool,
}

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Content {
    /// A number.
    Number(f64),
    /// `1,130` in a file that does not show its decimal sign.
    Unclear,
    /// Something else.
    Text,
}

/// Notations in the order in which they are tried. A comma between cells and in numbers needs
/// quotes around the numbers.
const NOTATIONS: [Notation; 10] = [
    Notation::of(Separator::Character(';'), '.'),
    Notation::of(Separator::Character(';'), ','),
    Notation::of(Separator::Character('\t'), '.'),
    Notation::of(Separator::Character('\t'), ','),
    Notation::of(Separator::Character(','), '.'),
    Notation::of(Separator::Character(','), ','),
    Notation::of(Separator::Character('|'), '.'),
    Notation::of(Separator::Character('|'), ','),
    Notation::of(Separator::Space, '.'),
    Notation::of(Separator::Space, ','),
];
/// Signs between thousands that are no decimal signs: spaces of several widths, apostrophes.
const BETWEEN_THOUSANDS: [char; 6] = [' ', '\u{a0}', '\u{202f}', '\u{2009}', '\'', '\u{2019}'];

impl Notation {
    pub(crate) const fn of(separator: Separator, decimal: char) -> Self {
        Self {
            separator,
            decimal,
            is_shown: false,
        }
    }

    /// The notation in which most lines are rows of numbers. None: no line has two numbers.
    pub(crate) fn found_in(lines: &[&str]) -> Option<Self> {
        let score =
            |notation: &Self| -> usize { lines.iter().map(|line| notation.score(line)).sum() };
        let mut best: Option<(usize, Self)> = None;
        for notation in NOTATIONS {
            let score = score(&notation);
            if score > best.map_or(0, |(most, _)| most) {
                best = Some((score, notation));
            }
        }
        best.map(|(_, notation)| notation)
    }

    /// 2 for a line of numbers alone, 1 for one with two numbers among other cells.
    fn score(&self, line: &str) -> usize {
        let cells = self.cells(line);
        let numbers = cells.iter().filter(|cell| self.number(cell).is_some());
        let numbers = numbers.count();
        let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
        match numbers {
            0 | 1 => 0,
            _ if numbers == filled => 2,
            _ => 1,
        }
    }

    /// How many cells are numbers, clear or not.
    pub(crate) fn count_numbers(&self, cells: &[&str]) -> usize {
        let numbers = cells
            .iter()
            .filter(|cell| self.content(cell) != Content::Text);
        numbers.count()
    }

    /// The cells of a line, without the spaces and quotes around them. Separators within quotes
    /// belong to their cell.
    pub(crate) fn cells<'a>(&self, line: &'a str) -> Vec<&'a str> {
        match self.separator {
            Separator::Character(separator) => quoted_cells(line, separator),
            Separator::Space => {
                let words = line.split([' ', '\t']).filter(|word| !word.is_empty());
                words.map(plain).collect()
            }
        }
    }

    /// The number that a cell is. None: it is something else, or unclear.
    pub(crate) fn number(&self, cell: &str) -> Option<f64> {
        match self.content(cell) {
            Content::Number(value) => Some(value),
            Content::Unclear | Content::Text => None,
        }
    }

    /// What a cell holds.
    pub(crate) fn content(&self, cell: &str) -> Content {
        let digits = |c: char| c.is_ascii_digit();
        let starts = |c| digits(c) || matches!(c, '+' | '-' | '\u{2212}') || c == self.decimal;
        if !cell.starts_with(starts) || !cell.ends_with(digits) {
            return Content::Text;
        }
        let is_part = |c: char| digits(c) || matches!(c, '+' | '-' | 'e' | 'E' | '\u{2212}');
        if cell.chars().all(|c| is_part(c) || c == self.decimal) {
            return self.parsed(cell).map_or(Content::Text, Content::Number);
        }
        let Some((between, groups)) = self.groups(cell) else {
            return Content::Text;
        };
        let is_clear = self.is_shown
            || BETWEEN_THOUSANDS.contains(&between)
            || groups > 1
            || cell.contains(self.decimal);
        if !is_clear {
            return Content::Unclear;
        }
        let without: String = cell.chars().filter(|c| *c != between).collect();
        self.parsed(&without).map_or(Content::Text, Content::Number)
    }

    fn parsed(&self, cell: &str) -> Option<f64> {
        let text = cell.replace('\u{2212}', "-").replace(self.decimal, ".");
        let value: f64 = text.parse().ok()?;
        value.is_finite().then_some(value)
    }

    /// The sign between the thousands of a number, and how often it occurs. None: the cell is no
    /// such number.
    fn groups(&self, cell: &str) -> Option<(char, usize)> {
        let unsigned = cell.trim_start_matches(['+', '-', '\u{2212}']);
        let whole = match unsigned.split_once(self.decimal) {
            Some((whole, fraction)) if fraction.chars().all(|c| c.is_ascii_digit()) => whole,
            Some(_) => return None,
            None => unsigned,
        };
        let other = if self.decimal == '.' { ',' } else { '.' };
        let is_sign = |c: &char| *c == other || BETWEEN_THOUSANDS.contains(c);
        let between = whole.chars().find(is_sign)?;
        is_grouped(whole, between).then(|| (between, whole.matches(between).count()))
    }

    /// Whether a number can only have this decimal sign: `0.123`, `12.5`, `1234.567`, `1,234.5`.
    pub(crate) fn shows(&self, cell: &str) -> bool {
        if self.number(cell).is_none() {
            return false;
        }
        cell.contains(self.decimal) && !self.may_be_thousands(cell)
    }

    /// Whether the decimal sign of a number may as well stand between thousands: `1.234`.
    pub(crate) fn may_be_thousands(&self, cell: &str) -> bool {
        let unsigned = cell.trim_start_matches(['+', '-', '\u{2212}']);
        is_grouped(unsigned, self.decimal)
    }
}

/// Whether a text is digits in groups of three: `1,234`, `12,345,678`, not `0,123`.
fn is_grouped(text: &str, between: char) -> bool {
    let mut groups = text.split(between);
    let first = groups.next().unwrap_or_default();
    let digits = |group: &str| group.chars().all(|c| c.is_ascii_digit());
    let mut others = groups.peekable();
    others.peek().is_some()
        && (1..=3).contains(&first.len())
        && digits(first)
        && !first.starts_with('0')
        && others.all(|group| group.len() == 3 && digits(group))
}

/// A cell without spaces and quotes around it.
fn plain(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

/// The cells between separators. Quotes around a cell hold separators, and `""` is a quote in it.
fn quoted_cells(line: &str, separator: char) -> Vec<&str> {
    let mut cells = Vec::new();
    let mut rest = line;
    loop {
        let inner = rest.trim_start_matches(' ').strip_prefix('"');
        let closed = inner.and_then(|inner| Some((inner, closing_quote(inner)?)));
        let (cell, after) = match closed {
            Some((inner, end)) => (inner[..end].trim(), &inner[end + 1..]),
            None => {
                let end = rest.find(separator).unwrap_or(rest.len());
                (plain(&rest[..end]), &rest[end..])
            }
        };
        cells.push(cell);
        match after.split_once(separator) {
            Some((_, next)) => rest = next,
            None => return cells,
        }
    }
}

/// Place of the quote that ends a cell; quotes in it are doubled.
fn closing_quote(inner: &str) -> Option<usize> {
    let bytes = inner.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        match (bytes[at], bytes.get(at + 1)) {
            (b'"', Some(b'"')) => at += 2,
            (b'"', _) => return Some(at),
            _ => at += 1,
        }
    }
    None
}
