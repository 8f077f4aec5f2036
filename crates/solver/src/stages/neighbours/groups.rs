//! Particles by cluster.

/// Clusters with fewer particles are small.
const SMALL: usize = 16;

/// The particles of each cluster.
pub(super) struct Groups {
    /// Particles, sorted by cluster, then by number.
    members: Vec<u32>,
    /// Start of each cluster in `members`, followed by the total number.
    starts: Vec<u32>,
}

impl Groups {
    /// `clusters`: one for each particle.
    pub(super) fn new(clusters: &[u32]) -> Self {
        let count = clusters.iter().max().map_or(0, |&last| last as usize + 1);
        let mut starts = vec![0_u32; count + 1];
        for &cluster in clusters {
            starts[cluster as usize + 1] += 1;
        }
        for cluster in 0..count {
            starts[cluster + 1] += starts[cluster];
        }
        let mut next = starts.clone();
        let mut members = vec![0; clusters.len()];
        for (i, &cluster) in (0..).zip(clusters) {
            let place = &mut next[cluster as usize];
            members[*place as usize] = i;
            *place += 1;
        }
        Self { members, starts }
    }

    /// All clusters, some of which may have no particle.
    pub(super) fn all(&self) -> std::ops::Range<u32> {
        0..self.starts.len() as u32 - 1
    }

    /// The particles of a cluster, ascending.
    pub(super) fn members(&self, cluster: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|k| self.starts[cluster as usize + k] as usize);
        &self.members[start..end]
    }

    pub(super) fn is_large(&self, cluster: u32) -> bool {
        self.members(cluster).len() >= SMALL
    }
}
