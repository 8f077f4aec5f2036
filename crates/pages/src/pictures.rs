//! Pictures of pages that come of studies and have no table.

use dem_plots::{Axis, Line, Marks, Plot, Point};
use dem_run::physics::bond::strain_rate::{HIGHEST_1_S, dynamic_increase_factor};

use crate::bench::{Bench, Failed, root};
use crate::plots::draw;

/// `doc/failure-models.svg` of doc/studies.md: load over travel with each failure model.
pub(crate) fn failure_models(bench: &Bench) -> Result<(), Failed> {
    let mut lines = Vec::new();
    for run in bench.study("failure-models")? {
        let curve = run.columns("force-displacement.csv", ["displacement_m", "load_n"])?;
        let shown = curve.iter().step_by(curve.len() / 400 + 1);
        let shown = shown.map(|[travel_m, load_n]| [1e3 * travel_m, *load_n]);
        lines.push(Line::new(&run.settings[0], shown.collect()));
    }
    let title = "one bending test with each failure model";
    let plot = Plot::of(title, "travel (mm)", "load (N)", lines);
    draw("doc/failure-models.svg", &plot)
}

/// Largest difference of the forces on both ends over the largest load, between half of it and all
/// of it, of a test in equilibrium: that of the verdict of a run.
const APART: f64 = 0.1;

/// `doc/strain-rate.svg` of doc/dynamic-tests.md: strength of the disc over the strain rate, beside
/// eq. 20, without rate strengthening and with it: the runs of the study take turns. A run out of
/// equilibrium measures no strength of the disc, and says so.
pub(crate) fn strain_rate(bench: &Bench) -> Result<(), Failed> {
    let mut marks = ["without rate strengthening", "eq. 20 for the bonds"].map(|name| Marks {
        name: name.to_owned(),
        ..Marks::default()
    });
    for (at, run) in bench.study("hopkinson-rates")?.iter().enumerate() {
        let test = run.test()?;
        let figure = |name: &str| test.figure(name).unwrap_or(f64::NAN);
        let point = [figure("strain rate"), figure("dynamic increase factor")];
        if !point[1].is_finite() {
            return Err("a disc of the study did not break".into());
        }
        marks[at % 2].points.push(Point {
            at: point,
            filled: figure("force equilibrium").abs() <= APART,
            ..Point::default()
        });
    }
    let all = marks.iter().flat_map(|marks| &marks.points);
    let rates = all.map(|point| point.at[0]).filter(|rate| rate.is_finite());
    let [lowest, highest] = rates.fold([HIGHEST_1_S, 0.0], |[low, high], rate| {
        [rate.min(low), rate.max(high)]
    });
    let theory = (0..=50)
        .map(|i| lowest * (highest / lowest).powf(f64::from(i) / 50.0))
        .map(|rate| [rate, dynamic_increase_factor(rate, 0.0)]);
    let title = "strength of a disc over its strain rate";
    let y = "strength over static strength";
    let plot = Plot {
        x: Axis::log("strain rate (1/s)"),
        marks: marks.into(),
        filled: Some(["in equilibrium", "not in equilibrium: not valid"].map(str::to_owned)),
        ..Plot::of(title, "", y, vec![Line::dashed("eq. 20", theory.collect())])
    };
    draw("doc/strain-rate.svg", &plot)
}

/// `doc/larger-spheres.svg` of doc/laboratory.md: the plot of the study, whose first body stands in
/// the root of the clone.
pub(crate) fn larger_spheres(bench: &Bench) -> Result<(), Failed> {
    let body = bench.usual("bending-sample", "2mm..3mm", 1)?;
    std::fs::copy(body, root().join("sample.vtp"))?;
    bench.study("larger-spheres")?;
    let plot = bench.folder.join("larger-spheres/curve-curves.svg");
    std::fs::copy(plot, root().join("doc/larger-spheres.svg"))?;
    Ok(())
}
