//! Prints the tables of doc/packing-method.md as Markdown, in the bending sample of `data/shapes`,
//! and draws the first one into `doc`:
//!
//! ```text
//! cargo run --release -p dem-pack --example quality_table           # quality, each --densify
//! cargo run --release -p dem-pack --example quality_table -- growth # time and memory
//! cargo run --release -p dem-pack --example quality_table -- growth 5000000
//! cargo run --release -p dem-pack --example quality_table -- ratios # scans and wide sizes
//! ```
//!
//! Each packing of the second table is made in a process of its own, to measure its memory
//! separately (Linux only).

use std::io::{Error, Write};
use std::process::Command;
use std::time::Instant;

use dem_io::body::vtp;
use dem_io::surface::{ReadSettings, Surface, surface_from_stl};
use dem_io::{Body, Diagnostic, Result};
use dem_pack::internals::{Boundary, Vector3};
use dem_pack::{Basis, BodyReport, BodySettings, BondSettings, PackSettings, Sizes, make_body};
use dem_plots::{Axis, Marks, Plot, Point};

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

fn main() -> std::result::Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        [] => quality_table(),
        ["growth"] => growth_table(&[10_000, 30_000, 100_000, 300_000, 1_000_000]),
        ["ratios"] => ratios(),
        ["growth", spheres] => growth_table(&[number(spheres)?]),
        ["one", spheres, threads] => one_size(number(spheres)?, number(threads)?),
        _ => Err(Error::other(
            "write nothing, growth, growth SPHERES, or ratios",
        )),
    }
}

fn number(text: &str) -> std::result::Result<usize, Error> {
    text.parse()
        .map_err(|_| Error::other(format!("'{text}' is not a whole number")))
}

/// Density, isotropy, sizes and time of a fraction of densification: means over the seeds.
struct Quality {
    densify: f64,
    spheres: f64,
    overall: f64,
    interior: f64,
    /// Deviation of an eigenvalue of the fabric from 1/3, over the standard deviation of chance.
    anisotropy: f64,
    /// Distance between the sizes placed and those requested, over the limit of chance (95 %).
    size_error: f64,
    removed: f64,
    front_s: f64,
    densifying_s: f64,
    all_s: f64,
}

impl Quality {
    fn of(densify: f64, all: &[BodyReport]) -> Self {
        let mean = |value: &dyn Fn(&BodyReport) -> f64| {
            all.iter().map(value).sum::<f64>() / all.len() as f64
        };
        Self {
            densify,
            spheres: mean(&|made| made.quality.particles as f64),
            overall: mean(&|made| made.quality.generating_density),
            interior: mean(&|made| {
                let interior = made.quality.interior_generating_density.as_ref();
                interior.map_or(f64::NAN, |fraction| fraction.value)
            }),
            anisotropy: mean(&|made| {
                let fabric = made.quality.interior_fabric.as_ref();
                fabric.map_or(f64::NAN, |fabric| fabric.largest_deviation_in_sigma)
            }),
            size_error: mean(&|made| {
                let fit = &made.quality.sizes_by_number;
                fit.distance / fit.limit_95
            }),
            removed: mean(&|made| made.history.removed as f64),
            front_s: mean(&|made| made.history.front_seconds),
            densifying_s: mean(&|made| made.history.densify_seconds),
            all_s: mean(&|made| made.seconds.packing + made.seconds.bonds + made.seconds.report),
        }
    }

    fn seconds_per_sphere(&self) -> f64 {
        self.all_s / self.spheres
    }
}

/// Quality over run time on one thread, for diameters of 2 mm to 3 mm without overlap: a table, and
/// plots in `doc`.
fn quality_table() -> std::result::Result<(), Error> {
    let surface = bending_sample()?;
    let mut out = std::io::stdout();
    writeln!(
        out,
        "| `--densify` | spheres | overall | interior | eigenvalue off 1/3, sigma | sizes off, of chance | removed | front, s | densification, s | spheres/s |\n\
         |---|---|---|---|---|---|---|---|---|---|"
    )?;
    let mut table = Vec::new();
    for densify in DENSIFY {
        let all = SEEDS
            .iter()
            .map(|seed| on_threads(1, || make(&surface, "2mm..3mm", Some(densify), *seed)))
            .collect::<Result<Vec<_>>>()
            .map_err(Error::other)?;
        let row = Quality::of(densify, &all);
        writeln!(
            out,
            "| {densify} | {:.0} | {:.4} | {:.4} | {:.1} | {:.2} | {:.1} | {:.2} | {:.2} | {:.0} |",
            row.spheres,
            row.overall,
            row.interior,
            row.anisotropy,
            row.size_error,
            row.removed,
            row.front_s,
            row.densifying_s,
            row.spheres / row.all_s,
        )?;
        table.push(row);
    }
    draw(&table)
}

/// Name of the file of a plot, its title, the label of its axis, and the value.
type Quantity = (
    &'static str,
    &'static str,
    &'static str,
    fn(&Quality) -> f64,
);

/// Draws density, isotropy and error of the sizes over run time.
fn draw(table: &[Quality]) -> std::result::Result<(), Error> {
    let doc = concat!(env!("CARGO_MANIFEST_DIR"), "/../../doc");
    let quantities: [Quantity; 3] = [
        (
            "density",
            "Density of the interior",
            "fraction of volume",
            |row| row.interior,
        ),
        (
            "isotropy",
            "Contact directions: chance gives about 2",
            "deviation of an eigenvalue (standard deviations)",
            |row| row.anisotropy,
        ),
        (
            "sizes",
            "Sizes placed: chance stays below 1 in 95 %",
            "distance from the requested sizes (of chance)",
            |row| row.size_error,
        ),
    ];
    for (name, title, label, value) in quantities {
        let point = |row: &Quality| Point {
            at: [row.seconds_per_sphere(), value(row)],
            filled: true,
            title: format!("--densify {}", row.densify),
            ..Point::default()
        };
        let plot = Plot {
            title: title.to_owned(),
            x: Axis::of("run time per sphere, one thread (s)"),
            y: Axis::of(label),
            marks: vec![Marks {
                points: table.iter().map(point).collect(),
                chains: vec![table.iter().map(|row| point(row).at).collect()],
                ..Marks::default()
            }],
            ..Plot::default()
        };
        std::fs::write(format!("{doc}/densify-{name}.svg"), plot.svg().file())?;
    }
    Ok(())
}

/// Time and memory over the number of spheres, on one thread and on two.
fn growth_table(counts: &[usize]) -> std::result::Result<(), Error> {
    let mut out = std::io::stdout();
    writeln!(
        out,
        "| spheres | threads | front, s | densifying, s | all, s | us/sphere | memory, bytes/sphere | interior | overall |\n\
         |---|---|---|---|---|---|---|---|---|"
    )?;
    for count in counts {
        for threads in ["1", "2"] {
            let program = std::env::current_exe()?;
            let status = Command::new(program)
                .args(["one", &count.to_string(), threads])
                .status()?;
            if !status.success() {
                return Err(Error::other(format!(
                    "{count} spheres on {threads} threads: {status}"
                )));
            }
        }
    }
    Ok(())
}

/// Time per sphere of a job on one thread, and its packing: medians over packings with different
/// seeds, since the number of steps that densifying needs varies from one to the next.
struct Timed {
    spheres: f64,
    all_us: f64,
    densifying_us: f64,
    densifying_steps: f64,
    /// Number of spheres that touch the wall.
    at_wall: f64,
    /// NaN if the shape has no interior for spheres of this size.
    interior: f64,
}

impl Timed {
    fn of(surface: &Surface, diameter: &str, basis: Basis) -> Result<Self> {
        let mut settings = BodySettings::new(PackSettings::new(Sizes::parse(diameter, basis)?));
        let boundary = Boundary::new(surface)?;
        let mut rows = Vec::new();
        for seed in TIMED_SEEDS {
            settings.packing.seed = seed;
            let (body, made) = on_threads(1, || make_body(surface, &settings, &|_, _| Ok(())))?;
            let (seconds, history) = (&made.seconds, &made.history);
            let all = seconds.packing + seconds.bonds + seconds.report;
            let spheres = made.quality.particles as f64;
            let interior = made.quality.interior_generating_density;
            rows.push([
                spheres,
                1e6 * all / spheres,
                1e6 * history.densify_seconds / spheres,
                history.densify_steps as f64,
                touching_the_wall(surface, &boundary, &body) as f64,
                interior.map_or(f64::NAN, |fraction| fraction.value),
            ]);
        }
        let median = |column: usize| {
            let mut values: Vec<f64> = rows.iter().map(|row| row[column]).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        Ok(Self {
            spheres: median(0),
            all_us: median(1),
            densifying_us: median(2),
            densifying_steps: median(3),
            at_wall: median(4),
            interior: median(5),
        })
    }
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
fn ratios() -> std::result::Result<(), Error> {
    let bar = |scale| shape("bar.stl", scale);
    let scan = cut_into_four(&shape("rock.stl", 1.0)?)?;
    let cases = [
        ("bar", bar(1.0)?, "1.2mm..1.5mm", Basis::Number),
        (
            "box of 28,000 spheres",
            bar(0.665)?,
            "0.956mm..1.195mm",
            Basis::Number,
        ),
        (
            "scan of 81,920 facets",
            scan,
            "0.956mm..1.195mm",
            Basis::Number,
        ),
        ("narrow sizes", bar(2.13)?, "2mm..3mm", Basis::Number),
        ("wide sizes, by mass", bar(0.56)?, "0.2mm..4mm", Basis::Mass),
    ];
    let mut out = std::io::stdout();
    writeln!(
        out,
        "| case | diameters | spheres | all, us/sphere | densifying, us/sphere | steps | spheres/s | touch the wall | interior |\n\
         |---|---|---|---|---|---|---|---|---|"
    )?;
    let mut timed = Vec::new();
    for (name, surface, diameter, basis) in cases {
        let row = Timed::of(&surface, diameter, basis).map_err(Error::other)?;
        let interior = if row.interior.is_nan() {
            "-".to_owned()
        } else {
            format!("{:.4}", row.interior)
        };
        writeln!(
            out,
            "| {name} | {diameter} | {} | {:.1} | {:.1} | {} | {:.0} | {} | {} |",
            row.spheres,
            row.all_us,
            row.densifying_us,
            row.densifying_steps,
            1e6 / row.all_us,
            row.at_wall,
            interior,
        )?;
        timed.push(row);
    }
    writeln!(
        out,
        "\ndensifying, scan over box: {:.2}; wide over narrow sizes: {:.2}",
        timed[2].densifying_us / timed[1].densifying_us,
        timed[4].all_us / timed[3].all_us
    )
}

/// The surface with each facet cut into four.
fn cut_into_four(surface: &Surface) -> std::result::Result<Surface, Error> {
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

/// Prints one line of the second table.
fn one_size(spheres: usize, threads: usize) -> std::result::Result<(), Error> {
    let surface = bending_sample()?;
    let before = peak_memory_bytes();
    let factor = (SPHERES_OF_1_35_MM / spheres as f64).cbrt();
    let diameter = format!("{}mm..{}mm", 1.2 * factor, 1.5 * factor);
    let started = Instant::now();
    let made = on_threads(threads, || {
        let settings = settings(&diameter, None, 1)?;
        let (body, made) = make_body(&surface, &settings, &|_, _| Ok(()))?;
        vtp::write(&body, &mut std::io::sink())
            .map_err(|e| Diagnostic::failed("", e.to_string(), ""))?;
        Ok(made)
    })
    .map_err(Error::other)?;
    let seconds = started.elapsed().as_secs_f64();
    let placed = made.quality.particles as f64;
    let memory = peak_memory_bytes().zip(before).map_or_else(
        || "-".to_owned(),
        |(peak, before)| format!("{:.0}", (peak - before) / placed),
    );
    writeln!(
        std::io::stdout(),
        "| {placed} | {threads} | {:.2} | {:.2} | {seconds:.2} | {:.1} | {memory} | {:.4} | {:.4} |",
        made.history.front_seconds,
        made.history.densify_seconds,
        1e6 * seconds / placed,
        made.quality
            .interior_generating_density
            .map_or(f64::NAN, |fraction| fraction.value),
        made.quality.generating_density,
    )
}

fn bending_sample() -> std::result::Result<Surface, Error> {
    shape("bending-sample.stl", 1.0)
}

/// A shape of `data/shapes`.
fn shape(name: &str, scale: f64) -> std::result::Result<Surface, Error> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/shapes");
    surface_of(&std::fs::read(format!("{folder}/{name}"))?, name, scale)
}

fn surface_of(stl: &[u8], name: &str, scale: f64) -> std::result::Result<Surface, Error> {
    let settings = ReadSettings {
        unit_m: 1e-3,
        scale,
        fill_holes: false,
    };
    surface_from_stl(stl, name, settings).map_err(Error::other)
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|e| Diagnostic::failed("", e.to_string(), ""))?
        .install(work)
}

fn make(surface: &Surface, diameter: &str, densify: Option<f64>, seed: u64) -> Result<BodyReport> {
    make_body(surface, &settings(diameter, densify, seed)?, &|_, _| Ok(())).map(|(_, made)| made)
}

/// Settings for spheres without overlap. Bonds join those that touch, so that the fabric is that of
/// the contacts.
fn settings(diameter: &str, densify: Option<f64>, seed: u64) -> Result<BodySettings> {
    Ok(BodySettings {
        packing: PackSettings {
            sizes: Sizes::parse(diameter, Basis::Number)?,
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
