//! Arguments as typed, and the settings that they give.

use crate::body::BodySettings;
use crate::bonds::{BondSettings, LARGEST_BOND_RANGE};
use crate::density::LARGEST_OVERLAP;
use crate::pack::PackSettings;
use crate::pack::shrink::SHRINK_RANGE;
use crate::sizes::{Basis, Sizes};
use clap::{Args, Parser, Subcommand, ValueEnum};
use dem_io::body::About;
use dem_io::units::{VOLUME, density_kg_m3, length_m, quantity, significant};
use dem_io::{Diagnostic, Result};
use dem_terminal::program::{Shell, parsed};
use std::ffi::OsString;
use std::path::PathBuf;

/// Largest value for `--densify`: the largest that is chosen automatically.
const LARGEST_DENSIFY: f64 = SHRINK_RANGE[1];

/// Fills the shape of an STL, OBJ, PLY or 3MF file with overlapping spheres and joins them by bonds.
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
        dem-pack cake.stl --diameter 2mm..3mm --overlap 0.25 --bond-range 1.1 -o cake.vtp\n  \
        dem-pack rock.stl --diameter lognormal:2.5mm,0.3mm,1.5mm..4mm --basis mass | dem-run --body -"
)]
pub struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) pack: PackArguments,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Describe a shape or a body
    Info {
        /// A shape (.stl, .obj, .ply, .3mf), a body (.vtp, .data, .csv, .txt), or - for a .vtp on
        /// standard input
        file: PathBuf,
        #[command(flatten)]
        reading: Reading,
        /// Print it as JSON
        #[arg(long)]
        json: bool,
    },
    /// Convert a body file to another format (.vtp, .data, .csv, .txt, - for a .vtp through a pipe)
    Convert {
        /// The body to read
        from: PathBuf,
        /// The file to write
        to: PathBuf,
    },
    /// Bond the spheres of a file: a packing without bonds, or a frame of a run
    Bond(BondCommand),
    /// Print a script that completes dem-pack's options in a shell
    Completions {
        /// Which shell
        shell: Shell,
    },
    /// Print the man page
    Man,
}

#[derive(Debug, Args)]
pub(super) struct BondCommand {
    /// The spheres: a body (.vtp, .data, .csv, .txt), a frame of a run (.vtp), whose loose spheres
    /// are taken, or - for a .vtp on standard input
    pub(super) spheres: PathBuf,
    /// The body to write: .vtp, .data (LAMMPS), .csv, .txt; standard output if not given
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) bonds: BondArguments,
    /// Replace the bonds that the file already has
    #[arg(long, help_heading = "Bonds")]
    pub(super) replace: bool,
    /// Density of the particles' material (kg/m3 unless given); that of the file if not given
    #[arg(long, allow_hyphen_values = true, help_heading = "Body")]
    pub(super) particle_density: Option<String>,
    /// Volume of the shape that the spheres fill (m3 unless given), such as 36cm3; that of the file
    /// if not given
    #[arg(long, allow_hyphen_values = true, help_heading = "Body")]
    pub(super) shape_volume: Option<String>,
    /// Only print errors
    #[arg(short, long)]
    pub(super) quiet: bool,
}

impl BondCommand {
    /// What is known of the body: `given` by its file, with the density and the volume of the
    /// options, if there are any, which must be positive.
    pub(super) fn about(&self, given: About) -> Result<About> {
        let density = checked_density("--particle-density", &self.particle_density)?;
        let volume = self
            .shape_volume
            .as_deref()
            .map(checked_volume)
            .transpose()?;
        Ok(About {
            particle_density_kg_m3: density.or(given.particle_density_kg_m3),
            shape_volume_m3: volume.or(given.shape_volume_m3),
            ..given
        })
    }
}

#[derive(Debug, Args)]
pub(super) struct Reading {
    /// Unit of the numbers in the file: nm, um, mm, cm, m, km, in; mm if not given. A 3MF has its
    /// own, which a unit given here must be
    #[arg(long, help_heading = "Shape")]
    pub(super) unit: Option<String>,
    /// Factor on all lengths of the shape
    #[arg(
        long,
        default_value_t = 1.0,
        allow_negative_numbers = true,
        help_heading = "Shape"
    )]
    pub(super) scale: f64,
    /// Close small holes of the surface instead of refusing them
    #[arg(long, help_heading = "Shape")]
    pub(super) fill_holes: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum BasisArgument {
    Number,
    Mass,
}

#[derive(Debug, Args)]
pub(super) struct PackArguments {
    /// The shape: an STL, OBJ, PLY or 3MF file, or - for standard input
    #[arg(value_name = "SHAPE", required = true)]
    pub(super) shape: Option<PathBuf>,
    /// The body to write: .vtp, .data (LAMMPS), .csv, .txt; standard output if not given
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) reading: Reading,

    /// Sphere diameters: 2.5mm | 2mm..3mm | normal:MEAN,STD,MIN..MAX | lognormal:MEAN,STD,MIN..MAX
    /// | weibull:SCALE,SHAPE,MIN..MAX | sieve:FILE.csv
    #[arg(
        short,
        long,
        required = true,
        allow_hyphen_values = true,
        help_heading = "Spheres"
    )]
    pub(super) diameter: Option<String>,
    /// Basis of the distribution of diameters: by number or by mass
    #[arg(long, value_enum, default_value = "number", help_heading = "Spheres")]
    pub(super) basis: BasisArgument,
    /// Overlap o of neighbouring spheres: they touch at the reduced radius r_gen = radius/(1 + o)
    #[arg(
        long,
        default_value_t = 0.25,
        allow_negative_numbers = true,
        help_heading = "Spheres"
    )]
    pub(super) overlap: f64,
    /// Density of the particles' material (kg/m3 unless given)
    #[arg(long, allow_hyphen_values = true, help_heading = "Spheres")]
    pub(super) particle_density: Option<String>,
    /// Find the overlap that gives this bulk density: mass of particles / volume of the shape
    /// (kg/m3 unless given)
    #[arg(
        long,
        requires = "particle_density",
        allow_hyphen_values = true,
        conflicts_with = "overlap",
        help_heading = "Spheres"
    )]
    pub(super) solid_density: Option<String>,
    /// Seed of the random numbers: the same seed gives the same body
    #[arg(
        long,
        default_value_t = 1,
        value_parser = parse_seed,
        allow_negative_numbers = true,
        help_heading = "Spheres"
    )]
    pub(super) seed: u64,
    /// Starting point of the advancing front: X,Y,Z; the deepest point if not given
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        help_heading = "Spheres"
    )]
    pub(super) seed_point: Option<String>,
    /// Densify: run the front at radii reduced by this fraction, then grow the spheres to full size
    /// while they relax; 0 for the bare front, at most 0.08. If not given, as much as leaves the
    /// spheres just short of jamming, 0.02 to 0.08
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "FRACTION",
        help_heading = "Spheres"
    )]
    pub(super) densify: Option<f64>,

    #[command(flatten)]
    pub(super) bonds: BondArguments,

    /// Number of threads; the result is the same for any
    #[arg(long, help_heading = "Running")]
    pub(super) threads: Option<usize>,
    /// Print the report as JSON on standard output (the body then needs --output)
    #[arg(long, requires = "output", help_heading = "Running")]
    pub(super) json: bool,
    /// Print the whole report
    #[arg(short, long, help_heading = "Running", conflicts_with_all = ["json", "quiet"])]
    pub(super) verbose: bool,
    /// Only print errors: no progress, and no report, which is not computed; --json is still
    /// printed
    #[arg(short, long, help_heading = "Running")]
    pub(super) quiet: bool,
}

impl Arguments {
    /// The arguments of a command line, the first of which is the name of the program. Help and
    /// version are printed, and the process ends.
    pub fn parsed(given: impl Iterator<Item = OsString>) -> Result<Self> {
        let given: Vec<OsString> = given.collect();
        parsed("dem-pack", &given)
    }
}

/// Which spheres are bonded, and how thick the bonds are.
#[derive(Debug, Args)]
pub(super) struct BondArguments {
    /// Bond pairs whose centres are nearer than this times the sum of their radii
    #[arg(
        long,
        default_value_t = 1.1,
        allow_negative_numbers = true,
        help_heading = "Bonds"
    )]
    pub(super) bond_range: f64,
    /// Find the bond range that gives this many bonds / particles
    #[arg(
        long,
        conflicts_with = "bond_range",
        allow_negative_numbers = true,
        help_heading = "Bonds"
    )]
    pub(super) bonds_per_particle: Option<f64>,
    /// Bond radius / radius of the smaller particle
    #[arg(
        long,
        default_value_t = 1.0,
        allow_negative_numbers = true,
        help_heading = "Bonds"
    )]
    pub(super) bond_radius: f64,
}

impl BondArguments {
    /// The settings, with every value checked.
    pub(super) fn checked(&self) -> Result<BondSettings> {
        check_range(
            "--bond-radius",
            self.bond_radius,
            f64::MIN_POSITIVE,
            10.0,
            "1 is usual",
        )?;
        check_range(
            "--bond-range",
            self.bond_range,
            f64::MIN_POSITIVE,
            LARGEST_BOND_RANGE * (1.0 + f64::EPSILON),
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
        Ok(BondSettings {
            range: self.bond_range,
            per_particle: self.bonds_per_particle,
            radius_factor: self.bond_radius,
        })
    }
}

fn parse_seed(text: &str) -> std::result::Result<u64, String> {
    let limits = format!("a seed is a whole number from 0 to {}", u64::MAX);
    text.parse().map_err(|_| limits)
}

impl PackArguments {
    /// The settings, with every value checked.
    pub(super) fn checked(&self) -> Result<BodySettings> {
        let basis = match self.basis {
            BasisArgument::Number => Basis::Number,
            BasisArgument::Mass => Basis::Mass,
        };
        let sizes = Sizes::parse(self.diameter.as_deref().unwrap_or_default(), basis)?;
        check_range(
            "--overlap",
            self.overlap,
            0.0,
            LARGEST_OVERLAP,
            "0.1 to 0.5 is usual",
        )?;
        if let Some(densify) = self.densify
            && !(0.0..=LARGEST_DENSIFY).contains(&densify)
        {
            return Err(Diagnostic::input(
                "--densify",
                format!(
                    "{densify} is not at least 0 and at most {LARGEST_DENSIFY}: spheres that grow by more jam",
                ),
                "0.03 to 0.06 is usual, 0 is the bare front",
            ));
        }
        Ok(BodySettings {
            packing: PackSettings {
                sizes,
                overlap: self.overlap,
                seed: self.seed,
                densify: self.densify,
                seed_point_m: self.seed_point.as_deref().map(parse_point).transpose()?,
            },
            bonds: self.bonds.checked()?,
            particle_density_kg_m3: checked_density("--particle-density", &self.particle_density)?,
            solid_density_kg_m3: checked_density("--solid-density", &self.solid_density)?,
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

fn checked_density(option: &str, text: &Option<String>) -> Result<Option<f64>> {
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
}

fn checked_volume(text: &str) -> Result<f64> {
    const OPTION: &str = "--shape-volume";
    let value = quantity(text, &VOLUME).map_err(|e| e.within(OPTION))?;
    if value <= 0.0 {
        let problem = format!("{value} m3 is not positive");
        return Err(Diagnostic::input(
            OPTION,
            problem,
            "give a volume such as 36cm3",
        ));
    }
    Ok(value)
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
