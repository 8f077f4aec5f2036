//! Frames: all particles and bonds at one time, in the order of the bodies' files.

use dem_io::Result;
use dem_io::body::BondColumn;
use dem_io::body::histories::DIRECTION;
use dem_io::body::stored_frame::{
    BODY, BOND_LENGTH, BOND_RADIUS, BROKEN, DAMAGE, DENSITY, FAILED, FRAGMENT_ID, PARTICLE_ID,
    RADIUS, RIGID, TURN, VELOCITY,
};
use dem_results::{Frame, FrameFiles, NamedArray, Values};

use super::walls::WallOutput;
use dem_engine::stages::ledger::totals::synchronous_motions;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::fragments::fragment_masses_kg;
use dem_engine::state::events::REMOVED;
use dem_engine::state::stored_bonds::{direction_of, histories_of};
use dem_physics::bond::BondLoad;
use dem_physics::bond::failure::{Stresses, stresses};
use dem_physics::rigid::rotation_vector;
use dem_plan::measure::{DynamicUtilisation, dynamic_utilisations, load, utilisation_under};

/// Numbering in a frame: particles and bonds of all bodies, in the order of their files, followed
/// by the spheres of clumps.
#[derive(Debug, Clone)]
pub(crate) struct FrameOrder {
    particles: Vec<u32>,
    bodies: Vec<u32>,
    bonds: Vec<u32>,
    start: Vec<[f64; 3]>,
    /// For each particle of the state, its number in the frames.
    place_of: Vec<u32>,
    /// Whether bodies are added, removed or replaced: then particles have no initial position.
    changes: bool,
}

impl FrameOrder {
    /// From a state at its start.
    pub(crate) fn new(bodies: &[PlacedBody], state: &State) -> Self {
        let mut order = Self {
            particles: Vec::new(),
            bodies: Vec::new(),
            bonds: Vec::new(),
            start: Vec::new(),
            place_of: vec![0_u32; state.particles.len()],
            changes: state.bodies_change(),
        };
        for body in bodies {
            let number = state.model.body_number(&body.name);
            for &i in body.particles.iter().filter(|i| **i != REMOVED) {
                order.place_of[i as usize] = order.particles.len() as u32;
                order.particles.push(i);
                order.bodies.push(number);
                order
                    .start
                    .push(state.particles.poses[i as usize].place().into());
            }
            let mut of_file: Vec<(u32, u32)> = (body.bonds.iter().copied())
                .zip(body.first_bond as u32..)
                .collect();
            of_file.sort_unstable();
            order.bonds.extend(of_file.iter().map(|(_, at)| at));
        }
        for clump in &state.clumps.all {
            let number = state.model.body_number(&state.clumps.template(clump).body);
            for i in state.clumps.spheres_of(clump) {
                order.place_of[i] = order.particles.len() as u32;
                order.particles.push(i as u32);
                order.bodies.push(number);
            }
        }
        order
    }

    /// Writes the frame of a state between a kick and the drift after it.
    pub(crate) fn write(
        &self,
        state: &State,
        walls: &WallOutput,
        files: &mut FrameFiles,
    ) -> Result<()> {
        let p = &state.particles;
        let motions = synchronous_motions(state);
        let particle = |i: usize| self.particles[i] as usize;
        let position = |i: usize| p.poses[particle(i)].place().into();
        let displacement = |i: usize| {
            let (now, start): ([f64; 3], _) = (position(i), self.start[i]);
            [0, 1, 2].map(|k| now[k] - start[k])
        };
        let radius = |i: usize| p.poses[particle(i)].radius_m();
        let body = |i: usize| self.bodies[i];
        let id = |i: usize| p.id(particle(i));
        let velocity = |i: usize| motions[particle(i)].velocity_m_s;
        let spin = |i: usize| motions[particle(i)].spin_rad_s;
        let clusters = state.clusters.as_ref();
        let cluster = |i: usize| clusters.map_or(0, |clusters| clusters.of_particle[particle(i)]);
        let masses_kg = clusters.map(|clusters| fragment_masses_kg(clusters, p, &state.clumps));
        let mass = |i: usize| masses_kg.as_ref().map_or(0.0, |kg| kg[particle(i)]);
        let density = |i: usize| state.density_kg_m3(particle(i));
        let turn = |i: usize| rotation_vector(p.poses[particle(i)].turned);
        let rigid = |i: usize| u32::from(particle(i) >= p.free);
        let mut arrays = vec![
            scalars(RADIUS, &radius),
            counts(BODY, &body),
            counts(PARTICLE_ID, &id),
            vectors(VELOCITY, &velocity),
            vectors("angular_velocity_rad_s", &spin),
        ];
        if self.changes {
            arrays.push(counts(RIGID, &rigid));
        } else {
            arrays.insert(3, vectors("displacement_m", &displacement));
        }
        // With the densities, and rotations where there are bonds, a piece can be taken as a body.
        if clusters.is_some() {
            arrays.push(counts(FRAGMENT_ID, &cluster));
            arrays.push(scalars(DENSITY, &density));
            arrays.push(scalars("fragment_mass_kg", &mass));
        } else {
            arrays.push(scalars(DENSITY, &density));
        }
        if !state.bonds.is_empty() {
            arrays.push(vectors(TURN, &turn));
        }
        self.append(state, &arrays, walls, files)
    }

    /// Appends the frame with these arrays of the particles and those of the bonds.
    fn append(
        &self,
        state: &State,
        particle_arrays: &[NamedArray<'_>],
        walls: &WallOutput,
        files: &mut FrameFiles,
    ) -> Result<()> {
        let bonds = &state.bonds;
        let loads = Loads::of(state, &self.bonds);
        let bond = |i: usize| self.bonds[i] as usize;
        let bond_radius = |i: usize| bonds.radius_m(bond(i));
        let normal_force = |i: usize| loads.of_bonds[i].normal_n;
        let shear_force = |i: usize| loads.of_bonds[i].shear_n;
        let torsion = |i: usize| loads.of_bonds[i].torsion_n_m;
        let bending = |i: usize| loads.of_bonds[i].bending_n_m;
        let normal_stress = |i: usize| loads.normal_stress_pa(i);
        let shear_stress = |i: usize| loads.shear_stress_pa(i);
        let utilisation = |i: usize| utilisation_under(state, bond(i), &loads.of_bonds[i]);
        let broken = |i: usize| u32::from(bonds.is_broken(bond(i)));
        let mut arrays = vec![
            scalars(BOND_RADIUS, &bond_radius),
            scalars("normal_force_n", &normal_force),
            scalars("shear_force_n", &shear_force),
            scalars("torsion_n_m", &torsion),
            scalars("bending_n_m", &bending),
            scalars("normal_stress_pa", &normal_stress),
            scalars("shear_stress_pa", &shear_stress),
            scalars("utilisation", &utilisation),
            counts(BROKEN, &broken),
        ];
        let damage = |i: usize| bonds.damage(bond(i));
        if !bonds.histories.damages.is_empty() {
            arrays.push(scalars(DAMAGE, &damage));
        }
        let failed = |i: usize| match bonds.is_broken(bond(i)) {
            true => 1.0,
            false => bonds.failed_fraction(bond(i)),
        };
        if !bonds.histories.joints.is_empty() {
            arrays.push(scalars(FAILED, &failed));
        }
        let dynamic = |i: usize| loads.dynamic[bond(i)].unwrap_or(DynamicUtilisation::BROKEN);
        let strain_rate = |i: usize| dynamic(i).strain_rate_1_s;
        let increase_factor = |i: usize| dynamic(i).increase_factor;
        let dynamic_utilisation = |i: usize| dynamic(i).utilisation;
        if bonds.strengthen_with_rate() {
            arrays.push(scalars("strain_rate_1_s", &strain_rate));
            arrays.push(scalars("dynamic_increase_factor", &increase_factor));
            arrays.push(scalars("dynamic_utilisation", &dynamic_utilisation));
        }
        let length = |i: usize| bonds.stress_free_length_m(bond(i));
        let direction = |i: usize| direction_of(bonds, bond(i), self.is_reversed(state, i));
        arrays.push(scalars(BOND_LENGTH, &length));
        if !self.bonds.is_empty() {
            arrays.push(vectors(DIRECTION, &direction));
        }
        let poses = &state.particles.poses;
        let histories = histories_of(bonds, &self.bonds, poses, &|i| self.is_reversed(state, i));
        arrays.extend(histories.iter().map(BondColumn::array));
        self.append_with(state, [particle_arrays, &arrays], walls, files)
    }

    /// Appends the frame with these arrays of the particles and of the bonds.
    fn append_with(
        &self,
        state: &State,
        [particle_arrays, bond_arrays]: [&[NamedArray<'_>]; 2],
        walls: &WallOutput,
        files: &mut FrameFiles,
    ) -> Result<()> {
        let body_names: Vec<&str> = state.model.bodies.iter().map(|b| b.name.as_str()).collect();
        let poses = &state.particles.poses;
        let frame = Frame {
            time_s: state.time_s,
            body_names: &body_names,
            particles: self.particles.len(),
            position_m: &|i| poses[self.particles[i] as usize].place().into(),
            particle_arrays,
            bonds: self.bonds.len(),
            ends: &|i| self.ends(state, i),
            bond_arrays,
        };
        files.append(&frame, &walls.frame(state), walls.fixed())
    }

    /// The particles of bond `i` of the frame, by their numbers in it.
    fn ends(&self, state: &State, i: usize) -> [u32; 2] {
        state.bonds.ends[self.bonds[i] as usize].map(|end| self.place_of[end as usize])
    }

    fn is_reversed(&self, state: &State, i: usize) -> bool {
        let [a, b] = self.ends(state, i);
        a > b
    }
}

/// Loads of the bonds of a frame, costly to compute and needed for many arrays.
struct Loads {
    /// By their order in the frame.
    of_bonds: Vec<BondLoad>,
    radii_m: Vec<f64>,
    /// By their order in the state. Empty: strengths do not depend on the rate.
    dynamic: Vec<Option<DynamicUtilisation>>,
}

impl Loads {
    fn of(state: &State, bonds: &[u32]) -> Self {
        let each = || bonds.iter().map(|at| *at as usize);
        Self {
            of_bonds: each().map(|at| load(state, at)).collect(),
            radii_m: each().map(|at| state.bonds.radius_m(at)).collect(),
            dynamic: match state.bonds.strengthen_with_rate() {
                true => dynamic_utilisations(state),
                false => Vec::new(),
            },
        }
    }

    fn stresses(&self, i: usize) -> Stresses {
        stresses(&self.of_bonds[i], self.radii_m[i])
    }

    fn normal_stress_pa(&self, i: usize) -> f64 {
        let stresses = self.stresses(i);
        stresses.axial_pa + stresses.bending_pa
    }

    fn shear_stress_pa(&self, i: usize) -> f64 {
        let stresses = self.stresses(i);
        stresses.shear_pa + stresses.torsion_pa
    }
}

fn scalars<'a>(name: &'a str, value: &'a dyn Fn(usize) -> f64) -> NamedArray<'a> {
    let values = Values::Scalars(value);
    NamedArray { name, values }
}

fn vectors<'a>(name: &'a str, value: &'a dyn Fn(usize) -> [f64; 3]) -> NamedArray<'a> {
    let values = Values::Vectors(value);
    NamedArray { name, values }
}

fn counts<'a>(name: &'a str, value: &'a dyn Fn(usize) -> u32) -> NamedArray<'a> {
    let values = Values::Counts(value);
    NamedArray { name, values }
}
