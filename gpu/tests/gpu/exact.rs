//! Sets and bits.

use glam::{DVec2, Vec2};
use twelvefold::{
    Amount, Domain, ImageMap, InvalidPixels, Placement, Sample, Sampling, SamplingError,
};
use twelvefold_gpu::{Arithmetic, Capacity, Importance, Order, Plan, Points, Source};

use crate::device::{Device, Output, device};

/// Ranks and bits, by rank.
type Ranked = Vec<(u64, [u32; 2])>;

/// A picture, and the density at which about so many points are made.
pub(crate) struct Case {
    pub(crate) domain: Domain,
    pub(crate) placement: Placement<'static>,
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<f32>,
    pub(crate) density: f64,
    pub(crate) points: f64,
}

impl Case {
    pub(crate) fn new(
        domain: Domain,
        seed: u64,
        (width, height): (usize, usize),
        points: f64,
        picture: impl Fn(f64, f64) -> f64,
    ) -> Self {
        let at = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        let pixels: Vec<f32> = (0..width * height)
            .map(|i| picture(at(i % width, width), at(i / width, height)) as f32)
            .collect();
        let clean = |v: &f32| if v.is_finite() { f64::from(*v).max(0.0) } else { 0.0 };
        let mean = pixels.iter().map(clean).sum::<f64>() / pixels.len() as f64;
        let density = points / (mean * domain.area());
        let placement = Placement::new(domain, seed);
        Self { domain, placement, width, height, pixels, density, points }
    }

    fn cpu(&self) -> Result<Ranked, SamplingError> {
        let map =
            ImageMap::new(self.width, self.height, self.pixels.clone(), InvalidPixels::ZeroAll)
                .unwrap()
                .over(self.domain);
        let sampling = Sampling::new(&self.placement, &map, Amount::Density(self.density))?;
        let mut points = Vec::new();
        for sample in sampling.points::<Vec2>()? {
            let Sample { rank, position } = sample?;
            points.push((rank, position.to_array().map(f32::to_bits)));
        }
        points.sort_unstable();
        Ok(points)
    }

    fn plan(&self, capacity: Capacity, order: Order) -> Plan {
        let size = (self.width as u32, self.height as u32);
        Plan::new(&self.placement, size, capacity, order, Points::Fixed, 4).unwrap()
    }

    pub(crate) fn room(&self) -> Capacity {
        Capacity::points((1.1 * self.points) as u32 + 1000)
    }

    fn gpu(&self, gpu: &Device, order: Order, arithmetic: Arithmetic) -> (Plan, Output) {
        let plan = self.plan(self.room(), order);
        let sampler = gpu.sampler(plan.clone(), Source::Buffer, arithmetic);
        let buffer = gpu.buffer(&self.pixels);
        (plan, gpu.run(&sampler, Importance::Buffer(&buffer), self.density))
    }

    fn check(&self, gpu: &Device, order: Order, arithmetic: Arithmetic) -> Output {
        let (plan, output) = self.gpu(gpu, order, arithmetic);
        assert!(output.status.is_complete(), "{:?}", output.status);
        assert!(!output.status.lacks_keys());
        assert_eq!(output.draw, [4, output.status.points, 0, 0]);
        same(&self.cpu().unwrap(), &by_rank(&plan, &output));
        output
    }
}

fn by_rank(plan: &Plan, output: &Output) -> Ranked {
    let rank = |key: &u32| plan.keys().rank(*key).unwrap();
    let mut points: Ranked =
        output.keys.iter().map(rank).zip(output.positions.iter().copied()).collect();
    points.sort_unstable();
    points
}

fn same(cpu: &Ranked, gpu: &Ranked) {
    if cpu != gpu {
        let only = |a: &Ranked, b: &Ranked| {
            a.iter().filter(|p| b.binary_search_by_key(&p.0, |q| q.0).is_err()).count()
        };
        let (missing, extra) = (only(cpu, gpu), only(gpu, cpu));
        panic!("{} points, {} on the GPU: {missing} missing, {extra} extra", cpu.len(), gpu.len());
    }
}

pub(crate) fn smooth(x: f64, y: f64) -> f64 {
    1.2 + (7.0 * x).sin() * (5.0 * y + 2.0 * x).cos()
}

pub(crate) fn noise(x: f64, y: f64) -> f64 {
    let n = (x * 7919.0 + y * 104_729.0).to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
    n as f64 / (1u64 << 24) as f64
}

/// A sun a thousand times as bright as the sky.
pub(crate) fn peak(x: f64, y: f64) -> f64 {
    let squared = (x - 0.7).powi(2) + (y - 0.3).powi(2);
    0.2 + 0.8 * y + 1e3 * (-squared / 2e-4).exp()
}

pub(crate) fn rectangle(min: [f64; 2], size: [f64; 2]) -> Domain {
    Domain::new(DVec2::from(min), DVec2::from(size)).unwrap()
}

#[test]
fn sets_and_bits_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let wide = rectangle([0.0, 0.0], [1.0, 0.7]);
    for (seed, points) in [(1, 64.0), (2, 5000.0), (3, 60_000.0)] {
        let unit = Domain::UNIT;
        for case in [
            Case::new(unit, seed, (256, 256), points, smooth),
            Case::new(wide, seed, (100, 70), points, noise),
            Case::new(unit, seed, (128, 128), points, peak),
            Case::new(rectangle([-3.5, 1e3], [7.0, 2.0]), seed, (37, 11), points, smooth),
            Case::new(unit, seed, (1, 1), points, |_, _| 1.0),
        ] {
            case.check(gpu, Order::Ordered, Arithmetic::Barriers);
        }
    }
}

#[test]
fn a_million_points_are_the_cpus() {
    let Some(gpu) = device() else { return };
    Case::new(Domain::UNIT, 7, (512, 512), 1e6, noise).check(
        gpu,
        Order::Ordered,
        Arithmetic::Barriers,
    );
}

#[test]
fn integers_alone_give_the_same() {
    let Some(gpu) = device() else { return };
    let case = Case::new(rectangle([-1.0, 0.3], [3.0, 1.0]), 9, (90, 30), 30_000.0, noise);
    let integers = case.check(gpu, Order::Ordered, Arithmetic::Integers);
    assert_eq!(integers, case.check(gpu, Order::Ordered, Arithmetic::Barriers));
}

#[test]
fn plain_arithmetic_differs_where_the_compiler_fuses() {
    let Some(gpu) = device() else { return };
    let case = Case::new(Domain::UNIT, 4, (64, 64), 20_000.0, smooth);
    let (plan, plain) = case.gpu(gpu, Order::Ordered, Arithmetic::Plain);
    let (cpu, plain) = (case.cpu().unwrap(), by_rank(&plan, &plain));
    let differ = cpu.iter().zip(&plain).filter(|(a, b)| a != b).count();
    println!("{differ} of {} positions differ without barriers", cpu.len());
    // The software GPU fuses, so that it sees the trap that the barriers avoid; another one need not.
    if std::env::var_os("TWELVEFOLD_REQUIRE_GPU").is_some() {
        assert!(differ > cpu.len() / 4, "{differ} of {}", cpu.len());
    }
}

#[test]
fn order_repeats_and_appending_gives_the_same_set() {
    let Some(gpu) = device() else { return };
    let case = Case::new(Domain::UNIT, 11, (128, 128), 40_000.0, peak);
    let once = case.check(gpu, Order::Ordered, Arithmetic::Barriers);
    assert!(once.status.subtiles > 0, "no tile was opened");
    assert_eq!(once, case.check(gpu, Order::Ordered, Arithmetic::Barriers));
    case.check(gpu, Order::Append, Arithmetic::Barriers);
}

#[test]
fn textures_are_as_good_as_buffers() {
    let Some(gpu) = device() else { return };
    let case = Case::new(Domain::UNIT, 5, (200, 64), 20_000.0, smooth);
    let from_buffer = case.check(gpu, Order::Ordered, Arithmetic::Barriers);
    let sampler =
        gpu.sampler(case.plan(case.room(), Order::Ordered), Source::Texture, Arithmetic::Barriers);
    let texture = gpu.texture(&case.pixels, 200, 64);
    assert_eq!(gpu.run(&sampler, Importance::Texture(&texture), case.density), from_buffer);
    // What was not planned is refused.
    let buffer = gpu.buffer(&case.pixels);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    assert!(sampler.record(&mut encoder, Importance::Buffer(&buffer), 1.0).is_err());
    let small = gpu.texture(&case.pixels[..64], 8, 8);
    assert!(sampler.record(&mut encoder, Importance::Texture(&small), 1.0).is_err());
    for density in [-1.0, f64::NAN, f64::INFINITY, 1e40, 1e-40] {
        assert!(sampler.record(&mut encoder, Importance::Texture(&texture), density).is_err());
    }
}

#[test]
fn limits_are_exact_whatever_the_importance() {
    let Some(gpu) = device() else { return };
    // Arbitrary bits, and importance whose thresholds lie next to integers and to ranks.
    for seed in 0..6u64 {
        let mut case = Case::new(Domain::UNIT, seed, (96, 96), 30_000.0, |_, _| 1.0);
        let rank_shift = twelvefold::export::Export::of(&case.placement).rank_shift;
        let ranks =
            case.density * twelvefold::export::Export::of(&case.placement).ranks_per_density;
        let plain = case.cpu().unwrap();
        let mut state = seed + 1;
        let mut next = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (state >> 33) as u32
        };
        for pixel in &mut case.pixels {
            let bits = next();
            *pixel = match bits % 4 {
                // Every float up to 4, subnormal ones, NaN and negative ones too.
                0 => f32::from_bits(next() * 2 + 1).min(4.0),
                1 => -1.0,
                _ => 1.0,
            };
        }
        // The pixels of points ask for a threshold as near to their rank as f32 has it.
        for (rank, at) in &plain {
            let [x, y] = at.map(|bits| (96.0 * f32::from_bits(bits)) as usize);
            let nearest = (((*rank as f64) + rank_shift) / ranks) as f32;
            case.pixels[96 * y + x] = match rank % 3 {
                0 => nearest.next_down(),
                1 => nearest,
                _ => nearest.next_up(),
            };
        }
        case.check(gpu, Order::Ordered, Arithmetic::Barriers);
    }
}

#[test]
fn too_many_points_are_counted_and_flagged_and_the_first_are_kept() {
    let Some(gpu) = device() else { return };
    let case = Case::new(Domain::UNIT, 8, (64, 64), 20_000.0, smooth);
    let whole = case.check(gpu, Order::Ordered, Arithmetic::Barriers);
    let buffer = gpu.buffer(&case.pixels);
    for order in [Order::Ordered, Order::Append] {
        let room = Capacity { points: 5000, ..case.room() };
        let sampler = gpu.sampler(case.plan(room, order), Source::Buffer, Arithmetic::Barriers);
        let output = gpu.run(&sampler, Importance::Buffer(&buffer), case.density);
        assert!(output.status.lacks_points() && output.status.points == whole.status.points);
        assert_eq!(output.draw, [4, 5000, 0, 0]);
        assert!(output.keys.iter().all(|key| whole.keys.contains(key)));
    }
    // Fewer candidates: a part of the same points, in the same order.
    let room = Capacity { candidates: 10_000, ..case.room() };
    let sampler =
        gpu.sampler(case.plan(room, Order::Ordered), Source::Buffer, Arithmetic::Barriers);
    let output = gpu.run(&sampler, Importance::Buffer(&buffer), case.density);
    assert!(
        output.status.lacks_candidates() && output.status.candidates == whole.status.candidates
    );
    assert!(!output.keys.is_empty() && whole.keys.starts_with(&output.keys));
}

#[test]
fn nothing_is_made_of_nothing() {
    let Some(gpu) = device() else { return };
    let case = Case::new(Domain::UNIT, 8, (64, 64), 2000.0, smooth);
    let sampler =
        gpu.sampler(case.plan(case.room(), Order::Ordered), Source::Buffer, Arithmetic::Barriers);
    let (full, empty) = (gpu.buffer(&case.pixels), gpu.buffer(&[0.0; 64 * 64]));
    for (buffer, density) in [(&full, 0.0), (&empty, case.density)] {
        let output = gpu.run(&sampler, Importance::Buffer(buffer), density);
        assert_eq!((output.status.points, output.draw[1]), (0, 0));
    }
    // And a frame after it is a whole one.
    let output = gpu.run(&sampler, Importance::Buffer(&full), case.density);
    same(&case.cpu().unwrap(), &by_rank(sampler.plan(), &output));
}
