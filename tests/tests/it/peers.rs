//! docs/LIGHTS.md: each function of DirectXMath's SHMath and of SHforHLSL with ours beside it, held to the formula that was
//! published for it. A row's check is what the row says; its costs and errors are the kernels'. This test compares the
//! page, and writes it with `UPDATE=1 cargo test -p zonal-tests peers`.

use crate::readme::hold;
use std::f64::consts::PI;
use zonal_codegen::families::Spec;
use zonal_codegen::families::family::MAX_HALF_ORDER;
use zonal_codegen::families::parts::zonal::cosine_lobe;
use zonal_codegen::generate::build;
use zonal_codegen::promise::samples::{Random, matrix_of};
use zonal_tests::turns::{apply, dot, transposed};
use zonal_tests::{Runner, larger, norm, spec};

/// A function of a library.
struct Peer {
    theirs: &'static str,
    /// The specs that do the same, joined by `, `; `n` is the order.
    ours: &'static str,
    /// How the one is got from the other.
    how: &'static str,
    /// Holds ours to what was published of theirs; nothing where ours is no kernel, or held elsewhere.
    check: Option<fn()>,
}

const fn peer(theirs: &'static str, ours: &'static str, how: &'static str, check: Option<fn()>) -> Peer {
    Peer { theirs, ours, how, check }
}

/// DirectXMath's, whose orders are 2 to 6. Its basis is ours.
const DIRECTX: [Peer; 13] = [
    peer("XMSHEvalDirection", "basis:n", "the same", Some(direction)),
    peer(
        "XMSHRotate",
        "rotate:n",
        "the rotation as a quaternion; `rotate:n:matrix` takes a matrix up to order 3",
        Some(rotation),
    ),
    peer("XMSHRotateZ", "rotate_z:n", "`cs` is the angle's cosine and sine", Some(rotation_z)),
    peer("XMSHAdd", "", "a loop over n² numbers", None),
    peer("XMSHScale", "", "a loop over n² numbers", None),
    peer("XMSHDot", "dot:n", "the same", None),
    peer("XMSHMultiply", "product:n", "the same", None),
    peer("XMSHMultiply2 to XMSHMultiply6", "product:n", "the same", None),
    peer(
        "XMSHEvalDirectionalLight",
        "light_directional:n",
        "`light` is the colour times π/(¾), π/(17/16), π/(17/16), π/(31/32), π/(31/32) at orders 2 to 6: a white surface that faces it sends out the colour",
        Some(directional),
    ),
    peer(
        "XMSHEvalSphericalLight",
        "light_sphere:n",
        "`light` is the colour, `dir` the direction to the centre, `s` r²/d²; the same inside of the sphere",
        Some(spherical),
    ),
    peer(
        "XMSHEvalConeLight",
        "light_cone:n",
        "`light` is the colour divided by sin² of the half-angle, by 1 from 90° on; below 1e-4 radians it is the directional light",
        Some(cone),
    ),
    peer(
        "XMSHEvalHemisphereLight",
        "light_hemisphere:n",
        "`top` and `bottom` are the colours times 3/2 as its source has it, times 6/5 to have what its documentation says: a white surface sends out the top colour where the bottom is black",
        Some(hemisphere),
    ),
    peer("SHProjectCubeMap", "", "`zonal project` reads latitude-longitude maps, on the CPU", None),
];

/// SHforHLSL's, whose orders are 2 and 3. Its basis has no Condon-Shortley phase: coefficients of odd m have the other sign.
const HLSL: [Peer; 19] = [
    peer("operators, Lerp", "", "a loop over n² numbers", None),
    peer("ToRGB", "", "a loop over n² numbers", None),
    peer("L2toL1", "", "the first n² numbers are the signal of order n", None),
    peer(
        "ProjectOntoL1, ProjectOntoL2",
        "light_directional:n",
        "`c` zero or the sum so far, `light` the value",
        Some(projection),
    ),
    peer("DotProduct", "dot:n", "the same", None),
    peer("Evaluate", "eval:n", "the same", Some(evaluation)),
    peer("ConvolveWithZH", "convolve:n", "`g` is theirs times √((2l+1)/4π)", Some(convolution)),
    peer("ConvolveWithCosineLobe", "convolve_cosine:n", "the same", Some(cosine)),
    peer(
        "OptimalLinearDirection",
        "dominant:n",
        "theirs sums the channels; give it the sum, or the luminance; theirs is not a number for zeros",
        Some(optimal_direction),
    ),
    peer(
        "ApproximateDirectionalLight",
        "light_fit:n, light_fit_along:n",
        "their colour is 2601/(1264 π²) times the light of order 2; `light_fit_along:n:rgb` gives each channel's",
        Some(approximate_light),
    ),
    peer("CalculateIrradiance", "irradiance:n", "the same: not divided by π", Some(irradiance)),
    peer(
        "CalculateIrradianceGeomerics",
        "eval_geomerics",
        "of the coefficients of irradiance, which `convolve_cosine:2` makes, one channel",
        None,
    ),
    peer("CalculateIrradianceL1ZH3Hallucinate", "eval_zh3", "of the coefficients of irradiance, one channel", None),
    peer(
        "ApproximateGGXAsL1ZH, ApproximateGGXAsL2ZH",
        "",
        "none for GGX; `gaussian:n`, `phong:n` and `henyey_greenstein:n` are lobes",
        None,
    ),
    peer("ConvolveWithGGX", "convolve:n", "with the coefficients of any lobe", Some(convolution)),
    peer(
        "ExtractSpecularDirLight",
        "dominant:n, eval:n",
        "the direction, and the radiance there; the roughness has no kernel",
        Some(evaluation),
    ),
    peer("Rotate", "rotate:n", "the rotation as a quaternion", Some(rotation)),
    peer("L1_RGB, L2_RGB", "eval:n:rgb", "`:rgb` of every kernel with a signal", None),
    peer("L1_F16, L2_F16", "eval:n:f16", "`:f16` where a kernel has it, WGSL only", None),
];

/// The order at which costs are told first; both libraries have it.
const ORDER: usize = 3;
/// The largest order of DirectXMath.
const LARGEST: usize = 6;

/// The specs of a row at an order; nothing where there is no such kernel.
fn specs(ours: &str, order: usize) -> Vec<Spec> {
    let at = |text: &str| text.replace(":n", &format!(":{order}")).parse().ok();
    ours.split(", ").filter(|text| !text.is_empty()).filter_map(at).collect()
}

/// A kernel's costs or errors, of each kernel of a row.
fn cells(ours: &str, order: usize, of: impl Fn(&zonal_codegen::emit::Function) -> String) -> String {
    let cells: Vec<String> = build(&specs(ours, order)).iter().map(of).collect();
    if cells.is_empty() { "–".to_owned() } else { cells.join(", ") }
}

fn table(peers: &[Peer]) -> String {
    let mut table = format!(
        "| theirs | ours | orders | how | operations, order {ORDER} | order {LARGEST} | f32 error, order {ORDER} | order {LARGEST} |\n\
         |---|---|---|---|---|---|---|---|\n"
    );
    for Peer { theirs: name, ours, how, .. } in peers {
        let cost = |order: usize| {
            cells(ours, order, |function| {
                let cost = function.built.code.cost(function.spec.channels());
                if cost.special == 0 { cost.total.to_string() } else { format!("{} + {}", cost.total, cost.special) }
            })
        };
        let error =
            |order: usize| cells(ours, order, |function| format!("{:.1e}", function.built.accuracy.rounding_f32));
        let all = [specs(ours, ORDER), specs(ours, LARGEST)].concat();
        let most = |spec: &Spec| if spec.half { MAX_HALF_ORDER } else { *spec.family.orders.end() };
        let [least, most] = [all.iter().map(|spec| *spec.family.orders.start()).min(), all.iter().map(most).max()];
        let orders = match least.zip(most) {
            None => "–".to_owned(),
            Some((least, most)) if least == most => least.to_string(),
            Some((least, most)) => format!("{least} to {most}"),
        };
        let ours = match ours.is_empty() {
            true => "–".to_owned(),
            false => ours.split(", ").map(|spec| format!("`{spec}`")).collect::<Vec<_>>().join(", "),
        };
        table += &format!(
            "| {name} | {ours} | {orders} | {how} | {} | {} | {} | {} |\n",
            cost(ORDER),
            cost(LARGEST),
            error(ORDER),
            error(LARGEST)
        );
    }
    table
}

/// The clamped cosine: its factor, and its zonal coefficient.
fn cosine_table() -> String {
    let mut table = "| band | A_l | A_l √((2l+1)/4π) |\n|---|---|---|\n".to_owned();
    for l in [0, 1, 2, 3, 4, 5, 6, 7, 8, 9] {
        let factor = cosine_lobe(l).to_f64();
        let zonal = factor * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
        table += &format!("| {l} | {factor:.17} | {zonal:.17} |\n");
    }
    table
}

#[test]
fn the_page_of_lights_is_what_the_kernels_say() {
    let blocks = [("directx", table(&DIRECTX)), ("hlsl", table(&HLSL)), ("cosine", cosine_table())];
    hold("docs/LIGHTS.md", "peers", &blocks);
}

#[test]
fn ours_are_what_was_published_of_theirs() {
    let checks: Vec<fn()> = DIRECTX.iter().chain(&HLSL).filter_map(|peer| peer.check).collect();
    assert!(checks.len() > 15);
    checks.into_iter().for_each(|check| check());
    // Of lights, and of what is made of a signal's bands, no row goes unchecked.
    for peer in DIRECTX.iter().chain(&HLSL) {
        let own = ["light_", "convolve", "dominant", "irradiance"].iter().any(|name| peer.ours.starts_with(name));
        assert!(!own || peer.check.is_some(), "{} is held to nothing", peer.theirs);
    }
}

fn run(text: &str, inputs: &[Vec<f64>]) -> Vec<f64> {
    Runner::<f64>::new(&spec(text)).run(inputs)
}

fn close(got: &[f64], want: &[f64], what: &str) {
    assert_eq!(got.len(), want.len(), "{what}");
    let error = got.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, larger);
    // Some ten roundings of numbers below ten.
    assert!(error <= 1e-14 * (1.0 + norm(want)), "{what}: {error:e}");
}

fn seeded(random: &mut Random, count: usize) -> Vec<f64> {
    (0..count).map(|_| random.signed()).collect()
}

/// n!
fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// The m-th derivative of the Legendre polynomial, by Rodrigues' formula multiplied out.
fn derivative(l: usize, m: usize, x: f64) -> f64 {
    let term = |j: usize| -> f64 {
        let power = l - 2 * j;
        if power < m {
            return 0.0;
        }
        let sign = if j.is_multiple_of(2) { 1.0 } else { -1.0 };
        let size = factorial(2 * l - 2 * j) / (factorial(j) * factorial(l - j) * factorial(power - m));
        sign * size * x.powi((power - m) as i32) / 2f64.powi(l as i32)
    };
    (0..=l / 2).map(term).sum()
}

/// The harmonics from their definition in angles (Sloan 2008, appendix A1), with the Condon-Shortley phase or without.
fn harmonics(order: usize, dir: &[f64], phase: bool) -> Vec<f64> {
    let (sin, phi) = (dir[0].hypot(dir[1]), dir[1].atan2(dir[0]));
    let mut all = Vec::new();
    for l in 0..order {
        for m in -(l as i32)..=l as i32 {
            let k = m.unsigned_abs() as usize;
            let norm = ((2 * l + 1) as f64 * factorial(l - k) / (4.0 * PI * factorial(l + k))).sqrt();
            let angle = f64::from(m.abs()) * phi;
            let wave = match m {
                0 => 1.0,
                _ if m > 0 => 2f64.sqrt() * angle.cos(),
                _ => 2f64.sqrt() * angle.sin(),
            };
            let sign = if phase && k % 2 == 1 { -1.0 } else { 1.0 };
            all.push(sign * norm * sin.powi(k as i32) * derivative(l, k, dir[2]) * wave);
        }
    }
    all
}

/// A signal of SHforHLSL as one of ours, or back: the parity of m is that of its place l(l+1) + m.
fn other_phase(c: &[f64]) -> Vec<f64> {
    c.iter().enumerate().map(|(place, x)| if place % 2 == 1 { -x } else { *x }).collect()
}

/// What a white surface sends out whose normal is a direction: irradiance over π, by its definition.
fn exit_radiance(order: usize, c: &[f64], normal: &[f64]) -> f64 {
    let y = harmonics(order, normal, true);
    let lobe = |place: usize| zonal_codegen::environment::cosine_lobe(place.isqrt()) / PI;
    (0..order * order).map(|place| lobe(place) * c[place] * y[place]).sum()
}

fn direction() {
    let mut random = Random::new(1);
    for order in 2..=LARGEST {
        let dir = random.unit::<3>().to_vec();
        close(
            &run(&format!("basis:{order}"), std::slice::from_ref(&dir)),
            &harmonics(order, &dir, true),
            "XMSHEvalDirection",
        );
    }
}

/// The value of the rotated function in a rotated direction is the value of the function.
fn rotated_by(text: &str, order: usize, parameter: Vec<f64>, matrix: &[f64; 9]) {
    let mut random = Random::new(2);
    let c = seeded(&mut random, order * order);
    let turned = run(text, &[parameter, c.clone()]);
    for _ in 0..10 {
        let dir = random.unit::<3>();
        let back = apply(&transposed(matrix), &dir);
        let [got, want] = [(&turned, &dir), (&c, &back)].map(|(c, dir)| dot(&harmonics(order, dir, true), c));
        close(&[got], &[want], text);
    }
}

fn rotation() {
    let mut random = Random::new(3);
    for order in 2..=LARGEST {
        let q = random.unit::<4>();
        rotated_by(&format!("rotate:{order}"), order, q.to_vec(), &matrix_of(q));
    }
}

fn rotation_z() {
    for order in 2..=LARGEST {
        let (sin, cos) = 0.7f64.sin_cos();
        let matrix = [cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0];
        rotated_by(&format!("rotate_z:{order}"), order, vec![cos, sin], &matrix);
    }
}

/// Sloan 2008, *normalisation*: 1/4 + 1/2 + 5/16 + 0 − 3/32 + 0, of the bands that there are.
fn directional() {
    let mut random = Random::new(4);
    for order in 2..=LARGEST {
        let whole: f64 = [0.25, 0.5, 5.0 / 16.0, 0.0, -3.0 / 32.0, 0.0][..order].iter().sum();
        let (dir, colour) = (random.unit::<3>().to_vec(), 0.8);
        let want: Vec<f64> = harmonics(order, &dir, true).iter().map(|y| y * colour * PI / whole).collect();
        let zero = vec![0.0; order * order];
        let got = run(&format!("light_directional:{order}"), &[dir.clone(), vec![colour * PI / whole], zero]);
        close(&got, &want, "XMSHEvalDirectionalLight");
        close(&[exit_radiance(order, &got, &dir)], &[colour], "its normalisation");
    }
}

/// A cap of radiance one about z, by ∫ P_l = (P_(l−1) − P_(l+1)) / (2l + 1), turned to a direction.
fn capped(order: usize, dir: &[f64], angle: f64) -> Vec<f64> {
    let (cos, y) = (angle.cos(), harmonics(order, dir, true));
    let band = |l: usize| match l {
        0 => 1.0 - cos,
        _ => (derivative(l - 1, 0, cos) - derivative(l + 1, 0, cos)) / (2 * l + 1) as f64,
    };
    y.iter().enumerate().map(|(place, y)| 2.0 * PI * band(place.isqrt()) * y).collect()
}

/// "There is no normalization of the intensity": the cap that the sphere fills, a hemisphere from inside of it.
fn spherical() {
    let mut random = Random::new(5);
    for order in 2..=LARGEST {
        for (distance, radius) in [(2.0, 0.5), (3.0, 2.9), (1.0, 2.0f64)] {
            let (dir, colour) = (random.unit::<3>().to_vec(), 0.6);
            let angle = if distance <= radius { PI / 2.0 } else { (radius / distance).asin() };
            let want: Vec<f64> = capped(order, &dir, angle).iter().map(|x| x * colour).collect();
            let s = (radius / distance) * (radius / distance);
            let zero = vec![0.0; order * order];
            let got = run(&format!("light_sphere:{order}"), &[dir, vec![s], vec![colour], zero]);
            close(&got, &want, "XMSHEvalSphericalLight");
        }
    }
}

/// "The exit radiance of a point directly under the light" is the colour, of all bands: that is sin² of the half-angle.
fn cone() {
    let mut random = Random::new(6);
    for order in 2..=LARGEST {
        for angle in [0.2f64, 1.0, PI / 2.0, 2.5] {
            let (dir, colour) = (random.unit::<3>().to_vec(), 0.9);
            let square = angle.min(PI / 2.0).sin().powi(2);
            let want: Vec<f64> = capped(order, &dir, angle).iter().map(|x| x * colour / square).collect();
            let zero = vec![0.0; order * order];
            let got = run(&format!("light_cone:{order}"), &[dir, vec![angle.cos()], vec![colour / square], zero]);
            close(&got, &want, "XMSHEvalConeLight");
        }
    }
    let far: Vec<f64> = run("light_cone:16", &[vec![0.0, 0.0, 1.0], vec![0.0], vec![1.0], vec![0.0; 256]]);
    // Bands from 16 on hold what is missing of one.
    assert!((exit_radiance(16, &far, &[0.0, 0.0, 1.0]) - 1.0).abs() < 0.01);
}

/// Linear in the height along the axis. "Normalized so that … exit radiance with a value of 1" needs 6/5; its source has 3/2.
fn hemisphere() {
    let mut random = Random::new(7);
    for order in 2..=LARGEST {
        let dir = random.unit::<3>().to_vec();
        let light = |factor: f64, top: f64, bottom: f64| {
            let zero = vec![0.0; order * order];
            run(&format!("light_hemisphere:{order}"), &[dir.clone(), vec![factor * top], vec![factor * bottom], zero])
        };
        let (top, bottom) = (0.7, 0.2);
        let mean = 1.5 * (top + bottom) / 2.0;
        let slope = 1.5 * (top - bottom) / 2.0;
        let y = harmonics(order, &dir, true);
        let want: Vec<f64> = (0..order * order)
            .map(|place| match place {
                0 => mean * (4.0 * PI).sqrt(),
                1..=3 => slope * 4.0 * PI / 3.0 * y[place],
                _ => 0.0,
            })
            .collect();
        close(&light(1.5, top, bottom), &want, "XMSHEvalHemisphereLight");
        close(&[exit_radiance(order, &light(1.2, 1.0, 0.0), &dir)], &[1.0], "its documentation");
        close(&[exit_radiance(order, &light(1.5, 1.0, 0.0), &dir)], &[1.25], "its source");
    }
}

fn projection() {
    let mut random = Random::new(8);
    for order in [2, 3] {
        let (dir, value) = (random.unit::<3>().to_vec(), 0.4);
        let want: Vec<f64> = harmonics(order, &dir, false).iter().map(|y| y * value).collect();
        let got = run(&format!("light_directional:{order}"), &[dir, vec![value], vec![0.0; order * order]]);
        close(&other_phase(&got), &want, "ProjectOnto");
    }
}

fn evaluation() {
    let mut random = Random::new(9);
    for order in [2, 3] {
        let (dir, c) = (random.unit::<3>().to_vec(), seeded(&mut random, order * order));
        let want = dot(&harmonics(order, &dir, false), &c);
        close(&run(&format!("eval:{order}"), &[dir, other_phase(&c)]), &[want], "Evaluate");
    }
}

fn convolution() {
    let mut random = Random::new(10);
    for order in [2, 3] {
        let (c, zh) = (seeded(&mut random, order * order), seeded(&mut random, order));
        let want: Vec<f64> = c.iter().enumerate().map(|(place, x)| x * zh[place.isqrt()]).collect();
        let g = zh.iter().enumerate().map(|(l, x)| x * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt()).collect();
        close(&run(&format!("convolve:{order}"), &[g, c]), &want, "ConvolveWithZH");
    }
}

fn cosine() {
    let mut random = Random::new(11);
    for order in [2, 3] {
        let c = seeded(&mut random, order * order);
        let lobe = [PI, 2.0 * PI / 3.0, PI / 4.0];
        let want: Vec<f64> = c.iter().enumerate().map(|(place, x)| x * lobe[place.isqrt()]).collect();
        close(&run(&format!("convolve_cosine:{order}"), &[c]), &want, "ConvolveWithCosineLobe");
    }
}

/// Three channels and their sum, in their basis.
fn channels(random: &mut Random) -> ([Vec<f64>; 3], Vec<f64>) {
    let all: [Vec<f64>; 3] = std::array::from_fn(|_| seeded(random, 4));
    let sum = (0..4).map(|i| all.iter().map(|c| c[i]).sum()).collect();
    (all, sum)
}

/// Sloan 2008, *optimal linear direction*.
fn linear_direction(sum: &[f64]) -> Vec<f64> {
    let d = [sum[3], sum[1], sum[2]];
    d.map(|x| x / norm(&d)).to_vec()
}

fn optimal_direction() {
    let (_, sum) = channels(&mut Random::new(12));
    close(&run("dominant:2", &[other_phase(&sum)]), &linear_direction(&sum), "OptimalLinearDirection");
}

fn approximate_light() {
    let (all, sum) = channels(&mut Random::new(13));
    let dir = linear_direction(&sum);
    let y = harmonics(2, &dir, false);
    for c in all {
        let want = dot(&y[1..], &c[1..]) * 867.0 / (316.0 * PI);
        let light = run("light_fit_along:2", &[dir.clone(), other_phase(&c)])[0];
        close(&[light * 2601.0 / (1264.0 * PI * PI)], &[want], "ApproximateDirectionalLight");
    }
    // Sloan 2008: of order 3, in units of a directional light of exit radiance one.
    let mut random = Random::new(14);
    let c = seeded(&mut random, 9);
    let fit = run("light_fit:3", std::slice::from_ref(&c));
    let lobe = |place: usize| zonal_codegen::environment::cosine_lobe(place.isqrt()) / PI;
    let unit = 16.0 * PI / 17.0;
    let light: Vec<f64> = harmonics(3, &fit[..3], true).iter().map(|y| y * unit).collect();
    let sum: f64 = (1..9).map(|place| lobe(place).powi(2) * light[place] * c[place]).sum();
    let colour = sum * 867.0 / (316.0 * PI);
    let ambient = (c[0] - colour * 8.0 * PI.sqrt() / 17.0) / (2.0 * PI.sqrt());
    close(&fit[3..], &[colour * unit, ambient], "the light and the ambient of Sloan 2008");
}

fn irradiance() {
    let mut random = Random::new(15);
    for order in [2, 3] {
        let (dir, c) = (random.unit::<3>().to_vec(), seeded(&mut random, order * order));
        let lobe = [PI, 2.0 * PI / 3.0, PI / 4.0];
        let y = harmonics(order, &dir, false);
        let want: f64 = (0..order * order).map(|place| lobe[place.isqrt()] * y[place] * c[place]).sum();
        close(&run(&format!("irradiance:{order}"), &[dir, other_phase(&c)]), &[want], "CalculateIrradiance");
    }
}
