//! What the benches and the speed report compare: our ways to make points and their peers, each at its
//! best: tables built before, buffers kept, nothing allocated while the clock runs.

use std::hint::black_box;

use glam::Vec2;
use twelvefold::{
    Amount, Constant, Domain, ImageMap, Importance, InvalidPixels, Placement, Sampling,
    SamplingError, StippleMap, Tables, bake,
};

use crate::maps::{self, Map};

mod peers;

/// Writes points to a buffer's start; returns how many.
type Maker<'a> = Box<dyn FnMut(&mut [Vec2]) -> usize + 'a>;

/// A way to make points.
pub struct Contender<'a> {
    /// As the table shows it.
    pub name: String,
    /// The most points it is asked for: some are too slow for more.
    pub most: usize,
    /// Prepares `n` points (not timed) and returns what makes them (timed): it writes them to the
    /// buffer's start and returns how many.
    pub prepare: Box<dyn Fn(usize) -> Maker<'a> + 'a>,
}

impl<'a> Contender<'a> {
    /// A contender that makes any number of points.
    pub fn new<F, G>(name: &str, prepare: F) -> Self
    where
        F: Fn(usize) -> G + 'a,
        G: FnMut(&mut [Vec2]) -> usize + 'a,
    {
        let prepare = move |n: usize| -> Maker<'a> { Box::new(prepare(n)) };
        Self { name: name.into(), most: usize::MAX, prepare: Box::new(prepare) }
    }

    /// The same for at most `most` points.
    pub fn at_most(self, most: usize) -> Self {
        Self { most, ..self }
    }

    /// Panics unless `made` is the number asked for: exactly for sequences, within a few standard
    /// deviations where the number is random.
    pub fn assert_count(&self, asked: usize, made: usize) {
        let slack = 8.0 * (asked as f64).sqrt() + 8.0;
        assert!((made as f64 - asked as f64).abs() <= slack, "{}: {made} for {asked}", self.name);
    }
}

/// The sampling of `n` points, relaxed or fixed.
fn sampling<'a, I: Importance>(
    placement: &'a Placement<'a>,
    importance: &'a I,
    n: usize,
    relaxed: bool,
) -> Result<Sampling<'a, I>, SamplingError> {
    let sampling = Sampling::new(placement, importance, Amount::Points(n as f64))?;
    if relaxed { sampling.relaxed() } else { Ok(sampling) }
}

/// Ours: the placement is kept, the sampling is made anew, as in a frame. `importance` makes what is
/// sampled for a number of points, before the clock runs.
fn ours<'a, I: Importance + 'a>(
    name: &str,
    domain: Domain,
    tables: Tables<'static>,
    relaxed: bool,
    importance: impl Fn(usize) -> I + 'a,
) -> Contender<'a> {
    Contender::new(name, move |n| {
        let importance = importance(n);
        // The seed whose number is nearest to the expected one: the time a point is compared.
        let placements: Vec<_> =
            (0..8).map(|seed| Placement::new_in(domain, seed, tables)).collect();
        let mut buffer = vec![Vec2::ZERO; n + n / 8 + 64];
        let mut off = |placement: &Placement<'_>| {
            let sampling = sampling(placement, &importance, n, relaxed);
            let made = sampling.and_then(|s| s.fill(&mut buffer)).expect("a valid sampling");
            made.written.abs_diff(n)
        };
        let placement = if n > 1 << 20 {
            placements[0].clone()
        } else {
            placements.iter().min_by_key(|p| off(p)).expect("eight placements").clone()
        };
        move |buffer: &mut [Vec2]| {
            let sampling = sampling(&placement, &importance, n, relaxed);
            let filled = sampling.and_then(|s| s.fill(buffer)).expect("a valid sampling");
            assert!(filled.complete);
            filled.written
        }
    })
}

/// Ours on two threads, in one piece of memory a part.
fn two_threads<'a, I: Importance + Sync>(
    domain: Domain,
    relaxed: bool,
    importance: &'a I,
) -> Contender<'a> {
    let name = if relaxed { "two threads, relaxed" } else { "two threads" };
    Contender::new(name, move |n| {
        let threads = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("two threads");
        let placement = Placement::new(domain, 1);
        let mut shards = twelvefold::Shards::<Vec2>::new();
        move |_: &mut [Vec2]| {
            let sampling = sampling(&placement, importance, n, relaxed);
            let made = sampling.and_then(|s| threads.install(|| shards.sample(&s)));
            made.expect("a valid sampling");
            shards.len()
        }
    })
}

/// Copying as many points as there are.
pub fn memcpy<'a>() -> Contender<'a> {
    Contender::new("memcpy of the same bytes", |n| {
        let source = vec![Vec2::ONE; n];
        move |buffer| {
            buffer[..n].copy_from_slice(black_box(&source));
            n
        }
    })
}

/// Uniform density over the unit square, memcpy first.
pub fn uniform<'a>() -> Vec<Contender<'a>> {
    let mut all = vec![memcpy()];
    for depth in 2..=bake::MAX_DEPTH {
        let bytes = bake::bake(&Tables::built_in().rules(), depth, None).expect("a depth in range");
        // Kept for the whole run.
        let tables = Tables::from_bytes(bytes.leak()).expect("baked just now");
        let name = format!("twelvefold, baked depth {depth}");
        all.push(ours(&name, Domain::UNIT, tables, false, |_| Constant::ONE));
    }
    let tables = Tables::built_in();
    all.push(ours("twelvefold, relaxed", Domain::UNIT, tables, true, |_| Constant::ONE));
    for relaxed in [false, true] {
        all.push(two_threads(Domain::UNIT, relaxed, &Constant::ONE));
    }
    all.extend(peers::uniform());
    all
}

/// An importance map over its pixels, memcpy first.
pub fn image<'a>(map: &'a Map) -> Vec<Contender<'a>> {
    let importance: &'a ImageMap = &map.importance;
    let (domain, tables) = (importance.domain(), Tables::built_in());
    let mut all = vec![memcpy()];
    all.push(ours("twelvefold", domain, tables, false, move |_| importance));
    all.push(ours("twelvefold, relaxed", domain, tables, true, move |_| importance));
    for relaxed in [false, true] {
        all.push(two_threads(domain, relaxed, importance));
    }
    let stipple = move |n: usize| {
        let pixels = importance.pixels().to_vec();
        let (side, reject) = (maps::SIDE, InvalidPixels::Reject);
        StippleMap::new(side, side, pixels, reject, n as f64).expect("a valid map")
    };
    let stippled = ours("twelvefold, relaxed stipple", domain, tables, true, stipple);
    // A prepared map for each of many points is more memory than a bench needs.
    all.push(stippled.at_most(1 << 20));
    all.extend(peers::image(map));
    all
}
