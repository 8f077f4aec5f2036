//! Input of the contact computation.

use crate::state::contacts::Contacts;
use crate::state::particles::{Motion, Pose};

/// Input common to all partitions.
pub(super) struct StepInput<'a> {
    pub(super) contacts: &'a Contacts,
    pub(super) poses: &'a [Pose],
    pub(super) motions: &'a [Motion],
    /// For each particle whether it is not stepped now. Empty: all are.
    pub(super) idle: &'a [bool],
    /// Whether all pairs are checked, not only those that were close.
    pub(super) checks_all: bool,
    pub(super) dt: f64,
}

impl StepInput<'_> {
    /// Whether an end of a pair is not stepped now.
    pub(super) fn leaves_out(&self, pair: [u32; 2]) -> bool {
        !self.idle.is_empty() && pair.iter().any(|&i| self.idle[i as usize])
    }

    /// For each of up to eight pairs a bit, lowest first: whether both ends are stepped now.
    pub(super) fn stepped(&self, pairs: &[[u32; 2]]) -> u8 {
        if self.idle.is_empty() {
            return u8::MAX;
        }
        let stepped = pairs.iter().map(|&pair| u8::from(!self.leaves_out(pair)));
        (0..)
            .zip(stepped)
            .fold(0, |bits, (lane, one)| bits | one << lane)
    }
}
