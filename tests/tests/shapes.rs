//! The shapes of `data/shapes`: equal to the generator's output, closed, oriented outwards, not
//! self-intersecting, and with the volume of their closed forms.

// The generator (`cargo run --example make_shapes`) itself.
#[path = "../../crates/io/examples/make_shapes/shapes/mod.rs"]
mod generator;

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};

type Point = [f64; 3];

fn folder() -> PathBuf {
    super::root().join("data/shapes")
}

/// Every file of the folder: its name and the corners of its facets, mm.
fn files() -> Vec<(String, Vec<[Point; 3]>)> {
    let mut files: Vec<_> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "stl"))
        .map(|path| {
            (
                path.file_name().unwrap().to_str().unwrap().to_owned(),
                read_stl(&path).1,
            )
        })
        .collect();
    files.sort_by(|a, b| a.0.cmp(&b.0));
    files
}

fn facets(name: &str) -> Vec<[Point; 3]> {
    read_stl(&folder().join(name)).1
}

/// Normals and corners of a binary STL file.
fn read_stl(path: &Path) -> (Vec<Point>, Vec<[Point; 3]>) {
    let bytes = fs::read(path).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count, "{}", path.display());
    let facets = bytes[84..].chunks(50).map(|facet| {
        let number = |i: usize| {
            f64::from(f32::from_le_bytes(
                facet[4 * i..4 * i + 4].try_into().unwrap(),
            ))
        };
        let point = |i: usize| [number(3 * i), number(3 * i + 1), number(3 * i + 2)];
        (point(0), [point(1), point(2), point(3)])
    });
    facets.unzip()
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Six times the volume of the tetrahedron `a b c d`: positive if `d` lies behind the facet `a b
/// c`.
fn six_volumes(a: Point, b: Point, c: Point, d: Point) -> f64 {
    dot(sub(a, d), cross(sub(b, d), sub(c, d)))
}

fn volume(facets: &[[Point; 3]]) -> f64 {
    facets
        .iter()
        .map(|&[a, b, c]| six_volumes(a, b, c, [0.0; 3]) / 6.0)
        .sum()
}

fn area(facets: &[[Point; 3]]) -> f64 {
    facets
        .iter()
        .map(|&[a, b, c]| length(cross(sub(b, a), sub(c, a))) / 2.0)
        .sum()
}

/// The coordinates of a corner as numbers in the file.
fn key(point: Point) -> [u32; 3] {
    point.map(|x| (x as f32).to_bits())
}

/// The largest distance between a smooth surface and flat facets with their corners on it, for
/// radii of curvature of at least `radius`: the sagitta of the largest facet's circumcircle.
fn sagitta(facets: &[[Point; 3]], radius: f64) -> f64 {
    let around = facets.iter().map(|&[a, b, c]| {
        let [u, v, w] = [sub(b, a), sub(c, b), sub(a, c)];
        length(u) * length(v) * length(w) / (2.0 * length(cross(u, w)))
    });
    let largest = around.fold(0.0, f64::max);
    radius - (radius * radius - largest * largest).sqrt()
}

#[test]
fn the_generator_writes_these_bytes() {
    let made = tempfile::tempdir().unwrap();
    generator::write_all(made.path()).unwrap();
    let mut names: Vec<String> = fs::read_dir(made.path())
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let known: Vec<String> = files().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, known);
    for name in names {
        let same =
            fs::read(made.path().join(&name)).unwrap() == fs::read(folder().join(&name)).unwrap();
        assert!(same, "{name} differs: run the generator again");
    }
}

#[test]
fn each_edge_joins_two_facets_that_agree() {
    for (name, facets) in files() {
        let mut edges: BTreeMap<_, u32> = BTreeMap::new();
        for [a, b, c] in facets {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((key(from), key(to))).or_default() += 1;
            }
        }
        for ((from, to), count) in &edges {
            assert_eq!(*count, 1, "{name}: edge used twice the same way");
            assert_eq!(
                edges.get(&(*to, *from)),
                Some(&1),
                "{name}: edge without a twin"
            );
        }
    }
}

#[test]
fn no_facet_is_degenerate_and_normals_point_outwards() {
    for (name, facets) in files() {
        assert!(volume(&facets) > 0.0, "{name}");
        let (normals, _) = read_stl(&folder().join(&name));
        for (i, (normal, [a, b, c])) in normals.into_iter().zip(facets).enumerate() {
            let twice_area = cross(sub(b, a), sub(c, a));
            let longest = [sub(b, a), sub(c, b), sub(a, c)]
                .map(length)
                .into_iter()
                .fold(0.0, f64::max);
            assert!(
                length(twice_area) > 0.02 * longest * longest,
                "{name}: facet {i} is a sliver"
            );
            let aligned = dot(normal, twice_area) / length(twice_area);
            assert!(
                (aligned - 1.0).abs() < 1e-6,
                "{name}: the normal of facet {i}: {aligned}"
            );
        }
    }
}

#[test]
fn no_surface_crosses_itself() {
    for (name, mut facets) in files() {
        let low = |f: &[Point; 3], k: usize| f[0][k].min(f[1][k]).min(f[2][k]);
        let high = |f: &[Point; 3], k: usize| f[0][k].max(f[1][k]).max(f[2][k]);
        facets.sort_by(|f, g| low(f, 0).total_cmp(&low(g, 0)));
        for (i, f) in facets.iter().enumerate() {
            for g in facets[i + 1..]
                .iter()
                .take_while(|g| low(g, 0) <= high(f, 0))
            {
                if (1..3).all(|k| low(g, k) <= high(f, k) && low(f, k) <= high(g, k)) {
                    assert!(
                        !pierces(f, g) && !pierces(g, f),
                        "{name}: {f:?} and {g:?} cross"
                    );
                }
            }
        }
    }
}

/// True if an edge of `f` that has no corner in common with `g` passes through `g`.
fn pierces(f: &[Point; 3], g: &[Point; 3]) -> bool {
    let [a, b, c] = *g;
    (0..3).map(|i| (f[i], f[(i + 1) % 3])).any(|(p, q)| {
        if g.contains(&p)
            || g.contains(&q)
            || six_volumes(a, b, c, p) * six_volumes(a, b, c, q) >= 0.0
        {
            return false;
        }
        let sides = [
            six_volumes(p, q, a, b),
            six_volumes(p, q, b, c),
            six_volumes(p, q, c, a),
        ];
        sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
    })
}

#[test]
fn crossing_facets_would_be_noticed() {
    let flat = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let through = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [5.0, 5.0, 0.0]];
    let beside = through.map(|p| [p[0] + 3.0, p[1], p[2]]);
    assert!(pierces(&through, &flat));
    assert!(!pierces(&beside, &flat) && !pierces(&flat, &beside));
}

#[test]
fn flat_sided_shapes_have_their_exact_volume() {
    assert_eq!(volume(&facets("bending-sample.stl")), 180.0 * 30.0 * 35.0);
    assert_eq!(
        volume(&facets("long-bending-sample.stl")),
        200.0 * 30.0 * 35.0
    );
    assert_eq!(volume(&facets("bar.stl")), 30.0 * 30.0 * 60.0);
    // A plate 20 thick, with eight ribs in front of it, 20 wide and 8 deep.
    let jaw = 160.0 * 20.0 + 8.0 * 0.5 * 20.0 * 8.0;
    // A sum of many terms, each rounded.
    assert!((volume(&facets("jaw.stl")) / (jaw * 200.0) - 1.0).abs() < 1e-13);
    let disc = facets("disc.stl");
    let exact = 48.0 * (2.0 * PI / 96.0).sin() * 25.0 * 25.0 * 25.0;
    assert!(
        (volume(&disc) - exact).abs() < 1e-4 * area(&disc),
        "{} {exact}",
        volume(&disc)
    );
    // A ring of n sections with plane sides has the volume of Pappus' theorem times sin(a)/a, a = 2
    // pi/n; the polygon in the torus' section has m corners. Coordinates are rounded to 1e-4 mm:
    // the volume to that times the area.
    let section = |m: f64, radius: f64| m / 2.0 * radius * radius * (2.0 * PI / m).sin();
    let torus = facets("torus.stl");
    let exact = 120.0 * (2.0 * PI / 120.0).sin() * 20.0 * section(48.0, 6.0);
    assert!(
        (volume(&torus) - exact).abs() < 1e-4 * area(&torus),
        "{} {exact}",
        volume(&torus)
    );
    let c = facets("c-shape.stl");
    let exact = 90.0 * (1.5 * PI / 90.0).sin() / 2.0 * (26.0 * 26.0 - 14.0 * 14.0) * 12.0;
    assert!(
        (volume(&c) - exact).abs() < 1e-4 * area(&c),
        "{} {exact}",
        volume(&c)
    );
}

#[test]
fn rings_around_a_hole_have_its_area() {
    let side = PI / 36.0;
    // Between two heights, polygons of these radii.
    let polygons = |low: f64, high: f64| 12.0 * side.sin() * (low * low + low * high + high * high);
    let circles = |low: f64, high: f64| PI / 3.0 * (low * low + low * high + high * high);
    for (name, outer, inner, height) in [
        ("tube.stl", [5.3, 5.3], [5.0, 5.0], 20.0),
        ("orifice.stl", [20.0, 20.0], [5.0, 5.0], 1.0),
        ("funnel.stl", [5.5, 26.5], [5.0, 26.0], 21.0),
    ] {
        let exact = height * (polygons(outer[0], outer[1]) - circles(inner[0], inner[1]));
        let facets = facets(name);
        assert!(
            (volume(&facets) - exact).abs() < 1e-4 * area(&facets),
            "{name}: {} {exact}",
            volume(&facets)
        );
    }
}

#[test]
fn round_shapes_miss_their_volume_by_no_more_than_flat_facets_must() {
    let tablet = facets("tablet.stl");
    let dome = PI / 3.0 * (3.0 * 13.0 - 1.0);
    let round = PI * 25.0 * 2.4 + 2.0 * dome;
    let missing = round - volume(&tablet);
    assert!(
        missing > 0.0 && missing < sagitta(&tablet, 5.0) * area(&tablet),
        "{missing} of {round}"
    );

    let torus = facets("torus.stl");
    let round = 2.0 * PI * PI * 20.0 * 36.0;
    let missing = round - volume(&torus);
    assert!(
        missing > 0.0 && missing < sagitta(&torus, 6.0) * area(&torus),
        "{missing} of {round}"
    );

    // The block's volume is exact; that of the ball is smaller, and so is that of the cavity.
    let pair = facets("hollow-pair.stl");
    let (ball, rest) = pair.split_at(20 << 8);
    let (cavity, block) = rest.split_at(20 << 6);
    assert_eq!(volume(block), 18.0 * 18.0 * 16.0);
    for (sphere, radius, sign) in [(ball, 12.0_f64, 1.0), (cavity, 5.0, -1.0)] {
        let missing = 4.0 / 3.0 * PI * radius.powi(3) - sign * volume(sphere);
        assert!(
            missing > 0.0 && missing < sagitta(sphere, radius) * area(sphere),
            "{missing}"
        );
    }
}

#[test]
fn the_rock_is_fine_and_star_shaped() {
    let rock = facets("rock.stl");
    assert!(rock.len() >= 20_000);
    assert!(
        rock.iter()
            .all(|&[a, b, c]| six_volumes(a, b, c, [0.0; 3]) > 0.0)
    );
}

#[test]
fn the_knot_is_as_thick_as_it_should_be_and_clears_itself() {
    // Rings of 30 corners around the points of the curve; strands that cross are more than half a
    // loop apart.
    let corners: Vec<Point> = facets("infinity-knot.stl").into_iter().flatten().collect();
    let on_curve = |t: f64| [45.0 * t.sin(), 20.0 * (2.0 * t).sin(), 8.0 * t.cos()];
    let curve: Vec<Point> = (0..24_000)
        .map(|i| on_curve(2.0 * PI * f64::from(i) / 24_000.0))
        .collect();
    for corner in corners.iter().step_by(37) {
        let nearest = curve
            .iter()
            .map(|&p| length(sub(*corner, p)))
            .fold(f64::INFINITY, f64::min);
        assert!(
            (nearest - 7.0).abs() < 1e-3,
            "{corner:?} is {nearest} mm from the curve"
        );
    }
    let (over, under): (Vec<Point>, Vec<Point>) = curve.iter().partition(|p| p[2] > 0.0);
    let crossing = |strand: &[Point]| -> Vec<Point> {
        strand
            .iter()
            .copied()
            .filter(|p| p[2].abs() > 4.0)
            .collect()
    };
    let (over, under) = (crossing(&over), crossing(&under));
    let gap = over
        .iter()
        .step_by(7)
        .map(|&p| {
            under
                .iter()
                .step_by(7)
                .map(|&q| length(sub(p, q)))
                .fold(f64::INFINITY, f64::min)
        })
        .fold(f64::INFINITY, f64::min);
    assert!(gap > 14.0 + 1.0, "the strands' axes are {gap} mm apart");
}

#[test]
fn the_table_of_shapes_is_right() {
    let table = fs::read_to_string(folder().join("README.md")).unwrap();
    for (name, facets) in files() {
        let row = table
            .lines()
            .find(|line| line.contains(&name))
            .unwrap_or_else(|| panic!("{name} is not in the table"));
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let extent: Vec<String> = (0..3)
            .map(|k| {
                let range = facets
                    .iter()
                    .flatten()
                    .fold((f64::MAX, f64::MIN), |r, p| (r.0.min(p[k]), r.1.max(p[k])));
                format!("{:.1}", range.1 - range.0)
            })
            .collect();
        let expected = [
            extent.join(" x "),
            facets.len().to_string(),
            format!("{:.1}", volume(&facets)),
        ];
        assert_eq!(cells[3..6], expected, "{name}");
    }
}

#[test]
fn the_folder_stays_small() {
    let bytes: u64 = fs::read_dir(folder())
        .unwrap()
        .map(|e| e.unwrap().metadata().unwrap().len())
        .sum();
    assert!(bytes < 6_000_000, "{bytes} bytes");
}
