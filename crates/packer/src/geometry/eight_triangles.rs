//! Eight triangles at once: lower bounds of their distances from a point, and which of them a
//! nearer wall hides. The compiler makes each loop over eight into a few instructions.

use super::nearest::Nearest;
use super::plane::Surroundings;
use crate::spheres::Vector3;

/// Number of triangles whose bounds are found at once.
pub(super) const AT_ONCE: usize = 8;

/// The surroundings of eight triangles, column by column.
#[derive(Default)]
pub(super) struct EightSurroundings {
    middle: [[f32; AT_ONCE]; 3],
    radius: [f32; AT_ONCE],
    normal: [[f32; AT_ONCE]; 3],
    half_height: [f32; AT_ONCE],
}

impl EightSurroundings {
    /// Sets those of triangle `k` of the eight.
    #[inline(always)]
    pub(super) fn set(&mut self, k: usize, around: &Surroundings) {
        for axis in 0..3 {
            self.middle[axis][k] = around.middle[axis];
            self.normal[axis][k] = around.normal[axis];
        }
        self.radius[k] = around.radius;
        self.half_height[k] = around.half_height;
    }

    /// The surroundings of triangle `k` of the eight.
    #[inline(always)]
    pub(super) fn of(&self, k: usize) -> Surroundings {
        Surroundings {
            middle: [self.middle[0][k], self.middle[1][k], self.middle[2][k]],
            radius: self.radius[k],
            normal: [self.normal[0][k], self.normal[1][k], self.normal[2][k]],
            half_height: self.half_height[k],
        }
    }

    /// Lower bounds of the distances of the triangles from a point.
    #[expect(
        clippy::needless_range_loop,
        reason = "several arrays side by side, lane by lane"
    )]
    #[inline(always)]
    pub(super) fn least_distances(&self, point: &Vector3) -> [f64; AT_ONCE] {
        let mut least = [0.0; AT_ONCE];
        for k in 0..AT_ONCE {
            least[k] = self.of(k).least_distance(point);
        }
        least
    }

    /// The triangles that are not nearer to a ball's centre than a wall and entirely behind its
    /// plane, one bit each. `least` holds lower bounds of their distances.
    #[inline(always)]
    pub(super) fn hidden_behind(
        &self,
        least: &[f64; AT_ONCE],
        wall: &Nearest,
        centre: &Vector3,
    ) -> u8 {
        let towards = wall.towards(centre);
        let mut hidden = [false; AT_ONCE];
        for k in 0..AT_ONCE {
            hidden[k] = (least[k] >= wall.distance)
                & self.of(k).is_past(centre, &towards, wall.hides_beyond());
        }
        bits(&hidden)
    }
}

/// One bit for each of eight, the first one lowest.
#[inline(always)]
pub(super) fn bits(of_eight: &[bool; AT_ONCE]) -> u8 {
    let mut bits = 0;
    for (k, bit) in of_eight.iter().enumerate() {
        bits |= u8::from(*bit) << k;
    }
    bits
}
