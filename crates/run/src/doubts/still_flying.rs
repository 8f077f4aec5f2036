//! Fragments that still move apart at the end of a run, and what may break them further.

use std::collections::{BTreeMap, BTreeSet};

use dem_io::units::significant;

use dem_engine::check::flight::{Meeting, free_clusters};
use dem_engine::stages::contacts::touching::touching;
use dem_engine::state::State;
use dem_engine::state::clusters::Clusters;
use dem_engine::state::clusters::fragments::Fragment;

/// Fraction of the largest kinetic energy in the relative motion of fragments that shows that they
/// still move apart.
const FLYING: f64 = 0.05;
/// Fraction of the run in which hardly a bond has broken at its end that shows that breakage is
/// over.
pub(super) const QUIET: f64 = 0.2;

/// Fragments that still move apart.
pub(crate) struct Flying {
    /// The note or warning.
    pub(crate) text: String,
    /// Whether breakage may not be over: something that can break touches something, and bonds have
    /// broken not long ago. Otherwise what has been simulated is complete, and a later impact is
    /// another question.
    pub(crate) may_break: bool,
}

/// The fragments that still move apart, if some cluster can break and may meet something.
/// `largest_kinetic_j`: the largest kinetic energy of the run; `last_break_s`: when its last bond
/// broke; `goes_on`: whether more than a few broke in its last part, [`QUIET`].
pub(crate) fn still_flying(
    state: &State,
    fragments: &[Fragment],
    largest_kinetic_j: f64,
    last_break_s: f64,
    goes_on: bool,
) -> Option<Flying> {
    let clusters = state.clusters.as_ref()?;
    let pieces = pieces_by_body(clusters, fragments);
    let apart_j: f64 = pieces.values().map(|pieces| kinetic_apart_j(pieces)).sum();
    let fraction = apart_j / largest_kinetic_j;
    let breakable = breakable(state, clusters);
    let flies = fraction > FLYING;
    if !flies || breakable.is_empty() {
        return None;
    }
    let count: usize = pieces.values().map(Vec::len).sum();
    let seen = format!(
        "{count} fragments still moved apart at the end, with {} % of the largest kinetic energy of the run",
        significant(100.0 * fraction, 2)
    );
    let end = significant(state.time_s, 4);
    let touching = touching(state);
    let touches = |id: &u32| clusters.members(*id).iter().any(|i| touching.contains(i));
    if breakable.iter().any(touches) {
        let (quiet_s, enough_s) = (state.time_s - last_break_s, QUIET * state.time_s);
        let is_silent = quiet_s >= enough_s;
        if is_silent || !goes_on {
            let (how, for_s) = match is_silent {
                true => ("no bond has", quiet_s),
                false => ("few bonds have", enough_s),
            };
            let quiet = significant(for_s, 3);
            return Some(Flying {
                text: format!("{seen}; {how} broken for {quiet} s"),
                may_break: false,
            });
        }
        let text = format!(
            "{seen}, and what can still break touches something: it may break further; set run.end_time later than {end} s"
        );
        return Some(Flying {
            text,
            may_break: true,
        });
    }
    let outlook = outlook(state, clusters, &breakable)?;
    Some(Flying {
        text: format!("{seen}; nothing that can still break touches anything{outlook}"),
        may_break: false,
    })
}

/// Numbers of the clusters with a bond that can break.
fn breakable(state: &State, clusters: &Clusters) -> BTreeSet<u32> {
    let bonds = &state.bonds;
    let can_break =
        |at: &usize| bonds.rules[bonds.rule_of(*at)].criteria.is_some() && !bonds.is_broken(*at);
    let intact = (0..bonds.len()).filter(can_break);
    intact
        .map(|at| clusters.of_particle[bonds.ends[at][0] as usize])
        .collect()
}

/// When clusters will meet a wall in free flight, as the end of a sentence. None: they never meet
/// one.
fn outlook(state: &State, clusters: &Clusters, ids: &BTreeSet<u32>) -> Option<String> {
    // Between a kick and the drift after it.
    let ahead_s = 0.5 * state.time_step_s;
    let members: Vec<&[u32]> = ids.iter().map(|&id| clusters.members(id)).collect();
    let flying = free_clusters(state, &members, ahead_s);
    let meetings = flying
        .iter()
        .map(|one| one.first_meeting(&state.walls, &[]))
        .filter(|meeting| *meeting != Meeting::Never);
    let meetings: Vec<Meeting> = meetings.collect();
    if meetings.is_empty() {
        return None;
    }
    let mut times: Vec<(f64, &str)> = Vec::new();
    for meeting in &meetings {
        if let Meeting::At { after_s, wall, .. } = meeting {
            times.push((state.time_s + after_s, wall));
        }
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(match times[..] {
        [] => "; if later impacts matter, set run.end_time later".to_owned(),
        [(first_s, wall), ..] => {
            let last_s = times[times.len() - 1].0;
            format!(
                ": in free flight the first meets the wall '{wall}' at {} s, the last a wall at {} s; if later impacts matter, set run.end_time later than that",
                significant(first_s, 3),
                significant(last_s, 3)
            )
        }
    })
}

/// Fragments grouped by the cluster that they come from.
fn pieces_by_body<'a>(
    clusters: &Clusters,
    fragments: &'a [Fragment],
) -> BTreeMap<u32, Vec<&'a Fragment>> {
    let mut pieces: BTreeMap<u32, Vec<&Fragment>> = BTreeMap::new();
    for fragment in fragments
        .iter()
        .filter(|fragment| fragment.parent_id.is_some())
    {
        let mut root = fragment.fragment_id;
        while let Some(parent) = clusters.history[root as usize].parent {
            root = parent;
        }
        pieces.entry(root).or_default().push(fragment);
    }
    pieces
}

/// Kinetic energy of the motion of fragments relative to their common centre of mass, J.
fn kinetic_apart_j(fragments: &[&Fragment]) -> f64 {
    let (mut mass_kg, mut momentum, mut kinetic_j) = (0.0, [0.0; 3], 0.0);
    for fragment in fragments {
        mass_kg += fragment.mass_kg;
        for (sum, v) in momentum.iter_mut().zip(fragment.velocity_m_s) {
            *sum += fragment.mass_kg * v;
            kinetic_j += 0.5 * fragment.mass_kg * v * v;
        }
    }
    let of_all: f64 = momentum.iter().map(|p| 0.5 * p * p / mass_kg).sum();
    (kinetic_j - of_all).max(0.0)
}
