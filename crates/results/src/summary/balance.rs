//! The balance of energy and momentum, and the list of its energies.

use serde::{Deserialize, Serialize};

use EnergyKind::{Brought, Lost, Stored, Work};

/// The ledger at a moment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Balance {
    /// Kinetic energy at this moment, J.
    pub kinetic_j: f64,
    /// Elastic energy of bonds, stretch, J.
    pub elastic_normal_j: f64,
    /// Elastic energy of bonds, shear, J.
    pub elastic_shear_j: f64,
    /// Elastic energy of bonds, torsion, J.
    pub elastic_torsion_j: f64,
    /// Elastic energy of bonds, bending, J.
    pub elastic_bending_j: f64,
    /// Potential energy in gravity, relative to the initial positions, J.
    pub gravity_j: f64,
    /// Work done by loads, J.
    pub load_work_j: f64,
    /// Work done by supports, J.
    pub support_work_j: f64,
    /// Work done by walls, J.
    pub wall_work_j: f64,
    /// Dissipated by viscous damping of bonds, J.
    pub bond_damping_j: f64,
    /// Dissipated by structural damping of bonds, J.
    pub structural_damping_j: f64,
    /// Dissipated by particle damping, J.
    pub local_damping_j: f64,
    /// Elastic energy of contacts, J.
    pub contact_elastic_j: f64,
    /// Energy of the attraction of ends that touch, J: below 0.
    pub adhesion_j: f64,
    /// Dissipated by contact damping, J.
    pub contact_damping_j: f64,
    /// Dissipated by friction of contacts, sliding and rolling, and of failed elements of flat
    /// joints, J.
    pub friction_j: f64,
    /// Released by bonds that broke, and by elements of flat joints that failed, J.
    pub bond_breakage_j: f64,
    /// Energy that damaged bonds lost while they softened, J.
    pub bond_damage_j: f64,
    /// Energy that particles lost as daughters replaced them, J.
    pub particle_breakage_j: f64,
    /// Plastic work of bonds, J: what hardening stores is part of it.
    pub bond_plastic_j: f64,
    /// Energy of liquid bridges, J: the work from the touch of their ends to their present gaps.
    pub liquid_bridge_j: f64,
    /// Dissipated by liquid bridges as they formed and ruptured, J.
    pub liquid_bridge_loss_j: f64,
    /// Kinetic energy of spheres that they lost as they joined rigid parts again, J.
    pub rejoining_loss_j: f64,
    /// Energy of added bodies, minus that of removed bodies, plus the gain when clumps and clusters
    /// replaced each other, minus the kinetic energy that bodies had when they fell asleep, J.
    pub flow_energy_j: f64,
    /// Actual minus expected energy, J.
    pub energy_error_j: f64,
    /// The same, divided by the largest energy or work so far: kinetic and elastic energy,
    /// adhesion, liquid bridges, gravity, losses, and the work of loads, supports and walls, each
    /// by itself.
    pub energy_error: f64,
    /// That largest energy or work, J.
    pub energy_scale_j: f64,
    /// Actual minus expected momentum, divided by the largest sum of the magnitudes of its parts so
    /// far.
    pub momentum_error: f64,
    /// The same for angular momentum about the initial centre of mass.
    pub angular_momentum_error: f64,
    /// Those largest sums: of momentum, N s, and of angular momentum, N m s.
    pub momentum_scales: [f64; 2],
}

impl Balance {
    /// Elastic energy of bonds, all modes, and of contacts, J.
    pub fn elastic_j(&self) -> f64 {
        self.elastic_normal_j
            + self.elastic_shear_j
            + self.elastic_torsion_j
            + self.elastic_bending_j
            + self.contact_elastic_j
    }
}

/// How an energy enters the balance: what is stored and lost, less work and what was brought, stays
/// what it was at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EnergyKind {
    /// Energy at a moment.
    Stored,
    /// Energy lost since the start.
    Lost,
    /// Work done on the bodies since the start.
    Work,
    /// Energy of bodies that were added, less that of those removed.
    Brought,
}

impl EnergyKind {
    /// 1 for what is stored or lost, -1 for what is supplied.
    pub fn sign(self) -> f64 {
        match self {
            Self::Stored | Self::Lost => 1.0,
            Self::Work | Self::Brought => -1.0,
        }
    }
}

/// A term of the balance.
#[derive(Debug, Clone, Copy)]
pub struct Energy {
    /// Its column in the time series.
    pub name: &'static str,
    /// How it enters the balance.
    pub kind: EnergyKind,
    /// Its value, J.
    pub of: fn(&Balance) -> f64,
}

/// All terms, in the order of the columns of the time series: their signed sum changes by the
/// energy error alone.
pub const ENERGIES: [Energy; 20] = [
    energy("kinetic_energy_j", Stored, |balance| balance.kinetic_j),
    energy("elastic_energy_j", Stored, Balance::elastic_j),
    energy("gravity_energy_j", Stored, |balance| balance.gravity_j),
    energy("load_work_j", Work, |balance| balance.load_work_j),
    energy("support_work_j", Work, |balance| balance.support_work_j),
    energy("wall_work_j", Work, |balance| balance.wall_work_j),
    energy("bond_damping_j", Lost, |balance| balance.bond_damping_j),
    energy("structural_damping_j", Lost, |balance| {
        balance.structural_damping_j
    }),
    energy("local_damping_j", Lost, |balance| balance.local_damping_j),
    energy("adhesion_j", Stored, |balance| balance.adhesion_j),
    energy("contact_damping_j", Lost, |balance| {
        balance.contact_damping_j
    }),
    energy("friction_j", Lost, |balance| balance.friction_j),
    energy("bond_breakage_j", Lost, |balance| balance.bond_breakage_j),
    energy("bond_damage_j", Lost, |balance| balance.bond_damage_j),
    energy("particle_breakage_j", Lost, |balance| {
        balance.particle_breakage_j
    }),
    energy("bond_plastic_j", Lost, |balance| balance.bond_plastic_j),
    energy("liquid_bridge_j", Stored, |balance| balance.liquid_bridge_j),
    energy("liquid_bridge_loss_j", Lost, |balance| {
        balance.liquid_bridge_loss_j
    }),
    energy("rejoining_loss_j", Lost, |balance| balance.rejoining_loss_j),
    energy("flow_energy_j", Brought, |balance| balance.flow_energy_j),
];

const fn energy(name: &'static str, kind: EnergyKind, of: fn(&Balance) -> f64) -> Energy {
    Energy { name, kind, of }
}
