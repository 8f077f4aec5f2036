//! doc/calibration.md: bonds calibrated for spheres of several sizes. doc/sphere-size.md: the
//! scatter of modulus and strength over packings of a bar in tension.

use dem_calibration::{read_record, sizes as table_of};
use dem_io::units::significant;
use dem_laboratory::Statistic;

use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};
use crate::cells::mean;
use crate::table::{Table, write};

const PAGE: &str = "doc/calibration.md";

const SIZES: [&str; 3] = ["7mm..9mm", "5mm..7mm", "3.5mm..4.5mm"];

/// Width of the bar over the mean diameter, the diameters, and the number of packings.
const RATIOS: [(u32, &str, u32); 5] = [
    (5, "5mm..7mm", 16),
    (10, "2.5mm..3.5mm", 16),
    (15, "1.667mm..2.333mm", 16),
    (20, "1.25mm..1.75mm", 8),
    (25, "1mm..1.4mm", 2),
];

/// The grips hold 10 mm of the bar at each end, whatever the spheres. The rate is half of that of
/// the scene. Frames of so many tests would fill a disk.
pub(crate) const SETS: [&str; 5] = [
    "groups.lower-grip.box.max=[\"1 m\",\"1 m\",\"10 mm\"]",
    "groups.upper-grip.box.min=[\"-1 m\",\"-1 m\",\"50 mm\"]",
    "test.periods=50",
    "test.rate_check=false",
    "output.frames=\"10 s\"",
];

/// Degrees of freedom, and the 2.5 % and 97.5 % quantiles of the chi-squared distribution for them.
const CHI_SQUARED: [(usize, [f64; 2]); 3] = [
    (3, [0.215_795, 9.348_40]),
    (7, [1.689_87, 16.012_8]),
    (15, [6.262_14, 27.488_4]),
];

pub(crate) fn tables() -> [Table; 2] {
    let sizes = "spheres | particles | bonds | across the body | bonds.cake.young_modulus | \
        modulus without shear | scatter | bonds.cake.failure.von_mises_strength | \
        strength | scatter | run time of a test | curve apart";
    let scatter = "width over mean diameter | diameters | packings | spheres | bonds | modulus, MPa | \
        its coefficient of variation | strength, MPa | its coefficient of variation | \
        processor time of a test";
    let ratios = RATIOS.map(|(ratio, ..)| ratio.to_string());
    [
        Table::new(PAGE, "calibration sizes", sizes, SIZES),
        Table::new("doc/sphere-size.md", "calibration scatter", scatter, ratios),
    ]
}

/// The commands of the page, and the record of `dem-run calibrate` as a table.
pub(crate) fn sizes(bench: &Bench) -> Result<(), Failed> {
    let [mut table, _] = tables();
    let measured = bench.folder.join("measured.json").display().to_string();
    let lab = "lab data/measured/a.csv data/measured/b.txt data/measured/c.csv --quiet \
         --type four-point-bending --support-span 180mm --loading-span 80mm --width 30mm \
         --height 35mm -o";
    let lab: Vec<&str> = lab.split_whitespace().chain([measured.as_str()]).collect();
    bench.command(&lab)?;
    let record = bench.folder.join("sizes.json");
    let mut calibrate = [
        "calibrate",
        "data/scenes/four-point-bending.toml",
        ONE_THREAD,
    ]
    .map(str::to_owned)
    .to_vec();
    calibrate.extend(sets(&[format!("test.measured={measured:?}")]));
    calibrate.push(format!(
        "--output={}",
        record.with_extension("toml").display()
    ));
    calibrate.push("--quiet".to_owned());
    let keeps = if bench.has(&record) {
        "--resume"
    } else {
        "--force"
    };
    calibrate.push(keeps.to_owned());
    calibrate.extend(SIZES.map(|size| format!("--size={size}")));
    let pack = "-- data/shapes/bending-sample.stl --overlap 0.296 --bond-range 1.0";
    calibrate.extend(pack.split_whitespace().map(str::to_owned));
    bench.command(&calibrate)?;
    let found = table_of(&read_record(&record)?);
    let head = found.columns.iter().map(|column| column.name.as_str());
    if !head.eq(table.head.iter().copied()) {
        return Err("the record of a calibration has other columns".into());
    }
    for row in found.rows {
        table.row(row.cells.into_iter().skip(1));
    }
    write(&[table])
}

pub(crate) fn scatter(bench: &Bench) -> Result<(), Failed> {
    let [_, mut table] = tables();
    for (ratio, diameters, packings) in RATIOS {
        let test = |seed| {
            let file = bench.usual("bar", diameters, seed)?;
            let mut options = sets(&SETS);
            options.extend([ONE_THREAD.to_owned(), body("bar", &file)]);
            let name = format!("scatter-{ratio}-{seed}");
            bench.run(&name, "data/scenes/tension.toml", &options)
        };
        let tests = (1..=packings).map(test);
        let tests: Vec<Run> = tests.collect::<Result<_, Failed>>()?;
        let of = |read: fn(&Run) -> f64| mean(&tests.iter().map(read).collect::<Vec<_>>());
        let figure = |name: &str| -> Result<Statistic, Failed> {
            let values = tests.iter().map(|run| {
                let value = run.test()?.figure(name);
                value.ok_or_else(|| Failed::from(format!("the test has no {name}")))
            });
            Ok(Statistic::of(&values.collect::<Result<Vec<_>, _>>()?))
        };
        let (modulus, strength) = (figure("specimen modulus")?, figure("strength")?);
        table.row([
            diameters.to_owned(),
            packings.to_string(),
            format!("{:.0}", of(|run| run.summary.particles as f64)),
            format!("{:.0}", of(|run| run.summary.bonds as f64)),
            format!("{:.2}", 1e-6 * modulus.mean),
            variation(&modulus),
            format!("{:.4}", 1e-6 * strength.mean),
            variation(&strength),
            format!("{} s", significant(of(Run::processor_s), 3)),
        ]);
    }
    write(&[table])
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
