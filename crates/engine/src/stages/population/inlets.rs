//! Bodies that enter through inlets.

use nalgebra::{UnitQuaternion, Vector3};

use crate::state::State;
use crate::state::clumps::{Clump, Template};
use crate::state::events::PopulationEvent;
use crate::state::population::{InletProgress, Surroundings};
use crate::state::rules::{Feed, Inlet};
use crate::state::walls::Wall;
use dem_io::random::uniform;
use dem_physics::rotation::numbers;
use dem_physics::rotation::rotation;

/// Positions tried for a body in one step.
const TRIES: u32 = 10;
/// Steps until the next attempt to place a body.
const WAIT: u64 = 50;

/// Bodies that enter through inlets in this step; records their mass, momenta and energy.
pub(super) fn coming(state: &mut State) -> Vec<Clump> {
    let mut coming: Vec<Clump> = Vec::new();
    let (steps, time_s) = (state.steps, state.time_s);
    let asks =
        |inlet: &Inlet, come: &InletProgress| steps >= come.next_try && is_due(inlet, come, time_s);
    let moved_m = state.fastest_m_s * state.previous_time_step_s;
    for near in &mut state.scratch.surroundings {
        near.left_m -= moved_m;
    }
    let mut both = state
        .model
        .rules
        .inlets
        .iter()
        .zip(&state.population.inlets);
    if !both.any(|(inlet, come)| asks(inlet, come)) {
        return coming;
    }
    let inlets = std::mem::take(&mut state.model.rules.inlets);
    let mut surroundings = std::mem::take(&mut state.scratch.surroundings);
    surroundings.resize_with(inlets.len(), Surroundings::default);
    let mut next_cluster = state
        .clusters
        .as_ref()
        .map_or(0, |c| c.history.len() as u32);
    for (n, inlet) in inlets.iter().enumerate() {
        let mut come = state.population.inlets[n];
        if !asks(inlet, &come) {
            continue;
        }
        let near = &mut surroundings[n];
        if near.left_m <= 0.0 {
            *near = around(inlet, state);
        }
        while asks(inlet, &come) {
            let Some(clump) = next_body(n, inlet, &mut come, state, near, &coming) else {
                if come.tries <= TRIES {
                    come.delayed += 1;
                }
                come.next_try = steps + WAIT;
                break;
            };
            let template = state.clumps.template(&clump);
            let now = Clump {
                velocity_m_s: inlet.velocity_m_s,
                ..clump
            };
            state.ledger.bring(
                1.0,
                [template.mass_kg, now.kinetic_j(template)],
                [clump.place_m, clump.velocity_m_s, clump.angular_momentum],
                state.model.gravity_m_s2,
            );
            come.bodies += 1;
            come.mass_kg += template.mass_kg;
            come.tries = 0;
            state.population.instances += 1;
            state.scratch.events.population.push(PopulationEvent::Came {
                cluster: next_cluster,
                body: template.body.clone(),
                inlet: inlet.name.clone(),
                place_m: clump.place_m,
            });
            next_cluster += 1;
            coming.push(clump);
        }
        state.population.inlets[n] = come;
    }
    state.model.rules.inlets = inlets;
    state.scratch.surroundings = surroundings;
    coming
}

/// Change of velocity by gravity from the time of the positions to half a step later, m/s.
fn half_kick(state: &State) -> Vector3<f64> {
    Vector3::from(state.model.gravity_m_s2) * (0.5 * state.time_step_s)
}

/// Whether an inlet is due to feed a body.
fn is_due(inlet: &Inlet, come: &InletProgress, time_s: f64) -> bool {
    let [start_s, end_s] = inlet.between_s;
    if come.bodies >= inlet.count || time_s < start_s || time_s >= end_s {
        return false;
    }
    let since_s = time_s - start_s;
    match inlet.feed {
        Feed::Number(per_s) => since_s * per_s >= f64::from(come.bodies),
        Feed::Mass(kg_s) => since_s * kg_s >= come.mass_kg,
    }
}

/// The next body of an inlet, if there is room for it: a random position in the region at which its
/// bounding sphere touches no sphere of another body, and none of its spheres touches a wall.
fn next_body(
    n: usize,
    inlet: &Inlet,
    come: &mut InletProgress,
    state: &State,
    surroundings: &Surroundings,
    coming: &[Clump],
) -> Option<Clump> {
    let seed = state.model.rules.seed;
    let number = u64::from(come.bodies);
    let random = |of: u64, attempt: u32| uniform(seed, &[n as u64, number, of, u64::from(attempt)]);
    let which = {
        let fraction = random(0, 0);
        let mut sum = 0.0;
        let chosen = inlet.templates.iter().find(|(_, part)| {
            sum += part;
            fraction < sum
        });
        chosen.or(inlet.templates.last())?.0
    };
    let template = &state.clumps.templates[which as usize];
    let region = &state.model.rules.regions[inlet.region];
    let reach_m = template.largest_reach_m();
    for _ in 0..TRIES {
        come.tries += 1;
        let attempt = come.tries;
        let Some(place_m) = region.point([1, 2, 3].map(|of| random(of, attempt))) else {
            continue;
        };
        if is_taken(place_m, reach_m, state, surroundings, coming) {
            continue;
        }
        let as_file = if inlet.random_orientation {
            any_rotation([4, 5, 6].map(|of| random(of, attempt)))
        } else {
            rotation(state.model.rules.starts[which as usize].turned)
        };
        let turned = numbers(&(as_file * rotation(template.axes)));
        let velocity = Vector3::from(inlet.velocity_m_s) + half_kick(state);
        let clump = Clump {
            template: which,
            instance: state.population.instances + 1,
            place_m,
            turned,
            velocity_m_s: velocity.into(),
            angular_momentum: angular_momentum(template, turned, inlet.spin_rad_s),
            ..Clump::default()
        };
        if !state
            .walls
            .iter()
            .any(|wall| is_in_wall(&clump, template, wall))
        {
            return Some(clump);
        }
    }
    None
}

/// Whether a sphere of a clump touches a wall, or is inside a closed surface.
fn is_in_wall(clump: &Clump, template: &Template, wall: &Wall) -> bool {
    let reach_m = template.largest_reach_m();
    if !wall.bounds_in_space().is_near(&clump.place_m, reach_m) {
        return false;
    }
    let mut touches = Vec::new();
    template.outer.iter().any(|&sphere| {
        let pose = template.pose(sphere as usize, clump);
        let centre = wall.frame.to_wall(pose.place().into());
        let radius_m = template.scale * pose.radius_m();
        touches.clear();
        wall.model.shape.touches(centre, radius_m, &mut touches);
        let touches_it = touches.iter().any(|touch| touch.distance_m < radius_m);
        touches_it || wall.model.shape.holds(centre)
    })
}

/// Angular momentum of a clump with this orientation and spin, kg m2/s.
pub fn angular_momentum(template: &Template, turned: [f64; 4], spin_rad_s: [f64; 3]) -> [f64; 3] {
    let turned = rotation(turned);
    let spin = turned.inverse() * Vector3::from(spin_rad_s);
    let own = spin.component_mul(&Vector3::from(template.moments_kg_m2));
    (turned * own).into()
}

/// A uniformly distributed random rotation, from three numbers in (0, 1) (Shoemake 1992).
fn any_rotation([u, v, w]: [f64; 3]) -> UnitQuaternion<f64> {
    let turn = std::f64::consts::TAU;
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    let ((sv, cv), (sw, cw)) = ((turn * v).sin_cos(), (turn * w).sin_cos());
    rotation([a * sv, a * cv, b * sw, b * cw])
}

/// What is near the region of an inlet: all that may be in the way of the bodies that it feeds,
/// until something has moved by the reach of the largest of them.
fn around(inlet: &Inlet, state: &State) -> Surroundings {
    let fed = inlet.templates.iter();
    let reaches = fed.map(|(of, _)| state.clumps.templates[*of as usize].largest_reach_m());
    let reach_m = reaches.fold(0.0, f64::max);
    let near_m = 2.0 * reach_m;
    let room = state.model.rules.regions[inlet.region].bounds();
    let free = &state.particles.poses[..state.particles.free];
    let particles = (0..)
        .zip(free)
        .filter(|(_, pose)| room.is_near(&pose.place().into(), near_m + pose.radius_m()));
    let clumps = (0..).zip(&state.clumps.all).filter(|(_, clump)| {
        let own_m = state.clumps.template(clump).largest_reach_m();
        room.is_near(&clump.place_m, near_m + own_m)
    });
    Surroundings {
        particles: particles.map(|(i, _)| i).collect(),
        clumps: clumps.map(|(at, _)| at).collect(),
        left_m: near_m - reach_m,
    }
}

/// Whether a body at this place could touch another.
fn is_taken(
    place_m: [f64; 3],
    reach_m: f64,
    state: &State,
    surroundings: &Surroundings,
    coming: &[Clump],
) -> bool {
    let place = Vector3::from(place_m);
    let near = |other: Vector3<f64>, reach: f64| {
        (other - place).norm_squared() < (reach_m + reach).powi(2)
    };
    let around = |clump: &Clump| {
        let reach = state.clumps.template(clump).largest_reach_m();
        near(clump.place_m.into(), reach)
    };
    // Inner spheres of a clump are not in the scene.
    let in_clump = |clump: &Clump| {
        let template = state.clumps.template(clump);
        let touches = |sphere: usize| {
            let pose = template.pose(sphere, clump);
            near(pose.place(), template.scale * pose.radius_m())
        };
        around(clump) && (0..template.spheres.len()).any(touches)
    };
    let mut particles = surroundings
        .particles
        .iter()
        .map(|&i| &state.particles.poses[i as usize]);
    let mut clumps = surroundings
        .clumps
        .iter()
        .map(|&at| &state.clumps.all[at as usize]);
    particles.any(|pose| near(pose.place(), pose.radius_m()))
        || clumps.any(in_clump)
        || coming.iter().any(around)
}
