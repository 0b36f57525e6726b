use glam::*;
macro_rules! orders { ($count:ident, $body:block) => { {const $count: usize = 4; $body} {const $count: usize = 9; $body} {const $count: usize = 25; $body}  {const $count: usize = 100; $body} } }

#[test]
fn explore() {
    use zonal_codegen::samples::Random;
    orders!(N, {
        let mut r = Random::new(1);
        let order = N.isqrt();
        for i in 0..4 {
            let mut q = [0.1f32, 0.2, 0.3, 0.9];
            q[i] = f32::NAN;
            let y = zonal::rotate(Quat::from_array(q), &[1.0f32; N]);
            let finite: Vec<usize> = (0..N).filter(|&i| !y[i].is_nan()).collect();
            println!("{N} q{i} {finite:?}");
            let y = zonal::Rotation::<[f32; N]>::new(Quat::from_array(q)).apply(&[1.0f32; N]);
            let finite: Vec<usize> = (0..N).filter(|&i| !y[i].is_nan()).collect();
            println!("{N} q{i} angles {finite:?}");
            if i < 3 {
                let mut d = [0.1f32, 0.2, 0.9];
                d[i] = f32::NAN;
                let d = Vec3::from_array(d);
                for (name, y) in [("basis", zonal::evaluate_basis::<[f32; N]>(d)), ("tilt", zonal::tilt(d, &[1.0f32; N])), ("align", zonal::align(d, &[1.0; N]))] {
                    let finite: Vec<usize> = (0..N).filter(|&i| !y[i].is_nan()).collect();
                    println!("{N} d{i} {name} {finite:?}");
                }
            }
        }
        for name in ["rotate", "rotation", "tilt", "align", "matrix", "basis", "eval", "zonal"] {
            for e in [1e-6, 1e-3, 1e-2, -1e-2, 0.1, -0.1] {
                let mut worst = vec![0f64; order];
                let scale = 1.0 + e;
                for _ in 0..2000 {
                    let mut c = [0f64; N];
                    for l in 0..order {
                        let v: Vec<f64> = (0..2 * l + 1).map(|_| r.signed()).collect();
                        let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
                        for (i, x) in v.iter().enumerate() { c[l * l + i] = x / norm; }
                    }
                    let q = DQuat::from_array(r.unit());
                    let d = DVec3::from_array(r.unit());
                    let t = dvec3(d.x, d.y, d.z.abs());
                    let mut g = [0f64; 2]; g[0] = 0.0;
                    let (a, b): ([f64; N], [f64; N]) = match name {
                        "rotate" => (zonal::rotate(q, &c), zonal::rotate(q * scale, &c)),
                        "matrix" => (zonal::rotate_matrix(DMat3::from_quat(q), &c), zonal::rotate_matrix(DMat3::from_quat(q) * scale, &c)),
                        "rotation" => (zonal::rotate(q, &c), zonal::Rotation::<[f64; N]>::new(q * scale).apply(&c)),
                        "tilt" => (zonal::tilt(t, &c), zonal::tilt(t * scale, &c)),
                        "align" => (zonal::align(d, &c), zonal::align(d * scale, &c)),
                        "basis" => (zonal::evaluate_basis(d), zonal::evaluate_basis(d * scale)),
                        "eval" => {
                            let mut a = [0f64; N]; let mut b = [0f64; N];
                            for l in 0..order {
                                let mut cc = [0f64; N]; cc[l * l..(l+1)*(l+1)].copy_from_slice(&c[l * l..(l+1)*(l+1)]);
                                a[l * l] = zonal::evaluate(d, &cc); b[l * l] = zonal::evaluate(d * scale, &cc);
                            }
                            (a, b)
                        }
                        _ => (c, c),
                    };
                    for l in 0..order {
                        let e = (l * l..(l + 1) * (l + 1)).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
                        worst[l] = worst[l].max(e);
                    }
                }
                println!("{N} {name} {e:e}: {:.2?}", worst.iter().map(|x| x / e.abs()).collect::<Vec<_>>());
            }
        }
    });
}
