//! A bed of spheres with contacts as in a heap.

use std::sync::Arc;

use dem_run::physics::contact::law::ContactKind;
use dem_run::physics::contact::law::Law;
use dem_run::physics::contact::law::Rolling;
use dem_run::physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_run::physics::contact::pair_parameters::{Elastic, PairInput};
use dem_run::physics::geometry::spatial_order::spatial_order;
use dem_run::stages::ledger::bookkeeping::opened;
use dem_run::stages::search::neighbours::near_pairs;
use dem_run::state::State;
use dem_run::state::bonds::Bonds;
use dem_run::state::clusters::Clusters;
use dem_run::state::contacts::{ContactModel, Contacts};
use dem_run::state::particles::Particles;
use dem_testing::Random;

/// Number of cubes of a face-centred lattice along each side: with four sites each, of which some
/// are empty, about 20,000 spheres.
const CUBES: usize = 18;
const EMPTY: f64 = 0.143;
const RADIUS_M: f64 = 1e-3;
const SKIN_M: f64 = 0.1 * RADIUS_M;

/// Spheres on a dense lattice with vacancies, with radii that differ by a thousandth: of their near
/// pairs, those of large spheres overlap, by about the same amount. About 2.9 pairs per sphere
/// touch, of 4.9 that are near. Nothing holds the bed together: its time step is so short that it
/// does not move.
pub(crate) fn bed(threads: usize) -> State {
    let mut random = Random(1);
    let side_m = 2.0 * RADIUS_M * std::f64::consts::SQRT_2;
    let mut places = Vec::new();
    for cube in 0..CUBES.pow(3) {
        let corner = [cube % CUBES, cube / CUBES % CUBES, cube / CUBES.pow(2)];
        for within in [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]] {
            if random.fraction() > EMPTY {
                places.push([0, 1, 2].map(|k| side_m * (corner[k] as f64 + within[k])));
            }
        }
    }
    let mut particles = Particles::default();
    for i in spatial_order(&places) {
        let radius_m = RADIUS_M * (1.0 + 2e-3 * (random.fraction() - 0.44));
        particles.push_sphere(places[i as usize], radius_m, 2500.0);
    }
    for motion in &mut particles.motions {
        motion.velocity_m_s = [0; 3].map(|_| 1e-3 * (random.fraction() - 0.5));
        motion.spin_rad_s = [0; 3].map(|_| random.fraction() - 0.5);
    }
    let count = particles.len();
    let mut state = State::new(particles, Bonds::default(), 1e-10, threads);
    state.clusters = Some(Clusters::new(count, &state.bonds));
    state.contacts = Some(contacts(&state, threads));
    state.ledger = opened(&state);
    state
}

fn contacts(state: &State, threads: usize) -> Contacts {
    let poses = &state.particles.poses;
    let glass = Elastic {
        young_modulus_pa: 1e8,
        poisson_ratio: 0.3,
    };
    let mut contacts = Contacts {
        model: Arc::new(ContactModel {
            kinds: vec![ContactKind {
                law: Law::HertzMindlin(HertzMindlin::new([glass; 2], &PairInput::new(0.5, 0.5))),
                rolling: Rolling::Free,
                bridge: None,
            }],
            kind_of: vec![0],
            least_overlap: 1e-3,
            ..ContactModel::default()
        }),
        materials: vec![0; poses.len()],
        skin_m: SKIN_M,
        skin_left_m: 0.5 * SKIN_M,
        lost_j: vec![[0.0; 2]; poses.len()],
        ..Contacts::default()
    };
    let clusters: Vec<u32> = (0..poses.len() as u32).collect();
    // As if they had come together: their overlaps give forces.
    let pairs = near_pairs(poses, &clusters, SKIN_M);
    contacts.relist(pairs, poses.len(), |_| 0.0);
    contacts.divide(poses.len(), threads);
    contacts
}
