// devtrain IN OUT seed grid passes...   grid: t:g:n,t:g:n,...   pass: amp:wave:min:max/sweeps:sigma:k:c:step/...
use twelvefold::bake::relaxation::Relaxation;
use twelvefold::relax::force::Law;
use twelvefold::relax::schedule::*;
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
    let seed: u64 = args[3].parse().unwrap();
    let segs: Vec<(f64, usize, f64)> = args[4]
        .split(',')
        .map(|s| {
            let n = nums(s);
            (n[0], n[1] as usize, n[2])
        })
        .collect();
    let extra = vec![(1.004, segs[0].1), (1.03, segs[0].1)];
    let zero = Table::zeros(&segs, &extra);
    let mut table = if args[1] == "0" {
        zero
    } else {
        let r = Relaxation::from_bytes(&std::fs::read(&args[1]).unwrap()).unwrap();
        Table::from_layer(&rules, &r.smooth).resampled(&rules, zero)
    };
    for (k, p) in args[5..].iter().enumerate() {
        let mut parts = p.split('/');
        let h = nums(parts.next().unwrap());
        let stages = parts
            .map(|s| {
                let n = nums(s);
                Stage {
                    sweeps: n[0] as usize,
                    law: Law { sigma: n[1], stiffness: n[2], contact: n[3] },
                    step: n[4] as f32,
                    pull: n.get(5).copied().unwrap_or(0.05) as f32,
                    shrink: 0.0,
                    settle: true,
                }
            })
            .collect();
        let ps = Pass { amplitude: h[0], wavelength: h[1], points: [h[2], h[3]], stages };
        pass(&rules, &mut table, &ps, seed * 100 + k as u64, &mut |_| {}).unwrap();
        eprintln!("pass {k} {:?}", t0.elapsed());
    }
    let mut d = [[0u8; 14]; 4];
    for k in TileType::ALL {
        d[k.index()][..k.child_count()].copy_from_slice(digits.of(k));
    }
    let r = Relaxation {
        digits: d,
        provenance: "dev".into(),
        smooth: table.quantized(0).unwrap(),
        rough: None,
    };
    let b = r.to_bytes().unwrap();
    println!("{} bytes {:?}", b.len(), t0.elapsed());
    std::fs::write(&args[2], b).unwrap();
}
