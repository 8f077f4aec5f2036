//! The options of `dem-run new`, which are its questions as well.

use std::path::PathBuf;

use clap::Args;
use dem_io::{Diagnostic, Result};

use super::templates::Template;

#[derive(Debug, Args)]
pub(crate) struct NewArguments {
    /// What happens in the scene
    #[arg(value_name = "TYPE")]
    pub(super) template: Template,
    /// The folder to make
    #[arg(value_name = "FOLDER")]
    pub(super) folder: PathBuf,
    /// Your own body, an STL, OBJ, PLY or 3MF file, in mm if it has no unit; the shape of the
    /// template if not given
    #[arg(long, value_name = "FILE")]
    pub(super) shape: Option<String>,
    /// Its largest extent, such as "30 mm": scales the shape
    #[arg(long, allow_hyphen_values = true)]
    pub(super) size: Option<String>,
    /// Mass of one body, such as "420 mg"; from the density of the template if not given
    #[arg(long, allow_hyphen_values = true)]
    pub(super) mass: Option<String>,
    /// Height of the fall, such as "1 m" (drop, drop-weight)
    #[arg(long, allow_hyphen_values = true)]
    height: Option<String>,
    /// Speed of the belt, such as "3 m/s" (chute), or of the drum, such as "60 rpm" (mill)
    #[arg(long, allow_hyphen_values = true)]
    speed: Option<String>,
    /// Gap between the jaws (crusher) or at the closed side (cone), width of the slot (silo) or of
    /// the openings (screen), such as "20 mm"
    #[arg(long, allow_hyphen_values = true)]
    gap: Option<String>,
    /// Diameters of the spheres, as for dem-pack; if not given, ten across the thinnest part, or as
    /// many as some 3,000 spheres allow
    #[arg(long, allow_hyphen_values = true)]
    pub(super) diameter: Option<String>,
    /// Ask nothing on a terminal: take the defaults
    #[arg(long, short)]
    pub(super) yes: bool,
}

impl NewArguments {
    /// The options of the one number that defines the situation, with their values.
    fn situations(&self) -> [(&'static str, Option<&str>); 3] {
        [
            ("--height", self.height.as_deref()),
            ("--speed", self.speed.as_deref()),
            ("--gap", self.gap.as_deref()),
        ]
    }

    /// The value of one of them.
    pub(super) fn situation(&self, option: &str) -> Option<&str> {
        let mut all = self.situations().into_iter();
        all.find(|(name, _)| *name == option)?.1
    }

    /// Refuses an option that the template does not use.
    pub(super) fn refuse_unused(&self) -> Result<()> {
        let used = self.template.option();
        let is_ball = self.template.is_ball();
        let of_shape = [("--shape", &self.shape), ("--diameter", &self.diameter)];
        let of_shape = of_shape.map(|(option, value)| (option, value.as_deref()));
        let others = of_shape.into_iter().filter(|_| is_ball);
        let mut given = (self.situations().into_iter())
            .filter(|(option, _)| Some(*option) != used)
            .chain(others)
            .filter(|(_, value)| value.is_some());
        let Some((option, _)) = given.next() else {
            return Ok(());
        };
        let used = used.map_or(String::new(), |used| format!(", {used}"));
        let all = match is_ball {
            true => format!("--size, --mass{used}"),
            false => format!("--shape, --size, --mass{used} and --diameter"),
        };
        Err(Diagnostic::input(
            option,
            format!("the scene '{}' does not use it", self.template.name()),
            format!("remove it: it uses {all}"),
        ))
    }
}
