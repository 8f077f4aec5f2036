//! Where a run takes place, so that the first view of it does not show what has fallen past all
//! walls as well: everything else would be tiny.

use dem_io::Bounds;

/// Where a run takes place, by its first frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Home {
    /// The box around walls and spheres, m.
    pub(crate) start: Bounds,
    /// Distance from it within which spheres count, m: a quarter of the longest side; infinite
    /// without walls.
    reach_m: f64,
}

impl Home {
    /// Of a run whose first frame has these corners of walls and centres of spheres, m. Shape
    /// n x 3 each.
    pub(crate) fn of(corners_m: &[[f64; 3]], centres_m: &[[f64; 3]]) -> Self {
        let start = Bounds::of(corners_m.iter().chain(centres_m).copied());
        let reach_m = match corners_m.is_empty() {
            true => f64::INFINITY,
            false => 0.25 * start.longest_side_m(),
        };
        Self { start, reach_m }
    }

    /// Whether a point, m, is part of it.
    pub(crate) fn contains(&self, point_m: &[f64; 3]) -> bool {
        self.start.is_near(point_m, self.reach_m)
    }
}

#[cfg(test)]
mod tests {
    use super::Home;

    #[test]
    fn what_fell_past_the_walls_is_no_part_of_it() {
        let corners_m = [[0.0; 3], [2.0, 1.0, 0.5]];
        let home = Home::of(&corners_m, &[]);
        assert!(home.contains(&[2.4, -0.4, 0.9]) && !home.contains(&[1.0, 0.5, -0.6]));
        let without_walls = Home::of(&[], &corners_m);
        assert!(without_walls.contains(&[0.0, 0.0, -1e3]));
    }
}
