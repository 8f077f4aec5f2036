//! Settings of cases exist in the scenes, and cheap rows of the page come out as they stand there.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;
use std::f64::consts::PI;

use dem_io::Body;
use dem_pack::{BodySettings, BondSettings, PackSettings, make_body};

use super::samples::{COARSE, PACKINGS, Sample, Table, scene};
use super::{bending, drops, oscillation, rebound, steps, strengthening};
use crate::bench::root;
use crate::cells::ends;
use crate::shapes::{shape, sizes};
use crate::table::{parts, rows};

/// The settings of all cases exist in the scenes and change them.
#[test]
fn scenes_take_what_cases_set() {
    let mut asked: Vec<(&str, Vec<String>)> = Vec::new();
    asked.extend(
        bending::rows()
            .iter()
            .map(|row| ("four-point-bending", row.sets())),
    );
    for row in drops::rows() {
        asked.extend(drops::FALLS.iter().map(|fall| ("drop", row.sets(fall))));
    }
    for row in strengthening::rows() {
        let sets = |fall| strengthening::sets(&row, fall);
        asked.extend(drops::FALLS.iter().map(|fall| ("drop", sets(fall))));
    }
    asked.extend(rebound::DAMPING.map(|(_, damping)| ("drop", rebound::sets(damping))));
    for (_, damping) in steps::DAMPING {
        asked.push(("drop", steps::sets(Table::Two, damping)));
    }
    asked.extend(oscillation::DAMPING.map(|damping| ("oscillation", oscillation::sets(damping))));
    assert!(asked.len() > 60);
    for (name, sets) in asked {
        scene(name, None, &sets).unwrap_or_else(|error| panic!("{name}, {sets:?}: {error}"));
    }
}

fn packed(sample: &Sample) -> Body {
    let options = sample.options();
    let value = |name: &str| {
        let at = options.iter().position(|option| option == name);
        options[at.unwrap() + 1].as_str()
    };
    let surface = shape(sample.shape(), 1.0).unwrap();
    let packing = PackSettings {
        overlap: value("--overlap").parse().unwrap(),
        seed: sample.seed.into(),
        densify: sample.bare.then_some(0.0),
        ..PackSettings::new(sizes(value("--diameter")).unwrap())
    };
    let settings = BodySettings {
        bonds: BondSettings {
            range: value("--bond-range").parse().unwrap(),
            ..BondSettings::default()
        },
        ..BodySettings::new(packing)
    };
    make_body(&surface, &settings, &|_, _| Ok(())).unwrap().0
}

/// Spheres and bonds of all bare packings of table 2, and the stable steps of its first one.
#[test]
fn cheap_rows_come_out_as_on_the_page() {
    let page = std::fs::read_to_string(root().join("tests/verification/thesis.md")).unwrap();
    let row_of = |words: &str, name: &str| {
        let [_, text, _] = parts(&page, words, 0).unwrap();
        rows(text).into_iter().find(|row| row[0] == name).unwrap()
    };
    let packing = |seed| packed(&Sample { seed, ..COARSE });
    let bodies: Vec<Body> = (1..=PACKINGS).map(packing).collect();
    let row = row_of("thesis sample", "table 2, bare front, bond range 1.0");
    let shown = |cell: &str| -> Vec<usize> {
        let numbers = cell.split(" to ").map(|number| number.replace(',', ""));
        numbers.map(|number| number.parse().unwrap()).collect()
    };
    let ends = |count: fn(&Body) -> usize| {
        let counts = bodies.iter().map(count);
        [counts.clone().min().unwrap(), counts.max().unwrap()]
    };
    assert_eq!(shown(&row[2]), ends(|body| body.radii.len()));
    assert_eq!(shown(&row[3]), ends(|body| body.bonds.len()));
    for (name, damping) in steps::DAMPING {
        let scene = scene("drop", None, &steps::sets(Table::Two, damping)).unwrap();
        let body = BTreeMap::from([("sample".to_owned(), bodies[0].clone())]);
        let limit_us = 1e6 * steps::limit_s(&scene, body).unwrap();
        let row = row_of("thesis steps", name);
        assert_eq!(row[2], format!("{limit_us:.2}"), "{name}");
    }
}

/// An undamped pair has the period of two masses on a spring; from critical damping on it does not
/// swing back beyond its length at rest.
#[test]
fn the_pair_oscillates_as_two_masses_on_a_spring() {
    let curves = oscillation::DAMPING.map(|damping| oscillation::curve(damping).unwrap());
    let free = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let points = points.iter().copied();
        points.filter(|point| point[0] > 0.3e-3).collect()
    };
    let undamped = free(&curves[0]);
    let rises = |pair: &&[[f64; 2]]| pair[0][1] < 0.0 && pair[1][1] >= 0.0;
    let zero = |pair: &[[f64; 2]]| {
        let ([t, x], [next_s, next_m]) = (pair[0], pair[1]);
        t - x * (next_s - t) / (next_m - x)
    };
    let crossings: Vec<f64> = undamped.windows(2).filter(rises).map(zero).collect();
    let [first, .., last] = crossings[..] else {
        panic!("{crossings:?}")
    };
    let period_s = (last - first) / (crossings.len() - 1) as f64;
    let (radius_m, length_m) = (2.5e-3_f64, 3.86e-3);
    let mass_kg = 2050.0 * 4.0 / 3.0 * PI * radius_m.powi(3);
    let stiffness_n_m = 15e6 * PI * radius_m.powi(2) / length_m;
    let theory_s = 2.0 * PI * (0.5 * mass_kg / stiffness_n_m).sqrt();
    // Leapfrog shortens the period by (omega dt)^2/24, 4e-5 here.
    let off = period_s / theory_s - 1.0;
    assert!(off.abs() < 2e-4, "{period_s} {theory_s}");
    let lengths = |points: &[[f64; 2]]| free(points).iter().map(|point| point[1]).collect();
    let of_curves: Vec<Vec<f64>> = curves.iter().map(|points| lengths(points)).collect();
    let [_, most_m] = ends(&of_curves[0]);
    let back = |curve: &[f64]| -ends(curve)[0] / most_m;
    assert!(back(&of_curves[1]) > 0.3);
    for overdamped in &of_curves[2..] {
        assert!(back(overdamped) < 1e-3);
    }
}
