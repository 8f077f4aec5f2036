//! Frames: all particles and bonds at one time, in the order of the bodies' files.

use dem_io::Result;
use dem_io::results::{Frame, FrameFiles, NamedArray, Values};

use crate::check::ledger::synchronous_motions;
use crate::measure::{load, utilisation_under};
use crate::physics::bond::BondLoad;
use crate::physics::bond::failure::stresses;
use crate::plan::bodies::PlacedBody;
use crate::state::State;

/// Who is who in a frame: particles and bonds of all bodies, in the order of their files.
#[derive(Debug, Clone)]
pub struct FrameOrder {
    particles: Vec<u32>,
    bodies: Vec<u32>,
    bonds: Vec<u32>,
    start: Vec<[f64; 3]>,
    /// For each particle of the state, its number in the frames.
    place_of: Vec<u32>,
}

impl FrameOrder {
    /// Of a state at its start.
    pub fn new(bodies: &[PlacedBody], state: &State) -> Self {
        let mut order = Self {
            particles: Vec::new(),
            bodies: Vec::new(),
            bonds: Vec::new(),
            start: Vec::new(),
            place_of: vec![0_u32; state.particles.len()],
        };
        for (number, body) in (0..).zip(bodies) {
            for &i in &body.particles {
                order.place_of[i as usize] = order.particles.len() as u32;
                order.particles.push(i);
                order.bodies.push(number);
                order
                    .start
                    .push(state.particles.poses[i as usize].place().into());
            }
            let mut of_file = vec![0_u32; body.bonds.len()];
            for (at, &original) in (body.first_bond as u32..).zip(&body.bonds) {
                of_file[original as usize] = at;
            }
            order.bonds.extend(of_file);
        }
        order
    }

    /// Number in the frames of a particle of the state.
    pub fn number_of(&self, particle: u32) -> u64 {
        u64::from(self.place_of[particle as usize])
    }

    /// Writes the frame of a state between a kick and the drift after it.
    ///
    /// # Errors
    /// Those of the files.
    pub fn write(&self, state: &State, files: &mut FrameFiles) -> Result<()> {
        let (p, bonds) = (&state.particles, &state.bonds);
        let motions = synchronous_motions(state);
        let particle = |i: usize| self.particles[i] as usize;
        let position = |i: usize| p.poses[particle(i)].place().into();
        let displacement = |i: usize| {
            let (now, start): ([f64; 3], _) = (position(i), self.start[i]);
            [0, 1, 2].map(|k| now[k] - start[k])
        };
        let bond = |i: usize| self.bonds[i] as usize;
        // Dear to compute, and seven arrays follow from them.
        let loads: Vec<BondLoad> = (0..self.bonds.len())
            .map(|i| load(state, bond(i)))
            .collect();
        let stresses = |i: usize| stresses(&loads[i], bonds.radius_m(bond(i)));
        let normal_stress = |i: usize| {
            let stresses = stresses(i);
            stresses.axial_pa + stresses.bending_pa
        };
        let shear_stress = |i: usize| {
            let stresses = stresses(i);
            stresses.shear_pa + stresses.torsion_pa
        };
        files.append(&Frame {
            time_s: state.time_s,
            particles: self.particles.len(),
            position_m: &position,
            particle_arrays: &[
                scalars("radius_m", &|i| p.poses[particle(i)].radius_m()),
                counts("body", &|i| self.bodies[i]),
                vectors("displacement_m", &displacement),
                vectors("velocity_m_s", &|i| motions[particle(i)].velocity_m_s),
                vectors("angular_velocity_rad_s", &|i| {
                    motions[particle(i)].spin_rad_s
                }),
            ],
            bonds: self.bonds.len(),
            ends: &|i| bonds.ends[bond(i)].map(|end| self.place_of[end as usize]),
            bond_arrays: &[
                scalars("bond_radius_m", &|i| bonds.radius_m(bond(i))),
                scalars("normal_force_n", &|i| loads[i].normal_n),
                scalars("shear_force_n", &|i| loads[i].shear_n),
                scalars("torsion_n_m", &|i| loads[i].torsion_n_m),
                scalars("bending_n_m", &|i| loads[i].bending_n_m),
                scalars("normal_stress_pa", &normal_stress),
                scalars("shear_stress_pa", &shear_stress),
                scalars("utilisation", &|i| {
                    utilisation_under(state, bond(i), &loads[i])
                }),
                counts("broken", &|i| u32::from(bonds.is_broken(bond(i)))),
            ],
        })
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
