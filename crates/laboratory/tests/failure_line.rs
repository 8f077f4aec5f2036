//! The line of Mohr and Coulomb through strengths that scatter.

use dem_laboratory::{FailureLine, TestType, student_95};

/// Points 1, 2, 3 with strengths off a line by +1, -2, +1: the textbook errors of slope and
/// intercept.
#[test]
fn the_intervals_are_those_of_a_regression() {
    let (slope, intercept, off) = (0.6, 5.0, 0.1);
    let points: Vec<[f64; 2]> = [(1.0, 1.0), (2.0, -2.0), (3.0, 1.0)]
        .map(|(x, sign)| [x, intercept + slope * x + sign * off])
        .to_vec();
    let line = FailureLine::of_peaks(false, &points).unwrap();
    // One degree of freedom: s² = 6 off².
    let s = 6.0_f64.sqrt() * off;
    let t = student_95(1);
    let of_slope = t * s / 2.0_f64.sqrt();
    let of_intercept = t * s * (1.0_f64 / 3.0 + 4.0 / 2.0).sqrt();
    let [cohesion, angle_deg] = line.half_widths.unwrap();
    assert!((line.cohesion_pa - intercept).abs() < 1e-12);
    assert!((cohesion / of_intercept - 1.0).abs() < 1e-9);
    let wanted_deg = (of_slope / (1.0 + slope * slope)).to_degrees();
    assert!(
        (angle_deg / wanted_deg - 1.0).abs() < 1e-9,
        "{angle_deg} {wanted_deg}"
    );
    assert_eq!(
        FailureLine::of_peaks(false, &points[..2])
            .unwrap()
            .half_widths,
        None
    );
}

/// In triaxial tests the intervals are the derivatives of cohesion and angle, which finite
/// differences give as well.
#[test]
fn triaxial_intervals_follow_the_line() {
    let strength = |pressure: f64| 8.0 + 2.5 * pressure;
    let points = |slope: f64, level: f64| {
        let point = |x: f64| [x, strength(x) + level + slope * (x - 2.0)];
        [1.0, 2.0, 3.0].map(point).to_vec()
    };
    let of = |slope: f64, level: f64| {
        let line = FailureLine::of_peaks(true, &points(slope, level)).unwrap();
        [line.cohesion_pa, line.friction_angle_deg]
    };
    let h = 1e-5;
    let derivative = |change: [f64; 2]| {
        let [low, high] = [-h, h].map(|h| of(h * change[0], h * change[1]));
        [0, 1].map(|k| (high[k] - low[k]) / (2.0 * h))
    };
    let (by_slope, by_level) = (derivative([1.0, 0.0]), derivative([0.0, 1.0]));
    let mut scattered = points(0.0, 0.0);
    for (point, sign) in scattered.iter_mut().zip([1.0, -2.0, 1.0]) {
        point[1] += 1e-3 * sign;
    }
    let s = 6.0_f64.sqrt() * 1e-3;
    let line = FailureLine::of_peaks(true, &scattered).unwrap();
    let half = line.half_widths.unwrap();
    for k in [0, 1] {
        let of_slope = by_slope[k] * s / 2.0_f64.sqrt();
        let of_level = by_level[k] * s / 3.0_f64.sqrt();
        let wanted = student_95(1) * of_slope.hypot(of_level);
        assert!(
            (half[k] / wanted - 1.0).abs() < 1e-3,
            "{k}: {} {wanted}",
            half[k]
        );
    }
    // Its strength is the axial stress without the pressure.
    let exact = FailureLine::of_peaks(true, &points(0.0, 0.0)).unwrap();
    let found = exact.strength_pa(Some(TestType::TriaxialCompression), 2.0);
    assert!((found - (strength(2.0) - 2.0)).abs() < 1e-9);
    let same = [1.0, 2.0, 3.0].map(|x| [x, strength(x) - x]);
    assert_eq!(
        FailureLine::of_strengths(TestType::TriaxialCompression, &same),
        Some(exact)
    );
}
