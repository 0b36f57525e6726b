use serde_json::Value;
use zonal_codegen::eval::*;
use zonal_codegen::kernel::Kernel;
use zonal_codegen::kernels::*;
use zonal_codegen::kernels::y_rotation::Small;
use zonal_codegen::listing::Listing;

fn golden(name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(format!("golden/{name}.json")).unwrap()).unwrap()
}
fn nums(v: &Value) -> Vec<f64> { v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect() }
fn run<T: Number>(k: &Kernel, inputs: &[Vec<f64>]) -> Vec<f64> {
    let p = Program::<T>::new(&Listing::new(k));
    let i: Vec<Vec<T>> = inputs.iter().map(|v| v.iter().map(|&x| T::from_f64(x)).collect()).collect();
    let r: Vec<&[T]> = i.iter().map(|v| &v[..]).collect();
    p.run(&r, Contraction::Separate).into_iter().map(|x| x.to_f64()).collect()
}
fn band_err(a: &[f64], b: &[f64]) -> f64 {
    let mut worst = 0f64;
    let n = (a.len() as f64).sqrt().round() as usize;
    for l in 0..n {
        let r = l*l..(l+1)*(l+1);
        let d: f64 = a[r.clone()].iter().zip(&b[r.clone()]).map(|(x,y)| (x-y)*(x-y)).sum();
        let s: f64 = b[r].iter().map(|y| y*y).sum();
        worst = worst.max((d/s).sqrt());
    }
    worst
}
fn cost(k: &Kernel, ch: usize) -> String { let l = Listing::new(k); let c = l.cost(ch); format!("{} +{}sp (live {})", c.total, c.special, l.footprint().live) }

#[test]
fn scratch() {
    for n in 2..=10 {
        println!("basis {n}: {} eval {} rgb {}", cost(&basis::basis(n, &(0..n).collect::<Vec<_>>()),1), cost(&basis::eval(n, &(0..n).collect::<Vec<_>>()),1), cost(&basis::eval(n, &(0..n).collect::<Vec<_>>()),3));
    }
    let b = golden("basis");
    for n in 2..=10 {
        let k = basis::basis(n, &(0..n).collect::<Vec<_>>());
        let e = basis::eval(n, &(0..n).collect::<Vec<_>>());
        let (mut w, mut w32, mut we, mut we32) = (0f64, 0f64, 0f64, 0f64);
        for case in b["cases"].as_array().unwrap() {
            let d = nums(&case["unit"]);
            let y: Vec<f64> = nums(&case["y"])[..n*n].to_vec();
            w = w.max(band_err(&run::<f64>(&k, &[d.clone()]), &y));
            w32 = w32.max(band_err(&run::<f32>(&k, &[d.clone()]), &y));
            let c: Vec<f64> = (0..n*n).map(|i| ((i * 37 % 17) as f64 - 8.0)/8.0).collect();
            let s: f64 = c.iter().zip(&y).map(|(a,b)| a*b).sum();
            we = we.max((run::<f64>(&e, &[d.clone(), c.clone()])[0] - s).abs());
            we32 = we32.max((run::<f32>(&e, &[d.clone(), c.clone()])[0] - s).abs());
        }
        println!("basis {n} err f64 {w:.2e} f32 {w32:.2e}; eval f64 {we:.2e} f32 {we32:.2e}");
    }
    let rot = golden("rotations");
    let mut kernels: Vec<(&str, fn(usize) -> Kernel)> = vec![("zyz", rotate::zyz), ("zxzxz", rotate::zxzxz), ("tensor", rotate::tensor), ("matrix", rotate::from_matrix)];
    kernels.truncate(4);
    for (name, f) in kernels {
        for n in 2..=10 {
            if n > 3 && (name == "tensor" || name == "matrix") { continue }
            let k = f(n);
            let (mut w, mut w32) = (0f64, 0f64);
            for case in rot["cases"].as_array().unwrap() {
                let q = nums(&case["quat_wxyz"]);
                let nq = q.iter().map(|x| x*x).sum::<f64>().sqrt(); let q = vec![q[1]/nq, q[2]/nq, q[3]/nq, q[0]/nq];
                let rm: Vec<Vec<f64>> = case["R"].as_array().unwrap().iter().map(nums).collect();
                let m: Vec<f64> = (0..9).map(|i| rm[i%3][i/3]).collect();
                let c: Vec<f64> = (0..n*n).map(|i| ((i * 37 % 17) as f64 - 8.0)/8.0).collect();
                let mut out = vec![];
                for l in 0..n {
                    let d: Vec<Vec<f64>> = case["D"][l].as_array().unwrap().iter().map(nums).collect();
                    for row in &d { out.push(row.iter().zip(&c[l*l..]).map(|(a,b)| a*b).sum::<f64>()); }
                }
                let p = if name == "matrix" { m } else { q };
                w = w.max(band_err(&run::<f64>(&k, &[p.clone(), c.clone()]), &out));
                w32 = w32.max(band_err(&run::<f32>(&k, &[p.clone(), c.clone()]), &out));
            }
            println!("{name} {n}: cost {} rgb {} err f64 {w:.2e} f32 {w32:.2e}", cost(&k,1), cost(&k,3));
        }
    }
    for n in 2..=10 {
        println!("angles {n}: {} apply {} align {} zonal {} rotate_y {} swap {}", cost(&rotate::angles(n),1), cost(&rotate::zyz_from_angles(n),1), cost(&rotate::align(n),1), cost(&rotate::zonal(n),1), cost(&rotate::rotate_y(n),1), cost(&rotate::swap_yz(n),1));
    }
    let t = golden("yrot_taylor");
    for (small, name) in Small::ALL.iter().take(3) {
        let k = y_rotation::about_y(8, &[*small; 7]);
        for case in t["cases"].as_array().unwrap() {
            let out = run::<f64>(&k, &[vec![case["beta"].as_f64().unwrap()], nums(&case["src"])]);
            println!("{name} {} err {:.2e} cost {}", case["beta"], band_err(&out, &nums(&case[*name])), cost(&k,1));
        }
    }
    let t = golden("yrot_lf3");
    let k = y_rotation::about_y(8, &[Small::Lf3; 7]);
    for case in t["cases"].as_array().unwrap() {
        let out = run::<f64>(&k, &[vec![case["beta"].as_f64().unwrap()], nums(&case["src"])]);
        let want = nums(&case["lf3"]);
        for l in 0..8 { let r = l*l..(l+1)*(l+1); println!("lf3 {} band {l} {:.1e}", case["beta"], out[r.clone()].iter().zip(&want[r]).map(|(a,b)| (a-b).abs()).fold(0., f64::max)); }
    }
    let t = golden("tilt");
    for n in 3..=8 { println!("tilt {n} {} rgb {}", cost(&tilt::tilt(n),1), cost(&tilt::tilt(n),3)); }
    let k = tilt::tilt(8);
    for case in t["cases"].as_array().unwrap() {
        let out = run::<f64>(&k, &[nums(&case["n"]), nums(&case["src"])]);
        let ex = nums(&case["exact"]);
        print!("tilt {} e3 {:.1e}", case["deg"], band_err(&out[..9], &ex[..9]));
        if case["lf3_closed"].is_array() { let w = nums(&case["lf3_closed"]); println!(" rest {:.1e}", out[9..].iter().zip(&w[9..]).map(|(a,b)| (a-b).abs()).fold(0., f64::max)); } else { println!() }
    }
}
