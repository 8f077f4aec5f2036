//! Ledgers of energy and momentum: compares the totals with what was supplied and removed.
//!
//! Work is summed with the velocities of the leapfrog: half of each step's power at its beginning,
//! half at its end. So the ledger is as accurate as the step: its error falls with the square of
//! the time step.

use nalgebra::Vector3;

use crate::stages::bonds::energy_kernel::elastic_energy;
use crate::stages::chunks::{ordered_sum, ordered_sums};
use crate::stages::clumps::motion::synchronous;
use crate::stages::contacts::bridges::bridges_energy_j;
use crate::stages::contacts::forces::{elastic_energy_j, lost_j, pairs_adhesion_j};
use crate::stages::ledger::islands::look_at_islands;
use crate::stages::ledger::rounding::{
    all_kinds, pressed_by_a_millionth_j, stretched_by_a_millionth_j,
};
use crate::stages::ledger::totals::{kinetic_energy, momenta, synchronous_motions_of_free};
use crate::stages::motion::kick_and_drift::power_w;
use crate::stages::motion::loads::{add_resultant, loads_power_w, loads_resultant};
use crate::stages::motion::supports::reactions_work_j;
use crate::stages::stage::{Need, Stage};
use crate::stages::walls::touches_adhesion_j;
use crate::state::State;
use crate::state::ledger::{EnergyLedger, Work, walls_work_j};
use crate::state::particles::{Pose, Wrench};
use crate::state::sleep::Sleep;
use crate::state::walls::{Wall, WallLoad};
use dem_physics::contact::law::ContactKind;
use dem_results::Balance;

/// The ledgers of energy and momentum.
pub(crate) const LEDGER: Stage = Stage::new("energy balance", |_, _| {
    Need::Needed("energy and momentum".to_owned())
});

/// Checks of the time step limit and of energy.
pub const CHECKS: Stage = Stage::new("checks", |_, _| {
    Need::Needed("of energy, and of the limit of the step".to_owned())
});

/// Records the work of the half step that ends with the coming kick.
pub(crate) fn book_before_kick(state: &mut State) -> usize {
    before_kick(state);
    0
}

/// Records the kick that has just been done.
pub(crate) fn book_after_kick(state: &mut State) -> usize {
    after_kick(state);
    0
}

/// Advances the time to the end of the drift.
pub(crate) fn advance_time(state: &mut State) -> usize {
    state.ledger.drift(state.time_step_s);
    state.time_s += state.time_step_s;
    state.previous_time_step_s = state.time_step_s;
    state.steps += 1;
    0
}

/// Energy that the attraction of ends that touch, adhesion or liquid, releases until their elastic
/// force balances it, for one contact of each particle by the law that attracts it most, J.
/// Contacts may be shorter than the time between two looks at the ledger.
fn attraction_at_rest_j(state: &State) -> f64 {
    let Some(contacts) = &state.contacts else {
        return 0.0;
    };
    let kinds = all_kinds(contacts, &state.walls);
    let poses = &state.particles.poses;
    ordered_sum(poses.len(), |i| {
        let radius_m = poses[i].radius_m();
        let of_kind = |kind: &&ContactKind| {
            let adhesion_n = kind.law.at_impact().largest_attraction_n(radius_m);
            let bridge_n = kind.bridge.map_or(0.0, |bridge| bridge.largest_n(radius_m));
            let attraction_n = adhesion_n + bridge_n;
            // The overlap at rest, by the growth of Hertz's force from a small one.
            let small_m = 1e-6 * radius_m;
            let stiffness_n_m = kind.normal_n_m(small_m, radius_m);
            let overlap_m = (1.5 * attraction_n * small_m.sqrt() / stiffness_n_m).powf(2.0 / 3.0);
            attraction_n * overlap_m.min(radius_m)
        };
        kinds.iter().map(of_kind).fold(0.0, f64::max)
    })
}

/// The ledger of a state before its first step.
pub fn opened(state: &State) -> EnergyLedger {
    let p = &state.particles;
    let clumps = &state.clumps;
    let free_kg = ordered_sum(p.free, |i| 1.0 / p.motions[i].inverse_mass);
    let mass_kg = free_kg + clumps.mass_kg();
    let about_m = [0, 1, 2].map(|k| {
        let of_free = ordered_sum(p.free, |i| {
            p.poses[i].position_m[k] / p.motions[i].inverse_mass
        });
        let of_clumps = clumps.all.iter();
        let of_clumps: f64 = of_clumps
            .map(|clump| clump.place_m[k] * clumps.template(clump).mass_kg)
            .sum();
        over(of_free + of_clumps, mass_kg)
    });
    let mut ledger = EnergyLedger {
        is_open: true,
        about_m,
        mass_kg,
        ..EnergyLedger::default()
    };
    let elastic = elastic_energy(state).total();
    ledger.attraction_j = attraction_at_rest_j(state);
    ledger.rounding_floor_j = stretched_by_a_millionth_j(state) + pressed_by_a_millionth_j(state);
    let pressed = state.contacts.as_ref();
    let pressed = pressed.map_or(0.0, |contacts| elastic_energy_j(contacts, p));
    let pressed = pressed
        + state
            .walls
            .iter()
            .map(|wall| wall.scratch.elastic_j)
            .sum::<f64>();
    let kinetic = kinetic_energy(p, |i| p.motions[i]) + clumps.kinetic_j();
    ledger.opening_j = kinetic + elastic + pressed;
    ledger.scale_j = ledger.opening_j.max(ledger.rounding_floor_j);
    let (momentum, scales) = momenta(p, clumps, about_m);
    [ledger.momentum, ledger.angular_momentum] = momentum;
    [ledger.momentum_scale, ledger.angular_momentum_scale] = scales;
    ledger
}

/// Power of a wall's forces, W, with its motion in the step just made (0) or in the next one (1).
fn wall_power_w(wall: &Wall, push: &WallLoad, step: usize) -> f64 {
    push.power_w(wall.velocities_m_s[step], wall.spins_rad_s[step])
}

/// Powers of loads and damping, W.
fn powers(state: &State) -> Work {
    let particles = &state.particles;
    let [of_bonds, on_particles] = state.resistances();
    let of_bonds_w = -power_w(of_bonds, particles);
    let structural = state.scratch.structural_share;
    Work {
        loads: loads_power_w(
            &state.loads,
            state.time_s,
            state.steps_s(),
            &particles.motions,
        ),
        supports: 0.0,
        bond_damping: (1.0 - structural) * of_bonds_w,
        structural_damping: structural * of_bonds_w,
        particle_damping: -power_w(on_particles, particles),
    }
}

/// Records the work of the half step that ends with the coming kick.
pub(crate) fn before_kick(state: &mut State) {
    let powers = powers(state);
    state.ledger.settle();
    let half_s = 0.5 * state.previous_time_step_s;
    state.ledger.work.add(&powers, half_s);
    for wall in &mut state.walls {
        let ridden = &mut wall.ridden;
        let ridden_j = ridden.pending_j + half_s * ridden.power_w;
        ridden.work_j += ridden_j;
        ridden.pending_j = 0.0;
        wall.work_j += wall.pending_j + half_s * wall_power_w(wall, &wall.push, 0) + ridden_j;
        wall.pending_j = 0.0;
    }
}

/// Records the kick that has just been done: work of supports, work of the next half step,
/// impulses.
pub(crate) fn after_kick(state: &mut State) {
    let pending = powers(state);
    let half_s = 0.5 * state.time_step_s;
    for wall in &mut state.walls {
        wall.pending_j = half_s * wall_power_w(wall, &wall.push, 1);
        wall.ridden.pending_j = half_s * wall.ridden.power_w;
    }
    let State {
        ledger,
        particles,
        supports,
        loads,
        ..
    } = state;
    let (before_s, after_s) = (state.previous_time_step_s, state.time_step_s);
    let steps_s = [before_s, after_s];
    let supported = reactions_work_j(supports, particles, state.time_s, steps_s);
    ledger.work.supports += supported[0];
    ledger.pending.add(&pending, 0.5 * after_s);
    ledger.pending.supports = supported[1];
    for broken in &state.scratch.events.broken {
        ledger.released_j += broken.released_j;
    }
    ledger.note_fall(state.model.gravity_m_s2);

    let about = ledger.about_m;
    let mut total = loads_resultant(loads, state.time_s, steps_s, &particles.poses, about);
    for support in supports.iter() {
        for held in &support.held {
            let [early, late] = held.reactions;
            let mean = |k: usize| (before_s * early[k] + after_s * late[k]) / (before_s + after_s);
            let [fx, fy, fz, tx, ty, tz] = [0, 1, 2, 3, 4, 5].map(mean);
            let pose = &particles.poses[held.particle as usize];
            add_resultant(&mut total, pose, [fx, fy, fz], [tx, ty, tz], about);
        }
    }
    for wall in &state.walls {
        let [x, y, z] = [0, 1, 2].map(|k| wall.frame.position_m[k] - about[k]);
        let ([fx, fy, fz], torque) = (wall.push.force_n, wall.push.torque_n_m);
        let moved = [y * fz - z * fy, z * fx - x * fz, x * fy - y * fx];
        for k in 0..3 {
            total[0][k] += wall.push.force_n[k];
            total[1][k] += torque[k] + moved[k];
        }
    }
    let resisted = resultant(&state.scratch.particle_resistance, &particles.poses, about);
    let g = state.model.gravity_m_s2;
    let [sx, sy, sz] = [0, 1, 2].map(|k| ledger.first_moment[k] - ledger.asleep_moment[k]);
    let awake_kg = ledger.mass_kg - ledger.asleep_kg;
    let fall = [
        sy * g[2] - sz * g[1],
        sz * g[0] - sx * g[2],
        sx * g[1] - sy * g[0],
    ];
    let kick_s = 0.5 * (before_s + after_s);
    for k in 0..3 {
        ledger.momentum[k] += kick_s * (total[0][k] + resisted[0][k] + awake_kg * g[k]);
        ledger.angular_momentum[k] += kick_s * (total[1][k] + resisted[1][k] + fall[k]);
    }
}

/// Force and moment about a point of wrenches on particles.
fn resultant(wrenches: &[Wrench], poses: &[Pose], about_m: [f64; 3]) -> [[f64; 3]; 2] {
    let sums = ordered_sums(wrenches.len(), |i| {
        let ([fx, fy, fz, _], [tx, ty, tz, _]) = (wrenches[i].force_n, wrenches[i].torque_n_m);
        let mut one = [[0.0; 3]; 2];
        add_resultant(&mut one, &poses[i], [fx, fy, fz], [tx, ty, tz], about_m);
        let [[fx, fy, fz], [mx, my, mz]] = one;
        [fx, fy, fz, mx, my, mz]
    });
    let [fx, fy, fz, mx, my, mz] = sums;
    [[fx, fy, fz], [mx, my, mz]]
}

/// Part of the energy of all contacts that is adhesion, J: below 0.
fn adhesion_j(state: &State) -> f64 {
    let Some(contacts) = &state.contacts else {
        return 0.0;
    };
    let (p, sleep) = (&state.particles, state.sleep.as_ref());
    let awake = contacts.pairs.iter().zip(&contacts.histories);
    let frozen = sleep.iter().flat_map(|sleep| &sleep.pairs);
    let frozen = frozen.map(|kept| (&kept.pair, &kept.history));
    let of_walls = state.walls.iter().enumerate().map(|(number, wall)| {
        let frozen = sleep.iter().flat_map(|sleep| &sleep.touches);
        let frozen = frozen.filter(|kept| kept.wall == number);
        let touches = wall.touching.iter().chain(frozen.map(|kept| &kept.touch));
        touches_adhesion_j(wall, contacts, p, touches)
    });
    pairs_adhesion_j(contacts, p, awake.chain(frozen)) + of_walls.sum::<f64>()
}

/// Energy of contacts before adhesion, and what friction and damping at them have taken, J.
fn contact_energies_j(state: &State) -> (f64, [f64; 2]) {
    let (mut elastic, [mut friction, mut damping]) = match &state.contacts {
        Some(contacts) => {
            let elastic_j = elastic_energy_j(contacts, &state.particles);
            (elastic_j, lost_j(contacts))
        }
        None => (0.0, [0.0; 2]),
    };
    for wall in &state.walls {
        elastic += wall.scratch.elastic_j;
        friction += wall.friction_j;
        damping += wall.damping_j;
    }
    elastic += state.sleep.as_ref().map_or(0.0, Sleep::elastic_j);
    (elastic, [friction, damping])
}

/// The ledger between the two halves of a step, `interact` and `advance`. Records the largest
/// energies and momenta.
pub fn balance(state: &mut State) -> Balance {
    let motions = synchronous_motions_of_free(state);
    let clumps = synchronous(state);
    let elastic = elastic_energy(state);
    look_at_islands(state, &motions, &clumps, elastic.total());
    let of_clumps = clumps.iter();
    let of_clumps = of_clumps.map(|clump| clump.kinetic_j(state.clumps.template(clump)));
    let kinetic = kinetic_energy(&state.particles, |i| motions[i]) + of_clumps.sum::<f64>();
    let wall_work = walls_work_j(&state.walls);
    let (contact_elastic, [friction, contact_damping]) = contact_energies_j(state);
    let adhesion = adhesion_j(state);
    let friction = friction + state.ledger.joint_friction_j;
    let bridges_j = bridges_energy_j(state);
    let bridges_lost_j = state.bridges.as_ref().map_or(0.0, |bridges| bridges.lost_j);
    let (present, scales) = momenta(&state.particles, &state.clumps, state.ledger.about_m);
    let g = state.model.gravity_m_s2;
    let ledger = &mut state.ledger;
    let gravity: f64 = 0.0 - (0..3).map(|k| g[k] * ledger.first_moment[k]).sum::<f64>();

    let work = ledger.work;
    let gone = (work.bond_damping + work.structural_damping)
        + work.particle_damping
        + contact_damping
        + friction
        + (ledger.released_j + ledger.damaged_j + ledger.plastic_j)
        + (ledger.particles_broken_j + ledger.rejoined_j)
        + bridges_lost_j;
    let stored = elastic.total() + contact_elastic + bridges_j;
    let given = work.loads + work.supports + wall_work + ledger.brought_j;
    let error = kinetic + stored + gravity + gone - given - ledger.opening_j;
    // Each by itself: adhesion and the elastic energy that it presses in nearly cancel.
    let held = kinetic + (elastic.total() + (contact_elastic - adhesion) + bridges_j.max(0.0));
    let largest = [
        held,
        adhesion.abs(),
        bridges_j.abs(),
        gone.abs(),
        gravity.abs(),
        work.loads.abs(),
        work.supports.abs(),
        wall_work.abs(),
    ];
    ledger.note(largest, adhesion.abs() + bridges_j.abs(), scales);
    Balance {
        kinetic_j: kinetic,
        elastic_normal_j: elastic.normal,
        elastic_shear_j: elastic.shear,
        elastic_torsion_j: elastic.torsion,
        elastic_bending_j: elastic.bending,
        gravity_j: gravity,
        load_work_j: work.loads,
        support_work_j: work.supports,
        wall_work_j: wall_work,
        bond_damping_j: work.bond_damping,
        structural_damping_j: work.structural_damping,
        local_damping_j: work.particle_damping,
        contact_elastic_j: contact_elastic - adhesion,
        adhesion_j: adhesion,
        contact_damping_j: contact_damping,
        friction_j: friction,
        bond_breakage_j: ledger.released_j,
        bond_damage_j: ledger.damaged_j,
        particle_breakage_j: ledger.particles_broken_j,
        bond_plastic_j: ledger.plastic_j,
        liquid_bridge_j: bridges_j,
        liquid_bridge_loss_j: bridges_lost_j,
        rejoining_loss_j: ledger.rejoined_j,
        flow_energy_j: ledger.brought_j,
        energy_error_j: error,
        energy_error: over(error, ledger.scale_j),
        energy_scale_j: ledger.scale_j,
        momentum_error: off(present[0], ledger.momentum, ledger.momentum_scale),
        angular_momentum_error: off(
            present[1],
            ledger.angular_momentum,
            ledger.angular_momentum_scale,
        ),
        momentum_scales: [ledger.momentum_scale, ledger.angular_momentum_scale],
    }
}

/// Distance of a vector from what it should be, over a scale.
fn off(is: [f64; 3], should: [f64; 3], scale: f64) -> f64 {
    over((Vector3::from(is) - Vector3::from(should)).norm(), scale)
}

/// A ratio; 0 if there is nothing to compare with.
pub fn over(value: f64, scale: f64) -> f64 {
    if scale == 0.0 { 0.0 } else { value / scale }
}
