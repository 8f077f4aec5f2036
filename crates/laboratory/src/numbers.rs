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
}

/// Notations in the order in which they are tried.
const NOTATIONS: [Notation; 9] = [
    Notation::of(Separator::Character(';'), '.'),
    Notation::of(Separator::Character(';'), ','),
    Notation::of(Separator::Character('\t'), '.'),
    Notation::of(Separator::Character('\t'), ','),
    Notation::of(Separator::Character(','), '.'),
    Notation::of(Separator::Character('|'), '.'),
    Notation::of(Separator::Character('|'), ','),
    Notation::of(Separator::Space, '.'),
    Notation::of(Separator::Space, ','),
];

impl Notation {
    const fn of(separator: Separator, decimal: char) -> Self {
        Self { separator, decimal }
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
        let numbers = self.count_numbers(&cells);
        let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
        match numbers {
            0 | 1 => 0,
            _ if numbers == filled => 2,
            _ => 1,
        }
    }

    /// How many cells are numbers.
    pub(crate) fn count_numbers(&self, cells: &[&str]) -> usize {
        let numbers = cells.iter().filter(|cell| self.number(cell).is_some());
        numbers.count()
    }

    /// The cells of a line, without the spaces and quotes around them.
    pub(crate) fn cells<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let plain = |cell: &'a str| cell.trim().trim_matches('"').trim();
        match self.separator {
            Separator::Character(separator) => line.split(separator).map(plain).collect(),
            Separator::Space => line.split_whitespace().map(plain).collect(),
        }
    }

    /// The number that a cell is. None: it is something else.
    pub(crate) fn number(&self, cell: &str) -> Option<f64> {
        let digits = |c: char| c.is_ascii_digit();
        let is_one = cell.starts_with(|c| digits(c) || matches!(c, '+' | '-') || c == self.decimal)
            && cell.ends_with(digits)
            && cell
                .chars()
                .all(|c| digits(c) || matches!(c, '+' | '-' | 'e' | 'E') || c == self.decimal);
        if !is_one {
            return None;
        }
        let value: f64 = cell.replace(self.decimal, ".").parse().ok()?;
        value.is_finite().then_some(value)
    }
}
