//! Depths whose memory later pictures use again: to touch new memory costs as much as to draw.

use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

/// Memory of earlier pictures, at most [`MOST_SPARE`] vectors of any length.
static SPARE: Mutex<Vec<Vec<f32>>> = Mutex::new(Vec::new());

/// As many as one picture needs.
const MOST_SPARE: usize = 32;

/// Depths, px. A vector whose memory is kept when this is dropped.
pub(super) struct Depths(Vec<f32>);

impl Depths {
    /// So many of them, all infinitely far away.
    pub(super) fn new(length: usize) -> Self {
        let mut depths = spare_for(length).unwrap_or_default();
        depths.clear();
        depths.resize(length, f32::NEG_INFINITY);
        Self(depths)
    }
}

/// Memory of about that length: large memory is not spent on few depths.
fn spare_for(length: usize) -> Option<Vec<f32>> {
    let mut spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner);
    let is_like = |one: &Vec<f32>| length / 4 <= one.capacity() && one.capacity() / 4 <= length;
    let place = spare.iter().rposition(is_like)?;
    Some(spare.swap_remove(place))
}

impl Drop for Depths {
    fn drop(&mut self) {
        let mut spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner);
        if spare.len() < MOST_SPARE {
            spare.push(std::mem::take(&mut self.0));
        }
    }
}

impl Deref for Depths {
    type Target = [f32];

    fn deref(&self) -> &[f32] {
        &self.0
    }
}

impl DerefMut for Depths {
    fn deref_mut(&mut self) -> &mut [f32] {
        &mut self.0
    }
}
