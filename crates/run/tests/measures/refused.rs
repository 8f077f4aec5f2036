//! Values outside their tolerances, and missing values.

use super::{Measured, assert_near};

fn falling(more: &str) -> Measured {
    let mut run = Measured::new(&format!(
        "version = 1
run = {{ end_time = 1, time_step = 1e-3 }}
materials.m = {{ density = 2000 }}
bodies.ball = {{ particles = [[0, 0, 2, 1]], material = \"m\" }}
[measures.height]
of = \"ball\"
quantity = \"position_z\"
{more}
"
    ));
    run.run(1e-3);
    run
}

#[test]
fn an_absolute_tolerance_is_in_the_unit_of_the_measure() {
    for (more, good) in [
        ("reference = 2.1\nabsolute_tolerance = \"11 cm\"", true),
        ("reference = 2.1\nabsolute_tolerance = \"9 cm\"", false),
        ("reference = 0\nabsolute_tolerance = \"2.1 m\"", true),
        (
            "reference = 2.1\ntolerance = 0.04\nabsolute_tolerance = 0.2",
            false,
        ),
        (
            "reference = 2.1\ntolerance = 0.05\nabsolute_tolerance = 0.09",
            false,
        ),
        (
            "reference = 2.1\ntolerance = 0.05\nabsolute_tolerance = 0.2",
            true,
        ),
    ] {
        let result = falling(more).probes[0].result();
        assert_near(result.value, 2.0, 0.0);
        assert_eq!(result.is_good(), good, "{more}");
    }
}
