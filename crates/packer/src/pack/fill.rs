//! Fourth act: the voids of a settled packing are filled, as far as the sizes allow.

use super::job::Job;
use super::settings::Progress;
use crate::front::{Assembly, first_draw};
use crate::spheres::ReducedSphere;
use dem_io::Result;

/// Spheres around which voids are searched at a time.
const VOID_SEARCH_GROUP: usize = 2000;

/// The history of this act.
#[derive(Debug, Default)]
pub(super) struct FillHistory {
    /// Spheres put into voids.
    pub(super) fillers: usize,
    /// Voids that would still take the smallest sphere, about.
    pub(super) voids_left: usize,
}

/// Puts spheres into the voids that take at least the smallest one, unless the front has filled
/// them already (`is_filled`): each of a size drawn among those that fit there, as long as their
/// number does not distort the distribution of sizes by more than a tenth of its statistical noise.
///
/// # Errors
/// What `progress` returns.
pub(super) fn fill(
    job: &Job,
    is_filled: bool,
    spheres: &mut Vec<ReducedSphere>,
    progress: Progress,
) -> Result<FillHistory> {
    if is_filled {
        return Ok(FillHistory::default());
    }
    progress("filling voids", 0.0)?;
    let assembly = || job.assembly(1.0, 1.0, spheres.len());
    let count = spheres.len();
    let radii = job.radius_range();
    let most = if radii[0] == radii[1] {
        usize::MAX
    } else {
        (0.1 * 1.36 * (count as f64).sqrt()).ceil() as usize
    };
    let mut filling = Filling {
        assembly: with_spheres(assembly(), spheres),
        seed: job.settings.seed ^ 0x5eed,
        most,
        fillers: 0,
    };
    // Neighbours in memory are neighbours in space: the search goes round in strides, so that what
    // it finds first is spread evenly.
    let groups = count.div_ceil(VOID_SEARCH_GROUP);
    for group in 0..groups {
        let around: Vec<u32> = (group..count).step_by(groups).map(|i| i as u32).collect();
        filling.fill_around(around);
        if filling.fillers == most {
            break;
        }
    }
    let voids_left = if filling.fillers == most {
        with_spheres(assembly(), &filling.assembly.spheres).count_all_voids()
    } else {
        0
    };
    let fillers = filling.fillers;
    *spheres = filling.assembly.spheres;
    Ok(FillHistory {
        fillers,
        voids_left,
    })
}

fn with_spheres<'a>(mut assembly: Assembly<'a>, spheres: &[ReducedSphere]) -> Assembly<'a> {
    spheres.iter().for_each(|sphere| assembly.add(*sphere));
    assembly
}

/// Voids being filled.
struct Filling<'a> {
    assembly: Assembly<'a>,
    /// Seed of the random numbers: each sphere has a stream of its own.
    seed: u64,
    /// Spheres put into voids at most.
    most: usize,
    /// Spheres put into voids.
    fillers: usize,
}

impl Filling<'_> {
    /// Searches around the spheres `around` (indices) and then around those that were added.
    fn fill_around(&mut self, mut around: Vec<u32>) {
        let smallest = self.assembly.settings.radius_range[0];
        while !around.is_empty() {
            let first = self.assembly.spheres.len() as u32;
            for void in self.assembly.voids(&around) {
                if self.fillers < self.most && self.assembly.fits(&void, smallest) {
                    let drawn = first_draw(self.seed, self.fillers as u64);
                    let (centre, radius) = self.assembly.roomy_place(&void, drawn);
                    self.assembly.add(self.assembly.sphere(&centre, radius));
                    self.fillers += 1;
                }
            }
            around = (first..self.assembly.spheres.len() as u32).collect();
        }
    }
}
