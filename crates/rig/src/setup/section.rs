//! The section of a body that is pressed or pulled, and how much of its ends is pressed, measured
//! on its particles.

use dem_io::units::{show_quantity, significant};
use dem_scene::{BoxShape, PlaneShape, Scene, Test, Wall, WallShape};
use nalgebra::Vector3;

use crate::setup::walls::{middle_of, placed};
use dem_engine::state::State;
use dem_laboratory::TestType;

/// Directions in which the outline of a section is measured.
const DIRECTIONS: usize = 180;
/// Most layers of the middle half of a body whose sections are measured.
const MOST_LAYERS: usize = 8;
/// Points of the edge of a round plate.
const POINTS: usize = 64;
/// Largest deviation of a section, a length or a pressed area that raises no doubt.
const MUCH: f64 = 0.05;
/// Diameters across a body of which the section is clear, and the largest deviation of others.
const FEW: f64 = 2.5;
const MUCH_OF_FEW: f64 = 0.5;
/// Largest ratio of the sections of a body that counts as prismatic.
const PRISMATIC: f64 = 1.15;

/// A convex outline, anticlockwise, m.
type Outline = Vec<[f64; 2]>;

/// The particles of a body as seen along its axis.
struct Seen {
    /// Place across the axis, along it, and radius, m.
    particles: Vec<([f64; 2], f64, f64)>,
    /// Ends along the axis, m.
    ends_m: [f64; 2],
    /// Mean diameter, m.
    diameter_m: f64,
}

/// Two unit vectors square to a direction and to each other.
struct Across([Vector3<f64>; 2]);

impl Across {
    fn of(direction: Vector3<f64>) -> Self {
        let least = direction.iamin();
        let mut axis = Vector3::zeros();
        axis[least] = 1.0;
        let u = (axis - direction * axis.dot(&direction)).normalize();
        Self([u, direction.cross(&u)])
    }

    fn place(&self, point: Vector3<f64>) -> [f64; 2] {
        self.0.map(|axis| axis.dot(&point))
    }
}

impl Seen {
    fn of(state: &State, particles: &[u32], direction: Vector3<f64>, across: &Across) -> Self {
        let seen = particles.iter().map(|&i| {
            let pose = &state.particles.poses[i as usize];
            let place = pose.place();
            (across.place(place), place.dot(&direction), pose.radius_m())
        });
        let particles: Vec<([f64; 2], f64, f64)> = seen.collect();
        let ends_m = particles.iter().fold(
            [f64::INFINITY, f64::NEG_INFINITY],
            |[low, high], (_, at, radius)| [low.min(at - radius), high.max(at + radius)],
        );
        let radii: f64 = particles.iter().map(|(.., radius)| radius).sum();
        let diameter_m = 2.0 * radii / particles.len().max(1) as f64;
        Self {
            particles,
            ends_m,
            diameter_m,
        }
    }

    /// Outline of the particles whose centres lie between two places along the axis, m.
    fn outline(&self, from_m: f64, to_m: f64) -> Outline {
        let is_in = |at: f64| (from_m..=to_m).contains(&at);
        let inner = self.particles.iter().filter(|(_, at, _)| is_in(*at));
        let inner: Vec<([f64; 2], f64)> = inner.map(|(place, _, r)| (*place, *r)).collect();
        outline_of(&inner)
    }

    /// Sections of layers of the middle half, m2, smallest first.
    fn sections_m2(&self) -> Vec<f64> {
        let [low_m, high_m] = self.ends_m;
        let length_m = high_m - low_m;
        let count = (0.25 * length_m / self.diameter_m) as usize;
        let count = count.clamp(1, MOST_LAYERS);
        let thickness_m = (0.5 * length_m / count as f64).max(self.diameter_m);
        let radius_m = 0.5 * self.diameter_m;
        // The corners of the section lie beyond the spheres in them.
        let corners_m2 = (4.0 - std::f64::consts::PI) * radius_m * radius_m;
        let mut sections: Vec<f64> = (0..count)
            .map(|layer| {
                let middle_m =
                    low_m + length_m * (0.25 + 0.5 * (layer as f64 + 0.5) / count as f64);
                let half_m = 0.5 * thickness_m;
                area_m2(&self.outline(middle_m - half_m, middle_m + half_m)) + corners_m2
            })
            .collect();
        sections.sort_by(f64::total_cmp);
        sections
    }
}

/// The convex outline of discs, m: of the extreme one in each direction the extreme point.
fn outline_of(discs: &[([f64; 2], f64)]) -> Outline {
    let point = |number: usize| {
        let angle = std::f64::consts::TAU * number as f64 / DIRECTIONS as f64;
        let (sin, cos) = angle.sin_cos();
        let reach = |([x, y], radius): &([f64; 2], f64)| x * cos + y * sin + radius;
        let far = discs.iter().max_by(|a, b| reach(a).total_cmp(&reach(b)));
        far.map(|([x, y], radius)| [x + radius * cos, y + radius * sin])
    };
    (0..DIRECTIONS).filter_map(point).collect()
}

fn area_m2(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let twice: f64 = outline
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum();
    0.5 * twice
}

/// The part of a convex outline within another.
fn common(outline: &[[f64; 2]], other: &[[f64; 2]]) -> Outline {
    let mut rest = outline.to_vec();
    for (a, b) in other.iter().zip(other.iter().cycle().skip(1)) {
        let inside = |p: &[f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let mut kept = Vec::new();
        for (p, q) in rest.iter().zip(rest.iter().cycle().skip(1)) {
            let (from, to) = (inside(p), inside(q));
            if from >= 0.0 {
                kept.push(*p);
            }
            if from * to < 0.0 {
                let part = from / (from - to);
                kept.push([p[0] + part * (q[0] - p[0]), p[1] + part * (q[1] - p[1])]);
            }
        }
        rest = kept;
    }
    rest
}

/// Centre of the area within an outline, m.
fn centre_m(outline: &[[f64; 2]]) -> [f64; 2] {
    let area_m2 = area_m2(outline);
    let mut sum = [0.0; 2];
    for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
        let part = a[0] * b[1] - a[1] * b[0];
        for k in 0..2 {
            sum[k] += (a[k] + b[k]) * part / (6.0 * area_m2);
        }
    }
    sum
}

/// Tangent of the angle between the axis of the body and the direction of the test: how far the
/// centres of its sections at 30 % and 70 % of its length lie apart across it.
fn tilt(seen: &Seen) -> f64 {
    let [low_m, high_m] = seen.ends_m;
    let length_m = high_m - low_m;
    let half_m = (0.1 * length_m).max(seen.diameter_m);
    let [low, high] = [0.3, 0.7].map(|at| {
        let middle_m = low_m + at * length_m;
        centre_m(&seen.outline(middle_m - half_m, middle_m + half_m))
    });
    (high[0] - low[0]).hypot(high[1] - low[1]) / (0.4 * length_m)
}

/// What a wall covers of a plane square to the direction of a test.
enum Cover {
    All,
    Within(Outline),
    /// It is not known.
    Unknown,
}

fn cover(wall: &Wall, direction: Vector3<f64>, across: &Across) -> Cover {
    let seen = |points: Vec<Vector3<f64>>| -> Outline {
        let discs: Vec<([f64; 2], f64)> = points
            .into_iter()
            .map(|point| (across.place(point), 0.0))
            .collect();
        outline_of(&discs)
    };
    match &wall.shape {
        WallShape::Plane(_) => Cover::All,
        WallShape::Box(BoxShape { min_m, max_m }) => {
            let corner = |number: usize| {
                let side = |k: usize| [min_m, max_m][number >> k & 1][k];
                placed(wall, [side(0), side(1), side(2)])
            };
            Cover::Within(seen((0..8).map(corner).collect()))
        }
        WallShape::Cylinder(pin) => {
            let [from, to] = [pin.from_m, pin.to_m].map(|end| placed(wall, end));
            let axis = (to - from).normalize();
            // Across the load it touches along a line.
            if axis.cross(&direction).norm() > MUCH {
                return Cover::Unknown;
            }
            let edge = Across::of(axis);
            let point = |number: usize| {
                let (sin, cos) = (std::f64::consts::TAU * number as f64 / POINTS as f64).sin_cos();
                from + (edge.0[0] * cos + edge.0[1] * sin) * pin.radius_m
            };
            Cover::Within(seen((0..POINTS).map(point).collect()))
        }
        _ => Cover::Unknown,
    }
}

/// Part of a flat end of the body that these walls press. None: it is not known, or there are
/// none.
fn pressed(
    seen: &Seen,
    is_high: bool,
    walls: &[&Wall],
    direction: Vector3<f64>,
    across: &Across,
) -> Option<f64> {
    if walls.is_empty() {
        return None;
    }
    let [low_m, high_m] = seen.ends_m;
    // Centres begin a radius below the end: as thick as the layers with which it is compared.
    let depth_m = 1.5 * seen.diameter_m;
    let end = if is_high {
        seen.outline(high_m - depth_m, high_m)
    } else {
        seen.outline(low_m, low_m + depth_m)
    };
    // A layer of a lattice is always in it.
    let half_m = 0.51 * seen.diameter_m;
    let inner = [0.35, 0.5, 0.65].map(|at| {
        let middle_m = low_m + at * (high_m - low_m);
        area_m2(&seen.outline(middle_m - half_m, middle_m + half_m))
    });
    let inner_m2 = inner.iter().sum::<f64>() / 3.0;
    let mut covered_m2 = 0.0;
    for wall in walls {
        covered_m2 += match cover(wall, direction, across) {
            Cover::All => area_m2(&end),
            Cover::Within(outline) => area_m2(&common(&end, &outline)),
            Cover::Unknown => return None,
        };
    }
    let part = covered_m2.min(area_m2(&end)) / inner_m2;
    part.is_finite().then_some(part.min(1.0))
}

/// What is measured on the body of a test, and the doubts that follow.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) section_m2: Option<f64>,
    /// The smaller of the pressed parts of its ends.
    pub(super) pressed: Option<f64>,
    /// Reasons to doubt the test, a sentence each.
    pub(super) warnings: Vec<String>,
}

/// Looks at a body that is pressed or pulled along its length, whose formula takes this length, m,
/// and area, m2. `volume_m3`: of its shape, if known; `free_m`: its length between grips;
/// `is_necked`: length and area are those of a neck.
pub(super) fn look_at_bar(
    scene: &Scene,
    test: &Test,
    state: &State,
    particles: &[u32],
    (length_m, area_m2): (f64, f64),
    (volume_m3, free_m): (Option<f64>, Option<f64>),
    is_necked: bool,
) -> Found {
    let mut found = Found::default();
    if particles.is_empty() {
        return found;
    }
    let direction = Vector3::from(test.direction);
    let across = Across::of(direction);
    let seen = Seen::of(state, particles, direction, &across);
    let body_m = seen.ends_m[1] - seen.ends_m[0];
    let sections = seen.sections_m2();
    let (least_m2, most_m2) = (sections[0], sections[sections.len() - 1]);
    let of_shape_m2 = volume_m3.map(|volume| volume / body_m);
    let mean_m2 = sections.iter().sum::<f64>() / sections.len() as f64;
    let is_prismatic = most_m2 < PRISMATIC * least_m2
        && of_shape_m2.is_some_and(|area| (area / mean_m2).max(mean_m2 / area) < PRISMATIC);
    let section_m2 = match of_shape_m2 {
        Some(area) if is_prismatic => area,
        _ if is_necked => least_m2,
        _ => mean_m2,
    };
    found.section_m2 = Some(section_m2);
    // A body with a neck, or whose shape is not known, has sections from one size to another.
    let [low_m2, high_m2] = if is_prismatic {
        [section_m2; 2]
    } else {
        let all = sections.iter().copied().chain(of_shape_m2);
        let least = all.clone().fold(f64::INFINITY, f64::min);
        [least, all.fold(0.0, f64::max)]
    };
    // Few spheres have no clear section.
    let is_resolved = section_m2.sqrt() > FEW * seen.diameter_m;
    let much = if is_resolved { MUCH } else { MUCH_OF_FEW };
    if area_m2 < (1.0 - much) * low_m2 || area_m2 > (1.0 + much) * high_m2 {
        let said = if test.area_m2.is_some() {
            "test.area is"
        } else {
            "the area taken, that of the box around the body, is"
        };
        found.warnings.push(format!(
            "{said} {}, and the section of the body '{}' {}: stress and modulus are {} times those of the body; correct or write test.area",
            show_quantity(area_m2, "m2"),
            test.body,
            show_quantity(section_m2, "m2"),
            significant(section_m2 / area_m2, 3)
        ));
    }
    let shortest_m = match test.kind {
        _ if is_necked => None,
        TestType::Tension | TestType::HopkinsonTension => free_m,
        _ => Some(body_m),
    };
    if let Some(shortest_m) = shortest_m.filter(|least| length_m < (1.0 - MUCH) * least) {
        found.warnings.push(format!(
            "the length taken is {}, and the body '{}' has {}: the modulus is {} times that of the body; correct test.length",
            show_quantity(length_m, "m"),
            test.body,
            show_quantity(shortest_m, "m"),
            significant(length_m / shortest_m, 3)
        ));
    }
    let presses = matches!(
        test.kind,
        TestType::Compression | TestType::HopkinsonPressure | TestType::TriaxialCompression
    );
    if presses {
        look_at_ends(scene, test, &seen, direction, &across, &mut found);
    }
    found
}

/// Looks at the ends of a body between plates.
fn look_at_ends(
    scene: &Scene,
    test: &Test,
    seen: &Seen,
    direction: Vector3<f64>,
    across: &Across,
    found: &mut Found,
) {
    let middle_m = 0.5 * (seen.ends_m[0] + seen.ends_m[1]);
    let lateral = test
        .confinement
        .as_ref()
        .map(|confinement| &confinement.walls);
    let is_lateral = |name: &String| lateral.is_some_and(|walls| walls.contains(name));
    let is_behind = |wall: &Wall| match &wall.shape {
        WallShape::Plane(PlaneShape { point_m, normal }) => {
            let normal_m = [0, 1, 2].map(|k| point_m[k] + normal[k]);
            let normal = placed(wall, normal_m) - placed(wall, *point_m);
            normal.dot(&direction) < -0.99
        }
        _ => middle_of(wall).is_none_or(|place| place.dot(&direction) > middle_m),
    };
    let moving: Vec<&Wall> = (test.crosshead.iter())
        .filter_map(|name| scene.walls.get(name))
        .collect();
    let others = scene.walls.iter();
    let resting: Vec<&Wall> = others
        .filter(|(name, wall)| {
            !test.crosshead.contains(name) && !is_lateral(name) && is_behind(wall)
        })
        .map(|(_, wall)| wall)
        .collect();
    let tilt = tilt(seen);
    if tilt > MUCH {
        found.warnings.push(format!(
            "the body '{}' stands askew between the plates, by {:.1} degrees (at most {:.1}): turn it, so that force over area is its stress",
            test.body,
            tilt.atan().to_degrees(),
            MUCH.atan().to_degrees()
        ));
    }
    for (is_high, walls, side) in [
        (false, moving, "the loaded end"),
        (true, resting, "the other end"),
    ] {
        let Some(part) = pressed(seen, is_high, &walls, direction, across) else {
            continue;
        };
        found.pressed = Some(found.pressed.map_or(part, |other| other.min(part)));
        if part < 1.0 - MUCH {
            found.warnings.push(format!(
                "{side} of the body '{}' is pressed over {:.0} % of its section (at least {:.0} %): the plate is smaller, or the end is not flat or not square to test.direction; force over area is then not the stress of the body",
                test.body,
                100.0 * part,
                100.0 * (1.0 - MUCH)
            ));
        }
    }
}
