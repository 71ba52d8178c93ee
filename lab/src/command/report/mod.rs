//! `twelvefold report`: what a sample costs and how much error it leaves, against what else is in use.

mod curves;
mod samplers;
mod scenes;
mod tone;
mod variants;

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use glam::DVec2;
use twelvefold::{
    Amount, EnvironmentMap, ImageMap, InvalidPixels, Placement, Sampling, StippleMap,
};

use crate::args::ReportOptions;
use curves::{Curve, Measured, Scene};
use samplers::{FOLLOWING, Kind, Target, UNIFORM};
use scenes::{Instance, Lighting, PLANES, skies};
use twelvefold_files::failure::Failure;
use twelvefold_files::output::Output;
use twelvefold_files::picture::{self, Tone};

/// Numbers of samples.
const SIZES: [usize; 7] = [16, 64, 256, 1024, 4096, 16_384, 65_536];

/// Sizes for which the tables state the time.
const TIMED: [usize; 2] = [256, 16_384];

/// Placements for a figure: as many as keep the whole report to minutes.
const SEEDS: u64 = 32;

/// Fewer dots than these make no tone.
const LEAST_DOTS: usize = 256;

/// Placements for a tone error, which is itself a mean over a picture.
const TONE_SEEDS: u64 = 4;

/// A part of the report: what its files are called, its title, what is to be said, and the scenes.
struct Group {
    name: &'static str,
    title: &'static str,
    remark: &'static str,
    scenes: Vec<Scene>,
}

/// Runs the subcommand.
pub(crate) fn run(options: &ReportOptions) -> Result<(), Failure> {
    let folder = &options.output;
    fs::create_dir_all(folder).map_err(|error| Failure::at(folder, error))?;
    let sizes: Vec<usize> = SIZES.into_iter().filter(|n| *n <= options.samples).collect();
    let say = |text: &str| {
        if !options.quiet {
            // Stderr may be closed; the report is written all the same.
            let _ = writeln!(std::io::stderr(), "twelvefold-lab: {text}");
        }
    };

    // What cannot be read is known before anything is measured.
    let photo = photo(options)?;
    let lights = lights(options)?;
    say("functions of the square");
    let mut groups = vec![Group {
        name: "uniform",
        title: "Constant importance",
        remark: UNIFORM_REMARK,
        scenes: uniform_scenes(&sizes),
    }];
    let mut scenes = Vec::new();
    for light in &lights {
        say(&format!("light of {}", light.name));
        scenes.extend(lighting_scenes(light, &sizes));
    }
    let title = "Light of an environment on eight surfaces";
    groups.push(Group { name: "lighting", title, remark: LIGHTING_REMARK, scenes });
    say("tone of a stippled photograph");
    let (title, scenes) = ("Tone of a stippled picture", tone_scene(&photo, &sizes));
    groups.push(Group { name: "tone", title, remark: TONE_REMARK, scenes });

    let (mut markdown, csv) = write_scenes(folder, &groups, &sizes)?;
    say("variants");
    markdown += VARIANTS;
    let timed: Vec<usize> = TIMED.into_iter().chain([1 << 18]).collect();
    markdown += &variants::table(&photo, &timed);
    write_file(&folder.join("report.csv"), &csv)?;
    write_file(&folder.join("report.md"), &markdown)
}

/// The built-in skies, then the environment maps that were named.
fn lights(options: &ReportOptions) -> Result<Vec<Lighting>, Failure> {
    let skies = skies().map_err(|error| Failure::about("skies", error))?;
    let mut lights: Vec<Lighting> =
        skies.into_iter().map(|(name, map)| Lighting::new(name.to_owned(), map)).collect();
    for path in &options.environments {
        let light = picture::read_radiance(path).map_err(|error| Failure::at(path, error))?;
        let (width, height) = (light.width, light.height);
        let map = EnvironmentMap::new(width, height, light.pixels, InvalidPixels::ZeroNegative)
            .map_err(|error| Failure::at(path, error))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        lights.push(Lighting::new(name, map));
    }
    Ok(lights)
}

/// The photograph whose tone is followed.
fn photo(options: &ReportOptions) -> Result<ImageMap, Failure> {
    let Some(path) = &options.photo else { return Ok(tone::drawing()) };
    let tone = Tone { linear: false, invert: false, ..Tone::default() };
    let photo = picture::read(path, tone).map_err(|error| Failure::at(path, error))?;
    ImageMap::new(photo.width, photo.height, photo.importance, InvalidPixels::Reject)
        .map_err(|error| Failure::at(path, error))
}

/// Writes a picture a scene; returns what report.md says of them, and report.csv.
fn write_scenes(
    folder: &Path,
    groups: &[Group],
    sizes: &[usize],
) -> Result<(String, String), Failure> {
    let mut csv = String::from("group,scene,sampler,n,error,seconds\n");
    let mut markdown = String::from(INTRODUCTION);
    for Group { name, title, remark, scenes } in groups {
        markdown += &format!("## {title}\n\n{remark}\n\n");
        for (i, scene) in scenes.iter().enumerate() {
            scene.csv(name, &mut csv);
            markdown += &scene.markdown(sizes, &TIMED);
            let picture = format!("{name}-{}.svg", i + 1);
            markdown += &format!("![{}]({picture})\n\n", scene.name);
            let svg = scene.svg().map_err(|error| Failure::about("plot", error))?;
            write_file(&folder.join(picture), &svg)?;
        }
        markdown += &winners(scenes, sizes.last().copied().unwrap_or(0));
    }
    Ok((markdown, csv))
}

const INTRODUCTION: &str = "\
# Error and time

Root-mean-square error over 32 fixed seeds (random placements, shifts or scramblings; for light, over all eight \
surfaces with each), in percent of the mean integral, and the least time to make one set with its weights (placement included), nanoseconds a \
sample, on one thread. Preparation of a map (pyramids, cumulative sums, alias table) is not in the time. The least \
error of a column is bold. Slopes are exponents of the error in the number of samples, from 256 on.

Every sampler's positions are f64 (Sobol's 32 bits). \"Ours, 1/density\" has a random number of \
points whose mean is the column's.

";

const UNIFORM_REMARK: &str = "\
\"Ours, relaxed\" moves the points by the baked offsets and weighs each 1/n: as evenness only. Its estimates are \
unbiased because the importance is constant; where it varies they are not, and the library refuses weights to \
relaxed points. The post-stratified weights are those of a constant map of 64 x 64 pixels.";

const LIGHTING_REMARK: &str = "\
Relaxed points are missing here on purpose: they are accepted in one place and lie in another, so that no weight \
makes them an unbiased estimate, and `Sampling::weighted` answers with an error. \"Ours, few-probe\" prunes by seven \
probes of a tile instead of a proven bound: the points that it loses, on small lights above all, are its error. The \
post-stratified and self-normalized weights, and exactly n points, are slightly biased.";

const TONE_REMARK: &str = "\
Where the dots are, blurred by 1.5 mean spacings, against the picture blurred alike; no weights. \"Ours, relaxed\" \
is what `twelvefold stipple` draws: relaxed points on a stipple map, whose making is not in the time.";

const VARIANTS: &str = "\
## Our variants

Nanoseconds a point, least of 15 runs, without the placement; and at 16,384 points the root-mean-square errors over 8 \
seeds, in percent: of the smooth bump with weights 1/n, and of the picture's tone. Baked depth and precision change the \
time, not the points. An empty cell repeats another, or cannot be.

";

/// Who has the least error at the greatest size, and which of ours.
fn winners(scenes: &[Scene], n: usize) -> String {
    let mut text = format!("At {n} samples the least error has:\n\n");
    for scene in scenes {
        let at = |curve: &Curve| curve.points.iter().find(|m| m.n == n).map(|m| m.error);
        let mut ranked: Vec<(f64, &Curve)> =
            scene.curves.iter().filter_map(|curve| Some((at(curve)?, curve))).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ours = ranked.iter().find(|(_, curve)| curve.kind != Kind::Rival);
        if let (Some((least, best)), Some((error, ours))) = (ranked.first(), ours) {
            text += &format!("- {}: {}", scene.name, best.sampler);
            if best.kind == Kind::Rival {
                let name = ours.sampler.trim_start_matches("ours, ");
                text +=
                    &format!("; the best of ours, {name}, has {:.2} times as much", error / least);
            }
            text += "\n";
        }
    }
    text += "\n";
    text
}

/// Times `make` and returns its result.
fn timed<T>(make: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let made = make();
    (made, start.elapsed().as_secs_f64())
}

/// The result of `make` and the least time of 15 runs, in seconds.
fn least_time<T>(mut make: impl FnMut() -> T) -> (T, f64) {
    let (mut made, mut least) = timed(&mut make);
    for _ in 1..15 {
        let (again, seconds) = timed(&mut make);
        if seconds < least {
            (made, least) = (again, seconds);
        }
    }
    (made, least)
}

/// Gathers errors and times over seeds.
#[derive(Default)]
struct Gathered {
    squares: f64,
    times: Vec<f64>,
}

impl Gathered {
    fn add(&mut self, error: f64, seconds: f64) {
        self.squares += error * error;
        self.times.push(seconds);
    }

    /// `None` if nothing was gathered.
    fn measured(self, n: usize) -> Option<Measured> {
        // The least: what else the machine does only adds.
        let seconds = self.times.iter().copied().min_by(f64::total_cmp)?;
        let error = (self.squares / self.times.len() as f64).sqrt();
        Some(Measured { n, error, seconds })
    }
}

fn uniform_scenes(sizes: &[usize]) -> Vec<Scene> {
    let instances: Vec<Vec<Instance>> = PLANES
        .iter()
        .map(|plane| (0..SEEDS).map(|seed| (plane.instance)(seed)).collect())
        .collect();
    let mut scenes: Vec<Scene> = PLANES
        .iter()
        .map(|plane| Scene { name: plane.name.to_owned(), curves: Vec::new() })
        .collect();
    for sampler in &UNIFORM {
        let mut curves = vec![Vec::new(); scenes.len()];
        for &n in sizes {
            let mut gathered: Vec<Gathered> = scenes.iter().map(|_| Gathered::default()).collect();
            for seed in 0..SEEDS {
                let (set, seconds) = timed(|| (sampler.make)(n, seed));
                let Some(set) = set else { continue };
                for (gathered, instances) in gathered.iter_mut().zip(&instances) {
                    let (function, integral) = &instances[seed as usize];
                    let estimate: f64 = set.iter().map(|(p, weight)| function(*p) * weight).sum();
                    gathered.add(estimate / integral - 1.0, seconds);
                }
            }
            for (curve, gathered) in curves.iter_mut().zip(gathered) {
                curve.extend(gathered.measured(n));
            }
        }
        for (scene, points) in scenes.iter_mut().zip(curves) {
            scene.curves.push(Curve { sampler: sampler.name, kind: sampler.kind, points });
        }
    }
    scenes
}

/// Without occluders, and with.
fn lighting_scenes(lighting: &Lighting, sizes: &[usize]) -> Vec<Scene> {
    let Some(target) = Target::new(lighting.map.importance()) else { return Vec::new() };
    let mut scenes = ["", ", with occluders"]
        .map(|suffix| Scene { name: format!("{}{suffix}", lighting.name), curves: Vec::new() });
    let means = lighting.means();
    for sampler in &FOLLOWING {
        let mut curves = [Vec::new(), Vec::new()];
        for &n in sizes {
            let mut gathered = [Gathered::default(), Gathered::default()];
            for seed in 0..SEEDS {
                let (set, seconds) = timed(|| (sampler.make)(&target, n, seed));
                let Some(set) = set else { continue };
                for errors in lighting.errors(&set) {
                    for ((gathered, error), mean) in gathered.iter_mut().zip(errors).zip(means) {
                        gathered.add(error / mean, seconds);
                    }
                }
            }
            for (curve, gathered) in curves.iter_mut().zip(gathered) {
                curve.extend(gathered.measured(n));
            }
        }
        for (scene, points) in scenes.iter_mut().zip(curves) {
            scene.curves.push(Curve { sampler: sampler.name, kind: sampler.kind, points });
        }
    }
    scenes.into()
}

/// Dots as a viewer sees them.
fn tone_scene(photo: &ImageMap, sizes: &[usize]) -> Vec<Scene> {
    let Some(target) = Target::new(photo) else { return Vec::new() };
    let mut scene = Scene { name: "root-mean-square tone error".to_owned(), curves: Vec::new() };
    for sampler in &FOLLOWING {
        // Weights do not show in a stippling: where only they differ, the dots are the same.
        if sampler.kind == Kind::Reweighted {
            continue;
        }
        let mut points = Vec::new();
        for &n in sizes.iter().filter(|n| **n >= LEAST_DOTS) {
            let mut gathered = Gathered::default();
            for seed in 0..TONE_SEEDS {
                let (set, seconds) = timed(|| (sampler.make)(&target, n, seed));
                let Some(set) = set else { continue };
                let dots: Vec<DVec2> = set.into_iter().map(|(position, _)| position).collect();
                gathered.add(tone::error(photo, &dots, n), seconds);
            }
            points.extend(gathered.measured(n));
        }
        scene.curves.push(Curve { sampler: sampler.name, kind: sampler.kind, points });
    }
    scene.curves.insert(1, relaxed_dots(photo, sizes));
    vec![scene]
}

/// Relaxed points on the map that is made ready for their number.
fn relaxed_dots(photo: &ImageMap, sizes: &[usize]) -> Curve {
    let ((width, height), mut points) = (photo.size(), Vec::new());
    for &n in sizes.iter().filter(|n| **n >= LEAST_DOTS) {
        let pixels = photo.pixels().to_vec();
        let map = StippleMap::new(width, height, pixels, InvalidPixels::Reject, n as f64);
        let Ok(map) = map else { continue };
        let mut gathered = Gathered::default();
        for seed in 0..TONE_SEEDS {
            let (dots, seconds) = timed(|| {
                let placement = Placement::new(map.domain(), seed);
                let sampling = Sampling::new(&placement, &map, Amount::Points(n as f64)).ok()?;
                samplers::filled(&sampling.relaxed().ok()?, n)
            });
            let Some(dots) = dots else { continue };
            gathered.add(tone::error(photo, &dots, n), seconds);
        }
        points.extend(gathered.measured(n));
    }
    Curve { sampler: "ours, relaxed", kind: Kind::Ours, points }
}

/// Writes a file of the report as a whole.
fn write_file(path: &Path, text: &str) -> Result<(), Failure> {
    let failed = |error: twelvefold_files::output::OutputError| Failure::at(path, error);
    let mut output = Output::create(path).map_err(failed)?;
    output.write_all(text.as_bytes()).map_err(|error| failed(error.into()))?;
    output.commit().map_err(failed)
}
