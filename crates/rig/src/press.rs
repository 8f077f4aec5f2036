//! A laboratory test without steps: equilibria at a few travels of its crosshead, for the stiffness
//! of the body. Bonds do not break, walls press without friction, and particles that are not bonded
//! do not touch each other.

use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};

use super::seat::seat;
use crate::record::{Loading, Row};
use crate::setup::Setup;
use dem_engine::state::State;
use dem_engine::state::particles::Pose;
use dem_engine::statics::contacts::{MovingWalls, WallForce, add_contacts, wall_forces};
use dem_engine::statics::degrees_of_freedom::DegreesOfFreedom;
use dem_engine::statics::factor::Factor;
use dem_engine::statics::matrix::Matrix;
use dem_engine::statics::newton::{
    Cause, Equilibrium, Step, cause, largest_bond_force_n, largest_net_n, set_bond_wrenches, six,
};
use dem_physics::rigid::turn;

/// Loads at which the equilibrium is found, as fractions of the largest: the range in which the
/// stiffness of a test is measured.
const LOADS: [f64; 3] = [0.2, 0.4, 0.6];
/// A load is near enough if it deviates by less than this fraction.
const NEAR: f64 = 0.1;
/// A load that deviates by more was not reached: the stroke ended first.
const FAR: f64 = 0.25;
/// Travels tried for a load.
const MOST_TRAVELS: usize = 12;
/// Largest ratio of the residual to the load of an equilibrium.
const RESIDUAL: f64 = 5e-4;
/// Newton steps for an equilibrium.
const STEPS: usize = 30;
/// Fraction to which a solution without factors reduces the residual of a Newton step.
const ACCURACY: f64 = 1e-3;
/// Largest ratio of a step of the travel to the one before for which the response is extrapolated.
const MOST_EXTRAPOLATED: f64 = 4.0;
/// Steps of the travel below this fraction of the one before do not change the direction.
const SHORT: f64 = 0.5;
/// Stiffness of the springs that keep a body from drifting, all together, over the mean stiffness
/// of its bonds: walls without friction leave it free to slide.
const GROUND: f64 = 1e-5;

/// What a test without steps found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pressed {
    /// Equilibria at about 0.2, 0.4 and 0.6 of the largest load.
    pub(crate) rows: Vec<Row>,
    /// How they were found.
    pub(crate) equilibrium: Equilibrium,
}

/// Why a test without steps has no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NotPressed {
    /// The walls do not meet the body within the stroke.
    NoContact,
    /// An equilibrium was not found.
    NoEquilibrium(Cause),
}

/// The test of a state before its first step. `loading`: its moving and resting sides;
/// `stroke_m`: largest travel; `largest_n`: load of which fractions are taken, that at the end of
/// the stroke unless given.
pub(crate) fn press(
    state: &mut State,
    setup: &Setup,
    loading: &Loading,
    stroke_m: f64,
    largest_n: Option<f64>,
    goes_on: &dyn Fn(f64) -> bool,
) -> Result<Pressed, NotPressed> {
    let direction = Vector3::from(setup.direction);
    let walls = MovingWalls::new(state, &loading.moving.walls, stroke_m * direction);
    let mut start = 0.0;
    if !loading.moving.walls.is_empty() {
        let moving = &loading.moving.walls;
        let seated = seat(state, &walls, moving, stroke_m, setup.mean_radius_m);
        start = seated.ok_or(NotPressed::NoContact)?;
    }
    let mut press =
        Press::new(state, walls, setup, loading, stroke_m).map_err(NotPressed::NoEquilibrium)?;
    let rows = press
        .rows(start, largest_n, goes_on)
        .map_err(NotPressed::NoEquilibrium)?;
    Ok(Pressed {
        rows,
        equilibrium: press.found(),
    })
}

/// A test that is pressed.
struct Press<'a> {
    state: &'a mut State,
    walls: MovingWalls,
    setup: &'a Setup,
    loading: &'a Loading,
    stroke_m: f64,
    degrees_of_freedom: DegreesOfFreedom,
    /// Displacements of gripped particles over the full stroke. Length 6 each.
    gripped: Vec<(u32, [f64; 6])>,
    matrix: Matrix,
    factor: Factor,
    /// Stiffness of the ground spring of every particle, N/m, and where these and the springs
    /// across contacts are without force: the equilibrium before.
    ground_n_m: f64,
    places: Vec<Vector3<f64>>,
    /// Travel, as a fraction of the stroke, and poses of the equilibrium before the last.
    earlier: Option<(f64, Vec<Pose>)>,
    newton_steps: usize,
    load_steps: usize,
    residual_n: f64,
}

impl<'a> Press<'a> {
    fn new(
        state: &'a mut State,
        walls: MovingWalls,
        setup: &'a Setup,
        loading: &'a Loading,
        stroke_m: f64,
    ) -> Result<Self, Cause> {
        // The supports of a test move during the first period and the rest of its time; their
        // displacements are those of the stroke.
        let mut degrees_of_freedom = DegreesOfFreedom::new(state, 1.0);
        degrees_of_freedom.moved.clear();
        let direction = Vector3::from(setup.direction);
        let supports = loading.moving.supports.iter();
        let mut gripped: Vec<(u32, [f64; 6])> = supports
            .flat_map(|at| &state.supports[*at].held)
            .map(|held| {
                let [x, y, z] = (stroke_m * direction).into();
                (held.particle, [x, y, z, 0.0, 0.0, 0.0])
            })
            .collect();
        gripped.sort_by_key(|(particle, _)| *particle);
        let matrix = Matrix::pattern(state, &degrees_of_freedom, true);
        let nodes = degrees_of_freedom.nodes(&state.particles.poses);
        let bonds = &state.bonds;
        let stiffness_n_m: f64 = (0..bonds.len()).map(|at| bonds.normal(at)).sum();
        let pairs = bonds.len() * state.particles.len();
        Ok(Self {
            factor: Factor::new(&matrix, nodes).map_err(cause)?,
            ground_n_m: GROUND * stiffness_n_m / pairs.max(1) as f64,
            places: Vec::new(),
            state,
            walls,
            setup,
            loading,
            stroke_m,
            degrees_of_freedom,
            gripped,
            matrix,
            earlier: None,
            newton_steps: 0,
            load_steps: 0,
            residual_n: 0.0,
        })
    }

    /// The equilibria at the loads wanted, from one at which the walls just touch.
    fn rows(
        &mut self,
        start: f64,
        largest_n: Option<f64>,
        goes_on: &dyn Fn(f64) -> bool,
    ) -> Result<Vec<Row>, Cause> {
        let first = 0.02 * self.setup.mean_radius_m / self.stroke_m;
        let mut at = start;
        let mut row = self.advance(&mut at, (start + first).min(1.0), &|| goes_on(0.0))?;
        let largest_n = match largest_n {
            Some(largest_n) => largest_n,
            // The load at the end of the stroke, as far as it is proportional to the travel.
            None => row.load_n() * (1.0 - start) / (at - start).max(1e-12),
        };
        let mut rows = Vec::new();
        let mut before = (start, 0.0);
        for (number, fraction) in LOADS.iter().enumerate() {
            let wanted_n = fraction * largest_n;
            for _ in 0..MOST_TRAVELS {
                let load_n = row.load_n();
                if (load_n - wanted_n).abs() <= NEAR * wanted_n || at >= 1.0 {
                    break;
                }
                let slope = (load_n - before.1) / (at - before.0);
                let step = (wanted_n - load_n) / slope;
                // Contacts stiffen as they grow: no more than what the travel was.
                let step = step.clamp(-0.5 * (at - start), 2.0 * (at - start));
                before = (at, load_n);
                let done = number as f64 / LOADS.len() as f64;
                row = self.advance(&mut at, (before.0 + step).min(1.0), &|| goes_on(done))?;
            }
            if (row.load_n() - wanted_n).abs() > FAR * wanted_n {
                return Err(Cause::NoConvergence);
            }
            rows.push(row);
        }
        Ok(rows)
    }

    /// The equilibrium at a travel, as a fraction of the stroke, from that at another, in as many
    /// parts as needed.
    fn advance(&mut self, at: &mut f64, to: f64, goes_on: &dyn Fn() -> bool) -> Result<Row, Cause> {
        let mut part = to - *at;
        while *at != to {
            if !goes_on() {
                return Err(Cause::Interrupted);
            }
            let next = if (to - *at).abs() <= part.abs() {
                to
            } else {
                *at + part
            };
            let before = self.state.particles.poses.clone();
            match self.equilibrium(*at, next) {
                Ok(()) => {
                    // A short step says little of the direction in which the body moves.
                    let is_long = |(earlier, _): &(f64, Vec<Pose>)| {
                        (next - *at).abs() > SHORT * (*at - earlier).abs()
                    };
                    if self.earlier.as_ref().is_none_or(is_long) {
                        self.earlier = Some((*at, before));
                    }
                    *at = next;
                    self.load_steps += 1;
                }
                Err(problem) => {
                    self.state.particles.poses = before;
                    part *= 0.5;
                    if part.abs() < 1e-3 * (to - *at).abs() || problem == Cause::Memory {
                        return Err(problem);
                    }
                }
            }
        }
        Ok(self.row(to))
    }

    fn equilibrium(&mut self, from: f64, to: f64) -> Result<(), Cause> {
        let skin_m = 0.5 * self.setup.mean_radius_m;
        self.places = self.state.particles.poses.iter().map(Pose::place).collect();
        self.walls.place(self.state, to, skin_m);
        let has_grips = !self.gripped.is_empty();
        if !has_grips {
            self.extrapolate(from, to);
        }
        let pull: Vec<(u32, [f64; 6])> = (self.gripped.iter())
            .map(|(particle, way)| (*particle, way.map(|w| (to - from) * w)))
            .collect();
        let mut pulls = has_grips;
        let mut before_n = f64::INFINITY;
        for _ in 0..STEPS {
            let contacts = wall_forces(self.state);
            let (net, load_n) = self.net(&contacts);
            let poses = &self.state.particles.poses;
            let residual_n = largest_net_n(&self.degrees_of_freedom, poses, &net);
            if !residual_n.is_finite() {
                return Err(Cause::NoConvergence);
            }
            if !pulls && residual_n <= RESIDUAL * load_n {
                self.residual_n = residual_n;
                return Ok(());
            }
            // With contacts that open, a residual may rise once, but not again and again.
            if !pulls && residual_n > 1e3 * before_n {
                return Err(Cause::NoConvergence);
            }
            before_n = if pulls { f64::INFINITY } else { residual_n };
            self.take_tangent(&contacts)?;
            let step = Step {
                factor: &self.factor,
                accuracy: ACCURACY,
                displacements: if pulls { &pull } else { &[] },
            };
            let poses = self.state.particles.poses.clone();
            step.take(self.state, &self.degrees_of_freedom, &poses, net)?;
            self.newton_steps += 1;
            pulls = false;
        }
        Err(Cause::NoConvergence)
    }

    /// Moves the body as far beyond the last equilibrium as it came from the one before, in
    /// proportion to the travel: all but the contacts responds linearly.
    fn extrapolate(&mut self, from: f64, to: f64) {
        let Some((before, poses)) = &self.earlier else {
            return;
        };
        let ratio = (to - from) / (from - before);
        if !(-1.0..=MOST_EXTRAPOLATED).contains(&ratio) {
            return;
        }
        for (pose, old) in self.state.particles.poses.iter_mut().zip(poses) {
            let [x, y, z] = (pose.place() + ratio * (pose.place() - old.place())).into();
            pose.position_m = [x, y, z, pose.radius_m()];
            let [now, old] = [pose.turned, old.turned]
                .map(|q| UnitQuaternion::new_normalize(Quaternion::from(Vector4::from(q))));
            let way = ratio * (now * old.inverse()).scaled_axis();
            pose.turned = turn(pose.turned, way.into());
        }
    }

    fn take_tangent(&mut self, contacts: &[WallForce]) -> Result<(), Cause> {
        let (bonds, poses) = (&self.state.bonds, &self.state.particles.poses);
        self.matrix.assemble(bonds, &self.degrees_of_freedom, poses);
        add_contacts(
            &mut self.matrix,
            &self.degrees_of_freedom,
            contacts,
            poses,
            self.ground_n_m,
        );
        self.factor.compute(&self.matrix).map_err(cause)
    }

    /// Net forces on the unknowns, N and N m, and the largest force of a wall or a grip on a
    /// particle, N.
    fn net(&mut self, contacts: &[WallForce]) -> (Vec<f64>, f64) {
        set_bond_wrenches(self.state);
        let particles = &self.state.particles;
        let mut forces: Vec<[f64; 6]> = particles.wrenches.iter().map(six).collect();
        let grips = self.gripped.iter();
        let gripped_n = grips.map(|(particle, _)| {
            let [x, y, z, ..] = forces[*particle as usize];
            Vector3::new(x, y, z).norm()
        });
        let pressed_n = contacts.iter().map(|contact| contact.force_n);
        let load_n = gripped_n.chain(pressed_n).fold(0.0, f64::max);
        for ((force, pose), place) in forces.iter_mut().zip(&particles.poses).zip(&self.places) {
            let back = self.ground_n_m * (place - pose.place());
            for k in 0..3 {
                force[k] += back[k];
            }
        }
        for contact in contacts {
            let i = contact.particle;
            let force = contact.on_particle_n(&(particles.poses[i].place() - self.places[i]));
            for k in 0..3 {
                forces[i][k] += force[k];
            }
        }
        let unknowns = self.degrees_of_freedom.unknowns();
        (unknowns.map(|(i, k)| forces[i][k]).collect(), load_n)
    }

    /// How the last equilibrium was found.
    fn found(&self) -> Equilibrium {
        Equilibrium {
            unknowns: self.degrees_of_freedom.count,
            held: self.degrees_of_freedom.held(),
            newton_steps: self.newton_steps,
            load_steps: self.load_steps,
            residuals: Vec::new(),
            residual_n: self.residual_n,
            bond_force_n: largest_bond_force_n(self.state),
            stable: true,
        }
    }

    /// Travel, forces and deflection at the present equilibrium.
    fn row(&mut self, at: f64) -> Row {
        let contacts = wall_forces(self.state);
        let direction = Vector3::from(self.setup.direction);
        let push = |moves: bool| -> f64 {
            let own = contacts
                .iter()
                .filter(|contact| self.loading.moving.walls.contains(&contact.wall) == moves);
            own.map(|contact| contact.force_n * contact.normal.dot(&direction))
                .sum()
        };
        let (pushed_n, held_n) = (push(true), push(false));
        let gripped_n: f64 = (self.gripped.iter())
            .map(|(particle, _)| {
                let [x, y, z, ..] = six(&self.state.particles.wrenches[*particle as usize]);
                -Vector3::new(x, y, z).dot(&direction)
            })
            .sum();
        let force_n = pushed_n + gripped_n;
        let has_walls = !self.loading.moving.walls.is_empty();
        Row {
            time_s: at,
            travel_m: at * self.stroke_m,
            force_n,
            reaction_n: if has_walls { -held_n } else { force_n },
            deflection_m: self.loading.deflection_m(self.setup, self.state),
            ..Row::default()
        }
    }
}
