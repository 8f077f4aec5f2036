//! A set as a single body: its centre of mass and its motion and rotation.
//!
//! A clump counts with its own mass, centre, velocity and angular momentum; the cluster that
//! replaces it has the same totals of its particles, so that every value is the same before and
//! after, except for rounding.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::measurement::{IfZero, Measurement, Settles};
use super::members::Members;
use super::probe::Probe;
use super::starts::{Starts, mean};
use super::view::{Motions, View};
use dem_engine::state::State;
use dem_physics::rigid::rotation_vector;
use dem_physics::rotation::numbers;
use dem_physics::rotation::rotation;

pub(super) const MEASUREMENTS: &[Measurement] = &[
    of_motion("position_x", |probe, view| {
        let wall = probe.walls[0].and_then(|wall| view.state.walls.get(wall));
        match wall {
            Some(wall) => wall.frame.position_m[probe.measure.part],
            None => probe.part(&centre(&probe.members, view.state)),
        }
    }),
    Measurement {
        counts_from_start: true,
        if_zero: IfZero::Note(|measure| Some(format!("'{}' did not move that way", measure.of))),
        ..of_motion("displacement_x", |probe, view| {
            probe.part(&centre_from(&probe.members, view.state, probe.start))
        })
    },
    of_motion("velocity_x", |probe, view| {
        probe.part(&velocity(&probe.members, view.state, view.motions()))
    }),
    Measurement {
        counts_from_start: true,
        ..of_motion("rotation_x", |probe, view| {
            let (starts, before) = (&probe.starts, &probe.turned_before);
            probe.part(&turn(&probe.members, view.state, starts, before))
        })
    },
    of_motion("angular_velocity_x", |probe, view| {
        probe.part(&spin(&probe.members, view.state, view.motions()))
    }),
    of_motion("kinetic_energy", |probe, view| {
        if probe.members.are_all {
            return view.balance.kinetic_j;
        }
        kinetic_j(&probe.members, view.state, view.motions())
    }),
];

const fn of_motion(name: &'static str, read: fn(&Probe, &View<'_>) -> f64) -> Measurement {
    Measurement {
        settles: Settles::IfHeld,
        ..Measurement::new(name, read)
    }
}

/// Centre of mass, m.
fn centre(members: &Members, state: &State) -> Vector3<f64> {
    mean(&places(members, state))
}

/// Distance of the centre of mass from a position, m.
fn centre_from(members: &Members, state: &State, from: Vector3<f64>) -> Vector3<f64> {
    let mut places = places(members, state);
    for (_, place) in &mut places {
        *place -= from;
    }
    mean(&places)
}

/// Masses, kg, and positions, m, of particles and clumps.
fn places(members: &Members, state: &State) -> Vec<(f64, Vector3<f64>)> {
    let p = &state.particles;
    let free = members.free(state);
    let free = free.map(|i| (1.0 / p.motions[i].inverse_mass, p.poses[i].place()));
    let clumps = members.clumps(state, &state.clumps.all);
    let clumps = clumps.map(|(clump, template)| (template.mass_kg, clump.place_m.into()));
    free.chain(clumps).collect()
}

/// Velocity of the centre of mass, m/s.
fn velocity(members: &Members, state: &State, motions: &Motions) -> Vector3<f64> {
    let p = &state.particles;
    let free = members.free(state).map(|i| {
        let velocity = Vector3::from(motions.particles[i].velocity_m_s);
        (1.0 / p.motions[i].inverse_mass, velocity)
    });
    let clumps = members.clumps(state, &motions.clumps);
    let clumps = clumps.map(|(clump, template)| (template.mass_kg, clump.velocity_m_s.into()));
    let parts: Vec<_> = free.chain(clumps).collect();
    mean(&parts)
}

fn kinetic_j(members: &Members, state: &State, motions: &Motions) -> f64 {
    let free = members.free(state);
    let free = free.map(|i| state.particles.kinetic_j(i, &motions.particles[i]));
    let clumps = members.clumps(state, &motions.clumps);
    free.sum::<f64>()
        + clumps
            .map(|(c, template)| c.kinetic_j(template))
            .sum::<f64>()
}

/// Spin of the rigid body with the same inertia and the same angular momentum about the centre of
/// mass, rad/s. For a single particle or clump, its own.
fn spin(members: &Members, state: &State, motions: &Motions) -> Vector3<f64> {
    let p = &state.particles;
    let (mut free, mut clumps) = (members.free(state), members.clumps(state, &motions.clumps));
    if let [Some(i), None] = [free.next(), free.next()]
        && clumps.next().is_none()
    {
        return motions.particles[i].spin_rad_s.into();
    }
    let about = centre(members, state);
    let velocity = velocity(members, state, motions);
    let (mut inertia, mut angular) = (Matrix3::zeros(), Vector3::zeros());
    let mut add = |mass: f64, place: Vector3<f64>, moving: [f64; 3], own: Matrix3<f64>, l| {
        let arm = place - about;
        inertia +=
            mass * (Matrix3::from_diagonal_element(arm.norm_squared()) - arm * arm.transpose());
        inertia += own;
        angular += mass * arm.cross(&(Vector3::from(moving) - velocity)) + l;
    };
    for i in members.free(state) {
        let (own, motion) = (&p.motions[i], &motions.particles[i]);
        let moment = 1.0 / own.inverse_inertia;
        let l = moment * Vector3::from(motion.spin_rad_s);
        let moments = Matrix3::from_diagonal_element(moment);
        let place = p.poses[i].place();
        add(
            1.0 / own.inverse_mass,
            place,
            motion.velocity_m_s,
            moments,
            l,
        );
    }
    for (clump, template) in members.clumps(state, &motions.clumps) {
        let to_space = rotation(clump.turned).to_rotation_matrix();
        let moments = Matrix3::from_diagonal(&template.moments_kg_m2.into());
        let own = to_space * moments * to_space.transpose();
        let l = Vector3::from(clump.angular_momentum);
        add(
            template.mass_kg,
            clump.place_m.into(),
            clump.velocity_m_s,
            own,
            l,
        );
    }
    // Every sphere has its own moment of inertia, so the total inertia is invertible.
    let solved = inertia.cholesky().map(|inertia| inertia.solve(&angular));
    solved.unwrap_or_else(|| Vector3::repeat(f64::NAN))
}

/// Mass-weighted mean of the rotation vectors since the start, rad, of 180 degrees at most.
/// `turned_before`: of particles that were rotated at the start.
fn turn(
    members: &Members,
    state: &State,
    starts: &Starts,
    turned_before: &BTreeMap<u32, UnitQuaternion<f64>>,
) -> Vector3<f64> {
    let p = &state.particles;
    let mut first: Option<Vector3<f64>> = None;
    let mut parts = Vec::new();
    let mut add = |mass_kg: f64, turned: [f64; 4]| {
        let near = *first.get_or_insert_with(|| rotation_vector(turned).into());
        parts.push((mass_kg, nearest(rotation_vector(turned).into(), &near)));
    };
    for i in members.free(state) {
        let before = turned_before.get(&(i as u32));
        let turned = p.poses[i].turned;
        let since = before.map_or(turned, |b| numbers(&(rotation(turned) * b.inverse())));
        add(1.0 / p.motions[i].inverse_mass, since);
    }
    for (clump, template) in members.clumps(state, &state.clumps.all) {
        let start = starts.get(&template.body);
        for (sphere, number) in template.spheres.iter().zip(template.file_number.iter()) {
            let before = start.and_then(|start| start.turned.get(*number as usize));
            let before = before.copied().unwrap_or_default();
            let now = rotation(clump.turned) * rotation(sphere.turned);
            add(sphere.mass_kg, numbers(&(now * before.inverse())));
        }
    }
    let mean = mean(&parts);
    nearest(mean, &Vector3::zeros())
}

/// Of the vectors of one rotation that are shorter than a full revolution, the one nearer to
/// another.
fn nearest(turn: Vector3<f64>, to: &Vector3<f64>) -> Vector3<f64> {
    let angle = turn.norm();
    if angle == 0.0 {
        return turn;
    }
    let other = turn * (1.0 - TAU / angle);
    if (other - to).norm() < (turn - to).norm() {
        other
    } else {
        turn
    }
}
