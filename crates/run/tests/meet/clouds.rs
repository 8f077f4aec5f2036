//! A cloud of spheres that fly into each other: no contact is lost, for any partition of the work
//! and any interval of the neighbour search.

use std::sync::Arc;

use dem_engine::stages::ledger::bookkeeping::{balance, opened};
use dem_engine::state::State;
use dem_engine::state::bonds::Bonds;
use dem_engine::state::clusters::Clusters;
use dem_engine::state::contacts::{ContactModel, Contacts};
use dem_engine::state::particles::Particles;
use dem_engine::step::{advance, interact, step};
use dem_physics::contact::law::ContactKind;
use dem_physics::contact::law::Law;
use dem_physics::contact::law::Rolling;
use dem_physics::contact::law::dmt::DerjaguinMullerToporov;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::law::linear::Linear;
use dem_physics::contact::pair_parameters::{Elastic, PairInput};
use dem_physics::contact::rolling::{ConstantMoment, ElasticPlastic};
use dem_runner::Progress;
use dem_runner::snapshot::{Snapshot, fingerprint};

/// Pseudo-random numbers between -1 and 1.
pub(crate) fn scattered() -> impl FnMut() -> f64 {
    let mut hash = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        hash ^= hash << 13;
        hash ^= hash >> 7;
        hash ^= hash << 17;
        (hash >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn pair_input() -> PairInput {
    PairInput::new(0.6, 0.4)
}

fn hertz_mindlin() -> HertzMindlin {
    let material = Elastic {
        young_modulus_pa: 1e7,
        poisson_ratio: 0.3,
    };
    HertzMindlin::new([material; 2], &pair_input())
}

fn hertz() -> Law {
    Law::HertzMindlin(hertz_mindlin())
}

pub(crate) fn kinds() -> [ContactKind; 3] {
    [
        ContactKind {
            law: hertz(),
            rolling: Rolling::Free,
            bridge: None,
        },
        ContactKind {
            law: Law::Linear(Linear::new(2e3, 2.0 / 7.0, &pair_input())),
            rolling: Rolling::Constant(ConstantMoment { friction: 0.1 }),
            bridge: None,
        },
        ContactKind {
            law: hertz(),
            rolling: Rolling::Spring(ElasticPlastic {
                friction: 0.1,
                damping_ratio: 0.3,
            }),
            bridge: None,
        },
    ]
}

/// 512 spheres of 1 mm, of two materials, each its own cluster, that fly to their common centre.
pub(crate) fn cloud(skin_m: f64, partitions: usize, time_step_s: f64) -> State {
    let mut any = scattered();
    let mut particles = Particles::default();
    for n in 0..512_u32 {
        let grid = [n % 8, n / 8 % 8, n / 64].map(|k| 1.15e-3 * (f64::from(k) - 3.5));
        let place = grid.map(|x| x + 0.05e-3 * any());
        particles.push_sphere(place, 0.5e-3 * (1.0 + 0.05 * any()), 2500.0);
        let motion = particles.motions.last_mut().unwrap();
        motion.velocity_m_s = grid.map(|x| -100.0 * x + 0.1 * any());
        motion.spin_rad_s = [300.0 * any(), 300.0 * any(), 300.0 * any()];
    }
    let count = particles.len();
    let mut state = State::new(particles, Bonds::default(), time_step_s, 1);
    let [one, mixed, other] = kinds();
    let mut contacts = Contacts {
        model: Arc::new(ContactModel {
            kinds: vec![one, mixed, other],
            kind_of: vec![0, 1, 1, 2],
            relaxes: true,
            least_overlap: 1e-3,
            ..ContactModel::default()
        }),
        materials: (0..count).map(|i| u8::from(i % 3 == 0)).collect(),
        skin_m,
        skin_left_m: -1.0,
        lost_j: vec![[0.0; 2]; count],
        ..Contacts::default()
    };
    contacts.divide(count, partitions);
    state.model.contacts = Some(Arc::clone(&contacts.model));
    state.contacts = Some(contacts);
    state.clusters = Some(Clusters::new(count, &state.bonds));
    state.ledger = opened(&state);
    state
}

/// Largest error of the energy over the largest energy while the cloud meets and flies apart.
fn worst_energy_error(time_step_s: f64) -> f64 {
    let mut state = cloud(0.1e-3, 1, time_step_s);
    let mut worst = 0.0_f64;
    while state.time_s < 2e-3 {
        interact(&mut state);
        if state.steps.is_multiple_of(20) {
            let balance = balance(&mut state);
            worst = worst.max(balance.energy_error.abs());
            assert!(balance.momentum_error < 1e-12, "{balance:?}");
            assert!(balance.angular_momentum_error < 1e-12, "{balance:?}");
        }
        advance(&mut state);
    }
    interact(&mut state);
    let balance = balance(&mut state);
    assert!(balance.friction_j > 0.0 && balance.contact_damping_j > 0.0);
    eprintln!("dt {time_step_s:e}: worst energy error {worst:.2e}, {balance:?}");
    worst
}

#[test]
fn the_books_of_a_meeting_cloud_balance() {
    let errors = [4e-7, 2e-7, 1e-7].map(worst_energy_error);
    eprintln!("{errors:?}");
    assert!(errors[2] < 1e-5, "{errors:?}");
    assert!(
        errors[0] > 3.0 * errors[1] && errors[1] > 3.0 * errors[2],
        "{errors:?}"
    );
}

#[test]
fn to_look_at_all_pairs_in_each_step_changes_no_bit() {
    let run = |always: bool| {
        let mut state = cloud(0.1e-3, 2, 2e-7);
        let mut looks = 0;
        for _ in 0..4000 {
            let contacts = state.contacts.as_mut().unwrap();
            if always {
                // No skin is left, as if it were used up: the close pairs are found again in every
                // step.
                (contacts.moved_m, contacts.scratch.close_skin_left_m) = (0.0, 0.0);
            }
            looks += usize::from(contacts.scratch.close_skin_left_m <= 0.0);
            step(&mut state);
        }
        let contacts = state.contacts.unwrap();
        let books = (contacts.histories, contacts.lost_j);
        (looks, state.particles.poses, state.particles.motions, books)
    };
    let (often, seldom) = (run(true), run(false));
    assert_eq!(often.0, 4000);
    assert!(seldom.0 < 400, "{}", seldom.0);
    assert_eq!(often.1, seldom.1);
    assert_eq!(often.2, seldom.2);
    assert_eq!(often.3, seldom.3);
}

#[test]
fn shares_and_skins_change_no_bit() {
    let run = |skin_m: f64, partitions: usize| {
        let mut state = cloud(skin_m, partitions, 2e-7);
        for _ in 0..4000 {
            step(&mut state);
        }
        let contacts = state.contacts.unwrap();
        (
            state.particles.poses,
            state.particles.motions,
            contacts.lost_j,
        )
    };
    let one = run(0.1e-3, 1);
    for (skin_m, partitions) in [(0.1e-3, 2), (0.1e-3, 5), (0.02e-3, 3), (0.5e-3, 1)] {
        let other = run(skin_m, partitions);
        assert!(one == other, "skin {skin_m}, {partitions} partitions");
    }
}

/// Spheres that part fast, so that no listed pair counts as close, still attract each other within
/// the step: both ends, also where two tasks work on them.
#[test]
fn shares_of_a_sticky_cloud_change_no_bit() {
    let run = |partitions: usize| {
        let mut state = cloud(0.1e-3, partitions, 1.5e-6);
        let contacts = state.contacts.as_mut().unwrap();
        let mut model = ContactModel::clone(&contacts.model);
        for kind in &mut model.kinds {
            kind.law = Law::DerjaguinMullerToporov(DerjaguinMullerToporov {
                hertz_mindlin: hertz_mindlin(),
                work_of_adhesion_j_m2: 0.05,
            });
        }
        contacts.model = Arc::new(model);
        state.model.contacts = Some(Arc::clone(&contacts.model));
        let mut parted = 0;
        let touching = |state: &State| {
            let histories = &state.contacts.as_ref().unwrap().histories;
            histories.iter().filter(|one| one.overlap_m() > 0.0).count()
        };
        let mut before = 0;
        for _ in 0..1000 {
            interact(&mut state);
            let now = touching(&state);
            parted += usize::from(now < before);
            before = now;
            let balance = balance(&mut state);
            assert!(balance.momentum_error < 1e-12, "{balance:?}");
            advance(&mut state);
        }
        assert!(parted > 100, "{parted}");
        (state.particles.poses, state.particles.motions)
    };
    let one = run(1);
    for partitions in [2, 5] {
        assert!(one == run(partitions), "{partitions} partitions");
    }
}

#[test]
fn a_cloud_taken_up_again_at_any_step_goes_on_to_the_same_bits() {
    let start = cloud(0.1e-3, 2, 2e-7);
    let fingerprint = fingerprint(&start).unwrap();
    let mut state = start.clone();
    while state.steps < 2000 {
        step(&mut state);
    }
    for _ in 0..60 {
        step(&mut state);
        let taken = Snapshot::taken(
            &state,
            &[],
            String::new(),
            fingerprint,
            Vec::new(),
            Progress::default(),
        );
        let bytes = taken.to_bytes().unwrap();
        let mut again = start.clone();
        Snapshot::from_bytes(&bytes)
            .unwrap()
            .restore(fingerprint, &mut again, &mut Vec::new())
            .unwrap();
        let mut on = state.clone();
        for _ in 0..20 {
            step(&mut on);
            step(&mut again);
        }
        assert!(
            on.particles.poses == again.particles.poses
                && on.particles.motions == again.particles.motions,
            "at step {}",
            state.steps
        );
    }
}
