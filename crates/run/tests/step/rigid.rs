//! Space has no preferred direction, position or numbering, and rigid motion does not deform bonds.

use crate::bars::{
    BondDamping, ELASTIC, MODELS, body, damp, random_body, random_spheres, reopen, soft, turned,
};
use dem_engine::stages::bonds::forces::bond_wrenches;
use dem_engine::state::State;
use dem_engine::state::loads::GroupLoad;
use dem_engine::state::particles::Particles;
use dem_engine::step::step;
use dem_scene::Factor;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

#[test]
fn a_body_moved_as_a_whole_feels_no_force() {
    for (model, _) in MODELS {
        let mut state = random_body(model, ELASTIC, 1e-6);
        let rest = state.particles.poses.clone();
        let size = 1e-2;
        let all = 0..state.bonds.len();
        let stiffest = all.map(|at| state.bonds.normal(at)).fold(0.0, f64::max);
        for (axis, angle) in [
            (Vector3::x(), 0.1),
            (Vector3::new(1.0, 2.0, -1.0), 3.0),
            (Vector3::new(0.1, -2.0, 1.0), -2.0),
        ] {
            let by = UnitQuaternion::<f64>::from_scaled_axis(angle * axis.normalize());
            let shift = size * Vector3::new(0.3, -0.2, 0.5);
            for (pose, rest) in state.particles.poses.iter_mut().zip(&rest) {
                let place: Vector3<f64> = by * rest.place() + shift;
                let [x, y, z] = place.into();
                let q = by.quaternion();
                pose.put_at([x, y, z]);
                pose.turned = [q.i, q.j, q.k, q.w];
            }
            let p = &mut state.particles;
            bond_wrenches(
                &state.bonds,
                &p.poses,
                &mut state.scratch.partitions,
                &mut p.wrenches,
            );
            let of_all = |f: fn(&dem_engine::state::particles::Wrench) -> [f64; 4]| {
                p.wrenches
                    .iter()
                    .flat_map(f)
                    .map(f64::abs)
                    .fold(0.0, f64::max)
            };
            let force = of_all(|w| w.force_n) / (stiffest * size);
            let torque = of_all(|w| w.torque_n_m) / (stiffest * size * 1e-3);
            eprintln!("{model:?}: {force:e} {torque:e}");
            // Positions are rounded to 1e-16 of the size of the body; a particle has up to a dozen
            // bonds.
            assert!(
                force < 1e-14 && torque < 1e-14,
                "{model:?}: {force:e} {torque:e}"
            );
        }
    }
}

/// The random body with everything that has a direction: smooth motion, damping, gravity, a load.
fn scene(
    particles: Particles,
    pairs: &[[u32; 2]],
    gravity: Vector3<f64>,
    pulled: u32,
    by: [Vector3<f64>; 2],
) -> State {
    let bonding = soft(dem_physics::bond::stiffness::BondModel::Timoshenko, ELASTIC);
    let mut state = body(particles, pairs, &bonding, 1e-6);
    damp(&mut state, BondDamping::ChenByMode(0.05));
    state.model.gravity_m_s2 = gravity.into();
    state.loads = vec![GroupLoad {
        end_s: f64::INFINITY,
        particles: vec![pulled],
        force_n: by[0].into(),
        torque_n_m: by[1].into(),
        factor: Factor::Ramp { until_s: 1e-4 },
    }];
    reopen(&mut state);
    for _ in 0..300 {
        step(&mut state);
    }
    state
}

const GRAVITY: Vector3<f64> = Vector3::new(1.0, -2.0, -900.0);
const FORCE: Vector3<f64> = Vector3::new(3e-3, 1e-3, -2e-3);
const TORQUE: Vector3<f64> = Vector3::new(1e-7, -2e-6, 1e-6);

fn in_motion() -> (Particles, Vec<[u32; 2]>) {
    let (mut particles, pairs) = random_spheres();
    for (pose, motion) in particles.poses.iter().zip(&mut particles.motions) {
        let p = pose.place() * 600.0;
        motion.velocity_m_s = [0.1 * p.y.sin(), 0.1 * p.z.cos(), 0.1 * (p.x + p.y).sin()];
        motion.spin_rad_s = [100.0 * p.x.sin(), 0.0, 50.0 * p.y.cos()];
    }
    (particles, pairs)
}

/// Largest differences of positions and velocities, over their largest values.
fn apart(
    a: &State,
    b: &State,
    map: impl Fn(&Vector3<f64>) -> Vector3<f64>,
    spin: f64,
    number: impl Fn(usize) -> usize,
) -> f64 {
    let (mut place, mut velocity, mut turning) = ([0.0_f64; 2], [0.0_f64; 2], [0.0_f64; 2]);
    let start = &random_spheres().0;
    for i in 0..a.particles.len() {
        let j = number(i);
        let of = |s: &State, i: usize| {
            let m = &s.particles.motions[i];
            [
                s.particles.poses[i].place(),
                m.velocity_m_s.into(),
                m.spin_rad_s.into(),
            ]
        };
        let ([pa, va, wa], [pb, vb, wb]) = (of(a, i), of(b, j));
        let note = |to: &mut [f64; 2], a: &Vector3<f64>, b: &Vector3<f64>, size: f64| {
            to[0] = to[0].max((a - b).norm());
            to[1] = to[1].max(size);
        };
        note(
            &mut place,
            &map(&pa),
            &pb,
            (pa - start.poses[i].place()).norm(),
        );
        note(&mut velocity, &map(&va), &vb, va.norm());
        note(&mut turning, &(spin * map(&wa)), &wb, wa.norm());
    }
    [place, velocity, turning]
        .iter()
        .map(|[d, s]| d / s)
        .fold(0.0, f64::max)
}

/// Relative differences after 300 steps with motion everywhere: rounding.
const ROUNDING: f64 = 1e-10;

#[test]
fn a_turned_scene_gives_the_turned_result() {
    let (particles, pairs) = in_motion();
    let straight = scene(particles.clone(), &pairs, GRAVITY, 17, [FORCE, TORQUE]);
    let by = UnitQuaternion::from_euler_angles(0.7, -0.4, 2.0);
    let other = scene(
        turned(&particles, by),
        &pairs,
        by * GRAVITY,
        17,
        [by * FORCE, by * TORQUE],
    );
    let found = apart(&straight, &other, |v| by * v, 1.0, |i| i);
    eprintln!("{found:e}");
    assert!(found < ROUNDING, "{found:e}");
}

#[test]
fn a_mirrored_scene_gives_the_mirrored_result() {
    let (particles, pairs) = in_motion();
    let straight = scene(particles.clone(), &pairs, GRAVITY, 17, [FORCE, TORQUE]);
    let mirror = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0));
    let mut other = particles;
    for (pose, motion) in other.poses.iter_mut().zip(&mut other.motions) {
        pose.position_m[0] *= -1.0;
        motion.velocity_m_s[0] *= -1.0;
        motion.spin_rad_s[1] *= -1.0;
        motion.spin_rad_s[2] *= -1.0;
    }
    let other = scene(
        other,
        &pairs,
        mirror * GRAVITY,
        17,
        [mirror * FORCE, -mirror * TORQUE],
    );
    let found = apart(&straight, &other, |v| mirror * v, -1.0, |i| i);
    eprintln!("{found:e}");
    assert!(found < ROUNDING, "{found:e}");
}

/// Reversed numbering: every bond has its ends exchanged, and every sum another order.
#[test]
fn numbers_do_not_matter() {
    let (particles, pairs) = in_motion();
    let straight = scene(particles.clone(), &pairs, GRAVITY, 17, [FORCE, TORQUE]);
    let last = particles.len() - 1;
    let mut other = Particles::default();
    for i in (0..=last).rev() {
        let pose = particles.poses[i];
        let [x, y, z] = pose.place().into();
        other.push_sphere([x, y, z], particles.poses[i].radius_m(), 2050.0);
        *other.motions.last_mut().unwrap() = particles.motions[i];
    }
    let mut back: Vec<[u32; 2]> = pairs
        .iter()
        .map(|[a, b]| [last as u32 - b, last as u32 - a])
        .collect();
    back.sort_unstable();
    let other = scene(other, &back, GRAVITY, last as u32 - 17, [FORCE, TORQUE]);
    let found = apart(&straight, &other, |v| *v, 1.0, |i| last - i);
    eprintln!("{found:e}");
    assert!(found < ROUNDING, "{found:e}");
}
