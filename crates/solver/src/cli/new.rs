//! `dem-run new`: a scene to start from, with a shape and its body.

mod fill;
mod questions;
mod shape;
mod spheres;
mod templates;

use std::fs;
use std::io::{ErrorKind, IsTerminal};
use std::path::{Path, PathBuf};

use clap::Args;
use dem_io::body::files::write_body;
use dem_io::safe_write::{explain, write_file};
use dem_io::stl::read_stl_file;
use dem_io::surface::{ReadSettings, surface_from_stl};
use dem_io::text::visible;
use dem_io::units::{Dimension, LENGTH, MASS, quantity, significant};
use dem_io::{Body, Diagnostic, Result, Surface, explain_read};
use dem_pack::{Basis, Sizes};
use dem_scene::reference;
use dem_terminal::standard_output::write_standard_output;

use self::fill::{Value, filled};
use self::questions::{Question, Questions};
use self::shape::{Facet, drum, stl};
use self::templates::{Measured, Template};
use super::new_folder::WholeFolder;

/// Name of the file of keys for editors, as in the first line of each scene.
const SCHEMA: &str = "scene.schema.json";
/// The limits within which a body is likely what was meant, m.
const SIZES_M: [f64; 2] = [1e-5, 100.0];
/// The densities of solids, from foams to the heaviest metal, kg/m3.
const DENSITIES_KG_M3: [f64; 2] = [20.0, 23_000.0];

#[derive(Debug, Args)]
pub(super) struct NewArguments {
    /// What happens in the scene
    #[arg(value_name = "TYPE")]
    template: Template,
    /// The folder to make
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Your own body, an STL file in mm; the shape of the template if not given
    #[arg(long, value_name = "FILE")]
    shape: Option<String>,
    /// Its largest extent, such as "30 mm": scales the shape
    #[arg(long, allow_hyphen_values = true)]
    size: Option<String>,
    /// Mass of one body, such as "420 mg"; from the density of the template if not given
    #[arg(long, allow_hyphen_values = true)]
    mass: Option<String>,
    /// Height of the fall, such as "1 m" (drop, drop-weight)
    #[arg(long, allow_hyphen_values = true)]
    height: Option<String>,
    /// Speed of the belt, such as "3 m/s" (chute), or of the drum, such as "60 rpm" (mill)
    #[arg(long, allow_hyphen_values = true)]
    speed: Option<String>,
    /// Gap between the jaws (crusher), or width of the slot (silo), such as "20 mm"
    #[arg(long, allow_hyphen_values = true)]
    gap: Option<String>,
    /// Diameters of the spheres, as for dem-pack; if not given, ten across the thinnest part, or as
    /// many as some 3,000 spheres allow
    #[arg(long, allow_hyphen_values = true)]
    diameter: Option<String>,
    /// Ask nothing on a terminal: take the defaults
    #[arg(long, short)]
    yes: bool,
}

/// What the answers give.
struct Answers {
    surface: Surface,
    facets: Vec<Facet>,
    body: Measured,
    /// The line of the scene with mass or density.
    weight: String,
    situation_si: f64,
}

/// Makes the folder with `scene.toml`, `shape.stl`, `body.vtp` and the schema for editors, and
/// prints the next commands. Refuses a folder that exists.
pub(super) fn new(arguments: &NewArguments) -> Result<()> {
    let folder = &arguments.folder;
    if fs::symlink_metadata(folder).is_ok() {
        return Err(exists_already(folder));
    }
    let diameter = arguments.diameter.as_deref();
    let diameter = diameter.map(|text| Sizes::parse(text, Basis::Number));
    let diameter = diameter
        .transpose()
        .map_err(|error| error.within("--diameter"))?;
    let answers = answers(arguments)?;
    let fineness = arguments.template.fineness();
    let (mut body, remark) = spheres::packed(&answers.surface, fineness, diameter.as_ref())?;
    let source = Path::new(".").join(folder).join("shape.stl");
    body.about.source = Some(source.display().to_string());
    if fineness.is_rigid {
        // Neither bonds nor few spheres across matter to a clump.
        body.bonds.clear();
        body.about.warnings.clear();
    }
    let drum_file = write_folder(arguments, &answers, &body)?;
    write_standard_output(|out| {
        let shown = folder.display().to_string();
        let shown = visible(&shown);
        let (spheres, bonds) = (body.radii.len(), body.bonds.len());
        writeln!(
            out,
            "made {shown}: scene.toml, shape.stl, body.vtp with {spheres} particles and {bonds} bonds, {drum_file}{SCHEMA}"
        )?;
        if let Some(remark) = remark {
            writeln!(out, "note: {remark}")?;
        }
        writeln!(
            out,
            "next:\n  dem-run check {shown}/scene.toml\n  dem-run {shown}/scene.toml --output {shown}/results"
        )
    })
}

/// The options, and on a terminal what they leave open.
fn answers(arguments: &NewArguments) -> Result<Answers> {
    let template = arguments.template;
    refuse_unused(arguments)?;
    let is_terminal = std::io::stdin().is_terminal() && std::io::stderr().is_terminal();
    let is_asked = is_terminal && !arguments.yes;
    let mut questions = Questions {
        terminal: is_asked.then(|| (std::io::stdin().lock(), std::io::stderr())),
    };
    let question = |option, what, default| Question {
        option,
        what,
        default,
    };
    let own = template.shape();
    let asked = question("--shape", "an STL file in mm", own.described());
    let shape = arguments.shape.as_deref();
    let read = |text: &str| {
        let surface = read_shape(Path::new(text))?;
        template.check(surface.extent().map(|x| x * surface.unit_m), 0.0)?;
        Ok(surface)
    };
    let original = match questions.answer(&asked, shape, read)? {
        Some(surface) => surface,
        None => surface_of(stl(&own.facets()).as_bytes(), "the shape", 1.0)?,
    };

    let longest_m = original.extent().into_iter().fold(0.0, f64::max) * original.unit_m;
    let default = Value::length(longest_m).text();
    let asked = question("--size", "its largest extent", default);
    let size_m = questions.answer(&asked, arguments.size.as_deref(), read_size)?;
    let (facets, surface) = scaled(&original, size_m.map_or(1.0, |size_m| size_m / longest_m))?;
    let (extent_m, volume_m3) = (
        surface.extent().map(|x| x * surface.unit_m),
        surface.volume_m3(),
    );

    let usual_kg = template.density_kg_m3() * volume_m3;
    let default = Value::new(usual_kg, "kg").text();
    let asked = question("--mass", "of one body", default);
    let read = |text: &str| read_mass(text, volume_m3);
    let mass_kg = questions.answer(&asked, arguments.mass.as_deref(), read)?;
    let density_kg_m3 = mass_kg.unwrap_or(usual_kg) / volume_m3;
    let body = Measured {
        extent_m,
        mass_kg: mass_kg.unwrap_or(usual_kg),
        density_kg_m3,
    };

    let mut situation_si = 0.0;
    if let Some(situation) = template.situation(&body) {
        let default = Value::new(situation.default_si, situation.dimension.si).text();
        let asked = question(situation.option, situation.what, default);
        let read = |text: &str| {
            let si = positive(text, situation.dimension)?;
            template.check(extent_m, si).map(|()| si)
        };
        let given = given_situation(arguments, situation.option);
        let answer = questions.answer(&asked, given, read)?;
        situation_si = answer.unwrap_or(situation.default_si);
    }
    let density = significant(density_kg_m3, 4);
    let weight = match mass_kg {
        Some(mass_kg) => format!(
            "mass = \"{}\"  # over the volume of the shape: {density} kg/m3",
            Value::new(mass_kg, "kg").text()
        ),
        None => {
            format!("body_density = \"{density} kg/m3\"         # mass over the volume of the shape")
        }
    };
    Ok(Answers {
        surface,
        facets,
        body,
        weight,
        situation_si,
    })
}

/// The options of the one number that defines the situation, with their values.
fn situations(arguments: &NewArguments) -> [(&'static str, Option<&str>); 3] {
    [
        ("--height", arguments.height.as_deref()),
        ("--speed", arguments.speed.as_deref()),
        ("--gap", arguments.gap.as_deref()),
    ]
}

fn given_situation<'a>(arguments: &'a NewArguments, option: &str) -> Option<&'a str> {
    let mut all = situations(arguments).into_iter();
    all.find(|(name, _)| *name == option)
        .and_then(|(_, given)| given)
}

fn refuse_unused(arguments: &NewArguments) -> Result<()> {
    let used = arguments.template.option();
    for (option, given) in situations(arguments) {
        if given.is_some() && Some(option) != used {
            let name = arguments.template.name();
            let used = used.map_or(String::new(), |used| format!(", {used}"));
            return Err(Diagnostic::input(
                option,
                format!("the scene '{name}' does not use it"),
                format!("remove it: it uses --shape, --size, --mass{used} and --diameter"),
            ));
        }
    }
    Ok(())
}

fn positive(text: &str, dimension: &Dimension) -> Result<f64> {
    let value = quantity(text, dimension)?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(Diagnostic::input(
        "",
        format!("'{text}' is not above 0"),
        format!(
            "write a {} above 0, such as {}",
            dimension.name, dimension.example
        ),
    ))
}

fn read_size(text: &str) -> Result<f64> {
    let size_m = positive(text, &LENGTH)?;
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

fn read_mass(text: &str, volume_m3: f64) -> Result<f64> {
    let mass_kg = positive(text, &MASS)?;
    let [lightest, heaviest] = DENSITIES_KG_M3;
    let density = mass_kg / volume_m3;
    if (lightest..=heaviest).contains(&density) {
        return Ok(mass_kg);
    }
    let mass = |density: f64| Value::new(density * volume_m3, "kg").text();
    Err(Diagnostic::input(
        "",
        format!(
            "'{text}' gives {} kg/m3 over the volume of the shape, not between {lightest} and {heaviest} kg/m3",
            significant(density, 4)
        ),
        format!(
            "write a mass from {} to {}, or check the size",
            mass(lightest),
            mass(heaviest)
        ),
    ))
}

fn read_shape(path: &Path) -> Result<Surface> {
    let bytes = read_stl_file(path).map_err(|error| explain_read(path, &error, "an STL file"))?;
    surface_of(&bytes, &path.display().to_string(), 1.0)
}

fn surface_of(bytes: &[u8], name: &str, scale: f64) -> Result<Surface> {
    let settings = ReadSettings {
        unit_m: 1e-3,
        scale,
        fill_holes: false,
    };
    surface_from_stl(bytes, name, settings)
}

/// The facets scaled, with the middle of their box at the origin, and their surface.
fn scaled(surface: &Surface, scale: f64) -> Result<(Vec<Facet>, Surface)> {
    let extent = surface.extent();
    let factor = scale * surface.unit_m * 1e3;
    let moved =
        |corner: [f64; 3]| [0, 1, 2].map(|axis| factor * (corner[axis] - 0.5 * extent[axis]));
    let triangles = 0..surface.triangles.len();
    let facets: Vec<Facet> = triangles
        .map(|triangle| surface.corners(triangle).map(moved))
        .collect();
    let surface = surface_of(stl(&facets).as_bytes(), &surface.source, 1.0)?;
    Ok((facets, surface))
}

/// Writes the files. Returns what to say of the drum of a mill.
fn write_folder(
    arguments: &NewArguments,
    answers: &Answers,
    body: &Body,
) -> Result<&'static str> {
    let folder = &arguments.folder;
    let template = arguments.template;
    if let Some(parent) = folder.parent() {
        fs::create_dir_all(parent).map_err(|error| explain(folder, &error))?;
    }
    let made = WholeFolder::beside(folder).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => exists_already(folder),
        _ => explain(folder, &error),
    })?;
    let write = |name: &str, text: &str| {
        write_file(&made.path().join(name), |out| {
            out.write_all(text.as_bytes())
        })
    };
    write("shape.stl", &stl(&answers.facets))?;
    write_body(body, &made.path().join("body.vtp"))?;
    let drum_m = template.drum_m(&answers.body);
    if let Some([radius_m, length_m]) = drum_m {
        write("drum.stl", &stl(&drum(1e3 * radius_m, 1e3 * length_m)))?;
    }
    for (name, text) in reference::files() {
        if name == SCHEMA {
            write(name, text.as_ref())?;
        }
    }
    let values = template.values(&answers.body, answers.situation_si);
    let scene = filled(template.text(), &answers.weight, &values);
    write("scene.toml", &scene)?;
    made.publish()?;
    Ok(if drum_m.is_some() { "drum.stl, " } else { "" })
}

fn exists_already(folder: &Path) -> Diagnostic {
    Diagnostic::input(
        folder.display().to_string(),
        "there is such a file or folder already, and nothing is overwritten",
        "name another folder",
    )
}
