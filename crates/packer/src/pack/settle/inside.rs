//! Which spheres are inside the solid once they have settled. Few rays are needed: a sphere is on
//! the side of its neighbours if no wall can be between them.

use super::neighbours::{NeighbourLists, squared_distance};
use super::walls::WallLists;
use crate::geometry::boundary::Boundary;
use crate::geometry::inside::is_inside;
use crate::spheres::{ReducedSphere, centre_of};
use rayon::prelude::*;

/// True for each sphere whose centre is inside.
pub(super) fn find_inside(
    boundary: &Boundary,
    spheres: &[ReducedSphere],
    near: &NeighbourLists,
    walls: &WallLists,
) -> Vec<bool> {
    let at_wall = walls.clearances(spheres);
    let of_ray = |i: usize| is_inside(boundary, &centre_of(&spheres[i]));
    let mut inside: Vec<Option<bool>> = vec![None; spheres.len()];
    let mut to_visit = Vec::new();
    for first in 0..spheres.len() {
        if at_wall[first].is_near || inside[first].is_some() {
            continue;
        }
        inside[first] = Some(of_ray(first));
        to_visit.push(first);
        while let Some(i) = to_visit.pop() {
            for j in near.of(i) {
                let j = *j as usize;
                // The line between two centres lies in the two balls that no wall enters.
                let clear = at_wall[i].distance + at_wall[j].distance;
                if inside[j].is_none() && squared_distance(&spheres[i], &spheres[j]) < clear * clear
                {
                    inside[j] = inside[i];
                    to_visit.push(j);
                }
            }
        }
    }
    let or_by_ray = |(i, inside): (usize, Option<bool>)| inside.unwrap_or_else(|| of_ray(i));
    inside.into_par_iter().enumerate().map(or_by_ray).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::surface_in_mm;
    use rand::{RngExt, SeedableRng};

    /// Spheres inside and outside a ring, and a ball with a cavity beside another ball, some of
    /// them on the wall, before and after they have moved by up to the skin.
    #[test]
    fn spheres_are_on_the_side_that_a_ray_finds() -> dem_io::Result<()> {
        const SKIN: f64 = 0.03;
        let mut random = rand::rngs::ChaCha8Rng::seed_from_u64(7);
        for stl in [
            &include_bytes!("../../../../../data/shapes/torus.stl")[..],
            &include_bytes!("../../../../../data/shapes/hollow-pair.stl")[..],
        ] {
            let surface = surface_in_mm(stl)?;
            let boundary = Boundary::new(&surface)?;
            let extent = surface.extent();
            let mut sphere = |_| {
                let [x, y, z] = extent.map(|most| random.random_range(-0.1..most + 0.1));
                [x, y, z, 0.03]
            };
            let mut spheres: Vec<ReducedSphere> = (0..20_000).map(&mut sphere).collect();
            let walls = WallLists::new(&boundary, &spheres, 1.0, SKIN);
            for moved in [false, true] {
                if moved {
                    for sphere in &mut spheres {
                        sphere[0] += SKIN * random.random_range(-1.0..1.0);
                    }
                }
                let near = NeighbourLists::new(&spheres, SKIN);
                let inside = find_inside(&boundary, &spheres, &near, &walls);
                let is_wrong = |(sphere, inside): &(&ReducedSphere, &bool)| {
                    is_inside(&boundary, &centre_of(sphere)) != **inside
                };
                assert_eq!(spheres.iter().zip(&inside).filter(is_wrong).count(), 0);
                // Of both kinds, and most are not near the wall.
                let number_inside = inside.iter().filter(|inside| **inside).count();
                assert!((400..19_600).contains(&number_inside), "{number_inside}");
                let clearances = walls.clearances(&spheres);
                let far = clearances.iter().filter(|wall| !wall.is_near).count();
                assert!(far > 10_000, "{far}");
            }
        }
        Ok(())
    }
}
