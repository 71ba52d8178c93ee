use twelvefold::bake::relaxation::Relaxation;
use twelvefold::relax::random::Random;
use twelvefold::relax::report;
use twelvefold::relax::field::{Image, ImageRules};
use twelvefold::tiling::{Digits, Rules};
use glam::DVec2;
use twelvefold::measure::fidelity::*;
use twelvefold::measure::nearest::Summary;
pub fn load(name: &str) -> (Vec<f32>, usize) {
    if name == "test" { return (report::test_image(), 1024); }
    let im = image::open(name).unwrap().to_luma32f();
    let w = im.width() as usize;
    (im.into_raw().into_iter().map(|v| (1.0 - v).max(0.0) * 0.97 + 0.03).collect(), w)
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let rules = Rules::new(&Digits::parse(include_str!("../tables/digits.txt")).unwrap()).unwrap();
    let table = (args[1] != "fixed").then(|| Relaxation::from_bytes(&std::fs::read(&args[1]).unwrap()).unwrap());
    let (v, w) = load(&args[2]);
    let count: f64 = args[3].parse().unwrap();
    for k in 0..3 {
        let im = Image::new(v.clone(), w, count, report::phase(k, 3), ImageRules::default()).unwrap();
        let pts = report::image_points(&rules, table.as_ref(), &im, &mut Random::new(7, &[k as u64])).unwrap();
        println!("{} {:.4?}", args[1], report::image_fidelity(&pts, &v, w).unwrap());
        if args[2] == "test" {
            let imp = Importance { values: &v, width: w };
            let total: f64 = v.iter().map(|v| f64::from(*v)).sum();
            let inside = pts.iter().filter(|p| p.x >= 0.0 && p.y >= 0.0 && p.x < w as f64 && p.y < w as f64).count();
            for (name, lo, hi) in [("grad", DVec2::ZERO, DVec2::new(1024., 500.)), ("disc", DVec2::new(0., 520.), DVec2::new(376., 1024.)), ("check", DVec2::new(392., 520.), DVec2::new(696., 1024.)), ("noise", DVec2::new(712., 520.), DVec2::new(1024., 1024.))] {
                let q: Vec<DVec2> = pts.iter().copied().filter(|p| p.cmpge(lo - 6.0).all() && p.cmplt(hi + 6.0).all()).collect();
                let s = Summary::new(local_distances(&q, &imp, inside as f64 / total)).unwrap();
                // crop for variance
                let (cw, ch) = ((hi.x - lo.x) as usize, (hi.y - lo.y) as usize);
                let crop: Vec<f32> = (0..cw * ch).map(|i| v[(lo.y as usize + i / cw) * w + lo.x as usize + i % cw]).collect();
                let q2: Vec<DVec2> = pts.iter().map(|p| *p - lo).collect();
                let bv = block_variance(&q2, &Importance { values: &crop, width: cw }, 64.0).unwrap();
                println!("   {name}: var {bv:.4} mean {:.4} 1% {:.4}", s.mean(), s.percentile(0.01));
            }
        }
    }
}
