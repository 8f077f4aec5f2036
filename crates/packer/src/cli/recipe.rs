//! Bodies by the arguments of dem-pack, for programs that need several packings of a shape.

use super::arguments::{Arguments, PackArguments};
use super::shape::{check_unit_of_diameter, read_surface};
use crate::body::{BodyReport, BodySettings, make_body};
use crate::pack::Progress;
use crate::sizes::Sizes;
use clap::Parser;
use dem_io::{Body, Diagnostic, Result, Surface};
use dem_terminal::program::on_one_line;
use std::path::{Path, PathBuf};

/// A shape and the settings with which it is packed.
#[derive(Debug)]
pub struct Recipe {
    shape: PathBuf,
    surface: Surface,
    settings: BodySettings,
    arguments: PackArguments,
}

impl Recipe {
    /// The shape and the settings of a command line of dem-pack, without the name of the program.
    ///
    /// # Errors
    /// Arguments that dem-pack refuses, that only concern its output, or that name no solid.
    pub fn parse(arguments: &[String]) -> Result<Self> {
        Self::of_shape(None, arguments)
    }

    /// The same with this shape in place of that of the arguments, which may have none.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn of_shape(other: Option<&Path>, arguments: &[String]) -> Result<Self> {
        let mut line = arguments.to_vec();
        if let Some(other) = other
            && !Self::names_shape(arguments)?
        {
            line.insert(0, other.display().to_string());
        }
        let mut parsed = parsed(&line).map_err(refused)?;
        if let Some(other) = other {
            parsed.pack.shape = Some(other.to_owned());
        }
        let arguments = parsed.pack;
        let no_output = arguments.output.is_none() && arguments.threads.is_none();
        let (None, true, Some(shape)) = (&parsed.command, no_output, arguments.shape.clone())
        else {
            let problem = "these are not the arguments of a shape that is packed";
            let remedy =
                "write the file of the shape and its options, without --output and --threads";
            return Err(Diagnostic::input("dem-pack", problem, remedy));
        };
        if shape.as_os_str() == "-" {
            let remedy = "name the file of the shape";
            return Err(Diagnostic::input(
                "dem-pack",
                "standard input is read once",
                remedy,
            ));
        }
        let surface = read_surface(&shape, &arguments.reading)?;
        let recipe = Self {
            settings: arguments.checked()?,
            shape,
            surface,
            arguments,
        };
        let diameter = recipe.arguments.diameter.as_deref();
        check_unit_of_diameter(diameter, &recipe.settings.packing.sizes, &recipe.surface)?;
        Ok(recipe)
    }

    /// Whether these arguments of dem-pack name a shape.
    ///
    /// # Errors
    /// Arguments that dem-pack refuses.
    pub fn names_shape(arguments: &[String]) -> Result<bool> {
        let with_one = || [&["shape.stl".to_owned()], arguments].concat();
        match parsed(arguments) {
            Ok(_) => Ok(true),
            Err(_) if parsed(&with_one()).is_ok() => Ok(false),
            Err(error) => Err(refused(error)),
        }
    }

    /// The diameters, as written.
    pub fn diameter(&self) -> &str {
        self.arguments.diameter.as_deref().unwrap_or_default()
    }

    /// The smallest diameter, m.
    pub fn smallest_diameter_m(&self) -> f64 {
        self.settings.packing.sizes.min_m()
    }

    /// The seed of the first packing.
    pub fn seed(&self) -> u64 {
        self.settings.packing.seed
    }

    /// The file of the shape, and that of a sieve curve.
    pub fn files(&self) -> Vec<PathBuf> {
        let sieve = Sizes::file(self.diameter()).map(PathBuf::from);
        std::iter::once(self.shape.clone()).chain(sieve).collect()
    }

    /// A packing with this seed.
    pub fn make(&self, seed: u64, progress: Progress) -> Result<(Body, BodyReport)> {
        let mut settings = self.settings.clone();
        settings.packing.seed = seed;
        make_body(&self.surface, &settings, progress)
    }
}

/// A command line of dem-pack, without the name of the program.
fn parsed(arguments: &[String]) -> std::result::Result<Arguments, clap::Error> {
    let line = std::iter::once("dem-pack".to_owned()).chain(arguments.iter().cloned());
    Arguments::try_parse_from(line)
}

#[expect(clippy::needless_pass_by_value, reason = "it is passed to map_err")]
fn refused(error: clap::Error) -> Diagnostic {
    let problem = on_one_line(&error.to_string());
    Diagnostic::input("dem-pack", problem, "see dem-pack --help")
}
