//! Disjoint sets (union-find) in a plain array: each element names another one of its set, and the
//! smallest names itself.

/// The smallest element of the set of `x`.
pub(crate) fn find(names: &mut [u32], mut x: u32) -> u32 {
    while names[x as usize] != x {
        let next = names[x as usize];
        names[x as usize] = names[next as usize];
        x = names[x as usize];
    }
    x
}

/// Makes one set of the sets of `a` and `b`.
pub(crate) fn join(names: &mut [u32], a: u32, b: u32) {
    let a = find(names, a);
    let b = find(names, b);
    names[a.max(b) as usize] = a.min(b);
}
