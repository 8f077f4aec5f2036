//! Disjoint sets whose members know whether they are turned relative to each other.

/// Disjoint sets over 0..n (union-find). Each member is turned, or not, relative to its set's root.
pub(super) struct Sets {
    parent: Vec<u32>,
    turned: Vec<bool>,
}

impl Sets {
    /// `count` sets of one member each.
    pub(super) fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
            turned: vec![false; count],
        }
    }

    /// The root of `member`'s set, and whether `member` is turned relative to it.
    pub(super) fn find(&mut self, member: u32) -> (u32, bool) {
        let mut root = member;
        let mut turned = false;
        while self.parent[root as usize] != root {
            turned ^= self.turned[root as usize];
            root = self.parent[root as usize];
        }
        let (mut next, mut turned_next) = (member, turned);
        while next != root {
            let (parent, step) = (self.parent[next as usize], self.turned[next as usize]);
            self.parent[next as usize] = root;
            self.turned[next as usize] = turned_next;
            turned_next ^= step;
            next = parent;
        }
        (root, turned)
    }

    /// Joins the sets of `a` and `b`, with `b` turned relative to `a` or not. The smallest member
    /// stays the root. False, and nothing done, when they are in one set already and stand the
    /// other way.
    pub(super) fn join(&mut self, a: u32, b: u32, turned: bool) -> bool {
        let (root_a, turned_a) = self.find(a);
        let (root_b, turned_b) = self.find(b);
        let turned_roots = turned_a ^ turned_b ^ turned;
        if root_a == root_b {
            return !turned_roots;
        }
        let (root, child) = (root_a.min(root_b), root_a.max(root_b));
        self.parent[child as usize] = root;
        self.turned[child as usize] = turned_roots;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_add_up_along_a_chain_and_a_contradiction_is_told() {
        let mut sets = Sets::new(6);
        assert!(sets.join(4, 5, true) && sets.join(3, 4, false) && sets.join(2, 3, true));
        assert_eq!(sets.find(5), (2, false));
        assert_eq!((sets.find(3), sets.find(4)), ((2, true), (2, true)));
        assert!(sets.join(5, 2, false) && !sets.join(5, 2, true));
        assert_eq!(sets.find(0), (0, false));
    }
}
