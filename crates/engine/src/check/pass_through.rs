//! Bodies that meet in a scene without contacts, and pass through each other.

use std::collections::BTreeSet;

use dem_io::units::significant;
use nalgebra::{UnitQuaternion, Vector3};

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

/// A body that moves as a rigid one.
struct Mover<'a> {
    name: &'a str,
    centre_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    spin_rad_s: Vector3<f64>,
    gravity_m_s2: Vector3<f64>,
    /// Centres relative to the centre of mass, m, and radii, m.
    spheres: Vec<(Vector3<f64>, f64)>,
    reach_m: f64,
}

/// The first two bodies that meet before `end_s`, although no contact is defined, as a sentence.
/// Loaded bodies and those that supports move are left out: their motion is not known.
pub fn passes_through(state: &State, bodies: &[PlacedBody], end_s: f64) -> Option<String> {
    let of_bodies = bodies.iter().filter_map(|body| mover(state, body));
    let of_clumps = state
        .clumps
        .all
        .iter()
        .map(|clump| mover_of_clump(state, clump));
    let movers: Vec<Mover<'_>> = of_bodies.chain(of_clumps).take(MOST_BODIES).collect();
    let mut first: Option<(f64, &str, &str)> = None;
    for (n, one) in movers.iter().enumerate() {
        for other in &movers[n + 1..] {
            let until_s = first.map_or(end_s, |(at_s, ..)| at_s);
            if let Some(at_s) = meeting_s(one, other, until_s) {
                first = Some((at_s, one.name, other.name));
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
fn mover<'a>(state: &State, body: &'a PlacedBody) -> Option<Mover<'a>> {
    let p = &state.particles;
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
    let (mut mass_kg, mut moment, mut momentum) = (0.0, Vector3::zeros(), Vector3::zeros());
    let mut spin = Vector3::zeros();
    for &i in &own {
        let motion = &p.motions[i as usize];
        let own_kg = 1.0 / motion.inverse_mass;
        mass_kg += own_kg;
        moment += own_kg * p.poses[i as usize].place();
        momentum += own_kg * Vector3::from(motion.velocity_m_s);
        spin += own_kg * Vector3::from(motion.spin_rad_s);
    }
    let centre_m = moment / mass_kg;
    let spheres: Vec<(Vector3<f64>, f64)> = own
        .iter()
        .map(|&i| {
            let pose = &p.poses[i as usize];
            (pose.place() - centre_m, pose.radius_m())
        })
        .collect();
    let free = if is_held { 0.0 } else { 1.0 };
    let reach_m = spheres.iter().map(|(arm, radius_m)| arm.norm() + radius_m);
    Some(Mover {
        name: &body.name,
        centre_m,
        velocity_m_s: free * momentum / mass_kg,
        spin_rad_s: free * spin / mass_kg,
        gravity_m_s2: free * Vector3::from(state.model.gravity_m_s2),
        reach_m: reach_m.fold(0.0, f64::max),
        spheres,
    })
}

fn mover_of_clump<'a>(state: &'a State, clump: &Clump) -> Mover<'a> {
    let template = state.clumps.template(clump);
    let centre_m = Vector3::from(clump.place_m);
    let spheres = (0..template.spheres.len()).map(|sphere| {
        let pose = template.pose(sphere, clump);
        (pose.place() - centre_m, template.scale * pose.radius_m())
    });
    Mover {
        name: &template.body,
        centre_m,
        velocity_m_s: clump.velocity_m_s.into(),
        spin_rad_s: clump.spin_rad_s(template),
        gravity_m_s2: state.model.gravity_m_s2.into(),
        spheres: spheres.collect(),
        reach_m: template.largest_reach_m(),
    }
}

/// Time at which two bodies that are apart at first meet, s. None: not before `until_s`.
fn meeting_s(one: &Mover<'_>, other: &Mover<'_>, until_s: f64) -> Option<f64> {
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
        at_s += 2.0 * way_m / (speed + (speed * speed + 2.0 * pull * way_m).sqrt());
        // At no speed it is NaN.
        let is_in_time = at_s <= until_s;
        if !is_in_time {
            return None;
        }
    }
    None
}

/// Gap between the surfaces of two bodies after a time, s, in m, or a lower bound of it.
fn gap_m(one: &Mover<'_>, other: &Mover<'_>, time_s: f64) -> f64 {
    let centre =
        |of: &Mover<'_>| of.centre_m + time_s * (of.velocity_m_s + 0.5 * time_s * of.gravity_m_s2);
    let [centre_a, centre_b] = [centre(one), centre(other)];
    let sure_m = (centre_b - centre_a).norm() - one.reach_m - other.reach_m;
    if sure_m > 0.0 {
        return sure_m;
    }
    let placed = |of: &Mover<'_>, centre: Vector3<f64>| -> Vec<(Vector3<f64>, f64)> {
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
