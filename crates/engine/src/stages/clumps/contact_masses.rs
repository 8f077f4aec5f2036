//! The mass with which contacts of clumps are damped.
//!
//! A dashpot c = 2 zeta sqrt(k m) gives a motion of circular frequency w the damping ratio zeta if
//! w^2 = k/m. A clump that lands on n contacts vibrates on all of them: so w follows from all that
//! touch it in the step, and each of them has its mass k/w^2.
//!
//! With the direction g = (n, r x n) of a contact, its stiffness k, and the speed s at which its
//! ends approach, contacts change the force on the clump by F = sum k s g in a second, and itself
//! accelerates what they feel:
//!
//!   w^2 = (F M^-1 F) / (sum k s^2),
//!
//! Rayleigh's quotient of the motion that is made: exact for a contact alone (k times the inverse
//! mass at its point), and for contacts in a mode of the clump on its springs. It lies between 0
//! and T = sum k (g M^-1 g), the sum of the squares of all six frequencies. Pushes that balance
//! each other, as of two plates that press, accelerate nothing: there it is at least their mean,
//! T/6, so that no mode is damped by more than sqrt(6) zeta.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use crate::stages::walls::{chunks, velocity_at};
use crate::state::State;
use crate::state::clump_touches::ClumpTouch;
use crate::state::clumps::{Clump, Clumps, Template};
use crate::state::contacts::{ContactPartition, Contacts};
use crate::state::meetings::Meetings;
use crate::state::particles::{Motion, Particles, Pose};
use crate::state::walls::Wall;
use crate::threads::for_each;
use dem_physics::contact::law::ContactKind;
use dem_physics::contact::relaxation::relaxed;
use dem_physics::rotation::rotation;

/// Clumps handled by one task.
const CHUNK: usize = 32;
/// Smallest square of the frequency, relative to the sum of all six.
const LEAST: f64 = 1.0 / 6.0;

/// Sets the inverse masses and moments of inertia with which contacts see the spheres of clumps in
/// this step. Single spheres keep theirs.
pub(crate) fn share_masses(state: &mut State) -> usize {
    let Some(contacts) = &state.contacts else {
        return 0;
    };
    let is_single = |template: &Arc<Template>| template.spheres.len() == 1;
    if state.clumps.templates.iter().all(is_single) {
        return 0;
    }
    let p = &mut state.particles;
    let touches = &mut state.scratch.clump_touches;
    // All are cleared once they have been used.
    touches.resize(p.len() - p.free, ClumpTouch::default());
    if touches.is_empty() {
        return 0;
    }
    if !contacts.model.alone {
        let seen = Seen {
            contacts,
            particles: p,
            checks_all: contacts.scratch.close_skin_left_m <= 0.0,
        };
        seen.add_pairs(&contacts.scratch.partitions, touches);
    }
    let in_use = state.scratch.meetings.iter();
    for meetings in in_use.take(chunks(&state.walls)) {
        add_walls(&state.walls, meetings, contacts, p, touches);
    }
    let free = p.free;
    let part = Part {
        clumps: &state.clumps.all,
        motions: &mut p.motions[free..],
        touches,
        first: free,
    };
    for_each(part.divided(), |part| {
        part.set_masses(&state.clumps, &p.poses);
    });
    0
}

/// What the search for touching pairs reads.
struct Seen<'a> {
    contacts: &'a Contacts,
    particles: &'a Particles,
    /// Whether all pairs are to be checked: the close ones are not known.
    checks_all: bool,
}

impl Seen<'_> {
    /// Adds the pairs of these partitions to `touches`, those of the spheres of clumps among their
    /// particles. In an order that does not depend on the partitions.
    fn add_pairs(&self, partitions: &[ContactPartition], mut touches: &mut [ClumpTouch]) {
        let free = self.particles.free;
        let parts = partitions.iter().map(|partition| {
            let Range { start, end } = partition.particles.clone();
            let own = touches.split_off_mut(..end.max(free) - start.max(free));
            (partition, own.unwrap_or_default())
        });
        for_each(parts, |(partition, touches)| {
            self.add_partition(partition, touches);
        });
    }

    fn add_partition(&self, partition: &ContactPartition, touches: &mut [ClumpTouch]) {
        let pairs = &self.contacts.pairs;
        for (kind, contact) in self.contacts.model.kinds.iter().enumerate() {
            let mut add = |at: usize| self.add_pair(contact, at, partition, touches);
            if self.checks_all {
                let is_meant = |at: &usize| self.contacts.kind(pairs[*at]) == kind;
                let of_border = partition.border.iter().map(|&at| at as usize);
                of_border.filter(is_meant).for_each(&mut add);
                partition.own.clone().filter(is_meant).for_each(add);
            } else {
                let [of_border, own] = &partition.close[kind];
                let of_border = of_border.iter().map(|&n| partition.border[n as usize]);
                of_border.for_each(|at| add(at as usize));
                own.iter().for_each(|&at| add(at as usize));
            }
        }
    }

    #[inline]
    fn add_pair(
        &self,
        kind: &ContactKind,
        at: usize,
        partition: &ContactPartition,
        touches: &mut [ClumpTouch],
    ) {
        let p = self.particles;
        let ends = self.contacts.pairs[at].map(|end| end as usize);
        if ends[1] < p.free {
            return;
        }
        let [a, b] = ends.map(|i| &p.poses[i]);
        let apart = b.place() - a.place();
        let reach_m = a.radius_m() + b.radius_m();
        let square = apart.norm_squared();
        if square >= reach_m * reach_m {
            return;
        }
        let awake = ends.map(|i| !p.sleeps(i));
        let length_m = square.sqrt();
        let radius_m = a.radius_m() * b.radius_m() / reach_m;
        let origin_m = self.contacts.histories[at].origin_m();
        let least_m = self.contacts.model.least_overlap * radius_m;
        let overlap_m = relaxed(reach_m - length_m, origin_m, least_m).overlap_m;
        if overlap_m <= 0.0 {
            return;
        }
        let stiffness_n_m = kind.normal_n_m(overlap_m, radius_m);
        let normal = apart / length_m;
        let [va, vb] = ends.map(|i| Vector3::from(p.motions[i].velocity_m_s));
        let velocity = vb - va;
        let first = partition.particles.start.max(p.free);
        for (i, is_awake) in ends.into_iter().zip(awake) {
            let is_own = is_awake && partition.particles.contains(&i);
            let at = i.checked_sub(first).filter(|_| is_own);
            if let Some(touch) = at.and_then(|n| touches.get_mut(n)) {
                touch.add(&normal, stiffness_n_m, &velocity);
            }
        }
    }
}

/// Adds the contacts of spheres of clumps with a wall.
fn add_walls(
    walls: &[Wall],
    meetings: &Meetings,
    contacts: &Contacts,
    particles: &Particles,
    touches: &mut [ClumpTouch],
) {
    let wall = &walls[meetings.of.0];
    for meeting in &meetings.all {
        let i = meeting.particle as usize;
        let Some(touch) = (i.checked_sub(particles.free)).and_then(|n| touches.get_mut(n)) else {
            continue;
        };
        let radius_m = particles.poses[i].radius_m();
        let before = meeting
            .old_wall
            .map_or(wall, |number| &walls[number as usize]);
        let old = meeting
            .old
            .map(|old| &before.touching[old as usize].history);
        let origin_m = old.map_or(0.0, |history| history.origin_m());
        let least_m = contacts.model.least_overlap * radius_m;
        let overlap_m = relaxed(radius_m - meeting.there.distance_m, origin_m, least_m).overlap_m;
        if overlap_m > 0.0 {
            let kind = wall.kind(contacts.materials[i]);
            let normal = -Vector3::from(meeting.there.normal);
            let velocity = Vector3::from(particles.motions[i].velocity_m_s)
                - velocity_at(wall, &meeting.there.point.into());
            touch.add(&normal, kind.normal_n_m(overlap_m, radius_m), &velocity);
        }
    }
}

/// Some clumps in their order, and what belongs to their spheres.
struct Part<'a> {
    clumps: &'a [Clump],
    motions: &'a mut [Motion],
    touches: &'a mut [ClumpTouch],
    /// Number of the first of their spheres among the particles.
    first: usize,
}

impl Part<'_> {
    /// Divided into parts of as many clumps as a task handles.
    fn divided(self) -> impl Iterator<Item = Self> {
        let (mut first, end) = (self.first, self.first + self.touches.len());
        let (mut motions, mut touches) = (self.motions, self.touches);
        let mut chunks = self.clumps.chunks(CHUNK).peekable();
        std::iter::from_fn(move || {
            let clumps = chunks.next()?;
            let next = chunks.peek().map_or(end, |next| next[0].first as usize);
            let count = next - first;
            let part = Self {
                clumps,
                motions: motions.split_off_mut(..count)?,
                touches: touches.split_off_mut(..count)?,
                first,
            };
            first = next;
            Some(part)
        })
    }

    fn set_masses(self, all: &Clumps, poses: &[Pose]) {
        let awake = self.clumps.iter().filter(|clump| !clump.asleep);
        for clump in awake {
            let template = all.template(clump);
            let [from, to] = clump.near.map(|n| n as usize);
            let near = &all.near[from..to];
            let is_single = template.spheres.len() == 1;
            let touched = |i: &u32| self.touches[*i as usize - self.first].count > 0;
            let squared = if !is_single && near.iter().any(touched) {
                let touches = near.iter().map(|&i| {
                    let place = poses[i as usize].place();
                    (&self.touches[i as usize - self.first], place)
                });
                squared_frequency(template, clump, touches)
            } else {
                (0, 0.0)
            };
            let inert = template.inert();
            for i in near.iter().map(|&i| i as usize - self.first) {
                let touch = std::mem::take(&mut self.touches[i]);
                let motion = &mut self.motions[i];
                [motion.inverse_mass, motion.inverse_inertia] =
                    shared(inert, squared, &touch, is_single);
            }
        }
    }
}

/// Inverse mass and inverse moment of inertia of a sphere of a clump with these inverses,
/// `inert`, and this number of contacts and square of the frequency, 1/s2.
///
/// A sphere that has several contacts takes their mean stiffness. Moments against rolling act on
/// the whole clump: each of its contacts has its share of the moment of inertia.
fn shared(
    inert: [f64; 2],
    (contacts, squared_1_s2): (u32, f64),
    touch: &ClumpTouch,
    is_single: bool,
) -> [f64; 2] {
    if touch.count == 0 || is_single {
        return inert;
    }
    let mean_n_m = touch.sum_n_m() / f64::from(touch.count);
    [squared_1_s2 / mean_n_m, f64::from(contacts) * inert[1]]
}

/// Number of the contacts of a clump, and the square of the frequency of its motion on them, 1/s2.
/// `touches`: what touches its spheres, and their centres, m.
fn squared_frequency<'a>(
    template: &Template,
    clump: &Clump,
    touches: impl Iterator<Item = (&'a ClumpTouch, Vector3<f64>)>,
) -> (u32, f64) {
    let turned = rotation(clump.turned).to_rotation_matrix();
    let per_moments = Vector3::from(template.moments_kg_m2.map(|moment| 1.0 / moment));
    let inverse_inertia =
        turned.matrix() * Matrix3::from_diagonal(&per_moments) * turned.matrix().transpose();
    let centre = Vector3::from(clump.place_m);
    let (mut count, mut sum, mut rate_w_s) = (0, 0.0, 0.0);
    let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
    for (touch, place) in touches.filter(|(touch, _)| touch.count > 0) {
        let arm = place - centre;
        let turning = arm.cross_matrix();
        let per_turn = turning.transpose() * inverse_inertia * turning;
        sum += touch.sum_n_m() / template.mass_kg + per_turn.dot(&touch.matrix_n_m());
        count += touch.count;
        rate_w_s += touch.rate_w_s;
        let rate = Vector3::from(touch.rate_n_s);
        force += rate;
        torque += arm.cross(&rate);
    }
    if count == 1 || rate_w_s <= 0.0 {
        return (count, sum);
    }
    let accelerated =
        force.norm_squared() / template.mass_kg + torque.dot(&(inverse_inertia * torque));
    (count, (accelerated / rate_w_s).clamp(LEAST * sum, sum))
}
