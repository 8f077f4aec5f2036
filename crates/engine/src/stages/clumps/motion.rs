//! Rigid clumps in the time step: forces on their spheres act on the clumps, and the spheres move
//! with them.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::stages::clusters::bytes::{ClusterUser, clusters_bytes};
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::clumps::Template;
use crate::state::clumps::{Clump, Clumps};
use crate::state::particles::{Motion, Particles, Pose, Wrench};
use crate::state::search::buffers::NearBuffers;
use crate::threads::{for_each, largest_of};
use dem_physics::bending::{Beyond, SlenderBody};
use dem_physics::rigid::rotation_vector;
use dem_physics::rotation;
use dem_physics::rotation::numbers;
use dem_physics::rotation::rotation as rotation_of;

/// Clumps handled by one task.
const CHUNK: usize = 32;

/// Rigid clumps.
pub(crate) const CLUMPS: Stage = Stage {
    bytes: |state| {
        clusters_bytes(state, ClusterUser::Clumps)
            + size_of::<Clump>() * state.clumps.all.len()
            + size_of_val(&state.clumps.near[..])
            + Template::bytes_of(&state.clumps.templates)
    },
    ..Stage::new("rigid clumps", |state, _| {
        let templates = &state.clumps.templates;
        let sum = |count: fn(&Template) -> usize| templates.iter().map(|t| count(t)).sum::<usize>();
        let (spheres, outer) = (sum(|t| t.spheres.len()), sum(|t| t.outer.len()));
        let shapes = match templates.len() {
            1 => "one shape".to_owned(),
            shapes => format!("{shapes} shapes"),
        };
        let clumps = state.clumps.all.len();
        Need::of(
            !templates.is_empty(),
            || {
                if state.has_no_lasting_clump() {
                    return "what inlets feed, until it is a particle".to_owned();
                }
                format!(
                    "{clumps} at the start; of the {spheres} spheres of {shapes} the {outer} outer ones"
                )
            },
            "no body starts as a clump",
        )
    })
};

/// Sums the contact forces on the spheres of clumps.
pub(crate) fn gather_clumps(state: &mut State) -> usize {
    if state.contacts.is_some() {
        gather(
            &mut state.clumps,
            &mut state.particles,
            state.previous_time_step_s,
        );
    }
    0
}

/// Updates the velocities of clumps. Returns the number of clumps that are awake.
pub(crate) fn kick_clumps(state: &mut State) -> usize {
    let kick_s = state.kick_s();
    kick(&mut state.clumps, state.model.gravity_m_s2, kick_s);
    awake(&state.clumps)
}

/// Moves clumps and those of their spheres that are near something.
pub(crate) fn drift_clumps(state: &mut State) -> usize {
    let (clumps, particles) = (&mut state.clumps, &mut state.particles);
    let fastest_m_s = drift(clumps, particles, state.time_step_s);
    state.fastest_m_s = state.fastest_m_s.max(fastest_m_s);
    0
}

/// Number of clumps that are awake.
pub(crate) fn awake(clumps: &Clumps) -> usize {
    clumps.all.iter().filter(|clump| !clump.asleep).count()
}

/// Records which spheres of clumps are near something, after the search for pairs and walls, and
/// puts those in place that were not near before. `near`: particles that are, in any order, with
/// duplicates.
pub(crate) fn list_near(
    clumps: &mut Clumps,
    particles: &mut Particles,
    near: impl Iterator<Item = u32>,
    NearBuffers { bits, former }: &mut NearBuffers,
) {
    let free = particles.free;
    let mut is_near = Bits::all_clear(bits, particles.len() - free);
    let of_clumps = near.filter_map(|i| (i as usize).checked_sub(free));
    of_clumps.for_each(|i| is_near.set(i));
    let mut now = std::mem::take(former);
    now.clear();
    now.extend(is_near.all().map(|i| (free + i) as u32));
    for &i in &clumps.near {
        is_near.clear(i as usize - free);
    }
    *former = clumps.set_near(now);
    for clump in clumps.all.iter().filter(|clump| !clump.asleep) {
        let [from, to] = clump.near.map(|n| n as usize);
        // Those that were near before are in place and have a velocity.
        let now_near = clumps.near[from..to].iter().map(|&i| i as usize);
        let mut now_near = now_near.filter(|i| is_near.get(i - free)).peekable();
        if now_near.peek().is_none() {
            continue;
        }
        let template = clumps.template(clump);
        let to_space = rotation_of(clump.turned).to_rotation_matrix();
        let motion_at = clump.motion(template);
        for i in now_near {
            let sphere = template.outer[i - clump.first as usize] as usize;
            let place = place_of(template, sphere, clump, &to_space);
            particles.poses[i].put_at(place.into());
            particles.motions[i] = motion_at(&place);
        }
    }
}

/// A bit for each of many numbers, most of which are clear.
struct Bits<'a>(&'a mut [u64]);

impl<'a> Bits<'a> {
    fn all_clear(memory: &'a mut Vec<u64>, count: usize) -> Self {
        memory.clear();
        memory.resize(count.div_ceil(64), 0);
        Self(memory)
    }

    fn set(&mut self, i: usize) {
        self.0[i / 64] |= 1 << (i % 64);
    }

    fn clear(&mut self, i: usize) {
        self.0[i / 64] &= !(1 << (i % 64));
    }

    fn get(&self, i: usize) -> bool {
        self.0[i / 64] >> (i % 64) & 1 == 1
    }

    /// The numbers that are set, ascending.
    fn all(&self) -> impl Iterator<Item = usize> {
        self.0.iter().enumerate().flat_map(|(at, &word)| {
            let without_lowest = |word: &u64| Some(word & (word - 1)).filter(|&word| word != 0);
            let words = std::iter::successors(Some(word).filter(|&word| word != 0), without_lowest);
            words.map(move |word| 64 * at + word.trailing_zeros() as usize)
        })
    }
}

/// Centre of a sphere of a clump that has this rotation, m.
pub(crate) fn place_of(
    template: &Template,
    sphere: usize,
    clump: &Clump,
    to_space: &Rotation3<f64>,
) -> Vector3<f64> {
    Vector3::from(clump.place_m) + to_space * Vector3::from(template.spheres[sphere].place_m)
}

/// Puts all spheres of all clumps in place. Those of clumps that sleep at rest already are.
pub fn place_all(clumps: &Clumps, particles: &mut Particles) {
    for clump in (clumps.all.iter()).filter(|clump| !clump.asleep || clump.rides()) {
        place_spheres(clumps, clump, particles);
    }
}

/// Puts all spheres of the clumps that are awake in place.
pub(crate) fn place_awake(clumps: &Clumps, particles: &mut Particles) {
    for clump in clumps.all.iter().filter(|clump| !clump.asleep) {
        place_spheres(clumps, clump, particles);
    }
}

/// Puts all spheres of a clump in place.
pub(crate) fn place_spheres(clumps: &Clumps, clump: &Clump, particles: &mut Particles) {
    let template = clumps.template(clump);
    let turned = rotation_of(clump.turned);
    let to_space = turned.to_rotation_matrix();
    let spheres = &mut particles.poses[clumps.spheres_of(clump)];
    for (pose, &sphere) in spheres.iter_mut().zip(template.outer.iter()) {
        pose.put_at(place_of(template, sphere as usize, clump, &to_space).into());
        let of_sphere = rotation_of(template.spheres[sphere as usize].turned);
        pose.turned = numbers(&(turned * of_sphere));
    }
}

/// Some clumps in their order, and what belongs to their spheres.
struct Part<'a> {
    clumps: &'a mut [Clump],
    poses: &'a mut [Pose],
    motions: &'a mut [Motion],
    wrenches: &'a mut [Wrench],
    /// Number of the first of their spheres among the particles.
    first: usize,
}

impl<'a> Part<'a> {
    /// All of them.
    fn of(all: &'a mut [Clump], particles: &'a mut Particles) -> Self {
        let free = particles.free;
        Self {
            clumps: all,
            poses: &mut particles.poses[free..],
            motions: &mut particles.motions[free..],
            wrenches: &mut particles.wrenches[free..],
            first: free,
        }
    }

    /// Divided into parts of as many clumps as a task handles.
    fn divided(self) -> impl Iterator<Item = Self> {
        let (mut first, end) = (self.first, self.first + self.poses.len());
        let (mut poses, mut motions, mut wrenches) = (self.poses, self.motions, self.wrenches);
        let mut chunks = self.clumps.chunks_mut(CHUNK).peekable();
        std::iter::from_fn(move || {
            let clumps = chunks.next()?;
            let next = chunks.peek().map_or(end, |next| next[0].first as usize);
            let count = next - first;
            let part = Self {
                clumps,
                poses: poses.split_off_mut(..count)?,
                motions: motions.split_off_mut(..count)?,
                wrenches: wrenches.split_off_mut(..count)?,
                first,
            };
            first = next;
            Some(part)
        })
    }
}

/// The contacts on the parts of a slender clump beyond its sections.
struct Bending<'a> {
    body: &'a SlenderBody,
    to_principal: UnitQuaternion<f64>,
    beyond: Beyond,
}

impl<'a> Bending<'a> {
    fn of(clump: &Clump, body: &'a SlenderBody) -> Self {
        Self {
            body,
            to_principal: rotation_of(clump.turned).inverse(),
            beyond: Beyond::default(),
        }
    }

    /// Adds the force and moment on a sphere at this place relative to the centre.
    fn add(&mut self, arm: &Vector3<f64>, on_it: [Vector3<f64>; 2]) {
        let place = self.to_principal * arm;
        let along = on_it.map(|v| self.to_principal * v);
        self.body.add(&mut self.beyond, &place, along);
    }

    /// Records the bending of a clump under this force and torque.
    fn note(&self, clump: &mut Clump, template: &Template, on_it: [Vector3<f64>; 2], dt: f64) {
        let [force, torque] = on_it.map(|v| self.to_principal * v);
        let turning = torque.component_div(&Vector3::from(template.moments_kg_m2));
        let accelerations = [force / template.mass_kg, turning];
        let stress = self.body.stress(accelerations, &self.beyond);
        (clump.hits).note_bending(stress, dt, self.body.volume_m3, template.breaks_from_n_m);
    }
}

/// Sums the forces on the spheres of each clump, and the energy that they take from its motion in a
/// step of `dt`, s. Clears the wrenches of the spheres.
pub fn gather(clumps: &mut Clumps, particles: &mut Particles, dt: f64) {
    let Clumps {
        templates,
        all,
        near,
        ..
    } = clumps;
    for_each(Part::of(all, particles).divided(), |part| {
        for clump in part.clumps.iter_mut().filter(|clump| !clump.asleep) {
            let centre = Vector3::from(clump.place_m);
            let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
            let template = &templates[clump.template as usize];
            let mut squeeze = Matrix3::zeros();
            let can_break = template.breaks_from_n_m.is_finite();
            let mut bending: Option<Bending<'_>> = None;
            let [from, to] = clump.near.map(|n| n as usize);
            for i in near[from..to].iter().map(|&i| i as usize - part.first) {
                let wrench = &mut part.wrenches[i];
                let [fx, fy, fz, _] = wrench.force_n;
                let [tx, ty, tz, _] = wrench.torque_n_m;
                let on_sphere = Vector3::new(fx, fy, fz);
                let arm = part.poses[i].place() - centre;
                let moment = Vector3::new(tx, ty, tz) + arm.cross(&on_sphere);
                force += on_sphere;
                torque += moment;
                *wrench = Wrench::default();
                if can_break && on_sphere != Vector3::zeros() {
                    let to_contact = part.poses[i].radius_m() * on_sphere.normalize();
                    squeeze += on_sphere * (arm - to_contact).transpose();
                    if let Some(body) = &template.slender {
                        let bending = bending.get_or_insert_with(|| Bending::of(clump, body));
                        bending.add(&arm, [on_sphere, moment]);
                    }
                }
            }
            if can_break {
                let touched = (squeeze != Matrix3::zeros()).then_some(&squeeze);
                clump.hits.note(touched, template.breaks_from_n_m);
                if let (Some(bending), Some(_)) = (&bending, touched) {
                    bending.note(clump, template, [force, torque], dt);
                }
            }
            let spin = clump.spin_rad_s(template);
            let power = force.dot(&Vector3::from(clump.velocity_m_s)) + torque.dot(&spin);
            clump.impact_energy_j += (-power * dt).max(0.0);
            clump.force_n = force.into();
            clump.torque_n_m = torque.into();
        }
    });
}

/// Changes velocities and angular momenta by the wrenches on the clumps and by gravity, over the
/// time `kick_s`.
pub fn kick(clumps: &mut Clumps, gravity_m_s2: [f64; 3], kick_s: f64) {
    let Clumps { templates, all, .. } = clumps;
    for_each(all.chunks_mut(CHUNK), |some| {
        for clump in some.iter_mut().filter(|clump| !clump.asleep) {
            let template = &templates[clump.template as usize];
            kick_one(clump, template, gravity_m_s2, kick_s);
        }
    });
}

/// As [`kick`], for one clump, awake or not.
pub(crate) fn kick_one(
    clump: &mut Clump,
    template: &Template,
    gravity_m_s2: [f64; 3],
    kick_s: f64,
) {
    let per_mass = kick_s / template.mass_kg;
    for (k, gravity) in gravity_m_s2.iter().enumerate() {
        clump.velocity_m_s[k] += per_mass * clump.force_n[k] + kick_s * gravity;
        clump.angular_momentum[k] += kick_s * clump.torque_n_m[k];
    }
}

/// Updates positions and orientations, over `time_step_s`, of clumps and of those of their spheres
/// that are near something. Returns an upper bound of the speed of all spheres, m/s.
pub fn drift(clumps: &mut Clumps, particles: &mut Particles, time_step_s: f64) -> f64 {
    let Clumps {
        templates,
        all,
        near,
        ..
    } = clumps;
    largest_of(Part::of(all, particles).divided(), |part| {
        let mut fastest = 0.0_f64;
        for clump in part.clumps.iter_mut().filter(|clump| !clump.asleep) {
            let template = &templates[clump.template as usize];
            let (speed, spin_rad_s) = drift_one(clump, template, time_step_s);
            fastest = fastest.max(speed);
            let to_space = rotation_of(clump.turned).to_rotation_matrix();
            let per_s = 1.0 / time_step_s;
            let [from, to] = clump.near.map(|n| n as usize);
            for &i in &near[from..to] {
                let sphere = template.outer[(i - clump.first) as usize] as usize;
                let pose = &mut part.poses[i as usize - part.first];
                let motion = &mut part.motions[i as usize - part.first];
                let place = place_of(template, sphere, clump, &to_space);
                // Contacts use the displacement in the step.
                motion.velocity_m_s = ((place - pose.place()) * per_s).into();
                motion.spin_rad_s = spin_rad_s;
                pose.put_at(place.into());
            }
        }
        fastest
    })
}

/// Upper bound of the speed of the spheres of a clump, m/s.
pub fn speed_m_s(clump: &Clump, template: &Template) -> f64 {
    let turning_m_s = clump.spin_rad_s(template).norm() * template.reach_m;
    Vector3::from(clump.velocity_m_s).norm() + turning_m_s
}

/// Updates position and orientation of a clump. Returns an upper bound of the speed of its spheres,
/// m/s, and its mean spin in this step, rad/s.
fn drift_one(clump: &mut Clump, template: &Template, time_step_s: f64) -> (f64, [f64; 3]) {
    let before = rotation_of(clump.turned);
    for k in 0..3 {
        clump.place_m[k] += time_step_s * clump.velocity_m_s[k];
    }
    rotation::drift(
        &mut clump.turned,
        clump.angular_momentum,
        template.moments_kg_m2,
        time_step_s,
    );
    let now = rotation_of(clump.turned);
    let turn = rotation_vector(numbers(&(now * before.inverse())));
    let spin_rad_s = turn.map(|angle| angle / time_step_s);
    let speed = Vector3::from(clump.velocity_m_s).norm();
    let speed = speed + Vector3::from(spin_rad_s).norm() * template.reach_m;
    clump.moved_m = speed * time_step_s;
    (speed, spin_rad_s)
}

/// Velocities and angular momenta at the time of the positions, between a kick and the drift after
/// it. One for each clump.
pub fn synchronous(state: &State) -> Vec<Clump> {
    let mut now = state.clumps.all.clone();
    for clump in now.iter_mut().filter(|clump| !clump.asleep) {
        let back_s = -0.5 * state.time_step_s;
        let template = state.clumps.template(clump);
        kick_one(clump, template, state.model.gravity_m_s2, back_s);
    }
    now
}
