//! The part of a packed body's section that bears: bonds join the centres of spheres, and those of
//! the outermost spheres lie within the faces, so that a layer at each face bears nothing.

/// Thickness of the layers at two opposite faces together, over the mean diameter of the spheres.
/// Bars of 5 to 15 spheres across in tension follow the law within 1.2 %, with 0.72 where an
/// overlap of 0.296 bonds touching spheres, and 0.65 where bonds reach a tenth further and the
/// overlap is 0.25: doc/sphere-size.md.
const LAYER: f64 = 0.7;

/// Fewest spheres across for which the law holds.
pub const FEWEST_ACROSS: f64 = 3.0;

/// Part of the section that bears in a body of the same spheres across in both directions of its
/// section: its modulus and strength over those of a large body of such bonds.
pub fn bearing_part(spheres_across: f64) -> f64 {
    (1.0 - LAYER / spheres_across).powi(2)
}

/// Factor on modulus and strengths of bonds that were calibrated in a body of `calibrated_across`
/// spheres across, with which a body of `spheres_across` is as stiff and strong.
pub fn size_correction(calibrated_across: f64, spheres_across: f64) -> f64 {
    bearing_part(calibrated_across) / bearing_part(spheres_across)
}

#[cfg(test)]
mod tests {
    use super::{bearing_part, size_correction};

    #[test]
    fn small_bodies_need_stiffer_bonds() {
        assert!((bearing_part(7.0) - 0.81).abs() < 1e-12);
        assert!((size_correction(7.0, 3.5) - 0.81 / 0.64).abs() < 1e-12);
        assert!((size_correction(6.0, 9.0) * size_correction(9.0, 6.0) - 1.0).abs() < 1e-12);
    }
}
