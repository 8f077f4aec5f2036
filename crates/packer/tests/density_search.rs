//! The search for the overlap that gives a density.

use dem_pack::internals::{
    Begun, MOST_PACKINGS, NEAR_ENOUGH, Try, USUAL_FRACTION, judged, next_overlap, overlap_for,
};

/// The overlaps tried for a body whose fraction in r_gen falls with the overlap and scatters by
/// up to `scatter`.
fn search(target: f64, scatter: f64) -> Vec<Try> {
    let mut tries = vec![];
    let mut overlap = overlap_for(target, USUAL_FRACTION).max(0.0);
    while tries.len() < MOST_PACKINGS {
        let chance = (overlap * 1e6).sin() * scatter;
        let reduced = (0.60 - 0.05 * overlap) * (1.0 + chance);
        let filled = reduced * (1.0 + overlap).powi(3);
        tries.push(Try { overlap, filled });
        if (filled / target - 1.0).abs() <= NEAR_ENOUGH {
            break;
        }
        overlap = next_overlap(&tries, target);
    }
    tries
}

#[test]
fn a_smooth_density_is_met_in_few_packings_and_a_scattering_one_in_more() {
    for target in [0.62, 0.7, 0.8, 1.0, 1.5, 2.5] {
        for (scatter, most) in [(0.0, 3), (0.002, MOST_PACKINGS)] {
            let tries = search(target, scatter);
            let last = tries[tries.len() - 1];
            assert!(
                tries.len() <= most && (last.filled / target - 1.0).abs() <= NEAR_ENOUGH,
                "{target} {scatter}: {tries:?}"
            );
        }
    }
}

#[test]
fn fronts_are_judged_by_what_settling_and_filling_did_before() {
    let one = |overlap, front, filled| Begun {
        overlap,
        front,
        filled,
    };
    let mut begun = vec![one(0.1, 0.80, None)];
    assert_eq!(judged(&begun)[0].filled, 0.80);
    begun.push(one(0.2, 0.90, Some(0.90 * 1.01)));
    begun.push(one(0.3, 1.00, Some(1.03)));
    begun.push(one(0.4, 1.10, Some(1.10 * 1.02)));
    let filled: Vec<f64> = judged(&begun).iter().map(|t| t.filled).collect();
    for (got, wanted) in filled
        .iter()
        .zip([0.80 * 1.02, 0.90 * 1.01, 1.03, 1.10 * 1.02])
    {
        assert!((got - wanted).abs() < 1e-12, "{filled:?}");
    }
    assert_eq!(filled.len(), 4);
}

#[test]
fn no_overlap_is_tried_twice() {
    // No packing is near enough: the density has a step at the target.
    let mut tries: Vec<Try> = Vec::new();
    let mut overlap = 0.3;
    for _ in 0..MOST_PACKINGS {
        let filled = if overlap < 0.31 { 0.98 } else { 1.02 };
        assert!(tries.iter().all(|t| t.overlap != overlap), "{tries:?}");
        tries.push(Try { overlap, filled });
        overlap = next_overlap(&tries, 1.0);
        assert!((0.0..1.0).contains(&overlap), "{tries:?}");
    }
}
