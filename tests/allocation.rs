//! After warm-up a frame allocates nothing.

use allocation_counter::measure;
use glam::{DVec2, Vec2};
use twelvefold::{
    Amount, Domain, ImageMap, InvalidPixels, PixelData, PixelView, Placement, Sampling,
};

#[test]
fn the_counter_counts() {
    assert_ne!(measure(|| drop(std::hint::black_box(vec![0u8; 100]))).count_total, 0);
}

#[test]
fn a_frame_allocates_nothing() {
    let pixels: Vec<f32> = (0..480 * 270).map(|i| (i % 97) as f32).collect();
    let bytes: Vec<u8> = pixels.iter().map(|p| *p as u8).collect();
    let mut map = ImageMap::new(480, 270, pixels.clone(), InvalidPixels::Reject).unwrap();
    let mut buffer = vec![Vec2::ZERO; 70_000];
    let (mut x, mut y) = (vec![0.0f64; 70_000], vec![0.0f64; 70_000]);
    let mut count = 0;
    let mut frame = || {
        let view = PixelView::new(PixelData::F32(&pixels), 480, 270).unwrap();
        map.update(&view, InvalidPixels::Reject).unwrap();
        let patch = PixelView::strided(PixelData::U8(&bytes), 100, 50, 480).unwrap();
        map.update_at(17, 31, &patch, InvalidPixels::ZeroAll).unwrap();
        let placement = Placement::new(map.domain(), 7);
        let sampling = Sampling::new(&placement, &map, Amount::Points(60_000.0)).unwrap();
        count += sampling.fill(&mut buffer).unwrap().written;
        count += sampling.fill_columns(&mut x, &mut y).unwrap().written;
        let rectangle = Domain::new(DVec2::splat(50.0), DVec2::splat(80.0)).unwrap();
        count += sampling.clipped(rectangle).points::<Vec2>().unwrap().count();
        let part = sampling.divide(3).unwrap().part(1).unwrap();
        count += part.points::<DVec2>().unwrap().count();
    };
    frame();
    let counted = measure(frame);
    assert_eq!((counted.count_total, counted.bytes_total), (0, 0));
    assert!(count > 2 * 2 * 59_000, "{count}");
}
