//! Hits of rigid clumps that would have broken their bonds: see [`Hits`].
//!
//! [`Hits`]: dem_physics::clump_stress::Hits

use std::collections::BTreeMap;

use dem_io::units::significant;
use dem_scene::{Replacement, Scene};
use serde::{Deserialize, Serialize};

use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bonds::Bonds;
use dem_engine::state::clumps::{Clumps, sphere_volume_m3};
use dem_engine::state::rigid_parts::RigidParts;

/// Number of bodies that warnings name.
const NAMED: usize = 3;

/// The hits of all clumps of a body.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct OfBody {
    count: u64,
    /// The largest mean stress, Pa, and the strength of the bonds, Pa.
    stress_pa: f64,
    strength_pa: f64,
    /// The end of the hit with this stress, s, and the place of the clump then, m. Length 3.
    time_s: f64,
    place_m: [f64; 3],
}

/// Hits of one clump or rigid part.
struct Hit {
    count: u32,
    /// The largest mean stress times volume, and that at which its bonds break, N m.
    moments_n_m: [f64; 2],
    volume_m3: f64,
    /// m. Length 3.
    place_m: [f64; 3],
}

impl OfBody {
    fn note(&mut self, hit: &Hit, time_s: f64) {
        self.count += u64::from(hit.count);
        let [stress_pa, strength_pa] = hit.moments_n_m.map(|n_m| n_m / hit.volume_m3);
        if stress_pa > self.stress_pa {
            *self = Self {
                count: self.count,
                stress_pa,
                strength_pa,
                time_s,
                place_m: hit.place_m,
            };
        }
    }
}

/// Hits of rigid clumps whose mean stress reached the strength of their bonds.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct RigidHits {
    of_body: BTreeMap<String, OfBody>,
}

impl RigidHits {
    /// Takes the hits that are over, or `at_end` of a run all hits, of clumps at this time, s.
    pub(super) fn take(&mut self, clumps: &mut Clumps, time_s: f64, at_end: bool) {
        let Clumps { templates, all, .. } = clumps;
        for clump in all {
            let (count, largest_n_m) = clump.hits.take(at_end);
            if count == 0 {
                continue;
            }
            let template = &templates[clump.template as usize];
            let hit = Hit {
                count,
                moments_n_m: [largest_n_m, template.breaks_from_n_m],
                volume_m3: sphere_volume_m3(&template.spheres),
                place_m: clump.place_m,
            };
            let own = self.of_body.entry(template.body.clone()).or_default();
            own.note(&hit, time_s);
        }
    }

    /// As [`Self::take`], for the rigid parts of bonded bodies.
    pub(super) fn take_of_parts(
        &mut self,
        parts: &mut RigidParts,
        bonds: &Bonds,
        bodies: &[PlacedBody],
        (time_s, at_end): (f64, bool),
    ) {
        for part in &mut parts.all {
            let (count, largest_n_m) = part.hits.take(at_end);
            let first = part.members.first().copied().filter(|_| count > 0);
            let body = first.and_then(|i| bodies.iter().find(|b| b.particles.contains(&i)));
            let Some(body) = body else {
                continue;
            };
            let hit = Hit {
                count,
                moments_n_m: [largest_n_m, part.breaks_from_n_m(bonds)],
                volume_m3: sphere_volume_m3(&part.spheres),
                place_m: part.place_m,
            };
            let own = self.of_body.entry(body.name.clone()).or_default();
            own.note(&hit, time_s);
        }
    }

    /// A sentence for each body with such hits.
    pub(super) fn warnings(&self, scene: &Scene) -> Vec<String> {
        // Where daughters replace a body, energies decide on it and not its bonds.
        let by_energy = |name: &String| {
            let rule = scene.replacement.get(name);
            rule.is_some_and(Replacement::breaks_whole)
        };
        let of_bonds = self.of_body.iter().filter(|(name, _)| !by_energy(name));
        let mut warnings: Vec<String> = of_bonds
            .clone()
            .take(NAMED)
            .map(|(name, own)| sentence(name, own, scene))
            .collect();
        let others = of_bonds.count().saturating_sub(NAMED);
        if others > 0 {
            warnings.push(format!(
                "rigid clumps of {others} other bodies took hits that would have broken their bonds"
            ));
        }
        warnings
    }
}

fn sentence(name: &str, own: &OfBody, scene: &Scene) -> String {
    let hits = match own.count {
        1 => "1 hit".to_owned(),
        many => format!("{many} hits"),
    };
    let [x, y, z] = own.place_m.map(|x| significant(x, 3));
    let is_in_part = (scene.bodies.get(name)).is_some_and(|body| body.bonded_within.is_some());
    let remedy = if is_in_part {
        format!("enlarge the region of bodies.{name}.bonded_within, so that what is hit is bonded")
    } else if scene.replacement.contains_key(name) {
        format!(
            "let the trigger of [replacement.{name}] fire before it, such as when it enters a larger region, or at a contact force or stress"
        )
    } else {
        format!("add [replacement.{name}], or start_as = \"bonded\" to [bodies.{name}]")
    };
    format!(
        "'{name}' took {hits} as a rigid body or part, at which its bonds would break: the hardest with a stress (mean by Love and Weber, or of bending) of {} Pa, {} times their strength of {} Pa, at ({x}, {y}, {z}) m, {} s; {remedy}",
        significant(own.stress_pa, 3),
        significant(own.stress_pa / own.strength_pa, 3),
        significant(own.strength_pa, 3),
        significant(own.time_s, 4),
    )
}
