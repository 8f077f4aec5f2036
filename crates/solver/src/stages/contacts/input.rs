//! What contacts are computed from.

use crate::state::contacts::Contacts;
use crate::state::particles::{Motion, Pose};

/// What all partitions look at.
pub(super) struct StepInput<'a> {
    pub(super) contacts: &'a Contacts,
    pub(super) poses: &'a [Pose],
    pub(super) motions: &'a [Motion],
    /// Whether all pairs are looked at, not only those that were close.
    pub(super) checks_all: bool,
    pub(super) dt: f64,
}
