use std::time::Instant;
use zonal_codegen::*;
use zonal_codegen::emit::dialect::Target;
fn main() {
    let specs = catalog::standard();
    let mut bases: Vec<spec::Spec> = specs.iter().map(built::Built::base).collect();
    bases.sort(); bases.dedup();
    let t = Instant::now();
    let kernels: Vec<_> = bases.iter().map(|s| (s.clone(), built::kernel(s))).collect();
    println!("kernels {:?}", t.elapsed());
    let t = Instant::now();
    let listings: Vec<_> = kernels.iter().map(|(s, k)| (s.clone(), listing::Listing::new(k))).collect();
    println!("listings {:?}", t.elapsed());
    let t = Instant::now();
    let mut n = 0usize;
    for (_, l) in &listings { for c in &l.constants { n += (c.to_f32() > 0.) as usize + (c.to_f64() > 0.) as usize; } }
    println!("round {} constants {:?}", n, t.elapsed());
    let t = Instant::now();
    for (s, l) in &listings { accuracy::rounding::<f32>(s, l, 1, 256, eval::Contraction::Separate); }
    println!("rounding once {:?}", t.elapsed());
    let t = Instant::now();
    for (s, _) in &listings { { accuracy::method_errors(s, &accuracy::ANGLES.map(f64::to_radians)); } }
    println!("method {:?}", t.elapsed());
    let t = Instant::now();
    let functions = catalog::build(&specs);
    println!("build all parallel {:?}", t.elapsed());
    let t = Instant::now();
    let mut texts = vec![];
    for f in &functions { for target in [Target::Wgsl, Target::Glsl] {
        let m = emit::Module { name: f.shader_name(), origin: String::new(), functions: vec![f.clone()], constants: vec![] };
        texts.push((target, m.shader(target).unwrap()));
    } }
    println!("emit shaders {:?}", t.elapsed());
    let t = Instant::now();
    for (target, text) in &texts { validate::validate(*target, "x", text).unwrap(); }
    println!("validate shaders {:?}", t.elapsed());
    let t = Instant::now();
    for (target, text) in texts.iter().filter(|(t, _)| *t == Target::Wgsl) { validate::validate(*target, "x", text).unwrap(); }
    println!("validate wgsl {:?}", t.elapsed());
}
