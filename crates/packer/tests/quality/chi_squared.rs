//! The distribution that judges isotropy.

use dem_pack::internals::chi_squared_5_exceeds;

#[test]
fn chi_squared_against_tables() {
    for (x, wanted) in [
        (0.0, 1.0),
        (4.351_46, 0.5),
        (11.070_50, 0.05),
        (15.086_27, 0.01),
        (20.515_01, 0.001),
        (500.0, 0.0),
    ] {
        let got = chi_squared_5_exceeds(x);
        assert!((got - wanted).abs() < 1e-6, "{x}: {got} {wanted}");
    }
}
