//! Contenders as groups of Criterion benches.

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use glam::Vec2;

use twelvefold_lab::contenders::Contender;

/// Numbers of points.
const COUNTS: [usize; 4] = [1 << 6, 1 << 12, 1 << 16, 1 << 20];

/// Few and short samples: there are many benches.
pub fn criterion() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600))
}

/// A group for each number of points; each contender's count is checked first.
pub fn bench(criterion: &mut Criterion, title: &str, contenders: &[Contender<'_>]) {
    for n in COUNTS {
        let mut group = criterion.benchmark_group(format!("{title}/{n}"));
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
