//! The command `cargo measure-batches`: times every batch function beside a copy of the same bytes and prints the law's k.

use clap::Parser;
use zonal::batch::Unit;
use zonal_measure_batches::peak;
use zonal_measure_batches::time::{IN_CACHE, Rounds, Row_, STREAMING, measure};

/// Time every batch function beside a copy of the same bytes.
#[derive(Parser)]
#[command(name = "cargo measure-batches", version)]
struct Arguments {
    /// The orders.
    #[arg(long, value_delimiter = ',', default_value = "2,3,4,5,6,7,8,9,10")]
    orders: Vec<usize>,
    /// How many rounds.
    #[arg(long, default_value_t = 15)]
    rounds: usize,
    /// A function, a layout or both.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// The units.
    #[arg(long, value_delimiter = ',')]
    units: Vec<String>,
    /// The signals.
    #[arg(long, value_delimiter = ',', default_values_t = [IN_CACHE, STREAMING])]
    signals: Vec<usize>,
}

fn main() {
    let arguments = Arguments::parse();
    for unit in Unit::ALL.into_iter().rev().filter(|unit| unit.is_there()) {
        let peak = peak::multiplications(unit);
        println!("{unit}: {peak:.1} multiplications a nanosecond");
        if !arguments.units.is_empty() && !arguments.units.contains(&unit.to_string()) {
            continue;
        }
        for &signals in &arguments.signals {
            let rounds = Rounds { rounds: arguments.rounds, signals: 20_480 };
            for row in measure(unit, peak, &arguments.orders, signals, rounds, &arguments.only, || ()) {
                let Row_ { function, layout, order, nanoseconds, copy, multiplications, .. } = &row;
                println!(
                    "{unit} {signals:6} {function:12} {layout:8} {order:2}: {nanoseconds:7.2} ns, copy {copy:6.2}, floor {multiplications:6.2}, {:5.2} copies, k {:4.2}",
                    row.copies(), row.k()
                );
            }
        }
    }
}
