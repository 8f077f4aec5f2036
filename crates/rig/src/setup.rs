//! Geometry of a test: the dimensions for its formulas, and the particles whose displacement is
//! measured.

mod arrangement;
mod bending;
mod directions;
mod given;
mod measured;
mod section;
mod sides;
mod walls;

use dem_io::units::{show_length, show_quantity, significant};
use dem_io::{Diagnostic, Result};
use dem_scene::{Scene, Test};
use nalgebra::Vector3;

pub(crate) use self::arrangement::extent;
use self::arrangement::{GAUGE, Refusal, forwards, middle, size};
pub use self::arrangement::{InSlab, Setup, Side};
use self::bending::beam;
use self::directions::{all_come_nearer, pulls_apart};
use self::given::{Said, compare_with_body, dimension};
use self::measured::{choose_measured, choose_strip};
use self::section::look_at_bar;
pub(crate) use self::sides::side_m2;
use self::sides::sides;
use dem_engine::state::State;
use dem_laboratory::{Specimen, TestType};

/// Largest ratio of the larger to the smaller size of a disc across its axis.
const ROUND: f64 = 1.25;
/// A disc has split in two if the mean distance of the crack from the loaded diameter is at most
/// this fraction of the diameter.
const NEAR_DIAMETER: f64 = 0.1;
/// Largest length or section of a test over that of the box around its body.
const ABOUT: f64 = 1.1;
/// Largest section of a test over the mean section of its body that is one of a neck.
const NARROW: f64 = 0.7;

/// Determines the arrangement from walls and body. `particles`: those of the tested body, in a
/// state before the first step; `halves`: those that a direct shear test drives, and those
/// that supports hold. `volume_m3`: of the body's shape, if known.
///
/// # Errors
/// Pins not cylindrical, skewed, or too many or few; a body not between them; a disc not round.
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
    let is_necked = has_neck(test, size(extent(&direction)), volume_m3);
    let found = match test.kind {
        TestType::FourPointBending | TestType::ThreePointBending => beam(scene, test, extent),
        TestType::BrazilianDisc | TestType::HopkinsonDisc => disc(test, direction, extent),
        _ if is_necked => bar(test, direction, volume_m3, extent).map(dog_bone),
        TestType::Compression
        | TestType::Tension
        | TestType::DogBone
        | TestType::HopkinsonPressure
        | TestType::HopkinsonTension
        | TestType::DropWeight => bar(test, direction, volume_m3, extent),
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
        let (taken, of_body) = ((length_m, area_m2), (volume_m3, free_m));
        let looked = look_at_bar(scene, test, state, particles, taken, of_body, is_necked);
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

/// Whether length and area of a test are those of a neck: always those of a dog bone, and between
/// bars those of a section much smaller than the mean one of the body. `body_m`: its length.
fn has_neck(test: &Test, body_m: f64, volume_m3: Option<f64>) -> bool {
    let is_narrow = || {
        let area_m2 = test.area_m2.filter(|_| test.length_m.is_some());
        let mean_m2 = volume_m3.map(|volume_m3| volume_m3 / body_m);
        area_m2
            .zip(mean_m2)
            .is_some_and(|(area, mean)| area < NARROW * mean)
    };
    match test.kind {
        TestType::DogBone => true,
        TestType::HopkinsonTension => is_narrow(),
        _ => false,
    }
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
