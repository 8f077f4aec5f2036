//! Mass and bulk density of regions and heaps, and Lacey's index, against closed forms.

use std::f64::consts::PI;
use std::fmt::Write;

use super::{Measured, assert_near};
use dem_testing::Random;

const DENSITY: f64 = 2000.0;

/// A scene of the bodies `a` and `b` of spheres (x, y, z, radius), with regions and measures.
fn scene(a: &[[f64; 4]], b: &[[f64; 4]], rest: &str) -> String {
    let mut text = format!(
        "version = 1\n[run]\nend_time = 1\ntime_step = 1e-6\ninitial_overlap = \"keep\"\n[materials.stuff]\ndensity = {DENSITY}\n"
    );
    for (name, spheres) in [("a", a), ("b", b)] {
        if spheres.is_empty() {
            continue;
        }
        write!(
            text,
            "[bodies.{name}]\nmaterial = \"stuff\"\nparticles = {spheres:?}\n"
        )
        .unwrap();
    }
    text + rest
}

/// The values of the measures, by their names in order.
fn values(text: &str) -> Vec<f64> {
    let mut measured = Measured::new(text);
    measured.interact();
    measured.read().into_values().collect()
}

fn mass(radius: f64) -> f64 {
    DENSITY * 4.0 / 3.0 * PI * radius.powi(3)
}

#[test]
fn spheres_that_a_border_cuts_count_in_part() {
    // A cap of this height, over the ball.
    let cap = |height: f64| height * height * (3.0 - height) / 4.0;
    let place = [0.1, 0.2, 0.3];
    for (high, wanted) in [
        ([9.0, 9.0, 9.0], 1.0),
        ([9.0, 9.0, 0.3], 0.5),
        ([9.0, 0.2, 0.3], 0.25),
        ([0.1, 0.2, 0.3], 0.125),
        ([9.0, 9.0, 0.8], 1.0 - cap(0.5)),
        ([9.0, 9.0, -0.3], cap(0.4)),
        ([-0.4, 9.0, 9.0], cap(0.5)),
        ([9.0, 9.0, -0.9], 0.0),
    ] {
        let [x, y, z] = place;
        let text = scene(
            &[[x, y, z, 1.0]],
            &[],
            &format!(
                "[regions.part]\nbox = {{ min = [-9, -9, -9], max = {high:?} }}\n[measures.m]\nof = \"a\"\nquantity = \"mass\"\nwithin = \"part\"\n"
            ),
        );
        let found = values(&text)[0] / mass(1.0);
        assert!((found - wanted).abs() < 6e-3, "{high:?}: {found} {wanted}");
    }
}

#[test]
fn a_region_divides_mass_by_its_volume() {
    let spheres = [
        [0.0, 0.0, 0.0, 1.0],
        [0.5, 0.0, 0.0, 0.25],
        [0.0, 9.0, 0.0, 0.5],
    ];
    let regions = "[regions.ball]\nsphere = { centre = [0, 0, 0], radius = 2 }\n\
        [regions.can]\ncylinder = { from = [0, 0, -2], to = [0, 0, 3], radius = 1.5 }\n\
        [regions.room]\nbox = { min = [-2, -2, -2], max = [2, 10, 2] }\n";
    let measure = |region: &str| {
        format!("[measures.{region}]\nquantity = \"bulk_density\"\nwithin = \"{region}\"\n")
    };
    let rest = regions.to_owned()
        + &["ball", "can", "room"].map(measure).concat()
        + "[measures.total]\nquantity = \"mass\"\n";
    let found = values(&scene(&spheres, &[], &rest));
    let two = mass(1.0) + mass(0.25);
    assert_near(found[0], two / (4.0 / 3.0 * PI * 8.0), 1e-9);
    assert_near(found[1], two / (PI * 1.5 * 1.5 * 5.0), 1e-9);
    assert_near(found[2], (two + mass(0.5)) / (4.0 * 12.0 * 4.0), 1e-9);
    assert_near(found[3], two + mass(0.5), 1e-9);
}

#[test]
fn a_lattice_has_the_bulk_density_of_its_cell() {
    let mut spheres = Vec::new();
    for i in 0..8 {
        for j in 0..8 {
            for k in 0..8 {
                spheres.push([i, j, k].map(|n| 2.0 * f64::from(n)));
            }
        }
    }
    let spheres: Vec<[f64; 4]> = spheres.iter().map(|[x, y, z]| [*x, *y, *z, 1.0]).collect();
    // A region that cuts spheres at all sides, as many cells as it has volume.
    let rest = "[regions.inside]\nbox = { min = [2.3, 2.7, 3.1], max = [10.3, 10.7, 11.1] }\n[measures.m]\nquantity = \"bulk_density\"\nwithin = \"inside\"\n";
    let found = values(&scene(&spheres, &[], rest))[0];
    let wanted = DENSITY * PI / 6.0;
    assert!((found / wanted - 1.0).abs() < 2e-3, "{found} {wanted}");
}

#[test]
fn the_surface_of_a_heap_is_that_of_its_spheres() {
    // Spheres side by side on the ground: each has the columns of width r that it enters, up to the
    // highest point of each: 14.378 r^3 in the mean over its places.
    let mut random = Random(5);
    let spheres: Vec<[f64; 4]> = (0..400)
        .map(|n| {
            let [i, j] = [n % 20, n / 20].map(|n| 4.0 * f64::from(n));
            [
                i + random.within(-0.5, 0.5),
                j + random.within(-0.5, 0.5),
                0.0,
                1.0,
            ]
        })
        .collect();
    let rest = "[measures.m]\nquantity = \"bulk_density\"\n";
    let found = values(&scene(&spheres, &[], rest))[0];
    let wanted = 4.0 / 3.0 * PI / 14.378 * DENSITY;
    assert!((found / wanted - 1.0).abs() < 0.02, "{found} {wanted}");
    // Upwards is against gravity: seen from the side, rows stand above each other.
    let fallen = scene(&spheres, &[], rest)
        .replace("end_time = 1\n", "end_time = 1\ngravity = [-9.81, 0, 0]\n");
    let sideways = values(&fallen)[0];
    assert!(sideways < 0.9 * found, "{sideways} {found}");
}

/// Regression: the height in the middle of each column was taken, and no column whose middle is
/// beside all spheres, so that a solid had more than its own density.
#[test]
fn a_heap_of_a_lattice_has_the_density_of_its_cell() {
    let density = |shift: f64, [n, layers]: [i32; 2]| {
        let place = |n: i32| 2.0 * f64::from(n) + 1.0 + shift;
        let spheres: Vec<[f64; 4]> = (0..n * n * layers)
            .map(|at| [at % n, at / n % n, at / n / n].map(place))
            .map(|[x, y, z]| [x, y, z, 1.0])
            .collect();
        values(&scene(
            &spheres,
            &[],
            "[measures.m]\nquantity = \"bulk_density\"\n",
        ))[0]
    };
    let wanted = DENSITY * PI / 6.0;
    assert_near(density(0.0, [12, 3]), wanted, 1e-9 * wanted);
    assert_near(density(7.0, [5, 1]), wanted, 1e-9 * wanted);
    // Beside the grid of columns the rim takes half a column more on each side.
    let off = |size: [i32; 2]| 1.0 - density(0.3, size) / wanted;
    let (small, large) = (off([6, 6]), off([40, 40]));
    assert!((0.0..0.16).contains(&small), "{small}");
    assert!(large < 0.03 && large < 0.25 * small, "{large}");
}

#[test]
fn few_cells_have_no_mixing_index() {
    let side = |x: f64| -> Vec<[f64; 4]> {
        (0..125)
            .map(|n| [n % 5, n / 5 % 5, n / 25].map(f64::from))
            .map(|[i, j, k]| [x + i, j + 0.5, k + 0.5, 0.4])
            .collect()
    };
    let (a, b) = (side(0.5), side(5.5));
    let found = |cell: f64| {
        let rest = format!(
            "[regions.room]\nbox = {{ min = [0, 0, 0], max = [10, 5, 5] }}\n[measures.m]\nof = \"a\"\nwith = \"b\"\nquantity = \"mixing_index\"\nwithin = \"room\"\ncell_size = {cell}\n"
        );
        values(&scene(&a, &b, &rest))[0]
    };
    for too_large in [100.0, 10.0, 5.0] {
        assert!(found(too_large).is_nan(), "{too_large}");
    }
    assert_near(found(1.25), 0.0, 1e-12);
}

#[test]
fn laceys_index_is_0_apart_and_1_at_random() {
    let place = |n: usize| [n % 16, n / 16 % 16, n / 256].map(|k| 2.0 * k as f64 + 1.0);
    let sphere = |n: usize| {
        let [x, y, z] = place(n);
        [x, y, z, 1.0]
    };
    let rest = "[regions.room]\nbox = { min = [0, 0, 0], max = [32, 32, 32] }\n[measures.m]\nof = \"a\"\nwith = \"b\"\nquantity = \"mixing_index\"\nwithin = \"room\"\ncell_size = 8\n";
    let index = |is_first: &mut dyn FnMut(usize) -> bool| {
        let (a, b): (Vec<usize>, Vec<usize>) = (0..4096).partition(|&n| is_first(n));
        let spheres = |of: &[usize]| of.iter().map(|&n| sphere(n)).collect::<Vec<_>>();
        values(&scene(&spheres(&a), &spheres(&b), rest))[0]
    };
    assert_near(index(&mut |n| n < 1024), 0.0, 1e-12);
    // Three fourths of each cell in the lower half, and nothing in the upper: p = 3/8,
    // s^2 = (3/8)^2, s0^2 = 15/64, n = 64.
    let apart = 15.0 / 64.0;
    let variance = (3.0_f64 / 8.0).powi(2);
    let wanted = (apart - variance) / (apart - apart / 64.0);
    let halves = index(&mut |n| n < 2048 && n % 4 != 0);
    assert_near(halves, wanted, 1e-12);
    let mut random = Random(11);
    let mixed = index(&mut |_| random.within(0.0, 1.0) < 0.3);
    assert!((mixed - 1.0).abs() < 0.01, "{mixed}");
    // Cells of a chessboard hold one of them each.
    let is_white = |n: usize| (0..3).map(|k| n / 16_usize.pow(k) % 16 / 4).sum::<usize>() % 2 == 0;
    assert_near(index(&mut |n| is_white(n)), 0.0, 1e-12);
    // Spheres of a chessboard are better mixed than at random: s^2 = 0.
    let is_white = |n: usize| (0..3).map(|k| n / 16_usize.pow(k) % 16).sum::<usize>() % 2 == 0;
    assert_near(index(&mut |n| is_white(n)), 64.0 / 63.0, 1e-12);
}

/// Regression: 0.229, without a doubt, for the halves of a lattice that the cells of a coarse grid
/// straddle. Whatever the grid, the border and the state, an index is right within 0.1 or doubtful.
#[test]
fn coarse_grids_are_doubtful() {
    let mut random = Random(23);
    let mut places = |count: usize, size: [f64; 3]| -> Vec<[f64; 3]> {
        let place = |_| size.map(|side| random.within(0.0, side));
        (0..count).map(place).collect()
    };
    // Index, and whether it is doubtful, in cells of this size from this corner.
    let found = |all: &[[f64; 3]], is_first: &dyn Fn(&[f64; 3]) -> bool, cell: f64, low: f64| {
        let side = |first: bool| -> Vec<[f64; 4]> {
            let of = all.iter().filter(|place| is_first(place) == first);
            of.map(|[x, y, z]| [*x, *y, *z, 0.01]).collect()
        };
        let rest = format!(
            "[regions.room]\nbox = {{ min = [{low}, {low}, {low}], max = [40, 40, 40] }}\n[measures.m]\nof = \"a\"\nwith = \"b\"\nquantity = \"mixing_index\"\nwithin = \"room\"\ncell_size = {cell}\n"
        );
        let mut measured = Measured::new(&scene(&side(true), &side(false), &rest));
        measured.interact();
        let value = measured.read()["m"];
        (value, measured.probes[0].coarse_cells().is_some())
    };
    let lattice: Vec<[f64; 3]> = (0..600)
        .map(|n| [n % 10, n / 10 % 10, n / 100].map(|k| f64::from(k) + 0.5))
        .collect();
    let is_left: &dyn Fn(&[f64; 3]) -> bool = &|place| place[0] < 5.0;
    let (value, is_doubtful) = found(&lattice, is_left, 2.0, 0.0);
    assert_near(value, 8.0 / 35.0, 1e-12);
    assert!(is_doubtful);
    assert_eq!(found(&lattice, is_left, 2.5, 0.0), (0.0, false));
    // Two layers within cells that are as high as the bed: mixed better than at random.
    let bed: Vec<[f64; 3]> = (0..800)
        .map(|n| [n % 20, n / 20 % 20, n / 400].map(|k| f64::from(k) + 0.5))
        .collect();
    let (value, is_doubtful) = found(&bed, &|place| place[2] < 1.0, 2.0, 0.0);
    assert_near(value, 8.0 / 7.0, 1e-12);
    assert!(is_doubtful);

    let (small, large) = (places(600, [10.0, 10.0, 6.0]), places(8000, [20.0; 3]));
    let mut random = Random(29);
    let (mut sound, mut wrong) = ([0; 2], Vec::new());
    for cell in [2.0, 2.5, 3.0, 4.0, 5.0, 6.7] {
        for shift in 0..4 {
            let low = -0.25 * f64::from(shift) * cell;
            for all in [&small, &large] {
                let middle = if all.len() == 600 { 5.0 } else { 10.0 };
                let is_core: &dyn Fn(&[f64; 3]) -> bool = &|place| {
                    let off = place.map(|x| (x - middle).powi(2));
                    off.iter().sum::<f64>() < 0.6 * middle * middle
                };
                let is_oblique: &dyn Fn(&[f64; 3]) -> bool =
                    &|[x, y, z]| x + y + 0.5 * z < 2.3 * middle;
                let is_half: &dyn Fn(&[f64; 3]) -> bool = &|place| place[0] < middle;
                let label: Vec<bool> = all.iter().map(|_| random.within(0.0, 1.0) < 0.4).collect();
                let is_mixed: &dyn Fn(&[f64; 3]) -> bool =
                    &|place| label[all.iter().position(|other| other == place).unwrap()];
                let states = [is_core, is_oblique, is_half, is_mixed];
                for (state, is_first) in states.iter().enumerate() {
                    let wanted = f64::from(u8::from(state == 3));
                    let (value, is_doubtful) = found(all, is_first, cell, low);
                    if !(value.is_nan() || is_doubtful) {
                        sound[usize::from(state == 3)] += 1;
                        if (value - wanted).abs() > 0.1 {
                            wrong.push((all.len(), state, cell, shift, value));
                        }
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
    // What is mixed is rarely doubtful, what is apart only on grids that fit.
    assert!(sound[0] > 5 && sound[1] > 40, "{sound:?}");
}

/// Lacey's index of pieces of two masses at random places: large ones of a, 64 times as heavy as
/// those of b, and as heavy in all.
fn index_at_random(seed: u64) -> f64 {
    let mut random = Random(seed);
    let mut spheres = |count: usize, radius: f64| -> Vec<[f64; 4]> {
        let mut place = |_| {
            let [x, y, z] = [0; 3].map(|_| random.within(0.0, 80.0));
            [x, y, z, radius]
        };
        (0..count).map(&mut place).collect()
    };
    let (a, b) = (spheres(5000, 0.04), spheres(320_000, 0.01));
    let rest = "[regions.room]\nbox = { min = [0, 0, 0], max = [80, 80, 80] }\n[measures.m]\nof = \"a\"\nwith = \"b\"\nquantity = \"mixing_index\"\nwithin = \"room\"\ncell_size = 10\n";
    values(&scene(&a, &b, rest))[0]
}

#[test]
fn laceys_index_is_1_for_pieces_of_different_mass_at_random() {
    // 512 cells, each with some 10 heavy pieces: s^2/sr^2 scatters by sqrt(2/512), sr^2 is
    // 0.026 s0^2.
    let found = index_at_random(3);
    assert!((found - 1.0).abs() < 0.006, "{found}");
    // With the variance of equal spheres, s0^2 over the 635 in a cell, it would be 0.976.
}

#[test]
fn pieces_of_several_spheres_count_as_pieces() {
    // Rods of four spheres along x, one in each cell of 8 times 2 times 2: with labels at random,
    // the index is that of pieces, not of spheres.
    let mut random = Random(17);
    let mut sides: [Vec<[f64; 4]>; 2] = Default::default();
    let mut bonds: [Vec<[usize; 2]>; 2] = Default::default();
    for n in 0..32 * 32 * 8 {
        let k = usize::from(random.within(0.0, 1.0) < 0.5);
        let [x, y, z] = [n % 8, n / 8 % 32, n / 256].map(f64::from);
        for j in 0..4 {
            if j > 0 {
                bonds[k].push([sides[k].len() - 1, sides[k].len()]);
            }
            sides[k].push([
                8.0 * x + 2.0 * f64::from(j) + 1.0,
                2.0 * y + 1.0,
                2.0 * z + 1.0,
                1.0,
            ]);
        }
    }
    let rest = "[bonds.glue]\nyoung_modulus = 1e6\npoisson_ratio = 0.3\n[regions.room]\nbox = { min = [0, 0, 0], max = [64, 64, 64] }\n[measures.m]\nof = \"a\"\nwith = \"b\"\nquantity = \"mixing_index\"\nwithin = \"room\"\ncell_size = 8\n";
    let mut text = scene(&sides[0], &sides[1], rest);
    for (name, bonds) in ["a", "b"].iter().zip(&bonds) {
        let head = format!("[bodies.{name}]\n");
        let with = format!("{head}bonds = \"glue\"\nbond_list = {bonds:?}\n");
        text = text.replace(&head, &with);
    }
    // 16 rods in each of 512 cells: sr^2 = s0^2/16.
    let found = values(&text)[0];
    let scatter = (2.0_f64 / 512.0).sqrt() / 15.0;
    assert!((found - 1.0).abs() < 3.0 * scatter, "{found}");
    // Moved by half a cell, each rod is in two cells, as two pieces of half its mass.
    let moved = text.replace("min = [0, 0, 0], max = [64", "min = [4, 0, 0], max = [68");
    let found = values(&moved)[0];
    assert!((found - 1.0).abs() < 6.0 * scatter, "{found}");
}

#[test]
fn cells_of_a_mixture_hold_its_mass() {
    let a = [[0.5, 0.5, 0.5, 0.1], [1.5, 0.5, 0.5, 0.2]];
    let b = [[1.6, 0.5, 0.5, 0.2], [0.5, 9.0, 0.5, 0.1]];
    let rest = "[regions.room]\nbox = { min = [0, 0, 0], max = [2, 2, 2] }\n[measures.m]\nof = \"a\"\nwith = \"b\"\nquantity = \"mixing_index\"\nwithin = \"room\"\ncell_size = 1\n";
    let mut measured = Measured::new(&scene(&a, &b, rest));
    measured.interact();
    let cells = measured.probes[0].mixed_cells(&measured.state);
    let found: Vec<[f64; 3]> = cells.iter().map(|cell| cell.centre_m).collect();
    assert_eq!(found, [[0.5, 0.5, 0.5], [1.5, 0.5, 0.5]]);
    assert_near(cells[0].mass_kg, mass(0.1), 1e-12);
    assert_near(cells[1].mass_kg, 2.0 * mass(0.2), 1e-12);
    assert_eq!([cells[0].fraction, cells[1].fraction], [1.0, 0.5]);
}
