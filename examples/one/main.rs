use twelvefold::*;
fn main(){ let n: f64 = std::env::args().nth(1).unwrap().parse().unwrap(); let p=Placement::new(Domain::unit(),1);
let mut b=vec![glam::Vec2::ZERO;(n*1.2) as usize+100]; let t=std::time::Instant::now(); let mut made=0;
while t.elapsed().as_secs_f64()<3.0 { let s=Sampling::new(&p,&Constant::ONE,Amount::Points(n)).unwrap().relaxed().unwrap(); made+=s.fill(&mut b).unwrap().written; }
println!("{}", t.elapsed().as_nanos() as f64/made as f64); }
