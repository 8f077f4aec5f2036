//! Rigid clumps in the time step: what acts on their spheres acts on them, and their spheres go where they go.

use nalgebra::Vector3;
use rayon::prelude::*;

use crate::physics::rigid::rotation_vector;
use crate::physics::rotation;
use crate::state::clumps::{Clump, Clumps, Template, numbers, rotation as rotation_of};
use crate::state::particles::{Motion, Particles, Pose, Wrench};

/// Sums up what acts on the spheres of each clump, and the energy that this takes from its motion in a step of `dt`, s. Nothing is left on the spheres.
pub fn gather(clumps: &mut Clumps, particles: &mut Particles, dt: f64) {
    let Clumps { templates, all } = clumps;
    let known = &*particles;
    all.par_iter_mut().for_each(|clump| {
        let template = &templates[clump.template as usize];
        let centre = Vector3::from(clump.place_m);
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        let first = clump.first as usize;
        for i in first..first + template.outer.len() {
            let wrench = &known.wrenches[i];
            let [fx, fy, fz, _] = wrench.force_n;
            let [tx, ty, tz, _] = wrench.torque_n_m;
            let on_sphere = Vector3::new(fx, fy, fz);
            if on_sphere != Vector3::zeros() || wrench.torque_n_m != [0.0; 4] {
                force += on_sphere;
                torque +=
                    Vector3::new(tx, ty, tz) + (known.poses[i].place() - centre).cross(&on_sphere);
            }
        }
        let power =
            force.dot(&Vector3::from(clump.velocity_m_s)) + torque.dot(&clump.spin_rad_s(template));
        clump.impact_energy_j += (-power * dt).max(0.0);
        clump.force_n = force.into();
        clump.torque_n_m = torque.into();
    });
    particles.wrenches[particles.free..].fill(Wrench::default());
}

/// Velocities and angular momenta changed by what acts on the clumps and by gravity, over the time `kick_s`.
pub fn kick(clumps: &mut Clumps, gravity_m_s2: [f64; 3], kick_s: f64) {
    let Clumps { templates, all } = clumps;
    for clump in all {
        let per_mass = kick_s / templates[clump.template as usize].mass_kg;
        for (k, gravity) in gravity_m_s2.iter().enumerate() {
            clump.velocity_m_s[k] += per_mass * clump.force_n[k] + kick_s * gravity;
            clump.angular_momentum[k] += kick_s * clump.torque_n_m[k];
        }
    }
}

/// Places and orientations after moving on for `time_step_s`, of clumps and of their spheres. Returns the largest speed of a sphere, m/s.
pub fn drift(clumps: &mut Clumps, particles: &mut Particles, time_step_s: f64) -> f64 {
    let Clumps { templates, all } = clumps;
    let Some(first) = all.first().map(|clump| clump.first as usize) else {
        return 0.0;
    };
    let mut poses = &mut particles.poses[first..];
    let mut motions = &mut particles.motions[first..];
    let mut work: Vec<(&mut Clump, &Template, &mut [Pose], &mut [Motion])> = Vec::new();
    for clump in all {
        let template = &*templates[clump.template as usize];
        let (own_poses, other_poses) = poses.split_at_mut(template.outer.len());
        let (own_motions, other_motions) = motions.split_at_mut(template.outer.len());
        work.push((clump, template, own_poses, own_motions));
        (poses, motions) = (other_poses, other_motions);
    }
    work.into_par_iter()
        .map(|(clump, template, poses, motions)| {
            drift_one(clump, template, poses, motions, time_step_s)
        })
        .reduce(|| 0.0, f64::max)
        .sqrt()
}

/// Moves a clump and its spheres. Returns the square of the largest speed of a sphere.
fn drift_one(
    clump: &mut Clump,
    template: &Template,
    poses: &mut [Pose],
    motions: &mut [Motion],
    dt: f64,
) -> f64 {
    let before = rotation_of(clump.turned);
    for k in 0..3 {
        clump.place_m[k] += dt * clump.velocity_m_s[k];
    }
    rotation::drift(
        &mut clump.turned,
        clump.angular_momentum,
        template.moments_kg_m2,
        dt,
    );
    let now = rotation_of(clump.turned);
    let spin_rad_s = rotation_vector(numbers(&(now * before.inverse()))).map(|angle| angle / dt);
    let mut fastest = 0.0_f64;
    for ((&sphere, pose), motion) in template.outer.iter().zip(poses).zip(motions) {
        let old = pose.place();
        let new = template.pose(sphere as usize, clump);
        pose.put_at(new.place().into());
        pose.turned = new.turned;
        // What contacts ask for: the way made in the step.
        let velocity = (new.place() - old) / dt;
        motion.velocity_m_s = velocity.into();
        motion.spin_rad_s = spin_rad_s;
        fastest = fastest.max(velocity.norm_squared());
    }
    fastest
}

/// Velocities and angular momenta at the time of the places, between a kick and the drift after it. One for each clump.
pub fn synchronous(clumps: &Clumps, gravity_m_s2: [f64; 3], time_step_s: f64) -> Vec<Clump> {
    let mut now = clumps.clone();
    kick(&mut now, gravity_m_s2, -0.5 * time_step_s);
    now.all
}
