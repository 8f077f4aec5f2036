//! `dem-run lab`: measured force-displacement curves to modulus, strength and mean curve, and
//! drop-weight tests to a law of breakage.

mod drop_weight;

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

use self::drop_weight::OreTask;
use self::pressures::{Output, lab_under_pressure};
use self::summary::{doubts_of, print_series, summary};

#[derive(Debug, Args)]
pub(super) struct LabArguments {
    /// Files of the test rig, one for each specimen: CSV or text with columns of travel and force;
    /// of drop-weight, sheets of one ore with columns of size, energy and t10
    #[arg(value_name = "FILE", required_unless_present = "specimens")]
    files: Vec<PathBuf>,
    /// Type of test: four-point-bending, three-point-bending, brazilian-disc, compression, tension,
    /// dog-bone, triaxial-compression, direct-shear, drop-weight
    #[arg(long = "type", value_name = "TYPE")]
    test: String,
    /// File to write, measured.json unless given, or ore.toml of drop-weight; a page of the same
    /// name, ending in .html, is written with it
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Material of drop-weight tests in the file that scenes include; the name of that file unless
    /// given
    #[arg(long, value_name = "NAME")]
    material: Option<String>,

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
    if arguments.test == drop_weight::TYPE {
        return fit_ore(arguments);
    }
    let test = arguments.test_type()?;
    let dimensions = arguments.dimensions()?;
    let listed = arguments.listed()?;
    let output = arguments.output("measured.json");
    let page_file = page_file(&output, "write the material to a name that ends in .json")?;
    if arguments.material.is_some() {
        let problem = format!("does not go with {}", arguments.test);
        let remedy = "leave it out: a measured material has no name";
        return Err(Diagnostic::input("--material", problem, remedy));
    }
    let curves = listed.iter().map(|one| one.file.clone());
    let inputs: Vec<PathBuf> = curves.chain(arguments.specimens.clone()).collect();
    refuse_to_replace(&[output.clone(), page_file.clone()], &inputs)?;
    let measured: Vec<MeasuredSpecimen> = listed
        .iter()
        .map(|one| arguments.measured(one, test, &dimensions))
        .collect::<Result<_>>()?;
    if test.has_residual() {
        let specimens = listed.iter().zip(measured).collect();
        let output = Output {
            file: &output,
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
    write_material(&output, &found)?;
    if arguments.json {
        write_standard_json(&summary(&found, &evaluated))
    } else if arguments.quiet {
        Ok(())
    } else {
        print(&found, &evaluated, &output, &page_file)
    }
}

/// Fits an ore to the sheets of its drop-weight tests; refuses options that only curves have.
fn fit_ore(arguments: &LabArguments) -> Result<()> {
    let given = [
        ("--specimens", arguments.specimens.is_some()),
        ("--support-span", arguments.support_span.is_some()),
        ("--loading-span", arguments.loading_span.is_some()),
        ("--width", arguments.width.is_some()),
        ("--height", arguments.height.is_some()),
        ("--length", arguments.length.is_some()),
        ("--area", arguments.area.is_some()),
        ("--normal-stress", arguments.normal_stress.is_some()),
        (
            "--confining-pressure",
            arguments.confining_pressure.is_some(),
        ),
        ("--travel-column", arguments.travel_column.is_some()),
        ("--travel-unit", arguments.travel_unit.is_some()),
        ("--force-column", arguments.force_column.is_some()),
        ("--force-unit", arguments.force_unit.is_some()),
    ];
    if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
        let problem = format!("does not go with {}", drop_weight::TYPE);
        let remedy = "leave it out: the sheets give the sizes and units of their columns";
        return Err(Diagnostic::input(*option, problem, remedy));
    }
    let output = arguments.output("ore.toml");
    drop_weight::ore(&OreTask {
        files: &arguments.files,
        material: arguments.material.as_deref(),
        page_file: &page_file(&output, "write the ore to a name that ends in .toml")?,
        output: &output,
        json: arguments.json,
        quiet: arguments.quiet,
    })
}

impl LabArguments {
    fn test_type(&self) -> Result<TestType> {
        let mut known = TestType::NAMES
            .iter()
            .filter(|(_, test)| !test.is_dynamic());
        let found = known.clone().find(|(name, _)| *name == self.test);
        found.map(|(_, test)| *test).ok_or_else(|| {
            let names = known.by_ref().map(|(name, _)| *name);
            let names: Vec<&str> = names.chain([drop_weight::TYPE]).collect();
            let names = names.join(", ");
            let problem = format!("'{}' is not a type of test", self.test.escape_debug());
            Diagnostic::input("--type", problem, format!("use one of {names}"))
        })
    }

    /// The file to write, this one unless given.
    fn output(&self, usual: &str) -> PathBuf {
        self.output.clone().unwrap_or_else(|| PathBuf::from(usual))
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

/// The page beside the output, whose folder is there.
fn page_file(output: &Path, remedy: &str) -> Result<PathBuf> {
    let page_file = output.with_extension("html");
    if page_file == output {
        let problem = format!("{} is the name of the page", output.display());
        return Err(Diagnostic::input("--output", problem, remedy));
    }
    need_folder_of(output)?;
    Ok(page_file)
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
