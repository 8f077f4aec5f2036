//! Modulus of a beam over that of its bonds, for spheres from coarse to fine, from tests without
//! steps.

use std::collections::BTreeMap;

use dem_io::Body;
use dem_io::units::significant;
use dem_laboratory::{Specimen, Statistic};
use dem_pack::cli::Recipe;
use dem_run::laboratory::evaluate::EQ_18;
use dem_run::plan;
use dem_run::run::statics::elastic_test::elastic_test;
use dem_scene::read_scene;

use super::programs::Failed;
use super::table::{Table, head};

const SCENE: &str = "data/scenes/four-point-bending.toml";
const SHAPE: &str = "data/shapes/bending-sample.stl";
/// Diameters from coarse to fine, and the number of packings of each.
pub(crate) const SIZES: [(&str, u64); 6] = [
    ("10mm..12mm", 4),
    ("7mm..9mm", 4),
    ("5mm..7mm", 4),
    ("3.5mm..4.5mm", 4),
    ("2mm..3mm", 2),
    ("1.5mm..2mm", 1),
];

/// What one packing gives.
struct Found {
    spheres: usize,
    across: f64,
    /// Modulus of the body by eq. 18 over that of its bonds.
    modulus: f64,
    /// Second moment of area of the section that bonds fill, over that of the shape.
    section: f64,
}

pub(crate) const HEAD: [&str; 6] = [
    "diameters",
    "spheres",
    "across the height",
    "E of the body over E of the bonds",
    "section of the bonds",
    "quotient",
];

pub(crate) fn table() -> Result<Table, Failed> {
    let mut rows = Vec::new();
    for (diameters, packings) in SIZES {
        let found: Vec<Found> = (1..=packings)
            .map(|seed| tested(diameters, seed))
            .collect::<Result<_, _>>()?;
        let of = |value: fn(&Found) -> f64| {
            let values: Vec<f64> = found.iter().map(value).collect();
            Statistic::of(&values)
        };
        let cell = |value: Statistic, digits: usize| match value.count {
            1 => format!("{:.digits$}", value.mean),
            _ => format!(
                "{:.digits$} +- {:.digits$}",
                value.mean, value.standard_deviation
            ),
        };
        rows.push(vec![
            diameters.to_owned(),
            format!("{:.0}", of(|one| one.spheres as f64).mean),
            significant(of(|one| one.across).mean, 3),
            cell(of(|one| one.modulus), 2),
            cell(of(|one| one.section), 3),
            cell(of(|one| one.modulus / one.section), 2),
        ]);
    }
    let head = head(&HEAD);
    Ok(Table {
        word: "stiffness",
        head,
        rows,
    })
}

fn tested(diameters: &str, seed: u64) -> Result<Found, Failed> {
    let words = [
        SHAPE,
        "--diameter",
        diameters,
        "--overlap",
        "0.296",
        "--bond-range",
        "1.0",
    ];
    let recipe = Recipe::parse(&words.map(str::to_owned))?;
    let (body, _) = recipe.make(seed, &|_, _| Ok(()))?;
    let scene = read_scene(SCENE.as_ref(), &["run.integrator=static".to_owned()])?;
    let spheres = body.positions.len();
    let (height_m, width_m) = (extent_m(&body, 2), extent_m(&body, 1));
    let mean_m = 2.0 * body.radii.iter().sum::<f64>() / spheres as f64;
    let bodies: BTreeMap<String, Body> = [("sample".to_owned(), body)].into();
    let mut plan = plan(&scene, bodies, 1, false)?;
    let setup = plan.test.take().ok_or("no test")?;
    let Specimen::Beam(beam) = setup.specimen else {
        return Err("no beam".into());
    };
    let test = elastic_test(&mut plan.state, &scene, &setup, &|_| true)?;
    let modulus_pa = test.figure(EQ_18).ok_or("no modulus")?;
    Ok(Found {
        spheres,
        across: beam.height_m / mean_m,
        modulus: modulus_pa / scene.bonds["cake"].young_modulus_pa,
        section: (height_m / beam.height_m).powi(3) * width_m / beam.width_m,
    })
}

/// Extent of the centres, between which bonds are, along an axis, m.
fn extent_m(body: &Body, axis: usize) -> f64 {
    let places = body.positions.iter().map(|place| place[axis]);
    let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    });
    high - low
}
