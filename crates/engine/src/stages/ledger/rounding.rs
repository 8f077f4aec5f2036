//! Energies below which all is rounding: a millionth of stretch in each bond, and of overlap for
//! each particle that can touch something.

use crate::stages::chunks::ordered_sum;
use crate::state::State;
use crate::state::contacts::Contacts;
use crate::state::walls::Wall;
use dem_physics::contact::law::ContactKind;

/// The types of contacts among particles and with walls.
pub(super) fn all_kinds<'a>(contacts: &'a Contacts, walls: &'a [Wall]) -> Vec<&'a ContactKind> {
    let of_walls = walls.iter().flat_map(|wall| &wall.model.kinds);
    contacts.model.kinds.iter().chain(of_walls).collect()
}

/// Energy of bond `at`, stretched by a millionth of its length, J.
pub(super) fn stretched_j(state: &State, at: usize) -> f64 {
    let stretch = 1e-6 * state.bonds.initial_length_m(at);
    0.5 * state.bonds.normal(at) * stretch * stretch
}

/// Energy of all bonds, stretched by a millionth of their lengths, J.
pub(super) fn stretched_by_a_millionth_j(state: &State) -> f64 {
    ordered_sum(state.bonds.len(), |at| stretched_j(state, at))
}

/// Energy of a contact of particle `i` at an overlap of a millionth of its radius, by the stiffest
/// law, J.
pub(super) fn pressed_j(state: &State, kinds: &[&ContactKind], i: usize) -> f64 {
    let radius_m = state.particles.poses[i].radius_m();
    let overlap_m = 1e-6 * radius_m;
    let stiffness = kinds
        .iter()
        .map(|kind| kind.normal_n_m(overlap_m, radius_m));
    0.5 * stiffness.fold(0.0, f64::max) * overlap_m * overlap_m
}

/// Contact energy of all particles at an overlap of a millionth of their radii, by the stiffest law
/// of the scene, J; 0 if nothing can touch.
pub(super) fn pressed_by_a_millionth_j(state: &State) -> f64 {
    let Some(contacts) = &state.contacts else {
        return 0.0;
    };
    let kinds = all_kinds(contacts, &state.walls);
    ordered_sum(state.particles.len(), |i| pressed_j(state, &kinds, i))
}
