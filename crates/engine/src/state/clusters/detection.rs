//! Detection: which particles are joined by bonds that are not broken.
//!
//! Algorithm 2 of Platzer 2022 is not used as printed: it reads the first partner of a bond twice,
//! and a bond between two clusters already found adds a particle to one of them instead of joining
//! the two. Here sets are disjoint by construction (union-find).
//!
//! Only clusters in which a bond has broken since the last search are searched, at a cost that
//! depends only on the number of their particles and bonds.

use serde::{Deserialize, Serialize};

use crate::state::bonds::Bonds;
use crate::state::partitions::first_bonds;
use dem_io::disjoint::{find, join};

/// A present or former cluster.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cluster {
    /// The cluster that it broke off from; none: it was there from the start or was added later.
    pub parent: Option<u32>,
    /// Its body: number in [`crate::state::model::Model::bodies`].
    pub body: u32,
    /// Time at which it was found, s.
    pub created_s: f64,
    /// Time of its last broken bond, s, or at which it was found or became bonded if that is later.
    pub unbroken_since_s: f64,
    /// Time at which it was found in pieces, s; none: it is intact.
    pub ended_s: Option<f64>,
    /// Number of its particles.
    pub particles: u32,
}

/// A cluster found in pieces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Split {
    /// The former cluster.
    pub parent: u32,
    /// Its fragments, in the order of their smallest particles.
    pub children: Vec<u32>,
}

/// The clusters of a scene.
///
/// A number stands for the same particles throughout the run and is never reused: a cluster found
/// intact keeps its number; one found in pieces ends, and every fragment, even the largest, gets a
/// new number.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Clusters {
    /// The cluster of each particle.
    pub of_particle: Vec<u32>,
    /// All clusters, by number.
    pub history: Vec<Cluster>,
    /// Particles, sorted by cluster, then by number.
    #[serde(skip)]
    members: Vec<u32>,
    /// Start of each cluster in `members`.
    #[serde(skip)]
    starts: Vec<u32>,
    /// Particle i is the first end of the bonds `first_bonds[i]..first_bonds[i + 1]`.
    #[serde(skip)]
    first_bonds: Vec<usize>,
    /// Sets that are being joined; between searches, each particle is its own set.
    #[serde(skip)]
    names: Vec<u32>,
    /// Particles visited in all searches so far.
    pub visited: u64,
}

impl Clusters {
    /// Bytes of the arrays.
    pub fn bytes(&self) -> usize {
        let of_particles = [&self.of_particle, &self.members, &self.starts, &self.names];
        of_particles
            .map(|list| size_of_val(&list[..]))
            .iter()
            .sum::<usize>()
            + size_of_val(&self.history[..])
            + size_of_val(&self.first_bonds[..])
    }

    /// The clusters of this number of particles with these bonds, some of which may be broken, at
    /// time 0.
    pub fn new(particles: usize, bonds: &Bonds) -> Self {
        let mut clusters = Self::default();
        clusters.extend(0.0, particles, bonds);
        clusters
    }

    /// Finds the clusters of particles added since, for a scene that now has this number of
    /// particles and these bonds. New bonds join new particles only.
    pub fn extend(&mut self, time_s: f64, particles: usize, bonds: &Bonds) {
        let known = self.of_particle.len();
        self.first_bonds = first_bonds(bonds, particles);
        self.of_particle.resize(particles, u32::MAX);
        let new = known as u32..particles as u32;
        self.members.extend(new.clone());
        self.names.extend(new);
        self.join_bonded(known..particles, bonds);
        self.number(None, time_s, known..particles);
    }

    /// Adds a cluster without bonds, whose particles come after all others.
    pub(crate) fn append(&mut self, cluster: Cluster) {
        let known = self.of_particle.len() as u32;
        let all = known + cluster.particles;
        self.of_particle
            .resize(all as usize, self.history.len() as u32);
        self.starts.push(known);
        self.members.extend(known..all);
        self.names.extend(known..all);
        let bonds = self.first_bonds.last().copied().unwrap_or(0);
        self.first_bonds.resize(all as usize + 1, bonds);
        self.history.push(cluster);
    }

    /// Sets the body of the clusters of these particles.
    pub fn set_body(&mut self, particles: &[u32], body: u32) {
        for &particle in particles {
            let id = self.of_particle[particle as usize];
            self.history[id as usize].body = body;
        }
    }

    /// Rebuilds the remaining data from the cluster of each particle, all clusters and these bonds.
    /// None if the three do not belong together.
    pub fn rebuild(&mut self, bonds: &Bonds) -> Option<()> {
        let (of_particle, history) = (&self.of_particle, &self.history);
        let mut counts = vec![0_u32; history.len()];
        for id in of_particle {
            *counts.get_mut(*id as usize)? += 1;
        }
        let mut starts = Vec::with_capacity(history.len());
        let mut end = 0;
        for (cluster, count) in history.iter().zip(&counts) {
            let wanted = if cluster.ended_s.is_some() {
                0
            } else {
                cluster.particles
            };
            if *count != wanted {
                return None;
            }
            starts.push(end);
            end += count;
        }
        let mut members: Vec<u32> = (0..of_particle.len() as u32).collect();
        members.sort_by_key(|p| of_particle[*p as usize]);
        let particles = of_particle.len();
        self.members = members;
        self.starts = starts;
        self.first_bonds = first_bonds(bonds, particles);
        self.names = (0..particles as u32).collect();
        Some(())
    }

    /// Particles of a cluster, in order. Empty for one that has ended.
    pub fn members(&self, id: u32) -> &[u32] {
        match self.history.get(id as usize) {
            Some(cluster) if cluster.ended_s.is_none() => {
                let start = self.starts[id as usize] as usize;
                &self.members[start..start + cluster.particles as usize]
            }
            _ => &[],
        }
    }

    /// Numbers of the intact clusters, in order.
    pub fn living(&self) -> impl Iterator<Item = u32> {
        let all = self.oldest()..self.history.len() as u32;
        all.filter(|id| self.history[*id as usize].ended_s.is_none())
    }

    /// The smallest number of an intact cluster: in a process, most have ended long ago.
    pub(crate) fn oldest(&self) -> u32 {
        let all = self.of_particle.iter().copied();
        all.min().unwrap_or(self.history.len() as u32)
    }

    /// Whether two particles belong to the same cluster.
    #[inline(always)]
    pub(crate) fn is_within(&self, [a, b]: [u32; 2]) -> bool {
        self.of_particle[a as usize] == self.of_particle[b as usize]
    }

    /// Whether a bond that is not broken joins two particles.
    pub(crate) fn are_bonded(&self, [a, b]: [u32; 2], bonds: &Bonds) -> bool {
        let joins = |first: u32, second: u32| {
            let [from, to] = [0, 1].map(|k| self.first_bonds[first as usize + k]);
            (from..to).any(|at| bonds.ends[at][1] == second && !bonds.is_broken(at))
        };
        joins(a, b) || joins(b, a)
    }

    /// The clusters that these broken bonds belonged to, in order, each once.
    pub fn damaged_by(&self, broken: &[u32], bonds: &Bonds) -> Vec<u32> {
        let ends = broken.iter().flat_map(|b| bonds.ends[*b as usize]);
        let mut ids: Vec<u32> = ends.map(|end| self.of_particle[end as usize]).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }

    /// Searches the clusters with these numbers, each once; skips those that have ended. Returns
    /// the ones found in pieces, in order.
    pub fn update(&mut self, time_s: f64, damaged: &[u32], bonds: &Bonds) -> Vec<Split> {
        let mut ids = damaged.to_vec();
        ids.sort_unstable();
        ids.dedup();
        let mut splits = Vec::new();
        for parent in ids {
            let count = self.members(parent).len();
            if count == 0 {
                continue;
            }
            let start = self.starts[parent as usize] as usize;
            self.join_bonded(start..start + count, bonds);
            let children = self.number(Some(parent), time_s, start..start + count);
            if children.is_empty() {
                self.history[parent as usize].unbroken_since_s = time_s;
            } else {
                splits.push(Split { parent, children });
            }
        }
        splits
    }

    /// Joins the sets of bonded particles in `members[range]`.
    fn join_bonded(&mut self, range: std::ops::Range<usize>, bonds: &Bonds) {
        self.visited += range.len() as u64;
        for &p in &self.members[range] {
            let p = p as usize;
            for bond in self.first_bonds[p]..self.first_bonds[p + 1] {
                let [a, b] = bonds.ends[bond];
                let are_searched = self.of_particle[a as usize] == self.of_particle[b as usize];
                if are_searched && !bonds.is_broken(bond) {
                    join(&mut self.names, a, b);
                }
            }
        }
    }

    /// Makes a cluster of each set in `members[range]`, and resets the sets. Makes none if they are
    /// one set and have a parent: that cluster is intact.
    fn number(
        &mut self,
        parent: Option<u32>,
        time_s: f64,
        range: std::ops::Range<usize>,
    ) -> Vec<u32> {
        let members: Vec<u32> = self.members[range.clone()].to_vec();
        let roots: Vec<u32> = members.iter().map(|p| find(&mut self.names, *p)).collect();
        for p in &members {
            self.names[*p as usize] = *p;
        }
        if parent.is_some() && roots.iter().all(|root| *root == roots[0]) {
            return Vec::new();
        }
        let body = parent.map_or(0, |parent| self.history[parent as usize].body);
        let first = self.history.len();
        for (p, root) in members.iter().zip(&roots) {
            // The name of a set is its smallest particle, which comes first.
            if p == root {
                self.of_particle[*p as usize] = self.history.len() as u32;
                self.history.push(Cluster {
                    parent,
                    body,
                    created_s: time_s,
                    unbroken_since_s: time_s,
                    ended_s: None,
                    particles: 0,
                });
            }
            let id = self.of_particle[*root as usize];
            self.of_particle[*p as usize] = id;
            self.history[id as usize].particles += 1;
        }
        let mut end = range.start as u32;
        for cluster in &self.history[first..] {
            self.starts.push(end);
            end += cluster.particles;
        }
        let mut next = self.starts[first..].to_vec();
        for p in members {
            let place = &mut next[self.of_particle[p as usize] as usize - first];
            self.members[*place as usize] = p;
            *place += 1;
        }
        if let Some(parent) = parent {
            self.history[parent as usize].ended_s = Some(time_s);
        }
        (first as u32..self.history.len() as u32).collect()
    }
}
