//! The command line of dem-pack: arguments as typed, and what is done with them.

mod report;

use self::report::{summary_text, surface_summary, surface_text};
use crate::body::{BodySettings, make_body};
use crate::bonds::LARGEST_BONDING_RADIUS;
use crate::density::LARGEST_OVERLAP;
use crate::pack::PackSettings;
use crate::sizes::{Basis, Sizes};
use clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use dem_io::body::{body_summary, files::body_files, read_body, write_body};
use dem_io::program::{Shell, print_completions, print_man_page};
use dem_io::safe_write::{
    need_folder_of, refuse_to_replace, write_standard_json, write_standard_output,
};
use dem_io::surface::{ReadSettings, surface_from_stl};
use dem_io::units::{density_kg_m3, length_m, length_unit_m, show_length, significant};
use dem_io::{Diagnostic, Result, Surface};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Read, Write};
use std::path::{Path, PathBuf};

/// As large as a share is chosen.
const LARGEST_SETTLE: f64 = crate::pack::shrink::SHRINK_RANGE[1];

/// Fills the shape of an STL file with overlapping spheres and joins them by bonds.
#[derive(Debug, Parser)]
#[command(
    name = "dem-pack",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    arg_required_else_help = true,
    after_help = "Lengths: a number with a unit (2mm, 0.3cm, 50um), or metres.\n\
        Exit codes: 0 done, 1 failed while running, 2 bad input, 130 interrupted.\n\
        Examples:\n  \
        dem-pack cake.stl --diameter 2mm..3mm --overlap 0.25 --bonding-radius 1.1 -o cake.vtp\n  \
        dem-pack rock.stl --diameter lognormal:2.5mm,0.3mm,1.5mm..4mm --by mass | dem-run --body -"
)]
pub struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    pack: PackArguments,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Say what is known of an STL file or a body
    Info {
        /// An STL file, a body (.vtp, .data, .csv, .txt), or - for a .vtp on standard input
        file: PathBuf,
        #[command(flatten)]
        reading: Reading,
        /// Say it as JSON
        #[arg(long)]
        json: bool,
    },
    /// Turn a body file into one of another kind (.vtp, .data, .csv, .txt, - for a .vtp through a pipe)
    Convert {
        /// The body to read
        from: PathBuf,
        /// The file to write
        to: PathBuf,
    },
    /// Print a script that completes dem-pack's options in a shell
    Completions {
        /// Which shell
        shell: Shell,
    },
    /// Print the man page
    Man,
}

#[derive(Debug, Args)]
struct Reading {
    /// Unit of the numbers in the STL file: nm, um, mm, cm, m, km, in
    #[arg(long, default_value = "mm", help_heading = "Shape")]
    unit: String,
    /// Factor on all lengths of the shape
    #[arg(
        long,
        default_value_t = 1.0,
        allow_negative_numbers = true,
        help_heading = "Shape"
    )]
    scale: f64,
    /// Close small holes of the surface instead of refusing them
    #[arg(long, help_heading = "Shape")]
    fill_holes: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ByArgument {
    Number,
    Mass,
}

#[derive(Debug, Args)]
struct PackArguments {
    /// The shape: an STL file, or - for standard input
    #[arg(value_name = "STL", required = true)]
    stl: Option<PathBuf>,
    /// The body to write: .vtp, .data (LAMMPS), .csv, .txt; standard output if not given
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,

    /// Sphere diameters: 2.5mm | 2mm..3mm | normal:MEAN,STD,MIN..MAX | lognormal:MEAN,STD,MIN..MAX | weibull:SCALE,SHAPE,MIN..MAX | sieve:FILE.csv
    #[arg(
        short,
        long,
        required = true,
        allow_hyphen_values = true,
        help_heading = "Spheres"
    )]
    diameter: Option<String>,
    /// What the distribution of diameters counts
    #[arg(long, value_enum, default_value = "number", help_heading = "Spheres")]
    by: ByArgument,
    /// Overlap o: spheres touch at radius/(1 + o)
    #[arg(
        long,
        default_value_t = 0.25,
        allow_negative_numbers = true,
        help_heading = "Spheres"
    )]
    overlap: f64,
    /// Density of the particles' material (kg/m3 unless given)
    #[arg(long, allow_hyphen_values = true, help_heading = "Spheres")]
    particle_density: Option<String>,
    /// Find the overlap that gives this mass of particles / volume of the shape (kg/m3 unless given)
    #[arg(
        long,
        requires = "particle_density",
        allow_hyphen_values = true,
        conflicts_with = "overlap",
        help_heading = "Spheres"
    )]
    solid_density: Option<String>,
    /// Random numbers: the same seed gives the same body
    #[arg(
        long,
        default_value_t = 1,
        value_parser = parse_seed,
        allow_negative_numbers = true,
        help_heading = "Spheres"
    )]
    seed: u64,
    /// Where the first front begins: X,Y,Z; the deepest point if not given
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        help_heading = "Spheres"
    )]
    seed_point: Option<String>,
    /// Run the front at radii smaller by this share, then let them grow to full size; 0 for the bare front, at most 0.08.
    /// If not given, as much as leaves the spheres just short of jamming, 0.02 to 0.08
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "SHARE",
        help_heading = "Spheres"
    )]
    settle: Option<f64>,

    /// Bond pairs nearer than this times the sum of their radii
    #[arg(
        long,
        default_value_t = 1.1,
        allow_negative_numbers = true,
        help_heading = "Bonds"
    )]
    bonding_radius: f64,
    /// Find the bonding radius that gives this many bonds / particles
    #[arg(
        long,
        conflicts_with = "bonding_radius",
        allow_negative_numbers = true,
        help_heading = "Bonds"
    )]
    bonds_per_particle: Option<f64>,
    /// Bond radius / radius of the smaller particle
    #[arg(
        long,
        default_value_t = 1.0,
        allow_negative_numbers = true,
        help_heading = "Bonds"
    )]
    bond_radius_factor: f64,

    /// Number of threads; the result is the same for any
    #[arg(long, help_heading = "Running")]
    threads: Option<usize>,
    /// Print the report as JSON on standard output (the body then needs --output)
    #[arg(long, requires = "output", help_heading = "Running")]
    json: bool,
    /// Say nothing but errors: no progress, no report; --json is printed all the same
    #[arg(short, long, help_heading = "Running")]
    quiet: bool,
}

/// Does what was asked for.
///
/// # Errors
/// Bad input, or work that failed; a reader that closes standard output early is no error.
pub fn run(arguments: &Arguments) -> Result<()> {
    match &arguments.command {
        Some(Command::Info {
            file,
            reading,
            json,
        }) => info(file, reading, *json),
        Some(Command::Convert { from, to }) => {
            refuse_to_replace(&body_files(to)?, &body_files(from)?)?;
            write_body(&read_body(from)?, to)
        }
        Some(Command::Completions { shell }) => print_completions(*shell, Arguments::command()),
        Some(Command::Man) => print_man_page(Arguments::command()),
        None => pack_command(&arguments.pack),
    }
}

impl Arguments {
    /// The arguments of this process. Help and version are printed, and the process ends.
    ///
    /// # Errors
    /// Arguments that are not understood, on one line.
    pub fn parsed() -> Result<Self> {
        Self::try_parse().map_err(|error| {
            if !error.use_stderr() || error.kind() == DisplayHelpOnMissingArgumentOrSubcommand {
                error.exit();
            }
            Diagnostic::input("", on_one_line(&error.to_string()), "see dem-pack --help")
        })
    }
}

/// What clap says, without its `error:`, the usage and the hint to the help, which stand in paragraphs of their own.
fn on_one_line(said: &str) -> String {
    let paragraphs = said.trim_start_matches("error:").split("\n\n");
    let kept = paragraphs.filter(|p| !p.starts_with("Usage:") && !p.starts_with("For more"));
    let lines = kept.map(|p| p.split_whitespace().collect::<Vec<_>>().join(" "));
    lines.collect::<Vec<_>>().join("; ")
}

fn parse_seed(text: &str) -> std::result::Result<u64, String> {
    let limits = format!("a seed is a whole number from 0 to {}", u64::MAX);
    text.parse().map_err(|_| limits)
}

fn pack_command(arguments: &PackArguments) -> Result<()> {
    let Some(stl) = &arguments.stl else {
        return Err(Diagnostic::input("", "no STL file was given", ""));
    };
    let output = arguments.output.as_deref().unwrap_or(Path::new("-"));
    check_output(output, stl, arguments.diameter.as_deref())?;
    if arguments.json && output == Path::new("-") {
        return Err(Diagnostic::input(
            "--json",
            "standard output cannot take both the report and the body",
            "give --output FILE",
        ));
    }
    let settings = arguments.checked()?;
    // The whole job runs in the pool: a parallel loop that is begun outside it puts the beginner to sleep and wakes it again.
    thread_pool(arguments.threads)?.install(|| pack_and_write(stl, arguments, &settings, output))
}

fn pack_and_write(
    stl: &Path,
    arguments: &PackArguments,
    settings: &BodySettings,
    output: &Path,
) -> Result<()> {
    let surface = read_surface(stl, &arguments.reading)?;
    check_unit_of_diameter(
        arguments.diameter.as_deref(),
        &settings.packing.sizes,
        &surface,
    )?;
    let person = if arguments.quiet {
        None
    } else {
        Some(std::io::stderr())
    };
    let bar = if person.is_some() && std::io::stderr().is_terminal() {
        progress_bar()
    } else {
        ProgressBar::hidden()
    };
    let progress = |stage: &str, done: f64| {
        bar.set_message(stage.to_owned());
        bar.set_position((done.clamp(0.0, 1.0) * 1000.0) as u64);
        Ok(())
    };
    let (body, made) = make_body(&surface, settings, &progress)?;
    bar.set_message("writing");
    write_body(&body, output)?;
    bar.finish_and_clear();
    drop(body);

    let text = summary_text(&surface, &made, output);
    if arguments.json {
        return write_standard_json(&made);
    }
    if arguments.output.is_some() && output != Path::new("-") {
        if arguments.quiet {
            Ok(())
        } else {
            write_standard_output(|out| out.write_all(text.as_bytes()))
        }
    } else {
        if let Some(mut person) = person {
            // Standard error that cannot be written to leaves nobody to tell.
            let _ = person.write_all(text.as_bytes());
        }
        Ok(())
    }
}

impl PackArguments {
    /// The settings, with every value checked.
    fn checked(&self) -> Result<BodySettings> {
        let by = match self.by {
            ByArgument::Number => Basis::Number,
            ByArgument::Mass => Basis::Mass,
        };
        let sizes = Sizes::parse(self.diameter.as_deref().unwrap_or_default(), by)?;
        check_range(
            "--overlap",
            self.overlap,
            0.0,
            LARGEST_OVERLAP,
            "0.1 to 0.5 is usual",
        )?;
        if let Some(settle) = self.settle
            && !(0.0..=LARGEST_SETTLE).contains(&settle)
        {
            return Err(Diagnostic::input(
                "--settle",
                format!(
                    "{settle} is not at least 0 and at most {LARGEST_SETTLE}: spheres that grow by more jam",
                ),
                "0.03 to 0.06 is usual, 0 is the bare front",
            ));
        }
        check_range(
            "--bond-radius-factor",
            self.bond_radius_factor,
            f64::MIN_POSITIVE,
            10.0,
            "1 is usual",
        )?;
        check_range(
            "--bonding-radius",
            self.bonding_radius,
            f64::MIN_POSITIVE,
            LARGEST_BONDING_RADIUS * (1.0 + f64::EPSILON),
            "1.0 to 1.2 is usual",
        )?;
        if let Some(wanted) = self.bonds_per_particle
            && !(wanted > 0.0 && wanted.is_finite())
        {
            return Err(Diagnostic::input(
                "--bonds-per-particle",
                format!("{wanted} is not a positive number"),
                "4 to 6 is usual",
            ));
        }
        let density = |option: &str, text: &Option<String>| {
            let Some(text) = text else { return Ok(None) };
            let value = density_kg_m3(text).map_err(|e| e.within(option))?;
            if value <= 0.0 {
                return Err(Diagnostic::input(
                    option,
                    format!("{value} kg/m3 is not positive"),
                    "give a density such as 2050",
                ));
            }
            Ok(Some(value))
        };
        Ok(BodySettings {
            packing: PackSettings {
                sizes,
                overlap: self.overlap,
                seed: self.seed,
                settle: self.settle,
                seed_point_m: self.seed_point.as_deref().map(parse_point).transpose()?,
            },
            bonding_radius: self.bonding_radius,
            bonds_per_particle: self.bonds_per_particle,
            bond_radius_factor: self.bond_radius_factor,
            particle_density_kg_m3: density("--particle-density", &self.particle_density)?,
            solid_density_kg_m3: density("--solid-density", &self.solid_density)?,
        })
    }
}

fn check_range(option: &str, value: f64, least: f64, below: f64, remedy: &str) -> Result<()> {
    if value >= least && value < below {
        return Ok(());
    }
    let limit = if least > 0.0 {
        "above 0".to_owned()
    } else {
        format!("at least {least}")
    };
    Err(Diagnostic::input(
        option,
        format!("{value} is not {limit} and below {}", significant(below, 3)),
        remedy,
    ))
}

/// A diameter without a unit that is larger than the shape was hardly meant as metres.
fn check_unit_of_diameter(text: Option<&str>, sizes: &Sizes, surface: &Surface) -> Result<()> {
    let text = text.unwrap_or_default();
    let numbers = text.rsplit(':').next().unwrap_or(text);
    let has_unit = numbers
        .chars()
        .any(|c| c.is_alphabetic() && !matches!(c, 'e' | 'E'));
    let longest = surface.extent().iter().copied().fold(0.0, f64::max) * surface.unit_m;
    if has_unit || sizes.min_m() <= longest {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("--diameter '{text}'"),
        format!(
            "no sphere fits: {} is larger than the shape, which is {} long",
            show_length(sizes.min_m()),
            show_length(longest)
        ),
        "a number without a unit is metres: write one, such as 2mm..3mm",
    ))
}

fn parse_point(text: &str) -> Result<[f64; 3]> {
    let bad = || {
        Diagnostic::input(
            "--seed-point",
            format!("'{text}' is not a point"),
            "write three lengths, such as 10mm,0mm,5mm",
        )
    };
    let parts: Vec<f64> = text
        .split(',')
        .map(length_m)
        .collect::<Result<_>>()
        .map_err(|e| e.within("--seed-point"))?;
    parts.try_into().map_err(|_| bad())
}

/// As many threads as asked for, or one per core.
fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool> {
    if let Some(threads @ (0 | 1025..)) = threads {
        return Err(Diagnostic::input(
            "--threads",
            format!("{threads} is not between 1 and 1024"),
            "",
        ));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|e| {
            Diagnostic::failed(
                "--threads",
                format!("the threads cannot be started: {e}"),
                "ask for fewer",
            )
        })
}

/// Finds out before the work whether the body can be written at all.
fn check_output(output: &Path, stl: &Path, diameter: Option<&str>) -> Result<()> {
    let files = body_files(output)?;
    for file in &files {
        need_folder_of(file)?;
    }
    let sieve = diameter.and_then(Sizes::file).map(PathBuf::from);
    let read: Vec<PathBuf> = sieve.into_iter().chain([stl.to_owned()]).collect();
    refuse_to_replace(&files, &read)?;
    if output == Path::new("-") && std::io::stdout().is_terminal() {
        return Err(Diagnostic::input(
            "standard output",
            "a .vtp is no text for a terminal",
            "give --output FILE, or pipe it into another program",
        ));
    }
    Ok(())
}

fn read_surface(path: &Path, reading: &Reading) -> Result<Surface> {
    if !(reading.scale > 0.0 && reading.scale.is_finite()) {
        return Err(Diagnostic::input(
            "--scale",
            format!("{} is not a positive number", reading.scale),
            "1 leaves the shape as it is",
        ));
    }
    let unit_m = length_unit_m(&reading.unit).map_err(|e| e.within("--unit"))?;
    let (name, bytes) = if path == Path::new("-") {
        let mut bytes = Vec::new();
        std::io::stdin()
            .lock()
            .read_to_end(&mut bytes)
            .map(|_| ("standard input".to_owned(), bytes))
    } else {
        std::fs::read(path).map(|bytes| (path.display().to_string(), bytes))
    }
    .map_err(|e| {
        let (problem, remedy) = if path.is_dir() {
            ("this is a folder".to_owned(), "name a file in it")
        } else if e.kind() == std::io::ErrorKind::NotFound {
            (
                "there is no such file".to_owned(),
                "check its name and folder",
            )
        } else {
            (format!("cannot be read: {e}"), "")
        };
        Diagnostic::input(path.display().to_string(), problem, remedy)
    })?;
    surface_from_stl(
        &bytes,
        &name,
        ReadSettings {
            unit_m,
            scale: reading.scale,
            fill_holes: reading.fill_holes,
        },
    )
}

fn info(file: &Path, reading: &Reading, json: bool) -> Result<()> {
    if file
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("stl"))
    {
        let surface = read_surface(file, reading)?;
        if json {
            return write_standard_json(&surface_summary(&surface));
        }
        return write_standard_output(|out| out.write_all(surface_text(&surface).as_bytes()));
    }
    let summary = body_summary(&read_body(file)?);
    if json {
        return write_standard_json(&summary);
    }
    write_standard_output(|out| write!(out, "{summary}"))
}

fn progress_bar() -> ProgressBar {
    let bar = ProgressBar::new(1000);
    if let Ok(style) =
        ProgressStyle::with_template("{msg:14} [{bar:40}] {percent:>3} %  {eta} left")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}
