//! Molecules of an export.

use dem_plan::Plan;

/// Molecules: a body of the scene, or a clump.
#[derive(Debug, Clone, Default)]
pub(super) struct Molecules {
    /// For each particle of the state its molecule, from 1.
    pub of_particle: Vec<u32>,
    /// For each molecule the number of its body.
    pub bodies: Vec<u32>,
    /// For each molecule whether it is a clump.
    pub are_clumps: Vec<bool>,
}

/// The molecules of a planned scene.
pub(super) fn molecules(plan: &Plan) -> Molecules {
    let state = &plan.state;
    let mut molecules = Molecules {
        of_particle: vec![0; state.particles.len()],
        ..Molecules::default()
    };
    for body in &plan.bodies {
        molecules.bodies.push(state.model.body_number(&body.name));
        molecules.are_clumps.push(false);
        let number = molecules.bodies.len() as u32;
        for &i in &body.particles {
            molecules.of_particle[i as usize] = number;
        }
    }
    for clump in &state.clumps.all {
        let name = &state.clumps.template(clump).body;
        molecules.bodies.push(state.model.body_number(name));
        molecules.are_clumps.push(true);
        let number = molecules.bodies.len() as u32;
        molecules.of_particle[state.clumps.spheres_of(clump)].fill(number);
    }
    molecules
}
