//! Input of the contact computation.

use crate::state::contacts::Contacts;
use crate::state::particles::{Motion, Pose};

/// Input common to all partitions.
pub(super) struct StepInput<'a> {
    pub(super) contacts: &'a Contacts,
    pub(super) poses: &'a [Pose],
    pub(super) motions: &'a [Motion],
    /// Whether all pairs are checked, not only those that were close.
    pub(super) checks_all: bool,
    pub(super) dt: f64,
}
