//! The time step of dem-run for 20,000 single spheres with contacts as in a settled heap, on one
//! thread and on all: `cargo bench -p dem-tests --features benchmarks --bench heap`.
//!
//! "contacts" is the pass over the contacts alone; "step" the complete step; "relist" the search
//! for near pairs, which a settled heap rarely needs.
#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a benchmark stops where it fails; criterion's macros write no documentation"
)]

mod bed;

use std::time::{Duration, Instant};

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use dem_run::stages::contacts::forces::{contact_wrenches, list_contacts};
use dem_run::state::State;
use dem_run::step::step;

fn heaps(criterion: &mut Criterion) {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    for threads in [1, all] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads start");
        let mut state = bed::bed(threads);
        let mut group = criterion.benchmark_group(format!("heap, {threads} threads"));
        group
            .sampling_mode(SamplingMode::Flat)
            .sample_size(20)
            .warm_up_time(Duration::from_millis(500))
            .measurement_time(Duration::from_secs(4))
            .throughput(Throughput::Elements(state.particles.len() as u64));
        // Inside the pool, so that a step does not have to enter it.
        let mut bench = |name: &str, work: &(dyn Fn(&mut State) + Sync)| {
            group.bench_function(name, |b| {
                b.iter_custom(|rounds| {
                    pool.install(|| {
                        let start = Instant::now();
                        (0..rounds).for_each(|_| work(&mut state));
                        start.elapsed()
                    })
                });
            });
        };
        bench("contacts", &|state| {
            let contacts = state.contacts.as_mut().expect("has contacts");
            contact_wrenches(contacts, &mut state.particles, state.time_step_s);
        });
        bench("step", &|state| {
            step(state);
        });
        bench("relist", &|state| {
            let contacts = state.contacts.as_mut().expect("has contacts");
            let clusters = state.clusters.as_ref().expect("can touch");
            let skin_m = contacts.skin_m;
            list_contacts(contacts, &clusters.of_particle, &state.particles, skin_m);
        });
        group.finish();
    }
}

criterion_group!(benches, heaps);
criterion_main!(benches);
