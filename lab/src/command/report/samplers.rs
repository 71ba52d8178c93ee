//! The samplers compared: ours in its variants, and what else is in use.

use std::sync::LazyLock;

use glam::DVec2;
use twelvefold::estimate::{
    SeamlessSet, Warp, Weighted, Weighting, exactly, normalize, post_stratify,
};
use twelvefold::light::Sobol;
use twelvefold::{
    Amount, Constant, Domain, ImageMap, Importance, InvalidPixels, Limits, Placement, Probed,
    Sampling,
};

use rand::SeedableRng as _;
use rand::distr::Distribution as _;
use rand::rngs::SmallRng;
use rand_distr::weighted::WeightedAliasIndex;
use twelvefold_lab::random::Random;
use twelvefold_lab::rivals::{self, InverseCdf, halton, poisson_disk, r2};

/// A set of points, each with the area that it stands for.
pub(crate) type Set = Vec<(DVec2, f64)>;

/// What is sampled, prepared once for all samplers.
pub(crate) struct Target<'m> {
    map: &'m ImageMap,
    warp: Warp<'m>,
    inverse: InverseCdf<f64>,
    alias: WeightedAliasIndex<f32>,
    integral: f64,
    greatest: f64,
}

impl<'m> Target<'m> {
    /// `None` for a map that is 0 everywhere.
    pub(crate) fn new(map: &'m ImageMap) -> Option<Self> {
        Some(Self {
            map,
            warp: Warp::new(map)?,
            inverse: InverseCdf::new(map),
            alias: WeightedAliasIndex::new(map.pixels().to_vec()).ok()?,
            integral: map.mean() * map.domain().area(),
            greatest: map.pixels().iter().copied().fold(0.0, f32::max).into(),
        })
    }

    /// The point of the map to which the inverse takes one of [0, 1)², with its weight as one of n.
    fn inverted(&self, point: DVec2, n: usize) -> (DVec2, f64) {
        self.weighted(self.inverse.position(point.to_array()).into(), n)
    }

    /// A position with its weight, as one of n that follow the map.
    fn weighted(&self, position: DVec2, n: usize) -> (DVec2, f64) {
        let value = self.map.value(position);
        (position, self.integral / (n as f64 * value))
    }
}

/// Whose a sampler is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// Ours, with points of its own.
    Ours,
    /// Ours: the points of "ours, 1/density" under other weights, which dots do not show.
    Reweighted,
    /// Another's.
    Rival,
}

/// A way to make a set of about n points of the unit square, from a seed.
pub(crate) struct Uniform {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) make: fn(n: usize, seed: u64) -> Option<Set>,
}

/// A way to make a set of about n points that follow a map, from a seed.
pub(crate) struct Following {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) make: fn(target: &Target<'_>, n: usize, seed: u64) -> Option<Set>,
}

fn set(points: Vec<Weighted>) -> Set {
    points.into_iter().map(|point| (point.position, point.weight)).collect()
}

/// The thresholded points of an importance. `None` if there are none to be had.
fn thresholded<I: Importance>(
    domain: Domain,
    importance: &I,
    n: usize,
    seed: u64,
    weighting: Weighting,
) -> Option<Vec<Weighted>> {
    let placement = Placement::new(domain, seed);
    let sampling = Sampling::new(&placement, importance, Amount::Points(n as f64)).ok()?;
    sampling.weighted(weighting).ok()?.collect::<Result<_, _>>().ok()
}

/// The positions that a sampling writes to a buffer; about n.
pub(crate) fn filled<I: Importance>(sampling: &Sampling<'_, I>, n: usize) -> Option<Vec<DVec2>> {
    let mut buffer = vec![DVec2::ZERO; n + 64 + n / 8];
    let mut filled = sampling.fill(&mut buffer).ok()?;
    if !filled.complete {
        buffer = vec![DVec2::ZERO; 2 * n + 1024];
        filled = sampling.fill(&mut buffer).ok()?;
    }
    buffer.truncate(filled.written);
    Some(buffer)
}

/// Constant importance as a map, in whose quarters points are stratified. `None` never.
static EVEN: LazyLock<Option<ImageMap>> = LazyLock::new(|| {
    let side = 64;
    let map = ImageMap::new(side, side, vec![1.0; side * side], InvalidPixels::Reject).ok()?;
    Some(map.over(Domain::UNIT))
});

/// Equal weights for points of the unit square.
fn equal(points: impl ExactSizeIterator<Item = DVec2>) -> Set {
    let weight = 1.0 / points.len() as f64;
    points.map(|point| (point, weight)).collect()
}

/// The fractional part of p + shift, the shift drawn from the seed.
fn shifted(points: impl ExactSizeIterator<Item = DVec2>, seed: u64) -> Set {
    let mut random = Random::new(seed, &[]);
    let shift = random.point();
    // Below 1 after rounding, too.
    let wrap = |p: DVec2| (p + shift).fract().min(DVec2::splat(1.0f64.next_down()));
    equal(points.map(wrap))
}

/// Point i of the Owen-scrambled Sobol sequence.
fn sobol(i: usize, seed: u64) -> DVec2 {
    rivals::sobol(i as u32, seed as u32).as_dvec2()
}

/// The samplers of constant importance.
pub(crate) const UNIFORM: [Uniform; 15] = [
    Uniform {
        name: "ours, 1/density",
        kind: Kind::Ours,
        make: |n, seed| {
            thresholded(Domain::UNIT, &Constant::ONE, n, seed, Weighting::Density).map(set)
        },
    },
    Uniform {
        name: "ours, smoothed",
        kind: Kind::Reweighted,
        make: |n, seed| {
            thresholded(Domain::UNIT, &Constant::ONE, n, seed, Weighting::Smoothed).map(set)
        },
    },
    Uniform {
        name: "ours, normalized",
        kind: Kind::Reweighted,
        make: |n, seed| {
            let mut points =
                thresholded(Domain::UNIT, &Constant::ONE, n, seed, Weighting::Density)?;
            normalize(&mut points, n as f64);
            Some(set(points))
        },
    },
    Uniform {
        name: "ours, post-stratified",
        kind: Kind::Reweighted,
        make: |n, seed| {
            let mut points =
                thresholded(Domain::UNIT, &Constant::ONE, n, seed, Weighting::Density)?;
            post_stratify(&mut points, EVEN.as_ref()?, 6.0);
            Some(set(points))
        },
    },
    Uniform {
        name: "ours, relaxed",
        kind: Kind::Ours,
        make: |n, seed| {
            let placement = Placement::new(Domain::UNIT, seed);
            let sampling =
                Sampling::new(&placement, &Constant::ONE, Amount::Points(n as f64)).ok()?;
            let weight = 1.0 / n as f64;
            let points = filled(&sampling.relaxed().ok()?, n)?;
            Some(points.into_iter().map(|p| (p, weight)).collect())
        },
    },
    Uniform {
        name: "ours, exactly n",
        kind: Kind::Ours,
        make: |n, seed| {
            let placement = Placement::new(Domain::UNIT, seed);
            exactly(&placement, &Constant::ONE, n, Limits::default()).ok().map(set)
        },
    },
    Uniform {
        name: "ours, complete level",
        kind: Kind::Ours,
        make: |n, seed| {
            let placement = Placement::aligned(Domain::UNIT, seed, n as f64).ok()?;
            let sampling =
                Sampling::new(&placement, &Constant::ONE, Amount::Density(n as f64)).ok()?;
            let weight = 1.0 / n as f64;
            Some(filled(&sampling, n)?.into_iter().map(|p| (p, weight)).collect())
        },
    },
    Uniform {
        name: "ours, seamless set",
        kind: Kind::Ours,
        make: |n, seed| {
            let set = SeamlessSet::new(n, Limits::default()).ok()?;
            Some(equal(set.points(seed)))
        },
    },
    Uniform {
        name: "Halton, shifted",
        kind: Kind::Rival,
        make: |n, seed| Some(shifted((0..n as u32).map(halton), seed)),
    },
    Uniform {
        name: "Hammersley, shifted",
        kind: Kind::Rival,
        make: |n, seed| {
            Some(shifted(
                (0..n as u32).map(|i| DVec2::new(f64::from(i) / n as f64, halton(i).x)),
                seed,
            ))
        },
    },
    Uniform {
        name: "Owen Sobol",
        kind: Kind::Rival,
        make: |n, seed| Some(equal((0..n).map(|i| sobol(i, seed)))),
    },
    Uniform {
        name: "R2, shifted",
        kind: Kind::Rival,
        make: |n, seed| Some(shifted((0..n as u32).map(r2), seed)),
    },
    Uniform {
        name: "jittered",
        kind: Kind::Rival,
        make: |n, seed| {
            let side = (n as f64).sqrt() as usize;
            let mut random = Random::new(seed, &[]);
            let cell = |i| DVec2::new((i % side) as f64, (i / side) as f64);
            Some(equal((0..side * side).map(|i| (cell(i) + random.point()) / side as f64)))
        },
    },
    Uniform {
        name: "Poisson disk",
        kind: Kind::Rival,
        make: |n, seed| {
            if n > 16_384 {
                return None;
            }
            let points: Vec<_> = poisson_disk(n, seed).iter().map(DVec2::from_array).collect();
            Some(equal(points.into_iter()))
        },
    },
    Uniform {
        name: "white noise",
        kind: Kind::Rival,
        make: |n, seed| {
            let mut random = Random::new(seed, &[]);
            Some(equal((0..n).map(move |_| random.point())))
        },
    },
];

/// The samplers of a map.
pub(crate) const FOLLOWING: [Following; 16] = [
    Following {
        name: "ours, 1/density",
        kind: Kind::Ours,
        make: |target, n, seed| {
            let map = target.map;
            thresholded(map.domain(), map, n, seed, Weighting::Density).map(set)
        },
    },
    Following {
        name: "ours, normalized",
        kind: Kind::Reweighted,
        make: |target, n, seed| {
            let map = target.map;
            let mut points = thresholded(map.domain(), map, n, seed, Weighting::Density)?;
            normalize(&mut points, n as f64);
            Some(set(points))
        },
    },
    Following {
        name: "ours, smoothed",
        kind: Kind::Reweighted,
        make: |target, n, seed| {
            let map = target.map;
            thresholded(map.domain(), map, n, seed, Weighting::Smoothed).map(set)
        },
    },
    Following {
        name: "ours, post-stratified",
        kind: Kind::Reweighted,
        make: |target, n, seed| {
            let map = target.map;
            let mut points = thresholded(map.domain(), map, n, seed, Weighting::Density)?;
            target.warp.post_stratify(&mut points, 6.0);
            Some(set(points))
        },
    },
    Following {
        name: "ours, few-probe",
        kind: Kind::Ours,
        make: |target, n, seed| {
            let map = Probed::new(target.map, target.map.domain(), 1.0);
            thresholded(target.map.domain(), &map, n, seed, Weighting::Density).map(set)
        },
    },
    Following {
        name: "ours, exactly n",
        kind: Kind::Ours,
        make: |target, n, seed| {
            let placement = Placement::new(target.map.domain(), seed);
            exactly(&placement, target.map, n, Limits::default()).ok().map(set)
        },
    },
    Following {
        name: "ours, warped level",
        kind: Kind::Ours,
        make: |target, n, seed| target.warp.level(n, seed, Limits::default()).ok().map(set),
    },
    Following {
        name: "ours, Sobol + warp",
        kind: Kind::Ours,
        make: |target, n, seed| {
            let points = Sobol::new(seed);
            let warped = |i| target.warp.weighted(DVec2::from_array(points.point(i)), n, i.into());
            Some(set((0..n as u32).map(warped).collect()))
        },
    },
    Following {
        name: "Owen Sobol + warp",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let warped = |i| target.weighted(target.warp.position(sobol(i, seed)), n);
            Some((0..n).map(warped).collect())
        },
    },
    Following {
        name: "Owen Sobol + inverse CDF",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let warped = |i| target.inverted(sobol(i, seed), n);
            Some((0..n).map(warped).collect())
        },
    },
    Following {
        name: "Halton + inverse CDF",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let points = shifted((0..n as u32).map(halton), seed);
            let warped = |(p, _): (DVec2, f64)| target.inverted(p, n);
            Some(points.into_iter().map(warped).collect())
        },
    },
    Following {
        name: "Hammersley + inverse CDF",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let flat = |i| DVec2::new(f64::from(i) / n as f64, halton(i).x);
            let points = shifted((0..n as u32).map(flat), seed);
            let warped = |(p, _): (DVec2, f64)| target.inverted(p, n);
            Some(points.into_iter().map(warped).collect())
        },
    },
    Following {
        name: "R2 + inverse CDF",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let points = shifted((0..n as u32).map(r2), seed);
            let warped = |(p, _): (DVec2, f64)| target.inverted(p, n);
            Some(points.into_iter().map(warped).collect())
        },
    },
    Following {
        name: "white + inverse CDF",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let mut random = Random::new(seed, &[]);
            let draw = |_| target.inverted(random.point(), n);
            Some((0..n).map(draw).collect())
        },
    },
    Following {
        name: "alias + jitter (white)",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let (mut random, mut texels) = (Random::new(seed, &[]), SmallRng::seed_from_u64(seed));
            let (width, _) = target.map.size();
            let draw = |_| {
                let pixel = target.alias.sample(&mut texels);
                let corner = DVec2::new((pixel % width) as f64, (pixel / width) as f64);
                target.weighted(corner + random.point(), n)
            };
            Some((0..n).map(draw).collect())
        },
    },
    Following {
        name: "rejection (white)",
        kind: Kind::Rival,
        make: |target, n, seed| {
            let domain = target.map.domain();
            let tries = n as f64 * target.greatest * domain.area() / target.integral;
            if tries > 1e7 {
                return None;
            }
            let mut random = Random::new(seed, &[]);
            let mut set = Vec::with_capacity(n);
            while set.len() < n {
                let position = random.point() * domain.size();
                if random.unit() * target.greatest < target.map.value(position) {
                    set.push(target.weighted(position, n));
                }
            }
            Some(set)
        },
    },
];
