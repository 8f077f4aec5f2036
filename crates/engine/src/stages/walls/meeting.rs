//! Forces between a wall and the particles that touch it, one contact for each lane.

use nalgebra::Vector3;

use crate::stages::bonds::blocks::{rows, vectors};
use crate::stages::contacts::forces::{contact_sphere, stored_contact};
use crate::state::contacts::ContactHistory;
use crate::state::meetings::{Meeting, Met};
use crate::state::particles::Particles;
use crate::state::walls::{Wall, WallContact};
use dem_physics::contact::NormalLaw;
use dem_physics::contact::assembly::{StoredContact, assemble};
use dem_physics::contact::kinematics::{WallPoint, wall_contact_kinematics};
use dem_physics::contact::law::{ContactKind, ContactWork};
use dem_physics::contact::rolling::RollingFriction;
use dem_physics::lanes::{LaneWork, Lanes, MOST, with_most_lanes};
use dem_physics::number::Vec3;

/// A wall and the particles at it.
pub(super) struct Place<'a> {
    pub(super) wall: &'a Wall,
    /// All walls, for contacts that have moved over from another one.
    pub(super) walls: &'a [Wall],
    /// The contacts of this wall that meetings continue.
    pub(super) olds: &'a [WallContact],
    pub(super) particles: &'a Particles,
    /// Material of each particle.
    pub(super) materials: &'a [u8],
    pub(super) least_overlap: f64,
    /// Time step just made, s.
    pub(super) dt: f64,
}

impl Place<'_> {
    /// Sets the interactions, in the order of the meetings.
    pub(super) fn meet(&self, meetings: &[Meeting], found: &mut Vec<Met>) {
        found.clear();
        with_most_lanes(MeetingWork {
            place: self,
            meetings,
            found,
        });
    }

    /// The contact that a meeting continues.
    #[inline(always)]
    fn old(&self, meeting: &Meeting) -> Option<&WallContact> {
        let olds = match meeting.old_wall {
            Some(wall) => &self.walls[wall as usize].touching,
            None => self.olds,
        };
        meeting.old.map(|old| &olds[old as usize])
    }

    fn kind(&self, meeting: &Meeting) -> &ContactKind {
        self.wall.kind(self.materials[meeting.particle as usize])
    }
}

struct MeetingWork<'a> {
    place: &'a Place<'a>,
    meetings: &'a [Meeting],
    found: &'a mut Vec<Met>,
}

impl LaneWork for MeetingWork<'_> {
    #[inline(always)]
    fn with<T: Lanes>(self, proof: T::Proof) {
        let Self {
            place,
            meetings,
            found,
        } = self;
        let alike = |a: &Meeting, b: &Meeting| std::ptr::eq(place.kind(a), place.kind(b));
        for meetings in meetings.chunk_by(alike) {
            let kind = place.kind(&meetings[0]);
            let work = KindWork::<T> {
                place,
                kind,
                meetings,
                found,
                proof,
            };
            kind.with(|number| T::all(proof, number), work);
        }
    }
}

/// The work on meetings of one contact type.
struct KindWork<'a, T: Lanes> {
    place: &'a Place<'a>,
    kind: &'a ContactKind,
    meetings: &'a [Meeting],
    found: &'a mut Vec<Met>,
    proof: T::Proof,
}

impl<T: Lanes> ContactWork<T> for KindWork<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with(self, law: &impl NormalLaw<T>, rolling: &impl RollingFriction<T>) {
        self.found.reserve(self.meetings.len());
        for some in self.meetings.chunks(T::COUNT) {
            let answers = self.place.meet_some(self.proof, (law, rolling), some);
            for (lane, meeting) in some.iter().enumerate() {
                self.found
                    .push(self.place.met(meeting, self.kind, &answers, lane));
            }
        }
    }
}

/// Geometry of a meeting.
#[derive(Clone, Copy, Default)]
struct Geometry {
    /// Unit vector from the wall to the centre, and the same a step before.
    normals: [Vector3<f64>; 2],
    /// Point of action of the force: half the overlap below the surface of the particle, m.
    point: Vector3<f64>,
    /// Velocity of the belt there, m/s.
    belt: Vector3<f64>,
    /// Velocity of the wall's surface there, m/s.
    velocity: Vector3<f64>,
}

impl Place<'_> {
    #[inline(always)]
    fn geometry(&self, meeting: &Meeting) -> Geometry {
        let wall = self.wall;
        let normal = -Vector3::from(meeting.there.normal);
        let pose = &self.particles.poses[meeting.particle as usize];
        let depth_m = 0.5 * (pose.radius_m() + meeting.there.distance_m);
        let point = pose.place() - normal * depth_m;
        let arm = point - Vector3::from(wall.frame.position_m);
        let [velocity, _] = wall.velocities_m_s.map(Vector3::from);
        let [spin, _] = wall.spins_rad_s.map(Vector3::from);
        let belt = Vector3::from(wall.model.surface_velocity_m_s);
        let belt = belt - normal * belt.dot(&normal);
        Geometry {
            normals: [
                normal,
                self.old(meeting).map_or(normal, |old| old.normal.into()),
            ],
            point,
            belt,
            velocity: velocity + spin.cross(&arm) + belt,
        }
    }

    /// Interaction of the particle in a lane.
    #[inline(always)]
    fn met(&self, meeting: &Meeting, kind: &ContactKind, answers: &Answers, lane: usize) -> Met {
        // Rows are borrowed: to copy those of all lanes for one number takes longer.
        let vector = |[x, y, z, _]: &[f64; 4]| Vector3::new(*x, *y, *z);
        let geometry = &answers.geometries[lane];
        let [normal, normal_before] = &geometry.normals;
        let radius_m = self.particles.poses[meeting.particle as usize].radius_m();
        let overlap_m = answers.overlaps[lane][3];
        Met {
            touch: WallContact {
                particle: meeting.particle,
                feature: meeting.there.feature,
                normal: (*normal).into(),
                history: ContactHistory {
                    tangential: answers.tangential[lane],
                    damping: answers.damping[lane],
                    rolling: answers.rolling[lane],
                    rolling_damping: answers.rolling_damping[lane],
                },
            },
            point: geometry.point,
            belt: geometry.belt,
            forces: [&answers.forces, &answers.damping].map(|rows| vector(&rows[lane])),
            torque: vector(&answers.torques[lane]),
            moments: [&answers.moments, &answers.overlaps].map(|rows| vector(&rows[lane])),
            elastic_j: answers.torques[lane][3],
            lost_j: [answers.moments[lane][3], answers.damping_j[lane]],
            crossed: meeting.is_behind || overlap_m > radius_m || normal_before.dot(normal) < 0.0,
            stiffness_n_m: kind.normal_n_m(overlap_m, radius_m),
        }
    }

    /// One to as many meetings as there are lanes.
    #[inline(always)]
    fn meet_some<T: Lanes, R: RollingFriction<T>>(
        &self,
        proof: T::Proof,
        laws: (&impl NormalLaw<T>, &R),
        some: &[Meeting],
    ) -> Answers {
        let meeting = |lane: usize| &some[lane.min(some.len() - 1)];
        let mut geometries = [Geometry::default(); MOST];
        for (geometry, meeting) in geometries.iter_mut().zip(some) {
            *geometry = self.geometry(meeting);
        }
        let row = |vector: &Vector3<f64>, last: f64| [vector.x, vector.y, vector.z, last];
        let [x, y, z, distance_m] = T::columns(proof, |lane| {
            row(&geometries[lane].normals[0], meeting(lane).there.distance_m)
        });
        let foot = WallPoint {
            normal: Vec3(x, y, z),
            normal_before: vectors(proof, |lane| row(&geometries[lane].normals[1], 0.0)),
            distance_m,
            velocity_m_s: vectors(proof, |lane| row(&geometries[lane].velocity, 0.0)),
            spin_rad_s: vectors(proof, |_| row(&self.wall.spins_rad_s[0].into(), 0.0)),
        };
        let particle = |lane: usize| meeting(lane).particle as usize;
        let (_, ball) = contact_sphere::<T>(
            proof,
            (&self.particles.poses, &self.particles.motions),
            particle,
        );
        let touch = wall_contact_kinematics(&foot, ball, self.dt);
        let none = ContactHistory::default();
        let history = |lane: usize| self.old(meeting(lane)).map_or(&none, |old| &old.history);
        let before = stored_contact::<T, R>(proof, history);
        let (law, rolling) = laws;
        let met = assemble(law, rolling, &touch, &before, self.least_overlap, self.dt);
        let StoredContact {
            springs, damped, ..
        } = met.remembered;
        let (energy, [_, torque]) = (met.response.energy, met.torques);
        let with = |Vec3(x, y, z): Vec3<T>, last: T| T::rows([x, y, z, last]);
        Answers {
            geometries,
            tangential: with(springs.tangential_m, springs.overlap_m),
            damping: with(damped.force_n, met.remembered.origin_m),
            rolling: with(springs.rolling_rad, met.overlap_m.zero()),
            rolling_damping: with(damped.moment_n_m, met.overlap_m.zero()),
            forces: rows(met.response.force_on_b),
            torques: with(torque, energy.normal + energy.tangential + energy.rolling),
            moments: with(met.response.moment_on_b, met.friction_j),
            overlaps: with(met.response.damping.rolling_n_m, met.overlap_m),
            damping_j: met.damping_j.values(),
        }
    }
}

/// Results for several meetings, row by row.
struct Answers {
    geometries: [Geometry; MOST],
    tangential: [[f64; 4]; MOST],
    damping: [[f64; 4]; MOST],
    rolling: [[f64; 4]; MOST],
    rolling_damping: [[f64; 4]; MOST],
    /// Forces on the particles.
    forces: [[f64; 4]; MOST],
    /// Torques on the particles, and elastic energies.
    torques: [[f64; 4]; MOST],
    /// Moments of rolling friction, and energies lost to friction.
    moments: [[f64; 4]; MOST],
    /// Damping moments of rolling friction, and overlaps of the law.
    overlaps: [[f64; 4]; MOST],
    damping_j: [f64; MOST],
}
