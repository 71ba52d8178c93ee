#[path = "../../benches/common/mod.rs"]
mod common;
use glam::Vec2;
use std::time::{Duration, Instant};
fn main() {
    let filter = std::env::args().nth(1).unwrap_or_default();
    let counts: Vec<usize> = std::env::args().nth(2).unwrap_or("4096,65536,1048576".into()).split(',').map(|s| s.parse().unwrap()).collect();
    let names = std::env::args().nth(3).unwrap_or("memcpy,twelvefold".into());
    let maps = common::maps::all();
    let mut sets = vec![("uniform".to_string(), common::uniform())];
    for map in &maps { sets.push((map.name.to_string(), common::image(map))); }
    for (title, set) in &sets {
        if !title.contains(&filter) { continue; }
        println!("== {title}");
        for &n in &counts {
            let mut buffer = vec![Vec2::ONE; n + n / 8 + 64];
            let mut run: Vec<_> = set.iter().filter(|c| n <= c.most && names.split(',').any(|x| c.name.starts_with(x))).map(|c| (c, (c.prepare)(n), f64::INFINITY)).collect();
            for _ in 0..9 { for (_, make, least) in run.iter_mut() {
                let (mut made, mut calls) = (0, 0);
                let start = Instant::now();
                while calls == 0 || start.elapsed() < Duration::from_millis(4) {
                    for _ in 0..(4096 / n).max(1) { made += std::hint::black_box(make(&mut buffer)); calls += 1; }
                }
                *least = least.min(start.elapsed().as_nanos() as f64 / made as f64);
            }}
            print!("{n:9}");
            for (c, _, least) in &run { print!("  {}: {:.2}", c.name, least); }
            println!();
        }
    }
}
