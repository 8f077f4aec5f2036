//! `[output]`

use std::path::{Path, PathBuf};

use super::field::Field;
use super::listing::{LISTED, Listing};
use super::numbers::quantity;
use super::paths::named_path;
use super::plain_table::keyed_struct;
use super::schema::{Kind, Word, table_schema};
use super::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{LENGTH, TIME};

/// The quantity that colours the particles of pictures. Of a quantity of bonds, a particle has the
/// largest value of its intact bonds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ColourBy {
    /// "fragment": each has its own colour.
    #[default]
    Fragment,
    /// "fragment_mass", kg.
    FragmentMass,
    /// "strain_rate" of bonds by their `strain_rate_measure`, 1/s.
    StrainRate,
    /// "dynamic_increase_factor" of the strengths of bonds.
    DynamicIncreaseFactor,
    /// "dynamic_utilisation" of bonds: stress over strength at their strain rate.
    DynamicUtilisation,
}

impl Word for ColourBy {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("fragment", Self::Fragment),
        ("fragment_mass", Self::FragmentMass),
        ("strain_rate", Self::StrainRate),
        ("dynamic_increase_factor", Self::DynamicIncreaseFactor),
        ("dynamic_utilisation", Self::DynamicUtilisation),
    ];
}

keyed_struct! {
    OUTPUT = "[output]";
    /// Output files and their intervals in simulated time. Without this table and `--output`, no
    /// file is written.
    #[derive(Debug, Clone, Default, PartialEq)]
    pub struct Output {
        /// Folder of the results, relative to the folder of the scene; without it and `--output`,
        /// the folder SCENE-out in the working directory, named after the scene.
        folder: Option<PathBuf> = text("folder", "a folder")
            .otherwise("the scene's name with -out");
        /// Time between frames.
        frames_s: Option<f64> = quantity("frames", &TIME).positive().otherwise("first and last");
        /// Time between rows of the time series; the default is at least 200 steps in scenes of
        /// more than 20,000 particles and bonds.
        series_s: Option<f64> = quantity("series", &TIME)
            .positive()
            .otherwise("a thousandth of the run");
        /// Time between pictures.
        pictures_s: Option<f64> = quantity("pictures", &TIME).positive();
        /// Camera of the pictures.
        view_from: Option<[f64; 3]> = table("view", &VIEW).otherwise("front, right and above");
        /// Quantity that colours the particles of pictures; of a quantity of bonds, a particle has
        /// the largest value of its intact bonds.
        colour_by: ColourBy = word::<ColourBy>("colour_by", "fragment");
        /// Openings of the sieves of `distribution.csv`, the smallest first.
        sieves_m: Vec<f64> = new("sieves", Kind::List(&Kind::Quantity(&LENGTH)))
            .otherwise("R 20/3 of ISO 565");
        /// Width of the intervals of `flow.csv`, in which mass flows are means.
        flow_s: Option<f64> = quantity("flow", &TIME)
            .positive()
            .otherwise("a twentieth of the run");
        /// Simulated time between checkpoints; by default one every minute of run time.
        checkpoint_s: Option<f64> = quantity("checkpoint", &TIME)
            .positive()
            .otherwise("at the end");
    }
}

table_schema! {
    /// Camera of the pictures.
    pub(super) static VIEW = "View";

    /// Direction from the bodies to the camera; its length does not matter.
    new("from", Kind::Direction("a direction")).required("[1, -2, 1]");
}

pub(super) fn read(field: &Field<'_>, folder: &Path) -> Result<Output> {
    let table = Table::of(field, &OUTPUT)?;
    Ok(Output {
        folder: table.read_by("folder", |field| {
            let path = named_path(&field, folder)?;
            if path.as_os_str() == "-" {
                return Err(field.wrong("a folder", "write a name such as \"results\""));
            }
            Ok(path)
        })?,
        frames_s: table.read("frames")?,
        series_s: table.read("series")?,
        pictures_s: table.read("pictures")?,
        view_from: table.read_by("view", |field| Table::of(&field, &VIEW)?.read("from"))?,
        colour_by: table.read("colour_by")?,
        sieves_m: table
            .read_by("sieves", |field| sieves_m(&field))?
            .unwrap_or_default(),
        flow_s: table.read("flow")?,
        checkpoint_s: table.read("checkpoint")?,
    })
}

fn sieves_m(field: &Field<'_>) -> Result<Vec<f64>> {
    let mut sieves_m: Vec<f64> = Vec::new();
    for item in field.items()? {
        let sieve_m = item.positive(&LENGTH)?;
        if let Some(before_m) = sieves_m.last().filter(|before_m| sieve_m <= **before_m) {
            let limit = format!(
                "more than the opening before it, {}",
                quantity(*before_m, "m")
            );
            return Err(item.wrong(&limit, "write openings with the smallest first, each once"));
        }
        sieves_m.push(sieve_m);
    }
    Ok(sieves_m)
}

pub(super) fn list(output: &Output, listing: &mut Listing) {
    match &output.folder {
        Some(folder) => listing.text("folder", folder.display().to_string()),
        None => listing.text("folder", listing.usual("folder")),
    }
    listing.value("frames", &output.frames_s);
    listing.value("series", &output.series_s);
    listing.value("pictures", &output.pictures_s);
    match &output.view_from {
        Some(from) => listing.table("view", &VIEW, |listing| listing.value("from", from)),
        None => listing.text("view.from", listing.usual("view")),
    }
    listing.value("colour_by", &output.colour_by);
    if output.sieves_m.is_empty() {
        listing.text("sieves", listing.usual("sieves"));
    } else {
        let shown = output.sieves_m.iter().take(LISTED);
        let shown: Vec<String> = shown.map(|sieve_m| quantity(*sieve_m, "m")).collect();
        listing.some("sieves", &shown, output.sieves_m.len());
    }
    listing.value("flow", &output.flow_s);
    listing.value("checkpoint", &output.checkpoint_s);
}
