//! Bodies that meet in a scene without contacts, and pass through each other.

use std::collections::BTreeSet;

use dem_io::units::significant;
use nalgebra::{UnitQuaternion, Vector3};

use super::flight::{FreeBody, time_over};
use crate::state::State;
use crate::state::bodies::PlacedBody;
use crate::state::clumps::Clump;
use crate::state::events::REMOVED;

/// Largest number of bodies whose meetings are looked for.
const MOST_BODIES: usize = 100;
/// Largest number of pairs of spheres of two bodies that are looked at.
const MOST_PAIRS: usize = 4_000_000;
/// Largest number of moves of a pair towards each other.
const MOVES: usize = 1000;
/// A gap below this fraction of the extent of the bodies is closed.
const CLOSED: f64 = 1e-6;

/// The first two bodies that meet before `end_s`, although no contact is defined, as a sentence.
/// Loaded bodies and those that supports move are left out: their motion is not known.
pub fn passes_through(state: &State, bodies: &[PlacedBody], end_s: f64) -> Option<String> {
    let of_bodies = bodies.iter().filter_map(|body| mover(state, body));
    let of_clumps = state
        .clumps
        .all
        .iter()
        .map(|clump| mover_of_clump(state, clump));
    let movers: Vec<FreeBody> = of_bodies.chain(of_clumps).take(MOST_BODIES).collect();
    let mut first: Option<(f64, &str, &str)> = None;
    for (n, one) in movers.iter().enumerate() {
        for other in &movers[n + 1..] {
            let until_s = first.map_or(end_s, |(at_s, ..)| at_s);
            if let Some(at_s) = meeting_s(one, other, until_s) {
                first = Some((at_s, &one.name, &other.name));
            }
        }
    }
    first.map(|(at_s, one, other)| {
        format!(
            "'{one}' and '{other}' meet at {} s and pass through each other: [contacts] is empty, so nothing can touch; say there how their materials meet",
            significant(at_s, 4)
        )
    })
}

/// None: its motion is not known.
fn mover(state: &State, body: &PlacedBody) -> Option<FreeBody> {
    let own: BTreeSet<u32> = body
        .particles
        .iter()
        .copied()
        .filter(|i| *i != REMOVED)
        .collect();
    let loads = state.loads.iter().flat_map(|load| &load.particles);
    let is_loaded = loads.into_iter().any(|i| own.contains(i));
    let holds = |at: &&crate::state::supports::GroupSupport| {
        at.held.iter().any(|held| own.contains(&held.particle))
    };
    let is_held = state.supports.iter().any(|support| holds(&support));
    let moving = state.supports.iter().filter(holds).any(|support| {
        let mut holds = support.holds.iter().flatten();
        holds.any(|hold| !matches!(hold, dem_scene::Hold::Fixed))
    });
    if is_loaded || moving || own.is_empty() {
        return None;
    }
    let own: Vec<u32> = own.into_iter().collect();
    let mut mover = FreeBody::of_particles(state, &body.name, &own);
    if is_held {
        let none = Vector3::zeros();
        mover.velocity_m_s = none;
        mover.spin_rad_s = none;
        mover.gravity_m_s2 = none;
    }
    Some(mover)
}

fn mover_of_clump(state: &State, clump: &Clump) -> FreeBody {
    let template = state.clumps.template(clump);
    let mut mover = FreeBody::of_spheres(state, clump, 0..template.spheres.len());
    mover.reach_m = template.largest_reach_m();
    mover
}

/// Time at which two bodies that are apart at first meet, s. None: not before `until_s`.
fn meeting_s(one: &FreeBody, other: &FreeBody, until_s: f64) -> Option<f64> {
    let closed_m = CLOSED * one.reach_m.min(other.reach_m);
    if one.spheres.len() * other.spheres.len() > MOST_PAIRS {
        return None;
    }
    // Copies in the same place are meant to be independent of each other.
    if gap_m(one, other, 0.0) < -closed_m {
        return None;
    }
    let apart = other.gravity_m_s2 - one.gravity_m_s2;
    let mut at_s = 0.0;
    for _ in 0..MOVES {
        let gap = gap_m(one, other, at_s);
        if gap < -closed_m {
            return Some(at_s);
        }
        let velocity = other.velocity_m_s - one.velocity_m_s + at_s * apart;
        let turning_m_s =
            one.spin_rad_s.norm() * one.reach_m + other.spin_rad_s.norm() * other.reach_m;
        let (speed, pull) = (velocity.norm() + turning_m_s, apart.norm());
        // They meet only once the gap is closed, so they may go a little farther.
        let way_m = gap.max(0.0) + 2.0 * closed_m;
        at_s += time_over(way_m, speed, pull);
        // At no speed it is NaN.
        let is_in_time = at_s <= until_s;
        if !is_in_time {
            return None;
        }
    }
    None
}

/// Gap between the surfaces of two bodies after a time, s, in m, or a lower bound of it.
fn gap_m(one: &FreeBody, other: &FreeBody, time_s: f64) -> f64 {
    let [centre_a, centre_b] = [one, other].map(|of| of.centre_after(time_s));
    let sure_m = (centre_b - centre_a).norm() - one.reach_m - other.reach_m;
    if sure_m > 0.0 {
        return sure_m;
    }
    let placed = |of: &FreeBody, centre: Vector3<f64>| -> Vec<(Vector3<f64>, f64)> {
        let turned = UnitQuaternion::from_scaled_axis(time_s * of.spin_rad_s);
        let own = of.spheres.iter();
        own.map(|(arm, radius_m)| (centre + turned * arm, *radius_m))
            .collect()
    };
    let of_other = placed(other, centre_b);
    // Only spheres within reach of the other body can be the nearest.
    let near = |(place, radius_m): &(Vector3<f64>, f64)| {
        (place - centre_b).norm() - radius_m <= other.reach_m + other.reach_m
    };
    let mut least_m = f64::INFINITY;
    for (place, radius_m) in placed(one, centre_a).iter().filter(|sphere| near(sphere)) {
        for (other_place, other_m) in &of_other {
            least_m = least_m.min((other_place - place).norm() - radius_m - other_m);
        }
    }
    // Those left out are farther away than the reach of the other body.
    least_m.min(other.reach_m)
}
