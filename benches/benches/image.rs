//! Importance maps of 1024 × 1024 pixels: memcpy, ours, and ways to draw from a discrete distribution;
//! the cost of changing a map; what probed bounds lose.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec2;
use twelvefold::{
    Amount, ImageMap, InvalidPixels, PixelData, PixelView, Placement, Probed, Sampling,
};
use twelvefold_lab::{contenders, maps};

fn points(criterion: &mut Criterion) {
    for map in &maps::all() {
        twelvefold_benches::bench(criterion, map.name, &contenders::image(map));
    }
}

fn probed(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("probed");
    for map in &maps::all() {
        let map_name = map.name;
        let map = &map.importance;
        let placement = Placement::new(map.domain(), 1);
        let amount = Amount::Points(65536.0);
        let mut buffer = vec![Vec2::ZERO; 80_000];
        let whole = Sampling::new(&placement, map, amount).expect("a sampling");
        let all = whole.fill(&mut buffer).expect("sound bounds").written;
        for headroom in [1.0, 2.0] {
            let probed = Probed::new(map, map.domain(), headroom);
            let sampling = Sampling::new(&placement, &probed, amount).expect("a sampling");
            let found = sampling.fill(&mut buffer).expect("sound values").written;
            assert!(found <= all);
            let missed = 100.0 * (all - found) as f64 / all as f64;
            println!("probed, headroom {headroom}, {map_name}: {missed:.3} % missed");
            group.bench_function(format!("{map_name}/headroom {headroom}"), |bencher| {
                bencher.iter(|| sampling.fill(&mut buffer));
            });
        }
    }
    group.finish();
}

fn update(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("update of 1024 × 1024 pixels");
    let [map, ..] = maps::all();
    let pixels = map.importance.pixels().to_vec();
    let bytes: Vec<u8> = pixels.iter().map(|pixel| (pixel * 100.0) as u8).collect();
    let mut map: ImageMap = map.importance;
    let mut copy = pixels.clone();
    group.bench_function("memcpy of f32 pixels", |bencher| {
        bencher.iter(|| copy.copy_from_slice(black_box(&pixels)));
    });
    for (name, data, size) in [
        ("whole, f32", PixelData::F32(&pixels), 1024),
        ("whole, u8", PixelData::U8(&bytes), 1024),
        ("64 × 64, f32", PixelData::F32(&pixels), 64),
    ] {
        let view = PixelView::strided(data, size, size, 1024).expect("pixels enough");
        group.bench_function(name, |bencher| {
            bencher.iter(|| map.update_at(0, 0, &view, InvalidPixels::Reject));
        });
        assert_eq!(map.update_at(0, 0, &view, InvalidPixels::Reject), Ok(()));
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = twelvefold_benches::criterion();
    targets = points, probed, update
}
criterion_main!(benches);
