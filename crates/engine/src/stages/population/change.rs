//! Adds, removes and replaces bodies. All changes of one call are made at once, and everything
//! indexed by particle is then renumbered.
//!
//! Done between a kick and the drift after it: positions are those of the present time, velocities
//! those half a step later.

use std::ops::Range;
use std::sync::Arc;

use crate::stages::clumps::motion::place_all;
use crate::stages::contacts::bridges::bridges_energy_j;
use crate::stages::contacts::forces::elastic_energy_j;
use crate::stages::motion::sleep::{count_sleepers, prepare_change};
use crate::stages::population::append::arrived;
use crate::stages::search::lists::renumber_lists;
use crate::stages::walls::touch_energy_j;
use crate::state::State;
use crate::state::clumps::{Clump, Clumps, Template};
use crate::state::clusters::{Cluster, Clusters};
use crate::state::events::{NewCluster, REMOVED, Renumbering, TopologyChange};
use crate::state::particles::{Motion, Particles, Pose, Wrench};
use crate::state::population::OutletWatch;
use crate::state::renumbered::NewNumbers;
use crate::state::walls::Wall;
use dem_physics::bond::scatter::{body_key, strength_factor};
use dem_physics::rotation::rotation;

/// Makes the changes. New clumps get their numbers among the clusters.
pub fn apply_topology_change(state: &mut State, changes: TopologyChange) -> Renumbering {
    prepare_change(state, &changes);
    state.scratch.surroundings.clear();
    state.scratch.outlets = OutletWatch::default();
    place_all(&state.clumps, &mut state.particles);
    let pressed_before_j = pressed_j(state);
    let TopologyChange {
        to_clusters,
        to_clumps,
        coming,
        leaving,
    } = changes;
    let old = std::mem::take(&mut state.particles);
    let old_firsts: Vec<u32> = state.clumps.all.iter().map(|clump| clump.first).collect();
    let mut near = std::mem::take(&mut state.clumps.near);
    let outer_of = |clump: &Clump| state.clumps.template(clump).outer.len();
    let mut rebuilt = Rebuilt::of(&old, coming.iter().map(outer_of).sum());
    let mut clusters = state.clusters.take();
    let stiffens = |id: u32| to_clumps.binary_search_by_key(&id, |(id, _)| *id).is_ok();
    let goes = |id: u32| leaving.binary_search(&id).is_ok() || stiffens(id);
    rebuilt.keep_free(clusters.as_ref(), goes);
    let mut created = rebuilt.replace_clumps(&to_clusters, &state.clumps);
    rebuilt.keep_clumps(&mut state.clumps, &to_clusters, &leaving);
    rebuilt.stiffen(&mut state.clumps, to_clumps, clusters.as_ref());
    let clusters_now = clusters.as_mut();
    let mut history = clusters_now.map_or(Vec::new(), |c| std::mem::take(&mut c.history));
    rebuilt.receive(state, coming, &mut history);
    state.clusters = clusters;
    for created in &created {
        let cluster = &mut history[created.clump.cluster as usize];
        cluster.particles = created.template.spheres.len() as u32;
        cluster.unbroken_since_s = state.time_s;
    }
    for clump in &state.clumps.all {
        let outer = state.clumps.template(clump).outer.len();
        history[clump.cluster as usize].particles = outer as u32;
    }
    for &id in &leaving {
        history[id as usize].ended_s = Some(state.time_s);
    }
    let Rebuilt {
        new,
        numbers: particles,
        ids,
        materials_of_new,
        ..
    } = rebuilt;

    // Near spheres of clumps stay near, under their new numbers; they are searched for again in the
    // next step.
    renumber(&mut near, &particles);
    near.retain(|&sphere| sphere as usize >= new.free);
    near.sort_unstable();
    state.clumps.set_near(near);
    state.particles = new;
    let bonds = change_bonds(state, &particles, &history, &mut created);
    let radii_m: Vec<f64> = old.poses.iter().map(Pose::radius_m).collect();
    count_anew(state, &particles, &radii_m, &materials_of_new);
    if let Some(clusters) = &mut state.clusters {
        (clusters.of_particle, clusters.history) = (ids, history);
        // They belong together by construction.
        let _ = clusters.rebuild(&state.bonds);
    }
    let is_new = |i: u32| materials_of_new[i as usize].is_some();
    renumber_lists(state, &particles, is_new, &old_firsts);
    for created in &created {
        state.ledger.gain(strain_of(created, state));
    }
    count_sleepers(state);
    let pressed_j = pressed_j(state);
    state.ledger.gain(pressed_j - pressed_before_j);
    Renumbering {
        particles,
        bonds,
        free: state.particles.free as u32,
        created,
    }
}

/// Elastic energy of the bonds of a new cluster, J: a fragment has the strain that it had when it
/// became a clump.
fn strain_of(created: &NewCluster, state: &State) -> f64 {
    let poses = &state.particles.poses;
    let bonds = created.first_bond..created.first_bond + created.template.bonds.len();
    bonds
        .map(|at| state.bonds.forces(at, poses).energy.total())
        .sum()
}

/// The particles as numbered after a change: free ones first, then those carried by clumps.
struct Rebuilt<'a> {
    old: &'a Particles,
    new: Particles,
    /// For each old particle, its new number, or [`REMOVED`].
    numbers: Vec<u32>,
    /// For each new particle, the number of its cluster.
    ids: Vec<u32>,
    /// For each new particle, its material if it did not exist before.
    materials_of_new: Vec<Option<u8>>,
}

impl<'a> Rebuilt<'a> {
    /// With room for `coming` more particles.
    fn of(old: &'a Particles, coming: usize) -> Self {
        Self {
            old,
            new: Particles::with_room(old.len() + coming),
            numbers: vec![REMOVED; old.len()],
            ids: Vec::with_capacity(old.len() + coming),
            materials_of_new: Vec::with_capacity(old.len() + coming),
        }
    }

    /// Assigns all particles added since the last call to this cluster; new ones have this
    /// material.
    fn label(&mut self, cluster: u32, material: Option<u8>) {
        self.ids.resize(self.new.len(), cluster);
        self.materials_of_new.resize(self.new.len(), material);
    }

    /// Free particles, without those of removed clusters.
    fn keep_free(&mut self, clusters: Option<&Clusters>, goes: impl Fn(u32) -> bool) {
        for i in 0..self.old.free {
            let id = clusters.map_or(0, |clusters| clusters.of_particle[i]);
            if !goes(id) {
                keep(self.old, i..i + 1, &mut self.new, &mut self.numbers);
                self.label(id, None);
            }
        }
        self.new.free = self.new.len();
    }

    /// Clumps that become clusters, whose particles are free from now on.
    fn replace_clumps(&mut self, to_clusters: &[usize], clumps: &Clumps) -> Vec<NewCluster> {
        let mut created = Vec::new();
        for &at in to_clusters {
            let clump = clumps.all[at];
            let template = Arc::clone(clumps.template(&clump));
            let first_particle = self.new.len();
            push_cluster(&template, &clump, &mut self.new);
            for (n, &sphere) in template.outer.iter().enumerate() {
                self.numbers[clump.first as usize + n] = first_particle as u32 + sphere;
            }
            self.label(clump.cluster, Some(template.material));
            created.push(NewCluster {
                clump,
                template,
                first_particle,
                first_bond: 0,
            });
        }
        created
    }

    /// Clumps that remain, and their spheres.
    fn keep_clumps(&mut self, clumps: &mut Clumps, to_clusters: &[usize], leaving: &[u32]) {
        let mut at = 0;
        let templates = &clumps.templates;
        clumps.all.retain_mut(|clump| {
            at += 1;
            let leaves = leaving.binary_search(&clump.cluster).is_ok();
            if leaves || to_clusters.binary_search(&(at - 1)).is_ok() {
                return false;
            }
            let own = templates[clump.template as usize].spheres_from(clump.first);
            clump.first = self.new.len() as u32;
            keep(self.old, own, &mut self.new, &mut self.numbers);
            self.label(clump.cluster, None);
            true
        });
    }

    /// Clusters that become clumps.
    fn stiffen(
        &mut self,
        clumps: &mut Clumps,
        to_clumps: Vec<(u32, Clump)>,
        clusters: Option<&Clusters>,
    ) {
        for (id, mut clump) in to_clumps {
            let template = Arc::clone(clumps.template(&clump));
            Clumps::push_spheres(&template, &mut clump, &mut self.new);
            // The spheres of its template are in the order of its particles.
            let members = clusters.map_or(&[][..], |clusters| clusters.members(id));
            for (n, &sphere) in template.outer.iter().enumerate() {
                self.numbers[members[sphere as usize] as usize] = clump.first + n as u32;
            }
            self.label(id, Some(template.material));
            clumps.all.push(clump);
        }
    }

    /// New clumps, each with its own number among the clusters.
    fn receive(&mut self, state: &mut State, coming: Vec<Clump>, history: &mut Vec<Cluster>) {
        for clump in coming {
            let (mut clump, cluster) = arrived(state, clump, history.len() as u32);
            history.push(cluster);
            let template = Arc::clone(state.clumps.template(&clump));
            Clumps::push_spheres(&template, &mut clump, &mut self.new);
            self.label(clump.cluster, Some(template.material));
            state.clumps.all.push(clump);
        }
    }
}

/// Elastic energy of contacts between particles and with walls, and energy of liquid bridges, J.
fn pressed_j(state: &State) -> f64 {
    let Some(contacts) = &state.contacts else {
        return 0.0;
    };
    let of_wall = |wall: &Wall| {
        let touching = wall.touching.iter();
        let energies =
            touching.map(|touch| touch_energy_j(wall, contacts, &state.particles, touch));
        energies.sum::<f64>()
    };
    let of_walls: f64 = state.walls.iter().map(of_wall).sum();
    elastic_energy_j(contacts, &state.particles) + of_walls + bridges_energy_j(state)
}

/// Divides the work anew, and gives damping forces of bonds to the particles that remain.
fn divide_anew(state: &mut State, particles: &[u32]) {
    let resistance = std::mem::take(&mut state.bond_resistance);
    let means = state.mean_resistance.clone();
    state.divide();
    for (list, before) in [
        (&mut state.bond_resistance, resistance),
        (&mut state.mean_resistance, means),
    ] {
        for (&now, wrench) in particles.iter().zip(before) {
            if let Some(kept) = list.get_mut(now as usize) {
                *kept = wrench;
            }
        }
    }
}

/// New numbers, without those of removed items.
fn renumber(numbers: &mut Vec<u32>, now: &[u32]) {
    numbers.retain_mut(|number| {
        *number = now[*number as usize];
        *number != REMOVED
    });
}

/// Keeps some consecutive particles, and sets their new numbers.
fn keep(old: &Particles, some: Range<usize>, new: &mut Particles, numbers: &mut [u32]) {
    for (number, now) in numbers[some.clone()].iter_mut().zip(new.len() as u32..) {
        *number = now;
    }
    new.poses.extend_from_slice(&old.poses[some.clone()]);
    new.motions.extend_from_slice(&old.motions[some.clone()]);
    new.wrenches.extend_from_slice(&old.wrenches[some.clone()]);
    new.ids.extend(some.map(|i| old.id(i)));
}

/// All spheres of a clump, as particles that move with it (Platzer 2022, section 4.5.4.1): x = c +
/// R s, v = v_c + w x (R s).
fn push_cluster(template: &Template, clump: &Clump, new: &mut Particles) {
    let motion_at = clump.motion(template);
    for (sphere, sub) in template.spheres.iter().enumerate() {
        let pose = template.pose(sphere, clump);
        let motion = motion_at(&pose.place());
        new.poses.push(pose);
        new.motions.push(Motion {
            inverse_mass: 1.0 / sub.mass_kg,
            inverse_inertia: 1.0 / sub.inertia_kg_m2,
            ..motion
        });
        new.wrenches.push(Wrench::default());
        new.ids.push(template.id(sphere, clump));
    }
    new.free += template.spheres.len();
}

/// Counts the broken bonds that are removed, by their bodies.
fn count_broken_gone(state: &mut State, bonds: &[u32], history: &[Cluster]) {
    let of_body = &mut state.population.broken_gone;
    of_body.resize(state.model.bodies.len(), 0);
    let clusters = state.clusters.as_ref();
    for at in (0..bonds.len()).filter(|&at| bonds[at] == REMOVED) {
        if !state.bonds.is_broken(at) {
            continue;
        }
        state.broken_removed += 1;
        let end = state.bonds.ends[at][0] as usize;
        let cluster = clusters.and_then(|clusters| history.get(clusters.of_particle[end] as usize));
        if let Some(count) = cluster.and_then(|c| of_body.get_mut(c.body as usize)) {
            *count += 1;
        }
    }
}

/// Bonds of remaining particles, and those of new clusters. Returns the new numbers.
fn change_bonds(
    state: &mut State,
    particles: &[u32],
    history: &[Cluster],
    created: &mut [NewCluster],
) -> Vec<u32> {
    let free = state.particles.free as u32;
    // Those of clumps and of removed particles are out of range.
    let now = |ends: [u32; 2]| ends.map(|end| particles[end as usize]);
    let mut count = 0;
    let bonds: Vec<u32> = (state.bonds.ends.iter())
        .map(|&ends| {
            if now(ends).iter().any(|&end| end >= free) {
                return REMOVED;
            }
            count += 1;
            count - 1
        })
        .collect();
    if (count as usize) < bonds.len() {
        count_broken_gone(state, &bonds, history);
        let old = std::mem::take(&mut state.bonds);
        state.bonds.rules.clone_from(&old.rules);
        for at in (0..old.len()).filter(|&at| bonds[at] != REMOVED) {
            state.bonds.push_copy(&old, at, now(old.ends[at]), 1.0);
        }
    } else {
        for ends in &mut state.bonds.ends {
            *ends = now(*ends);
        }
    }
    for created in created {
        created.first_bond = state.bonds.len();
        let template = &created.template;
        let first = created.first_particle as u32;
        for (at, ends) in template.bonds.ends.iter().enumerate() {
            let factor = template.scatter.map_or(1.0, |scatter| {
                let body = body_key(&template.body, created.clump.instance);
                let pair = ends.map(|end| u64::from(template.file_number[end as usize]));
                strength_factor(scatter.seed, body, pair, scatter.modulus)
            });
            let ends = ends.map(|end| first + end);
            state.bonds.push_copy(&template.bonds, at, ends, factor);
        }
        let turned = rotation(created.clump.turned) * rotation(template.axes).inverse();
        state.bonds.turn_histories(created.first_bond, &turned);
    }
    bonds
}

/// Renumbers everything else that is indexed by particles and bonds. `old_radii_m`: of the old
/// particles; `materials_of_new`: see [`NewNumbers`].
fn count_anew(
    state: &mut State,
    now: &[u32],
    old_radii_m: &[f64],
    materials_of_new: &[Option<u8>],
) {
    let partitions = state.wanted_partitions();
    let (poses, parts) = state.naming_particles();
    let by = NewNumbers {
        now,
        old_radii_m,
        poses,
        materials_of_new,
        partitions,
    };
    for part in parts {
        part.renumber(&by);
    }
    let free = state.particles.free;
    state.rigid_parts.number(free, &state.bonds);
    divide_anew(state, now);
}
