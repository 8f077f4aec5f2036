//! What touches something.

use std::collections::BTreeSet;

use crate::state::State;

/// The particles that touch a wall or a particle of another body or fragment.
pub fn touching(state: &State) -> BTreeSet<u32> {
    let of_walls = state.walls.iter().flat_map(|wall| &wall.touching);
    let of_walls = of_walls.filter(|touch| touch.history.overlap_m() > 0.0);
    let mut touching: BTreeSet<u32> = of_walls.map(|touch| touch.particle).collect();
    if let Some(contacts) = &state.contacts {
        let pairs = contacts.pairs.iter().zip(&contacts.histories);
        let pressed = pairs.filter(|(_, history)| history.overlap_m() > 0.0);
        touching.extend(pressed.flat_map(|(pair, _)| pair));
    }
    touching
}

/// Number of contacts that touch in this step, or did in the previous one.
pub fn contacts_now(state: &State) -> usize {
    let of_walls: usize = state.walls.iter().map(|wall| wall.touching.len()).sum();
    let partitions = state.contact_partitions().iter();
    let of_pairs: usize = partitions.map(|partition| partition.computed).sum();
    of_walls + of_pairs
}
