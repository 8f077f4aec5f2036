//! The individual stages of dem-pack for the bending sample with 14,000 and 87,000 spheres, on one
//! thread and on all: `cargo bench -p dem-tests --features benchmarks --bench packer`.
//!
//! The stages between the surface and the body are timed by the program's own clock, as in the
//! report of dem-pack: complete bodies are made, and each stage has its times from all of them. The
//! rest is timed from outside.
#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a benchmark stops where it fails; criterion's macros write no documentation"
)]

use std::cell::LazyCell;
use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};
use dem_io::Body;
use dem_io::body::vtp;
use dem_io::surface::{ReadSettings, Surface, read_surface};
use dem_pack::{Basis, BodyReport, BodySettings, BondSettings, PackSettings, Sizes, make_body};
use rayon::ThreadPool;

const SAMPLES: usize = 10;
const SHAPES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/shapes");
/// Diameters, and the approximate numbers of spheres.
const SIZES: [(&str, &str); 2] = [
    ("2.2mm..2.75mm", "14,000 spheres"),
    ("1.2mm..1.5mm", "87,000 spheres"),
];

/// A stage, and its time in seconds.
type Stage = (&'static str, fn(&BodyReport) -> f64);

const BARE_FRONT: [Stage; 1] = [("bare front", |made| made.history.front_seconds)];
const SETTLED: [Stage; 5] = [
    ("front", |made| made.history.front_seconds),
    ("densification", |made| made.history.densify_seconds),
    ("voids", |made| made.history.fill_seconds),
    ("bonds", |made| made.seconds.bonds),
    ("report", |made| made.seconds.report),
];

fn stages(criterion: &mut Criterion) {
    surface_reading(criterion);
    let surface = read(&file("bending-sample.stl"));
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    for (diameter, size) in SIZES {
        for threads in [1, all] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads start");
            let name = format!("{size}, {threads} of {all} threads");
            let mut group = criterion.benchmark_group(&name);
            group.sample_size(SAMPLES).sampling_mode(SamplingMode::Flat);
            // So short that criterion asks only once for each time.
            group
                .warm_up_time(Duration::from_nanos(1))
                .measurement_time(Duration::from_nanos(1));
            by_own_clock(&mut group, &surface, &pool, &bare(diameter), &BARE_FRONT);
            by_own_clock(&mut group, &surface, &pool, &settled(diameter), &SETTLED);
            group.finish();
            if all == 1 {
                break;
            }
        }
    }
    let (body, _) =
        make_body(&surface, &bare(SIZES[1].0), &|_, _| Ok(())).expect("the sample can be packed");
    body_files(criterion, &body);
}

/// Facets -> solid; the rock is the shape with the most facets.
fn surface_reading(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("surface reading");
    group.sample_size(SAMPLES);
    for name in ["bending-sample.stl", "rock.stl"] {
        let bytes = file(name);
        group.bench_function(name, |bencher| bencher.iter(|| read(black_box(&bytes))));
    }
    group.finish();
}

/// Measures each stage by its times from the same `SAMPLES` bodies, which are made for the first
/// stage.
fn by_own_clock(
    group: &mut BenchmarkGroup<WallTime>,
    surface: &Surface,
    pool: &ThreadPool,
    settings: &BodySettings,
    stages: &[Stage],
) {
    let bodies: LazyCell<Vec<BodyReport>, _> = LazyCell::new(|| {
        let make = || {
            make_body(surface, settings, &|_, _| Ok(()))
                .expect("the sample can be packed")
                .1
        };
        (0..SAMPLES).map(|_| pool.install(make)).collect()
    });
    for (name, seconds) in stages {
        let mut next = 0;
        group.bench_function(*name, |bencher| {
            bencher.iter_custom(|iterations| {
                next += 1;
                Duration::from_secs_f64(iterations as f64 * seconds(&bodies[next % SAMPLES]))
            });
        });
    }
}

/// Writes a body as .vtp into memory and reads it back.
fn body_files(criterion: &mut Criterion, body: &Body) {
    let mut bytes = Vec::new();
    vtp::write(body, &mut bytes).expect("memory can be written to");
    let mut group = criterion.benchmark_group("body of 87,000 spheres");
    group
        .sample_size(SAMPLES)
        .throughput(Throughput::Bytes(bytes.len() as u64));
    group.bench_function("writing", |bencher| {
        bencher.iter(|| {
            let mut bytes = Vec::with_capacity(bytes.len());
            vtp::write(black_box(body), &mut bytes).expect("memory can be written to");
            bytes
        });
    });
    group.bench_function("reading", |bencher| {
        bencher.iter(|| vtp::read(&mut black_box(bytes.as_slice())).expect("it was just written"));
    });
    group.finish();
}

fn settled(diameter: &str) -> BodySettings {
    let mut settings = bare(diameter);
    settings.packing.densify = None;
    settings
}

fn bare(diameter: &str) -> BodySettings {
    BodySettings {
        packing: PackSettings {
            sizes: Sizes::parse(diameter, Basis::Number).expect("sizes"),
            overlap: 0.0,
            seed: 1,
            densify: Some(0.0),
            seed_point_m: None,
        },
        bonds: BondSettings::default(),
        particle_density_kg_m3: None,
        solid_density_kg_m3: None,
    }
}

fn file(name: &str) -> Vec<u8> {
    std::fs::read(format!("{SHAPES}/{name}")).expect("the shapes lie in data/shapes")
}

fn read(bytes: &[u8]) -> Surface {
    read_surface(
        bytes,
        "",
        ReadSettings {
            unit_m: Some(1e-3),
            scale: 1.0,
            fill_holes: false,
        },
    )
    .expect("the shapes are closed")
}

criterion_group!(benches, stages);
criterion_main!(benches);
