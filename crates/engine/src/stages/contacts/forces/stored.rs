//! Elastic energies, forces and losses of contacts.

use crate::stages::chunks::{add, ordered_sum, ordered_sums};
use crate::state::contacts::{ContactHistory, Contacts};
use crate::state::particles::{Particles, Pose};
use crate::state::renumbered::{NewNumbers, Renumbered};
use dem_physics::contact::NormalLaw;
use dem_physics::contact::kinematics::{ContactKinematics, contact_kinematics};
use dem_physics::contact::law::{ContactKind, ContactWork};
use dem_physics::contact::rolling::RollingFriction;
use nalgebra::Vector3;

/// Overlap of two particles, m; below 0 if they are apart.
pub fn overlap_m(poses: &[Pose], pair: [u32; 2]) -> f64 {
    let [a, b] = pair.map(|i| &poses[i as usize]);
    a.radius_m() + b.radius_m() - (b.place() - a.place()).norm()
}

/// Elastic energy of all contacts, J. Summed by particle, so that near pairs without contact, which
/// may differ in a resumed run, do not change its last bit.
pub fn elastic_energy_j(contacts: &Contacts, particles: &Particles) -> f64 {
    let mut firsts = vec![0; particles.len() + 1];
    for &[a, _] in &contacts.pairs {
        firsts[a as usize + 1] += 1;
    }
    for i in 0..particles.len() {
        firsts[i + 1] += firsts[i];
    }
    ordered_sum(particles.len(), |i| {
        (firsts[i]..firsts[i + 1])
            .map(|at| contact_energy_j(contacts, particles, at))
            .sum()
    })
}

/// Elastic energy of contact `at`, J.
pub fn contact_energy_j(contacts: &Contacts, particles: &Particles, at: usize) -> f64 {
    if contacts.histories[at] == ContactHistory::default() {
        return 0.0;
    }
    let (pair, history) = (contacts.pairs[at], &contacts.histories[at]);
    let touch = stored_touch(particles, pair, history);
    let kind = &contacts.model.kinds[contacts.kind(pair)];
    kind.with(|number| number, StoredEnergy { touch, history })
}

/// A pair at rest, with the overlap in its history.
fn stored_touch(
    particles: &Particles,
    pair: [u32; 2],
    history: &ContactHistory,
) -> ContactKinematics {
    let ends = pair.map(|end| end as usize);
    let [a, b] = ends.map(|i| particles.poses[i].place());
    let balls = ends.map(|i| particles.contact_sphere_at_rest(i));
    let mut touch = contact_kinematics((b - a).into(), balls, 0.0);
    touch.overlap_m = history.overlap_m();
    touch
}

/// Part of the energy of these pairs that is adhesion, J: below 0.
pub(crate) fn pairs_adhesion_j<'a>(
    contacts: &Contacts,
    particles: &Particles,
    pairs: impl Iterator<Item = (&'a [u32; 2], &'a ContactHistory)>,
) -> f64 {
    let kinds = &contacts.model.kinds;
    if !kinds.iter().any(ContactKind::attracts) {
        return 0.0;
    }
    let adhesion_j = |(&pair, history): (&[u32; 2], &ContactHistory)| {
        let touch = stored_touch(particles, pair, history);
        kinds[contacts.kind(pair)].adhesion_j(&touch)
    };
    let touching = pairs.filter(|(_, history)| **history != ContactHistory::default());
    touching.map(adhesion_j).sum()
}

/// Where two particles touch, m: in the middle of their overlap, on the line between their centres.
pub fn touch_point_m(one: &Pose, other: &Pose) -> Vector3<f64> {
    let apart = other.place() - one.place();
    let distance_m = apart.norm();
    let lever_m = 0.5 * (distance_m + one.radius_m() - other.radius_m());
    one.place() + lever_m / distance_m * apart
}

/// Force of a contact on the second of a pair, N, from its history.
pub fn pair_force_n(
    contacts: &Contacts,
    particles: &Particles,
    pair: [u32; 2],
    history: &ContactHistory,
) -> Vector3<f64> {
    let touch = stored_touch(particles, pair, history);
    let kind = &contacts.model.kinds[contacts.kind(pair)];
    kind.with(|number| number, StoredForce { touch, history })
}

/// Force of a contact on its second end, between two particles or a wall and a particle, from its
/// history, N.
pub(in crate::stages) struct StoredForce<'a> {
    /// At the overlap in the history.
    pub(in crate::stages) touch: ContactKinematics,
    pub(in crate::stages) history: &'a ContactHistory,
}

impl ContactWork<f64> for StoredForce<'_> {
    type Output = Vector3<f64>;

    fn with(self, law: &impl NormalLaw<f64>, _: &impl RollingFriction<f64>) -> Vector3<f64> {
        let Self { touch, history } = self;
        let normal_response = law.evaluate(&touch, touch.overlap_m, 0.0);
        let vector = |[x, y, z, _]: [f64; 4]| Vector3::new(x, y, z);
        let normal = Vector3::from(touch.normal) * normal_response.elastic_n;
        normal - vector(history.tangential) * normal_response.tangential_n_m[1]
            + vector(history.damping)
    }
}

/// Elastic energy of a contact, between two particles or a particle and a wall, from its history,
/// J.
pub(in crate::stages) struct StoredEnergy<'a> {
    /// At the overlap in the history.
    pub(in crate::stages) touch: ContactKinematics,
    pub(in crate::stages) history: &'a ContactHistory,
}

impl ContactWork<f64> for StoredEnergy<'_> {
    type Output = f64;

    fn with(self, law: &impl NormalLaw<f64>, rolling: &impl RollingFriction<f64>) -> f64 {
        let Self { touch, history } = self;
        let normal_response = law.evaluate(&touch, touch.overlap_m, 0.0);
        let [stiffness, _] = rolling.linearised(&normal_response, &touch);
        let square = |[x, y, z, _]: [f64; 4]| x * x + y * y + z * z;
        normal_response.energy_j
            + 0.5 * normal_response.tangential_n_m[1] * square(history.tangential)
            + 0.5 * stiffness * square(history.rolling)
    }
}

/// Energy lost to friction and to damping so far, J.
pub fn lost_j(contacts: &Contacts) -> [f64; 2] {
    let [friction, damping] = ordered_sums(contacts.lost_j.len(), |i| contacts.lost_j[i]);
    let [gone_friction, gone_damping] = contacts.lost_by_removed_j;
    [friction + gone_friction, damping + gone_damping]
}

impl Renumbered for Contacts {
    fn renumber(&mut self, by: &NewNumbers<'_>) {
        let old_materials = std::mem::take(&mut self.materials);
        let old_lost_j = std::mem::take(&mut self.lost_j);
        let materials = by.materials_of_new.iter();
        self.materials = materials.map(|material| material.unwrap_or(0)).collect();
        self.lost_j = vec![[0.0; 2]; by.poses.len()];
        for ((&now, material), lost_j) in by.now.iter().zip(old_materials).zip(old_lost_j) {
            let booked = match self.lost_j.get_mut(now as usize) {
                Some(place) => {
                    self.materials[now as usize] = material;
                    place
                }
                None => &mut self.lost_by_removed_j,
            };
            *booked = add(*booked, lost_j);
        }
        let pairs = self.pairs.iter().zip(&self.histories);
        let mut remembered: Vec<([u32; 2], ContactHistory)> = pairs
            .filter_map(|(pair, history)| renumbered_pair(by, *pair, history))
            .collect();
        remembered.sort_unstable_by_key(|(pair, _)| *pair);
        (self.pairs, self.histories) = remembered.into_iter().unzip();
        self.divide(by.poses.len(), by.partitions);
    }
}

/// A pair with its history under new numbers. None: one of its particles is gone.
fn renumbered_pair(
    by: &NewNumbers<'_>,
    pair: [u32; 2],
    history: &ContactHistory,
) -> Option<([u32; 2], ContactHistory)> {
    let [Some(a), Some(b)] = pair.map(|end| by.of(end)) else {
        return None;
    };
    let pair = [a.min(b), a.max(b)];
    let mut history = if a < b { *history } else { history.reversed() };
    if pair.iter().any(|i| by.is_new(*i)) && history.overlap_m() > 0.0 {
        // Contact spheres of clumps may be larger than those of clusters.
        let now_m = overlap_m(by.poses, pair) - history.origin_m();
        history.tangential[3] = now_m.max(0.0).min(history.tangential[3]);
    }
    Some((pair, history))
}
