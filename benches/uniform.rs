//! Uniform density: memcpy, ours at each baked depth, sequences, Bridson.

mod common;

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec2;

fn bench(criterion: &mut Criterion) {
    let contenders = common::uniform();
    for n in [1 << 6, 1 << 12, 1 << 16, 1 << 20] {
        let mut group = criterion.benchmark_group(format!("uniform/{n}"));
        group.throughput(Throughput::Elements(n as u64));
        let mut buffer = vec![Vec2::ZERO; n + n / 8 + 64];
        for contender in contenders.iter().filter(|contender| n <= contender.most) {
            let mut make = (contender.prepare)(n);
            contender.assert_count(n, make(&mut buffer));
            group.bench_function(BenchmarkId::from_parameter(&contender.name), |bencher| {
                bencher.iter(|| make(&mut buffer));
            });
        }
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600));
    targets = bench
}
criterion_main!(benches);
