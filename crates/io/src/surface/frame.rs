//! Local coordinates: near the origin and of size one, so that neither an offset nor a scale costs
//! digits.

use super::mesh::{Mesh, Point};
use crate::bounds::Bounds;
use crate::diagnostic::{Diagnostic, Result};
use crate::units::significant;

/// Shapes smaller or larger than this, in units of the file or in metres, are refused: their volume
/// would not be a number.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Where local coordinates lie in those of the file: `file = corner + size * local`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    /// Smallest corner of the bounding box, in units of the file.
    pub(super) corner: Point,
    /// A local unit in units of the file: the power of two that makes the largest extent 1 to 2
    /// local units.
    pub(super) size: f64,
}

impl Frame {
    /// The frame of these facets. `unit_m` is a unit of the file in metres. Refuses a shape without
    /// extent or of an implausible size.
    pub(super) fn around(facets: &[[[f64; 3]; 3]], unit_m: f64) -> Result<Self> {
        let bounds = Bounds::of(facets.iter().flatten().copied());
        let extent = largest_extent(&bounds);
        if extent == 0.0 {
            return Err(Diagnostic::input(
                "",
                "all triangles lie in one point",
                "export the shape again",
            ));
        }
        if !SIZES.contains(&extent) || !SIZES.contains(&(extent * unit_m)) {
            let problem = format!(
                "the shape is {extent:e} units long, a unit is {unit_m:e} m: not a size to compute with"
            );
            return Err(Diagnostic::input(
                "",
                problem,
                "give another --unit or --scale, or export the shape again",
            ));
        }
        Ok(Self {
            corner: bounds.low.into(),
            size: power_of_two_below(extent),
        })
    }

    /// File coordinates to local ones. Exact for the size; the difference from the corner is
    /// rounded once.
    pub(super) fn to_local(self, facets: Vec<[[f64; 3]; 3]>) -> Vec<[Point; 3]> {
        let local = |corner: [f64; 3]| (Point::from(corner) - self.corner) / self.size;
        facets.into_iter().map(|facet| facet.map(local)).collect()
    }

    /// A local point in units of the file.
    pub(super) fn in_file(&self, local: Point) -> Point {
        self.corner + self.size * local
    }

    /// A local point for a message, in units of the file. What rounding leaves of a zero is 0.
    pub(super) fn show(&self, local: Point) -> String {
        let shown = |x: f64| match x.abs() < 1e-9 * self.size {
            true => "0".to_owned(),
            false => significant(x, 9),
        };
        let [x, y, z] = <[f64; 3]>::from(self.in_file(local)).map(shown);
        format!("({x}, {y}, {z})")
    }

    /// A local length for a message, in units of the file.
    pub(super) fn show_length(&self, local: f64) -> String {
        significant(self.size * local, 4)
    }

    /// Moves and scales the mesh so that it fills the frame again, if triangles at its border were
    /// dropped.
    pub(super) fn fit(&mut self, mesh: &mut Mesh) {
        let bounds = Bounds::of(mesh.vertices.iter().copied());
        let size = power_of_two_below(largest_extent(&bounds));
        let low = Point::from(bounds.low);
        if low == Point::zeros() && size == 1.0 {
            return;
        }
        self.corner = self.in_file(low);
        self.size *= size;
        for vertex in &mut mesh.vertices {
            *vertex = (*vertex - low) / size;
        }
    }
}

fn largest_extent(bounds: &Bounds) -> f64 {
    (0..3)
        .map(|k| bounds.high[k] - bounds.low[k])
        .fold(0.0, f64::max)
}

/// The largest power of two that is not larger than `x`, a positive normal number.
fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn sizes_are_powers_of_two_and_offsets_cost_nothing() {
        for (x, power) in [
            (1.0, 1.0),
            (1.999, 1.0),
            (2.0, 2.0),
            (20.0, 16.0),
            (0.3, 0.25),
            (1e-30, 2.0_f64.powi(-100)),
        ] {
            assert_eq!(power_of_two_below(x), power);
        }
        let facet = [[0.0, 0.0, 0.0], [20.0, 0.5, 0.0], [0.0, 12.0, 10.0]];
        let near = Frame::around(&[facet], 1e-3).unwrap();
        let far_facet = facet.map(|p| p.map(|x| x + 1e6));
        let far = Frame::around(&[far_facet], 1e-3).unwrap();
        assert_eq!(near.to_local(vec![facet]), far.to_local(vec![far_facet]));
        assert_eq!((far.corner, far.size), ([1e6; 3].into(), 16.0));
    }

    #[test]
    fn rounding_errors_of_zero_are_shown_as_zero() {
        let frame =
            Frame::around(&[[[-6.0, -6.0, 0.0], [6.0; 3], [6.0, -6.0, 0.0]]], 1e-3).unwrap();
        let almost = [0.75, 0.75 + f64::EPSILON, 0.625].into();
        assert_ne!(frame.in_file(almost)[1], 0.0);
        assert_eq!(frame.show(almost), "(0, 0, 5)");
        assert_eq!(frame.show([0.75, 0.751, 0.0].into()), "(0, 0.008, 0)");
    }

    #[test]
    fn sizes_without_sense_are_refused() {
        let facet = |size: f64| [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0]];
        for (size, unit) in [
            (0.0, 1.0),
            (1e-70, 1.0),
            (1e308, 1.0),
            (1e-40, 1e-40),
            (1.0, f64::MAX),
        ] {
            assert!(Frame::around(&[facet(size)], unit).is_err());
        }
        assert!(Frame::around(&[[[-1.7e308; 3], [1.7e308; 3], [0.0; 3]]], 1.0).is_err());
    }
}
