//! Integrals over the union of spheres, by its surface.
//!
//! By the divergence theorem, the integrals of 1, x and x x over the union are integrals of
//! polynomials over the free part of each sphere. On the unit sphere, a spherical harmonic Y of
//! degree l has the Laplacian -l (l + 1) Y, so that its integral over a part of the sphere is -1 /
//! (l (l + 1)) times that of its normal derivative along the edge: arcs of circles, with closed
//! forms. This leaves the area (l = 0). Its one-form is singular at one point, which is placed far
//! from all circles; each arc contributes the rotation of its stereographic image minus its own
//! curvature.
//!
//! Everything is continuous in the arcs: an arc lost or kept due to rounding changes the result
//! only by rounding.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use super::caps::{Arc, Cap, Hidden, free_arcs, hidden, prune};
use super::cells::Cells;

/// Integrals over a solid.
pub struct Solid {
    /// m^3.
    pub volume: f64,
    /// Of x, m^4.
    pub first: Vector3<f64>,
    /// Of x x^T, m^5.
    pub second: Matrix3<f64>,
}

/// Integrals over a part of the unit sphere, of points u, and for a vector c.
pub struct Patch {
    /// Of 1.
    pub area: f64,
    /// Of u.
    pub first: Vector3<f64>,
    /// Of u u^T.
    pub second: Matrix3<f64>,
    /// Of u u^T (u . c).
    pub third: Matrix3<f64>,
}

/// The integrals over the union of balls around `centres`, m, with `radii`, m, of the same number.
pub fn solid(centres: &[[f64; 3]], radii: &[f64]) -> Solid {
    let mut sum = Solid {
        volume: 0.0,
        first: Vector3::zeros(),
        second: Matrix3::zeros(),
    };
    patches(centres, radii, |centre, r, patch| {
        let area = r * r;
        let height = centre.dot(&patch.first) + r * patch.area;
        let moment = patch.second * centre + r * patch.first;
        let cross = centre * moment.transpose();
        sum.volume += area * height / 3.0;
        sum.first += (centre * height + r * moment) * (area / 4.0);
        sum.second += (centre * centre.transpose() * height
            + (cross + cross.transpose() + (patch.third + r * patch.second) * r) * r)
            * (area / 5.0);
    });
    sum
}

/// Calls `each` with the centre, m, the radius, m, and the free part of each sphere that has one.
pub fn patches(
    centres: &[[f64; 3]],
    radii: &[f64],
    mut each: impl FnMut(Vector3<f64>, f64, &Patch),
) {
    let largest = radii.iter().fold(0.0_f64, |most, &r| most.max(r));
    let cells = Cells::new(centres, 2.0 * largest);
    let (mut near, mut caps, mut free) = (Vec::new(), Vec::new(), Vec::new());
    'spheres: for (i, (centre, &radius)) in (0_u32..).zip(centres.iter().zip(radii)) {
        // NaN does not count as a sphere either.
        if radius.is_nan() || radius <= 0.0 {
            continue;
        }
        cells.near(centre, &mut near);
        let centre = Vector3::from(*centre);
        caps.clear();
        for &j in near.iter().filter(|&&j| j != i) {
            let offset = Vector3::from(centres[j as usize]) - centre;
            match hidden(radius, offset, radii[j as usize], j < i) {
                Hidden::Nothing => {}
                Hidden::Part(cap) => caps.push(cap),
                Hidden::All => continue 'spheres,
            }
        }
        if prune(&mut caps) {
            each(centre, radius, &Patch::outside(&caps, centre, &mut free));
        }
    }
}

impl Patch {
    /// The part of the unit sphere outside all caps, which must be the result of [`prune`].
    fn outside(caps: &[Cap], c: Vector3<f64>, free: &mut Vec<Arc>) -> Self {
        let (pole, is_free) = far_point(caps);
        let mut edge = Edge::zero();
        for (circle, cap) in caps.iter().enumerate() {
            free_arcs(caps, circle, free);
            for &[from, to] in &*free {
                // Split in two, as half a revolution is the limit for one arc.
                let middle = 0.5 * (from + to);
                edge.add(cap, [from, middle], &-pole, &c);
                edge.add(cap, [middle, to], &-pole, &c);
            }
        }
        let area = edge.turn + if is_free { 4.0 * PI } else { 0.0 };
        let first = edge.first / -2.0;
        let cross = first * c.transpose();
        let line = cross + cross.transpose() + Matrix3::from_diagonal_element(first.dot(&c));
        Self {
            area,
            first,
            second: Matrix3::from_diagonal_element(area / 3.0) - edge.second / 6.0,
            third: line / 5.0 - edge.third / 12.0,
        }
    }
}

/// A point of the unit sphere far from the edges of the part outside all caps, and whether it lies
/// in that part.
fn far_point(caps: &[Cap]) -> (Vector3<f64>, bool) {
    let Some(largest) = caps.first() else {
        return (Vector3::z(), true);
    };
    let mut best = (largest.axis, false);
    let mut clearance = largest.cosine.acos();
    if clearance > 0.5 {
        return best;
    }
    let signs = [-1.0, 0.0, 1.0];
    for (x, y, z) in signs
        .iter()
        .flat_map(|x| signs.iter().map(move |y| (x, y)))
        .flat_map(|(x, y)| signs.iter().map(move |z| (*x, *y, *z)))
        .filter(|v| *v != (0.0, 0.0, 0.0))
    {
        let point = Vector3::new(x, y, z).normalize();
        let (mut least, mut is_free) = (PI, true);
        for cap in caps {
            let height = point.dot(&cap.axis);
            is_free &= height < cap.cosine;
            least = least.min((height.clamp(-1.0, 1.0).acos() - cap.cosine.acos()).abs());
        }
        if least > clearance {
            clearance = least;
            best = (point, is_free);
        }
    }
    best
}

/// Integrals along arcs of the edge, with the cap on the right.
struct Edge {
    /// Rotation of the stereographic image minus the curvature of the arc itself.
    turn: f64,
    /// Of the normal derivatives into the caps of u, u u^T and the harmonic part of u u^T (u . c).
    first: Vector3<f64>,
    second: Matrix3<f64>,
    third: Matrix3<f64>,
}

impl Edge {
    fn zero() -> Self {
        Self {
            turn: 0.0,
            first: Vector3::zeros(),
            second: Matrix3::zeros(),
            third: Matrix3::zeros(),
        }
    }

    /// Adds an arc of at most half a revolution; `sight` is the point opposite the centre of the
    /// stereographic image.
    fn add(&mut self, cap: &Cap, [from, to]: Arc, sight: &Vector3<f64>, c: &Vector3<f64>) {
        let half = 0.5 * (to - from);
        let (sin_mid, cos_mid) = (0.5 * (from + to)).sin_cos();
        let (sin, cos) = half.sin_cos();
        let n = cap.axis;
        let f = cap.across[0] * cos_mid + cap.across[1] * sin_mid;
        let g = cap.across[1] * cos_mid - cap.across[0] * sin_mid;
        let (along, out) = (cap.cosine, cap.sine);

        // The arc is traversed from its larger angle to its smaller one.
        let start = n * along + (f * cos + g * sin) * out;
        let bend = stereographic_turn(&start, &(f * sin - g * cos), &-g, sight);
        self.turn += 2.0 * bend + along * 2.0 * half;

        // Integrals of 1, cos, cos^2, sin^2, cos^3 and cos sin^2 of the angle from the middle.
        let [i, ic] = [2.0 * half, 2.0 * sin];
        let [icc, iss] = [half + sin * cos, half - sin * cos];
        let icss = 2.0 * sin * sin * sin / 3.0;
        let iccc = ic - icss;

        let outer = |a: &Vector3<f64>, b: &Vector3<f64>| a * b.transpose();
        let both = |a: &Vector3<f64>, b: &Vector3<f64>| outer(a, b) + outer(b, a);
        let (nn, nf) = (
            outer(&n, &n) * (along * along),
            both(&n, &f) * (along * out),
        );
        let (ff, gg) = (outer(&f, &f) * (out * out), outer(&g, &g) * (out * out));
        let u = n * (along * i) + f * (out * ic);
        let uu = nn * i + nf * ic + ff * icc + gg * iss;
        let uu_cos = nn * ic + nf * icc + ff * iccc + gg * icss;
        let uu_sin = both(&n, &g) * (along * out * iss) + both(&f, &g) * (out * out * icss);
        let (cn, cf, cg) = (n.dot(c), f.dot(c), g.dot(c));
        let uuc = uu * (along * cn) + uu_cos * (out * cf) + uu_sin * (out * cg);

        // The normal times the length: (n - along u) d(angle).
        let first = n * i - u * along;
        let third = both(&n, &(uu * c)) + uu * cn - uuc * (3.0 * along);
        let line = both(&first, c) + Matrix3::from_diagonal_element(first.dot(c));
        self.first += first;
        self.second += both(&n, &u) - uu * (2.0 * along);
        self.third += third - line / 5.0;
    }
}

/// Half the rotation of the stereographic image of an arc, rad: the angle between its tangent at
/// the start and its chord.
fn stereographic_turn(
    start: &Vector3<f64>,
    tangent: &Vector3<f64>,
    chord: &Vector3<f64>,
    sight: &Vector3<f64>,
) -> f64 {
    let height = 0.5 * (start + sight).norm_squared();
    let image = |t: &Vector3<f64>| t - start * (t.dot(sight) / height);
    let (tangent, chord) = (image(tangent), image(chord));
    let along = tangent.dot(&chord) - tangent.dot(sight) * chord.dot(sight);
    sight.dot(&tangent.cross(&chord)).atan2(along)
}
