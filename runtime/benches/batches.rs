//! Each batch function at some orders and in each layout, beside a copy of the same bytes. Elements are signals.
//!
//! `cargo bench -p zonal --bench batches --features batch,all-orders`; `cargo measure-batches` times them in turn and writes what
//! `docs/BATCHES.md` says.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use zonal::Error;
use zonal::batch::{self, Block, Row, Signals, SignalsMut};

/// How many signals are worked on at once: 400 KiB at order 10.
const COUNT: usize = 1024;

fn run(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, mut work: impl FnMut() -> Result<(), Error>) {
    group.bench_function(name, |bencher| bencher.iter(|| black_box(work()).expect("sizes fit")));
}

/// Numbers between −1 and 1.
fn number(i: usize) -> f32 {
    ((i * 7919) % 2001) as f32 / 1000.0 - 1.0
}

fn order<const N: usize>(criterion: &mut Criterion) {
    let order = N.isqrt();
    let mut group = criterion.benchmark_group(format!("order {order}"));
    group.throughput(Throughput::Elements(COUNT as u64));
    let q = [0.36_f32, 0.48, 0.0, 0.8];
    let (quaternions, directions) = (vec![q; COUNT], vec![[0.36_f32, 0.48, 0.8]; COUNT]);
    let arrays: Vec<[f32; N]> = (0..COUNT).map(|k| std::array::from_fn(|i| number(k * N + i))).collect();
    let mut blocks = vec![Block::<f32, N>::zero(); COUNT / 16];
    batch::copy_each(&arrays, &mut blocks).expect("sizes fit");
    let (mut to_arrays, mut to_blocks, mut values) = (arrays.clone(), blocks.clone(), vec![0.0_f32; COUNT]);
    group.bench_function("a copy", |bencher| {
        bencher.iter(|| black_box(&mut to_blocks).copy_from_slice(black_box(&blocks)))
    });
    run(&mut group, "rotate_each, blocks", || batch::rotate_each(&quaternions, &blocks, &mut to_blocks));
    run(&mut group, "rotate_each, arrays", || batch::rotate_each(&quaternions, &arrays, &mut to_arrays));
    run(&mut group, "rotate_all, blocks", || batch::rotate_all(q, &blocks, &mut to_blocks));
    run(&mut group, "rotate_all, arrays", || batch::rotate_all(q, &arrays, &mut to_arrays));
    run(&mut group, "tilt_each, blocks", || batch::tilt_each(&directions, &blocks, &mut to_blocks));
    run(&mut group, "tilt_each, arrays", || batch::tilt_each(&directions, &arrays, &mut to_arrays));
    run(&mut group, "basis_each, blocks", || batch::basis_each(&directions, &mut to_blocks));
    run(&mut group, "basis_each, arrays", || batch::basis_each(&directions, &mut to_arrays));
    run(&mut group, "eval_each, blocks", || batch::eval_each(&directions, &blocks, &mut values));
    run(&mut group, "eval_each, arrays", || batch::eval_each(&directions, &arrays, &mut values));
    if order <= 6 {
        run(&mut group, "product_each, blocks", || batch::product_each(&blocks, &blocks, &mut to_blocks));
        run(&mut group, "product_each, arrays", || batch::product_each(&arrays, &arrays, &mut to_arrays));
    }
    let rgb: Vec<[[f32; 3]; N]> = arrays.iter().map(|c| c.map(|x| [x, 0.5 * x, -x])).collect();
    let mut to_rgb = rgb.clone();
    run(&mut group, "rotate_each, interleaved RGB", || batch::rotate_each(&quaternions, &rgb, &mut to_rgb));
    let planes = [&blocks[..]; 3];
    let mut of_planes = [blocks.clone(), blocks.clone(), blocks.clone()];
    run(&mut group, "rotate_each, RGB in three slices of blocks", || {
        let [red, green, blue] = &mut of_planes;
        batch::rotate_each(&quaternions, planes, [red.as_mut_slice(), green.as_mut_slice(), blue.as_mut_slice()])
    });
    if order <= 4 {
        let row = Row::splat(N);
        let stride = 3 * N;
        let splats: Vec<f32> = (0..COUNT * stride).map(number).collect();
        let mut to = splats.clone();
        run(&mut group, "rotate_each, splats", || {
            batch::rotate_each(
                &quaternions,
                Signals::rows(&splats, stride, row)?,
                SignalsMut::rows(&mut to, stride, row)?,
            )
        });
        run(&mut group, "rotate_all, splats", || {
            batch::rotate_all(q, Signals::rows(&splats, stride, row)?, SignalsMut::rows(&mut to, stride, row)?)
        });
    }
    group.finish();
}

fn batches(criterion: &mut Criterion) {
    order::<9>(criterion);
    order::<16>(criterion);
    order::<25>(criterion);
    order::<36>(criterion);
    order::<64>(criterion);
    order::<100>(criterion);
}

criterion_group!(benches, batches);
criterion_main!(benches);
