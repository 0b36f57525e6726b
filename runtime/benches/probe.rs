//! What a probe costs: many signals evaluated, rotated and tilted, each in a direction of its own, at the orders 3, 4 and 6
//! and for one channel and three. Elements are signals.
//!
//! `cargo bench -p zonal --bench probe --features order6`

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{Quat, Vec3};
use zonal::Coefficients;

/// How many signals are worked on at once: of order 6 and three channels they are 432 KiB, which stay in a cache.
const COUNT: usize = 1024;

/// Evaluates, rotates and tilts copies of a signal.
fn group<C>(criterion: &mut Criterion, channels: &str, signal: C)
where
    C: Coefficients<Scalar = f32>,
{
    let signals = vec![signal; COUNT];
    let turns: Vec<Quat> =
        (0..COUNT).map(|i| Quat::from_rotation_z(0.1 * i as f32) * Quat::from_rotation_y(0.3 * i as f32)).collect();
    let directions: Vec<Vec3> = turns.iter().map(|turn| *turn * Vec3::Z).collect();
    // Normals of a normal map, which lean by 17 degrees at most.
    let normals: Vec<Vec3> =
        directions.iter().map(|dir| Vec3::new(0.3 * dir.x, 0.3 * dir.y, 1.0).normalize()).collect();

    let mut group = criterion.benchmark_group(format!("order {} {channels}", C::ORDER));
    group.throughput(Throughput::Elements(COUNT as u64));
    group.bench_function("evaluate", |bencher| {
        bencher.iter(|| {
            for (dir, signal) in directions.iter().zip(&signals) {
                black_box(zonal::evaluate(*dir, signal));
            }
        });
    });
    group.bench_function("rotate", |bencher| {
        bencher.iter(|| {
            for (turn, signal) in turns.iter().zip(&signals) {
                black_box(zonal::rotate(*turn, signal));
            }
        });
    });
    group.bench_function("tilt", |bencher| {
        bencher.iter(|| {
            for (normal, signal) in normals.iter().zip(&signals) {
                black_box(zonal::tilt(*normal, signal));
            }
        });
    });
    group.finish();
}

/// Three channels that differ.
fn rgb<const N: usize>(signal: [f32; N]) -> [Vec3; N] {
    signal.map(|c| Vec3::new(c, 0.5 * c, 0.25 * c))
}

fn probes(criterion: &mut Criterion) {
    let dir = Vec3::new(0.36, 0.48, 0.8);
    let (third, fourth): ([f32; 9], [f32; 16]) = (zonal::evaluate_basis(dir), zonal::evaluate_basis(dir));
    let sixth: [f32; 36] = zonal::evaluate_basis(dir);
    group(criterion, "scalar", third);
    group(criterion, "rgb", rgb(third));
    group(criterion, "scalar", fourth);
    group(criterion, "rgb", rgb(fourth));
    group(criterion, "scalar", sixth);
    group(criterion, "rgb", rgb(sixth));
}

criterion_group!(benches, probes);
criterion_main!(benches);
