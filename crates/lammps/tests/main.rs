//! Types of bonds in LAMMPS.

use std::collections::BTreeSet;

use dem_lammps::bonds::{CLASS_WIDTH, Coefficients, classes};
use proptest::prelude::*;

proptest! {
    /// No class is wider than the width, equal bonds have one type and keep their numbers, and the
    /// mean of a class is within it.
    #[test]
    fn classes_of_bonds_are_narrow(scales in prop::collection::vec(0.5_f64..2.0, 1..60)) {
        let bond = |s: &f64| -> Coefficients {
            [1e9 * s, 1e7 / s, 3.0 * s * s, 2.0 * s, 1e300, 1e300, 1e300, s.powi(3), 0.0, s.sqrt(), 0.0, 1.0]
        };
        let mut all: Vec<Coefficients> = scales.iter().map(bond).collect();
        all.push(all[0]);
        let radii = vec![0.001; all.len()];
        let found = classes(&all, &radii);
        prop_assert_eq!(found.type_of[0], found.type_of[scales.len()]);
        let used: BTreeSet<u32> = found.type_of.iter().copied().collect();
        prop_assert_eq!(used.len(), found.types.len());
        for (number, one) in (0..).zip(&found.types) {
            let members: Vec<&Coefficients> =
                all.iter().zip(&found.type_of).filter(|(_, of)| **of == number).map(|(c, _)| c).collect();
            prop_assert_eq!(one.count, members.len());
            for k in 0..12 {
                let low = members.iter().map(|c| c[k]).fold(f64::INFINITY, f64::min);
                let high = members.iter().map(|c| c[k]).fold(0.0, f64::max);
                prop_assert!(high <= low * (1.0 + CLASS_WIDTH) * (1.0 + 1e-12));
                let rounding = 1e-12 * high;
                prop_assert!(low - rounding <= one.coefficients[k] && one.coefficients[k] <= high + rounding);
            }
        }
        prop_assert!(found.largest_error <= CLASS_WIDTH);
    }
}
