//! Batches: on every vector unit that the processor has and in every layout, what a kernel of f64 computes one signal at a
//! time, within the kernel's own bound; the same bits in every layout; nothing touched that is not a result, and nothing at all
//! where sizes do not fit.

mod channels;
mod strided;

use super::{narrow, quaternion, signal, wide};
use glam::DQuat;
use half::f16;
use std::sync::{Mutex, MutexGuard, PoisonError};
use zonal::batch::{self, Block, Row, Signals, Unit};
use zonal::{Coefficients, Error};
use zonal_codegen::promise::samples::Random;
use zonal_tests::norm;

/// Which unit is used is one for the whole program.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does something with each unit that the processor has; says which it lacks.
fn on_every_unit(mut check: impl FnMut(Unit)) {
    let _alone = alone();
    for unit in Unit::ALL {
        match unit.is_there() {
            true => {
                unit.at_most();
                assert_eq!(Unit::used(), unit);
                check(unit);
            }
            false => eprintln!("this processor has no {unit}: its batches are not run here"),
        }
    }
    Unit::Avx512.at_most();
}

/// The bound on rounding that the checked-in list has for a kernel.
fn bound(spec: &str) -> f64 {
    let manifest = include_str!("../../../../generated/MANIFEST.tsv");
    let line = manifest.lines().find(|line| line.split('\t').next() == Some(spec));
    let cell = line.and_then(|line| line.split('\t').nth(10)).unwrap_or_else(|| panic!("{spec} is in the catalogue"));
    cell.parse().expect("a bound is a number")
}

/// The largest difference in a band, by the band's norm.
fn band_error<const N: usize>(found: &[f32], wanted: &[f64; N], of: &[f64; N]) -> f64 {
    let band = |l: usize| l * l..(l + 1) * (l + 1);
    let error = |l: usize| {
        let difference: Vec<f64> = band(l).map(|i| f64::from(found[i]) - wanted[i]).collect();
        norm(&difference) / norm(&of[band(l)])
    };
    (0..N.isqrt()).map(error).fold(0.0, f64::max)
}

fn blocks<const N: usize>(rows: &[[f32; N]]) -> Vec<Block<f32, N>> {
    let mut blocks = vec![Block::zero(); Block::<f32, N>::count(rows.len())];
    for (k, row) in rows.iter().enumerate() {
        row.iter().enumerate().for_each(|(i, x)| blocks[k / 16].0[i][k % 16] = *x);
    }
    blocks
}

fn rows<const N: usize>(blocks: &[Block<f32, N>], count: usize) -> Vec<[f32; N]> {
    (0..count).map(|k| std::array::from_fn(|i| blocks[k / 16].0[i][k % 16])).collect()
}

/// Signals with their quaternions, f32 as batches get them.
fn turns<const N: usize>(count: usize, seed: u64) -> (Vec<[f32; 4]>, Vec<[f32; N]>) {
    let mut random = Random::new(seed);
    (0..count)
        .map(|k| {
            let q = match k {
                // The poles, half turns and no turn.
                0 => [0.0, 0.0, 0.0, 1.0],
                1 => [1.0, 0.0, 0.0, 0.0],
                2 => [0.0, 0.0, 1.0, 0.0],
                3 => [0.0, 1.0, 0.0, 0.0],
                4 => [1e-4, 0.0, 0.0, 1.0],
                _ => quaternion(&mut random).to_array(),
            };
            (q.map(|x| x as f32), narrow(&signal::<N>(&mut random)))
        })
        .unzip()
}

/// A unit vector of f64 near to one of f32: what a bound presumes of its parameters.
fn unit<const N: usize>(v: [f32; N]) -> [f64; N] {
    let v = v.map(f64::from);
    let length = norm(&v);
    v.map(|x| x / length)
}

/// What a parameter that is unit to f32 alone moves besides: band l by 5 l for a length of 1 + e, e below 1.2e-7, and by as much
/// for its direction (crate documentation, *Input that is not unit*).
fn of_the_parameter(order: usize) -> f64 {
    10.0 * order as f64 * 1.2e-7
}

#[test]
fn rotations_keep_the_kernels_bound_on_every_unit() {
    on_every_unit(|on| {
        every_order!(N, {
            let order = N.isqrt();
            let (quaternions, signals) = turns::<N>(37, 1);
            let mut turned = vec![[0.0; N]; 37];
            batch::rotate_each(&quaternions, &signals, &mut turned).expect("sizes fit");
            let most = bound(&format!("rotate:{order}")) + of_the_parameter(order);
            for ((q, c), found) in quaternions.iter().zip(&signals).zip(&turned) {
                let c = c.map(f64::from);
                let wanted = zonal::rotate(DQuat::from_array(unit(*q)), &c);
                let error = band_error(found, &wanted, &c);
                assert!(error <= most, "{on}, order {order}, {q:?}: {error:e} above {most:e}");
            }
            let all = if order < 4 { format!("rotate:{order}:zyz") } else { format!("rotate:{order}") };
            let most = bound(&all) + of_the_parameter(order);
            for q in &quaternions[5..8] {
                batch::rotate_all(*q, &signals, &mut turned).expect("sizes fit");
                for (c, found) in signals.iter().zip(&turned) {
                    let c = c.map(f64::from);
                    let error = band_error(found, &zonal::rotate(DQuat::from_array(unit(*q)), &c), &c);
                    assert!(error <= most, "{on}, all of order {order}, {q:?}: {error:e} above {most:e}");
                }
            }
        });
    });
}

#[test]
fn tilts_keep_the_kernels_bound_on_every_unit() {
    on_every_unit(|on| {
        every_order!(N, {
            let order = N.isqrt();
            let (_, signals) = turns::<N>(19, 2);
            let normals: Vec<[f32; 3]> = (0..19)
                .map(|k| {
                    // Up to the 25 degrees for which the kernel is bounded.
                    let (lean, round) = ((k as f64 * 25.0 / 18.0).to_radians(), k as f64);
                    [lean.sin() * round.cos(), lean.sin() * round.sin(), lean.cos()].map(|x| x as f32)
                })
                .collect();
            let mut tilted = signals.clone();
            batch::tilt_each_in_place(&normals, &mut tilted).expect("sizes fit");
            let most = bound(&format!("tilt:{order}")) + of_the_parameter(order);
            for ((n, c), found) in normals.iter().zip(&signals).zip(&tilted) {
                let c = c.map(f64::from);
                let error = band_error(found, &zonal::tilt(unit(*n), &c), &c);
                assert!(error <= most, "{on}, order {order}, {n:?}: {error:e} above {most:e}");
            }
        });
    });
}

#[test]
fn the_basis_and_values_keep_the_kernels_bounds_on_every_unit() {
    on_every_unit(|on| {
        every_order!(N, {
            let order = N.isqrt();
            let mut random = Random::new(3);
            let mut directions: Vec<[f32; 3]> = (0..33).map(|_| random.unit().map(|x| x as f32)).collect();
            // The poles and the horizon.
            directions[..4].copy_from_slice(&[[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
            let signals: Vec<[f32; N]> = (0..33).map(|_| narrow(&signal(&mut random))).collect();
            let (mut basis, mut values, mut all) = (vec![[0.0_f32; N]; 33], vec![0.0_f32; 33], vec![0.0_f32; 33]);
            batch::basis_each(&directions, &mut basis).expect("sizes fit");
            batch::eval_each(&directions, &signals, &mut values).expect("sizes fit");
            batch::eval_all(&directions, &signals[7], &mut all).expect("sizes fit");
            // A direction that is unit to f32 alone moves band l by l² times that.
            let of_the_direction = (order * order) as f64 * 1.2e-7;
            for (k, direction) in directions.iter().enumerate() {
                let wanted = zonal::evaluate_basis::<[f64; N]>(unit(*direction));
                let most = bound(&format!("basis:{order}")) + of_the_direction;
                let worst = wanted.iter().zip(basis[k]).map(|(w, f)| (w - f64::from(f)).abs()).fold(0.0, f64::max);
                assert!(worst <= most, "{on}, basis of order {order}, {direction:?}: {worst:e} above {most:e}");
                for (c, found) in [(&signals[k], values[k]), (&signals[7], all[k])] {
                    let wanted: f64 = wanted.iter().zip(c).map(|(y, c)| y * f64::from(*c)).sum();
                    // Each band of the signal is of norm one.
                    let most = bound(&format!("eval:{order}")) + of_the_direction * order as f64;
                    let error = (wanted - f64::from(found)).abs();
                    assert!(error <= most, "{on}, value of order {order}, {direction:?}: {error:e} above {most:e}");
                }
            }
        });
    });
}

#[test]
fn products_are_those_of_one_signal_at_a_time() {
    on_every_unit(|on| {
        macro_rules! product {
            ($($order:literal $module:ident $count:literal),*) => { $({
                let mut random = Random::new(4);
                let [a, b] = [0, 1].map(|_| (0..21).map(|_| narrow(&signal::<$count>(&mut random))).collect::<Vec<_>>());
                let mut product = vec![[0.0_f32; $count]; 21];
                batch::product_each(&a, &b, &mut product).expect("sizes fit");
                for ((a, b), found) in a.iter().zip(&b).zip(&product) {
                    let [a, b] = [a, b].map(|c| c.map(f64::from));
                    let wanted = zonal::$module::product(&a, &b);
                    let difference: Vec<f64> = wanted.iter().zip(found).map(|(w, f)| w - f64::from(*f)).collect();
                    let most = bound(concat!("product:", $order)) * norm(&a) * norm(&b);
                    assert!(norm(&difference) <= most, "{on}, order {}: {:e} above {most:e}", $order, norm(&difference));
                }
            })* };
        }
        product!(2 sh2 4, 3 sh3 9, 4 sh4 16, 5 sh5 25, 6 sh6 36);
    });
}

/// Rotations of f32 in every layout: the bits are those of blocks.
fn layouts<const N: usize>(on: Unit) {
    let order = N.isqrt();
    // Rows go through in groups of up to eight blocks: one group, two and three.
    for count in [1, 15, 16, 17, 150, 300] {
        let (quaternions, signals) = turns::<N>(count, 5);
        let of_blocks = |signals: &[[f32; N]]| {
            let mut turned = blocks(signals);
            batch::rotate_each_in_place(&blocks(&quaternions), &mut turned).expect("sizes fit");
            rows(&turned, count)
        };
        let wanted = of_blocks(&signals);
        let mut turned = vec![[0.0; N]; count];
        batch::rotate_each(&quaternions, &signals, &mut turned).expect("sizes fit");
        assert_eq!(turned, wanted, "{on}, {count} arrays of order {order}");
        let mut into = vec![Block::zero(); Block::<f32, N>::count(count)];
        batch::rotate_each(&quaternions, &signals, &mut into).expect("sizes fit");
        assert_eq!(rows(&into, count), wanted, "{on}, {count} arrays to blocks, order {order}");
        let mut in_place = signals.clone();
        batch::rotate_each_in_place(&quaternions, &mut in_place).expect("sizes fit");
        assert_eq!(in_place, wanted, "{on}, {count} arrays in place, order {order}");
        // Past the caches.
        batch::stream_from(0);
        let mut streamed = vec![Block::zero(); Block::<f32, N>::count(count)];
        batch::rotate_each(&quaternions, &blocks(&signals), &mut streamed).expect("sizes fit");
        turned.fill([0.0; N]);
        batch::rotate_each(&quaternions, &signals, &mut turned).expect("sizes fit");
        batch::stream_from(16 << 20);
        assert_eq!(rows(&streamed, count), wanted, "{on}, {count} streamed blocks of order {order}");
        assert_eq!(turned, wanted, "{on}, {count} streamed arrays of order {order}");
        // Three channels: each is what it is alone.
        let halves: Vec<[f32; N]> = signals.iter().map(|c| c.map(|x| 0.5 * x)).collect();
        let negative: Vec<[f32; N]> = signals.iter().map(|c| c.map(|x| -x)).collect();
        let all = [of_blocks(&signals), of_blocks(&halves), of_blocks(&negative)];
        let rgb: Vec<[[f32; 3]; N]> =
            (0..count).map(|k| std::array::from_fn(|i| [signals[k][i], halves[k][i], negative[k][i]])).collect();
        let mut turned = rgb.clone();
        batch::rotate_each_in_place(&quaternions, &mut turned).expect("sizes fit");
        for (channel, wanted) in all.iter().enumerate() {
            let found: Vec<[f32; N]> = turned.iter().map(|c| c.map(|c| c[channel])).collect();
            assert_eq!(&found, wanted, "{on}, {count} of interleaved RGB, order {order}");
        }
        let mut planes = [signals.clone(), halves.clone(), negative.clone()];
        let [red, green, blue] = &mut planes;
        let slices = [red.as_mut_slice(), green.as_mut_slice(), blue.as_mut_slice()];
        batch::rotate_each_in_place(&quaternions, slices).expect("sizes fit");
        assert_eq!(planes, all, "{on}, {count} of planar RGB, order {order}");
        let of_all = [&signals, &halves, &negative].map(|c| blocks(c));
        let mut together: Vec<[Block<f32, N>; 3]> =
            (0..of_all[0].len()).map(|k| [0, 1, 2].map(|channel| of_all[channel][k])).collect();
        batch::rotate_each_in_place(&quaternions, &mut together).expect("sizes fit");
        let mut apart = of_all.clone();
        let [red, green, blue] = &mut apart;
        let slices = [red.as_mut_slice(), green.as_mut_slice(), blue.as_mut_slice()];
        batch::rotate_each_in_place(&quaternions, slices).expect("sizes fit");
        for (channel, wanted) in all.iter().enumerate() {
            let found: Vec<Block<f32, N>> = together.iter().map(|blocks| blocks[channel]).collect();
            assert_eq!(&rows(&found, count), wanted, "{on}, {count} in blocks of three channels, order {order}");
            assert_eq!(&rows(&apart[channel], count), wanted, "{on}, {count} in three slices of blocks, order {order}");
        }
    }
}

#[test]
fn every_layout_gives_the_same_bits() {
    on_every_unit(|on| {
        layouts::<4>(on);
        layouts::<9>(on);
        layouts::<16>(on);
        layouts::<25>(on);
        layouts::<100>(on);
    });
}

#[test]
fn doubles_and_halves() {
    on_every_unit(|on| {
        let (quaternions, signals) = turns::<36>(21, 7);
        let wide_signals: Vec<[f64; 36]> = signals.iter().map(|c| c.map(f64::from)).collect();
        let wide_quaternions: Vec<[f64; 4]> = quaternions.iter().map(|q| unit(*q)).collect();
        let mut turned = wide_signals.clone();
        batch::rotate_each_in_place(&wide_quaternions, &mut turned).expect("sizes fit");
        for ((q, c), found) in wide_quaternions.iter().zip(&wide_signals).zip(&turned) {
            let wanted = zonal::rotate(*q, c);
            // The bound on f32, 2⁻²⁹ times.
            let worst = wanted.iter().zip(found).map(|(w, f)| (w - f).abs()).fold(0.0, f64::max);
            assert!(worst <= 2.0 * bound("rotate:6") / f64::from(1 << 29), "{on}: {worst:e}");
        }
        let halves: Vec<[f16; 36]> = signals.iter().map(|c| c.map(f16::from_f32)).collect();
        let mut through = vec![[0.0_f32; 36]; 21];
        batch::copy_each(&halves, &mut through).expect("sizes fit");
        assert_eq!(through, halves.iter().map(|c| c.map(f16::to_f32)).collect::<Vec<_>>());
        batch::rotate_each_in_place(&quaternions, &mut through).expect("sizes fit");
        let wanted: Vec<[f16; 36]> = through.iter().map(|c| c.map(f16::from_f32)).collect();
        let mut turned = halves.clone();
        batch::rotate_each_in_place(&quaternions, &mut turned).expect("sizes fit");
        assert_eq!(turned, wanted, "{on}: f16 is worked on as f32 and rounded once");
        let mut of_halves = vec![Block::<f16, 36>::zero(); 2];
        batch::rotate_each(&quaternions, &halves, &mut of_halves).expect("sizes fit");
        assert_eq!(of_halves[1].0[7][4], wanted[20][7], "{on}: blocks of f16");
    });
}

#[test]
fn threads_give_the_same_bits() {
    let _alone = alone();
    let (quaternions, signals) = turns::<25>(3000, 8);
    let (mut here, mut there) = (signals.clone(), signals.clone());
    batch::rotate_each_in_place(&quaternions, &mut here).expect("sizes fit");
    batch::parallel::rotate_each_in_place(&quaternions, &mut there).expect("sizes fit");
    assert_eq!(here, there);
    assert!(batch::parallel::rotate_each_in_place(&quaternions[1..], &mut there).is_err());
}

#[test]
fn a_number_that_is_none_stays_in_its_lane_and_band() {
    on_every_unit(|on| {
        let (quaternions, mut signals) = turns::<25>(32, 9);
        let mut wanted = signals.clone();
        batch::rotate_each_in_place(&quaternions, &mut wanted).expect("sizes fit");
        signals[9][5] = f32::NAN;
        signals[20][1] = f32::INFINITY;
        let mut turned = signals.clone();
        batch::rotate_each_in_place(&quaternions, &mut turned).expect("sizes fit");
        for k in 0..32 {
            for i in 0..25 {
                let is_spoilt = k == 9 && (4..9).contains(&i) || k == 20 && (1..4).contains(&i);
                match is_spoilt {
                    true => {}
                    false => assert_eq!(turned[k][i], wanted[k][i], "{on}: signal {k}, coefficient {i}"),
                }
            }
        }
        assert!(turned[9][4..9].iter().any(|x| x.is_nan()), "{on}: NaN does not vanish");
        // What is huge or denormal is no worse for it.
        for scale in [1e30_f32, 1e-42] {
            let mut scaled: Vec<[f32; 25]> = wanted.iter().map(|c| c.map(|x| x * scale)).collect();
            batch::rotate_all_in_place([0.0, 0.0, 0.0, 1.0], &mut scaled).expect("sizes fit");
            for (found, c) in scaled.iter().zip(&wanted) {
                for (found, x) in found.iter().zip(c) {
                    let most = f64::from(scale) * 2.0 * bound("rotate:5") + 60.0 * f64::from(f32::from_bits(1));
                    assert!((f64::from(*found) - f64::from(x * scale)).abs() <= most, "{on}, times {scale:e}");
                }
            }
        }
    });
}

#[test]
fn sizes_that_do_not_fit_touch_nothing() {
    let _alone = alone();
    let (quaternions, signals) = turns::<9>(20, 10);
    let untouched = vec![[3.0_f32; 9]; 20];
    let mut results = untouched.clone();
    let refused = |result: Result<(), Error>, results: &Vec<[f32; 9]>, why: &str| {
        let error = result.expect_err(why).to_string();
        assert!(error.contains(why), "{error}");
        assert_eq!(results, &untouched, "{why}");
    };
    refused(
        batch::rotate_each(&quaternions[1..], &signals, &mut results),
        &results.clone(),
        "19 signals or parameters, but 20",
    );
    refused(
        batch::rotate_each(&quaternions, &signals[..19], &mut results),
        &results.clone(),
        "19 signals or parameters",
    );
    let normals = vec![[0.0_f32, 0.0, 1.0]; 20];
    refused(
        batch::rotate_each(&normals, &signals, &mut results),
        &results.clone(),
        "3 numbers each, but the kernel takes 4",
    );
    refused(
        batch::tilt_each(&quaternions, &signals, &mut results),
        &results.clone(),
        "4 numbers each, but the kernel takes 3",
    );
    let higher = vec![[0.0_f32; 16]; 20];
    refused(batch::rotate_each(&quaternions, &higher, &mut results), &results.clone(), "9 numbers in 1 channels");
    let odd = vec![[0.0_f32; 7]; 20];
    let mut more = odd.clone();
    let error = batch::rotate_each(&quaternions, &odd, &mut more).expect_err("no order");
    assert!(error.to_string().contains("7 coefficients are no order"), "{error}");
    let ninth = vec![[0.0_f32; 81]; 20];
    let error = batch::product_each(&ninth, &ninth, &mut ninth.clone()).expect_err("no product of order 9");
    assert!(error.to_string().contains("of products 2 to 6"), "{error}");
    let planes = [&signals[..], &signals[..19], &signals[..]];
    let mut rgb = vec![[[0.0_f32; 3]; 9]; 19];
    let error = batch::rotate_each(&quaternions[..19], planes, &mut rgb).expect_err("slices of two lengths");
    assert!(error.to_string().contains("not of one length"), "{error}");
    let numbers = vec![0.0_f32; 100];
    for (result, why) in [
        (
            Signals::rows(&numbers, 40, Row::splat(16)).map(|_| ()),
            "a row of 40 numbers, but its signal reaches over 48",
        ),
        (Signals::rows(&numbers, 48, Row::splat(16)).map(|_| ()), "4 are left over"),
        (Signals::rows(&numbers, 50, Row::interleaved(10, 5)).map(|_| ()), "1 to 100 in 1 to 4"),
    ] {
        let error = result.expect_err(why).to_string();
        assert!(error.contains(why), "{error}");
    }
    // Nothing is nothing to do.
    batch::rotate_each(&quaternions[..0], &signals[..0], &mut results[..0]).expect("none of each");
}

#[test]
fn what_is_done_to_one_signal_is_done_to_many() {
    let _alone = alone();
    let mut random = Random::new(11);
    let signals: Vec<[[f32; 3]; 16]> =
        (0..35).map(|_| <[[f32; 3]; 16]>::from_fn(|_| random.unit::<3>().map(|x| x as f32))).collect();
    let unity = zonal::conventions::ALL.iter().find(|convention| convention.name == "unity").expect("Unity is known");
    let mut converted = vec![[[0.0_f32; 3]; 9]; 35];
    batch::map_each(&signals, &mut converted, |c: &[[f32; 16]; 16]| {
        zonal::to_convention(&zonal::resize::<_, [[f32; 16]; 9]>(c), unity).expect("nine coefficients fit")
    })
    .expect("sizes fit");
    for (c, found) in signals.iter().zip(&converted) {
        let wanted = zonal::to_convention(&zonal::resize::<_, [[f32; 3]; 9]>(c), unity).expect("nine fit");
        assert_eq!(found, &wanted);
    }
    let values = wide(&converted[0][0]);
    assert_eq!(values.len(), 3);
}
