//! The data file: particles as `atom_style bpm/sphere`, and bonds.
//!
//! <https://docs.lammps.org/read_data.html>

use std::io::{self, Write};

use dem_io::body::mass::volume_m3;

use super::bonds::BondTypes;
use super::clumps::is_body;
use super::contacts::Contacts;
use super::feeds::Feed;
use super::molecules::Molecules;
use dem_plan::Plan;

/// Density of each particle, kg/m3, with which the spheres of a clump have its mass together.
fn densities(plan: &Plan) -> Vec<f64> {
    let state = &plan.state;
    let volume = |i: usize| volume_m3(state.particles.poses[i].radius_m());
    let free = 0..state.particles.free;
    let mut densities: Vec<f64> = free.map(|i| state.particles.density_kg_m3(i)).collect();
    densities.resize(state.particles.len(), 0.0);
    for clump in &state.clumps.all {
        let spheres = state.clumps.spheres_of(clump);
        let total: f64 = spheres.clone().map(volume).sum();
        densities[spheres].fill(state.clumps.template(clump).mass_kg / total);
    }
    densities
}

/// Numbers of the particles in the state, in the order of their ids.
pub(super) fn by_id(plan: &Plan) -> Vec<usize> {
    let particles = &plan.state.particles;
    let mut order: Vec<usize> = (0..particles.len()).collect();
    order.sort_unstable_by_key(|&i| particles.id(i));
    order
}

/// The number of particle `i` in LAMMPS, where ids begin at 1.
pub(super) fn atom(plan: &Plan, i: usize) -> u64 {
    u64::from(plan.state.particles.id(i)) + 1
}

/// Writes the data file.
pub(super) fn write(
    plan: &Plan,
    contacts: &Contacts,
    types: &BondTypes,
    molecules: &Molecules,
    feeds: &[Feed],
    out: &mut dyn Write,
) -> io::Result<()> {
    let state = &plan.state;
    let p = &state.particles;
    writeln!(out, "Bonded spheres, units si (m, kg/m3, N/m, N m/rad)\n")?;
    writeln!(out, "{} atoms", p.len())?;
    writeln!(out, "{} bonds", state.bonds.len())?;
    let atom_types = contacts.materials.len() + feeds.len();
    writeln!(out, "{atom_types} atom types")?;
    if !types.types.is_empty() {
        writeln!(out, "{} bond types", types.types.len())?;
        writeln!(out, "{} extra bond per atom", most_bonds(plan))?;
    }
    writeln!(out)?;
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let ends = p.poses.iter().map(|pose| {
            let (x, r) = (pose.position_m[k], pose.radius_m());
            [x - 2.0 * r, x + 2.0 * r]
        });
        // An atom that comes outside of the box is lost.
        let rooms = feeds.iter().map(|f| [f.room.low[k], f.room.high[k]]);
        let [low, high] = ends
            .chain(rooms)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| {
                [low.min(a), high.max(b)]
            });
        writeln!(out, "{low:e} {high:e} {axis}lo {axis}hi")?;
    }
    if p.is_empty() {
        return Ok(());
    }
    let (order, densities) = (by_id(plan), densities(plan));
    writeln!(out, "\nAtoms # bpm/sphere\n")?;
    for &i in &order {
        let [x, y, z, r] = p.poses[i].position_m;
        writeln!(
            out,
            "{} {} {} {:e} {:e} {x:e} {y:e} {z:e}",
            atom(plan, i),
            molecules.of_particle[i],
            contacts.material_of[i] + 1,
            2.0 * r,
            densities[i]
        )?;
    }
    writeln!(out, "\nVelocities\n")?;
    for &i in &order {
        let [x, y, z] = p.motions[i].velocity_m_s;
        let [a, b, c] = p.motions[i].spin_rad_s;
        writeln!(out, "{} {x:e} {y:e} {z:e} {a:e} {b:e} {c:e}", atom(plan, i))?;
    }
    if types.types.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nBonds\n")?;
    for (number, at) in (1..).zip(as_in_files(plan)) {
        let [a, b] = state.bonds.ends[at].map(|end| atom(plan, end as usize));
        writeln!(out, "{number} {} {a} {b}", types.type_of[at] + 1)?;
    }
    Ok(())
}

/// Numbers of the bonds in the state, body by body in the order of its file.
fn as_in_files(plan: &Plan) -> Vec<usize> {
    let mut numbers = Vec::with_capacity(plan.state.bonds.len());
    for body in &plan.bodies {
        let mut own: Vec<(u32, usize)> = (body.bonds.iter().copied())
            .zip(body.first_bond..)
            .collect();
        own.sort_unstable();
        numbers.extend(own.into_iter().map(|(_, at)| at));
    }
    numbers
}

/// Whether a particle of a clump moves by itself: a clump of one sphere.
pub(super) fn lone_spheres(plan: &Plan) -> Vec<usize> {
    let state = &plan.state;
    let lone = state
        .clumps
        .all
        .iter()
        .filter(|clump| !is_body(state, clump));
    lone.map(|clump| clump.first as usize).collect()
}

/// Largest number of bonds of a particle.
fn most_bonds(plan: &Plan) -> u32 {
    let mut counts = vec![0_u32; plan.state.particles.len()];
    for end in plan.state.bonds.ends.iter().flatten() {
        counts[*end as usize] += 1;
    }
    counts.into_iter().max().unwrap_or(0)
}
