//! Stipplers side by side: how well, and how fast, each draws the same photographs with as many dots.
//!
//! Each line holds means over the photographs: dots; tone error at 1, 2 and 4 spacings; PSNR at 1 spacing; structural
//! similarity at 0.7; nearest distance, first percentile and mean, local hexagonal distance = 1; seconds.

use std::path::Path;
use std::time::Instant;

use glam::DVec2;
use twelvefold::refine::{best, refine};
use twelvefold::{
    Amount, ImageMap, Importance, InvalidPixels, Pixels, Placement, Sampling, SamplingError,
    StippleMap,
};
use twelvefold_files::failure::Failure;
use twelvefold_files::picture::{self, Picture, Tone};
use twelvefold_files::point_list;
use twelvefold_lab::measure::stippling::{Gray, Stippling, stippling};
use twelvefold_lab::stipplers::{Darkness, floyd_steinberg, linked_voronoi, weighted_voronoi};

use crate::args::StipplersOptions;

/// Rounds of weighted Voronoi relaxation: more change no figure by a percent.
const ROUNDS: usize = 100;

type Anything = Box<dyn std::error::Error>;
type Method = (&'static str, fn(&Picture, usize) -> Result<Vec<DVec2>, Anything>);

/// Ours first.
const METHODS: [Method; 9] = [
    ("fixed", |picture, n| sampled(picture, n, fixed)),
    ("relaxed", |picture, n| sampled(picture, n, relaxed)),
    ("refined, 3", |picture, n| refined(picture, n, 3)),
    ("refined, 10", |picture, n| refined(picture, n, 10)),
    ("refined, 20", |picture, n| refined(picture, n, 20)),
    ("best", |picture, n| {
        let mut dots = sampled(picture, n, relaxed)?;
        best(&mut dots, picture.width, picture.height, &picture.importance, 10)?;
        Ok(dots)
    }),
    ("weighted Voronoi", |picture, n| Ok(weighted_voronoi(&darkness(picture)?, n, ROUNDS, 1))),
    ("linked Voronoi", |picture, n| Ok(linked_voronoi(&darkness(picture)?, n, 1))),
    ("Floyd-Steinberg", |picture, n| Ok(floyd_steinberg(&darkness(picture)?, n))),
];

/// Runs the subcommand.
pub(crate) fn run(options: &StipplersOptions) -> Result<(), Failure> {
    let read = |path: &std::path::PathBuf| {
        let picture =
            picture::read(path, Tone::default()).map_err(|error| Failure::at(path, error))?;
        let values = picture.importance.iter().map(|value| f64::from(*value)).collect();
        let gray = Gray::new(picture.width, values).map_err(|error| Failure::at(path, error))?;
        Ok((picture, gray))
    };
    let photos = options.photos.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
    println!(
        "{:<18} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>8}",
        "", "dots", "t1", "t2", "t4", "psnr", "ssim.7", "near1%", "nearest", "seconds"
    );
    for (name, method) in METHODS {
        let mut mean = Mean::default();
        for ((picture, gray), path) in photos.iter().zip(&options.photos) {
            let start = Instant::now();
            let dots = method(picture, options.points as usize)
                .map_err(|error| Failure::at(path, error))?;
            let seconds = start.elapsed().as_secs_f64();
            mean.add(
                &stippling(gray, &dots).map_err(|error| Failure::at(path, error))?,
                Some(seconds),
            );
        }
        mean.print(name);
    }
    for lists in options.lists.chunks(photos.len()) {
        let mut mean = Mean::default();
        for ((_, gray), path) in photos.iter().zip(lists) {
            mean.add(&listed(path, gray)?, None);
        }
        let name = lists.first().and_then(|path| path.file_stem()).unwrap_or_default();
        mean.print(&name.to_string_lossy());
    }
    Ok(())
}

/// The figures of dots in a file.
fn listed(path: &Path, gray: &Gray) -> Result<Stippling, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::at(path, error))?;
    let dots = point_list::parse(&text).map_err(|error| Failure::at(path, error))?;
    stippling(gray, &dots).map_err(|error| Failure::at(path, error))
}

/// Sums of figures.
#[derive(Default)]
struct Mean {
    count: f64,
    sums: [f64; 8],
    seconds: Option<f64>,
}

impl Mean {
    fn add(&mut self, found: &Stippling, seconds: Option<f64>) {
        let [one, two, four] = found.tone;
        let [_, near] = found.ssim;
        let (least, mean) = (found.nearest_low, found.nearest_mean);
        let figures = [found.dots as f64, one, two, four, found.psnr, near, least, mean];
        self.sums.iter_mut().zip(figures).for_each(|(sum, figure)| *sum += figure);
        self.count += 1.0;
        self.seconds = seconds.map(|seconds| self.seconds.unwrap_or(0.0) + seconds);
    }

    fn print(&self, name: &str) {
        let [dots, one, two, four, psnr, ssim, least, mean] = self.sums.map(|sum| sum / self.count);
        let seconds =
            self.seconds.map_or_else(String::new, |sum| format!("{:.3}", sum / self.count));
        println!(
            "{name:<18} {dots:>6.0} {one:>6.4} {two:>6.4} {four:>6.4} {psnr:>6.2} {ssim:>6.3} \
             {least:>6.3} {mean:>6.3} {seconds:>8}"
        );
    }
}

fn darkness(picture: &Picture) -> Result<Darkness<'_>, Anything> {
    Darkness::new(picture.width, &picture.importance)
        .ok_or_else(|| "is white, which leaves no place for dots".into())
}

/// How a map is sampled.
type Sampler = fn(Pixels, f64) -> Result<Vec<DVec2>, Anything>;

/// Points of a sampling of a picture.
fn sampled(picture: &Picture, n: usize, sampler: Sampler) -> Result<Vec<DVec2>, Anything> {
    let pixels = picture.importance.clone();
    let pixels = Pixels::new(picture.width, picture.height, pixels, InvalidPixels::Reject)?;
    sampler(pixels, n as f64)
}

fn fixed(pixels: Pixels, n: f64) -> Result<Vec<DVec2>, Anything> {
    let map = ImageMap::new(pixels)?;
    let placement = Placement::new(map.domain(), 0);
    collect(&Sampling::new(&placement, &map, Amount::Points(n))?)
}

fn relaxed(pixels: Pixels, n: f64) -> Result<Vec<DVec2>, Anything> {
    let map = StippleMap::new(pixels, n)?;
    let placement = Placement::new(map.domain(), 0);
    collect(&Sampling::new(&placement, &map, Amount::Points(n))?.relaxed()?)
}

fn collect<I: Importance>(sampling: &Sampling<'_, I>) -> Result<Vec<DVec2>, Anything> {
    let points = sampling.points::<DVec2>()?.map(|point| point.map(|point| point.position));
    Ok(points.collect::<Result<_, SamplingError>>()?)
}

fn refined(picture: &Picture, n: usize, iterations: usize) -> Result<Vec<DVec2>, Anything> {
    let mut dots = sampled(picture, n, relaxed)?;
    refine(&mut dots, picture.width, picture.height, &picture.importance, iterations)?;
    Ok(dots)
}
