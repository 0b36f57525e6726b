//! Rows of any stride in batches: each channel is what it is alone, what lies between signals is not touched, and one rotation of
//! rows, which goes by the matrix, keeps the kernel's bound.

use super::{band_error, blocks, bound, of_the_parameter, on_every_unit, rows, turns, unit};
use glam::DQuat;
use zonal::batch::{self, Row, Signals, SignalsMut};
use zonal_codegen::promise::samples::Random;

#[test]
fn rows_are_touched_where_signals_lie_and_nowhere_else() {
    on_every_unit(|on| {
        for (name, row, stride, count) in [
            ("splats", Row::splat(16).at(6), 62, 16),
            ("splats of files", Row::splat(16), 48, 16),
            ("splats of degree 1", Row::splat(4).apart(3, 10), 25, 4),
            ("planar rows", Row::planar(9, 3).at(1), 31, 9),
            ("interleaved rows", Row::interleaved(25, 3), 80, 25),
        ] {
            for signals in [1, 16, 40] {
                let numbers: Vec<f32> = (0..signals * stride).map(|i| (i as f32).sin()).collect();
                let (quaternions, _) = turns::<4>(signals, 6);
                let mut turned = vec![7.0_f32; signals * stride];
                batch::rotate_each(
                    &quaternions,
                    Signals::rows(&numbers, stride, row).expect("fits"),
                    SignalsMut::rows(&mut turned, stride, row).expect("fits"),
                )
                .expect("sizes fit");
                let mut is_signal = vec![false; stride];
                for k in 0..signals {
                    for channel in 0..3 {
                        let at = |i: usize| k * stride + row.column(channel, i);
                        let alone = |of: &[f32]| (0..count).map(|i| of[at(i)]).collect::<Vec<f32>>();
                        let wanted: Vec<f32> = match count {
                            4 => turned_alone::<4>(quaternions[k], &alone(&numbers)),
                            9 => turned_alone::<9>(quaternions[k], &alone(&numbers)),
                            16 => turned_alone::<16>(quaternions[k], &alone(&numbers)),
                            _ => turned_alone::<25>(quaternions[k], &alone(&numbers)),
                        };
                        assert_eq!(alone(&turned), wanted, "{on}, {name}, signal {k}, channel {channel}");
                        (0..count).for_each(|i| is_signal[row.column(channel, i)] = true);
                    }
                    for (column, _) in is_signal.iter().enumerate().filter(|(_, is_signal)| !**is_signal) {
                        assert_eq!(turned[k * stride + column], 7.0, "{on}, {name}: column {column} is no signal's");
                    }
                }
            }
        }
    });
}

/// One rotation of rows of order 4 that lie side by side goes without lines, by the matrix: not the bits of blocks, but their bound.
#[test]
fn one_rotation_turns_rows_in_every_layout() {
    let most = bound("rotate:4") + of_the_parameter(4);
    on_every_unit(|on| {
        let q = turns::<16>(9, 12).0[8];
        for (name, row, stride) in [
            ("splats", Row::splat(16), 48),
            ("splats among others", Row::splat(16).at(6), 62),
            ("one channel", Row::planar(16, 1), 16),
            ("two channels", Row::planar(16, 2).at(3), 40),
            ("three channels", Row::planar(16, 3), 48),
            ("four channels", Row::planar(16, 4), 64),
            ("interleaved", Row::interleaved(16, 3), 48),
        ] {
            let channels = row.width().div_ceil(16).min(4).min(stride / 16);
            for count in [1, 16, 40, 300] {
                let mut random = Random::new(13);
                let mut numbers: Vec<f32> = (0..count * stride).map(|_| random.signed() as f32).collect();
                // A number that is none stays in its band.
                let spoilt = (count / 2) * stride + row.column(channels - 1, 6);
                numbers[spoilt] = f32::NAN;
                let turn = |to: &mut [f32]| {
                    let from = Signals::rows(&numbers, stride, row).expect("fits");
                    batch::rotate_all(q, from, SignalsMut::rows(to, stride, row).expect("fits")).expect("sizes fit");
                };
                let mut turned = vec![7.0_f32; count * stride];
                turn(&mut turned);
                let mut is_signal = vec![false; stride];
                for k in 0..count {
                    for channel in 0..channels {
                        let at = |i: usize| k * stride + row.column(channel, i);
                        let is_spoilt = k == count / 2 && channel == channels - 1;
                        let c: [f64; 16] = std::array::from_fn(|i| f64::from(numbers[at(i)]));
                        let whole = c.map(|x| if x.is_nan() { 0.0 } else { x });
                        let wanted = zonal::rotate(DQuat::from_array(unit(q)), &whole);
                        let mut found: [f32; 16] = std::array::from_fn(|i| turned[at(i)]);
                        if is_spoilt {
                            assert!(found[4..9].iter().any(|x| x.is_nan()), "{on}, {name}: NaN does not vanish");
                            (4..9).for_each(|i| found[i] = wanted[i] as f32);
                        }
                        let error = band_error(&found, &wanted, &whole);
                        assert!(error <= most, "{on}, {name}, signal {k}, channel {channel}: {error:e} above {most:e}");
                        (0..16).for_each(|i| is_signal[row.column(channel, i)] = true);
                    }
                    for (column, _) in is_signal.iter().enumerate().filter(|(_, is_signal)| !**is_signal) {
                        assert_eq!(turned[k * stride + column], 7.0, "{on}, {name}: column {column} is no signal's");
                    }
                }
                let bits = |of: &[f32]| of.iter().map(|x| x.to_bits()).collect::<Vec<u32>>();
                let mut streamed = vec![7.0_f32; count * stride];
                batch::stream_from(0);
                turn(&mut streamed);
                batch::stream_from(16 << 20);
                assert_eq!(bits(&streamed), bits(&turned), "{on}, {name}, {count} streamed");
                let mut in_place = numbers.clone();
                batch::rotate_all_in_place(q, SignalsMut::rows(&mut in_place, stride, row).expect("fits"))
                    .expect("sizes fit");
                for k in 0..count {
                    for channel in 0..channels {
                        for i in 0..16 {
                            let at = k * stride + row.column(channel, i);
                            assert_eq!(in_place[at].to_bits(), turned[at].to_bits(), "{on}, {name}, {count} in place");
                        }
                    }
                }
            }
        }
    });
}

/// One signal turned as a batch of one.
fn turned_alone<const N: usize>(q: [f32; 4], c: &[f32]) -> Vec<f32> {
    let mut turned = blocks(&[<[f32; N]>::try_from(c).expect("N numbers")]);
    batch::rotate_each_in_place(&blocks(&[q]), &mut turned).expect("sizes fit");
    rows(&turned, 1)[0].to_vec()
}
