//! Frames: all particles and bonds at one time, in the order of the bodies' files.

use dem_io::Result;
use dem_io::results::{Frame, FrameFiles, NamedArray, Values};

use crate::check::ledger::synchronous_motions;
use crate::measure::bond_utilisation;
use crate::physics::bond::failure::{Stresses, stresses};
use crate::plan::bodies::PlacedBody;
use crate::state::State;

/// Who is who in a frame: particles and bonds of all bodies, in the order of their files.
#[derive(Debug, Clone)]
pub struct FrameOrder {
    particles: Vec<u32>,
    bodies: Vec<u32>,
    bonds: Vec<u32>,
    ends: Vec<[u32; 2]>,
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
            ends: Vec::new(),
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
            for at in of_file {
                order.bonds.push(at);
                let ends = state.bonds.ends[at as usize];
                order
                    .ends
                    .push(ends.map(|end| order.place_of[end as usize]));
            }
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
        let p = &state.particles;
        let motions = synchronous_motions(state);
        let of_particles = |of: &dyn Fn(usize) -> [f64; 3]| -> Vec<[f64; 3]> {
            self.particles.iter().map(|&i| of(i as usize)).collect()
        };
        let positions = of_particles(&|i| p.poses[i].place().into());
        let displacements: Vec<[f64; 3]> = positions
            .iter()
            .zip(&self.start)
            .map(|(now, start)| [0, 1, 2].map(|k| now[k] - start[k]))
            .collect();
        let velocities = of_particles(&|i| motions[i].velocity_m_s);
        let spins = of_particles(&|i| motions[i].spin_rad_s);
        let radii: Vec<f64> = self
            .particles
            .iter()
            .map(|&i| p.radii_m[i as usize])
            .collect();
        let particle_arrays = [
            array("radius_m", Values::Scalars(&radii)),
            array("body", Values::Counts(&self.bodies)),
            array("displacement_m", Values::Vectors(&displacements)),
            array("velocity_m_s", Values::Vectors(&velocities)),
            array("angular_velocity_rad_s", Values::Vectors(&spins)),
        ];

        let bonds = &state.bonds;
        let mut loads: [Vec<f64>; 4] = Default::default();
        let mut normal_stresses = Vec::new();
        let mut shear_stresses = Vec::new();
        let mut used = Vec::new();
        let mut broken = Vec::new();
        for &at in &self.bonds {
            let at = at as usize;
            let is_broken = bonds.is_broken(at);
            let load = if is_broken {
                crate::physics::bond::BondLoad::default()
            } else {
                bonds.forces(at, &p.poses).load
            };
            let [normal, shear, torsion, bending] = &mut loads;
            normal.push(load.normal_n);
            shear.push(load.shear_n);
            torsion.push(load.torsion_n_m);
            bending.push(load.bending_n_m);
            let Stresses {
                axial_pa,
                bending_pa,
                shear_pa,
                torsion_pa,
            } = stresses(&load, bonds.radius_m(at));
            normal_stresses.push(axial_pa + bending_pa);
            shear_stresses.push(shear_pa + torsion_pa);
            used.push(bond_utilisation(state, at));
            broken.push(u32::from(is_broken));
        }
        let bond_radii: Vec<f64> = self
            .bonds
            .iter()
            .map(|&at| bonds.radius_m(at as usize))
            .collect();
        let bond_arrays = [
            array("bond_radius_m", Values::Scalars(&bond_radii)),
            array("normal_force_n", Values::Scalars(&loads[0])),
            array("shear_force_n", Values::Scalars(&loads[1])),
            array("torsion_n_m", Values::Scalars(&loads[2])),
            array("bending_n_m", Values::Scalars(&loads[3])),
            array("normal_stress_pa", Values::Scalars(&normal_stresses)),
            array("shear_stress_pa", Values::Scalars(&shear_stresses)),
            array("utilisation", Values::Scalars(&used)),
            array("broken", Values::Counts(&broken)),
        ];
        files.append(&Frame {
            time_s: state.time_s,
            positions: &positions,
            particle_arrays: &particle_arrays,
            bonds: &self.ends,
            bond_arrays: &bond_arrays,
        })
    }
}

fn array<'a>(name: &'a str, values: Values<'a>) -> NamedArray<'a> {
    NamedArray { name, values }
}
