//! The area between curves, against areas by hand.

use dem_laboratory::area_between;

#[test]
fn curves_that_are_a_known_way_apart() {
    let line = [[0.0, 0.0], [1.0, 2.0], [2.0, 4.0]];
    assert_eq!(area_between(&line, &line), 0.0);
    // The same line with other points, and before contact.
    let same = [[-1.0, -2.0], [0.5, 1.0], [2.0, 4.0]];
    assert!(area_between(&same, &line) < 1e-15);
    let stiffer = [[0.0, 0.0], [2.0, 4.4]];
    assert!((area_between(&stiffer, &line) - 0.1).abs() < 1e-15);
    // It breaks at half the displacement: the other half of the area, three quarters of it, is
    // between them, except for the drop.
    let weaker = [[0.0, 0.0], [1.0, 2.0], [1.0 + 1e-9, 0.0], [1.1, 0.0]];
    assert!((area_between(&weaker, &line) - 0.75).abs() < 1e-8);
    // Reversed: the area under the weaker one is 1, the area between them 3.
    assert!((area_between(&line, &weaker) - 3.0).abs() < 1e-8);
    // Two lines that cross half-way: two triangles of a quarter each; the area under the second
    // is one half.
    let [up, down] = [[[0.0, 0.0], [1.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]];
    assert!((area_between(&up, &down) - 1.0).abs() < 1e-15);
}
