//! The order of spheres in memory.

use crate::spheres::ReducedSphere;

/// Sorts spheres by the Morton code of cells of edge 4 `radius`, so that neighbours in space are
/// neighbours in memory.
pub(super) fn sort_along_curve(spheres: &mut [ReducedSphere], radius: f64) {
    let code = |sphere: &ReducedSphere| {
        let cell = [0, 1, 2].map(|k| (sphere[k] / (4.0 * radius)).clamp(0.0, 2_097_151.0) as u64);
        spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
    };
    spheres.sort_by_cached_key(code);
}

/// The 21 lowest bits of `x`, two zeros between each and the next.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}
