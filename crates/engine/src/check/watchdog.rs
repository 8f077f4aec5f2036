//! Stops a run that goes unstable.

use dem_io::{Diagnostic, Result};

use crate::stages::bonds::energy_kernel::elastic_energy;
use crate::stages::contacts::forces::contact_energy_j;
use crate::stages::ledger::totals::kinetic_energy;
use crate::stages::motion::loads::loads_power_w;
use crate::state::State;
use crate::state::bodies::PlacedBody;
use crate::state::bodies::bond_of_file;
use dem_physics::bond::pair::frequencies;
use dem_results::Balance;

/// Largest spurious energy for a step above the limit, relative to the energy supplied: there it
/// comes from a local mode that grows until it saturates, small compared with a large body.
const BEYOND_LIMIT: f64 = 1e-4;
/// Fraction of the effective radius down to which overlaps are relaxed, above which pairs that
/// become ordinary add energy that matters.
const USUAL_LEAST_OVERLAP: f64 = 1e-3;
/// Interval between checks of the kinetic energy, in steps.
const EVERY: u64 = 64;

/// Monitors the energy of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Watchdog {
    fraction_of_limit: f64,
    /// Largest spurious energy, relative to the energy supplied.
    allowed: f64,
}

impl Watchdog {
    /// For a run whose step is this fraction of the limit.
    ///
    /// Leapfrog below the limit conserves an energy close to the true one; for the fastest mode the
    /// two differ by a factor of up to 1/(1 - fraction^2). Twice that is allowed.
    pub fn new(fraction_of_limit: f64) -> Self {
        let square = fraction_of_limit * fraction_of_limit;
        Self {
            fraction_of_limit,
            allowed: if square < 1.0 {
                2.0 / (1.0 - square)
            } else {
                BEYOND_LIMIT
            },
        }
    }

    /// Whether the kinetic energy calls for a check of the ledger. Cheap; called after every kick.
    pub fn is_due(&self, state: &State) -> bool {
        if !state.steps.is_multiple_of(EVERY) {
            return false;
        }
        let p = &state.particles;
        let kinetic = kinetic_energy(p, |i| p.motions[i]) + state.clumps.kinetic_j();
        // Also true for NaN.
        let quiet = kinetic
            <= (1.0 + self.allowed)
                * state
                    .ledger
                    .energy_supplied_j(state.model.gravity_m_s2, &state.walls);
        !quiet
    }

    /// Checks the ledger; refuses NaN, and more spurious energy than that of a stable run.
    pub fn look(&self, state: &State, balance: &Balance, bodies: &[PlacedBody]) -> Result<()> {
        // A load that has just begun has moved nothing yet: its work in the next half step counts
        // as well.
        let power_w = loads_power_w(
            &state.loads,
            state.time_s,
            state.steps_s(),
            &state.particles.motions,
        );
        let coming = 0.5 * state.time_step_s * power_w.abs();
        let put_in = state
            .ledger
            .energy_supplied_j(state.model.gravity_m_s2, &state.walls)
            + coming;
        if balance.energy_error_j <= self.allowed * put_in {
            return Ok(());
        }
        Err(unstable(state, balance, self.fraction_of_limit, bodies))
    }
}

fn unstable(
    state: &State,
    balance: &Balance,
    fraction_of_limit: f64,
    bodies: &[PlacedBody],
) -> Diagnostic {
    let mut problem = format!(
        "unstable at step {}, {:.6e} s: {:.3e} J of energy were created; the time step is {:.4e} s and began at {:.3} of the largest stable one",
        state.steps, state.time_s, balance.energy_error_j, state.time_step_s, fraction_of_limit
    );
    let contact = contact_culprit(state);
    let unrelaxed = relaxation_remedy(state).filter(|_| contact.is_some());
    if let Some(contact) = contact {
        problem += &contact;
    } else if let Some((at, own_step_s)) = culprit(state) {
        let [a, b] = state.bonds.ends[at];
        let places = [a, b].map(|end| state.particles.poses[end as usize].place());
        let middle = 0.5 * (places[0] + places[1]);
        let where_ = if middle.iter().all(|x| x.is_finite()) {
            format!(
                " at ({:.4e}, {:.4e}, {:.4e}) m",
                middle.x, middle.y, middle.z
            )
        } else {
            String::new()
        };
        let which = bond_of_file(bodies, at).map_or(String::new(), |(body, number)| {
            format!(" {number} of body '{}'", body.name)
        });
        problem += &format!(
            "; most of it in bond{which}{where_}, whose two particles alone, undamped, could take a step of {own_step_s:.4e} s"
        );
    }
    let remedy = if let Some(remedy) = unrelaxed {
        remedy
    } else if fraction_of_limit > 1.0 {
        "take a smaller run.time_step, or \"auto\" for one below the limit"
    } else {
        "take a smaller run.safety_factor or run.time_step; or check loads and motions, if they are so large that the limit falls faster than it is looked for"
    };
    Diagnostic::unstable("", problem, remedy)
}

/// What to do against spurious energy, where it comes from fragments that overlap as they part: no
/// smaller time step removes it. None: no bond has broken, or such overlaps are relaxed.
pub fn relaxation_remedy(state: &State) -> Option<&'static str> {
    let model = &state
        .contacts
        .as_ref()
        .filter(|_| state.broken_count > 0)?
        .model;
    if !model.relaxes {
        return Some(
            "set relaxation.enabled = true: without it, fragments that separate while they overlap are pushed apart with spurious energy",
        );
    }
    (model.least_overlap > USUAL_LEAST_OVERLAP).then_some(
        "set a smaller relaxation.min_overlap, such as 1e-5: the contact force that pairs get at once where their overlap falls below it adds energy, which no smaller time step removes",
    )
}

/// Description of the contact with the largest energy, if contacts hold more than bonds.
fn contact_culprit(state: &State) -> Option<String> {
    let contacts = state.contacts.as_ref()?;
    let p = &state.particles;
    let energy = |at: usize| contact_energy_j(contacts, p, at);
    let at = (0..contacts.pairs.len()).max_by(|&a, &b| energy(a).total_cmp(&energy(b)));
    let of_pairs: f64 = (0..contacts.pairs.len()).map(energy).sum();
    let walls = state.walls.iter();
    let wall = walls.max_by(|a, b| {
        let [a, b] = [a, b].map(|wall| wall.scratch.elastic_j);
        a.total_cmp(&b)
    });
    let of_walls: f64 = state.walls.iter().map(|wall| wall.scratch.elastic_j).sum();
    if of_pairs + of_walls <= elastic_energy(state).total() {
        return None;
    }
    if let Some(wall) = wall.filter(|_| of_walls > of_pairs) {
        return Some(format!(
            "; most of it in contacts with the wall '{}'",
            wall.model.name
        ));
    }
    let [x, y, z, _] = p.poses[contacts.pairs[at?][0] as usize].position_m;
    Some(format!(
        "; most of it in contacts of particles, above all at ({x:.4e}, {y:.4e}, {z:.4e}) m"
    ))
}

/// The bond with the largest energy and the critical step of its two particles alone, s. If
/// energies are NaN: the bond with the smallest step.
fn culprit(state: &State) -> Option<(usize, f64)> {
    let own_step = |at: usize| {
        let ends = state.bonds.ends[at].map(|end| end as usize);
        let p = &state.particles;
        frequencies(
            &state.bonds.undamaged_stiffness(at),
            ends.map(|end| p.motions[end].inverse_mass),
            ends.map(|end| p.motions[end].inverse_inertia),
        )
        .critical_step_s()
    };
    let mut worst: Option<(usize, f64, f64)> = None;
    for at in (0..state.bonds.len()).filter(|&at| !state.bonds.is_broken(at)) {
        let energy = state
            .bonds
            .forces(at, &state.particles.poses)
            .energy
            .total();
        let (energy, step) = (
            if energy.is_finite() {
                energy
            } else {
                f64::INFINITY
            },
            own_step(at),
        );
        let is_worse = worst.is_none_or(|(_, e, s)| energy > e || (energy == e && step < s));
        if is_worse {
            worst = Some((at, energy, step));
        }
    }
    worst.map(|(at, _, step)| (at, step))
}
