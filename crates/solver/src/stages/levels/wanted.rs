//! Which bodies may take longer steps: as their limits allow, and none that is near another body of
//! shorter steps or a wall that moves.

use nalgebra::Vector3;

use crate::check::limit::safe_step;
use crate::check::linear::{at_impact_of_clump, contact_rates_of_each};
use crate::stages::bonds::bond_strain;
use crate::stages::clumps::speed_m_s;
use crate::stages::contacts::overlap_m;
use crate::stages::walls::{fastest_point_m_s, planned, reaches};
use crate::state::State;
use crate::state::clumps::Clump;
use crate::state::levels::{CYCLE, HIGHEST, LevelRule, Levels, length};
use crate::state::walls::Wall;
use dem_io::disjoint::{find, join};
use dem_scene::WallMotion;

/// A body gets a longer step only if that is below its limit by this factor: a step that changes
/// all the time conserves energy less well.
const ROOM: f64 = 1.05;
/// Two particles are near each other if they could touch after so many cycles at their present
/// relative speed. Less than two, so that no pair is near that is not listed.
const AHEAD: f64 = 1.5;
/// They are also near if the gap between them is below this fraction of the sum of their radii.
const NEAR: f64 = 1e-3;
/// Largest fraction of the smallest radius of a body that its particles may move in a step.
const FARTHEST: f64 = 0.5;

/// Whether two particles of different levels are near each other, or one that takes longer steps is
/// near a moving wall.
pub(super) fn have_met(state: &State, levels: &Levels) -> bool {
    let takes_longer = |i: u32| levels.of_particle[i as usize] > 0;
    if near_moving_walls(state).any(takes_longer) {
        return true;
    }
    let pairs = state.contacts.iter().flat_map(|contacts| &contacts.pairs);
    let mut pairs = pairs.filter(|pair| {
        let [a, b] = pair.map(|i| levels.of_particle[i as usize]);
        a != b
    });
    pairs.any(|&pair| is_near(state, pair))
}

/// Whether two particles may touch in the coming cycle. It depends on places and motions only, not
/// on when neighbours were searched for.
fn is_near(state: &State, pair: [u32; 2]) -> bool {
    let p = &state.particles;
    let ends = pair.map(|i| i as usize);
    let [a, b] = ends.map(|i| velocity_m_s(state, i));
    let radii = ends.map(|i| p.poses[i].radius_m());
    -overlap_m(&p.poses, pair) < reach_m(state, (b - a).norm(), radii[0] + radii[1])
}

/// Gap, m, below which two things are near that move at this speed, m/s, and whose radii have this
/// sum, m.
fn reach_m(state: &State, speed_m_s: f64, radii_m: f64) -> f64 {
    AHEAD * state.cycle_s() * speed_m_s + NEAR * radii_m
}

/// The particles near walls that move in the coming cycle.
fn near_moving_walls(state: &State) -> impl Iterator<Item = u32> {
    let is_driven = |wall: &&Wall| wall.model.motion != WallMotion::Fixed;
    state.walls.iter().filter(is_driven).flat_map(move |wall| {
        let [wall_m_s, spin_rad_s] = fastest_ahead(wall, state);
        let pivot = Vector3::from(wall.frame.position_m);
        let is_reached = reaches(wall);
        let is_near = move |&i: &u32| {
            let pose = &state.particles.poses[i as usize];
            let surface_m_s = wall_m_s + spin_rad_s * (pose.place() - pivot).norm();
            let speed_m_s = surface_m_s + velocity_m_s(state, i as usize).norm();
            let radius_m = pose.radius_m();
            let reach_m = radius_m + reach_m(state, speed_m_s, radius_m);
            surface_m_s > 0.0 && is_reached(pose.place().into(), reach_m)
        };
        wall.near.iter().copied().filter(is_near)
    })
}

/// Takes, for each moving wall, the distance that it may go in the coming cycle as the one that it
/// went in the last, if that is less: what is near it is listed before.
pub(crate) fn foresee_walls(state: &mut State) {
    if state.levels.is_none() {
        return;
    }
    for n in 0..state.walls.len() {
        let wall = &state.walls[n];
        if wall.model.motion == WallMotion::Fixed {
            continue;
        }
        let ahead = fastest_ahead(wall, state);
        let ahead_m = state.cycle_s() * fastest_point_m_s(wall, &state.particles, ahead);
        let wall = &mut state.walls[n];
        wall.moved_m = wall.moved_m.max(ahead_m);
    }
}

/// Largest speed of the pivot of a wall, m/s, and its largest spin, rad/s, in the time within which
/// things that could touch are near.
fn fastest_ahead(wall: &Wall, state: &State) -> [f64; 2] {
    let step_s = state.time_step_s;
    let steps = 0..(AHEAD * CYCLE as f64) as u32;
    steps.fold([0.0; 2], |fastest: [f64; 2], n| {
        let at_s = state.time_s + f64::from(n) * step_s;
        let motion = planned(wall, at_s, [step_s; 2]);
        let speeds = motion.map(|of| Vector3::from(of).norm());
        [0, 1].map(|k| fastest[k].max(speeds[k]))
    })
}

/// Velocity of a particle, m/s. That which is stored for a sphere of a clump depends on when it was
/// listed.
fn velocity_m_s(state: &State, i: usize) -> Vector3<f64> {
    let p = &state.particles;
    let motion = match state.clumps.carrier_of(i) {
        Some(at) => {
            let clump = &state.clumps.all[at];
            clump.motion(state.clumps.template(clump))(&p.poses[i].place())
        }
        None => p.motions[i],
    };
    motion.velocity_m_s.into()
}

/// Number of the body or fragment of each particle.
fn ids<'a>(state: &'a State, levels: &'a Levels) -> &'a [u32] {
    let clusters = state.clusters.as_ref();
    clusters.map_or(&levels.whole_of, |clusters| &clusters.of_particle)
}

/// Whether a body, or one that may come or be replaced, can take steps of a level above the lowest
/// while it is near no other.
pub(crate) fn any_longer(state: &State) -> bool {
    let (Some(rule), Some(levels)) = (&state.model.levels, &state.levels) else {
        return false;
    };
    let present = bodies(state, rule, levels).into_iter();
    let present = present.filter(|body| body.particles > 0);
    let mut all = present.chain(bodies_to_come(state, rule));
    all.any(|body| body.highest(HIGHEST, state.time_step_s, rule) > 0)
}

/// What may come through inlets, or replace clumps: of each template a single sphere or a clump,
/// unless it comes bonded, and a cluster, if it can become one.
fn bodies_to_come(state: &State, rule: &LevelRule) -> Vec<Body> {
    if state.model.rules.are_none() {
        return Vec::new();
    }
    let mut found = Vec::new();
    for (n, template) in (0_u32..).zip(&state.clumps.templates) {
        let whole = rule.own_of_template[n as usize];
        let mut add = |particles: usize, impact: [f64; 2]| {
            let mut alone = Body {
                particles,
                whole,
                smallest_m: template.smallest_m(),
                ..Body::NONE
            };
            alone.add_rates(impact, [0.0; 2]);
            found.push(alone);
        };
        let start = state.model.rules.starts.get(n as usize);
        let as_particles = rule.impact_of_particle(template.material);
        if start.is_some_and(|start| start.sphere) {
            add(1, as_particles);
        } else if !start.is_some_and(|start| start.bonded) {
            add(1, rule.impact_rates_of_clumps[n as usize]);
        }
        if rule.own[whole as usize].is_finite() {
            add(template.spheres.len(), as_particles);
        }
    }
    found
}

/// For each particle the level of its body: the highest that the limit of the body allows, and no
/// higher than that of any body that it is near.
pub(super) fn wanted_levels(state: &State, is_new: bool) -> Vec<u8> {
    let (Some(rule), Some(levels)) = (&state.model.levels, &state.levels) else {
        return Vec::new();
    };
    let ids = ids(state, levels);
    let bodies = bodies(state, rule, levels);
    let mut present = vec![0; bodies.len()];
    for (&id, &level) in ids.iter().zip(&levels.of_particle) {
        present[id as usize] = if is_new { HIGHEST } else { level };
    }
    let of_bodies = bodies.iter().zip(present);
    let mut of_body: Vec<u8> = of_bodies
        .map(|(body, present)| body.highest(present, state.time_step_s, rule))
        .collect();
    for i in near_moving_walls(state) {
        of_body[ids[i as usize] as usize] = 0;
    }
    for (cluster, _) in &levels.fired {
        of_body[*cluster as usize] = 0;
    }
    let mut names: Vec<u32> = (0..of_body.len() as u32).collect();
    for &pair in state.contacts.iter().flat_map(|contacts| &contacts.pairs) {
        let [a, b] = pair.map(|i| ids[i as usize]);
        if find(&mut names, a) != find(&mut names, b) && is_near(state, pair) {
            join(&mut names, a, b);
        }
    }
    let mut of_group = vec![HIGHEST; of_body.len()];
    for (id, level) in of_body.iter().enumerate() {
        let group = find(&mut names, id as u32) as usize;
        of_group[group] = of_group[group].min(*level);
    }
    for (id, level) in of_body.iter_mut().enumerate() {
        *level = of_group[find(&mut names, id as u32) as usize];
    }
    ids.iter().map(|&id| of_body[id as usize]).collect()
}

/// What limits the steps of a body or fragment.
#[derive(Debug, Clone, Copy)]
struct Body {
    /// Number of its free particles; 1 for a clump.
    particles: usize,
    /// Number of the whole body that it belongs to: it is no stiffer than that.
    whole: u32,
    /// Largest strain of its bonds.
    strain: f64,
    /// Upper bounds of the largest eigenvalues of its contacts, present and foreseen, 1/s2 and 1/s.
    rates: [f64; 2],
    /// The same of the first impacts alone.
    impact: [f64; 2],
    /// Largest speed of its particles, if they can touch anything.
    fastest_m_s: f64,
    smallest_m: f64,
}

impl Body {
    const NONE: Self = Self {
        particles: 0,
        whole: 0,
        strain: 0.0,
        rates: [0.0; 2],
        impact: [0.0; 2],
        fastest_m_s: 0.0,
        smallest_m: f64::INFINITY,
    };

    /// Takes the rates of a first impact, and of present contacts.
    fn add_rates(&mut self, impact: [f64; 2], present: [f64; 2]) {
        for n in 0..2 {
            self.impact[n] = self.impact[n].max(impact[n]);
            self.rates[n] = self.rates[n].max(impact[n]).max(present[n]);
        }
    }

    /// The highest level whose steps it may take with this time step, s: below its limit with some
    /// room, if that is above the present level.
    fn highest(&self, present: u8, time_step_s: f64, rule: &LevelRule) -> u8 {
        let may = |level: &u8| {
            let room = if *level > present { ROOM } else { 1.0 };
            self.may_take(*level, room * time_step_s, rule)
        };
        (1..=HIGHEST).take_while(may).last().unwrap_or(0)
    }

    /// Whether it may take the steps of a level, of at least 1, with this time step, s.
    fn may_take(&self, level: u8, time_step_s: f64, rule: &LevelRule) -> bool {
        let [safety, share] = rule.safety;
        let step_s = length(level) * time_step_s;
        // Transverse stiffness of a bond grows with the square of its levers.
        let strained = (1.0 + self.strain).powi(2);
        let own = match self.particles {
            1 => 0.0,
            _ => rule.own[self.whole as usize] * strained,
        };
        let [contacts, dashpots] = self.rates;
        let h = step_s / safety;
        let is_stable = 0.25 * h * h * (own + contacts) + 0.5 * h * dashpots <= 1.0;
        let [k, c] = self.impact;
        let is_resolved = step_s <= share * safe_step(k, c);
        is_stable && is_resolved && step_s * self.fastest_m_s <= FARTHEST * self.smallest_m
    }
}

/// Largest eigenvalues that the first impact of a clump adds, 1/s2 and 1/s. The template of a
/// fragment, and of a body that comes bonded and becomes a clump later, is not in the rule.
fn impact_of_clump(state: &State, rule: &LevelRule, clump: &Clump) -> [f64; 2] {
    let n = clump.template as usize;
    let start = state.model.rules.starts.get(n);
    match rule.impact_rates_of_clumps.get(n) {
        Some(rates) if !start.is_some_and(|start| start.bonded) => *rates,
        _ => {
            let [k, c, _] = at_impact_of_clump(state, rule.impact_speed_m_s, clump);
            [k, c]
        }
    }
}

/// The bodies and fragments, by the numbers of their particles.
fn bodies(state: &State, rule: &LevelRule, levels: &Levels) -> Vec<Body> {
    let p = &state.particles;
    let ids = ids(state, levels);
    let count = ids.iter().map(|&id| id as usize + 1).max().unwrap_or(0);
    let mut bodies = vec![Body::NONE; count];
    let materials = state.contacts.as_ref().map(|contacts| &contacts.materials);
    let [of_particles, of_clumps] = contact_rates_of_each(state);
    for (i, &id) in ids.iter().enumerate().take(p.free) {
        let body = &mut bodies[id as usize];
        body.particles += 1;
        body.whole = levels.whole_of[i];
        body.smallest_m = body.smallest_m.min(p.poses[i].radius_m());
        if state.contacts.is_some() {
            let speed_m_s = Vector3::from(p.motions[i].velocity_m_s).norm();
            body.fastest_m_s = body.fastest_m_s.max(speed_m_s);
        }
        let impact = materials.map(|of| rule.impact_of_particle(of[i]));
        body.add_rates(impact.unwrap_or_default(), of_particles[i]);
    }
    for (clump, rates) in state.clumps.all.iter().zip(of_clumps) {
        let body = &mut bodies[ids[clump.first as usize] as usize];
        let template = state.clumps.template(clump);
        body.particles = 1;
        body.smallest_m = template.smallest_m();
        if state.contacts.is_some() {
            body.fastest_m_s = speed_m_s(clump, template);
        }
        body.add_rates(impact_of_clump(state, rule, clump), rates);
    }
    for at in (0..state.bonds.len()).filter(|&at| !state.bonds.is_broken(at)) {
        let body = &mut bodies[ids[state.bonds.ends[at][0] as usize] as usize];
        body.strain = body.strain.max(bond_strain(&state.bonds, &p.poses, at));
    }
    bodies
}
