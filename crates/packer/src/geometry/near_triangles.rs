//! The triangles of the wall near a place, eight at a time, and the walls that a ball meets among
//! them.

use super::boundary::Boundary;
use super::eight_triangles::{AT_ONCE, EightSurroundings, bits};
use super::nearest::Nearest;
use super::plane::Surroundings;
use crate::spheres::Vector3;
use pulp::{Arch, NullaryFnOnce};

/// Most walls that a ball meets.
const MOST: usize = 8;

/// The triangles of the wall near a place, nearest first.
pub struct NearTriangles(Vec<NearestFirst>);

/// A triangle by the lower bound of its distance, in single precision, and then by its number: the
/// bits of numbers that are not negative are in their order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct NearestFirst(u64);

/// What a search for walls finds, with its work arrays.
#[derive(Default)]
pub(crate) struct WallSearch {
    /// The walls, nearest first.
    pub(crate) found: Vec<Nearest>,
    /// The surroundings of the triangles in the order of their list.
    one_by_one: Vec<Surroundings>,
    /// The same for each eight.
    around: Vec<EightSurroundings>,
    /// Lower bounds of their distances from the ball's centre.
    least: Vec<[f64; AT_ONCE]>,
    /// Those that could be walls and were not examined yet: one bit each, for each eight.
    open: Vec<u8>,
}

impl NearestFirst {
    fn new((least, number): (f64, u32)) -> Self {
        let least = (least as f32).to_bits();
        Self(u64::from(least) << 32 | u64::from(number))
    }

    /// The lower bound, rounded down.
    #[inline(always)]
    fn least(self) -> f64 {
        f32::from_bits((self.0 >> 32) as u32).next_down().into()
    }

    fn number(self) -> u32 {
        self.0 as u32
    }
}

impl NearTriangles {
    /// The triangles that come within `reach` (local units) of a place, or could.
    pub(crate) fn new(boundary: &Boundary, place: &Vector3, reach: f64) -> Self {
        let bounds = boundary.bounds_near(place, reach).into_iter();
        let mut near: Vec<NearestFirst> = bounds.map(NearestFirst::new).collect();
        near.sort_unstable();
        near.shrink_to_fit();
        Self(near)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Their numbers, nearest first.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        self.0.iter().map(|triangle| triangle.number())
    }

    /// A lower bound of the distance of the wall from the place; none if there are no triangles.
    pub(crate) fn least_distance(&self) -> Option<f64> {
        Some(self.0.first()?.least())
    }

    /// The walls that a ball (centre, radius in local units) would meet, nearest first, 8 at most:
    /// the nearest points of triangles, except those behind the plane of a nearer wall. That plane
    /// is taken to be nearer to the centre by 3 %, so that a smooth curved surface is one wall.
    /// What is behind a wall that is left out is left out as well.
    ///
    /// `moved` is the distance of the centre from the place. The triangle `first` is measured
    /// before all others: many are then known to be hidden without being measured.
    pub(crate) fn walls(
        &self,
        boundary: &Boundary,
        (centre, radius): (&Vector3, f64),
        moved: f64,
        first: Option<u32>,
        search: &mut WallSearch,
    ) {
        Arch::new().dispatch(Walls {
            near: self,
            boundary,
            centre,
            radius,
            moved,
            first,
            search,
        });
    }

    /// After [`NearTriangles::walls`]: the triangles that could be within `reach` of the ball's
    /// centre. `reach` is at most the radius of the ball.
    pub(crate) fn within<'a>(
        &'a self,
        reach: f64,
        search: &'a WallSearch,
    ) -> impl Iterator<Item = u32> + 'a {
        let bounds = search.least.as_flattened();
        let within = move |(number, least): (u32, &f64)| (*least <= reach).then_some(number);
        self.numbers().zip(bounds).filter_map(within)
    }
}

/// A search for the walls that a ball meets.
struct Walls<'a> {
    near: &'a NearTriangles,
    boundary: &'a Boundary,
    centre: &'a Vector3,
    radius: f64,
    moved: f64,
    first: Option<u32>,
    search: &'a mut WallSearch,
}

impl NullaryFnOnce for Walls<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        self.search.found.clear();
        self.find_open();
        if let Some(first) = self.first {
            self.measure(first, 0);
        }
        for k in 0..self.search.open.len() {
            while self.search.open[k] != 0 {
                let open = self.search.open[k];
                self.search.open[k] &= open - 1;
                let number = self.near.0[AT_ONCE * k + open.trailing_zeros() as usize].number();
                if self.first != Some(number) {
                    self.measure(number, k);
                }
            }
        }
        self.leave_out_hidden();
    }
}

impl Walls<'_> {
    /// Finds the triangles that could be within the radius.
    #[inline(always)]
    fn find_open(&mut self) {
        let search = &mut *self.search;
        search.around.clear();
        search.least.clear();
        search.open.clear();
        let reach = self.radius + self.moved;
        let near = self.near.0.chunks(AT_ONCE);
        let listed = near.take_while(|eight| eight[0].least() < reach).count();
        let listed = &self.near.0[..(AT_ONCE * listed).min(self.near.0.len())];
        // All are read before the first is used: their cache lines are on their way together.
        let surroundings = |near: &NearestFirst| *self.boundary.surroundings(near.number());
        search.one_by_one.clear();
        search.one_by_one.extend(listed.iter().map(surroundings));
        let eights = search.one_by_one.chunks(AT_ONCE);
        for (triangles, eight) in listed.chunks(AT_ONCE).zip(eights) {
            let mut around = EightSurroundings::default();
            for (k, surroundings) in eight.iter().enumerate() {
                around.set(k, surroundings);
            }
            let least = around.least_distances(self.centre);
            let mut may_reach = [false; AT_ONCE];
            for (k, triangle) in triangles.iter().enumerate() {
                may_reach[k] = (triangle.least() < reach) & (least[k] < self.radius);
            }
            search.around.push(around);
            search.least.push(least);
            search.open.push(bits(&may_reach));
        }
        self.fetch_open();
    }

    /// Reads from the triangles that could be within the radius before the first is measured: their
    /// cache lines are on their way together.
    #[inline(always)]
    fn fetch_open(&self) {
        for (triangles, open) in self.near.0.chunks(AT_ONCE).zip(&self.search.open) {
            for (k, triangle) in triangles.iter().enumerate() {
                if open >> k & 1 == 1 {
                    self.boundary.fetch(triangle.number());
                }
            }
        }
    }

    /// Measures a triangle. If it is a wall, those that it hides, of the eight numbered `from` and
    /// of later ones, need not be examined.
    #[inline(always)]
    fn measure(&mut self, triangle: u32, from: usize) {
        let wall = self.boundary.nearest_on(triangle, self.centre);
        if wall.distance < self.radius && wall.distance > 0.0 {
            let WallSearch {
                found,
                around,
                least,
                open,
                ..
            } = &mut *self.search;
            found.push(wall);
            for k in from..open.len() {
                if open[k] != 0 {
                    open[k] &= !around[k].hidden_behind(&least[k], &wall, self.centre);
                }
            }
        }
    }

    /// Leaves out walls behind the planes of nearer ones.
    #[inline(always)]
    fn leave_out_hidden(&mut self) {
        let found = &mut self.search.found;
        found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut kept = 0;
        for k in 0..found.len() {
            let near = found[k];
            let from_centre = near.point - self.centre;
            let is_hidden = found[..kept]
                .iter()
                .any(|wall| wall.hides(self.centre, &from_centre));
            if !is_hidden {
                found[kept] = near;
                kept += 1;
            }
        }
        found.truncate(kept.min(MOST));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::boundary::AS_NEAR;
    use crate::geometry::surface_in_mm;
    use rand::{RngExt, SeedableRng};

    /// The same, one triangle after the other.
    fn walls_one_by_one(
        boundary: &Boundary,
        near: &NearTriangles,
        (centre, radius): (&Vector3, f64),
        first: Option<u32>,
    ) -> Vec<Nearest> {
        let mut found: Vec<Nearest> = Vec::new();
        let others = near.numbers().filter(|number| first != Some(*number));
        for number in first.into_iter().chain(others) {
            let around = boundary.surroundings(number);
            let least = around.least_distance(centre);
            let is_hidden = |wall: &Nearest| {
                least >= wall.distance
                    && around.is_past(centre, &wall.towards(centre), wall.hides_beyond())
            };
            if least < radius && !found.iter().any(is_hidden) {
                let wall = boundary.nearest_on(number, centre);
                found.extend((wall.distance < radius && wall.distance > 0.0).then_some(wall));
            }
        }
        found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut kept: Vec<Nearest> = Vec::new();
        for wall in found {
            let from_centre = wall.point - centre;
            if !kept.iter().any(|near| near.hides(centre, &from_centre)) {
                kept.push(wall);
            }
        }
        kept.truncate(MOST);
        kept
    }

    /// Walls are nearest points of triangles, nearest first, none behind the plane of another.
    fn assert_none_is_hidden(boundary: &Boundary, walls: &[Nearest], centre: &Vector3) {
        for (k, wall) in walls.iter().enumerate() {
            assert_eq!(*wall, boundary.nearest_on(wall.triangle, centre));
            let hides = |nearer: &Nearest| {
                let height = (nearer.point - centre).dot(&(wall.point - centre));
                height > 0.97 * nearer.distance * nearer.distance * (1.0 + 1e-12)
            };
            assert!(!walls[..k].iter().any(hides));
            assert!(k == 0 || walls[k - 1].distance <= wall.distance);
        }
    }

    #[test]
    fn the_same_walls_as_one_by_one() -> dem_io::Result<()> {
        let mut random = rand::rngs::ChaCha8Rng::seed_from_u64(8);
        let (mut several, mut hidden, mut most) = (0, 0, 0);
        for surface in [
            surface_in_mm(include_bytes!("../../../../data/shapes/torus.stl"))?,
            surface_in_mm(include_bytes!("../../../../data/shapes/rock.stl"))?,
            surface_in_mm(include_bytes!("../../../../data/shapes/hollow-pair.stl"))?,
        ] {
            let boundary = Boundary::new(&surface)?;
            let mut search = WallSearch::default();
            for _ in 0..500 {
                let extent = surface.extent();
                let centre = Vector3::from(extent.map(|most| random.random_range(0.0..most)));
                let radius = random.random_range(0.01..0.3) * extent[0];
                let moved = random.random_range(0.0..0.1) * extent[0];
                let place = centre + moved * Vector3::new(0.6, 0.0, -0.8);
                let near = NearTriangles::new(&boundary, &place, radius + moved);
                for first in [None, near.numbers().last()] {
                    let wanted = walls_one_by_one(&boundary, &near, (&centre, radius), first);
                    // Compiled for all processors of its kind, and for this one.
                    let plain = Walls {
                        near: &near,
                        boundary: &boundary,
                        centre: &centre,
                        radius,
                        moved,
                        first,
                        search: &mut search,
                    };
                    plain.call();
                    assert_eq!(search.found, wanted);
                    near.walls(&boundary, (&centre, radius), moved, first, &mut search);
                    assert_eq!(search.found, wanted);
                    assert_none_is_hidden(&boundary, &search.found, &centre);
                    let nearest = boundary.nearest(&centre, radius);
                    let distance = |wall: &Nearest| wall.distance;
                    assert_eq!(wanted.first().map(distance), nearest.as_ref().map(distance));
                    several += usize::from(wanted.len() > 1);
                    most += usize::from(wanted.len() == MOST);
                    hidden += near.count() - wanted.len();
                    if let Some(nearest) = wanted.first() {
                        let reach = nearest.distance + AS_NEAR;
                        let within: Vec<u32> = near.within(reach, &search).collect();
                        let is_within = |t: &u32| boundary.nearest_on(*t, &centre).distance < reach;
                        let mut all = near.numbers().filter(is_within);
                        assert!(all.all(|number| within.contains(&number)));
                    }
                }
            }
        }
        assert!(
            several > 100 && hidden > 10_000 && most > 10,
            "{several} {hidden} {most}"
        );
        Ok(())
    }
}
