//! Surfaces of machines as facets, in mm.

use std::f64::consts::TAU;

/// Three corners, anticlockwise from outside, mm.
pub(super) type Facet = [[f64; 3]; 3];

/// Corners of the polygon that stands for the circles of a crusher.
const CORNERS: u32 = 48;

/// The surface of a line of points (radius, height) that goes round the z axis. It is closed if the
/// line begins and ends on the axis; upwards its outside is the outer one.
pub(super) fn revolved(line: &[[f64; 2]]) -> Vec<Facet> {
    let at = |[radius, height]: [f64; 2], corner: u32| {
        // The last corner is the first one, to the bit.
        let (sine, cosine) = (TAU * f64::from(corner % CORNERS) / f64::from(CORNERS)).sin_cos();
        [radius * cosine, radius * sine, height]
    };
    let mut facets = Vec::new();
    for ends in line.windows(2) {
        let [low, high] = [ends[0], ends[1]];
        for corner in 0..CORNERS {
            let [a, b] = [corner, corner + 1].map(|corner| at(low, corner));
            let [c, d] = [corner + 1, corner].map(|corner| at(high, corner));
            let pair = [(low, [a, b, c]), (high, [a, c, d])];
            // At a point on the axis one of the two has no area.
            facets.extend(
                pair.into_iter()
                    .filter(|(end, _)| end[0] > 0.0)
                    .map(|(_, facet)| facet),
            );
        }
    }
    facets
}

/// A plate with square openings: its middle at the origin, its faces normal to z.
#[derive(Debug, Clone, Copy)]
pub(super) struct Deck {
    /// Openings along x and y.
    pub(super) openings: [u32; 2],
    /// Width of an opening, mm.
    pub(super) opening: f64,
    /// Width of the bars between them, mm; half as wide around them all.
    pub(super) bar: f64,
    /// Thickness, mm.
    pub(super) thickness: f64,
}

impl Deck {
    pub(super) fn facets(&self) -> Vec<Facet> {
        let pitch = self.opening + self.bar;
        let [nx, ny] = self.openings;
        let mut facets = Vec::new();
        let mut add = |[a, b, c, d]: [[f64; 3]; 4]| facets.extend([[a, b, c], [a, c, d]]);
        let [up, down] = [0.5, -0.5].map(|half| half * self.thickness);
        for i in 0..nx {
            for j in 0..ny {
                let at = |n: u32, of: u32| (f64::from(n) - 0.5 * f64::from(of)) * pitch;
                let outer = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]]
                    .map(|[i, j]| [at(i, nx), at(j, ny)]);
                let half = 0.5 * self.bar;
                let inwards = [[half, half], [-half, half], [-half, -half], [half, -half]];
                let inner = [0, 1, 2, 3].map(|k| [0, 1].map(|n| outer[k][n] + inwards[k][n]));
                let is_edge = [j == 0, i + 1 == nx, j + 1 == ny, i == 0];
                for k in 0..4 {
                    let next = (k + 1) % 4;
                    let point = |[x, y]: [f64; 2], z: f64| [x, y, z];
                    let [from, to, in_to, in_from] = [outer[k], outer[next], inner[next], inner[k]];
                    add([
                        point(from, up),
                        point(to, up),
                        point(in_to, up),
                        point(in_from, up),
                    ]);
                    add([
                        point(from, down),
                        point(in_from, down),
                        point(in_to, down),
                        point(to, down),
                    ]);
                    add([
                        point(in_from, up),
                        point(in_to, up),
                        point(in_to, down),
                        point(in_from, down),
                    ]);
                    if is_edge[k] {
                        add([
                            point(from, down),
                            point(to, down),
                            point(to, up),
                            point(from, up),
                        ]);
                    }
                }
            }
        }
        facets
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume that facets enclose.
    fn volume(facets: &[Facet]) -> f64 {
        let of = |[a, b, c]: &Facet| {
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        facets.iter().map(of).sum::<f64>() / 6.0
    }

    /// Each edge belongs to two facets, once in each direction.
    fn is_closed(facets: &[Facet]) -> bool {
        let edges: Vec<[[u64; 3]; 2]> = (facets.iter())
            .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|edge| edge.map(|point| point.map(|x| (x + 0.0).to_bits())))
            .collect();
        edges.iter().all(|[from, to]| {
            let count =
                |wanted: [[u64; 3]; 2]| edges.iter().filter(|edge| **edge == wanted).count();
            count([*from, *to]) == 1 && count([*to, *from]) == 1
        })
    }

    #[test]
    fn a_deck_is_closed_and_has_the_volume_of_its_bars() {
        let deck = Deck {
            openings: [4, 2],
            opening: 12.0,
            bar: 4.0,
            thickness: 3.0,
        };
        let facets = deck.facets();
        assert!(is_closed(&facets));
        let wanted = 8.0 * (16.0 * 16.0 - 12.0 * 12.0) * 3.0;
        assert!((volume(&facets) / wanted - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_line_from_axis_to_axis_encloses_a_solid() {
        let facets = revolved(&[[0.0, 0.0], [3.0, 0.0], [1.0, 4.0], [0.0, 5.0]]);
        assert!(is_closed(&facets));
        // Frustum and cone on a regular polygon instead of a circle.
        let area = 0.5 * f64::from(CORNERS) * (TAU / f64::from(CORNERS)).sin();
        let wanted = area * (4.0 * (9.0 + 3.0 + 1.0) / 3.0 + 1.0 / 3.0);
        assert!((volume(&facets) / wanted - 1.0).abs() < 1e-12);
    }
}
