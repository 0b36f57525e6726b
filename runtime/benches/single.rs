//! What a single call takes beside a copy of the same bytes: every row of `calls`, over 1024 signals, which stay in a
//! cache. Elements are signals. `into` beside `call` says what returning the result by value takes, `loop` what the
//! compiler makes of a plain loop; with `RUSTFLAGS="-C target-cpu=native"` multiply-adds are fused.
//!
//! `cargo bench -p zonal --bench single --features all-orders`

mod calls;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

const COUNT: usize = 1024;

fn single(criterion: &mut Criterion) {
    let inputs = calls::Inputs::new(COUNT);
    for row in calls::rows() {
        let mut work = (row.make)(&inputs);
        let mut group = criterion.benchmark_group(format!("order {}", row.order));
        group.throughput(Throughput::Elements(COUNT as u64));
        group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
        group.bench_function(format!("{} {}", row.function, row.form).trim_end(), |bencher| {
            bencher.iter(|| {
                work.run();
                black_box(work.written());
            });
        });
        group.finish();
    }
}

criterion_group!(benches, single);
criterion_main!(benches);
