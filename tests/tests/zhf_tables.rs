//! The lobe sets: their directions, matrices and counts of non-zeros against the golden ones, and both of the ways to
//! rotate by them.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use zonal_codegen::sh::exact::Exact;
use zonal_codegen::sh::index::degrees;
use zonal_codegen::sh::zhf::{self, Lobe, LobeSet};

fn golden<T: DeserializeOwned>(name: &str) -> T {
    let path = format!("{}/golden/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn non_zeros(matrix: &[Vec<Exact>]) -> usize {
    matrix.iter().flatten().filter(|x| !x.is_zero()).count()
}

fn non_zeros_by_band(set: &LobeSet) -> Vec<usize> {
    (0..set.order).map(|l| non_zeros(set.a_hat(l))).collect()
}

fn values(matrix: &[Vec<Exact>]) -> Vec<Vec<f64>> {
    matrix.iter().map(|row| row.iter().map(Exact::to_f64).collect()).collect()
}

#[track_caller]
fn assert_close(a: &[Vec<f64>], b: &[Vec<f64>], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    for (x, y) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((x - y).abs() <= tolerance, "{x} is not {y}");
    }
}

/// The quotient of the largest and the smallest singular value, by one-sided Jacobi rotations.
fn condition(matrix: &[Vec<f64>]) -> f64 {
    let mut rows = matrix.to_vec();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    for _ in 0..30 {
        for i in 1..rows.len() {
            let (head, tail) = rows.split_at_mut(i);
            for a in head {
                let b = &mut tail[0];
                let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
                let angle = 0.5 * (2.0 * ab).atan2(aa - bb);
                let (sin, cos) = angle.sin_cos();
                for (x, y) in a.iter_mut().zip(b) {
                    (*x, *y) = (cos * *x + sin * *y, cos * *y - sin * *x);
                }
            }
        }
    }
    let sizes = rows.iter().map(|row| dot(row, row).sqrt());
    sizes.clone().fold(0.0, f64::max) / sizes.fold(f64::INFINITY, f64::min)
}

#[derive(Deserialize)]
struct Shared {
    #[serde(rename = "N")]
    order: usize,
    free: bool,
    per_band: Vec<usize>,
    cond: Vec<f64>,
    xyz: Vec<[f64; 3]>,
    subs: Vec<Vec<usize>>,
}

#[derive(Deserialize)]
struct Band {
    nnz: usize,
    cond: f64,
    xyz: Vec<[f64; 3]>,
    rows: Vec<usize>,
}

fn assert_directions(lobes: &[Lobe], golden: &[[f64; 3]]) {
    let ours: Vec<_> = lobes.iter().map(|lobe| lobe.xyz().map(|x| x.to_f64()).to_vec()).collect();
    assert_close(&ours, &golden.iter().map(|d| d.to_vec()).collect::<Vec<_>>(), 1e-11);
}

#[test]
fn the_shared_sets_are_the_golden_ones() {
    for golden in golden::<Vec<Shared>>("zhf_best_shared") {
        let set = if golden.free { zhf::shared_free(golden.order) } else { zhf::shared(golden.order) }.unwrap();
        assert_eq!(set.order, golden.order);
        assert_directions(&set.directions, &golden.xyz);
        assert_eq!(set.subsets, golden.subs);
        assert_eq!(non_zeros_by_band(set), golden.per_band);
        for (l, cond) in golden.cond.iter().enumerate() {
            let own = condition(&values(&zhf::lobe_values(l, &set.lobes(l))));
            assert!((own / cond - 1.0).abs() < 1e-6, "order {} band {l}: {own}, golden {cond}", golden.order);
        }
    }
}

#[test]
fn the_sets_have_the_known_counts_of_non_zeros() {
    let totals = |find: fn(usize) -> Option<&'static LobeSet>| -> Vec<usize> {
        (2..=10).map(|order| non_zeros_by_band(find(order).unwrap()).iter().skip(2).sum()).collect()
    };
    assert_eq!(totals(zhf::shared), [0, 9, 28, 67, 135, 231, 352, 512, 730]);
    assert_eq!(totals(zhf::shared_free), [0, 9, 28, 67, 124, 218, 347, 499, 721]);
    for order in [0, 1, 11] {
        assert!(zhf::shared(order).is_none() && zhf::shared_free(order).is_none());
    }
}

#[test]
fn the_bands_sets_are_the_golden_ones() {
    let golden: BTreeMap<String, Band> = golden("zhf_best_band");
    for l in (2..=8).chain([10]) {
        let (golden, lobes) = (&golden[&l.to_string()], zhf::single_band(l).unwrap());
        assert_directions(lobes, &golden.xyz);
        let a_hat = zhf::a_hat(l, lobes).unwrap();
        let rows: Vec<_> = a_hat.iter().map(|row| non_zeros(std::slice::from_ref(row))).collect();
        assert_eq!((non_zeros(&a_hat), &rows), (golden.nnz, &golden.rows), "band {l}");
        let cond = condition(&values(&zhf::lobe_values(l, lobes)));
        assert!((cond / golden.cond - 1.0).abs() < 1e-6, "band {l}: {cond}, golden {}", golden.cond);
    }
    // A sparser set than the golden one, and a better conditioned one.
    let lobes = zhf::single_band(9).unwrap();
    assert_eq!(non_zeros(&zhf::a_hat(9, lobes).unwrap()), 205);
    assert!(205 < golden["9"].nnz && condition(&values(&zhf::lobe_values(9, lobes))) < 16.0);
}

#[test]
fn the_matrices_are_the_golden_ones() {
    #[derive(Deserialize)]
    struct Golden {
        cases: Vec<Case>,
    }
    #[derive(Deserialize)]
    #[allow(non_snake_case)]
    struct Case {
        name: String,
        l: usize,
        dirs: Vec<[f64; 3]>,
        Y: Vec<Vec<f64>>,
        Ahat: Vec<Vec<f64>>,
        nnz: usize,
    }
    let golden: Golden = golden("zhf");
    for (name, lobes) in [
        ("sparse_found_l2", "pole, P2,0#1 7/4, P2,0#1 1/4, P2,0#1 5/4, equator 1/2"),
        ("sparse_found_l3", "P3,1#1 11/6, equator 2/3, equator 0, P3,1#1 1/6, P3,1#1 7/6, pole, equator 1/3"),
        (
            "sparse_found_l4",
            "equator 7/8, pole, P4,0#2 3/2, equator 1/2, equator 0, P4,1#1 1/2, equator 3/8, P2,0#1 1, P4,1#1 1",
        ),
        (
            "sparse_found_l5",
            "P3,1#1 7/8, P2,0#1 0, pole, P3,1#1 11/8, equator 3/4, P2,0#1 1/2, equator 1/2, P2,0#1 3/2, P3,1#1 9/8, \
             equator 1/4, equator 0",
        ),
        (
            "sparse_found_l6",
            "P6,1#2 1/2, pole, equator 2/3, P6,1#2 0, P5,0#2 0, equator 7/8, P4,2#1 1/2, equator 1/2, equator 1/3, \
             P6,1#1 1, P6,1#1 3/2, equator 0, equator 3/8",
        ),
    ] {
        let case = golden.cases.iter().find(|case| case.name == name).unwrap();
        let lobes: Vec<Lobe> = lobes.split(", ").map(|text| text.parse().unwrap()).collect();
        assert_directions(&lobes, &case.dirs);
        assert_close(&values(&zhf::lobe_values(case.l, &lobes)), &case.Y, 1e-9);
        let a_hat = zhf::a_hat(case.l, &lobes).unwrap();
        assert_close(&values(&a_hat), &case.Ahat, 1e-9);
        assert_eq!(non_zeros(&a_hat), case.nnz, "{name}");
    }
}

/// What is no zero is far from one, and Â is the inverse of Y.
#[test]
fn zeros_are_told_from_small_numbers() {
    for order in 2..=10 {
        for set in [zhf::shared(order).unwrap(), zhf::shared_free(order).unwrap()] {
            for l in 0..order {
                let (y, a_hat) = (zhf::lobe_values(l, &set.lobes(l)), set.a_hat(l));
                for x in y.iter().chain(a_hat).flatten().filter(|x| !x.is_zero()) {
                    assert!(x.to_f64().abs() > 2f64.powi(-60), "order {order} band {l}: {x:?}");
                }
                for (i, row) in y.iter().enumerate() {
                    let product = |d: usize| row.iter().zip(a_hat).map(|(x, a)| x * &a[d]).sum::<Exact>();
                    assert!((0..y.len()).all(|d| if d == i { product(d).is_one() } else { product(d).is_zero() }));
                }
            }
        }
    }
}

/// c' = Â f(R⁻¹ω_d) and c' = Σ_d z_d y(Rω_d) with z = Âᵀ c are D c.
#[test]
fn both_ways_rotate() {
    #[derive(Deserialize)]
    #[allow(non_snake_case)]
    struct Case {
        R: [[f64; 3]; 3],
        D: Vec<Vec<Vec<f64>>>,
    }
    #[derive(Deserialize)]
    struct Golden {
        cases: Vec<Case>,
    }
    let golden: Golden = golden("rotations");
    let set = zhf::shared(6).unwrap();
    for (case, l) in golden.cases.iter().flat_map(|case| (1..6).map(move |l| (case, l))) {
        let a_hat = values(set.a_hat(l));
        let c: Vec<f64> = degrees(l).map(|m| ((3 * m + 1) as f64).sin()).collect();
        let expected: Vec<f64> = case.D[l].iter().map(|row| row.iter().zip(&c).map(|(d, c)| d * c).sum()).collect();
        let mut tailored = vec![0.0; c.len()];
        let mut standard = vec![0.0; c.len()];
        for (d, lobe) in set.lobes(l).iter().enumerate() {
            let w = lobe.xyz().map(|x| x.to_f64());
            let back = [0, 1, 2].map(|i| (0..3).map(|j| case.R[j][i] * w[j]).sum::<f64>());
            let forth = [0, 1, 2].map(|i| (0..3).map(|j| case.R[i][j] * w[j]).sum::<f64>());
            let sample: f64 = band(l, back).iter().zip(&c).map(|(y, c)| y * c).sum();
            let weight: f64 = a_hat.iter().zip(&c).map(|(row, c)| row[d] * c).sum();
            for (m, y) in band(l, forth).iter().enumerate() {
                tailored[m] += a_hat[m][d] * sample;
                standard[m] += weight * y;
            }
        }
        assert_close(&[tailored], std::slice::from_ref(&expected), 1e-12);
        assert_close(&[standard], &[expected], 1e-12);
    }
}

/// Band `l` of the basis in `f64`.
fn band(l: usize, [x, y, z]: [f64; 3]) -> Vec<f64> {
    use zonal_codegen::sh::tables::{basis_factor, legendre_polynomial};
    let mut values = vec![0.0; 2 * l + 1];
    let (mut cosine, mut sine) = (1.0, 0.0);
    for m in 0..=l {
        let polynomial = legendre_polynomial(l, m);
        let value = polynomial.iter().rev().fold(0.0, |sum, c| sum * z + c.to_f64());
        let factor = basis_factor(l, m as isize).to_f64() * value;
        values[l - m] = factor * sine;
        values[l + m] = factor * cosine;
        (cosine, sine) = (cosine * x - sine * y, cosine * y + sine * x);
    }
    values
}

#[test]
fn directions_read_as_they_are_written() {
    for text in ["pole", "equator 0", "equator 3/4", "P6,1#2 1/3", "P10,8#1 7/4"] {
        assert_eq!(text.parse::<Lobe>().unwrap().to_string(), text);
    }
    for text in ["", "equator", "equator 1/0", "P6,1 1/3", "P6,1#0 0", "P6,1#3 0", "P6,7#1 0", "P65,1#1 0", "north"] {
        let error = text.parse::<Lobe>().unwrap_err().to_string();
        assert!(error.starts_with(&format!("`{text}`")), "{error}");
    }
    assert_eq!("P6,1#2 1/3".parse::<Lobe>().unwrap().describe(), "z = root 2 of P_6^1, azimuth π/3");
}
