//! Disjoint sets (union-find), such as the pieces that bonds hold together.

/// Disjoint sets of the numbers from 0 on, with their sizes. The smaller set joins the larger one.
#[derive(Debug, Clone)]
pub struct DisjointSets {
    parent: Vec<u32>,
    size: Vec<u32>,
}

impl DisjointSets {
    /// `count` sets of one member each.
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
            size: vec![1; count],
        }
    }

    /// The member that stands for the set of `a`: the same for all its members until it is joined.
    pub fn root(&mut self, mut a: u32) -> u32 {
        while self.parent[a as usize] != a {
            self.parent[a as usize] = self.parent[self.parent[a as usize] as usize];
            a = self.parent[a as usize];
        }
        a
    }

    /// Joins the sets of two members; the sizes of the smaller and the larger before, or None if they
    /// were one already.
    pub fn join(&mut self, a: u32, b: u32) -> Option<(u32, u32)> {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return None;
        }
        let (small, large) = if self.size(a) < self.size(b) {
            (a, b)
        } else {
            (b, a)
        };
        let sizes = (self.size(small), self.size(large));
        self.parent[small as usize] = large;
        self.size[large as usize] += sizes.0;
        Some(sizes)
    }

    /// Number of members in the set that `root` stands for.
    pub fn size(&self, root: u32) -> u32 {
        self.size[root as usize]
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
