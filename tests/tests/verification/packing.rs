//! Packed shapes: the values of the report compared with their definitions, computed separately.

use std::f64::consts::PI;

use dem_io::Body;
use dem_io::surface::{ReadSettings, Surface, read_surface};
use dem_pack::{Basis, BodyReport, BodySettings, BondSettings, PackSettings, Sizes, make_body};
use nalgebra::Vector3;

use super::page::{assert_shown, filled, on_one_thread};
use super::table::{Case, compared};
use crate::root;

/// Overlap of Platzer 2022, table 1: spheres touch at radii smaller by this.
const OVERLAP: f64 = 0.25;
/// Bond range of the same table: bonds join pairs up to this times the sum of their radii apart.
const BONDING: f64 = 1.1;

/// Density of the spheres in the same table.
const DENSITY_KG_M3: f64 = 2050.0;

/// Number of points for the estimate of a volume.
const POINTS: u32 = 100_000;

/// A shape of `data/shapes` with a closed form, and the diameters of its packing.
#[derive(Debug, Clone, Copy)]
struct Shape {
    name: &'static str,
    diameters_m: [f64; 2],
    /// Box around it, m.
    box_m: [[f64; 3]; 2],
    volume_m3: f64,
    /// Relative deficit of the volume due to the facets.
    facets: f64,
    /// Largest distance of a facet outside the surface, m: chords of hollow curves.
    facets_outside_m: f64,
    /// Distance from the surface, positive inside, m.
    depth_m: fn(&Vector3<f64>) -> f64,
}

/// A box with the origin in the middle of its lower face.
const BAR_M: [f64; 3] = [0.03, 0.03, 0.06];
/// Radius and thickness of a disc whose axis is y.
const DISC_M: [f64; 2] = [0.025, 0.025];
/// Radius of the ring and of its section.
const TORUS_M: [f64; 2] = [0.02, 0.006];

/// The number of sides of the disc, and of the ring and the section of the torus.
const SIDES: [f64; 3] = [96.0, 120.0, 48.0];

fn shapes() -> [Shape; 3] {
    let [across, _, height] = BAR_M;
    let [radius, thickness] = DISC_M;
    let [ring, tube] = TORUS_M;
    let [sides, of_ring, of_tube] = SIDES;
    [
        Shape {
            name: "bar",
            diameters_m: [5e-3, 7e-3],
            box_m: [
                [-0.5 * across, -0.5 * across, 0.0],
                [0.5 * across, 0.5 * across, height],
            ],
            volume_m3: across * across * height,
            facets: ROUNDING,
            facets_outside_m: 0.0,
            depth_m: |p| {
                let [across, _, height] = BAR_M;
                let side = 0.5 * across - p.x.abs().max(p.y.abs());
                side.min(p.z).min(height - p.z)
            },
        },
        Shape {
            name: "disc",
            diameters_m: [4e-3, 6.1e-3],
            box_m: [
                [-radius, -0.5 * thickness, -radius],
                [radius, 0.5 * thickness, radius],
            ],
            volume_m3: 0.5 * sides * radius * radius * (2.0 * PI / sides).sin() * thickness,
            facets: ROUNDING,
            facets_outside_m: 0.0,
            depth_m: |p| {
                let [radius, thickness] = DISC_M;
                (radius - p.x.hypot(p.z)).min(0.5 * thickness - p.y.abs())
            },
        },
        Shape {
            name: "torus",
            diameters_m: [2.5e-3, 3.5e-3],
            box_m: [
                [-ring - tube, -ring - tube, -tube],
                [ring + tube, ring + tube, tube],
            ],
            volume_m3: 2.0 * PI * PI * ring * tube * tube,
            // Polygons of n sides in circles: (2 pi/n)^2/6 less.
            facets: [of_ring, of_tube]
                .map(|n| (2.0 * PI / n).powi(2) / 6.0)
                .iter()
                .sum(),
            // Around the hole, polygons are inside their circles.
            facets_outside_m: (ring - tube) * (1.0 - (PI / of_ring).cos()),
            depth_m: |p| {
                let [ring, tube] = TORUS_M;
                tube - (p.x.hypot(p.y) - ring).hypot(p.z)
            },
        },
    ]
}

/// Rounding of numbers in a file, which have 24 bits.
const ROUNDING: f64 = 1e-6;

/// A packed shape.
struct Packed {
    shape: Shape,
    surface: Surface,
    body: Body,
    report: BodyReport,
}

/// A shape packed with spheres that touch at radii smaller by `overlap`; `settle` is 0 for an
/// unsettled front.
fn packed(shape: Shape, overlap: f64, settle: Option<f64>) -> Packed {
    let file = root().join(format!("data/shapes/{}.stl", shape.name));
    let reading = ReadSettings {
        unit_m: Some(1e-3),
        scale: 1.0,
        fill_holes: false,
    };
    let surface = read_surface(&std::fs::read(file).unwrap(), shape.name, reading).unwrap();
    let [small, large] = shape.diameters_m.map(|diameter| 1e3 * diameter);
    let sizes = Sizes::parse(&format!("{small}mm..{large}mm"), Basis::Number).unwrap();
    let packing = PackSettings {
        overlap,
        densify: settle,
        ..PackSettings::new(sizes)
    };
    let settings = BodySettings {
        bonds: BondSettings {
            range: BONDING,
            ..BondSettings::default()
        },
        particle_density_kg_m3: Some(DENSITY_KG_M3),
        ..BodySettings::new(packing)
    };
    let (body, report) = make_body(&surface, &settings, &|_, _| Ok(())).unwrap();
    Packed {
        shape,
        surface,
        body,
        report,
    }
}

impl Packed {
    fn spheres(&self) -> impl Iterator<Item = (Vector3<f64>, f64)> {
        let places = self
            .body
            .positions
            .iter()
            .map(|&place| Vector3::from(place));
        places.zip(self.body.radii.iter().copied())
    }

    /// Volume of all spheres with their radii divided by this, overlaps counted twice, m3.
    fn sum_m3(&self, over: f64) -> f64 {
        let volume = |radius: f64| 4.0 / 3.0 * PI * (radius / over).powi(3);
        self.body.radii.iter().map(|&radius| volume(radius)).sum()
    }

    /// Volume of the union of the spheres, m3, and its standard error, from points evenly spread in
    /// the box.
    fn union_m3(&self) -> [f64; 2] {
        let [low, high] = self.shape.box_m.map(Vector3::from);
        let size = high - low;
        let spheres: Vec<(Vector3<f64>, f64)> = self.spheres().collect();
        // Roots of x^4 = x + 1: an additive sequence that fills a cube evenly.
        let root = 1.220_744_084_605_759_5_f64;
        let steps = Vector3::new(1.0 / root, 1.0 / root.powi(2), 1.0 / root.powi(3));
        let inside = (1..=POINTS).filter(|&i| {
            let unit = (steps * f64::from(i)).map(f64::fract);
            let point = low + size.component_mul(&unit);
            spheres
                .iter()
                .any(|(place, radius)| (place - point).norm_squared() < radius * radius)
        });
        let fraction = inside.count() as f64 / f64::from(POINTS);
        let error = (fraction * (1.0 - fraction) / f64::from(POINTS)).sqrt();
        [fraction, error].map(|fraction| fraction * size.product())
    }

    /// Pairs at most this times the sum of their radii apart, and the largest overlap of reduced
    /// spheres over the smaller one's radius.
    fn pairs(&self) -> (usize, f64) {
        let spheres: Vec<(Vector3<f64>, f64)> = self.spheres().collect();
        let (mut near, mut largest) = (0, 0.0_f64);
        for (i, (a, r)) in spheres.iter().enumerate() {
            for (b, s) in &spheres[..i] {
                let (apart, reach) = ((a - b).norm(), r + s);
                near += usize::from(apart <= BONDING * reach);
                let smaller = r.min(*s) / (1.0 + OVERLAP);
                largest = largest.max((reach / (1.0 + OVERLAP) - apart) / smaller);
            }
        }
        (near, largest)
    }

    /// Largest protrusion of a sphere from the shape and its facets, as a fraction of its radius; 0
    /// if there is none.
    fn stands_out(&self) -> f64 {
        let out = |(place, radius): (Vector3<f64>, f64)| {
            let depth_m = (self.shape.depth_m)(&place) + self.shape.facets_outside_m;
            (radius - depth_m) / radius
        };
        self.spheres().map(out).fold(0.0, f64::max)
    }
}

/// Volumes of shapes, of the union of the spheres, and of the reduced spheres.
fn volumes(all: &[Packed]) -> [String; 3] {
    let (mut shapes, mut unions, mut reduced) = (Vec::new(), Vec::new(), Vec::new());
    for packed in all {
        let (name, quality) = (packed.shape.name, &packed.report.quality);
        let volume = packed.surface.volume_m3();
        let bound = packed.shape.facets;
        shapes.push(Case::new(
            name,
            1e9 * volume,
            1e9 * packed.shape.volume_m3,
            bound,
        ));
        let [union, error] = packed.union_m3();
        let found = quality.union_density;
        let bound = 4.0 * error.hypot(found.error * volume) / union;
        unions.push(Case::new(
            name,
            1e9 * found.value * volume,
            1e9 * union,
            bound,
        ));
        let wanted = packed.sum_m3(1.0 + OVERLAP) / volume;
        reduced.push(Case::new(name, quality.generating_density, wanted, 1e-12));
    }
    [
        compared("shape", "mm3", &shapes),
        compared("shape", "mm3", &unions),
        compared("shape", "", &reduced),
    ]
}

/// Values found by counting: bonds, density, sizes, overlaps and walls.
fn counts(all: &[Packed]) -> [String; 3] {
    let (mut counted, mut sizes, mut exact) = (Vec::new(), Vec::new(), Vec::new());
    for packed in all {
        let (name, quality) = (packed.shape.name, &packed.report.quality);
        let count = packed.body.radii.len() as f64;
        let (near, overlap) = packed.pairs();
        counted.push(Case::new(
            format!("{name}, {count} spheres: bonds per sphere"),
            quality.bonds_per_particle,
            near as f64 / count,
            1e-12,
        ));
        counted.push(Case::new(
            format!("{name}: coordination"),
            quality.mean_coordination,
            2.0 * near as f64 / count,
            1e-12,
        ));
        counted.push(Case::new(
            format!("{name}: solid density, kg/m3"),
            quality.solid_density_kg_m3.unwrap(),
            DENSITY_KG_M3 * packed.sum_m3(1.0) / packed.surface.volume_m3(),
            1e-12,
        ));
        let [small, large] = packed.shape.diameters_m;
        let middle = 0.5 * (small + large);
        let bound = 3.0 * (large - small) / (12.0 * count).sqrt() / middle;
        let mean = 2e3 * packed.body.radii.iter().sum::<f64>() / count;
        sizes.push(Case::new(name, mean, 1e3 * middle, bound));
        exact.push(Case::of_scale(
            format!("{name}: overlap of reduced spheres"),
            [overlap, 0.0],
            1.0,
            EXACT,
        ));
        exact.push(Case::of_scale(
            format!("{name}: out of the wall"),
            [packed.stands_out(), 0.0],
            1.0,
            EXACT,
        ));
    }
    [
        compared("shape", "", &counted),
        compared("shape", "mm", &sizes),
        compared("shape", "", &exact),
    ]
}

/// Overlaps of touching spheres in the front, which puts each against three others. Printed:
/// spheres of 1 mm and 0.7 mm at an overlap of 0.1.
fn touching() -> String {
    let [bar, ..] = shapes();
    let fraction = |overlap: f64| {
        let packed = packed(bar, overlap, Some(0.0));
        let spheres: Vec<(Vector3<f64>, f64)> = packed.spheres().collect();
        let pairs = spheres.iter().enumerate().flat_map(|(i, a)| {
            let before = spheres[..i].iter();
            before.map(move |b| 1.0 - (a.0 - b.0).norm() / (a.1 + b.1))
        });
        pairs.fold(0.0, f64::max)
    };
    let [little, much] = [0.1, OVERLAP].map(fraction);
    compared(
        "overlap",
        "",
        &[
            Case::new("0.1: fraction of the radii", little, 0.1 / 1.1, EXACT),
            Case::new("0.25: fraction of the radii", much, 0.25 / 1.25, EXACT),
            Case::new(
                "0.1: of 1 mm and 0.7 mm, mm",
                1.7 * little,
                0.155,
                0.0005 / 0.155,
            ),
        ],
    )
}

/// Rounding of positions, and of the corners of the shapes, relative to radii.
const EXACT: f64 = 1e-9;

/// The page of packing equals the results of the packer.
#[test]
fn the_page_shows_what_the_packer_gives() {
    let page = on_one_thread(|| {
        let all = shapes().map(|shape| packed(shape, OVERLAP, None));
        let [shapes, unions, reduced] = volumes(&all);
        let [counted, sizes, exact] = counts(&all);
        filled(
            include_str!("packing.md"),
            &[
                ("shapes", shapes),
                ("unions", unions),
                ("reduced", reduced),
                ("counted", counted),
                ("sizes", sizes),
                ("exact", exact),
                ("touching", touching()),
            ],
        )
    });
    assert_shown(&[("packing.md".to_owned(), page)]);
}
