//! `dem-run lab`: measured force-displacement curves to modulus, strength and mean curve.

mod pressures;
mod summary;

use std::path::{Path, PathBuf};

use clap::Args;
use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::units::quantity;
use dem_io::write_target::{need_folder_of, refuse_to_replace};
use dem_io::{Diagnostic, Result};
use dem_laboratory::{
    ColumnChoice, Curve, Dimensions, EvaluatedSpecimen, ListedSpecimen, MeasuredMaterial,
    MeasuredSpecimen, Specimen, Table, TestType, evaluate, material, page, read_list, read_text,
    write_material,
};
use dem_terminal::standard_output::{write_standard_json, write_standard_output};

use self::pressures::{Output, lab_under_pressure};
use self::summary::{doubts_of, print_series, summary};

#[derive(Debug, Args)]
pub(super) struct LabArguments {
    /// Files of the test rig, one for each specimen: CSV or text with columns of travel and force
    #[arg(value_name = "FILE", required_unless_present = "specimens")]
    files: Vec<PathBuf>,
    /// Type of test: four-point-bending, three-point-bending, brazilian-disc, compression, tension,
    /// dog-bone, triaxial-compression, direct-shear
    #[arg(long = "type", value_name = "TYPE")]
    test: String,
    /// File to write; a page of the same name, ending in .html, is written with it
    #[arg(long, short, value_name = "FILE", default_value = "measured.json")]
    output: PathBuf,

    /// Distance of the supports of a beam, such as 180mm
    #[arg(long, value_name = "LENGTH", help_heading = "Specimens")]
    support_span: Option<String>,
    /// Distance of the two loading pins
    #[arg(long, value_name = "LENGTH", help_heading = "Specimens")]
    loading_span: Option<String>,
    /// Width of a beam, or thickness of a disc
    #[arg(long, value_name = "LENGTH", help_heading = "Specimens")]
    width: Option<String>,
    /// Height of a beam, or diameter of a disc
    #[arg(long, value_name = "LENGTH", help_heading = "Specimens")]
    height: Option<String>,
    /// Length of a specimen that is pressed or pulled
    #[arg(long, value_name = "LENGTH", help_heading = "Specimens")]
    length: Option<String>,
    /// Area of its section, such as 9cm2
    #[arg(long, value_name = "AREA", help_heading = "Specimens")]
    area: Option<String>,
    /// Pressure on the sides of a triaxial test, such as 1MPa
    #[arg(long, value_name = "STRESS", help_heading = "Specimens")]
    confining_pressure: Option<String>,
    /// Stress on the plane of a direct shear test, such as 100kPa
    #[arg(long, value_name = "STRESS", help_heading = "Specimens")]
    normal_stress: Option<String>,
    /// Table of specimens with their own dimensions and cracks, as CSV: columns file, width (mm),
    /// ..., crack_offset (mm); empty cells are those of the options
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "files",
        help_heading = "Specimens"
    )]
    specimens: Option<PathBuf>,

    /// Column of the crosshead travel: its name or number; found unless given
    #[arg(long, value_name = "COLUMN", help_heading = "Columns")]
    travel_column: Option<String>,
    /// Unit of the travel; the one in the head of its column unless given
    #[arg(long, value_name = "UNIT", help_heading = "Columns")]
    travel_unit: Option<String>,
    /// Column of the force: its name or number; found unless given
    #[arg(long, value_name = "COLUMN", help_heading = "Columns")]
    force_column: Option<String>,
    /// Unit of the force; the one in the head of its column unless given
    #[arg(long, value_name = "UNIT", help_heading = "Columns")]
    force_unit: Option<String>,

    /// Print the summary as JSON
    #[arg(long)]
    json: bool,
    /// Only print errors; --json is still printed
    #[arg(long, short)]
    quiet: bool,
}

/// Reads and evaluates the curves, writes the measured material and its page, and prints a summary.
/// No valid specimen is an error, once the page is written.
pub(super) fn lab(arguments: &LabArguments) -> Result<()> {
    let test = arguments.test_type()?;
    let dimensions = arguments.dimensions()?;
    let listed = arguments.listed()?;
    let page_file = arguments.page_file()?;
    need_folder_of(&arguments.output)?;
    let curves = listed.iter().map(|one| one.file.clone());
    let inputs: Vec<PathBuf> = curves.chain(arguments.specimens.clone()).collect();
    refuse_to_replace(&[arguments.output.clone(), page_file.clone()], &inputs)?;
    let measured: Vec<MeasuredSpecimen> = listed
        .iter()
        .map(|one| arguments.measured(one, test, &dimensions))
        .collect::<Result<_>>()?;
    if test.has_residual() {
        let specimens = listed.iter().zip(measured).collect();
        let output = Output {
            file: &arguments.output,
            page_file: &page_file,
            json: arguments.json,
            quiet: arguments.quiet,
        };
        return lab_under_pressure(test, &dimensions, specimens, &output);
    }
    // Curves are scaled to the dimensions of the options, or else to those of the first specimen.
    let first = listed
        .first()
        .map_or_else(Dimensions::default, |one| one.dimensions);
    let scaled_to = dimensions.or(&first);
    let reference = Specimen::new(test, &scaled_to)?;
    let evaluated = evaluate(measured);
    let found = material(test, &scaled_to, &reference, &evaluated);
    write_file(&page_file, |out| {
        out.write_all(page(&evaluated, found.as_ref(), &reference).as_bytes())
    })?;
    let Some(found) = found else {
        let doubts = evaluated
            .iter()
            .map(doubts_of)
            .collect::<Vec<String>>()
            .join("; ");
        let problem = format!("no specimen is valid: {doubts}");
        let remedy = format!("see {}", visible(&page_file.display().to_string()));
        return Err(Diagnostic::input("", problem, remedy));
    };
    write_material(&arguments.output, &found)?;
    if arguments.json {
        write_standard_json(&summary(&found, &evaluated))
    } else if arguments.quiet {
        Ok(())
    } else {
        print(&found, &evaluated, &arguments.output, &page_file)
    }
}

impl LabArguments {
    fn test_type(&self) -> Result<TestType> {
        let mut known = TestType::NAMES
            .iter()
            .filter(|(_, test)| !test.is_dynamic());
        let found = known.clone().find(|(name, _)| *name == self.test);
        found.map(|(_, test)| *test).ok_or_else(|| {
            let names: Vec<&str> = known.by_ref().map(|(name, _)| *name).collect();
            let names = names.join(", ");
            let problem = format!("'{}' is not a type of test", self.test.escape_debug());
            Diagnostic::input("--type", problem, format!("use one of {names}"))
        })
    }

    /// The page beside the output.
    fn page_file(&self) -> Result<PathBuf> {
        let page_file = self.output.with_extension("html");
        if page_file == self.output {
            let problem = format!("{} is the name of the page", self.output.display());
            let remedy = "write the material to a name that ends in .json";
            return Err(Diagnostic::input("--output", problem, remedy));
        }
        Ok(page_file)
    }

    /// The dimensions that the options give.
    fn dimensions(&self) -> Result<Dimensions> {
        let mut dimensions = Dimensions::default();
        for (name, text) in [
            ("support_span", &self.support_span),
            ("loading_span", &self.loading_span),
            ("width", &self.width),
            ("height", &self.height),
            ("length", &self.length),
            ("area", &self.area),
            ("confining_pressure", &self.confining_pressure),
            ("normal_stress", &self.normal_stress),
        ] {
            let dimension = Dimensions::unit_of(name).0;
            if let Some(text) = text {
                let option = format!("--{}", name.replace('_', "-"));
                let value = quantity(text, dimension).map_err(|error| error.within(&option))?;
                dimensions.set(name, value);
            }
        }
        Ok(dimensions)
    }

    fn listed(&self) -> Result<Vec<ListedSpecimen>> {
        if let Some(table) = &self.specimens {
            return read_list(table);
        }
        let listed = |file: &PathBuf| ListedSpecimen {
            file: file.clone(),
            dimensions: Dimensions::default(),
            crack_m: None,
        };
        Ok(self.files.iter().map(listed).collect())
    }

    fn measured(
        &self,
        listed: &ListedSpecimen,
        test: TestType,
        dimensions: &Dimensions,
    ) -> Result<MeasuredSpecimen> {
        let column = |column: &Option<String>, unit: &Option<String>| ColumnChoice {
            column: column.clone(),
            unit: unit.clone(),
        };
        let travel = column(&self.travel_column, &self.travel_unit);
        let force = column(&self.force_column, &self.force_unit);
        let name = listed.file.display().to_string();
        let specimen = Specimen::new(test, &listed.dimensions.or(dimensions))?;
        let text = read_text(&listed.file)?;
        let curve = Table::of(&text).and_then(|table| match specimen {
            Specimen::Bar { area_m2, .. } if test.has_residual() => {
                Curve::of_stress(&table, &travel, &force, area_m2)
            }
            _ => Curve::of(&table, &travel, &force),
        });
        Ok(MeasuredSpecimen {
            curve: curve.map_err(|error| error.within(&name))?,
            crack_m: listed.crack_m,
            test,
            specimen,
            name,
        })
    }
}

fn print(
    found: &MeasuredMaterial,
    evaluated: &[EvaluatedSpecimen],
    output: &Path,
    page_file: &Path,
) -> Result<()> {
    write_standard_output(|out| {
        print_series(out, Some(found), evaluated)?;
        let [output, page_file] = [output, page_file].map(|path| path.display().to_string());
        writeln!(
            out,
            "written      {}, {}",
            visible(&output),
            visible(&page_file)
        )
    })
}
