//! Writes made-up curves of three bending samples into `data/measured`, each as another test rig
//! would: `cargo run -p dem-laboratory --example make_specimens`, from the root of the repository.
//!
//! Their moduli and strengths scatter around 12.05 MPa and 0.21 MPa (Platzer 2022, 4.4.1.2); they
//! are no measurements.

use std::fmt::Write;

use dem_testing::made_test::{Made, USUAL};

/// Stiffness, N/m, largest force, N, offset and drift of the load cell, N, and seating, m.
const SPECIMENS: [[f64; 5]; 3] = [
    [17_600.0, 49.6, 1.7, 0.4, 0.25e-3],
    [18_300.0, 51.3, -2.4, -0.3, 0.1e-3],
    [18_790.0, 53.45, 0.6, 0.2, 0.4e-3],
];

fn main() -> std::io::Result<()> {
    for (at, [stiffness_n_m, failure_n, offset_n, drift_n, seating_m]) in
        SPECIMENS.into_iter().enumerate()
    {
        let made = Made {
            stiffness_n_m,
            failure_n,
            offset_n,
            drift_n,
            seating_m,
            bend: 0.85,
            rows: 900,
            seed: at as u64,
            ..USUAL
        };
        let name = ["a.csv", "b.txt", "c.csv"][at];
        std::fs::write(format!("data/measured/{name}"), text(&made, at))?;
    }
    Ok(())
}

/// The file of a specimen.
fn text(made: &Made, at: usize) -> String {
    let (travel_m, force_n) = made.rows();
    let mut text = [
        "travel (mm),force (N)\n",
        "Sample b, made up\n\nTime\tCrosshead\tLoad\ns\tmm\tkN\n",
        "Probe c;erfunden\nStandardweg [mm];Standardkraft [N]\n",
    ][at]
        .to_owned();
    for (travel_m, force_n) in travel_m.iter().zip(force_n) {
        let travel_mm = 1e3 * travel_m;
        let row = match at {
            0 => format!("{travel_mm:.4},{force_n:.3}"),
            // 1 mm/min.
            1 => format!(
                "{:.2}\t{travel_mm:.4}\t{:.6}",
                60.0 * travel_mm,
                1e-3 * force_n
            ),
            _ => format!("{travel_mm:.4};{force_n:.3}").replace('.', ","),
        };
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{row}");
    }
    text
}
