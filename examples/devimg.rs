use glam::DVec2;
use twelvefold::bake::relaxation::Relaxation;
use twelvefold::measure::fidelity::*;
use twelvefold::measure::nearest::Summary;
use twelvefold::relax::field::{Image, ImageRules};
use twelvefold::relax::random::Random;
use twelvefold::relax::report;
use twelvefold::tiling::{Digits, Rules};
pub fn load(name: &str) -> (Vec<f32>, usize) {
    if name == "test" {
        return (report::test_image(), 1024);
    }
    let im = image::open(name).unwrap().to_luma32f();
    let w = im.width() as usize;
    (im.into_raw().into_iter().map(|v| (1.0 - v).max(0.0) * 0.97 + 0.03).collect(), w)
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let rules = Rules::new(&Digits::parse(include_str!("../tables/digits.txt")).unwrap()).unwrap();
    let table = (args[1] != "fixed")
        .then(|| Relaxation::from_bytes(&std::fs::read(&args[1]).unwrap()).unwrap());
    let (v, w) = load(&args[2]);
    let count: f64 = args[3].parse().unwrap();
    let env = |n: &str, d: f64| std::env::var(n).map_or(d, |s| s.parse().unwrap());
    let r = ImageRules {
        accept_radius: env("AR", 0.0),
        phase_radius: env("PR", 1.0),
        contrast_radius: env("CR", 1.0),
        contrast_from: env("CF", 0.07),
        contrast_to: env("CT", 0.6),
    };
    let clip = env("CLIP", 0.0);
    let mut acc = vec![];
    let mut regs: Vec<[f64; 3]> = vec![[0.0; 3]; 4];
    let nk = 4;
    for k in 0..nk {
        let im = Image::new(v.clone(), w, count, report::phase(k, nk), r).unwrap();
        let pts = if clip == 0.0 {
            report::image_points(&rules, table.as_ref(), &im, &mut Random::new(7, &[k as u64]))
                .unwrap()
        } else {
            use twelvefold::relax::field::*;
            use twelvefold::relax::*;
            let half = im.half_extent() + DVec2::splat(20.0);
            let ground =
                Ground::random(&rules, half.length(), &mut Random::new(7, &[k as u64])).unwrap();
            site::sites(&ground, &im, Region::Rectangle(half))
                .unwrap()
                .iter()
                .map(|s| {
                    let q = s.relaxed(table.as_ref().unwrap());
                    let mut f = 1.0;
                    while f > 0.1
                        && im.threshold(s.centre + (q - s.centre) * f) < clip * (s.rank as f64)
                    {
                        f *= 0.5;
                    }
                    if f <= 0.1 {
                        f = 0.0;
                    }
                    im.pixels(s.centre + (q - s.centre) * f)
                })
                .collect()
        };
        let f = report::image_fidelity(&pts, &v, w).unwrap();
        acc.push(f);
        if args[2] == "test" {
            let imp = Importance { values: &v, width: w };
            let total: f64 = v.iter().map(|v| f64::from(*v)).sum();
            let inside = pts
                .iter()
                .filter(|p| p.x >= 0.0 && p.y >= 0.0 && p.x < w as f64 && p.y < w as f64)
                .count();
            for (ri, (name, lo, hi)) in [
                ("grad", DVec2::ZERO, DVec2::new(1024., 500.)),
                ("disc", DVec2::new(0., 520.), DVec2::new(506., 1024.)),
                ("check", DVec2::new(518., 520.), DVec2::new(762., 1024.)),
                ("noise", DVec2::new(774., 520.), DVec2::new(1024., 1024.)),
            ]
            .into_iter()
            .enumerate()
            {
                let _ = name;
                let q: Vec<DVec2> = pts
                    .iter()
                    .copied()
                    .filter(|p| p.cmpge(lo - 6.0).all() && p.cmplt(hi + 6.0).all())
                    .collect();
                let s = Summary::new(local_distances(&q, &imp, inside as f64 / total)).unwrap();
                // crop for variance
                let (cw, ch) = ((hi.x - lo.x) as usize, (hi.y - lo.y) as usize);
                let crop: Vec<f32> = (0..cw * ch)
                    .map(|i| v[(lo.y as usize + i / cw) * w + lo.x as usize + i % cw])
                    .collect();
                let q2: Vec<DVec2> = pts.iter().map(|p| *p - lo).collect();
                let bv =
                    block_variance(&q2, &Importance { values: &crop, width: cw }, 64.0).unwrap();
                regs[ri][0] += bv / nk as f64;
                regs[ri][1] += s.mean() / nk as f64;
                regs[ri][2] += s.percentile(0.01) / nk as f64;
            }
        }
    }
    let m = |g: &dyn Fn(&Fidelity) -> f64| {
        let v: Vec<f64> = acc.iter().map(g).collect();
        (
            v.iter().sum::<f64>() / v.len() as f64,
            v.iter().copied().fold(f64::MAX, f64::min),
            v.iter().copied().fold(0.0, f64::max),
        )
    };
    println!(
        "{} {} var {:.4?} mean {:.4?} 1% {:.4?}",
        args[1],
        &args[2][args[2].len().saturating_sub(10)..],
        m(&|f| f.block_variance),
        m(&|f| f.mean_distance),
        m(&|f| f.first_percentile)
    );
    if args[2] == "test" {
        println!("   grad,disc,check,noise: {regs:.3?}");
    }
}
