//! The arguments of `dem-run calibrate`.

use std::path::PathBuf;

use clap::Args;
use dem_io::{Diagnostic, Result};
use dem_pack::cli::Recipe;
use dem_terminal::progress::{ProgressBar, progress_bar};

use crate::calibration::ModulusBy;
use crate::cli::scene_arguments::SceneArguments;

/// Packings of a shape, unless given.
pub(super) const PACKINGS: usize = 4;

#[derive(Debug, Args)]
pub(crate) struct CalibrateArguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// Scenes of other tests of the same material: one calibration meets the targets of all
    #[arg(value_name = "OTHER SCENES")]
    pub(super) more: Vec<PathBuf>,
    /// Material file to write, which scenes include; a page (.html) and a record (.json) of the
    /// same name are written with it
    #[arg(long, short, value_name = "FILE", default_value = "calibrated.toml")]
    pub(super) output: PathBuf,
    /// Number to vary: modulus, strength (all strengths of the bonds by one factor), one strength
    /// such as shear_strength, or PATH=MEASURE:VALUE for another number of the scene and a measure
    /// or test result (SI units) that it determines; modulus and strength unless given. With
    /// several scenes also friction_angle, and PATH alone
    #[arg(long, value_name = "NUMBER")]
    pub(super) free: Vec<String>,
    /// With several scenes: file of the shape of a scene's body, in place of that after --
    #[arg(long, value_name = "SCENE=FILE", requires_all = ["pack", "more"])]
    pub(super) shape: Vec<String>,
    /// With several scenes: a further result that a scene has to give, such as
    /// "shear.toml=residual strength:80 kPa"; without a value that of its measured file
    #[arg(long, value_name = "SCENE=RESULT:VALUE", requires = "more")]
    pub(super) target: Vec<String>,
    /// Modulus to meet: from the travel, as test rigs measure it, or from the specimen's own
    /// deformation
    #[arg(long, value_enum, default_value = "travel")]
    pub(super) modulus: ModulusBy,
    /// Number of packings of the shape after --, 4 unless given; their seeds follow that of the
    /// arguments
    #[arg(long, value_name = "N", requires = "pack")]
    pub(super) packings: Option<usize>,
    /// Diameters of spheres, in place of --diameter after --; repeat it for a table over sizes
    #[arg(long, value_name = "DIAMETERS", requires = "pack")]
    pub(super) size: Vec<String>,
    /// Largest error of the curve, such as 5%: names the coarsest size that keeps it
    #[arg(long, value_name = "ERROR", requires = "size")]
    pub(super) max_error: Option<String>,
    /// Go on with an interrupted calibration
    #[arg(long, conflicts_with = "force")]
    pub(super) resume: bool,
    /// Overwrite an earlier calibration
    #[arg(long)]
    pub(super) force: bool,
    /// Only print errors; --json is still printed
    #[arg(long, short)]
    pub(super) quiet: bool,
    /// Shape and options of dem-pack: the body is packed anew; otherwise --body names its
    /// packings, one each, or the scene its only one
    #[arg(last = true, value_name = "STL OPTIONS")]
    pub(super) pack: Vec<String>,
}

impl CalibrateArguments {
    /// The shape with each size of spheres, from coarse to fine; none without `--`.
    pub(super) fn recipes(&self) -> Result<Vec<Recipe>> {
        if let Some(wanted @ (0 | 1001..)) = self.packings {
            let problem = format!("{wanted} is not between 1 and 1000");
            return Err(Diagnostic::input("--packings", problem, "4 is usual"));
        }
        if self.pack.is_empty() {
            return Ok(Vec::new());
        }
        if self.size.is_empty() {
            return Ok(vec![Recipe::parse(&self.pack)?]);
        }
        let sized = self.size.iter().map(|size| {
            let mut arguments = self.pack.clone();
            arguments.extend(["--diameter".to_owned(), size.clone()]);
            Recipe::parse(&arguments)
        });
        let mut recipes: Vec<Recipe> = sized.collect::<Result<_>>()?;
        recipes.sort_by(|a, b| b.smallest_diameter_m().total_cmp(&a.smallest_diameter_m()));
        Ok(recipes)
    }

    /// The progress of a round.
    pub(super) fn progress_bar(&self, name: &str) -> ProgressBar {
        let template =
            "calibrate {prefix}[{bar:40}] {percent:>3} % of this round, {eta} left  {msg}";
        let bar = progress_bar(self.quiet, 1000, template);
        if !name.is_empty() {
            bar.set_prefix(format!("{name} "));
        }
        bar
    }
}
