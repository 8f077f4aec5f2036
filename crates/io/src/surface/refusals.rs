//! Why a surface does not bound a solid, in words.

use super::frame::Frame;
use super::holes::{Hole, LONGEST_BOUNDARY};
use super::mesh::{Edges, Mesh, mean};
use crate::diagnostic::Diagnostic;

/// Edges with three, five, ... facets.
pub(super) fn odd_edges(mesh: &Mesh, edges: &Edges, frame: &Frame) -> Option<Diagnostic> {
    let odd: Vec<&[u32]> = edges
        .groups()
        .filter(|group| group.len() > 2 && group.len() % 2 == 1)
        .collect();
    let first = odd.first()?;
    let [from, to] = mesh.segment(first[0]).map(|point| frame.show(point));
    let problem = format!(
        "the surface is not that of a solid: {}, the first with {} from {from} to {to} in units of the file",
        counted(
            odd.len(),
            "edge belongs to an odd number of facets",
            "edges belong to an odd number of facets"
        ),
        first.len()
    );
    Some(Diagnostic::input(
        "",
        problem,
        "remove inner walls and stray facets in the program that made the shape",
    ))
}

/// Edges with one facet. `holes` are the loops that they form.
pub(super) fn open_edges(
    mesh: &Mesh,
    edges: &Edges,
    holes: &[Hole],
    frame: &Frame,
    diagonal: f64,
) -> Diagnostic {
    let open: Vec<u32> = edges.open().collect();
    let largest = holes
        .iter()
        .map(|hole| (hole.perimeter(mesh), hole))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let place = match largest {
        Some((perimeter, hole)) => format!(
            "{}, the largest with a boundary of {} around {}",
            counted(holes.len(), "hole", "holes"),
            frame.show_length(perimeter),
            frame.show(hole.middle(mesh))
        ),
        None => open.first().map_or(String::new(), |h| {
            format!("the first at {}", frame.show(mean(mesh.segment(*h))))
        }),
    };
    let problem = format!(
        "the surface is not closed: {}, {place} (in units of the file)",
        counted(open.len(), "open edge", "open edges")
    );
    let remedy = if !holes.is_empty() && holes.iter().all(|hole| hole.is_small(mesh, diagonal)) {
        "close it in the program that made the shape, or pass --fill-holes".to_owned()
    } else {
        let limit = frame.show_length(LONGEST_BOUNDARY * diagonal);
        format!(
            "close it in the program that made the shape (--fill-holes closes holes with a boundary of up to {limit})"
        )
    };
    Diagnostic::input("", problem, remedy)
}

/// Triangles that cannot be wound alike.
pub(super) fn one_sided(mesh: &Mesh, half_edge: u32, frame: &Frame) -> Diagnostic {
    let [from, to] = mesh.segment(half_edge).map(|point| frame.show(point));
    let problem = format!(
        "the surface has no inside: its facets cannot be wound alike, as on a Moebius strip (found at the edge from {from} to {to} in units of the file)"
    );
    Diagnostic::input(
        "",
        problem,
        "make a surface with two sides in the program that made the shape",
    )
}

/// Nothing is enclosed.
pub(super) fn no_volume() -> Diagnostic {
    Diagnostic::input(
        "",
        "the surface encloses no volume: all its facets are flat or fold onto each other",
        "export the shape as a solid",
    )
}

/// "1 hole", "2 holes".
pub(super) fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}
