//! The exact tables against the golden ones: equal as rationals where those are, equal to the bit as `f64`.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use zonal_codegen::families::lifted;
use zonal_codegen::math::exact::Exact;
use zonal_codegen::math::index::{coefficients, degrees, index};
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::math::tables;

fn golden<T: DeserializeOwned>(name: &str) -> T {
    let path = format!("{}/golden/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// The sines' factors in a lifted coupling, each times its frequency, add up to the generator's entry, which is checked
/// against the golden `dy`.
#[test]
fn lifted_couplings_have_the_generator_as_their_slope() {
    for l in 1..=12 {
        let all = lifted::couplings(l);
        assert_eq!(all.len(), l * (l + 1) / 2);
        for [even, odd] in all {
            let factors = lifted::factors(l, [even, odd]);
            let slope = (1..).zip(&factors).fold(Exact::zero(), |sum, (k, factor)| sum + Exact::int(k) * factor);
            let want = match (even - odd).abs() {
                1 if even > odd => tables::dy_sub_diag(l, even),
                1 => -tables::dy_sub_diag(l, odd),
                _ => Exact::zero(),
            };
            assert_eq!(slope, want, "band {l}, {even} and {odd}");
        }
    }
}

/// A rational written p or p/q, of any length.
fn rational(text: &str) -> Exact {
    let natural = |digits: &str| {
        digits.bytes().fold(Exact::zero(), |n, digit| n * Exact::int(10) + Exact::int((digit - b'0').into()))
    };
    let (p, q) = text.split_once('/').unwrap_or((text, "1"));
    let size = natural(p.trim_start_matches('-')) / natural(q);
    if p.starts_with('-') { -size } else { size }
}

fn signed_square(e: &Exact) -> Exact {
    e * e.abs()
}

#[track_caller]
fn assert_bits(e: &Exact, expected: f64, what: &str) {
    assert_eq!(e.to_f64() + 0.0, expected + 0.0, "{what}");
    let single = e.to_f32();
    assert!(single == expected as f32 || is_midpoint(expected), "{what}: {single} for {expected}");
}

/// Whether a rounding to `f32` by way of this `f64` may differ from the one from the exact value.
fn is_midpoint(x: f64) -> bool {
    x.to_bits() & 0x1fff_ffff == 0x1000_0000
}

#[test]
fn the_swap_is_the_golden_one() {
    #[derive(Deserialize)]
    struct Golden {
        signed_sq: Vec<Vec<Vec<String>>>,
        f64: Vec<Vec<Vec<f64>>>,
    }
    let golden: Golden = golden("J");
    for (l, (squares, values)) in golden.signed_sq.iter().zip(&golden.f64).enumerate() {
        for (a, (squares, values)) in degrees(l).zip(squares.iter().zip(values)) {
            for (b, (square, value)) in degrees(l).zip(squares.iter().zip(values)) {
                let entry = tables::swap_yz(l, a, b);
                assert_eq!(signed_square(&entry), rational(square), "J {l} {a} {b}");
                assert_bits(&entry, *value, &format!("J {l} {a} {b}"));
            }
        }
    }
}

#[test]
fn the_norms_are_the_golden_ones() {
    #[derive(Deserialize)]
    struct Golden {
        sq: Vec<Vec<String>>,
        #[serde(rename = "K")]
        k: Vec<Vec<f64>>,
    }
    let golden: Golden = golden("K");
    for (l, (squares, values)) in golden.sq.iter().zip(&golden.k).enumerate() {
        for (m, (square, value)) in squares.iter().zip(values).enumerate() {
            let k = tables::k(l, m);
            assert_eq!(&k * &k * Exact::int(4) * Exact::pi_sqrt_power(2), rational(square), "K {l} {m}");
            assert_bits(&k, *value, &format!("K {l} {m}"));
        }
    }
}

#[test]
fn the_derivatives_about_y_are_the_golden_ones() {
    #[derive(Deserialize)]
    #[serde(rename_all = "camelCase")]
    struct Golden {
        n: usize,
        dy_sub_diag: Vec<f64>,
        ddy_diag: Vec<f64>,
    }
    let golden: Golden = golden("dy");
    for (i, (l, m)) in coefficients(golden.n).enumerate() {
        assert_bits(&tables::dy_sub_diag(l, m), golden.dy_sub_diag[i], &format!("dySubDiag {l} {m}"));
        assert_bits(&tables::ddy_diag(l, m), golden.ddy_diag[i], &format!("ddyDiag {l} {m}"));
    }
}

/// The second derivative is the square of the first, of which the diagonal is two products.
#[test]
fn the_second_derivative_is_the_square_of_the_first() {
    for (l, m) in coefficients(10) {
        // Its entries besides those at [m, m-1] are their mirror images; degree -1 is joined to -2 only.
        let below = tables::dy_sub_diag(l, m);
        let above = if m == l as isize { Exact::zero() } else { tables::dy_sub_diag(l, m + 1) };
        assert_eq!(-(&below * &below + &above * &above), tables::ddy_diag(l, m), "{l} {m}");
    }
}

/// D J = F J and J F of the rotations by ±90° about x, against the basis in golden directions that these permute.
#[test]
fn x90_turns_the_basis() {
    #[derive(Deserialize)]
    struct Golden {
        n: usize,
        cases: Vec<Case>,
    }
    #[derive(Deserialize)]
    struct Case {
        name: String,
        unit: [f64; 3],
        y: Vec<f64>,
    }
    let golden: Golden = golden("basis");
    for case in &golden.cases {
        let [x, y, z] = case.unit;
        for (sign, turned) in [(1, [x, -z, y]), (-1, [x, z, -y])] {
            let expected = basis(golden.n, turned);
            for (l, a) in coefficients(golden.n) {
                let value: f64 = degrees(l).map(|b| tables::x90(l, a, b, sign).to_f64() * case.y[index(l, b)]).sum();
                assert!((value - expected[index(l, a)]).abs() < 1e-12, "{} {sign} {l} {a}", case.name);
            }
        }
        let (own, golden) = (basis(golden.n, case.unit), &case.y);
        assert!(own.iter().zip(golden).all(|(a, b)| (a - b).abs() < 1e-12), "{}", case.name);
    }
}

/// The basis in `f64` from the tables' recurrence and factors.
fn basis(order: usize, [x, y, z]: [f64; 3]) -> Vec<f64> {
    let mut values = vec![0.0; order * order];
    let (mut cosine, mut sine) = (1.0, 0.0);
    for m in 0..order {
        let degree = m as isize;
        let mut last = 0.0;
        // K P^(m) at l = m, with the basis's sign and √2.
        let mut current = tables::legendre_polynomial(m, m)[0].to_f64() * tables::basis_factor(m, degree).to_f64();
        for l in m..order {
            if l > m {
                let (a, b) = tables::legendre_recurrence(l, m);
                (last, current) = (current, a.to_f64() * z * current - b.to_f64() * last);
            }
            values[index(l, degree)] = current * cosine;
            if m > 0 {
                values[index(l, -degree)] = current * sine;
            }
        }
        (cosine, sine) = (cosine * x - sine * y, cosine * y + sine * x);
    }
    values
}

/// The quadrature itself: x^2k integrates to 2 / (2k + 1) up to twice the number of nodes.
#[test]
fn the_quadrature_is_exact() {
    for count in [2, 5, 10] {
        let nodes: Vec<(f64, f64)> = gauss_legendre(count, -1.0, 1.0).collect();
        for power in 0..2 * count as i32 {
            let got: f64 = nodes.iter().map(|(x, weight)| weight * x.powi(power)).sum();
            let want = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
            assert!((got - want).abs() <= 1e-14, "{count} nodes, x^{power}: {got}");
        }
    }
}
