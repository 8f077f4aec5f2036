//! How contacts squeeze clumps: between two jaws their forces cancel, and only the single forces
//! and the stress tell.

use nalgebra::{Matrix3, Vector3};

use super::contacts::{self, pair_force_n};
use super::walls::{self, touch_force_n};
use crate::state::State;
use crate::state::contacts::Contacts;

/// The contacts of a clump at the end of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Squeeze {
    /// Largest force of a single contact, N.
    pub(super) largest_n: f64,
    /// Sum over the contacts of their force times the way from the clump's centre to the contact
    /// point (dyadic products), N m: the mean stress (Love 1927, Weber 1966) times the volume.
    moment_n_m: Matrix3<f64>,
}

impl Squeeze {
    /// Largest principal value, by magnitude, of the mean stress in this volume, m3, in Pa. The
    /// antisymmetric part, which belongs to a torque on the clump, is left out.
    pub(super) fn principal_stress_pa(&self, volume_m3: f64) -> f64 {
        let symmetric = 0.5 * (self.moment_n_m + self.moment_n_m.transpose());
        symmetric.symmetric_eigenvalues().amax() / volume_m3
    }

    fn add(&mut self, force_n: Vector3<f64>, arm_m: Vector3<f64>) {
        self.largest_n = self.largest_n.max(force_n.norm());
        self.moment_n_m += force_n * arm_m.transpose();
    }
}

/// The squeeze of each clump, and the number of contacts read for it; none if no trigger needs it.
pub(super) fn squeezes(state: &State) -> (Vec<Squeeze>, usize) {
    let mut triggers = state.model.rules.triggers.iter().flatten();
    let Some(contacts) = &state.contacts else {
        return (Vec::new(), 0);
    };
    if !triggers.any(|trigger| trigger.needs_squeeze()) {
        return (Vec::new(), 0);
    }
    let mut squeezes = vec![Squeeze::default(); state.clumps.all.len()];
    let read = of_pairs(state, contacts, &mut squeezes) + of_walls(state, contacts, &mut squeezes);
    (squeezes, read)
}

/// The clump of a particle. None: it is free.
fn clump_of(state: &State, particle: u32) -> Option<usize> {
    let clumps = &state.clumps.all;
    clumps
        .partition_point(|clump| clump.first <= particle)
        .checked_sub(1)
}

fn of_pairs(state: &State, contacts: &Contacts, squeezes: &mut [Squeeze]) -> usize {
    let (p, mut read) = (&state.particles, 0);
    let touching = contacts.pairs.iter().zip(&contacts.histories);
    for (&pair, history) in touching.filter(|(_, history)| history.overlap_m() > 0.0) {
        let clumps = pair.map(|i| clump_of(state, i));
        if clumps == [None; 2] {
            continue;
        }
        read += 1;
        let force_n = pair_force_n(contacts, p, pair, history);
        let [a, b] = pair.map(|i| &p.poses[i as usize]);
        let point = contacts::touch_point_m(a, b);
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
            let Some(clump) = clump_of(state, touch.particle) else {
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
