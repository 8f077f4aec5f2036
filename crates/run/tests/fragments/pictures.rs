//! Plots of fragments.

use std::fs;

use dem_engine::state::clusters::Cluster;
use dem_engine::state::clusters::sizes::FragmentSize;
use dem_plan::measure::sizes::steps;
use dem_runner::last_files::fragments::counts_over_time;

use super::burst::burst;

fn clusters(lives: &[(f64, Option<f64>)]) -> Vec<Cluster> {
    let cluster = |&(created_s, ended_s): &(f64, Option<f64>)| Cluster {
        parent: None,
        body: 0,
        created_s,
        unbroken_since_s: created_s,
        ended_s,
        particles: 1,
    };
    lives.iter().map(cluster).collect()
}

#[test]
fn numbers_step_when_clusters_split() {
    let lives = [
        (0.0, Some(1.0)),
        (0.0, None),
        (1.0, None),
        (1.0, Some(2.5)),
        (1.0, None),
        (2.5, None),
        (2.5, None),
    ];
    assert_eq!(
        counts_over_time(&clusters(&lives), 4.0),
        [
            [0.0, 2.0],
            [1.0, 2.0],
            [1.0, 4.0],
            [2.5, 4.0],
            [2.5, 5.0],
            [4.0, 5.0]
        ]
    );
    assert_eq!(
        counts_over_time(&clusters(&[(0.0, None)]), 4.0),
        [[0.0, 1.0], [4.0, 1.0]]
    );
}

#[test]
fn shares_step_at_every_size_up_to_all_of_the_mass() {
    let fragment = |mass_kg: f64, size_m: f64| FragmentSize {
        mass_kg,
        sieve_m: size_m,
        ..FragmentSize::default()
    };
    let all = [fragment(1.0, 0.1), fragment(2.0, 0.1), fragment(5.0, 0.5)];
    assert_eq!(
        steps(&all),
        [[0.1, 0.0], [0.1, 0.375], [0.5, 0.375], [0.5, 1.0]]
    );
}

/// The points of the only line of a plot, and the box around it: x, y, width, height.
fn line_and_area(text: &str) -> (Vec<[f64; 2]>, [f64; 4]) {
    let (_, points) = text.split_once("<polyline points=\"").unwrap();
    let points = points.split_once('"').unwrap().0;
    let points = points
        .split(' ')
        .map(|pair| {
            let (x, y) = pair.split_once(',').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        })
        .collect();
    let (_, area) = text.split_once("<rect class=\"area\"").unwrap();
    let number = |name: &str| {
        let (_, rest) = area.split_once(&format!(" {name}=\"")).unwrap();
        rest.split_once('"').unwrap().0.parse::<f64>().unwrap()
    };
    (points, ["x", "y", "width", "height"].map(number))
}

#[test]
fn plots_of_a_rod_that_burst() {
    let (_parent, folder, summary) = burst();
    let count = summary.fragments.unwrap().count;
    for (name, labels) in [
        (
            "fragments",
            [
                ">Fragments</text>",
                ">time (µs)</text>",
                ">fragments</text>",
            ],
        ),
        (
            "fragment_sizes",
            [
                ">Fragment sizes, with marks at d50</text>",
                ">sieve size, the width of a fragment (mm)</text>",
                ">cumulative mass fraction</text>",
            ],
        ),
    ] {
        let text = fs::read_to_string(folder.plot(name)).unwrap();
        for label in labels {
            assert!(text.contains(label), "{label} in {text}");
        }
        let (points, [x, y, width, height]) = line_and_area(&text);
        assert!(points.len() > 4);
        for pair in points.windows(2) {
            // Upwards or to the right: a staircase.
            assert!(pair[1][0] >= pair[0][0] && pair[1][1] <= pair[0][1]);
            assert!(pair[1][0] == pair[0][0] || pair[1][1] == pair[0][1]);
        }
        for [px, py] in points {
            assert!((x..=x + width).contains(&px) && (y..=y + height).contains(&py));
        }
    }
    let text = fs::read_to_string(folder.plot("fragment_sizes")).unwrap();
    // A single decade has numbers in between.
    let (_, numbers) = text.split_once("<g class=\"x\"").unwrap();
    let numbers = numbers.split_once("</g>").unwrap().0;
    assert!(numbers.matches("</text>").count() > 2, "{numbers}");
    // Whole numbers only, and the last one reaches the count.
    let text = fs::read_to_string(folder.plot("fragments")).unwrap();
    let (_, numbers) = text.split_once("text-anchor=\"end\">").unwrap();
    let numbers: Vec<f64> = numbers
        .split_once("</g>")
        .unwrap()
        .0
        .split("</text>")
        .filter_map(|label| label.rsplit_once('>'))
        .map(|(_, label)| label.parse().unwrap())
        .collect();
    assert!(numbers.iter().all(|number| number.fract() == 0.0));
    assert!(numbers.iter().any(|number| *number >= count as f64));
}
