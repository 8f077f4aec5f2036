//! The jaw of a crusher: a plate with upright ribs.

use super::mesh::Mesh;

/// Number of ribs, their width and depth, the thickness of the plate behind them and the total
/// height, mm.
const RIBS: u32 = 8;
const WIDE: f64 = 20.0;
const DEEP: f64 = 8.0;
const THICK: f64 = 20.0;
const HIGH: f64 = 200.0;

/// Ribs towards +x, with their valleys in the plane x = 0, the middle in y = 0, the foot in z = 0.
pub(crate) fn jaw() -> Mesh {
    let mut mesh = Mesh::default();
    let count = 2 * RIBS + 1;
    // At each position along y: front and back at the foot, front and back at the top.
    for place in 0..count {
        let y = 0.5 * WIDE * (f64::from(place) - f64::from(RIBS));
        let front = if place % 2 == 1 { DEEP } else { 0.0 };
        for z in [0.0, HIGH] {
            mesh.vertex([front, y, z]);
            mesh.vertex([-THICK, y, z]);
        }
    }
    for place in 0..count - 1 {
        let [front, back, front_top, back_top] = [0, 1, 2, 3].map(|k| 4 * place + k);
        let next = |corner: u32| corner + 4;
        mesh.quad([front, next(front), next(front_top), front_top]);
        mesh.quad([back, back_top, next(back_top), next(back)]);
        mesh.quad([front, back, next(back), next(front)]);
        mesh.quad([front_top, next(front_top), next(back_top), back_top]);
    }
    mesh.quad([0, 2, 3, 1]);
    let last = 4 * (count - 1);
    mesh.quad([last, last + 1, last + 3, last + 2]);
    mesh
}
