//! doc/inside/packing-method.md, and the packing of doc/inside/performance.md, in the bending
//! sample and the bar of `data/shapes`. Each packing of the table of growth is made in a process of
//! its own, to measure its memory separately (Linux only).

use std::process::Command;
use std::time::Instant;

use dem_io::body::vtp;
use dem_io::surface::Surface;
use dem_io::{Body, Diagnostic};
use dem_pack::cli::thread_pool;
use dem_pack::internals::{Boundary, Vector3};
use dem_pack::{Basis, BodyReport, BodySettings, BondSettings, PackSettings, Sizes, make_body};
use dem_plots::{Marks, Plot, Point};

use crate::bench::{Bench, Failed};
use crate::cells::{columns, mean, median};
use crate::plots::draw;
use crate::shapes::{shape, sizes, surface_of};
use crate::table::{Table, write};

/// Values of `--densify` in the first table.
const DENSIFY: [f64; 10] = [
    0.0, 0.01, 0.02, 0.025, 0.03, 0.033, 0.036, 0.039, 0.041, 0.043,
];
/// Seeds over which each line of the first table is averaged.
const SEEDS: [u64; 3] = [1, 2, 3];
/// Seeds of the packings that are timed.
const TIMED_SEEDS: [u64; 5] = [1, 2, 3, 4, 5];
/// Approximate number of spheres in the bending sample for diameters of 1.2 mm to 1.5 mm.
const SPHERES_OF_1_35_MM: f64 = 87_000.0;

/// Approximate numbers of spheres in the table of growth.
const COUNTS: [usize; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];

/// Bodies that are timed, and their diameters.
const CASES: [(&str, &str); 5] = [
    ("bar", "1.2mm..1.5mm"),
    ("box of 28,000 spheres", "0.956mm..1.195mm"),
    ("scan of 81,920 facets", "0.956mm..1.195mm"),
    ("narrow sizes", "2mm..3mm"),
    ("wide sizes, by mass", "0.2mm..4mm"),
];

pub(crate) fn tables() -> [Table; 3] {
    const PAGE: &str = "doc/inside/packing-method.md";
    let densify = "`--densify` | spheres | overall | interior | eigenvalue off 1/3, sigma | \
        sizes off, of chance | removed | front, s | densification, s | spheres/s";
    let growth = "spheres | threads | front, s | densifying, s | all, s | us/sphere | \
        memory, bytes/sphere | interior | overall";
    let ratios = "case | diameters | spheres | all, us/sphere | densifying, us/sphere | steps | \
        spheres/s | touch the wall | interior";
    let fractions = DENSIFY.map(|fraction| fraction.to_string());
    let cases = CASES.map(|(case, _)| case);
    [
        Table::new(PAGE, "packing densify", densify, fractions),
        Table::new(PAGE, "packing growth", growth, [""; 0]),
        Table::new("doc/inside/performance.md", "packing ratios", ratios, cases),
    ]
}

/// Quality over run time on one thread, for diameters of 2 mm to 3 mm without overlap.
pub(crate) fn densify(_: &Bench) -> Result<(), Failed> {
    let surface = shape("bending-sample", 1.0)?;
    let [mut table, ..] = tables();
    let mut means = Vec::new();
    for densify in DENSIFY {
        let mut rows = Vec::new();
        for seed in SEEDS {
            let settings = settings("2mm..3mm", Some(densify), seed)?;
            let (_, made) = on_threads(1, || make_body(&surface, &settings, &|_, _| Ok(())))?;
            rows.push(quality(&made));
        }
        let row = columns(&rows, mean);
        table.row((0..9).map(|at| match [0, 4, 4, 1, 2, 1, 2, 2, 0][at] {
            _ if at == ALL_S => format!("{:.0}", row[0] / row[ALL_S]),
            digits => format!("{:.digits$}", row[at]),
        }));
        means.push(row);
    }
    plots(&means)?;
    write(&[table])
}

/// Columns of the quality of a packing.
const INTERIOR: usize = 2;
const ANISOTROPY: usize = 3;
const SIZE_ERROR: usize = 4;
const ALL_S: usize = 8;

/// Spheres, density of all and of the interior, deviation of an eigenvalue of the fabric from 1/3
/// over the standard deviation of chance, distance between the sizes placed and those requested
/// over the limit of chance (95 %), spheres removed, times of the front, of densifying, of all.
fn quality(made: &BodyReport) -> [f64; 9] {
    let (quality, history) = (&made.quality, &made.history);
    let interior = quality.interior_generating_density.as_ref();
    let fabric = quality.interior_fabric.as_ref();
    [
        quality.particles as f64,
        quality.generating_density,
        interior.map_or(f64::NAN, |fraction| fraction.value),
        fabric.map_or(f64::NAN, |fabric| fabric.largest_deviation_in_sigma),
        quality.sizes_by_number.distance / quality.sizes_by_number.limit_95,
        history.removed as f64,
        history.front_seconds,
        history.densify_seconds,
        made.seconds.packing + made.seconds.bonds + made.seconds.report,
    ]
}

/// Draws density, isotropy and error of the sizes over run time.
fn plots(means: &[[f64; 9]]) -> Result<(), Failed> {
    // Name of the file of a plot, its title, the label of its axis, and the column.
    let quantities = [
        (
            "density",
            "Density of the interior",
            "fraction of volume",
            INTERIOR,
        ),
        (
            "isotropy",
            "Contact directions: chance gives about 2",
            "deviation of an eigenvalue (standard deviations)",
            ANISOTROPY,
        ),
        (
            "sizes",
            "Sizes placed: chance stays below 1 in 95 %",
            "distance from the requested sizes (of chance)",
            SIZE_ERROR,
        ),
    ];
    for (name, title, label, column) in quantities {
        let at = |row: &[f64; 9]| [row[ALL_S] / row[0], row[column]];
        let point = |(densify, row): (&f64, &[f64; 9])| Point {
            at: at(row),
            filled: true,
            title: format!("--densify {densify}"),
            ..Point::default()
        };
        let x = "run time per sphere, one thread (s)";
        let plot = Plot {
            marks: vec![Marks {
                points: DENSIFY.iter().zip(means).map(point).collect(),
                chains: vec![means.iter().map(at).collect()],
                ..Marks::default()
            }],
            ..Plot::of(title, x, label, Vec::new())
        };
        draw(&format!("doc/inside/densify-{name}.svg"), &plot)?;
    }
    Ok(())
}

/// Time and memory over the number of spheres, on one thread and on two.
pub(crate) fn growth(_: &Bench) -> Result<(), Failed> {
    let [_, mut table, _] = tables();
    for count in COUNTS {
        for threads in ["1", "2"] {
            let mut one = Command::new(std::env::current_exe()?);
            let done = one
                .args(["packing", "growth", &count.to_string(), threads])
                .output()?;
            if !done.status.success() {
                return Err(String::from_utf8_lossy(&done.stderr).into());
            }
            let cells = String::from_utf8(done.stdout)?;
            table.row(cells.split_whitespace().map(str::to_owned));
        }
    }
    write(&[table])
}

/// Number of spheres, times of a job on one thread and of densifying per sphere, us, steps of
/// densifying, spheres that touch the wall, density of the interior, not a number if there is none:
/// medians over packings with different seeds, since the number of steps that densifying needs
/// varies from one to the next.
fn timed(surface: &Surface, sizes: Sizes) -> Result<[f64; 6], Failed> {
    let mut settings = BodySettings::new(PackSettings::new(sizes));
    let boundary = Boundary::new(surface)?;
    let mut rows = Vec::new();
    for seed in TIMED_SEEDS {
        settings.packing.seed = seed;
        let (body, made) = on_threads(1, || make_body(surface, &settings, &|_, _| Ok(())))?;
        let [spheres, _, interior, .., densifying_s, all_s] = quality(&made);
        rows.push([
            spheres,
            1e6 * all_s / spheres,
            1e6 * densifying_s / spheres,
            made.history.densify_steps as f64,
            touching_the_wall(surface, &boundary, &body) as f64,
            interior,
        ]);
    }
    Ok(columns(&rows, |values| median(values.iter().copied())))
}

/// The number of spheres that come within a thousandth of their radius of the surface.
fn touching_the_wall(surface: &Surface, boundary: &Boundary, body: &Body) -> usize {
    let touches = |(centre_m, radius_m): &(&[f64; 3], &f64)| {
        let local = [0, 1, 2].map(|k| (centre_m[k] - surface.origin_m[k]) / surface.unit_m);
        !boundary.clears(&Vector3::from(local), 1.001 * *radius_m / surface.unit_m)
    };
    body.positions
        .iter()
        .zip(&body.radii)
        .filter(touches)
        .count()
}

/// Spheres per second in the bar, the time of a scan over that of a box, and the time of wide sizes
/// over that of narrow ones: defaults of the program.
#[allow(clippy::print_stdout, reason = "it prints ratios of the page")]
pub(crate) fn ratios(_: &Bench) -> Result<(), Failed> {
    let [.., mut table] = tables();
    let surfaces = [
        shape("bar", 1.0)?,
        shape("bar", 0.665)?,
        cut_into_four(&shape("rock", 1.0)?)?,
        shape("bar", 2.13)?,
        shape("bar", 0.56)?,
    ];
    let mut times_us = Vec::new();
    for ((name, diameters), surface) in CASES.into_iter().zip(&surfaces) {
        let sizes = match name.contains("by mass") {
            true => Sizes::parse(diameters, Basis::Mass)?,
            false => sizes(diameters)?,
        };
        let [spheres, all_us, densifying_us, steps, at_wall, interior] = timed(surface, sizes)?;
        table.row([
            diameters.to_owned(),
            spheres.to_string(),
            format!("{all_us:.1}"),
            format!("{densifying_us:.1}"),
            steps.to_string(),
            format!("{:.0}", 1e6 / all_us),
            at_wall.to_string(),
            match interior.is_nan() {
                true => "-".to_owned(),
                false => format!("{interior:.4}"),
            },
        ]);
        times_us.push([densifying_us, all_us]);
    }
    write(&[table])?;
    println!(
        "densifying, scan over box: {:.2}; wide over narrow sizes: {:.2}",
        times_us[2][0] / times_us[1][0],
        times_us[4][1] / times_us[3][1]
    );
    Ok(())
}

/// The surface with each facet cut into four.
fn cut_into_four(surface: &Surface) -> Result<Surface, Failed> {
    let facets = surface.triangles.len();
    let mut stl = vec![0; 80];
    stl.extend((4 * facets as u32).to_le_bytes());
    let middle = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| 0.5 * (p[k] + q[k]));
    for facet in 0..facets {
        let [a, b, c] = surface.corners(facet);
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            stl.extend([0; 12]);
            for x in corners.as_flattened() {
                stl.extend(((x * surface.unit_m / 1e-3) as f32).to_le_bytes());
            }
            stl.extend([0; 2]);
        }
    }
    surface_of(&stl, "scan", 1.0)
}

/// Prints the cells of a row of the table of growth.
#[allow(
    clippy::print_stdout,
    reason = "the program that started this one reads it"
)]
pub(crate) fn one_size(size: &str) -> Result<(), Failed> {
    let (spheres, threads) = size.split_once(' ').ok_or("write spheres and threads")?;
    let surface = shape("bending-sample", 1.0)?;
    let before = peak_memory_bytes();
    let factor = (SPHERES_OF_1_35_MM / spheres.parse::<f64>()?).cbrt();
    let settings = settings(&format!("{}mm..{}mm", 1.2 * factor, 1.5 * factor), None, 1)?;
    let started = Instant::now();
    let made = on_threads(threads.parse()?, || {
        let (body, made) = make_body(&surface, &settings, &|_, _| Ok(()))?;
        vtp::write(&body, &mut std::io::sink())
            .map_err(|e| Diagnostic::failed("", e.to_string(), ""))?;
        Ok(made)
    })?;
    let seconds = started.elapsed().as_secs_f64();
    let placed = made.quality.particles as f64;
    let memory = peak_memory_bytes().zip(before).map_or_else(
        || "-".to_owned(),
        |(peak, before)| format!("{:.0}", (peak - before) / placed),
    );
    let interior = made.quality.interior_generating_density;
    println!(
        "{placed} {threads} {:.2} {:.2} {seconds:.2} {:.1} {memory} {:.4} {:.4}",
        made.history.front_seconds,
        made.history.densify_seconds,
        1e6 * seconds / placed,
        interior.map_or(f64::NAN, |fraction| fraction.value),
        made.quality.generating_density,
    );
    Ok(())
}

fn on_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> dem_io::Result<T> + Send,
) -> Result<T, Failed> {
    Ok(thread_pool(Some(threads))?.install(work)?)
}

/// Settings for spheres without overlap. Bonds join those that touch, so that the fabric is that of
/// the contacts.
fn settings(diameters: &str, densify: Option<f64>, seed: u64) -> Result<BodySettings, Failed> {
    Ok(BodySettings {
        packing: PackSettings {
            sizes: sizes(diameters)?,
            overlap: 0.0,
            seed,
            densify,
            seed_point_m: None,
        },
        bonds: BondSettings {
            range: 1.001,
            ..BondSettings::default()
        },
        particle_density_kg_m3: None,
        solid_density_kg_m3: None,
    })
}

/// Peak memory of this process, as Linux counts it.
fn peak_memory_bytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024.0 * line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()?)
}
