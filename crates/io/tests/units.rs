//! Units of numbers.

use dem_io::units::{ANGLE_DEG, DIMENSIONS};

/// A size that is off in its last bit changes results.
#[test]
fn the_sizes_of_all_units_keep_their_bits() {
    let mut sizes = String::new();
    for dimension in DIMENSIONS.iter().chain([&ANGLE_DEG]) {
        for (unit, size) in dimension.units {
            let (bits, name, si) = (size.to_bits(), dimension.name, dimension.si);
            sizes += &format!("{bits:016x} {name} [{si}] {unit}\n");
        }
    }
    assert_eq!(sizes, include_str!("unit_sizes.txt"));
}
