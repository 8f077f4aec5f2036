//! Eight spheres at once give the same lists and forces as one after the other, bit for bit.

use proptest::prelude::*;
use pulp::NullaryFnOnce;
use pulp::x86::V4;

use super::cells::{LANES, SizeClasses};
use super::eight::{Eight, of_neighbours};
use super::forces;
use super::neighbours::{ChunkOfLists, ListChunk};
use crate::spheres::ReducedSphere;

/// The numbers in list `k`, of this sphere, without those that fill it up.
fn others(lists: &ChunkOfLists, k: usize, sphere: usize) -> Vec<u32> {
    let list = lists.of(k).as_flattened();
    let others = list.iter().take_while(|other| **other as usize != sphere);
    let others: Vec<u32> = others.copied().collect();
    assert!(
        list[others.len()..]
            .iter()
            .all(|other| *other as usize == sphere)
    );
    others
}

proptest! {
    #[test]
    fn eight_at_once_give_the_same_lists_and_forces(
        spheres in prop::collection::vec((prop::array::uniform3(-2.0..2.0), -3.0_f64..-0.5), 1..300),
        skin in 0.0..0.3, from in 0_usize..300,
    ) {
        // Without AVX-512 there is nothing to compare.
        if let Some(simd) = V4::try_new() {
            let ball = |([x, y, z], octaves): &([f64; 3], f64)| [*x, *y, *z, octaves.exp2()];
            let balls: Vec<ReducedSphere> = spheres.iter().map(ball).collect();
            let classes = SizeClasses::new(&balls, skin);
            let first = from % balls.len();
            let work = || ListChunk { classes: &classes, part: &balls[first..], first, skin };
            let by_four = work().call();
            let by_eight = simd.vectorize(Eight(simd, work()));
            for (k, ball) in balls[first..].iter().enumerate() {
                let list = others(&by_four, k, first + k);
                prop_assert_eq!(&list, &others(&by_eight, k, first + k));
                prop_assert!(by_eight.of(k).len().is_multiple_of(2));
                let sphere = ((first + k) as u32, ball);
                let mut worst = pulp::cast([0.0_f64; LANES]);
                let (force, overlap) = forces::of_neighbours(sphere, by_four.of(k), &balls);
                // Of lists of both lengths.
                for lists in [&by_four, &by_eight] {
                    let found = of_neighbours(simd, sphere, lists.of(k), &balls, &mut worst);
                    prop_assert_eq!(force.map(f64::to_bits), found.map(f64::to_bits));
                }
                let worst: [f64; LANES] = pulp::cast(worst);
                let worst = worst.into_iter().fold(0.0, f64::max);
                prop_assert_eq!(worst.to_bits(), (overlap / ball[3]).to_bits());
            }
        }
    }
}
