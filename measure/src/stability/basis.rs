//! The basis to order 64 in f32 and 128 in f64, in its loop form, and to order 8 in f16: at the poles, near them, at the
//! equator and anywhere, against polynomials in whole numbers.

use crate::numbers::Twin;
use crate::stability::truth::{Band, distance, norm, sampled};
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
// Names a family: its recurrence is what is measured.
use zonal_codegen::families::loops::basis_loop;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::half::Half;
use zonal_codegen::promise::samples::Random;

/// The orders that tables show.
pub const ORDERS: [usize; 7] = [2, 4, 8, 16, 32, 64, 128];
/// The kinds of direction.
pub const PLACES: [&str; 5] = ["pole", "1e-8 from a pole", "1e-4 from a pole", "equator", "anywhere"];
/// The number types with the highest order of each.
pub const NUMBERS: [(&str, usize); 3] = [("f16", 8), ("f32", 64), ("f64", 128)];

/// The error over the bands for one number type and one kind of direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// The number type.
    pub number: String,
    /// Which of [`PLACES`].
    pub place: String,
    /// The bands that were compared.
    pub bands: Vec<usize>,
    /// The largest error of each, as a part of the band's norm.
    pub errors: Vec<f64>,
    /// How many values of all bands, compared or not, were no finite number.
    pub not_finite: usize,
}

impl Curve {
    /// The largest error of the bands of an order.
    pub fn at_order(&self, order: usize) -> Option<f64> {
        let last = self.bands.last().copied()?;
        let below = self.bands.iter().zip(&self.errors).filter(|(l, _)| **l < order).map(|(_, error)| *error);
        (order <= last + 1).then(|| below.fold(0.0, f64::max))
    }
}

/// The directions of a kind, of unit length but for rounding.
fn directions(place: usize) -> Vec<[f64; 3]> {
    let near = |away: f64| -> Vec<[f64; 3]> {
        let up = (1.0 - away * away).sqrt();
        vec![[away, 0.0, up], [0.6 * away, -0.8 * away, -up], [-0.28 * away, 0.96 * away, up]]
    };
    match place {
        0 => vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]],
        1 => near(1e-8),
        2 => near(1e-4),
        3 => vec![[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.8, 0.0], [-0.28, 0.96, 1e-8]],
        _ => {
            let mut random = Random::new(0x0ba5e);
            (0..8).map(|_| random.unit()).collect()
        }
    }
}

fn curve<T: Number>(name: &str, order: usize, place: usize, truth: &[Band]) -> Curve {
    let program = Program::<T>::new(&Listing::from(&basis_loop(order)));
    let mut errors = vec![0.0f64; truth.len()];
    let mut not_finite = 0;
    for direction in directions(place) {
        let rounded = direction.map(T::from_f64);
        // What the type holds is taken as it is, so that the rounding of the input is in no figure.
        let given = rounded.map(T::to_f64);
        let wanted: Vec<Vec<Twin>> = truth.iter().map(|band| band.values(given)).collect();
        for contraction in [Contraction::Separate, Contraction::Fused] {
            let got = program.run(&[&rounded], contraction);
            not_finite += got.iter().filter(|x| !x.to_f64().is_finite()).count();
            for ((error, band), want) in errors.iter_mut().zip(truth).zip(&wanted) {
                let l = band.l();
                let size = norm(want.iter().map(|x| x.to_f64()));
                *error = error.max(distance(&got[l * l..(l + 1) * (l + 1)], want) / size);
            }
        }
    }
    Curve {
        number: name.to_owned(),
        place: PLACES[place].to_owned(),
        bands: truth.iter().map(Band::l).collect(),
        errors: errors.into_iter().map(significant).collect(),
        not_finite,
    }
}

/// Every number type in every kind of direction.
pub fn measure(progress: &dyn Progress) -> Vec<Curve> {
    let bands: Vec<usize> = sampled(1..=127).into_iter().chain([63]).collect();
    let mut truth = each(progress, "exact basis", &bands, |l| Band::new(*l));
    truth.sort_by_key(Band::l);
    let tasks: Vec<(usize, usize)> = (0..NUMBERS.len()).flat_map(|n| (0..PLACES.len()).map(move |p| (n, p))).collect();
    each(progress, "stability of the basis", &tasks, |(number, place)| {
        let (name, order) = NUMBERS[*number];
        let below: Vec<Band> = truth.iter().filter(|band| band.l() < order).cloned().collect();
        match *number {
            0 => curve::<Half>(name, order, *place, &below),
            1 => curve::<f32>(name, order, *place, &below),
            _ => curve::<f64>(name, order, *place, &below),
        }
    })
}
