//! The energy and momentum ledger: what went in and out since the start.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::walls::Wall;

/// What went in and out since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyLedger {
    /// Whether the energy and momenta at the start have been taken down.
    pub(crate) is_open: bool,
    /// Up to the present moment; the half step after it is in `pending`.
    pub(crate) work: Work,
    pub(crate) pending: Work,
    /// Released by bonds that broke, J.
    pub(crate) released_j: f64,
    /// Brought by bodies that came, J.
    pub(crate) brought_j: f64,
    /// Kinetic, elastic and potential energy at the start, J.
    pub(crate) opening_j: f64,
    /// Most that gravity had given, or taken, at a time, J.
    pub(crate) fallen_j: f64,
    /// Largest energy and work seen, J.
    pub(crate) scale_j: f64,
    /// Energy of all bonds stretched, and of all particles that can touch something pressed, by a
    /// millionth: less is rounding, J.
    pub(crate) rounding_floor_j: f64,
    /// The centre of mass at the start, about which moments are taken, m.
    pub(crate) about_m: [f64; 3],
    pub(crate) mass_kg: f64,
    /// Sum of mass times place from `about_m`, kg m.
    pub(crate) first_moment: [f64; 3],
    /// The same two of what sleeps, on which gravity does not act.
    pub(crate) asleep_kg: f64,
    pub(crate) asleep_moment: [f64; 3],
    /// What momentum and angular momentum should be, N s and N m s.
    pub(crate) momentum: [f64; 3],
    pub(crate) angular_momentum: [f64; 3],
    /// Largest sums of magnitudes seen, N s and N m s.
    pub(crate) momentum_scale: f64,
    pub(crate) angular_momentum_scale: f64,
}

/// Work by cause, J. Dissipation counts as positive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Work {
    pub(crate) loads: f64,
    pub(crate) supports: f64,
    pub(crate) bond_damping: f64,
    pub(crate) particle_damping: f64,
}

impl EnergyLedger {
    /// Energy of all bonds stretched, and of all particles that can touch something pressed, by a
    /// millionth: less is rounding, J.
    pub fn rounding_floor_j(&self) -> f64 {
        self.rounding_floor_j
    }

    /// Mass of all particles, kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// What a run could have in energy at most: that of the start, what loads, supports, walls and
    /// gravity gave, J.
    pub fn energy_supplied_j(&self, gravity_m_s2: [f64; 3], walls: &[Wall]) -> f64 {
        let fallen = self.fallen_j.max(self.fallen_now_j(gravity_m_s2));
        let pushed = walls_work_j(walls).abs();
        let given = self.work.loads.abs() + self.work.supports.abs() + pushed + fallen;
        let given = given + self.brought_j.abs();
        self.opening_j.abs() + given + self.rounding_floor_j
    }

    /// Size of what gravity has given until now, J.
    pub(crate) fn fallen_now_j(&self, gravity_m_s2: [f64; 3]) -> f64 {
        let fallen: f64 = (0..3).map(|k| gravity_m_s2[k] * self.first_moment[k]).sum();
        fallen.abs()
    }

    pub(crate) fn settle(&mut self) {
        let pending = std::mem::take(&mut self.pending);
        self.work.add(&pending, 1.0);
    }

    /// Books something that comes (1) or goes (-1) between a kick and the drift after it: of this
    /// mass, kg, at this place, m, with the velocity, m/s, and own angular momentum that it has
    /// after the kick, and with this energy at the moment of the places, that in gravity left out,
    /// J.
    pub fn bring(
        &mut self,
        sign: f64,
        [mass_kg, energy_j]: [f64; 2],
        [place_m, velocity_m_s, own]: [[f64; 3]; 3],
        gravity_m_s2: [f64; 3],
    ) {
        let [px, py, pz, lx, ly, lz, ..] =
            momenta_of(mass_kg, place_m, velocity_m_s, own, self.about_m);
        self.brought_j += sign * energy_j;
        self.mass_kg += sign * mass_kg;
        for (k, (p, l)) in [(px, lx), (py, ly), (pz, lz)].into_iter().enumerate() {
            let moment = sign * mass_kg * (place_m[k] - self.about_m[k]);
            self.first_moment[k] += moment;
            self.brought_j -= gravity_m_s2[k] * moment;
            self.momentum[k] += sign * p;
            self.angular_momentum[k] += sign * l;
        }
    }

    /// Books energy that was gained without a cause that has a place of its own, J.
    pub fn gain(&mut self, energy_j: f64) {
        self.brought_j += energy_j;
    }

    /// Books something that stops where it is, between a kick and the drift after it: of this mass,
    /// kg, at this place, m, with the velocity, m/s, and own angular momentum that it has after the
    /// kick, and with this kinetic energy at the moment of the places, J.
    pub fn stop(
        &mut self,
        [mass_kg, kinetic_j]: [f64; 2],
        [place_m, velocity_m_s, own]: [[f64; 3]; 3],
    ) {
        let [px, py, pz, lx, ly, lz, ..] =
            momenta_of(mass_kg, place_m, velocity_m_s, own, self.about_m);
        self.brought_j -= kinetic_j;
        for (k, (p, l)) in [(px, lx), (py, ly), (pz, lz)].into_iter().enumerate() {
            self.momentum[k] -= p;
            self.angular_momentum[k] -= l;
        }
    }

    /// Takes down what sleeps from now on: masses, kg, and places, m.
    pub fn set_asleep(&mut self, sleepers: impl Iterator<Item = (f64, [f64; 3])>) {
        self.asleep_kg = 0.0;
        self.asleep_moment = [0.0; 3];
        for (mass_kg, place_m) in sleepers {
            self.asleep_kg += mass_kg;
            for (k, moment) in self.asleep_moment.iter_mut().enumerate() {
                *moment += mass_kg * (place_m[k] - self.about_m[k]);
            }
        }
    }

    /// Where the centre of mass should be after a drift.
    pub fn drift(&mut self, time_step_s: f64) {
        for k in 0..3 {
            self.first_moment[k] += time_step_s * self.momentum[k];
        }
    }
}

impl Work {
    pub(crate) fn add(&mut self, other: &Self, factor: f64) {
        self.loads += factor * other.loads;
        self.supports += factor * other.supports;
        self.bond_damping += factor * other.bond_damping;
        self.particle_damping += factor * other.particle_damping;
    }
}

/// Work that all walls did on particles so far, J.
pub(crate) fn walls_work_j(walls: &[Wall]) -> f64 {
    walls.iter().map(|wall| wall.work_j).sum()
}

/// Momentum and angular momentum about a point of something of this mass, kg, place, m, velocity,
/// m/s, and own angular momentum; and their magnitudes.
pub(crate) fn momenta_of(
    mass_kg: f64,
    place_m: [f64; 3],
    velocity_m_s: [f64; 3],
    own: [f64; 3],
    about_m: [f64; 3],
) -> [f64; 8] {
    let momentum = Vector3::from(velocity_m_s) * mass_kg;
    let arm = Vector3::from(place_m) - Vector3::from(about_m);
    let angular = arm.cross(&momentum) + Vector3::from(own);
    let ([px, py, pz], [lx, ly, lz]): ([f64; 3], [f64; 3]) = (momentum.into(), angular.into());
    [px, py, pz, lx, ly, lz, momentum.norm(), angular.norm()]
}
