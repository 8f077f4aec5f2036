//! What single precision does to corners.

use crate::bounds::Bounds;
use crate::units::significant;

/// Part of the size by which single precision may move corners without a word.
const MOST_MOVED: f64 = 1e-4;

/// Rounding of corners to single precision, in the unit of the corners.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Moved {
    /// Half the distance of two neighbouring numbers, where coordinates are largest.
    by: f64,
    /// The same as a part of the longest extent of the corners.
    share_of_size: f64,
}

/// How far the numbers of single precision lie apart at these corners.
fn moved_by_single_precision<'a>(corners: impl Iterator<Item = &'a [f64; 3]> + Clone) -> Moved {
    let largest = corners
        .clone()
        .flatten()
        .fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let single = largest as f32;
    let by = 0.5 * f64::from(single.next_up() - single);
    let bounds = Bounds::of(corners.copied());
    let size = (0..3)
        .map(|k| bounds.high[k] - bounds.low[k])
        .fold(0.0, f64::max);
    Moved {
        by,
        share_of_size: by / size.max(f64::MIN_POSITIVE),
    }
}

/// True if single precision moves none of these corners by a part of their size that shows in the
/// volume.
pub fn single_precision_keeps<'a>(corners: impl Iterator<Item = &'a [f64; 3]> + Clone) -> bool {
    moved_by_single_precision(corners).share_of_size <= MOST_MOVED
}

/// A note if the single precision of a binary file of this format moves corners by a part of the
/// size that shows in the volume.
pub(crate) fn precision_note(corners: &[[[f64; 3]; 3]], format: &str) -> Option<String> {
    let moved = moved_by_single_precision(corners.iter().flatten());
    (moved.share_of_size > MOST_MOVED).then(|| {
        format!(
            "The numbers of a binary {format} have seven digits: this far from the origin its corners may be off by {} units of the file, {} % of its size. Export it near the origin, or as text.",
            significant(moved.by, 2),
            significant(100.0 * moved.share_of_size, 2)
        )
    })
}
