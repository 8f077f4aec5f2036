//! A piece of filter cake.

use super::mesh::Mesh;
use super::noise::layered;
use std::collections::BTreeMap;

const SEED: u64 = 5;
/// Cells along x, y and z.
const CELLS: [usize; 3] = [44, 30, 11];

/// A plate of about 120 x 80 x 30 mm: the top and bottom as pressed by the filter press, slightly
/// uneven; the four sides broken, slanted and rough, with chipped edges. It is a box of cells with
/// its sides moved.
pub(crate) fn filter_cake() -> Mesh {
    let mut mesh = Mesh::default();
    let mut known = BTreeMap::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for far in [false, true] {
            for i in 0..CELLS[u] {
                for j in 0..CELLS[v] {
                    let corner = |di: usize, dj: usize| {
                        let mut at = [0; 3];
                        at[axis] = if far { CELLS[axis] } else { 0 };
                        at[u] = i + di;
                        at[v] = j + dj;
                        at
                    };
                    let around = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]
                        .map(|at| *known.entry(at).or_insert_with(|| mesh.vertex(place(at))));
                    let [a, b, c, d] = around;
                    mesh.quad(if far { [a, b, c, d] } else { [d, c, b, a] });
                }
            }
        }
    }
    mesh
}

/// Position of a corner of the cells, mm.
fn place(at: [usize; 3]) -> [f64; 3] {
    let [s, t, w]: [f64; 3] = std::array::from_fn(|k| at[k] as f64 / CELLS[k] as f64);
    let slant = |by: f64| by * (w - 0.5);
    let left = line(&[(0.0, 10.0), (0.35, 3.0), (0.7, 7.0), (1.0, 18.0)], t) - slant(6.0);
    let right = line(
        &[(0.0, 112.0), (0.45, 117.0), (0.8, 111.0), (1.0, 101.0)],
        t,
    ) - slant(9.0);
    let front = line(
        &[
            (0.0, 12.0),
            (0.25, 6.0),
            (0.6, 3.0),
            (0.85, 8.0),
            (1.0, 17.0),
        ],
        s,
    ) + slant(8.0);
    let back = line(
        &[
            (0.0, 69.0),
            (0.3, 77.0),
            (0.55, 74.0),
            (0.8, 78.0),
            (1.0, 72.0),
        ],
        s,
    ) + slant(5.0);
    // The roughness of one side does not reach far inside.
    let x = left + s * (right - left) + (1.0 - s).powi(6) * broken_mm(1, t, 80.0, w)
        - s.powi(6) * broken_mm(2, t, 80.0, w);
    let y = front + t * (back - front) + (1.0 - t).powi(4) * broken_mm(3, s, 120.0, w)
        - t.powi(4) * broken_mm(4, s, 120.0, w);
    let bottom = 0.35 * layered(SEED + 10, [x / 22.0, y / 22.0, 0.0], 3, 0.45);
    let top = 30.0 + 0.7 * layered(SEED + 20, [x / 30.0, y / 30.0, 0.0], 4, 0.45);
    [x, y, bottom + w * (top - bottom)]
}

/// Distance of a broken side behind its plan line, mm: rough, and chipped along its upper and lower
/// edge. `along` goes from 0 to 1 over `length` mm, `w` from 0 at the bottom to 1 at the top.
fn broken_mm(side: u64, along: f64, length: f64, w: f64) -> f64 {
    let place = along * length;
    let rough = 2.4
        * layered(
            SEED + 30 * side,
            [place / 14.0, w * 30.0 / 14.0, 0.0],
            3,
            0.5,
        );
    let plane = if w > 0.5 { 3.0 } else { 0.0 };
    let chip = layered(SEED + 30 * side + 7, [place / 17.0, plane, 0.5], 2, 0.5).max(0.0);
    let edge = (2.0 * w - 1.0).powi(4);
    let inner = 1.0 - (2.0 * along - 1.0).powi(8);
    inner * (rough + edge * (1.0 + 6.0 * chip))
}

/// The value at `x` of the line through `points`.
fn line(points: &[(f64, f64)], x: f64) -> f64 {
    let piece = points
        .windows(2)
        .find(|p| x <= p[1].0)
        .unwrap_or(&points[points.len() - 2..]);
    let ((x0, y0), (x1, y1)) = (piece[0], piece[1]);
    y0 + (y1 - y0) * (x - x0) / (x1 - x0)
}
