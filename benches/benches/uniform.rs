//! Uniform density: memcpy, ours at each baked depth, sequences, Bridson.

use criterion::{Criterion, criterion_group, criterion_main};
use twelvefold_lab::contenders;

fn points(criterion: &mut Criterion) {
    twelvefold_benches::bench(criterion, "uniform", &contenders::uniform());
}

criterion_group! {
    name = benches;
    config = twelvefold_benches::criterion();
    targets = points
}
criterion_main!(benches);
