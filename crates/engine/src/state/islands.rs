//! Islands: pieces that have come near each other at any time, and the energy of each island.
//!
//! Energy passes from piece to piece only where they touch, so that an island keeps its own. Walls
//! that move, loads and supports join what they act on; walls at rest do no work.
//!
//! Losses in bonds and in bridges are known for the whole only. So the energy of an island with
//! bonds, or with bridges, shows at least what it has gained without a cause; what it has lost
//! without one is part of the error of the whole.

use std::collections::BTreeMap;

use dem_io::disjoint::{find, join};

use super::clusters::{Cluster, Clusters};

/// The islands of a scene with several pieces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Islands {
    /// Sets of walls, then of loads and supports together, then of pieces by their numbers. Empty:
    /// there is one piece, and no other can come.
    names: Vec<u32>,
    /// Number of walls.
    walls: usize,
    /// Energy that each piece has lost at walls, J. Length as `names`.
    lost_at_walls_j: Vec<f64>,
    /// The energy of each island at the last look, by its name at that time.
    books: BTreeMap<u32, IslandBook>,
    /// The largest relative error of an island that has become part of another.
    past: Option<IslandError>,
}

/// Energy of an island at one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct IslandSums {
    /// A number for its particles that are awake, free ones and those of clumps.
    pub(crate) key: u64,
    /// Kinetic and elastic energy, J.
    pub(crate) held_j: f64,
    /// Energy of adhesion and of liquid bridges, J.
    pub(crate) attraction_j: f64,
    /// Potential energy in gravity, J.
    pub(crate) height_j: f64,
    /// Lost in its contacts so far, J.
    pub(crate) lost_j: f64,
    /// Whether it may have lost energy otherwise.
    pub(crate) loses_more: bool,
    /// Work of walls, loads and supports on it so far, J.
    pub(crate) work_j: f64,
    /// Its bodies: numbers in [`crate::state::model::Model::bodies`].
    pub(crate) bodies: Vec<u32>,
    /// Number of its first piece that is there.
    pub(crate) piece: u32,
}

/// Energy of an island up to the last look.
#[derive(Debug, Clone, Default, PartialEq)]
struct IslandBook {
    key: u64,
    /// What it would have now without an error, with its losses and without the work on it, J.
    opening_j: f64,
    opening_height_j: f64,
    /// Error at the last look, J: below 0 also by losses that are not known, if it loses more.
    error_j: f64,
    loses_more: bool,
    largest: IslandError,
}

/// The largest error of the energy of an island.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct IslandError {
    /// Its bodies: numbers in [`crate::state::model::Model::bodies`].
    pub bodies: Vec<u32>,
    /// Number of its first piece.
    pub piece: u32,
    /// The magnitude of the error, J.
    pub error_j: f64,
    /// Its largest energy or work, each by itself, J.
    pub scale_j: f64,
}

impl IslandError {
    /// The error over the largest energy.
    pub fn ratio(&self) -> f64 {
        if self.scale_j > 0.0 {
            self.error_j / self.scale_j
        } else {
            0.0
        }
    }
}

impl Islands {
    /// Begins with this number of walls and these pieces, each by itself, if there are several or
    /// others may come.
    pub(crate) fn open(&mut self, walls: usize, clusters: &Clusters, may_come: bool) {
        if !may_come && clusters.living().nth(1).is_none() {
            return;
        }
        self.walls = walls;
        self.names = (0..self.first_piece()).collect();
        self.lost_at_walls_j = vec![0.0; self.names.len()];
        self.know(&clusters.history);
    }

    /// Whether there may be several.
    pub(crate) fn is_open(&self) -> bool {
        !self.names.is_empty()
    }

    /// Bytes of the arrays.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.names[..])
            + size_of_val(&self.lost_at_walls_j[..])
            + self.books.len() * size_of::<IslandBook>()
    }

    /// Number of sets.
    pub(crate) fn len(&self) -> usize {
        self.names.len()
    }

    /// The set of all loads and supports.
    pub(crate) fn acting(&self) -> u32 {
        self.walls as u32
    }

    fn first_piece(&self) -> u32 {
        self.walls as u32 + 1
    }

    /// Adds the pieces found since: fragments belong to what they were part of.
    pub(crate) fn know(&mut self, history: &[Cluster]) {
        let first = self.first_piece();
        let known = self.names.len() - first as usize;
        for (id, cluster) in (known as u32..).zip(&history[known.min(history.len())..]) {
            self.names.push(first + id);
            self.lost_at_walls_j.push(0.0);
            if let Some(parent) = cluster.parent {
                join(&mut self.names, first + id, first + parent);
            }
        }
    }

    /// Joins the pieces of these pairs of particles.
    pub(crate) fn join_pairs(
        &mut self,
        pairs: impl Iterator<Item = [u32; 2]>,
        clusters: &Clusters,
    ) {
        if !self.is_open() {
            return;
        }
        self.know(&clusters.history);
        let first = self.first_piece();
        for pair in pairs {
            let [a, b] = pair.map(|i| first + clusters.of_particle[i as usize]);
            if self.names[a as usize] != self.names[b as usize] {
                join(&mut self.names, a, b);
            }
        }
    }

    /// Joins the pieces of these particles with a wall of this number, or with what is
    /// [`Self::acting`].
    pub(crate) fn join_with(
        &mut self,
        set: u32,
        particles: impl Iterator<Item = u32>,
        clusters: &Clusters,
    ) {
        if !self.is_open() {
            return;
        }
        self.know(&clusters.history);
        let first = self.first_piece();
        for i in particles {
            let piece = first + clusters.of_particle[i as usize];
            if self.names[set as usize] != self.names[piece as usize] {
                join(&mut self.names, set, piece);
            }
        }
    }

    /// Records a loss of a piece at a wall, J.
    pub(crate) fn lose_at_walls(&mut self, piece: u32, lost_j: f64) {
        let at = (self.first_piece() + piece) as usize;
        if let Some(lost) = self.lost_at_walls_j.get_mut(at) {
            *lost += lost_j;
        }
    }

    /// The losses of all pieces at walls, J, each with its island.
    pub(crate) fn losses_at_walls(&mut self) -> Vec<(u32, f64)> {
        let lost = self.lost_at_walls_j.iter().zip(0..);
        let lost = lost.filter(|(lost_j, _)| **lost_j != 0.0);
        lost.map(|(lost_j, at)| (find(&mut self.names, at), *lost_j))
            .collect()
    }

    /// The island of a piece.
    pub(crate) fn of_piece(&mut self, id: u32) -> u32 {
        let first = self.first_piece();
        find(&mut self.names, first + id)
    }

    /// The island of a wall, or of what is [`Self::acting`].
    pub(crate) fn of_set(&mut self, set: u32) -> u32 {
        find(&mut self.names, set)
    }

    /// Looks at the energies of all islands, by name. `floors_j`: energies below which all is
    /// rounding, needed where an island is new or has other particles.
    pub(crate) fn look(
        &mut self,
        sums: Vec<IslandSums>,
        floors_j: impl FnOnce(&mut Self) -> Vec<f64>,
    ) {
        self.join_books();
        let is_known = |name: usize, key: u64| {
            let book = self.books.get(&(name as u32));
            book.is_some_and(|book| book.key == key)
        };
        let any_new = (0..)
            .zip(&sums)
            .any(|(name, now)| now.key != 0 && !is_known(name, now.key));
        let floors_j = if any_new { floors_j(self) } else { Vec::new() };
        for (name, now) in (0..).zip(sums) {
            if now.key == 0 {
                // Nothing awake: what a wall has done, or what slept, is no error of what comes.
                if now.own_j() != 0.0 || self.books.contains_key(&name) {
                    self.books.entry(name).or_default().begin_anew(&now);
                }
                continue;
            }
            let floor_j = floors_j.get(name as usize).copied().unwrap_or(0.0);
            self.books.entry(name).or_default().note(now, floor_j);
        }
    }

    /// Joins the books of islands that have met since the last look.
    fn join_books(&mut self) {
        for (name, book) in std::mem::take(&mut self.books) {
            let name = find(&mut self.names, name);
            let Some(other) = self.books.get_mut(&name) else {
                self.books.insert(name, book);
                continue;
            };
            let errors = [&other.largest, &book.largest].into_iter();
            let largest = (errors.chain(&self.past)).max_by(|a, b| a.ratio().total_cmp(&b.ratio()));
            self.past = largest.cloned();
            other.join(&book);
        }
    }

    /// The largest relative error of an island so far.
    pub fn largest(&self) -> Option<&IslandError> {
        let errors = self.books.values().map(|book| &book.largest);
        let errors = errors.chain(&self.past);
        errors.max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
    }
}

impl IslandSums {
    /// Its energy, with its losses and without the work on it, J.
    fn own_j(&self) -> f64 {
        self.held_j + self.attraction_j + self.height_j + self.lost_j - self.work_j
    }
}

impl IslandBook {
    /// Begins anew with other particles. What came and went brought and took energy: the error
    /// until now stays.
    fn begin_anew(&mut self, now: &IslandSums) {
        self.key = now.key;
        if self.loses_more {
            self.error_j = self.error_j.max(0.0);
        }
        self.opening_j = now.own_j() - self.error_j;
        self.opening_height_j = now.height_j;
    }

    /// Notes the energy at a look.
    fn note(&mut self, now: IslandSums, floor_j: f64) {
        if now.key == self.key {
            self.error_j = now.own_j() - self.opening_j;
        } else {
            self.begin_anew(&now);
        }
        self.loses_more = now.loses_more;
        let fallen_j = (now.height_j - self.opening_height_j).abs();
        let energies = [now.held_j, now.attraction_j.abs(), fallen_j];
        let energies = energies
            .into_iter()
            .chain([now.lost_j, now.work_j.abs(), floor_j]);
        let largest = &mut self.largest;
        largest.scale_j = energies.fold(largest.scale_j, f64::max);
        let error_j = match now.loses_more {
            true => self.error_j,
            false => self.error_j.abs(),
        };
        largest.error_j = largest.error_j.max(error_j);
        (largest.bodies, largest.piece) = (now.bodies, now.piece);
    }

    /// Adds the book of an island that it has met.
    fn join(&mut self, other: &Self) {
        self.key = self.key.wrapping_add(other.key);
        self.opening_j += other.opening_j;
        self.opening_height_j += other.opening_height_j;
        self.error_j += other.error_j;
        self.loses_more |= other.loses_more;
        let (largest, more) = (&mut self.largest, &other.largest);
        largest.error_j = 0.0;
        largest.scale_j = largest.scale_j.max(more.scale_j);
    }
}
