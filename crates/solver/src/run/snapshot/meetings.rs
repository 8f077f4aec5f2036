//! What a checkpoint holds of clusters, contacts and walls.

use dem_io::{Diagnostic, Result};
use serde::{Deserialize, Serialize};

use crate::geometry::Frame;
use crate::stages::sleep::count_sleepers;
use crate::state::State;
use crate::state::clusters::{Cluster, Clusters};
use crate::state::contacts::ContactHistory;
use crate::state::sleep::{ClusterSleep, Sleep};
use crate::state::walls::{Push, Wall, WallContact};

/// Clusters, contacts and walls of a state between two steps.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Meetings {
    /// Cluster of each particle, all clusters, bonds broken since the last search.
    clusters: Option<(Vec<u32>, Vec<Cluster>, Vec<u32>)>,
    fastest_m_s: f64,
    /// All listed pairs, in order, and what they remember: one that has come to touch in the last
    /// step remembers nothing yet, but it was listed.
    contacts: Vec<([u32; 2], ContactHistory)>,
    /// Energy that friction and damping took, booked at each particle, J.
    lost_j: Vec<[f64; 2]>,
    walls: Vec<WallState>,
    /// None: nobody can sleep.
    sleep: Option<SleepState>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SleepState {
    of_cluster: Vec<ClusterSleep>,
    particle_steps: [u64; 2],
    skin_left_m: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct WallState {
    frame: Frame,
    velocities_m_s: [[f64; 3]; 2],
    spins_rad_s: [[f64; 3]; 2],
    touching: Vec<WallContact>,
    push: Push,
    stiffness_n_m: f64,
    friction_j: f64,
    damping_j: f64,
    work_j: f64,
    pending_j: f64,
}

impl Meetings {
    pub(super) fn taken(state: &State) -> Self {
        let remembered = state.contacts.iter().flat_map(|contacts| {
            let pairs = contacts.pairs.iter().copied();
            pairs.zip(contacts.histories.iter().copied())
        });
        let kept = state.sleep.iter().flat_map(|sleep| &sleep.pairs);
        let kept = kept.map(|kept| (kept.pair, kept.history));
        let mut remembered: Vec<([u32; 2], ContactHistory)> = remembered.chain(kept).collect();
        remembered.sort_by_key(|(pair, _)| *pair);
        Self {
            clusters: state.clusters.as_ref().map(|clusters| {
                let (of_particle, history) = (&clusters.of_particle, &clusters.history);
                (
                    of_particle.clone(),
                    history.clone(),
                    state.unsearched.clone(),
                )
            }),
            fastest_m_s: state.fastest_m_s,
            contacts: remembered,
            lost_j: (state.contacts.as_ref()).map_or(Vec::new(), |c| c.lost_j.clone()),
            walls: (state.walls.iter().enumerate())
                .map(|(n, wall)| WallState {
                    frame: wall.frame,
                    velocities_m_s: wall.velocities_m_s,
                    spins_rad_s: wall.spins_rad_s,
                    touching: touching(wall, n, state.sleep.as_ref()),
                    push: wall.push,
                    stiffness_n_m: wall.stiffness_n_m,
                    friction_j: wall.friction_j,
                    damping_j: wall.damping_j,
                    work_j: wall.work_j,
                    pending_j: wall.pending_j,
                })
                .collect(),
            sleep: state.sleep.as_ref().map(|sleep| SleepState {
                of_cluster: sleep.of_cluster.clone(),
                particle_steps: sleep.particle_steps,
                skin_left_m: state.contacts.as_ref().map_or(-1.0, |c| c.skin_left_m),
            }),
        }
    }

    /// Puts a state that has been planned from the same scene where the run stood.
    ///
    /// # Errors
    /// The scene has other clusters, contacts or walls.
    pub(super) fn restore(&self, state: &mut State) -> Result<()> {
        if self.clusters.is_some() != state.clusters.is_some()
            || self.sleep.is_some() != state.sleep.is_some()
            || self.walls.len() != state.walls.len()
            || self.lost_j.len() != state.contacts.as_ref().map_or(0, |c| c.lost_j.len())
        {
            return Err(foreign());
        }
        if let Some((of_particle, history, unsearched)) = &self.clusters {
            let resumed = Clusters::resumed(of_particle.clone(), history.clone(), &state.bonds);
            state.clusters = Some(resumed.ok_or_else(foreign)?);
            state.unsearched.clone_from(unsearched);
        }
        state.fastest_m_s = self.fastest_m_s;
        if let Some(contacts) = &mut state.contacts {
            // The next step lists what is near again, and keeps what these remember.
            (contacts.pairs, contacts.histories) = self.contacts.iter().copied().unzip();
            contacts.lost_j.clone_from(&self.lost_j);
            contacts.skin_left_m = -1.0;
        }
        for (wall, saved) in state.walls.iter_mut().zip(&self.walls) {
            wall.frame = saved.frame;
            wall.velocities_m_s = saved.velocities_m_s;
            wall.spins_rad_s = saved.spins_rad_s;
            wall.touching.clone_from(&saved.touching);
            wall.push = saved.push;
            wall.stiffness_n_m = saved.stiffness_n_m;
            wall.friction_j = saved.friction_j;
            wall.damping_j = saved.damping_j;
            wall.work_j = saved.work_j;
            wall.pending_j = saved.pending_j;
        }
        if let (Some(sleep), Some(saved)) = (&mut state.sleep, &self.sleep) {
            sleep.of_cluster.clone_from(&saved.of_cluster);
            sleep.particle_steps = saved.particle_steps;
            sleep.is_resumed = true;
            if let Some(contacts) = &mut state.contacts {
                contacts.skin_left_m = saved.skin_left_m;
            }
            count_sleepers(state);
        }
        Ok(())
    }
}

/// What touches a wall, be it awake or asleep.
fn touching(wall: &Wall, n: usize, sleep: Option<&Sleep>) -> Vec<WallContact> {
    let kept = sleep.into_iter().flat_map(|sleep| &sleep.touches);
    let kept = kept.filter(|kept| kept.wall == n).map(|kept| kept.touch);
    let mut all: Vec<WallContact> = wall.touching.iter().copied().chain(kept).collect();
    all.sort_by_key(|touch| touch.particle);
    all
}

fn foreign() -> Diagnostic {
    Diagnostic::input(
        "",
        "this checkpoint belongs to a run with other clusters, contacts or walls than the scene has now",
        "give the scene and the bodies that the run began with, or start again without --resume",
    )
}
