//! The largest stable time step: from the largest eigenvalue of the linearised system, found by
//! Lanczos' method on the real forces.

use dem_io::random::uniform;
use dem_scene::Hold;
use nalgebra::{DMatrix, SymmetricEigen};
use serde::{Deserialize, Serialize};

use crate::check::linearised_contacts::{
    LinearContact, Weights, clump_rates, linear_contacts, linear_wrenches,
};
use crate::stages::bonds::forces::bond_wrenches;
use crate::stages::bonds::plasticity::add_elasto_plastic_wrenches;
use crate::stages::bonds::viscous_kernel::damping_wrenches;
use crate::state::State;
use crate::state::bonds::{BLOCK, BondBlock, BondLaw, BondRule, Bonds};
use crate::state::damping_rate::{MORE, largest_coefficients};
use crate::state::particles::{Motion, Pose, Wrench};
use dem_physics::rigid::turn;

/// Iterations at least and at most.
pub(super) const ITERATIONS: [usize; 2] = [20, 200];
/// Beyond the least number of iterations, one in so many asks whether it was enough.
const EVERY: usize = 5;
/// Displacement for the difference quotient, in radii, and rotation, of particles and of the axes
/// of bonds, in radians.
const STEP: f64 = 1e-5;

/// Largest distance from 1 of the eigenvalue at which the search for a damped limit ends, and most
/// eigenvalues computed for it.
const NEAR: f64 = 1e-3;
const TRIES: usize = 8;

/// How well an eigenvalue is to be known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Search {
    /// As well as a limit needs it.
    Fine,
    /// Where a thousandth does not matter, as of a bound near a step that is to say whether there
    /// is room: with one difference for two.
    Rough,
}

impl Search {
    /// Largest residual over eigenvalue at which the search ends. At 1e-4 it can end at the second
    /// largest eigenvalue, 1e-3 below the largest, in a damped body; ten iterations more cost
    /// little.
    fn residual(self) -> f64 {
        match self {
            Self::Fine => 1e-5,
            Self::Rough => 1e-4,
        }
    }
}

/// What was found of the largest stable step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Largest stable step, s. Infinite where nothing vibrates.
    pub step_s: f64,
    /// The same without damping of contacts and particles, s.
    pub undamped_step_s: f64,
    /// Largest circular frequency, rad/s.
    pub omega_rad_s: f64,
    /// Largest eigenvalue of the damping of contacts over mass, 1/s.
    pub damping_1_s: f64,
    /// Iterations needed for the frequency.
    pub iterations: usize,
    /// Iterations in all, those for damping included: each takes the forces of all bonds twice, or
    /// the damping of contacts, or both.
    pub all_iterations: usize,
}

/// A step that is not above the largest stable one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Bound {
    /// s.
    pub step_s: f64,
    /// Whether contacts were there, which may be damped.
    pub is_damped: bool,
}

/// The limit of kick-drift-kick for the state as it stands: the largest dt at which no eigenvalue
/// of M^-1 (dt^2/4 K + dt/2 C) is above 1, with the dashpots C of contacts. Those of bonds do not
/// matter: see [`crate::stages::bonds::damping`].
///
/// At the limit the fastest mode turns round in every step: x, -x, x. Its velocity is then always
/// against its force, which damping of particles raises by a fraction: K counts 1 + gamma times.
///
/// Bonds of the incremental formulation count with the stiffness of the total one, which is the
/// same. Contacts count at the overlap that they have, stuck. Afterwards no wrench acts on any
/// particle.
/// Rigid parts are taken as bonded. They only restrict the motion of the bonded body, and its mass
/// and stiffness for the motions that are left are the same: so the largest eigenvalue is not above
/// that of the whole bonded body (Rayleigh), and the limit is safe wherever the bonded zone is.
pub fn limit(state: &mut State) -> Limit {
    with_all_bonds(state, limit_of_bonded)
}

/// Takes rigid parts as bonded for a while.
fn with_all_bonds<T>(state: &mut State, found: impl FnOnce(&mut State) -> T) -> T {
    if state.rigid_parts.is_empty() {
        return found(state);
    }
    let parts = std::mem::take(&mut state.rigid_parts);
    state.divide_bonds();
    let result = found(state);
    state.rigid_parts = parts;
    state.divide_bonds();
    result
}

fn limit_of_bonded(state: &mut State) -> Limit {
    let contacts = &linear_contacts(state);
    let damaged = undamage(&mut state.bonds);
    let (k, iterations) = largest_eigenvalue(state, contacts, Weights::STIFFNESS, Search::Fine);
    let stiffer = stiffer_by_damping(state);
    let (c, of_damping) = if contacts.is_empty() {
        (0.0, 0)
    } else {
        largest_eigenvalue(state, contacts, Weights::DAMPING, Search::Fine)
    };
    let (step_s, of_both) = if c > 0.0 {
        damped_limit(state, contacts, stiffer, safe_step(stiffer * k, c))
    } else {
        (safe_step(stiffer * k, 0.0), 0)
    };
    let of_particles = Limit {
        step_s,
        undamped_step_s: safe_step(k, 0.0),
        omega_rad_s: k.sqrt(),
        damping_1_s: c,
        iterations,
        all_iterations: iterations + of_damping + of_both,
    };
    let limit = Limit {
        step_s: of_particles.bound().with_more(clump_rates(state, contacts)),
        ..of_particles
    };
    restore_stiffness(&mut state.bonds, damaged);
    clear_trial_wrenches(state);
    limit
}

/// A step that is not above the limit, or by less than a thousandth, and not below this one, s,
/// unless the limit is: found in a fraction of the time that the limit takes. What counts is said
/// at [`limit`].
pub fn bound_near(state: &mut State, step_s: f64) -> Bound {
    with_all_bonds(state, |state| bound_near_of_bonded(state, step_s))
}

fn bound_near_of_bonded(state: &mut State, step_s: f64) -> Bound {
    let contacts = &linear_contacts(state);
    let both = Weights::of_step(stiffer_by_damping(state), step_s);
    let damaged = undamage(&mut state.bonds);
    let (value, _) = largest_eigenvalue(state, contacts, both, Search::Rough);
    restore_stiffness(&mut state.bonds, damaged);
    let is_damped = !contacts.is_empty();
    let of_particles = Bound {
        step_s: not_too_long(step_s, value),
        is_damped,
    };
    let step_s = of_particles.with_more(clump_rates(state, contacts));
    clear_trial_wrenches(state);
    Bound { step_s, is_damped }
}

/// Damping of particles always acts against the fastest mode: see [`limit`].
fn stiffer_by_damping(state: &State) -> f64 {
    if state.scratch.particle_resistance.is_empty() {
        1.0
    } else {
        1.0 + state.model.particle_damping
    }
}

/// Makes damaged bonds as stiff as before they were damaged: pressed they are. Returns what they
/// were; None: there are none.
fn undamage(bonds: &mut Bonds) -> Option<Vec<BondBlock>> {
    if bonds.damaged.is_empty() {
        return None;
    }
    let before = bonds.blocks.clone();
    for number in 0..bonds.damaged.len() {
        let at = bonds.damaged[number] as usize;
        let known = bonds.undamaged_stiffness(at);
        let (block, lane) = (&mut bonds.blocks[at / BLOCK], at % BLOCK);
        block.normal[lane] = known.normal;
        block.shear[lane] = known.shear;
    }
    Some(before)
}

fn restore_stiffness(bonds: &mut Bonds, before: Option<Vec<BondBlock>>) {
    if let Some(blocks) = before {
        bonds.blocks = blocks;
    }
}

/// Clears the wrenches of the search: a balance before the next step would read them, and what acts
/// on the spheres of clumps is added to them.
pub(super) fn clear_trial_wrenches(state: &mut State) {
    state.particles.wrenches.fill(Wrench::default());
}

/// A step that is not too long, from another and the largest eigenvalue there of M^-1 (dt^2/4 K +
/// dt/2 C): it grows at least with the step and at most with its square.
fn not_too_long(step_s: f64, value: f64) -> f64 {
    if value < 1.0 {
        step_s / value.sqrt()
    } else {
        step_s / value
    }
}

/// A step that is never too long, from the largest eigenvalues of M^-1 K and M^-1 C: (-c + sqrt(c^2
/// + 4 k))/k, written so that nothing cancels. It is the limit where both belong to the same mode.
pub fn safe_step(k: f64, c: f64) -> f64 {
    4.0 / (c + (c * c + 4.0 * k).sqrt())
}

impl Limit {
    /// As a bound of itself.
    pub fn bound(&self) -> Bound {
        Bound {
            step_s: self.step_s,
            is_damped: self.damping_1_s > 0.0,
        }
    }
}

impl Bound {
    /// A step that is not too long once something more acts, with the largest eigenvalues k, 1/s2,
    /// and c, 1/s, of its own: the largest eigenvalue of a sum is at most the sum of the largest
    /// ones.
    pub fn with_more(&self, [k, c]: [f64; 2]) -> f64 {
        if k == 0.0 && c == 0.0 {
            return self.step_s;
        }
        // What is there grows with the square of the step; with damping, at least with the step
        // itself.
        let present = 2.0 / self.step_s;
        if self.is_damped {
            safe_step(k, c + present)
        } else {
            safe_step(k + present * present, c)
        }
    }
}

/// Largest dt at which the largest eigenvalue of M^-1 (`stiffer` dt^2/4 K + dt/2 C) is 1, from a
/// step that is not too long. By the secant of the eigenvalue over dt; not above the limit if the
/// eigenvalues found are the largest, and less than `NEAR` below it. And the iterations needed.
fn damped_limit(
    state: &mut State,
    contacts: &[LinearContact],
    stiffer: f64,
    safe_s: f64,
) -> (f64, usize) {
    let (mut safe_s, mut step_s) = (safe_s, safe_s);
    let mut all_iterations = 0;
    let mut before: Option<(f64, f64)> = None;
    for _ in 0..TRIES {
        let both = Weights::of_step(stiffer, step_s);
        let (value, iterations) = largest_eigenvalue(state, contacts, both, Search::Fine);
        all_iterations += iterations;
        let not_too_long = not_too_long(step_s, value);
        safe_s = safe_s.max(not_too_long);
        if (value - 1.0).abs() < NEAR {
            break;
        }
        let slope = value / step_s;
        let next = before.map_or(not_too_long, |(step_before, slope_before)| {
            let bend = (slope - slope_before) / (step_s - step_before);
            safe_step(4.0 * bend, 2.0 * (slope - bend * step_s))
        });
        before = Some((step_s, slope));
        if !next.is_finite() || next == step_s {
            break;
        }
        step_s = next;
    }
    (safe_s, all_iterations)
}

impl Weights {
    /// K alone.
    const STIFFNESS: Self = Self {
        stiffness: 1.0,
        damping: 0.0,
    };
    /// C alone.
    const DAMPING: Self = Self {
        stiffness: 0.0,
        damping: 1.0,
    };

    /// dt^2/4 K, `stiffer` by so much, + dt/2 C.
    pub(super) fn of_step(stiffer: f64, step_s: f64) -> Self {
        Self {
            stiffness: 0.25 * stiffer * step_s * step_s,
            damping: 0.5 * step_s,
        }
    }
}

/// A vector with three displacements and three rotations for each particle, each times the root of
/// its mass or inertia.
pub(super) type Field = Vec<[f64; 6]>;

/// Largest eigenvalue of a sum of the operators over mass, and the iterations needed for it.
/// An upper bound by the residual: never too small by more than that is too large.
fn largest_eigenvalue(
    state: &mut State,
    contacts: &[LinearContact],
    weights: Weights,
    search: Search,
) -> (f64, usize) {
    let roots = inverse_mass_roots(state);
    // Allocated once: allocators find it hard to use the place of an aligned array again.
    let mut displaced = state.particles.poses.clone();
    let at_rest = (search == Search::Rough && weights.stiffness > 0.0).then(|| {
        bonds_as_total(state, &displaced);
        state.particles.wrenches.clone()
    });
    lanczos(&roots, search, |present, image| {
        if weights.stiffness > 0.0 {
            add_stiffness_times(
                state,
                weights.stiffness,
                &roots,
                present,
                at_rest.as_deref(),
                &mut displaced,
                image,
            );
        }
        if !contacts.is_empty() {
            let motions = motions(present, &roots);
            let wrenches = &mut state.particles.wrenches;
            linear_wrenches(contacts, weights, &motions, wrenches);
            add_forces(-1.0, wrenches, &roots, image);
        }
    })
}

/// A bound of the largest eigenvalue of the damping of bonds over mass, 1/s, with the largest
/// coefficients that structural damping can have, until bonds are longer, or lie in other
/// directions, by `MORE`. Afterwards no wrench acts on any particle.
pub fn damping_bound_1_s(state: &mut State) -> f64 {
    with_all_bonds(state, |state| {
        let roots = inverse_mass_roots(state);
        let coefficients: Vec<[f64; 4]> = (0..state.bonds.len())
            .map(|at| largest_coefficients(&state.bonds, at, &state.particles))
            .collect();
        let mut wrenches = vec![Wrench::default(); state.particles.free];
        let (value, _) = lanczos(&roots, Search::Rough, |present, image| {
            damping_wrenches(
                &state.bonds,
                &coefficients,
                &state.particles.poses,
                &motions(present, &roots),
                &mut state.scratch.partitions,
                &mut wrenches,
            );
            add_forces(-1.0, &wrenches, &roots, image);
        });
        MORE * MORE * value
    })
}

/// The largest eigenvalue of a symmetric operator of which `add_image` adds the image of a field to
/// another, an upper bound by the residual, and the iterations needed for it.
fn lanczos(
    roots: &Field,
    search: Search,
    mut add_image: impl FnMut(&Field, &mut Field),
) -> (f64, usize) {
    let mut present = start(roots);
    let mut before: Field = vec![[0.0; 6]; roots.len()];
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let mut largest = (0.0, 0.0);
    for iteration in 1..=ITERATIONS[1].min(6 * roots.len()) {
        // The image of the present vector takes the place of the one before, of which only its part
        // is left.
        let beta_before = beside.last().copied().unwrap_or(0.0);
        let mut image = before;
        image.iter_mut().flatten().for_each(|f| *f *= -beta_before);
        add_image(&present, &mut image);
        let alpha = dot(&image, &present);
        for (image, present) in image.iter_mut().flatten().zip(present.iter().flatten()) {
            *image -= alpha * present;
        }
        let beta = dot(&image, &image).sqrt();
        diagonal.push(alpha);
        if iteration <= ITERATIONS[0] || iteration.is_multiple_of(EVERY) {
            largest = largest_ritz(&diagonal, &beside, beta);
        }
        let (value, residual) = largest;
        let settled = iteration >= ITERATIONS[0] && residual <= search.residual() * value;
        if settled || beta <= 1e-13 * value || beta == 0.0 {
            break;
        }
        beside.push(beta);
        image.iter_mut().flatten().for_each(|f| *f /= beta);
        before = std::mem::replace(&mut present, image);
    }
    let (value, residual) = largest;
    ((value + residual).max(0.0), diagonal.len())
}

/// Largest eigenvalue of Lanczos' tridiagonal matrix, and how far it can be from an eigenvalue of
/// the operator.
pub(super) fn largest_ritz(diagonal: &[f64], beside: &[f64], beta: f64) -> (f64, f64) {
    let n = diagonal.len();
    let mut matrix = DMatrix::zeros(n, n);
    for i in 0..n {
        matrix[(i, i)] = diagonal[i];
        if i + 1 < n {
            matrix[(i, i + 1)] = beside[i];
            matrix[(i + 1, i)] = beside[i];
        }
    }
    let eigen = SymmetricEigen::new(matrix);
    let at = eigen.eigenvalues.imax();
    (
        eigen.eigenvalues[at],
        beta * eigen.eigenvectors[(n - 1, at)].abs(),
    )
}

/// One over the root of mass or inertia of each freedom; 0 where a support holds it to the end.
/// What a support lets go of counts as free all along, which never gives a larger step.
pub(super) fn inverse_mass_roots(state: &State) -> Field {
    let p = &state.particles;
    let mut roots: Field = (0..p.len())
        .map(|i| {
            let (m, j) = (
                p.motions[i].inverse_mass.sqrt(),
                p.motions[i].inverse_inertia.sqrt(),
            );
            [m, m, m, j, j, j]
        })
        .collect();
    for support in (state.supports.iter()).filter(|support| support.end_s.is_infinite()) {
        for held in &support.held {
            for (root, hold) in roots[held.particle as usize].iter_mut().zip(support.holds) {
                // The end of a bar moves with the force on it.
                if hold.is_some_and(|hold| !matches!(hold, Hold::Bar { .. })) {
                    *root = 0.0;
                }
            }
        }
    }
    roots
}

/// A unit vector that has a part of every mode: random signs and sizes, the same on every machine.
fn start(roots: &Field) -> Field {
    let mut field = roots.clone();
    for (n, root) in (0..).zip(field.as_flattened_mut()) {
        if *root != 0.0 {
            *root = 2.0 * uniform(0, &[n]) - 1.0;
        }
    }
    let norm = dot(&field, &field).sqrt();
    if norm > 0.0 {
        field.iter_mut().flatten().for_each(|f| *f /= norm);
    }
    field
}

fn dot(a: &Field, b: &Field) -> f64 {
    crate::stages::chunks::ordered_sum(a.len(), |i| (0..6).map(|k| a[i][k] * b[i][k]).sum())
}

/// Displacements and rotations, or velocities and spins, that an entry of a field stands for; and
/// forces and torques over the roots.
fn scaled(field: &[f64; 6], roots: &[f64; 6]) -> [f64; 6] {
    [0, 1, 2, 3, 4, 5].map(|k| field[k] * roots[k])
}

/// Adds `weight` times the stiffness times a field, each scaled by `roots`, to `sum`: minus the
/// change of the forces in a small displacement, by a central difference, or from what they are
/// `at_rest`: for half the work, good to about 1e-5. The poses in `displaced` (one for each
/// particle) are overwritten.
pub(super) fn add_stiffness_times(
    state: &mut State,
    weight: f64,
    roots: &Field,
    field: &Field,
    at_rest: Option<&[Wrench]>,
    displaced: &mut [Pose],
    sum: &mut Field,
) {
    let moves: Field = (field.iter().zip(roots))
        .map(|(field, roots)| scaled(field, roots))
        .collect();
    let largest = (moves.iter().zip(&state.particles.poses))
        .flat_map(|(moved, pose)| {
            let [x, y, z, rx, ry, rz] = moved.map(f64::abs);
            [x.max(y).max(z) / pose.radius_m(), rx, ry, rz]
        })
        .fold(0.0, f64::max);
    // A bond that is much shorter than a radius is turned and stretched by much less.
    let turned = (state.bonds.ends.iter().enumerate()).map(|(at, ends)| {
        let [a, b] = ends.map(|end| &moves[end as usize]);
        let [x, y, z] = [
            (b[0] - a[0]).abs(),
            (b[1] - a[1]).abs(),
            (b[2] - a[2]).abs(),
        ];
        x.max(y).max(z) / state.bonds.initial_length_m(at)
    });
    let largest = turned.fold(largest, f64::max);
    if largest == 0.0 {
        return;
    }
    let step = STEP / largest;
    let (sides, apart) = match at_rest {
        Some(wrenches) => {
            add_forces(weight / step, wrenches, roots, sum);
            (&[1.0][..], step)
        }
        None => (&[1.0, -1.0][..], 2.0 * step),
    };
    for side in sides {
        let rest = state.particles.poses.iter();
        for ((pose, rest), moved) in displaced.iter_mut().zip(rest).zip(&moves) {
            let [x, y, z, rx, ry, rz] = moved.map(|m| side * step * m);
            let [px, py, pz, radius_m] = rest.position_m;
            pose.position_m = [px + x, py + y, pz + z, radius_m];
            pose.turned = turn(rest.turned, [rx, ry, rz]);
        }
        bonds_as_total(state, displaced);
        let factor = -side * weight / apart;
        add_forces(factor, &state.particles.wrenches, roots, sum);
    }
}

/// Forces of all bonds at these poses by the total formulation, without plastic flow and without
/// looking for failing ones.
fn bonds_as_total(state: &mut State, poses: &[Pose]) {
    let as_total = |rule: &BondRule| BondRule {
        law: match rule.law {
            BondLaw::Incremental | BondLaw::FlatJoint(_) => BondLaw::Elastic,
            law => law,
        },
        criteria: None,
        ..rule.clone()
    };
    let as_total = state.bonds.rules.iter().map(as_total).collect();
    let rules = std::mem::replace(&mut state.bonds.rules, as_total);
    let wrenches = &mut state.particles.wrenches;
    let partitions = &mut state.scratch.partitions;
    bond_wrenches(&state.bonds, poses, partitions, wrenches);
    if !state.bonds.histories.plastics.is_empty() {
        add_elasto_plastic_wrenches(&state.bonds, poses, partitions, wrenches);
    }
    state.bonds.rules = rules;
}

/// Displacements and rotations, or velocities and spins, that a field stands for.
fn motions(field: &Field, roots: &Field) -> Vec<Motion> {
    let motion = |(field, roots): (&[f64; 6], &[f64; 6])| {
        let [vx, vy, vz, wx, wy, wz] = scaled(field, roots);
        Motion {
            velocity_m_s: [vx, vy, vz],
            spin_rad_s: [wx, wy, wz],
            ..Motion::default()
        }
    };
    field.iter().zip(roots).map(motion).collect()
}

/// Adds a factor times wrenches to a field.
fn add_forces(factor: f64, wrenches: &[Wrench], roots: &Field, sum: &mut Field) {
    for ((sum, wrench), roots) in sum.iter_mut().zip(wrenches).zip(roots) {
        let ([fx, fy, fz, _], [tx, ty, tz, _]) = (wrench.force_n, wrench.torque_n_m);
        let forces = scaled(&[fx, fy, fz, tx, ty, tz], roots);
        for (sum, force) in sum.iter_mut().zip(forces) {
            *sum += factor * force;
        }
    }
}
