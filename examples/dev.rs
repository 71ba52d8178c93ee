use twelvefold::bake::relaxation::Relaxation;
use twelvefold::relax::random::Random;
use twelvefold::relax::report;
use twelvefold::tiling::{Digits, Rules};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let rules = Rules::new(&Digits::parse(include_str!("../tables/digits.txt")).unwrap()).unwrap();
    let table = (args[1] != "fixed")
        .then(|| Relaxation::from_bytes(&std::fs::read(&args[1]).unwrap()).unwrap());
    let seeds: u64 = args[2].parse().unwrap();
    let n: usize = args.get(3).map_or(16, |s| s.parse().unwrap());
    let mut all = vec![];
    for k in 0..n {
        let tau = report::phase(k, n);
        let mut v = vec![];
        for s in 0..seeds {
            let e = report::uniform(
                &rules,
                table.as_ref(),
                tau,
                16384.0,
                &mut Random::new(s, &[1, k as u64]),
            )
            .unwrap()
            .unwrap();
            v.push(e);
            all.push(e);
        }
        let f = |g: &dyn Fn(&twelvefold::measure::Evenness) -> f64| {
            v.iter().map(g).fold((f64::MAX, 0.0f64), |a, x| (a.0.min(x), a.1.max(x)))
        };
        println!(
            "tau {tau:7.3} n {:6} lowE {:.4} dmean {:.4} dmin {:.3}",
            v[0].count,
            f(&|e| e.low_frequency).1,
            f(&|e| e.mean_distance).0,
            f(&|e| e.least_distance).0
        );
    }
    let s = |g: &dyn Fn(&twelvefold::measure::Evenness) -> f64| {
        let mut x: Vec<f64> = all.iter().map(g).collect();
        x.sort_by(f64::total_cmp);
        (x[0], x[x.len() / 2], x[x.len() - 1])
    };
    println!(
        "lowE {:.4?} dmean {:.4?} dmin {:.3?}",
        s(&|e| e.low_frequency),
        s(&|e| e.mean_distance),
        s(&|e| e.least_distance)
    );
}
