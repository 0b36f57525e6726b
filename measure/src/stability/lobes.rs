//! The condition of every lobe set that is kept, and the error that it makes of f32's rounding: a band is taken apart into
//! lobes and put together from their turned copies, in f32, with Â and the lobes' values rounded once.

use crate::numbers::Twin;
use crate::stability::truth::{Band, Rotation, Swap, distance};
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
// Names a family: its lobes are what is measured.
use zonal_codegen::families::zhf::lobes::{HIGHEST_SIZE, Lobe, Record, a_hat, chosen, records};
use zonal_codegen::ir::eval::Number;
use zonal_codegen::math::exact::Exact;
use zonal_codegen::promise::samples::{Random, matrix_of};

/// How many rotations and signals a set is tried on.
const TRIES: usize = 3;

/// A lobe set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Set {
    /// How its bands share directions.
    pub mode: String,
    /// The order, or the band.
    pub size: usize,
    /// Whether kernels use it.
    pub chosen: bool,
    /// The non-zeros of Â.
    pub nonzeros: usize,
    /// The largest condition number of a band's Y.
    pub condition: f64,
    /// The largest error in f32 of a band of norm one.
    pub error: f64,
}

struct Truth {
    bands: Vec<Band>,
    swaps: Vec<Swap>,
}

fn worst(record: &Record, truth: &Truth) -> f64 {
    let lobes: Vec<Lobe> = record.lobes.iter().map(|text| text.parse().expect("a set names directions")).collect();
    let directions: Vec<[f64; 3]> = lobes.iter().map(|lobe| lobe.xyz().map(|x| x.to_f64())).collect();
    let mut random = Random::new(0x10be);
    let mut worst = 0.0f64;
    for (l, members) in record.parts() {
        let own: Vec<Lobe> = members.iter().map(|&d| lobes[d].clone()).collect();
        let change = a_hat(l, &own).expect("a set that is kept is independent");
        let change: Vec<Vec<f32>> = change.iter().map(|row| row.iter().map(Exact::to_f32).collect()).collect();
        for _ in 0..TRIES {
            let q: [f64; 4] = random.unit();
            let values: Vec<f64> = (0..2 * l + 1).map(|_| random.signed()).collect();
            let size = values.iter().map(|x| x * x).sum::<f64>().sqrt();
            let c: Vec<f32> = values.iter().map(|x| (x / size) as f32).collect();
            let m = matrix_of(q);
            let mut out = vec![0.0f32; 2 * l + 1];
            for (d, member) in members.iter().enumerate() {
                let weight = change.iter().zip(&c).fold(0.0f32, |sum, (row, c)| sum + row[d] * c);
                let from = directions[*member];
                let turned = std::array::from_fn(|i| (0..3).map(|j| m[3 * j + i] * from[j]).sum::<f64>());
                for (out, y) in out.iter_mut().zip(truth.bands[l].values(turned)) {
                    *out += weight * y.to_f64() as f32;
                }
            }
            let signal: Vec<Twin> = c.iter().map(|x| Twin::from_f64(f64::from(*x))).collect();
            let want = Rotation::of_quaternion(q, l).apply(&truth.swaps[l], &signal);
            worst = worst.max(distance(&out, &want));
        }
    }
    worst
}

/// Every set.
pub fn measure(progress: &dyn Progress) -> Vec<Set> {
    let bands: Vec<usize> = (0..=HIGHEST_SIZE).collect();
    let truth = Truth {
        bands: bands.iter().map(|l| Band::new(*l)).collect(),
        swaps: bands.iter().map(|l| Swap::new(*l)).collect(),
    };
    each(progress, "conditions of lobe sets", records(), |record| Set {
        mode: record.mode.name().to_owned(),
        size: record.size,
        chosen: chosen(record.mode, record.size) == Some(record),
        nonzeros: record.total(),
        condition: record.condition,
        error: significant(worst(record, &truth)),
    })
}
