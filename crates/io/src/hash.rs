//! FNV-1a, 64 bit (<http://www.isthe.com/chongo/tech/comp/fnv/>).

/// Hash of no bytes.
const START: u64 = 0xcbf2_9ce4_8422_2325;

/// Hash of these bytes.
pub fn fnv1a(bytes: &[u8]) -> u64 {
    fnv1a_of_parts(&[bytes])
}

/// Hash of the bytes of these parts, one after the other.
pub(crate) fn fnv1a_of_parts(parts: &[&[u8]]) -> u64 {
    parts
        .iter()
        .flat_map(|part| part.iter())
        .fold(START, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
        })
}

/// Hash of the bytes of a file. None: it cannot be read.
pub fn file_hash(path: &std::path::Path) -> Option<u64> {
    std::fs::read(path).ok().map(|bytes| fnv1a(&bytes))
}
