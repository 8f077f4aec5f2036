//! A search for some particles compared with a test of every pair; and one lane with several.

use proptest::prelude::*;

use super::among_small::SmallMeetings;
use super::find_pairs;
use crate::state::search::buffers::PairBuffers;
use crate::state::search::clusters::{KnownClusters, Searched};
use dem_physics::geometry::balls::Ball;
use dem_physics::lanes::{LaneWork, with_lanes, with_most_lanes};

/// Pairs of overlapping balls of different clusters of which at least one seeks, one by one.
fn pairs_sought(balls: &[Ball], clusters: &[u32], seeks: &[bool]) -> Vec<[u32; 2]> {
    let overlap = |i: usize, j: usize| {
        let ([ax, ay, az, a_m], [bx, by, bz, b_m]) = (balls[i], balls[j]);
        let apart = [bx - ax, by - ay, bz - az];
        apart.iter().map(|c| c * c).sum::<f64>() < (a_m + b_m).powi(2)
    };
    let all = (0..balls.len()).flat_map(|i| (i + 1..balls.len()).map(move |j| [i, j]));
    let sought =
        all.filter(|&[i, j]| (seeks[i] || seeks[j]) && clusters[i] != clusters[j] && overlap(i, j));
    sought.map(|[i, j]| [i as u32, j as u32]).collect()
}

proptest! {
    /// Balls of six size classes, in small clusters and large ones.
    #[test]
    fn a_search_for_some_finds_each_of_their_pairs_once(
        balls in prop::collection::vec((prop::array::uniform3(-1.0..1.0), -6.5_f64..-1.0), 2..200),
        clusters in prop::collection::vec(0_u32..40, 200),
        large in 0_usize..60,
        seeks in prop::collection::vec(any::<bool>(), 200),
    ) {
        let balls: Vec<Ball> = balls.iter().map(|([x, y, z], m)| [*x, *y, *z, m.exp2()]).collect();
        let number = |(i, cluster): (usize, &u32)| if i < large { 40 } else { *cluster };
        let clusters: Vec<u32> = clusters[..balls.len()].iter().enumerate().map(number).collect();
        let seeks = &seeks[..balls.len()];
        let searched = Searched {
            balls: &balls,
            clusters: &clusters,
            clusters_ever: None,
            seeks: Some(seeks),
            asleep: &[],
            clumps: None,
        };
        let (mut known, mut buffers) = (KnownClusters::default(), PairBuffers::default());
        // Those that seek were elsewhere at the search before, the order of the boxes another one.
        let elsewhere = |(&[x, y, z, radius_m], &seeks): (&Ball, &bool)| {
            if seeks { [-y, x, z, radius_m] } else { [x, y, z, radius_m] }
        };
        let before: Vec<Ball> = balls.iter().zip(seeks).map(elsewhere).collect();
        known.update(&Searched { balls: &before, seeks: None, ..searched });
        known.update(&searched);
        find_pairs(&searched, &known, &mut buffers);
        prop_assert_eq!(&buffers.found, &pairs_sought(&balls, &clusters, seeks));

        let mut found = [const { Vec::new() }; 3];
        let [by_one, by_four, by_most] = found.each_mut().map(|found| SmallMeetings {
            searched: &searched,
            known: &known,
            grids: &buffers.grids,
            some: &buffers.active,
            found,
        });
        by_one.with::<f64>(());
        with_lanes(by_four);
        with_most_lanes(by_most);
        prop_assert_eq!(&found[0], &found[1]);
        prop_assert_eq!(&found[0], &found[2]);
    }
}
