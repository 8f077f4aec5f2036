//! What the options say, and a person at the terminal: shape, size, mass, and situation.

use std::f64::consts::PI;
use std::io::{BufRead, IsTerminal, Write};
use std::path::Path;

use dem_io::surface::{ReadSettings, read_surface};
use dem_io::triangles::read_triangle_file;
use dem_io::units::{Dimension, LENGTH, MASS, quantity, significant};
use dem_io::{Diagnostic, Result, Surface, explain_read};
use dem_plan::masses::{HEAVIEST_KG_M3, LIGHTEST_KG_M3};

use super::arguments::NewArguments;
use super::fill::Value;
use super::questions::{Question, Questions};
use super::shape::stl;
use super::surfaces::Facet;
use super::templates::{Measured, Template};

/// The limits within which a body is likely what was meant, m.
const SIZES_M: [f64; 2] = [1e-5, 100.0];

/// What the answers give.
pub(super) struct Answers {
    /// The shape, scaled, with the middle of its box at the origin.
    pub(super) surface: Surface,
    pub(super) facets: Vec<Facet>,
    pub(super) body: Measured,
    /// The line of the scene with mass or density.
    pub(super) weight: String,
    /// The number of the situation, or 0 without one.
    pub(super) situation_si: f64,
}

/// The options, and on a terminal what they leave open.
pub(super) fn answers(arguments: &NewArguments) -> Result<Answers> {
    arguments.refuse_unused()?;
    let is_terminal = std::io::stdin().is_terminal() && std::io::stderr().is_terminal();
    let is_asked = is_terminal && !arguments.yes;
    let mut questions = Questions {
        terminal: is_asked.then(|| (std::io::stdin().lock(), std::io::stderr())),
    };
    let template = arguments.template;
    let (facets, surface) = shape(&mut questions, arguments)?;
    let volume_m3 = match template.is_ball() {
        true => PI / 6.0 * extent_m(&surface)[0].powi(3),
        false => surface.volume_m3(),
    };
    let usual_kg = template.density_kg_m3() * volume_m3;
    let usual = Value::new(usual_kg, "kg").text();
    let asked = Question {
        option: "--mass",
        what: "of one body",
        default: usual.clone(),
    };
    let read = |text: &str| read_mass(text, &usual, volume_m3);
    let mass_kg = questions.answer(&asked, arguments.mass.as_deref(), read)?;
    let body = Measured {
        extent_m: extent_m(&surface),
        mass_kg: mass_kg.unwrap_or(usual_kg),
        density_kg_m3: mass_kg.unwrap_or(usual_kg) / volume_m3,
    };
    Ok(Answers {
        situation_si: situation(&mut questions, arguments, &body)?,
        weight: weight(mass_kg, body.density_kg_m3),
        surface,
        facets,
        body,
    })
}

/// The shape of its size, with the middle of its box at the origin.
fn shape<R: BufRead, W: Write>(
    questions: &mut Questions<R, W>,
    arguments: &NewArguments,
) -> Result<(Vec<Facet>, Surface)> {
    let template = arguments.template;
    let own = template.shape();
    let asked = Question {
        option: "--shape",
        what: "an STL, OBJ, PLY or 3MF file; in mm if it has no unit",
        default: own.described(),
    };
    let read = |text: &str| read_shape(Path::new(text), template);
    let answer = match template.is_ball() {
        true => None,
        false => questions.answer(&asked, arguments.shape.as_deref(), read)?,
    };
    let original = match answer {
        Some(surface) => surface,
        None => surface_of(stl(&own.facets()).as_bytes(), "the shape")?,
    };
    let longest_m = extent_m(&original).into_iter().fold(0.0, f64::max);
    let usual = Value::length(longest_m).text();
    let asked = Question {
        option: "--size",
        what: "its largest extent",
        default: usual.clone(),
    };
    let read = |text: &str| read_size(text, &usual);
    let size_m = questions.answer(&asked, arguments.size.as_deref(), read)?;
    let facets = scaled(&original, size_m.map_or(1.0, |size_m| size_m / longest_m));
    let surface = surface_of(stl(&facets).as_bytes(), &original.source)?;
    Ok((facets, surface))
}

fn situation<R: BufRead, W: Write>(
    questions: &mut Questions<R, W>,
    arguments: &NewArguments,
    body: &Measured,
) -> Result<f64> {
    let template = arguments.template;
    let Some(situation) = template.situation(body) else {
        return Ok(0.0);
    };
    let usual = Value::new(situation.default_si, situation.dimension.si).text();
    let asked = Question {
        option: situation.option,
        what: situation.what,
        default: usual.clone(),
    };
    let read = |text: &str| {
        let si = positive(text, &usual, situation.dimension)?;
        situation.check(si).map(|()| si)
    };
    let given = arguments.situation(situation.option);
    let answer = questions.answer(&asked, given, read)?;
    Ok(answer.unwrap_or(situation.default_si))
}

/// The line of the scene with the mass that was given, or with the density.
fn weight(mass_kg: Option<f64>, density_kg_m3: f64) -> String {
    let density = significant(density_kg_m3, 4);
    match mass_kg {
        Some(mass_kg) => {
            let mass = Value::new(mass_kg, "kg").text();
            format!(
                "mass = \"{mass}\"                    # over the volume of the shape: {density} kg/m3"
            )
        }
        None => {
            format!(
                "body_density = \"{density} kg/m3\"         # mass over the volume of the shape"
            )
        }
    }
}

fn extent_m(surface: &Surface) -> [f64; 3] {
    surface.extent().map(|extent| extent * surface.unit_m)
}

/// A number above 0 with its unit, in SI. One without a unit is refused: who writes 20 means mm as
/// often as m. `usual` is the answer by default, whose unit is named.
fn positive(text: &str, usual: &str, dimension: &Dimension) -> Result<f64> {
    let value = quantity(text, dimension)?;
    if value <= 0.0 {
        return Err(Diagnostic::input(
            "",
            format!("'{text}' is not above 0"),
            format!(
                "write a {} above 0, such as {}",
                dimension.name, dimension.example
            ),
        ));
    }
    let number = text.trim();
    if number.parse::<f64>().is_ok() {
        let unit = usual.split_once(' ').map_or("", |(_, unit)| unit);
        return Err(Diagnostic::input(
            "",
            format!("'{number}' has no unit"),
            format!("write it with its unit, such as \"{number} {unit}\""),
        ));
    }
    Ok(value)
}

fn read_size(text: &str, usual: &str) -> Result<f64> {
    let size_m = positive(text, usual, &LENGTH)?;
    let [smallest, largest] = SIZES_M;
    if (smallest..=largest).contains(&size_m) {
        return Ok(size_m);
    }
    Err(Diagnostic::input(
        "",
        format!(
            "{} is not between {} and {}",
            Value::length(size_m).text(),
            Value::length(smallest).text(),
            Value::length(largest).text()
        ),
        "write the largest extent of one body with its unit, such as 30 mm",
    ))
}

fn read_mass(text: &str, usual: &str, volume_m3: f64) -> Result<f64> {
    let mass_kg = positive(text, usual, &MASS)?;
    let [lightest, heaviest] = [LIGHTEST_KG_M3, HEAVIEST_KG_M3];
    let density = mass_kg / volume_m3;
    if (lightest..=heaviest).contains(&density) {
        return Ok(mass_kg);
    }
    let mass = |density: f64| Value::new(density * volume_m3, "kg").text();
    Err(Diagnostic::input(
        "",
        format!(
            "{} is {} kg/m3 over the volume of the shape, not between {lightest} and {heaviest} kg/m3",
            Value::new(mass_kg, "kg").text(),
            significant(density, 3)
        ),
        format!(
            "write a mass from {} to {} with its unit, or check the size",
            mass(lightest),
            mass(heaviest)
        ),
    ))
}

fn read_shape(path: &Path, template: Template) -> Result<Surface> {
    let bytes = read_triangle_file(path).map_err(|error| explain_read(path, &error, "a file"))?;
    let surface = surface_of(&bytes, &path.display().to_string())?;
    template.check(extent_m(&surface))?;
    Ok(surface)
}

fn surface_of(bytes: &[u8], name: &str) -> Result<Surface> {
    let settings = ReadSettings {
        unit_m: None,
        scale: 1.0,
        fill_holes: false,
    };
    read_surface(bytes, name, settings)
}

/// The facets scaled, mm, with the middle of their box at the origin.
fn scaled(surface: &Surface, scale: f64) -> Vec<Facet> {
    let extent = surface.extent();
    let factor = scale * surface.unit_m * 1e3;
    let moved =
        |corner: [f64; 3]| [0, 1, 2].map(|axis| factor * (corner[axis] - 0.5 * extent[axis]));
    let triangles = 0..surface.triangles.len();
    triangles
        .map(|triangle| surface.corners(triangle).map(moved))
        .collect()
}
