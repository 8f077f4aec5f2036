//! Energy that particles take in from their contacts, which decides whether daughters replace them.
//!
//! The power of a contact is its normal force, damping included, times the speed at which both
//! sides approach. Each takes the share of its compliance (1 - nu^2)/E: the share of the overlap
//! that is its own in Hertz's contact (Johnson 1985, section 4.2), so of the elastic energy as
//! well. Equal materials take half each; next to a rigid wall a particle takes all.
//!
//! An impact begins when something touches the particle and ends when nothing touches it. Its
//! energy is the largest value that the sum of the work had since it began: for a single normal
//! impact, the kinetic energy of the relative motion, times the share.

use nalgebra::Vector3;

use crate::stages::clumps::motion::kick_one;
use crate::stages::contacts::forces::pair_force_n;
use crate::stages::stage::{Need, Stage};
use crate::stages::walls::{surface_velocity_m_s, touch_force_n};
use crate::state::State;
use crate::state::clumps::{Clump, Intake, Template};
use crate::state::contacts::Contacts;
use crate::state::rules::DaughterRule;
use dem_io::random::hash;
use dem_physics::bond::scatter::body_key;
use dem_physics::breakage::{BreakageLaw, damage};

/// Particles that daughters replace.
pub(crate) const DAUGHTERS: Stage = Stage::new("daughters", |state, _| {
    Need::of(
        state.model.rules.make_daughters(),
        || "particles are replaced once they have taken in enough energy".to_owned(),
        "no particle is replaced by daughters",
    )
});

/// Adds the work of the contacts over the coming kick to what the clumps have taken in. Returns
/// the number of clumps that something touches.
pub(crate) fn take_in_energy(state: &mut State) -> usize {
    if !state.model.rules.make_daughters() {
        return 0;
    }
    let mut powers_w = std::mem::take(&mut state.scratch.powers_w);
    find_powers_w(state, &mut powers_w);
    damage_by_ended_impacts(state, &powers_w);
    let kick_s = state.kick_s();
    let mut touched = 0;
    for (clump, &power_w) in state.clumps.all.iter_mut().zip(&powers_w) {
        if clump.asleep {
            continue;
        }
        touched += usize::from(power_w.is_some());
        clump
            .intake
            .advance(power_w.map(|power_w| power_w * kick_s));
    }
    state.scratch.powers_w = powers_w;
    touched
}

/// Damages the clumps that nothing touches any more, and whose impact has not broken them: see
/// [`damage`].
fn damage_by_ended_impacts(state: &mut State, powers_w: &[Option<f64>]) {
    let rules = &state.model.rules;
    let by_law = |rule: &Option<DaughterRule>| rule.as_ref().and_then(|rule| rule.by_law);
    if !(rules.daughters.iter())
        .any(|rule| by_law(rule).is_some_and(|by| by.damage_exponent.is_some()))
    {
        return;
    }
    for (n, power_w) in powers_w.iter().enumerate() {
        let clump = &state.clumps.all[n];
        if power_w.is_some() || clump.asleep || clump.intake.impact_j <= 0.0 {
            continue;
        }
        let template = state.clumps.template(clump);
        let base = state.base_of(clump.template) as usize;
        let by_law = state.model.rules.daughters.get(base).and_then(by_law);
        let Some((by_law, exponent)) = by_law.and_then(|by| Some((by, by.damage_exponent?))) else {
            continue;
        };
        let left_j_kg = fracture_energy_j_kg(clump, template, &by_law.law, state.model.rules.seed);
        if left_j_kg > 0.0 {
            let ratio = clump.intake.impact_j / (template.mass_kg * left_j_kg);
            let intake = &mut state.clumps.all[n].intake;
            intake.damage += (1.0 - intake.damage) * damage(ratio.min(1.0), exponent);
        }
    }
}

/// Fracture energy over mass of a particle, less what earlier impacts have taken, J/kg.
pub(super) fn fracture_energy_j_kg(
    clump: &Clump,
    template: &Template,
    law: &BreakageLaw,
    seed: u64,
) -> f64 {
    let particle = hash(body_key(&template.body, 0), [u64::from(clump.first_id)]);
    let whole_j_kg = law.own_energy_j_kg(seed, particle, template.size_m());
    (1.0 - clump.intake.damage) * whole_j_kg
}

impl Intake {
    /// Adds work, J. None: nothing touches the particle any more.
    fn advance(&mut self, work_j: Option<f64>) {
        match work_j {
            Some(work_j) => {
                self.now_j += work_j;
                self.impact_j = self.impact_j.max(self.now_j);
            }
            None => {
                *self = Self {
                    before_j: self.before_j + self.impact_j,
                    damage: self.damage,
                    ..Self::default()
                }
            }
        }
    }

    /// Whether the contacts still press the particle harder than before in this impact.
    pub(super) fn grows(&self) -> bool {
        self.now_j >= self.impact_j && self.impact_j > 0.0
    }
}

/// Sets the power that each clump takes in at the time of the positions, W. None: nothing touches
/// it.
fn find_powers_w(state: &State, powers_w: &mut Vec<Option<f64>>) {
    powers_w.clear();
    powers_w.resize(state.clumps.all.len(), None);
    if let Some(contacts) = &state.contacts {
        of_pairs(state, contacts, powers_w);
        of_walls(state, contacts, powers_w);
    }
}

fn of_pairs(state: &State, contacts: &Contacts, powers_w: &mut [Option<f64>]) {
    let p = &state.particles;
    let compliances = &state.model.rules.compliances;
    let free = p.free as u32;
    let pairs = contacts.pairs.iter().zip(&contacts.histories);
    let touching = pairs.filter(|([_, b], history)| *b >= free && history.overlap_m() > 0.0);
    for (&pair, history) in touching {
        let force_n = pair_force_n(contacts, p, pair, history);
        let [a, b] = pair.map(|i| i as usize);
        let normal = (p.poses[b].place() - p.poses[a].place()).normalize();
        let approach_m_s = (velocity_m_s(state, a) - velocity_m_s(state, b)).dot(&normal);
        let power_w = force_n.dot(&normal) * approach_m_s;
        let [of_a, of_b] = [a, b].map(|i| compliances[usize::from(contacts.materials[i])]);
        for (i, share) in [(a, share(of_a, of_b)), (b, share(of_b, of_a))] {
            if let Some(clump) = state.clumps.carrier_of(i) {
                *powers_w[clump].get_or_insert(0.0) += share * power_w;
            }
        }
    }
}

fn of_walls(state: &State, contacts: &Contacts, powers_w: &mut [Option<f64>]) {
    let p = &state.particles;
    let rules = &state.model.rules;
    for (wall, &of_wall) in state.walls.iter().zip(&rules.wall_compliances) {
        let touching = wall.touching.iter();
        for touch in touching.filter(|touch| touch.history.overlap_m() > 0.0) {
            let i = touch.particle as usize;
            let Some(clump) = state.clumps.carrier_of(i) else {
                continue;
            };
            let force_n = touch_force_n(wall, contacts, p, touch);
            let normal = Vector3::from(touch.normal);
            let of_wall_m_s = surface_velocity_m_s(wall, p, touch, 0);
            let approach_m_s = (of_wall_m_s - velocity_m_s(state, i)).dot(&normal);
            let own = rules.compliances[usize::from(contacts.materials[i])];
            let power_w = share(own, of_wall) * force_n.dot(&normal) * approach_m_s;
            *powers_w[clump].get_or_insert(0.0) += power_w;
        }
    }
}

/// The share of the energy of a contact that a side with compliance `own` takes, next to one with
/// compliance `other`, 1/Pa: see [`crate::state::rules::Rules::compliances`].
fn share(own: f64, other: f64) -> f64 {
    if own == other {
        0.5
    } else if own.is_infinite() {
        1.0
    } else {
        own / (own + other)
    }
}

/// Velocity of a particle's centre at the time of the positions, before the kick, m/s. Loads,
/// supports and damping of bonds are not in it.
fn velocity_m_s(state: &State, i: usize) -> Vector3<f64> {
    let half_s = 0.5 * state.previous_time_step_s;
    let gravity = state.model.gravity_m_s2;
    let p = &state.particles;
    match state.clumps.carrier_of(i) {
        Some(clump) => {
            let mut now = state.clumps.all[clump];
            let template = state.clumps.template(&now);
            kick_one(&mut now, template, gravity, half_s);
            now.motion(template)(&p.poses[i].place())
                .velocity_m_s
                .into()
        }
        None => {
            let [x, y, z, _] = p.wrenches[i].force_n;
            let push = half_s * p.motions[i].inverse_mass * Vector3::new(x, y, z);
            Vector3::from(p.motions[i].velocity_m_s) + push + half_s * Vector3::from(gravity)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn shares_add_up_and_follow_the_compliances() {
        for [own, other] in [
            [1e-9, 3e-9],
            [1e-9, 1e-9],
            [f64::INFINITY, 1e-9],
            [2e-9, 0.0],
        ] {
            assert!((share(own, other) + share(other, own) - 1.0).abs() < 1e-15);
        }
        assert!((share(1e-9, 3e-9) - 0.25).abs() < 1e-15);
        assert_eq!([share(1e-9, 0.0), share(f64::INFINITY, 0.0)], [1.0; 2]);
    }
}
