//! What each way to turn coefficients costs, and how far it errs.

use zonal_codegen::emit::bands;
use zonal_codegen::families::Spec;
use zonal_codegen::ir::listing::Cost;
use zonal_codegen::promise::law;
pub use zonal_codegen::scene::picture::Method;

/// The figures of a way to turn coefficients.
pub trait Judged {
    /// What the kernel of an order costs; of a way that reads tables all that it takes, for three channels.
    fn cost(self, order: usize) -> Cost;

    /// For each angle in radians between the two normals, the error of each band as a spectral norm.
    fn band_errors(self, order: usize, angles: &[f64]) -> Vec<Vec<f64>>;

    /// For each angle in radians between the two normals, the error of each band as a root mean square over all signals.
    fn typical_band_errors(self, order: usize, angles: &[f64]) -> Vec<Vec<f64>>;

    /// The largest error of any band at an angle in radians.
    fn error(self, order: usize, angle: f64) -> f64;
}

impl Judged for Method {
    fn cost(self, order: usize) -> Cost {
        if let Some(reading) = Reading::of(self, order) {
            return Cost { total: reading.operations, ..Cost::default() };
        }
        self.spec(order).map_or_else(Cost::default, |spec| spec.code().cost(1))
    }

    fn band_errors(self, order: usize, angles: &[f64]) -> Vec<Vec<f64>> {
        match self.spec(order) {
            _ if self.reads_tables() => vec![vec![0.0; order]; angles.len()],
            Some(spec) => by_law(&spec, angles, |error| error.max),
            None => left_out(order, angles, |shares| shares.iter().copied().fold(0.0, f64::max).sqrt()),
        }
    }

    fn typical_band_errors(self, order: usize, angles: &[f64]) -> Vec<Vec<f64>> {
        match self.spec(order) {
            _ if self.reads_tables() => vec![vec![0.0; order]; angles.len()],
            Some(spec) => by_law(&spec, angles, |error| error.mean),
            None => left_out(order, angles, |shares| (shares.iter().sum::<f64>() / shares.len() as f64).sqrt()),
        }
    }

    fn error(self, order: usize, angle: f64) -> f64 {
        self.band_errors(order, &[angle])[0].iter().copied().fold(0.0, f64::max)
    }
}

/// What a way costs that reads the light's bands from tables, for R, G and B, all from the quaternion of the frame on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Operations, with those that keep reads within the faces of cubemaps.
    pub operations: usize,
    /// Reads of cubemaps.
    pub reads: usize,
}

impl Reading {
    /// The cost of a method at an order; none if it reads no tables.
    pub fn of(method: Method, order: usize) -> Option<Self> {
        let reads = order * order;
        let operations = match method {
            Method::IsdTables => bands::shaded(order, 3),
            Method::ZhfTailored => bands::set_up(order) + method.spec(order)?.code().cost(3).total + 3 * reads,
            _ => return None,
        };
        Some(Self { operations, reads })
    }
}

/// One of the errors of each band, at each angle.
fn by_law(spec: &Spec, angles: &[f64], which: fn(&law::Error) -> f64) -> Vec<Vec<f64>> {
    angles.iter().map(|&angle| law::errors(spec, angle).iter().map(which).collect()).collect()
}

/// What leaving a rotation out does to each band: its eigenvalues are e^{imβ}, and `norm` is given the squares of their
/// distances from 1.
fn left_out(order: usize, angles: &[f64], norm: fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
    let square = |m: isize, angle: f64| 4.0 * (0.5 * m as f64 * angle).sin().powi(2);
    let band = |l: isize, angle: f64| norm(&(-l..=l).map(|m| square(m, angle)).collect::<Vec<f64>>());
    angles.iter().map(|&angle| (0..order as isize).map(|l| band(l, angle)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::catalog::ORDERS;

    #[test]
    fn methods_read_back_and_tell_their_cost_and_error() {
        for method in Method::ALL {
            assert_eq!(method.to_string().parse(), Ok(method));
        }
        let wrong = "tillt".parse::<Method>().expect_err("misspelt");
        assert!(wrong.contains("did you mean `tilt`"), "{wrong}");
        for order in ORDERS {
            let angle = 0.2;
            assert!(Method::Exact.error(order, angle) == 0.0 && Method::None.cost(order).total == 0);
            assert!(Method::Tilt.cost(order).total < Method::Exact.cost(order).total, "{order}");
            // Below half a turn of the last band its error is the largest.
            let none = 2.0 * (0.5 * (order - 1) as f64 * angle).sin();
            assert!((Method::None.error(order, angle) - none).abs() < 1e-12, "{order}");
            for method in [Method::Tilt, Method::Lf3, Method::Taylor15] {
                assert!(method.error(order, angle) < none, "{method} {order}");
            }
        }
    }

    #[test]
    fn the_error_of_leaving_a_turn_out_is_that_of_its_matrix() {
        use zonal_codegen::ir::eval::{Contraction, Program};
        use zonal_codegen::ir::listing::Listing;
        let order = 5;
        let program =
            Program::<f64>::new(&Listing::new(&Spec::new(&zonal_codegen::families::axis::ROTATE_Y, order).kernel()));
        for angle in [0.1f64, 0.5, 1.0, 1.5] {
            let errors = &Method::None.band_errors(order, &[angle])[0];
            let typical = &Method::None.typical_band_errors(order, &[angle])[0];
            for l in 1..order {
                let columns: Vec<Vec<f64>> = (l * l..(l + 1) * (l + 1))
                    .map(|j| {
                        let mut unit = vec![0.0; order * order];
                        unit[j] = 1.0;
                        let turned = program.run(&[&[angle.cos(), angle.sin()], &unit], Contraction::Separate);
                        (l * l..(l + 1) * (l + 1)).map(|i| turned[i] - unit[i]).collect()
                    })
                    .collect();
                let norm = zonal_codegen::math::linear::spectral_norm(&columns);
                assert!((errors[l] - norm).abs() < 1e-9, "{l} {angle}: {} {norm}", errors[l]);
                let square = columns.iter().flatten().map(|x| x * x).sum::<f64>() / columns.len() as f64;
                assert!((typical[l] - square.sqrt()).abs() < 1e-12, "{l} {angle}: {} {square}", typical[l]);
            }
        }
    }
}
