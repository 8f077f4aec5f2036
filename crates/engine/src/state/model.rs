//! Data fixed by the plan: no step changes them.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::bonds::BondRule;
use super::clumps::Template;
use super::contacts::ContactModel;
use super::rules::Rules;
use super::sleep::SleepRule;
use super::walls::WallModel;

/// A body of the scene.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NamedBody {
    /// Its name.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Size of the smallest sieve opening that it passes, m: see
    /// [`super::clusters::sizes::FragmentSize::sieve_m`].
    pub sieve_m: f64,
    /// Diameter of its smallest sphere, m: no fragment of it is smaller.
    pub smallest_diameter_m: f64,
    /// Mean diameter of its spheres, by mass, m; 0 for a body of one sphere, or one that stays
    /// rigid.
    pub mean_diameter_m: f64,
    /// Mass fraction of its spheres that are smaller than a tenth of its size: t10 cannot be
    /// larger.
    pub fine_fraction: f64,
}

/// Data fixed by the plan: no step changes them.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Model {
    /// All bodies of the scene, also those that inlets feed, in the order of their names.
    pub bodies: Vec<NamedBody>,
    /// m/s2. Length 3.
    pub gravity_m_s2: [f64; 3],
    /// gamma of Chen et al. 2022, eqs. 11 and 12. 0: none.
    pub particle_damping: f64,
    /// Bond rules, in the order of their names.
    pub bond_rules: Arc<[BondRule]>,
    /// Contact model of the particles. None: nothing can touch.
    pub contacts: Option<Arc<ContactModel>>,
    /// Walls, in the order of their names.
    pub walls: Vec<Arc<WallModel>>,
    /// Shapes of clumps.
    pub templates: Vec<Arc<Template>>,
    /// Ball radius that determines the outer spheres of clumps, m: see
    /// [`dem_physics::shape::outer_layer::outer_layer`].
    pub ball_m: f64,
    /// Rules for adding, removing and replacing bodies.
    pub rules: Rules,
    /// Rule by which bodies fall asleep. None: they never do.
    pub sleep: Option<SleepRule>,
}

impl Model {
    /// Number of the body with this name in [`Model::bodies`]; 0 if there is none.
    pub fn body_number(&self, name: &str) -> u32 {
        let found = (self.bodies).binary_search_by(|body| body.name.as_str().cmp(name));
        found.unwrap_or(0) as u32
    }

    /// Name of the body with this number in [`Model::bodies`].
    pub fn body_name(&self, number: u32) -> &str {
        let body = self.bodies.get(number as usize);
        body.map_or("", |body| body.name.as_str())
    }

    /// Name of the material of the body with this number.
    pub fn material_name(&self, number: u32) -> &str {
        let body = self.bodies.get(number as usize);
        body.map_or("", |body| body.material.as_str())
    }
}
