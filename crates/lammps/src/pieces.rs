//! The particles and bonds of an imported run as the state of a simulation: its clusters are found
//! as those of a run of our own.

use std::collections::BTreeMap;
use std::ops::Range;

use dem_engine::state::State;
use dem_engine::state::bonds::Bonds;
use dem_engine::state::clusters::{Clusters, Split};
use dem_engine::state::particles::Particles;
use dem_physics::bond::stiffness::Stiffness;

use super::breaks::Break;
use super::dump::Section;
use super::exported::Exported;
use super::files::Manifest;

/// What joins particles here: only whether it is broken matters.
const JOINED: Stiffness = Stiffness {
    normal: 1.0,
    shear: 0.0,
    torsion: 0.0,
    bending: 0.0,
    levers_m: [0.5; 2],
};

/// The state of an imported run, whose particles have the numbers of [`Exported`].
pub(super) struct Pieces {
    /// Particles, bonds, clusters and bodies. Rigid clumps are held together by further bonds.
    pub state: State,
    /// For each bond of the export whether it is broken.
    pub is_broken: Vec<bool>,
    /// For each bond of the export its number in the state.
    in_state: Vec<u32>,
}

impl Pieces {
    /// Those of the start.
    pub(super) fn new(manifest: &Manifest, exported: &Exported) -> Self {
        let own = (0..).zip(&exported.bonds);
        let own = own.map(|(at, [a, b])| ([*a.min(b), *a.max(b)], Some(at)));
        let all = 0..exported.ids.len();
        let held = holding(manifest, exported, all.clone()).map(|ends| (ends, None));
        let mut pairs: Vec<([u32; 2], Option<usize>)> = own.chain(held).collect();
        pairs.sort_unstable();
        let (mut bonds, mut in_state) = (Bonds::default(), vec![0; exported.bonds.len()]);
        for (ends, of) in pairs {
            if let Some(of) = of {
                in_state[of] = bonds.len() as u32;
            }
            bonds.push(ends, [1.0, 0.0, 0.0], 1.0, &JOINED, 0);
        }
        let mut particles = Particles::default();
        add_spheres(&mut particles, exported, all.clone());
        let mut clusters = Clusters::new(particles.len(), &bonds);
        set_bodies(&mut clusters, manifest, exported, all);
        let step_s = manifest.end_s / manifest.steps as f64;
        let mut state = State::new(particles, bonds, step_s, 1);
        state.clusters = Some(clusters);
        state.model.bodies = manifest.bodies.clone();
        Self {
            state,
            is_broken: vec![false; exported.bonds.len()],
            in_state,
        }
    }

    /// Adds the particles that inlets have fed since.
    pub(super) fn add_fed(&mut self, manifest: &Manifest, exported: &Exported, time_s: f64) {
        let new = self.state.particles.len()..exported.ids.len();
        if new.is_empty() {
            return;
        }
        add_spheres(&mut self.state.particles, exported, new.clone());
        for ends in holding(manifest, exported, new.clone()) {
            self.state
                .bonds
                .push(ends, [1.0, 0.0, 0.0], 1.0, &JOINED, 0);
        }
        if let Some(clusters) = &mut self.state.clusters {
            clusters.extend(time_s, new.end, &self.state.bonds);
            set_bodies(clusters, manifest, exported, new);
        }
    }

    /// Breaks bonds, all in the same step. Returns the clusters that are in pieces now.
    pub(super) fn break_bonds(&mut self, breaks: &[Break], step_s: f64) -> Vec<Split> {
        let state = &mut self.state;
        let broken: Vec<u32> = breaks.iter().map(|one| self.in_state[one.bond]).collect();
        for (one, at) in breaks.iter().zip(&broken) {
            self.is_broken[one.bond] = true;
            state.bonds.set_broken(*at as usize);
        }
        state.broken_count += broken.len() as u64;
        let Some(clusters) = &mut state.clusters else {
            return Vec::new();
        };
        let time_s = breaks.first().map_or(0.0, |one| one.step as f64 * step_s);
        let damaged = clusters.damaged_by(&broken, &state.bonds);
        clusters.update(time_s, &damaged, &state.bonds)
    }

    /// Moves the particles to where a frame has them. `columns`: of place, velocity and spin;
    /// `numbers`: for each row its particle.
    pub(super) fn move_to(&mut self, section: &Section, columns: &[usize; 9], numbers: &[u32]) {
        let particles = &mut self.state.particles;
        for (row, &i) in section.rows.iter().zip(numbers) {
            let [x, y, z, vx, vy, vz, wx, wy, wz] = columns.map(|column| row[column]);
            particles.poses[i as usize].put_at([x, y, z]);
            let motion = &mut particles.motions[i as usize];
            motion.velocity_m_s = [vx, vy, vz];
            motion.spin_rad_s = [wx, wy, wz];
        }
        self.state.steps = section.step;
    }
}

/// Adds some spheres of an export, at the places of the start or, if they are fed, anywhere.
fn add_spheres(particles: &mut Particles, exported: &Exported, some: Range<usize>) {
    for i in some {
        let place_m = exported.places_m.get(i).copied().unwrap_or_default();
        particles.push_sphere(place_m, exported.radii_m[i], exported.densities_kg_m3[i]);
    }
}

/// Pairs of particles that hold the rigid clumps among these together.
fn holding(
    manifest: &Manifest,
    exported: &Exported,
    some: Range<usize>,
) -> impl Iterator<Item = [u32; 2]> {
    let mut last_of: BTreeMap<u32, u32> = BTreeMap::new();
    some.filter_map(move |i| {
        let molecule = exported.molecules[i];
        let is_clump = manifest.is_clump[molecule as usize - 1];
        let last = is_clump.then(|| last_of.insert(molecule, i as u32));
        last.flatten().map(|last| [last, i as u32])
    })
}

fn set_bodies(
    clusters: &mut Clusters,
    manifest: &Manifest,
    exported: &Exported,
    some: Range<usize>,
) {
    for i in some {
        let molecule = exported.molecules[i] as usize;
        clusters.set_body(&[i as u32], manifest.body_of_molecule[molecule - 1]);
    }
}
