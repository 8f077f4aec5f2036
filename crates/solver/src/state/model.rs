//! What the plan fixed: no step changes it.

use std::sync::Arc;

use serde::Serialize;

use super::bonds::BondRule;
use super::clumps::Template;
use super::clusters::Triggers;
use super::contacts::ContactModel;
use super::rules::Rules;
use super::sleep::SleepRule;
use super::walls::WallModel;

/// What the plan fixed: no step changes it.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Model {
    /// m/s2. Length 3.
    pub gravity_m_s2: [f64; 3],
    /// gamma of Chen et al. 2022, eqs. 11 and 12. 0: none.
    pub particle_damping: f64,
    /// Kinds of bonds, in the order of their names.
    pub bond_rules: Arc<[BondRule]>,
    /// How particles meet. None: nothing can touch.
    pub contacts: Option<Arc<ContactModel>>,
    /// Walls, in the order of their names.
    pub walls: Vec<Arc<WallModel>>,
    /// Shapes of clumps.
    pub templates: Vec<Arc<Template>>,
    /// What the outer spheres of clumps are for, m: see [`crate::shape::outer_layer::outer_layer`].
    pub ball_m: f64,
    /// When bodies come, go, and become others.
    pub rules: Rules,
    /// When clusters are searched.
    pub search: Triggers,
    /// When bodies fall asleep. None: never.
    pub sleep: Option<SleepRule>,
}
