//! Particles by chunks: what one task handles, and sums that do not depend on the number of
//! threads.

use std::ops::Range;

pub use crate::state::sleep::mask::CHUNK;
use crate::threads::for_each;

/// The numbers of the chunks of `count` particles.
pub(crate) fn chunks_of(count: usize) -> Range<usize> {
    0..count.div_ceil(CHUNK)
}

/// The particles of a chunk, of `count` in all.
pub(crate) fn chunk_of(chunk: usize, count: usize) -> Range<usize> {
    nth_range(chunk, CHUNK, count)
}

/// The `n`th of the ranges of `each` numbers that 0..count is divided into.
pub(crate) fn nth_range(n: usize, each: usize, count: usize) -> Range<usize> {
    n * each..((n + 1) * each).min(count)
}

/// Does `count` tasks, each with a buffer of its own, and returns those buffers. They are kept for
/// their memory: each still holds what an earlier task left in it, which `work` is to clear.
pub(crate) fn in_tasks<T: Default + Send>(
    count: usize,
    buffers: &mut Vec<T>,
    work: impl Fn(usize, &mut T) + Sync,
) -> &[T] {
    if buffers.len() < count {
        buffers.resize_with(count, T::default);
    }
    let own = &mut buffers[..count];
    for_each(own.iter_mut().enumerate(), |(task, buffer)| {
        work(task, buffer);
    });
    own
}

/// The sum of `term` over 0..count, in an order that does not depend on the number of threads.
pub(crate) fn ordered_sum(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let [sum] = ordered_sums(count, |i| [term(i)]);
    sum
}

/// Largest number of partial sums that are found at the same time.
const PARTS: usize = 64;

/// Sums of several terms over 0..count, in an order that does not depend on the number of threads.
pub fn ordered_sums<const N: usize>(
    count: usize,
    terms: impl Fn(usize) -> [f64; N] + Sync,
) -> [f64; N] {
    sums_of_chunks(count, |range| {
        range.fold([0.0; N], |sums, i| add(sums, terms(i)))
    })
}

/// As [`ordered_sums`], where the caller sums each range of up to [`CHUNK`] itself.
pub(crate) fn sums_of_chunks<const N: usize>(
    count: usize,
    sums_over: impl Fn(Range<usize>) -> [f64; N] + Sync,
) -> [f64; N] {
    let of_chunk = |chunk: usize| sums_over(chunk_of(chunk, count));
    if count <= CHUNK {
        return of_chunk(0);
    }
    let chunks = count.div_ceil(CHUNK);
    let each = chunks.div_ceil(PARTS);
    let mut parts = [[0.0; N]; PARTS];
    let used = parts[..chunks.div_ceil(each)].iter_mut().enumerate();
    for_each(used, |(part, sums)| {
        let own = part * each..chunks.min((part + 1) * each);
        *sums = own.map(of_chunk).fold([0.0; N], add);
    });
    parts.into_iter().fold([0.0; N], add)
}

/// Sums of two lists, number by number.
pub(super) fn add<const N: usize>(mut sums: [f64; N], terms: [f64; N]) -> [f64; N] {
    for (sum, term) in sums.iter_mut().zip(terms) {
        *sum += term;
    }
    sums
}
