//! Fits a packing of loose spheres into the particle that it replaces.

use nalgebra::Vector3;

/// Factors on the centres of a packing, about its centre of mass, and on its radii: the spheres get
/// this volume together, m3, and lie within this distance of the centre, m, as deep in each other
/// as that takes (Platzer 2022, section 2.1.1.1). `arms_m`: centres relative to the centre of mass.
/// Centres coincide if the spheres are too large for that.
pub fn fit(arms_m: &[[f64; 3]], radii_m: &[f64], volume_m3: f64, reach_m: f64) -> [f64; 2] {
    let cubes: f64 = radii_m.iter().map(|radius| radius.powi(3)).sum();
    let of_radii = (0.75 * volume_m3 / (std::f64::consts::PI * cubes)).cbrt();
    let room = |(arm, radius): (&[f64; 3], &f64)| {
        let far_m = Vector3::from(*arm).norm();
        (far_m > 0.0).then(|| (reach_m - of_radii * radius) / far_m)
    };
    let rooms = arms_m.iter().zip(radii_m).filter_map(room);
    let of_centres = rooms.fold(f64::INFINITY, f64::min);
    let of_centres = if of_centres.is_finite() {
        of_centres
    } else {
        1.0
    };
    [of_centres.max(0.0), of_radii]
}
