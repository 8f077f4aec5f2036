//! The bare front leaves no void that takes the smallest sphere. Voids are searched by halving
//! boxes, without halos, grids or trees.

use crate::helpers::exact::{EXACT, assert_exact, distance_to_triangle, winding_number};
use crate::helpers::facets::{Facets, Point, cuboid, prism};
use crate::helpers::packing::settings;
use crate::helpers::solids::{
    icosphere, local_facets, point_between, random_numbers, surface_of, torus,
};
use dem_io::Surface;
use dem_pack::{PackHistory, PackSettings, Packing, pack};
use dem_pack::{Sizes, ks_distance_by_mass, ks_distance_by_number};

/// Boxes smaller than this fraction of the smallest radius are not halved any more. A void for
/// spheres larger than the smallest by at least this fraction is found, a narrower one may be
/// missed.
const FINEST: f64 = 1e-3;

struct Search<'a> {
    facets: &'a [[Point; 3]],
    balls: Vec<(Point, f64)>,
    radius: f64,
    reduced: f64,
    found: Vec<Point>,
}

impl Search<'_> {
    /// Distance of a point from the nearest place where the smallest sphere would touch something;
    /// less than 0 where it would overlap.
    fn clearance(&self, p: &Point, facets: &[u32], balls: &[u32]) -> f64 {
        let to_wall = facets
            .iter()
            .map(|f| distance_to_triangle(p, &self.facets[*f as usize]) - self.radius);
        let to_balls = balls.iter().map(|b| {
            let (centre, reduced) = self.balls[*b as usize];
            distance(p, &centre) - reduced - self.reduced
        });
        to_wall.chain(to_balls).fold(f64::INFINITY, f64::min)
    }

    /// Searches for places in a cube, given the facets and balls that may be near it.
    fn search(&mut self, middle: Point, half: f64, facets: &[u32], balls: &[u32], is_inside: bool) {
        let reach = half * 3.0_f64.sqrt();
        let near_facets: Vec<u32> = facets
            .iter()
            .copied()
            .filter(|f| {
                distance_to_triangle(&middle, &self.facets[*f as usize]) < self.radius + reach
            })
            .collect();
        let near_balls: Vec<u32> = balls
            .iter()
            .copied()
            .filter(|b| {
                let (centre, reduced) = self.balls[*b as usize];
                distance(&middle, &centre) < reduced + self.reduced + reach
            })
            .collect();
        let clearance = self.clearance(&middle, &near_facets, &near_balls);
        if clearance + reach < 0.0 {
            return;
        }
        let touches_wall = near_facets
            .iter()
            .any(|f| distance_to_triangle(&middle, &self.facets[*f as usize]) < reach);
        // A cube that no facet passes through is entirely inside or outside, and so are its parts.
        if !touches_wall && !is_inside && winding_number(self.facets, &middle) == 0 {
            return;
        }
        if clearance >= EXACT * self.radius && !touches_wall {
            self.found.push(middle);
            // One place per void is enough.
            self.balls.push((middle, self.reduced));
            return;
        }
        if reach < FINEST * self.radius {
            return;
        }
        for octant in 0..8 {
            let near_balls: Vec<u32> = near_balls
                .iter()
                .copied()
                .chain((self.balls.len() - self.found.len()..self.balls.len()).map(|b| b as u32))
                .collect();
            let child = [0, 1, 2].map(|k| {
                middle[k]
                    + if octant >> k & 1 == 0 {
                        -0.5 * half
                    } else {
                        0.5 * half
                    }
            });
            self.search(child, 0.5 * half, &near_facets, &near_balls, !touches_wall);
        }
    }
}

fn distance(a: &Point, b: &Point) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// Places for spheres of this radius that do not overlap each other, in local units.
fn voids(facets: &[[Point; 3]], packing: &Packing, overlap: f64, radius: f64) -> Vec<Point> {
    let spheres = &packing.spheres;
    let balls = spheres.positions.iter().zip(&spheres.radii);
    let mut search = Search {
        facets,
        balls: balls.map(|(p, r)| (*p, r / (1.0 + overlap))).collect(),
        radius,
        reduced: radius / (1.0 + overlap),
        found: Vec::new(),
    };
    let largest = facets.iter().flatten().flatten().fold(0.0, |m, x| x.max(m));
    let half = 0.5 * f64::max(largest, 0.0);
    let all_facets: Vec<u32> = (0..facets.len() as u32).collect();
    let all_balls: Vec<u32> = (0..search.balls.len() as u32).collect();
    search.search([half; 3], half, &all_facets, &all_balls, false);
    search.found
}

fn bare_front(surface: &Surface, diameter: &str, overlap: f64, seed: u64) -> (Sizes, Packing) {
    let settings = PackSettings {
        seed,
        ..settings(diameter, overlap, Some(0.0))
    };
    let packing = pack(surface, &settings, &|_, _| Ok(())).unwrap();
    (settings.sizes, packing)
}

fn assert_full_and_true(
    name: &str,
    surface: &Surface,
    diameter: &str,
    overlap: f64,
    seed: u64,
) -> PackHistory {
    let (sizes, packing) = bare_front(surface, diameter, overlap, seed);
    let facets = local_facets(surface);
    let radius = 0.5 * sizes.min_m() / surface.unit_m;
    let left = voids(&facets, &packing, overlap, radius);
    assert!(
        left.is_empty(),
        "{name}: {} voids among {} spheres, the first at {:?}, {:?}",
        left.len(),
        packing.spheres.radii.len(),
        left.first(),
        packing.history
    );
    assert_eq!(packing.history.voids_left, 0, "{name}");
    assert_sizes_are_true(name, surface, &packing, &sizes);
    packing.history
}

fn assert_sizes_are_true(name: &str, surface: &Surface, packing: &Packing, sizes: &Sizes) {
    let diameters: Vec<f64> = packing
        .spheres
        .radii
        .iter()
        .map(|r| 2.0 * r * surface.unit_m)
        .collect();
    for fit in [
        ks_distance_by_number(&diameters, sizes),
        ks_distance_by_mass(&diameters, sizes),
    ] {
        assert!(fit.passes(), "{name}: sizes are off, {fit:?}");
    }
}

#[test]
fn the_search_finds_the_room_of_a_sphere_taken_out() {
    let facets = cuboid([8.0, 7.0, 6.0]);
    let (surface, _) = surface_of(&facets);
    let (sizes, mut packing) = bare_front(&surface, "0.8mm..1.2mm", 0.1, 1);
    let facets = local_facets(&surface);
    let radius = 0.5 * sizes.min_m() / surface.unit_m;
    assert_eq!(voids(&facets, &packing, 0.1, radius).len(), 0);
    for taken in [3, 50, 200] {
        let place = packing.spheres.positions.remove(taken);
        packing.spheres.radii.remove(taken);
        let found = voids(&facets, &packing, 0.1, radius * (1.0 - 1e-6));
        assert!(
            found.iter().any(|p| distance(p, &place) < 2.0 * radius),
            "{found:?} {place:?}"
        );
    }
}

#[test]
fn no_void_is_left_that_takes_the_smallest_sphere() {
    let l_shape = prism(
        &[
            [0.0, 0.0],
            [12.0, 0.0],
            [12.0, 5.0],
            [5.0, 5.0],
            [5.0, 10.0],
            [0.0, 10.0],
        ],
        6.0,
    );
    let bumpy = icosphere(3, &|p: Point| {
        4.5 + 0.4 * (3.0 * p[0]).sin() * (2.0 * p[1]).cos()
    });
    let mut two_parts = cuboid([6.0, 6.0, 6.0]);
    two_parts.extend(
        cuboid([6.0, 6.0, 6.0])
            .into_iter()
            .map(|c| c.map(|p| [p[0] + 10.0, p[1], p[2]])),
    );
    let solids: [(&str, Facets); 6] = [
        ("box", cuboid([9.0, 8.0, 7.0])),
        ("L", l_shape),
        ("ball", icosphere(2, &|_| 4.8)),
        ("bumpy ball", bumpy),
        ("torus", torus(7.0, 2.4, 40, 20)),
        ("two parts", two_parts),
    ];
    let asked = [
        ("0.6mm..0.9mm", 0.25),
        ("0.8mm..1mm", 0.0),
        ("normal:0.9mm,0.1mm,0.75mm..1.1mm", 0.1),
    ];
    for (k, (name, facets)) in solids.into_iter().enumerate() {
        let (surface, _) = surface_of(&facets);
        let (diameter, overlap) = asked[k % 3];
        let name = format!("{name}, {diameter}");
        assert_full_and_true(&name, &surface, diameter, overlap, k as u64);
    }
}

/// The front reaches the entire wall of a ball at once, when hardly any draws are left that could
/// balance the small spheres put into voids.
#[test]
fn a_ball_is_full_and_true_after_a_few_attempts() {
    let (surface, _) = surface_of(&icosphere(3, &|_| 10.0));
    for seed in [1, 2] {
        let history =
            assert_full_and_true("ball of many spheres", &surface, "1mm..1.5mm", 0.25, seed);
        assert!(history.attempts <= 5, "{history:?}");
    }
}

#[test]
fn where_voids_cannot_all_be_filled_sizes_are_true_and_attempts_few() {
    let (surface, _) = surface_of(&icosphere(3, &|_| 10.0));
    let (sizes, packing) = bare_front(&surface, "normal:1.25mm,0.05mm,1mm..1.5mm", 0.25, 1);
    let history = &packing.history;
    assert!(history.voids_left > 0, "{history:?}");
    assert!(history.attempts <= 4, "{history:?}");
    assert_sizes_are_true("few small ones", &surface, &packing, &sizes);
}

#[test]
fn where_small_ones_are_too_few_voids_are_counted() {
    let (surface, _) = surface_of(&cuboid([9.0, 8.0, 7.0]));
    let (sizes, packing) = bare_front(&surface, "0.5mm..2mm", 0.0, 1);
    let facets = local_facets(&surface);
    let radius = 0.5 * sizes.min_m() / surface.unit_m;
    let left = voids(&facets, &packing, 0.0, radius).len();
    let counted = packing.history.voids_left;
    assert!(left > 100, "{left}");
    assert!(
        counted as f64 > 0.7 * left as f64 && (counted as f64) < 1.4 * left as f64,
        "{counted} counted, {left} found"
    );
    assert_exact(
        "wide",
        &facets,
        &packing.spheres.positions,
        &packing.spheres.radii,
        0.0,
        0.0,
    );
}

/// A large sphere that fits nowhere any more stops a front; in a shape a few of them across it
/// would leave most of the room.
#[test]
fn sizes_that_differ_much_fill_a_small_shape() {
    let (surface, _) = surface_of(&cuboid([4.0, 4.0, 4.0]));
    for overlap in [0.25, 0.0] {
        let settings = settings("lognormal:0.285mm,0.226mm", overlap, None);
        let packing = pack(&surface, &settings, &|_, _| Ok(())).unwrap();
        let spheres = &packing.spheres;
        let facets = local_facets(&surface);
        assert_exact(
            "wide, small",
            &facets,
            &spheres.positions,
            &spheres.radii,
            overlap,
            0.0,
        );
        let reduced = spheres.radii.iter().map(|r| (r / (1.0 + overlap)).powi(3));
        let filled = 4.0 / 3.0 * std::f64::consts::PI * reduced.sum::<f64>();
        let filled = filled * surface.unit_m.powi(3) / surface.volume_m3();
        assert!(filled > 0.54, "overlap {overlap}: {filled}");
        let diameters: Vec<f64> = (spheres.radii.iter())
            .map(|r| 2.0 * r * surface.unit_m)
            .collect();
        let fit = ks_distance_by_number(&diameters, &settings.sizes);
        assert!(fit.passes(), "overlap {overlap}: {fit:?}");
    }
}

/// Spheres too far apart for a smallest one to touch three of them leave voids as well.
#[test]
fn room_between_spheres_far_apart_is_counted() {
    let (surface, _) = surface_of(&cuboid([4.0, 4.0, 4.0]));
    let settings = settings("lognormal:0.285mm,0.226mm", 0.25, Some(0.0435));
    let packing = pack(&surface, &settings, &|_, _| Ok(())).unwrap();
    let (room, unit) = (packing.history.room_left, surface.unit_m);
    let mut random = random_numbers(5);
    let radius = 0.5 * settings.sizes.min_m() / unit;
    let spheres = &packing.spheres;
    let fits = |p: &Point| {
        let mut balls = spheres.positions.iter().zip(&spheres.radii);
        p.iter().all(|x| *x >= radius && 4e-3 / unit - x >= radius)
            && balls.all(|(c, r)| distance(p, c) >= (r + radius) / 1.25)
    };
    let points = 4000;
    let hits = (0..points)
        .map(|_| point_between(&mut random, [0.0; 3], [4e-3 / unit; 3]))
        .filter(fits)
        .count();
    let found = hits as f64 / f64::from(points);
    assert!(found > 0.4, "{found}");
    assert!((room - found).abs() < 0.04, "{room}, {found}");
    // At least a third of what the room would take if it were one.
    let smallest = 4.0 / 3.0 * std::f64::consts::PI * (radius / 1.25).powi(3);
    let voids = packing.history.voids_left as f64;
    assert!(voids > 0.3 * found * (4e-3 / unit).powi(3) / smallest);
}
