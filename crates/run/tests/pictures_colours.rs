//! Colours of fragments and bodies in pictures.

use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::Cluster;
use dem_pictures::colours::{SINGLE, of_fragment};
use dem_runner::pictures::subject::{by_body, of_clusters};

fn cluster(parent: Option<u32>, particles: u32) -> Cluster {
    Cluster {
        parent,
        body: 0,
        created_s: 0.0,
        unbroken_since_s: 0.0,
        ended_s: None,
        particles,
    }
}

#[test]
fn the_largest_piece_keeps_the_colour_and_singles_are_grey() {
    let history = [
        cluster(None, 100),
        cluster(None, 100),
        cluster(Some(0), 30),
        cluster(Some(0), 69),
        cluster(Some(0), 1),
        cluster(Some(3), 40),
        cluster(Some(3), 29),
    ];
    let found = of_clusters(&history);
    assert_eq!(found[0], of_fragment(0, 1.0));
    assert_eq!(found[1], of_fragment(1, 1.0));
    assert_eq!(found[2], of_fragment(2, 0.3));
    assert_eq!(found[3], of_fragment(0, 0.69));
    assert_eq!(found[4], SINGLE);
    assert_eq!(found[5], of_fragment(0, 0.4));
    assert_eq!(found[6], of_fragment(6, 0.29));
}

#[test]
fn without_clusters_bodies_have_colours() {
    let body = |particles: Vec<u32>| PlacedBody {
        name: String::new(),
        came_as: None,
        first_particle: 0,
        particles,
        first_bond: 0,
        bonds: Vec::new(),
    };
    let (of_particle, colours) = by_body(4, &[body(vec![2, 0]), body(vec![1]), body(vec![9])]);
    assert_eq!(of_particle, [0, 1, 0, u32::MAX]);
    assert_eq!(colours[0], of_fragment(0, 1.0));
    assert_eq!(colours[1], SINGLE);
}
