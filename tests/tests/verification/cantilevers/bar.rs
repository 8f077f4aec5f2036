//! Cantilevers of bonded spheres, run until they are at rest.

use std::sync::Arc;

use std::f64::consts::PI;

use dem_run::check::limit::limit;
use dem_run::physics::bond::stiffness::{BondModel, BondShape, Stiffness, stiffness};
use dem_run::physics::rigid::rotation_vector;
use dem_run::state::State;
use dem_run::state::bonds::{BondLaw, BondRule, Bonds};
use dem_run::state::loads::GroupLoad;
use dem_run::state::particles::{Particles, Wrench};
use dem_run::state::supports::GroupSupport;
use dem_run::state::supports::HeldParticle;
use dem_run::step::{advance, interact};
use dem_scene::{Factor, Hold};
use nalgebra::{UnitQuaternion, Vector3};

/// Young's modulus, Pa.
pub(crate) const YOUNG: f64 = 200e9;
/// Poisson's ratio.
pub(crate) const POISSON: f64 = 0.3;
/// The load of the paper, N.
pub(crate) const LOAD: f64 = 1e5;
/// Arbitrary; it only determines the time to reach rest.
const DENSITY: f64 = 7850.0;
/// Particle damping gamma (Chen et al. 2022, eqs. 11 and 12). The paper's 0.001 gives the same rest
/// state, later.
const DAMPING: f64 = 0.7;

/// A straight row of bonded spheres along x, from 0 to `length_m`, with its first sphere fixed.
#[derive(Debug, Clone)]
pub(crate) struct Bar {
    /// Distance between the centres of its ends, m.
    pub(crate) length_m: f64,
    /// Radii of the spheres, which are equally spaced, m.
    pub(crate) radii_m: Vec<f64>,
    /// Radius of all bonds, m.
    pub(crate) bond_radius_m: f64,
    /// Model of the bonds.
    pub(crate) model: BondModel,
    /// True for the incremental formulation.
    pub(crate) incremental: bool,
    /// Rotation from the bar's axes (along it, towards the load) to those of the simulation.
    pub(crate) turned: UnitQuaternion<f64>,
}

/// A bar at rest under its load.
#[derive(Debug, Clone)]
pub(crate) struct Rest {
    /// Displacements of the spheres along the load, m.
    pub(crate) deflections_m: Vec<f64>,
    /// Their rotations, rad.
    pub(crate) rotations: Vec<f64>,
    /// Displacement of the tip along the bar towards the support, m.
    pub(crate) shortening_m: f64,
    /// Force and moment of the support in the bar's axes, N and N m.
    pub(crate) reaction: [Vector3<f64>; 2],
}

impl Bar {
    /// A bar of this many equal bonds between equal spheres.
    pub(crate) fn even(
        length_m: f64,
        bonds: usize,
        radius_m: f64,
        bond_radius_m: f64,
        model: BondModel,
    ) -> Self {
        Self {
            length_m,
            radii_m: vec![radius_m; bonds + 1],
            bond_radius_m,
            model,
            incremental: false,
            turned: UnitQuaternion::identity(),
        }
    }

    /// Number of bonds.
    pub(crate) fn bonds(&self) -> usize {
        self.radii_m.len() - 1
    }

    /// Stiffness of bond `at`.
    pub(crate) fn stiffness(&self, at: usize) -> Stiffness {
        let shape = BondShape {
            length_m: self.length_m / self.bonds() as f64,
            radius_m: self.bond_radius_m,
            end_radii_m: [self.radii_m[at], self.radii_m[at + 1]],
        };
        stiffness(self.model, &shape, YOUNG, POISSON)
    }

    /// The bar, fixed at its first sphere, with a transverse load at its last that increases from 0
    /// to `load_n` until the time `ramp_s`.
    fn loaded(&self, load_n: f64, ramp_s: f64) -> State {
        let count = self.radii_m.len();
        let along = self.turned * Vector3::x();
        let mut particles = Particles::default();
        for (i, &radius_m) in self.radii_m.iter().enumerate() {
            let place = along * (self.length_m * i as f64 / self.bonds() as f64);
            particles.push_sphere(place.into(), radius_m, DENSITY);
        }
        let mut bonds = Bonds {
            rules: Arc::new([BondRule {
                law: if self.incremental {
                    BondLaw::Incremental
                } else {
                    BondLaw::Elastic
                },
                damped: false,
                structural_damping: 0.0,
                criteria: None,
                strengthening: None,
                strain_rate_measure: dem_scene::StrainRateMeasure::Elongation,
                contact_beside: false,
            }]),
            ..Bonds::default()
        };
        for i in 0..self.bonds() {
            let ends = [i as u32, i as u32 + 1];
            bonds.push(
                ends,
                along.into(),
                self.bond_radius_m,
                &self.stiffness(i),
                0,
            );
        }
        let mut state = State::new(particles, bonds, 1e-9, 1);
        state.loads.push(GroupLoad {
            end_s: f64::INFINITY,
            particles: vec![count as u32 - 1],
            force_n: (self.turned * Vector3::new(0.0, load_n, 0.0)).into(),
            torque_n_m: [0.0; 3],
            factor: Factor::Ramp { until_s: ramp_s },
        });
        state.supports.push(GroupSupport {
            end_s: f64::INFINITY,
            holds: [Some(Hold::Fixed); 6],
            factor: Factor::One,
            held: vec![HeldParticle::default()],
        });
        state.model.particle_damping = DAMPING;
        state.scratch.particle_resistance = vec![Wrench::default(); count];
        state.time_step_s = 0.5 * limit(&mut state).step_s;
        state
    }

    /// Period of the slowest oscillation, s: that of a massless beam with a quarter of the bar's
    /// mass at its tip.
    fn period_s(&self) -> f64 {
        let second_moment = 0.25 * PI * self.bond_radius_m.powi(4);
        let stiffness = 3.0 * YOUNG * second_moment / self.length_m.powi(3);
        let mass: f64 = self
            .radii_m
            .iter()
            .map(|r| DENSITY * 4.0 / 3.0 * PI * r.powi(3))
            .sum();
        2.0 * PI * (0.25 * mass / stiffness).sqrt()
    }

    /// Loads the bar in one period of its slowest oscillation and runs it to rest: until in each of
    /// three periods no sphere has moved, in any step, by more than the rounding of its position.
    pub(crate) fn at_rest(&self, load_n: f64) -> Rest {
        let period = self.period_s();
        let mut state = self.loaded(load_n, period);
        let per_period = (period / state.time_step_s).ceil() as usize;
        let mut quiet = 0;
        while quiet < 3 {
            let mut fastest = 0.0_f64;
            for _ in 0..per_period {
                interact(&mut state);
                for motion in &state.particles.motions {
                    fastest = fastest.max(Vector3::from(motion.velocity_m_s).norm());
                }
                advance(&mut state);
            }
            let moves = fastest * state.time_step_s > 1e-15 * self.length_m;
            quiet = if moves { 0 } else { quiet + 1 };
            assert!(
                state.time_s < 100.0 * period,
                "does not come to rest: {fastest} m/s"
            );
        }
        self.measured(&state)
    }

    fn measured(&self, state: &State) -> Rest {
        let back = self.turned.inverse();
        let poses = &state.particles.poses;
        let along = |i: usize| self.length_m * i as f64 / self.bonds() as f64;
        let places: Vec<Vector3<f64>> = poses.iter().map(|pose| back * pose.place()).collect();
        let [fx, fy, fz, mx, my, mz] = state.supports[0].held[0].reactions[0];
        Rest {
            deflections_m: places.iter().map(|place| place.y).collect(),
            rotations: poses
                .iter()
                .map(|pose| (back * Vector3::from(rotation_vector(pose.turned))).z)
                .collect(),
            shortening_m: along(self.bonds()) - places[self.bonds()].x,
            reaction: [Vector3::new(fx, fy, fz), Vector3::new(mx, my, mz)].map(|v| back * v),
        }
    }

    /// Exact deflections, m, and rotations, rad, of the spheres under a small load: the bar is
    /// statically determinate, so each bond carries the transverse load and its moment about the
    /// contact point, and deforms by these over its stiffnesses.
    pub(crate) fn exact(&self, load_n: f64) -> (Vec<f64>, Vec<f64>) {
        let (mut deflections, mut rotations) = (vec![0.0], vec![0.0]);
        let mut start = 0.0;
        for i in 0..self.bonds() {
            let k = self.stiffness(i);
            let [before, after] = k.levers_m;
            let (deflection, rotation) = (deflections[i], rotations[i]);
            let moment = load_n * (self.length_m - start - before);
            let turned = rotation + moment / k.bending;
            rotations.push(turned);
            deflections.push(deflection + before * rotation + after * turned + load_n / k.shear);
            start += before + after;
        }
        (deflections, rotations)
    }

    /// Deflection of the tip under the paper's load by Timoshenko's theory (eq. 29), m.
    pub(crate) fn timoshenko_m(&self) -> f64 {
        timoshenko_m(self.length_m, self.length_m, self.bond_radius_m)
    }
}

/// Deflection at `x_m` of a cantilever under the paper's load by Timoshenko's theory, m (eq. 28).
pub(crate) fn timoshenko_m(x_m: f64, length_m: f64, radius_m: f64) -> f64 {
    let shear_modulus = YOUNG / (2.0 * (1.0 + POISSON));
    let area = PI * radius_m * radius_m;
    euler_bernoulli_m(x_m, length_m, radius_m) + 10.0 * LOAD * x_m / (9.0 * shear_modulus * area)
}

/// The same by Euler and Bernoulli's theory, m.
pub(crate) fn euler_bernoulli_m(x_m: f64, length_m: f64, radius_m: f64) -> f64 {
    let second_moment = 0.25 * PI * radius_m.powi(4);
    LOAD * x_m * x_m * (3.0 * length_m - x_m) / (6.0 * YOUNG * second_moment)
}
