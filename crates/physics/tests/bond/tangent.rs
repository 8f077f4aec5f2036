//! The tangent of a bond compared with differences of its forces, and its asymmetry.

use super::total::{bond, largest};
use dem_physics::bond::tangent::{DEGREES_OF_FREEDOM, bond_tangent};
use dem_physics::bond::total::{End, bond_forces};
use dem_physics::dual::Dual;
use dem_physics::number::Number;
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

/// The ends after a small displacement or rotation along degree of freedom `j`.
fn moved(ends: &[End; 2], j: usize, by: f64) -> [End; 2] {
    let mut ends = *ends;
    let mut axis = Vector3::zeros();
    axis[j % 3] = by;
    let end = &mut ends[j / 6];
    if j % 6 < 3 {
        end.position_m += axis;
    } else {
        end.turned = UnitQuaternion::from_scaled_axis(axis) * end.turned;
    }
    ends
}

proptest! {
    #[test]
    fn tangent_is_the_derivative_of_the_forces((k, direction, ends) in bond()) {
        let forces = |ends: &[End; 2]| {
            let found = bond_forces(&k, &direction, ends);
            let [a, b] = found.torques;
            let parts = [-found.force_on_b, a, found.force_on_b, b];
            let mut all = [0.0; DEGREES_OF_FREEDOM];
            for (n, part) in parts.iter().enumerate() {
                all[3 * n..3 * n + 3].copy_from_slice(part.as_slice());
            }
            all
        };
        let tangent = bond_tangent(&k, &direction, &ends);
        let stiffest = tangent.iter().flatten().fold(0.0_f64, |s, entry| s.max(entry.abs()));
        let h = 3e-4;
        for j in 0..DEGREES_OF_FREEDOM {
            let [near, far] = [h, 2.0 * h].map(|h| {
                let (more, less) = (forces(&moved(&ends, j, h)), forces(&moved(&ends, j, -h)));
                let pairs = more.into_iter().zip(less);
                pairs.map(|(more, less)| more - less).collect::<Vec<f64>>()
            });
            for (i, row) in tangent.iter().enumerate() {
                // Fourth order.
                let slope = (8.0 * near[i] - far[i]) / (12.0 * h);
                let off = (row[j] + slope).abs();
                prop_assert!(off < 1e-9 * stiffest, "{i} {j}: {} and {slope}", row[j]);
            }
        }
    }

    #[test]
    fn tangent_is_symmetric_but_for_the_torques((k, direction, ends) in bond()) {
        let tangent = bond_tangent(&k, &direction, &ends);
        let forces = bond_forces(&k, &direction, &ends);
        let stiffest = tangent.iter().flatten().fold(largest(&forces), |s, entry| s.max(entry.abs()));
        let pairs = (0..DEGREES_OF_FREEDOM).flat_map(|i| (0..DEGREES_OF_FREEDOM).map(move |j| (i, j)));
        for (i, j) in pairs {
            let end = i / 6;
            let turns_of_one_end = i % 6 >= 3 && j % 6 >= 3 && j / 6 == end;
            let cross = if turns_of_one_end {
                forces.torques[end].cross_matrix()[(i % 3, j % 3)]
            } else {
                0.0
            };
            let off = tangent[i][j] - tangent[j][i] - cross;
            prop_assert!(off.abs() < 1e-13 * stiffest, "{i} {j}: {off}");
        }
    }

    /// Every operation, compared with explicit rules of differentiation.
    #[test]
    fn dual_numbers_differentiate(x in 0.2..3.0_f64, y in 0.2..3.0_f64) {
        let (a, b) = (Dual::<2>::variable(x, 0), Dual::<2>::variable(y, 1));
        let cases = [
            (a + b, x + y, [1.0, 1.0]),
            (a - b, x - y, [1.0, -1.0]),
            (a * b, x * y, [y, x]),
            (a / b, x / y, [1.0 / y, -x / (y * y)]),
            (-a, -x, [-1.0, 0.0]),
            (a.scale(3.0), 3.0 * x, [3.0, 0.0]),
            (a.plus(3.0), x + 3.0, [1.0, 0.0]),
            (b.inverse(), 1.0 / y, [0.0, -1.0 / (y * y)]),
            (b.sqrt(), y.sqrt(), [0.0, 0.5 / y.sqrt()]),
            (a.maximum(b), x.max(y), if x > y { [1.0, 0.0] } else { [0.0, 1.0] }),
            (a.minimum(b), x.min(y), if x < y { [1.0, 0.0] } else { [0.0, 1.0] }),
            ((-a).sign(), -1.0, [0.0, 0.0]),
            (a.if_positive(b), y, [0.0, 1.0]),
            ((-a).if_positive(b), 0.0, [0.0, 0.0]),
            (a.zero(), 0.0, [0.0, 0.0]),
            (Dual::constant(x), x, [0.0, 0.0]),
        ];
        for (n, (found, value, slopes)) in cases.into_iter().enumerate() {
            prop_assert!((found.value - value).abs() <= 1e-15 * value.abs(), "{n}");
            for (found, slope) in found.slopes.into_iter().zip(slopes) {
                prop_assert!((found - slope).abs() <= 1e-14 * slope.abs(), "{n}: {found} {slope}");
            }
        }
    }
}
