//! Particle groups: the particles of each name in a scene.

use std::collections::BTreeMap;

use dem_io::{Diagnostic, Result};
use dem_scene::{BoxShape, Pick, Scene, SphereShape};

use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::particles::Particles;
use dem_engine::state::supports::GroupSupport;

/// Particles (numbers in the state, ascending) of every set, every body and `all`. Refuses a set
/// without particles, or with a number that the body does not have.
pub(crate) fn resolve_groups(
    scene: &Scene,
    bodies: &[PlacedBody],
    particles: &Particles,
) -> Result<BTreeMap<String, Vec<u32>>> {
    let mut groups = BTreeMap::new();
    groups.insert("all".to_owned(), (0..particles.len() as u32).collect());
    for body in bodies {
        let mut numbers = body.particles.clone();
        numbers.sort_unstable();
        groups.insert(body.name.clone(), numbers);
    }
    for (name, set) in &scene.groups {
        let place = format!("{}: [groups.{name}]", scene.source);
        let mut picked = if let Pick::Particles(numbers) = &set.pick {
            by_number(&place, numbers, set.body.as_deref(), bodies)?
        } else {
            let of = set.body.as_deref().unwrap_or("all");
            let candidates = groups.get(of).map_or(&[][..], Vec::as_slice);
            candidates
                .iter()
                .copied()
                .filter(|&i| is_in(&set.pick, &particles.poses[i as usize].place().into()))
                .collect()
        };
        if picked.is_empty() {
            return Err(Diagnostic::input(
                place,
                "no particle's centre lies in it",
                format!("the bodies reach from {}", extent(particles)),
            ));
        }
        picked.sort_unstable();
        groups.insert(name.clone(), picked);
    }
    Ok(groups)
}

fn by_number(
    place: &str,
    numbers: &[u32],
    body: Option<&str>,
    bodies: &[PlacedBody],
) -> Result<Vec<u32>> {
    let body = bodies.iter().find(|b| Some(b.name.as_str()) == body);
    let particles = body.map_or(&[][..], |b| b.particles.as_slice());
    numbers
        .iter()
        .map(|&number| {
            particles.get(number as usize).copied().ok_or_else(|| {
                Diagnostic::input(
                    place,
                    format!(
                        "particle {number} does not exist: the body has {} particles",
                        particles.len()
                    ),
                    format!(
                        "use numbers from 0 to {}",
                        particles.len().saturating_sub(1)
                    ),
                )
            })
        })
        .collect()
}

fn is_in(pick: &Pick, place: &[f64; 3]) -> bool {
    match pick {
        Pick::All => true,
        Pick::Particles(_) => false,
        Pick::Box(BoxShape { min_m, max_m }) => {
            (0..3).all(|k| min_m[k] <= place[k] && place[k] <= max_m[k])
        }
        Pick::Sphere(SphereShape { centre_m, radius_m }) => {
            let square: f64 = (0..3).map(|k| (place[k] - centre_m[k]).powi(2)).sum();
            square <= radius_m * radius_m
        }
    }
}

/// Human-readable extent of the centres of all particles.
fn extent(particles: &Particles) -> String {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for pose in &particles.poses {
        for k in 0..3 {
            low[k] = low[k].min(pose.position_m[k]);
            high[k] = high[k].max(pose.position_m[k]);
        }
    }
    let show = |p: [f64; 3]| {
        let [x, y, z] = p.map(dem_io::units::show_length);
        format!("({x}, {y}, {z})")
    };
    format!("{} to {}", show(low), show(high))
}

/// Degrees of freedom that these supports hold.
pub(super) fn held_degrees_of_freedom<'a>(
    supports: impl Iterator<Item = &'a GroupSupport>,
) -> BTreeMap<u32, [bool; 6]> {
    let mut held: BTreeMap<u32, [bool; 6]> = BTreeMap::new();
    for support in supports {
        for one in &support.held {
            let entry = held.entry(one.particle).or_default();
            for (held, hold) in entry.iter_mut().zip(&support.holds) {
                *held |= hold.is_some();
            }
        }
    }
    held
}

/// The particles of a set that must exist in the scene.
pub fn particles_of<'a>(groups: &'a BTreeMap<String, Vec<u32>>, name: &str) -> &'a [u32] {
    groups.get(name).map_or(&[], Vec::as_slice)
}
