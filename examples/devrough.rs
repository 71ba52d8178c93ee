// devrough SMOOTH ROUGHIN|0 OUT seed grid cfrom cto phase_r contrast_r patches/points/sweeps:sigma:k:c:step[:pull:shrink]/...
use twelvefold::bake::relaxation::Relaxation;
use twelvefold::relax::field::ImageRules;
use twelvefold::relax::force::Law;
use twelvefold::relax::table::Table;
use twelvefold::relax::train::*;
use twelvefold::tiling::*;
fn nums(s: &str) -> Vec<f64> {
    s.split(':').map(|x| x.parse().unwrap()).collect()
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let digits = Digits::parse(include_str!("../tables/digits.txt")).unwrap();
    let rules = Rules::new(&digits).unwrap();
    let t0 = std::time::Instant::now();
    let seed: u64 = args[4].parse().unwrap();
    let segs: Vec<(f64, usize, f64)> = args[5]
        .split(',')
        .map(|s| {
            let n = nums(s);
            (n[0], n[1] as usize, n[2])
        })
        .collect();
    let r = Relaxation::from_bytes(&std::fs::read(&args[1]).unwrap()).unwrap();
    let smooth = Table::from_layer(&rules, &r.smooth);
    let zero = Table::zeros(&segs, &[]);
    let mut rough = if args[2] == "0" {
        smooth.resampled(&rules, zero)
    } else {
        let r = Relaxation::from_bytes(&std::fs::read(&args[2]).unwrap()).unwrap();
        Table::from_layer(&rules, &r.rough.unwrap()).resampled(&rules, zero)
    };
    let n = nums(&args[6]);
    let ir = ImageRules {
        accept_radius: n.get(4).copied().unwrap_or(0.0),
        contrast_from: n[0],
        contrast_to: n[1],
        phase_radius: n[2],
        contrast_radius: n[3],
    };
    for (k, p) in args[7..].iter().enumerate() {
        let mut parts = p.split('/');
        let patches: usize = parts.next().unwrap().parse().unwrap();
        let points: f64 = parts.next().unwrap().parse().unwrap();
        let stages = parts
            .map(|s| {
                let n = nums(s);
                Stage {
                    sweeps: n[0] as usize,
                    law: Law { sigma: n[1], stiffness: n[2], contact: n[3] },
                    step: n[4] as f32,
                    pull: n.get(5).copied().unwrap_or(0.05) as f32,
                    shrink: n.get(6).copied().unwrap_or(0.) as f32,
                    settle: true,
                }
            })
            .collect();
        image_pass(
            &rules,
            &smooth,
            &mut rough,
            &ImagePass { patches, points, rules: ir, stages },
            seed * 100 + k as u64,
            &mut |_| {},
        )
        .unwrap();
        eprintln!("pass {k} {:?}", t0.elapsed());
    }
    let r = Relaxation { rough: Some(rough.quantized(1).unwrap()), ..r };
    let b = r.to_bytes().unwrap();
    println!("{} bytes {:?}", b.len(), t0.elapsed());
    std::fs::write(&args[3], b).unwrap();
}
