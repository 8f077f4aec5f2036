//! Steps by body: bodies whose limits allow it take longer steps than others, without any other
//! change.

mod books;
mod breaking;
mod clumps;
mod exchange;
mod meeting;
mod order;
mod peaks;
mod same_bits;
mod walls;

use dem_run::plan::{Plan, plan};
use dem_run::stages::ledger::{balance, opened};
use dem_run::state::State;

use crate::helpers::scene;
use dem_scene::read_bodies;

/// Radius of all spheres of pairs, m.
pub(crate) const RADIUS_M: f64 = 1e-3;
/// Distance of the centres of a pair, m.
pub(crate) const APART_M: f64 = 2e-3;

/// The head of a scene with bodies of a soft material, and of a hard one that is a hundred times as
/// stiff: their limits differ by ten.
pub(crate) fn head(run: &str) -> String {
    format!(
        "version = 1\nrun.steps_by_body = true\n{run}\n\
         materials.soft = {{ density = 2500, young_modulus = 1e6, poisson_ratio = 0.25 }}\n\
         materials.hard = {{ density = 2500, young_modulus = 1e8, poisson_ratio = 0.25 }}\n\
         bonds.soft.young_modulus = 1e6\n\
         bonds.soft.poisson_ratio = 0.25\n\
         bonds.hard.young_modulus = 1e8\n\
         bonds.hard.poisson_ratio = 0.25\n"
    )
}

/// Damping of the bonds of a kind, to follow the head.
pub(crate) fn damped(kind: &str, damping_ratio: f64) -> String {
    format!("bonds.{kind}.damping.damping_ratio = {damping_ratio:e}\n")
}

/// Laws for all contacts.
pub(crate) const CONTACTS: &str = "contacts.soft-soft = { restitution = 0.8, friction = 0.3 }\n\
     contacts.hard-soft = { restitution = 0.8, friction = 0.3 }\n\
     contacts.hard-hard = { restitution = 0.8, friction = 0.3 }\n";

/// A steel plate at the height 0, and the laws of its contacts.
pub(crate) const PLATE: &str = "contacts.hard-steel = { restitution = 0.6, friction = 0.3 }\n\
     contacts.soft-steel = { restitution = 0.6, friction = 0.3 }\n\
     materials.steel = { young_modulus = 2e11 }\n\
     [walls.plate]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"steel\"\n";

/// A pair along x with its first sphere at this place, m, and with this velocity, m/s.
pub(crate) fn pair(name: &str, kind: &str, place_m: [f64; 3], velocity_m_s: [f64; 3]) -> String {
    format!(
        "[bodies.{name}]\nmaterial = \"{kind}\"\nbonds = \"{kind}\"\n\
         particles = [[0, 0, 0, {RADIUS_M:e}], [{APART_M:e}, 0, 0, {RADIUS_M:e}]]\n\
         bond_list = [[0, 1]]\nposition = {place_m:?}\nvelocity = {velocity_m_s:?}\n"
    )
}

pub(crate) fn planned(text: &str) -> Plan {
    let scene = scene(text);
    plan(&scene, read_bodies(&scene).unwrap(), 2, false).unwrap()
}

/// A state in which the ends of a bond part with this speed, m/s, in addition to their motion.
pub(crate) fn parting(state: &mut State, bond: usize, speed_m_s: f64) {
    let [a, b] = state.bonds.ends[bond].map(|end| end as usize);
    state.particles.motions[a].velocity_m_s[0] -= 0.5 * speed_m_s;
    state.particles.motions[b].velocity_m_s[0] += 0.5 * speed_m_s;
    state.ledger = opened(state);
}

/// Elongation of a bond, m.
pub(crate) fn elongation_m(state: &State, bond: usize) -> f64 {
    let [a, b] = state.bonds.ends[bond].map(|end| state.particles.poses[end as usize].place());
    (b - a).norm() - APART_M
}

/// Circular frequency of the two ends of a bond along it, rad/s.
pub(crate) fn frequency_rad_s(state: &State, bond: usize) -> f64 {
    let ends = state.bonds.ends[bond].map(|end| end as usize);
    let inverse_kg: f64 = ends
        .map(|i| state.particles.motions[i].inverse_mass)
        .iter()
        .sum();
    (state.bonds.normal(bond) * inverse_kg).sqrt()
}

/// Magnitudes of the relative errors of energy, momentum and angular momentum.
pub(crate) fn errors(state: &mut State) -> [f64; 3] {
    let books = balance(state);
    [
        books.energy_error.abs(),
        books.momentum_error,
        books.angular_momentum_error,
    ]
}

/// Number of touching pairs. Their particles have one level, and were listed before they touched.
pub(crate) fn touching_at_one_level(state: &State) -> usize {
    let contacts = state.contacts.as_ref().unwrap();
    let all = contacts.pairs.iter().zip(&contacts.histories);
    let mut touched = 0;
    for (pair, history) in all.filter(|(_, history)| history.overlap_m() > 0.0) {
        touched += 1;
        let [one, other] = pair.map(|i| levels(state)[i as usize]);
        assert_eq!(one, other);
        assert_eq!(history.origin_m(), 0.0, "listed too late");
    }
    touched
}

/// Level of the body of each particle.
pub(crate) fn levels(state: &State) -> &[u8] {
    &state.levels.as_ref().unwrap().of_particle
}
