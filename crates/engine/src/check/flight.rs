//! Bodies in free flight: the wall that they meet first, and the time.
//!
//! A body without supports, loads and contacts moves on a parabola and rotates uniformly. The
//! meeting is found by conservative advancement: the body moves on by the time in which none of its
//! points can cross the gap to the wall, until the gap is closed. The result is exact except for
//! two things that are left open: moving walls, and other bodies that come near.

use std::collections::BTreeSet;

use dem_scene::{Hold, Scene, WallMotion};
use nalgebra::{UnitQuaternion, Vector3};

use crate::state::State;
use crate::state::bodies::PlacedBody;
use crate::state::clumps::Clump;
use crate::state::events::REMOVED;
use crate::state::walls::Wall;

/// A gap smaller than this fraction of the body's extent counts as closed.
const CLOSED: f64 = 1e-6;
/// Largest number of moves towards a wall: beyond it, the body grazes the wall.
const MOVES: usize = 2000;

/// A body that flies freely, as a rigid assembly of spheres.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeBody {
    /// Name of the body in the scene.
    pub name: String,
    /// Centre of mass, m.
    pub(super) centre_m: Vector3<f64>,
    /// m/s.
    pub velocity_m_s: Vector3<f64>,
    pub(super) spin_rad_s: Vector3<f64>,
    pub(super) gravity_m_s2: Vector3<f64>,
    /// Centres relative to the centre of mass, m, and radii, m.
    pub(super) spheres: Vec<(Vector3<f64>, f64)>,
    /// Largest distance of a point from the centre of mass, m.
    pub(super) reach_m: f64,
}

/// First meeting of a flying body.
#[derive(Debug, Clone, PartialEq)]
pub enum Meeting {
    /// With a wall, after this time, s, at this speed of its centre, m/s.
    At {
        /// Time from the present, s.
        after_s: f64,
        /// Name of the wall.
        wall: String,
        /// m/s.
        speed_m_s: f64,
    },
    /// None, however long it flies.
    Never,
    /// It depends on a moving wall or another body.
    Unknown,
}

/// Whether bodies can touch walls or each other at all.
pub fn can_meet(state: &State, scene: &Scene) -> bool {
    let others = scene.bodies.len() > 1 || state.clumps.all.len() > 1 || !scene.inlets.is_empty();
    state.contacts.is_some() && (!state.walls.is_empty() || others)
}

/// The bodies of the scene that are held, loaded or asleep. Those that may move count as infinitely
/// large: whatever flies may meet them.
pub fn standing_bodies(state: &State, bodies: &[PlacedBody]) -> Vec<FreeBody> {
    let moving = state.supports.iter().filter(|support| {
        let mut holds = support.holds.iter().flatten();
        holds.any(|hold| *hold != Hold::Fixed)
    });
    let moved = moving.flat_map(|support| support.held.iter().map(|held| held.particle));
    let loaded = state.loads.iter().flat_map(|load| &load.particles).copied();
    let moved: BTreeSet<u32> = moved.chain(loaded).collect();
    let bound = bound_particles(state);
    let p = &state.particles;
    let is_bound = |i: &u32| bound.contains(i) || p.sleeps(*i as usize);
    let rides = |i: u32| p.sleeps(i as usize) && p.motions[i as usize].velocity_m_s != [0.0; 3];
    let of_bodies = bodies.iter().filter_map(|body| {
        let living = body.particles.iter().copied();
        let living: Vec<u32> = living.filter(|i| *i != REMOVED).collect();
        living.iter().any(is_bound).then(|| {
            let mut standing = FreeBody::of_particles(state, &body.name, &living);
            if living.iter().any(|i| moved.contains(i) || rides(*i)) {
                standing.reach_m = f64::INFINITY;
            }
            standing
        })
    });
    let asleep = state.clumps.all.iter().filter(|clump| clump.asleep);
    let of_clumps = asleep.map(|clump| {
        let mut standing = FreeBody::of_clump(state, clump);
        if clump.rides() {
            standing.reach_m = f64::INFINITY;
        }
        standing
    });
    let mut standing: Vec<FreeBody> = of_bodies.chain(of_clumps).collect();
    for body in &mut standing {
        body.velocity_m_s = Vector3::zeros();
        body.gravity_m_s2 = Vector3::zeros();
    }
    standing
}

/// The particles that are held or loaded.
fn bound_particles(state: &State) -> BTreeSet<u32> {
    let held = state.supports.iter().flat_map(|support| &support.held);
    let held = held.map(|held| held.particle);
    let loaded = state.loads.iter().flat_map(|load| &load.particles).copied();
    held.chain(loaded).collect()
}

/// The bodies of the scene in free flight: neither held nor loaded, nor asleep. Their velocities
/// are those of `ahead_s` after their positions.
pub fn free_bodies(state: &State, bodies: &[PlacedBody], ahead_s: f64) -> Vec<FreeBody> {
    let bound = bound_particles(state);
    let is_free = |i: &u32| !bound.contains(i) && !state.particles.sleeps(*i as usize);
    let of_bodies = bodies.iter().filter_map(|body| {
        let living = body.particles.iter().copied();
        let living: Vec<u32> = living.filter(|i| *i != REMOVED).collect();
        let flies = !living.is_empty() && living.iter().all(is_free);
        flies.then(|| FreeBody::of_particles(state, &body.name, &living))
    });
    let awake = state.clumps.all.iter().filter(|clump| !clump.asleep);
    let of_clumps = awake.map(|clump| FreeBody::of_clump(state, clump));
    let mut free_bodies: Vec<FreeBody> = of_bodies.chain(of_clumps).collect();
    for flyer in &mut free_bodies {
        flyer.velocity_m_s -= ahead_s * flyer.gravity_m_s2;
    }
    free_bodies
}

/// Clusters in free flight, from their particles. Their velocities are those of `ahead_s` after
/// their positions.
pub fn free_clusters(state: &State, clusters: &[&[u32]], ahead_s: f64) -> Vec<FreeBody> {
    let of_one = |particles: &&[u32]| {
        let mut flyer = FreeBody::of_particles(state, "", particles);
        flyer.velocity_m_s -= ahead_s * flyer.gravity_m_s2;
        flyer
    };
    clusters.iter().map(of_one).collect()
}

impl FreeBody {
    /// The particles as one rigid body.
    pub(super) fn of_particles(state: &State, name: &str, particles: &[u32]) -> Self {
        let p = &state.particles;
        let (mut mass_kg, mut moment, mut momentum) = (0.0, Vector3::zeros(), Vector3::zeros());
        let mut spin = Vector3::zeros();
        for &i in particles {
            let i = i as usize;
            let motion = &p.motions[i];
            let own_kg = 1.0 / motion.inverse_mass;
            mass_kg += own_kg;
            moment += own_kg * p.poses[i].place();
            momentum += own_kg * Vector3::from(motion.velocity_m_s);
            spin += own_kg * Vector3::from(motion.spin_rad_s);
        }
        let centre_m = moment / mass_kg;
        let spheres = particles.iter().map(|&i| {
            let pose = &p.poses[i as usize];
            (pose.place() - centre_m, pose.radius_m())
        });
        let gravity_m_s2 = state.model.gravity_m_s2.into();
        let velocity_m_s = momentum / mass_kg;
        Self::new(name, spheres.collect(), gravity_m_s2).moving(
            centre_m,
            velocity_m_s,
            spin / mass_kg,
        )
    }

    fn of_clump(state: &State, clump: &Clump) -> Self {
        let outer = &state.clumps.template(clump).outer;
        Self::of_spheres(state, clump, outer.iter().map(|&sphere| sphere as usize))
    }

    /// A clump with these of its spheres.
    pub(super) fn of_spheres(
        state: &State,
        clump: &Clump,
        spheres: impl Iterator<Item = usize>,
    ) -> Self {
        let template = state.clumps.template(clump);
        let centre_m = Vector3::from(clump.place_m);
        let spheres = spheres.map(|sphere| {
            let pose = template.pose(sphere, clump);
            (pose.place() - centre_m, template.scale * pose.radius_m())
        });
        Self::new(
            &template.body,
            spheres.collect(),
            state.model.gravity_m_s2.into(),
        )
        .moving(
            centre_m,
            clump.velocity_m_s.into(),
            clump.spin_rad_s(template),
        )
    }

    /// A body at rest at the origin: centres and radii of its spheres, m.
    pub fn new(name: &str, spheres: Vec<(Vector3<f64>, f64)>, gravity_m_s2: Vector3<f64>) -> Self {
        let reach_m = spheres.iter().map(|(arm, radius_m)| arm.norm() + radius_m);
        Self {
            name: name.to_owned(),
            centre_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            spin_rad_s: Vector3::zeros(),
            gravity_m_s2,
            reach_m: reach_m.fold(0.0, f64::max),
            spheres,
        }
    }

    /// The same body at a position, m, with a velocity, m/s, and a spin, rad/s.
    pub fn moving(
        mut self,
        centre: Vector3<f64>,
        velocity: Vector3<f64>,
        spin: Vector3<f64>,
    ) -> Self {
        self.centre_m = centre;
        self.velocity_m_s = velocity;
        self.spin_rad_s = spin;
        self
    }

    /// Centre of mass after a time, s, in m.
    pub fn centre_after(&self, time_s: f64) -> Vector3<f64> {
        self.centre_m + time_s * (self.velocity_m_s + 0.5 * time_s * self.gravity_m_s2)
    }

    fn velocity_after(&self, time_s: f64) -> Vector3<f64> {
        self.velocity_m_s + time_s * self.gravity_m_s2
    }

    /// Its first meeting with the walls and the other bodies.
    pub fn first_meeting(&self, walls: &[Wall], others: &[Self]) -> Meeting {
        let mut first = Meeting::Never;
        let mut first_s = f64::INFINITY;
        for wall in walls {
            match self.meeting(wall) {
                Meeting::Unknown => return Meeting::Unknown,
                Meeting::At { after_s, .. } if after_s >= first_s => {}
                Meeting::Never => {}
                meeting => {
                    if let Meeting::At { after_s, .. } = &meeting {
                        first_s = *after_s;
                    }
                    first = meeting;
                }
            }
        }
        let others = others.iter().filter(|other| *other != self);
        let may_meet = |other: &Self| self.comes_near_after(other).is_some_and(|s| s < first_s);
        if others.into_iter().any(may_meet) {
            return Meeting::Unknown;
        }
        first
    }

    /// Its meeting with this wall alone.
    fn meeting(&self, wall: &Wall) -> Meeting {
        if wall.model.motion != WallMotion::Fixed {
            return Meeting::Unknown;
        }
        let mut after_s = 0.0;
        for _ in 0..MOVES {
            let gap_m = self.gap_after(wall, after_s);
            if gap_m <= CLOSED * self.reach_m {
                let speed_m_s = self.velocity_after(after_s).norm();
                let wall = wall.model.name.clone();
                return Meeting::At {
                    after_s,
                    wall,
                    speed_m_s,
                };
            }
            if self.leaves(wall, after_s) {
                return Meeting::Never;
            }
            after_s += self.time_for(gap_m, after_s);
            if !after_s.is_finite() {
                return Meeting::Never;
            }
        }
        Meeting::Unknown
    }

    /// Gap between its surface and a wall after a time, s, in m; at most 0 if they touch.
    pub fn gap_after(&self, wall: &Wall, time_s: f64) -> f64 {
        let to_wall = wall.frame.all_to_wall();
        let centre = self.centre_after(time_s);
        let from_centre_m = wall.model.shape.distance_m(to_wall(centre.into()));
        let sure_m = from_centre_m - self.reach_m;
        if sure_m > self.reach_m || !from_centre_m.is_finite() {
            return sure_m;
        }
        let turned = UnitQuaternion::from_scaled_axis(time_s * self.spin_rad_s);
        let gaps = self.spheres.iter().map(|(arm, radius_m)| {
            let place = centre + turned * arm;
            wall.model.shape.distance_m(to_wall(place.into())) - radius_m
        });
        gaps.fold(f64::INFINITY, f64::min)
    }

    /// Time in which no point of it moves farther than this, s, starting at `from_s`. Infinite: it
    /// does not move.
    fn time_for(&self, way_m: f64, from_s: f64) -> f64 {
        let speed = self.velocity_after(from_s).norm() + self.spin_rad_s.norm() * self.reach_m;
        let gravity = self.gravity_m_s2.norm();
        time_over(way_m, speed, gravity)
    }

    /// Whether it moves away from a wall for ever from a moment on.
    fn leaves(&self, wall: &Wall, from_s: f64) -> bool {
        let velocity = self.velocity_after(from_s);
        let centre = self.centre_after(from_s);
        if wall.model.shape.plane().is_some() {
            let mut found = Vec::new();
            let to_wall = wall.frame.all_to_wall();
            wall.model
                .shape
                .touches(to_wall(centre.into()), f64::INFINITY, &mut found);
            return found.iter().all(|touch| {
                let into_wall = Vector3::from(wall.frame.touch_to_space(touch).normal);
                let turns = self.spin_rad_s.norm() * self.reach_m > 0.0;
                let beyond_reach = !turns || touch.distance_m > self.reach_m;
                beyond_reach
                    && velocity.dot(&into_wall) <= 0.0
                    && self.gravity_m_s2.dot(&into_wall) <= 0.0
            });
        }
        let bounds = wall.bounds_in_space();
        (0..3).any(|k| {
            let is_above = centre[k] - self.reach_m > bounds.high[k]
                && velocity[k] >= 0.0
                && self.gravity_m_s2[k] >= 0.0;
            let is_below = centre[k] + self.reach_m < bounds.low[k]
                && velocity[k] <= 0.0
                && self.gravity_m_s2[k] <= 0.0;
            is_above || is_below
        })
    }

    /// Time at which the bounding spheres of this body and another first touch, s. None: never.
    fn comes_near_after(&self, other: &Self) -> Option<f64> {
        let apart = other.centre_m - self.centre_m;
        let velocity = other.velocity_m_s - self.velocity_m_s;
        let gravity = other.gravity_m_s2 - self.gravity_m_s2;
        let reach_m = self.reach_m + other.reach_m;
        let c = apart.norm_squared() - reach_m * reach_m;
        if c <= 0.0 {
            return Some(0.0);
        }
        if gravity != Vector3::zeros() {
            return approach_after([apart, velocity, gravity], reach_m);
        }
        let (a, b) = (velocity.norm_squared(), apart.dot(&velocity));
        let root = b * b - a * c;
        (b < 0.0 && root >= 0.0).then(|| (-b - root.sqrt()) / a)
    }
}

/// Time in which a speed, m/s, that grows by an acceleration, m/s2, covers a way, m, in s.
pub(super) fn time_over(way_m: f64, speed: f64, acceleration: f64) -> f64 {
    2.0 * way_m / (speed + (speed * speed + 2.0 * acceleration * way_m).sqrt())
}

/// Time at which two points on a parabola relative to each other, from this distance, m, at this
/// velocity, m/s, and acceleration, m/s2, first come as near as `reach_m`, s. None: never.
fn approach_after([apart, velocity, gravity]: [Vector3<f64>; 3], reach_m: f64) -> Option<f64> {
    let mut after_s = 0.0;
    for _ in 0..MOVES {
        let now = apart + after_s * (velocity + 0.5 * after_s * gravity);
        let speed = velocity + after_s * gravity;
        let gap_m = now.norm() - reach_m;
        if gap_m <= CLOSED * reach_m {
            return Some(after_s);
        }
        let recedes = [now.dot(&speed), now.dot(&gravity), speed.dot(&gravity)];
        if recedes.iter().all(|part| *part >= 0.0) {
            return None;
        }
        after_s += time_over(gap_m, speed.norm(), gravity.norm());
    }
    Some(after_s)
}
