//! The surface of a union of balls is closed.

use dem_physics::shape::union::{patches, solid};
use nalgebra::{Matrix3, Vector3};

/// The integral of the normal over a closed surface is zero, and that of x n^T the volume times
/// one.
#[test]
fn surface_is_closed() {
    let mut state = 1_u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for count in [2, 3, 5, 20, 200, 2000] {
        let centres: Vec<[f64; 3]> = (0..count).map(|_| [0; 3].map(|_| 3.0 * next())).collect();
        let radii: Vec<f64> = (0..count).map(|_| 0.1 + 0.9 * next()).collect();
        let (mut normal, mut moment) = (Vector3::zeros(), Matrix3::zeros());
        patches(&centres, &radii, |centre, r, patch| {
            normal += patch.first * (r * r);
            moment += (centre * patch.first.transpose() + patch.second * r) * (r * r);
        });
        let volume = solid(&centres, &radii).volume;
        let wanted = Matrix3::from_diagonal_element(volume);
        assert!(normal.amax() < 1e-14 * volume, "{count}: {normal}");
        assert!(
            (moment - wanted).amax() < 1e-13 * volume,
            "{count}: {moment}"
        );
    }
}
