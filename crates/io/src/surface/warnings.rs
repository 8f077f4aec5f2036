//! What was done to a surface, in words.

use super::refusals::counted;
use super::solid::{Repairs, Shell};
use crate::units::{show_length, significant};

/// What the repairs alone do not tell.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Remarks {
    /// Triangles before any were turned.
    pub(super) triangles: usize,
    /// Parts without volume that were dropped.
    pub(super) flat_parts: usize,
    /// A place where two triangles cross, in units of the file, as text.
    pub(super) crossing_place: Option<String>,
    /// Shells overlap, with or without triangles that cross.
    pub(super) overlap: bool,
    /// Estimated error of the volume, as a share of it.
    pub(super) volume_error: f64,
}

/// One sentence for each thing that a user should know.
pub(super) fn sentences(repairs: &Repairs, shells: &[Shell], remarks: &Remarks) -> Vec<String> {
    let mut sentences = Vec::new();
    let mut say = |condition: bool, sentence: &dyn Fn() -> String| {
        if condition {
            sentences.push(sentence());
        }
    };
    of_facets(repairs, remarks, &mut say);
    of_parts(repairs, shells, remarks, &mut say);
    sentences
}

/// Takes a sentence and whether it is to be said.
type Say<'a> = &'a mut dyn FnMut(bool, &dyn Fn() -> String);

fn of_facets(repairs: &Repairs, remarks: &Remarks, say: Say<'_>) {
    say(repairs.welded_vertices > 0, &|| {
        let corners = counted(repairs.welded_vertices, "vertex was", "vertices were");
        let most = match repairs.weld_tolerance_m {
            below if below < 1e-9 => "less than 1 nm".to_owned(),
            tolerance_m => format!("{} at most", show_length(tolerance_m)),
        };
        format!("{corners} moved onto a near one to close the surface, over {most}.")
    });
    say(repairs.degenerate_facets > 0, &|| {
        format!(
            "{} dropped.",
            counted(
                repairs.degenerate_facets,
                "facet without area was",
                "facets without area were"
            )
        )
    });
    say(repairs.duplicate_facets > 0, &|| {
        format!(
            "{} dropped.",
            counted(
                repairs.duplicate_facets,
                "facet that stood there already was",
                "facets that stood there already were"
            )
        )
    });
    say(remarks.flat_parts > 0, &|| {
        format!(
            "{} dropped.",
            counted(
                remarks.flat_parts,
                "part without volume was",
                "parts without volume were"
            )
        )
    });
    say(repairs.t_junctions > 0, &|| {
        let edges = counted(repairs.t_junctions, "edge was", "edges were");
        format!(
            "{edges} split on one side only (T-junctions): closed by splitting the other side too."
        )
    });
    say(repairs.filled_holes > 0, &|| {
        let holes = counted(repairs.filled_holes, "hole was", "holes were");
        format!(
            "{holes} closed with {}.",
            counted(repairs.hole_triangles, "new triangle", "new triangles")
        )
    });
    say(repairs.flipped_facets > 0, &|| {
        if repairs.flipped_facets == remarks.triangles {
            format!(
                "All {} facets were wound the wrong way round: turned, so that their normals point out of the solid.",
                remarks.triangles
            )
        } else {
            let facets = counted(repairs.flipped_facets, "facet was", "facets were");
            format!(
                "{facets} wound the wrong way round ({} in all): turned, so that all normals point out of the solid.",
                remarks.triangles
            )
        }
    });
}

fn of_parts(repairs: &Repairs, shells: &[Shell], remarks: &Remarks, say: Say<'_>) {
    let cavities = shells.iter().filter(|shell| shell.is_cavity).count();
    let parts = shells.len() - cavities;
    say(parts > 1, &|| {
        format!("The shape has {parts} separate parts: each is filled.")
    });
    say(cavities > 0, &|| {
        format!(
            "The shape has {}: left empty.",
            counted(cavities, "cavity", "cavities")
        )
    });
    say(remarks.overlap, &|| {
        let place = remarks
            .crossing_place
            .as_deref()
            .map_or(String::new(), |place| {
                format!(", for example at {place} in units of the file")
            });
        let what = if repairs.self_intersections > 0 {
            format!(
                "{}{place}",
                counted(
                    repairs.self_intersections,
                    "pair of triangles crosses",
                    "pairs of triangles cross"
                )
            )
        } else {
            "Parts of the shape overlap".to_owned()
        };
        let error = significant(100.0 * remarks.volume_error, 2);
        format!(
            "{what}: the union of what they enclose is filled; its volume is known within about {error} %."
        )
    });
}
