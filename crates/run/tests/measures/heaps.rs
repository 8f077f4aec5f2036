//! The angle of repose of cones of spheres: lattices and random packings, cut so that all spheres
//! lie within the cone.

use std::collections::BTreeMap;
use std::f64::consts::SQRT_2;
use std::fmt::Write;

use nalgebra::{UnitQuaternion, Vector3};

use super::{Measured, assert_near};
use dem_testing::Random;

/// A sphere: centre and radius.
pub(super) type Sphere = (Vector3<f64>, f64);

/// A cone of this height and slope on the plane z = 0.
#[derive(Clone, Copy)]
struct Cone {
    height: f64,
    slope: f64,
}

impl Cone {
    fn of(height: f64, degrees: f64) -> Self {
        let slope = degrees.to_radians().tan();
        Self { height, slope }
    }

    fn radius(&self) -> f64 {
        self.height / self.slope
    }

    fn holds(&self, (place, radius): &Sphere) -> bool {
        let room = self.height - place.z - self.slope * place.x.hypot(place.y);
        room >= radius * self.slope.hypot(1.0)
    }
}

/// Layers of spheres of radius 1: squares or hexagons, the layer height, and the number of layers
/// after which they repeat.
#[derive(Clone, Copy)]
pub(super) struct Lattice {
    hexagonal: bool,
    layer: f64,
    repeats: i32,
}

pub(super) const CUBIC: Lattice = Lattice {
    hexagonal: false,
    layer: 2.0,
    repeats: 1,
};
pub(super) const CENTRED: Lattice = Lattice {
    hexagonal: false,
    layer: SQRT_2,
    repeats: 2,
};
pub(super) const HEXAGONAL: Lattice = Lattice {
    hexagonal: true,
    layer: 1.632_993_161_855_452,
    repeats: 2,
};
pub(super) const FACES: Lattice = Lattice {
    repeats: 3,
    ..HEXAGONAL
};

fn regular(lattice: &Lattice, cone: &Cone, shift: [f64; 2], turn_rad: f64) -> Vec<Vec<Sphere>> {
    let size = [cone.radius(), cone.height];
    regular_in(lattice, size, &|s| cone.holds(s), shift, turn_rad)
}

/// The spheres of a lattice that a shape of this radius and height holds, layer by layer. `shift`:
/// offset of a sphere of the lowest layer from the axis; `turn_rad`: rotation of the lattice about
/// it.
pub(super) fn regular_in(
    lattice: &Lattice,
    [radius, height]: [f64; 2],
    holds: &dyn Fn(&Sphere) -> bool,
    shift: [f64; 2],
    turn_rad: f64,
) -> Vec<Vec<Sphere>> {
    let shift = Vector3::new(shift[0], shift[1], 1.0);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::z() * turn_rad);
    let reach = radius as i32 + 4;
    let mut layers = Vec::new();
    for k in 0..=((height / lattice.layer) as i32) {
        let mut spheres = Vec::new();
        let f = f64::from(k % lattice.repeats);
        for i in -reach..=reach {
            for j in -reach..=reach {
                let (i, j, root) = (f64::from(i), f64::from(j), 3.0_f64.sqrt());
                let (x, y) = if lattice.hexagonal {
                    (2.0 * i + j + f, root * j + f / root)
                } else {
                    (2.0 * i + f, 2.0 * j + f)
                };
                let place = turn * (Vector3::new(x, y, lattice.layer * f64::from(k)) + shift);
                if holds(&(place, 1.0)) {
                    spheres.push((place, 1.0));
                }
            }
        }
        if !spheres.is_empty() {
            layers.push(spheres);
        }
    }
    layers
}

/// A lattice of at least this many layers at a random position in a cone of this slope.
fn regular_anywhere(
    lattice: &Lattice,
    degrees: f64,
    fewest: usize,
    random: &mut Random,
) -> Vec<Sphere> {
    loop {
        let top = lattice.layer * (fewest as f64 + random.within(-0.8, 3.0));
        let height = top + 1.0 + 1.0 / degrees.to_radians().cos();
        let shift = [random.within(0.0, 2.0), random.within(0.0, 2.0)];
        let turn_rad = random.within(0.0, 1.0);
        let layers = regular(lattice, &Cone::of(height, degrees), shift, turn_rad);
        if layers.len() >= fewest {
            return layers.concat();
        }
    }
}

fn dropped(cone: &Cone, spread: f64, random: &mut Random) -> Vec<Sphere> {
    dropped_in(cone.radius(), &|s| cone.holds(s), spread, random)
}

/// Spheres dropped one by one until 600 in succession do not fit into a shape of this radius, with
/// radii from `1 - spread` to `1 + spread`.
pub(super) fn dropped_in(
    reach: f64,
    holds: &dyn Fn(&Sphere) -> bool,
    spread: f64,
    random: &mut Random,
) -> Vec<Sphere> {
    let cell = 2.0 * (1.0 + spread);
    let column = |x: f64| (x / cell).floor() as i32;
    let mut cells: BTreeMap<(i32, i32), Vec<Sphere>> = BTreeMap::new();
    let mut all = Vec::new();
    let mut failed = 0;
    while failed < 600 {
        let radius = random.within(1.0 - spread, 1.0 + spread);
        let mut lowest: Option<Sphere> = None;
        for _ in 0..8 {
            let [x, y] = [0; 2].map(|_| random.within(-reach, reach));
            let (i, j) = (column(x), column(y));
            let near = (-1..=1).flat_map(|a| (-1..=1).map(move |b| (i + a, j + b)));
            let below = near.filter_map(|cell| cells.get(&cell)).flatten();
            let z = below.fold(radius, |z, (place, other)| {
                let square = (place.x - x).powi(2) + (place.y - y).powi(2);
                let room = (other + radius).powi(2) - square;
                if room > 0.0 {
                    z.max(place.z + room.sqrt())
                } else {
                    z
                }
            });
            let sphere = (Vector3::new(x, y, z), radius);
            if holds(&sphere) && lowest.is_none_or(|(place, _)| z < place.z) {
                lowest = Some(sphere);
            }
        }
        match lowest {
            Some(sphere) => {
                failed = 0;
                let key = (column(sphere.0.x), column(sphere.0.y));
                cells.entry(key).or_default().push(sphere);
                all.push(sphere);
            }
            None => failed += 1,
        }
    }
    all
}

/// The angle of repose of these spheres, degrees, under this gravity.
pub(super) fn angle_deg(spheres: &[Sphere], gravity: [f64; 3]) -> f64 {
    let mut particles = String::new();
    for (place, radius) in spheres {
        let [x, y, z] = (*place).into();
        write!(particles, "[{x:e}, {y:e}, {z:e}, {radius:e}],").unwrap();
    }
    let [x, y, z] = gravity;
    let mut run = Measured::new(&format!(
        "version = 1
run = {{ end_time = 1, time_step = 1e-3, gravity = [{x:e}, {y:e}, {z:e}] }}
materials.m = {{ density = 2000 }}
bodies.heap = {{ particles = [{particles}], material = \"m\" }}
measures.slope = {{ of = \"heap\", quantity = \"angle_of_repose\", reference = \"30 deg\" }}
"
    ));
    run.interact();
    let value = run.read()["slope"];
    let result = run.probes[0].result();
    assert_eq!(
        (result.unit.as_str(), result.reference),
        ("deg", Some(30.0))
    );
    value
}

pub(super) const DOWN: [f64; 3] = [0.0, 0.0, -9.81];

#[test]
fn lattices_cut_to_a_cone_have_its_slope() {
    let mut random = Random(11);
    for degrees in [10.0, 16.0, 22.0, 28.0, 34.0, 40.0] {
        for lattice in [CUBIC, CENTRED, HEXAGONAL, FACES] {
            let fewest = if degrees > 25.0 { 8 } else { 6 };
            let spheres = regular_anywhere(&lattice, degrees, fewest, &mut random);
            assert_near(angle_deg(&spheres, DOWN), degrees, 1.0);
        }
    }
}

/// A steep cone of six layers has about 200 spheres, few enough to depend on the position of each:
/// the largest of many errors would be a matter of luck.
#[test]
fn steep_cones_of_six_layers_have_their_slope_to_half_a_degree() {
    let mut random = Random(17);
    let mut errors_deg = Vec::new();
    for degrees in [26.0, 30.0, 35.0, 40.0] {
        for lattice in [CUBIC, CENTRED, HEXAGONAL, FACES] {
            for _ in 0..6 {
                let spheres = regular_anywhere(&lattice, degrees, 6, &mut random);
                errors_deg.push(angle_deg(&spheres, DOWN) - degrees);
            }
        }
    }
    let count = errors_deg.len() as f64;
    let mean_deg = errors_deg.iter().sum::<f64>() / count;
    let mean_square: f64 = errors_deg.iter().map(|e| e * e).sum::<f64>() / count;
    let within_1 = errors_deg.iter().filter(|e| e.abs() <= 1.0).count();
    assert!(mean_deg.abs() <= 0.2, "{mean_deg}");
    assert!(mean_square.sqrt() <= 0.5, "{}", mean_square.sqrt());
    assert!(within_1 as f64 >= 0.97 * count, "{within_1} of {count}");
}

/// Cones of 37.9 and 41.75 degrees that contain the same spheres: no measure based on their
/// positions can be right to 1 degree for both. This is why this accuracy is not promised for a
/// small regular heap.
#[test]
fn the_same_spheres_can_fill_cones_of_different_slopes() {
    let flat = Cone::of(11.058, 37.9);
    let steep = Cone::of(11.971, 41.75);
    let in_flat = regular(&CENTRED, &flat, [0.0, 0.0], 0.0);
    assert_eq!(in_flat, regular(&CENTRED, &steep, [0.0, 0.0], 0.0));
    let spheres = in_flat.concat();
    assert_eq!((in_flat.len(), spheres.len()), (7, 260));
    let angle = angle_deg(&spheres, DOWN);
    assert!(37.9 < angle && angle < 41.75, "{angle}");
}

#[test]
fn dropped_spheres_within_a_cone_have_its_slope() {
    let mut random = Random(5);
    for spread in [0.0, 0.3] {
        for degrees in [12.0, 20.0, 28.0, 40.0] {
            let cone = Cone::of(random.within(16.0, 20.0), degrees);
            let spheres = dropped(&cone, spread, &mut random);
            assert!(spheres.len() >= 200, "{}", spheres.len());
            assert_near(angle_deg(&spheres, DOWN), degrees, 1.0);
        }
    }
}

/// The position of a heap and the direction of gravity do not matter, and a few spheres that rolled
/// away hardly do.
#[test]
fn places_and_tilt_and_what_rolled_away_do_not_matter() {
    let mut random = Random(3);
    let mut spheres = dropped(&Cone::of(14.0, 25.0), 0.2, &mut random);
    let angle = angle_deg(&spheres, DOWN);
    assert_near(angle, 25.0, 1.0);
    let tilt = UnitQuaternion::from_scaled_axis(Vector3::new(0.7, -1.1, 0.4));
    let moved = Vector3::new(300.0, -200.0, 100.0);
    let tilted: Vec<Sphere> = spheres
        .iter()
        .map(|(p, r)| (tilt * p + moved, *r))
        .collect();
    let down = tilt * Vector3::from(DOWN);
    assert_near(angle_deg(&tilted, down.into()), angle, 1e-8);
    for n in 0..5 {
        let turn = f64::from(n);
        spheres.push((Vector3::new(90.0 * turn.cos(), 70.0 * turn.sin(), 1.0), 1.0));
    }
    assert_near(angle_deg(&spheres, DOWN), angle, 0.1);
}

#[test]
fn a_bed_that_is_flat_on_top_has_no_slope() {
    for layers in [1, 5] {
        let mut spheres = Vec::new();
        for n in 0..20 * 20 * layers {
            let [x, y, z] = [n % 20, n / 20 % 20, n / 400].map(|k| 2.0 * f64::from(k));
            spheres.push((Vector3::new(x, y, z + 1.0), 1.0));
        }
        assert_near(angle_deg(&spheres, DOWN), 0.0, 1e-6);
    }
}

/// Regression: the cone with the spread of two heaps 0.3 m apart had a slope of 0.3 degrees.
#[test]
fn several_heaps_have_no_slope() {
    let mut random = Random(29);
    let cone = Cone::of(12.0, 30.0);
    let heap = dropped(&cone, 0.1, &mut random);
    assert_near(angle_deg(&heap, DOWN), 30.0, 1.5);
    let reach = cone.radius();
    let at = |[x, y]: [f64; 2]| {
        let moved = move |(place, radius): &Sphere| (place + Vector3::new(x, y, 0.0), *radius);
        heap.iter().map(moved).collect::<Vec<Sphere>>()
    };
    let triangle = [0.0_f64, 2.1, 4.2].map(|turn| [turn.cos(), turn.sin()]);
    for apart in [2.0, 3.0, 8.0] {
        let two = [at([0.0; 2]), at([0.6, 0.8].map(|x| apart * reach * x))].concat();
        assert!(angle_deg(&two, DOWN).is_nan(), "two, {apart}");
        let three = triangle.map(|place| at(place.map(|x| x * apart * reach / 3.0_f64.sqrt())));
        assert!(angle_deg(&three.concat(), DOWN).is_nan(), "three, {apart}");
    }
}
