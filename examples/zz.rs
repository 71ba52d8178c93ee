use glam::Vec2; use twelvefold::*; use std::time::Instant;
fn main(){
  for depth in 2..=3u8 { let b=bake::bake(Tables::built_in().rules(),depth).unwrap(); let t=Tables::from_bytes(&b).unwrap();
  println!("depth {depth}");
  for f in ["camera","chelsea","coffee","jacksboro-dem16"] {
    let im=image::open(format!("../shared/data/{f}.png")).unwrap().to_luma32f();
    let (w,h)=im.dimensions();
    let px:Vec<f32>=im.into_raw().iter().map(|v|(1.0-v).max(0.0)).collect();
    let m=ImageMap::new(w as usize,h as usize,px,InvalidPixels::Reject).unwrap();
    for n in [20000.0,1e6]{
      let mut worst=0f64; let mut t0=0.0;
      for seed in 0..10 {
        let p=Placement::with_tables(m.domain(),seed,t);
        let s=Sampling::new(&p,&m,Amount::Points(n)).unwrap();
        let i=Instant::now();
        let c=s.points::<Vec2>().unwrap().count() as f64;
        t0+=i.elapsed().as_secs_f64();
        worst=worst.max((c/n-1.0).abs());
      }
      println!("{f} {n} worst {:.4}% {:.1} M/s",worst*100.0, n*10.0/t0/1e6);
    }
  }
  let p=Placement::with_tables(Domain::unit(),1,t);
  for n in [64.0,1024.,65536.,1048576.]{
    let s=Sampling::new(&p,&Constant::ONE,Amount::Points(n)).unwrap();
    let mut buf=vec![Vec2::ZERO;(n*1.2) as usize+100];
    let reps=(3e6/n) as usize+1;
    let i=Instant::now(); let mut f=0; for _ in 0..reps { f=s.fill(&mut buf).unwrap().written; }
    let t=i.elapsed().as_secs_f64()/reps as f64;
    println!("uniform {n} {f} {:.1} M/s {:.2} us",f as f64/t/1e6, t*1e6);
  } }
  let i=Instant::now(); for s in 0..1000 { std::hint::black_box(Placement::new(Domain::unit(),s)); } println!("placement {:.2} us",i.elapsed().as_secs_f64()*1e3);
}
