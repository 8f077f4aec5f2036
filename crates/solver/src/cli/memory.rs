//! The memory that a run needs.

use dem_io::units::significant;

use dem_engine::state::State;
use dem_engine::step::all_bytes;

/// Memory of the arrays of a state, and estimated memory of later contacts, bytes.
pub(super) fn memory_bytes(state: &State) -> usize {
    let now = all_bytes(state);
    let may_come = state
        .contacts
        .as_ref()
        .filter(|contacts| !contacts.model.alone);
    // Every particle may get a few contacts.
    now + may_come.map_or(0, |contacts| 3 * (8 + 128) * contacts.materials.len())
}

/// Human-readable number of bytes.
pub(super) fn size_text(bytes: usize) -> String {
    match bytes as f64 {
        few if few < 1e3 => format!("{bytes} bytes"),
        some if some < 1e6 => format!("{} kB", significant(some * 1e-3, 3)),
        many => format!("{} MB", significant(many * 1e-6, 3)),
    }
}
