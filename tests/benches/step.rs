//! The time step of dem-run for free bodies packed by dem-pack, on one thread and on all: `cargo
//! bench -p dem-tests --features benchmarks`.
//!
//! "bonds" is the pass over the bonds alone; "step" the complete step with failure, without
//! damping; "damped" the same with damping of the bonds.
#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a benchmark stops where it fails; criterion's macros write no documentation"
)]

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use dem_io::Body;
use dem_io::surface::{ReadSettings, read_surface};
use dem_pack::{Basis, BodySettings, BondSettings, PackSettings, Sizes, make_body};
use dem_run::plan::plan;
use dem_run::stages::bonds::forces::bond_wrenches;
use dem_run::state::State;
use dem_run::step::step;

const SHAPE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../data/shapes/bending-sample.stl"
);
/// Diameters, and the approximate numbers of particles and bonds.
const BODIES: [(&str, &str); 2] = [
    ("5mm..6mm", "1,100 particles, 5,400 bonds"),
    ("1.22mm..1.53mm", "78,000 particles, 380,000 bonds"),
];

const SCENE: &str = r#"
version = 1
[run]
end_time = "1 s"
[materials.cake]
density = "2050 kg/m3"
[bonds.cake]
young_modulus = "12.05 MPa"
poisson_ratio = 0.3
DAMPING
failure = { von_mises_strength = "185 kPa", equivalent_stress = "axial-in-tension" }
[bodies.cake]
file = "cake.vtp"
material = "cake"
bonds = "cake"
angular_velocity = [1.0, 0.0, 0.0]
"#;

/// The bending sample with as many bonds per particle as in Platzer 2022.
fn packed(diameters: &str) -> Body {
    let bytes = std::fs::read(SHAPE).expect("the shape is in the repository");
    let reading = ReadSettings {
        unit_m: Some(1e-3),
        scale: 1.0,
        fill_holes: false,
    };
    let surface = read_surface(&bytes, "", reading).expect("the shape is sound");
    let settings = BodySettings {
        packing: PackSettings {
            sizes: Sizes::parse(diameters, Basis::Number).expect("good diameters"),
            overlap: 0.0,
            seed: 1,
            densify: Some(0.0),
            seed_point_m: None,
        },
        bonds: BondSettings {
            per_particle: Some(4.87),
            ..BondSettings::default()
        },
        particle_density_kg_m3: None,
        solid_density_kg_m3: None,
    };
    let (body, _) = make_body(&surface, &settings, &|_, _| Ok(())).expect("packs");
    body
}

fn state(body: &Body, damping: &str, threads: usize) -> State {
    let text = SCENE.replace("DAMPING", damping);
    let scene = dem_scene::scene_from_text(&text, "bench.toml", &[]).expect("a good scene");
    let bodies = BTreeMap::from([("cake".to_owned(), body.clone())]);
    plan(&scene, bodies, threads, false).expect("plans").state
}

fn steps(criterion: &mut Criterion) {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    for (diameters, name) in BODIES {
        let body = packed(diameters);
        for threads in [1, all] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads start");
            let mut group = criterion.benchmark_group(format!("{name}, {threads} threads"));
            group
                .sampling_mode(SamplingMode::Flat)
                .sample_size(20)
                .warm_up_time(Duration::from_millis(500))
                .measurement_time(Duration::from_secs(4))
                .throughput(Throughput::Elements(body.bonds.len() as u64));
            // Inside the pool, so that a step does not have to enter it.
            let timed = |rounds: u64, work: &mut (dyn FnMut() + Send)| {
                pool.install(|| {
                    let start = Instant::now();
                    (0..rounds).for_each(|_| work());
                    start.elapsed()
                })
            };
            let mut free = state(&body, "", threads);
            group.bench_function("bonds", |b| {
                b.iter_custom(|rounds| {
                    timed(rounds, &mut || {
                        let p = &mut free.particles;
                        bond_wrenches(
                            &free.bonds,
                            &p.poses,
                            &mut free.scratch.partitions,
                            &mut p.wrenches,
                        );
                    })
                });
            });
            group.bench_function("step", |b| {
                b.iter_custom(|rounds| {
                    timed(rounds, &mut || {
                        step(&mut free);
                    })
                });
            });
            let mut damped = state(&body, "damping = { damping_ratio = 0.1 }", threads);
            group.bench_function("damped", |b| {
                b.iter_custom(|rounds| {
                    timed(rounds, &mut || {
                        step(&mut damped);
                    })
                });
            });
            group.finish();
        }
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
