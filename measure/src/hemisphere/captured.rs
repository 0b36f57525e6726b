//! Figures 4 and 5 of Gautron et al. 2004: how much of a lobe's energy a basis captures with how many coefficients, their
//! equation 15, at normal incidence and for views at 30 and 60 degrees.

use super::bases::{Basis, EVEN, HSH, SH, ZERNIKE};
use super::grid::{Node, hemisphere};
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::reflectance::brdf::Brdf;

/// The angles between view and normal, in degrees.
pub const VIEWS: [f64; 3] = [0.0, 30.0, 60.0];
/// The lobes by their names.
pub const LOBES: [&str; 2] = ["cos⁵", "Ward 0.2, 0.5"];
/// The bases and the largest order of each.
pub const BASES: [(&Basis, usize); 4] = [(&HSH, 10), (&SH, 10), (&EVEN, 10), (&ZERNIKE, 13)];

const RINGS: usize = 96;

/// What a basis captures of a lobe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Captured {
    /// The lobe.
    pub lobe: String,
    /// The angle of the view in degrees.
    pub view: f64,
    /// The basis.
    pub basis: String,
    /// For each order from 1 on the number of coefficients.
    pub coefficients: Vec<usize>,
    /// The share of the energy.
    pub shares: Vec<f64>,
}

/// The value of a lobe for a view in the xz plane, as a function of the light.
fn value(lobe: usize, view: f64, light: [f64; 3]) -> f64 {
    let (sin, cos) = view.to_radians().sin_cos();
    match lobe {
        0 => (cos * light[2] - sin * light[0]).max(0.0).powi(5),
        // The reflectance itself: what it is given with is its product with the cosine.
        _ => Brdf::Ward { alpha: [0.2, 0.5] }.value([sin, 0.0, cos], light) / light[2],
    }
}

fn captured(nodes: &[Node], lobe: usize, view: f64, (basis, last): (&Basis, usize)) -> Captured {
    let count = (basis.count)(last);
    let mut sums = vec![0.0; count];
    let mut values = vec![0.0; count];
    let mut energy = 0.0;
    for (direction, weight) in nodes {
        let f = value(lobe, view, *direction);
        energy += weight * f * f;
        (basis.values)(last, *direction, &mut values);
        sums.iter_mut().zip(&values).for_each(|(sum, value)| *sum += weight * f * value);
    }
    let coefficients: Vec<usize> = (1..=last).map(basis.count).collect();
    let share = |n: &usize| sums[..*n].iter().map(|c| c * c).sum::<f64>() / energy;
    Captured {
        lobe: LOBES[lobe].to_owned(),
        view,
        basis: basis.name.to_owned(),
        shares: coefficients.iter().map(|n| precise(share(n))).collect(),
        coefficients,
    }
}

/// A share with as many digits as its distance from one needs.
fn precise(share: f64) -> f64 {
    1.0 - significant(1.0 - share)
}

/// Every basis on every lobe.
pub fn measure(progress: &dyn Progress) -> Vec<Captured> {
    let nodes = hemisphere(RINGS);
    let tasks: Vec<(usize, f64, usize)> = (0..LOBES.len())
        .flat_map(|lobe| VIEWS.map(|view| (lobe, view)))
        .flat_map(|(lobe, view)| (0..BASES.len()).map(move |basis| (lobe, view, basis)))
        .collect();
    each(progress, "captured energy", &tasks, |(lobe, view, basis)| captured(&nodes, *lobe, *view, BASES[*basis]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hemisphere::bases::{H, HALF_LIFE};
    use crate::hemisphere::matrix::Matrix;

    /// The Gram matrices over the hemisphere, at the orders that are compared.
    #[test]
    fn the_bases_are_orthonormal_on_the_hemisphere() {
        let nodes = hemisphere(48);
        for (basis, order) in [(&HSH, 10), (&ZERNIKE, 13), (&H, 2), (&H, 3), (&HALF_LIFE, 1)] {
            let at: Vec<Vec<f64>> = nodes.iter().map(|(direction, _)| basis.at(order, *direction)).collect();
            let count = at[0].len();
            let gram = Matrix::from_fn(count, count, |i, j| {
                nodes.iter().zip(&at).map(|((_, weight), values)| weight * values[i] * values[j]).sum()
            });
            let worst = gram.mixed(1.0, &Matrix::identity(count), -1.0);
            let worst = (0..count).flat_map(|i| worst.row(i).to_vec()).map(f64::abs).fold(0.0, f64::max);
            assert!(worst < 1e-12, "{}: {worst:e}", basis.name);
        }
        // The mirrored functions are so too, but for those that vanish.
        let at: Vec<Vec<f64>> = nodes.iter().map(|(direction, _)| EVEN.at(4, *direction)).collect();
        for i in 0..16 {
            let square: f64 = nodes.iter().zip(&at).map(|((_, weight), values)| weight * values[i] * values[i]).sum();
            let l = i.isqrt();
            let wanted = if (i - l * l) % 2 == 0 { 1.0 } else { 0.0 };
            assert!((square - wanted).abs() < 1e-12, "{i}: {square}");
        }
    }
}
