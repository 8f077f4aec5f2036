//! The particles and bonds of a frame, for other programs.

/// The particles and bonds of a frame of any run. SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StoredParticles {
    /// Simulated time, s.
    pub time_s: f64,
    /// Names of the bodies of the scene.
    pub body_names: Vec<String>,
    /// Body of each particle: number in `body_names`.
    pub bodies: Vec<u32>,
    /// The number of each particle that follows it through the run.
    pub ids: Vec<u32>,
    /// Centre of each particle, m.
    pub positions: Vec<[f64; 3]>,
    /// Radius of each particle, m.
    pub radii: Vec<f64>,
    /// Velocity of each particle, m/s.
    pub velocities_m_s: Vec<[f64; 3]>,
    /// Fragment of each particle. None: nothing can break in this run.
    pub fragments: Option<Vec<u32>>,
    /// The two particles of each bond.
    pub bonds: Vec<[u32; 2]>,
    /// Radius of each bond, m.
    pub bond_radii: Vec<f64>,
    /// For each bond, true if it is broken.
    pub broken: Vec<bool>,
}
