//! Newton's method to an equilibrium, with the exact tangent of the bonds' energy.
//!
//! The residual is what acts on the degrees_of_freedom that are not held: bonds, loads and gravity. A step
//! solves for the moves and turns that take it to 0. Supports that move take their first step with
//! the tangent as well, so that the body follows them as a whole.
//!
//! The whole load is tried at once. Where a step would turn a particle far, or the steps do not
//! come to an end, half of it is, and so on from there (load stepping): small turns lead to the
//! equilibrium that the body comes to as the load rises. There is no line search on the energy: a
//! slender body that bends is first stretched by the square of its turns, which costs much energy
//! and is gone a step later. A search that forbids it takes fifty times as many steps.
//!
//! Off equilibrium the tangent is not symmetric: where a torque acts on a particle, by the cross
//! product with it. In equilibrium these torques are those of loads and supports. Where none can be
//! (see [`DegreesOfFreedom::has_free_torques`]), the symmetric part (K + K^T)/2 is factored by Cholesky:
//! exact at the solution, so that the convergence is quadratic, and a pivot that is not positive
//! says that the equilibrium is not stable. Elsewhere the tangent itself is factored, L U, and
//! stability is looked at in the end.

use crate::stages::bonds::bond_wrenches;
use crate::stages::loads::add_loads;
use crate::state::State;
use crate::state::particles::{Motion, Wrench};

use rayon::prelude::*;

use super::degrees_of_freedom::DegreesOfFreedom;
use super::displacements::{Displacements, displace, largest_turn};
use super::factor::{Factor, NoFactor};
use super::matrix::{Matrix, pulled_by_supports};

/// Newton steps in a load step, at most.
const STEPS: usize = 20;
/// Largest turn of a particle in a Newton step, rad.
const TURN: f64 = 0.5;
/// Smallest load step, as a share of all loads and displacements.
const SMALLEST: f64 = 1.0 / 1024.0;
/// Residual over the largest bond force at which factors are good for the equilibrium itself: its
/// stability is judged by them.
const NEAR: f64 = 1e-4;
/// The same from which on factors that are near serve for further steps.
const NEARER: f64 = 1e-6;
/// Largest residual over the largest bond force of an equilibrium, unless it is rounding.
const LARGEST: f64 = 1e-9;
/// A step that leaves more than this share of the residual shows that only rounding is left.
const STALLED: f64 = 0.5;
/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Unknown degrees_of_freedom.
    pub unknowns: usize,
    /// Freedoms that supports hold.
    pub held: usize,
    /// Newton steps, of all load steps together.
    pub newton_steps: usize,
    /// Load steps that were taken; 1: all at once.
    pub load_steps: usize,
    /// Largest residual over the largest bond force before each step of the last load step and
    /// after its last one: 1 where the bonds carried nothing yet.
    pub residuals: Vec<f64>,
    /// The largest residual that is left, N; that of a torque is over the radius of its particle.
    pub residual_n: f64,
    /// The largest that a bond carries, N; moments are over its radius.
    pub bond_force_n: f64,
    /// Whether small moves from the equilibrium need work, all of them. Where torques act it may be
    /// false though the body does not move away.
    pub stable: bool,
}

impl Equilibrium {
    /// Residual over the largest bond force; 0 where nothing acts.
    pub fn residual(&self) -> f64 {
        crate::stages::ledger::over(self.residual_n, self.bond_force_n)
    }
}

/// Why no equilibrium was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// No stable one is there: a pivot of the tangent is not positive.
    Pivot,
    /// The steps do not come to an end.
    NoConvergence,
    /// The factors do not fit into memory.
    Memory,
    /// It was told to stop.
    Interrupted,
}

/// How far it came without an equilibrium for the whole load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unsolved {
    /// Why it ended.
    pub cause: Cause,
    /// Fraction of loads and displacements for which an equilibrium was found.
    pub fraction: f64,
    /// Residual over the largest bond force at the end of the last try.
    pub residual: f64,
}

/// What it is that is to be in equilibrium.
struct Search<'a> {
    state: &'a mut State,
    degrees_of_freedom: DegreesOfFreedom,
    matrix: Matrix,
    factor: Factor,
    /// Loads and gravity at the end on every particle, N and N m. Length 6 each.
    load: Vec<[f64; 6]>,
    /// Force that rounding of the places may make, N.
    rounding_n: f64,
    newton_steps: usize,
    residuals: Vec<f64>,
    residual_n: f64,
    bond_force_n: f64,
}

/// Brings a state that stands at its start into the equilibrium under what loads, gravity and
/// supports are at `end_s`: its poses are changed, and its wrenches are those of the bonds.
/// `goes_on` is asked before every step, with how far it has come in 0..1.
///
/// Every piece of the bodies has to be held by supports, and all bonds be of the total formulation.
///
/// # Errors
/// There is none that is stable, it is not found, or it is told to stop. The poses are then those
/// of the share that was reached.
pub fn equilibrium(
    state: &mut State,
    end_s: f64,
    goes_on: &dyn Fn(f64) -> bool,
) -> Result<Equilibrium, Unsolved> {
    let degrees_of_freedom = DegreesOfFreedom::new(state, end_s);
    let symmetric = !degrees_of_freedom.has_free_torques(state);
    let matrix = Matrix::pattern(state, &degrees_of_freedom, symmetric);
    let out_of_memory = |_| Unsolved {
        cause: Cause::Memory,
        fraction: 0.0,
        residual: 1.0,
    };
    let mut search = Search {
        load: loads(state, end_s),
        rounding_n: rounding_n(state),
        factor: Factor::new(&matrix).map_err(out_of_memory)?,
        degrees_of_freedom,
        matrix,
        state,
        newton_steps: 0,
        residuals: Vec::new(),
        residual_n: 0.0,
        bond_force_n: 0.0,
    };
    let (mut fraction, mut by, mut load_steps) = (0.0, 1.0, 0);
    while fraction < 1.0 {
        let to = if fraction + by > 1.0 {
            1.0
        } else {
            fraction + by
        };
        let before = search.state.particles.poses.clone();
        match search.follow(fraction, to, goes_on) {
            Ok(()) => {
                fraction = to;
                by *= 2.0;
                load_steps += 1;
            }
            Err(cause) => {
                search.state.particles.poses = before;
                by = 0.5 * (to - fraction);
                let is_hopeless = matches!(cause, Cause::Memory | Cause::Interrupted);
                if is_hopeless || by < SMALLEST {
                    return Err(Unsolved {
                        cause,
                        fraction,
                        residual: search.residuals.last().copied().unwrap_or(1.0),
                    });
                }
            }
        }
    }
    let stable = symmetric || search.is_stable();
    Ok(Equilibrium {
        unknowns: search.degrees_of_freedom.count,
        held: search.degrees_of_freedom.held(),
        newton_steps: search.newton_steps,
        load_steps,
        residuals: search.residuals,
        residual_n: search.residual_n,
        bond_force_n: search.bond_force_n,
        stable,
    })
}

impl Search<'_> {
    /// From the equilibrium at one share of all loads and displacements to that at another.
    fn follow(&mut self, from: f64, to: f64, goes_on: &dyn Fn(f64) -> bool) -> Result<(), Cause> {
        let moved = self.degrees_of_freedom.moved.iter();
        let displacements: Vec<(u32, [f64; 6])> = moved
            .map(|(particle, way)| (*particle, way.map(|w| (to - from) * w)))
            .collect();
        let mut pulls = !displacements.is_empty();
        // The residual before the last step, whether the factors are near the equilibrium, and
        // whether that step was theirs alone.
        let (mut before_n, mut is_near, mut is_fresh) = (f64::INFINITY, false, false);
        let mut poses = self.state.particles.poses.clone();
        self.residuals.clear();
        for _ in 0..=STEPS {
            let net = self.net(to);
            let residual_n = self.largest(&net);
            let bond_force_n = self.largest_bond_force_n();
            if !residual_n.is_finite() {
                return Err(Cause::NoConvergence);
            }
            let residual = if residual_n == 0.0 {
                0.0
            } else {
                residual_n / bond_force_n.max(residual_n)
            };
            if !pulls {
                self.residuals.push(residual);
            }
            let stalls = residual_n >= STALLED * before_n;
            if is_near && stalls {
                let best_n = residual_n.min(before_n);
                if best_n <= (LARGEST * bond_force_n).max(self.rounding_n) {
                    if residual_n > before_n {
                        self.state.particles.poses = poses;
                        self.residuals.pop();
                        self.net(to);
                    }
                    self.residual_n = best_n;
                    self.bond_force_n = bond_force_n;
                    return Ok(());
                }
                is_near &= !is_fresh;
            }
            let far = (-residual.log10() / 12.0).clamp(0.0, 1.0);
            if !goes_on(from + (to - from) * far) {
                return Err(Cause::Interrupted);
            }
            is_fresh = pulls || !is_near || stalls || residual > NEARER;
            if is_fresh {
                self.factorise()?;
                is_near = residual <= NEAR && !pulls;
            }
            poses.clone_from(&self.state.particles.poses);
            let mut by = net;
            if pulls {
                let pulled = pulled_by_supports(
                    &self.state.bonds,
                    &self.degrees_of_freedom,
                    &poses,
                    &displacements,
                );
                by.iter_mut().zip(pulled).for_each(|(by, pull)| *by += pull);
            }
            self.factor.solve(&mut by);
            self.newton_steps += 1;
            let moves = Displacements {
                by: &by,
                displacements: if pulls { &displacements } else { &[] },
            };
            if largest_turn(&moves, &self.degrees_of_freedom) > TURN {
                return Err(Cause::NoConvergence);
            }
            let new = &mut self.state.particles.poses;
            displace(new, &poses, &self.degrees_of_freedom, &moves);
            before_n = if pulls { f64::INFINITY } else { residual_n };
            pulls = false;
        }
        Err(Cause::NoConvergence)
    }

    /// Takes the tangent where the particles are, and its factors.
    fn factorise(&mut self) -> Result<(), Cause> {
        let State {
            bonds, particles, ..
        } = &*self.state;
        self.matrix
            .assemble(bonds, &self.degrees_of_freedom, &particles.poses);
        self.factor.compute(&self.matrix).map_err(|why| match why {
            NoFactor::Pivot => Cause::Pivot,
            NoFactor::Memory => Cause::Memory,
        })
    }

    /// What acts on the unknowns at this share of the loads, N and N m.
    fn net(&mut self, fraction: f64) -> Vec<f64> {
        let State {
            bonds,
            particles,
            scratch,
            ..
        } = &mut *self.state;
        let partitions = &mut scratch.partitions;
        bond_wrenches(bonds, &particles.poses, partitions, &mut particles.wrenches);
        let unknowns = self.degrees_of_freedom.unknowns();
        unknowns
            .map(|(i, k)| six(&particles.wrenches[i])[k] + fraction * self.load[i][k])
            .collect()
    }

    /// The largest of forces, N, torques over the radii of the particles.
    fn largest(&self, net: &[f64]) -> f64 {
        let poses = &self.state.particles.poses;
        let unknowns = self.degrees_of_freedom.unknowns().zip(net);
        let sizes = unknowns.map(|((i, k), net)| match k {
            0..3 => net.abs(),
            _ => net.abs() / poses[i].radius_m(),
        });
        // Not f64::max, which would lose what is not a number.
        sizes.fold(0.0, |largest: f64, size| {
            if size > largest || size.is_nan() {
                size
            } else {
                largest
            }
        })
    }

    /// The largest that a bond carries, N; moments over its radius.
    fn largest_bond_force_n(&self) -> f64 {
        let (bonds, poses) = (&self.state.bonds, &self.state.particles.poses);
        let of_bond = |at: usize| {
            if bonds.is_broken(at) {
                return 0.0;
            }
            let load = bonds.forces(at, poses).load;
            let moment_n_m = load.torsion_n_m.max(load.bending_n_m);
            let force_n = load.normal_n.abs().max(load.shear_n);
            force_n.max(moment_n_m / bonds.radius_m(at))
        };
        let all = (0..bonds.len()).into_par_iter().with_min_len(1024);
        all.map(of_bond).reduce(|| 0.0, f64::max)
    }

    /// Whether the symmetric part of the tangent is positive definite.
    fn is_stable(&mut self) -> bool {
        let mut matrix = Matrix::pattern(self.state, &self.degrees_of_freedom, true);
        let poses = &self.state.particles.poses;
        matrix.assemble(&self.state.bonds, &self.degrees_of_freedom, poses);
        let factor = Factor::new(&matrix);
        factor.is_ok_and(|mut factor| factor.compute(&matrix).is_ok())
    }
}

/// Loads and gravity on every particle at `end_s`, N and N m.
pub(super) fn loads(state: &State, end_s: f64) -> Vec<[f64; 6]> {
    let mut wrenches = vec![Wrench::default(); state.particles.len()];
    add_loads(&state.loads, end_s, [0.0; 2], &mut wrenches);
    let with_weight = |(wrench, motion): (&Wrench, &Motion)| {
        let mut load = six(wrench);
        for (k, g) in state.model.gravity_m_s2.iter().enumerate() {
            load[k] += g / motion.inverse_mass;
        }
        load
    };
    let all = wrenches.iter().zip(&state.particles.motions);
    all.map(with_weight).collect()
}

/// Force that the rounding of places makes in the stiffest bond, N.
fn rounding_n(state: &State) -> f64 {
    let poses = &state.particles.poses;
    let of_bond = |at: usize| {
        let far = |end: u32| poses[end as usize].place().amax();
        let far_m = state.bonds.ends[at]
            .map(far)
            .into_iter()
            .fold(0.0, f64::max);
        let far_m = far_m.max(state.bonds.initial_length_m(at));
        16.0 * f64::EPSILON * far_m * state.bonds.normal(at)
    };
    (0..state.bonds.len()).map(of_bond).fold(0.0, f64::max)
}

/// Force and torque, one after the other.
pub(super) fn six(wrench: &Wrench) -> [f64; 6] {
    let ([fx, fy, fz, _], [tx, ty, tz, _]) = (wrench.force_n, wrench.torque_n_m);
    [fx, fy, fz, tx, ty, tz]
}
