//! Newton's method for an equilibrium, with the exact tangent of the bond energy.
//!
//! The residual consists of the forces of bonds, loads and gravity on the free degrees of freedom.
//! A step solves for the displacements that reduce it to 0. The first step also includes the
//! displacements of moving supports by the tangent, so that the entire body follows them.
//!
//! The full load is tried at once. If a step would rotate a particle far, or the iteration does not
//! converge, half of it is tried, and so on (load stepping): small rotations lead to the
//! equilibrium that the body reaches as the load rises. There is no line search on the energy: a
//! slender body that bends is first stretched by the square of its rotations, which costs much
//! energy but vanishes a step later. A search that prevents this needs fifty times as many steps.
//!
//! Away from equilibrium the tangent is not symmetric: a torque on a particle adds its cross
//! product matrix. In equilibrium these torques are those of loads and supports. If there can be
//! none (see [`DegreesOfFreedom::has_free_torques`]), the symmetric part (K + K^T)/2 is factored by
//! Cholesky: it is exact at the solution, so that convergence is quadratic, and a pivot that is not
//! positive shows that the equilibrium is not stable. Otherwise the tangent itself is factored, L
//! U, and stability is checked at the end.

use crate::stages::bonds::damage::press;
use crate::stages::bonds::forces::bond_wrenches;
use crate::stages::motion::loads::add_loads;
use crate::state::State;
use crate::state::particles::{Motion, Pose, Wrench};

use rayon::prelude::*;

use super::degrees_of_freedom::DegreesOfFreedom;
use super::direct::{DirectFactor, NoFactor};
use super::displacements::{Displacements, displace, largest_turn};
use super::factor::Factor;
use super::matrix::{Matrix, pulled_by_supports};

/// Largest number of Newton steps in a load step.
const STEPS: usize = 20;
/// Largest rotation of a particle in a Newton step, rad.
const TURN: f64 = 0.5;
/// Smallest load step, as a fraction of all loads and displacements.
const SMALLEST: f64 = 1.0 / 1024.0;
/// Ratio of residual to the largest bond force at which factors are accurate enough for the
/// equilibrium itself: its stability is judged by them.
const NEAR: f64 = 1e-4;
/// The same ratio below which such factors are reused for further steps.
const NEARER: f64 = 1e-6;
/// Largest ratio of residual to the largest bond force of an equilibrium, unless the rest is
/// rounding.
const LARGEST: f64 = 1e-9;
/// If a step leaves more than this fraction of the residual, only rounding is left.
const STALLED: f64 = 0.5;
/// Fraction by which a solution without factors reduces the residual.
const ACCURACY: f64 = 1e-8;

/// An equilibrium and how it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Number of unknown degrees of freedom.
    pub unknowns: usize,
    /// Number of degrees of freedom held by supports.
    pub held: usize,
    /// Total number of Newton steps of all load steps.
    pub newton_steps: usize,
    /// Number of load steps; 1: all at once.
    pub load_steps: usize,
    /// Ratio of residual to the largest bond force before each step of the last load step and after
    /// its last one: 1 if the bonds carried nothing yet.
    pub residuals: Vec<f64>,
    /// The largest remaining residual, N; torques are divided by the radius of their particle.
    pub residual_n: f64,
    /// The largest bond force, N; moments are divided by the bond radius.
    pub bond_force_n: f64,
    /// Whether all small displacements from the equilibrium require work. If torques act, it may be
    /// false although the body does not move away.
    pub stable: bool,
}

impl Equilibrium {
    /// Ratio of residual to the largest bond force; 0 if no force acts.
    pub fn residual(&self) -> f64 {
        crate::stages::ledger::bookkeeping::over(self.residual_n, self.bond_force_n)
    }
}

/// Reason why no equilibrium was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// There is no stable one: a pivot of the tangent is not positive.
    Pivot,
    /// The iteration does not converge.
    NoConvergence,
    /// The factors do not fit into memory.
    Memory,
    /// The library that computes factors does not work on this processor.
    Processor,
    /// It was interrupted.
    Interrupted,
}

/// Progress without an equilibrium for the full load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unsolved {
    /// Reason for the end.
    pub cause: Cause,
    /// Fraction of loads and displacements for which an equilibrium was found.
    pub fraction: f64,
    /// Ratio of residual to the largest bond force at the end of the last attempt.
    pub residual: f64,
}

/// The state whose equilibrium is sought.
struct Search<'a> {
    state: &'a mut State,
    degrees_of_freedom: DegreesOfFreedom,
    matrix: Matrix,
    factor: Factor,
    /// Loads and gravity at the end on every particle, N and N m. Length 6 each.
    load: Vec<[f64; 6]>,
    /// Force that may result from rounding of the positions, N.
    rounding_n: f64,
    newton_steps: usize,
    residuals: Vec<f64>,
    residual_n: f64,
    bond_force_n: f64,
}

/// Brings a state at its start into equilibrium under the loads, gravity and supports at `end_s`:
/// changes its poses, and sets its wrenches to those of the bonds. `goes_on` is called before every
/// step, with the progress in 0..1.
///
/// Supports must hold every piece of the bodies, and all bonds must be of the total formulation. On
/// an error the poses are those of the fraction of the load that was reached.
pub fn equilibrium(
    state: &mut State,
    end_s: f64,
    goes_on: &dyn Fn(f64) -> bool,
) -> Result<Equilibrium, Unsolved> {
    let degrees_of_freedom = DegreesOfFreedom::new(state, end_s);
    let symmetric = !degrees_of_freedom.has_free_torques(state);
    let matrix = Matrix::pattern(state, &degrees_of_freedom, symmetric);
    let no_factor = |why| Unsolved {
        cause: cause(why),
        fraction: 0.0,
        residual: 1.0,
    };
    let nodes = degrees_of_freedom.nodes(&state.particles.poses);
    let mut search = Search {
        load: loads(state, end_s),
        rounding_n: rounding_n(state),
        factor: Factor::new(&matrix, nodes).map_err(no_factor)?,
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
                let is_hopeless =
                    matches!(cause, Cause::Memory | Cause::Processor | Cause::Interrupted);
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
    /// From the equilibrium at one fraction of all loads and displacements to that at another.
    fn follow(&mut self, from: f64, to: f64, goes_on: &dyn Fn(f64) -> bool) -> Result<(), Cause> {
        let moved = self.degrees_of_freedom.moved.iter();
        let displacements: Vec<(u32, [f64; 6])> = moved
            .map(|(particle, way)| (*particle, way.map(|w| (to - from) * w)))
            .collect();
        let mut pulls = !displacements.is_empty();
        // The residual before the last step, whether the factors are near the equilibrium, and
        // whether they were computed for that step.
        let (mut before_n, mut is_near, mut is_fresh) = (f64::INFINITY, false, false);
        let mut poses = self.state.particles.poses.clone();
        self.residuals.clear();
        for _ in 0..=STEPS {
            let net = self.net(to);
            let poses_now = &self.state.particles.poses;
            let residual_n = largest_net_n(&self.degrees_of_freedom, poses_now, &net);
            let bond_force_n = largest_bond_force_n(self.state);
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
            let step = Step {
                factor: &self.factor,
                accuracy: ACCURACY,
                displacements: if pulls { &displacements } else { &[] },
            };
            step.take(self.state, &self.degrees_of_freedom, &poses, net)?;
            self.newton_steps += 1;
            before_n = if pulls { f64::INFINITY } else { residual_n };
            pulls = false;
        }
        Err(Cause::NoConvergence)
    }

    /// Computes the tangent at the present poses, and its factors.
    fn factorise(&mut self) -> Result<(), Cause> {
        let State {
            bonds, particles, ..
        } = &*self.state;
        self.matrix
            .assemble(bonds, &self.degrees_of_freedom, &particles.poses);
        self.factor.compute(&self.matrix).map_err(cause)
    }

    /// Net forces on the unknowns at this fraction of the loads, N and N m.
    fn net(&mut self, fraction: f64) -> Vec<f64> {
        set_bond_wrenches(self.state);
        let wrenches = &self.state.particles.wrenches;
        let unknowns = self.degrees_of_freedom.unknowns();
        unknowns
            .map(|(i, k)| six(&wrenches[i])[k] + fraction * self.load[i][k])
            .collect()
    }

    /// Whether the symmetric part of the tangent is positive definite.
    fn is_stable(&mut self) -> bool {
        let mut matrix = Matrix::pattern(self.state, &self.degrees_of_freedom, true);
        let poses = &self.state.particles.poses;
        matrix.assemble(&self.state.bonds, &self.degrees_of_freedom, poses);
        let factor = DirectFactor::new(&matrix);
        factor.is_ok_and(|mut factor| factor.compute(&matrix).is_ok())
    }
}

/// A Newton step with the matrix that was computed last.
pub struct Step<'a> {
    /// The factor of the stiffness.
    pub factor: &'a Factor,
    /// Fraction to which a solution without factors reduces the residual.
    pub accuracy: f64,
    /// Displacements of particles that supports move in this step, by their numbers, ascending: m,
    /// and rotation vectors in rad. Length 6 each.
    pub displacements: &'a [(u32, [f64; 6])],
}

impl Step<'_> {
    /// Moves a state from these poses by what the net forces on its unknowns, N and N m, ask for.
    /// The poses stay if there is no solution, or if it turns a particle far.
    pub fn take(
        &self,
        state: &mut State,
        degrees_of_freedom: &DegreesOfFreedom,
        from: &[Pose],
        net: Vec<f64>,
    ) -> Result<(), Cause> {
        let mut by = net;
        if !self.displacements.is_empty() {
            let pulled =
                pulled_by_supports(&state.bonds, degrees_of_freedom, from, self.displacements);
            by.iter_mut().zip(pulled).for_each(|(by, pull)| *by += pull);
        }
        self.factor.solve(&mut by, self.accuracy).map_err(cause)?;
        let moves = Displacements {
            by: &by,
            displacements: self.displacements,
        };
        if largest_turn(&moves, degrees_of_freedom) > TURN {
            return Err(Cause::NoConvergence);
        }
        displace(&mut state.particles.poses, from, degrees_of_freedom, &moves);
        Ok(())
    }
}

/// Sets the wrenches of all particles to those of the bonds at the present poses.
pub fn set_bond_wrenches(state: &mut State) {
    let State {
        bonds,
        particles,
        scratch,
        ..
    } = state;
    let partitions = &mut scratch.partitions;
    bond_wrenches(bonds, &particles.poses, partitions, &mut particles.wrenches);
    press(bonds, particles, &mut scratch.crushed);
}

/// The largest of net forces on the unknowns, N, and of net torques over the radii of their
/// particles.
pub fn largest_net_n(degrees_of_freedom: &DegreesOfFreedom, poses: &[Pose], net: &[f64]) -> f64 {
    let unknowns = degrees_of_freedom.unknowns().zip(net);
    let sizes = unknowns.map(|((i, k), net)| match k {
        0..3 => net.abs(),
        _ => net.abs() / poses[i].radius_m(),
    });
    // Not f64::max, which would drop NaN.
    sizes.fold(0.0, |largest: f64, size| {
        if size > largest || size.is_nan() {
            size
        } else {
            largest
        }
    })
}

/// The reason for which there is no solution of a linear system.
pub fn cause(why: NoFactor) -> Cause {
    match why {
        NoFactor::Pivot => Cause::Pivot,
        NoFactor::NoConvergence => Cause::NoConvergence,
        NoFactor::Memory => Cause::Memory,
        NoFactor::Processor => Cause::Processor,
    }
}

/// The largest bond force, N; moments over the bond radius.
pub fn largest_bond_force_n(state: &State) -> f64 {
    let (bonds, poses) = (&state.bonds, &state.particles.poses);
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

/// Loads and gravity on every particle at `end_s`, N and N m.
pub fn loads(state: &State, end_s: f64) -> Vec<[f64; 6]> {
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

/// Force in the stiffest bond that results from rounding of the positions, N.
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
pub fn six(wrench: &Wrench) -> [f64; 6] {
    let ([fx, fy, fz, _], [tx, ty, tz, _]) = (wrench.force_n, wrench.torque_n_m);
    [fx, fy, fz, tx, ty, tz]
}
