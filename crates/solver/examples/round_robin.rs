//! Writes the tables and plots of doc/round-robin.md: silo, drum and penetration of the round robin
//! of Dosta et al. 2024 beside closed forms and numbers of others. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example round_robin -- silo
//! cargo run --release -p dem-run --example round_robin -- drum
//! cargo run --release -p dem-run --example round_robin -- penetration
//! ```
//!
//! Builds the program and runs the scenes of the same names with several settings, some ten minutes
//! each. Results are in `target/round-robin`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

#[allow(dead_code, reason = "other examples use the rest")]
mod programs;
#[allow(dead_code, reason = "other examples use the rest")]
#[path = "programs/study.rs"]
mod study;

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use dem_laboratory::Line as Fit;
use dem_plots::{Axis, Line, Plot};
use serde_json::Value;

use programs::{Failed, Programs, results, root};
use study::{Table, columns, run_scene};

const PAGE: &str = "doc/round-robin.md";
const GRAVITY_M_S2: f64 = 9.81;
/// Materials of the paper, as stiff as there.
const STIFF: &str = "--material=data/materials/round-robin.toml";

fn main() -> Result<(), Failed> {
    let dem_run = Programs::build()?.dem_run;
    match std::env::args().nth(1).as_deref() {
        Some("silo") => silo(&dem_run),
        Some("drum") => drum(&dem_run),
        Some("penetration") => penetration(&dem_run),
        _ => Err("write silo, drum or penetration".into()),
    }
}

/// Runs a scene with these `--set` values and other options. Returns its summary and its folder.
fn run(
    dem_run: &Path,
    scene: &str,
    name: &str,
    set: &[String],
    more: &[&str],
) -> Result<(Value, PathBuf), Failed> {
    let folder = results("round-robin")?.join(format!("{scene}-{name}"));
    let mut options: Vec<String> = more.iter().map(|option| (*option).to_owned()).collect();
    options.extend(set.iter().map(|set| format!("--set={set}")));
    let summary = run_scene(dem_run, scene, &options, &folder)?;
    Ok((summary, folder))
}

fn value(summary: &Value, measure: &str) -> Result<f64, Failed> {
    let value = summary["measures"][measure]["value"].as_f64();
    Ok(value.ok_or("no value of a measure in summary.json")?)
}

/// Slope of a straight line through a column of the time series between two times.
fn slope(folder: &Path, column: &str, [from_s, to_s]: [f64; 2]) -> Result<f64, Failed> {
    let rows = columns(&folder.join("series.csv"), ["time_s", column])?;
    let rows = rows.iter().filter(|[t, _]| (from_s..=to_s).contains(t));
    let (times, values): (Vec<f64>, Vec<f64>) = rows.map(|[t, value]| (*t, *value)).unzip();
    Ok(Fit::fitted(&times, &values).slope)
}

/// Mass flow of Beverloo et al. 1961 through a round hole, kg/s, of spheres.
fn beverloo_kg_s(bulk_kg_m3: f64, hole_m: f64, diameter_m: f64) -> f64 {
    0.58 * bulk_kg_m3 * GRAVITY_M_S2.sqrt() * (hole_m - 1.4 * diameter_m).powf(2.5)
}

/// Diameter of the beads of the silo, m.
const BEAD_M: f64 = 4e-3;

/// A silo: its name in the table, its settings, the material's density in kg/m3, the width of its
/// hole, m, and the times between which its flow is read, s.
struct Silo {
    name: &'static str,
    set: Vec<String>,
    more: &'static [&'static str],
    density_kg_m3: f64,
    hole_m: f64,
    during_s: [f64; 2],
}

fn silo(dem_run: &Path) -> Result<(), Failed> {
    let hole = |hole_m: f64| vec![format!("walls.floor.scale={}", 100.0 * hole_m)];
    let second = |hole_m: f64| {
        let material = "bodies.bead.material=m2".to_owned();
        [hole(hole_m), vec![material]].concat()
    };
    let small = |name, set, density_kg_m3, hole_m| Silo {
        name,
        set,
        more: &[],
        density_kg_m3,
        hole_m,
        during_s: [0.7, 1.1],
    };
    // As wide as the smaller hole of the paper, in a silo half as wide, with a tenth of its beads.
    let large = [
        "walls.floor.scale=4",
        "walls.cylinder.scale=10",
        "walls.slide.box.min=[\"-25 mm\",\"-25 mm\",\"-4 mm\"]",
        "walls.slide.box.max=[\"25 mm\",\"25 mm\",\"-0.01 mm\"]",
        "walls.slide.displacement=[\"100 mm\",0,0]",
        "regions.gate.cylinder.to=[0,0,\"190 mm\"]",
        "regions.gate.cylinder.radius=\"45 mm\"",
        "regions.inside.cylinder.to=[0,0,\"200 mm\"]",
        "regions.inside.cylinder.radius=\"53 mm\"",
        "regions.bed.cylinder.radius=\"40 mm\"",
        "inlets.fill.count=10000",
        "inlets.fill.rate=40000",
        "run.end_time=\"1.3 s\"",
    ];
    let large = Silo {
        during_s: [0.7, 1.2],
        ..small(
            "M1, 40 mm as in the paper",
            large.map(str::to_owned).into(),
            2500.0,
            0.040,
        )
    };
    let stiff = [
        "inlets.fill.count=1200",
        "walls.slide.table=[[\"0.3 s\",0],[\"0.35 s\",1]]",
        "run.end_time=\"0.75 s\"",
    ];
    let short = |name, more| Silo {
        more,
        during_s: [0.45, 0.75],
        ..small(name, stiff.map(str::to_owned).into(), 2500.0, 0.022)
    };
    let silos = [
        small("M1", hole(0.018), 2500.0, 0.018),
        small("M1", hole(0.022), 2500.0, 0.022),
        small("M2", second(0.018), 2000.0, 0.018),
        small("M2", second(0.022), 2000.0, 0.022),
        short("M1, 1,200 beads", &[]),
        short("M1, 1,200 beads, 1 GPa", &[STIFF]),
        large,
    ];
    let mut table = Table::new(&[
        "material",
        "hole",
        "bulk density",
        "mass flow",
        "Beverloo",
        "off",
        "beads per second",
    ]);
    for (at, silo) in silos.iter().enumerate() {
        let (summary, folder) = run(dem_run, "silo", &at.to_string(), &silo.set, silo.more)?;
        let bulk_kg_m3 = value(&summary, "bulk_density")?;
        let flow_kg_s = -slope(&folder, "mass_inside_kg", silo.during_s)?;
        let law_kg_s = beverloo_kg_s(bulk_kg_m3, silo.hole_m, BEAD_M);
        let bead_kg = silo.density_kg_m3 * PI / 6.0 * BEAD_M.powi(3);
        table.row(&[
            silo.name.to_owned(),
            format!("{:.0} mm", 1e3 * silo.hole_m),
            format!("{bulk_kg_m3:.0} kg/m3"),
            format!("{flow_kg_s:.4} kg/s"),
            format!("{law_kg_s:.4} kg/s"),
            format!("{:+.1} %", 100.0 * (flow_kg_s / law_kg_s - 1.0)),
            format!("{:.0}", flow_kg_s / bead_kg),
        ]);
    }
    table.write(PAGE, "round_robin silo")
}

/// Angular velocity of the drum, rad/s, the height of its axis, m, and when its bed is steady, s.
const TURNS_1_S: f64 = 2.0;
const AXIS_M: f64 = 0.2;
const STEADY_S: [f64; 2] = [1.6, 3.6];
/// Mass of the spheres of drum.toml, kg.
const DRUM_KG: f64 = PI / 6.0 * (1111.0 * 2500.0 * 216e-9 + 296.0 * 2000.0 * 1728e-9);

fn drum(dem_run: &Path) -> Result<(), Failed> {
    let (_, folder) = run(dem_run, "drum", "scene", &[], &[])?;
    let rate = |column: &str| slope(&folder, column, STEADY_S);
    let walls = ["drum", "front", "back"];
    let booked_w = walls
        .iter()
        .map(|wall| rate(&format!("wall_{wall}_work_j")))
        .sum::<Result<f64, Failed>>()?;
    let mean = |column: &str| mean(&folder, column, STEADY_S);
    let torques = ["torque_n_m", "torque_front_n_m", "torque_back_n_m"].map(mean);
    let torque_n_m: f64 = torques.into_iter().sum::<Result<f64, Failed>>()?;
    let (x_m, z_m) = (mean("bed_x_m")?, mean("bed_z_m")? - AXIS_M);
    let lost_w = rate("contact_damping_j")? + rate("friction_j")?;
    let kept_w = rate("kinetic_energy_j")? + rate("elastic_energy_j")? + rate("gravity_energy_j")?;
    let weight_w = DRUM_KG * GRAVITY_M_S2 * x_m * TURNS_1_S;
    let mut table = Table::new(&["power", "", "off"]);
    for (name, power_w) in [
        ("work of the drum on the spheres, booked", booked_w),
        (
            "torque on the drum times 2 rad/s",
            torque_n_m.abs() * TURNS_1_S,
        ),
        (
            "weight times the offset of its centre times 2 rad/s",
            weight_w,
        ),
        ("dissipated by contacts and friction", lost_w),
        ("the same and what the spheres keep", lost_w + kept_w),
    ] {
        table.row(&[
            name.to_owned(),
            format!("{:.2} mW", 1e3 * power_w),
            format!("{:+.2} %", 100.0 * (power_w / booked_w - 1.0)),
        ]);
    }
    table.write(PAGE, "round_robin drum power")?;

    let series = |name: &str| columns(&folder.join("series.csv"), ["time_s", name]);
    let small_in_zone = series("small_in_zone_2_kg")?;
    let period_s = period_s(&small_in_zone);
    let mixing = series("mixing_index")?;
    let mut table = Table::new(&["", "here", "reference"]);
    let angle_deg = x_m.atan2(-z_m).to_degrees();
    table.row(&[
        "direction of the centre of mass, from the vertical".to_owned(),
        format!("{angle_deg:.1} degrees"),
        "20.9 to 32.8 degrees (Jop et al. 2006)".to_owned(),
    ]);
    table.row(&[
        "period of M1 in zone 2".to_owned(),
        period_s.map_or("not seen".to_owned(), |period_s| format!("{period_s:.2} s")),
        "about 2 s (MUSEN, LIGGGHTS)".to_owned(),
    ]);
    for time_s in [0.6, 1.6, 2.6, 3.6] {
        let at = mixing.iter().rfind(|[t, _]| *t <= time_s + 1e-9);
        table.row(&[
            format!("Lacey's index {:.0} s after the start", time_s - 0.6),
            at.map_or(String::new(), |[_, index]| format!("{index:.2}")),
            "0 apart, 1 mixed at random".to_owned(),
        ]);
    }
    table.write(PAGE, "round_robin drum bed")?;
    let since_start = |rows: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let turning = rows.iter().filter(|[t, _]| *t >= 0.6);
        turning.map(|[t, mass]| [t - 0.6, *mass]).collect()
    };
    let lines = [("M1", "small_in_zone_2_kg"), ("M2", "large_in_zone_2_kg")];
    let lines = lines.map(|(name, column)| {
        Ok::<Line, Failed>(Line {
            name: name.to_owned(),
            points: since_start(&series(column)?),
            ..Line::default()
        })
    });
    let plot = Plot {
        title: "mass in the lower quarter on the sinking side".to_owned(),
        x: Axis::of("time since the start of the drum (s)"),
        y: Axis::of("mass (kg)"),
        lines: lines.into_iter().collect::<Result<_, _>>()?,
        ..Plot::default()
    };
    std::fs::write(root().join("doc/round-robin-drum.svg"), plot.svg().file())?;
    Ok(())
}

/// Mean of a column of the time series between two times.
fn mean(folder: &Path, column: &str, [from_s, to_s]: [f64; 2]) -> Result<f64, Failed> {
    let rows = columns(&folder.join("series.csv"), ["time_s", column])?;
    let rows = rows.iter().filter(|[t, _]| (from_s..=to_s).contains(t));
    let values: Vec<f64> = rows.map(|[_, value]| *value).collect();
    Ok(values.iter().sum::<f64>() / values.len() as f64)
}

/// Time between the first two minima of a curve that are below a third of its largest value.
fn period_s(curve: &[[f64; 2]]) -> Option<f64> {
    let turning: Vec<&[f64; 2]> = curve.iter().filter(|[t, _]| *t >= 0.6).collect();
    let largest = turning.iter().map(|[_, y]| *y).fold(0.0, f64::max);
    let mut minima: Vec<f64> = Vec::new();
    let mut lowest: Option<[f64; 2]> = None;
    for [t, y] in turning {
        match lowest {
            _ if *y > largest / 3.0 => minima.extend(lowest.take().map(|[t, _]| t)),
            Some([_, before]) if before <= *y => {}
            _ => lowest = Some([*t, *y]),
        }
    }
    Some(minima.get(1)? - minima.first()?)
}

/// Radius of the ball, m; height of its centre at which it has 5 m/s, and that speed.
const BALL_M: f64 = 10e-3;
const FROM_M: f64 = 0.15;
const SPEED_M_S: f64 = 5.0;
/// Friction of a bed of smooth spheres, tan 20.9 degrees (Jop et al. 2006).
const BED_FRICTION: f64 = 0.38;

/// Depth by the law of Uehara et al. 2003, m.
fn uehara_m(bulk_kg_m3: f64, fall_m: f64) -> f64 {
    let ratio = (7200.0 / bulk_kg_m3).sqrt();
    0.14 / BED_FRICTION * ratio * (2.0 * BALL_M).powf(2.0 / 3.0) * fall_m.cbrt()
}

fn penetration(dem_run: &Path) -> Result<(), Failed> {
    let grains = |diameter_mm: f64, count: usize| {
        vec![
            format!(
                "bodies.grain.particles=[[0,0,0,\"{} mm\"]]",
                0.5 * diameter_mm
            ),
            format!("inlets.fill.count={count}"),
        ]
    };
    let and = |set: Vec<String>, more: &str| [set, vec![more.to_owned()]].concat();
    let modulus = "materials.m1.young_modulus=\"200 MPa\"";
    let cases = [
        ("8 mm", grains(8.0, 1_563)),
        ("5 mm", grains(5.0, 6_400)),
        (
            "5 mm, half the step",
            and(grains(5.0, 6_400), "run.safety_factor=0.45"),
        ),
        ("5 mm, another bed", and(grains(5.0, 6_400), "run.seed=1")),
        ("5 mm, 200 MPa", and(grains(5.0, 6_400), modulus)),
        ("4 mm", grains(4.0, 12_500)),
    ];
    let mut table = Table::new(&[
        "spheres",
        "bed",
        "bulk density",
        "depth",
        "Uehara et al. 2003",
        "off",
        "displacement of the ball",
    ]);
    let mut lines = Vec::new();
    for (at, (name, set)) in cases.iter().enumerate() {
        let (summary, folder) = run(dem_run, "penetration", &at.to_string(), set, &[])?;
        let series = folder.join("series.csv");
        let heights = columns(&series, ["time_s", "bed_centre_m"])?;
        let before = heights.iter().rfind(|[t, _]| *t <= 0.4);
        let bed_m = 2.0 * before.ok_or("no row before the fall")?[1];
        let bulk_kg_m3 = value(&summary, "bulk_density")?;
        let lowest_m = value(&summary, "ball")?;
        let depth_m = bed_m - (lowest_m - BALL_M);
        // The ball falls freely to the surface; its whole fall includes the depth.
        let free_m = SPEED_M_S.powi(2) / (2.0 * GRAVITY_M_S2) + FROM_M - BALL_M - bed_m;
        let law_m = uehara_m(bulk_kg_m3, free_m + depth_m);
        table.row(&[
            (*name).to_owned(),
            format!("{:.1} mm", 1e3 * bed_m),
            format!("{bulk_kg_m3:.0} kg/m3"),
            format!("{:.1} mm", 1e3 * depth_m),
            format!("{:.1} mm", 1e3 * law_m),
            format!("{:+.0} %", 100.0 * (depth_m / law_m - 1.0)),
            format!("{:.1} mm", 1e3 * (lowest_m - FROM_M)),
        ]);
        lines.push(Line {
            name: (*name).to_owned(),
            points: fall(&series)?,
            ..Line::default()
        });
    }
    table.write(PAGE, "round_robin penetration")?;
    let plot = Plot {
        title: "the ball below the place where it has 5 m/s".to_owned(),
        x: Axis::of("time (s)"),
        y: Axis::of("displacement (mm)"),
        lines,
        ..Plot::default()
    };
    std::fs::write(
        root().join("doc/round-robin-penetration.svg"),
        plot.svg().file(),
    )?;
    Ok(())
}

/// Displacement of the ball, mm, over time, from where it has 5 m/s.
fn fall(series: &Path) -> Result<Vec<[f64; 2]>, Failed> {
    let rows = columns(series, ["time_s", "ball_m"])?;
    let below = rows.iter().filter(|[_, z]| *z <= FROM_M);
    let Some(&[start_s, _]) = below.clone().next() else {
        return Err("the ball has not fallen".into());
    };
    Ok(below
        .map(|[t, z]| [t - start_s, 1e3 * (z - FROM_M)])
        .collect())
}
