//! Disjoint sets (union-find), such as the pieces connected by bonds, in a plain array: each
//! element refers to another one of its set, and the smallest to itself.

/// The smallest element of the set of `x`. Halves the path to it.
pub fn find(names: &mut [u32], mut x: u32) -> u32 {
    while names[x as usize] != x {
        let next = names[x as usize];
        names[x as usize] = names[next as usize];
        x = names[x as usize];
    }
    x
}

/// Merges the sets of `a` and `b`. Returns their previous smallest elements, the smaller first;
/// None if they were already one set.
pub fn join(names: &mut [u32], a: u32, b: u32) -> Option<[u32; 2]> {
    let (a, b) = (find(names, a), find(names, b));
    if a == b {
        return None;
    }
    names[a.max(b) as usize] = a.min(b);
    Some([a.min(b), a.max(b)])
}

/// Disjoint sets of the numbers from 0 on, with their sizes.
#[derive(Debug, Clone)]
pub struct DisjointSets {
    names: Vec<u32>,
    sizes: Vec<u32>,
}

impl DisjointSets {
    /// `count` sets of one member each.
    pub fn new(count: usize) -> Self {
        Self {
            names: (0..count as u32).collect(),
            sizes: vec![1; count],
        }
    }

    /// The smallest member of the set of `a`.
    pub fn root(&mut self, a: u32) -> u32 {
        find(&mut self.names, a)
    }

    /// Joins the sets of two members. Returns the previous sizes of the smaller and the larger set,
    /// or None if they were already one.
    pub fn join(&mut self, a: u32, b: u32) -> Option<(u32, u32)> {
        let [root, joined] = join(&mut self.names, a, b)?;
        let sizes = [root, joined].map(|root| self.size(root));
        self.sizes[root as usize] = sizes[0] + sizes[1];
        Some((sizes[0].min(sizes[1]), sizes[0].max(sizes[1])))
    }

    /// Number of members in the set represented by `root`.
    pub fn size(&self, root: u32) -> u32 {
        self.sizes[root as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_join_tells_both_sizes_and_members_of_one_set_have_one_root() {
        let mut sets = DisjointSets::new(5);
        assert_eq!(sets.join(0, 1), Some((1, 1)));
        assert_eq!(sets.join(3, 1), Some((1, 2)));
        assert_eq!(sets.join(0, 3), None);
        let root = sets.root(3);
        assert_eq!(
            (sets.root(0), sets.root(1), sets.size(root)),
            (root, root, 3)
        );
        assert_eq!(sets.root(4), 4);
    }
}
