//! Fourth step: the voids of a settled packing are filled, as far as the sizes allow.

use super::job::Job;
use super::settings::Progress;
use crate::front::{Assembly, first_draw};
use crate::spheres::ReducedSphere;
use dem_io::Result;

/// Number of spheres around which voids are searched at a time.
const VOID_SEARCH_GROUP: usize = 2000;

/// History of this step.
#[derive(Debug, Default)]
pub(super) struct FillHistory {
    /// Number of spheres put into voids.
    pub(super) fillers: usize,
    /// Approximate number of voids that would still take the smallest sphere.
    pub(super) voids_left: usize,
}

/// Puts spheres into the voids that take at least the smallest one, unless the front has filled
/// them already (`is_filled`). Each size is drawn among those that fit there. Filling stops before
/// it distorts the size distribution by more than a tenth of its statistical noise.
///
/// # Errors
/// Errors of `progress`.
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
    // Neighbours in memory are neighbours in space: the search proceeds in strides, so that the
    // places found first are spread evenly.
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
    /// Largest number of spheres put into voids.
    most: usize,
    /// Number of spheres put into voids.
    fillers: usize,
}

impl Filling<'_> {
    /// Searches around the spheres `around` (indices) and then around the added ones.
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
