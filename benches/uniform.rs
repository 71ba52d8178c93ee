//! Uniform density: memcpy, ours at each baked depth, sequences, Bridson.

mod common;

use criterion::{Criterion, criterion_group, criterion_main};

fn points(criterion: &mut Criterion) {
    common::groups::bench(criterion, "uniform", &common::uniform());
}

criterion_group! {
    name = benches;
    config = common::groups::criterion();
    targets = points
}
criterion_main!(benches);
