//! Contacts linearised for the time step limit: springs and dashpots at their present overlap, or
//! at that of an impact.

pub mod impact;

use nalgebra::{Matrix6, Vector3, Vector6};
use rayon::prelude::*;

use crate::stages::walls::wall_contact;
use crate::state::State;
use crate::state::bridges::Bridges;
use crate::state::clumps::{Clump, Template};
use crate::state::contacts::{ContactPartition, Contacts};
use crate::state::particles::{Motion, Particles, Wrench};
use crate::state::walls::{Wall, WallContact};
use dem_physics::contact::Linearised;
use dem_physics::contact::kinematics::{ContactKinematics, contact_kinematics, torques};
use dem_physics::contact::law::ContactKind;
use dem_physics::contact::law::Law;
use dem_physics::contact::liquid_bridge::LiquidBridge;
use dem_physics::rotation::rotation;

/// Translation and rotation of an end under a tangential force together: 1/m + R^2/I is this
/// multiple of 1/m for a sphere.
const WITH_ROTATION: f64 = 3.5;

/// Overlap over radius of a contact that hardly presses: far above rounding, and with Hertz's law
/// far below the stiffness of any bond.
const LEAST_OVERLAP: f64 = 1e-9;

/// A linearised contact.
#[derive(Debug, Clone, Copy)]
pub struct LinearContact {
    /// Its particles; None: a wall.
    ends: [Option<u32>; 2],
    touch: ContactKinematics,
    answer: Linearised,
}

/// All touching contacts and all liquid bridges of a state.
pub(crate) fn linear_contacts(state: &State) -> Vec<LinearContact> {
    let mut found = Vec::new();
    let p = &state.particles;
    if let Some(contacts) = &state.contacts {
        for (&pair, history) in contacts.pairs.iter().zip(&contacts.histories) {
            let overlap_m = history.overlap_m();
            if overlap_m > 0.0 {
                let [a, b] = pair.map(|end| end as usize);
                let apart = p.poses[b].place() - p.poses[a].place();
                let mut touch = contact_kinematics(
                    apart.into(),
                    [a, b].map(|i| p.contact_sphere_at_rest(i)),
                    0.0,
                );
                touch.overlap_m = overlap_m;
                let kind = &contacts.model.kinds[contacts.kind(pair)];
                found.push(LinearContact {
                    ends: pair.map(Some),
                    touch,
                    answer: kind.linearised(&touch),
                });
            }
        }
        for wall in &state.walls {
            let touching = wall.touching.iter();
            let touching = touching.filter(|touch| touch.history.overlap_m() > 0.0);
            found.extend(touching.map(|touch| at_wall(wall, touch, &contacts.materials, p)));
        }
        if let Some(bridges) = &state.bridges {
            found.extend(linear_bridges(state, contacts, bridges));
        }
    }
    found
}

/// Liquid bridges as springs between centres. Along the normal their stiffness is negative; its
/// magnitude counts, so that a step resolves how fast it pulls ends together or lets them go.
/// Across it, the pull holds like a string.
fn linear_bridges<'a>(
    state: &'a State,
    contacts: &'a Contacts,
    bridges: &'a Bridges,
) -> impl Iterator<Item = LinearContact> + 'a {
    let p = &state.particles;
    let linear = |ends, touch: ContactKinematics, law: LiquidBridge, gap_m: f64, length_m: f64| {
        let radius_m = touch.effective_radius_m;
        LinearContact {
            ends,
            touch: ContactKinematics {
                levers_m: [0.0; 2],
                ..touch
            },
            answer: Linearised {
                normal_n_m: law.fall_n_m(gap_m, radius_m),
                tangential_n_m: law.force_n(gap_m, radius_m) / length_m,
                ..Linearised::default()
            },
        }
    };
    let of_pairs = bridges.pairs.iter().filter_map(move |bridge| {
        let law = contacts.model.kinds[contacts.kind(bridge.pair)].bridge?;
        let [a, b] = bridge.pair.map(|end| end as usize);
        let apart = p.poses[b].place() - p.poses[a].place();
        let ends = [a, b].map(|i| p.contact_sphere_at_rest(i));
        let touch = contact_kinematics(apart.into(), ends, 0.0);
        Some(linear(
            bridge.pair.map(Some),
            touch,
            law,
            bridge.gap_m,
            apart.norm(),
        ))
    });
    let of_walls = bridges.walls.iter().filter_map(move |bridge| {
        let i = bridge.particle as usize;
        let law = state.walls[bridge.wall as usize]
            .kind(contacts.materials[i])
            .bridge?;
        let touch = wall_contact(p, i, &Vector3::from(bridge.normal), -bridge.gap_m);
        let length_m = p.poses[i].radius_m() + bridge.gap_m;
        let ends = [None, Some(bridge.particle)];
        Some(linear(ends, touch, law, bridge.gap_m, length_m))
    });
    of_pairs.chain(of_walls)
}

fn at_wall(
    wall: &Wall,
    there: &WallContact,
    materials: &[u8],
    particles: &Particles,
) -> LinearContact {
    let i = there.particle as usize;
    let overlap_m = there.history.overlap_m();
    let touch = wall_contact(particles, i, &Vector3::from(there.normal), overlap_m);
    let kind = wall.kind(materials[i]);
    LinearContact {
        ends: [None, Some(there.particle)],
        touch,
        answer: kind.linearised(&touch),
    }
}

/// An upper bound of the largest eigenvalues of stiffness over mass, 1/s2, and of damping over
/// mass, 1/s, of clumps: the largest of [`rates_of_clumps`]. 0 if no clump touches anything.
pub(crate) fn clump_rates(state: &State, contacts: &[LinearContact]) -> [f64; 2] {
    largest(rates_of_clumps(state, contacts))
}

fn largest(rates: impl IntoIterator<Item = [f64; 2]>) -> [f64; 2] {
    let both = |all: [f64; 2], one: [f64; 2]| [0, 1].map(|n| all[n].max(one[n]));
    rates.into_iter().fold([0.0; 2], both)
}

/// For each clump an upper bound of the largest eigenvalues of stiffness over mass, 1/s2, and of
/// damping over mass, 1/s: those of the clump alone, with twice the stiffness of its contacts with
/// particles and clumps, and once that of its contacts with walls.
///
/// For two ends joined by a spring, (u_a - u_b)^2 <= 2 u_a^2 + 2 u_b^2, as in [`contact_rates`].
fn rates_of_clumps(state: &State, contacts: &[LinearContact]) -> Vec<[f64; 2]> {
    let clumps = &state.clumps;
    let mut sums = vec![[Matrix6::zeros(); 2]; clumps.all.len()];
    for contact in contacts {
        for (end, side) in contact.ends.into_iter().zip([0, 1]) {
            let at = end.and_then(|i| clumps.carrier_of(i as usize));
            if let (Some(i), Some(at)) = (end, at) {
                let clump = &clumps.all[at];
                let centre = state.particles.poses[i as usize].place();
                contact.add_to_clump(&mut sums[at], clumps.template(clump), clump, centre, side);
            }
        }
    }
    let largest = |sum: Matrix6<f64>| sum.symmetric_eigenvalues().max().max(0.0);
    sums.into_iter().map(|both| both.map(largest)).collect()
}

impl LinearContact {
    /// Adds its stiffness and damping to those of the clump that carries one of its ends (0: the
    /// first, 1: the second), whose sphere is at `centre`, m: in the principal axes of the clump,
    /// divided by the square roots of its mass and moments. `sums`: stiffness, damping.
    fn add_to_clump(
        &self,
        sums: &mut [Matrix6<f64>; 2],
        template: &Template,
        clump: &Clump,
        centre: Vector3<f64>,
        side: usize,
    ) {
        let to_axes = rotation(clump.turned).inverse();
        let normal = Vector3::from(self.touch.normal);
        let lever_m = [1.0, -1.0][side] * self.touch.levers_m[side];
        let arm = to_axes * (centre + lever_m * normal - Vector3::from(clump.place_m));
        let per_root_kg = 1.0 / template.mass_kg.sqrt();
        let per_roots = Vector3::from(template.moments_kg_m2).map(|moment| 1.0 / moment.sqrt());
        let times = if self.ends.contains(&None) { 1.0 } else { 2.0 };
        let answer = &self.answer;
        let coefficients = [
            [
                answer.normal_n_m,
                answer.tangential_n_m,
                answer.rolling_n_m_rad,
            ],
            [
                answer.normal_damping_n_s_m,
                answer.tangential_damping_n_s_m,
                answer.rolling_damping_n_m_s,
            ],
        ];
        let normal = to_axes * normal;
        let axes = [Vector3::x(), Vector3::y(), Vector3::z(), normal];
        for (direction, is_normal) in axes.into_iter().zip([false, false, false, true]) {
            let turning = arm.cross(&direction).component_mul(&per_roots);
            let pushed = joined(per_root_kg * direction, turning);
            let rolled = joined(Vector3::zeros(), direction.component_mul(&per_roots));
            for (sum, [along, across, rolling]) in sums.iter_mut().zip(coefficients) {
                let (force, moment) = if is_normal {
                    (along - across, -rolling)
                } else {
                    (across, rolling)
                };
                sum.ger(times * force, &pushed, &pushed, 1.0);
                sum.ger(times * moment, &rolled, &rolled, 1.0);
            }
        }
    }
}

fn joined(first: Vector3<f64>, second: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(first.x, first.y, first.z, second.x, second.y, second.z)
}

/// The largest stiffness over effective mass, 1/s2, and damping over effective mass, 1/s, of any
/// one touching contact: as [`impact::at_impact`], at the overlaps that are there. 0 if nothing
/// touches.
pub fn stiffest_contact(state: &State) -> [f64; 2] {
    let inverse_kg = |end: u32| match state.clumps.carrier_of(end as usize) {
        Some(at) => {
            let template = state.clumps.template(&state.clumps.all[at]);
            template.landing().alone_per_kg
        }
        None => state.particles.motions[end as usize].inverse_mass,
    };
    let mut largest = [0.0_f64; 2];
    for contact in linear_contacts(state) {
        let ends = contact.ends.into_iter().flatten();
        let per_mass: f64 = ends.map(inverse_kg).sum();
        let of_one = translation(&contact.answer);
        largest = [0, 1].map(|n| largest[n].max(per_mass * of_one[n]));
    }
    largest
}

/// The largest stiffness, N/m, and damping, N s/m, against which a contact moves an end.
fn translation(answer: &Linearised) -> [f64; 2] {
    [
        (answer.normal_n_m).max(WITH_ROTATION * answer.tangential_n_m),
        (answer.normal_damping_n_s_m).max(WITH_ROTATION * answer.tangential_damping_n_s_m),
    ]
}

/// Upper bounds of the same eigenvalues for all contacts of a state together, of particles and of
/// clumps: fast to compute, but up to a few times too large.
///
/// For two ends joined by a spring, (u_a - u_b)^2 <= 2 u_a^2 + 2 u_b^2: so the bound for a particle
/// is twice the sum of its springs, and a clump takes the largest of its six modes.
pub fn contact_rates(state: &State) -> [f64; 2] {
    let [of_particles, of_clumps] = contact_rates_of_each(state);
    largest(of_particles.into_iter().chain(of_clumps))
}

/// The same bounds for each free particle, and for each clump.
pub(crate) fn contact_rates_of_each(state: &State) -> [Vec<[f64; 2]>; 2] {
    let contacts = linear_contacts(state);
    [
        rates_of_particles(state, &contacts),
        rates_of_clumps(state, &contacts),
    ]
}

fn rates_of_particles(state: &State, contacts: &[LinearContact]) -> Vec<[f64; 2]> {
    let p = &state.particles;
    let mut sums = vec![[0.0; 2]; p.free];
    for contact in contacts {
        for i in contact.ends.into_iter().flatten().map(|end| end as usize) {
            let Some(sum) = sums.get_mut(i) else { continue };
            let answer = &contact.answer;
            let motion = &p.motions[i];
            let turning = motion.inverse_inertia / motion.inverse_mass;
            let [stiffness, damping] = translation(answer);
            sum[0] += stiffness.max(turning * answer.rolling_n_m_rad);
            sum[1] += damping.max(turning * answer.rolling_damping_n_m_s);
        }
    }
    for (sum, motion) in sums.iter_mut().zip(&p.motions) {
        *sum = sum.map(|sum| 2.0 * sum * motion.inverse_mass);
    }
    sums
}

/// Weights of the two symmetric operators of a body in a sum.
#[derive(Debug, Clone, Copy)]
pub struct Weights {
    /// Weight of K, from displacements to forces.
    pub stiffness: f64,
    /// Weight of C, from velocities to forces.
    pub damping: f64,
}

/// Sets `wrenches` to the contact forces on particles with the displacements, or velocities,
/// `motions`; one of each for each particle.
pub(crate) fn linear_wrenches(
    contacts: &[LinearContact],
    weights: Weights,
    motions: &[Motion],
    wrenches: &mut [Wrench],
) {
    wrenches.fill(Wrench::default());
    let moving = |end: Option<u32>| end.map_or_else(Motion::default, |i| motions[i as usize]);
    for contact in contacts {
        let (touch, answer) = (&contact.touch, &contact.answer);
        let of = |stiffness: f64, damping: f64| {
            weights.stiffness * stiffness + weights.damping * damping
        };
        let along = of(answer.normal_n_m, answer.normal_damping_n_s_m);
        let across = of(answer.tangential_n_m, answer.tangential_damping_n_s_m);
        let rolling = of(answer.rolling_n_m_rad, answer.rolling_damping_n_m_s);

        let [a, b] = contact.ends.map(moving);
        let spins = [a, b].map(|m| Vector3::from(m.spin_rad_s));
        let velocities = [a, b].map(|m| Vector3::from(m.velocity_m_s));
        let n = Vector3::from(touch.normal);
        let [lever_a, lever_b] = touch.levers_m;
        let relative =
            velocities[1] - velocities[0] - (lever_a * spins[0] + lever_b * spins[1]).cross(&n);
        let closing = relative.dot(&n) * n;
        let force = -along * closing - across * (relative - closing);
        let turning = spins[1] - spins[0];
        let moment = -rolling * (turning - turning.dot(&n) * n);
        let on_ends = torques(touch, force.into(), moment.into());
        for ((end, torque), side) in contact.ends.into_iter().zip(on_ends).zip([-1.0, 1.0]) {
            if let Some(i) = end {
                wrenches[i as usize].add(&(side * force), &torque.into());
            }
        }
    }
}

/// The largest ratio of contact stiffness to effective mass, k (1/m_a + 1/m_b), of all touching
/// contacts, 1/s2: a measure of how far the limit may have fallen since this was smaller. 0 if
/// nothing touches. Contacts not stiffer than `matters` may be skipped.
pub fn largest_contact_rate_1_s2(state: &State, matters: StiffestContacts) -> f64 {
    let Some(contacts) = &state.contacts else {
        return 0.0;
    };
    let p = &state.particles;
    let of_pair = |kind: &ContactKind, at: usize, overlap_m: f64| {
        let [a, b] = contacts.pairs[at].map(|end| end as usize);
        let [ra, rb] = [a, b].map(|i| p.poses[i].radius_m());
        let per_mass = p.motions[a].inverse_mass + p.motions[b].inverse_mass;
        kind.normal_n_m(overlap_m, ra * rb / (ra + rb)) * per_mass
    };
    let least_m: Vec<f64> = (contacts.model.kinds.iter())
        .map(|kind| matters.least_overlap_m(&kind.law))
        .collect();
    // Whatever touches was close at the last check of all pairs.
    let of_partition = |partition: &ContactPartition| {
        let mut largest = 0.0_f64;
        for ((kind, [_, own]), least_m) in contacts
            .model
            .kinds
            .iter()
            .zip(&partition.close)
            .zip(&least_m)
        {
            for at in own.iter().map(|&at| at as usize) {
                let overlap_m = contacts.histories[at].overlap_m();
                if overlap_m > *least_m {
                    largest = largest.max(of_pair(kind, at, overlap_m));
                }
            }
        }
        largest
    };
    let partitions = state.contact_partitions();
    let of_pairs = (partitions.par_iter().map(of_partition)).reduce(|| 0.0, f64::max);
    let of_walls = state.walls.iter().flat_map(|wall| {
        wall.touching.iter().map(|touch| {
            let i = touch.particle as usize;
            let kind = wall.kind(contacts.materials[i]);
            let overlap_m = touch.history.overlap_m();
            kind.normal_n_m(overlap_m, p.poses[i].radius_m()) * p.motions[i].inverse_mass
        })
    });
    of_walls.fold(of_pairs, f64::max)
}

/// Contacts that matter for a step: those that are stiffer than contacts have been.
#[derive(Debug, Clone, Copy)]
pub struct StiffestContacts {
    /// Ratio of stiffness to mass that contacts have had, 1/s2.
    pub above_1_s2: f64,
    /// Largest radius, m, and largest inverse mass, 1/kg, that exist or will exist; none: unknown.
    pub extremes: Option<[f64; 2]>,
}

impl StiffestContacts {
    /// All contacts matter.
    pub const ALL: Self = Self {
        above_1_s2: 0.0,
        extremes: None,
    };

    /// Overlap up to which no contact of a law matters, m: not even one between two particles with
    /// the largest radius and the smallest mass.
    fn least_overlap_m(&self, law: &Law) -> f64 {
        let Some([radius_m, inverse_kg]) = self.extremes else {
            return 0.0;
        };
        let stiffness_n_m = 0.5 * self.above_1_s2 / inverse_kg;
        law.at_impact()
            .overlap_of_stiffness_m(stiffness_n_m, 0.5 * radius_m)
    }
}
