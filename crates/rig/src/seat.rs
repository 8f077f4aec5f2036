//! A body that is brought to its supports: as a rigid body, it is moved and turned until the forces
//! of all walls that touch it are in balance.

use nalgebra::{Matrix6, Vector3, Vector6};

use dem_engine::state::State;
use dem_engine::state::particles::Pose;
use dem_engine::statics::contacts::{MovingWalls, wall_forces};
use dem_physics::rigid::turn;

/// Advance of the walls in a step of the approach, in mean radii.
const ADVANCE: f64 = 0.01;
/// The same while no particle is near a moving wall, which is less than the distance that is near.
const FAR_ADVANCE: f64 = 0.5;
/// Largest number of steps towards a balance.
const MOST_STEPS: usize = 200;
/// Balance: largest rigid step, in mean radii.
const SMALL_STEP: f64 = 1e-7;

/// Advances the moving walls of a test, from the beginning, until they press the body against the
/// others. Returns the fraction of their displacement. None: they never do.
pub(super) fn seat(
    state: &mut State,
    walls: &MovingWalls,
    moving: &[usize],
    way_m: f64,
    mean_radius_m: f64,
) -> Option<f64> {
    let mut fraction = 0.0;
    loop {
        walls.place(state, fraction, mean_radius_m);
        let is_near = |at: &usize| !state.walls[*at].near.is_empty();
        let advance = if moving.iter().any(is_near) {
            ADVANCE
        } else {
            FAR_ADVANCE
        };
        fraction += advance * mean_radius_m / way_m;
        if fraction > 1.0 {
            return None;
        }
        walls.place(state, fraction, mean_radius_m);
        balance(state, mean_radius_m);
        let forces = wall_forces(state);
        let touches = |moves: bool| {
            let mut pressing = forces.iter().filter(|force| force.force_n > 0.0);
            pressing.any(|force| moving.contains(&force.wall) == moves)
        };
        if touches(true) && touches(false) {
            return Some(fraction);
        }
    }
}

/// Moves and turns the whole state by the least energy of its contacts with walls: Newton steps
/// with a damping that grows until the energy falls (Levenberg and Marquardt).
fn balance(state: &mut State, mean_radius_m: f64) {
    let mut damping = 1e-3;
    let mut energy_j = energy(state);
    for _ in 0..MOST_STEPS {
        let centre = centre(state);
        let (gradient, stiffness) = derivatives(state, &centre);
        if gradient == Vector6::zeros() {
            return;
        }
        // A length for turns: the size of the body.
        let size_m = extent_m(state, &centre);
        let scale = stiffness.fixed_view::<3, 3>(0, 0).trace().max(1e-300);
        let mut damped = stiffness;
        for k in 0..6 {
            let weight = if k < 3 { 1.0 } else { size_m * size_m };
            damped[(k, k)] += damping * scale * weight;
        }
        let Some(step) = damped.cholesky().map(|factor| -factor.solve(&gradient)) else {
            return;
        };
        let longest_m = step.fixed_rows::<3>(0).norm() + size_m * step.fixed_rows::<3>(3).norm();
        let before = state.particles.poses.clone();
        // No further than the walls advance: a light touch must not throw the body away.
        let most_m = ADVANCE * mean_radius_m;
        move_rigidly(state, &centre, &(step * (most_m / longest_m).min(1.0)));
        let new_j = energy(state);
        if new_j < energy_j {
            energy_j = new_j;
            damping = f64::max(0.1 * damping, 1e-9);
        } else {
            state.particles.poses = before;
            damping *= 10.0;
        }
        if longest_m < SMALL_STEP * mean_radius_m || damping > 1e6 {
            return;
        }
    }
}

fn energy(state: &State) -> f64 {
    wall_forces(state).iter().map(|force| force.energy_j).sum()
}

fn centre(state: &State) -> Vector3<f64> {
    let poses = &state.particles.poses;
    poses.iter().map(Pose::place).sum::<Vector3<f64>>() / poses.len().max(1) as f64
}

fn extent_m(state: &State, centre: &Vector3<f64>) -> f64 {
    let poses = state.particles.poses.iter();
    poses
        .map(|pose| (pose.place() - centre).norm())
        .fold(0.0, f64::max)
}

/// Gradient and stiffness of the energy of contacts with respect to a displacement, m, and a turn
/// about `centre`, rad.
fn derivatives(state: &State, centre: &Vector3<f64>) -> (Vector6<f64>, Matrix6<f64>) {
    let (mut gradient, mut stiffness) = (Vector6::zeros(), Matrix6::zeros());
    for force in wall_forces(state) {
        let arm = state.particles.poses[force.particle].place() - centre;
        let turning = arm.cross(&force.normal);
        let mut way = Vector6::zeros();
        way.fixed_rows_mut::<3>(0).copy_from(&force.normal);
        way.fixed_rows_mut::<3>(3).copy_from(&turning);
        gradient -= force.force_n * way;
        stiffness += force.stiffness_n_m * way * way.transpose();
    }
    (gradient, stiffness)
}

fn move_rigidly(state: &mut State, centre: &Vector3<f64>, step: &Vector6<f64>) {
    let by: Vector3<f64> = step.fixed_rows::<3>(0).into();
    let angle: Vector3<f64> = step.fixed_rows::<3>(3).into();
    let rotation = nalgebra::Rotation3::new(angle);
    for pose in &mut state.particles.poses {
        let radius_m = pose.radius_m();
        let [x, y, z] = (centre + by + rotation * (pose.place() - centre)).into();
        pose.position_m = [x, y, z, radius_m];
        pose.turned = turn(pose.turned, angle.into());
    }
}
