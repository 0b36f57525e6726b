//! The lobe sets: their directions, matrices and counts of non-zeros against the golden ones, and both of the ways to
//! rotate by them.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use zonal_codegen::families::zhf::lobes::{self, Lobe, LobeSet, Mode, Record};
use zonal_codegen::math::exact::Exact;
use zonal_codegen::math::index::degrees;

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
    dirs: Vec<(String, f64, String)>,
    xyz: Vec<[f64; 3]>,
    subs: Vec<Vec<usize>>,
}

#[derive(Deserialize)]
struct Band {
    nnz: usize,
    cond: f64,
    dirs: Vec<(String, f64, String)>,
    xyz: Vec<[f64; 3]>,
    rows: Vec<usize>,
}

/// The golden directions by the names of this project.
fn names(golden: &[(String, f64, String)]) -> Vec<String> {
    let name = |(height, _, azimuth): &(String, f64, String)| match height.as_str() {
        "pole" => "pole".to_owned(),
        "P1,0#1" => format!("equator {azimuth}"),
        root => format!("{root} {azimuth}"),
    };
    golden.iter().map(name).collect()
}

fn assert_directions(lobes: &[Lobe], golden: &[[f64; 3]]) {
    let ours: Vec<_> = lobes.iter().map(|lobe| lobe.xyz().map(|x| x.to_f64()).to_vec()).collect();
    assert_close(&ours, &golden.iter().map(|d| d.to_vec()).collect::<Vec<_>>(), 1e-11);
}

fn parsed(names: &[String]) -> Vec<Lobe> {
    names.iter().map(|name| name.parse().unwrap()).collect()
}

/// The sets that were known before have the non-zeros and conditions that other code found, and those that kernels use are
/// no denser.
#[test]
fn the_golden_shared_sets_are_counted_right_and_matched() {
    for golden in golden::<Vec<Shared>>("zhf_best_shared") {
        let mode = if golden.free { Mode::Free } else { Mode::Nested };
        let subsets = if golden.free { golden.subs } else { Vec::new() };
        let record = Record::new(mode, golden.order, (0, 0), names(&golden.dirs), subsets).unwrap();
        assert_directions(&parsed(&record.lobes), &golden.xyz);
        assert_eq!(record.nonzeros, golden.per_band);
        let worst = golden.cond.iter().copied().fold(0.0, f64::max);
        assert!((record.condition - worst).abs() <= 1e-6 * worst + 1e-4, "order {}", golden.order);
        for (l, (cond, (_, members))) in golden.cond.iter().zip(record.parts()).enumerate() {
            let lobes: Vec<Lobe> = members.iter().map(|&d| record.lobes[d].parse().unwrap()).collect();
            let own = condition(&values(&lobes::lobe_values(l, &lobes)));
            assert!((own / cond - 1.0).abs() < 1e-6, "order {} band {l}: {own}, golden {cond}", golden.order);
        }
        let used = lobes::chosen(mode, golden.order).unwrap();
        assert!(used.total() <= record.total() && used.condition <= lobes::LARGEST_CONDITION, "{used:?}");
    }
}

#[test]
fn the_golden_sets_of_bands_are_counted_right_and_matched() {
    let mut all: BTreeMap<String, serde_json::Value> = golden("zhf_best_band");
    for l in 2..=10 {
        let golden: Band = serde_json::from_value(all.remove(&l.to_string()).unwrap()).unwrap();
        let names = names(&golden.dirs);
        let lobes = parsed(&names);
        assert_directions(&lobes, &golden.xyz);
        let a_hat = lobes::a_hat(l, &lobes).unwrap();
        let rows: Vec<_> = a_hat.iter().map(|row| non_zeros(std::slice::from_ref(row))).collect();
        assert_eq!((non_zeros(&a_hat), &rows), (golden.nnz, &golden.rows), "band {l}");
        let cond = condition(&values(&lobes::lobe_values(l, &lobes)));
        assert!((cond / golden.cond - 1.0).abs() < 1e-6, "band {l}: {cond}, golden {}", golden.cond);
        let used = lobes::chosen(Mode::Band, l).unwrap();
        assert!(used.total() <= golden.nnz && used.condition <= golden.cond + 1e-4, "{used:?}");
        assert_eq!(non_zeros(&lobes::a_hat(l, lobes::single_band(l).unwrap()).unwrap()), used.total());
    }
}

/// The best that was known before the search, in the bands from 2 on.
#[test]
fn the_sets_in_use_are_no_denser_than_those_known_before() {
    let totals = |find: fn(usize) -> Option<&'static LobeSet>| -> Vec<usize> {
        (2..=10).map(|order| non_zeros_by_band(find(order).unwrap()).iter().skip(2).sum()).collect()
    };
    let (nested, free) = (totals(lobes::shared), totals(lobes::shared_free));
    println!("from band 2, nested {nested:?}, free {free:?}");
    assert!(
        nested.iter().zip([0, 9, 28, 67, 135, 231, 352, 513, 730]).all(|(own, before)| *own <= before),
        "{nested:?}"
    );
    assert!(free.iter().zip([0, 9, 28, 67, 124, 218, 347, 499, 721]).all(|(own, before)| *own <= before), "{free:?}");
    for order in [0, 1, 11] {
        assert!(lobes::shared(order).is_none() && lobes::shared_free(order).is_none());
    }
}

/// Each set of the data file is what it says, by exact numbers, and none is there that another beats.
#[test]
fn the_data_is_what_it_says() {
    let all = lobes::records();
    for (mode, _) in Mode::ALL {
        for size in 2..=10 {
            let own: Vec<&Record> = all.iter().filter(|record| (record.mode, record.size) == (mode, size)).collect();
            assert!(!own.is_empty(), "{mode:?} {size}");
            for pair in own.windows(2) {
                assert!(pair[0].total() < pair[1].total() && pair[0].condition > pair[1].condition, "{mode:?} {size}");
            }
        }
    }
    std::thread::scope(|scope| {
        for part in all.chunks(all.len().div_ceil(4)) {
            scope.spawn(move || {
                for record in part {
                    assert_eq!(record.counted(), Ok((record.nonzeros.clone(), record.condition)), "{record:?}");
                }
            });
        }
    });
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
        assert_close(&values(&lobes::lobe_values(case.l, &lobes)), &case.Y, 1e-9);
        let a_hat = lobes::a_hat(case.l, &lobes).unwrap();
        assert_close(&values(&a_hat), &case.Ahat, 1e-9);
        assert_eq!(non_zeros(&a_hat), case.nnz, "{name}");
    }
}

/// What is no zero is far from one, and Â is the inverse of Y.
#[test]
fn zeros_are_told_from_small_numbers() {
    for order in 2..=10 {
        for set in [lobes::shared(order).unwrap(), lobes::shared_free(order).unwrap()] {
            for l in 0..order {
                let (y, a_hat) = (lobes::lobe_values(l, &set.lobes(l)), set.a_hat(l));
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
    let set = lobes::shared(6).unwrap();
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
    use zonal_codegen::math::tables::{basis_factor, legendre_polynomial};
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
