//! How many numbers the arrays of a .vtp file have.

/// Numbers of points and cells.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counts {
    /// Number of points.
    pub points: u64,
    /// Number of lines.
    pub lines: u64,
    /// Number of vertex cells, whose cell data precede those of the lines.
    pub cells_before: u64,
    /// Number of polygons and strips, whose cell data follow those of the lines.
    pub cells_after: u64,
}

impl Counts {
    /// Number of all cells.
    pub(super) fn cells(&self) -> u64 {
        let others = self.cells_before.saturating_add(self.cells_after);
        self.lines.saturating_add(others)
    }

    /// Numbers of what an array tells of: before those whose numbers are kept, of those, after
    /// them.
    pub(super) fn parts(&self, of: Of) -> [u64; 3] {
        match of {
            Of::Points => [0, self.points, 0],
            Of::Lines => [0, self.lines, 0],
            Of::Cells => [self.cells_before, self.lines, self.cells_after],
            Of::Triangles => [0, self.cells_after, 0],
        }
    }
}

/// What the numbers of an array belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// Points.
    Points,
    /// Lines, in their own section.
    Lines,
    /// All cells; the numbers of the lines are kept.
    Cells,
    /// Polygons, of a file without other cells.
    Triangles,
}

/// How many numbers an array must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// This many for each; the text names them in messages: "values".
    Each(Of, u64, &'static str),
    /// Any number for each cell, the same for all; the numbers of the lines are kept.
    Tuples,
    /// Any number.
    Any,
    /// Field data of at most this many.
    Field(u64),
}

/// Largest possible number of values of an array; `shape`: None if it is not used.
pub(super) fn most_values(shape: Option<Shape>, counts: &Counts) -> u64 {
    const OF_OTHER: u64 = 1 << 16;
    const OF_OTHER_PER_CELL: u64 = 1 << 10;
    /// Elements of a flat joint, and vectors of them.
    const OF_TUPLE: u64 = 30_000;
    let of_tuples = counts.cells().saturating_mul(OF_TUPLE);
    let all = counts.points.saturating_add(counts.cells());
    let of_other = all
        .saturating_mul(OF_OTHER_PER_CELL)
        .saturating_add(OF_OTHER);
    match shape {
        Some(Shape::Each(of, numbers, _)) => {
            let count = counts.parts(of).into_iter().fold(0, u64::saturating_add);
            count.saturating_mul(numbers)
        }
        Some(Shape::Tuples) => of_tuples,
        Some(Shape::Field(most)) => most,
        Some(Shape::Any) => of_other.saturating_add(of_tuples),
        None => of_other,
    }
}
