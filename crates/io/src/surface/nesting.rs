//! Which shells lie in which: an odd number of shells around one makes it the wall of a cavity.

use super::intersections::Intersections;
use super::mesh::mean;
use super::rays::Rays;
use super::sets::Sets;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// So many triangles of each shell are asked where they lie.
const SAMPLES: usize = 32;

/// How a shell stands to the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Lies in an odd number of others.
    pub(super) is_cavity: bool,
    /// The shell around a cavity; its own number for others.
    pub(super) outer_shell: u32,
}

/// Where the samples of a shell lie relative to another one.
#[derive(Default)]
struct Votes {
    inside: usize,
    on: usize,
}

/// How the shells lie in each other, and whether some overlap without a triangle going through
/// another (faces in one plane).
///
/// Shells that cross, overlap or touch from inside count as one around others, and do not lie in
/// each other. `parts` holds the triangles of each shell.
pub(super) fn find(
    rays: &Rays,
    parts: &[Range<u32>],
    crossings: &Intersections,
) -> (Vec<Place>, bool) {
    if parts.len() == 1 {
        return (
            vec![Place {
                is_cavity: false,
                outer_shell: 0,
            }],
            false,
        );
    }
    let mut groups = Sets::new(parts.len());
    crossings.shells.iter().for_each(|[a, b]| {
        groups.join(*a, *b, false);
    });
    let mut overlap = false;
    let mut containers: Vec<Vec<u32>> = Vec::with_capacity(parts.len());
    for (shell, triangles) in parts.iter().enumerate() {
        let mut around = Vec::new();
        let (samples, votes) = ask(rays, shell as u32, triangles.clone());
        for (other, votes) in votes {
            if votes.inside == samples {
                around.push(other);
            } else if votes.inside > 0 || votes.on == samples {
                groups.join(shell as u32, other, false);
                overlap = true;
            }
        }
        containers.push(around);
    }
    let group_of: Vec<u32> = (0..parts.len() as u32)
        .map(|shell| groups.find(shell).0)
        .collect();
    for (shell, around) in containers.iter_mut().enumerate() {
        around.retain(|other| group_of[*other as usize] != group_of[shell]);
    }
    let depth = |shell: usize| {
        containers[shell]
            .iter()
            .map(|other| group_of[*other as usize])
            .collect::<BTreeSet<_>>()
            .len()
    };
    // Shells of one group lie equally deep.
    let group_depth: Vec<usize> = group_of
        .iter()
        .map(|group| depth(*group as usize))
        .collect();
    let places = (0..parts.len()).map(|shell| {
        let is_cavity = group_depth[shell] % 2 == 1;
        let around = || containers[shell].iter().copied();
        let next_outer =
            around().find(|other| group_depth[*other as usize] + 1 == group_depth[shell]);
        let outer_shell = if is_cavity {
            next_outer.or(around().next())
        } else {
            None
        };
        Place {
            is_cavity: is_cavity && outer_shell.is_some(),
            outer_shell: outer_shell.unwrap_or(shell as u32),
        }
    });
    (places.collect(), overlap)
}

/// Number of samples of a shell that could tell, and where they lie relative to the others.
fn ask(rays: &Rays, shell: u32, triangles: Range<u32>) -> (usize, BTreeMap<u32, Votes>) {
    let mut votes: BTreeMap<u32, Votes> = BTreeMap::new();
    let mut samples = 0;
    let step = triangles.len().div_ceil(SAMPLES);
    for triangle in triangles.step_by(step) {
        let middle = mean(rays.mesh.corners(triangle));
        let Some(around) = rays.around(middle) else {
            continue;
        };
        samples += 1;
        around
            .inside
            .iter()
            .filter(|other| **other != shell)
            .for_each(|other| votes.entry(*other).or_default().inside += 1);
        around
            .on
            .iter()
            .filter(|other| **other != shell)
            .for_each(|other| votes.entry(*other).or_default().on += 1);
    }
    (samples, votes)
}
