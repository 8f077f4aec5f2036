//! The bodies that a study packs itself, made before the runs that need them.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use dem_io::body::write_body;
use dem_io::{Diagnostic, Result};
use dem_pack::cli::Recipe;
use dem_scene::study::Study;
use dem_study::expand::Run;
use dem_study::packings::Packing;
use dem_terminal::progress::progress_bar;

use crate::interrupt::Interrupt;

/// The packings of some runs, each once, by file.
fn packings<'a>(study: &Study, runs: impl Iterator<Item = &'a Run>) -> BTreeMap<PathBuf, Packing> {
    let all = runs.flat_map(|run| run.packings(study));
    all.map(|packing| (packing.file.clone(), packing)).collect()
}

/// Refuses what `dem-pack` would refuse. Returns the files that the packings are made from.
pub(super) fn checked_packings(study: &Study, runs: &[Run]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for packing in packings(study, runs.iter()).values() {
        files.extend(recipe(packing)?.files());
    }
    files.sort();
    files.dedup();
    Ok(files)
}

fn recipe(packing: &Packing) -> Result<Recipe> {
    Recipe::parse(&packing.arguments).map_err(|error| error.within(&packing.place))
}

/// Makes the packings of these runs that are not there yet.
pub(super) fn make_packings<'a>(
    study: &Study,
    runs: impl Iterator<Item = &'a Run>,
    quiet: bool,
    interrupt: &Interrupt,
) -> Result<()> {
    let mut missing = packings(study, runs);
    missing.retain(|file, _| !file.exists());
    if missing.is_empty() {
        return Ok(());
    }
    let template = "pack [{bar:40}] {pos}/{len} bodies  {eta} left";
    let bar = progress_bar(quiet, missing.len(), template);
    bar.set_position(0);
    let made = interrupt.run_interruptible(|interrupted| {
        missing.values().try_for_each(|packing| {
            make(packing, interrupted)?;
            bar.inc(1);
            Ok(())
        })
    });
    bar.finish_and_clear();
    made
}

fn make(packing: &Packing, interrupted: &AtomicBool) -> Result<()> {
    let go_on = |_: &str, _: f64| match interrupted.load(Ordering::Relaxed) {
        true => Err(Diagnostic::interrupted(
            "interrupted",
            "go on with --resume",
        )),
        false => Ok(()),
    };
    let recipe = recipe(packing)?;
    let made = recipe.make(recipe.seed(), &go_on);
    let (body, _) = made.map_err(|error| error.within(&packing.place))?;
    write_body(&body, &packing.file)
}
