//! A force that begins or ends with a jump when the ends touch or part, within a step.
//!
//! The leapfrog applies the force at the end of a step over half of that step and half of the
//! next. Ends that touch after the fraction 1 - f of a step attract each other for its fraction f:
//! for f - 1/2 of a step longer than the leapfrog has it. Ends that part after the fraction f do so
//! for f - 1/2 of a step after the kick before it covers. In both cases this times the attraction
//! is added to the kick at the end of the step; without it, energy would have an error of first
//! order in the step.
//!
//! All of that addition belongs to the step just made, but velocities at the time of the positions
//! have half of it. The other half is counted with the losses to damping, and counted back in the
//! next step.

use crate::number::Number;

/// By how much of the way in a step the overlap at its end may exceed that way.
const ROUNDING: f64 = 1e-3;

/// f - 1/2 after a step in which the ends touched or parted, otherwise 0. `overlaps_m`: before and
/// after the step, `gained_m`: by how much their distance grew in it, m.
#[inline(always)]
pub(super) fn of_a_step_more<T: Number>([before_m, now_m]: [T; 2], gained_m: T) -> T {
    let zero = now_m.zero();
    let one = zero.plus(1.0);
    let [was, is] = [before_m, now_m].map(|overlap_m| overlap_m.if_positive(one));
    // 1 where they parted, -1 where they touched.
    let parted = was - is;
    let overlap_m = before_m.maximum(zero) + now_m.maximum(zero);
    let way_m = parted * gained_m;
    let fraction = overlap_m / way_m;
    let fits = way_m.scale(1.0 + ROUNDING) - overlap_m;
    fits.if_positive(fraction.minimum(one).plus(-0.5))
}

#[cfg(test)]
mod tests {
    use super::of_a_step_more;

    #[test]
    fn ends_attract_each_other_for_the_part_of_the_step_in_which_they_touch() {
        // Touched after a quarter of a step of 4 m, parted after a quarter.
        assert_eq!(of_a_step_more([0.0, 3.0], -4.0), 0.25);
        assert_eq!(of_a_step_more([1.0, 0.0], 4.0), -0.25);
        // Just now, and just after the step before.
        assert_eq!(of_a_step_more([0.0, 1e-15], -4.0), -0.5 + 0.25e-15);
        assert_eq!(of_a_step_more([0.0, 4.0 + 1e-15], -4.0), 0.5);
        // They touch, or they do not.
        assert_eq!(of_a_step_more([3.0, 1.0], 2.0), 0.0);
        assert_eq!(of_a_step_more([0.0, 0.0], 2.0), 0.0);
        // A contact that ends or begins otherwise: no longer listed, or pressed from the start.
        assert_eq!(of_a_step_more([3.0, 0.0], 2.0), 0.0);
        assert_eq!(of_a_step_more([0.0, 3.0], 0.0), 0.0);
    }
}
