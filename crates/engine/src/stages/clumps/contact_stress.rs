//! How contacts squeeze clumps: between two jaws their forces cancel, and only the single forces
//! and the stress tell.

use nalgebra::Vector3;

use crate::stages::contacts::forces::{pair_force_n, touch_point_m};
use crate::stages::walls::{self, touch_force_n};
use crate::state::State;
use crate::state::contacts::Contacts;
use dem_physics::clump_stress::Squeeze;

/// Sets `squeezes` to the squeeze of each clump; to none if no trigger needs it. Returns the number
/// of contacts read.
pub(super) fn find_squeezes(state: &State, squeezes: &mut Vec<Squeeze>) -> usize {
    squeezes.clear();
    let mut triggers = state.model.rules.triggers.iter().flatten();
    let Some(contacts) = &state.contacts else {
        return 0;
    };
    if !triggers.any(|trigger| trigger.needs_squeeze()) {
        return 0;
    }
    squeezes.resize(state.clumps.all.len(), Squeeze::default());
    of_pairs(state, contacts, squeezes) + of_walls(state, contacts, squeezes)
}

fn of_pairs(state: &State, contacts: &Contacts, squeezes: &mut [Squeeze]) -> usize {
    let (p, mut read) = (&state.particles, 0);
    let touching = contacts.pairs.iter().zip(&contacts.histories);
    for (&pair, history) in touching.filter(|(_, history)| history.overlap_m() > 0.0) {
        let clumps = pair.map(|i| state.clumps.carrier_of(i as usize));
        if clumps == [None; 2] {
            continue;
        }
        read += 1;
        let force_n = pair_force_n(contacts, p, pair, history);
        let [a, b] = pair.map(|i| &p.poses[i as usize]);
        let point = touch_point_m(a, b);
        for (clump, sign) in clumps.into_iter().zip([-1.0, 1.0]) {
            if let Some(clump) = clump {
                let centre = Vector3::from(state.clumps.all[clump].place_m);
                squeezes[clump].add(sign * force_n, point - centre);
            }
        }
    }
    read
}

fn of_walls(state: &State, contacts: &Contacts, squeezes: &mut [Squeeze]) -> usize {
    let (p, mut read) = (&state.particles, 0);
    for wall in &state.walls {
        let touching = wall.touching.iter();
        for touch in touching.filter(|touch| touch.history.overlap_m() > 0.0) {
            let Some(clump) = state.clumps.carrier_of(touch.particle as usize) else {
                continue;
            };
            read += 1;
            let force_n = touch_force_n(wall, contacts, p, touch);
            let point = walls::touch_point_m(p, touch);
            let centre = Vector3::from(state.clumps.all[clump].place_m);
            squeezes[clump].add(force_n, point - centre);
        }
    }
    read
}
