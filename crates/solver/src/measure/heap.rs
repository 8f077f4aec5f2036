//! The angle of repose of a heap.

use nalgebra::Vector3;

use crate::state::particles::Particles;

/// Median height of the mass of a cone over its height: 1 - (1 - z/H)^3 = 1/2.
const MEDIAN_HEIGHT: f64 = 0.206_299_474_015_900_3;
/// Median distance from the axis of the mass of a cone over the radius of its base: 3 x^2 - 2 x^3 = 1/2.
const MEDIAN_RADIUS: f64 = 0.5;

/// Slope of the cone whose mass has the same median height above the lowest point and the same median distance from the upright axis through the middle
/// of the mass as these particles, rad. Few that have rolled far away do not change it. `up`: unit vector.
pub(super) fn angle_of_repose_rad(particles: &Particles, some: &[u32], up: Vector3<f64>) -> f64 {
    let aside = up.cross(&Vector3::ith(up.iamin(), 1.0)).normalize();
    let across = up.cross(&aside);
    let pose = |i: u32| &particles.poses[i as usize];
    let mass = |i: u32| 1.0 / particles.motions[i as usize].inverse_mass;
    let median_of =
        |value: &dyn Fn(u32) -> f64| median(some.iter().map(|&i| (value(i), mass(i))).collect());
    let axis = [aside, across].map(|along| median_of(&|i| pose(i).place().dot(&along)));
    let radius = median_of(&|i| {
        let place = pose(i).place();
        (place.dot(&aside) - axis[0]).hypot(place.dot(&across) - axis[1])
    });
    let height = |i: u32| pose(i).place().dot(&up);
    let ground = some
        .iter()
        .map(|&i| height(i) - pose(i).radius_m())
        .fold(f64::INFINITY, f64::min);
    let middle = median_of(&height) - ground;
    (middle / MEDIAN_HEIGHT).atan2(radius / MEDIAN_RADIUS)
}

/// The value below which half of the weight is.
fn median(mut values: Vec<(f64, f64)>) -> f64 {
    values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * values.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut below = 0.0;
    for (value, weight) in values {
        below += weight;
        if below >= half {
            return value;
        }
    }
    f64::NAN
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_of_many_small_spheres_has_its_angle() {
        let (radius, height): (f64, f64) = (1.0, 0.6);
        let mut particles = Particles::default();
        let step = 0.02;
        let count = (1.0 / step) as i32;
        for x in -count..=count {
            for y in -count..=count {
                for z in 0..=5 * count {
                    let [x, y] = [x, y].map(|n| f64::from(n) * step);
                    let z = f64::from(z) * 0.2 * step;
                    if x.hypot(y) < radius * (1.0 - z / height) {
                        // A tilted world: up is x.
                        particles.push_sphere([z + 5.0, x - 3.0, y], 1e-6, 1000.0);
                    }
                }
            }
        }
        let all: Vec<u32> = (0..particles.len() as u32).collect();
        let angle = angle_of_repose_rad(&particles, &all, Vector3::x());
        let wanted = height.atan2(radius);
        assert!((angle - wanted).abs() < 0.01, "{angle} for {wanted}");
    }
}
