//! Clumps as bodies of `fix rigid/small`.
//!
//! Mass, centre and inertia are those of the clump, from a file: LAMMPS would compute others from
//! spheres that overlap. A clump of one sphere is a sphere.
//!
//! <https://docs.lammps.org/fix_rigid.html>

use std::io::{self, Write};

use nalgebra::{Matrix3, Vector3};

use super::molecules::Molecules;
use dem_engine::state::State;
use dem_engine::state::clumps::Clump;
use dem_physics::rotation::rotation;

/// Whether a clump is a body of several spheres.
pub(super) fn is_body(state: &State, clump: &Clump) -> bool {
    state.clumps.spheres_of(clump).len() > 1
}

/// Whether any clump is a body of several spheres.
pub(super) fn has_bodies(state: &State) -> bool {
    state.clumps.all.iter().any(|clump| is_body(state, clump))
}

/// Writes the properties of all bodies as `fix rigid/small ... infile` reads them.
pub(super) fn write(state: &State, molecules: &Molecules, out: &mut dyn Write) -> io::Result<()> {
    let bodies: Vec<&Clump> = (state.clumps.all.iter())
        .filter(|clump| is_body(state, clump))
        .collect();
    writeln!(
        out,
        "# molecule, mass (kg), centre (m), inertia xx yy zz xy xz yz (kg m2), velocity (m/s), angular momentum (kg m2/s), image flags"
    )?;
    writeln!(out, "{}", bodies.len())?;
    for clump in bodies {
        let template = state.clumps.template(clump);
        let turned = rotation(clump.turned).to_rotation_matrix();
        let principal = Matrix3::from_diagonal(&Vector3::from(template.moments_kg_m2));
        let inertia = turned.matrix() * principal * turned.matrix().transpose();
        let [x, y, z] = clump.place_m;
        let [vx, vy, vz] = clump.velocity_m_s;
        let [lx, ly, lz] = clump.angular_momentum;
        let molecule = molecules.of_particle[clump.first as usize];
        writeln!(
            out,
            "{molecule} {:e} {x:e} {y:e} {z:e} {:e} {:e} {:e} {:e} {:e} {:e} {vx:e} {vy:e} {vz:e} {lx:e} {ly:e} {lz:e} 0 0 0",
            template.mass_kg,
            inertia[(0, 0)],
            inertia[(1, 1)],
            inertia[(2, 2)],
            inertia[(0, 1)],
            inertia[(0, 2)],
            inertia[(1, 2)],
        )?;
    }
    Ok(())
}
