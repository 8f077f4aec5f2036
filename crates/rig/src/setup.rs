//! Geometry of a test: the dimensions for its formulas, and the particles whose displacement is
//! measured.

mod given;
mod section;
mod walls;

use dem_io::units::{show_length, show_quantity, significant};
use dem_io::{Diagnostic, Result};
use dem_scene::{Scene, Test, Wall, WallShape};
use nalgebra::Vector3;

use self::given::{Said, compare_with_body, compare_with_pins, dimension};
use self::section::look_at_bar;
use self::walls::{middle_of, placed};
use dem_engine::state::State;
use dem_laboratory::theory::Beam;
use dem_laboratory::{Specimen, TestType};

/// Half the size of the part of a body whose displacement is measured, as a fraction of its height.
const SPOT: f64 = 0.125;
/// Gauge length of a bar as a fraction of its length.
const GAUGE: f64 = 0.5;
/// Largest ratio of the larger to the smaller size of a disc across its axis.
const ROUND: f64 = 1.25;
/// A disc has split in two if the mean distance of the crack from the loaded diameter is at most
/// this fraction of the diameter.
const NEAR_DIAMETER: f64 = 0.1;
/// Largest number of slabs along the loaded diameter.
const MOST_SLABS: usize = 20;
/// Largest length or section of a test over that of the box around its body.
const ABOUT: f64 = 1.1;
/// Largest sine of the angle between the direction of a test and the normal of a plane that moves.
const OBLIQUE: f64 = 1e-3;

/// A wall that keeps a pressure on a side of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// Number of the wall in the state.
    pub wall: usize,
    /// Unit vector towards the body. Length 3.
    pub inwards: [f64; 3],
    /// Area of the side, m2.
    pub area_m2: f64,
    /// Particles halfway between the middle of the body and this wall, at half its height, whose
    /// mean displacement is that of the side.
    pub near: Vec<u32>,
    /// Distance of their mean from that of the opposite side, m; 0: the side is not measured.
    pub gauge_m: f64,
}

impl Side {
    /// Mean coordinate of the particles near it, towards the middle of the body, m.
    pub(crate) fn place_m(&self, state: &State) -> f64 {
        let places = self
            .near
            .iter()
            .map(|&i| state.particles.poses[i as usize].place());
        let sum: f64 = places
            .map(|place| place.dot(&Vector3::from(self.inwards)))
            .sum();
        sum / self.near.len().max(1) as f64
    }

    /// Force of the wall on the body, N.
    pub(crate) fn force_n(&self, state: &State) -> f64 {
        Vector3::from(state.walls[self.wall].push.force_n).dot(&Vector3::from(self.inwards))
    }
}

/// A particle near the loaded diameter of a disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InSlab {
    /// Its number in the state.
    pub particle: u32,
    /// Its slab along the diameter, in the direction of the load.
    pub slab: usize,
    /// Its share of the volume of the disc, m3.
    pub volume_m3: f64,
}

/// Initial arrangement of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// The specimen.
    pub specimen: Specimen,
    /// Unit vector of the load's motion. Length 3.
    pub direction: [f64; 3],
    /// Unit vector along which the position of the crack is measured: along a beam or bar, across
    /// the loaded diameter of a disc. Length 3.
    pub along: [f64; 3],
    /// Middle of the body, and of the span of a beam, m. Length 3.
    pub middle_m: [f64; 3],
    /// The crack is in the expected place if its mean distance from the middle is at most this, m.
    pub crack_within_m: f64,
    /// Particles whose displacement, minus that of `resting`, is the body's deflection or
    /// elongation. Empty: not measured.
    pub moving: Vec<u32>,
    /// The reference particles.
    pub resting: Vec<u32>,
    /// Their distance along a bar, or along the loaded diameter of a disc, m; otherwise 0.
    pub gauge_m: f64,
    /// Mean radius of the particles, m.
    pub mean_radius_m: f64,
    /// The walls on the sides of a triaxial test.
    pub sides: Vec<Side>,
    /// The particles along the loaded diameter of a disc.
    pub strip: Vec<InSlab>,
    /// Number of slabs of equal height into which they fall.
    pub slabs: usize,
    /// Section of a body that is pressed or pulled along its length, measured on it, m2. None: it
    /// is not measured.
    pub section_m2: Option<f64>,
    /// The smaller of the parts of its two ends that plates press. None: it is not measured.
    pub pressed: Option<f64>,
    /// What was assumed, a sentence each.
    pub notes: Vec<String>,
    /// Reasons to doubt the test, a sentence each.
    pub warnings: Vec<String>,
}

impl Setup {
    /// An arrangement without the particles that are chosen for measurements.
    fn of(
        specimen: Specimen,
        direction: [f64; 3],
        along: [f64; 3],
        middle_m: [f64; 3],
        crack_within_m: f64,
    ) -> Self {
        Self {
            specimen,
            direction,
            along,
            middle_m,
            crack_within_m,
            moving: Vec::new(),
            resting: Vec::new(),
            gauge_m: 0.0,
            mean_radius_m: 0.0,
            sides: Vec::new(),
            strip: Vec::new(),
            slabs: 0,
            section_m2: None,
            pressed: None,
            notes: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The same with what was said on its dimensions.
    fn saying(self, said: Said) -> Self {
        Self {
            notes: said.notes,
            warnings: said.warnings,
            ..self
        }
    }
}

/// Determines the arrangement from walls and body. `particles`: those of the tested body, in a
/// state before the first step; `halves`: those that a direct shear test drives, and those
/// that supports hold. `volume_m3`: of the body's shape, if known.
///
/// # Errors
/// Pins that are not cylinders, or not the number that the test needs; skewed pins; a body that is
/// not between them; a disc that is not round.
pub fn setup(
    scene: &Scene,
    test: &Test,
    state: &State,
    particles: &[u32],
    halves: &[Vec<u32>; 2],
    volume_m3: Option<f64>,
) -> Result<Setup> {
    let extent = |axis: &Vector3<f64>| extent(state, particles, axis);
    let direction = Vector3::from(test.direction);
    let radii = particles
        .iter()
        .map(|&i| state.particles.poses[i as usize].radius_m());
    let mean_radius_m = radii.sum::<f64>() / particles.len().max(1) as f64;
    let found = match test.kind {
        TestType::FourPointBending | TestType::ThreePointBending => beam(scene, test, extent),
        TestType::BrazilianDisc | TestType::HopkinsonDisc => disc(test, direction, extent),
        TestType::Compression
        | TestType::Tension
        | TestType::HopkinsonPressure
        | TestType::HopkinsonTension
        | TestType::DropWeight => bar(test, direction, volume_m3, extent),
        TestType::DogBone => bar(test, direction, volume_m3, extent).map(dog_bone),
        TestType::TriaxialCompression => {
            bar(test, direction, volume_m3, extent).map(|found| Setup {
                sides: sides(scene, test, state, particles),
                ..found
            })
        }
        TestType::DirectShear => sheared(test, state, extent, halves),
    };
    let place = || format!("{}: [test]", scene.source);
    let found = found.and_then(|found| fits_the_load(test, found, mass_kg(state, particles)));
    let found = found.map_err(|(problem, remedy)| Diagnostic::input(place(), problem, remedy))?;
    if matches!(test.kind, TestType::DogBone | TestType::HopkinsonTension) {
        pulls_apart(scene, test, state, halves)?;
    }
    if !test.kind.grips() {
        all_come_nearer(scene, test, Vector3::from(found.middle_m))?;
    }
    let mut setup = Setup {
        mean_radius_m,
        ..found
    };
    if let (Specimen::Bar { length_m, area_m2 }, true) = (setup.specimen, has_section(test.kind)) {
        let free_m = free_m(test, state, halves);
        let sizes = ((length_m, area_m2), (volume_m3, free_m));
        let looked = look_at_bar(scene, test, state, particles, sizes.0, sizes.1);
        setup.section_m2 = looked.section_m2;
        setup.pressed = looked.pressed;
        setup.warnings.extend(looked.warnings);
    }
    if test.kind == TestType::DirectShear {
        // It is as wide as the particles that break off.
        setup.crack_within_m += 4.0 * mean_radius_m;
    } else {
        choose_measured(&mut setup, state, particles);
    }
    choose_strip(&mut setup, state, particles);
    Ok(setup)
}

/// Whether force over area is a result of the test.
fn has_section(kind: TestType) -> bool {
    !matches!(kind, TestType::DropWeight | TestType::DirectShear)
}

/// Length of a body between what is pulled and what is held, m. None: nothing is held.
fn free_m(test: &Test, state: &State, halves: &[Vec<u32>; 2]) -> Option<f64> {
    if halves.iter().any(Vec::is_empty) {
        return None;
    }
    let direction = Vector3::from(test.direction);
    let [[pulled_m, _], [_, held_m]] =
        (halves.each_ref()).map(|half| extent(state, half, &direction));
    Some((pulled_m - held_m).max(0.0))
}

/// Refuses a body that is too long for the pulse in its bars, or too heavy for the weight.
fn fits_the_load(test: &Test, found: Setup, body_kg: f64) -> std::result::Result<Setup, Refusal> {
    let length_m = match found.specimen {
        Specimen::Bar { length_m, .. } => length_m,
        Specimen::Disc { diameter_m, .. } => diameter_m,
        Specimen::Beam(_) => return Ok(found),
    };
    if let Some(bars) = &test.bars
        && length_m >= 2.0 * bars.striker_m
    {
        let problem = format!(
            "the body '{}' is {} long, and the pulse {}, twice the striker (at most as long)",
            test.body,
            show_length(length_m),
            show_length(2.0 * bars.striker_m)
        );
        return Err((problem, "take a longer striker, or a shorter body"));
    }
    // Lighter than what it touches, a weight would need smaller steps than a fixed wall.
    if let Some(weight) = &test.weight
        && weight.mass_kg < body_kg
    {
        let problem = format!(
            "the weight of {} is lighter than the body '{}' of {} (at least as heavy)",
            show_quantity(weight.mass_kg, "kg"),
            test.body,
            show_quantity(body_kg, "kg")
        );
        return Err((
            problem,
            "take a heavier weight, or let the body fall on a wall",
        ));
    }
    Ok(found)
}

fn mass_kg(state: &State, particles: &[u32]) -> f64 {
    let masses = particles
        .iter()
        .map(|&i| 1.0 / state.particles.motions[i as usize].inverse_mass);
    masses.sum()
}

/// Smallest and largest coordinate of the body along an axis, m.
pub(crate) fn extent(state: &State, particles: &[u32], axis: &Vector3<f64>) -> [f64; 2] {
    particles
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &i| {
            let pose = &state.particles.poses[i as usize];
            let (at, radius) = (pose.place().dot(axis), pose.radius_m());
            [low.min(at - radius), high.max(at + radius)]
        })
}

fn size([low, high]: [f64; 2]) -> f64 {
    high - low
}

fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// A unit vector or its opposite, whichever has a positive largest component.
fn forwards(along: Vector3<f64>) -> Vector3<f64> {
    if along[along.iamax()] < 0.0 {
        -along
    } else {
        along
    }
}

type Refusal = (String, &'static str);

/// A point of the axis of a pin, m, and the unit vector along it.
type Pin = (Vector3<f64>, Vector3<f64>);

/// The pins of a bending test that load it, and those that support it.
fn bending_pins(scene: &Scene, test: &Test) -> std::result::Result<[Vec<Pin>; 2], Refusal> {
    let (loads, supports): (Vec<_>, Vec<_>) = scene
        .walls
        .iter()
        .partition(|(name, _)| test.crosshead.contains(name));
    let wanted = if test.kind == TestType::FourPointBending {
        2
    } else {
        1
    };
    if loads.len() != wanted || supports.len() != 2 {
        return Err((
            format!(
                "a {} test has {wanted} moving and 2 fixed pins, but here are {} and {}",
                test.kind.name(),
                loads.len(),
                supports.len()
            ),
            "add or remove walls, and name those that load in moves",
        ));
    }
    let pins = |walls: &[(&String, &Wall)]| -> std::result::Result<Vec<Pin>, Refusal> {
        walls.iter().map(|(name, wall)| pin(name, wall)).collect()
    };
    Ok([pins(&loads)?, pins(&supports)?])
}

/// A beam between pins.
fn beam(
    scene: &Scene,
    test: &Test,
    extent: impl Fn(&Vector3<f64>) -> [f64; 2],
) -> std::result::Result<Setup, Refusal> {
    let [loads, supports] = bending_pins(scene, test)?;
    let direction = Vector3::from(test.direction);
    let across = loads[0].1;
    let along = across.cross(&direction);
    if along.norm() < 0.999
        || [&loads, &supports]
            .into_iter()
            .flatten()
            .any(|(_, axis)| axis.dot(&across).abs() < 0.999)
    {
        let remedy = "turn them: all have one axis, and direction is square to it";
        return Err((
            "the pins stand askew to each other or to direction".to_owned(),
            remedy,
        ));
    }
    let along = forwards(along.normalize());
    let place = |pins: &[Pin]| -> Vec<f64> {
        let mut places: Vec<f64> = pins.iter().map(|(place, _)| place.dot(&along)).collect();
        places.sort_by(f64::total_cmp);
        places
    };
    let (loaded, held) = (place(&loads), place(&supports));
    let mut said = Said::default();
    let [wide_m, high_m] = [across, direction].map(|way| size(extent(&way)));
    compare_with_pins(
        "support_span",
        test.support_span_m,
        held[1] - held[0],
        &mut said,
    );
    compare_with_body(test, "width", test.width_m, wide_m, &mut said);
    compare_with_body(test, "height", test.height_m, high_m, &mut said);
    let beam = Beam {
        span_m: test.support_span_m.unwrap_or(held[1] - held[0]),
        loading_span_m: match loaded[..] {
            [left, right] => {
                compare_with_pins("loading_span", test.loading_span_m, right - left, &mut said);
                test.loading_span_m.unwrap_or(right - left)
            }
            _ => 0.0,
        },
        width_m: dimension(test, "width", test.width_m, wide_m, &mut said),
        height_m: dimension(test, "height", test.height_m, high_m, &mut said),
    };
    let [low, high] = extent(&along);
    if !(low < held[1] && high > held[0]) || beam.span_m <= beam.loading_span_m {
        let remedy =
            "the supports are further apart than the loading pins, and the body lies on them";
        return Err((
            "the body or the loading pins are not between the supports".to_owned(),
            remedy,
        ));
    }
    let centre = middle([held[0], held[1]]) * along
        + middle(extent(&across)) * across
        + middle(extent(&direction)) * direction;
    // A crack in three-point bending starts under the pin: it may deviate by half the height.
    let crack_within_m = if loaded.len() == 2 {
        0.5 * beam.loading_span_m
    } else {
        0.5 * beam.height_m
    };
    Ok(Setup::of(
        Specimen::Beam(beam),
        test.direction,
        along.into(),
        centre.into(),
        crack_within_m,
    )
    .saying(said))
}

/// Middle of a pin and unit vector along it.
fn pin(name: &str, wall: &Wall) -> std::result::Result<Pin, Refusal> {
    let WallShape::Cylinder { from_m, to_m, .. } = &wall.shape else {
        let problem = format!("the wall '{name}' is no cylinder, which pins are");
        return Err((
            problem,
            "write cylinder = { from, to, radius }, or remove the wall",
        ));
    };
    let [from, to] = [*from_m, *to_m].map(|end| placed(wall, end));
    Ok((0.5 * (from + to), (to - from).normalize()))
}

/// Normal of a plane at the start. None: it is another shape.
fn normal_of(wall: &Wall) -> Option<Vector3<f64>> {
    let WallShape::Plane { point_m, normal } = wall.shape else {
        return None;
    };
    let tip_m = [0, 1, 2].map(|k| point_m[k] + normal[k]);
    Some(placed(wall, tip_m) - placed(wall, point_m))
}

/// Refuses planes that load obliquely, walls that load by moving away from the body, and a
/// transmission bar that is not behind it.
fn all_come_nearer(scene: &Scene, test: &Test, middle: Vector3<f64>) -> Result<()> {
    let direction = Vector3::from(test.direction);
    for name in &test.crosshead {
        let normal = scene.walls.get(name).and_then(normal_of);
        if normal.is_some_and(|normal| normal.cross(&direction).norm() > OBLIQUE) {
            return Err(Diagnostic::input(
                format!("{}: test.direction", scene.source),
                format!("the wall '{name}' is not square to the direction in which it moves"),
                "write a direction along the normal of the wall",
            ));
        }
    }
    let behind_m = |name: &String| {
        let place = middle_of(scene.walls.get(name)?)?;
        Some((place - middle).dot(&Vector3::from(test.direction)))
    };
    for name in &test.crosshead {
        if let Some(behind_m) = behind_m(name).filter(|behind_m| *behind_m >= 0.0) {
            return Err(Diagnostic::input(
                format!("{}: [test]", scene.source),
                format!(
                    "the wall '{name}' moves away from the body '{}', whose middle lies {} mm behind it",
                    test.body,
                    significant(1e3 * behind_m, 3)
                ),
                "turn direction round, or name the walls that press in moves",
            ));
        }
    }
    let Some(bars) = &test.bars else {
        return Ok(());
    };
    match behind_m(&bars.transmission) {
        Some(behind_m) if behind_m <= 0.0 => Err(Diagnostic::input(
            format!("{}: test.transmission_bar", scene.source),
            format!(
                "the wall '{}' is not behind the body '{}', but {} mm before its middle along direction",
                bars.transmission,
                test.body,
                significant(-1e3 * behind_m, 3)
            ),
            "name the wall on the far side of the body",
        )),
        _ => Ok(()),
    }
}

/// Refuses a group that is pulled towards the one that is held, or that ends in the other bar.
fn pulls_apart(scene: &Scene, test: &Test, state: &State, halves: &[Vec<u32>; 2]) -> Result<()> {
    let direction = Vector3::from(test.direction);
    let [pulled_m, held_m] =
        (halves.each_ref()).map(|half| middle(extent(state, half, &direction)));
    if halves[1].is_empty() || pulled_m > held_m {
        return Ok(());
    }
    let (problem, remedy) = match &test.bars {
        Some(bars) => (
            format!(
                "the incident bar pulls '{}' towards '{}', the end of the transmission bar, {} before it",
                test.crosshead.join(", "),
                bars.transmission,
                show_length(held_m - pulled_m)
            ),
            "exchange crosshead and transmission_bar, or turn direction round",
        ),
        None => (
            format!(
                "the test pulls '{}' towards what is held, {} before it",
                test.crosshead.join(", "),
                show_length(held_m - pulled_m)
            ),
            "turn direction round, or name the group at the other end as the crosshead",
        ),
    };
    let place = format!("{}: [test]", scene.source);
    Err(Diagnostic::input(place, problem, remedy))
}

/// A disc: its axis is the one of x, y and z, perpendicular to the load, along which it is
/// shortest.
fn disc(
    test: &Test,
    direction: Vector3<f64>,
    extent: impl Fn(&Vector3<f64>) -> [f64; 2],
) -> std::result::Result<Setup, Refusal> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let square = axes.iter().filter(|axis| axis.dot(&direction).abs() < 0.5);
    let axis = square
        .min_by(|a, b| size(extent(a)).total_cmp(&size(extent(b))))
        .map_or(Vector3::y(), |axis| {
            (axis - direction * axis.dot(&direction)).normalize()
        });
    let along = forwards(axis.cross(&direction));
    let [across_m, high_m] = [along, direction].map(|way| size(extent(&way)));
    if across_m.max(high_m) > ROUND * across_m.min(high_m) {
        return Err((
            format!(
                "the body '{}' is no disc: {} mm along the load, {} mm across it (at most {ROUND} times as large one way as the other)",
                test.body,
                significant(1e3 * high_m, 3),
                significant(1e3 * across_m, 3)
            ),
            "take a disc whose axis is square to direction, or another kind of test",
        ));
    }
    let mut said = Said::default();
    let thick_m = size(extent(&axis));
    compare_with_body(test, "height", test.height_m, high_m, &mut said);
    compare_with_body(test, "width", test.width_m, thick_m, &mut said);
    let diameter_m = dimension(test, "height", test.height_m, high_m, &mut said);
    let thickness_m = dimension(test, "width", test.width_m, thick_m, &mut said);
    let centre = middle(extent(&along)) * along
        + middle(extent(&axis)) * axis
        + middle(extent(&direction)) * direction;
    Ok(Setup::of(
        Specimen::Disc {
            diameter_m,
            thickness_m,
        },
        test.direction,
        along.into(),
        centre.into(),
        NEAR_DIAMETER * diameter_m,
    )
    .saying(said))
}

/// A bar along the load.
fn bar(
    test: &Test,
    direction: Vector3<f64>,
    volume_m3: Option<f64>,
    extent: impl Fn(&Vector3<f64>) -> [f64; 2],
) -> std::result::Result<Setup, Refusal> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let of_body_m = size(extent(&direction));
    let mut said = Said::default();
    let length_m = dimension(test, "length", test.length_m, of_body_m, &mut said);
    // A box around the body, with its edges along the direction and the other axes.
    let others = axes.iter().filter(|axis| axis.dot(&direction).abs() < 0.5);
    let around_m2: f64 = others.map(|axis| size(extent(axis))).product();
    let section_m2 = volume_m3.map_or(around_m2, |volume| volume / of_body_m);
    let area_m2 = dimension(test, "area", test.area_m2, section_m2, &mut said);
    for (key, given, largest, unit) in [
        ("length", test.length_m, of_body_m, "m"),
        ("area", test.area_m2, around_m2, "m2"),
    ] {
        if let Some(given) = given.filter(|given| *given > ABOUT * largest) {
            return Err((
                format!(
                    "test.{key} is {}, and the body '{}' has {} (at most as large)",
                    show_quantity(given, unit),
                    test.body,
                    show_quantity(largest, unit)
                ),
                "check the unit, or remove the key: it is then measured",
            ));
        }
    }
    let centre: Vector3<f64> = axes.iter().map(|axis| middle(extent(axis)) * axis).sum();
    Ok(Setup::of(
        Specimen::Bar { length_m, area_m2 },
        test.direction,
        test.direction,
        centre.into(),
        0.5 * GAUGE * length_m,
    )
    .saying(said))
}

/// A dog bone: the crack belongs into its neck, whose length and section are given.
fn dog_bone(bar: Setup) -> Setup {
    let crack_within_m = match bar.specimen {
        Specimen::Bar { length_m, .. } => 0.5 * length_m,
        _ => bar.crack_within_m,
    };
    Setup {
        crack_within_m,
        ..bar
    }
}

/// The walls on the sides of a triaxial test.
fn sides(scene: &Scene, test: &Test, state: &State, particles: &[u32]) -> Vec<Side> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let extent_m = axes.map(|axis| extent(state, particles, &axis));
    let confining = |name: &String| {
        let confinement = test.confinement.as_ref();
        confinement.is_some_and(|confinement| confinement.walls.contains(name))
    };
    let walls = scene.walls.iter().enumerate();
    let side = |(wall, (_, of)): (usize, (&String, &Wall))| match of.shape {
        WallShape::Plane { normal, .. } => Some(Side {
            wall,
            inwards: normal,
            area_m2: side_m2(&extent_m, normal),
            near: near_side(
                state,
                particles,
                [test.direction, normal].map(Vector3::from),
            ),
            gauge_m: 0.0,
        }),
        _ => None,
    };
    let walls = walls.filter(|(_, (name, _))| confining(name));
    let mut sides: Vec<Side> = walls.filter_map(side).collect();
    let places: Vec<[f64; 3]> = (sides.iter())
        .map(|side| side.inwards.map(|c| c * side.place_m(state)))
        .collect();
    for at in 0..sides.len() {
        let inwards = sides[at].inwards;
        let is_opposite = |other: &&Side| (0..3).all(|k| other.inwards[k] == -inwards[k]);
        let measured = |side: &Side| !side.near.is_empty();
        let other = sides
            .iter()
            .position(|other| is_opposite(&other) && measured(other));
        if let Some(other) = other.filter(|_| measured(&sides[at])) {
            let apart = Vector3::from(places[other]) - Vector3::from(places[at]);
            sides[at].gauge_m = apart.norm();
        }
    }
    sides
}

/// The particles of a body in its middle half along `direction` that are halfway between its middle
/// and the side from which `inwards` points.
fn near_side(
    state: &State,
    particles: &[u32],
    [direction, inwards]: [Vector3<f64>; 2],
) -> Vec<u32> {
    let of = |axis: &Vector3<f64>| {
        let ends = extent(state, particles, axis);
        (middle(ends), size(ends))
    };
    let ((middle_m, height_m), (centre_m, width_m)) = (of(&direction), of(&inwards));
    let radii = particles
        .iter()
        .map(|&i| state.particles.poses[i as usize].radius_m());
    let largest_m = radii.fold(0.0, f64::max);
    let spot_m = (0.05 * width_m).max(2.0 * largest_m);
    let is_near = |i: &u32| {
        let place = state.particles.poses[*i as usize].place();
        let from_side_m = place.dot(&inwards) - centre_m + 0.5 * GAUGE * width_m;
        let from_middle_m = place.dot(&direction) - middle_m;
        from_side_m.abs() < spot_m && from_middle_m.abs() < 0.5 * GAUGE * height_m
    };
    particles.iter().copied().filter(is_near).collect()
}

/// Area of the box around a body, square to one of its axes, m2.
pub(crate) fn side_m2(extent_m: &[[f64; 2]; 3], normal: [f64; 3]) -> f64 {
    let sides = (0..3).filter(|k| normal[*k].abs() < 0.5);
    sides.map(|k| size(extent_m[k])).product()
}

/// A body whose driven half slides along the held one. The crack belongs between the two.
fn sheared(
    test: &Test,
    state: &State,
    extent: impl Fn(&Vector3<f64>) -> [f64; 2],
    halves: &[Vec<u32>; 2],
) -> std::result::Result<Setup, Refusal> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let normal = (test.normal_stress.as_ref()).map_or([0.0; 3], |normal| normal.direction);
    let along = Vector3::from(normal);
    let all = axes.map(|axis| extent(&axis));
    let mut centre: Vector3<f64> = axes.iter().map(|axis| middle(extent(axis)) * axis).sum();
    let [[_, driven_m], [held_m, _]] =
        (halves.each_ref()).map(|half| self::extent(state, half, &along));
    if halves[1].is_empty() {
        return Err((
            "no support holds the half of the body that is not driven".to_owned(),
            "add [supports.NAME] with group = its particles and fixed = true",
        ));
    }
    centre += (middle([driven_m, held_m]) - centre.dot(&along)) * along;
    Ok(Setup::of(
        Specimen::Bar {
            length_m: test.length_m.unwrap_or_else(|| size(extent(&along))),
            area_m2: test.area_m2.unwrap_or_else(|| side_m2(&all, normal)),
        },
        test.direction,
        normal,
        centre.into(),
        0.5 * (held_m - driven_m).max(0.0),
    ))
}

/// Chooses the particles within a twentieth of the diameter of a disc, or a mean diameter of the
/// particles, on both sides of the loaded diameter, and divides it into slabs of at least that mean
/// diameter.
fn choose_strip(setup: &mut Setup, state: &State, particles: &[u32]) {
    let Specimen::Disc {
        diameter_m,
        thickness_m,
    } = setup.specimen
    else {
        return;
    };
    let fits = (diameter_m / (2.0 * setup.mean_radius_m)) as usize;
    setup.slabs = fits.clamp(1, MOST_SLABS);
    let half_m = (0.05 * diameter_m).max(2.0 * setup.mean_radius_m);
    let cubed = |i: u32| state.particles.poses[i as usize].radius_m().powi(3);
    let volume_m3 = 0.25 * std::f64::consts::PI * diameter_m * diameter_m * thickness_m;
    let share = volume_m3 / particles.iter().map(|&i| cubed(i)).sum::<f64>();
    let [along, direction] = [setup.along, setup.direction].map(Vector3::from);
    for &i in particles {
        let offset = state.particles.poses[i as usize].place() - Vector3::from(setup.middle_m);
        let at = (offset.dot(&direction) / diameter_m + 0.5) * setup.slabs as f64;
        if offset.dot(&along).abs() < half_m && at >= 0.0 {
            setup.strip.push(InSlab {
                particle: i,
                slab: (at as usize).min(setup.slabs - 1),
                volume_m3: share * cubed(i),
            });
        }
    }
}

/// Chooses the particles whose displacement is measured: for a beam those at half its height at the
/// loading points and the supports, for a bar two slices at the ends of its middle half, for a disc
/// two spots at the ends of the middle half of its loaded diameter.
fn choose_measured(setup: &mut Setup, state: &State, particles: &[u32]) {
    let middle = Vector3::from(setup.middle_m);
    let [along, direction] = [setup.along, setup.direction].map(Vector3::from);
    let offset = |i: u32| state.particles.poses[i as usize].place() - middle;
    let pick = |is_in: &dyn Fn(f64, f64) -> bool| -> Vec<u32> {
        let all = particles.iter().copied();
        all.filter(|&i| is_in(offset(i).dot(&along), offset(i).dot(&direction)))
            .collect()
    };
    match setup.specimen {
        Specimen::Beam(beam) => {
            let spot = (SPOT * beam.height_m).max(2.0 * setup.mean_radius_m);
            let at = |place: f64| pick(&|x, z| (x.abs() - place).abs() < spot && z.abs() < spot);
            setup.moving = at(0.5 * beam.loading_span_m);
            setup.resting = at(0.5 * beam.span_m);
        }
        Specimen::Bar { length_m, .. } => {
            let half = 0.5 * GAUGE * length_m;
            let spot = (0.05 * length_m).max(2.0 * setup.mean_radius_m);
            setup.moving = pick(&|x, _| (x - half).abs() < spot);
            setup.resting = pick(&|x, _| (x + half).abs() < spot);
            let mean = |of: &[u32]| {
                of.iter().map(|&i| offset(i).dot(&along)).sum::<f64>() / of.len() as f64
            };
            setup.gauge_m = mean(&setup.moving) - mean(&setup.resting);
        }
        Specimen::Disc { diameter_m, .. } => {
            let half = 0.5 * GAUGE * diameter_m;
            let spot = (0.05 * diameter_m).max(2.0 * setup.mean_radius_m);
            let at = |place: f64| pick(&|x, z| x.abs() < spot && (z - place).abs() < spot);
            // The load moves forwards: what lies behind the centre moves further.
            setup.moving = at(-half);
            setup.resting = at(half);
            let mean = |of: &[u32]| {
                of.iter().map(|&i| offset(i).dot(&direction)).sum::<f64>() / of.len() as f64
            };
            setup.gauge_m = mean(&setup.resting) - mean(&setup.moving);
        }
    }
    if setup.moving.is_empty() || setup.resting.is_empty() {
        setup.moving.clear();
        setup.resting.clear();
        setup.gauge_m = 0.0;
    }
}
