//! The list of near pairs compared with a test of every pair.

use dem_engine::stages::search::neighbours::near_pairs;
use dem_engine::state::particles::{Particles, Pose};
use proptest::prelude::*;

/// Pairs of different clusters that are near, one by one.
fn all_pairs(poses: &[Pose], clusters: &[u32], skin_m: f64) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for i in 0..poses.len() {
        for j in i + 1..poses.len() {
            let (a, b) = (&poses[i], &poses[j]);
            let gap = (b.place() - a.place()).norm() - a.radius_m() - b.radius_m();
            if clusters[i] != clusters[j] && gap < skin_m {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}

fn cloud(places: &[[f64; 3]], radii: &[f64]) -> Vec<Pose> {
    let mut particles = Particles::default();
    for (&place, &radius) in places.iter().zip(radii) {
        particles.push_sphere(place, radius, 1000.0);
    }
    particles.poses
}

proptest! {
    #[test]
    fn near_pairs_are_all_pairs_that_are_near(
        spheres in prop::collection::vec((prop::array::uniform3(-1.0..1.0), -6.5_f64..-2.0), 2..200),
        clusters in prop::collection::vec(0_u32..40, 200),
        skin_m in 0.001..0.1,
        spread in prop::sample::select(vec![[1.0, 1.0, 1.0], [30.0, 1.0, 0.1], [1e6, 1.0, 1.0], [0.0, 0.0, 1.0]]),
    ) {
        let places: Vec<[f64; 3]> = spheres
            .iter()
            .map(|(place, _)| [0, 1, 2].map(|k| spread[k] * place[k]))
            .collect();
        let radii: Vec<f64> = spheres.iter().map(|(_, octaves)| octaves.exp2()).collect();
        let poses = cloud(&places, &radii);
        let clusters = &clusters[..poses.len()];
        prop_assert_eq!(near_pairs(&poses, clusters, skin_m), all_pairs(&poses, clusters, skin_m));
    }
}

proptest! {
    /// Clusters of 16 and more spheres, whose number leaves any remainder in a block of them.
    #[test]
    fn large_clusters_have_all_near_pairs(
        bodies in prop::collection::vec(
            (
                prop::array::uniform3(-1.5..1.5),
                prop::collection::vec((prop::array::uniform3(-1.0..1.0), 0.02_f64..0.3), 16..60),
            ),
            2..5,
        ),
        skin_m in 0.001..0.1,
    ) {
        let (mut places, mut radii, mut clusters) = (Vec::new(), Vec::new(), Vec::new());
        for (number, (middle, spheres)) in (0..).zip(&bodies) {
            for (place, radius) in spheres {
                places.push([0, 1, 2].map(|k| middle[k] + place[k]));
                radii.push(*radius);
                clusters.push(number);
            }
        }
        let poses = cloud(&places, &radii);
        prop_assert_eq!(near_pairs(&poses, &clusters, skin_m), all_pairs(&poses, &clusters, skin_m));
    }
}

/// Two bodies of many particles each, side by side: only the facing sides are near, and the other
/// ends are left out.
#[test]
fn large_clusters_meet_where_their_boxes_do() {
    for gap in [-0.3, 0.05, 0.5] {
        let mut places = Vec::new();
        let mut clusters = Vec::new();
        for body in 0..2 {
            for n in 0..216_usize {
                let (x, y, z) = ((n % 6) as f64, (n / 6 % 6) as f64, (n / 36) as f64);
                places.push([x + f64::from(body) * (6.0 + gap), y + 0.2 * z, z]);
                clusters.push(body);
            }
        }
        let poses = cloud(&places, &vec![0.5; places.len()]);
        let found = near_pairs(&poses, &clusters, 0.1);
        assert_eq!(found, all_pairs(&poses, &clusters, 0.1));
        assert_eq!(found.is_empty(), gap > 0.1, "{gap}");
    }
}

/// A single body has no near pairs, whatever its overlaps.
#[test]
fn a_cluster_alone_is_near_to_nothing() {
    let poses = cloud(&[[0.0; 3], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]], &[1.0; 3]);
    assert!(near_pairs(&poses, &[0; 3], 0.1).is_empty());
}
