//! A hundred thousand rotations in a row: what becomes of a signal's norm, which no rotation changes.

use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::families::SmallAngle;
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::kernel::Shape;
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::promise::samples::{Random, matrix_of};

/// After how many rotations the norm is noted.
pub const STEPS: [usize; 5] = [10, 100, 1_000, 10_000, 100_000];
/// (cos, sin) of the angle of rotations about y: 4.58 degrees, a rational point of the circle.
pub const TURN: [f64; 2] = [312.0 / 313.0, 25.0 / 313.0];

/// The drift of one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// The spec.
    pub spec: String,
    /// The number type.
    pub number: String,
    /// After each of [`STEPS`] how far the norm of a band lies from one, the largest of all bands; none if it is no finite
    /// number.
    pub norms: [Option<f64>; 5],
}

impl Drift {
    /// Whether every rotation was by another random one, or all about y by the same angle.
    pub fn is_random(&self) -> bool {
        self.spec.starts_with("rotate:") || self.spec.starts_with("zhf")
    }
}

/// The exact rotations, then those about y.
pub fn specs() -> Vec<Spec> {
    let exact = ["rotate:4", "rotate:4:zxzxz", "rotate:3", "rotate:3:matrix", "zhf:4", "rotate_y:4"];
    let exact = exact.into_iter().map(str::to_owned);
    let small = SmallAngle::APPROXIMATE.into_iter().map(|method| format!("{}:4", method.name()));
    exact.chain(small).map(|text| text.parse().expect("names a kernel")).collect()
}

fn drift<T: Number>(spec: &Spec, number: &str) -> Drift {
    let program = Program::<T>::new(&Listing::new(&spec.kernel()));
    let order = spec.order;
    let shape = program.listing().params[0].shape;
    let mut random = Random::new(0xd21f);
    let mut c: Vec<T> = Vec::new();
    for l in 0..order {
        let values: Vec<f64> = (0..2 * l + 1).map(|_| random.signed()).collect();
        let size = values.iter().map(|x| x * x).sum::<f64>().sqrt();
        c.extend(values.into_iter().map(|x| T::from_f64(x / size)));
    }
    let norms = |c: &[T]| -> Vec<f64> {
        let of = |l: usize| c[l * l..(l + 1) * (l + 1)].iter().map(|x| x.to_f64() * x.to_f64()).sum::<f64>().sqrt();
        (0..order).map(of).collect()
    };
    let first = norms(&c);
    let [cos, sin] = TURN;
    // The angle by its series: the same on every machine.
    let t = sin / (1.0 + cos);
    let square = t * t;
    let angle = 2.0 * t * (1.0 - square * (1.0 / 3.0 - square * (1.0 / 5.0 - square / 7.0)));
    let mut noted = [None; 5];
    for step in 1..=STEPS[4] {
        let input: Vec<f64> = match shape {
            Shape::Vec4 => random.unit::<4>().to_vec(),
            Shape::Mat3 => matrix_of(random.unit()).to_vec(),
            Shape::Pair => vec![cos, sin],
            _ => vec![angle],
        };
        let input: Vec<T> = input.into_iter().map(T::from_f64).collect();
        c = program.run(&[&input, &c], Contraction::Separate);
        if let Some(place) = STEPS.iter().position(|noted| *noted == step) {
            let now = norms(&c);
            let drift = now.iter().zip(&first).map(|(now, then)| (now / then - 1.0).abs());
            let drift = drift.fold(0.0, |worst: f64, x| if x.is_nan() { f64::INFINITY } else { worst.max(x) });
            noted[place] = drift.is_finite().then(|| significant(drift));
        }
    }
    Drift { spec: spec.to_string(), number: number.to_owned(), norms: noted }
}

/// Every method in f32 and in f64.
pub fn measure(progress: &dyn Progress) -> Vec<Drift> {
    let tasks: Vec<(Spec, bool)> = specs().into_iter().flat_map(|spec| [(spec.clone(), false), (spec, true)]).collect();
    each(progress, "rotations in a row", &tasks, |(spec, wide)| match wide {
        true => drift::<f64>(spec, "f64"),
        false => drift::<f32>(spec, "f32"),
    })
}
