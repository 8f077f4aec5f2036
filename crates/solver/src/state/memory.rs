//! What the arrays of a state take, by the stage that needs them.

use std::mem::{size_of, size_of_val};

use super::State;
use super::clumps::{Clump, Template};
use crate::clock::Stage;

/// Bytes of the arrays that a stage alone needs, as they are filled now: 0 for a stage that the scene does not need.
pub fn bytes(state: &State, stage: Stage) -> usize {
    let (p, b) = (&state.particles, &state.bonds);
    match stage {
        Stage::Bonds => {
            let of_partitions = state
                .partitions
                .iter()
                .flat_map(|partition| &partition.batches);
            size_of_val(&b.ends[..])
                + size_of_val(&b.blocks[..])
                + of_partitions
                    .map(|batch| 4 * batch.which.listed())
                    .sum::<usize>()
        }
        Stage::Histories => size_of_val(&b.histories[..]),
        Stage::Scatter => size_of_val(&b.strength_factors[..]),
        Stage::BondDamping => size_of_val(&b.damping[..]) + size_of_val(&state.bond_resistance[..]),
        Stage::ParticleDamping => size_of_val(&state.particle_resistance[..]),
        Stage::Search => {
            let contacts = state.contacts.as_ref();
            let of_contacts = contacts.map_or(0, |c| {
                size_of_val(&c.pairs[..]) + size_of_val(&c.lost_j[..]) + c.materials.len()
            });
            of_contacts + clusters_for(state, stage)
        }
        Stage::Clusters => clusters_for(state, stage),
        Stage::Output => {
            let watched = state.watches.iter().map(|watch| watch.of.bytes());
            clusters_for(state, stage) + watched.sum::<usize>()
        }
        Stage::Contacts => state.contacts.as_ref().map_or(0, |c| {
            let of_partitions = c.partitions.iter().map(|partition| {
                size_of_val(&partition.border[..])
                    + size_of_val(&partition.border_histories[..])
                    + partition.was_close.len()
            });
            size_of_val(&c.histories[..]) + of_partitions.sum::<usize>()
        }),
        Stage::Walls => {
            let of_wall = |wall: &super::walls::Wall| {
                size_of_val(wall) + size_of_val(&wall.near[..]) + size_of_val(&wall.touching[..])
            };
            state.walls.iter().map(of_wall).sum()
        }
        Stage::Clumps => {
            let templates = state.clumps.templates.iter();
            clusters_for(state, stage)
                + size_of::<Clump>() * state.clumps.all.len()
                + size_of_val(&state.clumps.near[..])
                + templates.map(|template| template.bytes()).sum::<usize>()
        }
        Stage::Sleep => state.sleep.as_ref().map_or(0, |sleep| {
            size_of_val(&sleep.of_cluster[..])
                + size_of_val(&sleep.pairs[..])
                + size_of_val(&sleep.touches[..])
                + p.asleep.len()
        }),
        Stage::Loads => {
            let loads = state.loads.iter();
            loads.map(|load| size_of_val(&load.particles[..])).sum()
        }
        Stage::Supports => {
            let supports = state.supports.iter();
            supports.map(|support| size_of_val(&support.held[..])).sum()
        }
        Stage::Motion => {
            size_of_val(&p.poses[..]) + size_of_val(&p.motions[..]) + size_of_val(&p.wrenches[..])
        }
        // Limits of strengths stand with the kinds of bonds, relaxation and rolling within what a contact remembers.
        Stage::Failure
        | Stage::Rates
        | Stage::Relaxation
        | Stage::Rolling
        | Stage::Replacement
        | Stage::Population
        | Stage::Gravity
        | Stage::EnergyLedger
        | Stage::Checks => 0,
    }
}

/// Bytes of what is known of clusters, if it is this stage that needs it: the search for them where bonds can break; else what tells bodies apart that
/// can touch; else clumps, or measures that count pieces.
fn clusters_for(state: &State, stage: Stage) -> usize {
    let breaks = (state.bonds.rules.iter()).any(|rule| rule.criteria.is_some());
    let owner = match (breaks, &state.contacts) {
        (true, _) => Stage::Clusters,
        (false, Some(_)) => Stage::Search,
        (false, None) if !state.clumps.templates.is_empty() => Stage::Clumps,
        (false, None) => Stage::Output,
    };
    match &state.clusters {
        Some(clusters) if stage == owner => clusters.bytes(),
        _ => 0,
    }
}

impl Template {
    /// Bytes of its arrays.
    fn bytes(&self) -> usize {
        size_of_val(&self.spheres[..])
            + size_of_val(&self.outer[..])
            + size_of_val(&self.file_number[..])
            + size_of_val(&self.bonds_of_file[..])
            + size_of_val(&self.bonds.ends[..])
            + size_of_val(&self.bonds.blocks[..])
            + size_of_val(&self.bonds.damping[..])
            + size_of_val(&self.bonds.histories[..])
    }
}

/// What all arrays of a state take, bytes.
pub fn all_bytes(state: &State) -> usize {
    Stage::ALL.iter().map(|&stage| bytes(state, stage)).sum()
}
