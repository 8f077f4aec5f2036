//! Cost of fracture as a sequence of equilibria: number of bonds that break one after another
//! before the largest load, and processor time of the Newton steps between them, against the test
//! with steps.

use dem_laboratory::Statistic;
use serde_json::{Value, json};

use super::bench::{Bench, number};
use super::programs::Failed;
use super::table::{Table, head};

pub(crate) const SIZES: [&str; 2] = ["5mm..7mm", "4mm..6mm"];
const PACKINGS: u32 = 4;
pub(crate) const NO_RATE_CHECK: &str = "test.rate_check=false";
pub(crate) const STATIC: &str = "run.integrator=static";

pub(crate) const HEAD: [&str; 7] = [
    "diameters",
    "packings",
    "bonds broken before the largest load",
    "processor time of the test with steps",
    "Newton steps for an equilibrium",
    "processor time of a Newton step",
    "equilibria before the largest load over the test with steps",
];

pub(crate) fn table() -> Result<Table, Failed> {
    let bench = Bench::new()?;
    let mut rows = Vec::new();
    for diameters in SIZES {
        let tests: Vec<Value> = (1..=PACKINGS)
            .map(|seed| tested(&bench, diameters, seed))
            .collect::<Result<_, _>>()?;
        rows.push(row(diameters, &tests)?);
    }
    let head = head(&HEAD);
    Ok(Table {
        word: "breaks",
        head,
        rows,
    })
}

fn tested(bench: &Bench, diameters: &str, seed: u32) -> Result<Value, Failed> {
    bench.kept(&format!("breaks-{diameters}-{seed}"), || {
        let body = bench.pack("bending-sample", diameters, seed)?;
        let stepped = bench.run("four-point-bending", &body, &[NO_RATE_CHECK])?;
        let at_rest = bench.run("four-point-bending", &body, &[STATIC])?;
        let newton_steps = number(&at_rest["equilibrium"], "newton_steps")?;
        Ok(json!({
            "broken": number(&stepped["test"], "broken_at_peak")?,
            "processor_s": number(&stepped, "processor_s")?,
            "newton_steps": newton_steps / number(&at_rest["equilibrium"], "load_steps")?,
            "newton_step_s": number(&at_rest, "processor_s")? / newton_steps,
        }))
    })
}

fn row(diameters: &str, tests: &[Value]) -> Result<Vec<String>, Failed> {
    let of = |name: &str| -> Result<Vec<f64>, Failed> {
        tests.iter().map(|test| number(test, name)).collect()
    };
    let mean = |name: &str| of(name).map(|values| Statistic::of(&values).mean);
    let mut broken = of("broken")?;
    broken.sort_by(f64::total_cmp);
    let each: Vec<String> = broken.iter().map(|count| format!("{count:.0}")).collect();
    let (test_s, step_s) = (mean("processor_s")?, mean("newton_step_s")?);
    let equilibria_s = mean("broken")? * mean("newton_steps")? * step_s;
    Ok(vec![
        diameters.to_owned(),
        tests.len().to_string(),
        format!("{} (mean {:.0})", each.join(", "), mean("broken")?),
        format!("{test_s:.1} s"),
        format!("{:.1}", mean("newton_steps")?),
        format!(
            "{step_s:.3} s ({:.1} % of the test)",
            100.0 * step_s / test_s
        ),
        format!("{:.1}", equilibria_s / test_s),
    ])
}
