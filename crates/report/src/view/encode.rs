//! Numbers of many frames as text in a page: changes from frame to frame, compressed.
//!
//! A track is one quantity of all spheres, bonds or corners, frame after frame. A frame whose
//! values are those of the frame before is not stored again. Otherwise its values are differences:
//! from the frame before if that has as many, else from the value before. Of the differences come
//! first all lowest bytes, then all next ones: the high bytes are mostly zero, and vanish when
//! compressed. `viewer.js` reads it back.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;

/// A quantity over all frames.
#[derive(Debug, Clone, Serialize, PartialEq, Eq)]
pub(crate) struct Track {
    name: &'static str,
    /// Bytes of a value: 1, 2 or 4.
    bytes: usize,
    /// Number of values of each frame; -1: those of the frame before.
    counts: Vec<i64>,
    #[serde(skip)]
    last: Vec<i32>,
    #[serde(skip)]
    data: Vec<u8>,
}

impl Track {
    pub(crate) fn new(name: &'static str, bytes: usize) -> Self {
        Self {
            name,
            bytes,
            counts: Vec::new(),
            last: Vec::new(),
            data: Vec::new(),
        }
    }

    /// Appends the values of the next frame; of more than `bytes` the lowest are kept.
    pub(crate) fn push(&mut self, values: Vec<i32>) {
        if !self.counts.is_empty() && values == self.last {
            self.counts.push(-1);
            return;
        }
        let follows = values.len() == self.last.len();
        let before = |i: usize| match i.checked_sub(1) {
            _ if follows => self.last[i],
            Some(previous) => values[previous],
            None => 0,
        };
        let differences = (0..values.len()).map(|i| values[i].wrapping_sub(before(i)));
        let differences: Vec<[u8; 4]> = differences.map(i32::to_le_bytes).collect();
        for plane in 0..self.bytes {
            self.data
                .extend(differences.iter().map(|bytes| bytes[plane]));
        }
        self.counts.push(values.len() as i64);
        self.last = values;
    }
}

/// All tracks one after the other, compressed (zlib), as base64.
pub(crate) fn encoded<'a>(tracks: impl Iterator<Item = &'a Track>) -> std::io::Result<String> {
    let mut compressed = ZlibEncoder::new(Vec::new(), Compression::new(6));
    for track in tracks {
        compressed.write_all(&track.data)?;
    }
    Ok(STANDARD.encode(compressed.finish()?))
}

/// A value as a part of `highest` in whole steps, 0 to `steps`. Values that are not numbers are 0.
pub(crate) fn level(value: f64, highest: f64, steps: i32) -> i32 {
    let part = value / highest;
    if part > 0.0 {
        (part.min(1.0) * f64::from(steps)).round() as i32
    } else {
        0
    }
}
