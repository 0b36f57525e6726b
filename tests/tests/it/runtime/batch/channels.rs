//! Bases, values and products in batches of several channels and in blocks: each channel has the bits that it has alone, in
//! arrays, which the bounds are tested on.

use super::{blocks, on_every_unit, rows, turns};
use zonal::Coefficients;
use zonal::batch::{self, Block, Unit};
use zonal_codegen::promise::samples::Random;

/// Three channels of signals, made of one.
fn channels<const N: usize>(signals: &[[f32; N]]) -> [Vec<[f32; N]>; 3] {
    [1.0_f32, 0.5, -1.25].map(|factor| signals.iter().map(|c| c.map(|x| factor * x)).collect())
}

/// The same side by side.
fn interleaved<const N: usize>(channels: &[Vec<[f32; N]>; 3]) -> Vec<[[f32; 3]; N]> {
    (0..channels[0].len()).map(|k| std::array::from_fn(|i| [0, 1, 2].map(|channel| channels[channel][k][i]))).collect()
}

fn values<const N: usize>(on: Unit, count: usize)
where
    [f32; N]: Coefficients<Scalar = f32, Element = f32>,
    [[f32; 3]; N]: Coefficients<Scalar = f32, Element = [f32; 3]>,
{
    let order = N.isqrt();
    let mut random = Random::new(11);
    let directions: Vec<[f32; 3]> = (0..count).map(|_| random.unit().map(|x| x as f32)).collect();
    let of = channels(&turns::<N>(count, 12).1);
    let alone = [0, 1, 2].map(|channel| {
        let mut values = vec![0.0_f32; count];
        batch::eval_each(&directions, &of[channel], &mut values).expect("sizes fit");
        values
    });
    let together: Vec<[f32; 3]> = (0..count).map(|k| [0, 1, 2].map(|channel| alone[channel][k])).collect();

    let mut found = vec![[0.0_f32; 3]; count];
    batch::eval_each(&directions, &interleaved(&of), &mut found).expect("sizes fit");
    assert_eq!(found, together, "{on}: {count} values of interleaved RGB, order {order}");

    let of_blocks = [0, 1, 2].map(|channel| blocks(&of[channel]));
    let mut apart = [0, 1, 2].map(|_| vec![Block::<f32, 1>::zero(); of_blocks[0].len()]);
    batch::eval_each(&blocks(&directions), &of_blocks[0], &mut apart[0]).expect("sizes fit");
    assert_eq!(rows(&apart[0], count).concat(), alone[0], "{on}: {count} values of blocks, order {order}");
    let [red, green, blue] = &mut apart;
    let [r, g, b] = &of_blocks;
    let slices = [red.as_mut_slice(), green.as_mut_slice(), blue.as_mut_slice()];
    batch::eval_each(&blocks(&directions), [r.as_slice(), g.as_slice(), b.as_slice()], slices).expect("sizes fit");
    for (channel, values) in apart.iter().enumerate() {
        assert_eq!(rows(values, count).concat(), alone[channel], "{on}: {count} values of planes, order {order}");
    }

    // One signal in every direction: what each channel has alone.
    let light: [[f32; 3]; N] = std::array::from_fn(|i| [0, 1, 2].map(|channel| of[channel][0][i]));
    batch::eval_all(&directions, &light, &mut found).expect("sizes fit");
    for (channel, signals) in of.iter().enumerate() {
        let mut values = vec![0.0_f32; count];
        batch::eval_all(&directions, &signals[0], &mut values).expect("sizes fit");
        let found: Vec<f32> = found.iter().map(|rgb| rgb[channel]).collect();
        assert_eq!(found, values, "{on}: {count} values of one light, order {order}");
    }

    // Bases: arrays, blocks, blocks past the caches.
    let mut of_arrays = vec![[0.0_f32; N]; count];
    batch::basis_each(&directions, &mut of_arrays).expect("sizes fit");
    for from in [16 << 20, 0] {
        batch::stream_from(from);
        let mut of_blocks = vec![Block::<f32, N>::zero(); Block::<f32, N>::count(count)];
        batch::basis_each(&blocks(&directions), &mut of_blocks).expect("sizes fit");
        batch::stream_from(16 << 20);
        assert_eq!(
            rows(&of_blocks, count),
            of_arrays,
            "{on}: {count} bases of blocks, order {order}, streamed from {from}"
        );
    }
}

#[test]
fn each_channel_has_the_values_that_it_has_alone() {
    on_every_unit(|on| {
        // One block, some groups of eight, and more than a core's own cache holds.
        for count in [1, 16, 17, 300] {
            values::<4>(on, count);
            values::<9>(on, count);
            values::<25>(on, count);
            values::<100>(on, count);
        }
        values::<64>(on, 5000);
    });
}

#[test]
fn each_channel_has_the_product_that_it_has_alone() {
    on_every_unit(|on| {
        let of = channels(&turns::<16>(100, 13).1);
        let other = channels(&turns::<16>(100, 14).1);
        let mut together = vec![[[0.0_f32; 3]; 16]; 100];
        batch::product_each(&interleaved(&of), &interleaved(&other), &mut together).expect("sizes fit");
        for channel in 0..3 {
            let mut alone = vec![[0.0_f32; 16]; 100];
            batch::product_each(&of[channel], &other[channel], &mut alone).expect("sizes fit");
            let found: Vec<[f32; 16]> = together.iter().map(|c| c.map(|rgb| rgb[channel])).collect();
            assert_eq!(found, alone, "{on}: channel {channel}");
            let mut of_blocks = vec![Block::<f32, 16>::zero(); 7];
            batch::product_each(&blocks(&of[channel]), &blocks(&other[channel]), &mut of_blocks).expect("sizes fit");
            assert_eq!(rows(&of_blocks, 100), alone, "{on}: channel {channel} of blocks");
        }
    });
}
