//! Bodies of which only a part is bonded.

use dem_io::{Diagnostic, Result};
use dem_scene::Scene;

use dem_engine::stages::clumps::zones::form_rigid_parts;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::rules::{Carrier, Rejoin, Zone};

/// Makes the bodies of a scene that are bonded in a region only rigid elsewhere. Refuses local
/// damping, which does not act on rigid parts, and a body without bonds.
pub(super) fn place_zones(scene: &Scene, bodies: &[PlacedBody], state: &mut State) -> Result<()> {
    let mut zones = Vec::new();
    for body in bodies {
        let Some(asked) = &scene.bodies[&body.name].bonded_within else {
            continue;
        };
        let place = format!("{}: bodies.{}.bonded_within", scene.source, body.name);
        if scene.run.local_damping > 0.0 {
            return Err(Diagnostic::input(
                place,
                "run.local_damping has no effect on rigid parts",
                "remove it, or give the bonds damping",
            ));
        }
        if body.bonds.is_empty() {
            return Err(Diagnostic::input(
                place,
                "the body has no bonds",
                "make it with bonds: dem-pack --bond-range 1.1",
            ));
        }
        let ids = body
            .particles
            .iter()
            .map(|&i| state.particles.id(i as usize));
        let (first, last) = ids.fold((u32::MAX, 0), |(low, high), id| (low.min(id), high.max(id)));
        let region = scene.regions.keys().position(|name| *name == asked.region);
        let wall = asked.moves_with.as_ref();
        let wall = wall.and_then(|wall| scene.walls.keys().position(|name| name == wall));
        zones.push(Zone {
            body: body.name.clone(),
            ids: first..last + 1,
            region: region.unwrap_or(0),
            carrier: wall.map(|wall| Carrier {
                wall,
                start: state.walls[wall].frame,
            }),
            rejoin: asked.rejoin.map(|rejoin| Rejoin {
                strain_energy_j_kg: rejoin.strain_energy_j_kg,
                speed_m_s: rejoin.fluctuation_velocity_m_s,
            }),
        });
    }
    state.model.rules.zones = zones;
    form_rigid_parts(state);
    Ok(())
}
