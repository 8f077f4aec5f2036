//! Linear systems with a symmetric tangent by conjugate gradients, for bodies whose factors would
//! not fit into memory: what it needs grows with the number of particles.
//!
//! The preconditioner has two levels that are added: the diagonal block of every particle, and the
//! rigid motions of groups of neighbouring particles, which carry forces across the body. The
//! number of iterations then depends on the size of the groups rather than on that of the body.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, Vector3};

use super::degrees_of_freedom::Node;
use super::direct::{DirectFactor, NoFactor};
use super::matrix::Matrix;

/// Particles in a group, on average.
const GROUP: f64 = 60.0;
/// Iterations after which there is no hope.
const MOST_ITERATIONS: usize = 5000;
/// Addition to the diagonal of the coarse matrix, relative to its largest entry: groups without a
/// rigid motion of their own have empty rows.
const REGULAR: f64 = 1e-12;

/// A matrix, and what approximates its inverse.
#[derive(Debug)]
pub struct ConjugateGradients {
    /// The unknowns of each particle: first, and inverse of its diagonal block.
    blocks: Vec<(usize, DMatrix<f64>)>,
    /// Group of each unknown and its motion under the six rigid motions of the group. Length of
    /// the unknowns.
    rigid: Vec<(usize, [f64; 6])>,
    /// Factors of the stiffness between groups.
    coarse: DirectFactor,
    /// Number of groups.
    groups: usize,
    matrix: Matrix,
}

impl ConjugateGradients {
    /// For a symmetric positive definite matrix whose unknowns have these nodes.
    pub fn new(matrix: &Matrix, nodes: &[Node]) -> Result<Self, NoFactor> {
        let (groups, rigid) = rigid_motions(nodes);
        let coarse_matrix = coarse(matrix, &rigid, groups);
        let mut coarse = DirectFactor::new(&coarse_matrix)?;
        coarse.compute(&coarse_matrix)?;
        Ok(Self {
            blocks: blocks(matrix, nodes)?,
            rigid,
            coarse,
            groups,
            matrix: matrix.clone(),
        })
    }

    /// Replaces the right-hand side by the solution; the norm of the residual, weighted by the
    /// preconditioner, falls by `accuracy`. Returns the number of iterations.
    pub fn solve(&self, side: &mut [f64], accuracy: f64) -> Result<usize, NoFactor> {
        let mut residual = side.to_vec();
        side.fill(0.0);
        let mut step = self.precondition(&residual);
        let mut size = dot(&residual, &step);
        let wanted = size * accuracy * accuracy;
        let mut direction = step.clone();
        let mut image = vec![0.0; residual.len()];
        for iteration in 0..MOST_ITERATIONS {
            if size <= wanted || size == 0.0 {
                return Ok(iteration);
            }
            self.matrix.multiply(&direction, &mut image);
            let curvature = dot(&direction, &image);
            if curvature.is_nan() || curvature <= 0.0 {
                return Err(NoFactor::Pivot);
            }
            let length = size / curvature;
            for (at, (side, residual)) in side.iter_mut().zip(&mut residual).enumerate() {
                *side += length * direction[at];
                *residual -= length * image[at];
            }
            step = self.precondition(&residual);
            let new = dot(&residual, &step);
            let kept = new / size;
            size = new;
            for (direction, step) in direction.iter_mut().zip(&step) {
                *direction = step + kept * *direction;
            }
        }
        Err(NoFactor::NoConvergence)
    }

    /// The two levels applied to a residual.
    fn precondition(&self, residual: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; 6 * self.groups];
        for ((group, motion), residual) in self.rigid.iter().zip(residual) {
            for (sum, motion) in sums[6 * group..6 * group + 6].iter_mut().zip(motion) {
                *sum += motion * residual;
            }
        }
        self.coarse.solve(&mut sums);
        let carried = |(group, motion): &(usize, [f64; 6])| {
            let own = sums[6 * group..6 * group + 6].iter();
            own.zip(motion).map(|(sum, motion)| sum * motion).sum()
        };
        let mut found: Vec<f64> = self.rigid.iter().map(carried).collect();
        for (first, inverse) in &self.blocks {
            let size = inverse.nrows();
            for row in 0..size {
                let sum: f64 = (0..size)
                    .map(|column| inverse[(row, column)] * residual[first + column])
                    .sum();
                found[first + row] += sum;
            }
        }
        found
    }
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Inverses of the diagonal blocks of all particles, each with its first unknown.
fn blocks(matrix: &Matrix, nodes: &[Node]) -> Result<Vec<(usize, DMatrix<f64>)>, NoFactor> {
    let mut found = Vec::new();
    let mut first = 0;
    for own in nodes.chunk_by(|a, b| a.particle == b.particle) {
        let size = own.len();
        let mut block = DMatrix::zeros(size, size);
        for column in 0..size {
            let entries = matrix.starts[first + column]..matrix.starts[first + column + 1];
            for at in entries {
                let row = matrix.rows[at];
                if row < first + size {
                    block[(row - first, column)] = matrix.values[at];
                    block[(column, row - first)] = matrix.values[at];
                }
            }
        }
        let inverse = block.cholesky().ok_or(NoFactor::Pivot)?.inverse();
        found.push((first, inverse));
        first += size;
    }
    Ok(found)
}

/// Number of groups; group of each unknown, and its motion under the rigid motions of the group.
fn rigid_motions(nodes: &[Node]) -> (usize, Vec<(usize, [f64; 6])>) {
    let count = nodes
        .chunk_by(|a, b| a.particle == b.particle)
        .count()
        .max(1);
    let radii = nodes.chunk_by(|a, b| a.particle == b.particle);
    let mean_m = radii.map(|own| own[0].radius_m).sum::<f64>() / count as f64;
    let edge_m = 2.0 * mean_m * GROUP.cbrt();
    let cell = |node: &Node| node.place_m.map(|x| (x / edge_m).floor() as i64);
    // Number, sum of places, count.
    let mut cells: BTreeMap<[i64; 3], (usize, Vector3<f64>, f64)> = BTreeMap::new();
    for node in nodes {
        let next = cells.len();
        let entry = cells
            .entry(cell(node))
            .or_insert((next, Vector3::zeros(), 0.0));
        entry.1 += Vector3::from(node.place_m);
        entry.2 += 1.0;
    }
    let motion = |node: &Node| {
        let (group, sum, count) = cells[&cell(node)];
        let arm = Vector3::from(node.place_m) - sum / count;
        let mut motion = [0.0; 6];
        motion[node.freedom] = 1.0;
        if node.freedom < 3 {
            for axis in 0..3 {
                let mut turn = Vector3::zeros();
                turn[axis] = 1.0;
                motion[3 + axis] = turn.cross(&arm)[node.freedom];
            }
        }
        (group, motion)
    };
    (cells.len(), nodes.iter().map(motion).collect())
}

/// Stiffness between the six rigid motions of two groups: rows, then columns.
type Block = [[f64; 6]; 6];

/// The stiffness between the rigid motions of groups, lower triangle.
fn coarse(matrix: &Matrix, rigid: &[(usize, [f64; 6])], groups: usize) -> Matrix {
    let blocks = group_blocks(matrix, rigid, groups);
    let diagonal = (0..groups).flat_map(|group| {
        let block = &blocks[&(group, group)];
        (0..6).map(|k| block[k][k])
    });
    let largest = diagonal.fold(0.0, f64::max);
    let mut found = Matrix {
        symmetric: true,
        starts: vec![0],
        rows: Vec::new(),
        values: Vec::new(),
    };
    for group in 0..groups {
        for column in 0..6 {
            for ((_, row_group), block) in blocks.range((group, 0)..(group + 1, 0)) {
                let is_diagonal = *row_group == group;
                let first = if is_diagonal { column } else { 0 };
                for (row, entries) in block.iter().enumerate().skip(first) {
                    let value = match entries[column] {
                        // A group without this motion of its own.
                        0.0 if is_diagonal && row == column => largest,
                        value if is_diagonal && row == column => value + REGULAR * largest,
                        value => value,
                    };
                    found.rows.push(6 * row_group + row);
                    found.values.push(value);
                }
            }
            found.starts.push(found.rows.len());
        }
    }
    found
}

/// The blocks of that stiffness by the groups of their columns and rows, lower triangle.
fn group_blocks(
    matrix: &Matrix,
    rigid: &[(usize, [f64; 6])],
    groups: usize,
) -> BTreeMap<(usize, usize), Block> {
    let mut blocks: BTreeMap<(usize, usize), Block> = BTreeMap::new();
    for group in 0..groups {
        blocks.insert((group, group), Block::default());
    }
    let mut add = |row: &(usize, [f64; 6]), column: &(usize, [f64; 6]), value: f64| {
        if row.0 < column.0 {
            return;
        }
        let block = blocks.entry((column.0, row.0)).or_default();
        for (entries, row) in block.iter_mut().zip(row.1).filter(|(_, row)| *row != 0.0) {
            for (entry, column) in entries.iter_mut().zip(column.1) {
                *entry += row * value * column;
            }
        }
    };
    for column in 0..matrix.starts.len() - 1 {
        for at in matrix.starts[column]..matrix.starts[column + 1] {
            let (row, value) = (matrix.rows[at], matrix.values[at]);
            add(&rigid[row], &rigid[column], value);
            if row != column {
                add(&rigid[column], &rigid[row], value);
            }
        }
    }
    blocks
}
