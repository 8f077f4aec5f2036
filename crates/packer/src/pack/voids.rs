//! Voids of a settled packing are filled, as far as the sizes allow.

use super::PackHistory;
use crate::front::Front;

/// Spheres around which voids are searched at a time.
const VOID_SEARCH_GROUP: usize = 2000;

/// Puts spheres into the voids that take at least the smallest one, each of a size drawn among those that fit there,
/// as long as their number does not distort the distribution of sizes by more than a tenth of its statistical noise. Whether it would have, so that voids may be left.
pub(super) fn fill_voids(front: &mut Front, history: &mut PackHistory) -> bool {
    let one_size = front.settings.radius_range[0] == front.settings.radius_range[1];
    let count = front.balls.len();
    let most = if one_size {
        usize::MAX
    } else {
        (0.1 * 1.36 * (count as f64).sqrt()).ceil() as usize
    };
    // Neighbours in memory are neighbours in space: the search goes round in strides, so that what it finds first is spread evenly.
    let groups = count.div_ceil(VOID_SEARCH_GROUP);
    for group in 0..groups {
        let around: Vec<u32> = (group..count).step_by(groups).map(|i| i as u32).collect();
        fill_voids_around(front, around, most, history);
        if history.void_fillers == most {
            return true;
        }
    }
    false
}

/// Searches around the spheres `around` and then around those that were added, until there are `most` of them.
fn fill_voids_around(
    front: &mut Front,
    mut around: Vec<u32>,
    most: usize,
    history: &mut PackHistory,
) {
    let smallest = front.settings.radius_range[0];
    while !around.is_empty() {
        let first = front.balls.len() as u32;
        for place in front.voids(&around) {
            if history.void_fillers < most && front.fits(&place, smallest) {
                let (centre, radius) = front.fill(&place);
                front.place(&centre, radius);
                history.void_fillers += 1;
            }
        }
        around = (first..front.balls.len() as u32).collect();
    }
}
