//! The ledger of energy and momentum: totals supplied and removed since the start.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::walls::Wall;

/// Part of the energy that a body brings that many such bodies do not reach by rounding.
const ROUNDED: f64 = 1e-9;

/// Energy and momentum supplied and removed since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyLedger {
    /// Whether the energy and momenta at the start have been recorded.
    pub(crate) is_open: bool,
    /// Up to the present moment; the half step after it is in `pending`.
    pub(crate) work: Work,
    pub(crate) pending: Work,
    /// Released by bonds that broke, J.
    pub(crate) released_j: f64,
    /// Lost by bonds that were damaged, J.
    pub(crate) damaged_j: f64,
    /// Lost by particles that daughters replaced, J.
    pub(crate) particles_broken_j: f64,
    /// Kinetic energy of spheres that they lost as they joined rigid parts, J.
    pub(crate) rejoined_j: f64,
    /// Friction of failed elements of flat joints, J.
    pub(crate) joint_friction_j: f64,
    /// Plastic work of bonds, J.
    pub(crate) plastic_j: f64,
    /// Net energy of added and removed bodies, J.
    pub(crate) brought_j: f64,
    /// Kinetic, elastic and potential energy at the start, J.
    pub(crate) opening_j: f64,
    /// Largest energy that gravity had supplied, or taken, at any time, J.
    pub(crate) fallen_j: f64,
    /// Largest energy or work seen, each by itself, J.
    pub(crate) scale_j: f64,
    /// Largest energy that the attraction of ends that touch, adhesion or liquid, has released at
    /// any time, J.
    pub(crate) attraction_j: f64,
    /// Energy at which all bonds are stretched, and all particles that can touch something are
    /// pressed, by a millionth: anything less is rounding, J.
    pub rounding_floor_j: f64,
    /// The centre of mass at the start, about which moments are taken, m.
    pub(crate) about_m: [f64; 3],
    pub(crate) mass_kg: f64,
    /// Sum of mass times position relative to `about_m`, kg m.
    pub(crate) first_moment: [f64; 3],
    /// The same two for sleeping bodies, on which gravity does not act.
    pub(crate) asleep_kg: f64,
    pub(crate) asleep_moment: [f64; 3],
    /// Momentum of those that ride, N s.
    pub(crate) asleep_momentum: [f64; 3],
    /// Expected momentum and angular momentum, N s and N m s.
    pub(crate) momentum: [f64; 3],
    pub(crate) angular_momentum: [f64; 3],
    /// Largest sums of magnitudes so far, N s and N m s.
    pub(crate) momentum_scale: f64,
    pub(crate) angular_momentum_scale: f64,
}

/// Work by cause, J. Dissipation counts as positive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Work {
    pub(crate) loads: f64,
    pub(crate) supports: f64,
    pub(crate) bond_damping: f64,
    pub(crate) structural_damping: f64,
    pub(crate) particle_damping: f64,
}

impl EnergyLedger {
    /// Mass of all particles, kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// Raises the largest energy (J), energy of attraction (J), momentum and angular momentum.
    pub(crate) fn note(&mut self, energies_j: [f64; 8], attraction_j: f64, momenta: [f64; 2]) {
        self.scale_j = energies_j.into_iter().fold(self.scale_j, f64::max);
        self.attraction_j = self.attraction_j.max(attraction_j);
        self.momentum_scale = self.momentum_scale.max(momenta[0]);
        self.angular_momentum_scale = self.angular_momentum_scale.max(momenta[1]);
    }

    /// Upper bound of the energy of a run: that at the start plus that supplied by loads, supports,
    /// walls, gravity, attraction and added bodies, J.
    pub(crate) fn energy_supplied_j(&self, gravity_m_s2: [f64; 3], walls: &[Wall]) -> f64 {
        let fallen = self.fallen_j.max(self.fallen_now_j(gravity_m_s2));
        let pushed = walls_work_j(walls).abs();
        let given = self.work.loads.abs() + self.work.supports.abs() + pushed + fallen;
        let given = given + self.brought_j.abs() + self.attraction_j;
        self.opening_j.abs() + given + self.rounding_floor_j
    }

    /// Magnitude of the energy supplied by gravity up to now, J.
    pub(crate) fn fallen_now_j(&self, gravity_m_s2: [f64; 3]) -> f64 {
        let fallen: f64 = (0..3).map(|k| gravity_m_s2[k] * self.first_moment[k]).sum();
        fallen.abs()
    }

    /// Notes the energy supplied by gravity up to now, if it is the largest so far.
    pub(crate) fn note_fall(&mut self, gravity_m_s2: [f64; 3]) {
        self.fallen_j = self.fallen_j.max(self.fallen_now_j(gravity_m_s2));
    }

    pub(crate) fn settle(&mut self) {
        let pending = std::mem::take(&mut self.pending);
        self.work.add(&pending, 1.0);
    }

    /// Records a body that is added (1) or removed (-1) between a kick and the drift after it: its
    /// mass, kg, position, m, velocity, m/s, and own angular momentum after the kick, and its
    /// energy at the time of the positions without the potential energy in gravity, J.
    pub fn bring(
        &mut self,
        sign: f64,
        [mass_kg, energy_j]: [f64; 2],
        [place_m, velocity_m_s, own]: [[f64; 3]; 3],
        gravity_m_s2: [f64; 3],
    ) {
        let [px, py, pz, lx, ly, lz, ..] =
            momenta_of(mass_kg, place_m, velocity_m_s, own, self.about_m);
        // What several bodies bring may cancel, but for rounding.
        let lifted: [f64; 3] = [0, 1, 2].map(|k| gravity_m_s2[k] * (place_m[k] - self.about_m[k]));
        let own_j = energy_j.abs() + (mass_kg * lifted.iter().sum::<f64>()).abs();
        self.scale_j = self.scale_j.max(ROUNDED * own_j);
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

    /// Records a gain of energy without an entry of its own, J.
    pub fn gain(&mut self, energy_j: f64) {
        self.brought_j += energy_j;
    }

    /// Turns the gain since `brought_j` was this, J, into a loss of particles that broke.
    pub(crate) fn book_broken_particles(&mut self, before_j: f64) {
        self.particles_broken_j -= self.brought_j - before_j;
        self.brought_j = before_j;
    }

    /// Records a body that stops at its place, between a kick and the drift after it: its mass, kg,
    /// position, m, velocity, m/s, and own angular momentum after the kick, and its kinetic energy
    /// at the time of the positions, J.
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

    /// Records a body that from now on rides: its mass, kg, position, m, and velocity, m/s. To be
    /// called after [`Self::stop`].
    pub(crate) fn carry(&mut self, mass_kg: f64, place_m: [f64; 3], velocity_m_s: [f64; 3]) {
        let kinetic_j = 0.5 * mass_kg * Vector3::from(velocity_m_s).norm_squared();
        let [place, velocity] = [place_m, velocity_m_s];
        self.stop([-mass_kg, -kinetic_j], [place, velocity, [0.0; 3]]);
    }

    /// Sets the sleeping bodies: masses, kg, positions, m, and velocities, m/s.
    pub(crate) fn set_asleep(&mut self, sleepers: impl Iterator<Item = (f64, [[f64; 3]; 2])>) {
        self.asleep_kg = 0.0;
        self.asleep_moment = [0.0; 3];
        self.asleep_momentum = [0.0; 3];
        for (mass_kg, [place_m, velocity_m_s]) in sleepers {
            self.asleep_kg += mass_kg;
            for k in 0..3 {
                self.asleep_moment[k] += mass_kg * (place_m[k] - self.about_m[k]);
                self.asleep_momentum[k] += mass_kg * velocity_m_s[k];
            }
        }
    }

    /// Advances the expected centre of mass, and that of sleeping bodies, by a drift.
    pub fn drift(&mut self, time_step_s: f64) {
        for k in 0..3 {
            self.first_moment[k] += time_step_s * self.momentum[k];
            self.asleep_moment[k] += time_step_s * self.asleep_momentum[k];
        }
    }
}

impl Work {
    pub(crate) fn add(&mut self, other: &Self, factor: f64) {
        self.loads += factor * other.loads;
        self.supports += factor * other.supports;
        self.bond_damping += factor * other.bond_damping;
        self.structural_damping += factor * other.structural_damping;
        self.particle_damping += factor * other.particle_damping;
    }
}

/// Work that all walls did on particles so far, J.
pub(crate) fn walls_work_j(walls: &[Wall]) -> f64 {
    walls.iter().map(|wall| wall.work_j).sum()
}

/// Momentum and angular momentum about a point of a body with this mass, kg, position, m, velocity,
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
