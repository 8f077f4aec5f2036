//! Scatter of modulus and strength over packings of a bar in tension, for spheres from coarse to
//! fine.

use dem_io::units::significant;
use dem_laboratory::Statistic;
use serde_json::{Value, json};

use super::bench::{Bench, number, result};
use super::programs::Failed;
use super::table::{Table, head};

/// Width of the bar over the mean diameter, the diameters, and the number of packings.
pub(crate) const RATIOS: [(u32, &str, u32); 5] = [
    (5, "5mm..7mm", 16),
    (10, "2.5mm..3.5mm", 16),
    (15, "1.667mm..2.333mm", 16),
    (20, "1.25mm..1.75mm", 8),
    (25, "1mm..1.4mm", 2),
];

/// The grips hold 10 mm of the bar at each end, whatever the spheres. The rate is half of that of
/// the scene.
pub(crate) const SETS: [&str; 4] = [
    "groups.lower-grip.box.max=[\"1 m\",\"1 m\",\"10 mm\"]",
    "groups.upper-grip.box.min=[\"-1 m\",\"-1 m\",\"50 mm\"]",
    "test.periods=50",
    "test.rate_check=false",
];

/// Degrees of freedom, and the 2.5 % and 97.5 % quantiles of the chi-squared distribution for them.
const CHI_SQUARED: [(usize, [f64; 2]); 3] = [
    (3, [0.215_795, 9.348_40]),
    (7, [1.689_87, 16.012_8]),
    (15, [6.262_14, 27.488_4]),
];

pub(crate) const HEAD: [&str; 10] = [
    "width over mean diameter",
    "diameters",
    "packings",
    "spheres",
    "bonds",
    "modulus, MPa",
    "its coefficient of variation",
    "strength, MPa",
    "its coefficient of variation",
    "processor time of a test",
];

pub(crate) fn table() -> Result<Table, Failed> {
    let bench = Bench::new()?;
    let mut rows = Vec::new();
    for (ratio, diameters, packings) in RATIOS {
        let tests: Vec<Value> = (1..=packings)
            .map(|seed| tested(&bench, ratio, diameters, seed))
            .collect::<Result<_, _>>()?;
        rows.push(row(ratio, diameters, &tests)?);
    }
    let head = head(&HEAD);
    Ok(Table {
        word: "scatter",
        head,
        rows,
    })
}

fn tested(bench: &Bench, ratio: u32, diameters: &str, seed: u32) -> Result<Value, Failed> {
    bench.kept(&format!("scatter-{ratio}-{seed}"), || {
        let body = bench.pack("bar", diameters, seed)?;
        let summary = bench.run("tension", &body, &SETS)?;
        Ok(json!({
            "particles": number(&summary, "particles")?,
            "bonds": number(&summary, "bonds")?,
            "modulus_pa": result(&summary, "specimen modulus")?,
            "strength_pa": result(&summary, "strength")?,
            "processor_s": number(&summary, "processor_s")?,
        }))
    })
}

fn row(ratio: u32, diameters: &str, tests: &[Value]) -> Result<Vec<String>, Failed> {
    let of = |name: &str| -> Result<Statistic, Failed> {
        let values = tests.iter().map(|test| number(test, name));
        Ok(Statistic::of(&values.collect::<Result<Vec<_>, _>>()?))
    };
    let whole = |name: &str| of(name).map(|statistic| format!("{:.0}", statistic.mean));
    let (modulus, strength) = (of("modulus_pa")?, of("strength_pa")?);
    Ok(vec![
        ratio.to_string(),
        diameters.to_owned(),
        tests.len().to_string(),
        whole("particles")?,
        whole("bonds")?,
        format!("{:.2}", 1e-6 * modulus.mean),
        variation(&modulus),
        format!("{:.4}", 1e-6 * strength.mean),
        variation(&strength),
        format!("{} s", significant(of("processor_s")?.mean, 3)),
    ])
}

/// Coefficient of variation with its 95 % confidence interval, for normally distributed values that
/// scatter little around their mean; a difference of two values says too little for one.
fn variation(statistic: &Statistic) -> String {
    let degrees = statistic.count - 1;
    let percent = 100.0 * statistic.standard_deviation / statistic.mean;
    match CHI_SQUARED.iter().find(|(of, _)| *of == degrees) {
        None => format!("{percent:.1} %"),
        Some((_, quantiles)) => {
            let [most, least] =
                quantiles.map(|quantile| percent * (degrees as f64 / quantile).sqrt());
            format!("{percent:.1} % ({least:.1} % to {most:.1} %)")
        }
    }
}
