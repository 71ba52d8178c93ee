//! The goals set for this crate, as ratios within one run, and what was measured.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use twelvefold::{InvalidPixels, PixelData, PixelView};

use twelvefold_lab::maps;

use super::Table;

const MILLION: usize = 1 << 20;

/// Markdown.
pub(crate) fn table(tables: &[Table]) -> String {
    let [uniform, smooth, textured, edges, bright] = tables else { return String::new() };
    let memcpy = |n| uniform.at("memcpy", n);
    let ours = |table: &Table, n| table.at("twelvefold", n);
    let mut text = String::from("| goal | asked | measured | |\n|---|---:|---:|---|\n");
    let mut at_least = |goal: &str, asked: f64, measured: f64| {
        let met = if measured >= asked { "met" } else { "missed" };
        let _ = writeln!(text, "| {goal} | ≥ {asked} | {measured:.2} | {met} |");
    };
    let uniform_million = (2..=4)
        .map(|depth| uniform.at(&format!("twelvefold, baked depth {depth}"), MILLION))
        .fold(f64::INFINITY, f64::min);
    let default_million = uniform.at("twelvefold, baked depth 3", MILLION);
    at_least(
        "uniform, 1M, default depth: share of memcpy's speed",
        0.8,
        memcpy(MILLION) / default_million,
    );
    at_least("the same at the best depth", 0.8, memcpy(MILLION) / uniform_million);
    for (name, table) in [("smooth", smooth), ("textured", textured), ("hard-edged", edges)] {
        let here = ours(table, MILLION);
        at_least(&format!("{name} map, 1M: share of memcpy's speed"), 0.25, memcpy(MILLION) / here);
        at_least(
            &format!("{name} map, 1M: times alias + jitter"),
            10.0,
            table.at("alias", MILLION) / here,
        );
        at_least(
            &format!("{name} map, 1M: times inverse CDF + Sobol"),
            40.0,
            table.at("inverse CDF + Owen", MILLION) / here,
        );
        at_least(
            &format!("{name} map, 4k: times alias + jitter"),
            1.0,
            table.at("alias", 4096) / ours(table, 4096),
        );
    }
    {
        let maps = [("uniform", uniform), ("smooth map", smooth), ("textured map", textured)];
        for (name, table) in maps {
            for n in [MILLION, 16 * MILLION] {
                let one = match name {
                    "uniform" => table.at("twelvefold, baked depth 3", n),
                    _ => ours(table, n),
                };
                at_least(
                    &format!("{name}, {}M: two threads over one", n >> 20),
                    1.7,
                    one / table.at("two threads", n),
                );
            }
            at_least(
                &format!("{name}, relaxed, 1M: two threads over one"),
                1.7,
                table.at("twelvefold, relaxed", MILLION)
                    / table.at("two threads, relaxed", MILLION),
            );
        }
    }
    let mut at_most = |goal: &str, asked: f64, measured: f64| {
        let met = if measured <= asked { "met" } else { "missed" };
        let _ = writeln!(text, "| {goal} | ≤ {asked} | {measured:.2} | {met} |");
    };
    at_most(
        "high dynamic range over smooth, ns a point, 1M",
        1.5,
        ours(bright, MILLION) / ours(smooth, MILLION),
    );
    let flat = [1 << 16, 1 << 20, 1 << 24].map(|n| ours(smooth, n));
    let (least, most) = flat.iter().fold((f64::MAX, 0.0f64), |(a, b), t| (a.min(*t), b.max(*t)));
    at_most("smooth map: dearest over cheapest point, 64k to 16M", 1.5, most / least);
    for (name, table) in
        [("smooth", smooth), ("textured", textured), ("high dynamic range", bright)]
    {
        at_most(&format!("{name} map, 64 points, µs"), 5.0, ours(table, 64) * 0.064);
        for n in [16, 64, 256] {
            at_most(
                &format!("{name} map, {n} points, over alias + jitter"),
                3.0,
                ours(table, n) / table.at("alias", n),
            );
        }
        at_most(
            &format!("{name} map, 1024 points, over inverse CDF + Sobol"),
            1.0,
            ours(table, 1024) / table.at("inverse CDF + Owen", 1024),
        );
    }
    at_most(
        "uniform, 1M: relaxed over fixed, ns a point",
        1.3,
        uniform.at("twelvefold, relaxed", MILLION) / default_million,
    );
    for (name, table) in [("smooth", smooth), ("textured", textured), ("hard-edged", edges)] {
        for (mode, row) in
            [("relaxed", "twelvefold, relaxed"), ("stipple map", "twelvefold, relaxed stipple")]
        {
            let relaxed = table.at(row, MILLION) / ours(table, MILLION);
            at_most(&format!("{name} map, 1M: {mode} over fixed, ns a point"), 1.3, relaxed);
        }
    }
    at_most("map of 1024² pixels replaced in place, in memcpys of its pixels", 3.0, update());
    text
}

/// Time of replacing all pixels, checks and copy included, over the time of copying them.
fn update() -> f64 {
    let [smooth, ..] = maps::all();
    let pixels = smooth.importance.pixels().to_vec();
    let mut map = smooth.importance;
    let mut copy = pixels.clone();
    let view = PixelView::new(PixelData::F32(&pixels), 1024, 1024).expect("1024² pixels");
    let (mut copying, mut updating) = (f64::MAX, f64::MAX);
    for _ in 0..30 {
        let start = Instant::now();
        copy.copy_from_slice(black_box(&pixels));
        black_box(&copy);
        copying = copying.min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        map.update(&view, InvalidPixels::Reject).expect("valid pixels");
        updating = updating.min(start.elapsed().as_secs_f64());
    }
    updating / copying
}
