//! FNV-1a, 64 bit (<http://www.isthe.com/chongo/tech/comp/fnv/>).

use std::io;

/// Hash of the bytes written to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fnv1a(pub u64);

impl Default for Fnv1a {
    /// Hash of no bytes.
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv1a {
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

impl io::Write for Fnv1a {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.add(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Hash of these bytes.
pub(crate) fn fnv1a(bytes: &[u8]) -> u64 {
    fnv1a_of_parts(&[bytes])
}

/// Hash of the bytes of these parts, one after the other.
pub fn fnv1a_of_parts(parts: &[&[u8]]) -> u64 {
    let mut hash = Fnv1a::default();
    parts.iter().for_each(|part| hash.add(part));
    hash.0
}

/// Hash of the bytes of a file. None if it cannot be read.
pub fn file_hash(path: &std::path::Path) -> Option<u64> {
    std::fs::read(path).ok().map(|bytes| fnv1a(&bytes))
}
