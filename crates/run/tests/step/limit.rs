//! The largest stable step compared with an independent eigenvalue solver.

use crate::bars::{
    BAR_LIMIT_S, BondDamping, ELASTIC, MODELS, bar, body, damp, damp_particles, random_body,
    scattered, soft,
};
use dem_engine::check::limit::{bound_near, limit};
use dem_engine::state::State;
use dem_engine::state::particles::Particles;
use dem_physics::bond::damping::{DampingCoefficients, resistance};
use dem_physics::bond::stiffness::BondModel;
use dem_physics::number::Vec3;
use nalgebra::Vector3;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Values of one model and body.
#[derive(Deserialize)]
struct Reference {
    step_s: f64,
}

type Body = fn(BondModel, dem_engine::state::bonds::BondRule, f64) -> State;

fn all() -> Vec<(String, BondModel, Body, Reference)> {
    let mut read: BTreeMap<String, BTreeMap<String, Reference>> =
        serde_json::from_str(include_str!("data/critical_step.json")).unwrap();
    let mut all = Vec::new();
    for (name, body) in [("bar", bar as Body), ("random500", random_body as Body)] {
        let mut of_body = read.remove(name).unwrap();
        for (model, key) in MODELS {
            if let Some(reference) = of_body.remove(key) {
                all.push((format!("{name} {key}"), model, body, reference));
            }
        }
        assert!(of_body.is_empty());
    }
    assert_eq!(all.len(), 8);
    all
}

#[test]
fn undamped_limits_are_those_of_the_reference() {
    for (name, model, body, reference) in all() {
        let found = limit(&mut body(model, ELASTIC, 1e-9));
        let ratio = found.step_s / reference.step_s;
        eprintln!("{name}: {ratio:.7} after {} iterations", found.iterations);
        // Never too long, by more than the error of the reference.
        assert!((1.0 - 1e-5..1.0 + 1e-6).contains(&ratio), "{name}: {ratio}");
        assert_eq!(found.step_s, found.undamped_step_s);
    }
}

/// Largest eigenvalue of the damping of bonds over mass, 1/s, by power iteration over the bonds,
/// one by one.
fn damping_1_s(state: &State) -> f64 {
    let (bonds, p) = (&state.bonds, &state.particles);
    let root = |i: usize, k: usize| {
        let motion = &p.motions[i];
        let inverse = if k < 3 {
            motion.inverse_mass
        } else {
            motion.inverse_inertia
        };
        inverse.sqrt()
    };
    let mut next = scattered();
    let mut field: Vec<[f64; 6]> = (0..p.len()).map(|_| [0; 6].map(|_| next())).collect();
    let mut largest = 0.0;
    for _ in 0..4000 {
        let mut image = vec![[0.0; 6]; p.len()];
        for at in 0..bonds.len() {
            let ends = bonds.ends[at].map(|end| end as usize);
            let motions = ends.map(|i| {
                let scaled =
                    |first| Vector3::from_fn(|k, _| root(i, first + k) * field[i][first + k]);
                [scaled(0), scaled(3)].map(Vec3::from)
            });
            let apart = p.poses[ends[1]].place() - p.poses[ends[0]].place();
            let [normal, shear, torsion, bending] = bonds.damping[at];
            let d = DampingCoefficients {
                normal,
                shear,
                torsion,
                bending,
            };
            let levers = bonds.levers_m(at);
            let (force_on_b, torques) = resistance(&d, levers, Vec3::from(apart), motions);
            let force_on_b = Vector3::from(force_on_b);
            let torques = torques.map(Vector3::from);
            for (end, sign) in [(0, 1.0), (1, -1.0)] {
                let i = ends[end];
                for k in 0..3 {
                    image[i][k] += sign * root(i, k) * force_on_b[k];
                    image[i][3 + k] -= root(i, 3 + k) * torques[end][k];
                }
            }
        }
        largest = image
            .as_flattened()
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt();
        image
            .as_flattened_mut()
            .iter_mut()
            .for_each(|x| *x /= largest);
        field = image;
    }
    largest
}

/// Damping of bonds does not change the limit, and is never stronger than what its stages cover,
/// nor much weaker: these grow with the root of it.
#[test]
fn damping_of_bonds_does_not_shorten_the_limit() {
    for (name, model, body, reference) in all() {
        for of_eta in [
            BondDamping::Chen as fn(f64) -> BondDamping,
            BondDamping::ChenByMode,
        ] {
            let mut state = body(model, ELASTIC, 1e-9);
            for eta in [0.05, 0.6, 10.0] {
                damp(&mut state, of_eta(eta));
                let ratio = limit(&mut state).step_s / reference.step_s;
                assert!(
                    (1.0 - 1e-5..1.0 + 1e-6).contains(&ratio),
                    "{name} {eta}: {ratio}"
                );
            }
            damp(&mut state, of_eta(1.0));
            let covered = state.damping_rate_1_s / damping_1_s(&state);
            eprintln!("{name}: covered {covered:.3}");
            assert!((1.0..4.0).contains(&covered), "{name}: {covered}");
        }
    }
}

/// A bound near a stable step is not below it, one near an unstable step is not above the limit: so
/// it distinguishes the two.
#[test]
fn a_bound_tells_whether_a_step_is_stable() {
    for (name, model, body, _) in all() {
        for damping in [0.0, 0.1, 2.0] {
            let mut state = body(model, ELASTIC, 1e-9);
            if damping > 0.0 {
                damp(&mut state, BondDamping::Chen(damping));
                damp_particles(&mut state, 0.2);
            }
            let limit_s = limit(&mut state).step_s;
            for fraction in [0.3, 0.9, 0.99, 1.01, 1.5, 10.0] {
                let bound = bound_near(&mut state, fraction * limit_s);
                let found = bound.step_s / limit_s;
                assert!(!bound.is_damped);
                assert!(
                    found < 1.0 + 1e-3 && (fraction > 1.0 || found > fraction * (1.0 - 1e-5)),
                    "{name}, damping {damping}, {fraction} of the limit: {found}"
                );
            }
        }
    }
}

/// The elastic solid bond is the beam with a shear coefficient of 1.
#[test]
fn the_elastic_solid_bond_has_the_limit_of_the_beam_it_is() {
    for body in [bar as Body, random_body as Body] {
        let [solid, beam] = [
            BondModel::ElasticSolid,
            BondModel::ShearCoefficient { alpha: 1.0 },
        ]
        .map(|model| limit(&mut body(model, ELASTIC, 1e-9)));
        assert!((solid.step_s / beam.step_s - 1.0).abs() < 1e-9);
    }
}

#[test]
fn damping_of_particles_stiffens() {
    let mut state = bar(BondModel::Timoshenko, ELASTIC, 1e-9);
    damp_particles(&mut state, 0.44);
    let found = limit(&mut state);
    assert!((found.step_s * 1.2 / BAR_LIMIT_S - 1.0).abs() < 1e-4);
    assert!((found.undamped_step_s / BAR_LIMIT_S - 1.0).abs() < 1e-4);
}

/// Spheres on a cubic grid, each displaced slightly, bonded to those closer than the diagonal of a
/// face: about 12 bonds each.
fn shaken_grid(side: i32) -> (Particles, Vec<[u32; 2]>) {
    let mut next = crate::bars::scattered();
    let mut particles = Particles::default();
    for (x, y, z) in (0..side * side * side).map(|i| (i % side, i / side % side, i / side / side)) {
        let place = [x, y, z].map(|k| 2.0e-3 * (f64::from(k) + 0.1 * next()));
        particles.push_sphere(place, 1.0e-3 + 1.0e-4 * next(), 2050.0);
    }
    let count = particles.len();
    let side = side as usize;
    let mut pairs = Vec::new();
    for a in 0..count {
        // The next layer contains all that are near enough.
        for b in a + 1..count.min(a + side * side + side + 2) {
            let apart = particles.poses[b].place() - particles.poses[a].place();
            if apart.norm() < 3.0e-3 {
                pairs.push([a as u32, b as u32]);
            }
        }
    }
    (particles, pairs)
}

/// The number of iterations hardly grows with the body; and from another starting vector, obtained
/// by reversed numbering, the same limit is found.
#[test]
fn the_limit_of_a_large_body_is_found_from_any_start() {
    let (particles, pairs) = shaken_grid(18);
    assert_eq!(particles.len(), 5832);
    assert!(pairs.len() > 4 * particles.len(), "{}", pairs.len());
    let last = particles.len() - 1;
    let mut back = Particles::default();
    for i in (0..=last).rev() {
        back.push_sphere(
            particles.poses[i].place().into(),
            particles.poses[i].radius_m(),
            2050.0,
        );
    }
    let mut pairs_back: Vec<[u32; 2]> = pairs
        .iter()
        .map(|[a, b]| [last as u32 - b, last as u32 - a])
        .collect();
    pairs_back.sort_unstable();
    for (model, name) in MODELS {
        for damping in [None, Some(BondDamping::Chen(0.1))] {
            if damping.is_some() && model != BondModel::Timoshenko {
                continue;
            }
            let [found, other] = [(&particles, &pairs), (&back, &pairs_back)].map(|(p, pairs)| {
                let mut state = body(p.clone(), pairs, &soft(model, ELASTIC), 1e-9);
                if let Some(damping) = damping {
                    damp(&mut state, damping);
                }
                limit(&mut state)
            });
            let apart = found.step_s / other.step_s - 1.0;
            eprintln!(
                "{name} {damping:?}: {} and {} iterations, {apart:e}",
                found.iterations, other.iterations
            );
            assert!(found.iterations < 200 && other.iterations < 200, "{name}");
            assert!(apart.abs() < 1e-5, "{name} {damping:?}: {apart:e}");
        }
    }
}
