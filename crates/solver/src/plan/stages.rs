//! What a step of a scene consists of, and what it leaves out and why.

use dem_io::scene::Scene;
use dem_io::units::significant;

use crate::clock::Stage;
use crate::state::State;
use crate::state::memory::bytes;

/// A stage of the step: done or left out, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedStage {
    /// Which.
    pub stage: Stage,
    /// Whether the scene needs it.
    pub needed: bool,
    /// Why, or why not.
    pub why: String,
    /// Bytes of the arrays that it alone needs, at the start.
    pub bytes: usize,
}

/// What a step consists of, and what is left out.
pub(super) fn stages(state: &State, scene: &Scene) -> Vec<PlannedStage> {
    let templates = &state.clumps.templates;
    let of_clumps: usize = templates.iter().map(|t| t.bonds.len()).sum();
    let can_bond = !state.rules.triggers.iter().all(Option::is_none)
        || state.rules.starts.iter().any(|start| start.bonded);
    let bonds = state.bonds.len() + if can_bond { of_clumps } else { 0 };
    let by_inlets = !state.rules.inlets.is_empty();
    let rules = &state.bonds.rules;
    let any = |of: &dyn Fn(&crate::state::bonds::BondRule) -> bool| rules.iter().any(of);
    let stage = |stage, needed, yes: String, no: &str| PlannedStage {
        stage,
        needed,
        why: if needed { yes } else { no.to_owned() },
        bytes: bytes(state, stage),
    };
    let contacts = state.contacts.as_ref();
    let pieces = state.clusters.as_ref().map_or(0, |c| c.living().count());
    let breaks = any(&|rule| rule.criteria.is_some()) && bonds > 0;
    let meets = contacts.is_some_and(|contacts| !contacts.alone);
    let rolls = scene
        .contacts
        .iter()
        .any(|c| c.rolling != dem_io::scene::Rolling::None);
    let scattered = !state.bonds.strength_factors.is_empty()
        || (can_bond && templates.iter().any(|t| t.scatter.is_some()));
    let spheres: usize = templates.iter().map(|t| t.spheres.len()).sum();
    let outer: usize = templates.iter().map(|t| t.outer.len()).sum();
    let damped = any(&|rule| rule.damped) && bonds > 0;
    vec![
        stage(
            Stage::Bonds,
            bonds > 0,
            if of_clumps > 0 {
                format!(
                    "{} bonds at the start; those of a clump, once it is replaced",
                    state.bonds.len()
                )
            } else {
                format!("{bonds} bonds")
            },
            if of_clumps > 0 {
                "clumps are never replaced"
            } else {
                "no body has bonds"
            },
        ),
        stage(
            Stage::Clumps,
            !templates.is_empty(),
            format!(
                "{} at the start; of the {spheres} spheres of {} the {outer} outer ones",
                state.clumps.all.len(),
                match templates.len() {
                    1 => "one shape".to_owned(),
                    shapes => format!("{shapes} shapes"),
                }
            ),
            "no body starts as a clump",
        ),
        stage(
            Stage::Replacement,
            state.rules.triggers.iter().any(Option::is_some),
            "clumps become bonded clusters".to_owned(),
            "no clump can become a cluster",
        ),
        stage(
            Stage::Population,
            by_inlets || !state.rules.outlets.is_empty(),
            format!(
                "{} and {}",
                state.rules.inlets.len(),
                state.rules.outlets.len()
            ),
            "no body comes or goes",
        ),
        stage(
            Stage::Histories,
            any(&|rule| rule.incremental) && bonds > 0,
            "bonds of the incremental formulation".to_owned(),
            "every bond has the total formulation",
        ),
        stage(
            Stage::Failure,
            any(&|rule| rule.criteria.is_some()),
            "bonds have strengths".to_owned(),
            "no bond has a strength",
        ),
        stage(
            Stage::Rates,
            any(&|rule| rule.strengthening_from_1_s.is_some()),
            "only for bonds that would break without it".to_owned(),
            "no rate strengthening asked for",
        ),
        stage(
            Stage::Scatter,
            scattered,
            "a factor for each bond".to_owned(),
            "no Weibull modulus given",
        ),
        stage(
            Stage::Clusters,
            state.clusters.is_some() && breaks,
            format!(
                "every {} steps, if bonds have broken",
                state.triggers.interval
            ),
            "no bond can break",
        ),
        stage(
            Stage::Search,
            contacts.is_some(),
            "when something may have come near".to_owned(),
            "nothing can touch",
        ),
        stage(
            Stage::Contacts,
            meets,
            format!("{pieces} pieces at the start"),
            if contacts.is_some() {
                "there is one body, and no bond can break"
            } else if breaks || pieces > 1 || scene.bodies.len() > 1 {
                "the scene has no [contacts]: bodies and pieces pass through each other"
            } else {
                "nothing can touch"
            },
        ),
        stage(
            Stage::Relaxation,
            meets && (contacts.is_some_and(|c| c.relaxes) && breaks),
            "overlaps of pieces that part are where their contact begins".to_owned(),
            if scene.relaxation.enabled {
                "no pieces part"
            } else {
                "switched off: pieces that part overlapping fly apart"
            },
        ),
        stage(
            Stage::Walls,
            !state.walls.is_empty(),
            format!("{}", state.walls.len()),
            "no walls",
        ),
        stage(
            Stage::Sleep,
            state.sleep.is_some(),
            state.sleep.as_ref().map_or(String::new(), |sleep| {
                format!(
                    "bodies slower than {} mm/s for {} ms are not stepped until something comes near",
                    significant(1e3 * sleep.speed_m_s, 4),
                    significant(1e3 * sleep.after_s, 4)
                )
            }),
            if scene.sleep.is_some() {
                "nothing can touch"
            } else {
                "not asked for"
            },
        ),
        stage(
            Stage::Rolling,
            contacts.is_some() && rolls,
            "materials have it".to_owned(),
            "no materials have it",
        ),
        stage(
            Stage::BondDamping,
            damped,
            "bonds are damped".to_owned(),
            "no bond is damped: no relative velocities",
        ),
        stage(
            Stage::ParticleDamping,
            state.particle_damping > 0.0,
            format!("gamma {}", state.particle_damping),
            "not asked for",
        ),
        stage(
            Stage::Loads,
            !state.loads.is_empty(),
            on_particles(state.loads.iter().map(|l| l.particles.len()).sum()),
            "no loads",
        ),
        stage(
            Stage::Supports,
            !state.supports.is_empty(),
            on_particles(state.supports.iter().map(|s| s.held.len()).sum()),
            "no supports",
        ),
        stage(
            Stage::Gravity,
            state.gravity_m_s2 != [0.0; 3],
            {
                let [x, y, z] = state.gravity_m_s2;
                format!("[{x}, {y}, {z}] m/s2")
            },
            "no gravity",
        ),
        stage(
            Stage::Motion,
            true,
            format!("{} particles at the start", state.particles.free),
            "",
        ),
        stage(Stage::EnergyLedger, true, "energy and momentum".to_owned(), ""),
        stage(
            Stage::Checks,
            true,
            "of energy, and of the limit of the step".to_owned(),
            "",
        ),
    ]
}

fn on_particles(count: usize) -> String {
    format!("on {count} particle{}", if count == 1 { "" } else { "s" })
}
