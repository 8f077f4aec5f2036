//! The colours of fragments, as in the pictures of a run.

use std::path::Path;

use dem_pictures::colours::{Piece, of_pieces};

/// The colour of each fragment up to the number `last`, from `fragment-tree.csv`. Without that file
/// each number has its own colour.
pub(crate) fn colours(folder: &Path, last: u32) -> Vec<[u8; 3]> {
    let text = std::fs::read_to_string(folder.join("fragment-tree.csv")).unwrap_or_default();
    let mut pieces: Vec<Piece> = text.lines().skip(1).filter_map(piece).collect();
    let unknown = |_| Piece {
        parent: None,
        particles: 2,
    };
    pieces.extend((pieces.len()..=last as usize).map(unknown));
    of_pieces(&pieces)
}

/// A row `fragment_id,parent_id,created_s,ended_s,particles`. Rows stand in the order of the ids.
fn piece(row: &str) -> Option<Piece> {
    let cells: Vec<&str> = row.split(',').collect();
    Some(Piece {
        parent: cells.get(1)?.parse().ok(),
        particles: cells.get(4)?.parse().ok()?,
    })
}
