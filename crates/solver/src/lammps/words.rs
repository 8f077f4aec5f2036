//! Refusals and counts in words.

use std::fmt::Display;

use dem_io::Diagnostic;
use dem_scene::Scene;

/// Numbers with spaces between them.
pub(super) fn numbers(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(|x| format!("{x:e}")).collect();
    words.join(" ")
}

/// The refusal of a part of a scene.
pub(super) fn refused(
    scene: &Scene,
    part: impl Display,
    why: impl Display,
    remedy: impl Display,
) -> Diagnostic {
    Diagnostic::input(
        format!("{}: {part}", scene.source),
        format!("LAMMPS has no word for it: {why}"),
        remedy.to_string(),
    )
}
